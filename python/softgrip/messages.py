"""What the daemon says, as values. Units stand at the end of every name; None is what is not known."""

from __future__ import annotations

import dataclasses
import enum
from collections.abc import Mapping
from typing import Any, Optional, TypeVar

T = TypeVar("T")


class Result(str, enum.Enum):
    """The answer to a grip, of one finger or of all."""

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


def _taken(cls: Any, json: Mapping[str, Any]) -> dict[str, Any]:
    """The keys that the class has; a newer daemon may say more."""
    return {field.name: json[field.name] for field in dataclasses.fields(cls) if field.name in json}


class _AsSaid:
    """Its fields are the keys of the JSON."""

    @classmethod
    def of(cls: type[T], json: Mapping[str, Any]) -> T:
        return cls(**_taken(cls, json))


@dataclasses.dataclass(frozen=True)
class Hello:
    api: int
    version: str
    started_at: str  # of the daemon, UTC; event ids count from there
    role: str  # "look" or "operate"
    commands: tuple[str, ...]
    capabilities: tuple[str, ...]

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Hello:
        return cls(json["api"], json["version"], json["started_at"], json["role"], tuple(json["commands"]),
                   tuple(json["capabilities"]))


@dataclasses.dataclass(frozen=True)
class Fault(_AsSaid):
    code: str  # "F202"
    name: str
    meaning: str
    remedy: str
    channel: Optional[str]  # None: the whole rig
    next: str  # what clears it


@dataclasses.dataclass(frozen=True)
class Channel:
    """One finger."""

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

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Channel:
        taken = _taken(cls, json)
        taken["result"] = Result(taken["result"])
        return cls(**taken)


@dataclasses.dataclass(frozen=True)
class SequenceState:
    """The sequence that runs, or ran last."""

    name: str
    request: int
    client: Optional[str]
    parameters: Mapping[str, float]
    step: int
    step_name: str
    steps: int
    ended: Optional[SequenceEnd]

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> SequenceState:
        taken = _taken(cls, json)
        taken["ended"] = SequenceEnd(taken["ended"]) if taken["ended"] else None
        return cls(**taken)


@dataclasses.dataclass(frozen=True)
class Status:
    state: State
    result: Result  # of all fingers of the sequence
    channels: tuple[Channel, ...]
    fault: Optional[Fault]
    sequence: Optional[SequenceState]
    owner: Optional[str]
    rig: str
    version: str
    rate_hz: float
    time_s: float  # since the daemon's start
    json: Mapping[str, Any] = dataclasses.field(repr=False, compare=False)  # all that it said

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Status:
        return cls(State(json["state"]), Result(json["result"]), tuple(Channel.of(c) for c in json["channels"]),
                   Fault.of(json["fault"]) if json["fault"] else None,
                   SequenceState.of(json["sequence"]) if json["sequence"] else None, json["owner"], json["rig"],
                   json["version"], json["rate_hz"], json["time_s"], json)

    def channel(self, name: str) -> Channel:
        """The finger of that name; KeyError if there is none."""
        for channel in self.channels:
            if channel.name == name:
                return channel
        raise KeyError(name)


@dataclasses.dataclass(frozen=True)
class Event(_AsSaid):
    id: int
    time_s: float
    at: str  # UTC
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
    """What is wrong with a sequence, and where."""

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
class Sequence:
    """A file of the daemon's sequence directory."""

    name: str
    about: str
    parameters: tuple[Parameter, ...]
    problems: tuple[Problem, ...]

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Sequence:
        return cls(json["name"], json["about"], tuple(Parameter.of(p) for p in json["parameters"]),
                   tuple(Problem.of(p) for p in json["problems"]))


@dataclasses.dataclass(frozen=True)
class Grip:
    """A sequence that was started."""

    request: int  # under which events and recordings name it
    warnings: tuple[Problem, ...]

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Grip:
        return cls(json["request"], tuple(Problem.of(p) for p in json.get("warnings", ())))


@dataclasses.dataclass(frozen=True)
class Checked:
    """What a start would have begun."""

    name: str
    parameters: Mapping[str, float]
    steps: int
    warnings: tuple[Problem, ...]

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Checked:
        would = json["would_start"]
        return cls(would["name"], would["parameters"], would["steps"],
                   tuple(Problem.of(p) for p in json.get("warnings", ())))
