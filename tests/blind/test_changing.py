#!/usr/bin/python3
"""Tests changing.judge(), which judges the diagnoses of fingers that have changed."""
import unittest

from changing import intervals, is_changed, judge


def diagnosis(named=(), rivals=None, verdict="cause_found"):
    return {"verdict": verdict, "causes": [{"id": i} for i in named], "alternatives": rivals or [[] for _ in named]}


class Judge(unittest.TestCase):
    def test_a_cause_named_for_an_unchanged_finger_is_a_false_alarm(self):
        self.assertEqual(judge("none", diagnosis(verdict="unchanged")), "unchanged")
        self.assertEqual(judge("none", diagnosis(verdict="unexplained")), "unexplained")
        self.assertEqual(judge("none", diagnosis(["leak"])), "false_alarm")

    def test_a_diagnosis_of_a_changed_finger_is_classified_by_its_causes(self):
        self.assertEqual(judge("leak", diagnosis(["leak"])), "first")
        self.assertEqual(judge("stiffening", diagnosis(["sensor_nonlinearity"])), "twin")
        self.assertEqual(judge("leak", diagnosis(["ageing", "leak"])), "listed")
        self.assertEqual(judge("leak", diagnosis(["ageing"], [["leak"]])), "listed")
        self.assertEqual(judge("leak", diagnosis(["ageing"])), "wrong")
        self.assertEqual(judge("leak", diagnosis(verdict="unchanged")), "missed")
        self.assertEqual(judge("leak", diagnosis(verdict="unexplained")), "unnamed")

    def test_a_cause_that_does_not_change_the_logs_is_no_change(self):
        self.assertFalse(is_changed({"recorded_change_mm": 0}))
        self.assertTrue(is_changed({"recorded_change_mm": 1e-6}))
        self.assertTrue(is_changed({}), "rows of earlier versions do not state the change")

    def test_intervals_are_compared_with_the_true_parameters(self):
        cause = {"id": "contact", "parameters": {"position_mm": {"value": 9.8, "ci95": [9.6, 10]}, "stiffening": {}}}
        truth = {"effects": {"contact": {"parameters": {"position_mm": 9.9, "stiffness_ratio": 3}}}}
        self.assertEqual([one["held"] for one in intervals("first", "contact", {"causes": [cause]}, truth)], [True])
        truth["effects"]["contact"]["parameters"]["position_mm"] = 10.1
        self.assertEqual([one["held"] for one in intervals("first", "contact", {"causes": [cause]}, truth)], [False])
        cause["parameters"]["position_mm"]["ci95"] = None
        self.assertEqual(intervals("first", "contact", {"causes": [cause]}, truth), [])
        self.assertEqual(intervals("first", "leak", {"causes": [cause]}, {"effects": {}}), [])


if __name__ == "__main__":
    unittest.main()
