"""Tests softgrip import as a user runs it. Covers imports of external files, the questions of the command, stored
answers, and refusals."""

import json
import os
import pty
import re
import subprocess

import bench
import foreign_files


class Matrix(bench.BenchTest):

    def test_every_file_is_imported_or_rejected_as_the_page_states(self):
        results = [(file, foreign_files.outcome(file, self.folder)) for file in foreign_files.files()]
        self.assertEqual([f"{file.name}: {wrong}" for file, (wrong, _, _) in results if wrong], [])
        self.assertGreaterEqual(len(results), 30)
        self.assertEqual(foreign_files.PAGE.read_text(), foreign_files.page(results),
                         "docs/reference/foreign-files.md is out of date. Update it with: tests/system/foreign_files.py --page")


class Import(bench.BenchTest):

    def foreign(self, name):
        return next(file for file in foreign_files.files() if file.name == name).make(self.folder)

    def imported(self, *arguments, expect=0):
        return self.softgrip("import", *arguments, expect=expect)

    def test_import_without_a_terminal_prints_the_options_and_writes_nothing(self):
        path = self.foreign("names_psi.csv")
        done = self.imported(path, "--out", "log.csv", expect=2)
        self.assertIn("--time 'Time (s)' --command 'P set [psi]' --pressure 'P meas [psi]' --displacement 'Tip [mm]'",
                      done.stderr)
        self.assertFalse((self.folder / "log.csv").exists())
        line = next(line for line in done.stderr.splitlines() if line.startswith("  equivalent command: softgrip "))
        subprocess.run(f"{bench.SOFTGRIP} {line.split('softgrip ', 1)[1]}", shell=True, cwd=self.folder, check=True,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        self.assertTrue((self.folder / "log.csv").exists())

    def answered(self, answer, *arguments):
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        with subprocess.Popen([bench.SOFTGRIP, "import", *map(str, arguments)], stdin=slave, cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
            os.close(slave)
            os.write(master, answer)
            output = child.communicate(timeout=bench.PATIENCE_S)[0]
        return child.returncode, output

    def test_import_on_a_terminal_asks_for_confirmation(self):
        path = self.foreign("names_psi.csv")
        code, output = self.answered(b"n\n", path, "--out", "log.csv")
        self.assertEqual(code, 2, output)
        self.assertFalse((self.folder / "log.csv").exists())
        code, output = self.answered(b"y\n", path, "--out", "log.csv")
        self.assertEqual(code, 0, output)
        self.assertIn("Write log.csv with this assignment?", output)
        self.assertTrue((self.folder / "log.csv").exists())

    def test_import_does_not_ask_for_confirmation_of_a_file_that_it_rejects(self):
        path = self.write("no_unit.csv", "time,p_kPa,tip_mm\n" + "".join(f"{0.1 * i:.1f},{i},{0.5 * i}\n" for i in range(60)))
        code, output = self.answered(b"y\n", path, "--out", "log.csv")
        self.assertEqual(code, 3, output)
        self.assertIn("--unit time=s", output)
        self.assertIn("time (no unit)", output)
        self.assertNotIn("Write log.csv with this assignment?", output)
        self.imported(path, "--out", "log.csv", "--unit", "time=s", "--yes")

    def test_the_stored_mapping_gives_the_same_log(self):
        path = self.foreign("volts.csv")
        self.imported(path, "--out", "a.csv", "--yes", "--scale", "command=25", "--scale", "displacement=-2.5", "--zero",
                      "displacement=first", "--from-s", "0.5")
        kept = (self.folder / "a.import.yaml").read_text()
        self.assertIn("warning: the reading decreases", kept)
        self.imported(path, "--out", "b.csv", "--map", "a.import.yaml")
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())
        (self.folder / "a.import.yaml").write_text(kept.replace("unit", "units"))
        (self.folder / "c.yaml").write_text(kept.replace("scale:", "skale:"))
        self.assertIn("c.yaml:", self.imported(path, "--out", "c.csv", "--map", "c.yaml", expect=3).stderr)

    def test_the_row_counts_are_printed_and_stored(self):
        path = self.foreign("coarse_times.csv")
        done = self.imported(path, "--out", "log.csv", "--yes", "--missing", "888")
        account = "300 rows: 60 used, 240 left out (240 with the time of the previous row)"
        warnings = [account, "--rate-hz 100 instead of --time keeps every row", "--missing 888 has no effect"]
        for warning in warnings:
            self.assertRegex(done.stderr, f"warning: .*{re.escape(warning)}")
        self.assertIn(account, done.stdout)
        kept = (self.folder / "log.import.yaml").read_text()
        for warning in warnings:
            self.assertRegex(kept, f"# warning: .*{re.escape(warning)}")
        rows = json.loads(self.imported(path, "--out", "log.csv", "--yes", "--json").stdout)["logs"][0]["rows"]
        self.assertEqual(rows, {"file": 300, "used": 60, "joined": 0, "left_out": {"repeated_time": 240}})

    def test_the_row_counts_are_stored_if_all_rows_are_used(self):
        self.imported(self.foreign("names_psi.csv"), "--out", "log.csv", "--yes")
        self.assertIn("# 300 rows: 300 used", (self.folder / "log.import.yaml").read_text())

    def test_the_stored_mapping_reproduces_logs_with_codes_and_options(self):
        for name, options in (("codes.csv", ()), ("two_times.csv", ()), ("bad_lines.csv", ("--skip-bad-lines",)),
                              ("fingers_right.csv", ("--channel", "right"))):
            path = self.foreign(name)
            self.imported(path, "--out", "a.csv", "--yes", *options)
            self.imported(path, "--out", "b.csv", "--map", "a.import.yaml")
            self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes(), name)

    def test_missing_value_codes_are_removed_from_a_log(self):
        rows = "".join(f"{0.01 * i:.2f},{30 - abs(i % 100 - 50) * 0.6},{999 if i % 50 == 7 else 0.2 * i % 7}\n"
                       for i in range(200))
        path = self.write("log.csv", "time_s,pressure_command_kpa,displacement_mm\n" + rows)
        done = self.imported(path, "--out", "clean.csv", "--yes")
        self.assertIn("warning: 4 cells of 'displacement_mm' with 999", done.stderr)
        self.assertNotIn(",999\n", (self.folder / "clean.csv").read_text())

    def test_several_files_are_written_to_a_folder_all_or_none(self):
        good, also, broken = (self.foreign(name) for name in ("names_psi.csv", "packed.csv.gz", "word.csv"))
        self.imported(good, also, "--out", "log.csv", "--yes", expect=2)
        self.imported(good, broken, "--out", "logs/", "--yes", expect=3)
        self.assertFalse((self.folder / "logs").exists())
        self.imported(good, also, "--out", "logs/", "--yes")
        self.assertEqual(sorted(path.name for path in (self.folder / "logs").iterdir()),
                         ["names_psi.csv", "names_psi.import.yaml", "packed.csv", "packed.import.yaml"])

    def test_invalid_import_options_are_rejected(self):
        path = self.foreign("names_psi.csv")
        for arguments in (("--unit", "pressure"), ("--scale", "colour=2"), ("--scale", "pressure=0"),
                          ("--zero", "pressure=last"), ("--separator", "dots"), ("--rate-hz", "nan"),
                          ("--time", "1", "--rate-hz", "100")):
            self.imported(path, "--out", "log.csv", "--yes", *arguments, expect=2)
        done = self.imported(path, "--out", "log.csv", "--yes", "--scale", "command=2", "displacement=3", expect=2)
        self.assertIn("repeat the option for each further value: --scale displacement=3", done.stderr)
        self.imported("absent.csv", "--out", "log.csv", expect=4)
        self.imported(path, "--map", "absent.yaml", "--out", "log.csv", expect=4)
        done = self.imported(path, "--out", path, "--yes", expect=2)
        self.assertIn("not overwritten", done.stderr)
        done = self.imported(path, "--out", "log.csv", "--time", "Zeit", "--yes", expect=3)
        self.assertIn("no column 'Zeit'", done.stderr)
        self.assertEqual(list(self.folder.glob("log*")), [])

    def test_other_commands_print_the_required_import_command(self):
        path = self.foreign("names_psi.csv")
        for command in (("identify", "--out", "o", "--data", path), ("simulate", "--model", "config/models/bench_twin.yaml",
                        "--out", "o.csv", "--input", path), ("plot", path, "--out", "o.svg")):
            done = self.softgrip(*command, expect=3)
            hint = next(line for line in done.stderr.splitlines() if "as a log: softgrip import" in line)
            self.assertIn("--out names_psi_log.csv", hint)
        subprocess.run(f"{bench.SOFTGRIP} {hint.split(': softgrip ', 1)[1]}", shell=True, cwd=self.folder, check=True,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        self.softgrip("plot", "names_psi_log.csv", "--out", "o.svg")

    def test_other_commands_require_the_choice_of_one_sheet(self):
        path = self.foreign("two_sheets.xlsx")
        done = self.softgrip("identify", "--out", "o", "--data", path, expect=3)
        self.assertIn(f"{path}: 2 sheets have rows of numbers: 'Monday', 'Tuesday': softgrip import {path} --sheet NAME "
                      "--out two_sheets_log.csv", done.stderr)

    def test_a_log_exported_as_mcap_is_imported_unchanged(self):
        self.softgrip("simulate", "--model", "config/models/bench_twin.yaml", "--input", "tp1", "--out", "own.csv",
                      "--rate-hz", "50")
        self.softgrip("export", "own.csv", "--out", "own.mcap")
        hint = self.softgrip("identify", "--data", "own.mcap", "--out", "o", expect=3).stderr
        self.assertIn("own.mcap as a log: softgrip import own.mcap --time time_s", hint)
        self.imported("own.mcap", "--out", "back.csv", "--yes")
        self.assertEqual((self.folder / "own.csv").read_bytes(), (self.folder / "back.csv").read_bytes())

    def test_an_exported_recording_is_imported_from_every_format(self):
        """The recording has the column age_s, which is constant except for its first value and is not a time."""
        self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--record", "rec", "--no-socket")
        ages = {row.split(",")[10] for row in (self.folder / "rec/run.csv").read_text().splitlines()[1:]}
        self.assertGreater(len(ages), 1)
        logs = []
        for ending in ("csv", "mat", "mcap"):
            self.softgrip("export", "rec", "--out", f"run.{ending}")
            self.imported(f"run.{ending}", "--out", f"{ending}_log.csv", "--yes", "--channel", "left")
            logs.append((self.folder / f"{ending}_log.csv").read_bytes())
        self.assertEqual(logs[0], logs[1])
        self.assertEqual(logs[0], logs[2])

    def test_the_stored_mapping_of_any_file_can_be_read(self):
        rows = [f"{0.01 * i:.2f},{30 - abs(i % 100 - 50) * 0.6},{0.2 * i % 7:.3f}" for i in range(200)]
        many = "".join(f",extra_signal_with_a_long_name_{i:04}" for i in range(2500))
        for header, cells in (("time_s,set_kpa,tip_mm" + many, ",1" * 2500), ("time_s,set\x01_kpa,tip_mm", ""),
                              ("time_s,set_kpa,tip_" + "m" * 70_000 + "_mm", "")):
            with self.subTest(header[:40]):
                self.write("any.csv", "\n".join([header, *(row + cells for row in rows)]) + "\n")
                self.imported("any.csv", "--out", "a.csv", "--yes")
                self.imported("any.csv", "--out", "b.csv", "--map", "a.import.yaml")
                self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_no_mapping_is_written_next_to_a_device(self):
        self.foreign("names_psi.csv")
        (self.folder / "sink").symlink_to("/dev/null")
        self.imported("names_psi.csv", "--out", "sink", "--yes")
        self.assertFalse((self.folder / "sink.import.yaml").exists())

    def test_an_imported_log_has_the_validation_error_of_the_original(self):
        self.softgrip("simulate", "--model", "config/models/bench_twin.yaml", "--input", "tp1", "--out", "own.csv",
                      "--rate-hz", "50")
        rows = (self.folder / "own.csv").read_text().splitlines()
        foreign = ["t_ms;p_bar;Weg_cm"] + [
            ";".join(repr(float(cell) * factor).replace(".", ",") for cell, factor in zip(row.split(","), (1000, 0.01, 0.1)))
            for row in rows[1:]]
        self.write("theirs.csv", "\n".join(foreign) + "\n")
        self.imported("theirs.csv", "--out", "log.csv", "--command", "p_bar", "--yes")
        results = []
        for name in ("own.csv", "log.csv"):
            done = self.softgrip("validate", "--model", "config/models/bench_twin.yaml", "--data", name, "--json")
            results += json.loads(done.stdout)["rmse_mm"].values()
        self.assertAlmostEqual(results[0], results[1], places=6)


if __name__ == "__main__":
    bench.main()
