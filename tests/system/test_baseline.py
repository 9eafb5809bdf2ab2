"""Tests softgrip baseline --rig, which runs the commissioning experiment on a rig. Checks the stored files and the
refusals."""

import csv
import json
import os
import re
import signal
import unittest.mock

import bench
import terminal

STONE = "\n        object: {position_mm: 12, yielding: 0.1}    # a stone between the fingers"
SHORT = ("--experiments", "minor_loops", "sharp_steps")
ENDS_WITHIN_S = 340


class Baseline(bench.BenchTest):

    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        patch = unittest.mock.patch.dict(os.environ, {"TMPDIR": str(self.temporary)})
        patch.start()
        self.addCleanup(patch.stop)

    def simulated(self, *changes):
        """Writes config/rig.yaml without an object, so that the left finger can move freely."""
        text = (self.folder / "config/rig.yaml").read_text()
        for old, new in ((STONE, ""), *changes):
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        return self.write("config/simulated.yaml", text)

    def commissioned(self, rig, *arguments, expect=0):
        return self.softgrip("baseline", "--rig", rig, "--rig-channel", "left", "--out", "base", *arguments,
                             expect=expect, timeout_s=ENDS_WITHIN_S)

    def column(self, log, name):
        with open(self.folder / "base" / log, newline="") as file:
            return [float(row[name]) for row in csv.DictReader(file) if row[name]]

    def check_nothing_is_left(self):
        self.assertEqual([path.name for path in self.folder.glob("base*")], [])
        self.assertEqual(list(self.temporary.iterdir()), [])

    def check_whole(self, logs):
        """Checks that the folder of --data is complete and that --check gives the same result. Also checks that the
        second run in the folder is a new recording and not a copy of the first."""
        self.assertEqual(list(self.temporary.iterdir()), [])
        about = json.loads((self.folder / "base/baseline.json").read_text())
        names = [f"{run}_{i + 1}.csv" for run in ("healthy", "second") for i in range(logs)]
        self.assertEqual([entry["file"] for entry in about["logs"] + about["second_run"]], names)
        self.assertEqual(sorted(path.name for path in (self.folder / "base").iterdir()),
                         sorted(["baseline.json", "model.yaml", *names]))
        self.assertNotEqual(about["logs"][0]["sha256"], about["second_run"][0]["sha256"],
                            "the second run was played and not copied")
        again = json.loads(self.softgrip("baseline", "--check", "base", "--json", expect=None,
                                         timeout_s=ENDS_WITHIN_S).stdout)
        self.assertEqual(again["check"], about["check"])
        return about

    def found(self, logs):
        self.softgrip("diagnose", "--baseline", "base", "--data", *logs, "--out", "found", timeout_s=ENDS_WITHIN_S)
        return json.loads((self.folder / "found/diagnosis.json").read_text())

    def test_a_gain_change_since_the_baseline_of_a_simulated_rig_is_found(self):
        done = self.commissioned(self.simulated(), *SHORT)
        self.assertRegex(done.stdout, r"The second run: Unchanged.*Residual of the baseline model: 0\.\d+ mm on the first run")
        about = self.check_whole(2)
        self.assertEqual(about["check"]["verdict"], "unchanged")
        self.assertEqual((about["rig"]["channel"], about["rig"]["simulated"]), ("left", True))
        (self.folder / "base").rename(self.folder / "healthy")
        # The changed model moves 10 % less than the original model at every pressure. The immediate displacement and
        # the creep are both 10 % smaller.
        def weaker(line):
            value = float(line[2]) * (0.9 if "mm_per_kpa" in line[1] else 1 / 0.9)
            return f"{line[1]}: {value}"
        text, count = re.subn(r"(alpha_mm_per_kpa|beta_mm_per_kpa|[kc]\d_kpa\w*_per_mm): ([\d.]+)", weaker,
                              (self.folder / "config/models/bench_twin.yaml").read_text())
        self.assertEqual(count, 7)
        self.write("config/models/weaker.yaml", text)
        self.commissioned(self.simulated(("      left:\n        model: models/bench_twin.yaml",
                                          "      left:\n        model: models/weaker.yaml")), *SHORT)
        (self.folder / "base").rename(self.folder / "today")
        (self.folder / "healthy").rename(self.folder / "base")
        cause = self.found(["today/healthy_1.csv", "today/healthy_2.csv"])["causes"][0]
        self.assertEqual(cause["id"], "ageing")
        self.assertAlmostEqual(cause["size"]["value"], -10, delta=2, msg="the gain in percent")
        log = self.folder / "base/second_2.csv"
        log.write_text(log.read_text() + "\n")
        self.assertIn("second_2.csv", self.softgrip("baseline", "--check", "base", expect=3).stderr)

    def test_commissioning_stays_within_the_limits_of_the_rig_file(self):
        for old, new, most_kpa, most_mm in (
                ("pressure_max_kpa: 60", "pressure_max_kpa: 22", 22, 35),
                ("displacement_max_mm: 35", "displacement_max_mm: 11", 60, 11)):
            with self.subTest(new):
                self.commissioned(self.simulated((old, new)), *SHORT)
                for log in ("healthy_1.csv", "second_1.csv"):
                    command = self.column(log, "pressure_command_kpa")
                    self.assertLessEqual(max(command), most_kpa + 1e-6)
                    self.assertGreater(max(command), 10)
                    steps = [abs(b - a) for a, b in zip(command, command[1:])]
                    self.assertLessEqual(max(steps), 300 / 200 + 1e-6, "300 kPa/s at 200 Hz")
                    self.assertLess(max(self.column(log, "displacement_mm")), most_mm)
                for path in (self.folder / "base").iterdir():
                    path.unlink()

    def test_a_contact_ends_the_commissioning_and_no_file_remains(self):
        done = self.commissioned(self.folder / "config/rig.yaml", expect=6)
        self.assertRegex(done.stderr, r"the finger touched an object: the finger stopped at 1[2-5](\.\d)? mm")
        self.check_nothing_is_left()

    def test_a_finger_that_hardly_moves_ends_the_commissioning(self):
        still = (self.folder / "config/models/bench_twin.yaml").read_text()
        plant = ("      left:\n        model: models/bench_twin.yaml", "      left:\n        model: models/still.yaml")
        self.write("config/models/still.yaml", re.sub(
            r"(alpha|beta)_mm_per_kpa: 0\.", r"\1_mm_per_kpa: 0.00", re.sub(r"(k[012]_kpa_per_mm: )", r"\g<1>100", still)))
        done = self.commissioned(self.simulated(plant), expect=6)
        self.assertIn("the finger hardly moved", done.stderr)
        self.check_nothing_is_left()

    def test_invalid_arguments_are_rejected_before_any_motion(self):
        free = self.simulated()
        (self.folder / "old").mkdir()
        self.write("old/baseline.json", "{}")
        for arguments, code, why in (
                (["--rig", free, "--out", "base"], 2, "the rig has 2 channels"),
                (["--rig", free, "--rig-channel", "middle", "--out", "base"], 2, "no channel 'middle'"),
                (["--rig", free, "--rig-channel", "left", "--out", "config"], 5, "config already exists"),
                (["--data", "config/rig.yaml", "--out", "old"], 5, "old already exists"),
                (["--rig", free, "--rig-channel", "left"], 2, "--out is required"),
                (["--rig", free, "--data", "log.csv", "--out", "base"], 2, "excludes"),
                (["--rig", "nowhere.yaml", "--out", "base"], 4, "nowhere.yaml"),
                (["--rig-channel", "left", "--data", "log.csv", "--out", "base"], 2, "requires --rig"),
                (["--rig", free, "--rig-channel", "left", "--experiments", "dance", "--out", "base"], 2, "dance"),
                (["--rig", free, "--rig-channel", "left", "--yes", "--gauge", "nowhere.csv", "--out", "base"], 4, "nowhere.csv"),
                (["--rig", free, "--rig-channel", "left", "--yes", "--model", "nowhere.yaml", "--out", "base"], 4, "nowhere.yaml"),
                (["--out", "base"], 2, "needs --rig or --data"),
                (["--check", "config"], 3, "config is not a baseline"),
                (["--check", "nowhere"], 4, "cannot read nowhere: No such file or directory")):
            with self.subTest(why):
                self.assertIn(why, self.softgrip("baseline", *arguments, expect=code).stderr)
        upper = self.simulated(("pressure_min_kpa: 0", "pressure_min_kpa: 2"))
        self.assertIn("never goes down to 0 kPa", self.commissioned(upper, expect=2).stderr)
        self.check_nothing_is_left()

    def test_a_modbus_rig_is_commissioned_in_real_time(self):
        self.creep_faster()
        board = self.emulator("--model", self.folder / "config/models/bench_twin.yaml")
        done = self.commissioned(self.rig(board.port), "--experiments", "sharp_steps", "--rest-s", "5", "--yes",
                                 expect=None)
        self.assertIn("run_2, 1 of 1: sharp_steps", done.stderr)
        self.assertLess(max(board.pressures_kpa()), 5, "the rig must be vented")
        about = self.check_whole(1)
        # One short log contains too little data to determine the verdict, so the test accepts any verdict.
        check = about["check"]
        self.assertEqual(done.returncode, 0 if check["verdict"] == "unchanged" else 6)
        self.assertLess(check["second_run_rms_mm"], 2 * check["healthy_heldout_rms_mm"])
        self.assertEqual((about["rig"]["channel"], about["rig"]["simulated"]), ("left", False))

    def test_the_rig_does_not_move_without_consent(self):
        board = self.emulator()
        rig = self.rig(board.port)
        self.assertIn("allow the motion with --yes", self.commissioned(rig, expect=2).stderr)
        screen = terminal.Terminal([bench.SOFTGRIP, "baseline", "--rig", rig, "--rig-channel", "left", "--out", "base"],
                                   self.folder, columns=200)
        self.addCleanup(screen.close)
        bench.wait_for("the question", lambda: "Continue? [y/N]" in screen.text())
        self.assertRegex(screen.text(), r"channel 'left' of bench will move: .* at most [\d.]+ kPa, in about 17 minutes. "
                                        "Remove all objects from the range of the finger")
        screen.type("n\n")
        self.assertEqual(screen.wait(), 1)
        self.assertIn("softgrip was not allowed to move the rig", screen.text())
        self.assertEqual(board.commands_kpa(), [0, 0])
        self.check_nothing_is_left()

    def test_a_board_that_softgripd_uses_is_rejected(self):
        board = self.emulator()
        rig = self.rig(board.port)
        softgripd = self.idle_daemon(rig)
        self.assertIn("softgripd runs", self.commissioned(rig, "--yes", expect=5).stderr)
        other = self.write("config/other.yaml", rig.read_text().replace("softgripd.sock", "other.sock"))
        self.assertIn(str(softgripd.child.pid), self.commissioned(other, "--yes", expect=5).stderr)
        self.check_nothing_is_left()

    def test_ctrl_c_vents_the_rig_and_no_file_remains(self):
        board = self.emulator()
        child = bench.Process("softgrip", [bench.SOFTGRIP, "baseline", "--rig", self.rig(board.port), "--rig-channel",
                                           "left", "--out", "base", "--yes"], self.folder)
        self.processes.append(child)
        bench.wait_for("pressure", lambda: board.commands_kpa()[0] > 5)
        self.assertNotEqual(list(self.temporary.iterdir()), [], "the recording is kept in a folder")
        self.assertEqual(child.end(signal.SIGINT), -signal.SIGINT,
                         "an exit code instead of a signal does not end the loop of a shell")
        self.assertIn("stopped by the user; the rig is vented", child.errors())
        self.assertEqual(board.commands_kpa(), [0, 0])
        self.check_nothing_is_left()

    def test_a_contact_on_a_modbus_rig_ends_the_commissioning(self):
        board = self.emulator("--object", "stone")
        done = self.commissioned(self.rig(board.port), *SHORT, "--rest-s", "1", "--yes", expect=6)
        self.assertIn("the finger touched an object", done.stderr)
        self.assertLess(max(board.pressures_kpa()), 5, "the rig must be vented")
        self.check_nothing_is_left()


if __name__ == "__main__":
    bench.main()
