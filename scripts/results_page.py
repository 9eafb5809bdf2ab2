"""Writes the beginning of a page in docs/results: the meaning of the result for a user, and a table of version, date,
command and conditions. tests/repository/results.py checks that each page has this beginning."""
import argparse
import datetime
import math
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def arguments(about, work=False, page=None):
    """Returns the parser of a script that writes a page, with the options --build and --page. If `work` is true, the
    folder --work is required. `page` is the default of --page."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=lambda path: pathlib.Path(path).resolve(), default=ROOT / "build/release")
    parser.add_argument("--page", type=pathlib.Path, default=page)
    if work:
        parser.add_argument("--work", type=pathlib.Path, required=True)
    return parser


def version_of(build):
    """Returns the version of a build, such as `softgrip 0.2.0+COMMIT`."""
    program = pathlib.Path(build) / "tools/softgrip"
    return subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.strip()


def here():
    """Returns the conditions of a measurement whose result depends on the computer."""
    return f"{os.cpu_count()} processors, 1-minute load {os.getloadavg()[0]:.1f}"


def head(title, meaning, version, command, conditions, date=None):
    """Returns the lines of the beginning of a page. `date` has the format YYYY-MM-DD; the default is today."""
    return [f"# {title}", "", meaning, "", "| version | date | command | conditions |", "|---|---|---|---|",
            f"| {version} | {date or datetime.date.today().isoformat()} | `{command}` | {conditions} |", ""]


def interval(hits, count):
    """Returns Wilson's 95 % interval of a share [%]."""
    if count == 0:
        return "-"
    p, z = hits / count, 1.96
    middle = (p + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return f"{100 * p:.1f} % ({100 * max(0, middle - half):.1f} .. {100 * min(1, middle + half):.1f})"
