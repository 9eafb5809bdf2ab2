"""Limits, PID, controller and boards. The computations are those of the daemon, for one finger.

Times are in s, pressures in kPa, displacements in the unit of the model. Only one thread at a time may use an object.
"""

from __future__ import annotations

import abc
import dataclasses
import math
from collections.abc import Sequence
from typing import Any, Optional

from . import _core
from .arguments import text_of
from .errors import BusError, InvalidArgument
from .models import Model, _number, _vector, _whole

_NAN = math.nan
_MOST_SEQUENCE = 2**32 - 1


def _finite(argument: str, value: float, unit: str = "") -> float:
    number = _number(argument, value, unit)
    if not math.isfinite(number):
        raise InvalidArgument(argument, f"{argument}: {number} is not a finite number{' in ' + unit if unit else ''}")
    return number


def _instance(argument: str, value: Any, kind: type) -> Any:
    if not isinstance(value, kind):
        raise InvalidArgument(argument, f"{argument}: {type(value).__name__} is no {kind.__name__}")
    return value


@dataclasses.dataclass(frozen=True)
class Limits:
    """Limits of one finger: pressures [kPa], slew rates [kPa/s], displacements in the unit of the model. `rest` is the
    command while the finger rests [kPa]."""

    pressure_min: float = 0
    pressure_max: float = 0
    slew_up: float = 300
    slew_down: float = 300
    displacement_min: float = -1e6
    displacement_max: float = 1e6
    rest: float = 0

    def __post_init__(self) -> None:
        for name, unit in (("pressure_min", "kPa"), ("pressure_max", "kPa"), ("slew_up", "kPa/s"), ("slew_down", "kPa/s"),
                           ("displacement_min", ""), ("displacement_max", ""), ("rest", "kPa")):
            object.__setattr__(self, name, _finite(name, getattr(self, name), unit))
        for name, lower, upper in (("pressure_max", self.pressure_min, self.pressure_max),
                                   ("displacement_max", self.displacement_min, self.displacement_max),
                                   ("slew_up", 0, self.slew_up), ("slew_down", 0, self.slew_down)):
            if not upper > lower:
                raise InvalidArgument(name, f"{name}: {upper} is not above {lower}")

    def _values(self) -> tuple[float, float, float, float, float, float, float]:
        return (self.pressure_min, self.pressure_max, self.slew_up, self.slew_down, self.displacement_min,
                self.displacement_max, self.rest)


@dataclasses.dataclass(frozen=True)
class LimitedCommand:
    """A command [kPa] within the limits, and the reasons why it differs from the requested pressure."""

    command: float
    saturated: bool  # True: the requested pressure is outside the pressure range
    slewing: bool  # True: the slew limits do not yet allow the requested pressure
    invalid: bool  # True: the requested pressure is not a number, so the result is the last command


def limit(limits: Limits, wanted: float, last: float, elapsed: float) -> LimitedCommand:
    """Returns the command for a requested pressure.

    wanted: requested pressure [kPa]; for NaN, the result is the last command. last: last command [kPa]. elapsed: time
    since the last command [s].

    >>> limit(Limits(pressure_max=60, slew_up=100), wanted=50, last=0, elapsed=0.1)
    LimitedCommand(command=10.0, saturated=False, slewing=True, invalid=False)
    """
    elapsed = _finite("elapsed", elapsed, "s")
    if elapsed < 0:
        raise InvalidArgument("elapsed", f"elapsed: {elapsed} s is below 0 s")
    return LimitedCommand(*_core.limit(_instance("limits", limits, Limits)._values(), _number("wanted", wanted, "kPa"),
                                       _finite("last", last, "kPa"), elapsed))


