"""Tests a planned feedforward, from the rig file through to the recording."""

import math
import re

import bench

PLANNED = "feedforward: planned"
# The gains that softgrip tune --model config/models/zhang2025.yaml --feedforward none computes.
PID_ALONE = ((PLANNED, "feedforward: none"), ("kp_kpa_per_mm: 3.067", "kp_kpa_per_mm: 4.402"),
             ("ki_kpa_per_mm_s: 12.68", "ki_kpa_per_mm_s: 13.79"))
# The model and the gains of config/rig.yaml.
TWIN = (("models/zhang2025.yaml", "models/bench_twin.yaml"), ("kp_kpa_per_mm: 3.067", "kp_kpa_per_mm: 2.7"),
        ("ki_kpa_per_mm_s: 12.68", "ki_kpa_per_mm_s: 13"))


class Virtual(bench.BenchTest):
    """Tests a planned feedforward with softgrip run in virtual time."""

    def rig_with(self, *changes):
        text = (self.folder / "config/rig_planned.yaml").read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return self.write("config/changed.yaml", text)

    def play(self, rig, record, sequence="track_sine", expect=0):
        return self.softgrip("run", f"config/sequences/{sequence}.yaml", "--rig", rig, "--virtual-time", "--record",
                             record, "--quiet", expect=expect, timeout_s=120)

    def tracking_rmse_mm(self, *changes):
        record = f"run{len(list(self.folder.glob('run*')))}"
        self.play(self.rig_with(*changes), record)
        rows = [row for row in self.rows(self.folder / record, "left") if row["step"] == "1"]
        self.assertGreater(len(rows), 9000)
        squares = [(float(row["reference_mm"]) - float(row["displacement_mm"])) ** 2 for row in rows]
        return math.sqrt(sum(squares) / len(squares))

    def test_planned_tracking_of_zhang2025_is_3_times_better_than_pid_alone(self):
        planned, alone = self.tracking_rmse_mm(), self.tracking_rmse_mm(*PID_ALONE)
        print(f"zhang2025: planned {planned:.3f} mm, PID alone {alone:.3f} mm")
        self.assertGreater(alone, 3 * planned)

    def test_planned_tracking_of_bench_twin_is_3_times_better_than_pid_alone(self):
        planned, alone = self.tracking_rmse_mm(*TWIN), self.tracking_rmse_mm(*TWIN, (PLANNED, "feedforward: none"))
        print(f"bench_twin: planned {planned:.3f} mm, PID alone {alone:.3f} mm")
        self.assertGreater(alone, 3 * planned)

    def test_planned_runs_in_virtual_time_write_the_same_bytes(self):
        for name in "ab":
            self.play("config/rig_planned.yaml", name)
        for file in ("run.csv", "run.json"):
            self.assertEqual(*((self.folder / name / file).read_bytes() for name in "ab"))

    def test_a_planned_grip_without_a_part_is_reported_as_no_part(self):
        done = self.play("config/rig_planned.yaml", "r", sequence="pick_stone", expect=6)
        self.assertIn("left: NO PART", done.stdout)

    def test_too_fast_motion_gives_a_warning_and_too_long_motion_is_rejected(self):
        fast = self.write("fast.yaml", "name: fast\nsteps:\n  - move: {displacement_mm: 20, duration_s: 0.1}\n")
        done = self.softgrip("check", "config/rig_planned.yaml", fast)
        self.assertRegex(done.stderr, r"fast.yaml:3:\d+: warning: step 'move': the model of channel 'left' cannot follow")
        done = self.softgrip("run", fast, "--rig", "config/rig_planned.yaml", "--virtual-time", "--record", "r")
        self.assertIn("fast.yaml:3:", done.stderr)
        endless = self.write("endless.yaml", "name: endless\nsteps:\n  - move: {displacement_mm: 6, duration_s: 1}\n"
                             "  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.05, cycles: 900}\n")
        done = self.softgrip("run", endless, "--rig", "config/rig_planned.yaml", "--virtual-time", "--record", "e",
                             expect=3)
        self.assertIn("600 s of motion", done.stderr)
        self.assertFalse((self.folder / "e").exists())

    def test_the_error_for_a_model_without_an_inverse_suggests_planned(self):
        done = self.softgrip("check", self.rig_with((PLANNED, "feedforward: full_model")), expect=3)
        self.assertIn("use feedforward `planned`, which needs no inverse", done.stderr)


class Served(bench.BenchTest):
    """Tests a planned feedforward with a daemon in real time. A client starts the sequence over the socket."""

    def setUp(self):
        super().setUp()
        text = (self.folder / "config/rig_planned.yaml").read_text()
        for pattern, replacement in ((r"/tmp/softgrip-runs", f"{self.folder}/runs"),
                                     (r"/tmp/softgrip.sock", f"{self.folder}/softgripd.sock"),
                                     (r"real_time: .*", "real_time: {required: false, priority: 70, cpus: [], "
                                      "lock_memory: false}")):
            text, count = re.subn(pattern, replacement, text)
            self.assertEqual(count, 1, pattern)
        self.softgripd = self.idle_daemon(self.write("config/served.yaml", text))

    def test_a_planned_sequence_starts(self):
        self.softgrip("start", "track_sine")
        self.softgripd.wait_for_event("step_started")
        self.softgrip("vent")
        self.softgripd.wait_for_state("idle")

    def test_a_vent_aborts_the_computation_of_a_plan(self):
        long = ("name: long\nsteps:\n  - move: {displacement_mm: 6, duration_s: 1}\n"
                "  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.05, cycles: 29}\n")
        lines = bench.Lines(self.softgripd.socket_path)
        self.addCleanup(lines.close)
        lines.file.write('{"id": 1, "command": "start", "sequence": "long", "sequence_text": "'
                         + long.replace("\n", "\\n") + '"}\n')
        lines.file.flush()
        # The daemon must answer requests while it computes the plan.
        self.assertIn("idle", lines.ask('{"id": 2, "command": "status"}'))
        self.assertEqual(self.softgripd.ask("start", sequence="track_sine")["error"]["code"], "busy")
        self.softgripd.ask("vent")
        self.assertIn('"abandoned"', lines.file.readline())
        self.assertEqual(self.softgripd.status()["state"], "idle")
        self.assertFalse([e for e in self.softgripd.events() if e["kind"] == "sequence_started"])


if __name__ == "__main__":
    bench.main()
