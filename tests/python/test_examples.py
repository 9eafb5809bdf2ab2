"""The examples in examples/python, one file each, run and have at most 80 lines."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
EXAMPLES = SOURCE / "examples/python"
MODEL = SOURCE / "config/models/bench_twin.yaml"


class Examples(unittest.TestCase):
    ran = {"nightly_health.py"}  # in test_health.py

    def run_example(self, name, *arguments):
        done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.ran.add(name)
        return done.stdout

    def test_all(self):
        with tempfile.TemporaryDirectory() as folder:
            at = pathlib.Path(folder)
            self.assertIn("bench_twin: 0.00 to", self.run_example("simulate_finger.py", MODEL, at / "log.csv"))
            self.assertTrue((at / "log.csv").read_text().startswith("time_s,pressure_command_kpa,displacement_mm"))
            self.assertRegex(self.run_example("invert_finger.py", MODEL), r"largest error \d\.\de-0[4-9] mm")
            for name, seed in (("one", 1), ("two", 2)):
                subprocess.run([BUILD / "tools/softgrip", "simulate", "--model", MODEL, "--input", "tp1", "--rate-hz", "20",
                                "--noise-mm", "0.05", "--seed", str(seed), "--out", at / f"{name}.csv"], check=True,
                               capture_output=True)
            rows = [line.split(",") for line in (at / "one.csv").read_text().splitlines()[1:]]
            (at / "other.csv").write_text("Time [s];Pressure setpoint [bar];Displacement [mm]\n" + "".join(
                f"{t};{float(p) / 100};{y}\n" for t, p, y in rows))
            self.assertIn("transport_delay: delay_s", self.run_example("diagnose_csv.py", at / "other.csv", at / "r.html"))
            self.assertIn("<html", (at / "r.html").read_text())
            self.assertIn("parameters differ", self.run_example("compare_fingers.py", at / "one.csv", at / "two.csv"))
            lines = self.run_example("many_logs.py", at / "one.csv", at / "two.csv", at / "none.csv").splitlines()
            self.assertEqual([": RMSE 0.0" in line for line in lines], [True, True, False])
            self.assertRegex(self.run_example("closed_loop.py", MODEL), r"RMSE of the last cycle: 0\.0\d+ mm")
            self.assertIn("20.0 kPa: valid, 4.0 mm", self.run_example("board_driver.py"))
        self.assertEqual(self.ran, {path.name for path in EXAMPLES.glob("*.py")})

    def test_lines(self):
        for path in EXAMPLES.glob("*.py"):
            self.assertLessEqual(len(path.read_text().splitlines()), 80, path.name)


if __name__ == "__main__":
    unittest.main()
