"""Defines models and logs as Python objects with NumPy arrays. Their results are identical to those of the `softgrip`
commands."""

from __future__ import annotations

import dataclasses
import html
import operator
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core
from .arguments import Path, path_of, reads, text_of, texts_of
from .errors import InvalidArgument

Vector = npt.NDArray[np.float64]
_EMPTY: Vector = np.empty(0)


def _vector(argument: str, values: npt.ArrayLike, unit: str) -> Vector:
    """Converts an argument to a vector of numbers. Raises InvalidArgument if the argument is not a vector of numbers."""
    wanted = f"a vector of numbers in {unit} is required"
    try:
        if isinstance(values, np.ma.MaskedArray):
            values = np.where(values.mask, np.nan, values.data)  # a masked value means that the reading is missing
        array = np.asarray(values)
    except Exception as error:
        raise InvalidArgument(argument, f"{argument}: {wanted}: {error}") from error
    if array.dtype.kind not in "fiu" and array.size:
        raise InvalidArgument(argument, f"{argument}: type {array.dtype}; {wanted}")
    if array.ndim != 1:
        raise InvalidArgument(argument, f"{argument}: shape {array.shape}; one dimension, {wanted}")
    return np.require(array, np.float64, ("C_CONTIGUOUS", "ALIGNED")) if array.size else np.empty(0)


def _number(argument: str, value: float, unit: str = "") -> float:
    if isinstance(value, (bool, str, bytes)) or getattr(value, "ndim", False) or \
            getattr(getattr(value, "dtype", None), "kind", "f") not in "fiu":
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a number{' in ' + unit if unit else ''}")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidArgument(argument,
                              f"{argument}: {value!r} is not a number{' in ' + unit if unit else ''}") from error


def _whole(argument: str, value: int, largest: int = 2**63 - 1) -> int:
    try:
        number = operator.index(value)
    except TypeError as error:
        raise InvalidArgument(argument, f"{argument}: {value!r} is not a whole number") from error
    if not 0 <= number <= largest:
        raise InvalidArgument(argument, f"{argument}: {number} is not between 0 and {largest}")
    return number


