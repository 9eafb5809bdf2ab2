"""Tests bench/other_loops.py: the models of sticking valves, the control loops, the historian, the outcomes and the page."""
import importlib.util
import json
import unittest

from foreign_case import BENCH, ForeignCase

NUMPY = importlib.util.find_spec("numpy") is not None
if NUMPY:
    import sys
    sys.path.append(str(BENCH / "other_loops"))
    import numpy as np
    import loop_judge
    import loop_kinds
    import loop_loads
    import loop_page
    import loop_parts
    import loop_valves
    import set_table

BAND, JUMP = 4.0, 1.0


def triangle(amplitude=10.0, scans=400, periods=3):
    return np.concatenate([np.r_[np.linspace(50, 50 + amplitude, scans), np.linspace(50 + amplitude, 50 - amplitude, 2 * scans),
                                 np.linspace(50 - amplitude, 50, scans)]] * periods)


def case_with(outcome, sticks=True, visible=True, horch="sticks", drift=False):
    return {"half": "first", "loop": "stick_he_1" if sticks else "other_sine_1", "kind": "he" if sticks else "sine",
            "sticks": sticks, "visible": visible, "model": "he", "process": "flow", "band": 2.0, "jump": 0.0, "share": 0.3,
            "effect_to_noise": 5.0, "rests": 4, "interval_s": 10.0, "samples": 751, "historian": "none", "outcome": outcome,
            "horch": horch, "drift_alone": drift, "verdict": "cause_found", "named": ["valve_deadband"],
            "alternatives": [[]], "sizes": [None], "wall_s": 3.0}


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Valves(unittest.TestCase):
    def test_every_model_rests_for_the_band_after_a_reversal_and_then_jumps(self):
        for name, model in loop_valves.STICKING.items():
            valve, command = model(50.0, BAND, JUMP), triangle()
            stem = np.array([valve.step(float(value), 0.5) for value in command])
            top = np.argmax(command)  # first reversal
            rest = np.flatnonzero(np.abs(np.diff(stem[top:])) > 1e-3)[0] + top
            within = JUMP if name in ("he", "karnopp") else 0.0  # the reversal can begin during a smaller rest
            self.assertTrue(BAND - 0.15 < command[top] - command[rest] < BAND + within + 0.15, name)
            self.assertAlmostEqual(stem[top] - stem[rest + 1], JUMP, delta=0.25, msg=name)
            self.assertAlmostEqual(np.max(np.abs(stem - command)[top:]), (BAND + JUMP) / 2, delta=0.2, msg=name)

    def test_without_jump_the_models_of_kano_and_he_are_a_deadband(self):
        command = triangle()
        stems = [[valve.step(float(value), 0.5) for value in command]
                 for valve in (loop_valves.Kano(50.0, BAND, 0.0), loop_valves.He(50.0, BAND, 0.0))]
        np.testing.assert_allclose(stems[0][800:], stems[1][800:], atol=0.06)

    def test_an_equal_percentage_valve_has_the_flow_and_gain_of_a_linear_valve_in_the_middle(self):
        self.assertAlmostEqual(loop_valves.equal_percentage(50.0), 50.0)
        self.assertAlmostEqual(loop_valves.equal_percentage(50.1) - 50.0, 0.1, 3)
        self.assertGreater(loop_valves.equal_percentage(80.0) - loop_valves.equal_percentage(79.0), 3)


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Loops(unittest.TestCase):
    def loop(self, process, margin, valve=None):
        plant = loop_parts.drawn(loop_parts.PROCESSES[process], np.random.default_rng(1))
        gain, integral_s = loop_parts.gains(plant, margin)
        setpoint = np.full(4000, 50.0)
        setpoint[5:] = 52.0
        return loop_parts.Loop(plant, valve or loop_valves.Free(50.0), gain, integral_s, setpoint, np.zeros(4000), np.zeros(4000))

    def test_a_gain_margin_of_4_is_stable_and_of_0_6_is_not(self):
        for process in loop_parts.PROCESSES:
            value = loop_parts.simulated([self.loop(process, 4.0)])[1]
            self.assertAlmostEqual(value[-1], 52.0, delta=0.01, msg=process)
            value = loop_parts.simulated([self.loop(process, 0.6)])[1]
            self.assertGreater(np.ptp(value[-2000:]), 0.5, process)

    def test_a_sticking_valve_with_jump_causes_a_lasting_oscillation(self):
        value = loop_parts.simulated([self.loop("flow", 5.0, loop_valves.He(50.0, 3.0, 1.5))])[1]
        self.assertGreater(np.ptp(value[-2000:]), 0.5)

    def test_the_output_stays_within_its_limits_and_recovers(self):
        loop = self.loop("flow", 4.0)
        loop.load = np.r_[np.full(2000, 70.0), np.zeros(2000)]
        command, value = loop_parts.simulated([loop])[:2]
        self.assertEqual(command[1900], 0.0)
        self.assertAlmostEqual(value[2200], 52.0, delta=0.1)

    def test_the_historian_stores_exceptions_only(self):
        values = np.array([0, 0.1, 0.2, 1.0, 1.1, 1.0])
        np.testing.assert_allclose(loop_parts.compressed(values, 0.5, False), [0, 0, 0, 1, 1, 1])
        np.testing.assert_allclose(loop_parts.compressed(values, 0.5, True), [0, 1 / 3, 2 / 3, 1, 1, 1])

    def test_a_random_walk_stays_within_its_limit(self):
        walk = loop_loads.walk(20000, np.random.default_rng(2), 1.0)
        self.assertLessEqual(np.abs(walk).max(), 30.0)
        self.assertLess(np.abs(np.diff(walk)).max(), 6.0)


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Files(ForeignCase):
    def test_the_plan_has_distinct_names_and_all_kinds_in_each_half(self):
        for half in loop_kinds.HALVES:
            plan = loop_kinds.planned(half)
            self.assertEqual(len(set(plan)), len(plan))
            self.assertEqual(len(plan), 12 * 4 + 3 * 14)

    def test_equal_arguments_give_equal_signals_and_the_halves_differ(self):
        one, again, other = (loop_kinds.built(half, "he", 2, True) for half in ("first", "first", "second"))
        for name, values in one.columns.items():
            np.testing.assert_array_equal(values, again.columns[name])
        self.assertNotEqual(one.facts["band"], other.facts["band"])

    def test_a_written_half_is_read_with_its_labels(self):
        plan = [("first", "he", 2, True), ("first", "quiet", 1, False)]
        loop_judge.write_half("first", self.data, plan)
        found = set_table.read_set(self.data / "foreign.yaml", self.data)
        self.assertEqual({loop.log: loop.sticks for loop in found.loops}, {"stick_he_3": True, "other_quiet_2": False})
        self.assertEqual([loop.problems for loop in found.loops], [[], []])
        labels = json.loads((self.data / "labels.json").read_text())
        self.assertEqual(labels["stick_he_3"]["model"], "he")
        columns = np.genfromtxt(self.data / "stick_he_3.csv", delimiter=",", names=True)
        self.assertAlmostEqual(np.ptp(columns["displacement_mm"]), np.ptp(columns["pressure_command_kpa"]), 6)
        self.assertEqual(columns["pressure_command_kpa"].min(), 0)

    def test_the_counts_separate_visible_and_hidden_effects(self):
        cases = [case_with("named"), case_with("listed"), case_with("not", visible=False), case_with("not", False),
                 case_with("named", False, horch="free"), case_with("failed")]
        rows = {text: (count, total) for text, count, total in loop_judge.counts(cases)}
        self.assertEqual(rows["sticking valves with a visible effect: `valve_deadband` named"], (1, 3))
        self.assertEqual(rows["sticking valves with a visible effect: `valve_deadband` named or listed"], (2, 3))
        self.assertEqual(rows["sticking valves without a visible effect: `valve_deadband` named"], (0, 1))
        self.assertEqual(rows["other loops: `valve_deadband` named"], (1, 2))
        self.assertEqual(rows["other loops without an error: reported as sticking by Horch's phase test"], (1, 2))
        self.assertEqual(rows["sticking valves with a visible effect: softgrip reported an error"], (1, 3))

    def test_the_page_contains_the_summary_and_every_case(self):
        page = self.folder / "page.md"
        cases = [case_with("named"), case_with("not", False, horch="free")]
        loop_page.write(page, {"version": "softgrip 0.2.0+x", "began": "2026-11-29T00:00:00Z", "halves": ["first"],
                               "at_most_s": 60, "cases": cases}, "bench/other_loops.py --out DIR --page")
        text = page.read_text()
        self.assertIn("stiction is named for 1 of 1 sticking valves whose effect is visible, and for 0 of 1 other loops", text)
        self.assertIn("| other loops: `valve_deadband` named | 0 of 1: 0.0 %", text)
        self.assertEqual(text.count("| stick_he_1 | flow |"), 1)


@unittest.skipUnless(NUMPY, "python3-numpy is not installed")
class Visibility(unittest.TestCase):
    def test_a_stem_that_follows_has_no_visible_effect_and_a_resting_one_has(self):
        made = loop_kinds.Record("flow", 600, 2, 1.0, 100.0, 0.1)
        plant = loop_parts.Plant((1.0,), 0.0, 0.0, 0.5)
        command = np.concatenate([triangle(scans=150, periods=4)] * 2)[:made.scans]
        self.assertEqual(loop_kinds.visibility(plant, command, command, made, 0.1, 2.0), (0.0, 0))
        valve = loop_valves.He(50.0, 4.0, 4.0)
        stem = np.array([valve.step(float(value), 0.5) for value in command])
        ratio, rests = loop_kinds.visibility(plant, command, stem, made, 0.1, 4.0)
        self.assertGreater(ratio, 4)
        self.assertGreaterEqual(rests, 2)


if __name__ == "__main__":
    unittest.main()
