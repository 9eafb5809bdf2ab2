"""Runs the system test inside the guest system. It installs the package, exposes the service to many failures, and
purges the package.

  steps.py [SEED]    SEED determines the random times of the failures; without SEED, a random seed is used and printed
"""

import hashlib
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

from guest import (CONFIGURATION, DRIVE, RIG, RUNS, UNIT, Emulator, Failed, Lines, Service, Steps, edit, expect, main_guard, sh,
                   wait_for)

service = Service()
# WatchdogSec= of the service [s]. For each thread, the longest stall [s] during which softgripd must still notify the
# service manager.
WATCHDOG_S = 2.0
STANDSTILL_S = {"softgrip-loop": 0.55, "softgrip-bus": 1.05, "process": 0}
# Time [s] that the emulated processor needs to start a program in the sandbox of the service. A real processor needs
# less than 0.1 s.
START_S = 3.0
DROP_IN = pathlib.Path(f"/run/systemd/system/{UNIT}.d/system-test.conf")
# Files that the system writes during the test, and copies of the user database that tools make.
NOT_COMPARED = ("/proc", "/sys", "/dev", "/run", "/tmp", "/mnt", "/var/log", "/var/lib/dpkg", "/var/cache", "/var/tmp",
                "/var/lib/systemd", "/var/lib/apt", "/root")
USER_DATABASE = {"/etc/passwd", "/etc/group", "/etc/shadow", "/etc/gshadow"}
KEPT = {"/etc/passwd-", "/etc/group-", "/etc/shadow-", "/etc/gshadow-", "/etc/.pwd.lock"}


def packages():
    found = sorted(DRIVE.glob("softgrip_*.deb"))
    expect(len(found) == 2, f"two packages on the drive: {found}")
    return found


def files():
    """Returns the paths of all files, and the contents of the files in /etc."""
    found = {}
    for folder, folders, names in os.walk("/"):
        folders[:] = [name for name in folders if os.path.join(folder, name) not in NOT_COMPARED]
        for name in folders + names:
            path = os.path.join(folder, name)
            regular = os.path.isfile(path) and not os.path.islink(path)
            found[path] = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest() \
                if regular and path.startswith("/etc/") else ""
    return found


def install(state):
    state["before"] = files()
    sh(f"dpkg -i {packages()[0]}")
    expect(sh("systemctl is-enabled softgripd", check=False).strip() == "disabled", "the service is enabled")
    expect(service.show("ActiveState") == "inactive", "the service was started")
    expect("softgrip" in sh("id -Gn softgrip") and "dialout" in sh("id -Gn softgrip"), "the user's groups")
    said = sh(f"systemd-analyze verify --man=no {UNIT}", check=False)
    expect(not said, f"systemd-analyze verify: {said}")
    said = sh("journalctl -q -o cat -u systemd-udevd | grep softgrip", check=False)
    expect(not said, f"udev on the rules: {said}")
    expect(sh("stat -c '%U %a' /var/lib/softgrip/runs") == "softgrip 750\n", "the folder of the recordings")
    installed = set(files()) - set(state["before"])
    return f"{len(installed)} files and folders, disabled, not started"


def start(state):
    edit(RIG, (r"host: .*", "host: 127.0.0.1"), (r"port: \d+", "port: 1502"), (r"cpus: \[1\]", "cpus: [0]"))
    state["emulator"] = Emulator()
    sh(f"systemctl enable --now {UNIT}")
    service.wait_idle()
    pid = service.pid()
    loop, bus = service.thread("softgrip-loop"), service.thread("softgrip-bus")
    expect(os.sched_getscheduler(loop) == os.SCHED_FIFO and os.sched_getparam(loop).sched_priority == 70,
           "the loop's scheduling")
    expect(os.sched_getscheduler(bus) == os.SCHED_FIFO and os.sched_getparam(bus).sched_priority == 69,
           "the bus thread's scheduling")
    of_process = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines())
    expect(int(of_process["VmLck"].split()[0]) > 0, "no locked memory")
    expect(int(of_process["CapEff"], 16) == 0, f"capabilities {of_process['CapEff']}")
    expect(of_process["NoNewPrivs"].strip() == "1" and of_process["Seccomp"].strip() == "2", "not confined")
    user = sh(f"ps -o user= -p {pid}").strip()
    expect(user == "softgrip", f"runs as {user}")
    real_time = service.status()["real_time"]
    expect(not real_time["degraded"], f"real time: {real_time['steps']}")
    steps = ", ".join(f"{step['name']} {step['detail']}" for step in real_time["steps"] if step["name"] == "kernel")
    return f"user softgrip, no capabilities, FIFO 70 and 69, {of_process['VmLck'].strip()} locked; {steps}"


