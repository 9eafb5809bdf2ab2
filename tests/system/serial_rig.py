"""Provides the shipped rig on a serial line. The line is a pseudo-terminal of the emulator, and the bytes take as
long as on a real line. The board has no watchdog and no read-back."""

import os
import resource
import threading
import time

import bench

RATE_HZ = 20


def board_priority():
    """Gives the emulator a higher priority. A real module has its own processor and answers in time even if this
    computer is busy."""
    return ["chrt", "-f", "40"] if resource.getrlimit(resource.RLIMIT_RTPRIO)[0] >= 40 or os.geteuid() == 0 else []


def rig_file(folder, rate_hz, *changes):
    """Writes a rig file with half of the highest possible control rate. The rate is low because a kernel thread
    transfers the bytes of a pseudo-terminal, and this thread has to wait on a busy machine."""
    return bench.write_rig(folder, "rig_rtu.yaml", "serial.yaml", (
        (r"device: .*", f"device: {folder}/line"), (r"rate_hz: \d+", f"rate_hz: {rate_hz}"),
        (r"exchange_deadline_s: [\d.]+", "exchange_deadline_s: 0.3"), (r"bus_down_cycles: \d+", "bus_down_cycles: 30"),
        (r"max_age_s: [\d.]+", "max_age_s: 0.8"), *changes))


class Shared(bench.Emulator):
    """An emulator for a test and a watcher. Both use the same control connection, because the emulator accepts one
    control client at a time. A lock protects this connection."""

    def __init__(self, folder, *arguments):
        self.one_at_a_time = threading.Lock()
        super().__init__(folder, *arguments)

    def ask(self, line):
        with self.one_at_a_time:
            return super().ask(line)


class Emulator(Shared):
    """A process of softgrip-rig on the serial device that the rig file names."""

    def __init__(self, folder, rig, *arguments):
        self.control_path = folder / "softgrip-rig.sock"
        self.one_at_a_time = threading.Lock()
        bench.Process.__init__(self, "softgrip-rig", [
            *board_priority(), bench.SOFTGRIP_RIG, "--model", folder / "config/models/bench_twin.yaml", "--rig", rig, "--control",
            self.control_path, *arguments], folder)
        bench.wait_for("the line", lambda: "listening on" in self.output(), pause_s=0.05)
        self.control = bench.Lines(self.control_path)


class Watcher:
    """Replaces the proxy of the TCP tests. Changes no message, and records the outputs every 5 ms."""

    def __init__(self, emulator):
        self.writes = []
        self.emulator = emulator
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch)
        self.thread.start()

    def watch(self):
        while not self.over.wait(0.005):
            self.writes.append((time.monotonic(), self.emulator.commands_kpa()))

    def close(self):
        self.over.set()
        self.thread.join()
