"""Tests bench/foreign.py as a user calls it. A small program replaces softgrip and answers immediately."""
import contextlib
import importlib.util
import io
import json
import stat
import unittest

from foreign_case import ForeignCase

if importlib.util.find_spec("scipy"):
    import foreign

# This program replaces softgrip. It records its arguments, writes a model, and prints an answer that it reads from a
# file. It refuses the log whose name is in the file `refuse`.
PROGRAM = """#!/usr/bin/python3
import json, pathlib, sys
folder, words = pathlib.Path("{folder}"), sys.argv[1:]
if words == ["--version"]:
    print("softgrip 1.2.3")
    sys.exit()
def of(option):
    if option not in words:
        return []
    rest = words[words.index(option) + 1:]
    end = next((i for i, word in enumerate(rest) if word.startswith("--")), len(rest))
    return [pathlib.Path(word).stem for word in rest[:end]]
with open(folder / "calls", "a") as calls:
    calls.write(words[0] + " " + ",".join(of("--healthy") + of("--data")) + "\\n")
data = words[words.index("--data") + 1]
refuse = folder / "refuse"
if refuse.exists() and refuse.read_text() in of("--data"):
    sys.exit(f"{{data}}:40:3: too few samples")
out = pathlib.Path(words[words.index("--out") + 1])
(out / "model.yaml").write_text("model")
if words[0] == "identify":
    held = {{"rmse_mm": {{name: 0.9 if name == "c" else 0.3 for name in of("--validate")}}}}
    print(json.dumps({{"rmse_mm": {{name: 0.1 for name in of("--data")}}, "validation": held,
                      "held_out": {{"rmse_mm": {{name: 0.001 for name in of("--data")}}}},
                      "structure": {{"description": "play operators"}}}}))
else:
    print((folder / "diagnose.json").read_text())
"""
DIAGNOSIS = {"verdict": "cause_found", "causes": [{"id": "sensor_drift", "size": {"value": 1.25, "unit": "mm"}}],
             "alternatives": [["backlash"]], "wall_s": 1}
TABLE = """\
title: Another laboratory
source: somewhere
licence: MIT
same: {time: t_s, command: u_kpa, displacement: y_mm}
logs: [{file: a.csv}, {file: b.csv}, {file: c.csv}]
repeats:
- {baseline: a, later: b, because: same day}
- {baseline: [a, b], later: c, because: same day}
changes:
- {baseline: [a, b], later: c, label: a worn gear, causes: backlash, because: labelled}
"""


