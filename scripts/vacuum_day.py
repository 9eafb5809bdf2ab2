#!/usr/bin/env python3
"""Draws the pressures of the vacuum rig during a day: vacuum_day.py [--out docs/pictures/vacuum_day.svg]

The rig of config/vacuum with pressures from -40 to 60 kPa runs on the emulated board. The events of the day are a
start, a grip, a vent, a stop, faults, a pause that is longer than the time-out of the board's watchdog, and a kill of
the daemon. Each event occurs while a vacuum is held. After each event, the pressure must go to the rest pressure of 0
kPa without overshoot. Otherwise the exit code is 6. Needs a release build (SOFTGRIP_BUILD).
"""

import argparse
import pathlib
import shutil
import signal
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/system"))
import bench  # noqa: E402
import test_vacuum  # noqa: E402

FAULTS = {"lost_request": "", "no_reply": "", "disconnect": "", "exception_reply": ", code: 4", "ignored_write": "",
          "sensor_out_of_range": "", "line_leaking": ", share: 0.5"}
SAMPLE_S = 0.02
SETTLED_KPA = 0.05
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 1500, 520, 60, 150, 40


class Day(test_vacuum.Vacuum):
    def runTest(self):
        """Replaces a test of the base class, which must not run here."""

    def begin(self):
        self.setUp()
        faults = self.write("faults.yaml", "faults:\n" + "".join(
            f"  - {{name: {kind}, kind: {kind}{keys}}}\n" for kind, keys in FAULTS.items()))
        self.samples, self.marks, self.wrong = [], [], []
        self.lock = threading.Lock()
        self.over = threading.Event()
        self.start_vacuum_rig("--faults", faults, "--watchdog-s", "0.8")
        self.began = time.monotonic()
        self.sampler = threading.Thread(target=self.sample, daemon=True)
        self.sampler.start()

    def ask(self, line):
        with self.lock:
            return self.board.ask(line)

    def sample(self):
        while not self.over.is_set():
            with self.lock:
                channel = self.board.status()["channels"][0]
            self.samples.append((time.monotonic() - self.began, channel["pressure_command_kpa"], channel["pressure_kpa"]))
            time.sleep(SAMPLE_S)

    def mark(self, text):
        self.marks.append((time.monotonic() - self.began, text))
        print(f"{self.marks[-1][0]:7.2f} s  {text}", flush=True)

    def hold(self):
        self.softgripd.wait_for_state("idle")
        self.softgripd.ask("acknowledge")
        self.mark("start")
        since = self.softgripd.events()[-1]["id"]
        self.softgripd.start("vacuum_grip")
        self.softgripd.wait_for_event("grip_result", since=since, code="HOLDING", channel="left")

    def to_rest(self, what):
        """Begins a period in which the command must go to the rest pressure. The command must never pass this
        pressure."""
        since = time.monotonic() - self.began
        try:
            bench.wait_for("rest", lambda: self.samples and abs(self.samples[-1][1]) <= SETTLED_KPA, 15)
            time.sleep(0.3)
        except AssertionError:
            self.wrong.append(f"{what}: the output stays at {self.samples[-1][1]:.2f} kPa")
        after = [kpa for at, kpa, _ in self.samples if at >= since]
        if max(after) > SETTLED_KPA:
            self.wrong.append(f"{what}: the output went to {max(after):.2f} kPa, above the rest pressure")
        if any(b < a - SETTLED_KPA for a, b in zip(after, after[1:])):
            self.wrong.append(f"{what}: the output moved away from the rest pressure")

    def grip(self):
        self.hold()
        self.softgripd.wait_for_state("idle")
        self.to_rest("a whole grip")

    def command(self, name):
        self.hold()
        self.mark(name)
        self.softgripd.result(name)
        if name == "stop":  # after a stop, the outputs keep the vacuum until a release
            self.softgripd.wait_for_state("idle")
            time.sleep(0.5)
            self.mark("release")
            self.softgripd.result("release")
        self.to_rest(name)

    def fault(self, kind):
        self.hold()
        self.mark(kind)
        self.ask(f"fault {kind}")
        if kind == "ignored_write":
            time.sleep(1)  # while the vacuum is held, the daemon writes no outputs, so it does not detect the fault
            self.softgripd.ask("vent")
            self.softgripd.wait_for_state("faulted")
            self.ask(f"clear {kind}")
        else:
            self.softgripd.wait_for_state("faulted", "idle")
        if self.softgripd.status()["state"] == "faulted":
            code = self.softgripd.status()["fault"]["code"]
            self.mark(code)
            self.softgripd.ask("vent")  # after a fault of a reading, the outputs keep the vacuum until a vent
        self.to_rest(kind)
        self.ask(f"clear {kind}")
        bench.wait_for("an acknowledged fault", lambda: self.softgripd.ask("acknowledge")["ok"] or
                       self.softgripd.status()["state"] == "idle", pause_s=0.1)

    def pause(self):
        self.hold()
        self.mark("pause")
        self.softgripd.child.send_signal(signal.SIGSTOP)
        self.to_rest("a pause")
        self.mark("goes on")
        self.softgripd.child.send_signal(signal.SIGCONT)
        self.softgripd.wait_for_state("faulted")
        self.to_rest("after a pause")
        bench.wait_for("an acknowledged fault", lambda: self.softgripd.ask("acknowledge")["ok"], pause_s=0.1)

    def kill(self):
        self.hold()
        self.mark("daemon killed")
        self.softgripd.kill()
        self.to_rest("a killed daemon")
        self.softgripd = self.idle_daemon(self.rig_path)

    def end(self):
        self.hold()
        self.mark("SIGTERM")
        self.softgripd.end()
        self.to_rest("an end by SIGTERM")

    def clear(self):
        self.over.set()
        self.sampler.join()
        for process in self.processes:
            if process.running():
                process.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def run_all(self):
        self.begin()
        try:
            self.grip()
            for name in ("vent", "stop"):
                self.command(name)
            for kind in FAULTS:
                self.fault(kind)
            self.pause()
            self.kill()
            self.end()
        finally:
            self.clear()


