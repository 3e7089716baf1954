#!/usr/bin/env python3
"""Measures the exact generated code beside its peers; README.md in this folder says what and how.

    python3 tests/peers/compare.py [ARM...] [--skip PROGRAM...] [--gramforge PATH] [--operations]

ARM is a known arm or the specification file of any other.

Everything it makes goes under target/peers/: comparison.md, comparison.json and what they were made with.
"""

import argparse
import json
import re
import resource
import subprocess
from pathlib import Path

import step
from arms import FORMS, KNOWN, REDUCED, ROOT, STATES, Arm, reduced_specification, sources
from builds import BUILD, HERE, PROCESSOR, PYTHON, VERSIONS, Natives
from builds import cargo, casadi_program, check_processor, install, install_callgrind
from measure import AGREEMENT, Program, deviation, nanoseconds, run
from table import INVERSE, inverse_dynamics, markdown


def described(arms):
    """Reads every arm with the generator's library and keeps its joints; the operations of plain inverse dynamics, ours
    and CasADi's, by arm."""
    folder = BUILD / "joints"
    folder.mkdir(exist_ok=True)
    print("reading the arms", flush=True)
    command = [cargo("describe", {}) / "describe", *(arm.specification for arm in arms)]
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stderr.strip())
    counts = {}
    for arm, line in zip(arms, done.stdout.splitlines(), strict=True):
        (folder / f"{arm.name}.json").write_text(line)
        ours = json.loads(line)["inverse_dynamics"]
        casadi = json.loads(run([PYTHON, HERE / "casadi_code.py", arm.joints(folder)]).stdout)
        counts[arm.name] = {"gramforge": ours["mul"] + ours["add"], "casadi": casadi["operations"]}
    return counts


def kinds(arms):
    """Everything that is generated: (list that names the module, name, specification by form of trigonometry)."""
    out = [("arms", arm.name, arm.exact) for arm in arms]
    for arm in (arm.name for arm in arms if arm.name in REDUCED):
        for tolerance in REDUCED[arm][2]:
            specify = lambda trig, arm=arm, tolerance=tolerance: reduced_specification(arm, tolerance, trig)
            out.append(("arms", f"{arm}_within_{tolerance}", specify))
    return out + [("steps", *kind) for arm in arms for kind in step.kinds(arm)]


def generated(arms, gramforge):
    """Generates every module; the forms of trigonometry that this generator knows, and what it said."""
    if gramforge is None:
        run(["cargo", "build", "--release", "--bin", "gramforge"], cwd=ROOT)
        gramforge = ROOT / "target/release/gramforge"
    folder, made = BUILD / "modules", {}
    folder.mkdir(exist_ok=True)
    trigs, modules = ["libm"], {"arms": [], "steps": []}
    for list_name, name, specify in kinds(arms):
        for trig in FORMS:
            path = BUILD / f"{name}_{trig}.json"
            path.write_text(json.dumps(specify(trig), indent=2))
            command = [gramforge, "generate", path, "--out", folder, "--json"]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode == 2 and trig != "libm" and "emit" in done.stderr:
                continue
            if done.returncode != 0:
                raise SystemExit(done.stderr)
            seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            made[name, trig] = json.loads(done.stdout)[0] | {"seconds": seconds}
            modules[list_name].append(module(folder / f"{name}_{trig}.rs"))
            if trig not in trigs:
                trigs.append(trig)
    for list_name, lines in modules.items():
        (folder / f"{list_name}.rs").write_text("\n".join([f"{list_name}! {{", *lines, "}\n"]))
    cargo("gramforge", {"GRAMFORGE_MODULES": str(folder), "RUSTFLAGS": f"-C target-cpu={PROCESSOR}"})
    return trigs, made


def module(path):
    """Name, type and number of joints of a generated module, as gramforge/src/main.rs takes them."""
    model, joints = re.search(r"impl (?:\w*::)*Model<(?:f64, )?(\d+)> for (\w+)", path.read_text()).group(2, 1)
    return f"{path.stem} {model} {joints}"


def counted(operations):
    """Arithmetic operations; a multiplication and an addition that are fused are one."""
    return sum(operations.get(kind, 0) for kind in ("mul", "add", "fused", "div"))


