"""bench/measured.py as it is called, with a program in place of softgrip that answers at once."""
import contextlib
import io
import json
import stat

from measured_case import MeasuredCase

import measured
import measured_runs

# Says what it was called for, answers from a file, or refuses.
PROGRAM = """#!/bin/sh
command=$1 model=$3
[ "$command" != --version ] || exec echo softgrip 1.2.3
echo "$command" >> "{folder}/calls"
while [ $# -gt 0 ]; do
  case $1 in --data) log=$2 ;; --out) out=$2 ;; esac
  shift
done
if [ -e "{folder}/refuse" ]; then
  printf '%s:40:3: too few samples\\n    1,2\\n     ^\\n    hint: at least 50\\n1 error\\n' "$log" >&2
  exit 3
fi
case $command$model in tune*diagnosis*) exit 3 ;; tune*) exit 0 ;; esac
echo model > "$out/model.yaml"
cat "{folder}/$command.json"
"""
ANSWERS = {
    "identify": {"rmse_mm": {"log": 0.1}, "converged": True, "held_out": {"rmse_mm": {"log": 0.5}},
                 "structure": {"id": "bouc_wen", "description": "Bouc-Wen, creep ladder",
                               "candidates": [{"chosen": True, "heldout_rmse_mm": 0.3}]}},
    "diagnose": {"verdict": "partly_explained", "base": None, "noise_mm": 0.05, "null_calibration": None,
                 "causes": [{"id": "valve_lag", "inclusion": 0.97, "share_percent": 61.0}],
                 "alternatives": [["sensor_lag"]], "partial_causes": [],
                 "heldout_rmse_mm": {"as_given": 0.9, "recalibrated": 0.8, "extended": 0.4},
                 "budget": {"recalibrated": 0.64, "causes": {"valve_lag": {"value": 0.48, "ci95": [0.4, 0.6]}},
                            "left": 0.16, "noise": 0.0025}}}
SCIPY = "import json; print(json.dumps({'rmse_mm': 0.2, 'continuation_mm': 1.0}))"
TABLE = """\
title: Fingers of another house
same: {time: t_s, command: u_kpa, displacement: y_mm}
logs:
- {file: a.csv}
- {file: b.csv}
"""


class Campaign(MeasuredCase):
    def setUp(self):
        super().setUp()
        self.calls, self.program, scipy = (self.folder / name for name in ("calls", "softgrip", "scipy.py"))
        for command, answer in ANSWERS.items():
            (self.folder / f"{command}.json").write_text(json.dumps(answer))
        (self.folder / "out").mkdir()
        (self.folder / "out/simulator.so").write_text("not compiled here")
        self.program.write_text(PROGRAM.format(folder=self.folder))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)
        scipy.write_text(SCIPY)
        measured_runs.SCIPY, before = scipy, measured_runs.SCIPY
        self.addCleanup(setattr, measured_runs, "SCIPY", before)
        self.put_plain("a.csv")
        self.put_plain("b.csv")

    def run_it(self, table=TABLE, *options):
        """(exit code, what was printed, page)"""
        self.calls.write_text("")
        printed = io.StringIO()
        page = self.folder / "page.md"
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            code = measured.main([str(self.table_path(table)), str(self.data), "--softgrip", str(self.program), "--out",
                                  str(self.folder / "out"), "--page", str(page), *options])
        return code, printed.getvalue(), page.read_text() if page.exists() else ""

    def called(self):
        return self.calls.read_text().split()

    def test_the_page_has_what_the_runs_said(self):
        code, printed, page = self.run_it()
        self.assertEqual(code, 0, printed)
        self.assertEqual(sorted(self.called()), ["diagnose"] * 2 + ["identify"] * 10 + ["tune"] * 4)
        span = 10.02
        for text in ("# Fingers of another house", "from `table.yaml` with softgrip 1.2.3.", f"| {50 / span:.2f} |",
                     f"{100 / span:.2f}", "Bouc-Wen, creep ladder | 1.00 | 2.99 | 4.99 | - | - | yes |",
                     "`partly_explained`", "- | - | no |", "valve_lag or sensor_lag (inclusion 0.97, share 61 %)",
                     "0.48 (0.4 .. 0.6)",
                     "geometric mean of 2: all", "(page-held-out.svg)", "(page-budget.svg)"):
            self.assertIn(text, page)
        self.assertIn("[2/2] b: diagnosis_command: partly_explained valve_lag", printed)
        self.assertIn("<circle", (self.folder / "page-budget.svg").read_text())
        self.assertNotIn(str(self.folder), page)

    def test_what_was_done_is_not_done_again(self):
        first = self.run_it()
        again = self.run_it()
        self.assertEqual(self.called(), [])
        self.assertEqual(again[2], first[2])
        self.put_plain("b.csv", line50="4.8,1,2")
        self.run_it()
        self.assertEqual(len(self.called()), 8)
        (self.folder / "out/a/auto/outcome.json").write_text("{ interrupted")
        self.run_it()
        self.assertEqual(self.called(), ["identify"])
        self.program.write_text(self.program.read_text() + "# another version\n")
        self.run_it()
        self.assertEqual(len(self.called()), 16)

    def test_a_bad_log_spoils_its_own_row(self):
        self.put_plain("a.csv", line50="4.8,open,3")
        code, printed, page = self.run_it()
        self.assertEqual(code, 1, printed)
        self.assertIn("| a | the log | a.csv:50: column 'u_kpa': 'open' is no number |", page)
        self.assertEqual(len(self.called()), 8)
        self.assertIn("| b | 100 |", page)

    def test_a_mistake_in_the_table_spoils_its_own_row(self):
        code, _, page = self.run_it(TABLE.replace("b.csv}", "b.csv, splt: 0.4}"))
        self.assertEqual(code, 1)
        self.assertIn("| b | the log | table.yaml:5: 'splt' is no key here: is it 'split'? |", page)

    def test_what_the_program_refuses_names_the_file_that_was_given(self):
        (self.folder / "refuse").touch()
        self.put("remark\n" + (self.data / "a.csv").read_text(), "a.csv")
        code, _, page = self.run_it(TABLE, "--only", "a", "--no-diagnosis")
        self.assertEqual(code, 1)
        self.assertIn("identify, auto, bouc_wen, prandtl_ishlinskii | a.csv:41: too few samples<br>at least 50 |", page)
        self.assertIn("1 of the table's 2 logs", page)

    def test_an_answer_of_another_shape_spoils_its_own_cell(self):
        (self.folder / "diagnose.json").write_text('{"verdict": "adequate"}')
        code, _, page = self.run_it()
        self.assertEqual(code, 1)
        self.assertIn("| a | diagnosis_command | its answer was not understood: KeyError('causes') |", page)

    def test_what_cannot_be_run_at_all(self):
        self.assertEqual(self.run_it("logs: [")[0], 2)
        self.assertEqual(self.run_it(TABLE, "--softgrip", "none")[0], 2)
        self.data = self.folder / "none"
        self.assertEqual(self.run_it()[0], 4)
