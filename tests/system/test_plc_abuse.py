"""Tests softgrip-plc with hostile Modbus clients. They must get only refusals, and the PLC must keep its
connection."""

import contextlib
import os
import random
import resource
import socket
import struct
import time

import bench
import plc
from test_web_limits import processor_s


class Abuse(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.start_rig()
        self.gateway = plc.Plc(self.folder, changes=((r"idle_s: 60", "idle_s: 5"),))
        self.processes.append(self.gateway)
        self.master = plc.Master(self.gateway)
        self.addCleanup(self.master.close)
        self.master.wait("state", plc.IDLE)

    def connect(self):
        client = socket.create_connection(("127.0.0.1", self.gateway.port))
        self.addCleanup(client.close)
        client.settimeout(bench.PATIENCE_S)
        return client

    def assert_well(self):
        """Checks that the PLC gets answers on its first connection, and that the rig has not moved."""
        self.assertTrue(self.gateway.running())
        self.assertEqual(self.master.read("state"), plc.IDLE)
        status = self.softgripd.status()
        self.assertEqual((status["state"], status["fault"]), ("idle", None))
        self.assertEqual(plc.started(self.softgripd), [])

    def test_a_thousand_connections_do_not_disturb_the_plc(self):
        crowd = []
        for _ in range(1000):
            crowd.append(self.connect())
            if len(crowd) % 5 == 0:
                # The PLC must send requests regularly, and the 1000 connections take seconds on a busy machine.
                self.master.read("state")
            if len(crowd) % 100 == 0:
                self.assert_well()
        # The gateway keeps three connections in addition to that of the PLC. It closes such a connection after five
        # seconds without a request.
        ends = sum(self.is_at_its_end(client) for client in crowd)
        self.assertGreaterEqual(ends, 997)
        self.assert_well()

    def test_the_gateway_without_free_descriptors_does_not_busy_wait(self):
        pid = self.gateway.child.pid
        in_use = len(os.listdir(f"/proc/{pid}/fd"))
        resource.prlimit(pid, resource.RLIMIT_NOFILE, (in_use, in_use))
        for _ in range(8):
            self.connect()
            # The PLC sends requests, because the gateway closes an idle connection when a new client connects.
            self.master.read("state")
        before = processor_s(pid)
        for _ in range(40):
            time.sleep(0.1)
            self.master.read("state")
        self.assertLess(processor_s(pid) - before, 0.4, "of 4 s")
        self.assert_well()

    def test_a_lowered_limit_of_descriptors_ends_only_the_newest_connections(self):
        descriptors = f"/proc/{self.gateway.child.pid}/fd"
        in_use = len(os.listdir(descriptors))
        crowd = [self.connect() for _ in range(3)]
        bench.wait_for("all connections", lambda: self.master.read("state") and len(os.listdir(descriptors)) == in_use + 3)
        resource.prlimit(self.gateway.child.pid, resource.RLIMIT_NOFILE, (5, 5))
        self.assertTrue(self.is_at_its_end(crowd[-1]))
        self.assert_well()

    def is_at_its_end(self, client):
        client.settimeout(0.5)
        try:
            return client.recv(1) == b""
        except ConnectionResetError:
            return True
        except TimeoutError:
            return False

    def test_a_client_that_sends_one_byte_per_second_is_disconnected(self):
        """Tests a client that sends one byte per second and never completes its request of 260 bytes. After `idle_s`,
        the gateway must close this connection in favour of another client."""
        slow = self.connect()
        began = time.monotonic()
        for byte in struct.pack(">HHHB", 1, 0, 254, 1) + b"\x10" * 253:
            try:
                slow.send(bytes((byte,)))
                slow.settimeout(0.5)
                if slow.recv(1) == b"":
                    break
            except TimeoutError:
                self.assert_well()
            except (BrokenPipeError, ConnectionResetError):
                break
            self.assertLess(time.monotonic() - began, bench.PATIENCE_S)
        self.assertGreater(time.monotonic() - began, 4)
        self.assert_well()

    def test_a_client_that_reads_no_replies_does_not_disturb_the_plc(self):
        deaf = self.connect()
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
        deaf.setblocking(False)
        question = struct.pack(">HHHBBHH", 1, 0, 6, 1, 3, 100, 11)
        sent, began = 0, time.monotonic()
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            while time.monotonic() - began < 8:
                try:
                    sent += deaf.send(question * 200)
                except BlockingIOError:
                    time.sleep(0.05)
                    self.assert_well()
        self.assertGreater(sent, 10_000)
        self.assertLess(self.gateway.resident_kib(), 64 * 1024)
        self.assert_well()

    def test_random_malformed_frames_do_not_disturb_the_plc(self):
        """Generates frames that are cut off, damaged or joined, and frames with a wrong function, address, count or
        length. No frame is a valid command, because the generator omits values that could be a command."""
        seed = 20261122
        chance = random.Random(seed)
        for turn in range(1500):
            data = bytearray()
            for _ in range(chance.randrange(1, 4)):
                function = chance.choice((1, 2, 3, 4, 5, 6, 15, 16, 22, 23, 43, 0, 128, 255))
                first = chance.choice((1, 99, 100, 110, 111, 120, 199, 200, 65535, chance.randrange(8, 65536)))
                body = struct.pack(">BHH", function, first, chance.choice((0, 1, 2, 124, 125, 126, 65535)))
                body += chance.randbytes(chance.randrange(0, 8))
                length = len(body) + 1 if chance.random() < 0.7 else chance.randrange(65536)
                protocol = 0 if chance.random() < 0.9 else chance.randrange(65536)
                data += struct.pack(">HHHB", chance.randrange(65536), protocol, length, chance.randrange(256)) + body
            if chance.random() < 0.3:
                del data[chance.randrange(len(data)):]
            with self.subTest(f"seed {seed}, turn {turn}: {bytes(data).hex()}"):
                self.check_answers(bytes(data))
            if turn % 100 == 0:
                self.assert_well()
        self.assert_well()

    def check_answers(self, data):
        """Checks that the answer consists of complete frames, with at most one frame per request. Instead of an
        answer, the gateway may close the connection."""
        with socket.create_connection(("127.0.0.1", self.gateway.port)) as client:
            client.settimeout(bench.PATIENCE_S)
            answer = b""
            with contextlib.suppress(OSError):
                client.sendall(data)
                client.shutdown(socket.SHUT_WR)
                while piece := client.recv(4096):
                    answer += piece
        frames = 0
        while answer:
            self.assertGreaterEqual(len(answer), 9)
            protocol, length = struct.unpack(">HH", answer[2:6])
            self.assertEqual(protocol, 0)
            self.assertGreaterEqual(len(answer), 6 + length)
            answer = answer[6 + length:]
            frames += 1
        self.assertLessEqual(frames, len(data) // 8)


if __name__ == "__main__":
    bench.main()
