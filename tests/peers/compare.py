#!/usr/bin/env python3
"""Measures the exact generated code beside its peers; README.md in this folder says what and how.

    python3 tests/peers/compare.py [ARM...] [--skip PROGRAM...] [--gramforge PATH]

Everything it makes goes under target/peers/: comparison.md, comparison.json and what they were made with.
"""

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

from arms import ARMS, REDUCED, ROOT, STATES, Arm, reduced_specification, specification
from measure import Program, deviation, nanoseconds, run
from table import INVERSE, markdown

HERE = Path(__file__).resolve().parent
BUILD = ROOT / "target/peers"
PYTHON = BUILD / "venv/bin/python"
VERSIONS = {"pin": "4.1.0", "casadi": "3.8.2", "mujoco": "4.0.0"}
AGREEMENT = 1e-9

# Valgrind knows no AVX-512; without it the machine's own instructions are measured.
FLAGS = Path("/proc/cpuinfo").read_text()
PROCESSOR = "x86-64-v3" if "avx512f" in FLAGS else "native"
OPTIMISED = ["-O3", f"-march={PROCESSOR}", "-DNDEBUG"]


def prepare():
    """The peers at their versions, and callgrind."""
    BUILD.mkdir(parents=True, exist_ok=True)
    if shutil.which("valgrind") is None:
        run(["apt-get", "update"])
        run(["apt-get", "install", "-y", "valgrind"])
    if not PYTHON.exists():
        run([sys.executable, "-m", "venv", BUILD / "venv"])
    run([PYTHON, "-m", "pip", "install", "-q", *(f"{name}=={version}" for name, version in VERSIONS.items())])


def packages():
    return Path(run([PYTHON, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]).stdout.strip())


class Natives:
    """The peers' programs that serve every arm; `missing` says which could not be built, and why."""

    def __init__(self, skipped):
        site, self.missing = packages(), {name: "skipped" for name in skipped}
        prefix, casadi, mujoco = site / "cmeel.prefix", site / "casadi", site / "mujoco"
        # As in the package's own pinocchioTargets.cmake.
        limits = ["LIMIT_LIST_SIZE=30", "LIMIT_VECTOR_SIZE=30", "CFG_NO_PREPROCESSED_HEADERS"]
        boost = [f"-DBOOST_MPL_{limit}" for limit in limits] + ["-DBOOST_FUSION_INVOKE_MAX_ARITY=12"]
        # Boost 1.90 with these limits fails its own check that a variant holds the type asked of it.
        boost.append("-DBOOST_VARIANT_USE_RELAXED_GET_BY_DEFAULT")
        headers = [f"-I{prefix}/include", f"-I{casadi}/include/eigen3", f"-I{casadi}/include"]
        pinocchio = ["g++", "-std=c++17", *boost, *headers]
        library = next(mujoco.glob("libmujoco.so*"))
        linked = ["gcc", *OPTIMISED, f"-I{mujoco}/include", "harness.c", "mujoco.c", library, f"-Wl,-rpath,{mujoco}"]
        run(["gcc", *OPTIMISED, "-c", "harness.c", "-o", BUILD / "harness.o"], cwd=HERE / "native")
        self.build("mujoco", [*linked, "-lm"])
        self.build("mj_inverse", [*linked, "-DINVERSE", "-lm"])
        self.build("pinocchio", [*pinocchio, *OPTIMISED, "pinocchio.cpp", BUILD / "harness.o"])
        paths = [f"-Wl,-rpath,{casadi}", casadi / "libcasadi.so"]
        self.build("pinocchio_casadi", [*pinocchio, "-O1", "-DNDEBUG", "pinocchio_casadi.cpp", *paths])

    def build(self, name, command):
        program = BUILD / name
        if name in self.missing:
            return
        sources = [HERE / "native" / part for part in os.listdir(HERE / "native")]
        if program.exists() and program.stat().st_mtime > max(part.stat().st_mtime for part in sources):
            return
        program.unlink(missing_ok=True)
        print(f"building {name}", flush=True)
        command = [str(part) for part in [*command, "-o", program]]
        done = subprocess.run(command, cwd=HERE / "native", capture_output=True, text=True)
        if done.returncode != 0:
            self.missing[name] = next((l for l in done.stderr.splitlines() if "error" in l), "did not build")

    def has(self, name):
        return name not in self.missing


