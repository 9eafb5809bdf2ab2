"""Kills the daemon with kill -9 in the middle of a grip. The board must vent, and at most the last second of the
recording may be missing."""

import json
import random
import time

import bench
import kill_nine

WATCHDOG_S = 0.5  # time-out of the watchdog in the board map


class Kill(bench.BenchTest):
    def test_the_board_vents_after_a_kill_and_the_recording_is_readable(self):
        emulator = self.emulator("--object", "stone")
        daemon = self.idle_daemon(self.rig(emulator.port))
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        began = daemon.wait_for_event("recording_started")["time_s"]
        self.assertGreater(min(emulator.commands_kpa()), 10)

        killed_at = daemon.status()["time_s"] - began
        daemon.kill()
        killed = time.monotonic()
        bench.wait_for("vented valves", lambda: max(emulator.commands_kpa()) == 0)
        # The test reads the outputs from the emulator every 20 ms. The rest of the 0.5 s is a margin for a busy
        # machine.
        self.assertLess(time.monotonic() - killed, WATCHDOG_S + 0.5)
        self.assertTrue(emulator.status()["watchdog_tripped"])

        (recording,) = self.recordings()
        last = float(self.rows(recording)[-1]["time_s"])
        self.assertGreater(last, killed_at - 1)
        self.assertLess(last, killed_at + 1)
        json.loads((recording / "run.json").read_text())
        self.softgrip("plot", recording, "--out", self.folder / "run.svg")
        self.softgrip("simulate", "--model", "config/models/bench_twin.yaml", "--input", recording,
                      "--channel", "left", "--out", self.folder / "again.csv")

    def test_a_new_daemon_after_a_kill_is_vented_and_idle(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.idle_daemon(rig)
        daemon.start("track_sine")
        bench.wait_for("pressure", lambda: min(emulator.commands_kpa()) > 5)
        daemon.kill()
        again = self.idle_daemon(rig)
        for _ in range(20):
            self.assertLess(max(emulator.commands_kpa()), 0.1)
            time.sleep(0.05)
        self.assertEqual(again.status()["state"], "idle")

    def test_a_new_daemon_grips_again_after_a_free_stroke(self):
        """Moves the finger once without a part. A new daemon does not know the creep that an earlier pressure has
        caused. The daemon estimates this creep from the stroke."""
        self.creep_faster()
        emulator = self.emulator("--object", "stone")
        rig = self.rig(emulator.port)
        daemon = self.idle_daemon(rig)
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        daemon.kill()
        again = self.idle_daemon(rig)
        bench.wait_for("creep that has gone", lambda: max(c["displacement_mm"] for c in emulator.status()["channels"]) < 3)

        def grip():
            since = again.events()[-1]["id"]
            again.start("pick_stone")
            return again.wait_for_event("grip_result", since, channel="left")["code"]
        self.assertEqual(grip(), "ERROR")
        self.assertEqual(again.wait_for_event("not_at_rest", channel="left")["code"], "off_model")
        again.wait_for_state("idle")
        for arguments in ((), ("--json",)):
            done = self.softgrip("start", "pick_stone", "--wait", *arguments, "--socket", again.socket_path, expect=6)
            self.assertRegex(done.stderr.splitlines()[-1], "pick_stone was not completed. left: Start aborted: at rest, the finger")
            self.assertIn("Start aborted", done.stdout)
            again.wait_for_state("idle")
        again.start("free_stroke")
        again.wait_for_event("sequence_finished", code="done")
        self.assertEqual(grip(), "HOLDING")

    def test_kills_at_random_times_leave_a_vented_board_and_a_valid_recording(self):
        """Runs a few kills at random times. scripts/kill_nine.sh runs a hundred kills."""
        seed = random.SystemRandom().randrange(1 << 31)
        print(f"seed {seed}")
        for number in range(4):
            result = kill_nine.once(number, seed)
            self.assertIsNone(result["wrong"], f"seed {seed}")


if __name__ == "__main__":
    bench.main()
