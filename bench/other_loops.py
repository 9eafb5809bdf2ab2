#!/usr/bin/python3
"""Simulates industrial control loops with and without a sticking valve, and judges whether softgrip names stiction.

    bench/other_loops.py --out DIR [--program PROGRAM] [--halves first second] [--kinds KIND ...] [--logs DIR]
                         [--only-logs] [--at-most-s 3600] [--page [FILE]]

Each half has 48 loops with a sticking valve (12 per friction model) and 42 other loops (3 per kind). The logs are written to
--logs (default: DIR/loops) if this folder does not contain them. Each loop is identified with `softgrip identify` and then
diagnosed with `softgrip diagnose` and this model. Horch's phase test is applied to the same signals. The answers of softgrip
are stored in DIR/answers. A repeated run makes only the calls whose inputs have changed. DIR/results.json contains all cases.
Exit codes: 0: all cases were judged; 1: some failed; 2: usage; 4: no such program.

The sources and equations are stated in bench/other_loops/loop_valves.py (sticking valves), loop_parts.py (process,
controller, historian), loop_loads.py (disturbances) and loop_kinds.py (kinds of loops, distributions, visible effects).
"""
import argparse
import json
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench/other_loops"), str(ROOT / "bench/foreign")]

import loop_judge  # noqa: E402
import loop_kinds  # noqa: E402
import loop_page  # noqa: E402
import loop_valves  # noqa: E402
from outcomes import output_of, write_whole  # noqa: E402

PAGE = ROOT / "docs/results/other-loops.md"
KINDS = (*loop_valves.STICKING, *loop_kinds.OTHERS)


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/tools/softgrip")
    parser.add_argument("--halves", nargs="+", choices=loop_kinds.HALVES, default=list(loop_kinds.HALVES))
    parser.add_argument("--kinds", nargs="+", choices=KINDS, metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--logs", type=pathlib.Path, help="folder of the logs [OUT/loops]")
    parser.add_argument("--only-logs", action="store_true", help="write the logs, and diagnose nothing")
    parser.add_argument("--at-most-s", type=float, default=3600, help="for one call")
    parser.add_argument("--page", type=pathlib.Path, nargs="?", const=PAGE, help=f"Markdown [{PAGE.relative_to(ROOT)}]")
    options = parser.parse_args(words)
    options.out = options.out.resolve()
    options.logs = (options.logs or options.out / "loops").resolve()
    options.program = options.program.resolve()
    return options


def run(options):
    values = {"schema": 1, "version": output_of([options.program, "--version"], 60).strip(), "halves": options.halves,
              "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), "at_most_s": options.at_most_s, "cases": []}
    for half in options.halves:
        for case in loop_judge.judged_half(options, half):
            values["cases"].append(case)
            print(f"{half} | {' | '.join(str(cell) for cell in loop_page.case_row(case))}", flush=True)
            write_whole(options.out / "results.json", json.dumps(values, indent=1) + "\n")
    return values


def command_of(options):
    return f"bench/other_loops.py --out DIR --halves {' '.join(options.halves)} --at-most-s {options.at_most_s:g} --page"


def main(words=None):
    options = parsed(words)
    if not options.only_logs and not options.program.is_file():
        print(f"other_loops.py: there is no program {options.program}: build it, or give --program PROGRAM", file=sys.stderr)
        return 4
    options.out.mkdir(parents=True, exist_ok=True)
    for half in options.halves:
        if not (options.logs / half / "labels.json").is_file():
            loop_judge.write_half(half, options.logs / half)
    if options.only_logs:
        return 0
    values = run(options)
    print("\n".join(loop_page.screen_lines(values)))
    if options.page:
        loop_page.write(options.page, values, command_of(options))
        print(f"page: {options.page}")
    return 1 if any(case["outcome"] == "failed" for case in values["cases"]) else 0


if __name__ == "__main__":
    sys.exit(main())
