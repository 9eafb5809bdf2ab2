"""Converts a measured log to the log format of softgrip (docs/how-to/identify.md). An entry of the table describes the
original format of the log."""
import csv
import dataclasses
import datetime
import math
import statistics

from log_table import meant
from units import QUANTITIES, TIME_POINT, ZEROS, unit_in, units_of

MISSING = {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "inf", "-inf", "+inf"}
COMMENTS = ("#", "%", "//")
SEPARATORS = (",", ";", "\t", "|", " ")
FAR_ENOUGH = 200  # number of lines at the start of a file in which the header is searched
MOST_SAID = 5
MOST_MISSING = 0.2  # largest share of samples without a displacement that `softgrip identify` accepts
# A hole, as in `softgrip identify`: an interval that is longer than HOLE_S and longer than HOLE_INTERVALS usual intervals, and
# over which the command changes by more than the share HOLE_CHANGE of its range.
HOLE_S, HOLE_INTERVALS, HOLE_CHANGE = 0.5, 20, 0.02
OUTPUT = {"command": "pressure_command_kpa", "displacement": "displacement_mm", "pressure": "pressure_kpa",
          "temperature": "temperature_c", "supply": "supply_kpa"}


class Spoiled(Exception):
    """A log cannot be used. The message states the file, the line and the expected content."""


@dataclasses.dataclass
class Log:
    time_s: list
    columns: dict  # values by name of the quantity; NaN: no reading
    lines: list  # for each sample, the number of its line in the file
    notes: list

    def text(self):
        names = [name for name in OUTPUT if name in self.columns]
        rows = [",".join(["time_s", *(OUTPUT[name] for name in names)])]
        for i, t in enumerate(self.time_s):
            cells = [f"{self.columns[name][i]:.9g}" for name in names]
            rows.append(",".join([f"{t:.9g}", *("" if cell == "nan" else cell for cell in cells)]))
        return "\n".join(rows) + "\n"


def decoded(path):
    try:
        data = path.read_bytes()
    except OSError as error:
        raise Spoiled(f"{path}: {error.strerror}") from error
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    if b"\0" in data:
        raise Spoiled(f"{path}: this is no text (a spreadsheet or .mat file? Export it as CSV)")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def split(line, separator):
    if separator == " ":
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]


