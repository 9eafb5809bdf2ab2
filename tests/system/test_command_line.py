"""Tests the programs as a user sees them: exit codes, messages, JSON and the live view."""

import json
import os
import pty
import select
import socket
import subprocess
import time

import bench
import plc
import web


class Offline(bench.BenchTest):
    """Tests the commands that need no daemon."""

    def simulate(self, *arguments, model="bench_twin", expect=0):
        return self.softgrip("simulate", "--model", f"config/models/{model}.yaml", *arguments, expect=expect)

    def test_simulate_with_the_same_seed_writes_the_same_bytes(self):
        for name, seed in (("a", 7), ("b", 7), ("c", 8)):
            self.simulate("--input", "tp1", "--out", f"{name}.csv", "--noise-mm", "0.05", "--seed", seed)
        a, b, c = ((self.folder / f"{name}.csv").read_bytes() for name in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)
        self.assertTrue(a.startswith(b"time_s,pressure_command_kpa,displacement_mm\n0,0,"))

    def test_simulate_keeps_the_times_of_the_input_log(self):
        self.write("log.csv", "time_s,pressure_command_kpa\n0,0\n0.5,20\n0.7,20\n4,0\n")
        done = self.simulate("--input", "log.csv", "--out", "-")
        rows = [line.split(",") for line in done.stdout.splitlines()]
        self.assertEqual([row[0] for row in rows], ["time_s", "0", "0.5", "0.7", "4"])
        self.assertGreater(float(rows[3][2]), 1)

    def test_simulate_rejects_invalid_options_models_and_inputs(self):
        self.simulate("--input", "tp1", expect=2)
        for number in ("-1", "nan", "inf", "x", "0", "1e9", "10 Hz"):
            self.simulate("--input", "tp1", "--out", "a.csv", "--rate-hz", number, expect=2)
        self.simulate("--input", "tp1", "--out", "a.csv", "--noise-mm", "nan", expect=2)
        self.simulate("--input", "tp1", "--out", "a.csv", model="none", expect=4)
        self.assertIn("signals are tp1", self.simulate("--input", "tp9", "--out", "a.csv", expect=4).stderr)
        self.write("config/models/bad.yaml", "name: bad\nsource: x\nactuator:\n  - bouc_wenn: {}\n")
        bad = self.simulate("--input", "tp1", "--out", "a.csv", model="bad", expect=3)
        self.assertIn("bad.yaml:4:5", bad.stderr)
        self.assertIn("1 error\n", bad.stderr, "no further error about the missing element")
        self.write("config/models/bad.yaml", "name: bad\nsource: x\nactuator: []\n")
        self.assertIn("the actuator has no element", self.simulate("--input", "tp1", "--out", "a.csv", model="bad",
                                                                   expect=3).stderr)
        self.write("bad.csv", "time_s,pressure_command_kpa,displacement_mm\n0,0,0\n1,x,0\n")
        self.assertIn("bad.csv:3:3", self.simulate("--input", "bad.csv", "--out", "a.csv", expect=3).stderr)
        self.assertFalse((self.folder / "a.csv").exists())

    def test_calibrate_rejects_a_duration_before_it_connects(self):
        calibrate = ("calibrate", "--rig", "config/rig_tcp.yaml", "--channel", "left", "--dead-zone", "--move")
        for option in ("--settle-s", "--average-s", "--ramp-s"):
            self.assertIn("'nan'", self.softgrip(*calibrate, option, "nan", expect=2).stderr)
        told = self.softgrip(*calibrate, "--ramp-s", "2", expect=2).stderr
        self.assertIn("--ramp-s 2 is too short: state at least 5 (10 times pressure_delay_s of the rig file)", told)

    def test_diagnose_and_investigate_reject_nan(self):
        self.simulate("--input", "tp1", "--out", "log.csv")
        files = ("--model", "config/models/bench_twin.yaml", "--data", "log.csv", "--out", "result")
        for command in ("diagnose", "investigate"):
            for option in ("--slew-kpa-per-s", "--pressure-max-kpa"):
                self.assertIn("'nan' is not a number above 0", self.softgrip(command, *files, option, "nan", expect=2).stderr)
        self.assertIn("'nan'", self.softgrip("investigate", *files, "--budget-minutes", "nan", expect=2).stderr)

    def test_investigate_refuses_logs_that_contain_only_vacuum(self):
        self.simulate("--input", "tp1", "--out", "log.csv")
        header, *rows = (self.folder / "log.csv").read_text().splitlines()
        names = header.split(",")
        self.assertEqual(names[:3], ["time_s", "pressure_command_kpa", "displacement_mm"])
        negative = [",".join([t, str(-float(p)), str(-float(y)), *rest]) for t, p, y, *rest in (r.split(",") for r in rows)]
        self.write("vacuum.csv", "\n".join([header, *negative]) + "\n")
        done = self.softgrip("investigate", "--model", "config/models/bench_twin.yaml", "--data", "vacuum.csv", "--out", "result",
                             "--rig-command", "true", "--yes", expect=3)
        self.assertIn("the logs contain no pressure above 0", done.stderr)

    def test_check_reports_all_problems_of_a_file(self):
        files = sorted((self.folder / "config").rglob("*.yaml"))
        # The sequence of the vacuum rig is valid for the vacuum rig only.
        vacuum = [path for path in files if "vacuum" in path.parts]
        good = self.softgrip("check", *(path for path in files if path not in vacuum))
        self.assertIn("rig 'bench': ok", good.stdout)
        self.assertIn("rig 'vacuum_bench': ok", self.softgrip("check", *vacuum).stdout)
        self.assertRegex(self.softgrip("check", "config/rig.yaml", *vacuum, expect=3).stderr,
                         r"allows 0 to 60 kPa.* \(rig file config/rig.yaml\)")
        self.write("bad.yaml", "name: bad\nsource: x\nvalve:\n  - transport_delay: {delay: 1}\nactuatr: []\n")
        bad = self.softgrip("check", "bad.yaml", "--json", expect=3)
        report = json.loads(bad.stdout)
        self.assertFalse(report["accepted"])
        self.assertGreater(len(report["problems"]), 1)
        self.assertIn("bad.yaml:4:", self.softgrip("check", "bad.yaml", expect=3).stderr)
        self.softgrip("check", "absent.yaml", expect=4)
        self.softgrip("check", expect=2)

    def test_run_in_virtual_time_writes_reproducible_recordings(self):
        for name in "ab":
            done = self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--record", name)
            self.assertIn("left: RELEASED", done.stdout)
        for file in ("run.csv", "run.json"):
            self.assertEqual(*((self.folder / name / file).read_bytes() for name in "ab"))

    def test_run_exits_with_code_6_if_a_grip_fails(self):
        rig = self.folder / "config/rig.yaml"
        lines = [line for line in rig.read_text().splitlines() if "object:" not in line]
        rig.write_text("\n".join(lines) + "\n")
        done = self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--quiet", "--record", "r",
                             expect=6)
        self.assertIn("left: NO PART", done.stdout)
        self.softgrip("run", "config/rig.yaml", expect=3)
        self.softgrip("run", "absent.yaml", expect=4)

    def test_client_commands_state_how_to_start_a_missing_daemon(self):
        for command in ("status", "watch", "stop", "vent", "acknowledge", "events"):
            done = self.softgrip(command, expect=4)
            self.assertIn("softgripd --config", done.stderr)
        self.softgrip("nonsense", expect=2)
        self.softgrip(expect=2)
        self.assertIn("did you mean `published`?", self.softgrip("study", "publishd", expect=2).stderr)
        self.assertIn("'many' is not a whole number from 0 to 100000",
                      self.softgrip("diagnose", "--nulls", "many", expect=2).stderr)
        self.assertIn("softgrip 0.", self.softgrip("--version").stdout)

    def test_the_emulator_rejects_invalid_options(self):
        def refused(code, *arguments):
            process = bench.Process("refused", [bench.SOFTGRIP_RIG, "--model",
                                                self.folder / "config/models/bench_twin.yaml", *arguments], self.folder)
            self.processes.append(process)
            self.assertEqual(process.wait(), code, process.errors())
            return process.errors()

        self.assertIn("--allow-network", refused(2, "--bind", "0.0.0.0", "--tcp", "0"))
        self.assertIn("7E1", refused(2, "--rtu", "line", "--format", "7E1"))
        refused(2, "--rtu", "line", "--tcp", "0")
        self.assertIn("'70000' is not a whole number from 0 to 65535", refused(2, "--tcp", "70000"))
        refused(4, "--rtu", "absent/line")
        self.assertIn("stone", refused(2, "--object", "feather", "--tcp", "0"))
        self.assertIn("faults.yaml:2:", refused(3, "--tcp", "0", "--faults", self.write(
            "faults.yaml", "faults:\n  - {name: a, kind: noreply}\n")))
        refused(4, "--faults", "absent.yaml")
        refused(3, "--channels", "9")
        with socket.create_server(("127.0.0.1", 0)) as taken:
            self.assertIn("cannot listen", refused(4, "--tcp", taken.getsockname()[1]))
        model = self.folder / "config/models/bench_twin.yaml"
        self.assertIn("--model was given 3 times, but the rig has 2 channels", refused(2, "--model", model, "--model", model))

    def test_a_server_confirms_a_checked_configuration(self):
        for server, config in ((web.SOFTGRIP_WEB, "config/web.yaml"), (plc.SOFTGRIP_PLC, "config/plc.yaml")):
            done = subprocess.run([server, "--config", config, "--check"], cwd=self.folder, capture_output=True, text=True,
                                  timeout=bench.PATIENCE_S, check=True)
            self.assertEqual(done.stdout, f"{config}: ok\n")


