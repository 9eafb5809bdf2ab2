#!/usr/bin/python3
"""Identification and diagnosis over a folder of measured logs, on one page.

    bench/measured.py TABLE DATA [--page PAGE.md] [--out FOLDER] [--softgrip PROGRAM] [--only NAME...]
                      [--no-diagnosis] [--nulls N] [--at-most-s SECONDS]

TABLE says what stands in the files of DATA (docs/how-to/measure.md; bench/measured/asu_softarm.yaml is one). Each log
is identified from its first part by every structure and by scipy, and foretold from there on; then all of it is
diagnosed.
Outcomes are kept in FOLDER: run again, only what is new or has changed is done. A log that cannot be used costs its
own row. PAGE is written whenever the command ends, two pictures beside it. Exit codes: 0 every run came to an end, 1
some did not (their rows say why), 2 the table or the command line cannot be used, 4 there is no such data.
"""
import argparse
import fnmatch
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench/measured"), str(ROOT / "bench/foreign")]

import measured_page  # noqa: E402
from log_reading import Spoiled, read_log  # noqa: E402
from log_table import Unusable, read_table  # noqa: E402
from measured_runs import Runs  # noqa: E402
from outcomes import checksum, output_of, write_whole  # noqa: E402


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", metavar="TABLE", type=pathlib.Path)
    parser.add_argument("data", metavar="DATA", type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="Markdown, with two pictures beside it [FOLDER/page.md]")
    parser.add_argument("--out", metavar="FOLDER", type=pathlib.Path, default=pathlib.Path("measured"))
    parser.add_argument("--softgrip", type=pathlib.Path, default=ROOT / "build/release/tools/softgrip")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="logs of these names; * stands for anything")
    parser.add_argument("--no-diagnosis", dest="diagnosis", action="store_false")
    parser.add_argument("--nulls", type=int, default=0, help="campaigns without a cause for each diagnosis")
    parser.add_argument("--at-most-s", type=float, default=1800, help="for one run")
    return parser.parse_args(words)


def short(outcome, span_mm):
    """One run's outcome in a few words."""
    if "error" in outcome:
        return outcome["error"].splitlines()[0]
    result = outcome["result"]
    if "verdict" in result:
        return " ".join([result["verdict"], *(cause["id"] for cause in result["causes"])])
    if "inverse" in result:
        return "yes" if result["inverse"] else "no"
    if "continuation_mm" in result:
        return f"{100 * result['continuation_mm'] / span_mm:.2f} % of span held out (continuation)"
    return f"{100 * result['fitted_mm'] / span_mm:.2f} % of span, fitted"


def spread(values):
    known = [value for value in values if value == value]
    return max(known) - min(known)


def unloading(log, split):
    """How far the driving pressure comes down within the fitted part, as a share of how far it goes there."""
    drive = [p for p in log.columns.get("pressure", log.columns["command"])[:int(split * len(log.time_s))] if p == p]
    if not drive or spread(drive) == 0:
        return 0.0
    highest, deepest = drive[0], 0.0
    for p in drive:
        highest = max(highest, p)
        deepest = max(deepest, highest - p)
    return deepest / spread(drive)


def run_log(entry, options, progress):
    """Everything on one log, as a row of the page."""
    row = {"name": entry.name, "set": entry.set, "split": entry.split, "notes": [], "outcomes": {}}
    try:
        log = read_log(entry, options.data)
    except Spoiled as spoiled:
        row["error"] = str(spoiled).replace(f"{options.data}/", "").replace(f"{options.table}", options.table.name)
        progress(f"{entry.name}: {row['error']}")
        return row
    folder = options.out / re.sub(r"[^\w.-]+", "_", entry.name)
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "log.csv", log.text())
    row.update(notes=log.notes, span_mm=spread(log.columns["displacement"]), samples=len(log.time_s),
               length_s=log.time_s[-1], unloading=unloading(log, entry.split))
    runs = Runs(entry, log, folder, options)
    for step in runs.steps():
        outcome, known = runs.outcome(step)
        row["outcomes"][step[0]] = outcome
        progress(f"{entry.name}: {step[0]}: {short(outcome, row['span_mm'] or 1)}"
                 + (" (done before)" if known else f", {outcome['wall_s']:.1f} s"))
    return row


def chosen(table, only):
    return [entry for entry in table.logs if not only or any(fnmatch.fnmatchcase(entry.name, o) for o in only)]


def refused(options):
    """Why nothing can be run, as (exit code, sentence)."""
    if not options.data.is_dir():
        return 4, f"there is no folder {options.data}"
    if not options.softgrip.is_file():
        return 2, f"there is no program {options.softgrip}: build it, or say --softgrip PROGRAM"
    return None


def main(words=None):
    options = parsed(words)
    if why := refused(options):
        print(f"measured.py: {why[1]}", file=sys.stderr)
        return why[0]
    try:
        table = read_table(options.table, options.data)
    except Unusable as error:
        print(error, file=sys.stderr)
        return 2
    entries = chosen(table, options.only)
    options.out = options.out.resolve()
    options.program_checksum = checksum(options.softgrip)
    options.program_version = output_of([options.softgrip, "--version"], 60).strip()
    rows = []
    try:
        for number, entry in enumerate(entries, 1):
            said = f"[{number}/{len(entries)}]"
            rows.append(run_log(entry, options, lambda text, where=said: print(where, text, flush=True)))
    except KeyboardInterrupt:
        print("stopped; run the same command again to go on", file=sys.stderr)
    page = options.page or options.out / "page.md"
    measured_page.write(page, table, rows, f"`{options.table.name}` with {options.program_version}")
    print(f"page: {page}")
    failed = any("error" in row or any("error" in o for o in row["outcomes"].values()) for row in rows)
    return 1 if failed or len(rows) < len(entries) else 0


if __name__ == "__main__":
    sys.exit(main())