@dataclasses.dataclass(frozen=True)
class PidSettings:
    """Gains of a PID controller: kp [kPa per unit of the model], ki [kPa per unit and s], kd [kPa s per unit].

    derivative_filter: time constant [s]. setpoint_weight: factor of the reference in the proportional part, 0 to 1.
    anti_windup: "back_calculation" (with the time constant tracking_time [s]), "conditional" or "none".
    """

    kp: float = 0
    ki: float = 0
    kd: float = 0
    derivative_filter: float = 0.02
    setpoint_weight: float = 1
    anti_windup: str = "back_calculation"
    tracking_time: float = 0.5

    def _values(self) -> tuple[float, float, float, float, float, str, float]:
        return (_number("kp", self.kp), _number("ki", self.ki), _number("kd", self.kd),
                _number("derivative_filter", self.derivative_filter, "s"), _number("setpoint_weight", self.setpoint_weight),
                text_of("anti_windup", self.anti_windup), _number("tracking_time", self.tracking_time, "s"))


class Pid:
    """A PID controller with two degrees of freedom. In each period, call `step()`, pass the sum of feedback and
    feedforward to `limit()`, and pass the limited command to `sent()`.

    >>> pid = Pid(PidSettings(kp=2), tick=0.01)
    >>> pid.step(reference=5, measurement=4)
    2.0
    """

    def __init__(self, settings: PidSettings, tick: float) -> None:
        """Creates a PID controller. tick: period of `step()` [s]."""
        self._core = _core.Pid(_instance("settings", settings, PidSettings)._values(), _number("tick", tick, "s"))

    def align(self, command: float) -> None:
        """Sets the integrator such that the next `step()` continues from the command `command` [kPa]."""
        self._core.align(_finite("command", command, "kPa"))

    def step(self, reference: float, measurement: float, feedforward: float = 0) -> float:
        """Returns the feedback [kPa]. The requested pressure is the sum of the feedback and the `feedforward` [kPa]."""
        return self._core.step(_finite("reference", reference), _finite("measurement", measurement),
                               _finite("feedforward", feedforward, "kPa"))

    def hold(self, feedforward: float = 0) -> float:
        """Returns the feedback [kPa] for a period without a usable measurement. The integrator and the derivative do
        not change."""
        return self._core.hold(_finite("feedforward", feedforward, "kPa"))

    def sent(self, command: float) -> None:
        """Receives the command [kPa] that was sent after the limits. The anti-windup uses this command."""
        self._core.sent(_finite("command", command, "kPa"))


class Reference:
    """A reference that is known in advance. It consists of up to 8 segments. In ramps and holds, value, rate and
    acceleration are continuous.

    >>> reference = Reference(0).ramp_to(6, duration=2).hold_for(1)
    >>> reference.at(1), reference.end
    (3.0, 3.0)
    """

    def __init__(self, value: float = 0, *, start: float = 0) -> None:
        """Creates a reference that holds a value from the time `start` [s] on."""
        self._core = _core.Reference(_finite("value", value))
        self._core.start(_finite("start", start, "s"), _finite("value", value))

    def ramp_to(self, value: float, duration: float) -> Reference:
        """Appends a minimum-jerk ramp to `value` with a duration [s]."""
        self._core.ramp_to(_number("value", value), _number("duration", duration, "s"))
        return self

    def hold_for(self, duration: float) -> Reference:
        """Appends a segment with a duration [s] in which the reference keeps its last value."""
        self._core.hold_for(_number("duration", duration, "s"))
        return self

    def sine(self, mean: float, amplitude: float, frequency: float, cycles: float) -> Reference:
        """Appends mean - amplitude cos(2 pi f t) with the frequency f [Hz]. Before the sine, the reference should be at
        mean - amplitude."""
        self._core.sine(_number("mean", mean), _number("amplitude", amplitude), _number("frequency", frequency, "Hz"),
                        _number("cycles", cycles))
        return self

    def at(self, time: float) -> float:
        """Returns the value of the reference at a time [s]."""
        return self._core.at(_finite("time", time, "s"))

    @property
    def end(self) -> float:
        """Returns the time at which the last segment ends [s]."""
        return self._core.end()


