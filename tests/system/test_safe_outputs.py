"""Tests the outputs after a daemon has ended. After a crash, the service manager runs softgripd --safe-outputs. After
a normal end, the daemon may leave its outputs in a hold."""

import os
import signal
import subprocess
import time

import bench
import serial_rig


class SafeOutputs(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.emulator_ = self.emulator("--object", "stone", "--watchdog-s", "0")
        self.rig_ = self.rig(self.emulator_.port)

    def hold(self):
        daemon = self.idle_daemon(self.rig_)
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        return daemon

    def safe_outputs(self, **environment):
        return subprocess.run([bench.SOFTGRIPD, "--config", self.rig_, "--safe-outputs"], capture_output=True, text=True,
                              timeout=bench.PATIENCE_S, env={**os.environ, **environment}, check=False)

    def test_safe_outputs_vent_the_board_after_a_kill(self):
        self.hold().kill()
        time.sleep(0.5)
        # Without --safe-outputs, the board would keep its outputs, because it has no watchdog.
        self.assertGreater(min(self.emulator_.commands_kpa()), 10)
        ended = self.safe_outputs(SERVICE_RESULT="signal")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertIn("vented and confirmed", ended.stdout)
        self.assertEqual(max(self.emulator_.commands_kpa()), 0)

    def test_safe_outputs_write_nothing_after_a_normal_end(self):
        self.hold().kill()
        held = self.emulator_.commands_kpa()
        ended = self.safe_outputs(SERVICE_RESULT="success")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertEqual(self.emulator_.commands_kpa(), held)

    def test_safe_outputs_are_refused_while_a_daemon_runs(self):
        daemon = self.hold()
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 5, ended.stdout + ended.stderr)
        self.assertGreater(min(self.emulator_.commands_kpa()), 10)
        self.assertEqual(daemon.status()["state"], "running")

    def test_safe_outputs_report_an_unreachable_board(self):
        self.emulator_.kill()
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 4, ended.stdout + ended.stderr)
        self.assertIn("not confirmed", ended.stdout)


