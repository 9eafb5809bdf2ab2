"""Words that fit two devices of the computer: every program refuses them with exit code 3, and nothing moves."""

import os
import pathlib
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
        """What a program says that refuses the rig file."""
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=bench.PATIENCE_S,
                              env={**os.environ, **(environment or {})})
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        return done.stderr

    def test_a_name_of_two_converters(self):
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

    @unittest.skipUnless(digital_lines.PRELOADED.exists(), "not built: a sanitizer's runtime must be loaded first")
    def test_a_label_of_two_chips(self):
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
