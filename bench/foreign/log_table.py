"""Reads and checks the table that describes measured logs. Every message states the line of the mistake.

A mistake in the description of one log is stored in `problems` of this log, and all other logs remain usable.
`Unusable` is raised if the complete table cannot be read. docs/how-to/measure.md lists the keys.
"""
import dataclasses
import difflib
import math
import pathlib

import yaml

from units import QUANTITIES, units_of

KEYS = ("name", "file", "separator", "missing", "from_s", "to_s", "split", "begin", "time", "command",
        "pressure", "displacement", "temperature", "supply")
TABLE_KEYS = ("title", "about", "same", "logs")
COLUMN_KEYS = ("column", "columns", "unit", "scale", "zero", "span_mm")
BEGINS = ("auto", "rest", "unknown")
COLUMNS = ("time", "command", "pressure", "displacement", "temperature", "supply")


class Unusable(Exception):
    """The complete table cannot be used. The message states the position of the mistake and the expected content."""


class Map(dict):
    """A mapping that stores the line of each key."""

    def __init__(self, line):
        super().__init__()
        self.line, self.line_of = line, {}


@dataclasses.dataclass
class Column:
    """The columns of a quantity, and the conversion of their values to the unit of the log format. The values of
    several columns are averaged."""
    quantity: str
    names: list = dataclasses.field(default_factory=list)  # names of columns, or column numbers from 1
    unit: str = ""
    scale: float = math.nan  # factor from the unit of the column to the unit of the log format
    zero: object = None  # value that is subtracted before scaling: a number, or "first" for the first value
    span_mm: float = math.nan  # range of the readings after scaling
    rate_hz: float = math.nan  # sampling rate if the file has no column for the time


@dataclasses.dataclass
class LogEntry:
    name: str
    file: str
    line: int
    columns: dict = dataclasses.field(default_factory=dict)
    separator: str = ""
    missing: tuple = ()
    from_s: float = 0.0
    to_s: float = math.inf
    split: float = 0.5
    begin: str = "auto"
    problems: list = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Table:
    title: str
    about: str
    logs: list


def plain(loader, node):
    """Converts a YAML node to plain values. Mappings become Map objects, which store the lines of their keys."""
    if isinstance(node, yaml.MappingNode):
        loader.flatten_mapping(node)
        values = Map(node.start_mark.line + 1)
        for key_node, value_node in node.value:
            key = str(plain(loader, key_node))
            values[key] = plain(loader, value_node)
            values.line_of[key] = key_node.start_mark.line + 1
        return values
    if isinstance(node, yaml.SequenceNode):
        return [plain(loader, item) for item in node.value]
    return loader.construct_object(node)


def meant(word, known):
    near = difflib.get_close_matches(str(word), list(known), 1, 0.6)
    return f"is it '{near[0]}'?" if near else "known are " + ", ".join(known)


