"""Tests bench/foreign/horch.py on simulated control loops. Also tests how a diagnosis is judged if the fault of the
loop is known."""
import importlib.util
import math
import random
import unittest

from foreign_case import ForeignCase  # noqa: F401  (sets the path)

NUMPY = importlib.util.find_spec("numpy") is not None
if NUMPY:
    import horch
    import judge_stiction

SAMPLES, LAG_S = 1500, 8.0


class Stem:
    """A valve stem with stiction. If the command differs from the stem position by more than `band`, the stem jumps
    to the command. Otherwise the stem does not move."""

    def __init__(self, band):
        self.band, self.at = band, 0.0

    def step(self, command):
        if abs(command - self.at) > self.band:
            self.at = command
        return self.at


def loop(seed, band=0.0, disturbance=0.0, gain=0.4, reset_s=6.0, noise=0.02):
    """Returns (command, reading) of a control loop: a proportional-integral controller on a first-order process with
    a sample time of 1 s."""
    draw, stem = random.Random(seed), Stem(band)
    process, integral, commands, readings = 0.5, 0.0, [], []
    period_s = draw.uniform(35, 60)
    for k in range(SAMPLES):
        outside = disturbance * math.sin(2 * math.pi * k / period_s)
        reading = process + outside + noise * draw.gauss(0, 1)
        integral += -reading / reset_s
        command = gain * (-reading + integral)
        process += (stem.step(command) - process) / LAG_S
        commands.append(command)
        readings.append(reading)
    return commands[200:], readings[200:]


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Phase(unittest.TestCase):
    def test_the_phase_ratio_of_sinusoids_is_the_phase_over_90_degrees(self):
        for degrees in (0, 20, 45, 70, 90):
            shift = math.radians(degrees)
            u = [math.sin(0.05 * k) for k in range(6283)]
            y = [-math.sin(0.05 * k + shift) for k in range(6283)]
            self.assertAlmostEqual(horch.phase_ratio(u, y), degrees / 90, delta=0.01)

    def test_at_least_18_of_20_sticking_valves_are_detected(self):
        verdicts = [horch.verdict(*loop(seed, band=0.3))[0] for seed in range(20)]
        self.assertGreaterEqual(verdicts.count("sticks"), 18)
        self.assertNotIn("free", verdicts)

    def test_an_oscillating_disturbance_is_not_reported_as_stiction(self):
        # The reset time of 20 s is more than twice the longest period divided by 2 pi. The integral part of the
        # controller therefore shifts the phase by less than 30 degrees.
        verdicts = [horch.verdict(*loop(seed, disturbance=0.5, reset_s=20))[0] for seed in range(20)]
        self.assertEqual(verdicts.count("sticks"), 0)
        self.assertGreaterEqual(verdicts.count("free"), 18)

    def test_the_phase_ratio_is_independent_of_scale_and_offset(self):
        u, y = loop(1, band=0.3)
        scaled = horch.phase_ratio([5 + 30 * value for value in u], [0.1 * value - 7 for value in y])
        self.assertAlmostEqual(horch.phase_ratio(u, y), scaled)

    def test_a_pulse_is_reported_free_and_a_constant_command_is_rejected(self):
        self.assertEqual(horch.verdict([0, 0, 1, 0, 0], [0, 0, 1, 0, 0])[0], "free")
        with self.assertRaises(ValueError):
            horch.verdict([1, 1, 1], [1, 2, 3])


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Answers(unittest.TestCase):
    def judged(self, named, alternatives=None, partial=()):
        found = judge_stiction.judged_names({"named": named, "alternatives": alternatives or [[] for _ in named],
                                             "partial": list(partial)})
        return [found[key] for key in ("stiction_named", "stiction_listed", "drift_named", "drift_alone")]

    def test_named_listed_and_partial_causes_are_counted_separately(self):
        self.assertEqual(self.judged(["valve_deadband"]), [True, True, False, False])
        self.assertEqual(self.judged(["sensor_drift"]), [False, False, True, True])
        self.assertEqual(self.judged(["sensor_drift"], [["ageing"]]), [False, False, True, False])
        self.assertEqual(self.judged(["sensor_drift", "outliers"]), [False, False, True, False])
        self.assertEqual(self.judged(["backlash"], [["valve_deadband"]]), [False, True, False, False])
        self.assertEqual(self.judged([], partial=["valve_deadband"]), [False, True, False, False])

    def test_the_summary_counts_sticking_and_other_loops_separately(self):
        def case(sticks, named, horch_verdict):
            return {"sticks": sticks, **judge_stiction.judged_names(
                {"named": named, "alternatives": [[] for _ in named], "partial": []}), "horch": horch_verdict}
        found = judge_stiction.summary([case(True, ["valve_deadband"], "sticks"), case(True, ["sensor_drift"], "free"),
                                        case(False, [], "sticks"), {"error": "x"}])
        self.assertEqual(found["sticking"], {"cases": 2, "stiction_named": 1, "stiction_listed": 1, "drift_named": 1,
                                             "drift_alone": 1, "horch": 1})
        self.assertEqual((found["others"]["cases"], found["others"]["horch"], found["failed"]), (1, 1, 1))
