#!/usr/bin/python3
"""Worlds with fixed seeds whose logs are ambiguous: `softgrip investigate` must resolve each to the truth.

    fixed_investigation.py --build BUILD CAUSE[+CAUSE]:STRENGTH:SEED:EXPERIMENT ...

EXPERIMENT is what must have resolved it; `none`: the logs alone name the truth. Exit code 0 when all of them are.
"""
import argparse
import sys
import tempfile

from investigating import investigate_world

parser = argparse.ArgumentParser()
parser.add_argument("--build", required=True)
parser.add_argument("worlds", nargs="+")
args = parser.parse_args()
failed = False
for text in args.worlds:
    causes, strength, seed, experiment = text.split(":")
    world = {"causes": causes.split("+"), "strength": float(strength), "seed": int(seed), "poor": False}
    with tempfile.TemporaryDirectory() as folder:
        result = investigate_world(args.build, folder, world)
    if experiment == "none":
        good = result.get("before") == "right"
    else:
        good = result["outcome"] == "right" and result["resolved_by"] == experiment
    print("resolved" if good else "NOT RESOLVED", result, flush=True)
    failed |= not good
sys.exit(1 if failed else 0)
