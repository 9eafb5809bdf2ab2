"""Tests every connection fault that the emulator can simulate. A short fault must not stop the sequence. A lasting
fault must latch with the correct code."""

import bench

# Maps a permanent fault of the connection to the daemon faults that may be latched. An invalid reply ends the session.
# The last error of the daemon is then either the invalid reply or the failed attempt to open the next session.
WIRE = {
    "lost_request": ("", ("F101", "F102")),
    "no_reply": ("", ("F101", "F102")),
    "late_reply": ("delay_s: 0.4", ("F101", "F102", "F103")),
    "dripped_reply": ("interval_s: 0.05", ("F101", "F102")),
    "cut_reply": ("", ("F101", "F102", "F103")),
    "wrong_unit": ("", ("F101", "F103")),
    "wrong_transaction": ("", ("F101", "F103")),
    "wrong_length": ("", ("F101", "F102", "F103")),
    "exception_reply": ("code: 4", ("F104",)),
    "disconnect": ("", ("F101",)),
}


class WireFaults(bench.BenchTest):
    def setUp(self):
        super().setUp()
        lines = ["faults:"]
        for kind, (keys, _) in WIRE.items():
            more = ", " + keys if keys else ""
            lines.append(f"  - {{name: {kind}_once, kind: {kind}, replies: 1{more}}}")
            lines.append(f"  - {{name: {kind}_lasting, kind: {kind}{more}}}")
        lines.append("  - {name: repeated_reply_once, kind: repeated_reply, replies: 1}")
        self.emulated = self.emulator("--faults", self.write("faults.yaml", "\n".join(lines) + "\n"))
        self.softgripd = self.idle_daemon(self.rig(self.emulated.port))

    def fresh_readings(self):
        def fresh():
            status = self.softgripd.status()
            return status["bus"]["connected"] and all(
                channel["validity"] == "valid" and channel["age_s"] < 0.05 for channel in status["channels"])
        bench.wait_for("fresh readings", fresh)

    def test_a_single_bad_reply_causes_no_fault(self):
        for kind in (*WIRE, "repeated_reply"):
            if kind == "disconnect":
                continue  # a disconnect affects all replies until the test clears it
            with self.subTest(kind):
                before = self.softgripd.result("statistics")["bus"]["exchanges"]
                self.emulated.ask(f"fault {kind}_once")
                bench.wait_for("successful exchanges after the fault",
                               lambda: self.softgripd.result("statistics")["bus"]["exchanges"] > before + 10)
                self.fresh_readings()
                self.assertEqual(self.softgripd.status()["state"], "idle", self.softgripd.errors())
                # A late or repeated reply must not shift the later replies. The reading must therefore be that of the
                # finger.
                for channel in self.softgripd.status()["channels"]:
                    self.assertAlmostEqual(channel["displacement_mm"], 0, delta=0.3)

    def test_a_lasting_connection_fault_is_acknowledged_only_after_its_end(self):
        for kind, (_, codes) in WIRE.items():
            with self.subTest(kind):
                newest = self.softgripd.events()[-1]["id"]
                self.emulated.ask(f"fault {kind}_lasting")
                fault = self.softgripd.wait_for_event("fault_latched", since=newest)
                self.assertIn(fault["code"], codes, self.softgripd.errors())
                self.softgrip("acknowledge", expect=5)
                self.emulated.ask(f"clear {kind}_lasting")
                self.fresh_readings()
                self.softgrip("acknowledge")
                self.softgripd.wait_for_state("idle")


if __name__ == "__main__":
    bench.main()
