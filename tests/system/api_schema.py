"""Checks every line that the daemon sends against the schema that the package installs."""

import functools
import importlib
import json
import pathlib

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "daemon/socket/socket-api-1.schema.json"


@functools.cache
def jsonschema():
    """Imports jsonschema when the first line is checked. The import takes half of the start of a test, and many tests
    check no line."""
    return importlib.import_module("jsonschema")


@functools.cache
def validator(name=None):
    """Returns a validator for every line that the daemon sends, or for the type `name` in $defs of the schema."""
    schema = json.loads(SCHEMA.read_text())
    if name:
        schema.pop("oneOf")
        schema["$ref"] = f"#/$defs/{name}"
    return jsonschema().Draft202012Validator(schema)


RESULTS = {"start": "accepted", "stop": "accepted", "vent": "accepted", "release": "accepted",
           "acknowledge": "accepted", "watch": "watching", "unwatch": "nothing", "subscribe": "subscribed",
           "unsubscribe": "nothing"}


def check(line, command=None):
    """Checks a line. If the line does not match the schema, raises an AssertionError that describes the part of the
    line that does not match."""
    result = line.get("result") if command and line.get("ok") else None
    name, value = (RESULTS.get(command, command), result) if result is not None else (None, line)
    error = jsonschema().exceptions.best_match(validator(name).iter_errors(value))
    if error:
        raise AssertionError(f"{command}: {error.json_path}: {error.message}")
    if result is not None and set(line) != {"id", "ok", "result"}:
        raise AssertionError(f"{command}: {sorted(line)}")
