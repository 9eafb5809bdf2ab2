"""Tests the files that a command reads and writes. A command must not overwrite its own input or wait for a pipe. A
small file must not cause it to fill the memory. It must not open another file to which its input file refers."""

import gzip
import json
import os
import re
import shutil
import struct
import subprocess
import zlib

import bench
import bench_files
import web
import workbooks
from bench_files import TWIN


class Overwriting(bench_files.Files):
    def refused(self, line, input_path, program=bench.SOFTGRIP):
        """Checks that the command refuses an output path that is its input, a symbolic link to its input or a hard
        link to its input. The input must stay unchanged."""
        path = self.folder / input_path
        before = path.read_bytes()
        with self.subTest(line):
            done = subprocess.run([program, *line.split()], cwd=self.folder, capture_output=True, text=True,
                                  timeout=bench.PATIENCE_S, stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("overwritten", done.stderr)
            self.assertEqual(path.read_bytes(), before)

    def test_a_histogram_file_has_the_counts_under_both_names(self):
        subprocess.run([bench.SOFTGRIPD, "--config", "config/rig.yaml", "--virtual-time", "--duration-s", "1", "--histograms",
                        "histograms.txt"], cwd=self.folder, check=True, capture_output=True, timeout=60)
        text = (self.folder / "histograms.txt").read_text()
        for count in ("woken late", "took long"):
            values = [re.search(rf"^# {name}, {count}: (\d+)$", text, re.M)[1] for name in ("Overruns", "Slips")]
            self.assertEqual(*values)

    def test_a_command_does_not_overwrite_its_own_input(self):
        self.record()
        self.refused("export rec --out rec/run.csv", "rec/run.csv")
        self.refused("export rec --format csv --out rec/run.json", "rec/run.json")
        self.refused("export rec/run.csv --out rec/run.csv", "rec/run.csv")
        self.refused("export model.yaml --format c --rate-hz 100 --out model.yaml", "model.yaml")
        self.refused(f"simulate --model {TWIN} --input log.csv --out log.csv", "log.csv")
        self.refused("simulate --model model.yaml --input tp1 --out model.yaml", "model.yaml")
        self.refused("import log.csv --yes --out log.csv", "log.csv")
        self.refused("import log.csv --map model.yaml --yes --out model.yaml", "model.yaml")
        self.refused("tune --model model.yaml --draws 1 --out model.yaml", "model.yaml")
        self.refused("tune --model model.yaml --rig config/rig.yaml --draws 1 --out config/rig.yaml", "config/rig.yaml")
        self.refused("calibrate --rig config/rig.yaml --channel left --out config/rig.yaml", "config/rig.yaml")
        self.refused("calibrate --rig config/rig_tcp.yaml --channel left --out config/boards/adam-6024.yaml",
                     "config/boards/adam-6024.yaml")
        self.refused("--model model.yaml --tcp 0 --truth model.yaml", "model.yaml", bench.SOFTGRIP_RIG)
        self.refused("--config config/rig.yaml --virtual-time --duration-s 1 --histograms config/rig.yaml", "config/rig.yaml",
                     bench.SOFTGRIPD)

    def test_a_command_does_not_overwrite_its_input_through_a_link(self):
        self.record()
        for link, make in (("soft", os.symlink), ("hard", os.link)):
            make(self.folder / "rec/run.csv", self.folder / f"{link}.csv")
            make(self.folder / "log.csv", self.folder / f"{link}.svg")
            self.refused(f"export rec --out {link}.csv", "rec/run.csv")
            self.refused(f"plot log.csv --out {link}.svg", "log.csv")
            self.refused(f"simulate --model {TWIN} --input {link}.csv --out rec/run.csv", "rec/run.csv")

    def test_a_command_does_not_overwrite_an_input_in_its_output_folder(self):
        self.softgrip("baseline", "--data", "log.csv", "--model", TWIN, "--out", "base")
        for name in ("identified/model.yaml", "diagnosed/model.yaml", "figures/figure-1.csv", "found/step_1/log.csv",
                     "judged/log/series.csv", "health/health.json"):
            (self.folder / name).parent.mkdir(parents=True)
            shutil.copy(self.folder / ("model.yaml" if name.endswith("yaml") else "log.csv"), self.folder / name)
        self.refused("identify --data log.csv --start identified/model.yaml --starts 1 --out identified", "identified/model.yaml")
        self.refused("identify --data log.csv --validate figures/figure-1.csv --out new --figures figures", "figures/figure-1.csv")
        self.refused("validate --model model.yaml --data judged/log/series.csv --out judged", "judged/log/series.csv")
        self.refused("diagnose --model diagnosed/model.yaml --data log.csv --out diagnosed", "diagnosed/model.yaml")
        self.refused("diagnose --baseline base --data log.csv --out base", "base/model.yaml")
        self.refused("baseline --data base/healthy_1.csv --model model.yaml --out base", "base/healthy_1.csv")
        self.refused("health log.csv --baseline base --notes health/health.json --out health", "health/health.json")
        self.refused("investigate --model model.yaml --data found/step_1/log.csv --rig config/rig.yaml --rig-channel left --yes "
                     "--out found", "found/step_1/log.csv")

    def test_import_can_overwrite_the_column_mapping_that_it_has_read(self):
        """import may overwrite the column mapping that it has read, and health may append to the scores that it has
        read."""
        self.softgrip("import", "log.csv", "--yes", "--out", "again.csv")
        self.write("raw.csv", (self.folder / "log.csv").read_text().replace("time_s,pressure_command_kpa,displacement_mm",
                                                                           "t [s],set [kPa],tip [mm]"))
        self.softgrip("import", "raw.csv", "--yes", "--out", "new.csv")
        before = (self.folder / "new.csv").read_bytes()
        self.softgrip("import", "raw.csv", "--map", "new.import.yaml", "--out", "new.csv")
        self.assertEqual((self.folder / "new.csv").read_bytes(), before)

    def test_a_folder_that_cannot_be_written_is_refused_before_the_computation(self):
        for line in (f"diagnose --model {TWIN} --data log.csv", "identify --data log.csv"):
            for option in ("--out", "--figures"):
                other = () if option == "--out" else ("--out", "out")
                done = self.softgrip(*line.split(), *other, option, "/proc/softgrip", expect=4)
                self.assertIn("cannot create /proc/softgrip", done.stderr)
                self.assertNotIn("search", done.stderr)

    def test_a_change_diagnosis_refuses_the_options_that_it_does_not_use(self):
        for unused in (("--gauge", "gauge.csv"), ("--nulls", "19"), ("--propose",), ("--pressure-max-kpa", "70")):
            done = self.softgrip("diagnose", "--model", TWIN, "--healthy", "log.csv", "--data", "log.csv", "--out", "out",
                                 *unused, expect=2)
            self.assertIn(unused[0], done.stderr)
        missing = self.softgrip("diagnose", "--baseline", "none", "--data", "log.csv", "--out", "out", expect=4)
        self.assertIn("none/baseline.json", missing.stderr)

    def test_a_change_diagnosis_removes_the_model_of_an_earlier_diagnosis(self):
        self.softgrip("diagnose", "--model", TWIN, "--data", "log.csv", "--out", "out", "--no-closed-loop", timeout_s=120)
        self.assertTrue((self.folder / "out/model.yaml").exists())
        self.softgrip("diagnose", "--model", TWIN, "--healthy", "log.csv", "--data", "log.csv", "--out", "out", timeout_s=120)
        self.assertFalse((self.folder / "out/model.yaml").exists())
        self.assertEqual(json.loads((self.folder / "out/diagnosis.json").read_text())["question"], "change")

    def test_a_name_that_is_not_utf_8_loses_no_result(self):
        name = os.fsdecode(b"l\xf6g.csv")
        shutil.copy(self.folder / "log.csv", self.folder / name)
        folder, log = os.fsencode(self.folder), os.fsencode(self.folder / name)
        for arguments in (("validate", "--model", TWIN, "--data", log, "--out", "valid", "--json"),
                          ("identify", "--data", log, "--starts", "1", "--out", "identified", "--json"),
                          ("simulate", "--model", TWIN, "--input", log, "--out", "out.csv", "--json")):
            done = subprocess.run([os.fsencode(bench.SOFTGRIP), *(a if isinstance(a, bytes) else str(a).encode()
                                                                  for a in arguments)], cwd=folder, capture_output=True,
                                  timeout=bench.PATIENCE_S)
            self.assertEqual(done.returncode, 0, done.stderr)
            json.loads(done.stdout.decode())

    def test_scores_that_cannot_be_read_are_not_replaced(self):
        self.record()
        self.softgrip("baseline", "--data", "log.csv", "--model", TWIN, "--out", "base")
        (self.folder / "health/health-scores.jsonl").mkdir(parents=True)
        self.softgrip("health", "rec", "--baseline", "base", "--out", "health", expect=4)
        self.assertEqual([path.name for path in (self.folder / "health").iterdir()], ["health-scores.jsonl"])


class Pipes(bench_files.Files):
    """Tests with a named pipe in place of an input file. No process writes to the pipe, so a command that waits for
    the pipe would never end."""

    def test_commands_do_not_wait_for_a_named_pipe_as_input(self):
        self.record()
        os.mkfifo(self.folder / "pipe")
        os.mkfifo(self.folder / "pipe.yaml")
        (self.folder / "rec/run.json").unlink()
        os.mkfifo(self.folder / "rec/run.json")
        for folder, name in (("spoilt", "run.csv"), ("report", "validate.json"), ("base", "baseline.json")):
            (self.folder / folder).mkdir()
            os.mkfifo(self.folder / folder / name)
        for line, code in (("import pipe --yes --out x.csv", 4), ("import spoilt --yes --out x.csv", 4),
                           ("import log.csv --map pipe.yaml --yes --out x.csv", 4), ("plot spoilt --out x.svg", 4),
                           ("export spoilt --out x.csv", 4), ("plot rec --out x.svg", 0), ("check pipe.yaml", 4),
                           ("simulate --model pipe.yaml --input tp1 --out x.csv", 4), (f"simulate --model {TWIN} --input pipe --out x.csv", 4),
                           (f"validate --model {TWIN} --data pipe", 4), ("identify --data pipe --out x", 4),
                           (f"diagnose --model {TWIN} --data log.csv --gauge pipe --out x", 4),
                           ("diagnose --baseline base --data log.csv --out x", 3), ("health rec --baseline base", 3),
                           ("health rec --baseline base --notes pipe", 4), ("report --verify report", 3),
                           ("run pipe.yaml --rig config/rig.yaml", 4), ("run config/sequences/pick_stone.yaml --rig pipe.yaml", 4),
                           ("calibrate --rig pipe.yaml --channel left", 4), ("doctor --rig pipe.yaml", 4),
                           ("tune --model pipe.yaml --out x", 4), ("status --rig pipe.yaml", 4), ("start pipe", 4)):
            with self.subTest(line):
                done = self.runner.run(line)
                self.assertEqual(done.returncode, code, done.stderr.decode())
        for program, option in ((bench.SOFTGRIPD, "--config"), (web.SOFTGRIP_WEB, "--config"), (bench.SOFTGRIP_RIG, "--model")):
            done = subprocess.run([program, option, "pipe.yaml"], cwd=self.folder, capture_output=True, timeout=bench.PATIENCE_S)
            self.assertIn(done.returncode, (3, 4), done.stderr)
            self.assertIn(b"it is a pipe", done.stderr)

    def test_status_and_web_do_not_wait_for_named_pipes_in_the_recordings(self):
        self.start_rig()
        (self.folder / "runs/health").mkdir(parents=True)
        os.mkfifo(self.folder / "runs/health/health.json")
        (self.folder / "runs/0").mkdir()
        os.mkfifo(self.folder / "runs/0/run.csv")
        self.assertIn("idle", self.softgrip("status").stdout)
        self.assertNotIn("health", json.loads(self.softgrip("status", "--json").stdout))
        page = web.Web(self.folder)
        self.processes.append(page)
        for _ in range(20):  # the number of requests exceeds the number of threads
            self.assertEqual(page.ask("/metrics", token=web.LOOK)[0], 200)
            self.assertEqual(page.ask("/recordings/0/run.csv", token=web.LOOK)[0], 404)
        self.assertEqual(page.command("vent")[0], 200)
        # The folder runs/0 is no valid recording, so it is removed before the check of the recordings.
        shutil.rmtree(self.folder / "runs/0")


def compressed_matrix(name, rows, data):
    """Returns a compressed element of a .mat file of version 5. The element is a column of doubles, and its header
    states `rows` rows."""
    def element(kind, content):
        return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)
    flags = element(6, struct.pack("<II", 6, 0))  # class number of a double matrix
    size = element(5, struct.pack("<ii", rows, 1))
    body = flags + size + element(1, name.encode()) + struct.pack("<II", 9, 8 * rows)
    packer = zlib.compressobj(9)
    packed = packer.compress(struct.pack("<II", 14, len(body) + 8 * rows) + body)
    packed += b"".join(packer.compress(part) for part in data) + packer.flush()
    return struct.pack("<II", 15, len(packed)) + packed


