"""Disturbs the soak test between and during its sequences. The disturbances are clients that connect and leave, a
full disk, and pauses of the process. Some pauses are shorter and some are longer than the time-out of the board's
watchdog. Each disturbance has a required result, and any other result counts as unexpected.
"""

import os
import random
import signal
import subprocess
import time

import bench

SHORT_PAUSE_S = 0.03  # the rig of the soak test must tolerate this pause
LONG_PAUSE_S = 0.8    # longer than the time-out of the board's watchdog
SETTLED_KPA = 0.1
RUNS_MIB = 64         # size of a separate disk for the recordings [MiB], if this user may mount one


class Runs:
    """The folder of the recordings. It is a separate file system if this user may mount one."""

    def __init__(self, folder):
        self.path = folder / "runs"
        self.path.mkdir()
        self.mounted = os.geteuid() == 0 and subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={RUNS_MIB}m", "softgrip-soak", self.path], capture_output=True).returncode == 0
        self.ballast = self.path / "ballast"

    def fill(self):
        with open(self.ballast, "wb", buffering=0) as file:
            try:
                while file.write(bytes(1 << 16)):
                    pass
            except OSError:
                return

    def free(self):
        self.ballast.unlink(missing_ok=True)

    def end(self):
        if self.mounted:
            subprocess.run(["umount", self.path], capture_output=True)


class Disturbances:
    """Runs one disturbance after the other, each during its own sequence. `soak` provides the daemon and the
    emulator, and records each unexpected result."""

    def __init__(self, soak, runs, seed):
        self.soak, self.runs, self.chance = soak, runs, random.Random(seed)
        self.done = {"clients": 0, "short pauses": 0, "long pauses": 0, "full disks": 0}

    def start(self, sequence="pick_stone"):
        self.soak.emulator.ask("object back")
        self.soak.emulator.ask("object stone")
        self.soak.daemon.start(sequence)
        time.sleep(self.chance.uniform(0.5, 6))  # after this time, the sequence is in its approach, its closing or its
                                                 # hold

    def finish(self, what):
        """Waits until the sequence has ended normally."""
        bench.wait_for(f"the end beside {what}", lambda: self.soak.daemon.status()["state"] in ("idle", "faulted"), 60, 0.25)
        self.soak.take_events()
        ended = self.soak.daemon.status()["sequence"]["ended"]
        if ended != "done":
            self.soak.note(f"{what}: the sequence ended {ended}")

    def clients(self):
        """Connects clients that disconnect at different times: after the answer to their request, before the answer,
        in the middle of a line, or before any request."""
        self.start()
        for number in range(200):
            client = bench.Lines(self.soak.folder / "softgripd.sock")
            if number % 4 == 0:
                client.ask('{"command": "status"}')
            elif number % 4 == 1:
                client.socket.sendall(b'{"command": "events"}\n' * 10)
            elif number % 4 == 2:
                client.socket.sendall(b'{"command": "sta')
            client.close()
            self.done["clients"] += 1
        self.finish("clients that come and go")

    def stopped(self, for_s):
        self.soak.daemon.send(signal.SIGSTOP)
        time.sleep(for_s)
        self.soak.daemon.send(signal.SIGCONT)

    def short_pause(self):
        self.start()
        self.stopped(SHORT_PAUSE_S)
        self.done["short pauses"] += 1
        self.finish(f"a pause of {SHORT_PAUSE_S} s")

    def long_pause(self):
        """Pauses the process until the board has vented. The daemon must then have a fault, and no pressure may rise
        until the fault is acknowledged and a sequence is started."""
        self.start()
        self.stopped(LONG_PAUSE_S)
        risen, began = [], time.monotonic()
        while time.monotonic() < began + 1:
            pressure_kpa = max(self.soak.emulator.commands_kpa())
            if pressure_kpa > SETTLED_KPA:
                risen.append((time.monotonic() - began, pressure_kpa))
        self.done["long pauses"] += 1
        codes = {event["code"] for event in self.soak.take_events(awaited=("fault_latched",))
                 if event["kind"] == "fault_latched"}
        if "F303" not in codes:
            self.soak.note(f"a pause of {LONG_PAUSE_S} s: faults {sorted(codes)}")
        if risen:
            self.soak.note(f"a pause of {LONG_PAUSE_S} s: {max(kpa for _, kpa in risen):.4g} kPa after the board "
                           f"had vented, seen {risen[0][0]:.4f} to {risen[-1][0]:.4f} s after it")

    def full_disk(self):
        if not self.runs.mounted:
            return
        self.start()
        self.runs.fill()
        bench.wait_for("the end on a full disk", lambda: self.soak.daemon.status()["state"] in ("idle", "faulted"), 60, 0.25)
        time.sleep(1.2)  # waits until the recording has ended
        events = self.soak.take_events(awaited=("recording_failed",))
        self.done["full disks"] += 1
        if self.soak.daemon.status()["sequence"]["ended"] != "done":
            self.soak.note(f"a full disk: ended {self.soak.daemon.status()['sequence']['ended']}")
        if not any(event["kind"] == "recording_failed" for event in events):
            self.soak.note("a full disk: no event says that the recording failed")
        self.runs.free()
        self.soak.remove_recordings()

    def round(self):
        for one in (self.clients, self.short_pause, self.long_pause, self.full_disk):
            one()
            self.soak.recover()
            time.sleep(1.2)  # waits until the recording has ended
            self.soak.read_recordings()
