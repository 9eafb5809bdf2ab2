"""Tests softgrip diagnose --explain, which prints the comparisons behind every reported cause. The output
lists the comparisons by run and by cause. Checks the text on the screen and the files."""

import json

import bench

GIVEN, TWIN = "config/models/zhang2025.yaml", "config/models/bench_twin.yaml"


class Explain(bench.BenchTest):

    def diagnosed(self, logs):
        for seed, log in enumerate(logs, 1):
            self.softgrip("simulate", "--model", TWIN, "--input", log, "--out", f"{log}.csv", "--noise-mm", "0.1", "--seed",
                          str(seed))
        text = self.softgrip("diagnose", "--model", GIVEN, "--data", *(f"{log}.csv" for log in logs), "--no-closed-loop",
                             "--out", "out", "--explain", timeout_s=170).stdout
        return text, json.loads((self.folder / "out/diagnosis.json").read_text())

    def test_explain_lists_the_errors_of_each_run_and_all_tested_causes(self):
        text, found = self.diagnosed(["tp1", "sp2"])
        self.assertEqual([run["run"] for run in found["runs"]], ["tp1", "sp2"])
        for run in found["runs"]:
            self.assertLess(run["extended_rmse_mm"], run["recalibrated_rmse_mm"], run)
            self.assertRegex(text, rf"(?m)^  {run['run']} .*{run['extended_rmse_mm']:.3g}$")
        named = [cause["id"] for cause in found["causes"]]
        self.assertIn("transport_delay", named)
        for cause in named:
            self.assertRegex(text, rf"Causes tested as alternatives to {cause}\n(?s:.*)\n  {cause} .* named\n")
        for candidate in found["candidates"]["transport_delay"]:
            self.assertIn(f"\n  {candidate['id']} ", text)
        self.assertIn("error by run", (self.folder / "out/report.html").read_text())

    def test_a_single_log_is_split_into_two_halves_as_runs(self):
        _, found = self.diagnosed(["sp2"])
        self.assertEqual([run["run"] for run in found["runs"]], ["first half", "second half"])
