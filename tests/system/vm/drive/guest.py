"""Functions for the steps of the system test inside the guest system. They run commands, control the service and the
emulator, and print the result of each step."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

DRIVE = pathlib.Path(__file__).resolve().parent
CONFIGURATION = pathlib.Path("/etc/softgrip")
RIG = CONFIGURATION / "rig_service.yaml"
UNIT = "softgripd.service"
SOCKET = "/run/softgrip/softgripd.sock"
RUNS = pathlib.Path("/var/lib/softgrip/runs")
# Longest waiting time [s]. It is long, because the processor of the guest is emulated. Some steps have limits of their
# own.
PATIENCE_S = 40


class Failed(Exception):
    """Exception for a step that did not have the expected result."""


def expect(condition, what):
    if not condition:
        raise Failed(what)


def sh(command, check=True):
    """Runs a command line and returns both of its output streams as one text. The command must succeed if `check` is
    true."""
    done = subprocess.run(["bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          stdin=subprocess.DEVNULL, check=False)
    if check and done.returncode != 0:
        raise Failed(f"`{command}` ended with {done.returncode}: {done.stdout.strip()[-400:]}")
    return done.stdout


def wait_for(what, condition, patience_s=PATIENCE_S, pause_s=0.1):
    """Calls condition() until its result is true. Returns this result and the time that it took."""
    begin = time.monotonic()
    while True:
        result = condition()
        if result:
            return result, time.monotonic() - begin
        if time.monotonic() - begin > patience_s:
            raise Failed(f"waited {patience_s} s in vain for {what}")
        time.sleep(pause_s)


def ask(path, line):
    """Sends one line to a Unix socket and returns one line, or None if there is no answer."""
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
            connection.settimeout(PATIENCE_S)
            connection.connect(path)
            with connection.makefile("rw", encoding="utf-8", newline="\n") as lines:
                lines.write(line + "\n")
                lines.flush()
                return lines.readline().strip()
    except OSError:
        return ""


class Emulator:
    """A process of softgrip-rig as the board of the installed rig file. This board has no watchdog, so nothing but
    softgrip can vent its outputs."""

    control = "/run/emulator.sock"
    process = None

    def __init__(self):
        self.start()

    def start(self):
        """Starts the service with fingers that have never moved. A finger that has moved would creep back for half a
        minute, and the daemon would refuse a start during this time."""
        if self.process:
            self.process.kill()
            self.process.wait()
        self.process = subprocess.Popen(
            ["softgrip-rig", "--rig", RIG, "--model", CONFIGURATION / "models/bench_twin.yaml", "--object", "stone",
             "--watchdog-s", "0", "--control", self.control], stdout=subprocess.DEVNULL)
        wait_for("the emulator", lambda: ask(self.control, "status"))

    def commands_kpa(self):
        return [channel["pressure_command_kpa"] for channel in json.loads(ask(self.control, "status"))["channels"]]

    def wait_vented(self, within_s):
        _, took_s = wait_for("vented outputs", lambda: max(self.commands_kpa()) == 0, within_s, 0.01)
        return took_s

    def expect_still(self, seconds):
        """Checks that no pressure is commanded for `seconds`."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            expect(max(self.commands_kpa()) == 0, f"the outputs moved: {self.commands_kpa()}")
            time.sleep(0.05)


class Lines:
    """A chip of simulated GPIO lines. The rig file uses the lines and the test switches them. A second chip
    exists that the rig file does not use."""

    label = "softgrip-panel"
    emergency_stop, enable = 0, 1

    def __init__(self):
        sh("modprobe gpio-sim; mountpoint -q /sys/kernel/config || mount -t configfs configfs /sys/kernel/config")
        other, _ = self.plug_in("other", "not-of-softgrip")
        self.chip, self.folder = self.plug_in("panel", self.label)
        wait_for("udev to give the group access to the chip", lambda: sh(f"stat -c '%G %a' /dev/{self.chip}") == "softgrip 660\n")
        sh("udevadm settle")
        expect(sh(f"stat -c '%U %G' /dev/{other}") == "root root\n",
               "udev gave the group access to a chip that no rig file names")

    @staticmethod
    def plug_in(name, label):
        """Adds a simulated GPIO chip with two lines. Returns the name and the folder of the chip."""
        device = pathlib.Path("/sys/kernel/config/gpio-sim") / name
        bank = device / "bank"
        bank.mkdir(parents=True)
        (bank / "num_lines").write_text("2")
        (bank / "label").write_text(label)
        (device / "live").write_text("1")
        chip = (bank / "chip_name").read_text().strip()
        return chip, pathlib.Path("/sys/devices/platform") / (device / "dev_name").read_text().strip() / chip

    def pull(self, line, level):
        (self.folder / f"sim_gpio{line}" / "pull").write_text("pull-up" if level else "pull-down")

    def level(self, line):
        return int((self.folder / f"sim_gpio{line}" / "value").read_text())