class Reader:
    def __init__(self, entry, data):
        self.entry, self.path = entry, data / entry.file
        self.notes, self.problems, self.more = [], [], 0
        self.lines = [(number, line) for number, line in enumerate(decoded(self.path).splitlines(), 1)
                      if line.strip() and not line.lstrip().startswith(COMMENTS)]
        if not self.lines:
            raise Spoiled(f"{self.path}:1: the file is empty")
        self.separator, self.header, self.header_line = self.find_header()
        self.places = {name: self.place(name) for column in entry.columns.values() for name in column.names}

    def spoiled(self, line, text):
        return Spoiled(f"{self.path}:{line}: {text}")

    def problem(self, line, text):
        if len(self.problems) < MOST_SAID:
            self.problems.append(f"{self.path}:{line}: {text}")
        else:
            self.more += 1

    # Positions of the columns

    def find_header(self):
        """Finds the first line that contains the names of all columns that the table gives by name. Returns the separator,
        the names, and the number of this line. If the table gives no names, the list is empty and the number is 0."""
        asked = [name for column in self.entry.columns.values() for name in column.names]
        names = [str(name) for name in asked if isinstance(name, str)]
        separators = [self.entry.separator] if self.entry.separator else SEPARATORS
        if not names:
            return self.separator_of_numbers(separators, max(asked, default=1)), [], 0
        seen = []
        for number, line in self.lines[:FAR_ENOUGH]:
            for separator in separators:
                cells = split(line, separator)
                found = sum(name in cells for name in names)
                if found == len(names):
                    return separator, cells, number
                seen.append((found, len(cells), -number, cells))
        _, _, number, cells = max(seen)  # the line that is most similar to a header
        number = -number
        absent = next(name for name in names if name not in cells)
        if all(self.is_number(cell) for cell in cells):
            raise self.spoiled(number, f"no line names a column '{absent}', this one has numbers only: without names a "
                                       "column is given by its number, the first is 1")
        raise self.spoiled(number, f"no column '{absent}'; {meant(absent, cells)}")

    def separator_of_numbers(self, separators, columns):
        for _, line in self.lines[:FAR_ENOUGH]:
            for separator in separators:
                cells = split(line, separator)
                if len(cells) >= columns and sum(map(self.is_number, cells)) > len(cells) / 2:
                    return separator
        raise self.spoiled(self.lines[0][0], f"no line holds numbers in {columns} columns")

    def place(self, name):
        if isinstance(name, str):
            if self.header.count(name) > 1:
                raise self.spoiled(self.header_line, f"'{name}' stands twice: give the column's number, the first is 1")
            return self.header.index(name)
        width = len(self.header) or max(len(split(line, self.separator)) for _, line in self.lines[:FAR_ENOUGH])
        if not 1 <= name <= width:
            raise self.spoiled(self.header_line or self.lines[0][0], f"column {name}: there are {width}")
        return name - 1

    # Numbers

    def number(self, text):
        """Returns the value of a cell. NaN: the reading is missing. None: the cell is not a number."""
        text = text.strip().strip('"').strip()
        if text.lower() in MISSING or text.lower() in self.entry.missing:
            return math.nan
        separator = getattr(self, "separator", ",")
        if separator != "," and "," in text and "." not in text:
            text = text.replace(",", ".")
        try:
            value = float(text)
        except ValueError:
            return None
        return math.nan if self.entry.missing and any(self.same(value, m) for m in self.entry.missing) else value

    @staticmethod
    def same(value, missing):
        try:
            return value == float(missing)
        except ValueError:
            return False

    def is_number(self, cell):
        value = self.number(cell)
        return value is not None and not math.isnan(value)

    def moment(self, text, line):
        """Converts a date with time of day to seconds since 1970. Reports any other text and returns NaN."""
        try:
            return datetime.datetime.fromisoformat(text.strip().strip('"').replace("Z", "+00:00")).timestamp()
        except ValueError:
            self.problem(line, f"'{text}' is no date with time of day such as 2024-05-31T12:00:00.5")
            return math.nan

    def rows(self):
        """Yields line number and cells of each sample, from the first row of numbers after the header."""
        first = next((i for i, (number, _) in enumerate(self.lines) if number > self.header_line), len(self.lines))
        asked = [self.places[name] for key, column in self.entry.columns.items() for name in column.names
                 if not (key == "time" and column.unit.lower() == TIME_POINT)]
        begun = False
        for index in range(first, len(self.lines)):
            number, line = self.lines[index]
            cells = split(line, self.separator)
            if not begun:
                begun = len(cells) > max(asked) and any(self.is_number(cells[place]) for place in asked)
                if not begun:
                    if index > first + FAR_ENOUGH:
                        raise self.spoiled(number, "no row of numbers follows the header")
                    continue
            if len(cells) > max(self.places.values()):
                yield number, cells
            elif index == len(self.lines) - 1:
                self.notes.append("the last line is cut off and left out")
            else:
                self.problem(number, f"{len(cells)} cells, where column {max(self.places.values()) + 1} is asked for")

    def cell(self, cells, name, line):
        text = cells[self.places[name]]
        value = self.number(text)
        if value is None:
            self.problem(line, f"column '{name}': '{text}' is no number")
            return math.nan
        return value

    def mean(self, cells, column, line):
        values = [self.cell(cells, name, line) for name in column.names]
        return sum(values) / len(values)

    # Units

    def factor(self, column, quantity):
        """Returns two numbers for a column: the factor from its unit to the unit of the log format, and the zero of the
        quantity in the unit of the column."""
        written = {unit_in(name, column.quantity) for name in column.names} - {""}
        unit = column.unit.lower() or (written.pop() if len(written) == 1 else "")
        if column.unit and written and not {unit} >= written and unit in QUANTITIES[column.quantity]:
            self.notes.append(f"{quantity}: the column says {', '.join(sorted(written))}; the table's {unit} is taken")
        if math.isfinite(column.scale) or math.isfinite(column.span_mm):
            return (column.scale if math.isfinite(column.scale) else 1.0), ZEROS.get(unit, 0.0)
        if not unit:
            raise Spoiled(f"{self.path}:{self.header_line or 1}: {quantity}: neither the column's name "
                          f"'{column.names[0]}' nor the table says a unit: {units_of(column.quantity)}; or `scale`")
        return QUANTITIES[column.quantity][unit], ZEROS.get(unit, 0.0)

    def scaled(self, values, column, quantity):
        scale, zero = self.factor(column, quantity)
        known = [value for value in values if not math.isnan(value)]
        if not known:
            raise self.spoiled(self.header_line or 1, f"{quantity}: no reading at all in '{column.names[0]}'")
        if column.zero is not None:
            zero = known[0] if column.zero == "first" else column.zero
        if math.isfinite(column.span_mm):
            if max(known) == min(known):
                raise self.spoiled(self.header_line or 1, f"{quantity}: '{column.names[0]}' never changes")
            scale = column.span_mm / (max(known) - min(known))
        return [(value - zero) * scale for value in values]

    # The log

    def read(self):
        time = self.entry.columns["time"]
        dates = time.unit.lower() == TIME_POINT
        factor = 1.0 if dates or not time.names else self.factor(time, "time")[0]
        quantities = {key: column for key, column in self.entry.columns.items() if key != "time"}
        lines, times, raw = [], [], {key: [] for key in quantities}
        without_time = 0
        for count, (line, cells) in enumerate(self.rows()):
            if not time.names:
                t = count / time.rate_hz
            elif dates:
                t = self.moment(cells[self.places[time.names[0]]], line)
            else:
                t = self.cell(cells, time.names[0], line) * factor
            if math.isnan(t):
                without_time += 1
                continue
            lines.append(line)
            times.append(t)
            for key, column in quantities.items():
                raw[key].append(self.mean(cells, column, line))
        self.refuse_problems()
        if not times:
            raise self.spoiled(self.header_line or 1, "no row of numbers follows the header")
        if without_time:
            self.notes.append(f"{without_time} rows without a time are left out")
        return self.log_of(lines, times, raw, quantities)

    def refuse_problems(self):
        if self.problems:
            raise Spoiled("\n".join(self.problems + ([f"{self.more} more of these"] if self.more else [])))

    def log_of(self, lines, times, raw, quantities):
        keep = self.with_readings(self.usable(lines, [t - times[0] for t in times]), raw["displacement"])
        if len(keep) < 2:
            raise self.spoiled(lines[0], f"{len(keep)} samples between {self.entry.from_s:g} and {self.entry.to_s:g} "
                                         f"s; the log has {times[-1] - times[0]:g} s")
        columns = {key: self.scaled([raw[key][i] for i in keep], column, key) for key, column in quantities.items()}
        log = Log([times[i] for i in keep], columns, [lines[i] for i in keep], self.notes)
        if "command" not in columns:
            self.notes.append("no command was recorded: the measured pressure stands for it")
        drive = columns.get("command") or columns["pressure"]
        first = next(i for i, value in enumerate(drive) if not math.isnan(value))
        log.columns["command"] = self.carried(drive)
        return longest_piece(cut(log, first, len(drive)))

    def carried(self, values):
        """Replaces a missing command by the previous command."""
        filled, gaps = list(values), 0
        for i in range(1, len(filled)):
            if math.isnan(filled[i]) and not math.isnan(filled[i - 1]):
                filled[i], gaps = filled[i - 1], gaps + 1
        if gaps:
            self.notes.append(f"{gaps} samples without a command keep the one before")
        return filled

    def with_readings(self, keep, readings):
        """Removes the samples without a reading if their share is above MOST_MISSING. Such a share occurs if the sensor
        delivers readings at a lower rate than the log."""
        read = [i for i in keep if not math.isnan(readings[i])]
        if not read or len(read) >= (1 - MOST_MISSING) * len(keep):
            return keep
        self.notes.append(f"{len(keep) - len(read)} of {len(keep)} samples without a displacement are left out")
        return read

    def usable(self, lines, times):
        """Returns the indices of the samples within the requested time range. Skips a sample that has the time of the
        previous sample. Raises Spoiled if a time decreases."""
        keep, repeated = [], 0
        for i, t in enumerate(times):
            if not self.entry.from_s <= t <= self.entry.to_s:
                continue
            if not keep or t > times[keep[-1]]:
                keep.append(i)
            elif t == times[keep[-1]]:
                repeated += 1
            else:
                raise self.spoiled(lines[i], f"the time goes back from {times[keep[-1]]:g} to {t:g} s after the first "
                                             "sample; two runs in one file? Cut it here and give each as a log")
        if repeated:
            self.notes.append(f"{repeated} samples at the time of the one before are left out")
        return keep


