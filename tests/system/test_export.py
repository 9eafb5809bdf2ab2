"""Tests softgrip export with readers of other projects. Also tests the files that identify, validate and diagnose
write for each log."""

import csv
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import unittest

import bench
import foreign_files
import mcap_reading

MODEL = "config/models/bench_twin.yaml"

HERE = pathlib.Path(__file__).resolve().parent
# Folder of the npm packages. scripts/mcap_reader.sh installs the packages that the lock file in HERE/mcap states.
READER = bench.BUILD.parent / "mcap"


def columns_of(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) if row[name] else math.nan for row in rows] for name in rows[0]}


def same(test, got, wanted):
    test.assertEqual(len(got), len(wanted))
    for a, b in zip(got, wanted):
        test.assertTrue(a == b or (math.isnan(a) and math.isnan(b)), (a, b))


class Signals(bench.BenchTest):
    """A recording of two fingers. One finger has a missing reading, and a state whose text contains a comma."""

    def setUp(self):
        super().setUp()
        foreign_files.recording(self.folder / "run")
        path = self.folder / "run/run.csv"
        lines = path.read_text().split("\n")
        lines[1] = "0.0,left,0.0,,0.0,\"idle, at rest\""
        path.write_text("\n".join(lines))

    def export(self, out, *arguments, expect=0, source="run"):
        return self.softgrip("export", source, "--out", out, *arguments, expect=expect)

    def test_wide_csv_has_a_column_per_signal_and_finger(self):
        self.export("wide.csv")
        with open(self.folder / "wide.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["time_s", *(f"{finger}_{name}" for finger in ("left", "right") for name in (
            "pressure_command_kpa", "displacement_mm", "pressure_kpa", "state"))])
        self.assertEqual(len(rows), foreign_files.COUNT)
        self.assertEqual(rows[0]["left_state"], "idle, at rest")
        self.assertEqual(rows[0]["left_displacement_mm"], "")
        self.assertEqual([float(row["left_pressure_command_kpa"]) for row in rows], foreign_files.COMMAND)
        self.assertEqual([float(row["right_displacement_mm"]) for row in rows],
                         [float(repr(0.1 * tip)) for tip in foreign_files.TIP])

    def test_wide_csv_is_read_by_pandas(self):
        import pandas
        self.export("wide.csv")
        frame = pandas.read_csv(self.folder / "wide.csv")
        self.assertEqual(frame["left_pressure_command_kpa"].tolist(), foreign_files.COMMAND)
        self.assertTrue(math.isnan(frame["left_displacement_mm"][0]))
        self.assertEqual(frame["left_displacement_mm"][1:].tolist(), foreign_files.TIP[1:])

    def test_wide_csv_is_read_by_numpy(self):
        import numpy
        self.export("wide.csv")
        table = numpy.genfromtxt(self.folder / "wide.csv", delimiter=",", names=True, usecols=(0, 1))
        self.assertEqual(table["left_pressure_command_kpa"].tolist(), foreign_files.COMMAND)

    def test_mat_is_read_by_scipy(self):
        import scipy.io
        done = self.export("run.mat", "--json")
        self.assertEqual(json.loads(done.stdout)["left_out"], ["left_state", "right_state"])
        mat = scipy.io.loadmat(self.folder / "run.mat", squeeze_me=True)
        self.assertEqual(mat["time_s"].tolist(), foreign_files.T)
        self.assertEqual(mat["left_pressure_kpa"].tolist(), foreign_files.PRESSURE)
        self.assertTrue(math.isnan(mat["left_displacement_mm"][0]))
        self.assertEqual(mat["left_displacement_mm"][1:].tolist(), foreign_files.TIP[1:])
        self.export("again.mat")
        self.assertEqual((self.folder / "run.mat").read_bytes(), (self.folder / "again.mat").read_bytes())

    def test_an_exported_mat_file_can_be_imported(self):
        self.export("run.mat")
        self.softgrip("import", "run.mat", "--out", "log.csv", "--time", "time_s", "--command",
                      "left_pressure_command_kpa", "--displacement", "left_displacement_mm")
        same(self, columns_of(self.folder / "log.csv")["displacement_mm"], [math.nan, *foreign_files.TIP[1:]])

    def test_mat_names_that_agree_in_their_first_63_characters_are_all_written(self):
        name = "a_topic_with_a_long_path_" * 3
        rows = [f"time_s,pressure_command_kpa,displacement_mm,{name}1,{name}2,{name}3"]
        rows += [f"{0.01 * i:.2f},{i % 50},{0.1 * (i % 50):.1f},1,2,{3 + i % 50}" for i in range(200)]
        self.write("long.csv", "\n".join(rows) + "\n")
        self.export("long.mat", source="long.csv")
        self.softgrip("import", "long.mat", "--time", "time_s", "--command", "pressure_command_kpa", "--displacement",
                      f"{name[:58]}_3", "--unit", "displacement=mm", "--out", "log.csv")
        self.assertEqual(columns_of(self.folder / "log.csv")["displacement_mm"], [3 + i % 50 for i in range(200)])

    def test_cells_of_other_columns_keep_their_digits(self):
        rows = ["time_s,pressure_command_kpa,displacement_mm,stamp_ns,serial,gain"]
        rows += [f"{0.01 * i:.2f},{i % 50},{0.1 * (i % 50):.1f},{1717149600123456790 + i},0007,1.50" for i in range(200)]
        self.write("ids.csv", "\n".join(rows) + "\n")
        self.export("ids_wide.csv", source="ids.csv")
        with open(self.folder / "ids_wide.csv", newline="") as file:
            row = list(csv.DictReader(file))[1]
        self.assertEqual([row["stamp_ns"], row["serial"], row["gain"]], ["1717149600123456791", "0007", "1.50"])
        done = self.export("ids.mat", "--json", source="ids.csv")
        self.assertEqual(json.loads(done.stdout)["left_out"], ["stamp_ns", "serial"])
        self.export("ids.mcap", source="ids.csv")
        _, message = mcap_reading.read(self.folder / "ids.mcap")["/signals"][1]
        self.assertEqual([message["stamp_ns"], message["serial"], message["gain"]], ["1717149600123456791", "0007", 1.5])

    def test_mcap_follows_the_specification(self):
        self.export("run.mcap")
        topics = mcap_reading.read(self.folder / "run.mcap")
        self.assertEqual(sorted(topics), ["/left", "/right"])
        times, left = zip(*topics["/left"])
        self.assertEqual(list(times), [round(1e9 * t) for t in foreign_files.T])
        self.assertEqual([message["pressure_command_kpa"] for message in left], foreign_files.COMMAND)
        self.assertNotIn("displacement_mm", left[0])
        self.assertEqual(left[0]["state"], "idle, at rest")
        self.assertEqual([message["displacement_mm"] for message in left[1:]], foreign_files.TIP[1:])

    def test_the_test_reader_detects_a_damaged_mcap_file(self):
        self.export("run.mcap")
        path = self.folder / "run.mcap"
        whole = bytearray(path.read_bytes())
        for at in (500, len(whole) // 2, len(whole) - 60):
            broken = bytearray(whole)
            broken[at] ^= 1
            path.write_bytes(broken)
            with self.assertRaises((AssertionError, struct.error, KeyError, UnicodeDecodeError, ValueError)):
                mcap_reading.read(path)

    def read_by_its_own_reader(self, path):
        """Reads a file with the MCAP reader of the authors of the format. If npm could not reach a registry when the
        reader was installed, scripts/mcap_reader.sh has written the reason to the file `unreachable`."""
        if (READER / "unreachable").exists():
            self.skipTest((READER / "unreachable").read_text().strip())
        self.assertTrue((READER / "node_modules/@mcap/core").is_dir(), "bash scripts/mcap_reader.sh installs @mcap/core")
        shutil.copy(HERE / "mcap/read.js", self.folder / "read.js")
        done = subprocess.run(["node", "read.js", path], cwd=self.folder, capture_output=True, text=True, timeout=120,
                              env={**os.environ, "NODE_PATH": str(READER / "node_modules")})
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_mcap_is_read_by_the_reader_of_the_format_authors(self):
        self.export("run.mcap")
        told = self.read_by_its_own_reader(self.folder / "run.mcap")
        self.assertTrue(told["done"])
        self.assertEqual(told["messages"], 2 * foreign_files.COUNT)
        self.assertEqual({topic: [(time_ns, message) for time_ns, message in messages]
                          for topic, messages in told["topics"].items()}, mcap_reading.read(self.folder / "run.mcap"))
        left = told["topics"]["/left"]
        self.assertEqual([time_ns for time_ns, _ in left], [round(1e9 * t) for t in foreign_files.T])
        self.assertEqual([message["pressure_command_kpa"] for _, message in left], foreign_files.COMMAND)
        self.assertEqual([message["displacement_mm"] for _, message in left[1:]], foreign_files.TIP[1:])

    def test_mat_is_read_by_octave(self):
        self.export("run.mat")
        self.write("read.m", r"""load run.mat
            printf("%d %d\n", size(time_s));
            printf("%.17g %.17g %.17g %.17g\n", [time_s, left_pressure_command_kpa, left_pressure_kpa, left_displacement_mm]');
            """)
        done = subprocess.run(["octave", "--no-gui", "--norc", "--quiet", "read.m"], cwd=self.folder, capture_output=True,
                              text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        size, *rows = done.stdout.splitlines()
        self.assertEqual(size, f"{foreign_files.COUNT} 1")
        for column, wanted in zip(zip(*(map(float, row.split()) for row in rows)), (
                foreign_files.T, foreign_files.COMMAND, foreign_files.PRESSURE, [math.nan, *foreign_files.TIP[1:]])):
            same(self, column, wanted)

    def test_export_rejects_unknown_formats_and_unsuitable_sources(self):
        for arguments in (("run.xlsx",), ("run",), ("run.csv2",), ("-", "--format", "mat"), ("x.csv", "--format", "tdms")):
            self.export(*arguments, expect=2)
        self.export("absent.csv", source="absent", expect=4)
        self.assertIn("can only be exported as .c", self.export("m.csv", source=MODEL, expect=2).stderr)
        self.assertIn("keep their own times", self.export("run.mat", "--rate-hz", "100", expect=2).stderr)
        before = (self.folder / "run/run.csv").read_bytes()
        self.assertIn("not overwritten", self.export("run/run.csv", source="run/run.csv", expect=2).stderr)
        self.assertEqual((self.folder / "run/run.csv").read_bytes(), before)
        self.write("nothing.csv", "a,b\n1,2\n2,3\n")
        self.assertIn("so it is not a log or a series", self.export("x.csv", source="nothing.csv", expect=3).stderr)
        self.write("texts.csv", "time_s,force_n,state\n0,1,idle\n1,2,held\n")
        refused = self.export("x.csv", source="texts.csv", expect=3).stderr
        self.assertIn("texts.csv:2:5: 'idle' in column 'state' is not a number", refused)
        self.assertFalse((self.folder / "x.csv").exists())
        self.assertTrue(self.export("-", "--format", "csv").stdout.startswith("time_s,left_"))


class PerLog(bench.BenchTest):

    def setUp(self):
        super().setUp()
        for name, signal in (("a", "tp1"), ("b", "sp1")):
            self.softgrip("simulate", "--model", MODEL, "--input", signal, "--out", f"{name}.csv", "--rate-hz", "20",
                          "--noise-mm", "0.01")

    def series(self, path, *models):
        columns = columns_of(self.folder / path)
        self.assertEqual(list(columns), ["time_s", "drive_kpa", "measured_mm", *(
            f"{what}_{model}_mm" for model in models for what in ("predicted", "residual")), "held_out"])
        for model in models:
            for measured, predicted, residual in zip(columns["measured_mm"], columns[f"predicted_{model}_mm"],
                                                     columns[f"residual_{model}_mm"]):
                self.assertAlmostEqual(measured - predicted, residual, places=12)
        return columns

    @staticmethod
    def rmse(errors):
        return math.sqrt(sum(e * e for e in errors) / len(errors))

    def test_identify_writes_the_fitted_and_held_out_series_of_each_log(self):
        self.softgrip("identify", "--data", "a.csv", "--validate", "b.csv", "a.csv", "--out", "o", "--start", MODEL,
                      "--starts", "2", "--fit-share", "0.5", timeout_s=120)
        told = json.loads((self.folder / "o/identify.json").read_text())
        fitted = self.series("o/a/series.csv", "identified")
        log = columns_of(self.folder / "a.csv")
        self.assertEqual(fitted["time_s"], log["time_s"])
        self.assertEqual(fitted["measured_mm"], log["displacement_mm"])
        held = [h == 1 for h in fitted["held_out"]]
        self.assertAlmostEqual(sum(held) / len(held), 0.5, places=2)
        self.assertAlmostEqual(self.rmse([e for e, h in zip(fitted["residual_identified_mm"], held) if not h]),
                               told["rmse_mm"]["a"], places=9)
        for path in ("o/b/series.csv", "o/a (2)/series.csv"):
            self.assertEqual(set(self.series(path, "identified")["held_out"]), {1.0})

    def test_each_of_several_logs_with_the_same_name_has_its_series(self):
        for folder, name in (("one", "a"), ("two", "b")):
            (self.folder / folder).mkdir()
            shutil.copy(self.folder / f"{name}.csv", self.folder / folder / "run.csv")
        self.softgrip("identify", "--data", "one/run.csv", "two/run.csv", "--validate", "one/run.csv", "--out", "o", "--start",
                      MODEL, "--starts", "2", timeout_s=120)
        for path, name in (("o/run", "a"), ("o/run (2)", "b"), ("o/run (3)", "a")):
            self.assertEqual(self.series(f"{path}/series.csv", "identified")["measured_mm"],
                             columns_of(self.folder / f"{name}.csv")["displacement_mm"])

    def test_validate_writes_the_series_of_each_log(self):
        self.softgrip("validate", "--model", MODEL, "--data", "a.csv", "b.csv", "--out", "o")
        told = json.loads((self.folder / "o/validate.json").read_text())
        for name in "ab":
            columns = self.series(f"o/{name}/series.csv", "given")
            self.assertAlmostEqual(self.rmse(columns["residual_given_mm"]), told["rmse_mm"][name], places=9)
        self.softgrip("export", "o/a/series.csv", "--out", "series.mcap")
        messages = mcap_reading.read(self.folder / "series.mcap")["/signals"]
        self.assertEqual([m["measured_mm"] for _, m in messages], columns_of(self.folder / "a.csv")["displacement_mm"])

    def test_diagnose_writes_the_series_of_all_three_models(self):
        given = (self.folder / MODEL).read_text()
        without = given[:given.index("valve:")] + given[given.index("actuator:"):]
        self.softgrip("diagnose", "--model", self.write("given.yaml", without), "--data", "a.csv", "b.csv", "--out", "o",
                      "--no-closed-loop", timeout_s=170)
        told = json.loads((self.folder / "o/diagnosis.json").read_text())
        self.assertEqual(told["verdict"], "cause_found")
        columns = [self.series(f"o/{name}/series.csv", "given", "recalibrated", "extended") for name in "ab"]
        given_mm, recalibrated_mm, extended_mm = (
            self.rmse([e for c in columns for e in c[f"residual_{model}_mm"]])
            for model in ("given", "recalibrated", "extended"))
        self.assertGreater(given_mm, recalibrated_mm)
        self.assertGreater(recalibrated_mm, 2 * extended_mm)
        self.assertLess(extended_mm, 0.012)


DRIVER = """
#include <stdio.h>
#include "model.c"
int main(void) {
  static NAME_state s;
  double command;
  int first = 1;
  while (scanf("%lf", &command) == 1) {
    printf("%.17g\\n", first ? NAME_reset(&s, command) : NAME_step(&s, command));
    first = 0;
  }
  return 0;
}
"""
INVERSE_DRIVER = """
#include <stdio.h>
#include "model.c"
int main(void) {
  static NAME_inverse_state s;
  double wanted;
  NAME_inverse_reset(&s, 0.0);
  while (scanf("%lf", &wanted) == 1) {
    const double command = NAME_inverse_step(&s, wanted, 0.0, 200.0);
    printf("%.17g %.17g\\n", command, s.pressure_kpa);
  }
  return 0;
}
"""
# A model that contains every block with C code and an inverse. The parameters are chosen so that each block has an effect.
EVERYTHING = """name: every thing
source: "a test"
valve:
  - transport_delay: {delay_s: 0.0372}
  - valve_lag: {time_constant_s: 0.02}
  - asymmetric_valve_lag: {filling_time_constant_s: 0.03, venting_time_constant_s: 0.06}
  - rate_limit: {filling_s_per_kpa: 0.008, venting_s_per_kpa: 0.012}
  - chamber_lag: {filling_time_constant_s: 0.01, venting_time_constant_s: 0.02}
actuator:
  - bouc_wen: {alpha_mm_per_kpa: 0.2, beta_mm_per_kpa: 0.1, gamma_per_kpa: 0.02, eta_per_kpa: 0.03, exponent: 1}
  - prandtl_ishlinskii: {trained_kpa: 18, envelope_bend: 0.2, envelope_skew: -0.1, envelope_kpa: 40, r1_kpa: 0, w1_mm_per_kpa: 0.05, r2_kpa: 4.5, w2_mm_per_kpa: 0.07, r3_kpa: 11, w3_mm_per_kpa: 0.03}
  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 20, c1_kpa_s_per_mm: 100, k2_kpa_per_mm: 0, c2_kpa_s_per_mm: 900}
  - pressure_dependent_creep: {hinge1_kpa: 15, compliance1_mm_per_kpa: 0.04, time_constant1_s: 2}
  - characteristic: {curvature: 0.6, span_mm: 25}
"""
# The only block of the actuator that has C code and no inverse. Its modes have two complex poles, a double pole and two
# real poles.
LINEAR_MODES = """  - linear_modes: {direct_mm_per_kpa: 0.02, period1_s: 0.3, damping_ratio1: 0.1, gain1_mm_per_kpa: 0.05, lead1_mm_per_kpa: -0.04, period2_s: 0.8, damping_ratio2: 1, gain2_mm_per_kpa: -0.03, lead2_mm_per_kpa: 0.02, period3_s: 0.5, damping_ratio3: 2.5, gain3_mm_per_kpa: 0.04, lead3_mm_per_kpa: 0.06}
"""
RATE_HZ, SECONDS = 1000, 60


def wave_kpa(t):
    """Returns a command that consists of sines of two frequencies, ramps, a jump and holds."""
    if t < 10:
        return 20 * (1 - math.cos(2 * math.pi * 0.4 * t))
    if t < 25:
        return 25 + 15 * math.sin(2 * math.pi * 0.9 * t) + 8 * math.sin(2 * math.pi * 3.1 * t)
    if t < 35:
        return 55.0 if t < 30 else 12.0
    if t < 50:
        return abs((t - 35) % 6 - 3) * 18
    return 0.0 if t > 55 else 30.0


def with_valve(*blocks):
    """Returns the model EVERYTHING with other blocks of the valve."""
    head, actuator = EVERYTHING[:EVERYTHING.index("  - transport_delay")], EVERYTHING[EVERYTHING.index("actuator:"):]
    return head + "".join(f"  - {block}\n" for block in blocks) + actuator


class ExportedC(bench.BenchTest):
    """Compiles and runs exported models. Also returns the result of `softgrip simulate` for the same commands."""

    def compiled(self, driver, model, *arguments):
        """Compiles the program of an exported model. The compiler must print no warning."""
        done = self.softgrip("export", model, "--out", "model.c", "--rate-hz", RATE_HZ, "--json", *arguments)
        told = json.loads(done.stdout)
        self.write("driver.c", driver.replace("NAME", told["function"].removesuffix("_step")))
        warnings = ["-Wall", "-Wextra", "-pedantic", "-Werror", *(["-Wno-unused-function"] if told["inverse"] else [])]
        subprocess.run(["cc", "-std=c99", "-O1", "-ffp-contract=off", *warnings, "driver.c", "-o", "driver", "-lm"],
                       cwd=self.folder, check=True, timeout=100)
        return told

    def run_driver(self, numbers):
        done = subprocess.run([self.folder / "driver"], input="\n".join(map(repr, numbers)), capture_output=True,
                              text=True, check=True, timeout=100)
        return [list(map(float, line.split())) for line in done.stdout.splitlines()]

    def simulated(self, model, commands):
        rows = ["time_s,pressure_command_kpa"] + [f"{i / RATE_HZ!r},{c!r}" for i, c in enumerate(commands)]
        self.write("command.csv", "\n".join(rows) + "\n")
        self.softgrip("simulate", "--model", model, "--input", "command.csv", "--out", "simulated.csv", timeout_s=100)
        return columns_of(self.folder / "simulated.csv")["displacement_mm"]

    @staticmethod
    def commands():
        return [wave_kpa(i / RATE_HZ) for i in range(RATE_HZ * SECONDS + 1)]

    @staticmethod
    def wanted():
        """Returns a displacement that rises to 5 mm in two seconds and then oscillates. Despite the creep of the
        finger, pressures above 0 kPa can reach it."""
        return [min(2.5 * t, 5.0) + (2 * (1 - math.cos(2 * math.pi * 0.3 * (t - 2))) if t > 2 else 0.0)
                for t in (i / RATE_HZ for i in range(1, 20 * RATE_HZ))]

    def assert_equal_motions(self, ours, theirs):
        self.assertEqual(len(ours), len(theirs))
        self.assertGreater(max(ours) - min(ours), 5)
        self.assertLess(max(abs(a - b) for a, b in zip(ours, theirs)), 1e-9)


class CModel(ExportedC):

    def compare(self, model, commands=None):
        commands = commands or self.commands()
        told = self.compiled(DRIVER, model)
        ours = self.simulated(model, commands)
        self.assert_equal_motions(ours, [row[0] for row in self.run_driver(commands)])
        return told

    def test_the_c_code_of_bench_twin_equals_simulate_within_1e_9_mm(self):
        self.assertTrue(self.compare(MODEL)["inverse"])

    def test_export_states_why_the_published_model_has_no_inverse(self):
        told = self.compare("config/models/zhang2025.yaml")
        self.assertFalse(told["inverse"])
        self.assertIn("beta", told["no_inverse"])
        self.assertNotIn("inverse_step", (self.folder / "model.c").read_text())

    def test_c_code_of_play_and_nonlinear_characteristic_equals_simulate(self):
        self.compare("config/models/soft_arm_play.yaml")

    def test_c_code_of_every_supported_block_equals_simulate(self):
        before = EVERYTHING.index("  - characteristic")
        self.compare(self.write("every.yaml", EVERYTHING[:before] + LINEAR_MODES + EVERYTHING[before:]))

    def test_c_code_of_linear_modes_with_one_or_no_mode_equals_simulate(self):
        slow = ", period1_s: 100, damping_ratio1: 100, gain1_mm_per_kpa: 0.3, lead1_mm_per_kpa: 0.1"
        for modes in (slow, ""):
            self.compare(self.write("modes.yaml", f"""name: modes
source: "a test"
valve:
  - valve_lag: {{time_constant_s: 0.1}}
actuator:
  - linear_modes: {{direct_mm_per_kpa: 0.1{modes}}}
"""))

    def test_c_code_of_lags_in_only_one_direction_equals_simulate(self):
        for filling_s, venting_s in ((0, 0.06), (0.03, 0)):
            for block in ("asymmetric_valve_lag", "chamber_lag"):
                lag = f"{block}: {{filling_time_constant_s: {filling_s}, venting_time_constant_s: {venting_s}}}"
                limit = f"rate_limit: {{filling_s_per_kpa: {filling_s / 10}, venting_s_per_kpa: {venting_s / 10}}}"
                self.compare(self.write("one_way.yaml", with_valve(limit, lag)))

    def test_c_code_of_a_delay_after_four_lags_equals_simulate(self):
        model = self.write("late.yaml", with_valve(
            "rate_limit: {filling_s_per_kpa: 0.0004, venting_s_per_kpa: 0.0003}", "valve_lag: {time_constant_s: 0.004}",
            "asymmetric_valve_lag: {filling_time_constant_s: 0.003, venting_time_constant_s: 0.005}",
            "chamber_lag: {filling_time_constant_s: 0.004, venting_time_constant_s: 0.003}",
            "transport_delay: {delay_s: 0.25}"))
        # The command reverses at each sample, and each lag splits the segments that the preceding lag passes to it.
        self.compare(model, [20.0 + 15 * (i % 2) for i in range(4 * RATE_HZ)] + [50.0] * RATE_HZ)

    def test_the_c_inverse_cancels_an_actuator_within_1e_9_mm(self):
        for text in ((self.folder / MODEL).read_text(), EVERYTHING):
            body = self.write("body.yaml", text[:text.index("valve:")] + text[text.index("actuator:"):])
            self.assertTrue(self.compiled(INVERSE_DRIVER, body)["inverse"])
            wanted = self.wanted()
            commands = [row[0] for row in self.run_driver(wanted)]
            reached = self.simulated(body, [0.0, *commands])
            self.assertLess(max(abs(a - b) for a, b in zip(reached[1:], wanted)), 1e-9)

    def test_the_c_inverse_compensates_the_lag_but_not_the_delay(self):
        self.assertTrue(self.compiled(INVERSE_DRIVER, MODEL)["inverse"])
        wanted = self.wanted()
        reached = self.simulated(MODEL, [0.0, *(row[0] for row in self.run_driver(wanted))])
        late = round(0.13 * RATE_HZ)
        self.assertLess(max(abs(a - b) for a, b in zip(reached[1 + late:], wanted)), 0.02)
        self.assertGreater(max(abs(a - b) for a, b in zip(reached[1:], wanted)), 0.2)

    def test_export_names_the_blocks_without_c_code(self):
        text = (self.folder / MODEL).read_text().replace("exponent: 1", "exponent: 2")
        path = self.write("sharp.yaml", text + "sensor:\n  - sensor_lag: {time_constant_s: 0.01}\n")
        done = self.softgrip("export", path, "--out", "x.c", "--rate-hz", "100", expect=3)
        self.assertIn("there is no C version of bouc_wen of an exponent above 1, sensor_lag", done.stderr)
        self.assertFalse((self.folder / "x.c").exists())
        self.softgrip("export", MODEL, "--out", "x.c", expect=2)
        self.softgrip("export", MODEL, "--out", "x.c", "--rate-hz", "nan", expect=2)


CALLS = """
u = load("commands.txt");
y = NAME(u);
assert(size(NAME(u')), fliplr(size(y)))
assert(NAME(u), y)  % the state of a call ends with it
save_numbers("simulated.txt", y);
if with_inverse
  save_numbers("inverted.txt", NAME(load("wanted.txt"), 0, 0, 200));
end
refused("NAME()", "the calls are");
refused("NAME([1 NaN])", "u .kPa.: value 2 is not finite");
refused("NAME('text')", "a vector of real doubles is required");
refused("NAME(ones(2, 2))", "a vector of real doubles is required");
refused("NAME([])", "a vector of real doubles is required");
if with_inverse
  refused("NAME(1, 0, 200, 0)", "low .kPa.: a value below high is required");
  refused("NAME(1, [0 1], 0, 200)", "start .kPa.: 1 number is required");
else
  refused("NAME(1, 0, 0, 200)", "NAME.c has no inverse");
end
"""
OCTAVE = """1;
function save_numbers(file, numbers)
  to = fopen(file, "w");
  fprintf(to, "%.17g\\n", numbers);
  fclose(to);
end
function refused(call, text)
  said = "no error";
  try
    eval([call ";"]);
  catch problem
    said = problem.message;
  end
  assert(! isempty(regexp(said, text)), [call ": " said]);
end
"""


@unittest.skipUnless(shutil.which("mkoctfile"), "mkoctfile is missing: Debian's octave-dev")
class CModelInOctave(ExportedC):
    """Compiles examples/matlab/softgrip_mex.c as docs/how-to/export.md states."""

    def octave(self, model):
        """Exports, compiles and calls a model. Returns True if the exported model has an inverse."""
        page = (bench.SOURCE / "docs/how-to/export.md").read_text(encoding="utf-8")
        command = next(line.partition("#")[0] for line in page.splitlines() if line.startswith("mkoctfile"))
        shutil.copy(bench.SOURCE / "examples/matlab/softgrip_mex.c", self.folder)
        done = self.softgrip("export", model, "--out", "model.c", "--rate-hz", RATE_HZ, "--json")
        told = json.loads(done.stdout)
        name = told["function"].removesuffix("_step")
        (self.folder / "model.c").rename(self.folder / f"{name}.c")
        subprocess.run(command.replace("bench_twin", name).split(), cwd=self.folder, check=True, timeout=150)
        for file, numbers in (("commands.txt", self.commands()), ("wanted.txt", self.wanted())):
            self.write(file, "\n".join(map(repr, numbers)) + "\n")
        inverse = "true" if told["inverse"] else "false"
        self.write("calls.m", f"{OCTAVE}with_inverse = {inverse};{CALLS.replace('NAME', name)}")
        done = subprocess.run(["octave", "--no-gui", "--norc", "--quiet", "calls.m"], cwd=self.folder, capture_output=True,
                              text=True, timeout=150)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_equal_motions(self.simulated(model, self.commands()), self.numbers("simulated.txt"))
        return told["inverse"]

    def numbers(self, file):
        return list(map(float, (self.folder / file).read_text().split()))

    def test_the_mex_function_equals_simulate(self):
        self.assertTrue(self.octave(MODEL))
        reached = self.simulated(MODEL, [0.0, *self.numbers("inverted.txt")])
        late = round(0.13 * RATE_HZ)
        self.assertLess(max(abs(a - b) for a, b in zip(reached[1 + late:], self.wanted())), 0.02)

    def test_the_mex_function_reports_a_missing_inverse(self):
        self.assertFalse(self.octave("config/models/zhang2025.yaml"))


if __name__ == "__main__":
    bench.main()
