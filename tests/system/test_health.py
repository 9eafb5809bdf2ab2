"""Tests softgrip health on recordings of softgrip run. From recordings of
ordinary grips, the command must detect that a finger has changed."""

import datetime
import json
import pathlib
import shutil
import tempfile

import bench
import web
import working_life
from working_life import Finger


def day(number, hour=8):
    return (datetime.datetime(2026, 8, 1, hour) + datetime.timedelta(number)).strftime("%Y-%m-%dT%H:%M:%SZ")


class Health(bench.BenchTest):
    """Writes recordings of 12 days with 2 grips per day. From the ninth day on, the left finger is changed."""

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="softgrip-health-"))
        cls.rig_at_work = working_life.Rig(bench.SOFTGRIP, cls.shared)
        cls.baseline = cls.rig_at_work.baseline()
        cls.healthy = [cls.rig_at_work.play(working_life.Grip(day(number, hour), 10 * number + hour,
                                                              {"left": Finger(), "right": Finger()}))
                       for number in range(8) for hour in (8, 15)]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.shared)

    def later(self, finger, days=range(8, 12)):
        rig = working_life.Rig(bench.SOFTGRIP, self.folder)
        return [rig.play(working_life.Grip(day(number, hour), 10 * number + hour, {"left": finger, "right": Finger()}))
                for number in days for hour in (8, 15)]

    def health(self, runs, *arguments, expect):
        out = self.folder / "out"
        done = self.softgrip("health", *runs, "--baseline", self.baseline, "--out", out, "--json", *arguments,
                             expect=expect)
        result = json.loads(done.stdout)
        self.assertEqual(result, json.loads((out / "health.json").read_text()))
        return {finger["finger"]: finger for finger in result["fingers"]}

    def check_found(self, finger, number, sign, suspect):
        fingers = self.health(self.healthy + self.later(finger), expect=6)
        left = fingers["left"]
        self.assertEqual(left["state"], "alarm")
        self.assertEqual(fingers["right"]["state"], "steady")
        alarm = next(one for one in left["alarms"] if one["number"] == number)
        self.assertGreater(sign * alarm["change"], 0)
        self.assertEqual(alarm["since"], day(8)[:10])
        self.assertEqual(left["suspects"][0]["id"], suspect, left["sentence"])
        self.assertTrue(all(left["suspects"][0]["next_steps"]))
        page = (self.folder / "out/health-left.html").read_text()
        self.assertIn(left["suspects"][0]["words"], page)
        return left

    def test_a_healthy_rig_is_reported_steady_without_alarms(self):
        fingers = self.health(self.healthy + self.later(Finger()), expect=0)
        for name in ("left", "right"):
            self.assertEqual(fingers[name]["state"], "steady")
            self.assertEqual(fingers[name]["alarms"], [])
            self.assertEqual(fingers[name]["grips"], 24)
            self.assertAlmostEqual(fingers[name]["numbers"]["gain_mm"]["value"], 32.09, delta=0.1)

    def test_the_gain_is_compared_at_the_recorded_temperature(self):
        rig = working_life.Rig(bench.SOFTGRIP, self.folder)
        warmer = (0, 3, -2, 5, 1, -4, 4, 2, -1, 3, 6, -3)
        finger = Finger(gain_per_c=0.005)
        runs = [rig.play(working_life.Grip(day(number), number, {"left": finger, "right": finger}, temperature_c=20 + by,
                                           thermometer=True)) for number, by in enumerate(warmer)]
        self.assertIn(",pressure_kpa,temperature_c,", (runs[0] / "run.csv").read_text().splitlines()[0])
        fingers = self.health(runs, expect=0)
        gain = fingers["left"]["numbers"]["gain_mm"]
        self.assertAlmostEqual(gain["per_c"], 0.005 * 32.1, delta=0.01)
        self.assertAlmostEqual(fingers["left"]["temperature_c"], 17, delta=0.2)
        self.assertIn("mm per °C", (self.folder / "out/health-left.html").read_text())

    def test_a_change_of_both_fingers_is_a_warning_and_no_alarm(self):
        rig = working_life.Rig(bench.SOFTGRIP, self.folder)
        leaking = Finger(leak=0.03)
        runs = [rig.play(working_life.Grip(day(number, hour), 10 * number + hour, {"left": leaking, "right": leaking}))
                for number in range(8, 12) for hour in (8, 15)]
        fingers = self.health(self.healthy + runs, expect=0)
        self.assertEqual({finger["state"] for finger in fingers.values()}, {"steady"})
        result = json.loads((self.folder / "out/health.json").read_text())
        self.assertIn("pressure_loss_kpa", result["shared"])
        told = next(one for one in result["shared_changes"] if one["number"] == "pressure_loss_kpa")
        self.assertEqual(told["since"], day(8)[:10])
        self.assertEqual(told["fingers"], ["left", "right"])
        self.assertTrue(any("show the same change" in warning for warning in result["warnings"]))

    def test_a_pressure_loss_is_attributed_to_a_leak(self):
        self.check_found(Finger(leak=0.04), "pressure_loss_kpa", 1, "leak")

    def test_a_gain_loss_of_4_percent_is_attributed_to_ageing(self):
        self.check_found(Finger(gain=0.96), "gain_mm", -1, "ageing")

    def test_a_sensor_offset_of_0_5_mm_is_attributed_to_sensor_drift(self):
        left = self.check_found(Finger(zero_mm=0.5), "zero_mm", 1, "sensor_drift")
        zero = next(one for one in left["alarms"] if one["number"] == "zero_mm")
        self.assertAlmostEqual(zero["change"], 0.5, delta=0.02)

    def test_a_larger_lag_is_attributed_to_a_blocked_line_or_the_valve(self):
        left = self.check_found(Finger(valve_lag_s=0.1), "lag_s", 1, "blocked_line")
        self.assertIn("valve_lag", [one["id"] for one in left["suspects"]])

    def test_a_repair_note_restarts_the_control_charts(self):
        runs = self.healthy + self.later(Finger(gain=0.96))
        notes = self.write("notes.yaml", f"notes:\n  - {{date: {day(8)[:10]}, finger: left, mended: finger replaced}}\n")
        fingers = self.health(runs, "--notes", notes, expect=0)
        self.assertEqual(fingers["left"]["state"], "steady")
        self.assertIn("finger replaced", (self.folder / "out/health-left.html").read_text())

    def test_scores_of_deleted_recordings_are_kept_and_bad_recordings_skipped(self):
        kept = self.folder / "kept"
        for run in self.healthy:
            shutil.copytree(run, kept / run.name)
        self.health([kept], expect=0)
        scores = (self.folder / "out/health-scores.jsonl").read_text()
        self.assertEqual(len(scores.splitlines()), 2 * len(self.healthy))
        for run in list(kept.iterdir())[:-1]:
            shutil.rmtree(run)
        bad = kept / "2026-08-20T08-00-00Z_pick_stone"
        bad.mkdir()
        (bad / "run.csv").write_text("time_s,channel\n0,left\n")
        fingers = self.health([kept, *self.later(Finger(leak=0.04))], expect=6)
        self.assertEqual(fingers["left"]["grips"], 24)
        result = json.loads((self.folder / "out/health.json").read_text())
        self.assertEqual([one["run"] for one in result["skipped"]], [bad.name])
        # The command must not score the same recording a second time.
        self.assertEqual(len((self.folder / "out/health-scores.jsonl").read_text().splitlines()), 48)

    def test_a_missing_path_causes_an_input_error_and_the_other_paths_are_used(self):
        def refused(*runs):
            done = self.softgrip("health", *runs, "--baseline", self.baseline, "--out", "out", expect=4)
            self.assertIn("nothere is skipped: the path cannot be read: No such file or directory", done.stderr)

        refused("nothere")
        self.assertFalse((self.folder / "out/health.json").exists())
        refused(*self.healthy, "nothere")
        result = json.loads((self.folder / "out/health.json").read_text())
        self.assertEqual([finger["grips"] for finger in result["fingers"]], [len(self.healthy)] * 2)
        self.assertEqual([one["run"] for one in result["skipped"]], ["nothere"])
        refused("nothere")
        refused(*self.later(Finger(leak=0.04)), "nothere")
        self.assertEqual(json.loads((self.folder / "out/health.json").read_text())["state"], "alarm")

    def test_the_run_csv_of_a_recording_gives_the_result_of_its_folder(self):
        for out, runs in (("folders", self.healthy), ("files", [run / "run.csv" for run in self.healthy])):
            self.softgrip("health", *runs, "--baseline", self.baseline, "--out", out)
        self.assertEqual(*((self.folder / out / "health-scores.jsonl").read_text() for out in ("folders", "files")))

    def test_a_finger_without_a_baseline_is_reported_once_in_each_call(self):
        shutil.copytree(self.baseline, self.folder / "bases/left")
        for _ in range(2):
            done = self.softgrip("health", *self.healthy, "--baseline", "bases", "--out", "out")
            self.assertEqual(done.stderr.count("there is no baseline of `right`"), 1, done.stderr)
            self.assertEqual([one["finger"] for one in json.loads((self.folder / "out/health.json").read_text())["skipped"]],
                             ["right"])

    def test_invalid_recordings_baselines_and_notes_are_rejected(self):
        def refused(code, *arguments):
            return self.softgrip("health", *arguments, "--out", self.folder / "out", expect=code).stderr

        self.assertIn("is not a baseline", refused(3, self.healthy[0], "--baseline", self.folder))
        self.assertEqual(refused(4, *self.healthy, "--baseline", "nosuch"), "softgrip: nosuch does not exist\n")
        self.assertIn("the folder contains no recordings", refused(3, self.folder, "--baseline", self.baseline))
        self.write("lft.yaml", "notes:\n  - {date: 2026-08-03, finger: lft, action: x}\n")
        misspelled = refused(3, *self.healthy, "--baseline", self.baseline, "--notes", "lft.yaml")
        self.assertIn("lft.yaml:2:", misspelled)
        self.assertIn("did you mean `left`?", misspelled)
        self.assertEqual(list((self.folder / "out").iterdir()), [])
        notes = self.write("bad.yaml", "notes:\n  - {date: soon, mended: x}\n")
        self.softgrip("health", *self.healthy, "--baseline", self.baseline, "--notes", notes, expect=3)
        self.softgrip("health", *self.healthy, "--baseline", self.baseline, "--notes", self.folder / "none", expect=4)
        broken = self.folder / "broken"
        shutil.copytree(self.baseline, broken)
        (broken / "model.yaml").write_text("changed\n")
        self.softgrip("health", *self.healthy, "--baseline", broken, expect=3)