def labels(marks):
    """Joins labels whose times differ by less than 1.3 s. Starts get no label, because they are visible in the
    curve."""
    found = []
    for at, text in marks:
        if text == "start" and found:
            continue
        if found and at - found[-1][0] < 1.3:
            found[-1][1] += f", {text}"
        else:
            found.append([at, text])
    return found


def picture(day):
    end_s = day.samples[-1][0]

    def x(time_s):
        return LEFT + (WIDTH - LEFT - 10) * time_s / end_s

    def y(kpa):
        return TOP + (HEIGHT - TOP - BOTTOM) * (10 - kpa) / 50

    def line(column, colour, width):
        samples = day.samples
        kept = [s for before, s, after in zip([None, *samples], samples, [*samples[1:], None])
                if before is None or after is None or before[column] != s[column] or after[column] != s[column]]
        points = " ".join(f"{x(s[0]):.1f},{y(s[column]):.1f}" for s in kept)
        return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"/>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for kpa in (10, 0, -10, -20, -30, -40):
        colour = "#2a7" if kpa == 0 else "#ccc"
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - 10}" y1="{y(kpa):.1f}" y2="{y(kpa):.1f}" stroke="{colour}"/>'
                     f'<text x="{LEFT - 6}" y="{y(kpa) + 4:.1f}" text-anchor="end">{kpa}</text>')
    for at, text in labels(day.marks):
        parts.append(f'<line x1="{x(at):.1f}" x2="{x(at):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                     f'<text transform="translate({x(at) + 4:.1f},{TOP - 6}) rotate(-60)">{text}</text>')
    parts += [line(2, "#e90", 3), line(1, "#14c", 1.2),
              f'<text x="{LEFT}" y="{HEIGHT - 10}">time: 0 to {end_s:.0f} s. Blue: pressure at the output of the board [kPa]. '
              'Orange: pressure at the finger. Green: rest pressure</text>', "</svg>"]
    return "\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/pictures/vacuum_day.svg")
    arguments = parser.parse_args()
    day = Day()
    day.run_all()
    arguments.out.write_text(picture(day))
    for text in day.wrong:
        print(f"WRONG {text}")
    print(f"{len(day.marks)} events, {len(day.wrong)} wrong; {arguments.out}")
    return 6 if day.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
