"""Tests logs and models whose output is a bending angle. The values must equal those of the same finger with its output
in mm. Every text must have the unit of the angle."""

import csv
import html
import json
import math
import re
import subprocess

import bench

TWIN, GIVEN = "config/models/bench_twin.yaml", "config/models/zhang2025.yaml"


def without_times(value):
    """Returns the JSON of a report without the values that differ between mm and degrees or between two runs: times,
    units, hashes and texts."""
    if isinstance(value, dict):
        return {key: without_times(inner) for key, inner in value.items()
                if key not in ("wall_s", "stages_s", "hash", "sha256", "output_unit", "unit")}
    if isinstance(value, list):
        return [without_times(inner) for inner in value]
    return None if isinstance(value, str) else value


def words_of(page):
    """Returns the text that a reader sees on a page, without markup and drawing instructions."""
    return html.unescape(re.sub(r"<[^>]*>", " ", re.sub(r"(?s)<style.*?</style>", "", page)))


class Angles(bench.BenchTest):

    def setUp(self):
        super().setUp()
        for seed, signal in enumerate(("tp1", "sp2"), 1):
            self.softgrip("simulate", "--model", TWIN, "--input", signal, "--rate-hz", "20", "--noise-mm", "0.05", "--seed",
                          seed, "--out", f"{signal}.csv")
            for unit, per_deg in (("deg", 1), ("rad", math.pi / 180)):
                self.rename(f"{signal}.csv", f"{unit}/{signal}.csv", f"angle_{unit}", per_deg)
            self.rename(f"{signal}.csv", f"mm/{signal}.csv", "displacement_mm", 1)

    def rename(self, source, target, column, factor):
        (self.folder / target).parent.mkdir(exist_ok=True)
        with open(self.folder / source, newline="") as file:
            rows = list(csv.reader(file))
        at = rows[0].index("displacement_mm")
        rows[0][at] = column
        for row in rows[1:]:
            row[at] = row[at] if factor == 1 else repr(float(row[at]) * factor)
        with open(self.folder / target, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)

    def in_degrees(self, model):
        name = "deg_" + model.rsplit("/", 1)[1]
        self.write(name, "output_unit: deg\n" + self.read(model))
        return name

    def read(self, path):
        return (self.folder / path).read_text()

    def parameters(self, unit):
        return {key: value["value"] for key, value in json.loads(self.read(f"{unit}/out/identify.json"))["parameters"].items()}

    def identified(self, unit, *more):
        return self.softgrip("identify", "--data", f"{unit}/tp1.csv", "--validate", f"{unit}/sp2.csv", "--starts", "3", *more,
                             "--out", f"{unit}/out", timeout_s=150).stdout

    def assert_in_degrees(self, folder, companion, *texts):
        page = words_of(self.read(f"{folder}/report.html"))
        told = self.read(f"{folder}/{companion}")
        self.assertEqual(json.loads(told)["output_unit"], "deg")
        for text in (page, told, self.read(f"{folder}/report.html"), *texts):
            self.assertEqual(re.findall(r".{0,40}(?: mm\b|\[mm|\bmm/kPa|millimetre).{0,20}", text), [])
        for text in (page, *texts):
            self.assertRegex(text, r"\d deg\b")

    def test_identify_in_degrees_gives_the_same_numbers_as_in_mm(self):
        said = {unit: self.identified(unit, "--figures", f"{unit}/figures") for unit in ("mm", "deg")}
        found = {unit: json.loads(self.read(f"{unit}/out/identify.json")) for unit in said}
        self.assertEqual(without_times(found["deg"]), without_times(found["mm"]))
        self.assertEqual(found["mm"]["output_unit"], "mm")
        self.assertEqual(found["deg"]["parameters"]["bouc_wen.alpha_mm_per_kpa"]["unit"], "deg/kPa")
        self.assert_in_degrees("deg/out", "identify.json", said["deg"])
        self.assertIn("bending angle in degrees", self.read("deg/out/report.html"))
        self.assertIn("\noutput_unit: deg\n", self.read("deg/out/model.yaml"))
        self.assertNotIn("output_unit", self.read("mm/out/model.yaml"))
        self.assertIn("measured_deg,predicted_identified_deg", self.read("deg/out/tp1/series.csv"))
        self.assertEqual(self.read("deg/out/tp1/series.csv").split("\n")[1:], self.read("mm/out/tp1/series.csv").split("\n")[1:])
        heads = [path.read_text().split("\n")[0] for path in (self.folder / "deg/figures").glob("*.csv")]
        self.assertTrue(any("[deg]" in head for head in heads), heads)
        self.assertFalse(any("[mm]" in head for head in heads), heads)

    def test_identify_with_a_chosen_structure_reports_degrees(self):
        for unit in ("mm", "deg"):
            said = self.identified(unit, "--structure", "bouc_wen")
        self.assertEqual(self.parameters("deg"), self.parameters("mm"))
        self.assert_in_degrees("deg/out", "identify.json", said)
        self.assertIn("\noutput_unit: deg\n", self.read("deg/out/model.yaml"))

    def test_a_log_in_radians_gives_the_same_model_as_in_degrees(self):
        for unit in ("deg", "rad"):
            self.identified(unit)
        other = self.parameters("rad")
        for name, value in self.parameters("deg").items():
            self.assertAlmostEqual(other[name] / value, 1, delta=1e-6, msg=name)
        self.assertIn("\noutput_unit: deg\n", self.read("rad/out/model.yaml"))

    def test_validate_and_diagnose_in_degrees_equal_those_in_mm(self):
        found = {}
        for unit in ("mm", "deg"):
            logs = [f"{unit}/tp1.csv", f"{unit}/sp2.csv"]
            models = [self.in_degrees(model) if unit == "deg" else model for model in (TWIN, GIVEN)]
            validated = self.softgrip("validate", "--model", models[0], "--data", *logs, "--out", f"{unit}/validated").stdout
            diagnosed = self.softgrip("diagnose", "--model", models[1], "--data", *logs, "--explain", "--out",
                                      f"{unit}/diagnosed", timeout_s=170).stdout
            found[unit] = [json.loads(self.read(f"{unit}/{name}"))
                           for name in ("validated/validate.json", "diagnosed/diagnosis.json")]
        self.assertEqual(without_times(found["deg"]), without_times(found["mm"]))
        self.assertTrue(found["deg"][1]["causes"], "nothing was diagnosed")
        self.assert_in_degrees("deg/validated", "validate.json", validated)
        self.assert_in_degrees("deg/diagnosed", "diagnosis.json", diagnosed)
        self.assertIn("\noutput_unit: deg\n", self.read("deg/diagnosed/model.yaml"))

    def test_a_diagnosed_change_is_reported_in_degrees(self):
        self.rename("tp1.csv", "deg/later.csv", "angle_deg", 0.8)
        said = self.softgrip("diagnose", "--model", self.in_degrees(TWIN), "--healthy", "deg/tp1.csv", "deg/sp2.csv", "--data",
                             "deg/later.csv", "--explain", "--out", "deg/changed", timeout_s=170).stdout
        self.assert_in_degrees("deg/changed", "diagnosis.json", said)

    def gauge(self, name, header, factor=1):
        self.write(name, header + "\n" + "".join(f"{factor * x!r},{factor * (x + 0.03 * x * (1 - x / 20))!r}\n"
                                                 for x in [*range(0, 28, 3), *range(27, -1, -3)]))

    def test_the_gauge_check_is_reported_in_the_unit_of_the_logs(self):
        found = {}
        for unit, column in (("mm", "displacement_mm"), ("deg", "angle_deg")):
            self.gauge(f"{unit}/gauge.csv", f"gauge_{unit},{column}")
            model = self.in_degrees(TWIN) if unit == "deg" else TWIN
            said = self.softgrip("diagnose", "--model", model, "--data", f"{unit}/tp1.csv", f"{unit}/sp2.csv", "--gauge",
                                 f"{unit}/gauge.csv", "--explain", "--out", f"{unit}/diagnosed", timeout_s=170).stdout
            found[unit] = json.loads(self.read(f"{unit}/diagnosed/diagnosis.json"))
        self.assertEqual(without_times(found["deg"]), without_times(found["mm"]))
        self.assertRegex(found["deg"]["gauge"]["sentence"], r"\d deg\b")
        self.assertTrue("position on the gauge in degrees" in self.read("deg/diagnosed/report.html"))
        self.assert_in_degrees("deg/diagnosed", "diagnosis.json", said)

    def test_baseline_and_health_in_degrees_equal_those_in_mm(self):
        bases, healths = {}, {}
        for unit in ("mm", "deg"):
            column = {"mm": "displacement_mm", "deg": "angle_deg"}[unit]
            runs = []
            for run in range(12):
                self.softgrip("simulate", "--model", TWIN, "--input", "tp1", "--rate-hz", "20", "--noise-mm", "0.05", "--seed",
                              20 + run, "--out", "run.csv")
                runs.append(f"{unit}/run{run:02}.csv")
                self.rename("run.csv", runs[-1], column, 0.7 if run > 8 else 1)
            model = self.in_degrees(TWIN) if unit == "deg" else TWIN
            said = self.softgrip("baseline", "--data", f"{unit}/tp1.csv", "--check", runs[0], "--model", model, "--out",
                                 f"{unit}/base", timeout_s=170).stdout
            bases[unit] = json.loads(self.read(f"{unit}/base/baseline.json"))
            again = self.softgrip("baseline", "--check", f"{unit}/base", timeout_s=170).stdout
            health = self.softgrip("health", *runs, "--baseline", f"{unit}/base", "--points", "run", "--out", f"{unit}/health",
                                   expect=6).stdout
            healths[unit] = json.loads(self.read(f"{unit}/health/health.json"))
        self.assertEqual(bases["deg"]["output_unit"], "deg")
        self.assertEqual(bases["mm"]["output_unit"], "mm")
        self.assertEqual(without_times(bases["deg"])["check"], without_times(bases["mm"])["check"])
        self.assertEqual(without_times(healths["deg"])["fingers"], without_times(healths["mm"])["fingers"])
        finger = healths["deg"]["fingers"][0]
        self.assertEqual(finger["output_unit"], "deg")
        self.assertIn("gain_mm", [alarm["number"] for alarm in finger["alarms"]])
        for text in (said, again, health, words_of(self.read("deg/health/health.html"))):
            self.assertEqual(re.findall(r".{0,40}(?: mm\b|\[mm).{0,20}", text), [])
            self.assertRegex(text, r"\d deg\b")

    def test_health_rejects_a_recording_in_another_unit_than_the_baseline(self):
        self.softgrip("baseline", "--data", "deg/tp1.csv", "--model", self.in_degrees(TWIN), "--out", "base")
        done = self.softgrip("health", "mm/tp1.csv", "--baseline", "base", expect=3)
        self.assertIn("the readings of the recording are in mm, but the baseline of `` is in deg", done.stderr)

    def test_logs_of_two_units_are_refused_with_file_and_line(self):
        done = self.softgrip("identify", "--data", "mm/tp1.csv", "deg/sp2.csv", "--out", "out", expect=3)
        self.assertRegex(done.stderr, r"deg/sp2\.csv:1:\d+: .*'angle_deg' gives readings in deg, and mm/tp1\.csv is in mm")
        self.assertNotIn("softgrip import", done.stderr)
        done = self.softgrip("identify", "--data", "rad/tp1.csv", "--validate", "mm/sp2.csv", "--out", "out", expect=3)
        self.assertRegex(done.stderr, r"mm/sp2\.csv:1:\d+: .*'displacement_mm' gives readings in mm, and rad/tp1\.csv is in deg")
        self.assertFalse((self.folder / "out").exists())

    def test_a_model_of_another_unit_is_refused(self):
        angular = self.in_degrees(TWIN)
        for model, log, why in ((TWIN, "deg/tp1.csv", "in deg, and the model bench_twin is in mm"),
                                (angular, "mm/tp1.csv", "in mm, and the model bench_twin is in deg")):
            for command in (["validate", "--model", model], ["diagnose", "--model", model, "--out", "out"],
                            ["identify", "--start", model, "--out", "out"]):
                done = self.softgrip(*command, "--data", log, expect=3)
                self.assertRegex(done.stderr, rf"{log}:1:\d+: .*{why}")
        self.assertRegex(self.softgrip("tune", "--model", angular, "--out", "out.yaml", expect=3).stderr, r"\bmm\b")
        self.gauge("gauge.csv", "gauge_mm,displacement_mm")
        for command in (["baseline", "--data", "deg/tp1.csv"], ["diagnose", "--model", angular, "--data", "deg/tp1.csv"]):
            done = self.softgrip(*command, "--gauge", "gauge.csv", "--out", "out", expect=3)
            self.assertRegex(done.stderr, r"gauge\.csv: the gauge is in mm, and (the model bench_twin|deg/tp1\.csv) is in deg")
        done = self.softgrip("baseline", "--data", "deg/tp1.csv", "--model", TWIN, "--out", "out", expect=3)
        self.assertIn(f"{TWIN} is in mm, but the logs are in deg", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_a_rig_with_a_model_in_degrees_is_rejected(self):
        why = "the output unit of the model is deg, but a rig measures and controls in mm"
        self.assertIn(f":1:1: {why}", self.softgrip("check", self.in_degrees(TWIN), expect=3).stderr)
        self.write(TWIN, "output_unit: deg\n" + self.read(TWIN))
        self.assertIn(f"{TWIN}:1:1: {why}", self.softgrip("check", "config/rig.yaml", expect=3).stderr)
        done = subprocess.run([bench.SOFTGRIPD, "--config", "config/rig.yaml", "--check"], cwd=self.folder,
                              capture_output=True, text=True, timeout=bench.PATIENCE_S, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn(why, done.stderr)

    def test_simulate_writes_the_angle_of_a_model_in_degrees(self):
        model = self.in_degrees(TWIN)
        told = self.softgrip("simulate", "--model", model, "--input", "tp1", "--rate-hz", "20", "--noise-mm", "0.05",
                             "--seed", "1", "--out", "simulated.csv").stdout
        self.assertRegex(told, r"span [\d.]+ deg, noise 0\.05 deg")
        self.assertEqual(self.read("simulated.csv"), self.read("deg/tp1.csv"))
        self.softgrip("export", "simulated.csv", "--out", "wide.csv")
        self.assertIn("angle_deg", self.read("wide.csv").split("\n")[0])
        self.softgrip("export", model, "--rate-hz", "100", "--out", "finger.c")
        self.assertIn("Returns the bending angle [deg]", self.read("finger.c"))

    def test_imported_angles_are_converted_to_degrees(self):
        with open(self.folder / "tp1.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        wanted = [float(row["displacement_mm"]) for row in rows]
        for name, factor, options in (("bend [\u00b0]", 1, ()), ("theta_rad", math.pi / 180, ()),
                                      ("Winkel (degrees)", 1, ()), ("flex [V]", 1 / 18, (
                                          "--displacement", "flex [V]", "--scale", "displacement=18", "--unit",
                                          "displacement=deg"))):
            with open(self.folder / "foreign.csv", "w", newline="") as file:
                csv.writer(file).writerows([["t (s)", "set (kPa)", name], *(
                    [row["time_s"], row["pressure_command_kpa"], repr(value * factor)] for row, value in zip(rows, wanted))])
            told = json.loads(self.softgrip("import", "foreign.csv", *options, "--yes", "--json", "--out", "log.csv").stdout)
            self.assertEqual(told["logs"][0]["output_unit"], "deg", name)
            with open(self.folder / "log.csv", newline="") as file:
                got = [float(row["angle_deg"]) for row in csv.DictReader(file)]
            self.assertEqual(len(got), len(wanted))
            for a, b in zip(got, wanted):
                self.assertAlmostEqual(a, b, delta=1e-9, msg=name)