def casadi_models(natives):
    """Title and name of each model that CasADi makes."""
    models = {"CasADi C, plain recursion": "plain"}
    return models | ({"CasADi C, Pinocchio's recursion": "pinocchio"} if natives.has("pinocchio_casadi") else {})


def implementations(arm, natives, trigs, made):
    """(name, program, figures known beforehand, whether it computes the passivity torque) of each."""
    states, model = BUILD / f"{arm.name}.states", BUILD / f"{arm.name}.model"
    states.write_text(arm.states())
    model.write_text(arm.numbers())
    rows = []
    binary = BUILD / "gramforge/release/gramforge-peers"
    for trig in trigs:
        module, said = f"{arm.name}_{trig}", made[arm.name, trig]
        program = Program([binary, module, states], binary, rf"{module}.*measured", "*::measured*")
        count = said["operations"]
        figures = {"operations": counted(count), "seconds": said["seconds"]}
        rows.append((f"Gramforge exact, {trig}", program, figures | {"form": said["form"]}))
    functions = r"^(measured|passivity|casadi_f0|casadi_sq)(\..*)?$"
    makers = {"plain": [PYTHON, HERE / "casadi_code.py", arm.path], "pinocchio": [BUILD / "pinocchio_casadi", model]}
    for title, name in casadi_models(natives).items():
        program, said = casadi_program(arm, name, makers[name])
        command = [program, "-", states, arm.n]
        rows.append((title, Program(command, program, functions), {k: said[k] for k in ("operations", "seconds")}))
    if natives.has("pinocchio"):
        rows.append(("Pinocchio, 2 × rnea", Program([BUILD / "pinocchio", model, states, arm.n]), {}))
    compiled = BUILD / f"{arm.name}.mjb"
    run([PYTHON, HERE / "mujoco_model.py", arm.path, compiled])
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
            binary = BUILD / "gramforge/release/gramforge-peers"
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
                    "operations": counted(count),
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
    parser.add_argument("arms", nargs="*", metavar="ARM", help=f"of {', '.join(KNOWN)} (all by default), or a file")
    skippable = ["pinocchio", "pinocchio_casadi", "mujoco", "mj_inverse"]
    parser.add_argument("--skip", nargs="+", default=[], choices=skippable, help="peers to leave out")
    parser.add_argument("--gramforge", type=Path, help="the generator, instead of building it")
    parser.add_argument("--operations", action="store_true", help="count plain inverse dynamics; measure nothing")
    options = parser.parse_args()
    arms = sources(options.arms or KNOWN)
    if not options.operations:
        check_processor()
    BUILD.mkdir(parents=True, exist_ok=True)
    install(["casadi"] if options.operations else VERSIONS)
    titles, plain = {arm.name: arm.title for arm in arms}, described(arms)
    if options.operations:
        return print("\n".join(inverse_dynamics(titles, plain)))
    install_callgrind()
    natives = Natives(options.skip)
    trigs, made = generated(arms, options.gramforge)
    result = {"versions": VERSIONS, "processor": PROCESSOR, "missing": natives.missing, "titles": titles}
    result |= {"inverse_dynamics": plain, "arms": {}, "steps": {}}
    compilers = (["gcc", "--version"], ["rustc", "--version"], ["valgrind", "--version"])
    result["tools"] = [run(command).stdout.splitlines()[0] for command in compilers]
    for arm in arms:
        print(f"measuring {arm.name}", flush=True)
        joints = Arm(arm.joints(BUILD / "joints"))
        result["arms"][arm.name] = compared(joints, natives, trigs, made)
        if step.kinds(arm) and (rows := step.compared(arm, joints.n, trigs, casadi_models(natives), made)):
            result["steps"][arm.name] = rows
    measured = [arm for arm in REDUCED if arm in titles]
    result["reduced"] = {arm: reduced(arm, trigs, made, result["arms"][arm]) for arm in measured}
    (BUILD / "comparison.json").write_text(json.dumps(result, indent=2, ensure_ascii=False) + "\n")
    (BUILD / "comparison.md").write_text(markdown(result))
    print(markdown(result))


if __name__ == "__main__":
    main()
