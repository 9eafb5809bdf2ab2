#!/usr/bin/python3
"""Compares the computing times of the Python package with those of the C++ library and of SciPy, on one page.

    bench/python_library.py [--build build/release] [--page docs/results/python-library.md] [--runs 5]

Measures the import, one simulation of 10,000 samples from Python and from C++, and the identification of the demo with
`softgrip.identify()` and with `scipy.optimize.least_squares` on a compiled simulator. Needs Debian's python3-scipy
(scripts/packages.sh tests readers). Exit codes: 0: the page was written; 1: a program failed or a requirement is not
met.
"""
import json
import os
import pathlib
import shutil
import statistics
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
import beside  # noqa: E402
import results_page  # noqa: E402

SAMPLES, CALLS, STARTS = 10_000, 400, 20
MOST_IMPORT_S, MOST_OVERHEAD_PERCENT = 0.15, 5
TRUTH = ROOT / "config/models/bench_twin.yaml"
PUBLISHED = ROOT / "config/models/zhang2025.yaml"
PYTHON = "/usr/bin/python3"

IMPORT = """import sys, time
if {without_numpy}: sys.modules["numpy"] = None
wall, cpu = time.perf_counter(), time.process_time()
import softgrip
print(time.perf_counter() - wall, time.process_time() - cpu, softgrip.Gripper.__name__)"""
SIMULATE = f"""import sys, time
import numpy as np
import softgrip
model = softgrip.Model.load({str(TRUTH)!r})
t = np.arange({SAMPLES}) / 100
pressure = 20 - 20 * np.cos(2 * np.pi * 0.1 * t)
for _ in range({CALLS}):
    began = time.perf_counter_ns()
    model.simulate(t, pressure)
    print(time.perf_counter_ns() - began)"""
IDENTIFY = f"""import json, sys
import softgrip
fit, *others = map(softgrip.Log.read, sys.argv[1:])
found = softgrip.identify(fit, start=softgrip.Model.load({str(PUBLISHED)!r}), starts={STARTS}, validation=others)
print(json.dumps({{"rmse_mm": found.rmse, "held_out_rmse_mm": [one.rmse for one in found.validation]}}))"""


class Study:
    def __init__(self, build, runs, folder):
        self.build, self.runs, self.folder = build, runs, folder
        self.version = results_page.version_of(build)
        self.environment = {**os.environ, "PYTHONPATH": str(build / "python"), "LD_LIBRARY_PATH": str(build / "library")}

    def said(self, *words):
        """Runs a program. Returns the standard output of the program and its processor time on all cores [s]."""
        return beside.said(words, self.folder, self.environment)

    def imports(self, without_numpy):
        """Returns the median wall time and the median processor time of an import [s]."""
        times = [self.said(PYTHON, "-c", IMPORT.format(without_numpy=without_numpy))[0].split() for _ in range(4 * self.runs)]
        return [statistics.median(float(one[column]) for one in times) for column in (0, 1)]

    def simulations(self):
        """Returns the time of the fastest call from C++ and from Python [µs]. Processes of the two languages alternate.
        The fastest call is used, because other programs on the machine can only increase the time of a call. In both
        languages, malloc is set to keep freed memory. By default, the small C++ program would return the memory to the
        system after each call, which would make the next call slower."""
        self.environment |= {"MALLOC_TRIM_THRESHOLD_": str(2**28), "MALLOC_MMAP_THRESHOLD_": str(2**25)}
        self.said("c++", "-std=c++20", "-O2", "-I", ROOT / "library/include", ROOT / "bench/library_simulate.cpp", "-o",
                  "library_simulate", self.build / "library/libsoftgrip.so")
        fastest = {"C++": [], "Python": []}
        for _ in range(self.runs):
            for name, words in (("C++", ["./library_simulate", TRUTH, SAMPLES, CALLS]), ("Python", [PYTHON, "-c", SIMULATE])):
                fastest[name].append(min(map(int, self.said(*words)[0].split())) / 1000)
        return [min(values) for values in fastest.values()]

    def identifications(self):
        """Returns, for SciPy and for softgrip, the result of the identification and the median processor time [s]."""
        logs = []
        for signal in ("tp1", "steps", "sp2"):
            logs.append(f"{signal}.csv")
            self.said(self.build / "tools/softgrip", "simulate", "--model", TRUTH, "--input", signal, "--out", logs[-1],
                      "--noise-mm", 0.05, "--seed", 3, "--rate-hz", 100)
        shutil.copy(ROOT / "bench/beside/identify.py", self.folder)
        self.said("cc", "-O2", "-shared", "-fPIC", "-o", "simulator.so", ROOT / "bench/sysid_peer_simulator.c", "-lm")
        found = []
        for words in ([PYTHON, "identify.py"], [PYTHON, "-c", IDENTIFY]):
            outputs = [self.said(*words, *logs) for _ in range(self.runs)]
            found.append((json.loads(outputs[0][0]), statistics.median(seconds for _, seconds in outputs)))
        return found


