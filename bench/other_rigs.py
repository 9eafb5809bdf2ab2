#!/usr/bin/python3
"""Simulates 17 rigs of other kinds than the models of softgrip, and judges the diagnosis of changes on their runs.

    bench/other_rigs.py --out DIR [--program PROGRAM] [--healthy 3 ...] [--rigs NAME ...] [--logs DIR] [--workers 1]
                        [--only-logs] [--stored] [--page FILE]

Each rig has 6 healthy runs, 2 repeats with the same kind of input, 1 repeat with another kind of input, and 5 runs with
a labelled change. --healthy selects the number of healthy runs; several numbers are judged one after the other. The logs
are written to --logs (default: DIR/rigs) if this folder has no labels.csv. The answers of softgrip are stored in
DIR/healthyN/RIG/diagnose/RUN. A repeated run makes only the calls whose inputs have changed.
Exit codes: 0: all cases were judged; 1: some failed; 2: usage; 4: no such program.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench/other_rigs"), str(ROOT / "bench/foreign")]

import rig_files  # noqa: E402
import rig_judge  # noqa: E402
import rig_page  # noqa: E402
from outcomes import output_of, write_whole  # noqa: E402

PAGE = ROOT / "docs/results/other-rigs.md"


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/tools/softgrip")
    parser.add_argument("--healthy", type=int, nargs="+", choices=(1, 2, 3, 4, 5, 6), default=[3])
    parser.add_argument("--rigs", nargs="+", choices=list(rig_files.RIGS), metavar="NAME", help=", ".join(rig_files.RIGS))
    parser.add_argument("--logs", type=pathlib.Path, help="folder of the logs [OUT/rigs]")
    parser.add_argument("--only-logs", action="store_true", help="write the logs, and diagnose nothing")
    parser.add_argument("--stored", action="store_true", help="judge only the cases of an interrupted run that have answers")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--at-most-s", type=float, default=3600, help="for one call")
    parser.add_argument("--page", type=pathlib.Path, nargs="?", const=PAGE, help=f"Markdown [{PAGE.relative_to(ROOT)}]")
    options = parser.parse_args(words)
    options.out = options.out.resolve()
    options.logs = (options.logs or options.out / "rigs").resolve()
    options.program = options.program.resolve()
    return options


def write_logs(folder, rigs):
    rows = []
    for rig in rigs:
        rows += rig_files.write_rig(rig, folder)
        print(f"{rig.name}: logs written", flush=True)
    rig_files.write_labels(folder / "labels.csv", rows)


def labels_in(folder):
    with (folder / "labels.csv").open(newline="") as file:
        return {(row["rig"], row["log"]): row for row in csv.DictReader(file)}


def judged(options, rig, healthy, labels):
    cases = []
    for case in rig_judge.judged_rig(options, rig, healthy, labels):
        cases.append(case)
        print(f"{healthy} healthy | {' | '.join(str(cell) for cell in rig_page.case_row(case))} ({case['wall_s']:.0f} s)",
              flush=True)
    return cases


def run(options, rigs):
    labels = labels_in(options.logs)
    values = {"schema": 1, "version": output_of([options.program, "--version"], 60).strip(), "healthy": options.healthy,
              "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), "cases": [],
              "rigs": [{"rig": rig.name, "spread_percent": float(labels[rig.name, "healthy1"]["spread_percent"])}
                       for rig in rigs]}
    jobs = [(rig, healthy) for healthy in options.healthy for rig in rigs]
    with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
        for cases in pool.map(lambda job: judged(options, *job, labels), jobs):
            values["cases"] += cases
            write_whole(options.out / "results.json", json.dumps(values, indent=1) + "\n")
    return values


def main(words=None):
    options = parsed(words)
    rigs = rig_judge.selected(options.rigs)
    if not options.only_logs and not options.program.is_file():
        print(f"other_rigs.py: there is no program {options.program}: build it, or give --program PROGRAM", file=sys.stderr)
        return 4
    options.out.mkdir(parents=True, exist_ok=True)
    if not (options.logs / "labels.csv").is_file():
        write_logs(options.logs, rigs)
    if options.only_logs:
        return 0
    values = run(options, rigs)
    print("\n".join(rig_page.screen_lines(values)))
    if options.page:
        chosen = f" --rigs {' '.join(options.rigs)}" if options.rigs else ""
        command = f"bench/other_rigs.py --out DIR --healthy {' '.join(map(str, options.healthy))}{chosen}"
        command += " --stored --page" if options.stored else " --page"
        rig_page.write(options.page, values, command)
        print(f"page: {options.page}")
    return 1 if any(case["outcome"] == "failed" for case in values["cases"]) else 0


if __name__ == "__main__":
    sys.exit(main())
