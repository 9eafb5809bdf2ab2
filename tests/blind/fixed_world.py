#!/usr/bin/python3
"""Runs one simulated world of fixed_worlds.csv. Hides an effect in the world, diagnoses its logs and judges the
diagnosis. The exit code is 0 if the outcome is one of the expected outcomes (OUTCOME).

    fixed_world.py --build BUILD CAUSE[+CAUSE] STRENGTH SEED OUTCOME[|OUTCOME]
"""
import argparse
import sys
import tempfile

import judging

parser = argparse.ArgumentParser()
parser.add_argument("--build", required=True)
parser.add_argument("causes")
parser.add_argument("strength", type=float)
parser.add_argument("seed", type=int)
parser.add_argument("expected")
args = parser.parse_args()
causes = [] if args.causes == "clean" else args.causes.split("+")
with tempfile.TemporaryDirectory() as folder:
    result = judging.run_world(args.build, folder, {"causes": causes, "strength": args.strength, "seed": args.seed})
print(result)
sys.exit(0 if result["outcome"] in args.expected.split("|") else 1)
