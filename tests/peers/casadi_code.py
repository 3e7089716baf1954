"""C code of the passivity torque by two inverse dynamics, made with CasADi. Run by compare.py in its environment.

    casadi_code.py JOINTS.json FILE.c     prints operations and CPU seconds as JSON
    casadi_code.py JOINTS.json            prints the operations of plain inverse dynamics alone

τ = rnea(q, (q̇ + v_r)/2, a_r) − rnea₀(q, (q̇ − v_r)/2, 0), rnea₀ without gravity: equal to D a_r + C(q, q̇) v_r + G because
the Christoffel C(q, ·)· is symmetric in its two velocities.

The recursion is Newton's and Euler's in the bodies' own frames, with inertia about each joint's origin, written so that
zeros and ones of the model fold away.
"""

import json
import sys
import time
from pathlib import Path

import casadi as ca

from arms import Arm


def rnea(arm, q, qd, qdd, gravity):
    """Torques of the motion q, q̇, q̈ against gravity, a list of scalar expressions."""
    omega, alpha, acceleration = ca.SX(3, 1), ca.SX(3, 1), -ca.DM(gravity)
    acceleration = ca.SX(ca.sparsify(acceleration))
    forces, moments, places = [], [], []
    for i, joint in enumerate(arm.joints):
        axis = ca.SX(ca.sparsify(ca.DM(joint["axis"])))
        revolute = joint["type"] == "R"
        fixed = ca.SX(ca.sparsify(ca.DM(joint["R"])))
        place = ca.SX(ca.sparsify(ca.DM(joint["p"])))
        if not revolute:
            place = place + fixed @ axis * q[i]
        turn = rotation(joint["along"], q[i]) if revolute else ca.SX.eye(3)

        def inward(x, fixed=fixed, turn=turn):
            return turn.T @ (fixed.T @ x)

        def outward(x, fixed=fixed, turn=turn):
            return fixed @ (turn @ x)

        carried = ca.cross(alpha, place) + ca.cross(omega, ca.cross(omega, place))
        acceleration = inward(acceleration + carried)
        omega, alpha = inward(omega), inward(alpha)
        if revolute:
            alpha = alpha + axis * qdd[i] + ca.cross(omega, axis * qd[i])
            omega = omega + axis * qd[i]
        else:
            acceleration = acceleration + axis * qdd[i] + 2 * ca.cross(omega, axis * qd[i])

        mass, com = joint["mass"], ca.DM(joint["com"])
        first = ca.SX(ca.sparsify(mass * com, 1e-14))
        about_com = ca.DM(joint["I_com"])
        about_origin = about_com + mass * (ca.dot(com, com) * ca.DM.eye(3) - com @ com.T)
        inertia = ca.SX(ca.sparsify(about_origin, 1e-14))
        spin = ca.cross(omega, first)
        forces.append(mass * acceleration + ca.cross(alpha, first) + ca.cross(omega, spin))
        momentum = inertia @ omega
        moments.append(inertia @ alpha + ca.cross(omega, momentum) + ca.cross(first, acceleration))
        places.append((place, outward))

    torques = [None] * arm.n
    for i in reversed(range(arm.n)):
        joint = arm.joints[i]
        torques[i] = (moments[i] if joint["type"] == "R" else forces[i])[joint["along"]]
        if i > 0:
            place, outward = places[i]
            force = outward(forces[i])
            forces[i - 1] += force
            moments[i - 1] += outward(moments[i]) + ca.cross(place, force)
    return torques


def rotation(along, angle):
    turn = ca.SX.eye(3)
    j, k = (along + 1) % 3, (along + 2) % 3
    c, s = ca.cos(angle), ca.sin(angle)
    turn[j, j], turn[j, k], turn[k, j], turn[k, k] = c, -s, s, c
    return turn


def passivity(arm):
    """The function (q, q̇, v_r, a_r) ↦ τ."""
    q, qd, v_r, a_r = (ca.SX.sym(name, arm.n) for name in ("q", "qd", "v_r", "a_r"))
    first = rnea(arm, q, (qd + v_r) / 2, a_r, arm.gravity)
    second = rnea(arm, q, (qd - v_r) / 2, ca.SX(arm.n, 1), [0.0, 0.0, 0.0])
    rotors = [a * r for a, r in zip(arm.armature, ca.vertsplit(a_r))]
    tau = ca.vertcat(*(a - b + r for a, b, r in zip(first, second, rotors)))
    return ca.Function("passivity", [q, qd, v_r, a_r], [ca.cse(tau)])


def inverse_dynamics(arm):
    """The function (q, q̇, q̈) ↦ τ: one recursion, without a second velocity."""
    q, qd, qdd = (ca.SX.sym(name, arm.n) for name in ("q", "qd", "qdd"))
    rotors = [a * r for a, r in zip(arm.armature, ca.vertsplit(qdd))]
    tau = ca.vertcat(*(t + r for t, r in zip(rnea(arm, q, qd, qdd, arm.gravity), rotors)))
    return ca.Function("inverse_dynamics", [q, qd, qdd], [ca.cse(tau)])


def operations(function):
    """Operations but trigonometry, and sines and cosines."""
    free = {ca.OP_CONST, ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_PARAMETER, ca.OP_ASSIGN}
    kinds = [function.instruction_id(k) for k in range(function.n_instructions())]
    trig = sum(kind in (ca.OP_SIN, ca.OP_COS) for kind in kinds)
    return sum(kind not in free for kind in kinds) - trig, trig


def main():
    arm = Arm(Path(sys.argv[1]))
    if len(sys.argv) == 2:
        return print(json.dumps({"operations": operations(inverse_dynamics(arm))[0]}))
    path = Path(sys.argv[2])
    start = time.process_time()
    function = passivity(arm)
    function.generate(path.name)
    Path(path.name).replace(path)
    seconds = time.process_time() - start
    count, trig = operations(function)
    print(json.dumps({"operations": count, "trig": trig, "seconds": seconds}))


main()
