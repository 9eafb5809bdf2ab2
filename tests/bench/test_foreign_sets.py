"""Tests bench/foreign/set_table.py: how the program reads tables of data sets, and which messages it prints about
mistakes in these tables."""
import pathlib

from foreign_case import BENCH, ForeignCase

import set_table
from log_table import Unusable

LOGS = """\
same: {time: t_s, command: u_kpa, displacement: y_mm}
logs: [{file: a.csv}, {file: b.csv}, {file: c.csv}]
"""


class Sets(ForeignCase):
    def read_set(self, text):
        return set_table.read_set(self.table_path(LOGS + text), self.data)

    def assert_says(self, items, *words):
        said = "\n".join(problem for item in items for problem in item.problems).replace(f"{self.folder}/", "")
        for word in words:
            self.assertIn(word, said)

    def test_repeats_changes_loops_and_fits_are_read(self):
        found = self.read_set(
            "source: a laboratory\nlicence: MIT\n"
            "repeats: [{baseline: a, later: b, because: same day}]\n"
            "changes: [{baseline: [a, b], later: c, label: a weight, causes: payload, because: labelled}]\n"
            "stiction: [{logs: '[ab]', sticks: true}, {logs: c, sticks: false}]\n"
            "identification: [{log: a}, {log: b, test: c, order: 2}]\n")
        self.assertEqual((found.source, found.licence, list(found.logs)), ("a laboratory", "MIT", ["a", "b", "c"]))
        repeat, change = found.repeats[0], found.changes[0]
        self.assertEqual((repeat.name, repeat.baseline, repeat.later, repeat.group), ("a -> b", ["a"], "b", "runs"))
        self.assertEqual((change.name, change.causes, change.label), ("a + b -> c", ("payload",), "a weight"))
        self.assertEqual([(loop.log, loop.sticks) for loop in found.loops], [("a", True), ("b", True), ("c", False)])
        self.assertEqual([(fit.log, fit.test, fit.order) for fit in found.fits], [("a", "", 0), ("b", "c", 2)])
        items = (*found.repeats, *found.changes, *found.loops, *found.fits)
        self.assertEqual([problem for item in items for problem in item.problems], [])

    def test_every_log_is_identified_without_the_key_identification(self):
        self.assertEqual([fit.log for fit in self.read_set("title: x\n").fits], ["a", "b", "c"])
        self.assertEqual(self.read_set("identification: []\n").fits, [])

    def test_an_error_in_a_pair_is_reported_with_file_and_line(self):
        found = self.read_set("repeats:\n- baseline: [a, d]\n  later: b\n- {baseline: a, later: a, becuase: x}\n")
        self.assert_says(found.repeats[:1], "table.yaml:4: baseline: no log is named 'd'", "'because' is missing")
        self.assert_says(found.repeats[1:], "table.yaml:6: later: 'a' belongs to its own baseline",
                         "table.yaml:6: 'becuase' is no key here: is it 'because'?")

    def test_errors_in_a_change_a_loop_and_a_fit_are_reported(self):
        found = self.read_set("changes: [{baseline: a, later: b, because: x, causes: [backlsh]}]\n"
                              "stiction:\n- {logs: stic_*, sticks: 'yes'}\n"
                              "identification: [{log: a, order: 9}]\n")
        self.assert_says(found.changes, "table.yaml:3: causes: 'backlsh' is no cause: is it 'backlash'?",
                         "table.yaml:3: 'label' is missing")
        self.assert_says(found.loops, "table.yaml:5: logs: no log fits 'stic_*'", "table.yaml:5: 'sticks' is true or false")
        self.assert_says(found.fits, "table.yaml:6: order: 9 is not 1, 2, 3 or 4")

    def test_repeats_and_changes_must_be_lists_of_mappings(self):
        for text in ("repeats: a\n", "changes: [a]\n"):
            with self.assertRaises(Unusable) as caught:
                self.read_set(text)
            self.assertIn("table.yaml:3:", str(caught.exception))

    def test_all_tables_of_this_project_are_valid(self):
        sets, problems = set_table.find_sets([BENCH / "foreign/data"], BENCH / "foreign/sets", self.folder)
        self.assertEqual((problems, sorted(s.name for s in sets)), ([], ["hydraulic", "piezo", "stiction"]))
        sets.append(set_table.read_set(BENCH / "foreign/sets/asu_softarm.yaml", self.data))
        for found in sets:
            items = [*found.logs.values(), *found.repeats, *found.changes, *found.loops, *found.fits]
            self.assertGreater(len(items), 0)
            self.assertEqual([problem for item in items for problem in item.problems], [])
            self.assertTrue(found.licence and found.source and found.about)
        runs = {len(pair.baseline) for found in sets for pair in found.repeats if pair.group == "runs"}
        self.assertGreaterEqual(runs, {1, 2, 3})
        for found in sets[:3]:
            self.assertTrue((BENCH / "foreign/data" / found.name / "LICENSE").is_file())


class Folders(ForeignCase):
    def find(self):
        sets, problems = set_table.find_sets([self.data], self.folder / "tables", self.folder / "scratch")
        return {s.name: s for s in sets}, problems

    def put_log(self, folder, name="a.csv"):
        (self.data / folder).mkdir(exist_ok=True)
        (self.data / folder / name).write_text("time_s,pressure_command_kpa,displacement_mm,note\n0,1,2,x\n1,2,3,y\n")

    def test_logs_in_a_folder_without_a_table_are_only_identified(self):
        self.put_log("new")
        (self.data / "new/other.csv").write_text("t,u\n0,1\n")
        (self.data / "notes").mkdir()
        sets, problems = self.find()
        self.assertEqual((problems, list(sets)), ([], ["new"]))
        self.assertEqual(([fit.log for fit in sets["new"].fits], sets["new"].repeats), (["a"], []))
        self.assertEqual(sorted(sets["new"].logs["a"].columns), ["command", "displacement", "time"])

    def test_the_root_folder_and_a_folder_with_a_table_are_sets(self):
        self.put_log("own")
        (self.data / "own/foreign.yaml").write_text(
            "title: Mine\nlogs:\n"
            "- {file: a.csv, time: time_s, command: pressure_command_kpa, displacement: displacement_mm}\n")
        self.put_log(".")
        sets, problems = self.find()
        self.assertEqual((problems, sets["own"].title, list(sets)), ([], "Mine", ["data", "own"]))

    def test_an_invalid_table_excludes_only_its_own_set(self):
        self.put_log("good")
        self.put_log("bad")
        (self.data / "bad/foreign.yaml").write_text("logs: [")
        sets, problems = self.find()
        self.assertEqual(list(sets), ["good"])
        self.assertIn("foreign.yaml:1:", problems[0])
        self.assertIsInstance(sets["good"].folder, pathlib.Path)
