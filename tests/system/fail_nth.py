"""Makes the Nth call of one group of functions fail (libfail_nth.so). N increases from 1 until a run has fewer than N
calls.

scripts/fail_nth.sh runs all scenarios; test_fail_nth.py runs the part that takes less than a minute.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import bench

SHIM = bench.BUILD / "tests" / "system" / "libfail_nth.so"
PATIENCE_S = 60
# Groups of functions that a program calls in loops. These calls are frequent, so N increases in steps of 25 %.
SPARSE = ("clock", "sleep", "send", "recv", "write", "open", "allocation")
FILES = ("open", "write", "short_write", "fsync", "rename", "mkdir")
PROCESS = ("mmap", "mlockall", "scheduler", "thread")
WIRE = ("socket", "connect", "bind", "listen", "send", "recv", "sleep", "clock")
# Exit codes that a run may have after a failed call. 0: done, 1: failed, 3: refused, 4: input or output error, 5: not
# possible in this state, 6: finished with a bad result.
GOT_OVER_IT, VIRTUAL, REAL = (0,), (0, 1, 3, 4), (0, 1, 3, 4, 5, 6)
SEQUENCE = """name: short
steps:
  - move: {displacement_mm: 4, speed_mm_per_s: 20, settle_s: 0.1}
  - release: {duration_s: 0.2, purge_s: 0.2, timeout_s: 5, on_fail: vent}
"""


class Failure(AssertionError):
    """Exception for a failed call with a forbidden consequence."""


def ends_in_a_destructor(done, call):
    """Returns True if an allocation has failed in a destructor of the JSON library. A destructor must not throw, so
    such a failure ends the process."""
    return call == "allocation" and done.returncode == -signal.SIGABRT and "std::bad_alloc" in done.stderr


def run(arguments, folder, call, nth, from_then_on=False):
    """Runs the command. Returns the finished process, and True if the run reached the Nth call."""
    told = folder / "told"
    told.unlink(missing_ok=True)
    environment = {**os.environ, "LD_PRELOAD": str(SHIM), "FAIL_CALL": call, "FAIL_NTH": str(nth), "FAIL_TOLD": str(told)}
    if from_then_on:
        environment["FAIL_FROM"] = "1"
    try:
        done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, errors="replace", cwd=folder,
                              timeout=PATIENCE_S, env=environment, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise Failure(f"{call} {nth}: it hangs") from None
    return done, told.exists()


def check_end(done, what, codes, silenced=False):
    """Checks that the program does not crash. Also checks that it prints a message before it ends, if it can write
    the message."""
    if done.returncode not in codes:
        raise Failure(f"{what}: exit code {done.returncode}\n{done.stderr[-1500:]}")
    if done.returncode != 0 and not silenced and len((done.stdout + done.stderr).strip()) < 20:
        raise Failure(f"{what}: exit code {done.returncode} without a message: {done.stderr!r}")


def check_recording(folder, what):
    """Checks a recording after a failed call. All rows except the last must be complete, and run.json must be valid
    if it exists. No temporary file may remain."""
    csv = folder / "run.csv"
    if csv.exists():
        rows = csv.read_text().split("\n")
        for row in rows[1:-1]:
            if row.count(",") != rows[0].count(","):
                raise Failure(f"{what}: an incomplete row: {row!r}")
    about = folder / "run.json"
    if about.exists():
        json.loads(about.read_text())
    left = [path.name for path in folder.iterdir() if path.name not in ("run.csv", "run.json")]
    if left:
        raise Failure(f"{what}: left behind: {left}")


def check_complete(folder, done, what):
    """Checks that all requested output files exist if the exit code is 0."""
    about = folder / "run.json"
    if not about.exists() or json.loads(about.read_text())["state"] != "complete":
        raise Failure(f"{what}: exit code 0 without a complete recording\n{done.stderr[-1500:]}")


def numbers(call, highest):
    """Generates N = 1, 2, 3, ... For groups with frequent calls, N increases in steps of 25 % above 10."""
    nth = 1
    while nth <= highest:
        yield nth
        nth += 1 if call not in SPARSE or nth < 10 else nth // 4


class Scenario:
    """A folder with the shipped configuration, and a command in whose run the Nth call fails."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_fail_nth_"))
        shutil.copytree(bench.SOURCE / "config", self.folder / "config")
        self.sequence = self.folder / "short.yaml"
        self.sequence.write_text(SEQUENCE)
        self.out = self.folder / "run"
        self.emulator = None
        self.aborted = 0

    def close(self):
        if self.emulator:
            self.emulator.kill()
            self.emulator.control.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def virtual(self, call, nth, from_then_on=False):
        """Runs softgripd in virtual time. In this mode, it has one thread, so its calls always have the same
        order."""
        shutil.rmtree(self.out, ignore_errors=True)
        histograms = self.folder / "histograms"
        histograms.unlink(missing_ok=True)
        done, happened = run([bench.SOFTGRIPD, "--config", "config/rig.yaml", "--virtual-time", "--sequence", self.sequence,
                              "--record", self.out, "--histograms", histograms], self.folder, call, nth, from_then_on)
        what = f"virtual {call} {nth}"
        if ends_in_a_destructor(done, call):
            self.aborted += 1
            return happened
        check_end(done, what, VIRTUAL if happened else GOT_OVER_IT, from_then_on and call == "write")
        if self.out.exists():
            check_recording(self.out, what)
        if happened and done.returncode == 0:
            check_complete(self.out, done, what)
        return happened

    def writer(self, arguments, name, call, nth, from_then_on=False):
        """Runs a command that writes a file or a folder. After the run, either the old version or the complete new
        version of the output must exist."""
        out = self.folder / name
        before = "what was there before\n"
        if out.suffix:
            out.write_text(before)
        else:
            shutil.rmtree(out, ignore_errors=True)
        done, happened = run([bench.SOFTGRIP, *arguments, "--out", out], self.folder, call, nth, from_then_on)
        what = f"{arguments[0]} {call} {nth}"
        check_end(done, what, VIRTUAL if happened else GOT_OVER_IT, from_then_on and call == "write")
        if happened and call in FILES and call != "open" and done.returncode not in (0, 4):
            raise Failure(f"{what}: exit code {done.returncode} although the output could not be written\n{done.stderr}")
        places = [out.parent] + ([out] if out.is_dir() else [])
        torn = [p.name for place in places for p in place.iterdir() if ".part" in p.name or p.name.endswith(".tmp")]
        if torn:
            raise Failure(f"{what}: left behind: {torn}")
        if out.suffix and done.returncode != 0 and out.read_text() != before:
            raise Failure(f"{what}: exit code {done.returncode}, and the previous file is gone")
        return happened

    def simulate(self, call, nth, from_then_on=False):
        return self.writer(["simulate", "--model", "config/models/bench_twin.yaml", "--input", "tp1"], "simulated.csv",
                           call, nth, from_then_on)

    def validate(self, call, nth, from_then_on=False):
        """Runs a command that writes several files to a folder."""
        log = self.folder / "log.csv"
        if not log.exists():
            subprocess.run([bench.SOFTGRIP, "simulate", "--model", "config/models/bench_twin.yaml", "--input", "steps",
                            "--rate-hz", "50", "--out", log], cwd=self.folder, check=True, capture_output=True)
        return self.writer(["validate", "--model", "config/models/bench_twin.yaml", "--data", log], "validated", call, nth,
                           from_then_on)

    def rig(self):
        if self.emulator is None:
            self.emulator = bench.Emulator(self.folder)
        text = (self.folder / "config" / "rig_tcp.yaml").read_text()
        for pattern, replacement in ((r"port: \d+", f"port: {self.emulator.port}"),
                                     (r"exchange_deadline_s: [\d.]+", "exchange_deadline_s: 0.15"),
                                     (r"bus_down_cycles: \d+", "bus_down_cycles: 60"),
                                     (r"invalid_reading_cycles: \d+", "invalid_reading_cycles: 120"),
                                     (r"max_missed_commands: \d+", "max_missed_commands: 120"),
                                     (r"max_age_s: [\d.]+", "max_age_s: 0.6"),
                                     (r"path: /tmp/softgrip.sock", f"path: {self.folder}/softgripd.sock")):
            text = re.sub(pattern, replacement, text)
        path = self.folder / "config" / "real.yaml"
        path.write_text(text)
        return path

    def real(self, call, nth, from_then_on=False):
        """Runs softgripd in real time. Afterwards, checks the outputs of the board."""
        rig = self.rig()
        shutil.rmtree(self.out, ignore_errors=True)
        done, happened = run([bench.SOFTGRIPD, "--config", rig, "--sequence", self.sequence, "--record", self.out],
                             self.folder, call, nth, from_then_on)
        what = f"real {call} {nth}"
        if ends_in_a_destructor(done, call):
            self.aborted += 1
        else:
            check_end(done, what, REAL if happened else GOT_OVER_IT)
        if self.out.exists():
            check_recording(self.out, what)
        if happened and done.returncode == 0:
            check_complete(self.out, done, what)
        bench.wait_for(f"{what}: safe outputs", lambda: max(self.emulator.commands_kpa()) < 0.1, 5)
        return happened


