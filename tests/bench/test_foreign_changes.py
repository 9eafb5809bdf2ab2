"""Tests bench/foreign/judge_changes.py: how the program judges a diagnosis of a change, and how it computes the spread
between runs."""
import importlib.util
import random
import unittest

from foreign_case import ForeignCase  # noqa: F401  (sets the path)

SCIPY = importlib.util.find_spec("scipy") is not None
if SCIPY:
    import judge_changes
    from set_table import Pair


def names(named=(), alternatives=None):
    return {"named": list(named), "alternatives": alternatives or [[] for _ in named]}


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Answers(unittest.TestCase):
    PAIR = None

    def judged(self, named=(), alternatives=None):
        pair = Pair("a -> b", ["a"], "b", "", label="a weight", causes=("payload", "contact"))
        found = judge_changes.judged_label(pair, names(named, alternatives), True)
        return found["named_correctly"], found["listed"], found["wrong_alone"]

    def test_a_diagnosis_is_judged_by_its_named_and_listed_causes(self):
        self.assertEqual(self.judged(["contact"]), (True, True, False))
        self.assertEqual(self.judged(["sensor_drift", "payload"]), (True, True, False))
        self.assertEqual(self.judged(["sensor_drift"], [["contact"]]), (False, True, False))
        self.assertEqual(self.judged(["sensor_drift"], [["leak"]]), (False, False, True))
        self.assertEqual(self.judged(), (False, False, False))

    def test_summaries_count_cases_and_failures(self):
        def repeat(changed, named, runs, group="runs"):
            return {"group": group, "changed": changed, "named": named, "baseline_runs": runs}
        found = judge_changes.summary_of_repeats([repeat(True, ["sensor_drift"], 1), repeat(False, [], 1),
                                                  repeat(True, [], 3), {"group": "runs", "error": "x"},
                                                  repeat(True, ["leak"], 1, "halves")])
        self.assertEqual(found["runs"], {"cases": 3, "failed": 1, "changed": 2, "sensor_drift": 1,
                                         "by_runs": {"1": {"cases": 2, "changed": 1}, "3": {"cases": 1, "changed": 1}}})
        self.assertEqual(found["halves"]["changed"], 1)

        def change(exceeds, changed, listed, wrong):
            return {"exceeds_spread": exceeds, "changed": changed, "listed": listed, "wrong_alone": wrong}
        found = judge_changes.summary_of_changes([change(True, True, True, False), change(True, False, False, False),
                                                  change(False, True, False, True), change(False, False, False, False),
                                                  change(None, True, True, False), {"error": "x"}])
        self.assertEqual(found, {"cases": 5, "failed": 1, "beyond_spread": 2, "detected": 1, "named_or_listed": 1,
                                 "within_spread": 2, "within_reported_unchanged": 1, "wrong_alone": 1,
                                 "changed": 3, "listed": 2})


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Spread(unittest.TestCase):
    def test_one_or_no_healthy_run_gives_no_bound(self):
        self.assertIsNone(judge_changes.healthy_bound([1.0]))
        self.assertIsNone(judge_changes.healthy_bound([]))

    def test_the_bound_of_equal_errors_is_that_error(self):
        self.assertAlmostEqual(judge_changes.healthy_bound([2.0, 2.0, 2.0]), 2.0)

    def test_a_new_healthy_run_is_below_the_bound_in_95_percent_of_cases(self):
        draw = random.Random(1)
        for runs in (2, 3, 6):
            below = 0
            for _ in range(4000):
                errors = [draw.gauss(1, 0.05) for _ in range(runs + 1)]
                below += errors[-1] < judge_changes.healthy_bound(errors[:-1])
            self.assertAlmostEqual(below / 4000, 0.95, delta=0.015)
