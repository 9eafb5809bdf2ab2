#!/usr/bin/python3
"""Tests softgrip with data that other laboratories have published.

    bench/foreign.py --out DIR [--data DIR ...] [--only JUDGE ...] [--cases PATTERN ...] [--softgrip PROGRAM]
                     [--threads 1] [--at-most-s 3600] [--reference FILE] [--page [PAGE]]

A judge is a test for one kind of case: repeats (runs between which nothing changed), changes (changes that the
laboratory labelled), stiction (control loops with labelled valves), identification (comparison with a linear
output-error model and with a Bouc-Wen fit by SciPy). Each folder below --data is a data set. The file
bench/foreign/sets/FOLDER.yaml, or foreign.yaml in the folder, describes the data set (docs/how-to/measure.md). The
cases and their summary are written to DIR/results.json. The results of all calls of softgrip are stored in DIR. A
repeated run makes only the calls whose inputs have changed. If a case fails, all other cases are judged nevertheless.
Exit codes: 0: all cases were judged; 1: some failed; 2: usage; 4: no such data or program.
"""
import argparse
import fnmatch
import json
import os
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
HERE = ROOT / "bench/foreign"
sys.path.insert(0, str(HERE))

import foreign_page  # noqa: E402
import judge_changes  # noqa: E402
import judge_identification  # noqa: E402
import judge_stiction  # noqa: E402
import set_table  # noqa: E402
from outcomes import UNREADABLE, Failed, described, read_json, write_whole  # noqa: E402
from runner import Runner  # noqa: E402

SHARED, COPY = ROOT.parent / "shared/data", HERE / "data"
PAGE, REFERENCE = ROOT / "docs/results/foreign-data.md", HERE / "reference.json"


class Judge:
    """The four functions of a judge. The functions return the cases of a data set, the result of one case, the text of
    this result for the screen, and the summary of all cases."""

    def __init__(self, cases, judge, said, summary):
        self.cases, self.judge, self.said, self.summary = cases, judge, said, summary


JUDGES = {
    "repeats": Judge(lambda data_set: data_set.repeats,
                     lambda runner, data_set, pair: judge_changes.judge_pair(runner, data_set, pair, "repeats"),
                     judge_changes.said, judge_changes.summary_of_repeats),
    "changes": Judge(lambda data_set: data_set.changes,
                     lambda runner, data_set, pair: judge_changes.judge_pair(runner, data_set, pair, "changes"),
                     judge_changes.said, judge_changes.summary_of_changes),
    "stiction": Judge(lambda data_set: data_set.loops, judge_stiction.judge_loop, judge_stiction.said,
                      judge_stiction.summary),
    "identification": Judge(lambda data_set: data_set.fits, judge_identification.judge_fit, judge_identification.said,
                            judge_identification.summary),
}


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, nargs="+", default=[SHARED if SHARED.is_dir() else COPY])
    parser.add_argument("--only", nargs="+", choices=list(JUDGES), default=list(JUDGES), metavar="JUDGE")
    parser.add_argument("--cases", nargs="+", metavar="PATTERN", help="of SET/CASE; * stands for anything")
    parser.add_argument("--softgrip", type=pathlib.Path, default=ROOT / "build/release/tools/softgrip")
    parser.add_argument("--threads", type=int, default=1, help="of each softgrip call")
    parser.add_argument("--at-most-s", type=float, default=3600, help="for one call")
    parser.add_argument("--reference", type=pathlib.Path, default=REFERENCE, help="results of an earlier version, or none")
    parser.add_argument("--title", default="Data of other laboratories", help="of the page [%(default)s]")
    parser.add_argument("--page", type=pathlib.Path, nargs="?", const=PAGE, help=f"Markdown [{PAGE.relative_to(ROOT)}]")
    return parser.parse_args(words)


