"""Tests softgrip init as a new user runs it, both with questions on a terminal and with options."""

import os
import pty
import re
import select
import subprocess
import time

import bench


class Terminal:
    """Runs softgrip on a pseudo-terminal."""

    def __init__(self, test, *arguments):
        self.master, slave = pty.openpty()
        self.child = subprocess.Popen([str(a) for a in (bench.SOFTGRIP, *arguments)], cwd=test.folder, stdin=slave,
                                      stdout=slave, stderr=slave, close_fds=True)
        os.close(slave)
        self.said = ""
        test.addCleanup(self.end)

    def end(self):
        self.child.kill()
        self.child.wait()
        os.close(self.master)

    def read_until(self, done):
        end = time.monotonic() + bench.PATIENCE_S
        while not done():
            if time.monotonic() > end:
                raise AssertionError(f"the program has not printed the expected question, only:\n{self.said}")
            ready, _, _ = select.select([self.master], [], [], 0.1)
            if not ready:
                continue
            try:
                said = os.read(self.master, 4096).decode()
            except OSError:  # the program has ended
                return
            self.said += said.replace("\r\n", "\n")

    def answer(self, question, text):
        """Waits for a question that matches the pattern and answers it. Returns the output since the previous
        answer."""
        self.read_until(lambda: re.search(rf"\? [^\n]*{question}[^\n]*: $", self.said))
        said, self.said = self.said, ""
        os.write(self.master, text.encode() + b"\n")
        return said

    def wait(self):
        self.read_until(lambda: False if self.child.poll() is None else True)
        self.child.wait(bench.PATIENCE_S)
        return self.child.returncode


class Init(bench.BenchTest):
    OPTIONS = ("--board", "adam-6024", "--address", "127.0.0.1:1502")

    def test_an_invalid_answer_repeats_the_question_on_a_terminal(self):
        asked = Terminal(self, "init", "config/mine.yaml")
        asked.answer("map", "adam-6042")
        self.assertIn("did you mean adam-6024?", asked.answer("map", "adam-6024"))
        asked.answer("address", "localhost")
        self.assertIn("127.0.0.1", asked.answer("address", "127.0.0.1"))
        asked.answer("unit id", "")
        asked.answer("names of the fingers", "thumb, index")
        asked.answer("model", "")
        asked.answer("pressures of the valve", "0 1oo")
        self.assertIn("two different pressures", asked.answer("pressures of the valve", "0 100"))
        asked.answer("highest permitted pressure", "150")
        self.assertIn("at most 100", asked.answer("highest permitted pressure", "50"))
        asked.answer("displacements of the sensor", "")
        asked.answer("measured", "maybe")
        asked.answer("measured", "yes")
        self.assertEqual(asked.wait(), 0, asked.said)
        done = self.softgrip("check", "config/mine.yaml", "config/sequences/pick_stone.yaml", expect=None)
        self.assertIn("mine.yaml: rig 'mine': ok\n", done.stdout, done.stderr)
        text = (self.folder / "config/mine.yaml").read_text()
        self.assertEqual(text.count("slew_up_kpa_per_s"), 1)
        self.assertIn("pressure_max_kpa: 50", text)
        self.assertIn("map: boards/adam-6024.yaml", text)

    def test_options_without_a_terminal_give_a_valid_rig_file(self):
        self.softgrip("init", "config/mine.yaml", *self.OPTIONS)
        done = self.softgrip("check", "config/mine.yaml")
        self.assertEqual(done.stderr, "")

    def test_an_option_without_a_default_value_is_required(self):
        done = self.softgrip("init", "mine.yaml", "--board", "adam-6024", expect=2)
        self.assertIn("without a terminal, the option --address is required", done.stderr)
        self.assertFalse((self.folder / "mine.yaml").exists())

    def test_an_existing_file_is_not_overwritten(self):
        before = (self.folder / "config/rig.yaml").read_bytes()
        done = self.softgrip("init", "config/rig.yaml", *self.OPTIONS, expect=5)
        self.assertIn("already exists", done.stderr)
        self.assertEqual((self.folder / "config/rig.yaml").read_bytes(), before)

    def test_a_refused_rig_file_is_explained_by_the_option(self):
        done = self.softgrip("init", "mine.yaml", *self.OPTIONS, "--rate-hz", "5000", expect=3)
        self.assertIn("--rate-hz 5000: the rig cannot be used at this rate", done.stderr)
        self.assertNotIn("mine.yaml:", done.stderr)
        for option, values, why in (("--sensor-mm", ("-0.005", "0.045"), "are in mm"), ("--valve-kpa", ("100", "0"), "Enter 0 100")):
            done = self.softgrip("init", "mine.yaml", *self.OPTIONS, option, *values, expect=2)
            self.assertIn(f"{option}: ", done.stderr)
            self.assertIn(why, done.stderr)
        self.assertFalse((self.folder / "mine.yaml").exists())

    def test_an_invalid_option_writes_no_file(self):
        done = self.softgrip("init", "mine.yaml", *self.OPTIONS, "--pressure-max-kpa", "lots", expect=2)
        self.assertIn("--pressure-max-kpa: `lots`", done.stderr)
        self.assertFalse((self.folder / "mine.yaml").exists())

    def test_the_written_rig_file_runs_with_the_emulator(self):
        self.softgrip("init", "config/mine.yaml", *self.OPTIONS)
        emulated = self.emulator("--rig", self.folder / "config/mine.yaml", "--object", "stone", board=None)
        rig = self.folder / "config/mine.yaml"
        text = rig.read_text()
        for old, new in (("port: 1502", f"port: {emulated.port}"), ("rate_hz: 200", f"rate_hz: {bench.RATE_HZ}"),
                         ("exchange_deadline_s: 0.02", "exchange_deadline_s: 0.15"),
                         ("bus_down_cycles: 5", f"bus_down_cycles: {bench.BUS_DOWN_CYCLES}"),
                         ("invalid_reading_cycles: 5", "invalid_reading_cycles: 30"),
                         ("readback_cycles: 10", "readback_cycles: 30"), ("max_missed_commands: 10", "max_missed_commands: 30"),
                         ("max_age_s: 0.05", "max_age_s: 0.35"), ("/tmp/softgrip-runs", f"{self.folder}/runs"),
                         ("/tmp/softgrip.sock", f"{self.folder}/softgripd.sock")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        rig.write_text(text)
        daemon = self.idle_daemon(rig)
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", channel="left", code="HOLDING")


if __name__ == "__main__":
    bench.main()
