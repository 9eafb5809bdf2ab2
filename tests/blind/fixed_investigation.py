#!/usr/bin/python3
"""Runs worlds with fixed seeds. `softgrip investigate` must find the true cause of each world.

    fixed_investigation.py --build BUILD CAUSE[+CAUSE]:STRENGTH:SEED:EXPERIMENT ...

EXPERIMENT is the experiment that must separate the true cause from the others, or `none` if the logs alone must do so.
The exit code is 0 if the true cause of every world is found in this way.
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
