"""Tests bench/foreign/log_table.py: the values that the program reads from a table, and its messages about mistakes in
the table."""
from foreign_case import BENCH, ForeignCase

import log_table


class Tables(ForeignCase):
    def problems(self, text):
        return "\n".join(self.table(text).logs[0].problems).replace(f"{self.folder}/", "")

    def assert_unusable(self, text, *words):
        with self.assertRaises(log_table.Unusable) as caught:
            self.table(text)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_keys_under_same_apply_to_every_log(self):
        logs = self.table("""\
            same: {time: t_s, command: u_kpa, displacement: y_mm, split: 0.6, begin: rest}
            logs:
            - file: a.csv
            - {file: b.csv, name: second, split: 0.4}
            """).logs
        self.assertEqual([(log.name, log.split, log.begin) for log in logs],
                         [("a", 0.6, "rest"), ("second", 0.4, "rest")])
        self.assertEqual([log.problems for log in logs], [[], []])

    def test_a_file_pattern_adds_one_log_for_each_matching_file(self):
        for name in ("x2.csv", "x1.csv", "y.csv"):
            self.put_plain(name)
        logs = self.table("logs: [{file: 'x*.csv', time: t_s, command: u_kpa, displacement: y_mm}]").logs
        self.assertEqual([log.name for log in logs], ["x1", "x2"])

    def test_the_example_table_of_the_how_to_guide_is_valid(self):
        page = (BENCH.parent / "docs/how-to/measure.md").read_text()
        logs = self.table(page.split("```yaml\n")[1].split("```")[0]).logs
        self.assertEqual([log.name for log in logs], ["day1/*.csv", "second day"])
        self.assertEqual([log.problems for log in logs], [[], []])
        for key in (*log_table.KEYS, *log_table.COLUMN_KEYS):
            self.assertIn(f"`{key}`", page)

    def test_errors_are_reported_with_line_and_suggestion(self):
        said = self.problems("""\
            logs:
            - file: a.csv
              tiem: t_s
              command: {column: u, unit: ft}
              displacement: {colunm: y, unit: mm}
              split: 1.5
              begin: anywhere
              separator: ", "
              from_s: soon
            """)
        for line in ("table.yaml:3: 'tiem' is no key here: is it 'time'?",
                     "table.yaml:4: unit: 'ft' is no unit of a pressure",
                     "table.yaml:5: 'colunm' is no key here: is it 'column'?",
                     "table.yaml:5: displacement: no column",
                     "table.yaml:6: split: 1.5 is not between", "table.yaml:7: begin: 'anywhere' is not one of auto,",
                     "table.yaml:8: separator", "table.yaml:9: from_s: 'soon'", "table.yaml:2: 'time' is missing"):
            self.assertIn(line, said)

    def test_a_log_without_command_and_pressure_is_reported(self):
        said = self.problems("logs: [{file: a.csv, time: t_s, displacement: y_mm}]")
        self.assertIn("neither 'command' nor 'pressure'", said)

    def test_a_duplicate_log_name_is_reported_and_made_unique(self):
        logs = self.table("""\
            same: {file: a.csv, time: t_s, command: u_kpa, displacement: y_mm}
            logs: [{split: 0.4}, {split: 0.6}]
            """).logs
        self.assertEqual(logs[0].problems, [])
        self.assertIn("a second log is named 'a'", logs[1].problems[0])
        self.assertNotEqual(logs[0].name, logs[1].name)

    def test_an_empty_or_malformed_table_is_rejected(self):
        self.assert_unusable("logs: [", "table.yaml:1:")
        self.assert_unusable("", "no list `logs`")
        self.assert_unusable("log: []", "no list `logs`")
        self.assert_unusable("logs: [a.csv]", "log 1 is 'a.csv'")
        self.assert_unusable("logs: [{file: a.csv}]\ntitel: x", "table.yaml:2: 'titel'", "is it 'title'?")
        with self.assertRaises(log_table.Unusable):
            log_table.read_table(self.folder / "none.yaml", self.data)
