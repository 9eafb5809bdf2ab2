"""Shows a board driver. The board of this example answers "SET 12.500" with "POS 2.500". A thread of the program simulates
the board. board_driver.py writes three commands and prints the readings."""

import socket
import threading
import time
from collections.abc import Callable, Sequence
from typing import Optional

import softgrip


class LineBoard(softgrip.Board):
    """After a failed exchange, a late response can still arrive. The driver therefore closes the connection, and
    `connect()` opens a new one."""

    def __init__(self, dial: Callable[[], socket.socket]) -> None:
        self._dial = dial
        self._line: Optional[socket.socket] = None
        self._sequence = 0

    @property
    def channels(self) -> int:
        return 1

    def connect(self, deadline: float) -> None:
        self.close()
        try:
            self._line = self._dial()
        except OSError as error:
            raise softgrip.BusError("disconnected", str(error)) from error

    def close(self) -> None:
        if self._line is not None:
            self._line.close()
        self._line = None

    def exchange(self, commands: Sequence[float], deadline: float) -> Sequence[softgrip.Reading]:
        if self._line is None:
            raise softgrip.BusError("disconnected", "no connection")
        end, reply = time.monotonic() + deadline, b""
        try:
            self._line.settimeout(deadline)
            self._line.sendall(f"SET {commands[0]:.3f}\n".encode())
            while len(reply) < 64 and not reply.endswith(b"\n"):
                self._line.settimeout(max(end - time.monotonic(), 1e-6))
                received = self._line.recv(64)
                if not received:
                    raise ConnectionError("the board closed the connection")
                reply += received
            if not (reply.startswith(b"POS ") and reply.endswith(b"\n")):
                raise ValueError(f"{reply!r} is not a position")
            displacement = float(reply[4:])
        except (OSError, ValueError) as error:
            self.close()
            kind = "bad_reply" if isinstance(error, ValueError) else "disconnected"
            raise softgrip.BusError("timed_out" if isinstance(error, socket.timeout) else kind, str(error)) from error
        self._sequence += 1
        return [softgrip.Reading(displacement, sampled_at=time.monotonic(), sequence=self._sequence)]


def device(line: socket.socket) -> None:
    with line, line.makefile("rw", buffering=1) as text:
        for command in text:
            text.write(f"POS {0.2 * float(command.split()[1]):.3f}\n")


def dial() -> socket.socket:
    here, there = socket.socketpair()
    threading.Thread(target=device, args=[there]).start()
    return here


if __name__ == "__main__":
    board = LineBoard(dial)
    board.connect(deadline=1)
    for command in (0.0, 10.0, 20.0):
        reading, = board.exchange([command], deadline=1)
        print(f"{command:4.1f} kPa: {reading.validity}, {reading.displacement:.1f} mm")
    board.close()
