#!/usr/bin/python3
"""Repeats the identification of the demo in Octave and in Python with SciPy, and compares the results with softgrip's
on one page.

    bench/beside.py [--build build/release] [--page docs/results/beside-octave-and-scipy.md] [--runs 3]

Needs Debian's octave, octave-optim, octave-dev, python3-scipy and python3-pandas (scripts/packages.sh tests readers
benchmarks). The programs for Octave and SciPy are in bench/beside. Both programs use one simulator, which is compiled C
code. This script measures every number of the page. Exit codes: 0: the page was written; 1: a program failed, or a
program read values that differ from the exported values.
"""
import csv
import json
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
import results_page  # noqa: E402

BESIDE = ROOT / "bench/beside"
SIGNALS = ("tp1", "steps", "sp2")
TRUTH = ROOT / "config/models/bench_twin.yaml"
PUBLISHED = ROOT / "config/models/zhang2025.yaml"
SIMULATOR, MEX = ROOT / "bench/sysid_peer_simulator.c", ROOT / "bench/sysid_peer_mex.c"


def said(words, folder, environment=None):
    """Runs a program. Returns the standard output of the program and the processor time that it used on all cores [s].
    The elapsed time is not used, because other programs on the machine increase it."""
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in words], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}:\n{done.stdout}{done.stderr}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, used.ru_utime + used.ru_stime - began.ru_utime - began.ru_stime


def repeated(runs, words, folder):
    """Runs a program `runs` times. Returns the output of the first run and the median of the processor times."""
    outputs = [said(words, folder) for _ in range(runs)]
    return outputs[0][0], statistics.median(seconds for _, seconds in outputs)


def lines_of(*files):
    """Returns the number of lines of a file that contain code. Empty lines and comments are not counted."""
    comment = ("#", "%", "/*", "*", "//", '"""')
    return sum(bool(line.strip()) and not line.strip().startswith(comment)
               for file in files for line in file.read_text().splitlines())


def mm(value):
    return f"{value:.3f}"


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(map(str, row)) + " |" for row in rows), ""]


