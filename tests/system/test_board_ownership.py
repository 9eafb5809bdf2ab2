"""Tests that a board accepts only one Modbus client at a time. Also tests that a program that receives a signal
releases the board before it ends."""

import os
import pathlib
import signal
import subprocess
import time
import unittest

import bench
import other_user

ENDING = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM,
          signal.SIGXCPU, signal.SIGVTALRM, signal.SIGPROF, signal.SIGIO, signal.SIGPWR, signal.SIGRTMIN)


class BoardOwnership(bench.BenchTest):
    def occupied_board(self):
        """Returns an emulator, its rig file, and the idle daemon that drives it."""
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        return emulator, rig, self.idle_daemon(rig)

    def second_rig(self, rig):
        """Writes a second rig file with the same board and a different socket."""
        text = rig.read_text().replace("softgripd.sock", "second.sock")
        path = rig.with_name("second.yaml")
        path.write_text(text)
        return path

    def test_a_second_daemon_with_another_socket_is_rejected(self):
        emulator, rig, daemon = self.occupied_board()
        second = bench.Process("second", [bench.SOFTGRIPD, "--config", self.second_rig(rig)], self.folder)
        self.assertEqual(second.wait(), 4)
        self.assertIn(f"another softgrip program drives this board (process {daemon.child.pid})", second.errors())
        self.assertEqual(daemon.status()["state"], "idle")

    def test_a_removed_socket_file_does_not_admit_a_second_daemon(self):
        emulator, rig, daemon = self.occupied_board()
        daemon.socket_path.unlink()
        second = bench.Process("second", [bench.SOFTGRIPD, "--config", rig], self.folder)
        self.assertEqual(second.wait(), 4)
        self.assertIn("another softgrip program", second.errors())
        self.assertEqual(daemon.status()["state"], "idle")

    def test_a_removed_lock_file_does_not_admit_a_second_daemon(self):
        emulator, rig, daemon = self.occupied_board()
        for folder in other_user.lock_folders():
            for lock in folder.glob(f"*{other_user.board_name(emulator.port)[len('.softgrip-'):]}*"):
                lock.unlink()
        second = bench.Process("second", [bench.SOFTGRIPD, "--config", self.second_rig(rig)], self.folder)
        self.assertEqual(second.wait(), 4)
        self.assertIn(f"another softgrip program drives this board (process {daemon.child.pid})", second.errors())

    def test_a_new_daemon_can_use_the_board_after_a_kill(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        self.daemon(rig).kill()
        self.assertEqual(self.daemon(rig).wait_for_state("idle")["state"], "idle")

    def test_doctor_and_safe_outputs_do_not_use_an_occupied_board(self):
        emulator, rig, daemon = self.occupied_board()
        second = self.second_rig(rig)
        self.assertIn("another softgrip program", self.softgrip("doctor", "--rig", second, expect=6).stdout)
        safe = bench.Process("safe", [bench.SOFTGRIPD, "--config", second, "--safe-outputs"], self.folder)
        self.assertEqual(safe.wait(), 5)
        self.assertIn("another softgrip program", safe.output())

    def test_commands_that_move_the_rig_are_refused_while_the_daemon_runs(self):
        emulator, rig, daemon = self.occupied_board()
        run = ("run", "config/sequences/pick_stone.yaml")
        for command in ((*run,), (*run, "--no-socket"), ("calibrate", "--channel", "left", "--move"),
                        ("baseline", "--rig-channel", "left", "--yes", "--out", "base")):
            told = self.softgrip(*command, "--rig", rig, expect=5).stderr
            self.assertIn("softgripd runs and controls the board: first stop softgripd", told)
        second = self.second_rig(rig)
        for command, code in ((run, 4), (("baseline", "--rig-channel", "left", "--yes", "--out", "base"), 5)):
            self.assertIn("another softgrip program", self.softgrip(*command, "--rig", second, expect=code).stderr)
        self.assertEqual(max(emulator.commands_kpa()), 0)
        self.assertEqual(daemon.status()["state"], "idle")

    def test_every_terminating_signal_vents_and_exits_with_code_0(self):
        emulator = self.emulator("--object", "stone")
        rig = self.rig(emulator.port)
        for number in ENDING:
            with self.subTest(signal=signal.Signals(number).name):
                daemon = self.idle_daemon(rig)
                daemon.start("pick_stone")
                bench.wait_for("the approach", lambda: min(emulator.commands_kpa()) > 3, pause_s=0.005)
                self.assertEqual(daemon.end(number), 0, daemon.errors())
                self.assertEqual(max(emulator.commands_kpa()), 0)

    def test_terminal_stop_signals_do_not_stop_the_daemon(self):
        emulator = self.emulator()
        daemon = self.idle_daemon(self.rig(emulator.port))
        for number in (signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU):
            daemon.send(number)
        before = daemon.status()["loop"]["ticks"]
        time.sleep(0.2)
        self.assertGreater(daemon.status()["loop"]["ticks"], before)


@unittest.skipUnless(os.geteuid() == 0, other_user.NEEDS_ROOT)
class OtherUsers(bench.BenchTest):
    """Tests a board without a watchdog while another user of the machine occupies the name with which a program locks
    the board."""

    HOLDERS = {"listens": 5, "accepts no connection": 0, "does not listen": None}

    def setUp(self):
        super().setUp()
        self.board = self.emulator("--object", "stone", "--watchdog-s", "0")
        self.rig_path = self.rig(self.board.port)
        self.name = other_user.board_name(self.board.port)

    def safe_outputs(self):
        return subprocess.run([bench.SOFTGRIPD, "--config", self.rig_path, "--safe-outputs"], capture_output=True,
                              text=True, timeout=bench.PATIENCE_S, check=False)

    def test_the_daemon_starts_and_names_the_user_who_holds_the_lock_name(self):
        for how, backlog in self.HOLDERS.items():
            with self.subTest(holder=how):
                holder = other_user.OtherUser(self, self.name, backlog)
                daemon = self.idle_daemon(self.rig_path)
                text = daemon.wait_for_event("board_lock")["text"]
                self.assertIn("has no permission to control the board", text)
                if backlog == 5:
                    self.assertIn(f"user {other_user.NOBODY} (process {holder.pid})", text)
                self.assertEqual(daemon.end(), 0)
                holder.end()

    def test_a_second_daemon_is_rejected_although_another_user_holds_the_name(self):
        other_user.OtherUser(self, self.name)
        daemon = self.idle_daemon(self.rig_path)
        second = self.rig_path.with_name("second.yaml")
        second.write_text(self.rig_path.read_text().replace("softgripd.sock", "second.sock"))
        other = bench.Process("second", [bench.SOFTGRIPD, "--config", second], self.folder)
        self.assertEqual(other.wait(), 4)
        self.assertIn(f"another softgrip program drives this board (process {daemon.child.pid})", other.errors())
        self.assertIn("another softgrip program", self.softgrip("doctor", "--rig", second, expect=6).stdout)
        self.assertEqual(daemon.status()["state"], "idle")

    def test_safe_outputs_vent_after_a_kill_although_the_name_is_held(self):
        for how, backlog in self.HOLDERS.items():
            with self.subTest(holder=how):
                daemon = self.idle_daemon(self.rig_path)
                daemon.start("pick_stone")
                bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 10, pause_s=0.005)
                daemon.kill()
                holder = other_user.OtherUser(self, self.name, backlog)
                self.assertGreater(min(self.board.commands_kpa()), 10)
                ended = self.safe_outputs()
                self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
                self.assertEqual(max(self.board.commands_kpa()), 0)
                holder.end()

    def test_safe_outputs_vent_although_another_user_holds_the_socket(self):
        daemon = self.idle_daemon(self.rig_path)
        daemon.start("pick_stone")
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 10, pause_s=0.005)
        daemon.kill()
        daemon.socket_path.unlink()
        self.folder.chmod(0o777)
        other_user.OtherUser(self, str(daemon.socket_path))
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_safe_outputs_vent_although_a_stopped_daemon_holds_the_board(self):
        daemon = self.idle_daemon(self.rig_path)
        daemon.start("pick_stone")
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 10, pause_s=0.005)
        daemon.send(signal.SIGSTOP)
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertIn("does not run", ended.stdout)
        self.assertEqual(max(self.board.commands_kpa()), 0)
        daemon.kill()

    def test_a_daemon_of_another_user_is_rejected_while_root_uses_the_board(self):
        daemon = self.idle_daemon(self.rig_path)
        self.folder.chmod(0o777)
        own = pathlib.Path(f"/tmp/softgrip-{other_user.NOBODY}")
        self.addCleanup(lambda: own.is_dir() and own.rmdir())
        second = self.rig_path.with_name("second.yaml")
        second.write_text(self.rig_path.read_text().replace("softgripd.sock", "second.sock"))
        program = self.folder / "softgripd"
        # Copies the program, because another user may have no permission to read the folder of the build.
        program.write_bytes(bench.SOFTGRIPD.read_bytes())
        program.chmod(0o755)
        other = subprocess.run([program, "--config", second], user=other_user.NOBODY, group=other_user.NOBODY,
                               extra_groups=[], cwd=self.folder, capture_output=True, text=True,
                               timeout=bench.PATIENCE_S, check=False)
        self.assertEqual(other.returncode, 4, other.stdout + other.stderr)
        self.assertIn(f"another softgrip program drives this board (process {daemon.child.pid})", other.stderr)
        self.assertEqual(daemon.status()["state"], "idle")


if __name__ == "__main__":
    bench.main()
