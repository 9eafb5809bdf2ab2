"""Writes the beginning of a page in docs/results: the meaning of the result for a user, and a table of version, date,
command and conditions. tests/repository/results.py checks that each page has this beginning."""
import datetime
import os
import pathlib
import subprocess


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