def cut(log, begin, end):
    return Log([t - log.time_s[begin] for t in log.time_s[begin:end]],
               {key: values[begin:end] for key, values in log.columns.items()}, log.lines[begin:end], log.notes)


def longest_piece(log):
    """Returns the longest segment of a log that contains no hole."""
    steps = [b - a for a, b in zip(log.time_s, log.time_s[1:])]
    if not steps:
        return log
    usual, command = statistics.median(steps), log.columns["command"]
    width = max(command) - min(command)
    holes = [i + 1 for i, step in enumerate(steps) if step > max(HOLE_S, HOLE_INTERVALS * usual)
             and abs(command[i + 1] - command[i]) > HOLE_CHANGE * width]
    if not holes:
        return log
    edges = [0, *holes, len(log.time_s)]
    begin, end = max(zip(edges, edges[1:]), key=lambda edge: log.time_s[edge[1] - 1] - log.time_s[edge[0]])
    log.notes.append(f"holes in which the command changed unseen: {len(holes)}, the first before line "
                     f"{log.lines[holes[0]]}; used are {log.time_s[end - 1] - log.time_s[begin]:.3g} of "
                     f"{log.time_s[-1]:.3g} s, lines {log.lines[begin]} to {log.lines[end - 1]}; `from_s` and `to_s` "
                     "give the others")
    return cut(log, begin, end)


def read_log(entry, data):
    """Reads a log and converts it to the log format. Raises Spoiled if the log cannot be used."""
    if entry.problems:
        raise Spoiled("\n".join(entry.problems))
    return Reader(entry, data).read()