@dataclasses.dataclass(frozen=True)
class Reading:
    """Reading of one channel. `pressure` [kPa] and `temperature` [degrees Celsius] are NaN without a sensor.
    `sampled_at` is the time of the sample on the clock of the program [s]. `sequence` is the number of responses of the
    board so far. `validity`: "valid", "none_yet", "out_of_range", "sensor_error", "jumped", "frozen" or "stale"."""

    displacement: float
    pressure: float = _NAN
    temperature: float = _NAN
    sampled_at: float = 0
    sequence: int = 0
    validity: str = "valid"

    def _values(self) -> tuple[float, float, float, float, int, str]:
        return (_number("displacement", self.displacement), _number("pressure", self.pressure, "kPa"),
                _number("temperature", self.temperature), _number("sampled_at", self.sampled_at, "s"),
                _whole("sequence", self.sequence, _MOST_SEQUENCE), text_of("validity", self.validity))


class Board(abc.ABC):
    """An I/O board with one output and one set of inputs per channel. To write a driver for a board, derive a class
    from Board."""

    @property
    @abc.abstractmethod
    def channels(self) -> int:
        """Returns the number of channels."""

    @abc.abstractmethod
    def exchange(self, commands: Sequence[float], deadline: float) -> Sequence[Reading]:
        """Writes one pressure [kPa] per channel and reads all channels, within a deadline [s]. Raises `BusError` if
        this fails."""

    def connect(self, deadline: float) -> None:
        """Opens or reopens the connection to the board, within a deadline [s]. The outputs of the board keep their
        values. Raises `BusError` if this fails."""

    def describe(self) -> str:
        """Returns a description of the board for the user, in one line with product and address."""
        return type(self).__name__


@dataclasses.dataclass(frozen=True)
class SimulatedObject:
    """An object that a simulated finger touches. `position`: displacement at contact. `yielding`: ratio of the motion
    beyond the contact to the motion without an object, 0 (rigid) to 1."""

    position: float
    yielding: float = 0.1

    def _values(self) -> tuple[float, float]:
        return _finite("position", self.position), _finite("yielding", self.yielding)


@dataclasses.dataclass(frozen=True)
class SimulatedFinger:
    """One channel of a `SimulatedBoard`: the model of its finger, an object that the finger can touch, the standard
    deviation of a reading, the range of the output [kPa], and the seed of the random numbers for all noise."""

    model: Model
    object: Optional[SimulatedObject] = None
    noise: float = 0
    pressure_min: float = 0
    pressure_max: float = 100
    seed: int = 1

    def _values(self) -> tuple[Any, ...]:
        return (_instance("model", self.model, Model)._core, _object_values(self.object), _number("noise", self.noise),
                _number("pressure_min", self.pressure_min, "kPa"), _number("pressure_max", self.pressure_max, "kPa"),
                _whole("seed", self.seed))


def _object_values(value: Optional[SimulatedObject]) -> Optional[tuple[float, float]]:
    return None if value is None else _instance("object", value, SimulatedObject)._values()


class SimulatedBoard(Board):
    """A simulated board to which simulated fingers are connected; the daemon uses this board too. The clock of the
    board changes only in `advance()`.

    >>> board = SimulatedBoard([SimulatedFinger(Model.load("config/models/bench_twin.yaml"))])
    >>> board.connect()
    >>> for _ in range(400):
    ...     reading, = board.exchange([20])
    ...     board.advance(0.005)
    >>> round(reading.displacement)
    9
    """

    def __init__(self, fingers: Sequence[SimulatedFinger], tick: float = 0.005) -> None:
        """Creates a board. fingers: settings of the fingers, one entry per channel, 1 to 16 entries. tick: usual time
        between two calls of `exchange()` [s], at least 1e-6 and at least 1/100000 of the dead time of each model."""
        try:
            values = [_instance("fingers", one, SimulatedFinger)._values() for one in fingers]
        except TypeError as error:
            raise InvalidArgument("fingers", "fingers: a list of SimulatedFinger is required") from error
        self._core = _core.SimulatedBoard(values, _number("tick", tick, "s"))

    @property
    def channels(self) -> int:
        return self._core.channels()

    def connect(self, deadline: float = 1) -> None:
        status, detail = self._core.connect(_number("deadline", deadline, "s"))
        if status != "ok":
            raise BusError(status, detail)

    def exchange(self, commands: Sequence[float], deadline: float = 1) -> tuple[Reading, ...]:
        values = [float(value) for value in _vector("commands", commands, "kPa")]
        status, detail, readings = self._core.exchange(values, _number("deadline", deadline, "s"))
        if status != "ok":
            raise BusError(status, detail)
        return tuple(Reading(*one) for one in readings)

    def describe(self) -> str:
        return self._core.describe()

    @property
    def now(self) -> float:
        """Returns the time of the board's clock [s], which starts at 1 s."""
        return self._core.now()

    def advance(self, duration: float) -> None:
        """Advances the board's clock by a duration [s]. The next call of `exchange()`, `displacement()` or `set_object()`
        simulates this duration, so its computation time increases with the duration."""
        self._core.advance(_number("duration", duration, "s"))

    def set_object(self, channel: int, value: Optional[SimulatedObject]) -> None:
        """Places an object at the finger of a channel at the time `now`; None removes the object."""
        self._core.set_object(_whole("channel", channel), _object_values(value))

    def displacement(self, channel: int = 0) -> float:
        """Returns the true displacement of a finger at the time `now`, without the errors of its sensor."""
        return self._core.displacement(_whole("channel", channel))


