"""Tests faults of sensors, pressure lines and outputs while a finger moves."""

import time

import bench

FAULTS = """faults:
  - {name: stuck, kind: sensor_stuck, channel: left}
  - {name: jumping, kind: sensor_jumping, by_mm: 15, interval_s: 1, channel: right}
  - {name: unsteady, kind: sensor_jumping, by_mm: 5, interval_s: 0.1, channel: right}
  - {name: blind, kind: sensor_out_of_range, channel: right}
  - {name: ignored, kind: ignored_write}
  - {name: leak, kind: line_leaking, share: 0.5, channel: left}
  - {name: blocked, kind: line_blocked, channel: left}
"""


class PlantFaults(bench.BenchTest):
    def tracking(self, changes=()):
        """Starts a daemon with a sequence in which both fingers track a sine."""
        self.emulated = self.emulator("--faults", self.write("faults.yaml", FAULTS))
        daemon = self.idle_daemon(self.rig(self.emulated.port, changes))
        daemon.start("track_sine")
        daemon.wait_for_event("step_started", code="1")
        return daemon

    def check_latches(self, fault, codes, channel, changes=()):
        daemon = self.tracking(changes)
        self.emulated.ask(f"fault {fault}")
        latched = daemon.wait_for_event("fault_latched")
        self.assertIn(latched["code"], codes, daemon.errors())
        if channel is not None:
            self.assertEqual(latched["channel"], channel)
        self.assertEqual(daemon.wait_for_event("sequence_finished")["code"], "faulted")
        self.assertEqual(daemon.results(), ["ERROR", "ERROR"])
        return daemon

    def test_a_stuck_sensor_causes_fault_f205_while_the_command_changes(self):
        self.check_latches("stuck", ("F205",), "left")
        bench.wait_for("vented valves", lambda: max(self.emulated.commands_kpa()) < 0.1)

    def test_a_sensor_that_jumps_by_15_mm_causes_fault_f204(self):
        # The sensor jumps by 15 mm. At 100 mm/s, a finger needs 15 cycles for this distance, so the daemon rejects the
        # reading for 15 cycles.
        self.check_latches("jumping", ("F204",), "right", ((r"max_speed_mm_per_s: \d+", "max_speed_mm_per_s: 100"),
                                                           (r"invalid_reading_cycles: \d+", "invalid_reading_cycles: 10")))

    def test_a_sensor_that_jumps_ten_times_per_second_causes_fault_f204(self):
        # Each jump of 5 mm is slower than max_speed_mm_per_s, so the daemon rejects no single reading.
        self.check_latches("unsteady", ("F204",), "right")

    def test_an_unsteady_reading_can_be_configured_as_a_warning(self):
        daemon = self.tracking(((r"unsteady_is_fault: true", "unsteady_is_fault: false"),
                                (r"displacement_margin_mm: 2", "displacement_margin_mm: 20")))
        self.emulated.ask("fault unsteady")
        told = daemon.wait_for_event("reading_unsteady")
        self.assertEqual((told["channel"], told["severity"]), ("right", "warning"))
        self.emulated.ask("clear unsteady")
        daemon.wait_for_event("reading_steady", channel="right")

    def test_a_slipping_part_is_not_reported_as_an_unsteady_reading(self):
        emulated = self.emulator("--object", "stone")
        daemon = self.idle_daemon(self.rig(emulated.port))
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING")
        for place in ("13:0.1", "14:0.1", "12:0.1"):
            emulated.ask(f"object {place}")
            time.sleep(0.3)
        emulated.ask("object out")
        daemon.wait_for_event("sequence_finished")
        kinds = {event["kind"] for event in daemon.events()}
        self.assertNotIn("reading_unsteady", kinds)
        self.assertNotIn("fault_latched", kinds)

    def test_a_sensor_out_of_range_causes_fault_f202_or_f203(self):
        self.check_latches("blind", ("F202", "F203"), "right")

    def test_ignored_writes_cause_fault_f301_or_f302(self):
        self.check_latches("ignored", ("F301", "F302"), None)

    def test_a_leaking_line_with_measured_pressure_causes_fault_f207(self):
        self.check_latches("leak", ("F207",), "left")

    def test_a_blocked_line_with_measured_pressure_causes_fault_f207(self):
        self.check_latches("blocked", ("F207",), "left")

    # Without a measured pressure, the model is the only way to detect a leak or a lost pressure.
    UNWATCHED = ((r"pressure_cycles: \d+", "pressure_cycles: 0"),)

    def test_a_leaking_line_makes_the_model_unfit(self):
        daemon = self.tracking(self.UNWATCHED)
        self.emulated.ask("fault leak")
        daemon.wait_for_event("model_health_changed", channel="left", code="unfit")

    def test_a_blocked_line_makes_the_model_unfit(self):
        daemon = self.tracking(self.UNWATCHED)
        self.emulated.ask("fault blocked")
        daemon.wait_for_event("model_health_changed", channel="left", code="unfit")


if __name__ == "__main__":
    bench.main()