def sequence(state):
    state["emulator"].wait_vented(1)
    since = service.newest_event()
    sh("softgrip start --wait pick_stone")
    results = [(event["channel"], event["code"]) for event in service.events(since) if event["kind"] == "grip_result"]
    for channel in ("left", "right"):
        expect([code for name, code in results if name == channel][-2:] == ["HOLDING", "RELEASED"], f"results {results}")
    service.wait_idle()
    return "HOLDING, then RELEASED on both fingers"


def emergency_stop(state):
    emulator = state["emulator"]
    before = RIG.read_text()
    RIG.write_text(before + f"""
gpio:
  debounce_s: 0.005
  stale_after_s: 0.5
  emergency_stop: {{chip: {Lines.label}, offset: {Lines.emergency_stop}, active: high}}
  enable: {{chip: {Lines.label}, offset: {Lines.enable}, active: high, on_fault: drop}}
""")
    lines = Lines()
    lines.pull(Lines.emergency_stop, 0)
    try:
        sh(f"systemctl stop {UNIT}")
        emulator.start()
        sh(f"systemctl start {UNIT}")
        wait_for("a stop that starts pressed", lambda: service.state() == "faulted")
        expect(service.status()["fault"]["code"] == "F501", f"fault {service.status()['fault']}")
        expect(lines.level(Lines.enable) == 0, "the enable output is on before the acknowledgement")
        sh("softgrip acknowledge")
        service.wait_idle()
        wait_for("the enable output", lambda: lines.level(Lines.enable) == 1, 2)

        sh("softgrip start pick_stone")
        wait_s = state["random"].uniform(0.5, 7)
        time.sleep(wait_s)
        commanded = max(emulator.commands_kpa())
        begin = time.monotonic()
        lines.pull(Lines.emergency_stop, 1)
        dropped_s = wait_for("the enable output to drop", lambda: lines.level(Lines.enable) == 0, 1, 0.005)[1]
        emulator.wait_vented(1)
        vented_s = time.monotonic() - begin
        expect(service.state() == "faulted", f"the daemon is {service.state()}")
        lines.pull(Lines.emergency_stop, 0)
        emulator.expect_still(2)
        expect(service.state() == "faulted", "a release alone cleared the fault")
        sh("softgrip acknowledge")
        service.wait_idle()
        emulator.expect_still(2)
    finally:
        RIG.write_text(before)
    return (f"pulled {wait_s:.2f} s into the sequence, at {commanded:.1f} kPa: enable off after {dropped_s:.2f} s, vented "
            f"after {vented_s:.2f} s; no motion after release nor acknowledge")


def expect_came_back(state, restarts):
    """Checks that the service has vented, has restarted once and is idle. Also checks that no finger moves for 3
    s."""
    wait_for("a restart", lambda: service.restarts() == restarts + 1)
    service.wait_idle()
    state["emulator"].expect_still(3)
    expect(service.state() == "idle", f"the daemon is {service.state()}")


