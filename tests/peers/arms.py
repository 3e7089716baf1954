"""The arms of the comparison, their joints, and the states they are measured at."""

import json
import random
import re
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent
ROOT = TESTS.parent

# Name of the reference values, specification that describes the same arm, name in the table.
KNOWN = {
    "threedof": ("generated/specs/arm3_exact.json", "three-link arm"),
    "puma560": ("generated/specs/puma560_exact.json", "PUMA 560"),
    "stanford": ("tests/data/stanford.json", "Stanford arm"),
    "ur5": ("tests/data/ur5.json", "UR5"),
    "panda": ("tests/data/panda.json", "Panda"),
}

# Additions and multiplications of plain inverse dynamics in OpenSYMORO's code with base parameters, by the name of the arm.
OPENSYMORO = {"threedof": 102, "puma560": 349, "stanford": 293, "ur5": 318, "panda": 649, "iiwa": 434}

# Reduced models by arm: specification, what it is reduced over, and tolerances as parts of each joint's peak torque.
REDUCED = {
    "puma560": (
        "tests/data/puma560_workspace.json",
        "over its workspace",
        {"1": 0.01, "2_5": 0.025, "5": 0.05},
    ),
    "panda": ("tests/data/panda.json", "in a tube of 0.05 rad around a motion", {"1": 0.01, "5": 0.05}),
}

# The field `emit` by what the rows call it.
FORMS = {"libm": {}, "polynomial": {"trig": "polynomial"}, "fused": {"trig": "polynomial", "fma": True}}

STATES = 512
SPEED, ACCELERATION = 2.0, 10.0

# Right angles written with few digits leave entries such as 5e-12 in a rotation; as zeros they cost nothing.
SNAP = 1e-11


class Arm:
    """A chain of joints along or about coordinate axes, with inertia about each body's own centre of mass."""

    def __init__(self, path):
        self.name, self.path = path.stem, path
        truth = json.loads(path.read_text())
        self.n = truth["n"]
        self.gravity = truth["conventions"]["gravity_vector"]
        self.joints = truth["joints"]
        self.armature = truth.get("motor_inertia", {}).get("G2Jm", [0.0] * self.n)
        for joint in self.joints:
            joint["R"] = [[snapped(x) for x in row] for row in joint["R"]]
            assert sorted(joint["axis"]) == [0.0, 0.0, 1.0], "joints turn about coordinate axes"
            joint["along"] = joint["axis"].index(1.0)

    def numbers(self):
        """The model as lines of numbers, for the programs in C++."""
        lines = [[self.n, *self.gravity]]
        for joint, armature in zip(self.joints, self.armature):
            kind = 0 if joint["type"] == "R" else 1
            rotation, inertia = sum(joint["R"], []), sum(joint["I_com"], [])
            lines.append(
                [kind, joint["along"], *rotation, *joint["p"], joint["mass"], *joint["com"], *inertia, armature]
            )
        return text(lines)

    def states(self):
        """Random q within the limits, q̇, v_r and a_r, one state a line; the same at every run."""
        draw = random.Random(1992)
        limits = [joint["qlim"] for joint in self.joints]
        lines = []
        for _ in range(STATES):
            q = [draw.uniform(low, high) for low, high in limits]
            rest = [[draw.uniform(-most, most) for _ in limits] for most in (SPEED, SPEED, ACCELERATION)]
            lines.append(sum(rest, q))
        return text(lines)


class Source:
    """What an argument of compare.py names: a known arm, or a specification file of any other."""

    def __init__(self, argument):
        self.known = argument in KNOWN
        if self.known:
            self.name, (file, self.title) = argument, KNOWN[argument]
            self.specification = ROOT / file
        else:
            self.specification = Path(argument).resolve()
            self.name = self.title = named(argument)

    def joints(self, folder):
        """The file of its joints: reference values of a known arm, else what the generator has read."""
        return TESTS / "data/truth" / f"{self.name}.json" if self.known else folder / f"{self.name}.json"

    def exact(self, trig):
        """The specification of the arm's exact model, and nothing else that would take time to generate."""
        spec = read(self.specification)
        kept = {key: spec[key] for key in ("arm", "motion") if key in spec}
        # A tube needs a motion; without one the model holds over the whole workspace.
        if "motion" not in spec and "measure" in spec:
            kept["measure"] = spec["measure"]
        return emitted(kept | {"name": f"{self.name}_{trig}", "model": "exact"}, trig)


def sources(arguments):
    """The arms that the arguments name. Stops with one message for each argument that cannot be used."""
    out, faults = [], []
    # An arm that is named twice is compared once.
    for argument in dict.fromkeys(arguments):
        try:
            out.append(Source(argument))
        except (OSError, ValueError) as fault:
            faults.append(f"{argument}: {fault}")
    names = [source.name for source in out]
    reserved = {*KNOWN, *(f"{arm}_within_{tolerance}" for arm in REDUCED for tolerance in REDUCED[arm][2])}
    for source in out:
        if not source.known and (names.count(source.name) > 1 or source.name in reserved):
            faults.append(f'{source.specification}: field "name": another arm has the name {source.name}; choose another')
    if faults:
        raise SystemExit("\n".join(faults))
    return out


def named(argument):
    """The name in a specification file. A ValueError says why it cannot be used."""
    path = Path(argument)
    if not path.is_file():
        raise ValueError(f"is not a known arm ({', '.join(KNOWN)}), and there is no such file")
    try:
        spec = json.loads(path.read_text())
    except ValueError as fault:
        raise ValueError(f"is not JSON: {fault}") from None
    if not isinstance(spec, dict) or not isinstance(spec.get("arm"), dict):
        raise ValueError('has no object "arm"; give the specification of an arm')
    if not re.fullmatch("[a-z][a-z0-9_]*", str(spec.get("name"))):
        raise ValueError(f'field "name" is {json.dumps(spec.get("name"))}; write small letters, digits and underscores')
    return spec["name"]


def reduced_specification(name, tolerance, trig):
    """The specification of a reduced model of an arm that stays within a tolerance, by its key in REDUCED."""
    source, _, tolerances = REDUCED[name]
    spec = read(ROOT / source)
    kept = {key: spec[key] for key in ("arm", "motion", "measure") if key in spec}
    kept |= {"name": f"{name}_within_{tolerance}_{trig}", "model": {"tolerance": {"torque": tolerances[tolerance]}}}
    return emitted(kept, trig)


def emitted(spec, trig):
    """The specification with the field `emit` of a form."""
    return spec | {"emit": FORMS[trig]} if FORMS[trig] else spec


def read(source):
    """A specification whose files are found from anywhere."""
    spec = json.loads(source.read_text())
    if "urdf" in spec["arm"]:
        spec["arm"]["urdf"] = str(source.parent / spec["arm"]["urdf"])
    if "csv" in spec.get("motion", {}):
        spec["motion"]["csv"]["file"] = str(source.parent / spec["motion"]["csv"]["file"])
    return spec


def snapped(x):
    return 0.0 if abs(x) < SNAP else float(round(x)) if abs(x - round(x)) < SNAP else x


def text(lines):
    return "".join(" ".join(repr(x) for x in line) + "\n" for line in lines)