@unittest.skipUnless(importlib.util.find_spec("scipy"), "python3-scipy is not installed")
class Command(ForeignCase):
    def setUp(self):
        super().setUp()
        self.program = self.folder / "softgrip"
        self.program.write_text(PROGRAM.format(folder=self.folder))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)
        self.answer(DIAGNOSIS)
        for name in ("a.csv", "b.csv", "c.csv"):
            self.put_plain(name)
        self.out, self.page = self.folder / "out", self.folder / "page.md"

    def answer(self, diagnosis):
        (self.folder / "diagnose.json").write_text(json.dumps(diagnosis))

    def run_it(self, *options, table=TABLE):
        """Runs foreign.py and returns (exit code, printed text)."""
        (self.data / "foreign.yaml").write_text(table)
        (self.folder / "calls").write_text("")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            code = foreign.main(["--data", str(self.data), "--softgrip", str(self.program), "--out", str(self.out),
                                 "--reference", str(self.folder / "reference.json"), "--page", str(self.page), *options])
        return code, printed.getvalue()

    def calls(self):
        return (self.folder / "calls").read_text().splitlines()

    def results(self):
        return json.loads((self.out / "results.json").read_text())

    def test_pairs_are_identified_diagnosed_and_counted(self):
        code, printed = self.run_it("--only", "repeats", "changes")
        self.assertEqual(code, 0, printed)
        self.assertIn("diagnose a,b", self.calls())
        self.assertEqual(self.calls().count("diagnose a,b,c"), 2)
        results = self.results()
        self.assertEqual(results["softgrip"]["version"], "softgrip 1.2.3")
        self.assertEqual(results["summary"]["repeats"]["runs"]["changed"], 2)
        self.assertEqual(results["summary"]["changes"]["named_or_listed"], 1)
        case = results["cases"][2]
        self.assertEqual((case["baseline_runs"], case["plain"]["left_out_mm"], case["exceeds_spread"]),
                         (2, [0.3, 0.3], True))
        self.assertAlmostEqual(case["plain"]["over_bound"], 3)
        self.assertTrue(all(case["load_1min"] is not None and case["wall_s"] >= 0 for case in results["cases"]))
        page = self.page.read_text()
        for text in ("2 of 2 repeated runs without a change are reported as changed. The labelled cause is named or listed for 1 of 1", "| softgrip 1.2.3 | ", "| runs without a change: reported as changed | at most 1 of 12 | 2 of 2 |",
                     "sensor_drift or backlash (1.25 mm)", "| a worn gear | backlash |", "Another laboratory"):
            self.assertIn(text, page)
        self.assertIn("[3/3] changes data: a + b -> c ... changed: sensor_drift (listed)", printed)

    def test_a_control_loop_is_diagnosed_and_judged_for_stiction(self):
        code, printed = self.run_it("--only", "stiction", table=TABLE + "stiction: [{logs: a, sticks: true}]\n")
        self.assertEqual(code, 0, printed)
        self.assertEqual(self.calls(), ["identify a", "diagnose a"])
        self.assertEqual(self.results()["summary"]["stiction"]["sticking"]["stiction_named"], 0)
        self.assertIn("| a | sticks | cause_found | sensor_drift or backlash (1.25 mm) |", self.page.read_text())

    def test_identification_is_compared_with_output_error_and_scipy_models(self):
        fits = "identification: [{log: a}, {log: a, test: c}]\n"
        code, printed = self.run_it("--only", "identification", table=TABLE + fits)
        self.assertEqual(code, 0, printed)
        self.assertEqual(self.calls(), ["identify a"] * 4)
        first, second = (case["rows"][0]["methods"] for case in self.results()["cases"])
        self.assertEqual((first["auto"]["held_out_mm"], second["plain"]["held_out_mm"]), (0.001, 0.9))
        for methods in (first, second):
            # The readings are the pressure times 0.25 mm/kPa, plus a sawtooth with an amplitude of 0.01 mm.
            self.assertLess(methods["output_error"]["held_out_mm"], 0.02)
            self.assertLess(methods["scipy"]["held_out_mm"], 0.05)
        self.assertEqual(self.results()["summary"]["identification"]["linear_better"], {"plain": 1, "auto": 1})
        self.assertIn("| yes | play operators |", self.page.read_text())

    def test_a_failed_method_does_not_affect_the_other_methods(self):
        self.put_plain("d.csv", line50="4.8,1,2")
        (self.folder / "refuse").write_text("d")
        table = TABLE.replace("{file: c.csv}", "{file: c.csv}, {file: d.csv}") + "identification: [{log: d}]\n"
        code, printed = self.run_it("--only", "identification", table=table)
        self.assertEqual(code, 1, printed)
        row = self.results()["cases"][0]["rows"][0]
        self.assertEqual((sorted(row["errors"]), sorted(row["methods"])), (["auto", "plain"], ["output_error", "scipy"]))
        self.assertIn("d.csv:40: too few samples", self.page.read_text())

    def test_the_page_shows_the_reference_results_in_a_separate_column(self):
        self.run_it("--only", "repeats")
        (self.folder / "reference.json").write_text((self.out / "results.json").read_text())
        self.answer({**DIAGNOSIS, "verdict": "unchanged", "causes": [], "alternatives": []})
        self.program.write_text(self.program.read_text().replace("1.2.3", "1.2.4"))
        self.run_it("--only", "repeats")
        self.assertIn("| criterion | required | reference: softgrip 1.2.3 | reached |", self.page.read_text())
        self.assertIn("| at most 1 of 12 | 2 of 2 | 0 of 2 |", self.page.read_text())

    def test_a_cached_call_is_repeated_only_if_a_log_has_changed(self):
        self.run_it("--only", "repeats")
        self.run_it("--only", "repeats")
        self.assertEqual(self.calls(), [])
        self.put_plain("b.csv", line50="4.8,1,2")
        self.run_it("--only", "repeats")
        self.assertGreater(len(self.calls()), 0)

    def test_a_refused_log_fails_only_the_cases_with_this_log(self):
        (self.folder / "refuse").write_text("a")
        self.put_plain("a.csv", line2="0.0,1,2")
        table = TABLE.replace("- {baseline: a, later: b,", "- {baseline: b, later: c,")
        code, printed = self.run_it("--only", "repeats", table=table)
        self.assertEqual(code, 1, printed)
        cases = self.results()["cases"]
        self.assertNotIn("error", cases[0])
        self.assertIn("a.csv:40: too few samples", cases[1]["error"])
        self.assertIn("too few samples", self.page.read_text())
        self.assertEqual(self.results()["summary"]["repeats"]["runs"]["failed"], 1)

    def test_an_error_in_the_table_fails_only_the_affected_case(self):
        code, _ = self.run_it("--only", "repeats", table=TABLE.replace("later: b,", "later: d,"))
        self.assertEqual(code, 1)
        cases = self.results()["cases"]
        self.assertIn("foreign.yaml:7: later: no log is named 'd'", cases[0]["error"])
        self.assertNotIn("error", cases[1])

    def test_a_diagnosis_without_required_keys_fails_the_case(self):
        self.answer({"verdict": "unchanged"})
        code, _ = self.run_it("--only", "repeats")
        self.assertEqual(code, 1)
        self.assertIn("KeyError", self.results()["cases"][0]["error"])

    def test_cases_are_chosen_by_patterns(self):
        self.run_it("--cases", "data/a -> *", "--only", "repeats")
        self.assertEqual([case["case"] for case in self.results()["cases"]], ["a -> b"])

    def test_a_missing_program_or_data_folder_exits_with_code_4(self):
        self.assertEqual(self.run_it("--softgrip", "none")[0], 4)
        self.data.joinpath("foreign.yaml").write_text(TABLE)
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(foreign.main(["--data", str(self.folder / "none"), "--out", str(self.out)]), 4)
