"""Tests softgrip investigate with an experiment that the rig cannot carry out as planned. Either the finger touches
an object, or the rig plays a signal that differs from the command. In both cases the command must end with exit code
6 and must not use the recording as evidence."""

import json
import shlex
import sys

import bench

GIVEN = "config/models/bench_twin.yaml"
FINGER = "config/models/finger.yaml"
# The pressure rises and falls once. The finger is softer than the given model. A drift or a wrong scale of the sensor
# would explain the log equally well.
CORNERS = ((0, 0), (1, 0), (7, 45), (13, 0), (16, 0))
RATE_HZ, NOISE_MM, NOISES, LONGEST_MINUTES = 25, "0.15", range(1, 17), 1
# A program for --rig-command. It changes the command with the function CHANGE and simulates a finger with the result.
PLAYER = """
import csv, subprocess, sys
with open(sys.argv[1], newline="") as file:
    rows = [(float(row["time_s"]), float(row["pressure_command_kpa"])) for row in csv.DictReader(file)]
rows = (CHANGE)(rows)
with open("played.csv", "w") as file:
    file.write("time_s,pressure_command_kpa\\n" + "".join(f"{t!r},{p!r}\\n" for t, p in rows))
sys.exit(subprocess.run([SOFTGRIP, "simulate", "--model", MODEL, "--input", "played.csv", "--out", sys.argv[2],
                         "--noise-mm", "0.04", "--seed", "7"], stdout=subprocess.DEVNULL).returncode)
"""


class Investigation(bench.BenchTest):

    def setUp(self):
        super().setUp()
        softer = "actuator:\n  - stress_softening: {softening_per_kpa: 0.004, levelling_per_kpa: 0}\n"
        self.write(FINGER, (self.folder / GIVEN).read_text().replace("actuator:\n", softer))
        rows = ["time_s,pressure_command_kpa"]
        for (begin, low), (end, high) in zip(CORNERS, CORNERS[1:]):
            count = RATE_HZ * (end - begin)
            rows += [f"{begin + i / RATE_HZ:.2f},{low + (high - low) * i / count:.6g}" for i in range(count)]
        self.write("load.csv", "\n".join(rows) + "\n")
        self.assertTrue(any(map(self.asks, NOISES)), "diagnose suggests no experiment for any of these logs")

    def asks(self, seed):
        """Writes log.csv with the noise of this seed. Several causes explain this log equally well. Returns True if a
        short experiment can separate them."""
        self.softgrip("simulate", "--model", FINGER, "--input", "load.csv", "--out", "log.csv", "--noise-mm", NOISE_MM,
                      "--seed", seed)
        told = json.loads(self.softgrip("diagnose", "--model", GIVEN, "--data", "log.csv", "--no-closed-loop", "--out",
                                        "asked", "--json").stdout)["next_experiment"]
        return told and told["minutes"] < LONGEST_MINUTES

    def investigated(self, *arguments, expect=6, timeout_s=170):
        done = self.softgrip("investigate", "--model", GIVEN, "--data", "log.csv", "--no-closed-loop", "--out", "found",
                             *arguments, expect=expect, timeout_s=timeout_s)
        told = json.loads((self.folder / "found/investigation.json").read_text())
        self.assertIn(told["why"], done.stdout)
        return told

    def check(self, told, end, why):
        self.assertEqual(told["end"], end, told)
        self.assertRegex(told["why"], why)
        self.assertEqual([bool(step["experiment"]) for step in told["steps"]], [True], "one experiment was played")
        self.assertEqual([log["path"] for log in told["logs"]], ["log.csv"],
                         "the recording must not be used as evidence")
        page = (self.folder / "found/report.html").read_text()
        self.assertIn(told["why"], page)

    def simulated(self, about):
        """Writes a rig file like config/rig.yaml with this finger. The text `about` replaces the entry `object`, which
        describes a stone between the fingers."""
        text = (self.folder / "config/rig.yaml").read_text()
        stone = "\n        object: {position_mm: 12, yielding: 0.1}    # a stone between the fingers"
        self.assertIn(stone, text)
        return self.write("config/simulated.yaml", text.replace(stone, about).replace(
            f"model: {GIVEN.removeprefix('config/')}", f"model: {FINGER.removeprefix('config/')}", 1))

    def test_a_contact_ends_the_investigation(self):
        rig = self.simulated("\n        object: {position_mm: 12, yielding: 0.1}")
        self.check(self.investigated("--rig", rig, "--rig-channel", "left"), "contact",
                   r"the finger touched an object: the finger stopped at 1[2-5](\.\d)? mm, .* mm before its free-motion displacement")

    def test_a_finger_without_contact_is_not_stopped(self):
        told = self.investigated("--rig", self.simulated(""), "--rig-channel", "left", expect=None, timeout_s=850)
        self.assertNotIn(told["end"], ("contact", "not_as_asked", "failed", "stopped"), told)
        self.assertEqual(told["logs"][1]["path"], "found/step_1/recording/run.csv")

    def test_a_contact_on_a_modbus_rig_ends_the_investigation(self):
        rig = self.emulator("--model", self.folder / FINGER, "--object", "stone")
        self.check(self.investigated("--rig", self.rig(rig.port), "--rig-channel", "left", "--yes"), "contact",
                   "the finger touched an object")
        self.assertLess(max(rig.pressures_kpa()), 5, "the rig must be vented")

    def test_a_rig_that_deviates_from_the_command_ends_the_investigation(self):
        for change, why in (("lambda rows: [(t, min(p, 30.0)) for t, p in rows]",
                             "the rig did not run the requested experiment: the command went to 30 instead of 45 kPa"),
                            ("lambda rows: rows[:len(rows) * 2 // 3]", r"it took [\d.]+ instead of [\d.]+ s"),
                            ("lambda rows: [(t, p if t < rows[-1][0] / 2 else 0.0) for t, p in rows]",
                             "the command changed by a total of")):
            with self.subTest(change):
                player = self.write("player.py", PLAYER.replace("CHANGE", change).replace(
                    "SOFTGRIP", repr(str(bench.SOFTGRIP))).replace("MODEL", repr(FINGER)))
                self.check(self.investigated("--rig-command", shlex.join([sys.executable, str(player)]), "--yes"),
                           "not_as_asked", why)

    def test_a_log_of_an_earlier_investigation_is_no_measurement(self):
        change = "lambda rows: [(t, min(p, 30.0)) for t, p in rows]"
        player = self.write("player.py", PLAYER.replace("CHANGE", change).replace(
            "SOFTGRIP", repr(str(bench.SOFTGRIP))).replace("MODEL", repr(FINGER)))
        self.investigated("--rig-command", shlex.join([sys.executable, str(player)]), "--yes")
        self.assertTrue((self.folder / "found/step_1/log.csv").is_file())
        told = self.investigated("--rig-command", "true", "--yes", expect=1)
        self.assertEqual(told["end"], "failed", told)
        self.assertRegex(told["why"], r"log\.csv")


if __name__ == "__main__":
    bench.main()
