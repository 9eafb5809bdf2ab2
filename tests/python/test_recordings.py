"""Tests the functions that read recordings and reports into arrays."""

import contextlib
import io
import json
import os
import pathlib
import random
import runpy
import sys
import tempfile
import threading
import unittest

import numpy as np
import package
import softgrip

from softgrip.recordings import Recording, read_columns, read_report

RUN = """time_s,channel,pressure_command_kpa,displacement_mm,result
0,left,0,,none
0,right,1,2,none
0.5,left,10.5,3.25,holding
0.5,right,11,4,released
"""
ABOUT = {"rate_hz": 2, "decimation": 1, "channels": ["left", "right"], "sequence": {"name": "pick"}}


class Recordings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "run.json").write_text(json.dumps(ABOUT))

    def write(self, text):
        (self.folder / "run.csv").write_text(text)

    def test_a_recording_is_split_into_columns_per_finger(self):
        self.write(RUN)
        recording = Recording.read(self.folder)
        self.assertEqual(list(recording.channels), ["left", "right"])
        left = recording.channels["left"]
        np.testing.assert_array_equal(left["time_s"], [0, 0.5])
        np.testing.assert_array_equal(left["displacement_mm"], [np.nan, 3.25])
        self.assertEqual(left["result"].tolist(), ["none", "holding"])
        self.assertNotIn("channel", left)

    def test_the_name_of_a_finger_may_be_a_number(self):
        self.write(RUN.replace("left", "1").replace("right", "02"))
        channels = Recording.read(self.folder).channels
        self.assertEqual(list(channels), ["1", "02"])
        np.testing.assert_array_equal(channels["02"]["time_s"], [0, 0.5])

    def test_a_byte_order_mark_is_not_part_of_the_first_name(self):
        self.write("\ufefftime_s,displacement_mm\n0,1\n")
        self.assertEqual(list(read_columns(self.folder / "run.csv")), ["time_s", "displacement_mm"])

    def test_an_invalid_path_is_rejected(self):
        for call in (read_columns, read_report, Recording.read):
            for bad in (0, None, b"run.csv", "\ud800", "a\0b"):
                with self.assertRaises(softgrip.InvalidArgument):
                    call(bad)

    def test_an_incomplete_last_line_is_skipped(self):
        self.write(RUN + "1,left,1")
        self.assertEqual(len(read_columns(self.folder / "run.csv")["time_s"]), 4)

    def test_a_line_with_missing_cells_is_reported_with_its_number(self):
        self.write(RUN + "1,left,1\n1,right,1,2,none\n")
        with self.assertRaisesRegex(ValueError, "run.csv:6: 3 cells, the header has 5"):
            read_columns(self.folder / "run.csv")

    def test_a_csv_without_rows_is_accepted_and_without_header_rejected(self):
        self.write("time_s,displacement_mm\n")
        self.assertEqual({k: len(v) for k, v in read_columns(self.folder / "run.csv").items()},
                         {"time_s": 0, "displacement_mm": 0})
        self.write("")
        with self.assertRaisesRegex(ValueError, "no header"):
            read_columns(self.folder / "run.csv")

    def test_a_csv_without_a_channel_column_belongs_to_the_first_finger(self):
        self.write("time_s,displacement_mm\n0,1\n")
        self.assertEqual(Recording.read(self.folder).channels["left"]["displacement_mm"].tolist(), [1])

    def test_lists_of_numbers_in_a_report_are_arrays(self):
        report = self.folder / "identify.json"
        report.write_text(json.dumps({"a": [1, 2.5], "b": [[1], ["x"]], "c": {"d": []}, "e": [True]}))
        read = read_report(report)
        np.testing.assert_array_equal(read["a"], [1, 2.5])
        np.testing.assert_array_equal(read["b"][0], [1])
        self.assertEqual((read["b"][1], read["c"], read["e"]), (["x"], {"d": []}, [True]))

    def test_a_named_pipe_is_rejected_without_blocking(self):
        self.write(RUN)
        for name, read in (("run.csv", read_columns), ("run.json", read_report)):
            (self.folder / name).unlink()
            os.mkfifo(self.folder / name)
            for call in (lambda: read(self.folder / name), lambda: Recording.read(self.folder)):
                # The package must refuse a named pipe. If the package waited for a writer, it would block this
                # test forever. The timer therefore opens the pipe for writing after 5 s.
                writer = threading.Timer(5, lambda: os.close(os.open(self.folder / name, os.O_RDWR)))
                writer.daemon = True
                writer.start()
                with self.assertRaisesRegex(OSError, f"not a regular file.*{name}"):
                    call()
                writer.cancel()
            (self.folder / name).unlink()
            self.write(RUN)

    def test_an_endless_or_too_large_file_is_rejected(self):
        with self.assertRaisesRegex(OSError, "not a regular file"):
            read_columns("/dev/zero")
        with open(self.folder / "run.csv", "w") as file:
            file.truncate(1 << 40)
        with self.assertRaisesRegex(OSError, "larger than"):
            read_columns(self.folder / "run.csv")

    def malformed(self, text):
        return self.assertRaisesRegex(softgrip.MalformedFile, text)

    def test_a_malformed_csv_raises_malformed_file(self):
        path = self.folder / "run.csv"
        for content, text in ((b"time_s\n\xff\xfe\n", "not text in UTF-8"), (b"\n", "no header"),
                              (b"a,b,a\n1,2,3\n", "column 'a' exists more than once"),
                              (b"a\n\"" + b"x" * 200_000 + b"\"\n", r"run\.csv:2: field larger"),
                              (b"a,b\n1,2\n\n3,4\n", r"run\.csv:3: 0 cells, the header has 2"),
                              (b"a,b\n1,\xe2\x80\xa82\n3\n", r"run\.csv:3: 1 cells")):
            path.write_bytes(content)
            with self.subTest(text), self.malformed(text):
                read_columns(path)

    def test_a_malformed_report_raises_malformed_file(self):
        path = self.folder / "run.json"
        self.write(RUN)
        for content, text in ((b"", "not JSON"), (b"{", "not JSON"), (b"[" * 200_000, "not JSON"),
                              (b"\xff", "not text in UTF-8"), (b"[1]", "not a JSON object"), (b"7", "not a JSON object")):
            path.write_bytes(content)
            for read in (lambda: read_report(path), lambda: Recording.read(self.folder)):
                with self.subTest(text), self.malformed(text):
                    read()

    def test_a_recording_without_finger_names_raises_malformed_file(self):
        self.write("time_s,displacement_mm\n0,1\n")
        for about in ({}, {"channels": []}, {"channels": "left"}, {"channels": None}):
            (self.folder / "run.json").write_text(json.dumps(about))
            with self.subTest(about), self.malformed("lists no finger"):
                Recording.read(self.folder)

    def test_damaged_bytes_raise_only_malformed_file(self):
        for seed in range(300):
            chance = random.Random(seed)
            for name, whole in (("run.csv", RUN), ("run.json", json.dumps(ABOUT))):
                text = bytearray(whole.encode())
                at = chance.randrange(len(text))
                text[at:at + chance.randrange(4)] = bytes(chance.randrange(256) for _ in range(chance.randrange(4)))
                (self.folder / name).write_bytes(text)
            with self.subTest(seed=seed), contextlib.suppress(softgrip.MalformedFile):
                Recording.read(self.folder)

    def test_the_example_program_summarises_a_recording(self):
        self.write(RUN)
        said = io.StringIO()
        argv, sys.argv = sys.argv, ["read_recording.py", str(self.folder)]
        try:
            with contextlib.redirect_stdout(said):
                runpy.run_path(str(package.SOURCE / "python/examples/read_recording.py"), run_name="__main__")
        finally:
            sys.argv = argv
        self.assertEqual(said.getvalue(), "pick, 2 Hz\nleft: at most 10.5 kPa, 3.25 mm, held for 0.50 s\n"
                         "right: at most 11.0 kPa, 4.00 mm, held for 0.00 s\n")


if __name__ == "__main__":
    unittest.main()