class Online(bench.BenchTest):
    """Tests the commands that communicate with the daemon."""

    def setUp(self):
        super().setUp()
        self.emulated = self.emulator("--object", "stone")
        self.softgripd = self.idle_daemon(self.rig(self.emulated.port))

    def test_client_commands_start_observe_and_vent_a_grip(self):
        self.assertIn("idle", self.softgrip("status").stdout)
        self.assertEqual(json.loads(self.softgrip("status", "--json").stdout)["rig"], "bench")
        self.softgrip("stop", expect=5)
        self.assertIn("sequence.yaml:1:", self.softgrip(
            "start", self.write("sequence.yaml", "nme: x\nsteps: []\n"), expect=3).stderr)
        self.softgrip("start", "no_such_sequence", expect=3)

        self.softgripd.start("pick_stone")
        self.softgrip("start", "pick_stone", expect=5)
        self.softgripd.wait_for_event("grip_result", code="HOLDING", channel="left")
        lines = self.softgrip("watch", "--count", "3", "--rate-hz", "20").stdout.splitlines()
        self.assertEqual(len(lines), 3)
        self.assertIn("HOLDING", lines[-1])
        states = [json.loads(line) for line in self.softgrip("watch", "--count", "2", "--json").stdout.splitlines()]
        self.assertEqual(states[1]["channels"][0]["name"], "left")
        self.softgrip("vent")
        bench.wait_for("vented valves", lambda: max(self.emulated.commands_kpa()) < 0.1)
        told = self.softgrip("events", "--limit", "1000").stdout
        self.assertIn("HOLDING", told)
        kinds = [json.loads(line)["kind"] for line in self.softgrip("events", "--json").stdout.splitlines()]
        self.assertIn("sequence_finished", kinds)

    def live(self, environment, keys):
        """Runs `softgrip watch` on its own terminal. Returns everything that the program has written."""
        child, terminal = pty.fork()
        if child == 0:
            os.environ.update(environment, TERM="xterm", SOFTGRIP_SOCKET=str(self.softgripd.socket_path))
            os.execv(bench.SOFTGRIP, ["softgrip", "watch"])
        written = b""
        end = time.monotonic() + bench.PATIENCE_S
        while time.monotonic() < end:
            if terminal in select.select([terminal], [], [], 0.2)[0]:
                try:
                    written += os.read(terminal, 65536)
                except OSError:
                    break  # the program has closed the terminal
            if written.count(b"\x1b[H") >= 3 and keys:
                os.write(terminal, keys)
                keys = b""
        _, status = os.waitpid(child, 0)
        os.close(terminal)
        self.assertEqual(os.waitstatus_to_exitcode(status), 0, written)
        return written

    def test_the_live_view_restores_the_terminal(self):
        for keys in (b"q", b"\x03"):  # ends the program with the key q and with Ctrl-C
            written = self.live({}, keys)
            self.assertIn(b"displacement", written)
            self.assertTrue(written.startswith(b"\x1b[?1049h\x1b[?25l"), written[:40])
            self.assertTrue(written.endswith(b"\x1b[?25h\x1b[?1049l"), written[-40:])
            self.assertIn(b"\x1b[1m", written)

    def test_the_live_view_has_no_colour_if_no_color_is_set(self):
        self.assertNotIn(b"m", set(self.escapes(self.live({"NO_COLOR": "1"}, b"q"))))

    @staticmethod
    def escapes(written):
        """Returns the last character of every escape sequence in an output."""
        for part in written.split(b"\x1b[")[1:]:
            for byte in part:
                if 0x40 <= byte <= 0x7e:
                    yield bytes([byte])
                    break


if __name__ == "__main__":
    bench.main()