class EditedRig(bench.BenchTest):
    """Tests a crash while the user is editing the rig file. The rig file is then incomplete. The board has no
    watchdog."""

    def setUp(self):
        super().setUp()
        if os.geteuid() != 0 and not os.path.isdir(f"/run/user/{os.geteuid()}"):
            self.skipTest("this user has no folder in /run")
        self.board = self.emulator("--object", "stone", "--watchdog-s", "0")
        self.rig_path = self.rig(self.board.port)

    def under_pressure(self):
        daemon = self.idle_daemon(self.rig_path)
        daemon.start("pick_stone")
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 10, pause_s=0.005)
        return daemon

    def safe_outputs(self, expect, **environment):
        ended = subprocess.run([bench.SOFTGRIPD, "--config", self.rig_path, "--safe-outputs"], capture_output=True,
                               text=True, timeout=bench.PATIENCE_S, env={**os.environ, **environment}, check=False)
        self.assertEqual(ended.returncode, expect, ended.stdout + ended.stderr)
        return ended

    def edits(self):
        """Returns changes that make a rig file unreadable, each with its name."""
        board = self.folder / "config/boards/adam-6024.yaml"
        model = self.folder / "config/models/bench_twin.yaml"
        for path in (self.rig_path, board, model):
            yield f"half of {path.name}", path, path.read_bytes()[:path.stat().st_size // 2]
        yield "an empty rig file", self.rig_path, b""
        yield "another kind of file", self.rig_path, b"steps: []\n"

    def test_safe_outputs_vent_with_the_last_valid_rig_file(self):
        for what, path, contents in self.edits():
            with self.subTest(edit=what):
                whole = path.read_bytes()
                daemon = self.under_pressure()
                path.write_bytes(contents)
                daemon.kill()
                self.assertGreater(min(self.board.commands_kpa()), 10)
                ended = self.safe_outputs(0, SERVICE_RESULT="signal")
                self.assertIn("vented and confirmed", ended.stdout)
                self.assertIn("as the last softgripd had read it", ended.stdout)
                self.assertEqual(max(self.board.commands_kpa()), 0)
                path.write_bytes(whole)

    def test_safe_outputs_vent_although_the_rig_file_was_deleted(self):
        daemon = self.under_pressure()
        self.rig_path.unlink()
        daemon.kill()
        self.safe_outputs(0)
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_safe_outputs_vent_the_board_in_use_although_the_file_changed(self):
        daemon = self.under_pressure()
        self.rig_path.write_text(self.rig_path.read_text().replace(f"port: {self.board.port}", "port: 1"))
        daemon.kill()
        self.safe_outputs(0)
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_the_rig_file_is_read_again_after_the_board_is_safe(self):
        self.under_pressure().kill()
        self.assertIn("as the last softgripd had read it", self.safe_outputs(0).stdout)
        self.assertNotIn("as the last softgripd had read it", self.safe_outputs(0).stdout)
        self.rig_path.write_text("name: half")
        self.safe_outputs(3)

    def test_the_stored_rig_file_is_kept_until_the_board_responds(self):
        daemon = self.under_pressure()
        port = self.board.port
        daemon.kill()
        self.board.kill()
        self.rig_path.write_text("name: half")
        self.safe_outputs(4)
        again = self.emulator("--object", "stone", "--watchdog-s", "0", port=port, name="again")
        self.safe_outputs(0)
        self.assertEqual(max(again.commands_kpa()), 0)

    def test_the_rig_file_is_read_after_a_normal_end(self):
        daemon = self.idle_daemon(self.rig_path)
        self.assertEqual(daemon.end(signal.SIGTERM), 0)
        self.rig_path.write_text("name: half")
        self.safe_outputs(0, SERVICE_RESULT="success")
        self.safe_outputs(3)


class Hold(bench.BenchTest):
    """Tests the messages about a hold. The board determines how long it holds its outputs. The programs must state this
    before the start, at the start and at the end."""

    def ends_holding(self, emulator, rig):
        """Ends a daemon while it holds a part. Returns the output of the check, the output of the daemon, and the
        outputs of the board 1 s later."""
        check = subprocess.run([bench.SOFTGRIPD, "--check", "--config", rig], capture_output=True, text=True, check=True)
        daemon = self.idle_daemon(rig)
        start = daemon.errors()
        daemon.start("pick_stone")
        for channel in ("left", "right"):
            daemon.wait_for_event("grip_result", code="HOLDING", channel=channel)
        self.assertEqual(daemon.end(), 0)
        self.assertGreater(min(emulator.commands_kpa()), 10, "the outputs end with the held pressure")
        time.sleep(1)
        return check.stdout, start, daemon.errors(), emulator.commands_kpa()

    def test_the_messages_state_that_the_watchdog_ends_the_hold(self):
        emulator = self.emulator("--object", "stone")
        check, start, end, outputs_kpa = self.ends_holding(emulator, self.rig(emulator.port))
        sentence = "hold: a part is held only while softgripd runs; the watchdog vents the fingers 0.5 s after the program ends"
        self.assertIn(sentence, check)
        self.assertIn(sentence, start)
        self.assertIn("remain under pressure until the board's watchdog vents in 0.5 s", end)
        self.assertEqual(max(outputs_kpa), 0)

    def test_a_board_without_a_watchdog_holds_after_the_daemon_ends(self):
        rig = serial_rig.rig_file(self.folder, serial_rig.RATE_HZ)
        emulator = serial_rig.Emulator(self.folder, rig, "--object", "stone")
        self.processes.append(emulator)
        self.addCleanup(emulator.control.close)
        check, start, end, outputs_kpa = self.ends_holding(emulator, rig)
        for text in (check, start, end):
            self.assertNotIn("the watchdog vents the fingers", text)
        self.assertIn("remain under pressure, because the board has no watchdog that vents", end)
        self.assertGreater(min(outputs_kpa), 10)


if __name__ == "__main__":
    bench.main()