class Study:
    def __init__(self, build, runs, folder):
        self.version = results_page.version_of(build)
        self.softgrip, self.runs, self.folder = build / "tools/softgrip", runs, folder
        self.octave = ["octave-cli", "--quiet", "--no-history", "--norc", "--eval"]

    def prepare(self):
        for signal in SIGNALS:
            said([self.softgrip, "simulate", "--model", TRUTH, "--input", signal, "--out", f"{signal}.csv",
                  "--noise-mm", 0.05, "--seed", 3, "--rate-hz", 100], self.folder)
        for file in (*BESIDE.iterdir(), SIMULATOR, MEX):
            if file.is_file():
                shutil.copy(file, self.folder)
        said(["cc", "-O2", "-shared", "-fPIC", "-o", "simulator.so", SIMULATOR.name, "-lm"], self.folder)
        said(["mkoctfile", "-O2", "--mex", "-o", "simulate.mex", MEX.name, SIMULATOR.name], self.folder)

    def peers(self):
        logs = [f"{signal}.csv" for signal in SIGNALS]
        text, seconds = repeated(self.runs, ["/usr/bin/python3", "identify.py", *logs], self.folder)
        self.scipy = {**json.loads(text), "processor_s": seconds}
        call = "identify('.', " + ", ".join(f"'{log}'" for log in logs) + ")"
        text, seconds = repeated(self.runs, [*self.octave, call], self.folder)
        self.octave_result = {**json.loads(text), "processor_s": seconds}

    def ours(self):
        words = [self.softgrip, "identify", "--start", PUBLISHED, "--data", "tp1.csv", "--validate", "steps.csv",
                 "sp2.csv", "--out", "identified"]
        _, self.identify_s = repeated(self.runs, words, self.folder)
        self.identified = json.loads((self.folder / "identified/identify.json").read_text())
        _, self.diagnose_s = said([self.softgrip, "diagnose", "--model", PUBLISHED, "--data", "tp1.csv", "--out",
                                   "diagnosis", "--no-closed-loop"], self.folder)
        self.diagnosis = json.loads((self.folder / "diagnosis/diagnosis.json").read_text())
        said([self.softgrip, "validate", "--model", "diagnosis/model.yaml", "--data", "steps.csv", "sp2.csv", "--out",
              "extended"], self.folder)
        self.extended = json.loads((self.folder / "extended/validate.json").read_text())["rmse_mm"]

    def exports(self):
        """Returns, for each program that reads the exported file, the largest difference between the values that the
        program read and the exported values [mm]."""
        import pandas
        import scipy.io
        said([self.softgrip, "export", "tp1.csv", "--out", "out.mat"], self.folder)
        said([self.softgrip, "export", "tp1.csv", "--out", "wide.csv"], self.folder)
        with open(self.folder / "tp1.csv", newline="") as file:
            was = [float(row["displacement_mm"]) for row in csv.DictReader(file)]
        by_octave, _ = said([*self.octave, "load out.mat; printf('%.17g\\n', displacement_mm)"], self.folder)
        read = {"Octave, `load out.mat`": [float(line) for line in by_octave.split()],
                "SciPy, `scipy.io.loadmat`":
                    scipy.io.loadmat(self.folder / "out.mat", squeeze_me=True)["displacement_mm"].tolist(),
                "pandas, `read_csv` of the wide CSV":
                    pandas.read_csv(self.folder / "wide.csv", float_precision="round_trip")["displacement_mm"].tolist()}
        self.readers = []
        for reader, values in read.items():
            if len(values) != len(was):
                sys.exit(f"{reader}: {len(values)} values of {len(was)}")
            self.readers.append((reader, len(values), max(abs(a - b) for a, b in zip(values, was))))
        if any(difference > 0 for _, _, difference in self.readers):
            sys.exit(f"what was exported is not what was read back: {self.readers}")

    def summary_rows(self):
        ours = self.identified
        held_out = ours["validation"]["rmse_mm"]
        rows = [("Octave, `lsqcurvefit`", lines_of(BESIDE / "identify.m") + lines_of(SIMULATOR, MEX),
                 f"{self.octave_result['processor_s']:.1f}", mm(self.octave_result["rmse_mm"]),
                 *map(mm, self.octave_result["held_out_rmse_mm"]), f"{self.octave_result['reached']} of 20"),
                ("Python, `scipy.optimize.least_squares`", lines_of(BESIDE / "identify.py") + lines_of(SIMULATOR),
                 f"{self.scipy['processor_s']:.1f}", mm(self.scipy["rmse_mm"]), *map(mm, self.scipy["held_out_rmse_mm"]),
                 f"{self.scipy['reached']} of 20"),
                ("`softgrip identify`", 0, f"{self.identify_s:.1f}", mm(ours["rmse_mm"]["tp1"]), mm(held_out["steps"]),
                 mm(held_out["sp2"]), f"{ours['multistart']['share_reached_best'] * ours['multistart']['starts']:.0f} of "
                 f"{ours['multistart']['starts']}"),
                ("`softgrip diagnose --no-closed-loop`, on `tp1` alone", 0, f"{self.diagnose_s:.1f}", "-", mm(self.extended["steps"]),
                 mm(self.extended["sp2"]), "-")]
        return rows

    def unsaid_rows(self):
        beta = self.identified["parameters"]["bouc_wen.beta_mm_per_kpa"]
        half = (beta["ci95"][1] - beta["ci95"][0]) / 2 if beta["ci95"] else float("nan")
        causes = ", ".join(
            f"{cause['id']} (" + ", ".join(f"{name} {value['value']:.3g}" for name, value in cause["parameters"].items())
            + ")" for cause in self.diagnosis["causes"])
        residuals = self.identified["residuals"]
        return [
            ("uncertainty of beta (95 %)",
             f"± {self.scipy['beta_ci95']:.2g} mm/kPa from the Jacobian, as if every sample were independent",
             f"± {half:.2g} mm/kPa: the residuals are correlated (lag-1 correlation "
             f"{residuals['lag1_correlation']:.2f}), so they contain as much information as {residuals['effective_samples']:.0f} independent samples"),
            ("the model has no inverse", f"not reported; the script only prints beta {self.scipy['beta']:.3f} and alpha "
             f"{self.scipy['alpha']:.3f} mm/kPa", next((w for w in self.identified["warnings"] if "inverse response" in w), "-")),
            ("cause of the missing inverse", "not reported; the small error of the fit does not show that an effect is missing", f"{self.diagnosis['verdict']}: {causes or '-'}"),
            ("reduction of the held-out RMS error by the named causes", "-", f"steps {mm(self.identified['validation']['rmse_mm']['steps'])} → "
             f"{mm(self.extended['steps'])} mm, sp2 {mm(self.identified['validation']['rmse_mm']['sp2'])} → "
             f"{mm(self.extended['sp2'])} mm"),
            ("a log with a wrong unit, an inverted sign or swapped columns", "not reported; the fit ends with a wrong model, or does not converge",
             "reported with a warning that states the suspicious number ([how](../how-to/import.md#plausibility-warnings))"),
            ("reproduction of the numbers", "possible if the user has kept all files",
             "`softgrip report --verify` checks the hashes, repeats the call and compares every number ([how](../how-to/identify.md))")]

    def page(self):
        return "\n".join([
            *results_page.head(
                "Compared with Octave and SciPy",
                f"Octave, SciPy and `softgrip identify` fit the demo's log with RMS errors of {mm(self.octave_result['rmse_mm'])}, "
                f"{mm(self.scipy['rmse_mm'])} and {mm(self.identified['rmse_mm']['tp1'])} mm. With Octave or SciPy, the user must write a script. With softgrip, the user needs no script.",
                self.version, f"bench/beside.py --runs {self.runs}",
                f"simulated logs; {results_page.here()}"),
            "The identification of the demo's model is repeated with three programs: Octave with `lsqcurvefit`, Python with SciPy, and `softgrip`. The authors of the",
            "published model used `lsqcurvefit` of MATLAB. Each program fits a model to the log `tp1` from 20 start points and predicts the logs `steps` and `sp2`.",
            "`bench/beside.py` writes this page with all its numbers. `bench/beside.py` needs the packages of `scripts/packages.sh tests readers benchmarks`.",
            "",
            "## Steps of the identification",
            "",
            *table(["step", "Octave", "SciPy", "softgrip"], [
                ("read the log", "`csvread`, columns by number", "`genfromtxt`, columns by name",
                 "`--data`. If a file is not a log, softgrip states the line of the error; such a file can be [imported](../how-to/import.md)"),
                ("simulate the model", f"{SIMULATOR.name} ({lines_of(SIMULATOR)} lines of C), and {lines_of(MEX)} lines of C that call it",
                 "the C simulator of the Octave column, called with ctypes", "built in"),
                ("choose parameters, bounds and start points", "logarithms and bounds by hand, 20 starts in a loop",
                 "logarithms and bounds by hand, 20 starts in a loop", "`--starts 20`"),
                ("fit the parameters", "`lsqcurvefit`", "`least_squares`", "`softgrip identify`"),
                ("compute confidence intervals", "from the Jacobian by hand", "from the Jacobian by hand", "in the report"),
                ("predict the logs that were not fitted", "by hand", "by hand", "`--validate`"),
                ("write figures, time series and report", "by hand", "by hand", "`report.html`, `series.csv`")]),
            "## Lines of code, processor time and errors",
            "",
            *table(["program", "lines of code that the user writes", "processor time [s]", "RMSE on the fitted log tp1 [mm]",
                    "RMSE on the held-out log steps [mm]", "RMSE on the held-out log sp2 [mm]",
                    "starts that reached the smallest error"], self.summary_rows()),
            "The numbers of lines include the simulator, but not blank lines and comments. The processor time is the sum over all cores for the complete program.",
            f"The table states the median of {self.runs} runs for each fit, and the time of one run for the diagnosis. The three fits have equal errors, because the problem is",
            "small and each optimiser uses a compiled simulator.",
            "",
            "## Results that only softgrip gives",
            "",
            *table(["result", "Octave and SciPy", "softgrip"], self.unsaid_rows()),
            "## Other programs can read the exported files",
            "",
            "`softgrip export` writes the log `tp1.csv` as a .mat file and as a wide CSV file. Three other programs read the two exported files:",
            "",
            *table(["program that reads the file", "number of values", "largest difference from the log [mm]"],
                   [(reader, count, f"{difference:g}") for reader, count, difference in self.readers])])


def main():
    parser = results_page.arguments(__doc__, page=ROOT / "docs/results/beside-octave-and-scipy.md")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        study = Study(options.build, options.runs, pathlib.Path(folder))
        for step in (study.prepare, study.peers, study.ours, study.exports):
            step()
        options.page.write_text(study.page(), encoding="utf-8")
    print(options.page)


if __name__ == "__main__":
    main()
