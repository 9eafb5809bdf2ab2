"""What can go wrong, each with what a program may do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

if TYPE_CHECKING:
    from .messages import Problem, Result, SequenceEnd


class SoftgripError(Exception):
    """The base of all of them."""


class NoDaemon(SoftgripError):
    """Nobody listens on the socket, or this user may not open it."""


class ConnectionLost(SoftgripError):
    """The daemon has gone. `reconnect()` goes on where the events left off."""


class NotAnswered(SoftgripError, TimeoutError):
    """The daemon, or the grip, took longer than the time that was given."""


class ProtocolError(SoftgripError):
    """A line of the daemon is malformed, and the connection is closed; or the daemon does not take the request. `code` is
    the daemon's word, if it gave one."""

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code


class Refused(SoftgripError):
    """The rig's state does not allow it; the text says why and what to do. `code` is `R01` ..., or the daemon's word
    (`busy`, `abandoned`, `not_allowed`)."""

    def __init__(self, message: str, code: str, name: str) -> None:
        super().__init__(f"{message} ({code})")
        self.code = code
        self.name = name


class Owned(Refused):
    """Another client's sequence runs: it may be stopped and vented, nothing else."""


class SequenceRefused(SoftgripError):
    """The sequence cannot be run on this rig."""

    def __init__(self, message: str, problems: tuple[Problem, ...]) -> None:
        super().__init__("\n".join([message, *map(str, problems)]))
        self.problems = problems


class GripFailed(SoftgripError):
    """The grip came to something else than what was waited for."""

    def __init__(self, result: Result, end: Optional[SequenceEnd]) -> None:
        super().__init__(f"the grip's result is {result.value}" +
                         (f", the sequence ended: {end.value}" if end else ""))
        self.result = result
        self.end = end


class StopNotConfirmed(SoftgripError):
    """Leaving the block sent the stop of what the block had started, and no confirmation came: it may still run. The cause
    is in `__cause__`, the exception that left the block in `__context__` of that."""


class MalformedFile(SoftgripError, ValueError):
    """A recording, a log or a report that is not as softgrip writes it."""


# Arguments of the C++ library that have another name here.
_ARGUMENTS = {"time_s": "t", "pressure_kpa": "pressure", "pressure_command_kpa": "command", "supply_kpa": "supply",
              "temperature_c": "temperature", "pressure_min_kpa": "pressure_min", "pressure_max_kpa": "pressure_max",
              "slew_up_kpa_per_s": "slew_up", "slew_down_kpa_per_s": "slew_down", "start_kpa": "start",
              "parameter": "name"}


class InvalidArgument(SoftgripError, ValueError):
    """An argument that no call accepts. The text names the argument, the shape or range that is required, and the unit."""

    def __init__(self, argument: str, message: str) -> None:
        self.argument = _ARGUMENTS.get(argument, argument)
        if message.startswith(f"{argument}: "):
            message = self.argument + message[len(argument):]
        super().__init__(message)

    def __reduce__(self) -> tuple[type[InvalidArgument], tuple[str, str]]:
        return type(self), (self.argument, str(self))


class NoResult(SoftgripError):
    """The arguments are valid, but there is no answer: a model without an inverse, logs that cannot be fitted."""
