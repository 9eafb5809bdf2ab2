"""Defines the exceptions of the package. The docstring of each exception describes its cause."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

if TYPE_CHECKING:
    from .messages import Problem, Result, SequenceEnd


class SoftgripError(Exception):
    """The base class of all exceptions of this package."""


class NoDaemon(SoftgripError):
    """No daemon listens on the socket, or this user has no permission to open it."""


class ConnectionLost(SoftgripError):
    """The connection to the daemon was lost. After `Gripper.reconnect()` or `AsyncGripper.connect()`, `events()`
    continues with the events that the client has missed, as far as the daemon still stores them."""


class NotAnswered(SoftgripError, TimeoutError):
    """The daemon did not reply, or the grip did not end, before the time-out of the call."""


class ProtocolError(SoftgripError):
    """A line of the daemon is malformed, or the daemon does not accept the request. After a malformed line, the
    connection is closed. `code` is the error code of the daemon, if the daemon sent one."""

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code


class Refused(SoftgripError):
    """The state of the rig does not allow the request. The text gives the reason and the remedy. `code` is `R01` or a
    similar code of a refusal, or one of the daemon's codes `busy`, `abandoned` and `not_allowed`."""

    def __init__(self, message: str, code: str, name: str) -> None:
        super().__init__(f"{message} ({code})")
        self.code = code
        self.name = name
        self._message = message

    def __reduce__(self) -> tuple[type[Refused], tuple[str, str, str]]:
        return type(self), (self._message, self.code, self.name)


class Owned(Refused):
    """A sequence of another client runs, so only stop and vent are allowed."""


class SequenceRefused(SoftgripError):
    """The sequence does not fit this rig, so the daemon refuses to start it."""

    def __init__(self, message: str, problems: tuple[Problem, ...]) -> None:
        super().__init__("\n".join([message, *map(str, problems)]))
        self.problems = problems
        self._message = message

    def __reduce__(self) -> tuple[type[SequenceRefused], tuple[str, tuple[Problem, ...]]]:
        return type(self), (self._message, self.problems)


class GripFailed(SoftgripError):
    """The grip ended with a result other than the expected result."""

    def __init__(self, result: Result, end: Optional[SequenceEnd]) -> None:
        super().__init__(f"the grip's result is {result.value}" +
                         (f", the sequence ended: {end.value}" if end else ""))
        self.result = result
        self.end = end

    def __reduce__(self) -> tuple[type[GripFailed], tuple[Result, Optional[SequenceEnd]]]:
        return type(self), (self.result, self.end)


class StopNotConfirmed(SoftgripError):
    """At the end of a `with` block, the daemon did not confirm the stop of the sequences that the block had started.
    These sequences may still run. `__cause__` is the reason. `__context__` of the reason is the exception that ended
    the block."""


class MalformedFile(SoftgripError, ValueError):
    """The content of a file is invalid, or the file cannot be read or written. Examples are recordings, logs, models and
    reports."""


class UnreadableFile(OSError, MalformedFile):
    """A model or a log cannot be opened. The attributes `errno` and `filename` are those of `OSError`."""


class MissingFile(FileNotFoundError, UnreadableFile):
    """A model or a log does not exist."""


# Arguments of the C++ library that have a different name in this package.
_ARGUMENTS = {"time_s": "t", "pressure_kpa": "pressure", "pressure_command_kpa": "command", "supply_kpa": "supply",
              "temperature_c": "temperature", "pressure_min_kpa": "pressure_min", "pressure_max_kpa": "pressure_max",
              "slew_up_kpa_per_s": "slew_up", "slew_down_kpa_per_s": "slew_down", "start_kpa": "start",
              "parameter": "name", "rest_kpa": "rest", "kp_kpa_per_mm": "kp", "ki_kpa_per_mm_s": "ki",
              "kd_kpa_s_per_mm": "kd", "derivative_filter_s": "derivative_filter", "tracking_time_s": "tracking_time",
              "tick_s": "tick", "extra_latency_s": "extra_latency", "reading_max_age_s": "reading_max_age"}


class InvalidArgument(SoftgripError, ValueError):
    """An invalid argument. The text names the argument, the required number or range of values, and the unit."""

    def __init__(self, argument: str, message: str) -> None:
        self.argument = _ARGUMENTS.get(argument, argument)
        if message.startswith(f"{argument}: "):
            message = self.argument + message[len(argument):]
        super().__init__(message)

    def __reduce__(self) -> tuple[type[InvalidArgument], tuple[str, str]]:
        return type(self), (self.argument, str(self))


class BusError(SoftgripError):
    """An exchange with a board failed. `status` is the kind of failure, such as "timed_out" or "disconnected"."""

    def __init__(self, status: str, detail: str = "") -> None:
        super().__init__(f"{status}: {detail}" if detail else status)
        self.status = status
        self.detail = detail

    def __reduce__(self) -> tuple[type[BusError], tuple[str, str]]:
        return type(self), (self.status, self.detail)


class NoResult(SoftgripError):
    """The arguments are valid, but the function cannot compute a result. Examples are a model without an inverse, and
    logs that cannot be fitted."""
