"""Tests the health analysis of recordings. Values and pages must equal those of `softgrip health`, and results must be
picklable. Invalid arguments must raise an exception.

Needs the folder python of a build (SOFTGRIP_BUILD). This folder contains the extension module.
"""

import json
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
sys.path[:0] = [str(BUILD / "python"), str(SOURCE / "tests/system")]

import numpy as np
import softgrip
from softgrip import health
from working_life import Finger, Grip, Rig

PROGRAM = BUILD / "tools/softgrip"
MADE = ("made", "made_unix_s")


class Health(unittest.TestCase):
    """Writes the recordings of a gripper with two fingers that grips once per day for 12 days. From the ninth day
    on, the left finger leaks."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.at = pathlib.Path(cls.folder.name)
        rig = Rig(PROGRAM, cls.at)
        cls.baseline = rig.baseline()
        for day in range(12):
            rig.play(Grip(f"2026-08-{day + 1:02}T08:00:00Z", day,
                          {"left": Finger(leak=0.05 if day >= 8 else 0), "right": Finger()}))
        cls.recordings = rig.recordings
        cls.found = health(cls.recordings, cls.baseline)

    def command(self, *arguments):
        done = subprocess.run([PROGRAM, "health", self.recordings, "--baseline", self.baseline, "--json", *arguments],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 6, done.stderr)
        return {key: value for key, value in json.loads(done.stdout).items() if key not in MADE}

    def test_report_scores_and_pages_equal_those_of_the_command(self):
        out, scores = self.at / "out", self.at / "scores.jsonl"
        expected = self.command("--out", out, "--false-alarm-points", "1000")
        found = health([self.recordings], self.baseline, false_alarm_points=1000, scores=scores)
        self.assertEqual({key: value for key, value in found.report.items() if key not in MADE}, expected)
        self.assertEqual(scores.read_bytes(), (out / "health-scores.jsonl").read_bytes())
        for finger in found.fingers:
            self.assertEqual(finger.html, (out / f"health-{finger.finger}.html").read_text())
        by_run = health([self.recordings], self.baseline, points="run")
        self.assertEqual({key: value for key, value in by_run.report.items() if key not in MADE},
                         self.command("--points", "run"))

    def test_the_result_objects_contain_the_values_of_the_report(self):
        self.assertTrue(self.found.alarm)
        for finger, said in zip(self.found.fingers, self.found.report["fingers"]):
            self.assertEqual((finger.finger, finger.state, finger.sentence, finger.unit, finger.grips, list(finger.advice)),
                             tuple(said[key] for key in ("finger", "state", "sentence", "output_unit", "grips", "advice")))
            self.assertEqual(len(finger.points), said["points"])
            self.assertEqual([(one.id, one.words, list(one.next_steps)) for one in finger.suspects],
                             [(one["id"], one["words"], one["next_steps"]) for one in said["suspects"]])
            for one in finger.indicators:
                number = said["numbers"][one.id]
                self.assertEqual((one.value, one.reference, one.spread),
                                 (number["value"], number["reference"], number["spread"]))
                self.assertEqual(len(one.values), len(finger.points))
            for one, alarm in zip(finger.alarms, said["alarms"]):
                self.assertEqual((one.indicator, one.change, one.since, one.noticed, one.grips_until_noticed, one.active),
                                 tuple(alarm[key] for key in ("number", "change", "since", "noticed", "grips_until_noticed",
                                                              "stands")))
        left = self.found.finger("left")
        self.assertEqual(left.suspects[0].id, "leak")
        loss = left.indicator("pressure_loss_kpa")
        self.assertEqual(loss.values[-1], loss.value)
        self.assertEqual(self.found.finger("right").state, "steady")

    def test_a_result_can_be_pickled_and_plotted(self):
        copy = pickle.loads(pickle.dumps(self.found))
        self.assertEqual(copy.report, self.found.report)
        np.testing.assert_array_equal(copy.fingers[0].indicators[0].values, self.found.fingers[0].indicators[0].values)
        self.assertIn("leak", self.found._repr_html_())
        import matplotlib
        matplotlib.use("Agg")
        axes = self.found.plot()
        self.assertEqual(axes.get_title(), "left: alarm")
        left = self.found.finger("left")
        first = next(one.indicator for one in left.alarms if one.active)
        self.assertEqual(axes.get_ylabel(), f"{left.indicator(first).title} [{left.indicator(first).unit}]")
        self.assertEqual(left.plot("pressure_loss_kpa").get_ylabel(), "pressure loss while holding [kPa]")
        self.assertIn("gain", self.found.plot("right").get_ylabel())
        for bad in (lambda: self.found.plot("middle"), lambda: self.found.plot("left", "no_such")):
            with self.assertRaises(softgrip.InvalidArgument):
                bad()
        matplotlib.pyplot.close("all")

    def test_scores_replace_deleted_recordings_and_notes_end_alarms(self):
        scores, few = self.at / "kept.jsonl", self.at / "few"
        shutil.copytree(self.recordings, few)
        health(few, self.baseline, scores=scores)
        first, *others = sorted(few.iterdir())
        for other in others:
            shutil.rmtree(other)
        again = health(few, self.baseline, scores=scores)
        self.assertEqual(again.report["fingers"], self.found.report["fingers"])
        (self.at / "notes.yaml").write_text("notes:\n  - {date: 2026-08-09, finger: left, action: line replaced}\n")
        after = health(few, self.baseline, scores=scores, notes=self.at / "notes.yaml")
        self.assertFalse(after.alarm)
        self.assertNotEqual(after.finger("left").state, "alarm")

    def test_progress_is_reported_and_a_callback_exception_ends_the_call(self):
        stages = []
        health(self.recordings, self.baseline, progress=stages.append)
        self.assertEqual(stages, [f"recording {one} of 12" for one in range(1, 13)])

        def stop(stage):
            stages.append(stage)
            raise KeyError(stage)
        stages.clear()
        with self.assertRaises(KeyError):
            health(self.recordings, self.baseline, progress=stop)
        self.assertEqual(stages, ["recording 1 of 12"])

    def test_invalid_files_and_arguments_raise_the_matching_exceptions(self):
        broken = self.at / "broken"
        shutil.copytree(self.baseline, broken)
        (broken / "model.yaml").write_text("changed\n")
        (self.at / "bad.yaml").write_text("notes:\n  - {date: soon, action: x}\n")
        for call, kind, text in (
                (lambda: health(self.recordings, broken), softgrip.MalformedFile, "model.yaml was changed"),
                (lambda: health(self.recordings, self.at / "nowhere"), softgrip.MalformedFile, "nowhere does not exist"),
                (lambda: health(self.at / "nothing", self.baseline), softgrip.NoResult, "no recording can be compared"),
                (lambda: health(self.recordings, self.baseline, notes=self.at / "bad.yaml"), softgrip.MalformedFile, "not a date"),
                (lambda: health(self.recordings, self.baseline, notes=self.at / "none"), softgrip.MalformedFile, "none"),
                (lambda: health(self.recordings, self.baseline, points="week"), softgrip.InvalidArgument, "^points: 'week'"),
                (lambda: health(self.recordings, self.baseline, false_alarm_points=float("nan")), softgrip.InvalidArgument,
                 "^false_alarm_points: nan"),
                (lambda: health([], self.baseline), softgrip.InvalidArgument, "^recordings: 0 paths"),
                (lambda: health(3, self.baseline), softgrip.InvalidArgument, "^recordings: 3 is no path")):
            with self.assertRaisesRegex(kind, text):
                call()

    def test_the_nightly_example_reports_the_leak_and_writes_the_page(self):
        out = self.at / "night"
        done = subprocess.run([sys.executable, SOURCE / "examples/python/nightly_health.py", self.recordings, self.baseline,
                               out], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("leak: ", done.stdout)
        self.assertIn("<html", (out / "health-left.html").read_text())
        self.assertTrue((out / "health-scores.jsonl").exists())


if __name__ == "__main__":
    unittest.main()
