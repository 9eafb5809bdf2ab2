"""Manages the processes and files of the end-to-end tests. Each test has its own folder and free ports, and no process
or file remains after the test.

The programs come from the build. The environment variable SOFTGRIP_BUILD contains the folder of the build.
"""

import contextlib
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import api_schema
import recording_check

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build" / "release"))
SOFTGRIP = BUILD / "tools" / "softgrip"
SOFTGRIP_RIG = BUILD / "tools" / "softgrip-rig"
SOFTGRIPD = BUILD / "daemon" / "softgripd"

# Factor of the longest waiting times. It is above 1 for tests that use only the idle time of the processors.
PATIENCE = float(os.environ.get("SOFTGRIP_PATIENCE", 1))

# Longest waiting time [s]. It is long, because the machine may be busy. No result of a test depends on this time.
PATIENCE_S = 30 * PATIENCE

# In the tests, the rig runs at 100 Hz, and its bus may be silent for up to 0.6 s.
RATE_HZ = 100
BUS_DOWN_CYCLES = 30  # shorter than the time-out of the board's watchdog


def wait_for(what, condition, patience_s=PATIENCE_S, pause_s=0.02):
    """Calls condition() until its result is true, and returns this result. If the result is not true within
    `patience_s`, fails with the message `what`."""
    end = time.monotonic() + patience_s
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > end:
            raise AssertionError(f"waited {patience_s} s in vain for {what}")
        time.sleep(pause_s)


