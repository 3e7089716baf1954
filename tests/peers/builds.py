"""The programs of the comparison: what they need, how they are compiled."""

import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from arms import ROOT
from measure import run

HERE = Path(__file__).resolve().parent
BUILD = ROOT / "target/peers"
PYTHON = BUILD / "venv/bin/python"
VERSIONS = {"pin": "4.1.0", "casadi": "3.8.2", "mujoco": "4.0.0"}

# Every machine compiles for the same instructions, or counts would not repeat. Valgrind does not know AVX-512.
PROCESSOR = "x86-64-v3"
# What x86-64-v3 adds to older processors, in the names of Linux; `abm` has lzcnt.
NEEDED = ["avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"]
OPTIMISED = ["-O3", f"-march={PROCESSOR}", "-DNDEBUG"]


def check_processor(path=Path("/proc/cpuinfo")):
    """Stops where this processor cannot run what is compiled for the comparison."""
    help = "Use Linux on an x86-64 processor with AVX2. `--operations` counts operations on every machine"
    if not path.exists():
        raise SystemExit(f"{path} does not exist, so the instructions of this processor are not known. {help}.")
    flags = set(path.read_text().split())
    if missing := [flag for flag in NEEDED if flag not in flags]:
        raise SystemExit(
            f"this processor ({platform.machine()}) cannot run code for {PROCESSOR}: {path} does not list "
            f"{', '.join(missing)}. {help}."
        )


def install(names):
    """The peers of these names, at their versions."""
    if not PYTHON.exists():
        run([sys.executable, "-m", "venv", BUILD / "venv"])
    run([PYTHON, "-m", "pip", "install", "-q", *(f"{name}=={VERSIONS[name]}" for name in names)])


def install_callgrind():
    if shutil.which("valgrind") is None:
        run(["apt-get", "update"])
        run(["apt-get", "install", "-y", "valgrind"])


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
        program, made_by = BUILD / name, BUILD / f"{name}.command"
        if name in self.missing:
            return
        command = [str(part) for part in [*command, "-o", program]]
        sources = {"harness.c", "model.hpp"} | set(command) & set(os.listdir(HERE / "native"))
        newest = max((HERE / "native" / source).stat().st_mtime for source in sources)
        same = made_by.exists() and made_by.read_text() == " ".join(command)
        if same and program.exists() and program.stat().st_mtime > newest:
            return
        program.unlink(missing_ok=True)
        print(f"building {name}", flush=True)
        done = subprocess.run(command, cwd=HERE / "native", capture_output=True, text=True)
        made_by.write_text(" ".join(command))
        if done.returncode != 0:
            self.missing[name] = next((l for l in done.stderr.splitlines() if "error" in l), "did not build")

    def has(self, name):
        return name not in self.missing


def casadi_program(arm, name, maker):
    """A program from the C code that `maker` writes, and what `maker` said."""
    source, program = BUILD / f"{arm.name}_{name}.c", BUILD / f"{arm.name}_{name}"
    said = json.loads(run([*maker, source], cwd=BUILD).stdout)
    common = [HERE / "native/casadi.c", BUILD / "harness.o"]
    # Apart from its caller, as generated code is used; inside its own file gcc may inline what it likes.
    run(["gcc", *OPTIMISED, "-c", source, "-o", f"{program}.o"])
    run(["gcc", *OPTIMISED, *common, f"{program}.o", "-o", program, "-lm"])
    return program, said


def cargo(package, environment):
    """The release programs of a Rust package in this folder."""
    target = BUILD / package
    environment = os.environ | environment | {"CARGO_TARGET_DIR": str(target)}
    run(["cargo", "build", "--release"], cwd=HERE / package, env=environment)
    return target / "release"
