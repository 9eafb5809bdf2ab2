"""Tests a second Modbus client whose reads prevent the watchdog of the board from tripping. The programs must report
this client."""

import contextlib
import json
import socket
import threading
import time

import bench

WATCHDOG_S = 0.5  # time-out of the watchdog in the board map
# Modbus request: function 4, one register from address 0, unit 1.
REQUEST = bytes((0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 1))


class Reader(threading.Thread):
    """A client that reads the first input of the board every 50 ms, as a display would."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.socket = socket.create_connection(("127.0.0.1", port), bench.PATIENCE_S)
        self.ended = threading.Event()
        self.start()

    def run(self):
        with contextlib.suppress(OSError):
            while not self.ended.wait(0.05):
                self.socket.sendall(REQUEST)
                self.socket.recv(64)

    def close(self):
        self.ended.set()
        self.join(bench.PATIENCE_S)
        self.socket.close()


class SecondClient(bench.BenchTest):
    def setUp(self):
        super().setUp()
        board = self.folder / "config/boards/adam-6024.yaml"
        board.write_text(board.read_text() + "  clients: {function: 4, address: 31}\n")

    def reader(self, port):
        reader = Reader(port)
        self.addCleanup(reader.close)
        return reader

    def doctor(self, rig):
        report = json.loads(self.softgrip("doctor", "--rig", rig, "--json", expect=None).stdout)
        return {finding["name"]: finding for finding in report["findings"]}

    def test_a_reading_client_prevents_the_watchdog_trip_and_is_reported(self):
        """Kills the daemon. The requests of the second client then prevent a watchdog trip, so the pressure remains. A
        dead daemon cannot vent, so the daemon must warn of the second client while it runs."""
        emulator = self.emulator("--object", "stone")
        daemon = self.idle_daemon(self.rig(emulator.port))
        self.assertNotIn("another_client", [event["kind"] for event in daemon.events()])
        reader = self.reader(emulator.port)
        told = daemon.wait_for_event("another_client")
        self.assertEqual(told["severity"], "warning")
        self.assertIn("has 2 clients", told["text"])
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        daemon.kill()
        time.sleep(3 * WATCHDOG_S)
        self.assertGreater(min(emulator.commands_kpa()), 5)
        reader.close()
        bench.wait_for("vented valves", lambda: max(emulator.commands_kpa()) == 0)

    def test_doctor_warns_of_a_second_client_and_states_the_count(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        alone = self.doctor(rig)
        self.assertEqual(alone["watchdog"]["verdict"], "warn")
        self.assertIn("even a client that only reads resets the watchdog", alone["watchdog"]["text"])
        self.assertEqual(alone["clients"]["verdict"], "ok")
        self.reader(emulator.port)
        both = self.doctor(rig)
        self.assertEqual(both["clients"]["verdict"], "warn")
        self.assertIn("has 2 clients", both["clients"]["text"])

    def test_a_reading_client_does_not_reset_a_watchdog_that_needs_writes(self):
        board = self.folder / "config/boards/adam-6024.yaml"
        board.write_text(board.read_text().replace("fed_by: any_request", "fed_by: functions\n  functions: [16]"))
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        self.reader(emulator.port)
        self.assertEqual(self.doctor(rig)["watchdog"]["verdict"], "ok")
        daemon = self.idle_daemon(rig)
        daemon.start("track_sine")
        bench.wait_for("pressure", lambda: min(emulator.commands_kpa()) > 5)
        self.assertNotIn("another_client", [event["kind"] for event in daemon.events()])
        daemon.kill()
        bench.wait_for("vented valves", lambda: max(emulator.commands_kpa()) == 0)


if __name__ == "__main__":
    bench.main()
