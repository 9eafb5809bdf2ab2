#!/usr/bin/python3
"""Writes a how-to page about common faults of a rig. The page shows the commands and the output of softgrip.

    scripts/morning.py [--build build/release] [--page docs/how-to/a-morning.md | --check docs/how-to/a-morning.md]

The emulator replaces the board and simulates the faults. Times of day are shown as hh:mm:ss, and measured numbers are
rounded. --check repeats the page and compares the sentences, regardless of their numbers.
"""
import argparse
import difflib
import os
import pathlib
import re
import sys
import textwrap
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/system"))

HEAD = """# A morning at the bench

This page shows the output of softgrip for common faults, and the remedies. `scripts/morning.py` ran the commands below,
with `softgrip-rig` in place of the board, and wrote this page. A test runs the commands again and compares their output
with this page. On this page, times are shown as hh:mm:ss, measured numbers are rounded, and `[...]` marks omitted lines.
`softgrip watch` shows the state of the daemon live. The keys of `softgrip watch` are `s`, `v`, `r`, `a` and `g`
([commands](../reference/commands.md#with-a-daemon)). The first picture shows `softgrip watch` in 80 columns while both
fingers hold a part. The second picture shows `softgrip watch` in 60 columns after a sensor failed during a hold and
recovered. `scripts/watch_pictures.py` drew the two pictures from a real terminal:

![watch at 80 columns: both fingers hold a part](../pictures/watch-80.svg)

![watch at 60 columns: after a sensor failed during a hold, the fingers remain pressurised](../pictures/watch-60.svg)
"""

WRONG_RECIPE = """name: pick_nut
steps:
  - grip:
      displacement_mm: 40
      sqeeze_kpa: 5
      squeeze_speed_kpa_per_s: 5
      speed_mm_per_s: 5
      settle_s: 0.5
      verify: {by: detection, window_s: 0.3}
      timeout_s: -20
      on_fail: release
  - hold:
      hold_s: 5 s
      reverify_every_s: 0.25
      on_fail: release
"""
MENDED = (("sqeeze", "squeeze"), ("5 s", "5"), ("-20", "20"))


def rounded(text):
    """Masks times of day and ports, and rounds measured values, because these texts differ between runs."""
    text = re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3}", "hh:mm:ss", text)
    text = re.sub(r"127\.0\.0\.1:\d+", "127.0.0.1:1502", text)
    text = re.sub(r"\d+ ms old", "fresh", text)
    text = re.sub(r"(?<![\d.])(?<!every )(?<!outputs after )-?\d+\.\d+(?= (kPa|mm|s|ms)\b)",
                  lambda found: f"{float(found.group()):.0f}", text)
    return re.sub(r"-0(?= (kPa|mm))", "0", text)


def sentences(page):
    """Returns the sentences that --check compares. Numbers are replaced by #. The comparison ignores line breaks and
    omitted lines. It also ignores details that differ between runs: how a connection was interrupted, which watchdog
    reported the interruption last, and the amount of data that the model has."""
    text = re.sub(r"-?\d+(\.\d+)?", "#", page.replace("[...]", ""))
    text = re.sub(r"disconnected:[^.]*", "disconnected", " ".join(text.split()))
    text = text.replace("watchdog_tripped: no successful exchange with the board for # s; the board's own watchdog vents the outputs after # s",
                        "disconnected")
    text = re.sub(r"model (unknown|healthy|suspect)", "model", text)
    return re.split(r"(?<=[.:]) ", text)


