"""Makes the Nth call of a function fail, for N = 1, 2, 3 and so on until a run succeeds. This test runs the part that
takes less than a minute; scripts/fail_nth.sh runs all scenarios."""

import unittest

import fail_nth


@unittest.skipUnless(fail_nth.SHIM.exists(), "the shim is not built: a sanitizer's runtime must be loaded first")
class FailNth(unittest.TestCase):
    def setUp(self):
        self.scenario = fail_nth.Scenario()
        self.addCleanup(self.scenario.close)

    def check(self, scenario, *calls, from_then_on=False):
        for call in calls:
            with self.subTest(call):
                failed, through = fail_nth.until_success(scenario, call, from_then_on=from_then_on)
                self.assertTrue(through, f"after {failed} failed calls the run has still not succeeded")

    def test_the_daemon_handles_each_failed_file_call(self):
        self.check(self.scenario.virtual, "write", "short_write", "rename", "mkdir")

    def test_daemon_and_simulate_handle_a_disk_that_fills_at_any_write(self):
        self.check(self.scenario.virtual, "write", from_then_on=True)
        self.check(self.scenario.simulate, "write", from_then_on=True)

    def test_simulate_and_validate_handle_each_failed_file_call(self):
        self.check(self.scenario.simulate, "open", "write", "short_write", "rename")
        self.check(self.scenario.validate, "write", "rename", "mkdir")

    def test_the_daemon_handles_each_failed_thread_start(self):
        self.check(self.scenario.real, "thread")

    def test_the_daemon_handles_failed_bind_listen_and_mlockall_calls(self):
        self.check(self.scenario.real, "bind", "listen", "mlockall")


if __name__ == "__main__":
    unittest.main(verbosity=2)
