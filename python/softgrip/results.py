"""Defines the results of identification, validation, diagnosis and health as objects, with tables for notebooks and
with plots."""

from __future__ import annotations

import dataclasses
import functools
import html
import importlib
import json
from collections.abc import Mapping, Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from .errors import InvalidArgument
from .models import Model

Vector = npt.NDArray[np.float64]


def _pyplot() -> Any:
    return importlib.import_module("matplotlib.pyplot")  # imported only for plots: the import takes about 1 s


def two_axes(axes: Any) -> tuple[Any, Any]:
    """Returns the two matplotlib axes in `axes`, or two new axes in one column."""
    if axes is None:
        _, axes = _pyplot().subplots(2, 1, sharex=True, layout="constrained")
    try:
        upper, lower = axes
    except (TypeError, ValueError) as error:
        raise InvalidArgument("axes", "axes: two matplotlib axes are required") from error
    return upper, lower


def _table(title: str, warnings: Sequence[str], header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    cells = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    head = "".join(f"<th>{html.escape(one)}</th>" for one in header)
    told = "".join(f"<p>warning: {html.escape(one)}</p>" for one in warnings)
    return f"<p><b>{html.escape(title)}</b></p>{told}<table><tr>{head}</tr>{cells}</table>"


def _interval(interval: Optional[tuple[float, float]]) -> str:
    return "" if interval is None else f"{interval[0]:.4g} to {interval[1]:.4g}"


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A number with its 95 % interval. The interval is None if the number is fixed, is at a bound, or has no effect on
    the result; `note` gives the reason."""

    name: str
    unit: str
    value: float
    ci95: Optional[tuple[float, float]]
    free: bool
    note: str


@dataclasses.dataclass(frozen=True, eq=False)
class Prediction:
    """The prediction of one log. `error` is the reading minus the prediction, in `unit`; NaN where a reading is missing."""

    log: str
    unit: str
    time_s: Vector
    prediction: Vector
    error: Vector
    rmse: float
    rmse_percent_of_span: float
    largest_error: float
    diverges: bool

    def plot(self, axes: Any = None) -> Any:
        """Draws readings and prediction on one matplotlib axes, and the error on a second axes below the first. Returns
        both axes."""
        upper, lower = two_axes(axes)
        upper.plot(self.time_s, self.prediction + self.error, ".", markersize=2, label="reading")
        upper.plot(self.time_s, self.prediction, label="prediction")
        upper.set_ylabel(f"[{self.unit}]")
        upper.set_title(f"{self.log}: RMSE {self.rmse:.3g} {self.unit}")
        upper.legend()
        lower.plot(self.time_s, self.error)
        lower.set_ylabel(f"error [{self.unit}]")
        lower.set_xlabel("time [s]")
        return upper, lower


class _Reported:
    """A result that contains the JSON and the report page of the `softgrip` command."""

    json: str
    html: str

    @functools.cached_property
    def report(self) -> Mapping[str, Any]:
        """Returns the complete result of the command: the content of its JSON file as Python values."""
        return json.loads(self.json)  # type: ignore[no-any-return]

    def save_html(self, path: Any) -> None:
        """Writes the report page of the command to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)


def _plotted(predictions: Sequence[Prediction], log: Optional[str], axes: Any) -> Any:
    for one in predictions:
        if log is None or one.log == log:
            return one.plot(axes)
    raise InvalidArgument("log", f"log: {log!r} is not one of {', '.join(one.log for one in predictions)}")


@dataclasses.dataclass(frozen=True, eq=False)
class Identification(_Reported):
    """The result of `identify()`."""

    model: Model
    rmse: float  # RMSE of all fitted samples, in the unit of the model
    converged: bool
    verdict: str
    warnings: Sequence[str]
    parameters: Sequence[Estimate]
    combinations: Sequence[Estimate]
    fit: Sequence[Prediction]
    held_out: Sequence[Prediction]
    validation: Sequence[Prediction]
    json: str = dataclasses.field(repr=False)
    html: str = dataclasses.field(repr=False)

    def _repr_html_(self) -> str:
        rows = [(one.name, f"{one.value:.5g}", one.unit, _interval(one.ci95), one.note) for one in self.parameters]
        return _table(self.verdict, self.warnings, ("parameter", "value", "unit", "95 % interval", ""), rows)

    def plot(self, log: Optional[str] = None, axes: Any = None) -> Any:
        """Draws the fit of one log; the default is the first log."""
        return _plotted(self.fit, log, axes)


