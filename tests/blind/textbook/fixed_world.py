#!/usr/bin/python3
"""Runs one simulated world of the fixed_worlds.csv in this folder. Hides an effect in the world, diagnoses its logs
and judges the diagnosis. The exit code is 0 if the outcome is one of the expected outcomes (OUTCOME). In a world
without a hidden effect, the error of the identified structure must also be within its limit.

    fixed_world.py --build BUILD CAUSE[+CAUSE] STRENGTH SEED MAKE COLUMNS OUTCOME[|OUTCOME]
"""
import argparse
import sys
import tempfile

import trial

parser = argparse.ArgumentParser()
parser.add_argument("--build", required=True)
parser.add_argument("causes")
parser.add_argument("strength", type=float)
parser.add_argument("seed", type=int)
parser.add_argument("make")
parser.add_argument("columns", choices=["pressure", "command"])
parser.add_argument("expected")
args = parser.parse_args()
causes = [] if args.causes == "clean" else args.causes.split("+")
world = {"causes": causes, "strength": args.strength, "seed": args.seed, "make": args.make, "columns": args.columns,
         "given": "plain"}
with tempfile.TemporaryDirectory() as folder:
    result = trial.run_world(args.build, folder, world, threads=2)
print(result)
good = result["outcome"] in args.expected.split("|")
if not causes:
    good = good and result["heldout_over_noise"] <= trial.HELD_OUT_AT_MOST[args.columns]
sys.exit(0 if good else 1)
