"""The head of a page in docs/results: meaning of the result for a user, then version, date, command and conditions.

tests/repository/results.py checks that each page has it.
"""
import datetime
import os
import pathlib
import subprocess


def version_of(build):
    """Returns `softgrip 0.2.0+COMMIT` of a build folder."""
    program = pathlib.Path(build) / "tools/softgrip"
    return subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.strip()


def here():
    """Returns the conditions of a figure that depends on the computer."""
    return f"{os.cpu_count()} processors, 1-minute load {os.getloadavg()[0]:.1f}"


def head(title, meaning, version, command, conditions, date=None):
    """Returns the lines of the head. `date`: YYYY-MM-DD, by default today."""
    return [f"# {title}", "", meaning, "", "| version | date | command | conditions |", "|---|---|---|---|",
            f"| {version} | {date or datetime.date.today().isoformat()} | `{command}` | {conditions} |", ""]