class Lines:
    """A client that sends and receives lines over a Unix socket."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.settimeout(PATIENCE_S)
        try:
            self.socket.connect(str(path))
        except OSError:
            self.socket.close()
            raise
        self.file = self.socket.makefile("rw", encoding="utf-8", newline="\n")

    def ask(self, line):
        self.file.write(line + "\n")
        self.file.flush()
        answer = self.file.readline()
        if not answer:
            raise AssertionError(f"no answer to {line!r}")
        return answer.rstrip("\n")

    def close(self):
        self.file.close()
        self.socket.close()


def resident_kib(pid):
    """Returns the resident memory of a process [KiB]."""
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text()).group(1))


class Process:
    """A child process whose output goes to files. If the process still runs at the end of the test, the test ends
    it."""

    def __init__(self, name, arguments, folder, environment=None):
        self.name = name
        self.output_path = folder / f"{name}.out"
        self.error_path = folder / f"{name}.err"
        with open(self.output_path, "wb") as output, open(self.error_path, "wb") as error:
            self.child = subprocess.Popen([str(a) for a in arguments], stdout=output, stderr=error,
                                          stdin=subprocess.DEVNULL, cwd=folder, env={**os.environ, **(environment or {})})

    def output(self):
        return self.output_path.read_text(errors="replace")

    def errors(self):
        return self.error_path.read_text(errors="replace")

    def running(self):
        return self.child.poll() is None

    def listening_port(self):
        """Waits until the process prints the address at which it listens, and returns the port."""
        def port():
            if not self.running():
                raise AssertionError(f"{self.name} ended: {self.errors()}")
            found = re.search(r"listening on (?:http://)?[\d.]+:(\d+)/?\n", self.output())
            return found and found.group(1)
        return int(wait_for(f"{self.name} to listen", port))

    def resident_kib(self):
        return resident_kib(self.child.pid)

    def send(self, number):
        self.child.send_signal(number)

    def kill(self):
        """Kills the process with SIGKILL, like the command kill -9."""
        self.child.kill()
        self.child.wait(PATIENCE_S)

    def end(self, number=signal.SIGTERM):
        """Requests that the process ends, and returns its exit code."""
        if self.running():
            self.send(number)
        return self.wait()

    def wait(self):
        try:
            return self.child.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError(f"{self.name} did not end:\n{self.errors()}") from None


class Emulator(Process):
    """A process of softgrip-rig that listens on a free port and has a control socket."""

    def __init__(self, folder, *arguments, port=0, board="adam-6024", name="softgrip-rig"):
        self.control_path = folder / f"{name}.sock"
        boards = ["--board", folder / f"config/boards/{board}.yaml"] if board else []
        super().__init__(name, [SOFTGRIP_RIG, "--model", folder / "config/models/bench_twin.yaml", *boards,
                                "--tcp", port, "--control", self.control_path, *arguments], folder)
        self.port = self.listening_port()
        self.control = Lines(self.control_path)

    def ask(self, line):
        answer = self.control.ask(line)
        if answer.startswith("error"):
            raise AssertionError(f"{line}: {answer}")
        return answer

    def status(self):
        return json.loads(self.ask("status"))

    def commands_kpa(self):
        return [channel["pressure_command_kpa"] for channel in self.status()["channels"]]

    def pressures_kpa(self):
        return [channel["pressure_kpa"] for channel in self.status()["channels"]]


class Daemon(Process):
    """A process of softgripd that uses a rig file in the folder of the test."""

    def __init__(self, folder, rig, name="softgripd", environment=None):
        self.socket_path = folder / "softgripd.sock"
        super().__init__(name, [SOFTGRIPD, "--config", rig], folder, environment)
        wait_for("the daemon's socket", self._listening)
        self.lines = Lines(self.socket_path)
        self.checked = {}  # {command: last reply that has been checked}

    def _listening(self):
        if not self.running():
            raise AssertionError(f"softgripd ended: {self.errors()}")
        with contextlib.suppress(OSError):
            Lines(self.socket_path).close()
            return True
        return False

    def ask(self, command, **arguments):
        text = self.lines.ask(json.dumps({"command": command, **arguments}))
        reply = json.loads(text)
        # A test that waits receives many equal replies, and a check takes longer than the exchange.
        if self.checked.get(command) != text:
            api_schema.check(reply, command)
            self.checked[command] = text
        return reply

    def result(self, command, **arguments):
        reply = self.ask(command, **arguments)
        if not reply["ok"]:
            raise AssertionError(f"{command}: {reply['error']}\n{self.errors()}")
        return reply["result"]

    def status(self):
        return self.result("status")

    def events(self, since=0):
        return self.result("events", since=since, limit=1000)["events"]

    def wait_for_state(self, *states):
        try:
            return wait_for(f"state {states}", lambda: (s := self.status())["state"] in states and s)
        except AssertionError as error:
            raise AssertionError(f"{error}; it is {self.status()['state']}\n{self.errors()}") from None

    def wait_for_event(self, kind, since=0, **keys):
        def find():
            for event in self.events(since):
                if event["kind"] == kind and all(event.get(k) == v for k, v in keys.items()):
                    return event
            return None
        try:
            return wait_for(f"event {kind} {keys}", find)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.errors()}") from None

    def start(self, sequence):
        """Starts a sequence. If the daemon refuses the start because a busy machine has delayed the readings, repeats
        the start."""
        def accepted():
            reply = self.ask("start", sequence=sequence)
            if reply["ok"]:
                return reply["result"]
            if reply["error"].get("refusal", {}).get("name") != "no_valid_reading":
                raise AssertionError(f"start {sequence}: {reply['error']}\n{self.errors()}")
            return None
        return wait_for("readings to start with", accepted)["request"]

    def results(self):
        return [channel["result"] for channel in self.status()["channels"]]


def write_rig(folder, name, new_name, changes):
    """Writes a changed copy of a shipped rig file, with paths in the folder of the test. `changes` contains pairs
    (pattern, replacement). Every pattern must occur in the file."""
    text = (folder / "config" / name).read_text()
    for pattern, replacement in (
            (r"invalid_reading_cycles: \d+", "invalid_reading_cycles: 30"),
            (r"readback_cycles: \d+", "readback_cycles: 30"),
            (r"max_missed_commands: \d+", "max_missed_commands: 30"),
            (r"longest_pause_s: [\d.]+", "longest_pause_s: 0.2"),
            (r"real_time: .*", "real_time: {required: false, priority: 70, cpus: [], lock_memory: false}"),
            (r"directory: /tmp/softgrip-runs", f"directory: {folder}/runs"),
            (r"path: /tmp/softgrip.sock", f"path: {folder}/softgripd.sock"),
            *changes):
        text, count = re.subn(pattern, replacement, text)
        if count == 0:
            raise AssertionError(f"{name} has no {pattern}")
    path = folder / "config" / new_name
    path.write_text(text)
    return path


class BenchTest(unittest.TestCase):
    """A test with its own folder, which contains the shipped configuration. When the test ends, its processes are
    ended."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_system_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        shutil.copytree(SOURCE / "config", self.folder / "config")
        self.processes = []

    def tearDown(self):
        for process in reversed(self.processes):
            if process.running():
                process.kill()
        self.check_recordings()
        result = self._outcome.result
        if any(test is self for test, _ in result.failures + result.errors):
            for process in self.processes:
                print(f"--- {process.name}\n{process.output()[-2000:]}\n{process.errors()[-6000:]}", file=sys.stderr)

    def check_recordings(self):
        """Checks that all recordings of the test have the properties that docs/reliability.md states."""
        for about in sorted((self.folder / "runs").glob("*/run.json")):
            self.assertEqual(recording_check.check(about.parent), [])

    def start_rig(self, *arguments):
        """Starts an emulated rig with a stone between the fingers. Starts its daemon and waits until the daemon is
        idle."""
        self.board = self.emulator("--object", "stone", *arguments)
        self.rig_path = self.rig(self.board.port)
        self.softgripd = self.idle_daemon(self.rig_path)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def rig(self, port, changes=(), name="rig_tcp.yaml"):
        """Writes the shipped TCP rig file with this port, paths in the folder of the test, and the given changes
        (pattern, replacement).

        The control rate is low and the time limits are long, so that a pause of a busy machine causes no fault."""
        return write_rig(self.folder, name, "test_rig.yaml", (
            (r"port: \d+", f"port: {port}"),
            (r"rate_hz: \d+", f"rate_hz: {RATE_HZ}"),
            (r"exchange_deadline_s: [\d.]+", "exchange_deadline_s: 0.15"),
            (r"bus_down_cycles: \d+", f"bus_down_cycles: {BUS_DOWN_CYCLES}"),
            (r"max_age_s: [\d.]+", "max_age_s: 0.35"), *changes))

    def creep_faster(self):
        """Changes the finger of the shipped rigs, and its model, so that the creep of the finger decays within a few
        seconds."""
        path = self.folder / "config/models/bench_twin.yaml"
        text, count = re.subn(r"c1_kpa_s_per_mm: [\d.]+", "c1_kpa_s_per_mm: 20", path.read_text())
        self.assertEqual(count, 1)
        path.write_text(text)

    def emulator(self, *arguments, **keys):
        process = Emulator(self.folder, *arguments, **keys)
        self.processes.append(process)
        self.addCleanup(process.control.close)
        return process

    def daemon(self, rig, environment=None):
        process = Daemon(self.folder, rig, environment=environment)
        self.processes.append(process)
        self.addCleanup(process.lines.close)
        return process

    def idle_daemon(self, rig, environment=None):
        """Starts the daemon and waits until it is idle."""
        process = self.daemon(rig, environment)
        process.wait_for_state("idle")
        return process

    def softgrip(self, *arguments, expect=0, timeout_s=30):
        """Runs softgrip, checks that the exit code is `expect`, and returns the finished process. The command may take
        PATIENCE times `timeout_s`."""
        done = subprocess.run([str(a) for a in (SOFTGRIP, *arguments)], capture_output=True, text=True,
                              timeout=timeout_s * PATIENCE, cwd=self.folder, stdin=subprocess.DEVNULL,
                              env={**os.environ, "SOFTGRIP_SOCKET": str(self.folder / "softgripd.sock")})
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"softgrip {arguments}:\n{done.stdout}\n{done.stderr}")
        return done

    def recordings(self):
        """Returns the folders of the recordings, beginning with the oldest."""
        return sorted(path.parent for path in (self.folder / "runs").glob("*/run.csv"))

    @staticmethod
    def rows(recording, channel=None):
        with open(recording / "run.csv", newline="") as file:
            return [row for row in csv.DictReader(file) if channel in (None, row["channel"])]


def main():
    unittest.main(verbosity=2)
