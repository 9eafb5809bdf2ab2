"""Client of softgripd, the controller of soft pneumatic grippers, and reader of its files.

`Gripper` blocks, `AsyncGripper` is for asyncio; both speak version 1 of the daemon's socket. `Recording` and the
`read_*` functions need NumPy, the clients need nothing but Python.
"""

from .aio import AsyncGripper
from .client import Gripper
from .errors import (ConnectionLost, GripFailed, MalformedFile, NoDaemon, NotAnswered, Owned, ProtocolError, Refused,
                     SequenceRefused, SoftgripError, StopNotConfirmed)
from .messages import (Channel, Checked, Event, Fault, Grip, Hello, Parameter, Problem, Result, Sequence, SequenceEnd,
                       SequenceState, State, Status)

__all__ = [
    "AsyncGripper", "Channel", "Checked", "ConnectionLost", "Event", "Fault", "Grip", "GripFailed", "Gripper", "Hello",
    "MalformedFile", "NoDaemon", "NotAnswered", "Owned", "Parameter", "Problem", "ProtocolError", "Refused", "Result",
    "Sequence", "SequenceEnd", "SequenceRefused", "SequenceState", "SoftgripError", "State", "Status",
    "StopNotConfirmed",
]
