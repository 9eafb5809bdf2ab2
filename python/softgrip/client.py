"""The client of softgripd whose methods block."""

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

    `path`: socket of the daemon; the default is $SOFTGRIP_SOCKET or the socket of the packaged service. `name`: name of
    this client in the daemon's events. A client with a name owns the sequences that it starts. While such a sequence
    runs, other clients may only stop the sequence or vent the fingers. `answer_s`: longest time until the daemon
    replies [s]. Threads must not share an object.

    At the end of a `with` block, the object stops those sequences that it has started itself and that may still run.
    Raises StopNotConfirmed if the daemon does not confirm the stop within `answer_s`.
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
        """Ends the connection. A running sequence continues and has no owner. After this call, the end of the `with`
        block does not stop the sequence."""
        self._session.starts.clear()
        if self._wire:
            self._wire.close()
        self._wire = None

    def reconnect(self) -> Hello:
        """Connects to the daemon after a ConnectionLost. After this call, `events()` returns the events that the client
        has missed, as far as the daemon still stores them. If the daemon was restarted, the last grip counts as ended
        by a fault."""
        if self._wire:
            self._wire.close()
        self.hello = self._open()
        return self.hello

    def status(self) -> Status:
        return Status.of(self.ask("status"), "status")

    def sequences(self) -> tuple[Sequence, ...]:
        """Returns the sequences that the daemon can start by name."""
        return Listing.of(self.ask("sequences"), "sequences").sequences

    def start(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Grip:
        """Starts the sequence with the name `sequence`. If `text` is given, `text` is the content of the sequence.
        Additional keyword arguments are parameters of the sequence, for example `squeeze_kpa=4`."""
        return Grip.of(self.ask("start", **start_keys(sequence, text, parameters)), "start")

    def check(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Checked:
        """Makes all checks of `start()`, but does not start the sequence. Raises the same exceptions as `start()`."""
        return Checked.of(self.ask("start", dry_run=True, **start_keys(sequence, text, parameters)), "start")

    def stop(self) -> None:
        """Stops the sequence. The channels take the safe action that the rig file gives for the sequence's phase."""
        self.ask("stop")

    def vent(self) -> None:
        """Vents all channels. The daemon never refuses this request to a client that may operate the rig."""
        self.ask("vent")

    def release(self) -> None:
        """Continues with the release step of the sequence. Without a running sequence, vents the fingers that are still
        under pressure."""
        self.ask("release")

    def acknowledge(self) -> None:
        """Resets the latched fault if its cause no longer exists. The fingers do not move."""
        self.ask("acknowledge")

    def wait_until(self, *wanted: Result, timeout_s: float) -> Result:
        """Waits until the overall result of the last start is one of `wanted`, and returns this result. A result that
        was reported before the call counts, until a call has returned it and the sequence has reported a later result
        or has ended. If the last start has no reply yet, the call also waits for the reply. Raises GripFailed if the
        grip reports NO PART, PART LOST or ERROR and this result is not in `wanted`, also if the grip reported a result
        in `wanted` before. Also raises GripFailed if the sequence ends without such a result, or ends other than with
        `done`."""
        end = time.monotonic() + timeout_s
        while True:
            result = self._session.reached(frozenset(wanted))
            if result is not None:
                return result
            self._connected().read(self._session, end)

    def wait(self, *, timeout_s: float) -> SequenceEnd:
        """Waits for the end of the sequence that was started last. If the start has no reply yet, the call also waits for
        the reply."""
        end = time.monotonic() + timeout_s
        while True:
            how = self._session.ended()
            if how is not None:
                return how
            self._connected().read(self._session, end)

    def events(self, *, timeout_s: float) -> Iterator[Event]:
        """Yields all events in the order in which they occurred. The iteration ends after `timeout_s` seconds without
        an event."""
        while True:
            end = time.monotonic() + timeout_s
            try:
                while not self._session.events:
                    self._connected().read(self._session, end)
            except NotAnswered:
                return
            yield self._session.events.popleft()

    def ask(self, command: str, **keys: Any) -> Mapping[str, Any]:
        """Sends a request of the socket API and returns its result. `command` is the name of the request."""
        return self._connected().ask(self._session, command, keys, time.monotonic() + self.answer_s)

    def _open(self) -> Hello:
        end = time.monotonic() + self.answer_s
        self._wire = Wire(self.path, end)
        self._session.failure = None  # it belonged to the previous connection
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
        """Stops the sequences that this client started. The stop request is sent without any request before it, so that
        a daemon that does not respond now receives the stop later. Each stop names one start. Therefore, it ends no
        other sequence, and it cancels a start that the daemon has not received yet."""
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
            # The connection was lost, or an exception interrupted this client while it sent a request.
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