def _flag(argument: str, value: object) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise InvalidArgument(argument, f"{argument}: {value!r} is not True or False")


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A parameter of a model: name, value, unit, smallest and largest permitted value, and description."""

    name: str
    value: float
    unit: str
    lower: float
    upper: float
    about: str


@dataclasses.dataclass(frozen=True)
class Inverse:
    """Result of `Model.inverse()`: the command."""

    pressure_kpa: Vector  # one value per time; the board holds each value until the next time
    out_of_reach: npt.NDArray[np.bool_]  # True if the finger cannot reach the reference because of the limits of the command


class Model:
    """A model of a finger: a chain of blocks from the commanded pressure to the reading. A Model object is immutable.

    >>> model = Model.load("config/models/bench_twin.yaml")
    >>> model.name, model.unit
    ('bench_twin', 'mm')
    >>> t = np.arange(0, 5, 0.01)
    >>> float(model.simulate(t, np.full(t.size, 20.0))[-1].round(2))
    10.28
    """

    def __init__(self, core: _core.Model) -> None:
        """Only the package calls this constructor. To create a model, use `load()` or `parse()`."""
        if not isinstance(core, _core.Model):
            raise InvalidArgument("core", "core: use Model.load() or Model.parse()")
        self._core = core

    @classmethod
    def load(cls, path: Path) -> Model:
        """Reads a model file. Raises `MalformedFile` if the file is not a valid model; the text names each problem with
        line and column. If the file cannot be opened, the exception is also an `OSError`, such as `FileNotFoundError`."""
        file = path_of("path", path)
        with reads(file):
            return cls(_core.Model.load(file))

    @classmethod
    def parse(cls, yaml: str, name: str = "model") -> Model:
        """Reads the text of a model file. Error messages use `name` as the name of the text."""
        return cls(_core.Model.parse(text_of("yaml", yaml), text_of("name", name)))

    def save(self, path: Path) -> None:
        """Writes a model file, from which `load()` reads an equal model."""
        self._core.save(path_of("path", path))

    @property
    def yaml(self) -> str:
        """Returns the text of a model file."""
        return self._core.yaml()

    @property
    def name(self) -> str:
        """Returns the name of the model."""
        return self._core.name()

    @property
    def source(self) -> str:
        """Returns the origin of the parameters."""
        return self._core.source()

    @property
    def unit(self) -> str:
        """Returns the unit of the output: "mm", or "deg" for a bending angle."""
        return self._core.unit()

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """Returns all parameters by name, in the order of the chain."""
        return {one[0]: Parameter(*one) for one in self._core.parameters()}

    def with_parameter(self, name: str, value: float) -> Model:
        """Returns a copy of the model in which one parameter has the value `value`.

        >>> model = Model.load("config/models/bench_twin.yaml").with_parameter("transport_delay.delay_s", 0.2)
        >>> model.parameters["transport_delay.delay_s"].value
        0.2
        """
        return Model(self._core.with_parameter(text_of("name", name), _number("value", value)))

    def simulate(self, t: npt.ArrayLike, pressure: npt.ArrayLike, *, held: bool = False, noise: float = 0,
                 seed: int = 1, supply: Optional[npt.ArrayLike] = None,
                 temperature: Optional[npt.ArrayLike] = None) -> Vector:
        """Returns the reading at each time, in the unit of the model. At first, the finger is at rest under the first
        pressure.

        t: times [s], increasing. pressure: commanded pressure [kPa], one value per time. held: if True, the pressure of
        a sample is constant until the next sample; otherwise, the pressure is linear between samples. noise: standard
        deviation of white noise, in the unit of the model. seed: seed of the random numbers for all noise. supply:
        supply pressure [kPa], one value per time. temperature: [degrees Celsius], one value per time.

        >>> model = Model.load("config/models/bench_twin.yaml")
        >>> model.simulate([0, 1], [0, 10, 20])
        Traceback (most recent call last):
        softgrip.errors.InvalidArgument: pressure: 3 values, but there are 2 times. One value per time is required, in kPa
        """
        return self._core.simulate(
            _vector("t", t, "s"), _vector("pressure", pressure, "kPa"), _flag("held", held), _number("noise", noise, self.unit),
            _whole("seed", seed), _EMPTY if supply is None else _vector("supply", supply, "kPa"),
            _EMPTY if temperature is None else _vector("temperature", temperature, "degrees Celsius"))

    def inverse(self, t: npt.ArrayLike, displacement: npt.ArrayLike, *, pressure_min: float = 0,
                pressure_max: float = 100, slew_up: float = 300, slew_down: float = 300, start: float = 0) -> Inverse:
        """Returns the command for which the displacement of the finger follows a reference.

        t: times [s] with equal steps. displacement: the reference in the unit of the model, one value per time.
        pressure_min, pressure_max: range of the command [kPa]. slew_up, slew_down: largest rates of increase and
        decrease of the command [kPa/s]. start: command under which the finger is at rest at the first time [kPa].
        Raises `NoResult` if the model has no inverse.

        >>> model = Model.load("config/models/bench_twin.yaml")
        >>> t = np.arange(0, 10, 0.005)
        >>> wanted = 6 - 2 * np.cos(0.2 * np.pi * t)
        >>> command = model.inverse(t, wanted)
        >>> moved = model.simulate(t, command.pressure_kpa, held=True)
        >>> bool(np.abs(moved - wanted)[600:].max() < 1e-3)
        True
        """
        pressure_kpa, out_of_reach = self._core.inverse(
            _vector("t", t, "s"), _vector("displacement", displacement, self.unit),
            _number("pressure_min", pressure_min, "kPa"), _number("pressure_max", pressure_max, "kPa"),
            _number("slew_up", slew_up, "kPa/s"), _number("slew_down", slew_down, "kPa/s"), _number("start", start, "kPa"))
        return Inverse(pressure_kpa, out_of_reach.astype(bool))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self.yaml == other.yaml

    def __hash__(self) -> int:
        return hash(self.yaml)

    def __reduce__(self) -> tuple[Any, tuple[str, str]]:
        return Model.parse, (self.yaml, self.name)

    def __repr__(self) -> str:
        return f"<softgrip.Model {self.name}, {len(self.parameters)} parameters, output in {self.unit}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{html.escape(one.name)}</td><td>{one.value:.6g}</td><td>{html.escape(one.unit)}</td>"
                       f"<td>{html.escape(one.about)}</td></tr>" for one in self.parameters.values())
        return f"<p><b>{html.escape(self.name)}</b>: {html.escape(self.source)}</p><table>{rows}</table>"


def _column(argument: str, values: Optional[npt.ArrayLike], unit: str) -> Vector:
    return _EMPTY if values is None else _vector(argument, values, unit)


@dataclasses.dataclass(frozen=True, eq=False)
class Log:
    """A measured log of one finger: `Log(t, command, displacement)`, `Log.from_pandas()` or `Log.read()`.

    t: times [s], increasing. command: commanded pressure [kPa]. displacement: readings in `unit`; NaN where a reading is
    missing. pressure: measured pressure [kPa]. temperature [degrees Celsius]. supply: supply pressure [kPa]. Each array has
    one value per time.

    >>> log = Log([0, 0.1, 0.2], [0, 10, 20], [0, 1, 2.5], name="short")
    >>> len(log), log.unit
    (3, 'mm')
    """

    t: Vector
    command: Vector
    displacement: Vector
    pressure: Vector = dataclasses.field(default_factory=lambda: _EMPTY)
    temperature: Vector = dataclasses.field(default_factory=lambda: _EMPTY)
    supply: Vector = dataclasses.field(default_factory=lambda: _EMPTY)
    unit: str = "mm"
    name: str = "log"
    path: str = ""
    sha256: str = ""
    notes: Sequence[str] = ()

    if TYPE_CHECKING:
        def __init__(self, t: npt.ArrayLike, command: npt.ArrayLike, displacement: npt.ArrayLike,
                     pressure: Optional[npt.ArrayLike] = None, temperature: Optional[npt.ArrayLike] = None,
                     supply: Optional[npt.ArrayLike] = None, unit: str = "mm", name: str = "log", path: str = "",
                     sha256: str = "", notes: Sequence[str] = ()) -> None: ...

    def __post_init__(self) -> None:
        if text_of("unit", self.unit) not in ("mm", "deg"):
            raise InvalidArgument("unit", f"unit: {self.unit!r} is not 'mm' or 'deg'")
        for argument, unit in (("t", "s"), ("command", "kPa"), ("displacement", self.unit), ("pressure", "kPa"),
                               ("temperature", "degrees Celsius"), ("supply", "kPa")):
            values = _column(argument, getattr(self, argument), unit)
            required = argument in ("t", "command", "displacement")
            if (required or values.size) and values.size != np.size(self.t):
                raise InvalidArgument(argument, f"{argument}: shape {values.shape}, but t has shape "
                                                f"({np.size(self.t)},). One value per time is required, in {unit}")
            if values.flags.writeable and values.size:
                values = values.copy()
                values.flags.writeable = False
            object.__setattr__(self, argument, values)
        for argument in ("name", "path", "sha256"):
            text_of(argument, getattr(self, argument))

    @classmethod
    def read(cls, path: Path, *, channel: str = "", columns: Optional[Mapping[str, str]] = None,
             units: Optional[Mapping[str, str]] = None, rate_hz: Optional[float] = None, sheet: str = "",
             import_file: bool = True) -> Log:
        """Reads a log (CSV, or the folder of a recording). Converts a file of another program (text, XLSX, TDMS, MCAP,
        MATLAB, HDF5) with the column roles that `softgrip import` proposes; the notes of the log describe the conversion.

        columns: for each role (time, command, pressure, displacement, temperature, supply), the name of a column, or
        its number counted from 1. units: unit for each role whose unit is not in the file. rate_hz: samples per second
        of a file without times. Raises the exceptions of `Model.load()`.
        """
        file = path_of("path", path)
        with reads(file):
            found = _core.read_log(file, text_of("channel", channel), _flag("import_file", import_file),
                                   texts_of("columns", columns), texts_of("units", units),
                                   None if rate_hz is None else _number("rate_hz", rate_hz, "Hz"), text_of("sheet", sheet))
        return cls(found["time_s"], found["pressure_command_kpa"], found["displacement"], found["pressure_kpa"],
                   found["temperature_c"], found["supply_kpa"], found["unit"], found["name"], found["path"],
                   found["sha256"], tuple(found["notes"]))

    @classmethod
    def from_pandas(cls, frame: Any, *, name: str = "log") -> Log:
        """Returns the log in a pandas DataFrame that has the columns of a log file: time_s, pressure_command_kpa,
        displacement_mm (or angle_deg), and optionally pressure_kpa, temperature_c and supply_kpa."""
        unit = "deg" if "angle_deg" in frame.columns else "mm"
        needed = ("time_s", "pressure_command_kpa", "angle_deg" if unit == "deg" else "displacement_mm")
        for column in needed:
            if column not in frame.columns:
                raise InvalidArgument("frame", f"frame: no column {column!r}; it has {', '.join(map(str, frame.columns))}")
        columns = [frame[column].to_numpy() for column in needed]
        columns += [frame[column].to_numpy() if column in frame.columns else None
                    for column in ("pressure_kpa", "temperature_c", "supply_kpa")]
        t, command, displacement, pressure, temperature, supply = columns
        return cls(t, command, displacement, pressure, temperature, supply, unit, name)

    def write(self, path: Path) -> None:
        """Writes a log file, from which `read()` reads an equal log. The times of a log file start at 0, so the first
        value of `t` is subtracted from all times."""
        _core.write_log(path_of("path", path), self._columns())

    def check(self) -> None:
        """Raises `InvalidArgument` if `identify()` would refuse the log."""
        _core.check(self._columns())

    def _columns(self) -> dict[str, Any]:
        return {"name": self.name, "unit": self.unit, "time_s": self.t, "pressure_command_kpa": self.command,
                "displacement": self.displacement, "pressure_kpa": self.pressure, "temperature_c": self.temperature,
                "supply_kpa": self.supply, "path": self.path, "sha256": self.sha256}

    def __len__(self) -> int:
        return int(self.t.size)

    def __repr__(self) -> str:
        length_s = self.t[-1] - self.t[0] if len(self) else 0
        return f"<softgrip.Log {self.name}, {len(self)} samples, {length_s:.6g} s, readings in {self.unit}>"

    def plot(self, axes: Any = None) -> Any:
        """Draws command and displacement over time on two matplotlib axes, and returns the axes."""
        from .results import two_axes
        upper, lower = two_axes(axes)
        upper.plot(self.t, self.command, label="command")
        if self.pressure.size:
            upper.plot(self.t, self.pressure, label="measured")
            upper.legend()
        upper.set_ylabel("pressure [kPa]")
        lower.plot(self.t, self.displacement, ".", markersize=2)
        lower.set_ylabel(f"{'angle' if self.unit == 'deg' else 'displacement'} [{self.unit}]")
        lower.set_xlabel("time [s]")
        return upper, lower
