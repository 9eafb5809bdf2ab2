"""Reads the table of a workflow. The table is a CSV file, or a TSV file if its name ends in .tsv. Each row is one task.

The columns, with the tasks that use them in parentheses:
name      name of the row and of its folder: letters, digits, - _ .
task      identify, diagnose, baseline, health or world
data      logs, recordings or folders of recordings, separated by spaces (identify, diagnose, baseline, health)
model     a model file; for identify, the start of the fit (identify, diagnose, baseline)
baseline  a folder that softgrip baseline has written, or @NAME for the baseline of another row (diagnose, health)
rig       the file of the rig that the experiment moves (baseline)
options   further options of the command line
judge     the module whose run_world() runs the world: judging, trial or changing (world)
world     the settings of a simulated world as JSON (world)

Paths are relative to the folder of the table. Only the columns name and task are required. Unknown columns are ignored.
"""
import csv
import dataclasses
import json
import pathlib
import re
import shlex

COLUMNS = ("name", "task", "data", "model", "baseline", "rig", "options", "judge", "world")
JUDGES = ("judging", "trial", "changing")
# The columns that each task needs. From the columns in a tuple, one is enough.
NEEDED = {"identify": ("data",), "diagnose": ("data", ("model", "baseline")), "baseline": (("data", "rig"),),
          "health": ("data", "baseline"), "world": ("judge", "world")}
TASKS = tuple(NEEDED)
quoted = shlex.quote


class Refused(Exception):
    """Raised with all problems of a table, one per line."""


@dataclasses.dataclass(frozen=True)
class Row:
    folder: pathlib.Path  # folder of the table
    cells: dict
    of: dict  # maps the name of each row to its task

    @property
    def name(self):
        return self.cells["name"]

    @property
    def task(self):
        return self.cells["task"]

    def get(self, column):
        return (self.cells.get(column) or "").strip()

    def logs(self):
        return [self.folder / path for path in shlex.split(self.get("data"))]

    def path(self, column):
        return self.folder / self.get(column)

    def result(self, name=None):
        """Returns the path of row.json, relative to the output folder."""
        return f"{self.of[name]}/{name}/row.json" if name else f"{self.task}/{self.name}/row.json"

    def other_baseline(self):
        """Returns the name of the row whose baseline this row reads, or None."""
        return self.get("baseline")[1:] if self.get("baseline").startswith("@") else None

    def inputs(self):
        """Returns the existing files and folders that the row reads. If one of them changes, the row is run a second
        time."""
        found = [file_of(log) for log in self.logs()]
        found += [self.path(column) for column in ("model", "rig") if self.get(column)]
        other = self.other_baseline()
        if self.get("baseline") and not other:
            folder = self.path("baseline")  # each finger can have its own baseline in a folder with its name
            found += [folder / "baseline.json", *sorted(folder.glob("*/baseline.json"))]
        found += self.files_in_options()
        return [str(path) for path in found if path.exists()] + ([self.result(other)] if other else [])

    def files_in_options(self):
        """Returns the files that the words of the options name, also in a word such as --validate=FILE."""
        words = [word.partition("=")[2] if word.startswith("--") else word for word in shlex.split(self.get("options"))]
        found = [file_of(self.folder / word) for word in words if word]
        return [path for path in found if path.is_file()]

    def text(self):
        """Returns the cells of the row as text. If this text changes, the row is run a second time."""
        return json.dumps([self.get(column) for column in COLUMNS])


def file_of(log):
    """Returns run.csv if the log is the folder of a recording, otherwise the path of the log."""
    return log / "run.csv" if (log / "run.csv").exists() else log


def problems_of(row, seen):
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.-]*", row.name or ""):
        yield f"name {row.name!r}: letters, digits, - _ . are meant"
    if row.name in seen:
        yield f"name {row.name!r} is already used in line {seen[row.name]}"
    if row.task not in TASKS:
        yield f"task {row.task!r}: one of {', '.join(TASKS)} is meant"
        return
    for needed in NEEDED[row.task]:
        one_of = needed if isinstance(needed, tuple) else (needed,)
        if not any(row.get(column) for column in one_of):
            yield f"{row.task} needs {' or '.join(one_of)}"
    other = row.other_baseline()
    if other and row.of.get(other) != "baseline":
        yield f"baseline @{other}: no row of that name has the task baseline"
    for column in ("data", "options"):
        try:
            shlex.split(row.get(column))
        except ValueError as error:
            yield f"{column}: {error}"
    if row.task == "world":
        if row.get("judge") not in JUDGES:
            yield f"judge {row.get('judge')!r}: one of {', '.join(JUDGES)} is meant"
        try:
            json.loads(row.get("world") or "{}")
        except ValueError as error:
            yield f"world: {error}"


def read(path):
    """Returns the rows of the table. Raises Refused with all problems of the table."""
    path = pathlib.Path(path)
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file, delimiter="\t" if path.suffix == ".tsv" else ",")
        lines = [(reader.line_num, cells) for cells in reader]
    problems = [f"{path}:1: no column {column!r}" for column in ("name", "task") if column not in (reader.fieldnames or [])]
    if problems:
        raise Refused("\n".join(problems))
    tasks = {cells["name"]: cells["task"] for _, cells in lines}
    rows, seen = [], {}
    for number, cells in lines:
        row = Row(path.resolve().parent, cells, tasks)
        if None in cells:
            problems.append(f"{path}:{number}: more cells than the header has")
        problems += [f"{path}:{number}: {problem}" for problem in problems_of(row, seen)]
        seen[row.name] = number
        rows.append(row)
    if not rows:
        problems.append(f"{path}: no rows")
    if problems:
        raise Refused("\n".join(problems))
    return rows
