"""Tests softgrip tune and softgrip study as a user sees them. The options are chosen so that the runs are short."""

import json
import re

import bench

MODEL = "config/models/bench_twin.yaml"
SHORT = ("--draws", "2", "--frequencies-hz", "0.3")


class Tune(bench.BenchTest):

    def tune(self, *arguments, expect=0):
        return self.softgrip("tune", "--model", MODEL, *SHORT, *arguments, expect=expect, timeout_s=120)

    def test_the_written_gains_are_valid_in_a_rig_file(self):
        self.tune("--feedforward", "full_model", "--out", "pid.yaml")
        snippet = (self.folder / "pid.yaml").read_text()
        self.assertIn("# Limited by ", snippet)
        self.assertIn("each model parameter was varied by up to 5 %", snippet)
        keys = snippet[snippet.index("pid:\n"):].replace("\n", "\n  ")
        rig = (self.folder / "config/rig.yaml").read_text()
        rig, count = re.subn(r"pid:\n(    \w+: \S+\n)+", keys.rstrip() + "\n", rig)
        self.assertEqual(count, 1)
        self.softgrip("check", self.write("config/tuned.yaml", rig))

    def test_json_contains_all_values_and_is_reproducible(self):
        first, second = (json.loads(self.tune("--out", name, "--json").stdout) for name in ("a.yaml", "b.yaml"))
        for key in ("schema", "kp_kpa_per_mm", "ki_kpa_per_mm_s", "kd_kpa_s_per_mm", "derivative_filter_s",
                    "sensitivity", "most_sensitivity", "crossover_hz", "rmse_mm", "rmse_exact_mm", "rmse_noise_mm"):
            self.assertIn(key, first)
        self.assertLessEqual(first["sensitivity"], first["most_sensitivity"])
        self.assertEqual(first | {"out": ""}, second | {"out": ""})
        self.assertEqual((self.folder / "a.yaml").read_text(), (self.folder / "b.yaml").read_text())

    def test_the_option_rig_sets_the_control_rate(self):
        done = self.tune("--rig", "config/rig.yaml", "--channel", "right", "--out", "-")
        self.assertIn("200 Hz", done.stdout)
        self.assertIn("pid:\n", done.stdout)

    def test_tune_rejects_invalid_options_and_files(self):
        for number in ("0", "-200", "nan", "inf", "fast", "1e9"):
            self.tune("--rate-hz", number, "--out", "pid.yaml", expect=2)
        for seed in ("-1", "18446744073709551616", "1.5"):
            self.tune("--seed", seed, "--out", "pid.yaml", expect=2)
        self.tune("--feedforward", "magic", "--out", "pid.yaml", expect=2)
        self.tune("--rig", "config/rig.yaml", "--channel", "thumb", "--out", "pid.yaml", expect=2)
        self.tune(expect=2)  # the option --out is missing
        for missing in (("tune", "--model", "absent.yaml"), ("tune", "--model", MODEL, "--rig", "absent.yaml")):
            done = self.softgrip(*missing, "--out", "pid.yaml", expect=4)
            self.assertIn("absent.yaml", done.stderr)
        self.write("file", "")
        self.tune("--out", "file/pid.yaml", expect=4)
        vacuum = (self.folder / "config/rig.yaml").read_text().replace("pressure_min_kpa: 0", "pressure_min_kpa: 20")
        low = self.tune("--rig", self.write("config/never_low.yaml", vacuum), "--pressure-max-kpa", "10", "--out", "pid.yaml",
                        expect=2)
        self.assertIn("--pressure-max-kpa 10 is not above the lowest pressure of the channel, 20 kPa", low.stderr)
        self.tune("--noise-mm", "nan", "--out", "pid.yaml", expect=2)
        bad = self.write("bad.yaml", "name: bad\nsource: x\nactuator:\n  - bouc_wenn: {}\n")
        self.assertIn("bad.yaml:4:5", self.softgrip("tune", "--model", bad, "--out", "pid.yaml", expect=3).stderr)
        rig = (self.folder / "config/rig.yaml").read_text().replace("rate_hz: 200", "rate_hz: -200")
        done = self.tune("--rig", self.write("config/slow.yaml", rig), "--out", "pid.yaml", expect=3)
        self.assertRegex(done.stderr, r"slow\.yaml:\d+:\d+: ")
        rig = (self.folder / "config/rig.yaml").read_text().replace('mode: "0660"', 'mode: "0666"')
        done = self.tune("--rig", self.write("config/open.yaml", rig), "--channel", "left", "--out", "pid.yaml")
        self.assertRegex(done.stderr, r"open\.yaml:\d+:\d+: .*everyone on this machine may move the gripper")
        (self.folder / "pid.yaml").unlink()
        # The model does not permit the requested feedforward. The command must refuse the input and state the reason.
        done = self.softgrip("tune", "--model", "config/models/zhang2025.yaml", "--feedforward", "full_model", "--out",
                             "pid.yaml", expect=3)
        self.assertIn("beta > alpha + 1/k0", done.stderr)
        self.assertFalse((self.folder / "pid.yaml").exists())


class Study(bench.BenchTest):

    def study(self, *arguments, expect=0):
        return self.softgrip("study", *arguments, expect=expect, timeout_s=170)

    def test_study_published_writes_numbers_and_a_report(self):
        done = self.study("published", "--starts", "2", "--out", "out")
        self.assertIn("report: out/report.html", done.stdout)
        numbers = json.loads((self.folder / "out/published.json").read_text())
        for key in ("schema", "software", "seed", "hidden_latency", "published_response", "inverse", "paper_rmse",
                    "published"):
            self.assertIn(key, numbers)
        self.assertEqual([row["paper_mm"] for row in numbers["paper_rmse"]], [0.194, 0.256, 0.540, 0.392])
        self.assertGreater(numbers["published"]["ratio"], 2)
        self.assert_is_report("out/report.html")

    def test_study_control_writes_numbers_and_a_report(self):
        done = self.study("control", "--draws", "2", "--frequencies-hz", "0.2", "--out", "out", "--json")
        numbers = json.loads(done.stdout)
        self.assertEqual(numbers, json.loads((self.folder / "out/control.json").read_text()))
        for key in ("schema", "software", "seed", "draws"):
            self.assertIn(key, numbers)
        self.assert_is_report("out/report.html")

    def assert_is_report(self, path):
        page = (self.folder / path).read_text()
        self.assertTrue(page.startswith("<!DOCTYPE html>"), page[:40])
        self.assertIn("<svg", page)
        self.assertNotRegex(page, r"<script|https?://(?!www\.w3\.org)")
        self.assertLess(len(page), 1.5e6)

    def test_study_rejects_invalid_options(self):
        for arguments in (("published",), ("control",), ("nothing", "--out", "o"), ()):
            self.study(*arguments, expect=2)
        for number in ("0", "-1", "nan", "many"):
            self.study("published", "--starts", number, "--out", "o", expect=2)
            self.study("control", "--draws", number, "--out", "o", expect=2)
            self.study("control", "--frequencies-hz", number, "--out", "o", expect=2)
        self.assertFalse((self.folder / "o").exists())
        self.write("file", "")
        for name in ("published", "control"):
            self.study(name, "--out", "file/inside", expect=4)


if __name__ == "__main__":
    bench.main()
