"""Tests bench/other_rigs.py: the simulated rigs, their run-to-run variation, their labelled changes, the outcomes and the
page."""
import importlib.util
import types
import unittest

from foreign_case import BENCH, ForeignCase

SCIPY = importlib.util.find_spec("scipy") is not None
if SCIPY:
    import sys
    sys.path.append(str(BENCH / "other_rigs"))
    import numpy as np
    import rig_elements
    import rig_files
    import rig_judge
    import rig_page
    import rig_runs
    import set_table

FAST = ("pneunet", "soft_arm", "dielectric", "control_valve")
LENGTH_S = 20.0


def case_with(outcome="named", group="change", named=(), admissible=("contact",), healthy=3):
    return {"rig": "pneunet", "log": "change_contact", "healthy": healthy, "group": group, "cause": "contact",
            "admissible": list(admissible), "text": "object", "ratio": 17.0, "verdict": "cause_found", "named": list(named),
            "alternatives": [[] for _ in named], "sizes": [None for _ in named], "outcome": outcome}


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Rigs(ForeignCase):
    def test_labels_are_causes_and_every_rig_has_distinct_changes(self):
        self.assertGreaterEqual(len(rig_files.RIGS), 16)
        for rig in rig_files.RIGS.values():
            causes = [change.cause for change in rig.changes]
            self.assertEqual(len(set(causes)), 5, rig.name)
            for change in rig.changes:
                self.assertLessEqual({change.cause, *change.also}, set(set_table.CAUSES), rig.name)
                self.assertNotIn(change.cause, change.also)

    def test_a_leak_is_only_simulated_with_a_measured_pressure(self):
        for rig in rig_files.RIGS.values():
            if "leak" in [change.cause for change in rig.changes]:
                self.assertGreater(rig.pressure_noise_kpa, 0, rig.name)

    def test_sizes_of_the_logs_are_within_their_limits(self):
        for rig in rig_files.RIGS.values():
            self.assertLessEqual(rig.length_s / rig.step_s, 12000, rig.name)
            self.assertTrue(60 <= rig.length_s <= 180 and 0.005 <= rig.step_s <= 0.1, rig.name)

    def test_equal_seeds_give_equal_files_that_the_reader_of_the_tables_accepts(self):
        rig = rig_files.RIGS["control_valve"]
        rows = [rig_files.write_rig(rig, out, LENGTH_S) for out in (self.data, self.folder / "again")]
        self.assertEqual(rows[0], rows[1])
        files = sorted(path.name for path in (self.data / rig.name).iterdir())
        self.assertEqual(len(files), 6 + 2 + 1 + 5 + 1)
        for name in files:
            self.assertEqual((self.data / rig.name / name).read_bytes(),
                             (self.folder / "again" / rig.name / name).read_bytes())
        found = set_table.read_set(self.data / rig.name / "foreign.yaml", self.data / rig.name)
        self.assertEqual([pair.problems for pair in found.repeats + found.changes], [[]] * 8)
        self.assertEqual([pair.group for pair in found.repeats], ["same", "same", "other"])
        rig_files.write_labels(self.folder / "labels.csv", rows[0])
        self.assertEqual(len((self.folder / "labels.csv").read_text().splitlines()), 15)

    def test_runs_of_a_healthy_rig_differ_in_input_and_conditions(self):
        for name in FAST:
            rig = rig_files.RIGS[name]
            one, two = (rig_runs.run_columns(rig, number, rig.family, None, LENGTH_S) for number in (0, 1))
            for column in one:
                self.assertFalse(np.array_equal(one[column], two[column]), (name, column))
            self.assertTrue((np.diff(one["time_s"]) > 0).all())

    def test_the_standard_deviations_of_the_conditions_are_those_of_the_page(self):
        runs = [rig_runs.varied(np.random.default_rng(seed)) for seed in range(2000)]
        for values, deviation in (([run.gain for run in runs], 0.01), ([run.offset for run in runs], 0.003),
                                  ([run.supply for run in runs], 0.01), ([run.warmer_k for run in runs], 2.0)):
            self.assertAlmostEqual(np.std(values) / deviation, 1, delta=0.06)
        self.assertIn("gain 1 %, offset 0.3 % of the span, temperature 2 K", rig_page.variation_text())

    def test_every_change_is_at_least_4_times_the_difference_between_runs(self):
        """The slow rigs are tested by the program itself, which writes the ratios to labels.csv."""
        for name in FAST:
            spread, ratios = rig_runs.ratios(rig_files.RIGS[name])
            self.assertTrue(0.003 < spread < 0.02, name)
            self.assertGreaterEqual(min(ratios.values()), 4.0, (name, ratios))


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Elements(unittest.TestCase):
    def test_an_oscillator_and_a_lag_reach_their_input(self):
        step = np.r_[np.zeros(10), np.ones(4000)]
        for response in (rig_elements.lag(step, 0.01, 0.5), rig_elements.second_order(step, 0.01, 1.0, 0.2)):
            self.assertEqual(response[5], 0)
            self.assertAlmostEqual(response[-1], 1, 6)
        self.assertAlmostEqual(rig_elements.second_order(step, 0.01, 1.0, 0.2).max(), 1.53, delta=0.02)

    def test_a_signal_that_does_not_begin_at_0_has_no_transient(self):
        constant = np.full(50, 7.0)
        for response in (rig_elements.lag(constant, 0.01, 0.5), rig_elements.second_order(constant, 0.01, 1.0, 0.2),
                         rig_elements.memory(constant, np.linspace(1, 2, 50)), rig_elements.stiction(constant, 1, 0.5)):
            np.testing.assert_allclose(response, 7.0, rtol=1e-9)

    def test_dahl_friction_reaches_its_force_and_a_preisach_model_remembers(self):
        friction = rig_elements.dahl(np.r_[np.linspace(0, 10, 500), np.linspace(10, 0, 500)], 2.0, 4.0)
        self.assertAlmostEqual(friction[499], 2.0, 3)
        self.assertAlmostEqual(friction[-1], -2.0, 3)
        output = rig_elements.preisach(np.array([0.0, 1.0, 0.5, 0.0, 0.5]))
        self.assertGreater(output[2], output[4] + 0.3)

    def test_a_sticking_valve_remains_and_then_jumps(self):
        position = rig_elements.stiction(np.linspace(0, 3, 301), 1.0, 0.4)
        self.assertEqual(position[99], 0)
        self.assertAlmostEqual(position[102], 0.41, delta=0.02)


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class Outcomes(ForeignCase):
    def outcome(self, verdict, named=(), alternatives=(), label="object", causes=("contact",)):
        pair = types.SimpleNamespace(label=label, causes=causes)
        return rig_judge.outcome_of(pair, {"verdict": verdict, "named": list(named), "alternatives": list(alternatives)})

    def test_each_outcome(self):
        self.assertEqual(self.outcome("unchanged", label=""), "correct")
        self.assertEqual(self.outcome("unexplained", label=""), "false alarm")
        self.assertEqual(self.outcome("unchanged"), "missed")
        self.assertEqual(self.outcome("unexplained"), "unnamed")
        self.assertEqual(self.outcome("cause_found", ["contact"], [[]]), "named")
        self.assertEqual(self.outcome("ambiguous", ["ageing"], [["contact"]]), "listed")
        self.assertEqual(self.outcome("cause_found", ["ageing"], [[]]), "wrong")

    def test_counts_of_the_summary(self):
        cases = [case_with("named", named=["contact"]), case_with("named", named=["contact", "leak"]),
                 case_with("wrong", named=["leak"]), case_with("missed"), case_with("failed"),
                 case_with("false alarm", "same"), case_with("correct", "other")]
        self.assertEqual([row[1:] for row in rig_judge.counts(cases)],
                         [(1, 1), (0, 1), (3, 4), (2, 4), (2, 4), (1, 4), (0, 4), (1, 4)])

    def test_the_page_contains_the_summary_and_every_case(self):
        cases = [case_with("named", named=["contact"]), case_with("false alarm", "same", ["leak"], ()),
                 case_with("correct", "other")]
        page = self.folder / "page.md"
        rig_page.write(page, {"version": "softgrip 0.2.0+x", "began": "2026-11-28T00:00:00Z", "healthy": [3], "cases": cases,
                              "rigs": [{"rig": "pneunet", "spread_percent": 0.66}]}, "bench/other_rigs.py --out DIR --page")
        text = page.read_text()
        self.assertIn("1 of 2 repeats without a change are reported as changed", text)
        self.assertIn("| changes: detected | 1 of 1: 100.0 % (20.7 .. 100.0) |", text)
        self.assertEqual(text.count("| pneunet | change_contact |"), 3)


if __name__ == "__main__":
    unittest.main()