@dataclasses.dataclass(frozen=True, eq=False)
class Validation(_Reported):
    """The result of `validate()`."""

    verdict: str
    warnings: Sequence[str]
    predictions: Sequence[Prediction]
    json: str = dataclasses.field(repr=False)
    html: str = dataclasses.field(repr=False)

    def _repr_html_(self) -> str:
        rows = [(one.log, f"{one.rmse:.4g} {one.unit}", f"{one.rmse_percent_of_span:.3g} %",
                 f"{one.largest_error:.3g} {one.unit}") for one in self.predictions]
        return _table(self.verdict, self.warnings, ("log", "RMSE", "of span", "largest error"), rows)

    def plot(self, log: Optional[str] = None, axes: Any = None) -> Any:
        """Draws the prediction of one log; the default is the first log."""
        return _plotted(self.predictions, log, axes)


@dataclasses.dataclass(frozen=True)
class Cause:
    """A cause that a diagnosis names. In a `Diagnosis`, the error reduction is the reduction of the error on held-out
    blocks. It is NaN if only one-step predictions in a closed loop show the cause. In a `Change`, the error reduction is
    the reduction of the whitened RMS error of the later logs, to which the size of the cause is fitted. It is NaN for
    "outliers" and "sampling", which are found without a fit. In a `Change`, the parameters contain the size of the
    change."""

    id: str
    title: str
    error_reduction_percent: float
    error_reduction_ci95: tuple[float, float]
    parameters: Sequence[Estimate]
    alternatives: Sequence[str]  # ids of causes that the logs cannot separate from this cause


def _cause_rows(causes: Sequence[Cause]) -> list[tuple[str, ...]]:
    return [(cause.id, one.name, f"{one.value:.4g} {one.unit}", _interval(one.ci95), ", ".join(cause.alternatives))
            for cause in causes for one in cause.parameters]


def _one_axes(axes: Any) -> Any:
    """Returns the given matplotlib axes, or new axes."""
    return _pyplot().subplots(layout="constrained")[1] if axes is None else axes


def _plotted_causes(causes: Sequence[Cause], axes: Any) -> Any:
    axes = _one_axes(axes)
    with_reduction = [one for one in causes if np.isfinite(one.error_reduction_percent)]
    for row, one in enumerate(with_reduction):
        lower, upper = one.error_reduction_ci95
        axes.plot([lower, upper], [row, row], color="tab:blue")
        axes.plot([one.error_reduction_percent], [row], "o", color="tab:blue")
    axes.set_yticks(range(len(with_reduction)), [one.id for one in with_reduction])
    axes.set_xlabel("reduction of the held-out error [%], 95 % interval")
    return axes


@dataclasses.dataclass(frozen=True, eq=False)
class Diagnosis(_Reported):
    """The result of `diagnose()`. The errors are root mean squares in `unit`. The errors of the refitted and of the
    extended model were computed on held-out blocks."""

    verdict: str
    sentence: str
    warnings: Sequence[str]
    causes: Sequence[Cause]
    unit: str
    noise: float
    rmse_given: float
    rmse_refitted: float
    rmse_extended: float
    unexplained_percent: float
    refitted: Model
    extended: Model
    json: str = dataclasses.field(repr=False)
    html: str = dataclasses.field(repr=False)

    def _repr_html_(self) -> str:
        return _table(self.sentence, self.warnings, ("cause", "parameter", "value", "95 % interval", "alternatives"),
                      _cause_rows(self.causes))

    def plot(self, axes: Any = None) -> Any:
        """Draws the error reduction of each cause with its interval on matplotlib axes, and returns the axes."""
        return _plotted_causes(self.causes, axes)


@dataclasses.dataclass(frozen=True, eq=False)
class Change(_Reported):
    """The result of `diagnose()` with healthy logs."""

    verdict: str
    sentence: str
    warnings: Sequence[str]
    causes: Sequence[Cause]
    unit: str
    json: str = dataclasses.field(repr=False)
    html: str = dataclasses.field(repr=False)

    def _repr_html_(self) -> str:
        return _table(self.sentence, self.warnings, ("cause", "size", "value", "95 % interval", "alternatives"),
                      _cause_rows(self.causes))

    def plot(self, axes: Any = None) -> Any:
        """Draws the size of each change with its 95 % interval on matplotlib axes, and returns the axes. The sizes have
        different units. Therefore, each size is drawn relative to the largest absolute value in its own interval, and
        the labels state the sizes with units."""
        axes = _one_axes(axes)
        sizes = [(cause.id, one) for cause in self.causes for one in cause.parameters]
        for row, (_, one) in enumerate(sizes):
            lower, upper = one.ci95 or (one.value, one.value)
            scale = max(abs(lower), abs(upper), abs(one.value)) or 1.0
            axes.plot([lower / scale, upper / scale], [row, row], color="tab:blue")
            axes.plot([one.value / scale], [row], "o", color="tab:blue")
        axes.axvline(0, color="tab:gray", linewidth=1)
        axes.set_yticks(range(len(sizes)), [f"{cause}\n{one.value:.3g} {one.unit}" for cause, one in sizes])
        axes.set_xlabel("size of the change, as a share of its largest value, 95 % interval")
        return axes


