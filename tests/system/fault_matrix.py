"""Runs the cells of fault_matrix.yaml; a cell is one fault in one phase of a grip. The cells use a real softgripd, a
real softgrip-rig and real sockets. A proxy between the two programs adds the faults.

scripts/fault_matrix.sh runs all cells and publishes docs/results/fault-matrix.md; test_fault_matrix.py runs a few
cells. With --vacuum the same faults act on the rig of config/vacuum, whose outputs are below their rest pressure.
"""

import argparse
import concurrent.futures
import contextlib
import csv
import json
import math
import os
import pathlib
import re
import shutil
import sys
import tempfile
import time
import traceback

import yaml

import bench
import digital_lines
import pauses
import serial_rig
import wire_proxy

TABLE = pathlib.Path(__file__).with_name("fault_matrix.yaml")
PAGE = bench.SOURCE / "docs" / "results" / "fault-matrix.md"
# Maps a phase of the matrix to its name in safe_action of the rig file. safe_action has no name for the phase
# `connect`.
PHASE_OF = {"idle": "idle", "closing": "closing", "holding": "holding", "venting": "releasing"}
# Number of cycles for which the test observes a fault that must have no visible effect.
OBSERVED_CYCLES = 80
SETTLED_KPA = 0.1
SEQUENCE = """name: matrix
steps:
  - grip:
      displacement_mm: 17
      speed_mm_per_s: 8
      settle_s: 0.3
      verify: {{by: detection, window_s: 0.2}}
      timeout_s: 8
      on_fail: release
  - hold: {{hold_s: {hold_s}, reverify_every_s: 0.25, on_fail: release}}
  - release: {{duration_s: 3, purge_s: 0.5, timeout_s: 8, on_fail: vent}}
"""

# The pressures of this sequence are below the rest pressure. The sequence has the same duration as SEQUENCE.
VACUUM_SEQUENCE = """name: matrix
steps:
  - grip:
      pressure_kpa: -25
      speed_kpa_per_s: 10
      settle_s: 0.3
      verify: {{by: pressure, window_s: 0.2, pressure_max_kpa: -20}}
      timeout_s: 8
      on_fail: release
  - hold: {{hold_s: {hold_s}, reverify_every_s: 0.25, on_fail: release}}
  - release: {{duration_s: 3, purge_s: 0.5, timeout_s: 8, on_fail: vent}}
"""
# Raw 12-bit value of an output at its rest pressure of 0 kPa. The shipped rig has 0 V at this pressure, and the vacuum
# rig has 5 V.
REST_RAW = {False: 0, True: 2047.5}
# A constant command holds a vacuum until the release. During this hold, a repeated old reply has the correct contents.
NOT_BELOW_REST = {("repetition_of_contents", "holding")}


class Wrong(AssertionError):
    """Exception for a cell whose result differs from the result in the table."""


class Skipped(Exception):
    """Exception for a cell that needs a missing resource, or a permission that this user does not have."""


def require(holds, sentence):
    if not holds:
        raise Wrong(sentence)


class Table:
    def __init__(self, path=TABLE):
        data = yaml.safe_load(path.read_text())
        self.rig = data["rig"]
        self.phases = data["phases"]
        self.sequence = data["sequence"]
        self.faults = {fault["name"]: fault for fault in data["faults"]}

    def cells(self):
        return [(name, phase) for name, fault in self.faults.items() for phase in fault.get("phases", self.phases)]

    def cell(self, name, phase):
        cells = self.faults[name]["cells"]
        return cells.get(phase, cells.get("all"))

    def names(self):
        """Returns the names that an expression in the key `within` may use, each with its value in cycles."""
        rig, shipped = self.rig, shipped_rig()
        rate = rig["rate_hz"]
        slowest_kpa_per_s = self.sequence["slowest_kpa_per_s"]
        share = self.sequence["smallest_share_lost"]
        return {**{k: v for k, v in rig.items() if k.endswith("_cycles")},
                "pressure_delay_cycles": math.ceil(shipped["faults"]["pressure_delay_s"] * rate),
                "travel_cycles": math.ceil(shipped["faults"]["pressure_tolerance_kpa"] / share / slowest_kpa_per_s * rate),
                "readback_delay_cycles": math.ceil(shipped["faults"]["readback_delay_s"] * rate),
                "debounce_cycles": math.ceil(digital_lines.DEBOUNCE_S * rate),
                "frozen_cycles": math.ceil(shipped["plausibility"]["frozen_after_s"] * rate),
                "age_cycles": math.ceil(rig["max_age_s"] * rate)}

    def bound(self, expression):
        names = self.names()
        text = str(expression)
        if not re.fullmatch(r"[a-z_0-9 +*]+", text):
            raise ValueError(f"not an expression of cycles: {text}")
        return eval(text, {"__builtins__": {}}, names)  # the expression contains only letters, digits, + and *


