"""Cuts the connection in the middle of a grip. Tests which fault is latched and when, how the outputs change, and which
steps are necessary to continue."""

import bench


class Wire(bench.BenchTest):
    def holding(self, *emulator_arguments, changes=()):
        """Starts a daemon and waits until both fingers hold a stone."""
        self.rig_process = self.emulator("--object", "stone", *emulator_arguments)
        self.rig_file = self.rig(self.rig_process.port, changes)
        daemon = self.idle_daemon(self.rig_file)
        daemon.start("pick_stone")
        for channel in ("left", "right"):
            daemon.wait_for_event("grip_result", code="HOLDING", channel=channel)
        self.held_kpa = min(self.rig_process.commands_kpa())
        self.assertGreater(self.held_kpa, 10)
        return daemon

    def check_cycles_to_fault(self, recording):
        """Checks that the fault occurs in time. The rig file states the permitted number of cycles without a
        successful exchange."""
        rows = self.rows(recording, "left")
        faulted = next(i for i, row in enumerate(rows) if row["state"] == "faulted")
        missed = 0
        while missed < faulted and float(rows[faulted - missed]["age_s"]) > 1.5 / bench.RATE_HZ:
            missed += 1
        self.assertLessEqual(missed, bench.BUS_DOWN_CYCLES + 1, "cycles without a new reading up to the fault")
        self.assertGreaterEqual(missed, bench.BUS_DOWN_CYCLES // 2)

    def check_nothing_moves_until_started(self, daemon, rig_process, sequence="pick_stone"):
        """After the connection is restored, the rig must stay vented and faulted until an operator resets the fault. No
        finger may move until a new start."""
        bench.wait_for("the bus", lambda: daemon.status()["bus"]["connected"])
        for _ in range(20):
            self.assertEqual(daemon.status()["state"], "faulted")
            self.assertLess(max(rig_process.commands_kpa()), 0.1)
            bench.time.sleep(0.05)
        self.softgrip("start", "config/sequences/pick_stone.yaml", expect=5)
        self.softgrip("acknowledge")
        daemon.wait_for_state("idle")
        for _ in range(10):
            self.assertLess(max(rig_process.commands_kpa()), 0.1)
            bench.time.sleep(0.05)
        daemon.start(sequence)
        bench.wait_for("motion", lambda: min(rig_process.commands_kpa()) > 5)

    def test_a_disconnected_cable_latches_f101_and_the_watchdog_vents(self):
        daemon = self.holding("--faults", self.write("faults.yaml", "faults:\n  - {name: cut, kind: disconnect}\n"))
        self.rig_process.ask("fault cut")
        fault = daemon.wait_for_event("fault_latched")
        self.assertEqual(fault["code"], "F101")
        bench.wait_for("the board's watchdog", lambda: self.rig_process.status()["watchdog_tripped"])
        self.assertEqual(self.rig_process.commands_kpa(), [0, 0])
        self.assertEqual(daemon.results(), ["ERROR", "ERROR"])
        bench.wait_for("the end of the recording", lambda: not daemon.status()["recording"]["active"])
        self.check_cycles_to_fault(self.recordings()[0])
        self.rig_process.ask("clear cut")
        self.check_nothing_moves_until_started(daemon, self.rig_process)

    def test_a_board_that_loses_power_latches_f101(self):
        daemon = self.holding()
        port = self.rig_process.port
        self.rig_process.kill()
        daemon.wait_for_event("fault_latched", code="F101")
        bench.wait_for("the end of the recording", lambda: not daemon.status()["recording"]["active"])
        self.check_cycles_to_fault(self.recordings()[0])
        # The fingers of the new emulator have never moved, so they have no creep. However, the model of the daemon
        # still predicts creep. A sequence that detects objects would therefore have to wait. A sequence that sets a
        # pressure and detects no objects starts immediately.
        again = self.emulator("--object", "stone", port=port, name="softgrip-rig-again")
        self.check_nothing_moves_until_started(daemon, again, "pressure_staircase")

    def test_lost_requests_latch_f101_or_f102_and_the_watchdog_vents(self):
        daemon = self.holding("--faults", self.write("faults.yaml", "faults:\n  - {name: cut, kind: lost_request}\n"))
        self.rig_process.ask("fault cut")
        fault = daemon.wait_for_event("fault_latched")
        self.assertIn(fault["code"], ("F101", "F102"))
        bench.wait_for("the board's watchdog", lambda: self.rig_process.status()["watchdog_tripped"])
        self.assertEqual(self.rig_process.commands_kpa(), [0, 0])
        self.rig_process.ask("clear cut")
        self.check_nothing_moves_until_started(daemon, self.rig_process)

    def test_a_board_without_a_watchdog_keeps_the_grip_if_the_risk_is_accepted(self):
        board = self.folder / "config/boards/adam-6024.yaml"
        text = board.read_text()
        board.write_text(text[:text.index("watchdog:")] + "watchdog: {kind: none}\n")
        words = "the outputs keep their last pressure when softgripd dies"
        daemon = self.holding("--faults", self.write("faults.yaml", "faults:\n  - {name: cut, kind: disconnect}\n"),
                              changes=((r"(safe_action: .*)", rf'\1\n  accept_no_watchdog: "{words}"'),))
        self.rig_process.ask("fault cut")
        daemon.wait_for_event("fault_latched", code="F101")
        bench.time.sleep(1)
        self.assertGreater(min(self.rig_process.commands_kpa()), self.held_kpa - 2, "holding: hold")
        self.rig_process.ask("clear cut")
        bench.wait_for("the bus", lambda: daemon.status()["bus"]["connected"])
        before_kpa = self.rig_process.commands_kpa()
        bench.time.sleep(1)
        self.assertEqual(daemon.status()["state"], "faulted")
        for before, after in zip(before_kpa, self.rig_process.commands_kpa()):
            self.assertAlmostEqual(before, after, delta=0.1)
        self.softgrip("acknowledge")
        self.softgrip("vent")
        bench.wait_for("vented valves", lambda: max(self.rig_process.commands_kpa()) < 0.1)


if __name__ == "__main__":
    bench.main()
