"""One master per board, and signals that end a process end it in order."""

import signal
import time

import bench

ENDING = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM,
          signal.SIGXCPU, signal.SIGVTALRM, signal.SIGPROF, signal.SIGIO, signal.SIGPWR, signal.SIGRTMIN)


class Masters(bench.BenchTest):
    def second_rig(self, rig):
        """The same board behind another socket."""
        text = rig.read_text().replace("softgripd.sock", "second.sock")
        path = rig.with_name("second.yaml")
        path.write_text(text)
        return path

    def test_a_second_daemon_behind_another_socket_is_refused(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.daemon(rig)
        daemon.wait_for_state("idle")
        second = bench.Process("second", [bench.SOFTGRIPD, "--config", self.second_rig(rig)], self.folder)
        self.assertEqual(second.wait(), 4)
        self.assertIn(f"another softgrip program drives this board (process {daemon.child.pid})", second.errors())
        self.assertEqual(daemon.status()["state"], "idle")

    def test_a_socket_file_that_was_removed_makes_no_room_for_another(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.daemon(rig)
        daemon.wait_for_state("idle")
        daemon.socket_path.unlink()
        second = bench.Process("second", [bench.SOFTGRIPD, "--config", rig], self.folder)
        self.assertEqual(second.wait(), 4)
        self.assertIn("another softgrip program", second.errors())
        self.assertEqual(daemon.status()["state"], "idle")

    def test_a_killed_master_leaves_the_board_to_the_next(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        self.daemon(rig).kill()
        self.assertEqual(self.daemon(rig).wait_for_state("idle")["state"], "idle")

    def test_calibration_and_safe_outputs_keep_off(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.daemon(rig)
        daemon.wait_for_state("idle")
        second = self.second_rig(rig)
        self.assertIn("another softgrip program", self.softgrip("doctor", "--rig", second, expect=6).stdout)
        safe = bench.Process("safe", [bench.SOFTGRIPD, "--config", second, "--safe-outputs"], self.folder)
        self.assertEqual(safe.wait(), 5)
        self.assertIn("another softgrip program", safe.output())

    def test_every_signal_that_ends_it_ends_it_in_order(self):
        emulator = self.emulator("--object", "stone")
        rig = self.rig(emulator.port)
        for number in ENDING:
            with self.subTest(signal=signal.Signals(number).name):
                daemon = self.daemon(rig)
                daemon.wait_for_state("idle")
                daemon.start("pick_stone")
                bench.wait_for("the approach", lambda: min(emulator.commands_kpa()) > 3, pause_s=0.005)
                self.assertEqual(daemon.end(number), 0, daemon.errors())
                self.assertEqual(max(emulator.commands_kpa()), 0)

    def test_a_terminal_cannot_stop_it(self):
        emulator = self.emulator()
        daemon = self.daemon(self.rig(emulator.port))
        daemon.wait_for_state("idle")
        for number in (signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU):
            daemon.send(number)
        before = daemon.status()["loop"]["ticks"]
        time.sleep(0.2)
        self.assertGreater(daemon.status()["loop"]["ticks"], before)


if __name__ == "__main__":
    bench.main()
