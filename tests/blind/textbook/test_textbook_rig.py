"""Tests that textbook-rig responds like the board that it simulates. Also tests that its fingers behave like the
fingers of textbook-world."""
import pathlib
import re
import socket
import statistics
import struct
import subprocess
import sys
import time
import unittest

RIG = pathlib.Path(sys.argv.pop(1))
OUTPUTS_AT, READ_BACK_AT = 256, 24


class Master:
    """A Modbus TCP client that writes the outputs and reads the inputs with function code 23."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        self.number = 0

    def exchange(self, output_v, read_at=0, count=8):
        written = b"".join(struct.pack(">f", volts) for volts in output_v)
        body = struct.pack(">BBHHHHB", 1, 23, read_at, 2 * count, OUTPUTS_AT, len(written) // 2, len(written)) + written
        self.number += 1
        self.socket.sendall(struct.pack(">HHH", self.number, 0, len(body)) + body)
        answer = b""
        while len(answer) < 9 + 4 * count:
            part = self.socket.recv(1000)
            if not part:
                raise AssertionError("the rig has gone")
            answer += part
        return struct.unpack(f">{count}f", answer[9:])

    def stay(self, output_v, seconds):
        """Writes `output_v` repeatedly for `seconds`. Returns the mean values that were read in the last 0.3 s."""
        end, seen = time.monotonic() + seconds, []
        while time.monotonic() < end:
            seen.append((time.monotonic(), self.exchange(output_v)))
            time.sleep(0.005)
        last = [values for at, values in seen if at > end - 0.3]
        return [statistics.fmean(column) for column in zip(*last)]


class TextbookRig(unittest.TestCase):
    def setUp(self):
        self.process = subprocess.Popen([RIG, "--make", "play", "--seed", "3", "--fingers", "2"], stdout=subprocess.PIPE,
                                        text=True)
        self.addCleanup(self.process.stdout.close)
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        self.master = Master(int(re.search(r":(\d+)$", self.process.stdout.readline().strip())[1]))
        self.addCleanup(self.master.socket.close)

    def test_a_finger_follows_its_own_valve(self):
        seen = self.master.stay([3, 0], 2.0)
        displacement_mm, pressure_kpa = [5 * v - 5 for v in seen[:2]], [10 * v for v in seen[4:6]]
        self.assertAlmostEqual(pressure_kpa[0], 30, delta=1.5)
        self.assertAlmostEqual(pressure_kpa[1], 0, delta=0.5)
        self.assertGreater(displacement_mm[0], 3)
        self.assertAlmostEqual(displacement_mm[1], 0, delta=0.1)
        vented = self.master.stay([0, 3], 2.0)
        # The limit is large, because the hysteresis remains and the creep disappears slowly.
        self.assertLess(5 * vented[0] - 5, displacement_mm[0] / 2)
        # Both fingers have the same parameters, so the same command must cause the same displacement.
        self.assertAlmostEqual(5 * vented[1] - 5, displacement_mm[0], delta=0.1)

    def test_outputs_are_read_back_one_exchange_later(self):
        self.master.exchange([2.5, 1.25])
        self.master.exchange([2.5, 1.25])
        self.assertEqual(self.master.exchange([2.5, 1.25], READ_BACK_AT, 2), (2.5, 1.25))

    def test_the_rig_process_ends_if_the_client_disconnects(self):
        self.master.exchange([0, 0])
        self.master.socket.close()
        self.assertEqual(self.process.wait(10), 0)


if __name__ == "__main__":
    unittest.main()
