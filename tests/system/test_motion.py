"""Tests commands that move a rig without a daemon. If the board has vented during a gap in communication, no
pressure may rise after the gap. No pressure may rise either after the failure of a sensor that the motion needs. In
both cases, the command must end with the exit code for the fault."""

import json
import re
import signal
import time

import bench

WATCHDOG_S = 0.5  # time-out of the watchdog in the board map
PAUSE_S = 1.2
NOISE_KPA = 0.05  # resolution of the board's outputs
# The faults file for all tests in this module. Each test activates one of its faults.
FAULTS = """faults:
  - {name: requests_lost, kind: lost_request, for_s: 0.7}
  - {name: replies_lost, kind: no_reply, for_s: 0.7}
  - {name: blind, kind: sensor_out_of_range, channel: left}
"""
CALIBRATE = ("calibrate", "--channel", "left", "--average-s", "0.3")
# Commands that move the left finger. For each command, the required exit code if the board vents during the motion.
MOTIONS = {
    "calibrate": ((*CALIBRATE, "--valve", "--move", "--settle-s", "1"), 4),
    "doctor": (("doctor", "--move", "--json"), 6),
    "run": (("run", "config/sequences/pick_stone.yaml", "--no-socket"), 6),
    "baseline": (("baseline", "--rig-channel", "left", "--out", "base", "--yes"), 6),
}


