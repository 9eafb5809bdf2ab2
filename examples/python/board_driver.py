"""Shows a board driver. The board of this example answers "SET 12.500" with "POS 2.500". A thread of the program simulates
the board.

board_driver.py writes three commands and prints the readings.
"""

import socket
import threading
import time
from collections.abc import Sequence

import softgrip


class LineBoard(softgrip.Board):
    def __init__(self, line: socket.socket) -> None:
        self._line = line
        self._replies = line.makefile("r")
        self._sequence = 0

    @property
    def channels(self) -> int:
        return 1

    def exchange(self, commands: Sequence[float], deadline: float) -> Sequence[softgrip.Reading]:
        self._line.settimeout(deadline)
        try:
            self._line.sendall(f"SET {commands[0]:.3f}\n".encode())
            word, position = self._replies.readline().split()
            displacement = float(position)
        except socket.timeout as error:
            raise softgrip.BusError("timed_out", "no response within the deadline") from error
        except OSError as error:
            raise softgrip.BusError("disconnected", str(error)) from error
        except ValueError as error:
            raise softgrip.BusError("bad_reply", str(error)) from error
        if word != "POS":
            raise softgrip.BusError("bad_reply", f"{word!r} is not POS")
        self._sequence += 1
        return [softgrip.Reading(displacement, sampled_at=time.monotonic(), sequence=self._sequence)]

    def describe(self) -> str:
        return "line board"


def device(line: socket.socket) -> None:
    with line, line.makefile("rw") as text:
        for command in text:
            text.write(f"POS {0.2 * float(command.split()[1]):.3f}\n")
            text.flush()


def main() -> None:
    here, there = socket.socketpair()
    player = threading.Thread(target=device, args=[there])
    player.start()
    with here:
        board = LineBoard(here)
        board.connect(deadline=1)
        for command in (0.0, 10.0, 20.0):
            reading, = board.exchange([command], deadline=1)
            print(f"{command:4.1f} kPa: {reading.validity}, {reading.displacement:.1f} mm")
        here.shutdown(socket.SHUT_RDWR)
    player.join()


if __name__ == "__main__":
    main()