@dataclasses.dataclass(frozen=True, eq=False)
class HealthIndicator:
    """An indicator of a finger. `value` is its value at the last point that has a value. `reference` and `spread` are its
    mean and standard deviation since the last maintenance record. An unknown `value`, `reference` or `spread` is None.
    `values` has one value per point, for the recipe of the reference; NaN for a point without such a value."""

    id: str
    title: str
    unit: str
    value: Optional[float]
    reference: Optional[float]
    spread: Optional[float]
    values: Vector


@dataclasses.dataclass(frozen=True)
class HealthAlarm:
    """A significant change of an indicator, in the unit of the indicator. `since` and `noticed` are the points at which
    the change began and at which it was detected. A maintenance record ends the alarm."""

    indicator: str
    change: float
    since: str
    noticed: str
    grips_until_noticed: int
    active: bool


@dataclasses.dataclass(frozen=True)
class Suspect:
    """A possible cause of the active alarms, and the checks that confirm this cause, the quickest check first."""

    id: str
    words: str
    next_steps: Sequence[str]


@dataclasses.dataclass(frozen=True, eq=False)
class FingerHealth:
    """The health of one finger. `state` is "learning", "steady" or "alarm"; `points` are days or names of recordings."""

    finger: str
    state: str
    sentence: str
    unit: str
    grips: int
    points: Sequence[str]
    indicators: Sequence[HealthIndicator]
    alarms: Sequence[HealthAlarm]
    suspects: Sequence[Suspect]
    advice: Sequence[str]
    html: str = dataclasses.field(repr=False)

    def indicator(self, name: str) -> HealthIndicator:
        """Returns the indicator with an id, such as "gain_mm"."""
        for one in self.indicators:
            if one.id == name:
                return one
        raise InvalidArgument("indicator", f"indicator: {name!r} is not one of {', '.join(one.id for one in self.indicators)}")

    def plot(self, indicator: Optional[str] = None, axes: Any = None) -> Any:
        """Draws an indicator over the points, with its reference ± 3 standard deviations, on matplotlib axes. Returns
        the axes. The default indicator is that of the first active alarm, or the gain if no alarm is active."""
        active = [one.indicator for one in self.alarms if one.active]
        shown = self.indicator(indicator if indicator is not None else active[0] if active else "gain_mm")
        axes = _one_axes(axes)
        x = np.arange(len(self.points))
        axes.plot(x, shown.values, "o", markersize=4)
        if shown.reference is not None:
            axes.axhline(shown.reference, color="tab:gray", linewidth=1)
            if shown.spread is not None:
                axes.axhspan(shown.reference - 3 * shown.spread, shown.reference + 3 * shown.spread, color="tab:gray", alpha=0.2)
        for alarm in self.alarms:
            if alarm.indicator == shown.id and alarm.noticed in self.points:
                axes.axvline(self.points.index(alarm.noticed), color="tab:red", linewidth=1)
        ticks = x[::max(1, len(x) // 6)]
        axes.set_xticks(ticks, [self.points[one] for one in ticks], rotation=30, ha="right")
        axes.set_ylabel(f"{shown.title} [{shown.unit}]")
        axes.set_title(f"{self.finger}: {self.state}")
        return axes


@dataclasses.dataclass(frozen=True, eq=False)
class Health:
    """The result of `health()`. `alarm` is True while an alarm of a finger is active. `warnings` describe changes that
    several fingers share, and changes that are not attributed to a finger. `skipped` contains the name of each recording
    that was not used, or in which one finger was not used, with the reason."""

    alarm: bool
    fingers: Sequence[FingerHealth]
    warnings: Sequence[str]
    skipped: Sequence[tuple[str, str]]
    json: str = dataclasses.field(repr=False)

    @functools.cached_property
    def report(self) -> Mapping[str, Any]:
        """Returns the complete result: the content of health.json as Python values."""
        return json.loads(self.json)  # type: ignore[no-any-return]

    def finger(self, name: str) -> FingerHealth:
        """Returns the health of the finger with this name."""
        for one in self.fingers:
            if one.finger == name:
                return one
        raise InvalidArgument("finger", f"finger: {name!r} is not one of {', '.join(one.finger for one in self.fingers)}")

    def _repr_html_(self) -> str:
        rows = [(one.finger, one.state, one.sentence, ", ".join(suspect.id for suspect in one.suspects))
                for one in self.fingers]
        return _table("alarm" if self.alarm else "steady", self.warnings, ("finger", "state", "health", "suspects"), rows)

    def plot(self, finger: Optional[str] = None, indicator: Optional[str] = None, axes: Any = None) -> Any:
        """Draws an indicator of a finger over time. The default finger is the first finger with an active alarm, or the
        first finger if no alarm is active."""
        alarmed = [one for one in self.fingers if one.state == "alarm"]
        shown = self.finger(finger) if finger is not None else (alarmed or self.fingers)[0]
        return shown.plot(indicator, axes)
