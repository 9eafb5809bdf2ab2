#!/usr/bin/python3
"""Tests the physics of textbook-world. The test uses nothing but the output of the program. test_textbook_world.py
PROGRAM [unittest option ...]"""
import collections
import csv
import functools
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
STRENGTH_SEEDS = [6]


def output(*options):
    return subprocess.run([PROGRAM, *options], check=True, capture_output=True, text=True).stdout


def probe(name):
    return list(csv.DictReader(io.StringIO(output("--probe", name))))


def world(*options, seed=SEED):
    """Runs the program. Returns the bytes of its logs, in order, and the truth."""
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        output("--seed", str(seed), "--out", work / "logs", "--truth", work / "truth.json", *options)
        return [p.read_bytes() for p in sorted((work / "logs").iterdir())], json.loads((work / "truth.json").read_text())


def displacements(logs):
    return [float(line.split(b",")[2]) for log in logs for line in log.splitlines()[1:]]


def beyond_zero_and_gain(change, plain):
    """Fits the straight line offset + gain * `plain` to `change`. Returns the RMS of the residual."""
    count = len(change)
    change_mean, plain_mean = sum(change) / count, sum(plain) / count
    change, plain = [c - change_mean for c in change], [p - plain_mean for p in plain]
    gain = sum(c * p for c, p in zip(change, plain)) / sum(p * p for p in plain)
    return math.sqrt(sum((c - gain * p) ** 2 for c, p in zip(change, plain)) / count)


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

    def test_the_regulator_comes_to_rest_within_its_hysteresis(self):
        rows = probe("hold")
        self.assertEqual(len(rows), 50)
        for row in rows:
            with self.subTest(**row):
                self.assertLess(float(row["variation_kpa"]), 0.01)
                self.assertLess(abs(float(row["pressure_kpa"]) - float(row["command_kpa"])), 0.31)


class Finger(unittest.TestCase):
    def test_minor_loops_close_and_are_wiped_out(self):
        at = {(row["make"], row["place"]): float(row["displacement_mm"]) for row in probe("loops")}
        for make in ("play", "maxwell_slip", "preisach"):
            with self.subTest(make=make):
                self.assertGreater(at[make, "inside"], at[make, "turn"] + 1)
                self.assertAlmostEqual(at[make, "back"], at[make, "turn"], places=9)
                for place in ("end", "rising"):
                    self.assertAlmostEqual(at[make, place], at[make, place + "_reference"], places=9)

    def test_the_preisach_model_equals_a_sum_of_relays(self):
        rows = [{name: float(value) for name, value in row.items()} for row in probe("relays")]
        width, envelope, span_mm = (rows[0][name] for name in ("width", "envelope", "span_mm"))
        count = 120
        # Each relay switches on at the pressure `on` and off at the pressure `off`. The weight of a relay is 2 (1 +
        # envelope off), or half of it if `on` equals `off`.
        relays = [[(i + 0.5) / count, (j + 0.5) / count, False] for i in range(count) for j in range(i + 1)]
        half = [0.5 if on == off else 1 for on, off, _ in relays]

        def answer(q):
            for relay in relays:
                relay[2] = q >= relay[0] or (relay[2] and q > relay[1])
            up = sum(part * (1 + envelope * off) for part, (_, off, is_on) in zip(half, relays) if is_on)
            return (1 - 2 * width) * q + 2 * width * 2 * up / count**2

        answers = [answer(row["pressure_kpa"] / 60) for row in rows]
        full = 1 - 2 * width + 2 * width * (1 + envelope / 3)
        for row, z in zip(rows, answers):
            self.assertAlmostEqual(row["displacement_mm"] / span_mm, z / full, delta=0.002)

    def test_the_span_is_reached_at_working_pressure(self):
        rows = probe("span")
        self.assertEqual(len(rows), 20)
        for row in rows:
            with self.subTest(**row):
                self.assertAlmostEqual(float(row["displacement_mm"]) / float(row["span_mm"]), 1, places=6)

    def test_creep_is_monotone_over_five_decades(self):
        curves = collections.defaultdict(list)
        for row in probe("creep"):
            curves[row["make"]].append(float(row["displacement_mm"]))
        self.assertEqual(len(curves), 5)
        for make, values in curves.items():
            with self.subTest(make=make):
                self.assertTrue(all(a < b for a, b in zip(values, values[1:])), values)

    def test_fractional_creep_follows_a_power_of_time(self):
        curve = {float(row["time_s"]): float(row["displacement_mm"]) for row in probe("creep")
                 if row["make"] == "fractional" and 0.1 < float(row["time_s"]) < 400}
        values = list(curve.values())
        steps = [b - a for a, b in zip(values, values[1:])]
        # The times are powers of 2. Under a power law, each displacement step exceeds the step before by the factor
        # 2^exponent. The exponent is drawn between 0.1 and 0.25.
        exponents = [math.log2(b / a) for a, b in zip(steps, steps[1:])]
        self.assertGreater(len(exponents), 8)
        for exponent in exponents:
            self.assertAlmostEqual(exponent, sum(exponents) / len(exponents), delta=0.1)
            self.assertTrue(0.05 < exponent < 0.3, exponents)


