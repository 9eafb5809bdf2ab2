"""Tests softgrip watch on a terminal. Checks the display and the keys. At its end, the program must restore the
terminal."""

import os
import signal

import bench
import terminal


class Watch(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.emulated = self.emulator("--object", "stone", "--faults", self.write("faults.yaml", (
            "faults:\n"
            "  - {name: blind, kind: sensor_out_of_range, channel: left}\n")))
        self.softgripd = self.idle_daemon(self.rig(self.emulated.port))

    def watch(self, *arguments, columns=80, rows=24):
        program = [bench.SOFTGRIP, "watch", "--socket", self.softgripd.socket_path, *arguments]
        watched = terminal.Terminal(program, self.folder, columns, rows)
        self.addCleanup(watched.close)
        watched.wait_for("q quit")
        return watched

    def test_keys_start_stop_and_release_a_grip(self):
        watched = self.watch()
        watched.wait_for("idle")
        watched.type("g")
        watched.wait_for("start which sequence")
        watched.type("hand_over\r")
        watched.wait_for("Start hand_over? The fingers will move.")
        self.assertEqual(self.softgripd.status()["state"], "idle", "nothing moves before the answer")
        watched.type("n")
        watched.wait_for(lambda text: "Start hand_over?" not in text)
        self.assertEqual(self.softgripd.status()["state"], "idle")
        watched.type("g")
        watched.wait_for("start which sequence")
        watched.type("hand_over\r")
        watched.wait_for("Start hand_over?")
        watched.type("y")
        watched.wait_for("started hand_over")
        watched.wait_for("HOLDING by")
        screen = watched.wait_for("left: Grip result: HOLDING.")
        self.assertIn("▁", screen, "the screen must show a trend")
        watched.type("s")
        screen = watched.wait_for("UNDER PRESSURE")
        self.assertIn("`softgrip release`", screen)
        watched.type("r")
        watched.wait_for("held parts drop")
        self.assertGreater(min(self.emulated.commands_kpa()), 1)
        watched.type("y")
        watched.wait_for("releasing")
        watched.wait_for(lambda text: "UNDER PRESSURE" not in text)
        watched.type("q")
        self.assertEqual(watched.wait(), 0)
        self.assertTrue(watched.restored())

    def test_the_vent_key_needs_no_confirmation(self):
        self.softgripd.start("hand_over")
        bench.wait_for("the hold", lambda: self.softgripd.results() == ["HOLDING", "HOLDING"])
        watched = self.watch()
        watched.type("v")
        watched.wait_for("venting")
        bench.wait_for("vented valves", lambda: max(self.emulated.commands_kpa()) < 0.1)

    def test_a_fault_can_be_acknowledged_only_after_its_cause_is_gone(self):
        watched = self.watch(rows=30)
        self.emulated.ask("fault blind")
        watched.wait_for("fault F202 of left")
        watched.wait_for("The cause is still present: F202 reading_out_of_range of left.")
        watched.type("a")
        watched.wait_for("refused (R09)")
        self.emulated.ask("clear blind")
        watched.wait_for("The cause is gone: `softgrip acknowledge`")
        watched.type("a")
        watched.wait_for("acknowledged F202 reading_out_of_range of left")
        self.softgripd.wait_for_state("idle")

    def test_long_texts_are_wrapped_at_60_columns(self):
        watched = self.watch(columns=60)
        self.emulated.ask("fault blind")
        watched.wait_for("fault F202 of left")
        self.emulated.ask("clear blind")
        screen = watched.wait_for("The cause is gone")
        # If a text is too long for its line, it continues in the next line. The last word of the remedy must therefore
        # be visible.
        self.assertIn("measure the electrical signal of the sensor.", " ".join(screen.split()))
        self.assertIn("s stop  v vent  r release  a acknowledge  g start  q quit", screen)

    def test_the_display_adapts_to_the_window_size(self):
        watched = self.watch(columns=100, rows=30)
        watched.resize(60, 20)
        watched.wait_for(lambda text: text.split("\n")[19].startswith("s stop"))
        watched.resize(80, 6)
        watched.wait_for("more lines: enlarge the window")
        watched.resize(100, 40)
        watched.wait_for("recording")

    def test_the_terminal_is_restored_after_every_kind_of_end(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGSEGV,
                       signal.SIGABRT):
            with self.subTest(signal=number):
                watched = self.watch()
                watched.child.send_signal(number)
                crashed = number in (signal.SIGSEGV, signal.SIGABRT)
                self.assertEqual(watched.wait(), -number if crashed else 0)
                self.assertTrue(watched.restored())
        watched = self.watch("--count", "3")
        self.assertEqual(watched.wait(), 0)
        self.assertTrue(watched.restored())

    def test_ctrl_z_restores_the_terminal_and_the_display_resumes(self):
        watched = self.watch()
        watched.type("\x1a")
        _, status = os.waitpid(watched.child.pid, os.WUNTRACED)
        self.assertTrue(os.WIFSTOPPED(status))
        self.assertTrue(watched.restored())
        watched.child.send_signal(signal.SIGCONT)
        watched.wait_for(lambda text: not watched.restored())
        watched.wait_for("q quit")
        watched.type("q")
        self.assertEqual(watched.wait(), 0)
        self.assertTrue(watched.restored())

    def test_the_end_of_the_daemon_is_reported_on_the_restored_terminal(self):
        watched = self.watch()
        self.softgripd.end()
        self.assertEqual(watched.wait(), 4)
        self.assertTrue(watched.restored())
        self.assertIn("closed the connection", watched.raw.decode(errors="replace").split("\x1b[?1049l")[-1])

    def test_watch_without_a_terminal_prints_plain_lines(self):
        printed = self.softgrip("watch", "--count", "2").stdout
        self.assertNotIn("\x1b", printed)
        self.assertEqual(len(printed.splitlines()), 2)
        self.assertRegex(printed.splitlines()[0], r"^[\d.]+ s  idle  left ")


if __name__ == "__main__":
    bench.main()
