"""Tests bench/other_kinds.py: the simulated rigs, their files and their labelled changes."""
import importlib.util
import unittest

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
        for name, (simulate, changes) in other_kinds.RIGS.items():
            def reading(seed, change=None):
                generator = np.random.default_rng(seed)
                return simulate(generator, 0, change)[2]
            for change in changes:
                self.assertGreater(np.std(reading(1, change) - reading(1)), 0.05 * np.std(reading(1)), (name, change))

    def test_the_gain_of_the_exchanger_is_negative(self):
        _, flow, temperature = other_kinds.exchanger(np.random.default_rng(1), 0)
        self.assertLess(np.corrcoef(flow[:-60], temperature[60:])[0, 1], -0.5)


if __name__ == "__main__":
    unittest.main()
