"""Tests bench/other_kinds.py: the simulated rigs, their files and their labelled changes."""
import importlib.util
import unittest
from unittest import mock

from foreign_case import ForeignCase

SCIPY = importlib.util.find_spec("scipy") is not None
if SCIPY:
    import numpy as np
    import other_kinds
    import set_table


@unittest.skipUnless(SCIPY, "python3-scipy is not installed")
class OtherKinds(ForeignCase):
    def test_descriptions_are_accepted_and_equal_seeds_give_equal_files(self):
        for name in other_kinds.RIGS:
            for out in (self.data, self.folder / "again"):
                other_kinds.write_rig(name, out)
            for path in (self.data / name).iterdir():
                self.assertEqual(path.read_bytes(), (self.folder / "again" / name / path.name).read_bytes())
            found = set_table.read_set(self.data / name / "foreign.yaml", self.data / name)
            self.assertEqual([pair.problems for pair in found.repeats + found.changes],
                             [[]] * (3 + len(other_kinds.RIGS[name][1])))

    def test_a_change_exceeds_the_variation_of_the_runs(self):
        """All readings have the same input and noise. The healthy runs differ in gain, offset and initial state."""
        variation = other_kinds.variation
        for name, (simulate, changes) in other_kinds.RIGS.items():
            def reading(change=None, run=1):
                varied = variation(np.random.default_rng(run))
                with mock.patch.object(other_kinds, "variation", lambda rng: (variation(rng), varied)[1]):
                    return simulate(np.random.default_rng(1), 0, change)[2]

            def effect(**given):
                return np.sqrt(np.mean((reading(**given) - reading()) ** 2))
            for change in changes:
                self.assertGreater(effect(change=change), 2 * max(effect(run=run) for run in range(2, 22)), (name, change))

    def test_the_drives_oscillate_with_the_frequency_of_the_belt(self):
        with mock.patch.object(other_kinds, "binary", lambda time_s, *_: 0.5 + 0.5 * (time_s >= 1)):
            time_s, _, speed = other_kinds.drives(np.random.default_rng(1), 0)
        first = np.argmax(speed)
        second = first + 20 + np.argmax(speed[first + 20:first + 50])
        self.assertAlmostEqual(2 * np.pi / (time_s[second] - time_s[first]), 9.0, delta=1.0)

    def test_the_dryer_warms_when_its_heater_is_switched_on(self):
        with mock.patch.object(other_kinds, "binary", lambda time_s, *_: 1.0 * (time_s >= 40)):
            time_s, _, temperature = other_kinds.dryer(np.random.default_rng(1), 0)
        self.assertLess(abs(temperature[time_s < 40.24].max() - 4), 0.2)
        self.assertGreater(temperature[time_s > 42].mean(), 6)

    def test_the_gain_of_the_exchanger_is_negative(self):
        _, flow, temperature = other_kinds.exchanger(np.random.default_rng(1), 0)
        self.assertLess(np.corrcoef(flow[:-60], temperature[60:])[0, 1], -0.5)


if __name__ == "__main__":
    unittest.main()
