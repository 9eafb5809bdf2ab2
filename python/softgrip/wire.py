"""Implements the connection of the blocking client: sends and receives lines over the daemon's socket."""

from __future__ import annotations

import socket
import time
from collections.abc import Mapping
from typing import Any, Optional, Union

from .errors import ConnectionLost, NoDaemon, NotAnswered, ProtocolError
from .session import LONGEST_LINE, Session

# Time between two attempts to connect while the daemon's queue of waiting clients is full.
CONNECT_PAUSE_S = 0.01


class Wire:
    """A connection to the daemon. `torn` is True if an exception, such as KeyboardInterrupt, may have left a line that
    was sent only in part."""

    def __init__(self, path: str, end: float) -> None:
        self.path = path
        self.torn = False
        self._input = bytearray()
        self._socket: Optional[socket.socket] = _connected(path, end)

    def close(self) -> None:
        if self._socket:
            self._socket.close()
        self._socket = None

    def ask(self, session: Session, command: str, keys: Mapping[str, Any], end: float) -> Mapping[str, Any]:
        """Sends a request, waits for the reply, and returns the result."""
        number, line = session.request(command, keys)
        try:
            self._send(session, line, end)
            while number not in session.replies:
                self.read(session, end)
            return session.result_of(number)
        finally:
            session.forget(number)

    def read(self, session: Session, end: float) -> None:
        """Receives bytes until at least one line is complete, and processes the complete lines."""
        received: Union[bytes, bytearray] = self._input
        while b"\n" not in received:
            if len(self._input) > LONGEST_LINE:
                self.close()
                raise ProtocolError(f"a line is longer than {LONGEST_LINE} bytes")
            received = self._receive(session, end)
        *lines, self._input = self._input.split(b"\n")
        try:
            for line in lines:
                session.receive(bytes(line))
        except ProtocolError:
            self.close()
            raise

    def _receive(self, session: Session, end: float) -> bytes:
        try:
            data = self._ready(end).recv(1 << 16)
        except socket.timeout as error:
            raise self._late() from error
        except OSError as error:
            raise self._lost(session, error) from error
        if not data:
            raise self._lost(session, None)
        self._input += data
        return data

    def _send(self, session: Session, line: bytes, end: float) -> None:
        if self.torn:
            self.close()
        connection = self._ready(end)
        self.torn = True
        try:
            connection.sendall(line)
        except socket.timeout as error:
            raise self._late() from error
        except OSError as error:
            raise self._lost(session, error) from error
        self.torn = False

    def _ready(self, end: float) -> socket.socket:
        if self._socket is None:
            raise ConnectionLost(f"{self.path}: not connected")
        left = end - time.monotonic()
        if left <= 0:
            raise self._late()
        self._socket.settimeout(left)
        return self._socket

    def _late(self) -> NotAnswered:
        return NotAnswered(f"{self.path}: time limit exceeded")

    def _lost(self, session: Session, error: Optional[OSError]) -> Exception:
        """Returns the exception for a lost connection. If the last message of the daemon was an error, the result is
        the exception for this error, because it is more specific than ConnectionLost."""
        self.close()
        return session.failure or ConnectionLost(f"{self.path}: {error or 'the daemon closed the connection'}")


def _connected(path: str, end: float) -> socket.socket:
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        while True:
            connection.settimeout(max(end - time.monotonic(), CONNECT_PAUSE_S))
            try:
                connection.connect(path)
                return connection
            except BlockingIOError:
                if time.monotonic() > end:
                    raise
                time.sleep(CONNECT_PAUSE_S)
    except OSError as error:
        connection.close()
        raise NoDaemon(f"{path}: {error.strerror or error}") from error
    except BaseException:
        connection.close()
        raise
