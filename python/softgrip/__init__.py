"""Client of softgripd, the controller of soft pneumatic grippers. The package also reads files of softgrip and computes
models.

The methods of `Gripper` block until the daemon replies; `AsyncGripper` is for asyncio. Both classes use version 1 of
the daemon's socket API and need no other package. `Recording` and the `read_*` functions need NumPy. Models, logs,
`identify()`, `validate()`, `diagnose()`, `health()`, the controller and the simulated board need NumPy and the shared
library. NumPy and the shared library are loaded when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .aio import AsyncGripper
from .client import Gripper
from .errors import (BusError, ConnectionLost, GripFailed, InvalidArgument, MalformedFile, MissingFile, NoDaemon, NoResult,
                     NotAnswered, Owned, ProtocolError, Refused, SequenceRefused, SoftgripError, StopNotConfirmed,
                     UnreadableFile)
from .messages import (Channel, Checked, Event, Fault, Grip, Hello, Parameter, Problem, Result, Sequence, SequenceEnd,
                       SequenceState, State, Status)

if TYPE_CHECKING:
    from .analysis import diagnose, health, identify, validate
    from .control import (Board, Controller, ControlOutput, LimitedCommand, Limits, Pid, PidSettings, Reading, Reference,
                          SimulatedBoard, SimulatedFinger, SimulatedObject, limit)
    from .models import Inverse, Log, Model, Parameter as ModelParameter
    from .results import (Cause, Change, Diagnosis, Estimate, FingerHealth, Health, HealthAlarm, HealthIndicator,
                          Identification, Prediction, Suspect, Validation)

# Names that are loaded when they are first used. For each: the module that defines it, and its name in this module.
_ON_USE = {name: ("analysis", name) for name in ("diagnose", "health", "identify", "validate")}
_ON_USE |= {name: ("control", name) for name in
            ("Board", "ControlOutput", "Controller", "LimitedCommand", "Limits", "Pid", "PidSettings", "Reading", "Reference",
             "SimulatedBoard", "SimulatedFinger", "SimulatedObject", "limit")}
_ON_USE |= {name: ("models", name) for name in ("Inverse", "Log", "Model")}
_ON_USE |= {"ModelParameter": ("models", "Parameter")}
_ON_USE |= {name: ("results", name) for name in
            ("Cause", "Change", "Diagnosis", "Estimate", "FingerHealth", "Health", "HealthAlarm", "HealthIndicator",
             "Identification", "Prediction", "Suspect", "Validation")}


def __getattr__(name: str) -> Any:
    if name not in _ON_USE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, own_name = _ON_USE[name]
    try:
        value = getattr(importlib.import_module(f".{module}", __name__), own_name)
    except ModuleNotFoundError as error:
        if error.name in ("numpy", "softgrip._core"):
            package = "python3-numpy" if error.name == "numpy" else "the package python3-softgrip, built with pybind11"
            raise ImportError(f"softgrip.{name} needs {package}: {error}", name=error.name) from error
        raise
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_ON_USE})


__all__ = [
    "AsyncGripper", "Board", "BusError", "Cause", "Change", "Channel", "Checked", "ConnectionLost", "ControlOutput",
    "Controller", "Diagnosis", "Estimate", "Event", "Fault", "FingerHealth", "Grip", "GripFailed", "Gripper", "Health",
    "HealthAlarm", "HealthIndicator", "Hello", "Identification", "InvalidArgument", "Inverse", "LimitedCommand", "Limits",
    "Log", "MalformedFile", "MissingFile", "Model", "ModelParameter", "NoDaemon", "NoResult", "NotAnswered", "Owned",
    "Parameter", "Pid", "PidSettings", "Prediction", "Problem", "ProtocolError", "Reading", "Reference", "Refused", "Result",
    "Sequence", "SequenceEnd", "SequenceRefused", "SequenceState", "SimulatedBoard", "SimulatedFinger", "SimulatedObject",
    "SoftgripError", "State", "Status", "StopNotConfirmed", "Suspect", "UnreadableFile", "Validation", "diagnose", "health",
    "identify", "limit", "validate",
]
