"""Writes external files in every supported format, and checks the result of `softgrip import` for each.

    tests/system/foreign_files.py [--page] [--keep FOLDER]

Prints the result of every file; --page writes docs/reference/foreign-files.md. The exit code is 6 if a result is not
the required one. The required result is a log with the original values, or a refusal with the reason. Needs a built
tree and python3-h5py.
"""

import argparse
import csv
import datetime
import gzip
import json
import math
import os
import pathlib
import shlex
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

import tdms
import workbooks

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", ROOT / "build" / "release"))
PAGE = ROOT / "docs/reference/foreign-files.md"

# The original signals: three seconds, sampled at 100 Hz. The command rises to 60 kPa and falls to 0. The measured
# pressure follows the command with a lag, and the displacement of a finger follows the pressure.
COUNT = 300
PSI, BAR = 6.894757293168361, 100.0


def truth():
    time_s = [i / 100 for i in range(COUNT)]
    command = [round(60 - abs(40 * t - 60), 6) for t in time_s]
    pressure, now = [], 0.0
    for value in command:
        now += 0.2 * (value - now)
        pressure.append(round(now, 6))
    displacement = [round(0.2 * p + 0.4 * math.sin(p / 20), 6) for p in pressure]
    temperature = [round(21 + 0.5 * t, 6) for t in time_s]
    return {"time_s": time_s, "pressure_command_kpa": command, "pressure_kpa": pressure,
            "displacement_mm": displacement, "temperature_c": temperature}


TRUTH = truth()
T, COMMAND, PRESSURE, TIP, WARM = TRUTH.values()


def table(names, columns, separator=",", decimal=".", above="", units=None, quote=False, end="\n"):
    """Returns lines of text for the rows. A value of None becomes an empty cell."""
    def cell(value):
        text = "" if value is None else value if isinstance(value, str) else repr(value)
        text = text if isinstance(value, str) else text.replace(".", decimal)
        return f'"{text}"' if quote and text else text

    def name(text):
        return f'"{text}"' if quote or separator in text else text
    lines = [separator.join(map(name, names))] if names else []
    lines += [separator.join(map(name, units))] if units else []
    lines += [separator.join(map(cell, row)) for row in zip(*columns)]
    return above + end.join(lines) + end


def scaled(values, factor, digits=12):
    return [round(value / factor, digits) for value in values]


def times(start, pattern):
    begin = datetime.datetime.fromisoformat(start)
    return [(begin + datetime.timedelta(milliseconds=round(1000 * t))).strftime(pattern)[:-3] for t in T]


def changed(text, line, old, new):
    lines = text.split("\n")
    assert old in lines[line - 1], lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new, 1)
    return "\n".join(lines)


def dropped(columns, rows):
    return [[value for i, value in enumerate(column) if i not in rows] for column in columns]


def without(rows):
    kept = {name: [value for i, value in enumerate(values) if i not in rows] for name, values in TRUTH.items()}
    first = kept["time_s"][0]
    return kept | {"time_s": [round(t - first, 9) for t in kept["time_s"]]}


# Writes MATLAB 5 files. The code follows the specification (MAT-File Format, The MathWorks). It does not use the
# library with which softgrip reads these files.

def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def matrix(name, values):
    return element(14, element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", len(values), 1))
                   + element(1, name.encode()) + element(9, struct.pack(f"<{len(values)}d", *values)))


def structure(name, fields):
    names = b"".join(field.encode().ljust(32, b"\0") for field in fields)
    return element(14, element(6, struct.pack("<II", 2, 0)) + element(5, struct.pack("<ii", 1, 1))
                   + element(1, name.encode()) + struct.pack("<HHi", 5, 4, 32) + element(1, names)
                   + b"".join(matrix("", values) for values in fields.values()))


def headed(kind, shape, name, content):
    return element(14, element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack("<ii", *shape))
                   + element(1, name.encode()) + content)


def text_matrix(text):
    return headed(4, (1, len(text)), "", element(16, text.encode()))


def structures(name, elements):
    """Returns an array of MATLAB structures. The values of the fields are given in encoded form."""
    names = b"".join(field.encode().ljust(32, b"\0") for field in elements[0])
    return headed(2, (1, len(elements)), name, struct.pack("<HHi", 5, 4, 32) + element(1, names)
                  + b"".join(value for fields in elements for value in fields.values()))


def cells(name, values):
    return headed(1, (1, len(values)), name, b"".join(values))


def dspace():
    def signal(name, unit, values):
        return {"Name": text_matrix(name), "Data": matrix("", values), "Unit": text_matrix(unit)}
    return matlab_5(structures("rec001", [{"X": structures("", [signal("time", "s", T)]), "Y": structures(
        "", [signal("set", "kPa", COMMAND), signal("tip", "mm", TIP)]), "Description": text_matrix("bench")}]))


def late_signal():
    """Returns named signals. The reading has a time of its own, which begins 0.5 s after the time of the command."""
    def signal(name, values, **others):
        return structures(name[:3], [{"Name": text_matrix(name)} | {
            key: matrix("", column) for key, column in others.items()} | {"Data": matrix("", values)}])
    return matlab_5(matrix("time_s", T), signal("set_kPa", COMMAND),
                    signal("tip_mm", TIP, Time_s=[round(t + 0.5, 2) for t in T]))


def trials():
    def trial(factor):
        return {"t_s": matrix("", T), "set_kPa": matrix("", scaled(COMMAND, factor)), "tip_mm": matrix("", scaled(TIP, factor))}
    return matlab_5(structures("finger", [{"trial": structures("", [trial(factor) for factor in (2, 1, 4)])}]))


def lvm(x_columns, sections):
    """Returns a file in the text format of LabVIEW, with sections of equal length. Without X columns, the row number
    determines the time."""
    text = "".join(f"{key}\t{value}\n" for key, value in (
        ("LabVIEW Measurement", ""), ("Writer_Version", "2"), ("Separator", "Tab"), ("Decimal_Separator", ","),
        ("Multi_Headings", "Yes"), ("X_Columns", x_columns), ("Time_Pref", "Relative"), ("***End_of_Header***", "")))
    length = COUNT // sections
    for begin in range(0, COUNT, length):
        text += ("\t\nChannels\t2\t\t\nDate\t2024/06/13\t2024/06/13\t\nTime\t12:59:50,938\t12:59:50,938\t\n"
                 "Y_Unit_Label\tkPa\tmm\t\nX0\t0,0E+0\t0,0E+0\t\nDelta_X\t0,01\t0,01\t\n***End_of_Header***\t\t\t\n"
                 "X_Value\tSet\tTip\tComment\n")
        for i in range(length):
            time = "" if x_columns == "No" else f"{T[i]:.6f}"
            text += "\t".join((time, f"{COMMAND[begin + i]:.6f}", f"{TIP[begin + i]:.6f}")).replace(".", ",") + "\n"
    return text


def matlab_5(*variables):
    return b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM" + b"".join(variables)


def packed(variable):
    data = zlib.compress(variable)
    return struct.pack("<II", 15, len(data)) + data


def matlab_4(name, values):
    return struct.pack("<5i", 0, len(values), 1, 0, len(name) + 1) + name.encode() + b"\0" + struct.pack(
        f"<{len(values)}d", *values)


def matlab_73(path):
    import h5py
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", T), ("p_cmd_kPa", COMMAND), ("p_kPa", PRESSURE), ("tip_mm", TIP)):
            file.create_dataset(name, data=[values]).attrs.create("MATLAB_class", b"double", dtype="S6")
        # Empty arrays: MATLAB stores the dimensions of the array as its values.
        for name in ("offset", "calibration", "remarks", "trigger", "limits"):
            empty = file.create_dataset(name, data=[0, 0], dtype="u8")
            empty.attrs.create("MATLAB_class", b"double", dtype="S6")
            empty.attrs["MATLAB_empty"] = 1
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + struct.pack("<H", 0x0200) + b"IM")


def hdf5_datasets(path):
    import h5py
    with h5py.File(path, "w") as file:
        for name, unit, values in (("time", "s", T), ("pressure/set", "bar", scaled(COMMAND, BAR)),
                                   ("pressure/measured", "psi", scaled(PRESSURE, PSI)), ("tip", "mm", TIP)):
            file.create_dataset("run1/" + name, data=values, compression="gzip").attrs["units"] = unit


PACKED = [round((tip - 5) / 0.0005) for tip in TIP]


def hdf5_packed(path):
    """Writes a file with 16-bit integers, as programs write them for netCDF. Two readings are missing."""
    import h5py
    import numpy
    with h5py.File(path, "w") as file:
        file["time"] = T
        file["pressure_set"] = numpy.array([round(10 * value) for value in COMMAND], "i2")
        file["tip"] = numpy.array([-32767 if i in (50, 51) else value for i, value in enumerate(PACKED)], "i2")
        file["room"] = T
        for name, attributes in (("time", {"units": "s"}), ("pressure_set", {"units": "kPa", "scale_factor": 0.1}),
                                 ("tip", {"units": "mm", "scale_factor": [0.0005], "add_offset": 5.0, "_FillValue": numpy.int16(-32767)}),
                                 ("room", {"scale_factor": "0.1"})):
            file[name].attrs.update(attributes)


def hdf5_single(path):
    """Writes readings of 32 bits. Two readings have the fill value, which is stored with 64 bits."""
    import h5py
    import numpy
    with h5py.File(path, "w") as file:
        file["time"], file["pressure_set"] = T, COMMAND
        file["tip"] = numpy.array([-99.1 if i in (50, 51) else tip for i, tip in enumerate(TIP)], "f4")
        file["tip"].attrs["_FillValue"] = -99.1
        for name, unit in (("time", "s"), ("pressure_set", "kPa"), ("tip", "mm")):
            file[name].attrs["units"] = unit


def hdf5_compound(path):
    import h5py
    import numpy
    rows = numpy.array([(*row, b"run", (1, 2, 3)) for row in zip(T, COMMAND, TIP)], dtype=[
        ("time_s", "f8"), ("setpoint_kpa", "f8"), ("x_mm", "f8"), ("state", "S8"), ("xyz", "f4", (3,))])
    with h5py.File(path, "w") as file:
        file["log"] = rows


