#!/usr/bin/python3
"""softgrip diagnose on measured logs of a soft pneumatic arm: what is said of data whose truth nobody knows.

    bench/diagnosis_measured.py --data FOLDER [--softgrip PROGRAM] [--out FOLDER] [--nulls 19]

The logs are made as bench/sysid_measured.py makes them. Each is diagnosed twice: with the commanded pressure as
input, and with the measured one, which takes the regulator out of the question. The model given is the one that
`softgrip identify` finds on the same log. Held-out errors are in percent of the span (30 mm), over blocks that the
refitted model has not seen, beside the second half predicted from the first by the baseline of sysid_measured.py.
Exit code 4 where the data are not there.
"""
import argparse
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import sysid_measured as measured  # noqa: E402


def diagnose(args, log, drive, out):
    common = ["--data", log, "--drive", drive]
    # 6: identified, but the structure does not explain the log, which is why it is diagnosed.
    fitted = subprocess.run([args.softgrip, "identify", *common, "--out", out + "_identified"], capture_output=True, text=True)
    if fitted.returncode not in (0, 6):
        sys.exit(f"{log}, {drive}: {fitted.stderr.strip()}")
    done = subprocess.run([args.softgrip, "diagnose", "--model", os.path.join(out + "_identified", "model.yaml"), *common,
                           "--out", out, "--no-closed-loop", "--nulls", str(args.nulls), "--json"], capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"{log}, {drive}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    parser.add_argument("--softgrip", default=os.path.join(root, "build/release/tools/softgrip"))
    parser.add_argument("--data", required=True)
    parser.add_argument("--out", default="diagnosis_measured")
    parser.add_argument("--nulls", type=int, default=19)
    args = parser.parse_args()
    if not os.path.isdir(args.data):
        print(f"diagnosis_measured.py: the measured logs are not there: {args.data}", file=sys.stderr)
        return 4
    os.makedirs(args.out, exist_ok=True)
    percent = 100 / measured.SPAN_MM
    print(f"{'log':<22}{'drive':<10}{'verdict':<14}{'recal. %':>9}{'ext. %':>8}{'noise %':>9}{'left %':>8}{'p':>7}"
          f"{'baseline %':>12}  named, or in brackets what explains part of it")
    for (name, segment), (_, _, baseline) in measured.BASELINE.items():
        log = os.path.join(args.out, f"{name}_segment{segment}.csv")
        measured.convert(os.path.join(args.data, f"{name}_data_collect_1.csv"), segment, log)
        for drive in ("command", "measured"):
            d = diagnose(args, log, drive, os.path.join(args.out, f"{name}_segment{segment}_{drive}"))
            named = [" or ".join([c["id"], *rivals]) for c, rivals in zip(d["causes"], d["alternatives"])]
            partly = [c["id"] for c in d["partial_causes"]]
            held = d["heldout_rmse_mm"]
            nulls = d["null_calibration"]
            print(f"{name + ' segment ' + str(segment):<22}{drive:<10}{d['verdict']:<14}{held['recalibrated'] * percent:>9.2f}"
                  f"{held['extended'] * percent:>8.2f}{d['noise_mm'] * percent:>9.2f}{d['unexplained_percent']:>8.1f}"
                  f"{nulls['p_value'] if nulls else float('nan'):>7.2f}{baseline:>12.2f}  {', '.join(named)}"
                  f"{'[' + ', '.join(partly) + ']' if partly else ''}", flush=True)
    print(f"reports: {args.out}/*/report.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
