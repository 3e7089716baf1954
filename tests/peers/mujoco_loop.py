#!/usr/bin/env python3
"""Generated controllers drive arms in MuJoCo; README.md in this folder says what and how.

    python3 tests/peers/mujoco_loop.py [ARM...] [--corners N] [--payloads KG...] [--gramforge PATH]

Exit code 1 where an error or a torque leaves what is guaranteed, or where MuJoCo's dynamics are not Gramforge's.
"""

import argparse
import importlib.util
import json
import os
import random
import sys
from pathlib import Path

from builds import BUILD, PYTHON, install
from generated_c import FOLDER, Controller, gramforge, outputs, written

if importlib.util.find_spec("mujoco") is None:
    BUILD.mkdir(parents=True, exist_ok=True)
    install(["mujoco"])
    os.execv(PYTHON, [str(PYTHON), *sys.argv])

import mujoco
import numpy as np

from loop_arms import INTERVAL, INITIAL, LOOPS, PAYLOAD, evaluated
from mujoco_model import compiled

# Steps of the integrator in a control period, and how long the loop runs after the motion, s.
SUBSTEPS, AFTER = 10, 1.0
# Largest difference of an inverse or forward dynamics, as a part of the largest torque or acceleration.
AGREEMENT = 1e-9
STATES = 64


class Plant:
    """An arm in MuJoCo with a payload of this mass, kg; the friction is a torque."""

    def __init__(self, loop, mass, step):
        # The compiler takes steps of its own.
        mujoco.set_mjcb_passive(None)
        self.model = compiled(loop.peer(mass))
        self.viscous, self.forwards, self.backwards = loop.friction()
        self.model.opt.timestep = step
        self.model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
        self.data = mujoco.MjData(self.model)
        # The inertias were put in after the compiler; nothing else may act on the arm.
        assert self.model.ngeom == self.model.neq == self.model.nu == self.model.ntendon == 0
        assert not self.model.jnt_limited.any() and not self.model.dof_damping.any()
        assert not self.model.dof_frictionloss.any() and not self.model.jnt_stiffness.any()
        mujoco.set_mjcb_passive(self.passive)

    def passive(self, model, data):
        """Friction; MuJoCo asks for it at every stage of a Runge-Kutta step."""
        qd = data.qvel
        coulomb = np.where(qd > 0, self.forwards, np.where(qd < 0, self.backwards, 0.0))
        data.qfrc_passive[:] -= self.viscous * qd + coulomb

    def put(self, q, qd):
        self.data.qpos[:], self.data.qvel[:] = q, qd

    def inverse(self, q, qd, qdd):
        self.put(q, qd)
        self.data.qacc[:] = qdd
        mujoco.mj_inverse(self.model, self.data)
        return self.data.qfrc_inverse.copy()

    def forward(self, q, qd, torque):
        self.put(q, qd)
        self.data.qfrc_applied[:] = torque
        mujoco.mj_forward(self.model, self.data)
        return self.data.qacc.copy()


def apart(found, expected):
    found, expected = np.array(found), np.array(expected)
    return np.abs(found - expected).max() / np.abs(expected).max()


def agreement(loop, tool, payloads):
    """Largest difference between MuJoCo's dynamics and `gramforge evaluate` at random states, over the payloads."""
    worst = 0.0
    draw = random.Random(560)
    for mass in payloads:
        plant = Plant(loop, mass, 1e-4)
        limits = [joint["qlim"] for joint in loop.peer(mass).joints]
        states = []
        for _ in range(STATES):
            rates = [[draw.uniform(-most, most) for _ in limits] for most in (2.0, 10.0)]
            states.append(([draw.uniform(low, high) for low, high in limits], *rates))
        torques = [state["tau"] for state in evaluated(tool, loop, mass, states)]
        inverse = apart([plant.inverse(*state) for state in states], torques)
        accelerations = [plant.forward(q, qd, torque) for (q, qd, _), torque in zip(states, torques)]
        # Unlike max, this keeps a NaN.
        worst = np.max([worst, inverse, apart(accelerations, [qdd for *_, qdd in states])])
    return worst


def corners(n, count):
    """Signs of the initial error: the first and the last alike for all joints, then in turn, then random."""
    draw = random.Random(1)
    fixed = [[1] * n, [-1] * n, [(-1) ** i for i in range(n)], [-((-1) ** i) for i in range(n)]]
    return (fixed + [[draw.choice((-1, 1)) for _ in range(n)] for _ in range(count)])[:count]


class Desired:
    """The desired motion at every step of the integrator."""

    def __init__(self, controller, step):
        self.periods = round((controller.duration + AFTER) / controller.period)
        times = [k * step for k in range(self.periods * SUBSTEPS + 1)]
        self.q = np.array([controller.reference(time)[0] for time in times])
        self.qd = controller.reference(0.0)[1]


