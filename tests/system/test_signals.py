"""Tests commands that are interrupted by a signal. The command must write safe outputs and then end by the same
signal, so that a shell script that runs the command stops as well."""

import json
import os
import re
import signal
import subprocess
import time

import bench

NO_WATCHDOG = "the outputs keep their last pressure when softgripd dies"
INTERRUPTING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.board = self.emulator("--object", "stone")
        self.rig_path = self.rig(self.board.port)

    def process(self, *arguments):
        process = bench.Process("interrupted", arguments, self.folder)
        self.processes.append(process)
        return process

    def running(self, *more):
        """Starts a run. Returns its process as soon as the fingers are pressurised."""
        run = self.process(bench.SOFTGRIP, "run", "config/sequences/pick_stone.yaml", "--rig", self.rig_path, *more)
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 3, pause_s=0.005)
        return run

    def test_a_run_ends_by_the_signal_with_safe_outputs(self):
        for number in INTERRUPTING:
            with self.subTest(signal=number.name):
                run = self.running()
                self.assertEqual(run.end(number), -number, run.output() + run.errors())
                self.assertEqual(max(self.board.commands_kpa()), 0)
                self.assertIn(f"sequence stopped by {number.name}", run.output())
                self.assertIn("the board confirmed the safe outputs", run.output())

    def test_an_interrupted_run_reports_stopped_in_its_json(self):
        run = self.running("--json", "--quiet")
        self.assertEqual(run.end(signal.SIGTERM), -signal.SIGTERM)
        self.assertIn('"sequence_end":"stopped"', run.output().replace(" ", ""))

    def test_a_signal_after_the_last_step_ends_the_run(self):
        run = self.running()
        bench.wait_for("the end of the sequence", lambda: "RELEASED" in run.output(), pause_s=0.005)
        self.assertEqual(run.end(signal.SIGINT), -signal.SIGINT, run.output())
        self.assertIn("sequence done", run.output())

    def test_the_loop_of_a_shell_does_not_start_the_next_sequence(self):
        command = (f"for turn in 1 2; do echo turn $turn >> turns; {bench.SOFTGRIP} run "
                   f"config/sequences/pick_stone.yaml --rig {self.rig_path} --quiet; done; echo over >> turns")
        shell = subprocess.Popen(["bash", "-c", command], cwd=self.folder, start_new_session=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(shell.wait)
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 3, pause_s=0.005)
        os.killpg(shell.pid, signal.SIGINT)  # a terminal also sends Ctrl-C to all processes of the group
        self.assertEqual(shell.wait(bench.PATIENCE_S), -signal.SIGINT)
        self.assertEqual((self.folder / "turns").read_text(), "turn 1\n")
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_a_signal_ends_a_daemon_with_a_sequence_with_safe_outputs(self):
        daemon = self.process(bench.SOFTGRIPD, "--config", self.rig_path, "--sequence",
                              "config/sequences/pick_stone.yaml")
        bench.wait_for("pressure", lambda: min(self.board.commands_kpa()) > 3, pause_s=0.005)
        self.assertEqual(daemon.end(signal.SIGTERM), -signal.SIGTERM)
        self.assertIn("the sequence ended: stopped", daemon.errors())
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_a_sequence_longer_than_duration_s_exits_with_code_6(self):
        daemon = self.process(bench.SOFTGRIPD, "--config", self.rig_path, "--sequence",
                              "config/sequences/pick_stone.yaml", "--duration-s", "3")
        self.assertEqual(daemon.wait(), 6, daemon.errors())
        self.assertIn("the sequence ended: stopped", daemon.errors())
        self.assertEqual(max(self.board.commands_kpa()), 0)

    def test_an_interrupted_watch_with_a_count_ends_by_the_signal(self):
        daemon = self.idle_daemon(self.rig_path)
        watch = self.process(bench.SOFTGRIP, "watch", "--count", "100000", "--socket", daemon.socket_path)
        bench.wait_for("updates", lambda: watch.output().count("\n") > 2)
        self.assertEqual(watch.end(signal.SIGINT), -signal.SIGINT)

    def test_an_interrupted_daemon_or_watch_without_limit_exits_with_code_0(self):
        daemon = self.idle_daemon(self.rig_path)
        watch = self.process(bench.SOFTGRIP, "watch", "--socket", daemon.socket_path)
        bench.wait_for("updates", lambda: watch.output().count("\n") > 2)
        self.assertEqual(watch.end(signal.SIGINT), 0)
        self.assertEqual(daemon.end(signal.SIGTERM), 0)


class WithoutABoard(bench.BenchTest):
    """Tests a run in virtual time. A signal interrupts an endless sequence, and the recording must be closed
    properly."""

    def test_a_run_that_leaves_a_finger_under_pressure_states_this(self):
        text = (self.folder / "config/sequences/pick_stone.yaml").read_text()
        released = text.index("  - release")
        self.write("keep.yaml", text[:released])
        for watchdog, sentence, vents_after_s in (
                ("0.5", "remain under pressure until the board's watchdog vents in 0.5 s", 0.5),
                ("0", "remain under pressure, because the board has no watchdog that vents", None)):
            rig = self.write("config/kept.yaml", self.rig_with_watchdog(watchdog))
            run = ("run", "keep.yaml", "--rig", rig, "--virtual-time", "--quiet")
            self.assertIn(sentence, self.softgrip(*run).stdout)
            result = json.loads(self.softgrip(*run, "--json").stdout)
            self.assertEqual(result.get("vents_after_s"), vents_after_s)
            self.assertEqual(set(result["pressure_left_on_kpa"]), {"left", "right"})
            self.assertGreater(min(result["pressure_left_on_kpa"].values()), 5)
        released = json.loads(self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--quiet",
                                            "--json").stdout)
        self.assertEqual(released["pressure_left_on_kpa"], {})

    def rig_with_watchdog(self, timeout_s):
        """Returns the text of the rig file with this watchdog time of the board."""
        text = (self.folder / "config/rig.yaml").read_text()
        text, count = re.subn(r"watchdog_timeout_s: \S+", f"watchdog_timeout_s: {timeout_s}", text)
        self.assertEqual(count, 1)
        return text if timeout_s != "0" else text.replace("safety:\n", f"safety:\n  accept_no_watchdog: {NO_WATCHDOG}\n")

    def test_an_interrupted_virtual_run_completes_its_recording(self):
        for number in INTERRUPTING:
            with self.subTest(signal=number.name):
                folder = self.folder / f"record_{number.name}"
                run = bench.Process("virtual", [bench.SOFTGRIP, "run", "config/sequences/pick_stone.yaml", "--set",
                                                "hold_s=600", "--rig", "config/rig.yaml", "--virtual-time",
                                                "--record", folder, "--quiet"], self.folder)
                self.processes.append(run)
                bench.wait_for("a recording", (folder / "run.csv").exists, pause_s=0.001)
                time.sleep(0.05)
                self.assertEqual(run.end(number), -number, run.output() + run.errors())
                self.assertIn(f"sequence stopped by {number.name}", run.output())
                self.assertIn('"state": "complete"', (folder / "run.json").read_text())


if __name__ == "__main__":
    bench.main()
