#!/usr/bin/python3
"""Tests trial.judge(), which judges the diagnosis of a textbook world."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import trial  # noqa: E402

OWN = {"valve_lag": 0.1, "slow_creep": 0.1, "stiffening": 0.1}


def judged(hidden, *sets, verdict="cause_found"):
    return trial.judge(hidden, OWN, {"verdict": verdict, "causes": [{"id": one[0]} for one in sets],
                                     "alternatives": [list(one[1:]) for one in sets]})


class Judge(unittest.TestCase):
    def test_own_physics_is_neither_found_nor_wrong(self):
        result = judged([], ["valve_lag"], ["sensor_nonlinearity", "stiffening"])
        self.assertEqual(result, {"found": [], "alone": [], "wrong": [], "outcome": "right"})
        self.assertEqual(judged(["contact"], ["valve_lag"])["outcome"], "missed")

    def test_an_unsupported_cause_is_wrong_even_beside_a_correct_cause(self):
        result = judged(["contact"], ["contact"], ["inertia", "sensor_lag"])
        self.assertEqual(result, {"found": ["contact"], "alone": ["contact"], "wrong": ["inertia"], "outcome": "wrong"})
        self.assertEqual(judged([], ["contact"])["outcome"], "wrong")

    def test_an_alternative_is_found_but_not_alone(self):
        result = judged(["contact"], ["sensor_saturation", "contact"], verdict="ambiguous")
        self.assertEqual((result["found"], result["alone"], result["outcome"]), (["contact"], [], "ambiguous_right"))

    def test_a_named_cause_counts_for_at_most_one_hidden_cause(self):
        result = judged(["contact", "sensor_saturation"], ["contact", "sensor_saturation"])
        self.assertEqual((len(result["found"]), result["outcome"]), (1, "partly"))
        result = judged(["contact", "sensor_saturation"], ["contact", "sensor_saturation"], ["contact"])
        self.assertEqual(sorted(result["found"]), ["contact", "sensor_saturation"])

    def test_a_partly_explained_verdict_that_names_all_causes_is_right(self):
        result = judged(["contact", "backlash"], ["backlash"], ["contact"], ["slow_creep"], verdict="partly_explained")
        self.assertEqual(result["outcome"], "right")

    def test_a_hidden_cause_that_is_own_physics_too_counts_as_found(self):
        self.assertEqual(judged(["valve_lag"], ["valve_lag"])["outcome"], "right")

    def test_an_unexplained_verdict_has_a_separate_outcome(self):
        self.assertEqual(judged([], verdict="unexplained")["outcome"], "unexplained")
        self.assertEqual(judged([], verdict="adequate")["outcome"], "right")


if __name__ == "__main__":
    unittest.main()
