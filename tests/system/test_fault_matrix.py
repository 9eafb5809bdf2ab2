"""Runs a part of the fault matrix in every test run: one fault of every group of faults, in every phase in which it
can have an effect.

scripts/fault_matrix.sh runs all cells.
"""

import unittest

import digital_lines
import fault_matrix


class FaultMatrix(unittest.TestCase):
    def check(self, *cells, vacuum=False):
        table = fault_matrix.Table()
        for cell in cells:
            name, phase = cell.split("/")
            self.assertIn((name, phase), table.cells())
            with self.subTest(cell):
                result = fault_matrix.run_cell(name, phase, attempts=3, vacuum=vacuum)
                if result["skipped"]:
                    self.skipTest(result["skipped"])
                self.assertIsNone(result["wrong"], f"{result['wrong']}\n{result['log']}")

    def test_connection_faults_while_connecting_and_idle_end_as_specified(self):
        self.check("masquerade/connect", "silent/idle", "exception_4/idle", "half_open/idle")

    def test_connection_faults_while_closing_end_as_specified(self):
        self.check("repetition/closing", "loss_of_replies/closing")

    def test_connection_faults_while_holding_end_as_specified(self):
        self.check("blocked_channel/holding")

    def test_unusual_board_behaviour_ends_as_specified(self):
        self.check("settling/connect", "request_repeated/closing", "requests_repeated/holding", "no_transaction_id/closing",
                   "few_registers/closing", "stray_bytes_over_tcp/holding")

    def test_outputs_that_differ_from_the_command_end_as_specified(self):
        self.check("asymmetric_information/closing", "received_by_some_only/venting")

    def test_sensor_faults_end_as_specified(self):
        self.check("sensor_jump/closing", "sensor_out_of_range/holding")

    def test_a_burst_line_and_a_lost_supply_end_as_specified(self):
        self.check("line_burst/closing", "supply_lost/holding")

    def test_pauses_of_process_and_loop_end_as_specified(self):
        self.check("process_above/holding", "loop_above/closing", "serial_loop_above/closing")

    def test_connection_faults_of_a_vacuum_rig_end_as_specified(self):
        self.check("silent/idle", "loss_of_requests/closing", "loss_of_replies/holding", "delay/venting", vacuum=True)

    def test_sensor_line_and_supply_faults_of_a_vacuum_rig_end_as_specified(self):
        self.check("sensor_out_of_range/holding", "line_burst/closing", "supply_lost/holding", vacuum=True)

    def test_pauses_of_a_vacuum_rig_end_as_specified(self):
        self.check("process_above/holding", "loop_above/closing", vacuum=True)

    @unittest.skipUnless(digital_lines.PRELOADED.exists(), "not built: a sanitizer's runtime must be loaded first")
    def test_digital_line_faults_end_as_specified(self):
        self.check("lines_emergency_stop/holding", "lines_emergency_stop_in_a_pause/closing", "lines_panel_above/closing")

    def test_every_cell_of_the_matrix_states_the_expected_end(self):
        table = fault_matrix.Table()
        for name, phase in table.cells():
            cell = table.cell(name, phase)
            self.assertIn(cell["ends"], ("waits", "faulted", "ridden", "unseen"), f"{name}/{phase}")
            if cell["ends"] in ("ridden", "unseen"):
                self.assertTrue(cell.get("why"), f"{name}/{phase} has no reason")
            if cell["ends"] == "faulted":
                self.assertTrue(cell["codes"])
                if "within" in cell:
                    self.assertGreater(table.bound(cell["within"]), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
