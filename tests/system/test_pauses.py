"""Tests that no pressure rises without a command after a pause of the daemon.

Either the whole process pauses (SIGSTOP), or one of its threads does (ptrace): the loop, the bus or the service
thread. The pauses are shorter than, equal to and longer than the time-out of the board's watchdog. They occur in
every phase of a grip, over a real connection."""

import os
import subprocess
import time

import bench
import pauses

WATCHDOG_S = 0.5  # time-out of the watchdog in the board map
# Each entry contains three values: the process or thread that pauses, the duration of the pause [s], and the required
# result.
PAUSES = (
    # The permitted time without a bus exchange is longer than this pause. The grip may therefore continue, or it may
    # end with a fault.
    ("process", 0.2, "anything"),
    ("process", WATCHDOG_S, "F303"),
    ("process", 0.8, "F303"),
    ("softgrip-loop", 0.2, "anything"),
    ("softgrip-loop", 1.5, "F901"),
    # The loop detects the pause of the bus thread before the bus thread can report the fault itself.
    ("softgrip-bus", 0.8, "faulted"),
    ("softgrip-serve", 0.8, "nothing"),
)
NOISE_KPA = 0.05  # resolution of the board's outputs


class Pauses(bench.BenchTest):
    def pause(self, daemon, what, for_s):
        try:
            pauses.pause(daemon, what, for_s)
        except PermissionError as error:
            self.skipTest(str(error))

    def reach(self, daemon, emulator, phase):
        pick = (self.folder / "config/sequences/pick_stone.yaml").read_text()
        hold_s = 0.5 if phase == "releasing" else 20
        (self.folder / "config/sequences/paused.yaml").write_text(pick.replace(
            "hold_s: {default: 5", f"hold_s: {{default: {hold_s}"))
        daemon.wait_for_state("idle")
        daemon.start("paused")
        if phase == "closing":
            bench.wait_for("the approach", lambda: min(emulator.commands_kpa()) > 5, pause_s=0.005)
            return
        for channel in ("left", "right"):
            daemon.wait_for_event("grip_result", code="HOLDING", channel=channel)
        if phase == "releasing":
            daemon.wait_for_event("step_started", text="Step 4 started: release.")

    def outputs_for(self, emulator, seconds):
        samples, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            samples.append(emulator.commands_kpa())
            time.sleep(0.001)
        return samples

    def check(self, phase, what, for_s, expected):
        emulator = self.emulator("--object", "stone", name=f"rig-{phase}-{what}-{for_s}")
        daemon = self.daemon(self.rig(emulator.port))
        try:
            self.reach(daemon, emulator, phase)
            before = emulator.commands_kpa()
            self.pause(daemon, what, for_s)
            samples = self.outputs_for(emulator, 1)
            faults = [e["code"] for e in daemon.events() if e["kind"] == "fault_latched"]
            if expected == "nothing":
                self.assertEqual(faults, [])
            elif expected == "faulted":
                self.assertNotEqual(faults, [])
            elif expected != "anything":
                self.assertIn(expected, faults)
            if faults:
                self.check_nothing_rises(before, samples, vented=what != "softgrip-loop" and for_s >= WATCHDOG_S)
                self.assertEqual(daemon.status()["state"], "faulted")
        finally:
            daemon.kill()
            emulator.kill()

    def check_nothing_rises(self, before, samples, vented):
        for channel, lowest in enumerate([0, 0] if vented else before):
            for sample in samples:
                self.assertLessEqual(sample[channel], lowest + NOISE_KPA, [s[channel] for s in samples[:50]])
                lowest = min(lowest, sample[channel])

    def check_phase(self, phase):
        for what, for_s, expected in PAUSES:
            with self.subTest(phase=phase, what=what, for_s=for_s):
                self.check(phase, what, for_s, expected)

    def test_no_pressure_rises_after_a_pause_while_closing(self):
        self.check_phase("closing")

    def test_no_pressure_rises_after_a_pause_while_holding(self):
        self.check_phase("holding")

    def test_no_pressure_rises_after_a_pause_while_releasing(self):
        self.check_phase("releasing")

    def test_a_pause_during_the_last_step_ends_the_sequence_as_faulted(self):
        self.start_rig()
        path = self.write("config/sequences/brief.yaml",
                          "name: brief\nsteps:\n  - move: {pressure_kpa: 10, duration_s: 1}\n")
        with subprocess.Popen([bench.SOFTGRIP, "start", "--wait", path], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "SOFTGRIP_SOCKET": str(self.folder / "softgripd.sock")}) as waiting:
            bench.wait_for("a pressure", lambda: min(self.board.commands_kpa()) > 1, pause_s=0.005)
            self.pause(self.softgripd, "process", 1.5)
            said = waiting.communicate(timeout=bench.PATIENCE_S)[0]
        self.assertEqual(waiting.returncode, 6, said)
        self.softgripd.wait_for_event("sequence_finished", code="faulted")

    def test_a_bus_down_time_longer_than_the_watchdog_is_rejected(self):
        rig = self.rig(1502, ((r"bus_down_cycles: \d+", "bus_down_cycles: 90"),))
        done = subprocess.run([bench.SOFTGRIPD, "--check", "--config", rig], capture_output=True, text=True)
        self.assertEqual(done.returncode, 3)
        self.assertIn("the board's watchdog (0.5 s", done.stderr)


if __name__ == "__main__":
    bench.main()
