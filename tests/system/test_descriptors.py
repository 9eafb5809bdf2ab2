"""Tests servers that cannot open another file descriptor. The servers must wait without using processor time, and their
existing connections must continue."""

import os
import resource
import socket
import time

import bench
from test_web_limits import processor_s


class Descriptors(bench.BenchTest):
    def check_recordings(self):
        """Replaces the check of recordings, because the tests of this class record nothing."""

    def test_the_emulator_without_free_descriptors_does_not_busy_wait(self):
        rig = self.emulator()
        pid = rig.child.pid
        in_use = len(os.listdir(f"/proc/{pid}/fd"))
        resource.prlimit(pid, resource.RLIMIT_NOFILE, (in_use, in_use))
        for _ in range(8):
            client = socket.create_connection(("127.0.0.1", rig.port), bench.PATIENCE_S)
            self.addCleanup(client.close)
        time.sleep(1)
        before = processor_s(pid)
        time.sleep(4)
        self.assertLess(processor_s(pid) - before, 0.4, "of 4 s")
        self.assertEqual(len(rig.commands_kpa()), 2, "the control connection continues")

    def test_a_lowered_limit_ends_only_the_newest_connections_of_the_emulator(self):
        rig = self.emulator()
        descriptors = f"/proc/{rig.child.pid}/fd"
        in_use = rig.status() and len(os.listdir(descriptors))
        clients = [socket.create_connection(("127.0.0.1", rig.port), bench.PATIENCE_S) for _ in range(8)]
        for client in clients:
            self.addCleanup(client.close)
        bench.wait_for("all clients", lambda: rig.status() and len(os.listdir(descriptors)) == in_use + 8)
        resource.prlimit(rig.child.pid, resource.RLIMIT_NOFILE, (8, 8))
        clients[-1].settimeout(bench.PATIENCE_S)
        self.assertEqual(clients[-1].recv(1), b"")
        self.assertEqual(len(rig.commands_kpa()), 2, "the control connection continues")


if __name__ == "__main__":
    bench.main()
