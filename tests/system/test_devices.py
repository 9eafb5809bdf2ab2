"""Tests rig files in which a device name is ambiguous, because two devices of the computer match it. Every program
must refuse such a file with exit code 3, and no finger may move."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import bench
import digital_lines


class Devices(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write_rig(self, name, *changes):
        text = (bench.SOURCE / "config" / name).read_text()
        for old, new in (("models/", f"{bench.SOURCE}/config/models/"), ("cpus: [1]", "cpus: []"),
                         ("/tmp/softgrip-runs", f"{self.folder}/runs"),
                         ("/tmp/softgrip.sock", f"{self.folder}/socket"), *changes):
            self.assertIn(old, text)
            text = text.replace(old, new)
        path = self.folder / "rig.yaml"
        path.write_text(text)
        return path

    def refused(self, command, environment=None):
        """Returns the message with which a program refuses the rig file."""
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=bench.PATIENCE_S,
                              env={**os.environ, **(environment or {})})
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        return done.stderr

    def test_a_name_that_matches_two_converters_is_rejected(self):
        for number, name in enumerate(("mcp4725", "mcp4725", "ads1115")):
            node = self.folder / "iio" / f"iio:device{number}"
            node.mkdir(parents=True)
            (node / "name").write_text(name + "\n")
            (node / "out_voltage0_raw").write_text("1234\n")
        rig = self.write_rig("rig_iio.yaml", ("  iio:\n", f"  iio:\n    root: {self.folder}/iio\n"),
                             ("1-0060", "mcp4725"), ("1-0061", "mcp4725"))
        for command in ((bench.SOFTGRIP, "check", rig), (bench.SOFTGRIP, "doctor", "--rig", rig),
                        (bench.SOFTGRIPD, "--config", rig), (bench.SOFTGRIPD, "--config", rig, "--check"),
                        (bench.SOFTGRIPD, "--config", rig, "--safe-outputs"),
                        (bench.SOFTGRIPD, "--config", rig, "--device", "iio:device0")):
            said = self.refused(command)
            self.assertIn("rig.yaml:11:18: `mcp4725` fits 2 converters: iio:device0 (name `mcp4725`) and iio:device1", said)
        for number in range(3):
            self.assertEqual((self.folder / f"iio/iio:device{number}/out_voltage0_raw").read_text(), "1234\n")

    def plug(self, number, address, name):
        """Adds a converter to a bus in the simulated /sys, with a link in the list of all converters."""
        node = self.folder / "hardware" / address / f"iio:device{number}"
        node.mkdir(parents=True)
        for attribute, text in (("name", name), ("out_voltage0_raw", "1234"), ("out_voltage0_scale", "0.8"),
                                ("out_voltage0_powerdown", "1")):
            (node / attribute).write_text(text + "\n")
        for channel in range(4):
            (node / f"in_voltage{channel}_raw").write_text("8000\n")
            (node / f"in_voltage{channel}_scale").write_text("0.125\n")
        (self.folder / "iio").mkdir(exist_ok=True)
        (self.folder / "iio" / node.name).symlink_to(node)
        return node

    def test_another_converter_with_the_name_of_a_removed_one_is_not_used(self):
        valve = self.plug(0, "1-0060", "mcp4725")
        self.plug(1, "1-0061", "dac7571")
        sensors = self.plug(2, "1-0048", "ads1115")
        rig = self.write_rig("rig_iio.yaml", ("  iio:\n", f"  iio:\n    root: {self.folder}/iio\n"),
                             ("device: 1-0060", "device: mcp4725"), ("device: 1-0061", "device: dac7571"))
        log = self.folder / "log"
        with log.open("w") as file:
            daemon = subprocess.Popen([bench.SOFTGRIPD, "--config", rig], stdout=file, stderr=file)
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.kill)
        bench.wait_for("the first output", lambda: (valve / "out_voltage0_powerdown").read_text() == "0\n")
        self.assertEqual((valve / "out_voltage0_raw").read_text().split()[0], "0")
        (self.folder / "iio/iio:device0").unlink()
        other = self.plug(0, "1-0062", "mcp4725")
        # This text is not a number, so the daemon ends the session with the board.
        (sensors / "in_voltage0_raw").write_text("gone\n")
        bench.wait_for("the end of the session", lambda: "no number" in log.read_text())
        (sensors / "in_voltage0_raw").write_text("8000\n")
        bench.wait_for("the refusal", lambda: re.search(
            "No session with the board can be opened: disconnected: mcp4725 voltage0: it was mcp4725 at .*1-0060, "
            "but now it is mcp4725 at .*1-0062: restart softgripd if this change is intended", log.read_text()))
        self.assertEqual((other / "out_voltage0_raw").read_text(), "1234\n")
        self.assertEqual((other / "out_voltage0_powerdown").read_text(), "1\n")
        (self.folder / "iio/iio:device0").unlink()
        # The converter of the rig returns with another device number.
        (self.folder / "iio/iio:device3").symlink_to(valve)
        bench.wait_for("the next session", lambda: "Communication with the board restored" in log.read_text())

    @unittest.skipUnless(digital_lines.PRELOADED.exists(), "not built: a sanitizer's runtime must be loaded first")
    def test_a_label_that_matches_two_gpio_chips_is_rejected(self):
        rig = self.write_rig("rig.yaml")
        rig.write_text(rig.read_text() + digital_lines.SECTION.replace("chip: gpiochip0", "chip: preloaded"))
        environment = {**digital_lines.environment(self.folder), "GPIO_TWIN": "1"}
        for more in ((), ("--check",)):
            (self.folder / "gpio/lines").unlink(missing_ok=True)
            said = self.refused((bench.SOFTGRIPD, "--config", rig, *more), environment)
            self.assertIn("`preloaded` fits 2 GPIO chips: gpiochip0 (label `preloaded`) and gpiochip1 (label `preloaded`)",
                          said)
            self.assertRegex(said, r"rig\.yaml:\d+:\d+: `preloaded`")


if __name__ == "__main__":
    unittest.main(verbosity=2)