class Campaign(unittest.TestCase):
    def test_the_same_seed_writes_the_same_bytes(self):
        self.assertEqual(world("--pressure", "--cause", "backlash"), world("--pressure", "--cause", "backlash"))

    def test_another_campaign_changes_the_logs_but_not_the_finger(self):
        (logs, truth), (others, other) = world(), world("--campaign", "1")
        self.assertNotEqual(logs, others)
        self.assertEqual((truth["make"], truth["span_mm"]), (other["make"], other["span_mm"]))

    def test_twice_the_sample_rate_gives_the_same_displacements(self):
        usual, often = (displacements(world(*rate)[0][:1]) for rate in ((), ("--rate-hz", "200")))
        change = [a - b for a, b in zip(usual, often[::2])]
        self.assertIn(len(often), range(2 * len(usual) - 2, 2 * len(usual) + 1))
        # The difference contains the noise of two readings, 0.04 mm each. It also contains a difference of the
        # commands: the valve samples them at 100 Hz in one world and at 200 Hz in the other.
        self.assertLess(math.sqrt(sum(c * c for c in change) / len(change)), 0.07)

    def test_options_omit_the_temperature_and_supply_columns(self):
        logs, _ = world("--no-temperature", "--no-supply")
        self.assertEqual(logs[0].splitlines()[0], b"time_s,pressure_command_kpa,displacement_mm")

    def test_logs_of_every_make_contain_only_finite_values(self):
        for make in output("--makes").split():
            logs, truth = world("--make", make, "--pressure")
            self.assertEqual(truth["make"], make)
            for log in logs:
                for row in log.splitlines()[1:]:
                    self.assertTrue(all(math.isfinite(float(cell)) for cell in row.split(b",")), (make, row))

    def test_listed_own_physics_effects_exceed_a_quarter_of_the_noise(self):
        for make in output("--makes").split():
            _, truth = world("--make", make)
            with self.subTest(make=make):
                self.assertLessEqual({"hysteresis_shape", "valve_lag"}, set(truth["own_physics_mm"]))
                for size_mm in truth["own_physics_mm"].values():
                    self.assertGreater(size_mm, truth["noise_mm"] / 4)


class Strength(unittest.TestCase):
    @staticmethod
    @functools.cache
    def effects(strength, seed):
        causes = ",".join(output("--list").split())
        return world("--cause", causes, "--strength", str(strength), seed=seed)[1]["effects"]

    def test_every_cause_has_the_requested_strength(self):
        for seed in STRENGTH_SEEDS:
            for strength in (2, 8):
                effects = self.effects(strength, seed)
                self.assertEqual(len(effects), 23)
                for cause, effect in effects.items():
                    with self.subTest(cause=cause, strength=strength, seed=seed):
                        self.assertTrue(effect["reachable"], effect)
                        self.assertAlmostEqual(effect["excess_mm"] / 0.04 / strength, 1, delta=0.15)

    def test_the_logs_differ_by_at_least_the_strength(self):
        for cause in ("stress_softening", "backlash", "sensor_nonlinearity", "contact", "leak"):
            plain, (with_effect, truth) = world()[0], world("--cause", cause)
            plain, with_effect = displacements(plain), displacements(with_effect)
            change = [a - b for a, b in zip(with_effect, plain)]
            excess_mm = truth["effects"][cause]["excess_mm"]
            with self.subTest(cause=cause):
                if cause == "leak":
                    whole_mm = math.sqrt(sum(c * c for c in change) / len(change))
                    self.assertAlmostEqual(whole_mm, excess_mm, delta=0.01)
                else:
                    self.assertGreater(beyond_zero_and_gain(change, plain), excess_mm - 0.01)


if __name__ == "__main__":
    print(f"seed {SEED}, strengths at the seeds {STRENGTH_SEEDS}")
    unittest.main()
