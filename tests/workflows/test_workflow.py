"""Tests the workflow with small logs. Covers a table with a wrong row, a killed run that the next call continues, and
the steps that then run a second time."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build" / "release"))
RUN = SOURCE / "workflows/run.py"
TWIN = SOURCE / "config/models/bench_twin.yaml"
SLOW = "--starts 250"  # makes a step slow, so that the test can kill the run during this step


class Workflow(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.logs = tempfile.TemporaryDirectory(prefix="softgrip_workflow_")
        cls.addClassCleanup(cls.logs.cleanup)
        whole = pathlib.Path(cls.logs.name) / "whole.csv"
        subprocess.run([BUILD / "tools/softgrip", "simulate", "--model", TWIN, "--input", "tp1", "--rate-hz", "20",
                        "--noise-mm", "0.04", "--out", whole], check=True, capture_output=True)
        cls.log = "\n".join(whole.read_text().splitlines()[:500]) + "\n"

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="softgrip_workflow_")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def table(self, *rows, name="rows.csv"):
        path = self.folder / name
        path.write_text("name,task,data,model,baseline,options\n" + "".join(",".join(row) + "\n" for row in rows))
        return path

    def small_logs(self, *names):
        for name in names:
            (self.folder / name).write_text(self.log)

    def run_table(self, table, *arguments, expect=0, cwd=None):
        done = subprocess.run([sys.executable, RUN, table, "--out", self.folder / "out", "--cores", "2", "--build", BUILD,
                               *arguments], capture_output=True, text=True, timeout=100, cwd=cwd)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def told(self, task, name):
        return json.loads((self.folder / "out" / task / name / "row.json").read_text())

    def written(self):
        return {str(path.relative_to(self.folder / "out")): path.stat().st_mtime_ns
                for path in (self.folder / "out").glob("*/*/row.json")}

    def test_an_invalid_log_fails_only_its_own_row(self):
        self.small_logs("a.csv", "b.csv", "late.csv")
        (self.folder / "bad.csv").write_text("no log <b>at all</b>\n")
        table = self.table(("a", "identify", "a.csv", "", "", "--starts 3"), ("bad", "identify", "bad.csv", "", "", ""),
                           ("gone", "identify", "gone.csv", "", "", ""), ("twin", "diagnose", "b.csv", str(TWIN), "",
                                                                         "--no-closed-loop"),
                           ("finger", "baseline", "a.csv", str(TWIN), "", ""),
                           ("today", "diagnose", "late.csv", "", "@finger", ""))
        self.run_table(table, expect=6)
        counts = json.loads((self.folder / "out/overview.json").read_text())["counts"]
        self.assertEqual(counts, {"done": 4, "not_acceptable": 0, "failed": 2})
        self.assertRegex(self.told("identify", "a")["found"], r"^0\.0\d+ mm$")
        self.assertEqual(self.told("identify", "bad")["exit_code"], 3)
        self.assertIn("gone.csv", self.told("identify", "gone")["error"])
        self.assertEqual(self.told("diagnose", "today")["found"], "unchanged")
        page = (self.folder / "out/overview.html").read_text()
        self.assertIn('<a href="identify/a/result/report.html">a</a>', page)
        self.assertTrue((self.folder / "out/identify/a/result/report.html").exists())
        self.assertNotIn("<b>at all", page, "text from a log must not become markup")

        before = self.written()
        self.run_table(table, expect=6)
        self.assertEqual(self.written(), before, "no step is run twice")
        self.small_logs("bad.csv", "gone.csv")
        (self.folder / "b.csv").write_text(self.log[:self.log.rindex("\n", 0, -1) + 1])
        table.write_text(table.read_text().replace("--starts 3", "--starts 4"))
        self.run_table(table)
        again = {name for name, when in self.written().items() if when != before[name]}
        self.assertEqual(again, {f"{row}/row.json" for row in ("identify/a", "identify/bad", "identify/gone", "diagnose/twin")})

    def test_the_next_run_continues_a_killed_run(self):
        names = [f"log{i}" for i in range(5)]
        self.small_logs(*(f"{name}.csv" for name in names))
        table = self.table(*((name, "identify", f"{name}.csv", "", "", SLOW) for name in names))
        child = subprocess.Popen([sys.executable, RUN, table, "--out", self.folder / "out", "--cores", "2", "--build", BUILD],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        end = time.monotonic() + 60
        while len(self.written()) < 3 and time.monotonic() < end:
            time.sleep(0.01)
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        before = self.written()
        self.assertGreaterEqual(len(before), 3)
        self.assertLess(len(before), len(names), "the run was killed before its end")
        self.assertFalse((self.folder / "out/overview.html").exists())
        self.run_table(table)
        after = self.written()
        self.assertEqual(len(after), len(names))
        # Steps run on two cores. If the run is killed, Snakemake may not have recorded the last finished step of each
        # core. Up to two steps are therefore run twice.
        self.assertLessEqual(sum(after[name] != when for name, when in before.items()), 2,
                             "finished steps are not run again")
        self.assertEqual(list((self.folder / "out").glob("*/*/running-*")), [])

    def test_all_errors_of_a_table_are_reported_at_once(self):
        table = self.table(("a b", "identify", "", "", "", ""), ("x", "cook", "", "", "", ""),
                           ("y", "diagnose", "a.csv", "", "@x", ""), ("y", "identify", "'", "", "", ""))
        said = self.run_table(table, expect=3).stderr
        for line, what in ((2, "name 'a b'"), (2, "identify needs data"), (3, "task 'cook'"),
                           (4, "baseline @x: no row of that name has the task baseline"), (5, "name 'y' is already used in line 4"),
                           (5, "data: No closing quotation")):
            self.assertRegex(said, rf"rows\.csv:{line}: {what}")
        self.assertIn("no column 'task'", self.run_table(self.write("name\na\n"), expect=3).stderr)
        self.run_table(self.folder / "nowhere.csv", expect=4)

    def write(self, text):
        path = self.folder / "other.csv"
        path.write_text(text)
        return path

    def write_program(self, name):
        """Writes a program that accepts any command and computes nothing."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/sh\nexit 0\n")
        path.chmod(0o755)
        return path

    def test_a_changed_baseline_or_file_in_the_options_repeats_its_row(self):
        self.small_logs("a.csv", "other.csv", "again.csv")
        files = [self.folder / name for name in ("baselines/left/baseline.json", "notes.yaml", "again.csv", "run/run.csv")]
        for file in files:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(self.log)
        table = self.table(("month", "health", "a.csv", "", "baselines", "--notes notes.yaml"),
                           ("finger", "baseline", "a.csv", "", "", "--check run --gauge=again.csv"),
                           ("other", "identify", "other.csv", "", "", "--starts 3"))
        arguments = ("--program", str(self.write_program("tool")))
        self.run_table(table, *arguments)
        repeated = ["health/month", "health/month", "baseline/finger", "baseline/finger", "health/month"]
        for file, row in zip([*files, self.folder / "baselines/right/baseline.json"], repeated):
            with self.subTest(file=file.name):
                before = self.written()
                file.parent.mkdir(exist_ok=True)
                file.write_text(self.log + "\n")
                self.run_table(table, *arguments)
                self.assertEqual({name for name, when in self.written().items() if when != before[name]}, {f"{row}/row.json"})

    def test_the_error_of_a_log_in_degrees_has_this_unit(self):
        (self.folder / "angle.csv").write_text(self.log.replace("displacement_mm", "angle_deg", 1))
        self.run_table(self.table(("a", "identify", "angle.csv", "", "", "--starts 3")))
        self.assertRegex(self.told("identify", "a")["found"], r"^0\.0\d+ deg$")

    def test_the_path_of_the_program_is_relative_to_the_working_folder(self):
        self.small_logs("a.csv")
        program = self.write_program("bin/tool")
        table = self.table(("a", "identify", "a.csv", "", "", ""))
        said = self.run_table(table, "--program", "./missing", expect=4, cwd=program.parent).stderr
        self.assertIn("./missing: no such program", said)
        self.run_table(table, "--program", "./tool", cwd=program.parent)
        self.assertEqual(self.told("identify", "a")["command"][0], str(program.resolve()))

    def test_simulated_cases_are_rows_and_no_row_starts_after_its_deadline(self):
        self.small_logs("a.csv")
        table = self.table(("a", "identify", "a.csv", "", "", ""))
        said = self.run_table(table, "--until", "1", expect=1).stderr
        self.assertIn("0 of 1 rows are there", said)
        self.run_table(table)
        worlds = self.write('name\ttask\tjudge\tworld\nw\tworld\tjudging\t{"causes": 3}\n').rename(self.folder / "worlds.tsv")
        self.run_table(worlds, expect=6)
        self.assertIn("KeyError", self.told("world", "w")["error"])


if __name__ == "__main__":
    unittest.main()
