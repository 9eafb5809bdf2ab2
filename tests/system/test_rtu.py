"""Tests a serial line end to end with real processes. The line is a pseudo-terminal on which bytes take as long as on
a real line."""

import re
import shutil
import subprocess
import time
import unittest

import bench
import serial_rig
from serial_rig import RATE_HZ


class Line(bench.BenchTest):
    """Tests the shipped rig on a serial line. The line is a pseudo-terminal of the emulator."""

    def line_rig(self, *changes):
        return serial_rig.rig_file(self.folder, RATE_HZ, *changes)

    def line_emulator(self, rig, *arguments):
        emulator = serial_rig.Emulator(self.folder, rig, *arguments)
        self.processes.append(emulator)
        self.addCleanup(emulator.control.close)
        return emulator

    def report(self, rig):
        done = subprocess.run([str(bench.SOFTGRIPD), "--config", str(rig), "--check"], capture_output=True, text=True,
                              timeout=bench.PATIENCE_S)
        return done

    def test_a_stone_is_held(self):
        rig = self.line_rig()
        self.line_emulator(rig, "--object", "stone")
        daemon = self.idle_daemon(rig)
        daemon.start("pick_stone")
        for channel in ("left", "right"):
            daemon.wait_for_event("grip_result", code="HOLDING", channel=channel)
        self.assertEqual(daemon.end(), 0)

    def test_a_rate_above_the_line_capacity_is_rejected_with_the_calculation(self):
        done = self.report(self.line_rig((r"rate_hz: \d+", "rate_hz: 100")))
        self.assertEqual(done.returncode, 3)
        for part in ("not fast enough for 100 exchanges a second", "115200 8N1", "63 bytes (5.47 ms)",
                     "silences (6 x 1.75 ms = 10.5 ms)", "at most 45 Hz", "accept_over_budget"):
            self.assertIn(part, done.stderr)
        done = self.report(self.line_rig((r"rate_hz: \d+", "rate_hz: 100"),
                                         (r"first_pause_s:", "accept_over_budget: true\n    first_pause_s:")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("configured 100 Hz: DOES NOT FIT", done.stdout)
        done = self.report(self.line_rig())
        self.assertIn(f"configured {RATE_HZ} Hz: fits", done.stdout)
        self.assertIn("watchdog: NONE on the board", done.stdout)

    def test_a_reconnected_serial_adapter_is_used_again(self):
        faults = self.write("faults.yaml", "faults:\n  - {name: unplugged, kind: disconnect}\n")
        rig = self.line_rig()
        emulator = self.line_emulator(rig, "--faults", faults)
        daemon = self.idle_daemon(rig)
        emulator.ask("fault unplugged")
        bench.wait_for("the removal of the device name", lambda: not (self.folder / "line").is_symlink())
        daemon.wait_for_state("faulted")
        emulator.ask("clear unplugged")
        daemon.wait_for_event("bus_recovered")
        self.assertEqual(daemon.status()["state"], "faulted", "nothing moves before the fault is acknowledged")
        bench.wait_for("the bus", lambda: daemon.status()["bus"]["connected"])
        daemon.result("acknowledge")
        daemon.wait_for_state("idle")

    def test_the_daemon_keeps_its_rate(self):
        rig = self.line_rig()
        self.line_emulator(rig)
        histograms = self.folder / "histograms.txt"
        done = subprocess.run([str(bench.SOFTGRIPD), "--config", str(rig), "--duration-s", "5", "--no-socket",
                               "--histograms", str(histograms)], capture_output=True, text=True,
                              timeout=bench.PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        exchanges = int(re.search(r"# Exchanges: (\d+)", histograms.read_text()).group(1))
        # On a busy machine, up to 20 % of the exchanges may be missing.
        self.assertGreater(exchanges, 0.8 * 5 * RATE_HZ)


@unittest.skipUnless(shutil.which("mbpoll"), "mbpoll is not installed")
class MbpollOnTheLine(bench.BenchTest):
    """Tests the emulator with mbpoll as the Modbus client. mbpoll shares no code with softgrip."""

    def poll(self, *arguments):
        done = subprocess.run(["mbpoll", "-m", "rtu", "-b", "19200", "-P", "even", "-0", "-1", "-q",
                               *map(str, arguments)], capture_output=True, text=True, timeout=bench.PATIENCE_S)
        return done

    def test_mbpoll_reads_and_writes_registers_on_a_serial_line(self):
        device = self.folder / "line"
        process = bench.Process("softgrip-rig", [
            bench.SOFTGRIP_RIG, "--model", self.folder / "config/models/bench_twin.yaml", "--rtu", device, "--baud", 19200,
            "--format", "8E1", "--noise-mm", 0, "--board", self.folder / "config/boards/waveshare-ao8-b.yaml",
            "--board", self.folder / "config/boards/waveshare-ai8-b.yaml"], self.folder)
        self.processes.append(process)
        bench.wait_for("the line", lambda: "listening on" in process.output())
        done = self.poll("-a", 1, "-t", 4, "-r", 0, device, 4000, 2000)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        time.sleep(2)
        done = self.poll("-a", 1, "-t", 4, "-r", 0, "-c", 2, device)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        self.assertEqual([int(v) for v in re.findall(r"\]:\s+(\d+)", done.stdout)], [4000, 2000])
        done = self.poll("-a", 2, "-t", 3, "-r", 0, "-c", 2, device)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        left, right = (int(v) for v in re.findall(r"\]:\s+(\d+)", done.stdout))
        self.assertGreater(left, right + 500,
                           "the reading at 40 kPa must exceed the reading at 20 kPa by more than 500 mV")
        done = self.poll("-a", 2, "-t", 3, "-r", 8, "-c", 1, device)
        self.assertNotEqual(done.returncode, 0, "the input does not exist")
        self.assertIn("Illegal data address", done.stdout + done.stderr)
        done = self.poll("-a", 3, "-t", 4, "-r", 0, "-c", 1, device)
        self.assertIn("timed out", done.stdout + done.stderr, "no board has this unit")


if __name__ == "__main__":
    bench.main()
