"""Tests bench/foreign/insert_effects.py, which adds simulated effects to the readings of real runs. Also tests the
data set that the program writes."""
import unittest

import numpy as np
from foreign_case import ForeignCase

import insert_effects
import set_table
from log_reading import Log

TABLE = """\
title: A finger
source: a laboratory
licence: MIT
same: {time: t_s, command: u_kpa, displacement: y_mm}
logs: [{file: a.csv}, {file: b.csv}, {file: c.csv}]
repeats:
- {baseline: a, later: c, because: same day}
- {baseline: [a, b], later: c, because: same day}
- {baseline: a, later: b, because: pulses, group: pulses}
"""


def log_of(readings):
    return Log([0.1 * i for i in range(len(readings))], {"displacement": readings}, [], [])


class Inserted(ForeignCase):
    def readings_with(self, effect, readings):
        return insert_effects.inserted(log_of(readings), effect)["displacement"]

    def test_each_effect_changes_readings_by_4_to_60_percent_of_the_stroke(self):
        readings = list(5 + 10 * np.sin(np.linspace(0, 12, 400)) ** 2)
        for effect in insert_effects.EFFECTS:
            with self.subTest(effect):
                change = np.abs(self.readings_with(effect, readings) - readings)
                self.assertGreater(change.max(), 0.4)
                self.assertLess(change.max(), 6)
        self.assertEqual(len(insert_effects.EFFECTS), 9)

    def test_a_contact_changes_only_readings_beyond_its_position(self):
        readings = np.linspace(2, 12, 101)
        changed = self.readings_with("contact", list(readings))
        np.testing.assert_allclose(changed[:60], readings[:60])
        self.assertAlmostEqual(changed[-1], 2 + 6 + 0.25 * 4)

    def test_a_missing_reading_is_interpolated_linearly(self):
        changed = self.readings_with("gain", [0.0, float("nan"), 2.0, 4.0])
        np.testing.assert_allclose(changed, [0, 0.85, 1.7, 3.4])

    def test_a_delay_shifts_pressure_and_displacement_equally(self):
        log = log_of(list(np.arange(50.0)))
        log.columns["pressure"] = list(np.arange(50.0))
        changed = insert_effects.inserted(log, "delay")
        np.testing.assert_allclose(changed["pressure"], changed["displacement"])
        self.assertAlmostEqual(changed["pressure"][20], 17.5)

    def test_the_written_set_uses_the_repeat_with_the_most_baseline_runs(self):
        for name in "abc":
            self.put_plain(f"{name}.csv")
        (self.data / set_table.OWN_TABLE).write_text(TABLE)
        found = set_table.read_set(self.data / set_table.OWN_TABLE, self.data)
        folder = self.folder / "finger_inserted"
        insert_effects.write_set(found, insert_effects.chosen(found.repeats), folder)
        made = set_table.read_set(folder / set_table.OWN_TABLE, folder)
        self.assertEqual(len(made.changes), len(insert_effects.EFFECTS))
        self.assertEqual([pair.baseline for pair in made.changes], [["a", "b"]] * len(made.changes))
        self.assertEqual([problem for pair in made.changes for problem in pair.problems], [])
        self.assertEqual(made.fits, [])
        self.assertEqual((folder / "a.csv").read_text().splitlines()[1], "0,0,0")
        pulses = insert_effects.chosen(found.repeats, pulses=True)
        self.assertEqual([(pair.baseline, pair.later) for pair in pulses], [(["a"], "b")])


if __name__ == "__main__":
    unittest.main()