class Bombs(bench_files.Files):
    """Tests small compressed files. Their uncompressed content is larger than the memory of any machine."""

    def packed(self, rows, times):
        with open(self.folder / "bomb.csv.gz", "wb") as file, gzip.GzipFile("", "wb", 9, file, 0) as text:
            text.write(b"time_s,pressure_command_kpa,displacement_mm\n")
            for _ in range(times):
                text.write(rows)
        self.assertLess((self.folder / "bomb.csv.gz").stat().st_size, 4 << 20)

    def test_gzip_text_above_512_mib_is_rejected(self):
        self.packed(b"0.000000000000000000000000000000000,1.00000000000000000000000000000000,2\n" * 10_000, 900)
        said = self.limited("import", "bomb.csv.gz", "--yes", "--out", "log.csv", code=3)
        self.assertIn("after decompression, the gzip file has more than 536870912 bytes", said)

    def test_text_with_more_than_16777216_lines_is_rejected(self):
        self.packed(b"0,1,2\n" * 100_000, 600)
        self.assertIn("the text has more than 16777216 lines", self.limited("import", "bomb.csv.gz", "--yes", "--out", "x.csv", code=3))
        with open(self.folder / "plain.csv", "wb") as text:
            text.write(b"time_s,pressure_command_kpa,displacement_mm\n" + b"0,1,2\n" * 20_000_000)
        self.assertIn("16777216 lines", self.limited("import", "plain.csv", "--yes", "--out", "x.csv", code=3))

    def test_a_line_longer_than_1_mib_is_rejected(self):
        self.packed(b"," * 1_000_000, 400)
        self.assertIn("line 2 has more than 1048576 bytes",
                      self.limited("import", "bomb.csv.gz", "--yes", "--out", "x.csv", code=3))

    def test_a_workbook_with_too_many_bytes_or_cells_is_rejected(self):
        """Tests a sheet of 600 MB, a sheet with more cells than the memory can hold, and long strings that many cells
        repeat."""
        cells = "<c><v>1</v></c>" * 4
        huge = f"<worksheet><sheetData><row>{cells}{' ' * (600 << 20)}</row></sheetData></worksheet>"
        many = f"<worksheet><sheetData>{'<row/>' * 20_000_000}</sheetData></worksheet>"
        repeated = "<worksheet><sheetData>" + "<row><c t='s'><v>0</v></c></row>" * 500_000 + "</sheetData></worksheet>"
        for sheet, strings, reason in ((huge, [], "after decompression the workbook has more than 536870912 bytes"),
                                       (many, [], "the sheet has too many cells"),
                                       (repeated, ["x" * 30_000], "the sheet has more than 536870912 bytes of text")):
            packed = workbooks.package({"Run": sheet}, strings)
            self.assertLess(len(packed), 4 << 20)
            (self.folder / "bomb.xlsx").write_bytes(packed)
            self.assertIn(reason, self.limited("import", "bomb.xlsx", "--yes", "--out", "x.csv", code=3))

    def test_a_too_large_matlab_variable_is_skipped(self):
        zeros = [bytes(8 << 20)] * 100
        header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
        small = b"".join(compressed_matrix(name, 50, [struct.pack("<50d", *(i * scale for i in range(50)))])
                         for name, scale in (("time_s", 0.1), ("pressure_command_kpa", 1), ("displacement_mm", 0.5)))
        # In the first file, all samples are present. In the second file, the header announces samples that are not
        # present.
        for large in (compressed_matrix("bomb", 100 << 20, zeros), compressed_matrix("bomb", 500 << 20, [])):
            (self.folder / "bomb.mat").write_bytes(header + small + large)
            self.assertLess((self.folder / "bomb.mat").stat().st_size, 2 << 20)
            self.limited("import", "bomb.mat", "--yes", "--out", "from_mat.csv", code=0)
            self.assertIn("'bomb' is skipped", (self.folder / "from_mat.import.yaml").read_text())
            self.assertEqual(len((self.folder / "from_mat.csv").read_text().splitlines()), 51)

    def test_a_matlab_file_with_too_many_cells_is_rejected(self):
        """Tests a file of empty cells. In the file, an empty cell takes 8 bytes, and almost none after compression. In
        memory, an empty cell takes an object of libmatio."""
        header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
        body = (struct.pack("<IIII", 6, 8, 1, 0) + struct.pack("<IIii", 5, 8, 500_000_000, 1) + struct.pack("<II", 1, 4) +
                b"bomb" + bytes(4 + (100 << 20)))
        packed = zlib.compress(struct.pack("<II", 14, len(body)) + body, 9)
        (self.folder / "bomb.mat").write_bytes(header + struct.pack("<II", 15, len(packed)) + packed)
        said = self.limited("import", "bomb.mat", "--yes", "--out", "x.csv", code=3)
        self.assertIn("the cells, structures and objects of the file have more than 100000 parts", said)

    def test_too_large_hdf5_datasets_and_chunks_are_skipped(self):
        h5py = self.h5py()
        with h5py.File(self.folder / "bomb.h5", "w") as file:
            for name, scale in (("time_s", 0.1), ("pressure_command_kpa", 1), ("displacement_mm", 0.5)):
                file[name] = [i * scale for i in range(50)]
            file.create_dataset("rows", (1 << 30,), "f8", chunks=(1 << 20,), compression="gzip")
            file.create_dataset("chunk", (50,), "f8", chunks=(100 << 20,), maxshape=(None,), compression="gzip")
        self.limited("import", "bomb.h5", "--yes", "--out", "from_h5.csv", code=0)
        said = (self.folder / "from_h5.import.yaml").read_text()
        self.assertIn("'rows' is skipped", said)
        self.assertIn("'chunk' is skipped: the chunks of the dataset have more than 256 MiB", said)


