#!/usr/bin/env python3
"""Grips through softgrip-plc while client, gateway and daemon are killed at random: plc_campaign.py [--grips N]
[--seed S]

The script counts every execution of a command in the daemon's events and on the emulated board. The exit code is 6 in
three cases: a command was executed twice, an accepted command was not executed, or a refused command was executed.
The output lists the outcomes of the commands and the delay from the client's write to the output of the board (p50,
p99, max).
"""

import argparse
import collections
import pathlib
import random
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/system"))
import bench  # noqa: E402
import plc  # noqa: E402

OUTCOMES = {plc.ACCEPTED: "accepted", plc.REFUSED: "refused", plc.UNKNOWN: "unknown"}
ERROR = 5
RESULTS = {plc.HOLDING: "HOLDING", plc.NO_PART: "NO PART", plc.PART_LOST: "PART LOST", ERROR: "ERROR"}
FREE_STROKE = 4  # number of the recipe free_stroke
# Fraction of the grips that are disturbed: one of three.
DISTURBED = 1 / 3


class Campaign(bench.BenchTest):
    grips, seed = 50, 1

    def setUp(self):
        super().setUp()
        self.random = random.Random(self.seed)
        # After a kill during a grip, the finger creeps for one or two minutes until it is at rest. This change of the
        # model shortens the creep.
        self.creep_faster()
        self.board = self.emulator("--object", "stone")
        self.rig_path = self.rig(self.board.port)
        self.softgripd, self.gateway, self.master = None, None, None
        self.wrong, self.counts, self.latencies = [], collections.Counter(), []
        self.started_before = 0
        self.start_daemon()
        self.start_gateway()
        self.start_master()

    def start_daemon(self):
        self.softgripd = self.idle_daemon(self.rig_path)
        self.started_before = 0

    def start_gateway(self):
        port = self.gateway.port if self.gateway else 0
        self.gateway = plc.Plc(self.folder, port=port)
        self.processes.append(self.gateway)

    def start_master(self, synchronise=True):
        if self.master:
            self.master.close()
        self.master = plc.Master(self.gateway, synchronise)
        self.addCleanup(self.master.close)

    def disturb(self):
        """Kills and restarts the client, the gateway or the daemon."""
        victim = self.random.choice(("master", "gateway", "daemon"))
        self.counts[f"{victim} restarted"] += 1
        if victim == "daemon":
            self.softgripd.kill()
            self.start_daemon()
        if victim == "gateway":
            self.gateway.kill()
            self.start_gateway()
        if victim in ("master", "gateway"):
            # A PLC writes its registers in every cycle. After a restart, the client begins with the counter of the
            # gateway and sends no command.
            self.start_master(synchronise=victim == "master")
        return victim

    def starts(self):
        """Returns the number of sequences that the running daemon has started since the last call."""
        count = len(plc.started(self.softgripd))
        new, self.started_before = count - self.started_before, count
        return new

    def grip(self):
        self.starts()
        daemon = self.softgripd
        disturbed = self.random.random() < DISTURBED
        counter = self.master.put(plc.START, recipe=1, squeeze=self.random.randrange(300, 1000))
        victim = None
        if disturbed:
            time.sleep(self.random.choice((0, 0, 0.002, 0.01, 0.05, 0.5, 3)))
            victim = self.disturb()
        if victim in ("master", "gateway"):
            # A restarted client does not repeat its command. If the gateway has restarted as well, the outcome of the
            # command is unknown.
            bench.wait_for("a daemon", lambda: self.master.read("state") != plc.NO_DAEMON_STATE)
        outcome = self.outcome_of(counter, victim)
        # The sequences of a daemon that was killed cannot be counted.
        executed = self.starts() if daemon is self.softgripd else None
        self.judge(outcome, executed, victim)
        self.come_to_rest()

    def outcome_of(self, counter, victim):
        if victim == "gateway":
            # The restarted gateway does not know if the previous gateway has executed the command. Therefore it must
            # not execute this command.
            for _ in range(5):
                self.master.write("command_counter", counter, plc.START, 1)
            if self.master.done(counter) != (plc.REFUSED, plc.FIRST_AFTER_START):
                self.wrong.append("a new gateway executed an old command as if the command were new")
            time.sleep(0.1)
            return None
        return self.master.done(counter)[0]

    def judge(self, outcome, executed, victim):
        self.counts[OUTCOMES.get(outcome, "not answered")] += 1
        if executed is None:
            if self.starts():
                self.wrong.append(f"carried out by a daemon that was started later ({victim})")
            return
        self.counts[f"carried out {executed} times"] += 1
        if executed > 1:
            self.wrong.append(f"carried out {executed} times ({victim})")
        if outcome == plc.ACCEPTED and executed != 1:
            self.wrong.append(f"accepted, but not carried out exactly once ({victim})")
        if outcome == plc.REFUSED and executed != 0:
            self.wrong.append(f"refused, but carried out ({victim})")

    def wait_for_result(self):
        """Waits for the result of a grip. Before the fingers move, the gateway shows the result of the previous
        grip. If the fingers are not at rest, the grip does not begin."""
        self.master.wait("state", plc.RESYNCHRONISING, plc.RUNNING)
        self.master.wait("state", plc.RUNNING, plc.IDLE, plc.FAULTED)
        self.master.wait("result", *RESULTS)
        result = self.master.read("result")
        self.counts[f"grips: {RESULTS[result]}"] += 1
        return result

    def stroke(self):
        """Runs a stroke without a part. After a kill during a grip, the restarted daemon uses this stroke to determine
        the state of the finger."""
        self.counts["free strokes"] += 1
        self.master.command(plc.START, recipe=FREE_STROKE)
        self.master.wait("state", plc.RESYNCHRONISING, plc.RUNNING)
        self.master.wait("state", plc.IDLE)

    def come_to_rest(self):
        """Vents, measures the delay from the command to the board, and waits until the rig is idle."""
        self.master.synchronise()
        bench.wait_for("a daemon", lambda: self.master.read("state") not in (plc.NO_DAEMON_STATE, 1))
        held = min(self.board.commands_kpa())
        if held > 3:
            began = time.monotonic()
            self.master.put(plc.VENT)
            bench.wait_for("falling outputs", lambda: min(self.board.commands_kpa()) < held - 0.02, pause_s=0)
            self.latencies.append((time.monotonic() - began) * 1e3)
        else:
            self.master.command(plc.VENT)
        self.master.wait("state", plc.IDLE, 6)
        self.master.command(plc.ACKNOWLEDGE)
        self.master.wait("state", plc.IDLE)
        bench.wait_for("vented outputs", lambda: max(self.board.commands_kpa()) < 0.5)

    def check_recordings(self):
        """Deletes the incomplete recordings of daemons that were killed."""

    def runTest(self):
        began = time.monotonic()
        for number in range(self.grips):
            if number % 3:
                # Sends some of the commands while the gripper holds a part.
                self.master.command(plc.START, recipe=1)
                result = self.wait_for_result()
                self.come_to_rest()
                if result == ERROR:
                    self.stroke()
            self.grip()
        print(f"{self.grips} grips, seed {self.seed}, {time.monotonic() - began:.0f} s")
        for name, count in sorted(self.counts.items()):
            print(f"{count:6} {name}")
        times = sorted(self.latencies)
        print(f"time from the client's write of a vent to the change of the board's output: p50 {times[len(times) // 2]:.1f} ms, "
              f"p99 {times[int(len(times) * 0.99)]:.1f} ms, max {times[-1]:.1f} ms, {len(times)} times")
        self.assertEqual(self.wrong, [])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--grips", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    Campaign.grips, Campaign.seed = arguments.grips, arguments.seed
    outcome = bench.unittest.TextTestRunner(verbosity=0).run(Campaign())
    sys.exit(0 if outcome.wasSuccessful() else 6)


if __name__ == "__main__":
    main()