class EntryReader:
    """Reads one entry of the table and collects the mistakes in it."""

    def __init__(self, path, values):
        self.path, self.values, self.problems = path, values, []

    def wrong(self, text, line=None):
        self.problems.append(f"{self.path}:{line or self.values.line}: {text}")

    def number(self, values, key, otherwise, accepts=math.isfinite, range_text="a number"):
        value = values.get(key, otherwise)
        if key not in values or (isinstance(value, (int, float)) and not isinstance(value, bool) and accepts(value)):
            return value
        self.wrong(f"{key}: {value!r} is not {range_text}", values.line_of[key])
        return otherwise

    def known_keys(self, values, known):
        for key in values:
            if key not in known:
                self.wrong(f"'{key}' is no key here: {meant(key, known)}", values.line_of[key])

    def one_of(self, key, known):
        value = self.values.get(key, known[0])
        if value in known:
            return value
        self.wrong(f"{key}: '{value}' is not one of {', '.join(known)}", self.values.line_of[key])
        return known[0]

    def column(self, key):
        given, line = self.values[key], self.values.line_of[key]
        column = Column("pressure" if key in ("command", "supply") else key)
        if isinstance(given, (str, int)) and not isinstance(given, bool):
            column.names = [given]
            return column
        if not isinstance(given, Map):
            self.wrong(f"{key}: {given!r} is neither a column nor what says where one is", line)
            return column
        self.known_keys(given, ("column", "unit", "rate_hz") if key == "time" else COLUMN_KEYS)
        names = given.get("columns", [given["column"]] if "column" in given else [])
        column.names = names if isinstance(names, list) else [names]
        column.rate_hz = self.number(given, "rate_hz", math.nan, lambda v: v > 0, "a rate above 0")
        if not column.names and math.isnan(column.rate_hz):
            self.wrong(f"{key}: no column is named" + (", and no rate_hz" if key == "time" else ""), line)
        for name in ("scale", "span_mm"):
            factor = self.number(given, name, math.nan, lambda v: math.isfinite(v) and v != 0, "a number but 0")
            setattr(column, name, factor)
        if given.get("zero") != "first":
            column.zero = self.number(given, "zero", None, math.isfinite, "a number, nor 'first'")
        else:
            column.zero = "first"
        column.unit = self.unit(given, column)
        return column

    def unit(self, given, column):
        unit = str(given.get("unit", ""))
        scaled = math.isfinite(column.scale) or math.isfinite(column.span_mm)
        if not unit or scaled or unit.lower() in QUANTITIES[column.quantity]:
            return unit
        how = "" if column.quantity == "time" else "; or say `scale`, contract units per unit of the column"
        self.wrong(f"unit: '{unit}' is no unit of a {column.quantity}: {units_of(column.quantity)}{how}",
                   given.line_of["unit"])
        return ""

    def separator(self):
        words = {"tab": "\t", "space": " ", "comma": ",", "semicolon": ";"}
        value = str(self.values.get("separator", ""))
        value = words.get(value, value)
        if len(value) > 1:
            self.wrong(f"separator: '{value}' is more than one character; words are {', '.join(words)}",
                       self.values.line_of["separator"])
            return ""
        return value

    def read(self, name, file):
        values = self.values
        self.known_keys(values, KEYS)
        entry = LogEntry(name, file, values.line, problems=self.problems)
        for key in COLUMNS:
            if key in values:
                entry.columns[key] = self.column(key)
        for key in ("time", "displacement"):
            if key not in values:
                self.wrong(f"'{key}' is missing: which column holds it"
                           + (", or `time: {rate_hz: 100}`" if key == "time" else ""))
        if "command" not in values and "pressure" not in values:
            self.wrong("neither 'command' nor 'pressure': one of them drives the finger")
        entry.separator = self.separator()
        missing = values.get("missing", [])
        entry.missing = tuple(str(m).lower() for m in (missing if isinstance(missing, list) else [missing]))
        entry.from_s = self.number(values, "from_s", 0.0)
        entry.to_s = self.number(values, "to_s", math.inf)
        entry.split = self.number(values, "split", 0.5, lambda v: 0.05 <= v <= 0.95, "between 0.05 and 0.95")
        entry.begin = self.one_of("begin", BEGINS)
        return entry


def files_of(values, data):
    """Returns the name and the file of every log that an entry of the table describes."""
    file = str(values.get("file", ""))
    if not file:
        return [(str(values.get("name", "?")), "")]
    if not any(symbol in file for symbol in "*?["):
        return [(str(values.get("name", pathlib.Path(file).stem)), file)]
    found = sorted(p.relative_to(data) for p in data.glob(file) if p.is_file())
    before = f"{values['name']} " if "name" in values else ""
    return [(before + p.stem, str(p)) for p in found] or [(before + file, file)]


def with_defaults(given, defaults):
    merged = Map(given.line)
    for source in (defaults, given):
        merged.update(source)
        merged.line_of.update(source.line_of)
    return merged


def values_of(path):
    """Reads the YAML file at `path`. Returns its plain values."""
    try:
        loader = yaml.SafeLoader(path.read_text())
        node = loader.get_single_node()
        return plain(loader, node) if node else None
    except OSError as error:
        raise Unusable(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise Unusable(f"{path}: this is no text: {error}") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise Unusable(f"{path}:{mark.line + 1 if mark else 1}: {getattr(error, 'problem', error)}") from error


def refuse_what_says_nothing(path, values, known):
    if not isinstance(values, Map) or not isinstance(values.get("logs"), list) or not values["logs"]:
        raise Unusable(f"{path}:1: no list `logs`: one entry per log, with its file and columns")
    for key in values:
        if key not in known:
            raise Unusable(f"{path}:{values.line_of[key]}: '{key}' is no key here: {meant(key, known)}")
    if not isinstance(values.get("same") or Map(1), Map):
        raise Unusable(f"{path}:{values.line_of['same']}: `same` holds keys that all logs share")
    for number, given in enumerate(values["logs"], 1):
        if not isinstance(given, Map):
            raise Unusable(f"{path}:{values.line_of['logs']}: log {number} is {given!r}, not keys with values")


def read_table(path, data, more_keys=()):
    """Reads the table at `path`, which describes logs in the folder `data`. `more_keys` are additional keys that the
    caller reads from the table."""
    path, data = pathlib.Path(path), pathlib.Path(data)
    values = values_of(path)
    refuse_what_says_nothing(path, values, (*TABLE_KEYS, *more_keys))
    logs, names = [], set()
    for number, given in enumerate(values["logs"], 1):
        merged = with_defaults(given, values.get("same") or Map(1))
        for name, file in files_of(merged, data):
            reader = EntryReader(path, merged)
            if not file:
                reader.wrong("'file' is missing: the log's file within the data folder")
            if name in names:
                reader.wrong(f"a second log is named '{name}'")
                name = f"{name} ({number})"
            names.add(name)
            logs.append(reader.read(name, file))
    return Table(str(values.get("title", "Measured logs")), str(values.get("about", "")).strip(), logs)
