"""Tests a rig with pressures from -40 to 60 kPa on the emulated board. After any end of a vacuum, the pressure must
return to the rest pressure of 0 kPa."""

import os
import signal
import subprocess
import time

import bench

VACUUM_KPA = -30
# Tolerance [kPa] of an emulated valve, whose output is a float.
EQUAL_KPA = 1e-3


class Vacuum(bench.BenchTest):
    def start_vacuum_rig(self, *arguments):
        self.rig_path = self.vacuum_rig(1502)
        self.board = self.emulator("--rig", self.rig_path, *arguments, board=None)
        self.rig_path = self.vacuum_rig(self.board.port)
        self.softgripd = self.idle_daemon(self.rig_path)

    def vacuum_rig(self, port):
        return self.rig(port, name="vacuum/rig_tcp.yaml",
                        changes=((r"\.\./models/", "models/"),
                                 (r"sequence_directory: sequences", "sequence_directory: vacuum/sequences"),
                                 # this board map has a long watchdog time-out, so that a busy machine does
                                 # not trip the watchdog
                                 (r"map: board\.yaml", "map: boards/patient.yaml")))

    def setUp(self):
        super().setUp()
        board = (self.folder / "config/vacuum/board.yaml").read_text()
        (self.folder / "config/boards/patient.yaml").write_text(board.replace("timeout_s: 0.2", "timeout_s: 0.8"))

    def evacuate(self):
        before = self.softgripd.events()[-1]["id"]
        self.softgripd.start("vacuum_grip")
        self.softgripd.wait_for_event("grip_result", since=before, code="HOLDING", channel="left")
        for kpa in self.board.commands_kpa():
            self.assertAlmostEqual(kpa, VACUUM_KPA, delta=EQUAL_KPA)

    def wait_for_rest(self):
        """Waits until the pressure reaches the rest pressure. Checks that the pressure never exceeds 0 kPa on its way
        back from a vacuum."""
        highest_kpa = -1e9
        end = time.monotonic() + bench.PATIENCE_S
        while time.monotonic() < end:
            commands = self.board.commands_kpa()
            highest_kpa = max(highest_kpa, *commands)
            if all(abs(kpa) <= EQUAL_KPA for kpa in commands):
                break
            time.sleep(0.005)
        else:
            self.fail(f"the outputs stay at {commands} kPa")
        time.sleep(0.3)
        self.assertTrue(all(abs(kpa) <= EQUAL_KPA for kpa in self.board.commands_kpa()), self.board.commands_kpa())
        self.assertLessEqual(highest_kpa, EQUAL_KPA)

    def test_an_idle_rig_and_a_completed_grip_are_at_rest_pressure(self):
        self.start_vacuum_rig()
        for kpa in self.board.commands_kpa():
            self.assertAlmostEqual(kpa, 0, delta=EQUAL_KPA)
        self.assertEqual(self.softgripd.status()["channels"][0]["limits"]["rest_kpa"], 0)
        self.evacuate()
        self.softgripd.wait_for_state("idle")
        self.assertEqual(self.softgripd.results(), ["RELEASED", "RELEASED"])
        self.wait_for_rest()

    def test_vent_release_and_sigterm_return_to_rest_pressure(self):
        self.start_vacuum_rig()
        for command in ("vent", "release"):
            self.evacuate()
            self.softgripd.result(command)
            self.wait_for_rest()
            self.softgripd.wait_for_state("idle")
            self.softgripd.ask("acknowledge")
        self.softgripd.start("vacuum_grip")
        bench.wait_for("a vacuum", lambda: max(self.board.commands_kpa()) < -10, pause_s=0.005)
        self.softgripd.child.send_signal(signal.SIGTERM)
        self.wait_for_rest()

    def test_a_remaining_vacuum_after_a_stop_is_reported(self):
        self.start_vacuum_rig()
        self.evacuate()
        self.softgripd.result("stop")
        state = self.softgripd.wait_for_state("idle")
        self.assertEqual([channel["name"] for channel in state["under_pressure"]["channels"]], ["left", "right"])
        self.softgripd.result("release")
        self.wait_for_rest()
        self.assertIsNone(self.softgripd.status()["under_pressure"])

    def test_the_board_returns_to_rest_pressure_after_a_kill(self):
        self.start_vacuum_rig()
        self.evacuate()
        self.softgripd.kill()
        self.wait_for_rest()

    def test_a_pause_beyond_the_watchdog_returns_to_rest_pressure(self):
        self.start_vacuum_rig()
        self.evacuate()
        self.softgripd.child.send_signal(signal.SIGSTOP)
        self.wait_for_rest()
        self.softgripd.child.send_signal(signal.SIGCONT)
        self.softgripd.wait_for_state("faulted")
        self.wait_for_rest()

    def test_safe_outputs_are_the_rest_pressure(self):
        self.start_vacuum_rig("--watchdog-s", "0")
        self.evacuate()
        self.softgripd.kill()
        time.sleep(1)
        self.assertLess(max(self.board.commands_kpa()), -20)  # without a new command, the board keeps its outputs
        ended = subprocess.run([bench.SOFTGRIPD, "--config", self.rig_path, "--safe-outputs"], capture_output=True,
                               text=True, timeout=bench.PATIENCE_S, check=False,
                               env={**os.environ, "SERVICE_RESULT": "signal"})
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.wait_for_rest()

    def test_a_board_that_vents_to_full_vacuum_is_rejected(self):
        text = self.vacuum_rig(1502).read_text().replace("patient.yaml", "softgrip-sim.yaml")
        done = self.softgrip("check", self.write("config/full.yaml", text), expect=3)
        self.assertIn("to -100 kPa, but the rest pressure of this channel is 0 kPa", done.stdout + done.stderr)


if __name__ == "__main__":
    bench.main()
