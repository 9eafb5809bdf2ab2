"""Tests the check of recordings. The recordings of a grip that ends in a fault must pass the check. If rows of a
recording are changed, the recording must fail."""

import csv
import json
import signal
import time
import unittest

import bench
import recording_check

STUCK_DISK = bench.BUILD / "tests" / "system" / "libstuck_disk.so"


class Recordings(bench.BenchTest):
    def record(self):
        """Records a grip, a pause of the process, an acknowledgement, and a second grip. The pause is longer than the
        time-out of the board's watchdog."""
        emulator = self.emulator("--object", "stone")
        daemon = self.idle_daemon(self.rig(emulator.port))
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        daemon.send(signal.SIGSTOP)
        time.sleep(0.8)
        daemon.send(signal.SIGCONT)
        daemon.wait_for_state("faulted")
        time.sleep(1)  # waits until the recording has ended
        bench.wait_for("an acknowledged fault", lambda: daemon.ask("acknowledge")["ok"])
        daemon.wait_for_state("idle")
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="right")
        self.assertEqual(daemon.end(), 0)
        recordings = self.recordings()
        self.assertGreaterEqual(len(recordings), 2)
        return recordings

    def tampered(self, recording, change):
        """Changes rows of the recording, returns the violations that the check finds, and restores the recording."""
        path = recording / "run.csv"
        before = path.read_text()
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        change(rows)
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        said = recording_check.check(recording)
        path.write_text(before)
        return "\n".join(said)

    def test_the_check_accepts_a_valid_recording_and_rejects_changed_rows(self):
        recording = self.record()[0]
        self.assertEqual(recording_check.check(recording), [])

        def last(rows, state):
            return next(row for row in reversed(rows) if row["state"] == state)

        def rise(rows):
            last(rows, "faulted")["pressure_command_kpa"] = "3"

        def leave_range(rows):
            last(rows, "running")["pressure_command_kpa"] = "75"

        def jump(rows):
            row = last(rows, "running")
            row["pressure_command_kpa"] = str(float(row["pressure_command_kpa"]) + 10)

        def fall(rows):
            last(rows, "running")["pressure_command_kpa"] = "0"

        def lose_a_row(rows):
            del rows[len(rows) // 2]

        def lose_a_tick(rows):
            del rows[len(rows) // 2 * 2 - 100:len(rows) // 2 * 2 - 98]

        def swap(rows):
            rows[10], rows[12] = rows[12], rows[10]

        def hold_blindly(rows):
            first = next(row for row in rows if row["result"] == "holding")
            first["validity"], first["pressure_kpa"] = "stale", ""

        def go_on_under_a_fault(rows):
            rows[-1]["state"] = rows[-2]["state"] = "running"

        for change, sentence in ((rise, "while faulted"), (leave_range, "out of the range"), (jump, "the command leaves rest by 1"),
                                 (fall, "the command returns to rest by"),
                                 (lose_a_row, "out of order"), (lose_a_tick, "run.json says"), (swap, "its time follows"),
                                 (hold_blindly, "HOLDING from a reading that is stale"),
                                 (go_on_under_a_fault, "faulted is followed by running")):
            with self.subTest(change.__name__):
                self.assertIn(sentence, self.tampered(recording, change))


@unittest.skipUnless(STUCK_DISK.exists(), "the shim is not built: a sanitizer's runtime must be loaded first")
class HangingDisk(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.stuck = self.folder / "stuck"
        self.board = self.emulator("--object", "stone")
        self.softgripd = self.idle_daemon(self.rig(self.board.port), {
            "LD_PRELOAD": str(STUCK_DISK), "STUCK_WHILE": str(self.stuck), "STUCK_FOLDER": str(self.folder / "runs")})

    def wait_for_the_recorder(self):
        bench.wait_for("a recorder that waits for the disk", (self.folder / "stuck.waits").exists)

    def test_a_disk_that_hangs_at_the_stop_is_reported_with_exit_code_4(self):
        self.softgripd.start("pick_stone")
        self.softgripd.wait_for_event("recording_started")
        self.stuck.touch()
        self.wait_for_the_recorder()
        self.assertEqual(self.softgripd.end(), 4)
        self.stuck.unlink()
        self.assertEqual(max(self.board.commands_kpa()), 0)
        errors = self.softgripd.errors()
        for sentence in ("Stopping: the safe outputs are written", "The thread of the recorder hangs",
                         "The board confirmed the safe outputs"):
            self.assertIn(sentence, errors)

    def test_two_starts_while_the_disk_hangs_get_recordings_with_their_own_sequences(self):
        self.stuck.touch()
        self.softgripd.start("free_stroke")
        self.wait_for_the_recorder()
        self.softgripd.result("stop")
        self.softgripd.wait_for_state("idle")
        since = self.softgripd.events()[-1]["id"]
        self.softgripd.start("pick_stone")
        self.softgripd.wait_for_event("sequence_started", since=since)
        self.stuck.unlink()
        self.assertEqual(self.softgripd.end(), 0)
        recorded = [json.loads((recording / "run.json").read_text())["sequence"]["name"] for recording in self.recordings()]
        self.assertEqual(sorted(recorded), ["free_stroke", "pick_stone"])


if __name__ == "__main__":
    bench.main()
