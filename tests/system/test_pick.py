"""Tests the pick sequence with both fingers over TCP. Covers three cases: a stone between the fingers, no stone,
and a stone that is pulled out."""

import json

import bench


class Pick(bench.BenchTest):
    def run_pick(self, *emulator_arguments, sequence="pick_stone"):
        self.rig_process = self.emulator(*emulator_arguments)
        daemon = self.idle_daemon(self.rig(self.rig_process.port))
        daemon.start(sequence)
        return daemon

    def results_told(self, daemon, channel):
        return [event["code"] for event in daemon.events()
                if event["kind"] == "grip_result" and event.get("channel") == channel]

    def test_a_stone_is_held_and_released(self):
        daemon = self.run_pick("--object", "stone")
        end = daemon.wait_for_event("sequence_finished")
        self.assertEqual(end["code"], "done")
        for channel in ("left", "right"):
            self.assertEqual(self.results_told(daemon, channel), ["HOLDING", "RELEASED"])
        daemon.wait_for_state("idle")
        self.assertEqual(daemon.results(), ["RELEASED", "RELEASED"])
        bench.wait_for("vented valves", lambda: max(self.rig_process.commands_kpa()) < 0.1)
        bench.wait_for("the end of the recording", lambda: not daemon.status()["recording"]["active"])
        self.assertEqual(daemon.end(), 0)
        self.check_recording()

    def check_recording(self):
        (recording,) = self.recordings()
        story = json.loads((recording / "run.json").read_text())
        self.assertEqual(story["state"], "complete")
        self.assertEqual(story["dropped_rows"], 0)
        self.assertEqual(story["sequence"]["name"], "pick_stone")
        for channel in ("left", "right"):
            rows = self.rows(recording, channel)
            self.assertGreater(len(rows), 500)
            held = [row for row in rows if row["result"] == "holding" and row["step"] == "2"]
            self.assertGreater(len(held), 200)
            # The stone yields: beyond 12 mm, the finger moves one tenth of the distance that it would move without the
            # stone.
            for row in held[50:-50]:
                self.assertTrue(11.5 < float(row["displacement_mm"]) < 13.5, row)
        self.softgrip("plot", recording, "--out", self.folder / "run.svg")
        picture = (self.folder / "run.svg").read_text()
        self.assertIn("HOLDING", picture)
        self.assertIn("</svg>", picture)

    def test_a_missing_part_is_reported_as_no_part(self):
        daemon = self.run_pick()
        end = daemon.wait_for_event("sequence_finished")
        self.assertEqual(end["code"], "failed")
        for channel in ("left", "right"):
            self.assertIn("NO PART", self.results_told(daemon, channel))
            self.assertNotIn("HOLDING", self.results_told(daemon, channel))
        self.assertEqual(daemon.results(), ["NO PART", "NO PART"])
        bench.wait_for("vented valves", lambda: max(self.rig_process.commands_kpa()) < 0.1)

    def test_a_removed_stone_is_reported_as_part_lost(self):
        daemon = self.run_pick("--object", "stone")
        daemon.wait_for_event("step_started", code="2")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="right")
        self.rig_process.ask("object out")
        end = daemon.wait_for_event("sequence_finished")
        self.assertEqual(end["code"], "failed")
        for channel in ("left", "right"):
            self.assertEqual(self.results_told(daemon, channel)[:2], ["HOLDING", "PART LOST"])
        self.assertEqual(daemon.results(), ["PART LOST", "PART LOST"])

    def test_start_with_wait_prints_the_result_and_sets_the_exit_code(self):
        self.rig_process = self.emulator("--object", "stone")
        daemon = self.idle_daemon(self.rig(self.rig_process.port))
        done = self.softgrip("start", "--wait", "config/sequences/pick_stone.yaml", timeout_s=60)
        self.assertIn("HOLDING", done.stdout)
        self.rig_process.ask("object out")
        failed = self.softgrip("start", "--wait", "config/sequences/pick_stone.yaml", expect=6, timeout_s=60)
        self.assertIn("NO PART", failed.stdout)


if __name__ == "__main__":
    bench.main()
