"""The client that blocks."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import Any, Optional

from .errors import ConnectionLost, NotAnswered, ProtocolError, Refused, SoftgripError
from .messages import Checked, Event, Grip, Hello, Listing, Result, Sequence, SequenceEnd, Status
from .session import API, NOT_RUNNING, START_ID, Session, default_path, start_keys
from .wire import Wire


class Gripper:
    """A connection to softgripd.

    `path`: the daemon's socket; without it $SOFTGRIP_SOCKET, or that of the packaged service. `name`: how it stands in
    the daemon's events; who has one owns the sequences that it starts: others may then only stop and vent.
    `answer_s`: how long an answer may take. Not to be shared by threads.

    As a context manager it stops on exit what it has started and what may still run, and nothing else. StopNotConfirmed
    if the daemon does not confirm that within `answer_s`.
    """

    def __init__(self, path: Optional[str] = None, *, name: str, answer_s: float = 5.0) -> None:
        self.path = path or default_path()
        self.name = name
        self.answer_s = answer_s
        self._session = Session()
        self._wire: Optional[Wire] = None
        self.hello = self._open()

    def __enter__(self) -> Gripper:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        try:
            self._stop_own()
        finally:
            self.close()

    def close(self) -> None:
        """Ends the connection. A sequence that runs continues without an owner: leaving the block does not stop it any
        more."""
        self._session.starts.clear()
        if self._wire:
            self._wire.close()
        self._wire = None

    def reconnect(self) -> Hello:
        """After a ConnectionLost. No event is missed that the daemon still keeps; a grip of a daemon that has gone counts
        as ended by a fault."""
        if self._wire:
            self._wire.close()
        self.hello = self._open()
        return self.hello

    def status(self) -> Status:
        return Status.of(self.ask("status"), "status")

    def sequences(self) -> tuple[Sequence, ...]:
        """What the daemon can be asked to start by name."""
        return Listing.of(self.ask("sequences"), "sequences").sequences

    def start(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Grip:
        """Starts a sequence by its name, or one whose `text` is given. `parameters`: `squeeze_kpa=4`."""
        return Grip.of(self.ask("start", **start_keys(sequence, text, parameters)), "start")

    def check(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Checked:
        """Everything that a start would check, and no motion; raises what the start would raise."""
        return Checked.of(self.ask("start", dry_run=True, **start_keys(sequence, text, parameters)), "start")

    def stop(self) -> None:
        """Ends the sequence; the outputs go where the rig file says for the phase."""
        self.ask("stop")

    def vent(self) -> None:
        """Everything down. Never refused to who may operate."""
        self.ask("vent")

    def release(self) -> None:
        """On with the sequence's release step; or lets down what is still under pressure."""
        self.ask("release")

    def acknowledge(self) -> None:
        """Clears the latched fault, once its cause is gone; nothing moves."""
        self.ask("acknowledge")

    def wait_until(self, *wanted: Result, timeout_s: float) -> Result:
        """Waits until all fingers together have come to one of the results since the last start, and returns it. Every
        result counts once, also one that came and went before this call. GripFailed if it came to NO PART, PART LOST
        or ERROR instead, or ended."""
        end = time.monotonic() + timeout_s
        while True:
            result = self._session.reached(frozenset(wanted))
            if result is not None:
                return result
            self._connected().read(self._session, end)

    def wait(self, *, timeout_s: float) -> SequenceEnd:
        """Waits for the end of the sequence that was started last."""
        end = time.monotonic() + timeout_s
        while True:
            how = self._session.ended()
            if how is not None:
                return how
            self._connected().read(self._session, end)

    def events(self, *, timeout_s: float) -> Iterator[Event]:
        """Events as they come, none missed; ends when none has come for `timeout_s`."""
        while True:
            end = time.monotonic() + timeout_s
            try:
                while not self._session.events:
                    self._connected().read(self._session, end)
            except NotAnswered:
                return
            yield self._session.events.popleft()

    def ask(self, command: str, **keys: Any) -> Mapping[str, Any]:
        """Any command of the socket API, and its result."""
        return self._connected().ask(self._session, command, keys, time.monotonic() + self.answer_s)

    def _open(self) -> Hello:
        end = time.monotonic() + self.answer_s
        self._wire = Wire(self.path, end)
        try:
            hello = Hello.of(self.ask("hello", client=self.name, api=API), "hello")
            self._session.greeted(hello)
            self._session.subscribed(self.ask("subscribe", **self._session.subscription()))
        except BaseException:
            self._wire.close()
            raise
        return hello

    def _connected(self) -> Wire:
        if self._wire is None:
            raise ConnectionLost(f"{self.path}: not connected")
        return self._wire

    def _stop_own(self) -> None:
        """Nothing is asked first: a daemon that is silent at present hears the stop later. The stop names the start, so it
        ends nothing else, and a start that is still on its way does not begin."""
        end = time.monotonic() + self.answer_s
        failure: Optional[SoftgripError] = None
        for start_id in tuple(self._session.starts):
            try:
                self._stop_start(start_id, end)
                self._session.starts.pop(start_id, None)
            except SoftgripError as error:
                failure = error
        self._session.raise_unconfirmed(failure)

    def _stop_start(self, start_id: str, end: float) -> None:
        try:
            self._ask_stop(self._connected(), self._session, start_id, end)
        except (ConnectionLost, ProtocolError):
            # The connection has gone, or an exception has interrupted it in the middle of a line.
            wire = Wire(self.path, end)
            try:
                self._ask_stop(wire, Session(), start_id, end)
            finally:
                wire.close()

    @staticmethod
    def _ask_stop(wire: Wire, session: Session, start_id: str, end: float) -> None:
        try:
            wire.ask(session, "stop", {START_ID: start_id}, end)
        except Refused as refused:
            if refused.name != NOT_RUNNING:
                raise