def thread_hangs(state, name):
    service.start_fresh(state["emulator"])
    service.hold()
    restarts, wall = service.restarts(), time.time()
    hang = subprocess.Popen([sys.executable, DRIVE / "hang_thread.py", str(service.thread(name))],
                            stdout=subprocess.PIPE, text=True)
    expect(hang.stdout.readline() == "hangs\n", "the thread was not stopped")
    begin = time.monotonic()
    state["emulator"].wait_vented(WATCHDOG_S + STANDSTILL_S[name] + START_S)
    vented_s = time.monotonic() - begin
    wait_for("the watchdog", lambda: "Watchdog timeout" in service.journal(wall - 1), START_S)
    hang.wait(10)
    expect_came_back(state, restarts)
    expect("safe outputs:" in service.journal(wall - 1), "ExecStopPost= did not run")
    return f"starved the watchdog, vented after {vented_s:.1f} s, came back idle, still for 3 s"


def process_hangs(state):
    service.start_fresh(state["emulator"])
    service.hold()
    restarts, wall = service.restarts(), time.time()
    os.kill(service.pid(), signal.SIGSTOP)
    took_s = state["emulator"].wait_vented(WATCHDOG_S + STANDSTILL_S["process"] + START_S)
    expect_came_back(state, restarts)
    expect("vented and confirmed" in service.journal(wall - 1), "ExecStopPost= did not confirm")
    return f"vented by ExecStopPost= after {took_s:.1f} s, came back idle, still for 3 s"


def killed(state):
    service.start_fresh(state["emulator"])
    service.hold()
    wait_s = state["random"].uniform(0, 3)
    time.sleep(wait_s)
    restarts, wall = service.restarts(), time.time()
    recording = max(RUNS.iterdir())
    status_s = service.status()["time_s"] - service.wait_event("recording_started")["time_s"]
    os.kill(service.pid(), signal.SIGKILL)
    took_s = state["emulator"].wait_vented(START_S)
    expect_came_back(state, restarts)
    expect("vented and confirmed" in service.journal(wall - 1), "ExecStopPost= did not confirm")
    json.loads((recording / "run.json").read_text())
    lines = (recording / "run.csv").read_text().splitlines()
    last_s = float(lines[-1 if lines[-1].count(",") == lines[0].count(",") else -2].split(",")[0])
    expect(last_s > status_s - 1, f"the recording ends at {last_s}, the kill came at {status_s}")
    return (f"{wait_s:.2f} s into the hold: vented by ExecStopPost= after {took_s:.2f} s, "
            f"{max(0.0, status_s - last_s):.2f} s of the recording lost")


def stopped(state):
    service.start_fresh(state["emulator"])
    service.hold()
    before = state["emulator"].commands_kpa()
    wall = time.time()
    sh(f"systemctl stop {UNIT}")
    after = state["emulator"].commands_kpa()
    # The controller acts until the last tick, so the outputs may change slightly. If the part had been released, the
    # outputs would be 0.
    expect(all(abs(now - then) < 2 for now, then in zip(after, before)), f"held with {before}, left with {after} kPa")
    expect("ended normally" in service.journal(wall - 1), "ExecStopPost= did not say so")
    expect(service.show("Result") == "success", service.show("Result"))
    sh(f"systemctl start {UNIT}")
    service.wait_idle()
    state["emulator"].wait_vented(2)
    return "the safe action of the phase (hold) stayed; a start afterwards vents"


def drop_in(text):
    if text:
        DROP_IN.parent.mkdir(parents=True, exist_ok=True)
        DROP_IN.write_text(text)
    else:
        DROP_IN.unlink(missing_ok=True)
    sh("systemctl daemon-reload")


def rights_removed(state):
    drop_in("[Service]\nLimitRTPRIO=0\nLimitMEMLOCK=64K\n")
    try:
        wall = time.time()
        service.start_fresh(state["emulator"])
        real_time = service.status()["real_time"]
        expect(real_time["degraded"], "the status does not report the degradation")
        failed = [step["name"] for step in real_time["steps"] if step["outcome"] == "failed"]
        journal = service.journal(wall - 1)
        expect("real time: DEGRADED" in journal, "not in the journal")
        edit(RIG, (r"real_time: \{required: false", "real_time: {required: true"))
        wall = time.time()
        sh(f"systemctl restart {UNIT}", check=False)
        expect(service.state() is None, "the service runs although real time is required")
        expect("could not be verified" in service.journal(wall - 1), "the refusal is not in the journal")
        state["emulator"].expect_still(1)
        sh(f"systemctl stop {UNIT}", check=False)
    finally:
        edit(RIG, (r"real_time: \{required: \w+", "real_time: {required: false"))
        drop_in("")
    service.start_fresh(state["emulator"])
    expect(not service.status()["real_time"]["degraded"], "still degraded although the rights are restored")
    return f"degraded said ({', '.join(failed)}); refused when required; whole again with the rights"


