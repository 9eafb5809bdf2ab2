#!/usr/bin/python3
"""Diagnoses all seven subsets of the three logs that scripts/demo.sh creates, and writes the results as a page.

    bench/demo_subsets.py --build BUILD [--page FILE] [--check] [SUBSET ...]

SUBSET: names of logs joined by +, such as tp1+sp2; default: all seven. --check fails in three cases: an interval does
not cover the true value of the simulated finger; a wrong cause is named; a cause that is named with some logs is no
longer named when logs are added.
"""
import argparse
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "scripts"))
import results_page  # noqa: E402

NUMBER_OF = {"transport_delay": "delay_s", "valve_lag": "time_constant_s"}


def demo_logs():
    """Returns the names of the demo's signals, and the options with which the demo calls `softgrip simulate`."""
    text = (ROOT / "scripts/demo.sh").read_text()
    signals = re.search(r"for signal in ([a-z0-9 ]+); do", text)[1].split()
    options = re.search(r"--noise-mm [0-9.]+ --seed \d+ --rate-hz \d+", text)[0].split()
    return signals, options


def truth():
    """Returns the true delay and the true lag of the simulated finger [s], by cause."""
    text = (ROOT / "config/models/bench_twin.yaml").read_text()
    return {cause: float(re.search(rf"{cause}:\s+{number}: ([0-9.]+)", text)[1]) for cause, number in NUMBER_OF.items()}


def diagnose(softgrip, logs, out):
    done = subprocess.run([softgrip, "diagnose", "--model", ROOT / "config/models/zhang2025.yaml", "--data", *logs, "--out",
                           out, "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def found(diagnosis):
    """Returns a tuple (value, low, high, inclusion) for each named cause, or None in place of the tuple for a cause
    that is not in NUMBER_OF."""
    rows = {}
    for cause in diagnosis["causes"]:
        number = cause["parameters"].get(NUMBER_OF.get(cause["id"]))
        rows[cause["id"]] = number and (number["value"], *(number["ci95"] or (None, None)), cause["inclusion"])
    return rows


def complaints(results, real):
    """Returns a sentence for each error in the diagnoses."""
    wrong = []
    for subset, rows in results.items():
        for cause, row in rows.items():
            if cause not in real:
                wrong.append(f"{'+'.join(subset)}: {cause} is named")
            elif row and row[1] is not None and not row[1] <= real[cause] <= row[2]:
                wrong.append(f"{'+'.join(subset)}: {cause} {row[1]:.4f} .. {row[2]:.4f} does not hold {real[cause]}")
    for fewer, more in itertools.permutations(results, 2):
        if set(fewer) < set(more):
            wrong += [f"{'+'.join(more)} misses {cause}, which {'+'.join(fewer)} names"
                      for cause in results[fewer] if cause in real and cause not in results[more]]
    return wrong


def cell(row):
    if row is None:
        return "not named"
    value, low, high, inclusion = row
    interval = f" ({low:.4f} .. {high:.4f})" if low is not None else ""
    return f"{value:.4f} s{interval}, inclusion {inclusion:.2f}"


def page(results, verdicts, real, options, version):
    both = sum(verdict == "cause_found" and real.keys() <= rows.keys() for verdict, rows in zip(verdicts.values(), results.values()))
    lines = [*results_page.head(
                 "The demo's logs, all seven subsets",
                 f"With {both} of the {len(results)} combinations of the demo's logs, the diagnosis names the transport delay "
                 "and the valve lag, both without an alternative.", version, "bench/demo_subsets.py --build build/release --page docs/results/demo-subsets.md",
                 f"simulated logs, `softgrip simulate` with `{' '.join(options)}`, `softgrip diagnose --model "
                 "config/models/zhang2025.yaml`"),
             f"The simulated finger of the demo has a transport delay of {real['transport_delay']} s and a valve lag of {real['valve_lag']} s. The model that `softgrip diagnose` receives has neither a delay nor a lag. If the logs do not show that the finger has a lag, the confidence interval of the delay contains the delays of two fits: one with and one without a lag. The *inclusion* of a cause is the share of bootstrap samples in which the model with the cause is better than the model without the cause or with another cause.", "",
             "| logs | verdict | transport delay | valve lag |", "|---|---|---|---|"]
    for subset, rows in results.items():
        lines.append(f"| {' + '.join(subset)} | {verdicts[subset]} | {cell(rows.get('transport_delay'))} | "
                     f"{cell(rows.get('valve_lag'))} |")
    wrong = complaints(results, real)
    lines += ["", "Every confidence interval in the table contains the true value. An additional log never reduces the number of named causes." if not wrong else "Wrong:"]
    return "\n".join(lines + [f"- {sentence}" for sentence in wrong]) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True, type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("subsets", nargs="*")
    args = parser.parse_args()
    softgrip = args.build.resolve() / "tools/softgrip"
    signals, options = demo_logs()
    subsets = [tuple(s.split("+")) for s in args.subsets] or [
        subset for count in (1, 2, 3) for subset in itertools.combinations(signals, count)]
    results, verdicts = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for signal in signals:
            subprocess.run([softgrip, "simulate", "--model", ROOT / "config/models/bench_twin.yaml", "--input", signal,
                            "--out", f"{folder}/{signal}.csv", *options], check=True, capture_output=True)
        for subset in subsets:
            diagnosis = diagnose(softgrip, [f"{folder}/{signal}.csv" for signal in subset], f"{folder}/out")
            results[subset], verdicts[subset] = found(diagnosis), diagnosis["verdict"]
            print(" + ".join(subset), verdicts[subset], {c: cell(r) for c, r in results[subset].items()}, flush=True)
    real = truth()
    if args.page:
        args.page.write_text(page(results, verdicts, real, options, results_page.version_of(args.build)))
    wrong = complaints(results, real)
    print("\n".join(wrong), file=sys.stderr)
    sys.exit(1 if args.check and wrong else 0)


if __name__ == "__main__":
    main()