def shipped_rig():
    return yaml.safe_load((bench.SOURCE / "config" / "rig_tcp.yaml").read_text())


class Cell:
    """A cell of the matrix: one fault in one phase of a grip."""

    def __init__(self, table, name, phase, vacuum=False):
        self.vacuum = vacuum
        self.table = table
        self.name = name
        self.phase = phase
        self.fault = table.faults[name]
        self.expected = table.cell(name, phase)
        self.rate = serial_rig.RATE_HZ if self.fault.get("rig") == "serial" else table.rig["rate_hz"]
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_matrix_"))
        self.processes = []
        self.proxy = None
        self.lines = None
        self.seen = 0  # largest id of the events before the fault
        self.measured = {}

    # --- Starting the processes

    def rig_file(self, port):
        text = self.vacuum_rig() if self.vacuum else (self.folder / "config" / "rig_tcp.yaml").read_text()
        changes = {"port": port, **self.table.rig}
        for key, value in changes.items():
            text, count = re.subn(rf"\b{key}: [-\d.]+", f"{key}: {value}", text)
            require(count > 0, f"rig_tcp.yaml has no {key}")
        for old, new in ((r"real_time: .*", "real_time: {required: false, priority: 70, cpus: [], lock_memory: false}"),
                         (r"directory: /tmp/softgrip-runs", f"directory: {self.folder}/runs"),
                         (r"path: /tmp/softgrip.sock", f"path: {self.folder}/softgripd.sock")):
            text = re.sub(old, new, text)
        text, count = re.subn(r"\bunit: 1\b", f"unit: 1\n    {self.fault.get('session', '')}", text)
        require(count == 1, "rig_tcp.yaml has no unit")
        path = self.folder / "config" / "matrix.yaml"
        path.write_text(text + (digital_lines.SECTION if self.has_lines() else ""))
        return path

    def vacuum_rig(self):
        """Writes the vacuum rig for the board that the proxy supports. The safe value of an output is the middle of
        its range."""
        boards = self.folder / "config" / "boards"
        board, count = re.subn(r"safe_v: \[0, 0\]", "safe_v: [5, 5]", (boards / "adam-6024.yaml").read_text())
        require(count == 1, "adam-6024.yaml has no safe_v")
        (boards / "adam-6024-vacuum.yaml").write_text(board)
        text = (self.folder / "config" / "vacuum" / "rig_tcp.yaml").read_text()
        return text.replace("map: board.yaml", "map: boards/adam-6024-vacuum.yaml").replace("../", "")

    def has_lines(self):
        return self.fault.get("rig") == "lines"

    def start_emulator(self):
        arguments = ["--object", "stone"]
        if "plant" in self.fault["do"]:
            faults = self.folder / "faults.yaml"
            faults.write_text(f"faults:\n  - {{name: it, kind: {self.fault['do']['plant']}}}\n")
            arguments += ["--faults", faults]
        if self.fault.get("rig") == "serial":
            self.rig_path = serial_rig.rig_file(self.folder, self.rate)
            self.emulator = serial_rig.Emulator(self.folder, self.rig_path, *arguments)
            self.processes.append(self.emulator)
            self.proxy = serial_rig.Watcher(self.emulator)
            return
        if "map" in self.fault:
            with (self.folder / "config" / "boards" / "adam-6024.yaml").open("a") as board:
                board.write(f"\n{self.fault['map']}\n")
        if self.fault.get("rig") == "rtu_over_tcp":
            self.emulator = serial_rig.Shared(self.folder, "--rtu-over-tcp", *arguments)
            self.processes.append(self.emulator)
            self.rig_path = self.rig_file(self.emulator.port)
            self.proxy = serial_rig.Watcher(self.emulator)
            return
        if self.vacuum:
            self.emulator = bench.Emulator(self.folder, "--rig", self.rig_file(1502), *arguments, board=None)
        else:
            self.emulator = bench.Emulator(self.folder, *arguments)
        self.processes.append(self.emulator)
        self.proxy = wire_proxy.Proxy(self.emulator.port)
        self.rig_path = self.rig_file(self.proxy.port)

    def start_daemon(self):
        environment = digital_lines.environment(self.folder) if self.has_lines() else None
        self.daemon = bench.Daemon(self.folder, self.rig_path, environment=environment)
        self.processes.append(self.daemon)
        if self.has_lines():
            self.lines = digital_lines.Lines(self.folder)

    def clear_emergency_stop(self):
        """Acknowledges the fault of the emergency stop, which the daemon latches at its start."""
        self.daemon.wait_for_state("faulted")
        bench.wait_for("an acknowledged start", lambda: self.daemon.ask("acknowledge")["ok"], pause_s=0.05)
        bench.wait_for("the enable output", lambda: "ENABLE" in self.lines.on())
        self.seen = self.daemon.events()[-1]["id"]

    def find_origin(self):
        """Sets `origin` to time.monotonic() at the daemon's time 0. A status can be one tick old, so `origin` is the
        smallest of the values from 20 statuses."""
        self.origin = math.inf
        for n in range(20):
            now_s = self.daemon.status()["time_s"]
            self.origin = min(self.origin, time.monotonic() - now_s)
            time.sleep((0.3 + n % 3) / self.rate)

    def begin_fault(self):
        self.began = time.monotonic()
        if self.fault["do"].get("hand") == "presses":
            self.lines.press()
        elif self.fault["do"].get("hand") == "pulls_the_chip":
            self.lines.pull_out_the_chip()
        elif self.fault["do"].get("hand") == "presses_in_pause":
            with pauses.whole_process(self.daemon):
                self.lines.press_for(self.fault["do"]["for_s"])
                time.sleep(self.fault["do"]["for_s"])
            self.lines.heard()
        elif "pause" in self.fault["do"]:
            try:
                pauses.pause(self.daemon, self.fault["do"]["pause"], self.fault["do"]["for_s"])
            except PermissionError as error:
                raise Skipped(str(error)) from None
        elif "plant" in self.fault["do"]:
            self.emulator.ask("fault it")
        else:
            self.wire_fault = wire_proxy.Fault(**self.fault["do"])
            self.proxy.begin(self.wire_fault)

    def clear_fault(self):
        if self.fault["do"].get("hand") == "presses":
            self.lines.release()
            return
        if "pause" in self.fault["do"] or "hand" in self.fault["do"]:
            return  # the fault has ended
        if "plant" in self.fault["do"]:
            self.emulator.ask("clear it")
            if self.fault["do"]["plant"] == "ignored_write":
                self.began = self.first_other_write()
        else:
            if self.wire_fault.first_touch is not None:
                self.began = self.wire_fault.first_touch
            self.proxy.clear()

    def first_other_write(self):
        """Since the beginning of the fault, the board has ignored all writes. Returns the time of the first ignored
        write whose values differ from the outputs of the board."""
        before = [words for at, words in self.proxy.writes if at <= self.began][-1:]
        return next((at for at, words in self.proxy.writes
                     if at > self.began and before and wire_proxy.noticeable(words, before[0])), self.began)

    def reach_phase(self):
        if self.has_lines():
            self.clear_emergency_stop()
        self.daemon.wait_for_state("idle")
        if self.phase in ("connect", "idle"):
            time.sleep(0.2)
            return
        text = (VACUUM_SEQUENCE if self.vacuum else SEQUENCE).format(hold_s=0.2 if self.phase == "venting" else 6)
        def accepted():
            reply = self.daemon.ask("start", sequence="matrix", sequence_text=text)
            require(reply["ok"] or "refusal" in reply["error"], f"start: {reply}")
            return reply["ok"]
        bench.wait_for("a start", accepted)
        step = {"closing": "0", "holding": "1", "venting": "2"}[self.phase]
        self.daemon.wait_for_event("step_started", code=step)
        time.sleep({"closing": 0.6, "holding": 0.4, "venting": 0.4}[self.phase])
        status = self.daemon.status()
        require(status["state"] == "running", f"before the fault the state was {status['state']}")
        if self.phase == "holding":
            require(self.daemon.results() == ["HOLDING", "HOLDING"], f"before the fault: {self.daemon.results()}")

    # --- Checking the required results

    def latched(self):
        return next((e for e in self.daemon.events() if e["kind"] == "fault_latched" and e["id"] > self.seen), None)

    def observe(self, cycles=OBSERVED_CYCLES):
        """Waits for this number of control cycles."""
        ticks = self.daemon.status()["loop"]["ticks"]
        bench.wait_for("ticks", lambda: self.daemon.status()["loop"]["ticks"] >= ticks + cycles)

    def outputs_kpa(self):
        return self.emulator.commands_kpa()

    def away_kpa(self):
        """Returns the absolute difference between each output and the rest pressure of 0 kPa."""
        return [abs(kpa) for kpa in self.outputs_kpa()]

    def check_waits(self):
        self.observe()
        status = self.daemon.status()
        require(status["state"] == "starting" and not self.latched(), f"{status['state']}, {self.latched()}")
        require(max(self.away_kpa()) < SETTLED_KPA, f"outputs {self.outputs_kpa()}")
        self.clear_fault()
        self.daemon.wait_for_state("idle")

    def check_faulted(self):
        try:
            fault = bench.wait_for("a fault", self.latched, 15)
        except AssertionError:
            raise Wrong(f"no fault: {self.daemon.status()['state']}, {self.daemon.results()}") from None
        self.measured["code"] = fault["code"]
        require(fault["code"] in self.expected["codes"], f"{fault['code']} ({fault['text']})")
        require(self.daemon.status()["state"] == "faulted", self.daemon.status()["state"])
        writes_before = len(self.proxy.writes)
        if self.expected.get("outputs") != "spoiled":
            self.check_outputs(fault["code"])
            self.check_no_motion(writes_before)
        if self.has_lines() and not self.expected.get("for_good"):  # if the chip was removed, it drives no output
            bench.wait_for("an enable output that has dropped", lambda: "ENABLE" not in self.lines.on(), 2)
            bench.wait_for("the fault lamp", lambda: "FAULT" in self.lines.on(), 2)
        self.find_origin()
        self.observe(60)  # waits until the recording has ended
        self.clear_fault()
        if self.expected.get("for_good"):
            require(not self.daemon.ask("acknowledge")["ok"], "the fault was acknowledged although its cause remains")
        else:
            self.acknowledge()
        return fault

    def action(self, code):
        safety = shipped_rig()["safety"]
        # Without a watchdog, the board keeps its outputs when the bus fails. In this case, only the phase
        # determines the safe action.
        watched = self.fault.get("rig") != "serial"
        if watched and code.startswith("F1") or code in ("F303", "F304") or self.phase == "connect":
            return "vent"  # the watchdog of the ADAM vents the outputs
        if code in ("F501", "F502"):
            return safety["on_emergency_stop"]
        return safety["safe_action"][PHASE_OF[self.phase]]

    def check_outputs(self, code):
        """Checks the outputs of the emulator. Real valves would receive these values."""
        action = self.action(code)
        self.measured["outputs"] = action
        if action == "vent":
            bench.wait_for("vented outputs", lambda: max(self.away_kpa()) <= SETTLED_KPA, 10)
            self.measured["by"] = "board" if self.emulator.status()["watchdog_tripped"] else "daemon"
            return
        held = self.outputs_kpa()
        require(min(self.away_kpa()) > 5, f"held outputs {held}")
        self.observe(30)
        require(all(abs(a - b) <= SETTLED_KPA for a, b in zip(held, self.outputs_kpa())), f"{held} became {self.outputs_kpa()}")

    def check_no_motion(self, since):
        rest = REST_RAW[self.vacuum]
        writes = [words for _, words in self.proxy.writes[since:]]
        for before, after in zip(writes, writes[1:]):
            require(all(abs(b - rest) <= abs(a - rest) for a, b in zip(before, after)),
                    f"an output moved away from rest after the fault: {before} to {after}")

    def acknowledge(self):
        """Checks the behaviour after the fault has ended. The daemon must accept the acknowledgement, the rig must
        become idle, and no finger may move."""
        since = len(self.proxy.writes)
        bench.wait_for("an acknowledged fault", lambda: self.daemon.ask("acknowledge")["ok"], 15, 0.1)
        self.daemon.wait_for_state("idle")
        self.observe(20)
        if self.expected.get("outputs") != "spoiled":
            self.check_no_motion(since)

    def check_ridden(self):
        self.observe()
        fault = self.latched()
        require(not fault, f"{fault and fault['code']}: {fault and fault['text']}")
        if self.phase == "closing":
            bench.wait_for("an answer", lambda: "-" not in self.daemon.results(), 15)
            self.measured["result"] = self.daemon.results()[0]
            left = self.expected.get("result", "HOLDING")
            require(self.daemon.results() == [left, "HOLDING"], f"{self.daemon.results()}")
        elif self.phase == "holding":
            self.measured["result"] = self.daemon.results()[0]
            require(self.daemon.results() == ["HOLDING"] * 2, f"{self.daemon.results()}")
        elif self.phase == "venting":
            self.daemon.wait_for_event("sequence_finished", code="done")
            require(max(self.away_kpa()) <= SETTLED_KPA, f"outputs {self.outputs_kpa()}")
        self.clear_fault()
        require(not self.latched(), "there is still a fault at the end")

    def check_unseen(self):
        """Checks that the daemon reports no fault, because it cannot detect this fault. Records the grip result, but
        does not require a specific one."""
        self.observe()
        fault = self.latched()
        require(not fault, f"a fault was detected: {fault and fault['code']}: {fault and fault['text']}")
        if self.phase in ("closing", "holding"):
            bench.wait_for("an answer", lambda: "-" not in self.daemon.results() or self.latched(), 15)
        self.measured["result"] = "/".join(self.daemon.results())
        self.clear_fault()

    # --- Checking the recording

    def recordings(self):
        return sorted(path.parent for path in (self.folder / "runs").glob("*/run.csv"))

    def check_recordings(self, slips):
        for recording in self.recordings():
            about = json.loads((recording / "run.json").read_text())
            with open(recording / "run.csv", newline="") as file:
                rows = [row for row in csv.DictReader(file) if row["channel"] == "left"]
            require(about["state"] == "complete" and not about["dropped_rows"] and not about["error"],
                    f"{recording.name}: {about['state']}, {about['dropped_rows']} dropped, {about['error']}")
            require(about["rows"] == 2 * len(rows), f"{recording.name}: {2 * len(rows)} rows, {about['rows']} counted")
            times = [float(row["time_s"]) for row in rows]
            missing = round((times[-1] - times[0]) * self.rate) + 1 - len(times)
            require(missing <= slips, f"{recording.name}: {missing} ticks missing, {slips} slipped")

    def reaction(self, fault):
        """Counts rows of the recording. Returns the number of ticks from the first effect of the fault to the latched
        fault."""
        # The emergency stop at the start of the daemon causes an additional recording.
        for recording in reversed(self.recordings()):
            about = json.loads((recording / "run.json").read_text())
            same = next((e for e in reversed(about["faults"]) if e["code"] == fault["code"]), None)
            if same is None:
                continue
            begin = fault["time_s"] - same["time_s"] + self.origin
            with open(recording / "run.csv", newline="") as file:
                times = [begin + float(row["time_s"]) for row in csv.DictReader(file) if row["channel"] == "left"]
            require(times[0] < self.began, "the recording begins after the fault began")
            latch = fault["time_s"] + self.origin
            return sum(1 for t in times if self.began < t <= latch + 1e-6)
        raise Wrong(f"no recording has {fault['code']} among its faults")

    def run(self):
        self.start_emulator()
        if self.phase == "connect":
            self.begin_fault()
            self.start_daemon()
            hurry(True)
            # Some faults are so short that the test cannot observe them before they end.
            if self.expected["ends"] in ("ridden", "unseen"):
                self.daemon.wait_for_state("idle")
        else:
            self.start_daemon()
            hurry(True)
            self.reach_phase()
            self.begin_fault()
        fault = {"waits": self.check_waits, "faulted": self.check_faulted, "ridden": self.check_ridden,
                 "unseen": self.check_unseen}[self.expected["ends"]]()
        self.daemon.ask("vent")
        loop = self.daemon.result("statistics")["loop"]
        slips = loop["slips_woken_late"] + loop["slips_took_long"]
        require(self.daemon.end() == 0, "softgripd did not end with 0")
        require(max(self.away_kpa()) <= SETTLED_KPA or self.expected.get("outputs") == "spoiled",
                f"outputs at the end {self.outputs_kpa()}")
        self.check_recordings(slips)
        if fault and "within" in self.expected:
            cycles = self.reaction(fault)
            bound = self.table.bound(self.expected["within"])
            self.measured |= {"cycles": cycles, "bound": bound}
            require(cycles <= bound, f"{fault['code']} after {cycles} cycles, {bound} are allowed")

    def close(self):
        if self.proxy:
            self.proxy.close()
        if self.lines:
            self.lines.close()
        for process in reversed(self.processes):
            if process.running():
                process.kill()
            for lines in (getattr(process, "control", None), getattr(process, "lines", None)):
                if lines:
                    lines.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def hurry(yes):
    """Sets a real-time priority for this process if `yes` is true, or else the normal priority. Has no effect without
    the permission. The process simulates a wire, and other work of the machine does not delay a wire. The process
    sleeps most of the time. Child processes start with the normal priority, because the test checks the priorities
    that they set."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO if yes else os.SCHED_OTHER, os.sched_param(30 if yes else 0))


def run_once(name, phase, vacuum=False):
    hurry(False)
    cell = Cell(Table(), name, phase, vacuum)
    wrong = log = skipped = None
    try:
        shutil.copytree(bench.SOURCE / "config", cell.folder / "config")
        cell.run()
    except Skipped as error:
        skipped = str(error)
    except Wrong as error:
        wrong = str(error)
    except Exception as error:  # an error in one cell must not stop the other cells
        wrong = f"{type(error).__name__}: {error}\n{traceback.format_exc(limit=4)}"
    if wrong:
        log = "\n".join(p.errors()[-1800:] for p in cell.processes if p.name == "softgripd")
    cell.close()
    return {"fault": name, "phase": phase, "expected": cell.expected, "measured": cell.measured, "wrong": wrong, "log": log,
            "skipped": skipped}


def run_cell(name, phase, attempts=2, vacuum=False):
    """Runs a cell. If the cell fails, runs the cell a second time, because a pause of the machine may have caused the
    failure. The page of results states the number of repetitions."""
    for attempt in range(1, attempts + 1):
        result = run_once(name, phase, vacuum)
        result["attempts"] = attempt
        if not result["wrong"]:
            break
    return result


def show(result):
    measured = ", ".join(f"{k} {v}" for k, v in result["measured"].items())
    head = f"{result['fault']} x {result['phase']}: {result['expected']['ends']}"
    again = f" (attempt {result['attempts']})" if result["attempts"] > 1 else ""
    ends = "WRONG" if result["wrong"] else "skip " if result["skipped"] else "ok   "
    print(f"{ends} {head}{'; ' + measured if measured else ''}{again}", flush=True)
    if result["wrong"]:
        print(f"      {result['wrong']}\n{result['log'] or ''}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cells", nargs="*", help="FAULT, FAULT/PHASE or /PHASE; default: all cells")
    parser.add_argument("--jobs", type=int, default=3,
                        help="number of cells that run at the same time; they mostly wait")
    parser.add_argument("--attempts", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, help="write the results as JSON")
    parser.add_argument("--keep", type=pathlib.Path,
                        help="the results of an earlier --out, for the cells that this call does not run")
    parser.add_argument("--vacuum", action="store_true",
                        help="use the rig of config/vacuum, without the cells of a serial rig")
    parser.add_argument("--page", action="store_true", help=f"write {PAGE.relative_to(bench.SOURCE)}")
    arguments = parser.parse_args()
    table = Table()

    def wanted(name, phase):
        other_rig = table.faults[name].get("rig") in ("serial", "rtu_over_tcp") or "map" in table.faults[name]
        if arguments.vacuum and (other_rig or (name, phase) in NOT_BELOW_REST):
            return False
        return not arguments.cells or any(c in (name, f"{name}/{phase}", f"/{phase}") for c in arguments.cells)

    cells = [cell for cell in table.cells() if wanted(*cell)]
    if not cells:
        parser.error("no such cell")
    began = time.monotonic()
    results = []
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        futures = [pool.submit(run_cell, *cell, arguments.attempts, arguments.vacuum) for cell in cells]
        for future in concurrent.futures.as_completed(futures):
            results.append(future.result())
            show(results[-1])
    if arguments.keep:
        run_now = {(r["fault"], r["phase"]) for r in results}
        results += [r for r in json.loads(arguments.keep.read_text()) if (r["fault"], r["phase"]) not in run_now]
        cells = table.cells()
    results.sort(key=lambda r: cells.index((r["fault"], r["phase"])))
    if arguments.out:
        arguments.out.write_text(json.dumps(results, indent=1))
    wrong = [r for r in results if r["wrong"]]
    print(f"{len(results)} cells in {time.monotonic() - began:.0f} s: {len(results) - len(wrong)} as the table says, "
          f"{len(wrong)} not, {sum(r['attempts'] > 1 for r in results)} tried more than once")
    if arguments.page:
        import fault_matrix_page
        PAGE.write_text(fault_matrix_page.page(table, results, bench.BUILD))
    return 6 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