def until_success(scenario, call, highest=2000, from_then_on=False):
    """Makes the first call fail, then the second, and so on, until a run has no failed call and succeeds. Returns the
    number of failed calls."""
    failed = 0
    for nth in numbers(call, highest):
        if not scenario(call, nth, from_then_on):
            return failed, True
        failed += 1
    return failed, False


ALL = ([("virtual", call) for call in FILES] + [("simulate", call) for call in FILES] + [("validate", call) for call in FILES] +
       [("real", call) for call in PROCESS + FILES + WIRE] + [(what, "allocation") for what in ("validate", "virtual", "real")])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("calls", nargs="*", help="only these calls")
    parser.add_argument("--minutes-each", type=float, default=2,
                        help="a longer scenario is ended early, and the output says so")
    arguments = parser.parse_args()
    if not SHIM.exists():
        parser.error(f"{SHIM} is not built")
    wrong = 0
    for what, call in ALL:
        if arguments.calls and call not in arguments.calls:
            continue
        for from_then_on in (False, True) if what != "real" and call in ("write", "open") else (False,):
            scenario = Scenario()
            began = time.monotonic()
            failed, end = 0, "until a run succeeded"
            try:
                for nth in numbers(call, 100000):
                    if not getattr(scenario, what)(call, nth, from_then_on):
                        break
                    failed += 1
                    if time.monotonic() - began > arguments.minutes_each * 60:
                        end = f"stopped by the time limit at call {nth}"
                        break
            except AssertionError as error:
                wrong += 1
                end = f"WRONG: {error}"
            finally:
                scenario.close()
            if scenario.aborted:
                end += f"; {scenario.aborted} of these failures ended the program in a destructor"
            print(f"{what:9} {call:12}{'and all later' if from_then_on else '':14} {failed:4} calls failed, {end}", flush=True)
    return 6 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
