"""A generated controller as a C library: its specification, its crate and the C programs around it."""

import ctypes
import json
import os
import shutil
import subprocess
from pathlib import Path

from arms import ROOT
from builds import BUILD, HERE
from measure import run

FOLDER = BUILD / "loops"


def gramforge(path):
    """The generator; built if no path is given."""
    if path is not None:
        return path.resolve()
    run(["cargo", "build", "--release", "--bin", "gramforge"], cwd=ROOT)
    return ROOT / "target/release/gramforge"


def outputs(commands):
    """Standard output of commands that run side by side; stops with what the first failed one said."""
    started = [
        subprocess.Popen([str(x) for x in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for command in commands
    ]
    said = [process.communicate() for process in started]
    for process, (_, errors) in zip(started, said):
        if process.returncode != 0:
            raise SystemExit(errors)
    return [out for out, _ in said]


def written(spec):
    """Writes a specification, with the C interface asked for."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{spec['name']}.json"
    path.write_text(json.dumps(spec | {"emit": spec.get("emit", {}) | {"c_api": True}}, indent=2))
    return path


def archive(name):
    """The static library of the generated crate NAME_c."""
    # The runtime of this checkout, as docs/guides/c.md says it.
    (FOLDER / ".cargo").mkdir(exist_ok=True)
    patch = f'[patch.crates-io]\ngramforge-runtime = {{ path = "{ROOT / "runtime"}" }}\n'
    (FOLDER / ".cargo/config.toml").write_text(patch)
    crate = FOLDER / f"{name}_c"
    shutil.copy(ROOT / "Cargo.lock", crate / "Cargo.lock")
    environment = os.environ | {"CARGO_TARGET_DIR": str(FOLDER / "target")}
    run(["cargo", "build", "--release", "--quiet"], cwd=crate, env=environment)
    return FOLDER / f"target/release/lib{name}_c.a"


def compiled(name, source, out, options):
    """A C program or library of native/SOURCE around the generated controller."""
    header = FOLDER / f"{name}.h"
    defines = [f"-DNAME={name}", f"-DUPPER={name.upper()}", f'-DHEADER="{header}"']
    warnings = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O2"]
    run(["gcc", *warnings, *options, *defines, HERE / "native" / source, archive(name), "-o", out, "-lm"])
    return out


class Controller:
    """A generated controller that runs in this process."""

    def __init__(self, name):
        path = compiled(name, "loop.c", FOLDER / f"lib{name}.so", ["-shared", "-fPIC"])
        self.library = ctypes.CDLL(str(path))
        numbers = ctypes.POINTER(ctypes.c_double)
        self.library.reference.argtypes = [ctypes.c_double, numbers]
        self.library.step.argtypes = [numbers, numbers, ctypes.c_double, numbers, ctypes.POINTER(ctypes.c_uint32)]
        self.n = ctypes.c_int.in_dll(self.library, "joints").value
        self.period = ctypes.c_double.in_dll(self.library, "period").value
        self.duration = ctypes.c_double.in_dll(self.library, "duration").value
        self.buffers = [(ctypes.c_double * self.n)() for _ in range(3)]
        self.cut = ctypes.c_uint32()

    def start(self):
        """A controller that has not run yet."""
        if self.library.start() != 1:
            raise SystemExit("the header and the library of the generated controller do not belong together")

    def reference(self, time):
        """Desired positions and velocities."""
        desired = (ctypes.c_double * (3 * self.n))()
        if self.library.reference(time, desired) != 0:
            raise SystemExit(f"the reference at {time} s answers a fault")
        return desired[: self.n], desired[self.n : 2 * self.n]

    def step(self, q, qd, time):
        """The torque to hold for the next period; a limit may not cut it, and no fault may come."""
        position, velocity, torque = self.buffers
        position[:], velocity[:] = q, qd
        fault = self.library.step(position, velocity, time, torque, ctypes.byref(self.cut))
        if fault != 0 or self.cut.value != 0:
            raise SystemExit(f"step at {time} s: fault {fault}, torques cut {self.cut.value:b}")
        return torque[:]