def recording(path):
    path.mkdir()
    lines = ["time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,state"]
    for t, command, tip, pressure in zip(T, COMMAND, TIP, PRESSURE):
        lines += [f"{t!r},left,{command!r},{tip!r},{pressure!r},running", f"{t!r},right,0,{0.1 * tip!r},0,running"]
    (path / "run.csv").write_text("\n".join(lines) + "\n")


def exported(file):
    """Returns an MCAP file of the recording, which `softgrip export` has written."""
    def make(path):
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder) / "run"
            recording(run)
            out = run.with_suffix(".mcap")
            subprocess.run([BUILD / "tools/softgrip", "export", run, "--out", out], check=True, capture_output=True)
            path.write_bytes(file(out.read_bytes()))
    return make


def mcap(messages):
    """Returns an MCAP file with the messages (topic, time [s], object), sorted by time."""
    def text(value):
        return struct.pack("<I", len(value)) + value.encode()

    def record(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content
    names = sorted({topic for topic, _, _ in messages})
    records = [record(4, struct.pack("<HH", i, 0) + text(name) + text("json") + struct.pack("<I", 0))
               for i, name in enumerate(names)]
    for topic, time_s, content in sorted(messages, key=lambda message: message[1]):
        time_ns = 1717156800 * 10**9 + round(1e9 * time_s)
        records.append(record(5, struct.pack("<HIQQ", names.index(topic), 0, time_ns, time_ns) + json.dumps(content).encode()))
    magic = b"\x89MCAP0\r\n"
    return magic + record(1, text("") + text("test")) + b"".join(records) + record(15, bytes(4)) + record(2, bytes(20)) + magic


class File:
    """One external file: the function that writes the file, the import options, and the required result."""

    def __init__(self, name, about, content, options="", *, columns=None, refused="", says="", left_out=None, joined=0,
                 tolerance=1e-9):
        self.name, self.about, self.content, self.options = name, about, content, options
        self.refused, self.says, self.tolerance = refused, says, tolerance
        self.account = {"joined": joined, "left_out": left_out or {}}
        self.columns = None if refused else columns or {key: TRUTH[key] for key in BASIC}

    def make(self, folder):
        path = folder / self.name
        if callable(self.content):
            self.content(path)
        else:
            path.write_bytes(self.content if isinstance(self.content, bytes) else self.content.encode())
        return path


def ambiguous_tables():
    """Returns texts that have two possible meanings, and texts with rows or dates outside the cells of the readings."""
    names = ["time_s", "set_kpa", "tip_mm"]
    rows = PLAIN.splitlines()
    swapped = table(["time_s", "tip_mm", "set_kpa"], [T[150:], TIP[150:], COMMAND[150:]])
    without_time = table(names[1:], [COMMAND, TIP]).splitlines()
    return [
        File("two_units.csv", "two commands in psi and in kPa, whose mean is used",
             table(["time_s", "p1 (psi)", "p2 (kPa)", "tip_mm"], [T, scaled(COMMAND, PSI), COMMAND, TIP]),
             "--command 'p1 (psi)' --command 'p2 (kPa)'"),
        File("two_tables.csv", "two tables, one after the other, with another order of the columns",
             "\n".join(rows[:151]) + "\n" + swapped, "--skip-bad-lines",
             refused="two_tables.csv:152:1: a second table begins here"),
        File("rows_in_comments.csv", "ten rows in comments and two empty lines, with the rate as an option",
             "\n".join("#" + row if 201 <= i < 211 else "" if i in (251, 252) else row for i, row in enumerate(without_time)),
             "--rate-hz 100", columns={key: without({*range(200, 210), 250, 251})[key] for key in BASIC},
             left_out={"comment": 10, "empty": 2}),
        File("thousands.csv", "thousands separated by commas, in quotes",
             table(["time", "set_pa", "tip_um"], [times("2024-05-31T12:00:00", "%H:%M:%S.%f"),
                   [f"{1000 * p:,.0f}" for p in COMMAND], [f"{1000 * tip:,.0f}" for tip in TIP]], quote=True),
             refused="can be a decimal comma or separate thousands"),
        File("column_numbers.csv", "the numbers of the columns instead of their names", table(["0", "1", "2"], [T, COMMAND, TIP]),
             "--time 1 --unit time=s --command 2 --unit command=kPa --displacement 3 --unit displacement=mm",
             refused="column_numbers.csv:1:1: this line has the numbers of the columns instead of their names"),
        File("date_and_time.csv", "dates and times of day in two columns, across midnight", table(
            ["Date", "Time", *names[1:]], [[text[:10] for text in times("2024-05-31T23:59:58", "%d.%m.%Y.%f")],
                                           times("2024-05-31T23:59:58", "%H:%M:%S.%f"), COMMAND, TIP]),
             says="'Date' and 'Time' are combined into one time"),
        *(File(f"date_{word}.csv", f"dates that change {about} midnight", table(
            ["Date", "Time", *names[1:]], [["31.05.2024" if t < when else "01.06.2024" for t in T],
                                           times("2024-05-31T23:59:58.500", "%H:%M:%S.%f"), COMMAND, TIP]),
               says="'Date' does not change in the row in which 'Time' passes midnight, so the dates are not used")
          for word, about, when in (("late", "one row after", 1.505), ("early", "one row before", 1.485))),
        File("date_changes.csv", "dates with the month first that change within the file", table(
            ["Date", "Time", *names[1:]], [[f"0{5 if t < 1.5 else 6}/01/2024" for t in T],
                                           times("2024-05-31T12:00:00", "%H:%M:%S.%f"), COMMAND, TIP]),
             refused="date_changes.csv:152:1: the date changes to '06/01/2024'"),
        File("utf16_no_mark.txt", "UTF-16 without a byte order mark",
             table(names, [T, COMMAND, TIP], "\t", end="\r\n").encode("utf-16-le")),
    ]


def spreadsheets():
    """Returns workbooks, and files that look like workbooks but are not."""
    names = ["Time (s)", "P set (kPa)", "Tip (mm)"]
    rows = [list(row) for row in zip(T, COMMAND, TIP)]
    days = [["Time", *names[1:]]] + [[workbooks.date(45443.999 + t / 86400), *row] for t, *row in rows]
    clocks = [["Time", *names[1:]]] + [[workbooks.date((0.99999 + t / 86400) % 1, 2), *row] for t, *row in rows]
    odd = [["Bench 3"], None, ["Operator", "me"], ["Time", workbooks.inline("P set"), "Tip", "valid"], ["s", "kPa", "mm"]]
    odd += [[t, workbooks.formula("B7*2", command), tip, True] for t, command, tip in rows]
    odd[15][2], odd[25][2], odd[35][2] = workbooks.error("#DIV/0!"), workbooks.formula("NOW()"), None
    holes = [math.nan if i in (10, 20, 30) else tip for i, tip in enumerate(TIP)]
    stuck = [names] + [row[:] for row in rows]
    stuck[101][2] = "stuck"
    strings = []
    days_of_work = {"Monday": workbooks.sheet([names] + [[t, c, -d] for t, c, d in rows], strings),
                    "Tuesday": workbooks.sheet([names] + rows, strings), "Notes": workbooks.sheet([["mass", 2]], strings)}
    several = workbooks.package(days_of_work, strings)
    return [
        File("plain.xlsx", "a workbook", workbooks.book([names] + rows)),
        File("dates.xlsx", "dates in a workbook, across midnight", workbooks.book(days)),
        File("clocks.xlsx", "times of day in a workbook, across midnight", workbooks.book(clocks)),
        File("dates_1904.xlsx", "a workbook with dates that are counted from 1904", workbooks.package(
            {"Run": workbooks.sheet(days, strings)}, strings, from_1904=True), says="counted from 1904"),
        File("odd.xlsx", "a workbook with titles, formulas, errors, booleans and merged cells that does not begin at A1", workbooks.book(
            odd, first_row=2, first_column=1, below='<mergeCells><mergeCell ref="B2:E2"/></mergeCells>'),
             columns=BASIC_OF | {"displacement_mm": holes}, says="D17 (#DIV/0!)"),
        File("two_sheets.xlsx", "two sheets with numbers", several, refused="2 sheets have rows of numbers: 'Monday', 'Tuesday'"),
        File("sheet_chosen.xlsx", "two sheets with numbers, one of them selected", several, "--sheet Tuesday", says="sheet 'Monday' is not used"),
        File("idle_sheet.csv", "the option --sheet for a file without sheets", PLAIN, "--sheet Run", says="--sheet has no effect"),
        File("word.xlsx", "a word among the numbers of a sheet", workbooks.book(stuck),
             refused="sheet 'Run':102:10: displacement: cell C102: 'stuck' is not a number"),
        File("cut_off.xlsx", "a workbook with a missing end", workbooks.book([names] + rows)[:3000], refused="broken or cut off"),
        File("spreadsheet.ods", "an OpenDocument spreadsheet", opendocument, refused="an OpenDocument spreadsheet (.ods)"),
        File("old.xls", "an old spreadsheet", b"\xd0\xcf\x11\xe0" + bytes(508), refused="this is an old spreadsheet (.xls)"),
        File("locked.xlsx", "a workbook with a password", b"\xd0\xcf\x11\xe0" + bytes(508) + "EncryptedPackage".encode("utf-16-le"),
             refused="this is a workbook with a password"),
    ]


def measurements():
    """Returns files in the binary format of LabVIEW (.tdms)."""
    times = {"t": tdms.Channel(T, {"unit_string": "s"}), "set": tdms.Channel(COMMAND, {"unit_string": "kPa"}),
             "tip": tdms.Channel(TIP, {"unit_string": "mm"})}
    ramp = [k - 150 for k in range(COUNT)]
    stamps = times | {"t": tdms.Channel([3.8e9 + t for t in T], kind="time"), "comment": tdms.Channel(["ok"], kind="text"),
                      "valid": tdms.Channel(ramp, kind="i16")}
    steps = {name: tdms.Channel(channel.values, channel.properties | {"wf_increment": 0.01, "wf_start_offset": 0.0})
             for name, channel in times.items() if name != "t"}
    whole = tdms.file([tdms.segment("log", times, pieces=3)])

    def parts(*changes):
        """Returns a file with three segments of 1 s. Each segment states its start time and its sampling interval."""
        stated = [({"wf_increment": 0.01, "wf_start_time": 3.8e9 + k} | change) for k, change in enumerate(changes)]
        return tdms.file([tdms.segment("log", {name: tdms.Channel(channel.values[100 * k:100 * k + 100], channel.properties | properties)
                                               for name, channel in times.items() if name != "t"})
                          for k, properties in enumerate(stated)])
    return [
        File("blocks.tdms", "LabVIEW TDMS: each channel in a block, 3 chunks", whole),
        File("interleaved.tdms", "LabVIEW TDMS: interleaved channels", tdms.file([tdms.segment("log", times, interleaved=True)])),
        File("segments.tdms", "LabVIEW TDMS: segments that repeat the metadata", tdms.file(tdms.in_segments("log", times, 50))),
        File("stamps.tdms", "LabVIEW TDMS: time stamps, a text, integers", tdms.file([tdms.segment("log", stamps)]),
             says="'log/comment' is skipped: a text", tolerance=1e-6),
        File("waveform.tdms", "LabVIEW TDMS: waveforms", tdms.file([tdms.segment("log", steps)]),
             says="'wf_time' is computed from wf_start_offset in steps of wf_increment"),
        File("wave_parts.tdms", "LabVIEW TDMS: waveforms in segments that follow without a gap", parts({}, {}, {})),
        File("wave_gap.tdms", "LabVIEW TDMS: waveforms in 3 segments; the last segment begins 0.4 s later", parts({}, {}, {"wf_start_time": 3.8e9 + 2.4}),
             columns=BASIC_OF | {"time_s": [round(t + (0.4 if t > 1.995 else 0), 6) for t in T]}, tolerance=1e-6,
             says="the first gap is from 1.99 s to 2.4 s"),
        File("wave_rates.tdms", "LabVIEW TDMS: waveforms with 2 sampling intervals", parts({}, {}, {"wf_increment": 0.05}),
             refused="the waveform 'log/set' are contradictory: wf_increment changes from 0.01 s to 0.05 s"),
        File("wave_back.tdms", "LabVIEW TDMS: waveforms in segments that overlap", parts({}, {}, {"wf_start_time": 3.8e9 + 1.5}),
             refused="a segment begins at 1.5 s after the first value, but the previous values end at 1.99 s"),
        File("cut_off.tdms", "LabVIEW TDMS: interleaved channels, with a missing end", tdms.file([tdms.segment("log", times, interleaved=True)])[:-100 * 24 - 5],
             columns={key: TRUTH[key][:199] for key in BASIC}, says="the file is cut off", left_out={"cut_off_line": 1}),
        File("daqmx.tdms", "LabVIEW TDMS: raw values of DAQmx", whole[:4] + bytes([whole[4] | 128]) + whole[5:],
             refused="raw values of DAQmx"),
    ]


def damaged_matlab():
    """Returns MATLAB files that are cut off or damaged in the last variable."""
    names, values = ("time_s", "set_kPa", "tip_mm"), (T, COMMAND, TIP)
    whole = matlab_5(*map(matrix, names, values))
    run = matlab_5(structure("run", dict(zip(names, values))))
    small = matlab_5(*(packed(matrix(*pair)) for pair in zip(names, values)))
    old = b"".join(map(matlab_4, names, values))
    cell = matlab_5(cells("log", [*(matrix("", column) for column in values), element(9, bytes(8))]))
    said = "it is cut off or damaged in the "
    return [
        File("cut_values.mat", "MATLAB 5, with the last half of the last variable missing", whole[:-1200], refused=said + "variable 'tip_mm'"),
        File("cut_name.mat", "MATLAB 5, with a missing end: the file ends before the name of the last variable", whole[:-2420],
             refused=f"{said}data element at byte {len(whole) - len(matrix('tip_mm', TIP))}"),
        File("cut_structure.mat", "MATLAB 5: a structure, with a missing end", run[:-1200], refused=said + "variable 'run'"),
        File("cut_packed.mat", "MATLAB 7: compressed vectors, with a missing end", small[:-200], refused=said + "variable 'tip_mm'"),
        File("changed_packed.mat", "MATLAB 7: compressed vectors, with one changed bit",
             small[:-200] + bytes([small[-200] ^ 1]) + small[-199:], refused=said + "variable 'tip_mm'"),
        File("changed_cell.mat", "MATLAB 5: a cell array whose last cell is not an array", cell,
             "--time 1 --command 2 --displacement 3 --unit time=s --unit command=kPa --unit displacement=mm",
             says="'log{4}' is skipped: this array cannot be read"),
        File("cut_old.mat", "MATLAB 4, with the last half of the last variable missing", old[:-1200], refused=said + "variable 'tip_mm'"),
    ]


def clocks_and_cells():
    """Returns files with clocks that begin again for different reasons, with columns that have no value, and with
    values that look like codes or errors."""
    names = ["time_s", "set_kpa", "tip_mm"]

    def restarted(first, second, pattern):
        return table(["Time", *names[1:]], [times(first, pattern) + times(second, pattern), COMMAND * 2, TIP * 2])
    ms = [65000 + round(1000 * t) for t in T]
    repeated = "".join(f"{t!r},{c!r},\n{t!r},{c!r},{y!r}\n" for t, c, y in zip(T, COMMAND, TIP))
    rare = [60.0 if i % 100 in (20, 21, 22) else float(i // 50 % 2) for i in range(COUNT)]
    empty = [None] * COUNT
    wrong_pressure = [200.0 if i == 100 else value for i, value in enumerate(PRESSURE)]
    late = [round(t + (0 if i < 80 else 2.345678), 6) for i, t in enumerate(T)]
    late_command = [None if i < 10 else value for i, value in enumerate(COMMAND)]
    return [
        File("minutes_restart.csv", "minutes and seconds of two runs; the second run begins at 00:00",
             restarted("2024-05-31T12:34:57", "2024-05-31T12:00:00", "%M:%S.%f"),
             refused="minutes_restart.csv:302:1: the time goes back"),
        File("clock_set_back.csv", "times of day with a clock that was set back by 17 hours",
             restarted("2024-05-31T20:00:00", "2024-05-31T03:00:00", "%H:%M:%S.%f"),
             refused="clock_set_back.csv:302:1: the time goes back"),
        File("two_counters.csv", "a separate 16-bit counter of the reading, which begins 3 ms later",
             table(["t_cmd (ms)", "set (kPa)", "t_tip (ms)", "tip (mm)"], [ms, COMMAND, [(t + 3) % 65536 for t in ms], TIP]),
             columns={"time_s": [round(t + late_s, 3) for t in T for late_s in (0, 0.003)],
                      "pressure_command_kpa": [value for value in COMMAND for _ in (1, 2)],
                      "displacement_mm": [value for tip in TIP for value in (math.nan, tip)]},
             says="the clock overflows at 65536, 1 time, first in line 56 of 't_tip (ms)'"),
        File("code_in_time.csv", "-999 for missing times", table(names, [
            [-999 if i in (0, 1, 2, 200) else t for i, t in enumerate(T)], COMMAND, TIP]), "--missing -999",
             columns={key: without({0, 1, 2, 200})[key] for key in BASIC}, left_out={"no_time": 4},
             says="--missing -999 applies to 4 cells of 'time_s'"),
        File("repeated_command.csv", "the command of one time in two rows, one of them with the reading", ",".join(names) + "\n" + repeated,
             joined=COUNT),
        File("empty_columns.csv", "a measured pressure and a temperature without a value",
             table([*names, "pressure_kpa", "temperature_C"], [T, COMMAND, TIP, empty, empty]),
             says="'temperature_C' has no value, so it is not used as the temperature"),
        File("rare_command.csv", "a high command in a few rows", table(names, [T, rare, TIP]),
             columns=BASIC_OF | {"pressure_command_kpa": rare}),
        File("first_reading.csv", "a wrong first reading", table(names, [T, COMMAND, [90.0, *TIP[1:]]]),
             columns=BASIC_OF | {"displacement_mm": [math.nan, *TIP[1:]]}, says="the first reading was removed: the jump from 90"),
        File("wrong_pressure.csv", "a measured pressure that is wrong in one row",
             table([*names, "pressure_kpa"], [T, COMMAND, TIP, wrong_pressure]),
             columns=MEASURED | {"pressure_kpa": [math.nan if i == 100 else value for i, value in enumerate(PRESSURE)]},
             says="1 of 300 measured pressures is isolated, removed: 200 kPa at 1 s"),
        File("gap_after_start.csv", "a gap, after rows without a command",
             table(names, dropped([late, late_command, TIP], set(range(80, 150)))),
             columns={key: without(set(range(150)))[key] for key in BASIC}, left_out={"before_command": 10, "hole": 70},
             says="3.845678 to 5.335678 s; to select another segment, use --from-s and --to-s: 0.1 to 0.79 s"),
    ]


def opendocument(path):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr("content.xml", "<office/>")


BASIC = ("time_s", "pressure_command_kpa", "displacement_mm")
BASIC_OF = {key: TRUTH[key] for key in BASIC}
BENT = {"time_s": T, "pressure_command_kpa": COMMAND, "angle_deg": TIP}
MEASURED = {key: TRUTH[key] for key in (*BASIC, "pressure_kpa")}
ALONE = {"time_s": T, "pressure_command_kpa": PRESSURE, "pressure_kpa": PRESSURE, "displacement_mm": TIP}
PLAIN = table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, TIP])
PREAMBLE = "".join(f"{key}\t{value}\n" for key, value in (
    ("LabVIEW Measurement", ""), ("Writer_Version", "2"), ("Operator", "M. Muster"), ("Date", "2024/05/31"),
    ("Channels", "3"), ("***End_of_Header***", "")))
EPOCH = 1717156800


def reports():
    """Returns files like those in public field reports. Each file is given by the text of its rows."""
    names = ["time_s", "set_kpa", "tip_mm"]
    ms = [round(1000 * t) for t in T]
    thirds = {"pressure_command_kpa": [COMMAND[3 * (i // 3)] for i in range(COUNT)]}
    slow = [tip if i % 20 == 0 else math.nan for i, tip in enumerate(TIP)]
    slow_cells = [tip if i % 20 == 0 else "n/a" for i, tip in enumerate(TIP)]
    quarter = [round(0.25 * value, 6) for value in COMMAND]
    other_tip = [round(3 - value, 6) for value in TIP]
    three = table(["time_s", *(f"{finger}_{kind}" for finger in ("thumb", "index", "ring") for kind in (
        "pressure_command_kpa", "displacement_mm"))], [T, quarter, other_tip, COMMAND, TIP, quarter, TIP[::-1]])
    rows_of_two = "t_s,channel,set_kpa,tip_mm\n" + "".join(
        f"{t!r},A,{q!r},{o!r}\n{t!r},B,{c!r},{y!r}\n" for t, q, o, c, y in zip(T, quarter, other_tip, COMMAND, TIP))
    coded = {code: [code if i in (5, 120, 121) else tip for i, tip in enumerate(TIP)] for code in (-1000, 65535)}
    coded_truth = BASIC_OF | {"displacement_mm": [math.nan if i in (5, 120, 121) else tip for i, tip in enumerate(TIP)]}
    channels = {"t": tdms.Channel(T, {"unit_string": "s"}), "set": tdms.Channel(COMMAND, {"unit_string": "kPa"}),
                "tip": tdms.Channel(TIP, {"unit_string": "mm"})}
    parts = [tdms.segment("log", channels, rows=(begin, begin + 100)) for begin in (0, 100, 200)]
    first = {key: TRUTH[key][:200] for key in BASIC}
    clock = times("2024-05-31T12:59:58", "%I:%M:%S.%f")
    two_clocks = table(["t_cmd (ms)", "set (kPa)", "t_tip (ms)", "tip (mm)"],
                       [ms[::3] + [None] * 200, COMMAND[::3] + [None] * 200, ms, TIP], ";", ",")
    lvm_text = lvm("One", 3)
    blanks = [names] + [[t, c if i % 3 == 0 else None, y] for i, (t, c, y) in enumerate(zip(T, COMMAND, TIP))]
    step_back = [t if i < 150 else round(t - 0.015, 6) for i, t in enumerate(T)]
    return [
        File("three_fingers.csv", "columns of three fingers, as exported by softgrip, one finger selected", three, "--channel index"),
        File("three_fingers_unsaid.csv", "columns of three fingers, as exported by softgrip, no finger selected", three,
             refused="the columns belong to 3 fingers: 'thumb', 'index', 'ring'"),
        File("channel_rows.csv", "rows of two fingers, one finger selected", rows_of_two, "--channel B", left_out={"other_channel": 300}),
        File("channel_rows_none.csv", "rows of two fingers, and the option --channel with a name that no finger has", rows_of_two, "--channel C",
             refused="no row belongs to channel 'C'"),
        File("fingers.xlsx", "two fingers in a workbook, one of them selected", workbooks.book(
            [["time_s", "P1 set (kPa)", "P2 set (kPa)", "tip 1 (mm)", "tip 2 (mm)"]]
            + [list(row) for row in zip(T, quarter, COMMAND, other_tip, TIP)]), "--channel 2"),
        File("one_sensor.csv", "the pressures of two fingers and the reading of one finger",
             table(["t_s", "left set (kPa)", "right set (kPa)", "right tip (mm)"], [T, quarter, COMMAND, TIP])),
        File("counter_24_bit.csv", "microseconds of a 24-bit counter",
             table(["t_us", "set_kpa", "tip_mm"], [[(2 ** 24 - 1000000 + round(1e6 * t)) % 2 ** 24 for t in T], COMMAND, TIP]),
             says="the clock overflows at 16777216, 1 time"),
        File("day_in_ms.csv", "milliseconds of the day across midnight",
             table(["t_ms", "set_kpa", "tip_mm"], [[(86_399_000 + m) % 86_400_000 for m in ms], COMMAND, TIP]),
             says="the clock overflows at 86400000, 1 time"),
        File("clock_corrected.csv", "a clock that steps back by 15 ms", table(names, [step_back, COMMAND, TIP]),
             refused="clock_corrected.csv:152:1: the time goes back"),
        File("date_corrected.csv", "dates that step back by 15 ms", table(
            ["Date", *names[1:]], [[(datetime.datetime(2024, 5, 31) + datetime.timedelta(seconds=t)).isoformat(
                timespec="milliseconds") for t in step_back], COMMAND, TIP]), refused="date_corrected.csv:152:1: the time goes back"),
        File("blank_commands.xlsx", "a workbook with a command in every third row", workbooks.book(blanks),
             columns=BASIC_OF | thirds, says="200 samples without a command (the command of the previous sample is used)"),
        File("late_command.csv", "readings before the first command",
             table(names, [T, [None] * 10 + COMMAND[10:], TIP]), columns={key: without(set(range(10)))[key] for key in BASIC},
             says="10 samples before the first command (left out)", left_out={"before_command": 10}),
        File("two_clocks.csv", "a separate, slower clock of the command, decimal commas", two_clocks, columns=BASIC_OF | thirds,
             says="each row has 2 times", joined=100, left_out={"empty": 200}),
        File("same_clock_twice.csv", "the same time in s and in ms", table(
            ["time_s", "t_ms", "set_kpa", "tip_mm"], [T, ms, COMMAND, TIP]), says="contains the same times"),
        File("clock_and_counter.csv", "a time and a counter of samples",
             table(["time_s", "sample", "set_kpa", "tip_mm"], [T, list(range(COUNT)), COMMAND, TIP]), says="unused columns: 'sample'"),
        File("unread_time.csv", "a time, and dates with the month first", table(
            ["time_s", "Timestamp", *names[1:]], [T, times("2024-05-31T12:00:00", "%m/%d/%Y %H:%M:%S.%f"), COMMAND, TIP]),
             says="the column 'Timestamp' looks like a time and cannot be read ('05/31/2024 12:00:00.000')"),
        File("long_minutes.csv", "times with more than 59 minutes", table(
            ["Time", *names[1:]], [[f"{(3598 + t) // 60:.0f}:{(3598 + t) % 60:05.2f}" for t in T], COMMAND, TIP])),
        File("noon.csv", "p.m. in lower case across one o'clock",
             table(["Time", *names[1:]], [[text[:12].lstrip("0") + " p.m." for text in clock], COMMAND, TIP])),
        File("comma_fraction.csv", "ISO dates with a comma before the fraction", table(
            ["Date", *names[1:]], [[text.replace(".", ",") for text in times("2024-05-31T11:59:59", "%Y-%m-%d %H:%M:%S.%f")],
                                   COMMAND, TIP], ";", ",")),
        File("zones.csv", "dates with a time-zone offset", table(
            ["Date", *names[1:]], [[text + "+02:00" for text in times("2024-05-31T23:59:59", "%Y-%m-%dT%H:%M:%S.%f")],
                                   COMMAND, TIP])),
        File("slow_readings.csv", "a reading in every 20th row", table(names, [T, COMMAND, slow_cells]),
             refused="95.0 % of the samples have no reading"),
        File("slow_readings_long.csv", "a reading in every 20th row, in a file with ten times as many rows", table(
            names, [[i / 100 for i in range(10 * COUNT)], COMMAND * 10, slow_cells * 10]),
             columns={"time_s": [i / 100 for i in range(10 * COUNT)], "pressure_command_kpa": COMMAND * 10,
                      "displacement_mm": slow * 10}, says="95.0 % of the samples have no reading"),
        File("code_minus_1000.csv", "-1000 for missing readings", table(names, [T, COMMAND, coded[-1000]]),
             columns=coded_truth, says="3 cells of 'tip_mm' with -1000, far from all other values, count as missing"),
        File("code_65535.csv", "65535 for missing readings", table(names, [T, COMMAND, coded[65535]]),
             columns=coded_truth, says="3 cells of 'tip_mm' with 65535"),
        File("stamps_of_20_ms.csv", "time stamps with a resolution of 20 ms in a log of 100 Hz, with the rate as an option", table(
            names, [[round(0.02 * (i // 2), 6) for i in range(COUNT)], COMMAND, TIP]), "--rate-hz 100",
             says="the column 'time_s' looks like a time and is not used, because --rate-hz replaces this column"),
        File("cut_off.lvm", "a LabVIEW measurement with a missing end", lvm_text[:-20], columns={key: TRUTH[key][:-1] for key in BASIC},
             says=": the last line is cut off and left out", left_out={"cut_off_line": 1}),
        File("nul_tail.lvm", "a LabVIEW measurement with NUL bytes at its end", lvm_text.encode() + bytes(100),
             says="100 NUL bytes at the end of the file are left out"),
        File("cut_metadata.tdms", "LabVIEW TDMS: the file ends in the metadata of the third segment",
             tdms.file(parts)[:-100 * 24 - 30], columns=first, says="is cut off in its metadata"),
        File("cut_block.tdms", "LabVIEW TDMS: the file ends in the values of the third segment", tdms.file(parts)[:-100 * 16 - 80],
             columns=first, says="incomplete rows or blocks of values are left out: 720 bytes", left_out={"cut_off_line": 90}),
        File("nested_cells.mat", "MATLAB 5: a cell array of structures", matlab_5(cells("runs", [structures("", [
            {"t_ms": matrix("", ms), "set_kPa": matrix("", COMMAND), "tip_mm": matrix("", TIP)}])]))),
        File("title_date.xlsx", "times of day in the rows, with the date in the title", workbooks.book(
            [["Bench 3"], [workbooks.date(45443.5)], None, ["Time", *names[1:]]]
            + [[workbooks.date(0.5 + t / 86400, 2), c, y] for t, c, y in zip(T, COMMAND, TIP)]), tolerance=1e-6),
        File("short_rows.csv", "three rows without their last cell, skipped",
             "\n".join(line.rsplit(",", 1)[0] if i in (40, 41, 200) else line for i, line in enumerate(PLAIN.split("\n"))),
             "--skip-bad-lines", columns={key: without({39, 40, 199})[key] for key in BASIC}, left_out={"bad_line": 3},
             says="leaves out 3 lines with too few or too many cells, in lines 41, 42, 201"),
        *ambiguous_tables(), *other_fingers_and_clocks(),
        File("idle_sheet.mcap", "an MCAP recording with options of other formats", exported(bytes),
             "--channel left --sheet Run --separator tab", columns=MEASURED, left_out={"other_channel": 300},
             says="--separator has no effect: the file is not a text"),
    ]


def other_fingers_and_clocks():
    """Returns files that have a row for each finger, and files whose channels have different intervals or start
    times."""
    rows = [(round(t + delay, 3), finger, *values) for t, *both in zip(T, COMMAND, TIP) for delay, finger, values in
            ((0, 1, both), (0.002, 2, [60 - both[0], 12 - both[1]]))]
    of_first = {"left_out": {"other_channel": COUNT}}
    by_word = table(["time_s", "Finger", "set_kpa", "tip_mm"], [
        [row[0] for row in rows], [("left", "right")[row[1] - 1] for row in rows], *zip(*(row[2:] for row in rows))])
    by_number = table(["time_s", "actuator_no", "set_kpa", "tip_mm"], list(zip(*rows)))
    names = ("time_s", "finger", "set_kPa", "tip_mm")
    readings = table(["time_s", "set_kpa", "finger"], [T, COMMAND, TIP])
    one_x = lvm("No", 1)
    # The second channel starts 20 ms after the first channel. It has half the sample rate of the first channel and ends
    # earlier.
    own_x = lvm("Multi", 1).replace("kPa\tmm", "kPa\t\tmm").replace(
        "12:59:50,938\t12:59:50,938", "12:59:50,938\t\t12:59:50,958").replace("2024/06/13\t2024", "2024/06/13\t\t2024").replace(
        "X_Value\tSet\tTip", "X_Value\tSet\tX_Value\tTip")
    own_x = own_x[:own_x.index("Comment\n") + 8] + "".join(
        "\t".join((f"{T[i]:.6f}", f"{COMMAND[i]:.6f}", *((f"{2 * T[i]:.6f}", f"{TIP[2 * i + 2]:.6f}") if 2 * i + 2 < COUNT else ("", "")))
                  ).replace(".", ",") + "\n" for i in range(COUNT))
    late = BASIC_OF | {"displacement_mm": [TIP[i] if i > 0 and i % 2 == 0 else math.nan for i in range(COUNT)]}
    slow = {name: tdms.Channel(values[::2], {"unit_string": unit}) for name, values, unit in (("t", T, "s"), ("tip", TIP, "mm"))}
    fast = {name: tdms.Channel(values, {"unit_string": unit}) for name, values, unit in (("t", T, "s"), ("set", COMMAND, "kPa"))}
    stamp = [1717156800 + int(t) for t in T], [round(t % 1 * 1e9) for t in T]
    return [
        File("psi_as_kpa.csv", "a pressure in psi, in a column that is labelled kPa", table(["time_s", "set_kpa", "tip_mm"], [T, scaled(COMMAND, PSI), TIP]),
             columns=BASIC_OF | {"pressure_command_kpa": scaled(COMMAND, PSI)}, says="The largest value of `set_kpa` is 8.7"),
        File("finger_rows.csv", "rows of two fingers, whose names are in a column that is not called channel", by_word, refused="the file has 2 channels: 'left', 'right'"),
        File("finger_rows_left.csv", "rows of two fingers, whose names are in a column that is not called channel, one finger selected", by_word, "--channel left", **of_first),
        File("finger_numbers.csv", "rows of several fingers, each with the number of its finger", by_number, "--channel 1", **of_first),
        File("finger_rows.mat", "MATLAB 5: rows of several fingers, each with the number of its finger", matlab_5(structures("run", [
            {name: matrix("", values) for name, values in zip(names, zip(*rows))}])),
             refused="the rows belong to 2 fingers: 'run.finger' has 1, 2"),
        File("id_rows.csv", "rows of two devices at the same times, with the number of the device in a column id", table(
            ["time_s", "id", "set_kpa", "tip_mm"], list(zip(*((t, *row[1:]) for t, row in zip([t for t in T for _ in (1, 2)], rows))))),
             left_out={"repeated_time": COUNT}, says="the column 'id' (values 1, 2) separates them"),
        File("id_runs.csv", "two runs one after the other, with the number of the run in a column id", table(
            ["time_s", "id", "set_kpa", "tip_mm"], [T * 2, [1] * COUNT + [2] * COUNT, COMMAND * 2, TIP * 2]),
             refused="the time goes back"),
        File("finger_readings.csv", "readings in a column called finger", readings, "--displacement finger --unit displacement=mm"),
        File("two_steps.lvm", "a LabVIEW measurement without X columns, with 2 rates", one_x.replace("0,01\t0,01", "0,01\t0,02"),
             refused="the channels share one X column, but differ in Delta_X: 0,01 and 0,02"),
        File("two_starts.lvm", "a LabVIEW measurement without X columns; the recording was started twice", one_x.replace("50,938\t\n", "51,138\t\n"),
             refused="the channels share one X column, but begin 0.2 s apart"),
        File("own_times.lvm", "a LabVIEW measurement with an X column per channel, with different starts, rates and lengths", own_x,
             columns=late, joined=149, left_out={"empty": 151}, says="channel 2 begins 0.02 s after the first"),
        File("two_lengths.tdms", "LabVIEW TDMS: groups with separate times", tdms.file([
            tdms.segment("valve", fast), tdms.segment("laser", slow)]), refused="'laser/tip' is skipped: 150 values, but other arrays have 300"),
        File("seconds_and_rest.csv", "seconds and nanoseconds in two columns", table(
            ["stamp_sec", "stamp_nsec", "set_kpa", "tip_mm"], [*stamp, COMMAND, TIP]), tolerance=1e-6,
             says="'stamp_sec' and 'stamp_nsec' are combined into one time"),
        File("header_stamp.csv", "the time of a ROS header, nanoseconds first", table(
            ["header.stamp.nanosec", "header.stamp.sec", "set_kpa", "tip_mm"], [*stamp[::-1], COMMAND, TIP]), tolerance=1e-6,
             says="'header.stamp.sec' and 'header.stamp.nanosec' are combined into one time"),
        File("secs_nsecs.csv", "seconds and nanoseconds, columns selected by number", table(
            ["secs", "nsecs", "p", "y"], [*stamp, COMMAND, TIP]),
             "--time 1 --command 3 --unit command=kPa --displacement 4 --unit displacement=mm", tolerance=1e-6),
        File("no_rest.csv", "nanoseconds that count the whole time, in addition to seconds", table(
            ["stamp_sec", "stamp_nsec", "set_kpa", "tip_mm"], [stamp[0], [10**10 + round(1e9 * t) for t in T], COMMAND, TIP]),
             refused="the times of the columns 'stamp_sec', 'stamp_nsec' differ"),
        *signals(stamp),
        File("place_of_no_time.csv", "a clock of whole seconds in the column before the time", table(
            ["board_s", "set_kpa", "tip_mm", "log_time_s"], [[7000 + 2 * int(50 * t) / 100 for t in T], COMMAND, TIP, T]),
             refused="the times of the columns 'board_s', 'log_time_s' differ"),
    ]


def signals(stamp):
    """Returns MCAP files that have a separate topic for each signal."""
    units = "--unit command=kPa --unit displacement=mm"

    def of(name, values, late_s=0.0, every=1):
        return [(name, t + late_s, {"data": value}) for t, value in list(zip(T, values))[::every]]

    def stamped(name, key, values, late_s=0.0, begin=0):
        # The time at which a message was logged is later than the time stamp inside the message.
        return [(name, t + late_s, {"header": {"stamp": {"sec": sec - begin, "nanosec": rest}}, key: value})
                for t, sec, rest, value in zip(T, *stamp, values)]
    half = {"time_s": sorted([*T, *(round(t + 0.002, 6) for t in T[::2])])}
    when = {t: (c, None) for t, c in zip(T, COMMAND)} | {round(t + 0.002, 6): (c, tip) for t, c, tip in list(zip(T, COMMAND, TIP))[::2]}
    half |= {"pressure_command_kpa": [when[t][0] for t in half["time_s"]],
             "displacement_mm": [math.nan if when[t][1] is None else when[t][1] for t in half["time_s"]]}
    fingers = [message for side, share in (("left", 1), ("right", 0.5)) for key, values in (("set_kpa", COMMAND), ("tip_mm", TIP))
               for message in of(f"/{side}/{key}", [share * value for value in values])]
    both = stamped("/valve", "set_kpa", COMMAND, 0.003) + stamped("/laser", "tip_mm", TIP, 0.02)
    return [
        File("signals.mcap", "MCAP: a topic per signal, at the same times", mcap(of("/command", COMMAND) + of("/displacement", TIP)), units,
             joined=COUNT, says="the messages of 2 topics are merged by log_time"),
        File("signals_half.mcap", "MCAP: a topic per signal with separate times, and another message", mcap(
            of("/command", COMMAND) + of("/displacement", TIP, 0.002, 2) + of("/room", [20.5] * 3)), units, columns=half,
             left_out={"empty": 3}, says="unused columns: 'room'"),
        File("signals_stamped.mcap", "MCAP: a topic per signal, with time stamps of ROS", mcap(both), joined=COUNT, tolerance=1e-6,
             says="the messages of 2 topics are merged by 'header.stamp.sec'"),
        File("signals_apart.mcap", "MCAP: a topic per signal, with a sensor clock that counts from its start", mcap(
            stamped("/valve", "set_kpa", COMMAND) + stamped("/laser", "tip_mm", TIP, begin=1717156000)),
             refused="of the topics 'laser' and 'valve' come from two clocks. Relative to log_time, these times differ by 1.717e+09 s"),
        File("signals_back.mcap", "MCAP: a topic per signal, with a clock that steps back", mcap(
            stamped("/valve", "set_kpa", COMMAND)[100:] + [(name, t + 10, content) for name, t, content in both[:100]]
            + stamped("/laser", "tip_mm", TIP)), refused="the time goes back"),
        File("signals_fingers.mcap", "MCAP: a topic per signal of two fingers", mcap(fingers), refused="the columns belong to 2 fingers: 'left', 'right'"),
        File("signals_left.mcap", "MCAP: a topic per signal of two fingers, one finger selected", mcap(fingers), "--channel left", joined=COUNT, left_out={"empty": 2 * COUNT}),
        File("signals_nobody.mcap", "MCAP: a topic per signal of two fingers, and the option --channel with a name that no finger has", mcap(fingers), "--channel middle",
             refused="no finger has the name 'middle'"),
    ]


def files():
    hole = set(range(100, 200))
    slow = [tip if i % 5 == 0 else None for i, tip in enumerate(TIP)]
    coded = [999 if i in (0, 77, 201) else tip for i, tip in enumerate(TIP)]
    other = [[round(0.5 * value, 6) for value in values] for values in (COMMAND, TIP)]
    fingers = table(["t (s)", "P_left (kPa)", "P_right (kPa)", "tip_right (mm)", "tip_left (mm)"],
                    [T, other[0], COMMAND, TIP, other[1]])
    right = {"time_s": T, "pressure_command_kpa": COMMAND, "pressure_kpa": COMMAND, "displacement_mm": TIP}
    held = [COMMAND[10 * (i // 10)] for i in range(COUNT)]
    pairs = list(zip(T, COMMAND, TIP))
    broken_bar = [None if i == 50 else value for i, value in enumerate(COMMAND)]
    return [
        File("names_psi.csv", "names that differ from the names in a log, pressures in psi, units in brackets",
             table(["Time (s)", "P set [psi]", "P meas [psi]", "Tip [mm]"], [T, scaled(COMMAND, PSI),
                                                                             scaled(PRESSURE, PSI), TIP]),
             columns=MEASURED),
        File("bar_semicolon.csv", "pressures in bar, a displacement in cm, columns separated by semicolons",
             table(["t_s", "Sollwert_bar", "Weg_cm"], [T, scaled(COMMAND, BAR), scaled(TIP, 10)], ";")),
        File("volts.csv", "a laser sensor and a regulator in V, with scale factors",
             table(["time_ms", "valve_V", "laser_V"], [[round(1000 * t) for t in T], scaled(COMMAND, 25),
                                                       [round(2 + tip / 2.5, 12) for tip in TIP]]),
             "--scale command=25 --scale displacement=2.5 --zero displacement=2"),
        File("volts_unsaid.csv", "a displacement in V without a scale factor", table(["time_s", "set_kpa", "laser_V"], [T, COMMAND, TIP]),
             refused="'V' is not a unit of displacement"),
        File("unit_unsaid.csv", "a column without a unit", table(["time_s", "set_kpa", "tip"], [T, COMMAND, TIP]),
             refused="'tip' has no unit"),
        File("unit_said.csv", "a column without a unit, with the unit as an option",
             table(["time_s", "set_kpa", "tip"], [T, COMMAND, TIP]), "--unit displacement=mm"),
        File("milliseconds_tabs.tsv", "times in milliseconds, columns separated by tabs",
             table(["Time ms", "Setpoint kPa", "Position mm"], [[round(1000 * t) for t in T], COMMAND, TIP], "\t")),
        File("savetxt.txt", "columns separated by blanks, with the names in a comment (numpy.savetxt)",
             "# bench 3\n# t_s p_cmd_kpa tip_mm\n" + table([], [T, COMMAND, TIP], " ")),
        File("comments.csv", "comment lines before and between the rows",
             "% run 7\n// by hand\n" + PLAIN.replace("\n0.5,", "\n# touched the table here\n0.5,")),
        File("units_row.csv", "a row of units below the names",
             table(["Time", "Set", "Actual", "Tip"], [[round(1000 * t) for t in T], scaled(COMMAND, 0.1),
                                                      scaled(PRESSURE, 0.1), scaled(TIP, 1e-3)], ";",
                   units=["ms", "mbar", "mbar", "µm"]), "--pressure Actual --command Set", columns=MEASURED),
        File("missing.csv", "NaN, NA, empty cells and -999 for missing readings",
             table(["time_s", "set_kpa", "tip_mm"],
                   [T, COMMAND, [{7: "NaN", 8: "NA", 9: None, 10: "-999"}.get(i, tip) for i, tip in enumerate(TIP)]]),
             "--missing -999",
             columns={key: TRUTH[key] for key in BASIC} | {
                 "displacement_mm": [math.nan if i in (7, 8, 9, 10) else tip for i, tip in enumerate(TIP)]}),
        File("epoch.csv", "seconds since 1970", table(["timestamp", "cmd_kpa", "x_mm"],
                                                      [[f"{EPOCH + t:.2f}" for t in T], COMMAND, TIP])),
        File("epoch_ms.csv", "milliseconds since 1970, no unit",
             table(["timestamp", "cmd_kpa", "x_mm"], [[1000 * EPOCH + round(1000 * t) for t in T], COMMAND, TIP])),
        File("dates.csv", "dates with time of day (ISO 8601)",
             table(["date", "cmd_kpa", "x_mm"], [times("2024-05-31T11:59:59", "%Y-%m-%dT%H:%M:%S.%f"), COMMAND, TIP])),
        File("midnight.csv", "times of day across midnight",
             table(["Uhrzeit", "Soll (kPa)", "Weg (mm)"], [times("2024-05-31T23:59:58", "%H:%M:%S.%f"), COMMAND, TIP],
                   ";")),
        File("decimal_comma.csv", "decimal commas between semicolons",
             table(["Zeit [s]", "Soll [bar]", "Weg [mm]"], [T, scaled(COMMAND, BAR), TIP], ";", ",")),
        File("quoted_comma.csv", "decimal commas in quotes between commas",
             table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, TIP], ",", ",", quote=True)),
        File("bare_comma.csv", "decimal commas between commas, not quoted",
             "time_s,set_kpa,tip_mm\n" + "".join(f"{t:.2f},{c:.3f},{y:.4f}\n".replace(".", ",")
                                                 for t, c, y in zip(T, COMMAND, TIP)),
             refused="3 column names above 6 columns"),
        File("mixed_decimals.csv", "decimal points and decimal commas in one file",
             changed(table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, TIP], ";"), 90, ".", ","),
             refused="decimal comma and numbers with a decimal point"),
        File("bom_crlf.csv", "byte order mark, quotes, Windows line ends",
             "\ufeff" + table(["Time, s", "Command, kPa", "Tip, mm"], [T, COMMAND, TIP], quote=True, end="\r\n")),
        File("utf16.txt", "UTF-16 with tabs (Excel's \"Unicode text\")",
             table(["Time (s)", "Set (kPa)", "Tip (mm)"], [T, COMMAND, TIP], "\t", end="\r\n").encode("utf-16")),
        File("latin1.csv", "Latin-1: µm, °C",
             table(["t (s)", "p_set (kPa)", "tip (µm)", "temp (°C)"], [T, COMMAND, scaled(TIP, 1e-3), WARM],
                   ";").encode("latin-1"),
             columns={key: TRUTH[key] for key in (*BASIC, "temperature_c")}),
        File("preamble.lvm", "lines above the names (LabVIEW)",
             PREAMBLE + table(["X_Value (s)", "Set (psi)", "Tip (in)"],
                              [T, scaled(COMMAND, PSI), scaled(TIP, 25.4)], "\t"),
             "--time 'X_Value (s)' --command 'Set (psi)' --displacement 'Tip (in)'"),
        File("fixed_width.txt", "columns separated by blanks, names with blanks",
             "Time s      Set kPa     Tip mm\n" + "".join(f"{t:<12.2f}{c:<12.6f}{y:.6f}\n"
                                                      for t, c, y in zip(T, COMMAND, TIP))),
        File("no_names.csv", "a file without names, with columns selected by number", table([], [T, COMMAND, TIP]),
             "--time 1 --command 2 --displacement 3 --unit time=s --unit command=kPa --unit displacement=mm"),
        File("no_time.csv", "a file without times, with the rate as an option", table(["set_kpa", "tip_mm"], [COMMAND, TIP]), "--rate-hz 100"),
        File("no_displacement.csv", "a file without a displacement", table(["time_s", "set_kpa"], [T, COMMAND]),
             refused="no column looks like a displacement"),
        File("pressure_alone.csv", "a measured pressure without a command", table(["time_s", "pressure_kpa", "tip_mm"],
                                                                    [T, PRESSURE, TIP]),
             columns=ALONE, says="the measured pressure is used instead"),
        File("two_chambers.csv", "two chambers, averaged",
             table(["time_s", "pd1_psi", "pd2_psi", "tip_mm"],
                   [T, scaled(COMMAND, PSI / 0.9), scaled(COMMAND, PSI / 1.1), TIP]),
             "--command pd1_psi --command pd2_psi"),
        File("slow_sensor.csv", "a slow sensor, which has a reading in every fifth row",
             table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, slow]),
             columns={key: TRUTH[key] for key in BASIC} | {
                 "displacement_mm": [math.nan if tip is None else tip for tip in slow]},
             says="of the samples have no reading"),
        File("command_gap.csv", "one missing commanded pressure",
             table(["time_s", "set_kpa", "tip_mm"], [T, broken_bar, TIP]),
             columns={key: TRUTH[key] for key in BASIC} | {"pressure_command_kpa": [
                 COMMAND[49] if i == 50 else value for i, value in enumerate(COMMAND)]},
             says="the command of the previous sample is used"),
        File("duplicates.csv", "rows that occur twice",
             PLAIN.replace("\n1.5,", "\n1.49,61,99\n1.5,"), says="1 sample with the time of the previous sample (left out)",
             left_out={"repeated_time": 1}),
        File("hole.csv", "a gap without samples, in which the command changed",
             table(["time_s", "set_kpa", "tip_mm"], dropped([T, COMMAND, TIP], set(range(80, 150)))),
             columns={key: without(set(range(150)))[key] for key in BASIC}, says="the longest segment is kept",
             left_out={"hole": 80}),
        File("stretch.csv", "a file of which only a part is imported", PLAIN, "--from-s 1 --to-s 1.99",
             columns={key: without(set(range(100)) | set(range(200, 300)))[key] for key in BASIC},
             left_out={"outside_stretch": 200}),
        File("two_runs.csv", "two runs in one file", PLAIN + table([], [T, COMMAND, TIP]), refused="the time goes back"),
        File("cut_off.csv", "the last line is cut off", PLAIN[:-12],
             columns={key: TRUTH[key][:-1] for key in BASIC}, says="the last line is cut off and left out",
             left_out={"cut_off_line": 1}),
        File("cut_number.csv", "the last number is cut off",
             table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, [f"{tip:.6f}" for tip in TIP]])[:-5],
             columns=BASIC_OF | {"displacement_mm": [*TIP[:-1], int(1e2 * TIP[-1]) / 1e2]},
             says="line 301: the last row may be cut off"),
        File("ragged.csv", "a row with one cell too many", changed(PLAIN, 120, ",", ",,"),
             refused="4 cells, but the rows above have 3"),
        File("word.csv", "a word among the numbers", changed(PLAIN, 77, "0.75,", "0.75x,"),
             refused="'0.75x' is not a number"),
        File("upside_down.csv", "a sensor that is mounted in reverse", table(["time_s", "set_kpa", "tip_mm"],
                                                                            [T, COMMAND, [-y for y in TIP]]),
             columns={key: TRUTH[key] for key in BASIC} | {"displacement_mm": [-y for y in TIP]},
             says="the reading decreases when the pressure increases"),
        File("wrong_unit.csv", "a measured pressure in psi, in a column that is labelled kPa",
             table(["time_s", "set_kpa", "actual_pressure_kpa", "tip_mm"], [T, COMMAND, scaled(PRESSURE, PSI), TIP]),
             columns=MEASURED | {"pressure_kpa": scaled(PRESSURE, PSI)}, says="which is the conversion factor between psi and kPa"),
        File("packed.csv.gz", "a text file that is compressed by gzip", gzip.compress(PLAIN.encode(), mtime=0)),
        File("packed_cut.csv.gz", "a text file that is compressed by gzip and whose end is missing", gzip.compress(PLAIN.encode(), mtime=0)[:-300],
             refused="the gzip file is cut off"),
        File("vectors.mat", "MATLAB 5: vectors",
             matlab_5(matrix("time_s", T), matrix("p_cmd_psi", scaled(COMMAND, PSI)), matrix("tip_mm", TIP))),
        File("structure.mat", "MATLAB 7: a structure, compressed",
             matlab_5(packed(structure("run", {"t_ms": [1000 * t for t in T], "p_set_kPa": COMMAND,
                                               "p_meas_kPa": PRESSURE, "tip_mm": TIP}))), columns=MEASURED),
        File("dspace.mat", "MATLAB 5: structures with Name, Data and Unit (dSPACE)", dspace()),
        File("late_signal.mat", "MATLAB 5: structures with Name and Data, one of them with a time of its own", late_signal(),
             columns={"time_s": [i / 100 for i in range(COUNT + 50)], "pressure_command_kpa": COMMAND + 50 * COMMAND[-1:],
                      "displacement_mm": 50 * [math.nan] + TIP}, joined=COUNT - 50),
        File("small_arrays.mat", "MATLAB 5: vectors, and two matrices with 3 rows", matlab_5(
            *map(matrix, ("time_s", "set_kPa", "tip_mm"), (T, COMMAND, TIP)), *(headed(
                6, (3, 3), name, element(9, struct.pack("<9d", *range(9)))) for name in ("R1", "R2"))),
             says="'R1(:,1)' is skipped: 3 values, but other arrays have 300"),
        File("trials.mat", "MATLAB 5: an array of structures", trials(), refused="belong to 3 fingers: '1', '2', '3'"),
        File("trials_chosen.mat", "MATLAB 5: one structure of an array", trials(), "--channel 2"),
        File("cells.mat", "MATLAB 5: a cell array", matlab_5(cells("log", [matrix("", T), matrix("", COMMAND),
                                                                        matrix("", TIP)])),
             "--time 1 --command 2 --displacement 3 --unit time=s --unit command=kPa --unit displacement=mm"),
        File("one_section.lvm", "a LabVIEW measurement", lvm("One", 1)),
        File("sections.lvm", "a LabVIEW measurement in 3 sections", lvm("One", 3),
             says="the section begins one sample interval after the end of the previous section"),
        File("counted.lvm", "a LabVIEW measurement without X columns", lvm("No", 1)),
        File("old.mat", "MATLAB 4", matlab_4("time_s", T) + matlab_4("set_bar", scaled(COMMAND, BAR))
             + matlab_4("tip_mm", TIP)),
        File("v73.mat", "MATLAB 7.3, with 5 empty arrays", matlab_73, "--unit time=s", columns=MEASURED,
             says="'offset' is skipped: empty"),
        File("cut_off.mat", "MATLAB 5, with a missing end", matlab_5(matrix("time_s", T))[:-900],
             refused="it is cut off or damaged in the variable 'time_s'"),
        *damaged_matlab(),
        File("groups.h5", "HDF5: groups, compressed, units as attributes", hdf5_datasets, columns=MEASURED),
        File("packed.nc", "HDF5: packed integers with scale_factor, add_offset and _FillValue (netCDF)", hdf5_packed,
             columns=BASIC_OF | {"displacement_mm": [math.nan if i in (50, 51) else value * 0.0005 + 5 for i, value in enumerate(PACKED)]},
             says="'tip': the stored values are multiplied by 0.0005 (scale_factor), and 5 is added (add_offset); 2 stored values of "
                  "-32767 count as missing (_FillValue)"),
        File("single.h5", "HDF5: readings of 32 bits with a _FillValue of 64 bits", hdf5_single, tolerance=1e-6,
             columns=BASIC_OF | {"displacement_mm": [math.nan if i in (50, 51) else tip for i, tip in enumerate(TIP)]},
             says="'tip': 2 stored values of -99.0999985 count as missing (_FillValue)"),
        File("compound.h5", "HDF5: a table of compounds, with a text and an array in each row", hdf5_compound,
             says="'log.state' is skipped: no numbers; 'log.xyz' is skipped: an array in each row"),
        File("counter_16_bit.csv", "milliseconds of a 16-bit counter",
             table(["t_ms", "set_kpa", "tip_mm"], [[(64000 + round(1000 * t)) % 65536 for t in T], COMMAND, TIP]),
             says="the clock overflows at 65536, 1 time"),
        File("counter_32_bit.csv", "microseconds of a 32-bit counter",
             table(["t_us", "set_kpa", "tip_mm"],
                   [[(2 ** 32 - 500000 + round(1e6 * t)) % 2 ** 32 for t in T], COMMAND, TIP]),
             says="the clock overflows at 4294967296, 1 time"),
        File("seconds_of_the_day.csv", "seconds of the day across midnight",
             table(["time_s", "set_kpa", "tip_mm"], [[f"{(86399 + t) % 86400:.2f}" for t in T], COMMAND, TIP]),
             says="the clock overflows at 86400, 1 time"),
        File("clock_set.csv", "a clock that was set back by 0.3 s",
             table(["time_s", "set_kpa", "tip_mm"], [[t if t < 1 else round(t - 0.3, 6) for t in T], COMMAND, TIP]),
             refused="clock_set.csv:102:1: the time goes back"),
        File("below_the_first.csv", "a clock that falls below its first value",
             table(["time_s", "set_kpa", "tip_mm"], [[50 + t if t < 1 else t for t in T], COMMAND, TIP]),
             refused="below_the_first.csv:102:1: the time goes back"),
        File("minutes.csv", "minutes and seconds across the hour",
             table(["Time", "set_kpa", "tip_mm"], [times("2024-05-31T11:59:58", "%M:%S.%f"), COMMAND, TIP])),
        File("two_fields.csv", "times that can be hours and minutes, or minutes and seconds",
             table(["Time", "set_kpa", "tip_mm"], [[f"{i // 60:02}:{i % 60:02}" for i in range(COUNT)], COMMAND, TIP]),
             refused="'Time' contains times that can be hours and minutes, or minutes and seconds"),
        File("two_fields_said.csv", "minutes and seconds, with the unit as an option",
             table(["Time", "set_kpa", "tip_mm"], [[f"{i // 60:02}:{i % 60:02}" for i in range(COUNT)], COMMAND, TIP]),
             "--unit time=mm:ss", columns={key: TRUTH[key] for key in BASIC} | {"time_s": list(range(COUNT))}),
        File("half_days.csv", "times of day with AM and PM, across noon",
             table(["Time", "set_kpa", "tip_mm"],
                   [[text[:12] + (" AM" if text < "12" else " PM")
                     for text in times("2024-05-31T11:59:58", "%H:%M:%S.%f")], COMMAND, TIP])),
        File("milliseconds_behind_a_colon.csv", "HH:MM:SS:mmm",
             table(["Time", "set_kpa", "tip_mm"],
                   [[text[:8] + ":" + text[9:] for text in times("2024-05-31T12:59:58", "%H:%M:%S.%f")], COMMAND, TIP])),
        File("named_months.csv", "dates with names of months",
             table(["Date", "set_kpa", "tip_mm"], [times("2024-05-31T23:59:58", "%d-%b-%Y %H:%M:%S.%f"), COMMAND, TIP],
                   ";")),
        File("coarse_times.csv", "time stamps with a resolution of 50 ms in a log of 100 Hz",
             table(["time_s", "set_kpa", "tip_mm"], [[round(0.05 * (i // 5), 6) for i in range(COUNT)], COMMAND, TIP]),
             columns={key: TRUTH[key][::5] for key in BASIC}, says="--rate-hz 100 instead of --time keeps every row",
             left_out={"repeated_time": 240}),
        File("coarser_times.csv", "time stamps with a resolution of 1 s in a log of 100 Hz",
             table(["time_s", "set_kpa", "tip_mm"], [[i // 100 for i in range(COUNT)], COMMAND, TIP]),
             refused="too few rows can be used: 300 rows: 3 used, 297 left out (297 with the time of the previous row)"),
        File("rows_of_commands.csv", "commanded pressures in separate rows",
             table(["time_s", "set_kpa", "tip_mm"],
                   [T, [value if i % 10 == 0 else None for i, value in enumerate(COMMAND)],
                    [None if i % 10 == 0 else tip for i, tip in enumerate(TIP)]]),
             columns={"time_s": T, "pressure_command_kpa": held, "displacement_mm": [
                 math.nan if i % 10 == 0 else tip for i, tip in enumerate(TIP)]}, says="the command of the previous sample is used"),
        File("rows_at_one_time.csv", "the command and the reading of one time in two rows",
             "time_s,set_kpa,tip_mm\n" + "".join(f"{t!r},{c!r},\n{t!r},,{y!r}\n" for t, c, y in pairs), joined=300),
        File("two_times.csv", "separate times of the command and of the reading",
             table(["t_cmd (s)", "set (kPa)", "t_tip (s)", "tip (mm)"],
                   [T[::10] + [None] * 270, COMMAND[::10] + [None] * 270, T, TIP]),
             columns=BASIC_OF | {"pressure_command_kpa": held}, says="each row has 2 times", left_out={"empty": 270}, joined=30),
        File("two_times_unclear.csv", "two times that differ, without names that show to which signal they belong",
             table(["time_a_s", "time_b_s", "set_kpa", "tip_mm"], [T, [round(0.5 * t, 6) for t in T], COMMAND, TIP]),
             refused="the times of the columns 'time_a_s', 'time_b_s' differ"),
        File("two_times_chosen.csv", "two times that differ, one of them selected by an option",
             table(["time_a_s", "time_b_s", "set_kpa", "tip_mm"], [T, [round(0.5 * t, 6) for t in T], COMMAND, TIP]),
             "--time time_a_s", says="the column 'time_b_s' looks like a time and is not used, because its times differ"),
        File("fingers.csv", "columns of two fingers", fingers, refused="the columns belong to 2 fingers: 'left', 'right'"),
        File("fingers_right.csv", "columns of two fingers, one finger selected", fingers, "--channel right", columns=right,
             says="unused columns: 'P_left (kPa)', 'tip_left (mm)'"),
        File("fingers_none.csv", "columns of two fingers, and the option --channel with a name that no finger has", fingers, "--channel thumb",
             refused="no finger has the name 'thumb': the columns belong to 'left', 'right'"),
        File("finger_alone.csv", "the option --channel for a file of one finger", PLAIN, "--channel thumb",
             refused="--channel 'thumb': the file has no column 'channel'"),
        File("codes.csv", "999 for missing readings", table(["time_s", "set_kpa", "tip_mm"], [T, COMMAND, coded]),
             columns=BASIC_OF | {"displacement_mm": [math.nan if v == 999 else v for v in coded]},
             says="3 cells of 'tip_mm' with 999, far from all other values, count as missing"),
        File("nul_tail.csv", "NUL bytes after the last line", PLAIN.encode() + bytes(512),
             says="512 NUL bytes at the end of the file are left out"),
        File("extra_separator.csv", "a separator at the end of each row of numbers", PLAIN.replace("\n", ",\n").replace(
            "tip_mm,\n", "tip_mm\n")),
        File("bad_lines.csv", "a row with a word and a row with one cell too many, both skipped",
             changed(changed(PLAIN, 120, ",", ",,"), 77, "0.75,", "0.75x,"), "--skip-bad-lines",
             columns={key: values for key, values in without({75, 118}).items() if key in BASIC}, says="--skip-bad-lines leaves out 1 line with too few or too many cells, in line 120",
             left_out={"bad_line": 2}),
        File("idle_options.csv", "options without an effect", PLAIN,
             "--missing 888 --unit supply=bar --to-s 100", says="--missing 888 has no effect"),
        File("months_first.csv", "dates with the month first",
             table(["Timestamp", "set_kpa", "tip_mm"], [times("2024-05-31T12:00:00", "%m/%d/%Y %H:%M:%S.%f"), COMMAND, TIP]),
             refused="'Timestamp' has '05/31/2024 12:00:00.000', which is in an unknown format"),
        File("fingers_a_b.csv", "fingers A and B", table(
            ["t_s", "Finger A set (kPa)", "Finger A tip (mm)", "Finger B set (kPa)", "Finger B tip (mm)"],
            [T, *other, COMMAND, TIP]), "--channel B"),
        File("angle.csv", "a bending angle in degrees", table(["time_s", "set_kpa", "tip (deg)"], [T, COMMAND, TIP]), columns=BENT),
        File("angle_sign.csv", "a bending angle with the sign of degrees", table(
            ["time_s", "set_kpa", "bend [\u00b0]"], [T, COMMAND, TIP]), columns=BENT),
        File("angle_rad.csv", "a bending angle in radians", table(
            ["time_s", "set_kpa", "theta_rad"], [T, COMMAND, scaled(TIP, math.degrees(1), 15)]), columns=BENT),
        File("angle_volts.csv", "a bend sensor with 18 degrees per volt", table(
            ["time_s", "set_kpa", "flex_V"], [T, COMMAND, scaled(TIP, 18)]),
             "--displacement flex_V --scale displacement=18 --unit displacement=deg", columns=BENT),
        File("angle_beside.csv", "the displacement of a tip in mm, and a bending angle", table(
            ["time_s", "set_kpa", "angle (deg)", "tip (mm)"], [T, COMMAND, scaled(TIP, 0.3), TIP]),
             says="unused columns: 'angle (deg)'"),
        File("angle_gon.csv", "an unknown unit of angles", table(
            ["time_s", "set_kpa", "angle (gon)"], [T, COMMAND, TIP]), refused="'gon' is not a unit of displacement"),
        File("angle_scaled.csv", "a bending angle in degrees, converted to the path of a tip 45 mm from the bend",
             table(["time_s", "set_kpa", "tip (deg)"], [T, COMMAND, scaled(TIP, math.radians(45))]),
             f"--scale displacement={math.radians(45)!r}"),
        File("recording", "a recording of softgripd, one channel selected", recording, "--channel left",
             columns=MEASURED, left_out={"other_channel": 300}),
        File("recording_both", "a recording of softgripd, no channel selected", recording, refused="2 channels"),
        File("run.mcap", "a recording exported as MCAP, one channel selected", exported(bytes), "--channel left",
             columns=MEASURED, says="unused columns: 'state'", left_out={"other_channel": 300}),
        File("both.mcap", "a recording exported as MCAP, no channel selected", exported(bytes), refused="2 channels: 'left', 'right'"),
        File("cut_off.mcap", "a recording exported as MCAP, with a missing end", exported(lambda whole: whole[:whole.index(b'"time_s":2.0') - 40]),
             "--channel left", columns={key: TRUTH[key][:201] for key in MEASURED}, says="the file is cut off: its last",
             left_out={"other_channel": 200, "cut_off_line": 1}),
        File("changed.mcap", "a recording exported as MCAP, with a changed byte",
             exported(lambda whole: whole.replace(b'"time_s":1.5,', b'"time_s":2.5,', 1)), "--channel left", refused="a chunk does not match its checksum"),
        *clocks_and_cells(),
        *spreadsheets(),
        *measurements(),
        *reports(),
        File("noise.bin", "random bytes", bytes((i * i * 31 + 7 * i) % 251 for i in range(3000)),
             refused="this file is not a text file, and its format is not known"),
    ]


def read_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    names = [name for name in (rows[0] if rows else {}) if name in TRUTH or name == "angle_deg"]
    return {name: [float(row[name]) if row[name] else math.nan for row in rows] for name in names}


def furthest(got, wanted):
    """Returns the largest relative difference between a log and the original signals. If no difference can be computed,
    returns the reason."""
    if set(got) != set(wanted):
        return math.inf, f"columns {sorted(got)} instead of {sorted(wanted)}"
    worst = 0.0
    for name, values in wanted.items():
        if len(got[name]) != len(values):
            return math.inf, f"{name}: {len(got[name])} values instead of {len(values)}"
        size = max(1.0, max(abs(v) for v in values if not math.isnan(v)))
        for a, b in zip(got[name], values):
            if math.isnan(a) != math.isnan(b):
                return math.inf, f"{name}: a value where there is none, or none where there is one"
            if not math.isnan(a):
                worst = max(worst, abs(a - b) / size)
    return worst, ""


def outcome(file, folder):
    """Imports one file. Returns (wrong, what, rest); `wrong` is empty if the result is the required one."""
    path = file.make(folder)
    out = folder / "out" / (file.name + ".csv")
    done = subprocess.run([BUILD / "tools/softgrip", "import", path, *shlex.split(file.options), "--yes", "--json",
                           "--out", out], capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
    said = done.stderr.replace(f"{folder}/", "")
    if file.refused:
        reason = next((line for line in said.splitlines() if file.refused in line), "")
        wrong = "" if done.returncode == 3 and reason and not out.exists() else f"not refused so: {said or 'written'}"
        return wrong, "refused", reason
    if done.returncode != 0:
        return f"exit code {done.returncode}: {said}", "refused", ""
    told = json.loads(done.stdout)["logs"][0]
    remarks = "; ".join(told["warnings"] + told["notes"] +
                        ["warning: " + warning for warning in told["plausibility_warnings"]])
    if told["doubts"] != told["plausibility_warnings"]:
        return "the deprecated key doubts differs from plausibility_warnings", "values", remarks
    rows = told["rows"]
    if rows["file"] != rows["used"] + rows["joined"] + sum(rows["left_out"].values()) or rows["used"] != told["samples"]:
        return f"{rows} does not account for every row", "values", remarks
    if {key: rows[key] for key in file.account} != file.account:
        return f"{rows} where {file.account} is expected", "values", remarks
    worst, why = furthest(read_csv(out), file.columns)
    if why or worst > file.tolerance:
        return why or f"off by {worst:.2g}", "values", remarks
    if file.says and file.says not in remarks:
        return f"does not say '{file.says}': {remarks}", "values", remarks
    return "", f"{told['samples']} samples, with the values of the file", remarks


HEAD = """# External files

This page shows how `softgrip import` converts external files in many formats. The following script writes the page:

```
$ tests/system/foreign_files.py --page
```

The script writes every file of the table, imports the file, and compares each imported value with the written value. The
result "with the values of the file" means that each imported value deviates from the written value by at most 1e-9 of the largest value
in the column. The result "refused" means that the import states the reason and writes no output. If the column "options"
of the table is empty, the import used the columns that `import --yes` proposes from names and units. The test
`system.test_import` repeats all imports and compares their results with this page. [How to import](../how-to/import.md)
contains the rules of the import.

| file | content | options | result | messages |
|---|---|---|---|---|
"""


def page(results):
    rows = []
    for file, (wrong, what, rest) in results:
        cells = [f"`{file.name}`", file.about, f"`{file.options}`" if file.options else "",
                 f"**WRONG** {wrong.splitlines()[0][:80]}" if wrong else what, rest.replace("|", "\\|")]
        rows.append("| " + " | ".join(cells) + " |")
    refused = sum(what == "refused" for _, (_, what, _) in results)
    return (HEAD + "\n".join(rows)
            + f"\n\n{len(results)} files: {len(results) - refused} imported, {refused} refused with the reason.\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--page", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    parser.add_argument("--keep", type=pathlib.Path, help="write the files into this folder and keep them")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.keep or pathlib.Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        results = [(file, outcome(file, folder)) for file in files()]
    for file, (wrong, what, rest) in results:
        print(f"{file.name:24} {'WRONG ' + wrong if wrong else what + ('' if not rest else ': ' + rest)}")
    if options.page:
        PAGE.write_text(page(results))
    return 6 if any(wrong for _, (wrong, _, _) in results) else 0


if __name__ == "__main__":
    sys.exit(main())
