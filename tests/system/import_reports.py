#!/usr/bin/env python3
"""Shows the result of `softgrip import` for every file in a folder of field reports.

    tests/system/import_reports.py [FOLDER] [--softgrip PROGRAM]...

FOLDER has a folder for each report. Without FOLDER, writes and imports the reports of foreign_files.py. The table has
a row for each file. With two programs, the table has a column for each program, to compare two versions. The exit code
is 1 if a run has crashed."""

import argparse
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import foreign_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", ROOT / "build" / "release"))
SUFFIXES = {".csv", ".gz", ".h5", ".lvm", ".mat", ".mcap", ".tdms", ".tsv", ".txt", ".xlsx"}
# If a report is about an import option, its file is imported with this option.
OPTIONS = {"channel-ignored": ["--channel right", "--channel nonsense", ""]}


def cases(folder):
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix in SUFFIXES:
            for options in OPTIONS.get(path.parent.name, [""]):
                yield path, options


def own_cases(folder):
    return [(file.make(folder), file.options) for file in foreign_files.reports()]


def outcome(program, path, options):
    """Imports one file. Returns (exit code, sentence about the result)."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([program, "import", path, *shlex.split(options), "--yes", "--json", "--out",
                               pathlib.Path(out) / "log.csv"], capture_output=True, text=True, timeout=120,
                              stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        problems = [line for line in done.stderr.splitlines() if line.startswith(f"{path}:")]
        return done.returncode, (problems or done.stderr.splitlines() or [""])[-1].replace(f"{path}:", "")[:160]
    log = json.loads(done.stdout)["logs"][0]
    said = log.get("warnings", []) + log["notes"] + log["plausibility_warnings"]
    return 0, f"{log['samples']} samples, {log['duration_s']:.6g} s" + "".join("; " + text[:120] for text in said[:2])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("--softgrip", type=pathlib.Path, action="append",
                        help="default: the program in the build folder")
    options = parser.parse_args()
    programs = options.softgrip or [BUILD / "tools/softgrip"]
    print("| file | options | " + " | ".join(f"exit code {i + 1} | result {i + 1}" for i in range(len(programs))) + " |")
    print("|---|---|" + "---|---|" * len(programs))
    crashed = False
    made = tempfile.TemporaryDirectory()
    folder = options.folder or pathlib.Path(made.name)
    for path, said in cases(folder) if options.folder else own_cases(folder):
        results = [outcome(program, path, said) for program in programs]
        crashed = crashed or any(code < 0 for code, _ in results)
        cells = [cell for code, text in results for cell in (str(code), text.replace("|", "\\|"))]
        print(f"| {path.relative_to(folder)} | {said} | " + " | ".join(cells) + " |", flush=True)
    return 1 if crashed else 0


if __name__ == "__main__":
    sys.exit(main())
