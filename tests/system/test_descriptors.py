"""Programs that listen, without a free descriptor: they wait, and their connections continue."""

import os
import resource
import socket
import time

import bench
from test_web_limits import processor_s


class Descriptors(bench.BenchTest):
    def check_recordings(self):
        """Nothing is recorded."""

    def test_the_emulator_does_not_spin(self):
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


if __name__ == "__main__":
    bench.main()