@dataclasses.dataclass(frozen=True)
class ControlOutput:
    """Result of `Controller.tick()`. A value that is not available is NaN."""

    command: float  # command for the board [kPa], within the limits
    reference: float  # value of the reference at this time; NaN while no reference is followed
    displacement: float  # last valid reading of the displacement
    feedforward: float  # feedforward part of the requested pressure [kPa]
    feedback: float  # feedback part of the requested pressure [kPa]
    residual: float  # reading minus the reading that the model predicts
    validity: str  # validity of the reading after the plausibility check
    saturated: bool
    slewing: bool
    out_of_reach: bool  # True if the feedforward cannot reach the reference


class Controller:
    """Controller of one finger. The controller adds feedforward and PID feedback, limits the sum, and checks the
    plausibility of the readings."""

    def __init__(self, model: Model, limits: Limits, pid: PidSettings = PidSettings(), *, feedforward: str = "full_model",
                 extra_latency: float = 0, tick: float = 0.005, sensor_noise: float = 0.05,
                 reading_max_age: float = 0.05) -> None:
        """feedforward: "full_model", "bouc_wen" or "none". extra_latency: time from a command to the output of the board
        [s]. tick: period of `tick()` [s]. sensor_noise: standard deviation of a reading. reading_max_age: longest age of a
        reading that is used [s].
        """
        self._core = _core.Controller(
            _instance("model", model, Model)._core, _instance("limits", limits, Limits)._values(),
            _instance("pid", pid, PidSettings)._values(), text_of("feedforward", feedforward),
            _number("extra_latency", extra_latency, "s"), _number("tick", tick, "s"), _number("sensor_noise", sensor_noise),
            _number("reading_max_age", reading_max_age, "s"))

    def start(self, command: float) -> None:
        """Starts the control of a finger that rests under a command [kPa]."""
        self._core.start(_finite("command", command, "kPa"))

    def follow(self, reference: Reference) -> None:
        """Follows a reference from the next tick on. The times of the reference are on the clock of the argument `now`
        of `tick()`."""
        self._core.follow(_instance("reference", reference, Reference)._core)

    def hold(self) -> None:
        """Holds the present command from the next tick on."""
        self._core.hold()

    def vent(self) -> None:
        """Goes to the rest pressure from the next tick on, within the slew limits."""
        self._core.vent()

    def pressure(self, pressure: float) -> None:
        """Goes to a pressure [kPa] from the next tick on, within the slew limits and without feedback."""
        self._core.pressure(_finite("pressure", pressure, "kPa"))

    def tick(self, now: float, reading: Reading) -> ControlOutput:
        """Executes one period and returns its output. now: time of the period [s], on the clock of
        `Reading.sampled_at`."""
        return ControlOutput(*self._core.tick(_number("now", now, "s"), _instance("reading", reading, Reading)._values()))