class Groups(bench_files.Files):
    """Tests HDF5 files whose groups cannot be read."""

    def write_columns(self, file):
        for name, scale in (("time_s", 0.1), ("pressure_command_kpa", 1), ("displacement_mm", 0.5)):
            file[name] = [i * scale for i in range(50)]

    def damage(self, index):
        """Overwrites the signature of one symbol table node of a.h5."""
        content = bytearray((self.folder / "a.h5").read_bytes())
        nodes = [match.start() for match in re.finditer(b"SNOD", content)]
        content[nodes[index]:nodes[index] + 4] = b"XXXX"
        (self.folder / "damaged.h5").write_bytes(content)

    def test_a_damaged_hdf5_group_is_rejected(self):
        with self.h5py().File(self.folder / "a.h5", "w") as file:
            self.write_columns(file)
            file["laser/tip_mm"] = [float(i) for i in range(50)]
        self.limited("import", "a.h5", "--yes", "--out", "log.csv", code=0)
        (self.folder / "log.csv").unlink()
        messages = []
        for index in (0, 1):
            self.damage(index)
            messages.append(self.limited("import", "damaged.h5", "--yes", "--out", "log.csv", code=3))
            self.assertFalse((self.folder / "log.csv").exists())
        self.assertIn("the group '/' cannot be read", "".join(messages))
        self.assertIn("the group 'laser' cannot be read", "".join(messages))

    def test_an_hdf5_group_below_8_other_groups_is_named(self):
        path = "/".join(f"g{i}" for i in range(9))
        with self.h5py().File(self.folder / "a.h5", "w") as file:
            self.write_columns(file)
            file[path + "/laser_mm"] = [float(i) for i in range(50)]
        self.limited("import", "a.h5", "--yes", "--out", "log.csv", code=0)
        self.assertIn(f"'{path}' is skipped: only 8 levels of groups are read", (self.folder / "log.import.yaml").read_text())


