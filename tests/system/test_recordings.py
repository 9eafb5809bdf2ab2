"""Tests the check of recordings. The recordings of a grip that ends in a fault must pass the check. If rows of a
recording are changed, the recording must fail."""

import csv
import signal
import time

import bench
import recording_check


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


if __name__ == "__main__":
    bench.main()
