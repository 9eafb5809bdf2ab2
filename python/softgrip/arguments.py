"""Checks arguments that are texts and paths. The module needs only Python."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator, Mapping
from typing import Optional, Union

from .errors import InvalidArgument, MalformedFile, MissingFile, UnreadableFile

Path = Union[str, "os.PathLike[str]"]


def text_of(argument: str, value: object) -> str:
    if not isinstance(value, str):
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a text")
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise InvalidArgument(argument, f"{argument}: {value!r} cannot be encoded as UTF-8") from error
    return value


def file_path_of(argument: str, value: Path) -> str:
    """Returns the path as a text that the operating system accepts, even if the path is not valid UTF-8."""
    try:
        path = os.fspath(value)
        if isinstance(path, str) and b"\0" not in os.fsencode(path):
            return path
    except (TypeError, UnicodeEncodeError) as error:
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a path") from error
    raise InvalidArgument(argument, f"{argument}: {value!r} is not a path")


def path_of(argument: str, value: Path) -> str:
    """Returns the path as a text in UTF-8, which the library requires for its messages."""
    return text_of(argument, file_path_of(argument, value))


@contextlib.contextmanager
def reads(*paths: str) -> Iterator[None]:
    """Raises UnreadableFile in place of MalformedFile if one of the files cannot be opened. The block reads the files."""
    try:
        yield
    except MalformedFile:
        for path in paths:
            try:
                if stat.S_ISREG(os.stat(path).st_mode):
                    os.close(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC))
            except OSError as error:
                kind = MissingFile if isinstance(error, FileNotFoundError) else UnreadableFile
                raise kind(error.errno, error.strerror, path) from None
        raise


def texts_of(argument: str, value: Optional[Mapping[str, str]]) -> dict[str, str]:
    """Returns a copy of a mapping of texts; an empty mapping for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a dict of texts")
    return {text_of(argument, key): text_of(argument, one) for key, one in value.items()}
