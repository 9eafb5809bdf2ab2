"""Tests the feedforward `full_model` of a rig with a low rate."""

import math
import re

import bench

SINE = """name: fast_sine
about: a sine of 1 Hz
steps:
  - move: {displacement_mm: 14.4, speed_mm_per_s: 5, settle_s: 3}
  - track: {mean_mm: 20, amplitude_mm: 5.6, frequency_hz: 1.0, cycles: 10}
  - release: {duration_s: 2, purge_s: 1, timeout_s: 10, on_fail: vent}
"""


class LowRate(bench.BenchTest):
    """Runs config/rig.yaml without its object in virtual time."""

    def tracking_rmse_mm(self, rate_hz):
        text = (self.folder / "config/rig.yaml").read_text()
        for pattern, replacement in ((r"rate_hz: 200", f"rate_hz: {rate_hz}"), (r" *object: .*\n", ""),
                                     (r"watchdog_timeout_s: 0.5", "watchdog_timeout_s: 3"), (r"max_age_s: 0.05", "max_age_s: 0.6"),
                                     (r"pressure_max_kpa: 60", "pressure_max_kpa: 90"),
                                     (r"kp_kpa_per_mm: 2.7", "kp_kpa_per_mm: 0.1"), (r"ki_kpa_per_mm_s: 13", "ki_kpa_per_mm_s: 0.2")):
            text, count = re.subn(pattern, replacement, text)
            self.assertGreater(count, 0, pattern)
        rig, sine = self.write(f"config/rig_{rate_hz}.yaml", text), self.write("fast_sine.yaml", SINE)
        self.softgrip("run", sine, "--rig", rig, "--virtual-time", "--record", f"r{rate_hz}", "--quiet", "--no-socket")
        rows = [row for row in self.rows(self.folder / f"r{rate_hz}", "left") if row["step"] == "1"]
        self.assertGreater(len(rows), 9 * rate_hz)
        squares = [(float(row["reference_mm"]) - float(row["displacement_mm"])) ** 2 for row in rows]
        return math.sqrt(sum(squares) / len(squares))

    def test_a_fast_sine_is_tracked_at_20_hz(self):
        slow, usual = self.tracking_rmse_mm(20), self.tracking_rmse_mm(200)
        print(f"20 Hz: {slow:.3f} mm, 200 Hz: {usual:.3f} mm")
        self.assertLess(usual, 0.2)
        self.assertLess(slow, 1.2)


if __name__ == "__main__":
    bench.main()