def chosen(options, sets):
    """Yields (judge, data set, item) for each selected case, in the order of the judges."""
    for name in JUDGES:
        for data_set in sets if name in options.only else ():
            for item in JUDGES[name].cases(data_set):
                case = f"{data_set.name}/{item.name}"
                if not options.cases or any(fnmatch.fnmatchcase(case, pattern) for pattern in options.cases):
                    yield name, data_set, item


def case_of(runner, name, data_set, item):
    runner.cost()
    case = {"judge": name, "set": data_set.name, "case": item.name}
    if hasattr(item, "group"):
        case["group"] = item.group
    try:
        case.update(JUDGES[name].judge(runner, data_set, item))
    except (Failed, *UNREADABLE) as error:
        case["error"] = described(error)
    return {**case, **runner.cost()}


def has_failed(case):
    return "error" in case or any(row["errors"] for row in case.get("rows", []))


def summaries(cases):
    return {name: judge.summary([case for case in cases if case["judge"] == name]) for name, judge in JUDGES.items()
            if any(case["judge"] == name for case in cases)}


class Results:
    """Collects the cases and writes results.json after each case."""

    def __init__(self, options, runner, sets):
        self.path = options.out / "results.json"
        self.values = {"schema": 1, "softgrip": {"version": runner.version, "sha256": runner.program},
                       "machine": {"processors": os.cpu_count(), "threads": options.threads,
                                   "load_before": [round(load, 2) for load in os.getloadavg()]},
                       "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
                       "sets": {s.name: {"title": s.title, "about": s.about, "source": s.source, "licence": s.licence,
                                         "table": s.table} for s in sets},
                       "summary": {}, "cases": []}

    def add(self, case):
        self.values["cases"].append(case)
        self.values["summary"] = summaries(self.values["cases"])
        self.values["machine"]["load_after"] = [round(load, 2) for load in os.getloadavg()]
        write_whole(self.path, json.dumps(self.values, indent=1) + "\n")


def refused(options):
    """Returns a tuple (exit code, error message) if a data folder or the program does not exist, otherwise None."""
    for folder in options.data:
        if not folder.is_dir():
            return 4, f"there is no folder {folder}"
    if not options.softgrip.is_file():
        return 4, f"there is no program {options.softgrip}: build it, or give --softgrip PROGRAM"
    return None


def run(options, runner, sets):
    results = Results(options, runner, sets)
    cases = list(chosen(options, sets))
    for number, (name, data_set, item) in enumerate(cases, 1):
        print(f"[{number}/{len(cases)}] {name} {data_set.name}: {item.name} ...", end=" ", flush=True)
        case = case_of(runner, name, data_set, item)
        results.add(case)
        print(case["error"].splitlines()[0] if "error" in case else JUDGES[name].said(case),
              f"({case['wall_s']:.0f} s, load {case['load_1min']})", flush=True)
    return results.values


def main(words=None):
    options = parsed(words)
    if why := refused(options):
        print(f"foreign.py: {why[1]}", file=sys.stderr)
        return why[0]
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    runner = Runner(options.softgrip.resolve(), options.out, options.threads, options.at_most_s)
    sets, problems = set_table.find_sets([folder.resolve() for folder in options.data], HERE / "sets",
                                         options.out / "tables")
    for problem in problems:
        print(problem, file=sys.stderr)
    try:
        values = run(options, runner, sets)
    except KeyboardInterrupt:
        print("stopped; the same command continues", file=sys.stderr)
        return 1
    if options.page:
        command = "bench/foreign.py --out DIR" + (" --data DATA" if options.data != [SHARED if SHARED.is_dir() else COPY] else "")
        command += f" --only {' '.join(options.only)}" if options.only != list(JUDGES) else ""
        reference = None if options.reference.name == "none" else read_json(options.reference)
        foreign_page.write(options.page, values, reference, options.title, f"{command} --page")
        print(f"page: {options.page}")
    failed = [case for case in values["cases"] if has_failed(case)]
    return 1 if failed or problems else 0


if __name__ == "__main__":
    sys.exit(main())
