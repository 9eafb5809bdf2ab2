"""Tests softgripd with a board that pymodbus serves. softgripd and pymodbus have independent implementations of the
protocol."""

import json
import pathlib
import subprocess
import sys
import unittest

import bench

try:
    import pymodbus  # noqa: F401
except ImportError:
    pymodbus = None

MOVE = """name: move
steps:
  - move: {displacement_mm: 8, speed_mm_per_s: 10, settle_s: 2}
  - move: {displacement_mm: 12, speed_mm_per_s: 10, settle_s: 2, tolerance_mm: 0.5, timeout_s: 20, on_fail: vent}
  - release: {duration_s: 1, purge_s: 1, timeout_s: 10, on_fail: vent}
"""


@unittest.skipUnless(pymodbus, "pymodbus is not installed")
class Pymodbus(bench.BenchTest):
    def serve(self, *arguments):
        self.board = subprocess.Popen([sys.executable, pathlib.Path(__file__).with_name("pymodbus_rig.py"), *arguments],
                                      text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.board.stdout.close)
        self.addCleanup(self.board.wait)
        self.addCleanup(self.board.stdin.close)
        self.port = json.loads(self.board.stdout.readline())["port"]

    def told(self):
        self.board.stdin.write("\n")
        self.board.stdin.flush()
        return json.loads(self.board.stdout.readline())

    def test_a_stone_is_held_and_released(self):
        self.serve("12")
        daemon = self.idle_daemon(self.rig(self.port))
        daemon.start("pick_stone")
        self.assertEqual(daemon.wait_for_event("sequence_finished")["code"], "done", daemon.errors())
        told = [(event["channel"], event["code"]) for event in daemon.events() if event["kind"] == "grip_result"]
        for channel in ("left", "right"):
            self.assertEqual([code for name, code in told if name == channel], ["HOLDING", "RELEASED"])

    def test_a_sequence_runs_to_its_end(self):
        self.serve()
        daemon = self.idle_daemon(self.rig(self.port))
        path = self.write("config/sequences/move.yaml", MOVE)
        daemon.start("move")
        highest_mm = 0
        while not any(event["kind"] == "sequence_finished" for event in daemon.events()):
            highest_mm = max(highest_mm, *self.told()["displacements_mm"])
            self.assertTrue(daemon.running())
            bench.time.sleep(0.05)
        end = daemon.wait_for_event("sequence_finished")
        self.assertEqual(end["code"], "done", f"{path}: {daemon.errors()}")
        self.assertAlmostEqual(highest_mm, 12, delta=0.5)
        bench.wait_for("vented valves", lambda: max(self.told()["commands_kpa"]) < 0.1)
        told = self.told()
        self.assertGreater(told["writes"], 300)
        self.assertEqual(daemon.status()["fault"], None)

        self.assertEqual(daemon.end(), 0)
        self.assertLess(max(self.told()["commands_kpa"]), 0.1)


if __name__ == "__main__":
    bench.main()