def ran(controller, plant, desired, initial):
    """Errors at every step of the integrator, and the torques, of one run."""
    controller.start()
    mujoco.mj_resetData(plant.model, plant.data)
    plant.put(desired.q[0] + initial, desired.qd)
    data, errors, torques = plant.data, [plant.data.qpos - desired.q[0]], []
    for period in range(desired.periods):
        torque = controller.step(data.qpos, data.qvel, period * controller.period)
        torques.append(torque)
        data.qfrc_applied[:] = torque
        for substep in range(1, SUBSTEPS + 1):
            mujoco.mj_step(plant.model, data)
            errors.append(data.qpos - desired.q[period * SUBSTEPS + substep])
    return np.abs(errors), np.array(torques)


def parts(guarantee, controller, errors, torques):
    """What was found as a part of what is guaranteed, by joint, for each promise."""
    step = controller.period / SUBSTEPS
    settled = round(guarantee["settle"] / step)
    end = round(controller.duration / step)
    low, high = np.array(guarantee["torque_min"]), np.array(guarantee["torque_max"])
    middle, half = (high + low) / 2, (high - low) / 2
    return {
        "error at any time": errors.max(axis=0) / guarantee["reach"],
        f"error from {guarantee['settle']:g} s on": errors[settled:].max(axis=0) / guarantee["settled_error"],
        "error at the end of the motion": errors[end] / guarantee["end_error"],
        "torque in its range": np.abs(torques - middle).max(axis=0) / half,
    }


def looped(loop, tool, count, payloads):
    """The largest parts over all runs of an arm, and how well the two dynamics agree."""
    difference = agreement(loop, tool, payloads)
    if not difference <= AGREEMENT:
        raise SystemExit(f"{loop.arm}: MuJoCo's dynamics differ from Gramforge's by {difference:.1e}")
    path = written(loop.specification(tool))
    said = outputs([[tool, "inspect", path, "--json"], [tool, "generate", path, "--out", FOLDER]])
    guarantee = json.loads(said[0])["guarantee"]
    controller = Controller(path.stem)
    last = controller.duration + AFTER
    if guarantee["kind"] != "sampled" or (guarantee["valid_until"] or last) < last:
        raise SystemExit(f"{loop.arm}: no guarantee of the sampled loop until {last} s: {guarantee}")
    step = controller.period / SUBSTEPS
    desired, worst = Desired(controller, step), {}
    for mass in payloads:
        plant = Plant(loop, mass, step)
        for signs in corners(controller.n, count):
            errors, torques = ran(controller, plant, desired, INITIAL * np.array(signs))
            for promise, part in parts(guarantee, controller, errors, torques).items():
                if not np.isfinite(part).all():
                    raise SystemExit(f"{loop.arm}, {mass} kg, corner {signs}: an error or a torque is not finite")
                worst[promise] = np.maximum(worst.get(promise, 0.0), part)
    return worst, difference


def main():
    parser = argparse.ArgumentParser(description="Generated controllers drive arms in MuJoCo.")
    known = [loop.arm for loop in LOOPS]
    parser.add_argument("arms", nargs="*", metavar="ARM", help=f"of {', '.join(known)}; all by default")
    parser.add_argument("--corners", type=int, default=6, help="corners of the initial error")
    masses = [INTERVAL[0], PAYLOAD, INTERVAL[1]]
    parser.add_argument("--payloads", type=float, nargs="+", default=masses, metavar="KG", help="what the arms carry")
    parser.add_argument("--gramforge", type=Path, help="the generator, instead of building it")
    options = parser.parse_args()
    if unknown := [arm for arm in options.arms if arm not in known]:
        parser.error(f"unknown arms {', '.join(unknown)}; choose from {', '.join(known)}")
    if options.corners < 1:
        parser.error("--corners must be at least 1")
    if min(options.payloads) < 0:
        parser.error("--payloads must not be negative")
    tool, largest = gramforge(options.gramforge), 0.0
    print(f"MuJoCo {mujoco.__version__}; found as a part of what is guaranteed, by joint\n")
    for loop in (loop for loop in LOOPS if loop.arm in (options.arms or known)):
        worst, difference = looped(loop, tool, options.corners, options.payloads)
        runs = options.corners * len(options.payloads)
        print(f"{loop.arm}: law {loop.law}, {runs} runs; dynamics agree to {difference:.1e}")
        for promise, part in worst.items():
            print(f"  {promise:32}" + "".join(f"{x:8.4f}" for x in part), flush=True)
            largest = max(largest, part.max())
    print(f"\nlargest: {largest:.6f}")
    return 0 if largest <= 1 else 1


if __name__ == "__main__":
    sys.exit(main())