class MotionTest(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.board = self.emulator("--faults", self.write("faults.yaml", FAULTS))
        self.rig_path = self.rig(self.board.port)

    def begin(self, command):
        child = bench.Process(f"softgrip-{command[0]}", [bench.SOFTGRIP, command[0], *command[1:], "--rig", self.rig_path],
                              self.folder)
        self.processes.append(child)
        return child

    def wait_for_pressure(self, child, kpa):
        def reached():
            self.assertTrue(child.running(),
                            f"the command ended before it moved the finger: {child.errors()}\n{child.output()}")
            return self.board.commands_kpa()[0] > kpa
        bench.wait_for(f"{kpa} kPa", reached, pause_s=0.005)

    def outputs_to_the_end(self, child):
        """Reads the outputs until the command ends. Returns all values."""
        samples = []
        while child.running():
            samples.append(self.board.commands_kpa())
            time.sleep(0.001)
        return samples + [self.board.commands_kpa()]

    def check_vented(self, samples):
        self.assertLessEqual(max(max(sample) for sample in samples), NOISE_KPA, samples[:50])
        self.assertEqual(self.board.status()["watchdog_trips"], 1, "the board must have vented once")

    def check_end(self, name, child, expected):
        code = child.wait()
        told = child.errors() + child.output()
        self.assertEqual(code, expected, told)
        if name == "calibrate":
            self.assertEqual(child.output(), "", "no lines for the rig file")
        if name == "doctor":
            findings = {finding["name"]: finding for finding in json.loads(child.output())["findings"]}
            self.assertEqual(findings["motion left"]["verdict"], "fail")
            self.assertEqual(findings["safe state"]["verdict"], "ok")
            told = findings["motion left"]["text"]
        self.assertRegex(told, r"F303|no successful exchange with the board for \d\.\d+ s; the board's own watchdog vents "
                         r"the outputs after 0\.500 s")

    def pause(self, child):
        child.send(signal.SIGSTOP)
        time.sleep(PAUSE_S)
        child.send(signal.SIGCONT)


class Paused(MotionTest):
    """Tests pauses of the whole process (SIGSTOP). A pause is longer than the time-out of the board's watchdog."""

    def check(self, name):
        command, code = MOTIONS[name]
        child = self.begin(command)
        self.wait_for_pressure(child, 5)
        self.pause(child)
        samples = self.outputs_to_the_end(child)
        self.check_end(name, child, code)
        self.check_vented(samples)

    def test_calibrate_raises_no_pressure_after_a_pause(self):
        self.check("calibrate")

    def test_doctor_raises_no_pressure_after_a_pause(self):
        self.check("doctor")

    def test_run_raises_no_pressure_after_a_pause(self):
        self.check("run")

    def test_baseline_raises_no_pressure_after_a_pause(self):
        self.check("baseline")

    def test_calibrate_raises_no_pressure_after_a_pause_before_its_question(self):
        child = self.begin((*CALIBRATE, "--sensor", "--move", "--settle-s", "0.3"))
        # Standard input is closed. The pause occurs while the finger is pressurised, before the command asks its
        # question.
        self.wait_for_pressure(child, 9.9)
        self.pause(child)
        samples = self.outputs_to_the_end(child)
        self.check_end("calibrate", child, 4)
        self.check_vented(samples)


class Silent(MotionTest):
    """Tests a connection whose messages are lost for 0.7 s."""

    def check(self, name, fault, expected, kpa=5):
        child = self.begin(MOTIONS[name][0])
        self.wait_for_pressure(child, kpa)
        highest = max(self.board.commands_kpa())
        self.board.ask(f"fault {fault}")
        samples = self.outputs_to_the_end(child)
        self.assertEqual(child.wait(), expected, child.errors() + child.output())
        return highest, samples

    def check_nothing_rises_again(self, samples):
        left = [sample[0] for sample in samples]
        vented = left.index(min(left))
        self.assertLessEqual(max(left[vented:]), NOISE_KPA, left[:200])

    def test_run_names_the_bus_fault_of_a_board_that_is_switched_off(self):
        self.board.kill()
        done = self.softgrip("run", "config/sequences/pick_stone.yaml", "--no-socket", "--rig", self.rig_path, expect=4)
        last = [line for line in done.stderr.splitlines() if line.startswith("softgrip: ")][-1]
        self.assertIn("the board cannot be used, so the rig did not become idle within 10 s: ", last)
        self.assertIn("Connection refused", last)

    def test_run_refuses_a_file_as_recording_folder_before_it_uses_the_board(self):
        file = self.write("file", "mine")
        for path in ("file", "file/new"):
            done = self.softgrip("run", "config/sequences/pick_stone.yaml", "--no-socket", "--rig", self.rig_path,
                                 "--record", path, expect=4)
            self.assertIn(f"nothing can be recorded in {path}: Not a directory", done.stderr)
        self.assertEqual(self.board.status()["requests"], 0)
        self.assertEqual(file.read_text(), "mine")

    def test_calibrate_raises_no_pressure_after_lost_requests(self):
        _, samples = self.check("calibrate", "requests_lost", 4)
        self.check_nothing_rises_again(samples)

    def test_doctor_raises_no_pressure_after_lost_requests(self):
        _, samples = self.check("doctor", "requests_lost", 6)
        self.check_nothing_rises_again(samples)

    def test_doctor_reports_at_once_that_the_board_does_not_respond(self):
        child = self.begin(MOTIONS["doctor"][0])
        self.wait_for_pressure(child, 5)
        self.board.kill()
        bench.wait_for("the report", lambda: "the board does not respond" in child.errors())
        self.assertTrue(child.running(), "the report must not wait for the end of the command")
        self.assertEqual(child.output(), "")
        self.assertEqual(child.wait(), 6, child.errors())
        findings = {finding["name"]: finding for finding in json.loads(child.output())["findings"]}
        self.assertEqual([findings[name]["verdict"] for name in ("motion left", "safe state")], ["fail", "fail"])

    def test_calibrate_raises_no_pressure_while_replies_are_lost(self):
        """Tests a connection on which the requests arrive and the replies are lost. The board keeps its outputs. They
        may stay at the last command but must not rise."""
        highest, samples = self.check("calibrate", "replies_lost", 4)
        self.assertLess(max(sample[0] for sample in samples), highest + 2,
                        "the command must rise by at most one cycle's step plus the noise")
        self.assertLessEqual(samples[-1][0], NOISE_KPA)


class Blind(MotionTest):
    """Tests a displacement sensor that fails while its finger moves."""

    def test_calibrate_raises_no_pressure_without_the_sensor(self):
        self.board.ask("fault blind")
        for what in (("--move",), ("--valve", "--move"), ("--dead-zone", "--move"), ("--sensor", "--move")):
            with self.subTest(what):
                child = self.begin((*CALIBRATE, "--settle-s", "0.3", *what))
                samples = self.outputs_to_the_end(child)
                self.assertEqual(child.wait(), 6, child.errors())
                self.assertRegex(child.errors(), r"the displacement sensor of `left`: \d+ consecutive readings are not valid "
                                                 r"\(\w+\)")
                self.assertLessEqual(max(max(sample) for sample in samples), NOISE_KPA)
                self.assertEqual(child.output(), "", "no lines for the rig file")

    def test_doctor_does_not_move_a_finger_without_its_sensor(self):
        self.board.ask("fault blind")
        child = self.begin(MOTIONS["doctor"][0])
        samples = self.outputs_to_the_end(child)
        self.assertEqual(child.wait(), 6, child.errors())
        self.assertLessEqual(max(sample[0] for sample in samples), NOISE_KPA)
        self.assertGreater(max(sample[1] for sample in samples), 5, "the other finger has its sensor")
        findings = {finding["name"]: finding for finding in json.loads(child.output())["findings"]}
        self.assertEqual(findings["sensor left"]["verdict"], "fail")
        self.assertEqual(findings["motion left"]["text"], "not judged: see `sensor left`")
        self.assertEqual(findings["finger right"]["verdict"], "ok")

    def test_a_sensor_failure_during_the_motion_ends_calibrate_and_vents(self):
        child = self.begin((*CALIBRATE, "--valve", "--move", "--settle-s", "1"))
        self.wait_for_pressure(child, 12)  # the pressure is rising to 40 kPa
        self.board.ask("fault blind")
        samples = self.outputs_to_the_end(child)
        self.assertEqual(child.wait(), 6, child.errors())
        self.assertIn("are not valid", child.errors())
        self.assertLess(max(sample[0] for sample in samples), 30)
        self.assertEqual(self.board.commands_kpa(), [0, 0])

    def test_calibrate_without_motion_reports_the_number_of_invalid_readings(self):
        self.board.ask("fault blind")
        done = self.softgrip("calibrate", "--rig", self.rig_path, *CALIBRATE[1:], "--sensor", "--gauge-mm", "1", "20",
                             expect=6)
        self.assertTrue(re.search(r"\d+ of \d+ readings are not valid", done.stderr), done.stderr)


if __name__ == "__main__":
    bench.main()
