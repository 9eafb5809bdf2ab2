#!/usr/bin/python3
"""Runs one simulated world of changed_worlds.csv. Changes the finger, diagnoses the change and judges the diagnosis.
The exit code is 0 if the outcome is one of the expected outcomes (OUTCOME).

    changed_world.py --build BUILD FAMILY CAUSE STRENGTH SEED COLUMNS OUTCOME[|OUTCOME]
"""
import argparse
import sys
import tempfile

import changing

parser = argparse.ArgumentParser()
parser.add_argument("--build", required=True)
parser.add_argument("family", choices=["textbook", "first"])
parser.add_argument("cause")
parser.add_argument("strength", type=float)
parser.add_argument("seed", type=int)
parser.add_argument("columns", choices=["pressure", "command"])
parser.add_argument("expected")
args = parser.parse_args()
world = {"family": args.family, "cause": args.cause, "strength": args.strength, "seed": args.seed,
         "columns": args.columns, "zero_mm": 0.3, "warmer_c": 4 if args.cause == "none" else 0}
with tempfile.TemporaryDirectory() as folder:
    result = changing.run_world(args.build, folder, world, threads=2)
print(result)
sys.exit(0 if result["outcome"] in args.expected.split("|") else 1)