def refused_configuration(state):
    edit(RIG, (r"rate_hz: 20", "rate_khz: 20"))
    try:
        restarts = service.restarts()
        sh(f"systemctl restart {UNIT}", check=False)
        time.sleep(5)
        expect(service.show("ActiveState") == "failed", service.show("ActiveState"))
        expect(service.restarts() == restarts, "the service was restarted repeatedly")
        expect(service.show("ExecMainStatus") == "3", service.show("ExecMainStatus"))
    finally:
        edit(RIG, (r"rate_khz: 20", "rate_hz: 20"))
    service.start_fresh(state["emulator"])
    return "exit code 3, not started again"


def upgrade(state):
    service.start_fresh(state["emulator"])
    service.hold()
    held = state["emulator"].commands_kpa()
    pid = service.pid()
    sh(f"dpkg -i {packages()[1]}")
    wait_for("another process", lambda: service.pid() not in (0, pid))
    service.wait_idle()
    state["emulator"].wait_vented(2)
    state["emulator"].expect_still(3)
    expect(min(held) > 10, f"nothing was held: {held}")
    expect("127.0.0.1" in RIG.read_text(), "the rig file was overwritten")
    return "restarted, came back idle and vented, still for 3 s; the edited rig file was kept"


def remove(state):
    service.start_fresh(state["emulator"])
    service.hold()
    sh("dpkg -r softgrip")
    expect(service.show("ActiveState") != "active", "it still runs")
    expect(RIG.exists() and RUNS.exists(), "removing the package deleted files that only purging may delete")
    state["emulator"].process.kill()
    return "stopped; configuration and recordings kept"


def purge(state):
    sh("dpkg --purge softgrip")
    sh("systemctl daemon-reload")
    after = files()
    left = {path for path in after if path not in state["before"]} - KEPT
    expect(not left, f"left: {sorted(left)}")
    gone = {path for path in state["before"] if path not in after}
    expect(not gone, f"gone: {sorted(gone)}")
    changed = {path for path, digest in after.items() if path in state["before"] and state["before"][path] != digest}
    expect(changed <= USER_DATABASE | KEPT, f"changed: {sorted(changed)}")
    return "no file or folder left or lost; kept by policy: the user softgrip"


def main():
    main_guard()
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else random.SystemRandom().randrange(10**6)
    print(f"seed {seed}; {sh('uname -srv').strip()}; {sh('systemctl --version').splitlines()[0]}", flush=True)
    state = {"random": random.Random(seed)}
    steps = Steps()
    steps.run("the package is installed", install, state)
    steps.run("the service starts", start, state)
    if "emulator" not in state:
        raise Failed("nothing to test")
    steps.run("a sequence runs", sequence, state)
    steps.run("the emergency stop is pulled", emergency_stop, state)
    steps.run("the loop hangs in a hold", thread_hangs, state, "softgrip-loop")
    steps.run("the bus thread hangs in a hold", thread_hangs, state, "softgrip-bus")
    steps.run("the whole process hangs in a hold", process_hangs, state)
    steps.run("kill -9 in a hold", killed, state)
    steps.run("stopped in a hold", stopped, state)
    steps.run("the rights are removed", rights_removed, state)
    steps.run("a rig file that is refused", refused_configuration, state)
    steps.run("upgraded while it holds a part", upgrade, state)
    steps.run("the package is removed while it holds a part", remove, state)
    steps.run("the package is purged", purge, state)
    steps.end("SYSTEM TEST")


if __name__ == "__main__":
    main()