def play():
    """Runs the commands and returns the text of the page."""
    import bench

    class Morning(bench.BenchTest):
        def setUp(self):
            super().setUp()
            self.page = [HEAD]

        def say(self, text):
            for paragraph in text.split("\n\n"):
                self.page.append(textwrap.fill(paragraph, 118) + "\n")

        def show(self, *commands, keep=None, drop=None):
            """Adds a command and its output to the page. If `keep` is given, omits all other lines than those that
            match `keep`. If `drop` is given, omits lines that match `drop`."""
            shown = []
            for command in commands:
                done = self.softgrip(*command, expect=None)
                lines = (done.stdout + done.stderr).replace(f"{self.folder}/", "").splitlines()
                shown.append(f"$ softgrip {' '.join(str(one) for one in command)}")
                left_out = False
                for line in lines:
                    wanted = (keep is None or re.search(keep, line)) and not (drop and re.search(drop, line))
                    if wanted:
                        shown.append(line.rstrip())
                    elif not left_out or shown[-1] != "[...]":
                        shown.append("[...]")
                        left_out = True
            self.page.append("```\n" + rounded("\n".join(shown)) + "\n```\n")

        def show_status(self):
            """Adds the output of `softgrip status` to the page. Omits the lines about the loop, the recording and the
            bars, because they never change on this page."""
            self.show(("status",), drop=r"^(loop|recording|  (pressure|displacement) .*|$)|real time degraded")

        def show_failures(self, *command):
            """Adds the failed checks of softgrip doctor, and the checks that could not be judged because of these
            failures. Omits the timing checks, because they may fail on a busy computer."""
            done = self.softgrip("doctor", *command, expect=6)
            shown, wanted = [f"$ softgrip doctor {' '.join(command)}".rstrip()], False
            for line in done.stdout.splitlines():
                if re.match(r" (ok  |warn|FAIL|--  ) ", line):
                    wanted = line.startswith((" FAIL", " --")) and not re.match(r" FAIL (timer|bus time|loop) ", line)
                if wanted and not line.startswith("NOT FIT"):
                    shown.append(line.rstrip())
                elif shown[-1] != "[...]":
                    shown.append("[...]")
            self.page.append("```\n" + rounded("\n".join(shown)) + "\n```\n")

        def newest(self):
            return self.softgripd.result("events", limit=1)["newest"]

        def emulate(self, port=0):
            self.emulated = self.emulator("--object", "stone", "--faults", self.folder / "faults.yaml", port=port,
                                          name=f"rig{len(self.processes)}")
            return self.emulated.port

        def no_cable(self):
            self.say("## The cable is not connected\n\nsoftgripd was started before the board was connected. Until "
                     "the first connection, softgripd does not report the missing connection as a fault. `softgrip "
                     "status` shows the number and the interval of the connection attempts.")
            bench.wait_for("slow attempts", lambda: self.softgripd.status()["bus"]["attempts"] >= 4)
            self.show_status()
            self.say("The cable is connected:")

        def cable_out(self):
            self.say("## The cable is disconnected\n\nThe rig is idle and holds no part. The fault remains latched "
                     "until it is acknowledged. While the cause of the fault is present, the daemon refuses "
                     "`acknowledge` with a message that names the cause.")
            self.emulated.ask("fault cable")
            self.softgripd.wait_for_state("faulted")
            bench.wait_for("attempts", lambda: self.softgripd.status()["bus"]["attempts"] >= 2)
            bench.wait_for("the watchdog", lambda: self.softgripd.status()["bus"]["failure_kind"] == "watchdog_tripped")
            bench.wait_for("readings to be old", lambda: all(
                channel["validity"] == "stale" for channel in self.softgripd.status()["channels"]))
            self.show_status()
            self.show(("acknowledge",))
            self.say("`softgrip doctor` reports one failure for the disconnected cable. `softgrip doctor` does not "
                     "check sensors and models, because the checks of sensors and models need the board:")
            self.show_failures()
            self.say("The cable is connected again:")
            self.emulated.ask("clear cable")
            bench.wait_for("the cause to go", lambda: self.softgripd.status()["fault"]["present"] is None)
            self.show_status()
            self.show(("acknowledge",))
            self.softgripd.wait_for_state("idle")

        def sensor_out(self):
            self.say("## A sensor loses its cable\n\nThe fault message names the finger whose sensor failed.")
            self.emulated.ask("fault blind")
            self.softgripd.wait_for_state("faulted")
            self.show_status()
            self.emulated.ask("clear blind")
            bench.wait_for("the cause to go", lambda: self.softgripd.status()["fault"]["present"] is None)
            self.say("The sensor is connected again:")
            self.show(("acknowledge",))
            self.softgripd.wait_for_state("idle")

        def stop_while_holding(self):
            self.say("## Stopped while holding\n\nThe rig file has `holding: hold`, so a stop keeps the part held. "
                     "The output of `softgrip stop` warns of the remaining pressure and gives the command that vents "
                     "the fingers. The ready lamp blinks while the fingers are pressurised.")
            self.softgripd.start("hand_over")
            bench.wait_for("the hold", lambda: self.softgripd.results() == ["HOLDING", "HOLDING"])
            self.show(("stop",))
            self.show_status()
            self.show(("release",))
            bench.wait_for("no pressure", lambda: self.softgripd.status()["under_pressure"] is None)
            self.softgripd.wait_for_state("idle")

        def part_lost(self):
            self.say("## The part is lost\n\nThe part is pulled out of a running hold. The sequence has `on_fail: "
                     "release`, and the result is PART LOST.")
            since = self.newest()
            self.softgripd.start("hand_over")
            bench.wait_for("the hold", lambda: self.softgripd.results() == ["HOLDING", "HOLDING"])
            self.emulated.ask("object out")
            self.softgripd.wait_for_event("sequence_finished", since=since)
            self.softgripd.wait_for_state("idle")
            self.show(("events", "--since", str(since)), keep=r"left: Grip result|sequence")
            self.emulated.ask("object stone")

        def wrong_recipe(self):
            self.say("## A wrong recipe\n\nThe sequence file has a misspelled key, a unit behind a number and a "
                     "negative time. `softgrip start` reports all errors at once, with line and column, and no finger "
                     "moves.")
            self.write("pick_nut.yaml", WRONG_RECIPE)
            self.page.append(f"```yaml\n{WRONG_RECIPE}```\n")
            self.show(("start", "pick_nut.yaml"))
            self.say("After the correction of the errors in the sequence file, the next message names the motions that the "
                     "rig cannot make:")
            text = WRONG_RECIPE
            for wrong, right in MENDED:
                text = text.replace(wrong, right)
            self.write("pick_nut.yaml", text)
            self.show(("start", "pick_nut.yaml"))
            self.assertEqual(self.softgripd.status()["state"], "idle")

        def crossed_sensors(self):
            self.say("## Crossed sensors\n\nThe sensor of each of the two fingers was connected to the input of the "
                     "other finger. "
                     "`doctor --move` moves one finger after the other and reads all sensors.")
            self.softgripd.end()
            swap = ((r"sensor: \{input: 0\b", "sensor: {input: 99"), (r"sensor: \{input: 1\b", "sensor: {input: 0"),
                    (r"sensor: \{input: 99\b", "sensor: {input: 1"))
            self.rig(self.emulated.port, swap).rename(self.folder / "rig.yaml")
            (self.folder / "rig.yaml").write_text(
                (self.folder / "rig.yaml").read_text().replace("boards/", "config/boards/").replace(
                    "models/", "config/models/"))
            self.show_failures("--rig", "rig.yaml", "--move")

        def runTest(self):
            self.write("faults.yaml", "faults:\n  - {name: cable, kind: disconnect}\n"
                                      "  - {name: blind, kind: sensor_out_of_range, channel: left}\n")
            port = self.emulate()
            # The bus fault must occur before the board's watchdog trips, so this time is much shorter than the watchdog
            # time-out.
            rig = self.rig(port, ((r"bus_down_cycles: \d+", "bus_down_cycles: 10"),))
            self.emulated.end()
            self.softgripd = self.daemon(rig)
            self.no_cable()
            self.emulate(port)
            self.softgripd.wait_for_state("idle")
            self.show(("watch", "--count", "1"))
            for scene in (self.cable_out, self.sensor_out, self.stop_while_holding, self.part_lost,
                          self.wrong_recipe, self.crossed_sensors):
                scene()
            play.page = "\n".join(self.page)

    if not unittest.TextTestRunner(verbosity=0).run(Morning()).wasSuccessful():
        sys.exit(1)
    return play.page.replace(str(ROOT), "")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    arguments.add_argument("--page", type=pathlib.Path)
    arguments.add_argument("--check", type=pathlib.Path)
    given = arguments.parse_args()
    os.environ["SOFTGRIP_BUILD"] = str(given.build.resolve())
    page = play()
    if given.page:
        given.page.write_text(page)
    if not given.check:
        return 0
    differences = list(difflib.unified_diff(sentences(given.check.read_text()), sentences(page), str(given.check),
                                            "this morning", lineterm="", n=1))
    print("\n".join(differences))
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
