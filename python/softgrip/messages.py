"""Defines the messages of the daemon as Python objects. The name of a quantity ends with its unit. The value None means
that the daemon does not know the quantity."""

from __future__ import annotations

import dataclasses
import enum
from collections.abc import Mapping
from typing import Any, Optional, TypeVar

from .decoding import decoded, fields_of

T = TypeVar("T")


class Result(str, enum.Enum):
    """The result of a grip, of one finger or of all fingers."""

    HOLDING = "HOLDING"
    NO_PART = "NO PART"
    PART_LOST = "PART LOST"
    RELEASED = "RELEASED"
    ERROR = "ERROR"
    NONE = "-"


class State(str, enum.Enum):
    STARTING = "starting"
    IDLE = "idle"
    RESYNCHRONISING = "resynchronising"
    RUNNING = "running"
    STOPPING = "stopping"
    FAULTED = "faulted"


class SequenceEnd(str, enum.Enum):
    DONE = "done"
    FAILED = "failed"
    STOPPED = "stopped"
    FAULTED = "faulted"


class _AsSaid:
    """Base class of the messages. The names of the fields are the keys of the JSON object."""

    @classmethod
    def of(cls: type[T], json: Any, where: str) -> T:
        """Creates an object from JSON. Raises ProtocolError if the JSON does not match the fields of the class. `where`
        is the location in the message."""
        return decoded(cls, json, where)


@dataclasses.dataclass(frozen=True)
class Hello(_AsSaid):
    api: int
    version: str
    started_at: str  # start time of the daemon, UTC; the ids of its events begin at this time
    role: str  # role of the client: "look" or "operate"
    commands: tuple[str, ...]
    capabilities: tuple[str, ...]

    @property
    def read_only(self) -> bool:
        """Returns True if the client may read the state of the rig, but may not move the rig."""
        return self.role == "look"


@dataclasses.dataclass(frozen=True)
class Fault(_AsSaid):
    code: str  # fault code, such as "F202"
    name: str
    meaning: str
    remedy: str
    channel: Optional[str]  # name of the channel; None: the whole rig
    next: str  # action of the user that resets the fault


@dataclasses.dataclass(frozen=True)
class Channel(_AsSaid):
    """The state of one finger."""

    name: str
    command_kpa: Optional[float]
    pressure_kpa: Optional[float]
    displacement_mm: Optional[float]
    reference_mm: Optional[float]
    residual_mm: Optional[float]
    deficit_mm: Optional[float]
    squeeze_kpa: Optional[float]
    age_s: Optional[float]
    validity: str
    result: Result
    evidence: str
    limit: Optional[str]
    health: str

    @property
    def shortfall_mm(self) -> Optional[float]:
        """Returns the displacement of free motion minus the reading; `deficit_mm` is the deprecated name."""
        return self.deficit_mm


@dataclasses.dataclass(frozen=True)
class SequenceState(_AsSaid):
    """The running sequence, or the last sequence if no sequence runs."""

    name: str
    request: int
    client: Optional[str]
    parameters: Mapping[str, float]
    step: int
    step_name: str
    steps: int
    ended: Optional[SequenceEnd]


@dataclasses.dataclass(frozen=True)
class Status:
    state: State
    result: Result  # overall result of all fingers of the sequence
    channels: tuple[Channel, ...]
    fault: Optional[Fault]
    sequence: Optional[SequenceState]
    owner: Optional[str]
    rig: str
    version: str
    rate_hz: float
    time_s: float  # time since the daemon's start
    json: Mapping[str, Any] = dataclasses.field(repr=False, compare=False)  # the complete status as the daemon sent it

    @classmethod
    def of(cls, json: Mapping[str, Any], where: str) -> Status:
        return cls(**fields_of(cls, {**json, "json": json}, where))

    def channel(self, name: str) -> Channel:
        """Returns the finger with this name. Raises KeyError if no finger has this name."""
        for channel in self.channels:
            if channel.name == name:
                return channel
        raise KeyError(name)


@dataclasses.dataclass(frozen=True)
class Event(_AsSaid):
    id: int
    time_s: float
    at: str  # time of the event, UTC
    kind: str
    severity: str
    text: str
    channel: Optional[str] = None
    code: Optional[str] = None
    request: Optional[int] = None
    client: Optional[str] = None
    value: Optional[float] = None
    parameters: Optional[Mapping[str, float]] = None


@dataclasses.dataclass(frozen=True)
class Parameter(_AsSaid):
    name: str
    unit: str
    lower: float
    upper: float
    default: float
    about: str


@dataclasses.dataclass(frozen=True)
class Problem(_AsSaid):
    """A problem of a sequence, with its location."""

    file: str
    line: int
    column: int
    line_text: str
    message: str
    hint: str

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}:{self.column}" if self.line_text else self.file
        return f"{where}: {self.message}" + (f" ({self.hint})" if self.hint else "")


@dataclasses.dataclass(frozen=True)
class Sequence(_AsSaid):
    """A sequence file in the daemon's sequence directory."""

    name: str
    about: str
    parameters: tuple[Parameter, ...]
    problems: tuple[Problem, ...]


@dataclasses.dataclass(frozen=True)
class Grip(_AsSaid):
    """A grip: a sequence that was started."""

    request: int  # number by which events and recordings identify this start
    warnings: tuple[Problem, ...] = ()


@dataclasses.dataclass(frozen=True)
class WouldStart(_AsSaid):
    """The part of the daemon's reply to a check that describes the sequence that a start would run."""

    name: str
    parameters: Mapping[str, float]
    steps: int


@dataclasses.dataclass(frozen=True)
class CheckReply(_AsSaid):
    would_start: WouldStart
    warnings: tuple[Problem, ...] = ()


@dataclasses.dataclass(frozen=True)
class Checked:
    """The result of a check: the sequence that a start would run."""

    name: str
    parameters: Mapping[str, float]
    steps: int
    warnings: tuple[Problem, ...]

    @classmethod
    def of(cls, json: Any, where: str) -> Checked:
        said = CheckReply.of(json, where)
        return cls(said.would_start.name, said.would_start.parameters, said.would_start.steps, said.warnings)


@dataclasses.dataclass(frozen=True)
class Listing(_AsSaid):
    """The reply to the request `sequences`."""

    sequences: tuple[Sequence, ...]


@dataclasses.dataclass(frozen=True)
class Subscribed(_AsSaid):
    """The reply to the request `subscribe`."""

    since: int
    started_at: str


@dataclasses.dataclass(frozen=True)
class Refusal(_AsSaid):
    code: str  # code of the refusal, such as "R02"
    name: str


@dataclasses.dataclass(frozen=True)
class Failure(_AsSaid):
    """The error in a reply."""

    code: str
    message: str
    problems: tuple[Problem, ...] = ()
    refusal: Optional[Refusal] = None


@dataclasses.dataclass(frozen=True)
class Reply(_AsSaid):
    id: Optional[int]  # id of the request; None: the daemon could not read the request
    ok: bool
    result: Optional[Mapping[str, Any]] = None
    error: Optional[Failure] = None
