"""Whole control periods: generated controllers beside the same law written by hand in C around CasADi's models."""

import random
import subprocess

import arms
from arms import REDUCED, ROOT, STATES, read, text
from builds import BUILD, HERE, OPTIMISED
from measure import AGREEMENT, Program, deviation, run

# Errors of position and velocity at the states: inside and outside the boundary layers, and mostly within torque limits.
POSITION_ERROR, SPEED_ERROR = 0.005, 0.05
REDUCED_TO = "1"


def kinds(arm):
    """(name, specification by form of trigonometry) of the arm's controllers: exact, and reduced for the arms of REDUCED.

    Empty unless the arm follows a quintic by the law `report`, as the hand-written law does.
    """
    spec = read(arm.specification)
    if spec.get("control", {}).get("law") != "report" or "quintic" not in spec.get("motion", {}):
        return []
    shared = {key: spec[key] for key in ("arm", "motion", "measure", "control") if key in spec}
    out = [(f"{arm.name}_step", lambda trig: emitted(shared | {"model": "exact"}, f"{arm.name}_step", trig))]
    if arm.known and arm.name in REDUCED:
        file, _, tolerances = REDUCED[arm.name]
        over = {"measure": read(ROOT / file)["measure"]}
        over |= {"model": {"tolerance": {"torque": tolerances[REDUCED_TO]}}}
        name = f"{arm.name}_step_within_{REDUCED_TO}"
        out.append((name, lambda trig: emitted(shared | over, name, trig)))
    return out


def emitted(spec, name, trig):
    return arms.emitted(spec | {"name": f"{name}_{trig}"}, trig)


def states(arm):
    """Random times of the motion, q and q̇ near the desired ones, one state a line; the same at every run."""
    motion = read(arm.specification)["motion"]["quintic"]
    draw, lines = random.Random(1992), []
    for _ in range(STATES):
        x = draw.uniform(0.0, 1.0)
        place, speed = x**3 * (10 - 15 * x + 6 * x * x), 30 * x**2 * (1 - x) ** 2 / motion["duration"]
        spans = [(a, b - a) for a, b in zip(motion["from"], motion["to"])]
        q = [a + span * place + draw.uniform(-POSITION_ERROR, POSITION_ERROR) for a, span in spans]
        qd = [span * speed + draw.uniform(-SPEED_ERROR, SPEED_ERROR) for _, span in spans]
        lines.append([x * motion["duration"], *q, *qd])
    return text(lines)


def constants(arm, binary):
    """Writes the constants of the law written by hand into a folder; None, and a message, where it is not the arm's law."""
    folder = BUILD / f"{arm.name}_step"
    folder.mkdir(exist_ok=True)
    command = [binary, f"{arm.name}_step_libm", BUILD / f"{arm.name}.periods", "constants"]
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
    if done.returncode != 0:
        return print(f"{arm.name}: whole periods are not compared: {done.stderr.strip()}")
    (folder / "constants.h").write_text(done.stdout)
    return folder


def by_hand(arm, model, folder):
    """The program of the law written by hand around one of CasADi's models."""
    program = folder / model
    sources = [HERE / "native/step.c", HERE / "native/harness.c", BUILD / f"{arm.name}_{model}.o"]
    run(["gcc", *OPTIMISED, "-DSTEP", f"-I{folder}", *sources, "-o", program, "-lm"])
    return program


def compared(arm, joints, trigs, peers, made):
    """Rows of the arm's table, none where the hand-written law is not the arm's; `peers` has the titles of CasADi's models
    and the names of their objects, `made` what the generator said of each module."""
    periods, binary = BUILD / f"{arm.name}.periods", BUILD / "gramforge/release/step"
    periods.write_text(states(arm))
    folder, programs = constants(arm, binary), []
    if folder is None:
        return []
    for name, _ in kinds(arm):
        exact = name == f"{arm.name}_step"
        for trig in trigs:
            # Where reducing does not pay, the module is the exact one; its code may even be merged with that.
            if not exact and made[name, trig]["operations"] == made[name, trig]["exact_operations"]:
                continue
            title = f"Gramforge {'exact' if exact else f'within {REDUCED_TO} %'}, {trig}"
            module = f"{name}_{trig}"
            programs.append((title, exact, Program([binary, module, periods], toggle=f"step::{module}::measured*")))
    for title, model in peers.items():
        program = by_hand(arm, model, folder)
        programs.append((f"hand-written C, {title.removeprefix('CasADi C, ')} of CasADi", True, Program([program, "-", periods, joints])))
    reference, rows = programs[0][2].torques(), []
    for title, exact, program in programs:
        apart = deviation(program.torques(), reference) if exact else None
        if exact and not apart <= AGREEMENT:
            raise SystemExit(f"{arm.name}: {title} deviates by {apart:.1e} of the largest torque")
        rows.append({"implementation": title, "deviation": apart})
        rows[-1]["instructions"] = program.instructions(STATES, BUILD / "callgrind.out")
    return rows
