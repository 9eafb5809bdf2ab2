"""Converts JSON of the daemon to Python objects. Each value is checked against the annotations of its class. Malformed
JSON raises only ProtocolError, with the location of the error."""

from __future__ import annotations

import collections.abc
import dataclasses
import enum
import functools
import json
import math
import typing
from typing import Any, TypeVar, Union

from .errors import ProtocolError

T = TypeVar("T")


def _no_number(name: str) -> Any:
    raise ValueError(f"{name} is not a JSON number")


def parsed(line: bytes) -> dict[str, Any]:
    """Returns the JSON object in a line. Raises ProtocolError if the line contains no JSON object."""
    try:
        value = json.loads(line, parse_constant=_no_number)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise ProtocolError("the program at this socket is not softgripd: a line is not a JSON object")
    return value


@functools.lru_cache(maxsize=None)
def _hints(cls: Any) -> dict[str, Any]:
    return typing.get_type_hints(cls)


def fields_of(cls: Any, value: Any, where: str) -> dict[str, Any]:
    """Returns the values of a dataclass's fields from the members of a JSON object that have the same names. Members
    without a field are ignored, because a newer daemon may send additional members. A member may be missing if the
    field has a default."""
    if not isinstance(value, dict):
        raise ProtocolError(f"{where} is not a JSON object")
    found = {}
    for field in dataclasses.fields(cls):
        if field.name in value:
            found[field.name] = checked(_hints(cls)[field.name], value[field.name], f"{where}.{field.name}")
        elif field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
            raise ProtocolError(f"{where} lacks '{field.name}'")
    return found


def decoded(cls: type[T], value: Any, where: str) -> T:
    """Creates an object of a dataclass from JSON. `where` is the location in error messages."""
    return cls(**fields_of(cls, value, where))


def checked(kind: Any, value: Any, where: str) -> Any:
    """Returns the value if it has the annotated type `kind`. Raises ProtocolError if it has another type."""
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin is Union:  # the annotation is Optional[...]
        return None if value is None else checked(inner[0], value, where)
    if origin is tuple:
        items = _is(list, "list", value, where)
        return tuple(checked(inner[0], item, f"{where}[{i}]") for i, item in enumerate(items))
    if origin is collections.abc.Mapping:
        entries = _is(dict, "JSON object", value, where)
        return {key: checked(inner[1], entry, f"{where}.{key}") for key, entry in entries.items()}
    if kind is Any:
        return value
    if kind is float:
        return _number(value, where)
    if kind in (bool, int, str):
        return _is(kind, {bool: "true or false", int: "a whole number", str: "a text"}[kind], value, where)
    if issubclass(kind, enum.Enum):
        return _choice(kind, value, where)
    return kind.of(value, where)


def _is(kind: type[T], name: str, value: Any, where: str) -> T:
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise ProtocolError(f"{where} is not {name}")
    return value


def _number(value: Any, where: str) -> float:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if math.isfinite(number):
            return number
    raise ProtocolError(f"{where} is not a finite number")


def _choice(kind: type[enum.Enum], value: Any, where: str) -> enum.Enum:
    if isinstance(value, str):
        for choice in kind:
            if choice.value == value:
                return choice
    raise ProtocolError(f"{where} is not one of {', '.join(str(choice.value) for choice in kind)}")
