"""Reads recordings and reports of softgrip as NumPy arrays."""

from __future__ import annotations

import csv
import dataclasses
import errno
import io
import json
import os
import pathlib
import stat
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .arguments import Path, file_path_of
from .errors import MalformedFile

Array = npt.NDArray[Any]


LARGEST_CSV = 512 << 20  # largest size of a CSV file [bytes], as in the softgrip commands
LARGEST_JSON = 64 << 20


def _check(about: os.stat_result, path: Path, largest: int) -> None:
    if not stat.S_ISREG(about.st_mode):
        raise OSError(errno.EINVAL, "not a regular file", os.fspath(path))
    if about.st_size > largest:
        raise OSError(errno.EFBIG, f"larger than {largest} bytes", os.fspath(path))


def _text(path: Path, largest: int) -> str:
    """Returns the text of a regular file. Raises OSError for a device, for a pipe (because reading could block) and for
    a file that is too large."""
    path = file_path_of("path", path)
    _check(os.stat(path), path, largest)  # check the type first: opening alone starts some devices
    with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC), "rb") as file:
        _check(os.fstat(file.fileno()), path, largest)  # another process may have replaced the file since the first check
        data = file.read(largest)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MalformedFile(f"{path}: the file is not text in UTF-8: {error}") from error


def _json_object(path: Path) -> dict[str, Any]:
    text = _text(path, LARGEST_JSON)
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MalformedFile(f"{path}: the file is not JSON: {error}") from error
    if not isinstance(value, dict):
        raise MalformedFile(f"{path}: the file is not a JSON object")
    return value


def _column(name: str, cells: list[str]) -> Array:
    """Returns an array of numbers if every cell is a number or empty (NaN). Otherwise, returns an array of texts. The names
    of fingers are texts, because a name may consist of digits."""
    if name == "channel":
        return np.array(cells)
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def read_columns(path: Path) -> dict[str, Array]:
    """Reads a CSV file with a header (run.csv, a log, a series.csv) as one array per column. An incomplete last line is
    ignored, because a program that was killed can leave such a line. Any other malformed line raises MalformedFile with
    the line number."""
    text = _text(path, LARGEST_CSV)
    rows = csv.reader(io.StringIO(text[:text.rfind("\n") + 1], newline=""))
    kept: list[list[str]] = []
    try:
        for row in rows:
            kept.append(row)
            if len(row) != len(kept[0]):
                raise MalformedFile(f"{path}:{rows.line_num}: {len(row)} cells, the header has {len(kept[0])}")
    except csv.Error as error:
        raise MalformedFile(f"{path}:{rows.line_num}: {error}") from error
    if not kept or not kept[0]:
        raise MalformedFile(f"{path}: no header")
    names = kept[0]
    for name in names:
        if names.count(name) > 1:
            raise MalformedFile(f"{path}: the column '{name}' exists more than once")
    columns = zip(*kept[1:]) if len(kept) > 1 else ([] for _ in names)
    return {name: _column(name, list(cells)) for name, cells in zip(names, columns)}


def read_report(path: Path) -> Mapping[str, Any]:
    """Reads identify.json, diagnosis.json or run.json. Lists of numbers are returned as arrays."""
    return _with_arrays(_json_object(path))  # type: ignore[no-any-return]


def _with_arrays(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _with_arrays(inner) for key, inner in value.items()}
    if isinstance(value, list):
        if value and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in value):
            return np.array(value)
        return [_with_arrays(inner) for inner in value]
    return value


@dataclasses.dataclass(frozen=True)
class Recording:
    """A recording: a folder with run.csv and run.json."""

    about: Mapping[str, Any]  # content of run.json
    channels: Mapping[str, Mapping[str, Array]]  # for each finger, its columns in run.csv; all columns have the same length

    @classmethod
    def read(cls, folder: Path) -> Recording:
        folder = pathlib.Path(file_path_of("folder", folder))
        columns = read_columns(folder / "run.csv")
        about = _json_object(folder / "run.json")
        if "channel" not in columns:
            channels = about.get("channels")
            if not isinstance(channels, list) or not channels:
                raise MalformedFile(f"{folder}: run.csv has no column 'channel', and run.json lists no finger")
            return cls(about, {str(channels[0]): columns})
        of = columns.pop("channel")
        return cls(about, {name: {key: column[of == name] for key, column in columns.items()}
                           for name in dict.fromkeys(map(str, of))})
