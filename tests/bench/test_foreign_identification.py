"""Tests bench/foreign/output_error.py on linear systems with known parameters, and the comparison of the
identification methods."""
import importlib.util
import json
import math
import subprocess
import sys
import unittest

from foreign_case import BENCH, ForeignCase

SCIPY = importlib.util.find_spec("scipy") is not None
if SCIPY:
    import judge_identification
    import numpy as np

STEP_S, SAMPLES, NOISE_MM = 0.02, 3000, 0.01


def drive(seed):
    draw = np.random.default_rng(seed)
    levels = np.repeat(draw.uniform(0, 60, SAMPLES // 100), 100)
    return np.convolve(levels, np.ones(25) / 25, "same")


class Plant:
    """A linear system with known parameters: an immediate gain of 0.1 mm/kPa, a lag of 0.5 s, and either a resonance
    at 1.5 Hz or creep with a time constant of 8 s. The system is integrated with 20 steps per sample."""

    def __init__(self, resonance, start=(0.0, 0.0, 0.0)):
        self.resonance, self.state = resonance, list(start)

    def step(self, u, seconds):
        lag, x, v = self.state
        lag += seconds * (u - lag) / 0.5
        if self.resonance:
            w = 2 * math.pi * 1.5
            v += seconds * (w * w * (u - x) - 2 * 0.1 * w * v)
            x += seconds * v
        else:
            x += seconds * (u - x) / 8
        self.state = [lag, x, v]

    def reading(self, u):
        lag, x, _ = self.state
        return 2.5 + 0.1 * u + 0.2 * lag + 0.05 * x


def record(seed, resonance, start=(0.0, 0.0, 0.0)):
    u, draw = drive(seed), np.random.default_rng(seed + 100)
    plant, readings = Plant(resonance, [value + u[0] for value in start[:2]] + [0.0]), []
    for k in range(SAMPLES):
        readings.append(plant.reading(u[k]) + NOISE_MM * draw.normal())
        after = u[min(k + 1, SAMPLES - 1)]
        for i in range(20):
            plant.step(u[k] + (after - u[k]) * (i + 0.5) / 20, STEP_S / 20)
    return u, readings


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class OutputError(ForeignCase):
    def put_record(self, name, *arguments):
        rows = [f"{STEP_S * k:.3f},{u:.6f},{y:.6f}" for k, (u, y) in enumerate(zip(*record(*arguments)))]
        path = self.folder / name
        path.write_text("\n".join(["time_s,pressure_command_kpa,displacement_mm", *rows]) + "\n")
        return path

    def fit(self, order, *paths):
        run = subprocess.run([sys.executable, BENCH / "foreign/output_error.py", paths[0], "0.5", str(order), *paths[1:]],
                             check=True, capture_output=True, text=True)
        return json.loads(run.stdout)

    def test_a_model_of_the_true_order_predicts_to_the_noise_level(self):
        for resonance in (False, True):
            with self.subTest(resonance=resonance):
                found = self.fit(3, self.put_record("a.csv", 1, resonance))
                self.assertEqual(found["resonance"], resonance)
                self.assertLess(found["fitted_mm"], 1.2 * NOISE_MM)
                self.assertLess(found["held_out_mm"], 1.5 * NOISE_MM)

    def test_the_initial_state_of_the_test_log_is_estimated(self):
        first = self.put_record("a.csv", 1, False, (5.0, -5.0, 0.0))
        found = self.fit(2, first, self.put_record("b.csv", 2, False, (-4.0, 6.0, 0.0)))
        self.assertLess(found["held_out_mm"], 3 * NOISE_MM)

    def test_a_model_of_too_low_order_has_a_larger_error(self):
        path = self.put_record("a.csv", 1, True)
        self.assertGreater(self.fit(1, path)["held_out_mm"], 5 * self.fit(3, path)["held_out_mm"])

    def test_irregular_samples_and_missing_readings_are_accepted(self):
        path = self.put_record("a.csv", 1, False)
        head, *rows = path.read_text().splitlines()
        kept = [row if k % 50 != 7 else row.rsplit(",", 1)[0] + "," for k, row in enumerate(rows) if k % 3 != 1]
        path.write_text("\n".join([head, *kept]) + "\n")
        self.assertLess(self.fit(2, path)["held_out_mm"], 3 * NOISE_MM)


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Comparison(unittest.TestCase):
    def row(self, **held_out_mm):
        return {"span_mm": 10, "drive": "command", "errors": {}, "methods": {
            name: {"held_out_mm": value} for name, value in held_out_mm.items()}}

    def test_the_linear_model_is_better_by_more_than_10_percent(self):
        row = self.row(plain=0.2, auto=0.109, output_error=0.1, scipy=0.3)
        self.assertTrue(judge_identification.linear_is_better(row, "plain"))
        self.assertFalse(judge_identification.linear_is_better(row, "auto"))

    def test_the_summary_counts_rows_and_methods_that_failed(self):
        good = self.row(plain=0.2, auto=0.1, output_error=0.15, scipy=0.3)
        lost = {**self.row(plain=0.2, output_error=0.15, scipy=0.3), "errors": {"auto": "no"}}
        found = judge_identification.summary([{"rows": [good, lost]}, {"error": "x"}])
        self.assertEqual((found["rows"], found["failed"], found["methods_failed"]), (2, 1, 1))
        self.assertEqual(found["linear_better"], {"plain": 2, "auto": 0})
        self.assertEqual(found["first"], {"plain": 0, "auto": 1, "output_error": 0, "scipy": 0})
