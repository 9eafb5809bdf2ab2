"""The client that blocks."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import Any, Optional

from .errors import ConnectionLost, NoDaemon, NotAnswered, ProtocolError, SoftgripError
from .messages import Checked, Event, Grip, Hello, Listing, Result, Sequence, SequenceEnd, Status
from .session import API, LONGEST_LINE, Session, default_path, start_keys


class Gripper:
    """A connection to softgripd.

    `path`: the daemon's socket; without it $SOFTGRIP_SOCKET, or that of the packaged service. `name`: how it stands in
    the daemon's events; who has one owns the sequences that it starts: others may then only stop and vent.
    `answer_s`: how long an answer may take. Not to be shared by threads.

    As a context manager it stops on exit what it has started and what still runs.
    """

    def __init__(self, path: Optional[str] = None, *, name: str, answer_s: float = 5.0) -> None:
        self.path = path or default_path()
        self.name = name
        self.answer_s = answer_s
        self._session = Session()
        self._socket: Optional[socket.socket] = None
        self._input = b""
        self.hello = self._open()

    def __enter__(self) -> Gripper:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        try:
            if self._session.runs() and self.status().json["sequence"]["ended"] is None:
                self.stop()
        except SoftgripError:
            # It ended by itself meanwhile, or the daemon has gone, whose own rules hold then.
            pass
        finally:
            self.close()

    def close(self) -> None:
        """Ends the connection; what runs goes on running, owned by nobody."""
        if self._socket:
            self._socket.close()
        self._socket = None

    def reconnect(self) -> Hello:
        """After a ConnectionLost. No event is missed that the daemon still keeps; a grip of a daemon that has gone counts
        as ended by a fault."""
        self.close()
        self.hello = self._open()
        return self.hello

    def status(self) -> Status:
        return Status.of(self.ask("status"), "status")

    def sequences(self) -> tuple[Sequence, ...]:
        """What the daemon can be asked to start by name."""
        return Listing.of(self.ask("sequences"), "sequences").sequences

    def start(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Grip:
        """Starts a sequence by its name, or one whose `text` is given. `parameters`: `squeeze_kpa=4`."""
        grip = Grip.of(self.ask("start", **start_keys(sequence, text, parameters)), "start")
        self._session.grip = grip.request
        return grip

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
            self._read(end)

    def wait(self, *, timeout_s: float) -> SequenceEnd:
        """Waits for the end of the sequence that was started last."""
        end = time.monotonic() + timeout_s
        while True:
            how = self._session.ended()
            if how is not None:
                return how
            self._read(end)

    def events(self, *, timeout_s: float) -> Iterator[Event]:
        """Events as they come, none missed; ends when none has come for `timeout_s`."""
        while True:
            end = time.monotonic() + timeout_s
            try:
                while not self._session.events:
                    self._read(end)
            except NotAnswered:
                return
            yield self._session.events.popleft()

    def ask(self, command: str, **keys: Any) -> Mapping[str, Any]:
        """Any command of the socket API, and its result."""
        number, line = self._session.request(command, keys)
        end = time.monotonic() + self.answer_s
        try:
            self._send(line, end)
            while number not in self._session.replies:
                self._read(end)
            return self._session.result_of(number)
        finally:
            self._session.forget(number)

    def _open(self) -> Hello:
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        connection.settimeout(self.answer_s)
        try:
            connection.connect(self.path)
        except OSError as error:
            connection.close()
            raise NoDaemon(f"{self.path}: {error.strerror or error}") from error
        self._socket = connection
        self._input = b""
        try:
            hello = Hello.of(self.ask("hello", client=self.name, api=API), "hello")
            self._session.subscribed(self.ask("subscribe", **self._session.subscription()))
        except BaseException:
            self.close()
            raise
        return hello

    def _connection(self, end: float) -> socket.socket:
        if self._socket is None:
            raise ConnectionLost(f"{self.path}: not connected")
        left = end - time.monotonic()
        if left <= 0:
            raise NotAnswered(f"{self.path}: it took too long")
        self._socket.settimeout(left)
        return self._socket

    def _lost(self, error: Optional[OSError]) -> Exception:
        self.close()
        return self._session.failure or ConnectionLost(f"{self.path}: {error or 'the daemon hung up'}")

    def _send(self, line: bytes, end: float) -> None:
        try:
            self._connection(end).sendall(line)
        except TimeoutError as error:
            raise NotAnswered(f"{self.path}: it took too long") from error
        except OSError as error:
            raise self._lost(error) from error

    def _read(self, end: float) -> None:
        """Takes at least one line."""
        try:
            while b"\n" not in self._input:
                data = self._connection(end).recv(1 << 16)
                if not data:
                    raise self._lost(None)
                self._input += data
                if len(self._input) > LONGEST_LINE and b"\n" not in self._input:
                    self.close()
                    raise ProtocolError(f"a line is longer than {LONGEST_LINE} bytes")
        except TimeoutError as error:
            raise NotAnswered(f"{self.path}: it took too long") from error
        except OSError as error:
            raise self._lost(error) from error
        *lines, self._input = self._input.split(b"\n")
        try:
            for line in lines:
                self._session.receive(line)
        except ProtocolError:
            self.close()
            raise
