"""Reads a data set and its table. The table describes the logs, as in log_table.py, and the known facts that the judges use.

A mistake in a log, a pair or a loop is reported with its file and line. The cases that use a wrong entry are not
judged; all other cases are judged. If the complete table cannot be read, log_table.Unusable is raised.
docs/how-to/measure.md lists the keys.
"""
import csv
import dataclasses
import fnmatch
import pathlib

from log_table import EntryReader, Map, Unusable, meant, read_table, values_of

SET_KEYS = ("source", "licence", "repeats", "changes", "stiction", "identification")
LOG_COLUMNS = {"time_s": "time", "pressure_command_kpa": "command", "displacement_mm": "displacement",
               "pressure_kpa": "pressure", "temperature_c": "temperature", "supply_kpa": "supply"}
CAUSES = ("transport_delay", "valve_lag", "valve_deadband", "pressure_saturation", "supply_sag", "leak", "blocked_line",
          "actuator_threshold", "stiffening", "asymmetric_hysteresis", "rate_dependent_hysteresis", "hysteresis_shape",
          "stress_softening", "slow_creep", "thermal_gain", "ageing", "contact", "inertia", "backlash", "payload",
          "sensor_lag", "sensor_drift", "sensor_nonlinearity", "sensor_saturation", "periodic_disturbance", "outliers",
          "clock_offset", "sampling")
OWN_TABLE = "foreign.yaml"  # name of the table in a data folder; without this file, sets/NAME_OF_THE_FOLDER.yaml is used


@dataclasses.dataclass
class Pair:
    """Baseline logs and a later log of the same rig. Without a label, nothing has changed between the baseline logs and the
    later log."""
    name: str
    baseline: list
    later: str
    because: str
    group: str = "runs"
    label: str = ""
    causes: tuple = ()  # causes that are correct answers for the labelled change
    problems: list = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Loop:
    log: str
    sticks: bool
    problems: list = dataclasses.field(default_factory=list)

    @property
    def name(self):
        return self.log


@dataclasses.dataclass
class Fit:
    """A log that is identified. The model is fitted to the first part of this log, or it is fitted to the whole log and
    tested on another log."""
    log: str
    test: str = ""
    order: int = 0  # order of the linear model; 0: default order
    problems: list = dataclasses.field(default_factory=list)

    @property
    def name(self):
        return f"{self.log} -> {self.test}" if self.test else self.log


@dataclasses.dataclass
class DataSet:
    name: str
    folder: pathlib.Path
    title: str
    about: str = ""
    source: str = ""
    licence: str = ""
    table: str = ""  # name of the table's file
    logs: dict = dataclasses.field(default_factory=dict)
    repeats: list = dataclasses.field(default_factory=list)
    changes: list = dataclasses.field(default_factory=list)
    loops: list = dataclasses.field(default_factory=list)
    fits: list = dataclasses.field(default_factory=list)