class LastHealthResult(web.WebTest):
    """Tests that every program that reads the last result of softgrip health shows it. The service writes this result
    next to the recordings."""

    def judge(self):
        at_work = working_life.Rig(bench.SOFTGRIP, self.folder / "at_work")
        baseline = at_work.baseline()
        runs = [at_work.play(working_life.Grip(day(number), number, {
            "left": Finger(leak=0.05 if number >= 8 else 0), "right": Finger()})) for number in range(12)]
        self.softgrip("health", *runs, "--baseline", baseline, "--out", self.folder / "runs/health", expect=6)

    def test_status_doctor_and_metrics_report_the_last_health_result(self):
        self.start_rig()
        told = self.start_web()
        self.assertNotIn("Possible cause", self.softgrip("status").stdout)
        self.assertFalse(json.loads(self.softgrip("status", "--json").stdout).get("health"))
        self.assertNotIn("softgrip_health_state", told.ask("/metrics")[1])
        self.judge()
        self.assertIn("Possible cause: the pressure falls while it should be constant.", self.softgrip("status").stdout)
        status = json.loads(self.softgrip("status", "--json").stdout)
        self.assertEqual(status["health"]["state"], "alarm")
        self.assertLess(status["health"]["age_s"], 600)
        for arguments in ((), ("--rig", self.rig_path)):
            report = json.loads(self.softgrip("doctor", *arguments, "--json", expect=None).stdout)
            finding = next(one for one in report["findings"] if one["name"] == "health")
            self.assertEqual(finding["verdict"], "warn")
            self.assertIn("the pressure falls", finding["text"])
            self.assertIn("soapy water", finding["advice"])
        metrics = told.metrics()
        self.assertEqual(metrics['softgrip_health_state{channel="left",state="alarm"}'], 1)
        self.assertEqual(metrics['softgrip_health_state{channel="right",state="steady"}'], 1)
        self.assertEqual(metrics['softgrip_health_suspect{channel="left",cause="leak"}'], 1)
        self.assertAlmostEqual(metrics["softgrip_health_timestamp_seconds"], bench.time.time(), delta=600)
        self.assertIn("soapy water", told.ask("/recordings/health/health-left.html")[1])
        self.softgripd.kill()
        bench.wait_for("no daemon", lambda: told.metrics()["softgrip_up"] == 0)
        self.assertIn('softgrip_health_suspect{channel="left",cause="leak"}', told.metrics())


if __name__ == "__main__":
    bench.main()
