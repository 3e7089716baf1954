"""Measurements of a program that speaks as native/harness.c does."""

import os
import re
import statistics
import subprocess

# Largest deviation from the first row, as a fraction of the largest torque.
AGREEMENT = 1e-9
ROUNDS = 60
BLOCK_NS = 2e6


class Program:
    """One implementation for one arm: a command to which the mode is appended, and the binary's functions that count."""

    def __init__(self, command, binary=None, functions=r"^$", toggle="measured"):
        self.command = [str(part) for part in command]
        self.binary, self.functions, self.toggle = binary, re.compile(functions), toggle

    def torques(self):
        """One torque vector a state."""
        lines = run([*self.command, "torques"]).stdout.splitlines()
        return [[float(x) for x in line.split()] for line in lines]

    def instructions(self, states, scratch):
        """Executed instructions a call, mean over the states, with everything that is called."""
        callgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={scratch}"]
        # With lazy binding the first call would count the dynamic linker's work.
        environment = os.environ | {"LD_BIND_NOW": "1"}
        done = run([*callgrind, f"--toggle-collect={self.toggle}", *self.command, "count"], env=environment)
        collected = int(re.search(r"Collected : (\d+)", done.stderr).group(1))
        if collected == 0:
            raise SystemExit(f"{' '.join(self.command)}: no function {self.toggle} was called, so nothing was counted")
        return collected / states

    def code_bytes(self):
        """Machine code of the functions that count, without constants and the sine's code; None for a library."""
        if self.binary is None:
            return None
        sizes = [line.split() for line in run(["nm", "-S", self.binary]).stdout.splitlines()]
        found = [int(size[1], 16) for size in sizes if len(size) == 4 and self.functions.search(size[3])]
        assert found, f"{self.binary}: no function matches {self.functions.pattern}"
        return sum(found)


def nanoseconds(programs):
    """Median and quartiles of a call's ns for each program, block by block in turn so that noise falls on all alike."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 1}
    running = [subprocess.Popen([*program.command, "time"], **pipes) for program in programs]

    def block(process, rounds):
        process.stdin.write(f"{rounds}\n")
        process.stdin.flush()
        return float(process.stdout.readline())

    try:
        rounds = [max(1, round(BLOCK_NS / (512 * min(block(p, 4) for _ in range(3))))) for p in running]
        blocks = [[] for _ in running]
        for _ in range(ROUNDS):
            for found, process, count in zip(blocks, running, rounds):
                found.append(block(process, count))
    finally:
        for process in running:
            process.stdin.close()
            process.wait()
    return [statistics.quantiles(found, n=4) for found in blocks]


def deviation(torques, reference):
    """Largest |difference| as a fraction of the largest |torque|."""
    assert len(torques) == len(reference) > 0
    pairs = [(x, y) for a, b in zip(torques, reference) for x, y in zip(a, b, strict=True)]
    apart = [abs(x - y) for x, y in pairs]
    assert all(x == x for x in apart), "a torque is not a number"
    return max(apart) / max(abs(y) for _, y in pairs)


def run(command, **options):
    """Runs a command; what it printed is shown if it fails."""
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return done
