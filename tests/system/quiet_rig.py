"""Runs a daemon on a simulated rig in which a pause of the machine causes no fault. Tests with failing clients use this
rig, so that no fault of the rig disturbs them."""

import re

import bench

LONG = "name: long\nsteps:\n  - move: {pressure_kpa: 5, duration_s: 90}\n"
SHORT = "name: short\nsteps:\n  - move: {pressure_kpa: 5, duration_s: 0.1}\n"


class QuietRigTest(bench.BenchTest):
    def setUp(self):
        super().setUp()
        text = (self.folder / "config/rig.yaml").read_text()
        for pattern, replacement in ((r"watchdog_timeout_s: [\d.]+", "watchdog_timeout_s: 30"),
                                     (r"max_missed_commands: \d+", "max_missed_commands: 1000"),
                                     (r"(bus_down|invalid_reading|readback|pressure)_cycles: \d+", r"\1_cycles: 1000"),
                                     (r"max_age_s: [\d.]+", "max_age_s: 10"),
                                     (r"cpus: \[1\]", "cpus: []"), (r"lock_memory: true", "lock_memory: false"),
                                     (r"timeout_s: 10\}", "timeout_s: 60}"),
                                     ("/tmp/softgrip-runs", f"{self.folder}/runs"),
                                     ("/tmp/softgrip.sock", f"{self.folder}/softgripd.sock")):
            text, count = re.subn(pattern, replacement, text)
            self.assertGreater(count, 0, pattern)
        self.softgripd = self.idle_daemon(self.write("config/quiet.yaml", text))
        self.path = str(self.softgripd.socket_path)

    def running(self):
        """Returns the request id of the running sequence, or None if no sequence runs."""
        sequence = self.softgripd.status()["sequence"]
        return sequence["request"] if sequence and sequence["ended"] is None else None

    def ended(self, request):
        """Returns the code with which the sequence with this request id has ended, or None if this sequence still
        runs."""
        for event in self.softgripd.events():
            if event["kind"] == "sequence_finished" and event["request"] == request:
                return event["code"]
        return None

    def wait_until_ended(self, request):
        return bench.wait_for(f"the end of request {request}", lambda: self.ended(request))
