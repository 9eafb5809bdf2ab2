#!/usr/bin/python3
"""The physics of textbook-world, judged by its output alone: test_textbook_world.py PROGRAM [unittest option ...]"""
import collections
import csv
import io
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
SEED = 11


def probe(name):
    text = subprocess.run([PROGRAM, "--probe", name], check=True, capture_output=True, text=True).stdout
    return list(csv.DictReader(io.StringIO(text)))


def world(*options):
    """The bytes of the logs, in order, and the truth."""
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        subprocess.run([PROGRAM, "--seed", str(SEED), "--out", work / "logs", "--truth", work / "truth.json", *options],
                       check=True)
        return [p.read_bytes() for p in sorted((work / "logs").iterdir())], json.loads((work / "truth.json").read_text())


class Valve(unittest.TestCase):
    def test_flow_is_choked_below_the_critical_ratio_and_subsonic_above(self):
        flow = {float(row["ratio"]): float(row["flow"]) for row in probe("flow")}
        for ratio, value in flow.items():
            if ratio <= 0.3:
                self.assertAlmostEqual(value, 0.01 * 300)
            elif ratio < 0.995:
                self.assertAlmostEqual(value, 3 * math.sqrt(1 - ((ratio - 0.3) / 0.7) ** 2), msg=f"ratio {ratio}")
        self.assertEqual(flow[1.0], 0)

    def test_air_is_conserved_behind_a_shut_spool(self):
        air = [float(row["air_kpa_dm3"]) for row in probe("rest")]
        self.assertGreater(len(air), 5)
        for value in air:
            self.assertAlmostEqual(value, 180 * 0.02 + 120 * 0.08, places=9)


class Finger(unittest.TestCase):
    def test_minor_loops_close_and_are_wiped_out(self):
        at = {(row["make"], row["place"]): float(row["displacement_mm"]) for row in probe("loops")}
        for make in ("play", "maxwell_slip", "preisach"):
            with self.subTest(make=make):
                self.assertGreater(at[make, "inside"], at[make, "turn"] + 1)
                self.assertAlmostEqual(at[make, "back"], at[make, "turn"], places=9)
                for place in ("end", "rising"):
                    self.assertAlmostEqual(at[make, place], at[make, place + "_reference"], places=9)

    def test_creep_is_monotone_over_five_decades(self):
        curves = collections.defaultdict(list)
        for row in probe("creep"):
            curves[row["make"]].append(float(row["displacement_mm"]))
        self.assertEqual(len(curves), 5)
        for make, values in curves.items():
            with self.subTest(make=make):
                self.assertTrue(all(a < b for a, b in zip(values, values[1:])), values)


class Campaign(unittest.TestCase):
    def test_the_same_seed_writes_the_same_bytes(self):
        self.assertEqual(world("--pressure", "--cause", "backlash"), world("--pressure", "--cause", "backlash"))

    def test_columns_can_be_left_out(self):
        logs, _ = world("--no-temperature", "--no-supply")
        self.assertEqual(logs[0].splitlines()[0], b"time_s,pressure_command_kpa,displacement_mm")

    def test_every_make_has_every_value(self):
        for make in ("play", "maxwell_slip", "preisach", "hyperelastic_tube", "fractional"):
            logs, truth = world("--make", make, "--pressure")
            self.assertEqual(truth["make"], make)
            self.assertIn("slow_creep", truth["own_physics"])
            for log in logs:
                for row in log.splitlines()[1:]:
                    self.assertTrue(all(math.isfinite(float(cell)) for cell in row.split(b",")), (make, row))


if __name__ == "__main__":
    print(f"seed {SEED}")
    unittest.main()
