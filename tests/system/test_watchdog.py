"""Tests that the daemon notifies the watchdog of the service manager while the loop, the bus and the service thread
run. If one of these threads stalls, the daemon must stop these notifications."""

import contextlib
import os
import pathlib
import socket
import subprocess
import sys
import time

import bench

HANG_THREAD = pathlib.Path(__file__).parent / "vm/drive/hang_thread.py"
WATCHDOG_S = 0.4  # watchdog time-out of the service; the daemon sends four notifications during this time


class Watchdog(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.notices = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.notices.close)
        self.notices.bind(str(self.folder / "notify"))
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        environment = {"NOTIFY_SOCKET": str(self.folder / "notify"), "WATCHDOG_USEC": str(int(WATCHDOG_S * 1e6))}
        os.environ.update(environment)
        try:
            self.daemon_ = self.daemon(rig)
        finally:
            for name in environment:
                del os.environ[name]
        self.daemon_.wait_for_state("idle")

    def notices_for(self, seconds):
        """Returns the messages that the daemon sends to the service manager in the next `seconds`."""
        texts, end = [], time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.notices.settimeout(left)
            with contextlib.suppress(TimeoutError):
                texts.append(self.notices.recv(4096).decode())
        return texts

    def thread(self, name):
        for task in pathlib.Path(f"/proc/{self.daemon_.child.pid}/task").iterdir():
            if (task / "comm").read_text().strip() == name:
                return task.name
        raise AssertionError(f"no thread {name}")

    def starves_when(self, name, patience_s=2):
        self.assertGreater(self.notices_for(2).count("WATCHDOG=1"), 4)
        hang = subprocess.Popen([sys.executable, HANG_THREAD, self.thread(name)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(hang.stdout.close)
        self.addCleanup(hang.wait)
        self.addCleanup(self.daemon_.kill)
        if hang.stdout.readline() != "hangs\n":
            self.skipTest("this user may not trace another process")
        self.notices_for(patience_s)  # the daemon waits for this time before it treats the thread as stalled
        notices = self.notices_for(2)
        self.assertNotIn("WATCHDOG=1", notices)
        self.assertTrue(self.daemon_.running())  # the daemon must not end by itself; only the service manager ends it

    def test_a_stalled_loop_stops_the_watchdog_notifications(self):
        self.starves_when("softgrip-loop")

    def test_a_stalled_bus_thread_stops_the_watchdog_notifications(self):
        self.starves_when("softgrip-bus")

    def test_a_stalled_service_thread_stops_the_watchdog_notifications(self):
        self.starves_when("softgrip-serve", patience_s=4)


if __name__ == "__main__":
    bench.main()
