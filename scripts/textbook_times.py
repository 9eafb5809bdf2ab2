#!/usr/bin/python3
"""Measures the run time of `softgrip diagnose` for three logs of 8,000 to 13,000 samples each.

    scripts/textbook_times.py [--build build/release] [--worlds 24] [--threads 2] [--first-seed 1000] [--page PAGE.md]

The worlds are the first worlds of a campaign of scripts/textbook_campaign.py, sampled at 200 Hz. They contain every
make. Half of them have a recorded pressure (`--drive measured`). They have zero to three hidden effects. The
diagnoses run one after the other and include all steps of the command: refit, search, held-out logs, intervals, the
closed loop and the report. Run nothing else at the same time.
"""
import argparse
import os
import pathlib
import statistics
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
for folder in ("tests/blind", "tests/blind/textbook", "scripts"):
    sys.path.insert(0, str(ROOT / folder))

import campaign  # noqa: E402
import results_page  # noqa: E402
import textbook_campaign  # noqa: E402
import trial  # noqa: E402
from textbook_page import table  # noqa: E402

WANTED = {"median": 10, "longest": 30}


def planned(args):
    plan = argparse.Namespace(columns=["pressure", "command"], given=["plain"], clean=10, seeds=1, pairs=10, triples=4,
                              strengths=[8, 2], causes=None, first_seed=args.first_seed)
    ids, makes = trial.listed(args.build, "--list"), trial.listed(args.build, "--makes")
    return textbook_campaign.worlds(plan, ids, makes)[:args.worlds]


def processor_s():
    times = os.times()
    return times.children_user + times.children_system


def timed(build, threads, world):
    """Returns a copy of the world to which wall_s, processor_s, samples and the duration [s] of each stage are
    added."""
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        logs, _ = trial.make_logs(build, work, world, "--rate-hz", "200", *trial.hiding(world))
        began_s, used_s = time.monotonic(), processor_s()
        diagnosis, message = trial.diagnosed(build, trial.GIVEN, logs, work, world, threads)
        took_s, used_s = time.monotonic() - began_s, processor_s() - used_s
        if diagnosis is None:
            sys.exit(f"{world}: {message}")
        samples = sum(len(log.read_text().splitlines()) - 1 for log in logs)
        return {**world, "wall_s": took_s, "processor_s": used_s, "samples": samples, "stages_s": diagnosis["stages_s"],
                "verdict": diagnosis["verdict"]}


def summary(rows):
    lines = []
    for name, among in (("all cases", rows), ("logs with a measured pressure", [r for r in rows if r["columns"] == "pressure"]),
                        ("logs with the commanded pressure alone", [r for r in rows if r["columns"] == "command"])):
        if among:
            wall = [r["wall_s"] for r in among]
            lines.append((name, len(among), f"{statistics.median(wall):.1f}", f"{max(wall):.1f}",
                          f"{statistics.median(r['processor_s'] for r in among):.1f}"))
    return lines


def shares(rows):
    """Returns the duration of each stage as a fraction of the total duration."""
    stages = {stage for row in rows for stage in row["stages_s"]}
    total = sum(r["wall_s"] for r in rows)
    took = {stage: sum(r["stages_s"].get(stage, 0) for r in rows) for stage in stages}
    named = sorted(took.items(), key=lambda item: -item[1])
    return [(stage, f"{100 * s / total:.0f} %") for stage, s in [*named, ("everything else", total - sum(took.values()))]]


def page(args, rows, command):
    median, longest = statistics.median(r["wall_s"] for r in rows), max(r["wall_s"] for r in rows)
    slowest = sorted(rows, key=lambda r: -r["wall_s"])[:5]
    return "\n".join([
        *results_page.head(
            "Duration of a diagnosis", f"A diagnosis of three logs takes {median:.1f} s (median) and at most {longest:.1f} s.",
            results_page.version_of(args.build), command,
            f"{len(rows)} cases that are simulated with equations from textbooks, three logs each, "
            f"{statistics.median(r['samples'] for r in rows) / 3:.0f} samples in a log (median), {args.threads} threads on {os.cpu_count()} processors; the durations include the simulation of the closed loop and the report"),
        f"Required: a median of at most {WANTED['median']} s and a longest duration of at most {WANTED['longest']} s. "
        f"Measured: a median of {median:.1f} s and a longest duration of {longest:.1f} s.", "",
        *table(("cases", "number of cases", "median duration [s]", "longest duration [s]", "median processor time [s]"), summary(rows)),
        *table(("stage of the diagnosis (`stages_s` in the result)", "fraction of the total time"), shares(rows)),
        "The table lists the five longest diagnoses:", "",
        *table(("hidden cause", "strength", "type of finger", "columns", "seed", "verdict", "duration [s]"), [
            (" + ".join(r["causes"]) or "nothing", f"{r['strength']:g}", r["make"], r["columns"], r["seed"], r["verdict"],
             f"{r['wall_s']:.1f}") for r in slowest])])


def main():
    parser = results_page.arguments(__doc__)
    parser.add_argument("--worlds", type=int, default=24)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=1000)
    args = parser.parse_args()
    rows = []
    for world in planned(args):
        rows.append(timed(args.build, args.threads, world))
        row = rows[-1]
        print(f"{len(rows)}/{args.worlds} {textbook_campaign.called(row)}: {row['wall_s']:.1f} s, "
              f"{row['processor_s']:.1f} s of processor time, {row['verdict']}", flush=True)
    command = campaign.command("scripts/textbook_times.py", parser, args, ("worlds", "threads", "first_seed"))
    text = page(args, rows, command)
    args.page.write_text(text) if args.page else print(text, end="")


if __name__ == "__main__":
    main()
