"""Checks arguments that are texts and paths. The module needs only Python."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Optional, Union

from .errors import InvalidArgument

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


def texts_of(argument: str, value: Optional[Mapping[str, str]]) -> dict[str, str]:
    """Returns a copy of a mapping of texts; an empty mapping for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a dict of texts")
    return {text_of(argument, key): text_of(argument, one) for key, one in value.items()}
