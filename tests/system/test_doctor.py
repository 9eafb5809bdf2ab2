"""Tests softgrip doctor and softgrip calibrate as a technician uses them. The emulator replaces the board, over
TCP."""

import json
import os
import re
import resource
import signal
import subprocess
import unittest

import bench
import digital_lines


class Doctor(bench.BenchTest):
    def doctor(self, rig, *arguments, expect=0):
        done = self.softgrip("doctor", "--rig", rig, "--json", *arguments, expect=expect)
        report = json.loads(done.stdout)
        return report, {finding["name"]: finding for finding in report["findings"]}

    def test_a_healthy_rig_passes_and_is_vented_afterwards(self):
        emulator = self.emulator()
        report, findings = self.doctor(self.rig(emulator.port), "--move", expect=None)
        # In the tests, the punctuality checks of the doctor may fail, because the machine may be busy.
        failed = {name for name, finding in findings.items() if finding["verdict"] == "fail"}
        self.assertLessEqual(failed, {"timer", "bus time"}, report)
        for name in ("board", "sensor left", "valve left", "finger right", "model right", "safe state"):
            self.assertEqual(findings[name]["verdict"], "ok", findings[name])
        self.assertEqual(max(emulator.commands_kpa()), 0)

    def test_doctor_without_the_option_move_applies_no_pressure(self):
        emulator = self.emulator()
        report, findings = self.doctor(self.rig(emulator.port), expect=None)
        self.assertFalse(report["moved"])
        self.assertNotIn("valve left", findings)
        self.assertLess(max(emulator.pressures_kpa()), 0.01)

    def test_an_unreachable_board_fails_with_advice_on_the_cable(self):
        _, findings = self.doctor(self.rig(1), expect=6)
        self.assertEqual(findings["board"]["verdict"], "fail")
        self.assertIn("cable", findings["board"]["advice"])

    def failures(self, report):
        """Returns the names of the failed checks. Omits the punctuality checks, because they may fail on a busy
        machine."""
        return [finding["name"] for finding in report["findings"]
                if finding["verdict"] == "fail" and finding["name"] not in ("timer", "bus time", "loop")]

    @staticmethod
    def swapped(key, one, other):
        """Returns the changes of the rig file that swap two terminals of the board."""
        kind = "output" if key == "valve" else "input"
        return [(rf"{key}: \{{{kind}: {a}\b", f"{key}: {{{kind}: {b}")
                for a, b in ((one, 99), (other, one), (99, other))]

    def crossed(self, *swaps):
        emulator = self.emulator()
        changes = [change for key, one, other in swaps for change in self.swapped(key, one, other)]
        report, findings = self.doctor(self.rig(emulator.port, changes), "--move", expect=6)
        self.assertEqual(max(emulator.commands_kpa()), 0)
        return report, findings

    def test_the_advice_on_swapped_sensors_names_both_inputs(self):
        report, findings = self.crossed(("sensor", 0, 1))
        self.assertEqual(self.failures(report), ["sensors left, right"])
        self.assertIn("crossed", findings["sensors left, right"]["text"])
        self.assertIn("swap input 1 (`left`) and input 0 (`right`)", findings["sensors left, right"]["advice"])
        for name in ("finger left", "model right"):
            self.assertEqual(findings[name]["verdict"], "not_judged")
        self.assertEqual(findings["valve left"]["verdict"], "ok",
                         "the pressure monitor of the left valve is connected correctly")

    def test_the_advice_on_swapped_pressure_monitors_names_both_inputs(self):
        report, findings = self.crossed(("pressure_monitor", 4, 5))
        self.assertEqual(self.failures(report), ["monitors left, right"])
        self.assertIn("swap input 5 (`left`) and input 4 (`right`)", findings["monitors left, right"]["advice"])
        self.assertEqual(findings["valve left"]["verdict"], "not_judged")
        self.assertEqual(findings["finger left"]["verdict"], "ok")

    def test_the_advice_on_swapped_valves_names_both_outputs(self):
        report, findings = self.crossed(("valve", 0, 1))
        self.assertEqual(self.failures(report), ["valves left, right"])
        self.assertIn("swap output 1 (`left`) and output 0 (`right`)", findings["valves left, right"]["advice"])

    def test_a_disconnected_sensor_is_reported_as_one_failure(self):
        emulator = self.emulator("--faults", self.write("faults.yaml", (
            "faults:\n  - {name: blind, kind: sensor_out_of_range, channel: left}\n")))
        emulator.ask("fault blind")
        rig = self.rig(emulator.port)
        report, findings = self.doctor(rig, "--move", expect=6)
        self.assertEqual(self.failures(report), ["sensor left"])
        self.assertIn("see `sensor left`", findings["motion left"]["text"])
        self.assertEqual(findings["finger right"]["verdict"], "ok")
        daemon = self.daemon(rig)
        bench.wait_for("an answer of the daemon", lambda: daemon.status()["bus"]["connected"])
        report, _ = self.doctor(rig, expect=6)
        self.assertEqual(self.failures(report), ["sensor left"])

    def verdicts(self, rig, names):
        """Returns the verdicts of `softgrip doctor` without and with a running daemon."""
        _, alone = self.doctor(rig, expect=None)
        daemon = self.daemon(rig)
        bench.wait_for("an answer of the daemon", lambda: daemon.status()["bus"]["connected"])
        _, beside = self.doctor(rig, expect=None)
        return [[findings[name]["verdict"] for name in names] for findings in (alone, beside)]

    def test_an_unused_sensor_is_judged_equally_with_and_without_a_daemon(self):
        emulator = self.emulator("--faults", self.write("faults.yaml", (
            "faults:\n  - {name: blind, kind: sensor_out_of_range, channel: left}\n")))
        emulator.ask("fault blind")
        rig = self.rig(emulator.port, [(r"feedforward: full_model", "feedforward: none\n  displacement_used: false")])
        alone, beside = self.verdicts(rig, ("sensor left", "pressure left"))
        self.assertEqual(alone, ["ok", "ok"])
        self.assertEqual(beside, alone)

    def test_a_broken_pressure_monitor_is_judged_equally_with_and_without_a_daemon(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port, [(r"valid_v: \[-0\.2, 10\]", "valid_v: [8, 10]")])
        alone, beside = self.verdicts(rig, ("sensor left", "pressure left", "pressure right"))
        self.assertEqual(alone, ["ok", "fail", "fail"])
        self.assertEqual(beside, alone)

    def test_a_daemon_without_a_board_is_reported_as_one_failure(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.idle_daemon(rig)
        emulator.kill()
        daemon.wait_for_state("faulted")
        report, findings = self.doctor(rig, expect=6)
        self.assertEqual(self.failures(report), ["board"])
        self.assertIn("see `board`", findings["fault"]["text"])
        self.assertEqual(findings["sensor left"]["verdict"], "not_judged")

    def test_doctor_without_a_daemon_requires_the_option_rig(self):
        """The working directory contains the shipped config/rig.yaml, which describes the simulated rig."""
        self.rig(1)
        asked = self.softgrip("doctor", expect=2)
        self.assertIn("--rig RIG", asked.stderr)
        self.assertIn("config/rig.yaml is the simulated rig", asked.stderr)
        named = self.softgrip("doctor", "--rig", "config/rig.yaml", expect=None)
        self.assertRegex(named.stdout.splitlines()[-1], r"SIMULATED: no board, valve, finger or sensor was examined$")
        self.assertTrue(json.loads(self.softgrip("doctor", "--rig", "config/rig.yaml", "--json", expect=None)
                                   .stdout)["simulated"])

    def test_doctor_takes_the_rig_file_from_the_running_daemon(self):
        emulator = self.emulator()
        daemon = self.idle_daemon(self.rig(emulator.port))
        report = json.loads(self.softgrip("doctor", "--json", expect=None).stdout)
        self.assertEqual(report["rig"], "bench")
        self.assertTrue(report["rig_file"].endswith("config/test_rig.yaml"), report["rig_file"])
        self.assertFalse(report["simulated"])
        self.assertIn("disk", {finding["name"] for finding in report["findings"]})
        self.softgrip("doctor", "--move", expect=5)

    def test_a_recording_folder_that_cannot_be_created_is_a_failure(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port, [(r"directory: \S+/runs", "directory: /proc/runs")])
        _, findings = self.doctor(rig, expect=6)
        self.assertEqual(findings["disk"]["verdict"], "fail")

    def test_doctor_asks_a_running_daemon_and_does_not_use_the_board(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        daemon = self.idle_daemon(rig)
        report, findings = self.doctor(rig, expect=None)
        self.assertTrue(report["daemon_runs"])
        self.assertEqual(findings["daemon"]["verdict"], "ok")
        self.assertEqual(findings["sensor left"]["verdict"], "ok")
        refused = self.softgrip("doctor", "--rig", rig, "--move", expect=5)
        self.assertIn("softgripd runs", refused.stderr)
        self.assertEqual(daemon.status()["state"], "idle")
        self.assertEqual(daemon.end(), 0)

    def test_an_invalid_rig_file_exits_with_3_and_a_missing_one_with_4(self):
        self.softgrip("doctor", "--rig", self.write("bad.yaml", "name: x\n"), expect=3)
        self.softgrip("doctor", "--rig", "nowhere.yaml", expect=4)


class Calibrate(bench.BenchTest):
    """Tests softgrip calibrate. The emulator has the values of the shipped rig, and the rig file to be calibrated has
    different values."""

    # The true values of sensor and valve, from config/rig_tcp.yaml.
    def true_mm(self, volts):
        return -5 + 5 * volts

    def wrong_rig(self, emulator):
        return self.rig(emulator.port, [(r"is_mm: \[-5, 45\]", "is_mm: [0, 60]"),
                                        (r"displacement_margin_mm: 2", "displacement_margin_mm: 40"),
                                        (r"at_v: \[0, 10\], is_kpa: \[0, 100\], range", "at_v: [0, 10], is_kpa: [0, 80], range")])

    def start(self, rig, *arguments, environment=None):
        child = subprocess.Popen([str(a) for a in (bench.SOFTGRIP, "calibrate", "--rig", rig, "--channel", "left",
                                                   "--date", "2026-11-20", *arguments)],
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 cwd=self.folder, env={**os.environ, **(environment or {})})
        self.addCleanup(self.clean_up, child)
        return child

    @staticmethod
    def clean_up(child):
        child.kill()
        child.wait()
        for stream in (child.stdin, child.stdout, child.stderr):
            stream.close()

    def answer_with(self, child, reading):
        """Answers every question of the program until it ends. Returns everything that the program has printed."""
        said = b""
        while True:
            byte = os.read(child.stderr.fileno(), 1)
            if not byte:
                break
            said += byte
            if re.search(rb"\? [^\n]*: $", said):
                child.stdin.write(f"{reading():.4f}\n".encode())
                child.stdin.flush()
                said += b"\n"
        out = child.stdout.read().decode()
        child.wait(bench.PATIENCE_S)
        return out, said.decode()

    @staticmethod
    def line_in(text, key):
        numbers = r"\[([-\d.]+), ([-\d.]+)\]"
        found = re.search(rf"^{key}: .*at_v: {numbers}, is_\w+: {numbers}", text, re.M)
        x0, x1, y0, y1 = (float(found.group(i)) for i in range(1, 5))
        return lambda x: y0 + (x - x0) * (y1 - y0) / (x1 - x0)

    def test_wrong_sensor_and_valve_calibrations_are_corrected(self):
        emulator = self.emulator()
        rig = self.wrong_rig(emulator)
        child = self.start(rig, "--sensor", "--move", "--settle-s", "1.5", "--average-s", "0.6")
        out, said = self.answer_with(child, lambda: emulator.status()["channels"][0]["displacement_mm"])
        self.assertEqual(child.returncode, 0, said)
        error = float(re.search(r"sensor: error between the points ([\d.]+) mm", out).group(1))
        sensor = self.line_in(out, "sensor")
        # The test reads the gauge shortly before softgrip averages the readings of the sensor. Meanwhile, the finger
        # creeps.
        for volts in (2, 4):
            self.assertAlmostEqual(sensor(volts), self.true_mm(volts), delta=error + 0.3, msg=out)
        self.assertEqual(max(emulator.commands_kpa()), 0)

        child = self.start(rig, "--valve", "--move", "--settle-s", "1", "--average-s", "0.6")
        out, said = self.answer_with(child, lambda: 0)
        self.assertEqual(child.returncode, 0, said)
        valve = self.line_in(out, "valve")
        for volts in (2, 5):
            self.assertAlmostEqual(valve(volts), 10 * volts, delta=0.5, msg=out)

    def test_gauge_values_can_be_options_and_the_output_states_the_date(self):
        emulator = self.emulator()
        done = self.softgrip("calibrate", "--rig", self.rig(emulator.port), "--channel", "left", "--sensor", "--move",
                             "--settle-s", "0.5", "--average-s", "0.3", "--gauge-mm", "4.8", "18.9", "--date",
                             "2026-01-02", "--out", "left.yaml")
        text = (self.folder / "left.yaml").read_text()
        self.assertTrue(text.startswith("# softgrip calibrate, 2026-01-02: rig bench, channel left\n"), text)
        self.assertIn("left.yaml", done.stdout)

    def test_invalid_gauge_values_and_options_are_rejected(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        quick = ("--channel", "left", "--sensor", "--move", "--settle-s", "0.3", "--average-s", "0.3")
        close = self.softgrip("calibrate", "--rig", rig, *quick, "--gauge-mm", "5", "5.1", expect=6)
        self.assertIn("too close", close.stderr)
        self.softgrip("calibrate", "--rig", rig, *quick, "--gauge-mm", "five", "6", expect=3)
        self.softgrip("calibrate", "--rig", rig, *quick, expect=3)  # standard input gives no answer to the question
        self.softgrip("calibrate", "--rig", rig, "--channel", "left", "--valve", expect=2)
        self.softgrip("calibrate", "--rig", rig, expect=2)  # the option --channel is missing
        typo = self.softgrip("calibrate", "--rig", rig, "--channel", "lft", "--sensor", expect=2)
        self.assertIn("the rig has no channel `lft`; give one of its channels with --channel: left, right", typo.stderr)
        few = self.softgrip("calibrate", "--rig", rig, *quick, "--repeats", "2", "--gauge-mm", "5", "20", "6", expect=2)
        self.assertIn("--gauge-mm has 3 readings, but 2 or 4 are necessary", few.stderr)
        self.assertEqual(max(emulator.commands_kpa()), 0)

    QUICK = ("--channel", "left", "--sensor", "--move", "--settle-s", "0.5", "--average-s", "0.3")

    @unittest.skipUnless(digital_lines.PRELOADED.exists(), "not built: a sanitizer's runtime must be loaded first")
    def test_an_emergency_stop_ends_the_calibration_at_the_rest_pressures(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        rig.write_text(rig.read_text() + digital_lines.SECTION)
        child = self.start(rig, "--valve", "--move", environment=digital_lines.environment(self.folder))
        bench.wait_for("the motion", lambda: max(emulator.commands_kpa()) > 5)
        lines = digital_lines.Lines(self.folder)
        self.addCleanup(lines.wire.close)
        self.assertIn("ENABLE", lines.on())
        lines.press()
        _, said = child.communicate(timeout=bench.PATIENCE_S)
        self.assertEqual(child.returncode, 6, said)
        self.assertIn(b"the emergency stop is pressed", said)
        self.assertEqual(emulator.commands_kpa(), [0, 0])

    def test_a_calibration_by_hand_does_not_drop_a_held_part_without_a_confirmation(self):
        rig = self.folder / "config/rig.yaml"
        text, count = re.subn(r"watchdog_timeout_s: \S+", "watchdog_timeout_s: 0", rig.read_text())
        self.assertEqual(count, 1)
        words = "the outputs keep their last pressure when softgripd dies"
        rig.write_text(text.replace("safety:\n", f'safety:\n  accept_no_watchdog: "{words}"\n'))
        by_hand = ("--channel", "left", "--sensor", "--average-s", "0.1", "--gauge-mm", "1", "20")
        refused = self.softgrip("calibrate", "--rig", rig, *by_hand, expect=5)
        self.assertIn("the fingers may still hold a part", refused.stderr)
        confirmed = self.softgrip("calibrate", "--rig", rig, *by_hand, "--yes", expect=6)
        self.assertIn("the signal changes too little", confirmed.stderr)

    def test_the_result_is_written_into_the_rig_file(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        before = rig.read_text()
        done = self.softgrip("calibrate", "--rig", rig, *self.QUICK, "--gauge-mm", "3.6", "19", "--write")
        after = rig.read_text()
        backup = [path for path in rig.parent.iterdir() if path.name.startswith("test_rig.yaml.")]
        self.assertEqual([path.read_text() for path in backup], [before])
        self.assertIn(backup[0].name, done.stderr)
        old, new = before.splitlines(), after.splitlines()
        self.assertEqual([line for line in new if line not in old],
                         [line for line in new if "softgrip calibrate" in line or "sensor: {input: 0, at_v" in line])
        self.assertEqual(len(new), len(old) + 1)
        line = next(line for line in new if "sensor: {input: 0" in line)
        numbers = [float(number) for number in re.findall(r"-?[\d.]+", line)]
        for volts, reading_mm in zip(numbers[1:3], numbers[3:5]):
            self.assertAlmostEqual(reading_mm, self.true_mm(volts), delta=1.5)
        self.softgrip("check", rig)

    def test_an_implausible_scale_requires_confirmation(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        before = rig.read_bytes()
        wrong = ("--gauge-mm", "4.8", "118.9", "--write")
        done = self.softgrip("calibrate", "--rig", rig, *self.QUICK, *wrong, expect=6)
        self.assertIn("doubtful: sensor: at the point where the calibration line in the rig file gives", done.stderr)
        self.assertIn("doubtful: sensor: between", done.stderr)
        self.assertIn("is unchanged", done.stderr)
        self.assertEqual(rig.read_bytes(), before)
        self.assertEqual(len(list(rig.parent.glob("test_rig.yaml.*"))), 0)
        child = self.start(rig, *self.QUICK[2:], *wrong)
        child.communicate(b"perhaps\nno\n", timeout=bench.PATIENCE_S)
        self.assertEqual(child.returncode, 6)
        self.assertEqual(rig.read_bytes(), before)
        child = self.start(rig, *self.QUICK[2:], *wrong)
        _, said = child.communicate(b"yes\n", timeout=bench.PATIENCE_S)
        self.assertEqual(child.returncode, 0, said)
        self.assertNotEqual(rig.read_bytes(), before)

    def test_an_invalid_answer_repeats_the_question(self):
        emulator = self.emulator()
        child = self.start(self.rig(emulator.port), *self.QUICK[2:])
        _, said = child.communicate(b"4,8mm\n4,8\nabout 19\n18.9\n", timeout=bench.PATIENCE_S)
        self.assertEqual(child.returncode, 0, said)
        self.assertIn(b"`4,8mm` is not a number. Please enter", said)
        self.assertIn(b"`about 19` is not a number. Please enter", said)

    def test_a_full_disk_leaves_the_rig_file_unchanged(self):
        emulator = self.emulator()
        rig = self.rig(emulator.port)
        before = rig.read_bytes()
        # The limit on the file size makes the write fail. restore_signals=False keeps SIGXFSZ ignored; otherwise, this
        # signal would end the process.
        done = subprocess.run([bench.SOFTGRIP, "calibrate", "--rig", rig, *self.QUICK, "--gauge-mm", "3.6", "19", "--write",
                               "--out", "-"], cwd=self.folder, capture_output=True, text=True, restore_signals=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("not written", done.stderr)
        self.assertEqual(rig.read_bytes(), before)
        self.assertEqual(len(list(rig.parent.glob("test_rig.yaml.*"))), 0)

    def test_ctrl_c_vents_the_rig(self):
        emulator = self.emulator()
        child = self.start(self.rig(emulator.port), "--valve", "--move", "--settle-s", "3")
        bench.wait_for("motion", lambda: emulator.commands_kpa()[0] > 5)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.wait(bench.PATIENCE_S), -signal.SIGINT,
                         "an exit code instead of a signal does not end the loop of a shell")
        self.assertEqual(max(emulator.commands_kpa()), 0)


if __name__ == "__main__":
    bench.main()
