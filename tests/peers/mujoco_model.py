"""Writes an arm as a compiled MuJoCo model. Run by compare.py in its environment, imported by mujoco_loop.py.

    mujoco_model.py JOINTS.json FILE.mjb

The inertias go into the compiled model: the compiler would refuse a link without mass, and one that breaks the triangle
inequality, both of which the usual PUMA 560 has.
"""

import sys
from pathlib import Path

import mujoco
import numpy as np

from arms import Arm


def quaternion(rotation):
    result = np.zeros(4)
    mujoco.mju_mat2Quat(result, np.asarray(rotation, dtype=float).flatten())
    return result


def listed(numbers):
    return " ".join(repr(float(x)) for x in numbers)


def chain(arm):
    opening, closing = "", ""
    for joint, armature in zip(arm.joints, arm.armature):
        kind = "hinge" if joint["type"] == "R" else "slide"
        opening += (
            f'<body pos="{listed(joint["p"])}" quat="{listed(quaternion(joint["R"]))}">'
            f'<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
            f'<joint type="{kind}" axis="{listed(joint["axis"])}" armature="{armature!r}"/>'
        )
        closing += "</body>"
    return (
        f'<mujoco><option gravity="{listed(arm.gravity)}"/>'
        f"<worldbody>{opening}{closing}</worldbody></mujoco>"
    )


def compiled(arm):
    """The compiled model. Nothing in it limits or touches, and the joints have no friction."""
    model = mujoco.MjModel.from_xml_string(chain(arm))
    for body, joint in enumerate(arm.joints, start=1):
        moments, axes = np.linalg.eigh(np.array(joint["I_com"]))
        axes[:, 2] *= np.sign(np.linalg.det(axes))
        model.body_mass[body] = joint["mass"]
        model.body_ipos[body] = joint["com"]
        model.body_inertia[body] = moments
        model.body_iquat[body] = quaternion(axes)
        model.body_sameframe[body] = 0
        model.body_simple[body] = 0
    masses = [joint["mass"] for joint in arm.joints]
    for body in range(arm.n + 1):
        model.body_subtreemass[body] = sum(masses[max(body - 1, 0) :])
    return model


if __name__ == "__main__":
    mujoco.mj_saveModel(compiled(Arm(Path(sys.argv[1]))), sys.argv[2], None)
