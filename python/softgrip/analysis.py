"""Identification, validation and diagnosis of logs, and health of recordings. The results are identical to those of the
`softgrip` commands."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable
from typing import Any, Optional, Union

from . import _core
from .arguments import Path, path_of, text_of
from .errors import InvalidArgument
from .models import Log, Model, _flag, _number, _whole
from .results import (Cause, Change, Diagnosis, Estimate, FingerHealth, Health, HealthAlarm, HealthIndicator, Identification,
                      Prediction, Suspect, Validation)

Logs = Union[Log, Iterable[Log]]
Progress = Optional[Callable[[str], object]]
_MOST_THREADS = 4096


def _columns(argument: str, logs: Logs) -> list[dict[str, Any]]:
    try:
        all_logs = [logs] if isinstance(logs, Log) else list(logs)
    except TypeError as error:
        raise InvalidArgument(argument, f"{argument}: {logs!r} is neither a Log nor a list of Logs") from error
    for one in all_logs:
        if not isinstance(one, Log):
            raise InvalidArgument(argument, f"{argument}: {type(one).__name__} is not a Log; use Log(t, command, displacement)")
    return [one._columns() for one in all_logs]


def _model(argument: str, model: Model) -> _core.Model:
    if not isinstance(model, Model):
        raise InvalidArgument(argument, f"{argument}: {type(model).__name__} is not a Model; use Model.load()")
    return model._core


def _callback(progress: Progress) -> Progress:
    if progress is not None and not callable(progress):
        raise InvalidArgument("progress", f"progress: {progress!r} cannot be called")
    return progress


def _names(argument: str, names: Iterable[str]) -> list[str]:
    if isinstance(names, str):
        raise InvalidArgument(argument, f"{argument}: a list of names is required, not a text")
    try:
        return [text_of(argument, one) for one in names]
    except TypeError as error:
        raise InvalidArgument(argument, f"{argument}: a list of names is required") from error


def _estimates(found: list[dict[str, Any]]) -> tuple[Estimate, ...]:
    return tuple(Estimate(**one) for one in found)


def _predictions(found: list[dict[str, Any]]) -> tuple[Prediction, ...]:
    return tuple(Prediction(**one) for one in found)


def _causes(found: list[dict[str, Any]]) -> tuple[Cause, ...]:
    for one in found:
        one.update(parameters=_estimates(one["parameters"]), alternatives=tuple(one["alternatives"]))
    return tuple(Cause(**one) for one in found)


def identify(logs: Logs, structure: str = "start", *, start: Optional[Model] = None, branches: int = 2,
             fixed: Iterable[str] = (), free: Iterable[str] = (), starts: int = 20, seed: int = 1, robust: bool = False,
             fit_share: float = 1, threads: int = 0, drive: str = "command", begin: str = "auto", held: bool = False,
             validation: Logs = (), progress: Progress = None) -> Identification:
    """Fits a model to logs, as `softgrip identify` does.

    structure: "start" uses the structure of `start`, or the default structure with `branches` creep branches. "auto",
    "bouc_wen" and "prandtl_ishlinskii" select a structure by the error on held-out blocks of the logs ("play" is a
    deprecated name of "prandtl_ishlinskii"). With such a selection, `start`, `branches`, `fixed`, `free` and `robust`
    must have their default values; otherwise, `InvalidArgument` is raised. fixed: parameters that keep their start value.
    free: parameters that are estimated; by default, all parameters except those in `fixed`. starts: number of start points.
    fit_share: share of each log that is fitted, from its start; 0.05 to 1. threads: number of threads, 0 for one per
    processor core. drive: "command" or "measured" pressure as the input. begin: state of the finger at the start of a log,
    "auto", "rest" or "unknown". validation: logs that are predicted but not fitted.
    progress: function that is called with a text about the present stage; an exception in this function ends the
    computation, as Ctrl-C does.

    >>> model = Model.load("config/models/bench_twin.yaml")
    >>> import numpy as np
    >>> t = np.arange(0, 20, 0.05)
    >>> command = 20 - 20 * np.cos(0.2 * np.pi * t)
    >>> log = Log(t, command, model.simulate(t, command, noise=0.05))
    >>> identify(log, start=model, starts=1).rmse < 0.06
    True
    """
    if text_of("structure", structure) == "play":
        warnings.warn('structure="play" is deprecated; use "prandtl_ishlinskii"', DeprecationWarning, stacklevel=2)
        structure = "prandtl_ishlinskii"
    found = _core.identify(
        _columns("logs", logs), structure, None if start is None else _model("start", start),
        _whole("branches", branches), _names("fixed", fixed), _names("free", free), _whole("starts", starts),
        _whole("seed", seed), _flag("robust", robust), _number("fit_share", fit_share), _whole("threads", threads, _MOST_THREADS),
        text_of("drive", drive), text_of("begin", begin), _flag("held", held), _columns("validation", validation),
        _callback(progress))
    found.update({key: _estimates(found[key]) for key in ("parameters", "combinations")})
    found.update({key: _predictions(found[key]) for key in ("fit", "held_out", "validation")})
    found.update(model=Model(found["model"]), warnings=tuple(found["warnings"]))
    return Identification(**found)


def validate(model: Model, logs: Logs, *, drive: str = "command", begin: str = "auto", held: bool = False) -> Validation:
    """Predicts logs with a model and rates the predictions, as `softgrip validate` does."""
    found = _core.validate(_model("model", model), _columns("logs", logs), text_of("drive", drive), text_of("begin", begin),
                           _flag("held", held))
    found.update(predictions=_predictions(found["predictions"]), warnings=tuple(found["warnings"]))
    return Validation(**found)


def diagnose(model: Model, logs: Logs, healthy: Optional[Logs] = None, *, seed: int = 1, threads: int = 0,
             null_campaigns: int = 0, drive: str = "command", begin: str = "auto", held: bool = False,
             progress: Progress = None) -> Union[Diagnosis, Change]:
    """Determines the error of a model on logs and the causes of this error, as `softgrip diagnose` does. With logs of
    the healthy finger in `healthy`, determines how the finger has changed since these logs, as `softgrip diagnose
    --healthy` does. The result is then a `Change`, and `null_campaigns`, `drive` and `begin` have no effect."""
    core = _model("model", model)
    columns = _columns("logs", logs)
    seed = _whole("seed", seed)
    threads = _whole("threads", threads, _MOST_THREADS)
    if healthy is None:
        found = _core.diagnose(core, columns, seed, threads, _whole("null_campaigns", null_campaigns),
                               text_of("drive", drive), text_of("begin", begin), _flag("held", held), _callback(progress))
        found.update(causes=_causes(found["causes"]), warnings=tuple(found["warnings"]),
                     refitted=Model(found["refitted"]), extended=Model(found["extended"]))
        return Diagnosis(**found)
    found = _core.diagnose_change(core, _columns("healthy", healthy), columns, seed, threads, _flag("held", held),
                                  _callback(progress))
    found.update(causes=_causes(found["causes"]), warnings=tuple(found["warnings"]))
    return Change(**found)


def health(recordings: Union[Path, Iterable[Path]], baseline: Path, *, points: str = "day", false_alarm_points: float = 3650,
           notes: Optional[Path] = None, scores: Optional[Path] = None, progress: Progress = None) -> Health:
    """Detects changed fingers in recordings of ordinary grips, as `softgrip health` does.

    recordings: folders of recordings, or folders that contain such folders. baseline: folder of `softgrip baseline`. If
    it contains a folder with the name of a finger, the baseline in that folder applies to this finger. points: a point
    of a control chart is a "day" or a "run". false_alarm_points: mean number of points between two false alarms of a
    healthy finger. notes: file of maintenance records. scores: file that stores the indicators of all recordings that
    were read so far. Recordings whose indicators for the current baseline are in this file are not read again. The call
    replaces the file at its end.
    """
    if isinstance(recordings, (str, os.PathLike)):
        recordings = [recordings]
    try:
        paths = [path_of("recordings", one) for one in recordings]
    except TypeError as error:
        raise InvalidArgument("recordings", f"recordings: {recordings!r} is no path and no list of paths") from error
    found = _core.health(paths, path_of("baseline", baseline), text_of("points", points),
                         _number("false_alarm_points", false_alarm_points), "" if notes is None else path_of("notes", notes),
                         "" if scores is None else path_of("scores", scores), _callback(progress))
    for one in found["fingers"]:
        one.update(indicators=tuple(HealthIndicator(**inner) for inner in one["indicators"]),
                   alarms=tuple(HealthAlarm(**inner) for inner in one["alarms"]),
                   suspects=tuple(Suspect(**inner) for inner in one["suspects"]))
    found.update(fingers=tuple(FingerHealth(**one) for one in found["fingers"]), warnings=tuple(found["warnings"]),
                 skipped=tuple(found["skipped"]))
    return Health(**found)
