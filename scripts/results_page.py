"""The head of a page in docs/results: what the result means for a user, then version, date, command and conditions.

tests/repository/results.py checks that each page has it.
"""
import datetime
import os
import pathlib
import subprocess


def version_of(build):
    """`softgrip 0.1.0+COMMIT` of a build folder."""
    program = pathlib.Path(build) / "tools/softgrip"
    return subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.strip()


def here():
    """The conditions of a figure that depends on the machine."""
    return f"{os.cpu_count()} processors, 1-minute load {os.getloadavg()[0]:.1f}"


def head(title, meaning, version, command, conditions, date=None):
    """Lines; `date`: YYYY-MM-DD, without it today."""
    return [f"# {title}", "", meaning, "", "| version | date | command | conditions |", "|---|---|---|---|",
            f"| {version} | {date or datetime.date.today().isoformat()} | `{command}` | {conditions} |", ""]
