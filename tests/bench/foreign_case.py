"""Writes a folder with a table and logs, for the tests of bench/foreign.py."""
import math
import pathlib
import sys
import tempfile
import textwrap
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
sys.path[:0] = [str(BENCH), str(BENCH / "foreign")]

import log_reading  # noqa: E402
import log_table  # noqa: E402

SAMPLES = 100


def kpa(i):
    return 20 - 20 * math.cos(0.2 * i)


def mm(i):
    return 0.25 * kpa(i) + 0.01 * (i % 3)


def log_text(head, row, samples=SAMPLES):
    """Returns the text of a log. The first line of the log is `head`. row(i) returns the line of sample i."""
    return "\n".join([head, *(row(i) for i in range(samples))]) + "\n"


class ForeignCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.data = self.folder / "data"
        self.data.mkdir()

    def put(self, text, name="a.csv"):
        (self.data / name).write_bytes(text if isinstance(text, bytes) else text.encode())

    def put_plain(self, name="a.csv", **changed):
        """Writes a log in the units of the project. `changed` maps a line number (key line1, line2, ...) to the new
        text of the line."""
        lines = log_text("t_s,u_kpa,y_mm", lambda i: f"{0.1 * i:.1f},{kpa(i):.4f},{mm(i):.4f}").splitlines()
        for number, line in changed.items():
            lines[int(number.removeprefix("line")) - 1] = line
        self.put("\n".join(lines) + "\n", name)

    def table_path(self, text):
        path = self.folder / "table.yaml"
        path.write_text(textwrap.dedent(text))
        return path

    def table(self, text):
        return log_table.read_table(self.table_path(text), self.data)

    def read(self, keys):
        """Returns the first log of a table. `keys` contains the YAML lines of the table entry of this log."""
        entry = self.table("logs:\n- file: a.csv\n" + textwrap.indent(textwrap.dedent(keys), "  ")).logs[0]
        return log_reading.read_log(entry, self.data)

    def spoiled(self, keys):
        """Asserts that the first log of the table cannot be used, and returns the message."""
        with self.assertRaises(log_reading.Spoiled) as caught:
            self.read(keys)
        return str(caught.exception).replace(f"{self.data}/", "").replace(f"{self.folder}/", "")

    def assert_log(self, log, samples=SAMPLES):
        """Asserts that the log consists of the first `samples` samples that put_plain() writes."""
        self.assertEqual(len(log.time_s), samples)
        for i in range(samples):
            self.assertAlmostEqual(log.time_s[i], 0.1 * i, 6)
            self.assertAlmostEqual(log.columns["command"][i], kpa(i), 2)
            self.assertAlmostEqual(log.columns["displacement"][i], mm(i), 2)
