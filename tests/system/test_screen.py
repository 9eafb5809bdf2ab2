"""Tests the texts on the screen: the warning about remaining pressure, the sentences of refusals, and the events as a
journal."""

import json
import re

import bench


class Screen(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.emulated = self.emulator("--object", "stone", "--faults", self.write("faults.yaml", (
            "faults:\n  - {name: blind, kind: sensor_out_of_range, channel: left}\n")))
        self.softgripd = self.idle_daemon(self.rig(self.emulated.port))

    def hold(self):
        self.softgripd.start("hand_over")
        bench.wait_for("the hold", lambda: self.softgripd.results() == ["HOLDING", "HOLDING"])

    def test_remaining_pressure_after_a_stop_is_shown_until_the_release(self):
        self.assertIsNone(self.softgripd.status()["under_pressure"])
        self.hold()
        self.assertIsNone(self.softgripd.status()["under_pressure"], "the hold was requested, so it is not a problem")
        stopped = self.softgrip("stop").stdout
        self.assertRegex(stopped, r"stopping\nFingers are pressurised: left [\d.]+ kPa, right [\d.]+ kPa\. `softgrip release`")
        self.assertEqual(self.softgripd.status()["state"], "idle")
        self.assertEqual([one["name"] for one in self.softgripd.status()["under_pressure"]["channels"]],
                         ["left", "right"])
        for command in (("status",), ("watch", "--count", "1")):
            self.assertIn("UNDER PRESSURE", self.softgrip(*command).stdout)
        self.softgrip("release")
        bench.wait_for("vented valves", lambda: max(self.emulated.commands_kpa()) < 0.1)
        bench.wait_for("the end of the warning about pressure",
                       lambda: self.softgripd.status()["under_pressure"] is None)
        self.assertNotIn("UNDER PRESSURE", self.softgrip("status").stdout)

    def test_a_fault_is_shown_with_finger_cause_and_remedy(self):
        self.emulated.ask("fault blind")
        self.softgripd.wait_for_state("faulted")
        fault = self.softgripd.status()["fault"]
        self.assertEqual((fault["code"], fault["channel"]), ("F202", "left"))
        self.assertEqual(fault["present"], {"code": "F202", "name": "reading_out_of_range", "channel": "left"})
        shown = self.softgrip("status").stdout
        self.assertIn("fault F202 of left  reading_out_of_range", shown)
        self.assertIn("The cause is still present: F202 reading_out_of_range of left.", shown)
        self.assertIn("faulted F202 of left", self.softgrip("watch", "--count", "1").stdout)
        self.assertIn("left: Fault F202 reading_out_of_range", self.softgrip("events").stdout)
        refused = self.softgrip("acknowledge", expect=5).stderr
        self.assertIn("still present: F202 reading_out_of_range of left. Read the display of the sensor", refused)

        self.emulated.ask("clear blind")
        bench.wait_for("the cause to go", lambda: self.softgripd.status()["fault"]["present"] is None)
        self.assertIn("The cause is gone: `softgrip acknowledge` clears the fault", self.softgrip("status").stdout)
        self.assertEqual(self.softgrip("acknowledge").stdout,
                         "acknowledged F202 reading_out_of_range of left; nothing moves until the next start\n")
        self.softgripd.wait_for_state("idle")
        self.assertIn("left: Fault F202 reading_out_of_range was acknowledged.", self.softgrip("events").stdout)

    def test_the_status_of_an_unreachable_board_states_the_attempts(self):
        self.softgripd.end()
        self.emulated.kill()
        away = self.daemon(self.rig(self.emulated.port))
        bench.wait_for("some attempts", lambda: away.status()["bus"]["attempts"] >= 3)
        status = away.status()
        self.assertFalse(status["bus"]["answered"])
        self.assertIn("Connection refused", status["bus"]["failure"])
        shown = self.softgrip("status").stdout
        self.assertRegex(" ".join(shown.split()), r"no response yet: \d+ connection attempts, one "
                                                  r"every [\d.]+ s\. .*Connection refused")
        self.assertIn("- mm, reference -", shown)
        self.assertIn("board NOT CONNECTED", self.softgrip("watch", "--count", "1").stdout)

    def test_a_refusal_states_its_reason_and_the_next_command(self):
        refused = self.softgrip("stop", expect=5).stderr
        self.assertIn("refused (R07): No sequence runs.", refused)
        self.assertIn("`softgrip release`", refused)

    def test_events_are_listed_in_order_and_filtered_by_options(self):
        self.hold()
        self.softgrip("vent")
        self.softgripd.wait_for_state("idle")
        self.softgripd.wait_for_event("recording_finished")  # waits for the last event of the recording
        every = self.softgrip("events", "--json").stdout.splitlines()
        told = [json.loads(line) for line in every]
        self.assertEqual([event["id"] for event in told], sorted(event["id"] for event in told))
        last = self.softgrip("events", "-n", "3").stdout.splitlines()
        self.assertEqual([int(line.split()[0]) for line in last], [event["id"] for event in told[-3:]])
        for line in last:
            self.assertRegex(line, r"^ *\d+  \d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3}  (information|warning|error) ")
        self.assertEqual(len(self.softgrip("events", "--since", str(told[2]["id"])).stdout.splitlines()),
                         len(told) - 3)
        self.assertEqual(self.softgrip("events", "--since", "1h", "--json").stdout.splitlines(), every)
        grave = self.softgrip("events", "--severity", "warning").stdout
        self.assertIsNone(re.search(r"  information ", grave))
        self.softgrip("events", "--since", "once", expect=2)


if __name__ == "__main__":
    bench.main()
