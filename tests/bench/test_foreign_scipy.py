"""Tests bench/foreign/scipy_bouc_wen.py on a log whose model is known. Needs scipy."""
import importlib.util
import json
import math
import subprocess
import sys
import unittest

from foreign_case import BENCH, ForeignCase

SAMPLES = 600


def relaxed(pressures, share):
    """Returns the readings of a system with an offset of 3 mm, a gain of 0.2 mm/kPa, and creep. The creep pressure
    approaches `share` times the pressure with a time constant of 2 s."""
    creep, readings = 0.0, []
    for p in pressures:
        creep += (share * p - creep) * 0.05 / 2
        readings.append(3 + 0.2 * p + 0.2 * creep)
    return readings


@unittest.skipUnless(importlib.util.find_spec("scipy"), "python3-scipy is not installed")
class Scipy(ForeignCase):
    def test_a_system_with_creep_is_fitted_and_its_held_out_part_predicted(self):
        pressures = [30 - 20 * math.cos(0.04 * i) - 10 * math.cos(0.1 * i) for i in range(SAMPLES)]
        rows = [f"{0.05 * i},{p},{'' if i % 50 == 7 else y}"
                for i, (p, y) in enumerate(zip(pressures, relaxed(pressures, 0.5)))]
        log, library = self.folder / "log.csv", self.folder / "simulator.so"
        log.write_text("\n".join(["time_s,pressure_command_kpa,displacement_mm", *rows]) + "\n")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, BENCH / "sysid_peer_simulator.c", "-lm"],
                       check=True)
        run = subprocess.run([sys.executable, BENCH / "foreign/scipy_bouc_wen.py", log, "0.5", library],
                             check=True, capture_output=True, text=True)
        answer = json.loads(run.stdout)
        self.assertLess(answer["fitted_mm"], 0.01)
        self.assertLess(answer["held_out_mm"], 0.05)