class OtherFiles(bench_files.Files):
    """Tests HDF5 files that refer to other files. The log must not contain data of these other files."""

    def setUp(self):
        super().setUp()
        self.secret = self.folder / "secret.bin"
        self.secret.write_bytes(struct.pack("<50d", *range(50)))

    def refused(self, name, why):
        said = self.limited("import", name, "--yes", "--out", "stolen.csv", code=3)
        self.assertIn(why, said)
        self.assertFalse((self.folder / "stolen.csv").exists())

    def columns(self, file):
        for name, scale in (("time_s", 0.1), ("pressure_command_kpa", 1)):
            file[name] = [i * scale for i in range(50)]

    def test_hdf5_external_storage_is_rejected(self):
        h5py = self.h5py()
        with h5py.File(self.folder / "a.h5", "w") as file:
            self.columns(file)
            file.create_dataset("run/displacement_mm", (50,), "f8", external=[(str(self.secret), 0, 400)])
        self.refused("a.h5", "external storage")

    def other_hdf5(self):
        """Writes a second file with readings and returns its path."""
        with self.h5py().File(self.folder / "other.h5", "w") as file:
            file["data"] = [float(i) for i in range(50)]
        return str(self.folder / "other.h5")

    def test_an_hdf5_external_link_is_rejected(self):
        h5py, other = self.h5py(), self.other_hdf5()
        with h5py.File(self.folder / "a.h5", "w") as file:
            self.columns(file)
            file["displacement_mm"] = h5py.ExternalLink(other, "data")
        self.refused("a.h5", "external link")

    def test_a_soft_link_through_an_external_link_is_not_followed(self):
        h5py, other = self.h5py(), self.other_hdf5()
        with h5py.File(self.folder / "a.h5", "w") as file:
            self.columns(file)
            file["displacement_mm"] = h5py.SoftLink("/#hidden/data")  # a list of columns does not show names that
                                                                      # contain #
            file["#hidden"] = h5py.ExternalLink(other, "/")
        said = self.limited("import", "a.h5", "--yes", "--out", "stolen.csv", code=3)
        self.assertIn("no column looks like a displacement", said)
        self.assertFalse((self.folder / "stolen.csv").exists())

    def test_an_hdf5_virtual_dataset_is_rejected(self):
        h5py, other = self.h5py(), self.other_hdf5()
        layout = h5py.VirtualLayout((50,), "f8")
        layout[:] = h5py.VirtualSource(other, "data", (50,))
        with h5py.File(self.folder / "a.h5", "w") as file:
            self.columns(file)
            file.create_virtual_dataset("displacement_mm", layout)
        self.refused("a.h5", "virtual dataset")


if __name__ == "__main__":
    bench.main()
