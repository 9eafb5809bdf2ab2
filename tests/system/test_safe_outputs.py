"""softgripd --safe-outputs: what the service manager runs after a crash, against a board without a watchdog."""

import os
import subprocess
import time

import bench


class SafeOutputs(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.emulator_ = self.emulator("--object", "stone", "--watchdog-s", "0")
        self.rig_ = self.rig(self.emulator_.port)

    def hold(self):
        daemon = self.daemon(self.rig_)
        daemon.wait_for_state("idle")
        daemon.start("pick_stone")
        daemon.wait_for_event("grip_result", code="HOLDING", channel="left")
        return daemon

    def safe_outputs(self, **environment):
        return subprocess.run([bench.SOFTGRIPD, "--config", self.rig_, "--safe-outputs"], capture_output=True, text=True,
                              timeout=bench.PATIENCE_S, env={**os.environ, **environment}, check=False)

    def test_after_a_kill_the_board_is_vented(self):
        self.hold().kill()
        time.sleep(0.5)
        self.assertGreater(min(self.emulator_.commands_kpa()), 10)  # nobody vents by himself
        ended = self.safe_outputs(SERVICE_RESULT="signal")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertIn("vented and confirmed", ended.stdout)
        self.assertEqual(max(self.emulator_.commands_kpa()), 0)

    def test_after_an_orderly_end_nothing_is_written(self):
        self.hold().kill()
        held = self.emulator_.commands_kpa()
        ended = self.safe_outputs(SERVICE_RESULT="success")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertEqual(self.emulator_.commands_kpa(), held)

    def test_beside_a_running_daemon_it_is_refused(self):
        daemon = self.hold()
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 5, ended.stdout + ended.stderr)
        self.assertGreater(min(self.emulator_.commands_kpa()), 10)
        self.assertEqual(daemon.status()["state"], "running")

    def test_a_board_that_is_gone_is_said(self):
        self.emulator_.kill()
        ended = self.safe_outputs()
        self.assertEqual(ended.returncode, 4, ended.stdout + ended.stderr)
        self.assertIn("not confirmed", ended.stdout)


if __name__ == "__main__":
    bench.main()