def main():
    parser = results_page.arguments(__doc__, page=ROOT / "docs/results/python-library.md")
    parser.add_argument("--runs", type=int, default=5)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        study = Study(args.build, args.runs, pathlib.Path(folder))
        with_numpy, without_numpy = study.imports(False), study.imports(True)
        cpp_us, python_us = study.simulations()
        (scipy, scipy_s), (ours, ours_s) = study.identifications()
    overhead = 100 * (python_us / cpp_us - 1)
    rows = [
        ("`import softgrip`, wall time and processor time", f"{with_numpy[0]:.3f} and {with_numpy[1]:.3f} s",
         f"less than {MOST_IMPORT_S} s"),
        ("`import softgrip` without NumPy, wall time and processor time", f"{without_numpy[0]:.3f} and {without_numpy[1]:.3f} s", f"less than {MOST_IMPORT_S} s"),
        (f"`Model.simulate()` of {SAMPLES:,} samples from C++", f"{cpp_us:.1f} µs", "-"),
        ("`Model.simulate()` of 10,000 samples from Python", f"{python_us:.1f} µs, {overhead:+.1f} % compared with C++",
         f"at most {MOST_OVERHEAD_PERCENT} % more than in C++")]
    fits = [(name, f"{seconds:.2f}", f"{found['rmse_mm']:.4f}", *(f"{one:.4f}" for one in found["held_out_rmse_mm"]))
            for name, found, seconds in (("SciPy", scipy, scipy_s), ("`softgrip.identify()`", ours, ours_s))]
    text = "\n".join([
        *results_page.head(
            "Python functions compared with C++ and SciPy",
            f"A simulation takes {abs(overhead):.1f} % {'more' if overhead > 0 else 'less'} time if it is called from Python than if it is called from C++. "
            f"The fits of `softgrip.identify()` and SciPy have RMS errors of {ours['rmse_mm']:.4f} and {scipy['rmse_mm']:.4f} mm, and `softgrip.identify()` "
            f"needs {scipy_s / ours_s:.1f} times less processor time than SciPy.",
            study.version, f"bench/python_library.py --runs {args.runs}", f"simulated logs; {results_page.here()}"),
        "| measured | result | required |", "|---|---|---|", *("| " + " | ".join(row) + " |" for row in rows), "",
        f"The time of `import softgrip` is the median of {4 * args.runs} processes. The time of a simulation is the shortest time of {args.runs * CALLS:,} calls.",
        "The benchmark ran processes in C++ and in Python alternately. The processes of both languages used a `MALLOC_TRIM_THRESHOLD_` of 256 MiB. With the",
        "default value of `MALLOC_TRIM_THRESHOLD_`, the C++ program returns memory to the operating system after each call, so its next call takes longer.", "",
        "## Identification", "",
        "| program | processor time [s] | RMSE on the fitted log tp1 [mm] | RMSE on the held-out log steps [mm] | RMSE on the held-out log sp2 [mm] |", "|---|---|---|---|---|",
        *("| " + " | ".join(row) + " |" for row in fits), "",
        f"SciPy and softgrip each start the fit from the published parameters and from {STARTS - 1} other parameter sets. SciPy's `least_squares` calls a simulator in C",
        f"(`bench/sysid_peer_simulator.c`) through ctypes. The processor time is the sum over all cores for the complete program (median of {args.runs}",
        "runs). The processor time of `softgrip.identify()` also includes the computation of confidence intervals, warnings and the report.", ""])
    args.page.write_text(text)
    print(text)
    met = max(with_numpy[1], without_numpy[1]) < MOST_IMPORT_S and overhead <= MOST_OVERHEAD_PERCENT
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