def generated(names, gramforge):
    """Generates every arm's exact module and the reduced ones; the forms of trigonometry that this generator knows, and
    what it said."""
    if gramforge is None:
        run(["cargo", "build", "--release", "--bin", "gramforge"], cwd=ROOT)
        gramforge = ROOT / "target/release/gramforge"
    folder, made = BUILD / "modules", {}
    folder.mkdir(exist_ok=True)
    trigs = ["libm"]
    kinds = [(name, name in names, lambda trig, name=name: specification(name, trig)) for name in ARMS]
    for arm, (_, _, tolerances) in REDUCED.items():
        for tolerance in tolerances:
            specify = lambda trig, arm=arm, tolerance=tolerance: reduced_specification(arm, tolerance, trig)
            kinds.append((f"{arm}_within_{tolerance}", arm in names, specify))
    for name, wanted, specify in kinds:
        for trig in ("libm", "polynomial"):
            path = BUILD / f"{name}_{trig}.json"
            path.write_text(json.dumps(specify(trig), indent=2))
            if not wanted and (folder / f"{name}_{trig}.rs").exists():
                continue
            command = [gramforge, "generate", path, "--out", folder, "--json"]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode == 2 and trig == "polynomial" and "emit" in done.stderr:
                continue
            if done.returncode != 0:
                raise SystemExit(done.stderr)
            seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            made[name, trig] = json.loads(done.stdout)[0] | {"seconds": seconds}
            if trig not in trigs:
                trigs.append(trig)
    features = ["--features", "polynomial"] if "polynomial" in trigs else []
    environment = os.environ | {
        "GRAMFORGE_MODULES": str(folder),
        "RUSTFLAGS": f"-C target-cpu={PROCESSOR}",
        "CARGO_TARGET_DIR": str(BUILD / "cargo"),
    }
    run(["cargo", "build", "--release", *features], cwd=HERE / "gramforge", env=environment)
    return trigs, made


def casadi_program(arm, name, maker):
    """A program from the C code that `maker` writes, and what `maker` said."""
    source, program = BUILD / f"{arm.name}_{name}.c", BUILD / f"{arm.name}_{name}"
    said = json.loads(run([*maker, source], cwd=BUILD).stdout)
    common = [HERE / "native/casadi.c", BUILD / "harness.o"]
    # Apart from its caller, as generated code is used; inside its own file gcc may inline what it likes.
    run(["gcc", *OPTIMISED, "-c", source, "-o", f"{program}.o"])
    run(["gcc", *OPTIMISED, *common, f"{program}.o", "-o", program, "-lm"])
    return program, said


def implementations(arm, natives, trigs, made):
    """(name, program, figures known beforehand, whether it computes the passivity torque) of each."""
    states, model = BUILD / f"{arm.name}.states", BUILD / f"{arm.name}.model"
    states.write_text(arm.states())
    model.write_text(arm.numbers())
    rows = []
    binary = BUILD / "cargo/release/gramforge-peers"
    for trig in trigs:
        module, said = f"{arm.name}_{trig}", made[arm.name, trig]
        program = Program([binary, module, states], binary, rf"{module}.*measured", "*::measured*")
        count = said["operations"]
        figures = {"operations": count["mul"] + count["add"] + count.get("div", 0), "seconds": said["seconds"]}
        rows.append((f"Gramforge exact, {trig}", program, figures | {"form": said["form"]}))
    functions = r"^(measured|passivity|casadi_f0|casadi_sq)(\..*)?$"
    makers = {"CasADi C, plain recursion": ("plain", [PYTHON, HERE / "casadi_code.py", arm.name])}
    if natives.has("pinocchio_casadi"):
        makers["CasADi C, Pinocchio's recursion"] = ("pinocchio", [BUILD / "pinocchio_casadi", model])
    for title, (name, maker) in makers.items():
        program, said = casadi_program(arm, name, maker)
        command = [program, "-", states, arm.n]
        rows.append((title, Program(command, program, functions), {k: said[k] for k in ("operations", "seconds")}))
    if natives.has("pinocchio"):
        rows.append(("Pinocchio, 2 × rnea", Program([BUILD / "pinocchio", model, states, arm.n]), {}))
    compiled = BUILD / f"{arm.name}.mjb"
    run([PYTHON, HERE / "mujoco_model.py", arm.name, compiled])
    if natives.has("mujoco"):
        rows.append(("MuJoCo, 2 × mj_rne", Program([BUILD / "mujoco", compiled, states, arm.n]), {}))
    if natives.has("mj_inverse"):
        rows.append((INVERSE, Program([BUILD / "mj_inverse", compiled, states, arm.n]), {}))
    return rows


