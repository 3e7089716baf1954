#!/usr/bin/env python3
"""A 1 kHz loop of the host around a generated step, in C: how late it wakes up, how long a step takes.

    python3 tests/peers/host_loop.py [SPECIFICATION] [--seconds S] [--gramforge PATH]

SPECIFICATION is a controller's, for which a C interface can be emitted; by default the PUMA 560 within 1 %.
"""

import argparse
from pathlib import Path

from arms import ROOT, read
from generated_c import FOLDER, compiled, gramforge, outputs, written
from measure import run


def main():
    parser = argparse.ArgumentParser(description="Measures a loop of the host around a generated step.")
    default = ROOT / "generated/specs/puma560_one_percent.json"
    parser.add_argument("specification", nargs="?", type=Path, default=default)
    parser.add_argument("--seconds", type=float, default=10.0, help="how long the loop runs")
    parser.add_argument("--gramforge", type=Path, help="the generator, instead of building it")
    options = parser.parse_args()
    spec = read(options.specification)
    outputs([[gramforge(options.gramforge), "generate", written(spec), "--out", FOLDER]])
    name = spec["name"]
    program = compiled(name, "host_loop.c", FOLDER / f"host_loop_{name}", [])
    print(f"{name}\n{run([program, options.seconds]).stdout}", end="")


if __name__ == "__main__":
    main()