class Service:
    """The service softgripd.service. It is observed with systemctl, through its socket and in its journal."""

    @staticmethod
    def show(name):
        return sh(f"systemctl show -p {name} --value {UNIT}").strip()

    def pid(self):
        return int(self.show("MainPID"))

    def restarts(self):
        return int(self.show("NRestarts"))

    @staticmethod
    def request(command, **arguments):
        answer = ask(SOCKET, json.dumps({"command": command, **arguments}))
        return json.loads(answer)["result"] if answer and json.loads(answer)["ok"] else None

    def status(self):
        return self.request("status")

    def state(self):
        status = self.status()
        return status["state"] if status else None

    def wait_idle(self):
        wait_for("an idle daemon", lambda: self.state() == "idle")

    def events(self, since=0):
        result = self.request("events", since=since, limit=1000)
        return result["events"] if result else []

    def newest_event(self):
        return max([event["id"] for event in self.events()], default=0)

    def wait_event(self, kind, since=0, patience_s=PATIENCE_S, **keys):
        def find():
            return [event for event in self.events(since)
                    if event["kind"] == kind and all(event.get(key) == value for key, value in keys.items())]
        return wait_for(f"event {kind} {keys}", find, patience_s)[0][0]

    def thread(self, name):
        """Returns the id of a thread of the daemon."""
        tasks = pathlib.Path(f"/proc/{self.pid()}/task")
        for task in tasks.iterdir():
            if (task / "comm").read_text().strip() == name:
                return int(task.name)
        raise Failed(f"no thread {name}")

    def start_fresh(self, emulator):
        """Restarts the service with new fingers. Waits until the service is idle and its restart count is 0,
        regardless of the previous step."""
        sh(f"systemctl stop {UNIT}; systemctl reset-failed {UNIT}", check=False)
        emulator.start()
        sh(f"systemctl start {UNIT}", check=False)
        self.wait_idle()

    def hold(self):
        """Starts a grip and waits until both fingers hold a stone."""
        expect(self.state() == "idle", f"the daemon is {self.state()}")
        since = self.newest_event()
        sh("softgrip start pick_stone")
        for channel in ("left", "right"):
            self.wait_event("grip_result", since, code="HOLDING", channel=channel)

    @staticmethod
    def journal(since):
        return sh(f"journalctl -q --no-pager -o cat -u {UNIT} --since=@{since:.0f}")


class Steps:
    """Runs functions in order. Prints for each function if its requirements were met."""

    def __init__(self):
        self.failed = []
        self.began = time.monotonic()
        self.count = 0

    def run(self, title, function, *arguments):
        self.count += 1
        begin, wall = time.monotonic(), time.time()
        try:
            remark = function(*arguments)
            verdict = "PASS"
        except (Failed, OSError, ValueError, KeyError, TypeError, subprocess.SubprocessError) as error:
            remark, verdict = f"{type(error).__name__}: {error}", "FAIL"
            self.failed.append(title)
        took_s = time.monotonic() - begin
        print(f"{verdict} {took_s:6.1f} s  {title}{': ' + remark if remark else ''}", flush=True)
        if verdict == "FAIL":
            print(Service.journal(wall - 1)[-3000:], flush=True)
            print(sh(f"systemctl status --no-pager {UNIT}", check=False)[-1500:], flush=True)

    def end(self, name):
        took_s = time.monotonic() - self.began
        if self.failed:
            print(f"{name}: FAILED, {len(self.failed)} of {self.count} steps, {took_s:.0f} s", flush=True)
        else:
            print(f"{name}: PASSED, {self.count} steps, {took_s:.0f} s", flush=True)


def edit(path, *replacements):
    """Replaces each pattern in a file by a text. Each pattern must match at least once."""
    text = path.read_text()
    for pattern, replacement in replacements:
        text, count = re.subn(pattern, replacement, text)
        expect(count > 0, f"{path} has no {pattern}")
    path.write_text(text)


def terminate(process):
    process.send_signal(signal.SIGTERM)
    process.wait(PATIENCE_S)


def main_guard():
    os.environ["PATH"] = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
    sys.stdout.reconfigure(line_buffering=True)
