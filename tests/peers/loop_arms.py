"""The loops of mujoco_loop.py: arms with rotors, friction and an uncertain payload, along a quintic about a home position."""

import json
import xml.etree.ElementTree as xml
from dataclasses import dataclass

import numpy as np

from arms import KNOWN, ROOT, SNAP, TESTS, Arm, read
from generated_c import FOLDER, outputs

# Away from home each joint begins at one side and ends at the other, rad.
AWAY = 0.25
DURATION, SETTLE, PERIOD = 3.0, 2.0, 1e-3
INITIAL = 0.01
PAYLOAD, INTERVAL, AT = 1.0, [0.8, 1.2], [0.0, 0.0, 0.06]


@dataclass
class Loop:
    """An arm of arms.KNOWN, its home position, its law and model, and the drives that its robot file leaves out."""

    arm: str
    home: list
    law: str
    model: object
    armature: list | None = None
    viscous: list | None = None

    def description(self, mass=PAYLOAD):
        """The field `arm` of the specification, with a payload of this mass, kg."""
        arm = read(ROOT / KNOWN[self.arm][0])["arm"]
        if "urdf" in arm:
            moving = [joint.get("name") for joint in joints(arm["urdf"]) if joint.get("type") == "revolute"]
            drives = zip(moving, self.armature, self.viscous, strict=True)
            # A whole workspace, which `evaluate` is asked for, needs limits of the acceleration.
            arm["joints"] = {
                name: {"armature": armature, "viscous_friction": viscous, "limits": {"acceleration": 20.0}}
                for name, armature, viscous in drives
            }
        arm["payload"] = {"mass": mass, "com": AT}
        return arm

    def specification(self, gramforge):
        """The controller's specification. K is 100/s times the inertia that a joint moves while the others are free."""
        still = [0.0] * len(self.home)
        mass_matrix = evaluated(gramforge, self, PAYLOAD, [(self.home, still, still)])[0]["D"]
        damping = 100 / np.diag(np.linalg.inv(mass_matrix))
        away = [AWAY if i % 2 == 0 else -AWAY for i in range(len(self.home))]
        ends = [[home + sign * by for home, by in zip(self.home, away)] for sign in (-1, 1)]
        control = {
            "law": self.law, "period": PERIOD, "settle": SETTLE, "require_guarantee": "sampled",
            "W": list(0.75 * damping), "Pqq": list(1.25 * damping), "Omega": list(6.25 * damping),
            "initial_error": {"position": INITIAL},
            "uncertainty": {"payload": {"mass": INTERVAL}},
        }  # fmt: skip
        if self.law != "exact":
            control["boundary_layer"] = 0.05
        return {
            "name": f"{self.arm}_loop",
            "arm": self.description(),
            "motion": {"quintic": {"from": ends[0], "to": ends[1], "duration": DURATION}},
            "measure": {"tube": {"position_error": 0.05}},
            "model": self.model,
            "control": control,
        }

    def peer(self, mass):
        """The same arm for MuJoCo, from the joints of the reference values: joints, rotors and a payload of this mass."""
        arm = Arm(TESTS / "data/truth" / f"{self.arm}.json")
        if self.armature is not None:
            arm.armature = self.armature
        description = self.description()
        position, rotation = tip(description)
        load(arm.joints[-1], mass, position + rotation @ AT)
        return arm

    def friction(self):
        """Viscous friction, and Coulomb friction forwards and backwards, by joint, on the joint's side of the gear."""
        arm = self.description()
        if "urdf" in arm:
            return np.array(self.viscous), np.zeros(len(self.home)), np.zeros(len(self.home))
        motors = [link["motor"] for link in arm["dh"]["links"]]
        gear = np.abs([motor["gear_ratio"] for motor in motors])
        coulomb = np.array([motor["coulomb_friction"] for motor in motors])
        viscous = np.array([motor["viscous_friction"] for motor in motors])
        return viscous * gear**2, coulomb[:, 0] * gear, coulomb[:, 1] * gear


LOOPS = [
    Loop("puma560", [0.0, 0.6, -0.6, 0.0, 0.6, 0.0], "report", {"tolerance": {"torque": 0.01}}),
    Loop(
        "ur5", [0.0, -1.2, 1.4, -1.6, -1.5, 0.0], "exact", "exact",
        [1.0, 1.0, 0.6, 0.1, 0.1, 0.1], [0.5, 0.5, 0.5, 0.1, 0.1, 0.1],
    ),
    Loop(
        "panda", [0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.5], "exact", "exact",
        [0.6, 0.6, 0.5, 0.5, 0.2, 0.2, 0.15], [0.5, 0.5, 0.5, 0.5, 0.1, 0.1, 0.1],
    ),
]  # fmt: skip


def evaluated(gramforge, loop, mass, states):
    """What `gramforge evaluate` says of the exact arm with friction and this payload, state by state."""
    spec = {"name": "evaluated", "arm": loop.description(mass), "measure": "workspace", "model": "exact"}
    FOLDER.mkdir(parents=True, exist_ok=True)
    path, asked = FOLDER / f"{loop.arm}_evaluated.json", FOLDER / f"{loop.arm}_states.json"
    path.write_text(json.dumps(spec))
    asked.write_text(json.dumps([{"q": list(q), "qd": list(qd), "qdd": list(qdd)} for q, qd, qdd in states]))
    command = [gramforge, "evaluate", path, "--states", asked, "--model", "exact", "--friction", "--json"]
    return json.loads(outputs([command])[0])


def joints(urdf):
    """The joints of a robot file, as its elements."""
    return list(xml.parse(urdf).getroot().iter("joint"))


def tip(description):
    """Position and rotation of the tip in the frame of the last moving joint."""
    position, rotation = np.zeros(3), np.eye(3)
    if "urdf" not in description:
        # The last link of the DH tables here has no length, so that its frame is the joint's.
        last = description["dh"]["links"][-1]
        assert last["a"] == last["d"] == last["alpha"] == 0.0
        return position, rotation
    every = joints(description["urdf"])
    moving = [joint for joint in every if joint.get("type") == "revolute"]
    link = moving[-1].find("child").get("link")
    while found := [joint for joint in every if joint.find("parent").get("link") == link]:
        origin = found[0].find("origin")
        position = position + rotation @ np.array(origin.get("xyz").split(), dtype=float)
        rotation = rotation @ turned(*map(float, origin.get("rpy").split()))
        link = found[0].find("child").get("link")
    return position, rotation


def turned(roll, pitch, yaw):
    """The rotation of a URDF file's rpy."""
    (sr, sp, sy), (cr, cp, cy) = np.sin([roll, pitch, yaw]), np.cos([roll, pitch, yaw])
    out = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
    return np.where(np.abs(out) < SNAP, 0.0, out)


def load(joint, mass, at):
    """Adds a point of this mass to a joint's body."""
    own, com = joint["mass"], np.array(joint["com"])
    lever = np.asarray(at) - com
    reduced = own * mass / (own + mass)
    joint["mass"] = own + mass
    joint["com"] = list(com + mass / (own + mass) * lever)
    added = reduced * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    joint["I_com"] = (np.array(joint["I_com"]) + added).tolist()