class ListReader:
    """Reads the entries of one list of the table."""

    def __init__(self, path, values, key, logs):
        self.path, self.key, self.logs = path, key, logs
        self.given = values.get(key, [])
        self.line = values.line_of.get(key, 1)
        if not isinstance(self.given, list):
            raise Unusable(f"{path}:{self.line}: `{key}` is no list")

    def entries(self, known):
        """Yields an EntryReader for each entry, after a check of the entry's keys."""
        for number, given in enumerate(self.given, 1):
            if not isinstance(given, Map):
                raise Unusable(f"{self.path}:{self.line}: entry {number} of `{self.key}` is {given!r}, not keys with values")
            entry = EntryReader(self.path, given)
            entry.known_keys(given, known)
            yield entry

    def text(self, entry, key, needed=True):
        value = str(entry.values.get(key, "")).strip()
        if needed and not value:
            entry.wrong(f"'{key}' is missing")
        return value

    def log(self, entry, key, needed=True):
        """Returns the name of a log that an entry refers to, and checks that the table describes this log."""
        name = self.text(entry, key, needed)
        if name:
            self.known_log(entry, key, name)
        return name

    def known_log(self, entry, key, name):
        if name not in self.logs:
            entry.wrong(f"{key}: no log is named '{name}': {meant(name, self.logs)}", entry.values.line_of[key])

    def baseline(self, entry):
        given = entry.values.get("baseline", [])
        names = [str(name) for name in (given if isinstance(given, list) else [given])]
        if not names:
            entry.wrong("'baseline' is missing: one log, or a list of logs")
        for name in names:
            self.known_log(entry, "baseline", name)
        return names

    def causes(self, entry):
        given = entry.values.get("causes", [])
        causes = tuple(given if isinstance(given, list) else [given])
        if not causes:
            entry.wrong("'causes' is missing: the ids that name this change correctly")
        for cause in causes:
            if cause not in CAUSES:
                entry.wrong(f"causes: '{cause}' is no cause: {meant(cause, CAUSES)}", entry.values.line_of["causes"])
        return causes

    def pairs(self, labelled):
        keys = ("baseline", "later", "because", "group", *(("label", "causes") if labelled else ()))
        for entry in self.entries(keys):
            baseline, later = self.baseline(entry), self.log(entry, "later")
            if later in baseline:
                entry.wrong(f"later: '{later}' belongs to its own baseline", entry.values.line_of["later"])
            pair = Pair(f"{' + '.join(baseline)} -> {later}", baseline, later, self.text(entry, "because"),
                        self.text(entry, "group", False) or "runs", problems=entry.problems)
            if labelled:
                pair.label, pair.causes = self.text(entry, "label"), self.causes(entry)
            yield pair

    def loops(self):
        for entry in self.entries(("logs", "sticks")):
            pattern = self.text(entry, "logs")
            names = [name for name in self.logs if fnmatch.fnmatchcase(name, pattern)]
            if pattern and not names:
                entry.wrong(f"logs: no log fits '{pattern}'", entry.values.line_of["logs"])
            sticks = entry.values.get("sticks")
            if not isinstance(sticks, bool):
                entry.wrong("'sticks' is true or false: how the valve is labelled", entry.values.line_of.get("sticks"))
            for name in names or [pattern]:
                yield Loop(name, bool(sticks), entry.problems)

    def fits(self):
        for entry in self.entries(("log", "test", "order")):
            order = entry.number(entry.values, "order", 0, lambda v: v in (1, 2, 3, 4), "1, 2, 3 or 4")
            yield Fit(self.log(entry, "log"), self.log(entry, "test", False), order, entry.problems)


def read_set(path, folder):
    """Reads the data set that the table at `path` describes. Its logs are in `folder`."""
    path, folder = pathlib.Path(path), pathlib.Path(folder)
    table = read_table(path, folder, SET_KEYS)
    values = values_of(path)
    logs = {log.name: log for log in table.logs}
    lists = {key: ListReader(path, values, key, logs) for key in ("repeats", "changes", "stiction", "identification")}
    fits = list(lists["identification"].fits()) if "identification" in values else [Fit(name) for name in logs]
    return DataSet(folder.name, folder, table.title, table.about, str(values.get("source", "")),
                   str(values.get("licence", "")), path.name, logs, list(lists["repeats"].pairs(False)),
                   list(lists["changes"].pairs(True)), list(lists["stiction"].loops()), fits)


def is_log(path):
    with path.open(newline="", errors="replace") as file:
        return {"time_s", "displacement_mm"} <= set(next(csv.reader(file), []))


def set_without_table(folder, scratch):
    """Returns a data set for a folder that has no table. Each CSV file in the log format is a case of the judge
    `identification`. All other judges have no cases."""
    files = [path for path in sorted(folder.glob("*.csv")) if is_log(path)]
    if not files:
        return None
    entries = []
    for path in files:
        with path.open(newline="", errors="replace") as file:
            header = next(csv.reader(file))
        columns = ", ".join(f"{LOG_COLUMNS[name]}: {name}" for name in header if name in LOG_COLUMNS)
        entries.append(f'- {{file: "{path.name}", {columns}}}')
    table = scratch / f"{folder.name}.yaml"
    table.parent.mkdir(parents=True, exist_ok=True)
    table.write_text("\n".join([f'title: "{folder.name}"', "about: no table describes this folder", "logs:", *entries, ""]))
    return read_set(table, folder)


def table_of(folder, tables):
    own = folder / OWN_TABLE
    return own if own.is_file() else tables / f"{folder.name}.yaml"


def find_sets(roots, tables, scratch):
    """Reads the data set in each folder below `roots`, or in a root that contains logs itself. Returns the data sets and
    the problems."""
    sets, problems, names = [], [], set()
    for root in roots:
        folders = [root, *sorted(path for path in root.iterdir() if path.is_dir())]
        for folder in folders:
            table = table_of(folder, tables)
            try:
                found = read_set(table, folder) if table.is_file() else set_without_table(folder, scratch)
            except Unusable as unusable:
                problems.append(str(unusable))
                continue
            if found is None:
                continue
            if found.name in names:
                problems.append(f"{folder}: a second set is named '{found.name}'; it is not used")
                continue
            names.add(found.name)
            sets.append(found)
    return sets, problems