def compared(arm, natives, trigs, made):
    """The rows of one arm's table."""
    rows = implementations(arm, natives, trigs, made)
    reference = rows[0][1].torques()
    # mj_inverse knows no v_r: what it should give is the passivity torque at v_r = q̇.
    still = BUILD / f"{arm.name}.inverse_states"
    lines = [line.split() for line in arm.states().splitlines()]
    n = arm.n
    still.write_text("".join(" ".join(x[: 2 * n] + x[n : 2 * n] + x[3 * n :]) + "\n" for x in lines))
    inverse = Program([*rows[0][1].command[:2], still]).torques()
    for name, program, figures in rows:
        target = inverse if name == INVERSE else reference
        figures["deviation"] = deviation(program.torques(), target)
        if not figures["deviation"] <= AGREEMENT:
            raise SystemExit(f"{arm.name}: {name} deviates by {figures['deviation']:.1e} of the largest torque")
        figures["instructions"] = program.instructions(STATES, BUILD / "callgrind.out")
        figures["code_bytes"] = program.code_bytes()
    for (_, _, figures), (low, median, high) in zip(rows, nanoseconds([program for _, program, _ in rows])):
        figures["ns"] = {"median": median, "quartiles": [low, high]}
    return [{"implementation": name} | figures for name, _, figures in rows]


def reduced(arm, trigs, made, rows):
    """Rows of the reduced models of an arm, with the certified error and instructions as a part of each CasADi row's."""
    tolerances = REDUCED[arm][2]
    out = []
    for tolerance in tolerances:
        for trig in trigs:
            module = f"{arm}_within_{tolerance}"
            binary = BUILD / "cargo/release/gramforge-peers"
            command = [binary, f"{module}_{trig}", BUILD / f"{arm}.states"]
            program = Program(command, binary, rf"{module}_{trig}.*measured", "*::measured*")
            said = made[module, trig]
            instructions = program.instructions(STATES, BUILD / "callgrind.out")
            parts = {
                row["implementation"]: instructions / row["instructions"]
                for row in rows
                if row["implementation"].startswith("CasADi C")
            }
            errors = zip(said["torque_error"], said["peak_torque"])
            count = said["operations"]
            out.append(
                {
                    "tolerance": tolerances[tolerance],
                    "trig": trig,
                    "operations": count["mul"] + count["add"],
                    "certified": max(error / peak for error, peak in errors),
                    "instructions": instructions,
                    "parts": parts,
                    "code_bytes": program.code_bytes(),
                    "source_bytes": said["bytes"],
                    "seconds": said["seconds"],
                }
            )
    return out


def main():
    parser = argparse.ArgumentParser(description="Measures the exact generated code beside its peers.")
    parser.add_argument("arms", nargs="*", metavar="ARM", help=f"of {', '.join(ARMS)}; all by default")
    skippable = ["pinocchio", "pinocchio_casadi", "mujoco", "mj_inverse"]
    parser.add_argument("--skip", nargs="+", default=[], choices=skippable, help="peers to leave out")
    parser.add_argument("--gramforge", type=Path, help="the generator, instead of building it")
    options = parser.parse_args()
    names = options.arms or list(ARMS)
    if unknown := set(names) - set(ARMS):
        parser.error(f"no such arm: {', '.join(unknown)}; there are {', '.join(ARMS)}")
    prepare()
    natives = Natives(options.skip)
    trigs, made = generated(names, options.gramforge)
    result = {"versions": VERSIONS, "processor": PROCESSOR, "missing": natives.missing, "arms": {}}
    compilers = (["gcc", "--version"], ["rustc", "--version"], ["valgrind", "--version"])
    result["tools"] = [run(command).stdout.splitlines()[0] for command in compilers]
    for name in names:
        print(f"measuring {name}", flush=True)
        result["arms"][name] = compared(Arm(name), natives, trigs, made)
    measured = [arm for arm in REDUCED if arm in names]
    result["reduced"] = {arm: reduced(arm, trigs, made, result["arms"][arm]) for arm in measured}
    (BUILD / "comparison.json").write_text(json.dumps(result, indent=2, ensure_ascii=False) + "\n")
    (BUILD / "comparison.md").write_text(markdown(result))
    print(markdown(result))


if __name__ == "__main__":
    main()
