"""Tests the emulator with mbpoll, which shares no code with softgrip."""

import re
import shutil
import subprocess
import unittest

import bench


@unittest.skipUnless(shutil.which("mbpoll"), "mbpoll is not installed")
class Mbpoll(bench.BenchTest):
    def poll(self, port, *arguments, expect=0):
        done = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(port), "-a", "1", "-0", "-1", *arguments], text=True,
                              capture_output=True, timeout=bench.PATIENCE_S, check=False)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def registers(self, port, table, first, count):
        text = self.poll(port, "-t", table, "-r", str(first), "-c", str(count), "127.0.0.1")
        return [int(value) for value in re.findall(r"^\[\d+\]:\s+(\d+)", text, re.MULTILINE)]

    def test_reads_inputs_with_either_function_and_writes_outputs(self):
        emulator = self.emulator("--watchdog-s", "0", "--noise-mm", "0", "--pressure-noise-kpa", "0")
        one_volt = round((1 + 10) / 20 * 65535)  # reading of 1 V: with 0 to 10 V for -5 to 45 mm, 1 V means 0 mm
        zero_volts = round(10 / 20 * 65535)
        expected = [one_volt, one_volt, zero_volts, zero_volts, zero_volts, zero_volts]
        for table in ("3", "4"):
            for value, wanted in zip(self.registers(emulator.port, table, 0, 6), expected, strict=True):
                self.assertAlmostEqual(value, wanted, delta=1)
        self.poll(emulator.port, "-t", "4", "-r", "10", "127.0.0.1", "1638", "819")
        self.assertEqual(self.registers(emulator.port, "4", 10, 2), [1638, 819])
        left, right = emulator.commands_kpa()
        self.assertAlmostEqual(left, 40, delta=0.02)
        self.assertAlmostEqual(right, 20, delta=0.02)
        bench.wait_for("the finger", lambda: emulator.status()["channels"][0]["displacement_mm"] > 10)
        self.assertGreater(self.registers(emulator.port, "3", 0, 1)[0], one_volt + 10 / 50 * 10 / 20 * 65535 - 700)

    def test_nonexistent_addresses_are_rejected(self):
        emulator = self.emulator()
        self.assertIn("Illegal data address", self.poll(emulator.port, "-t", "4", "-r", "100", "-c", "1", "127.0.0.1",
                                                        expect=1))


if __name__ == "__main__":
    bench.main()
