"""Provokes every ending of every command. The exit code must be the one in the table of docs/reference/exit-codes.md,
which this test reads."""

import os
import re
import signal
import subprocess
import unittest

import bench
import exit_codes
import fail_nth
from exit_codes import Command, ENDINGS, FullDisk, Runner, STOPPING, code_of

TWIN = "config/models/bench_twin.yaml"
FILE_COMMANDS = {
    "init": Command("init {out}/new.yaml --board simulated", "init config/rig.yaml --board simulated", "bench_twin.yaml",
                    "new.yaml", new=True),
    "check": Command("check config/rig.yaml", "check bad.yaml", "config/rig.yaml"),
    "simulate": Command(f"simulate --model {TWIN} --input tp1 --rate-hz 20 --out {{out}}/log.csv",
                        "simulate --model bad.yaml --input tp1 --out {out}/log.csv", "bench_twin.yaml", "log.csv"),
    "import": Command("import raw.csv --yes --out {out}/log.csv", "import bad.csv --yes --out {out}/log.csv", "raw.csv",
                      "log.csv"),
    "plot": Command("plot rec --out {out}/plot.svg", "plot bad.csv --out {out}/plot.svg", "run.csv", "plot.svg",
                    more=("plot rec --out {out}/plot.pdf", "plot rec --out {out}/plot.png", "plot rec --out {out}/plot.html")),
    "export": Command("export rec --out {out}/run.mat", "export bad.csv --out {out}/run.mat", "run.csv", "run.mat",
                      more=("export rec --out {out}/run.csv", "export rec --out {out}/run.mcap",
                            f"export {TWIN} --rate-hz 100 --out {{out}}/model.c")),
    "identify": Command("identify --data log.csv --starts 1 --threads 1 --out {out}/id --figures {out}/figures",
                        "identify --data bad.csv --out {out}/id", "log.csv", "id/identify.json"),
    "validate": Command(f"validate --model {TWIN} --data log.csv --out {{out}}/judged --figures {{out}}/figures",
                        f"validate --model {TWIN} --data bad.csv", "log.csv", "judged/validate.json"),
    "tune": Command(f"tune --model {TWIN} --draws 1 --out {{out}}/pid.yaml", "tune --model bad.yaml --out {out}/pid.yaml",
                    "bench_twin.yaml", "pid.yaml"),
    "diagnose": Command(f"diagnose --model {TWIN} --data log.csv --no-closed-loop --out {{out}}/di --figures {{out}}/figures",
                        f"diagnose --model {TWIN} --data bad.csv --out {{out}}/di", "log.csv", "di/diagnosis.json",
                        more=(f"diagnose --model {TWIN} --healthy log.csv --data other.csv --out {{out}}/change",)),
    "health": Command("health rec --baseline base --out {out}/health", "health rec --baseline spoilt", "baseline.json",
                      "health/health.json"),
    "study": Command("study control --draws 1 --frequencies-hz 0.5 --out {out}/study", "study nothing",
                     writes="study/control.json"),
    "report": Command("report --verify judged", "report --verify spoilt", "validate.json"),
    "completion": Command("completion bash", "completion tcsh"),
    "baseline": Command(f"baseline --data log.csv --model {TWIN} --out {{out}}/new.base",
                        f"baseline --data bad.csv --model {TWIN} --out {{out}}/new.base", "log.csv", "new.base/baseline.json",
                        new=True),
    "investigate": Command(f"investigate --model {TWIN} --data log.csv --rig config/rig.yaml --rig-channel left --yes "
                           "--no-closed-loop --out {out}/found",
                           f"investigate --model {TWIN} --data bad.csv --rig config/rig.yaml --rig-channel left --yes "
                           "--out {out}/found", "log.csv", "found/investigation.json"),
}
# Commands that send requests to the daemon. One daemon answers all of them in this order.
CLIENTS = {
    "status": Command("status"),
    "sequences": Command("sequences"),
    "events": Command("events"),
    "watch": Command("watch --count 2"),
    "start": Command("start pick_stone", "start no_such_sequence"),
    "stop": Command("stop", "stop"),
    "release": Command("release", "release"),
    "vent": Command("vent"),
    "acknowledge": Command("acknowledge", "acknowledge"),
    "start --wait": Command("start short.yaml --wait", "start short.yaml --wait"),
}
# Commands that move a rig. The test replaces `{rig}` by the rig file of an emulated board, and `{out}` by the folder of
# the outputs.
MOTION = {
    "run": Command("run short.yaml --rig {rig} --no-socket --record {out}/rec", "run bad.yaml --rig {rig} --no-socket",
                   writes="rec"),
    "calibrate": Command("calibrate --rig {rig} --channel left --move --valve --settle-s 0.3 --average-s 0.3 --out {out}/points.yaml",
                         "calibrate --rig bad.yaml --channel left --move", writes="points.yaml"),
    "doctor": Command("doctor --rig {rig} --move", "doctor --rig bad.yaml --move"),
    "baseline --rig": Command(f"baseline --rig {{rig}} --rig-channel left --model {TWIN} --experiments minor_loops --rest-s 0 --yes "
                              "--out {out}/base", "baseline --rig bad.yaml --rig-channel left --yes --out {out}/base", writes="base"),
}
# The experiments of this command take 2 minutes.
LONG = "baseline --rig"
SHORT = ("name: short\nsteps:\n  - move: {displacement_mm: 5, speed_mm_per_s: 10, settle_s: 0.5}\n"
         "  - release: {duration_s: 0.2, purge_s: 0.2, timeout_s: 5, on_fail: vent}\n")
NO_SPACE = "No space left on device|File too large"
NEEDS_SHIM = unittest.skipUnless(fail_nth.SHIM.exists(), "the shim is not built: a sanitizer's runtime must be loaded first")


class Page(unittest.TestCase):
    def test_the_table_lists_every_tested_command_with_valid_codes(self):
        table = exit_codes.table()
        self.assertEqual(set(table), set(FILE_COMMANDS) | set(CLIENTS) | set(MOTION) | set(exit_codes.ELSEWHERE))
        for command, cells in table.items():
            self.assertEqual(set(cells), set(ENDINGS))
            for cell in cells.values():
                self.assertRegex(cell, r"^([0-6]|signal|-)$", command)

    def test_the_table_has_every_command_of_the_program(self):
        told = subprocess.run([bench.SOFTGRIP, "--help"], capture_output=True, text=True, check=True).stdout
        commands = set(re.findall(r"^  ([a-z]+) ", told.partition("Subcommands:\n")[2], re.M))
        self.assertGreater(len(commands), 20)
        self.assertEqual({row.split()[0] for row in exit_codes.table()} & commands, commands)


class UnreadableFiles(bench.BenchTest):
    """Gives every program that reads configuration files a missing file and a folder in place of each file."""

    CALLS = (
        "{softgripd} --config {file}", "{softgripd} --config {file} --check", "{softgripd} --config {file} --safe-outputs",
        "{softgripd} --config {file} --device gpiochip0", "{softgripd} --config config/rig.yaml --sequence {file}",
        "{softgripd} --config config/rig.yaml --sequence {file} --check",
        "{softgrip} run {file} --rig config/rig.yaml --virtual-time",
        "{softgrip} run config/sequences/pick_stone.yaml --rig {file} --virtual-time",
        "{softgrip} simulate --model {file} --input tp1 --out log.csv", "{softgrip} doctor --rig {file}",
        "{softgrip} calibrate --rig {file} --channel left", "{softgrip} baseline --rig {file} --out base",
        "{softgrip} tune --model {file} --out pid.yaml",
        "{rig} --model {file}", f"{{rig}} --model {TWIN} --rig {{file}}", f"{{rig}} --model {TWIN} --faults {{file}}",
        f"{{rig}} --model {TWIN} --board {{file}}", "{plc} --config {file}", "{plc} --config {file} --check",
        "{web} --config {file}", "{web} --config {file} --check",
    )

    def test_a_missing_file_and_a_folder_are_input_errors(self):
        (self.folder / "folder.yaml").mkdir()
        tools = bench.BUILD / "tools"
        for call in self.CALLS:
            for file in ("absent.yaml", "folder.yaml"):
                words = call.format(softgripd=bench.SOFTGRIPD, softgrip=bench.SOFTGRIP, rig=bench.SOFTGRIP_RIG,
                                    plc=tools / "softgrip-plc", web=tools / "softgrip-web", file=file).split()
                with self.subTest(call, file=file):
                    done = subprocess.run(words, cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                          timeout=bench.PATIENCE_S)
                    self.assertEqual(done.returncode, 4, done.stderr)
                    self.assertIn(file, done.stderr)


class EndingsTest(bench.BenchTest):
    """Runs commands and compares their exit codes with the table."""

    def setUp(self):
        super().setUp()
        self.table = exit_codes.table()
        self.runner = Runner(self.folder)

    def ended(self, done, cell, number=None):
        said = "" if done.stderr is None else done.stderr.decode(errors="replace")[-1500:]
        self.assertEqual(done.returncode, code_of(cell, number), f"{done.args}\n{said}")

    def full_disk(self):
        disk = FullDisk(self.folder / "full")
        self.addCleanup(disk.close)
        return disk

    def run_onto(self, disk, line):
        """Runs a command whose standard output is a file on the full disk."""
        with open(disk.folder / "output", "ab") as output:
            return self.runner.run(line, stdout=output, preexec_fn=disk.limit)


class FileCommands(EndingsTest):
    """Tests the commands that read and write files."""

    def setUp(self):
        super().setUp()
        self.write("bad.csv", "nothing\nthat,is\na,log\n")
        self.write("bad.yaml", "name: bad\nvalve: 3\n")
        for folder in ("spoilt", "out"):
            (self.folder / folder).mkdir()
        self.write("spoilt/baseline.json", '{"logs": 3, "model": []}')
        self.write("spoilt/validate.json", '{"call": {"validate": 1}, "software": []}')
        for seed, log in ((3, "log.csv"), (4, "other.csv")):
            self.softgrip("simulate", "--model", TWIN, "--input", "steps", "--rate-hz", "20", "--noise-mm", "0.05", "--seed",
                          seed, "--out", log)
        header, *rows = (self.folder / "log.csv").read_text().splitlines()
        self.write("raw.csv", "\n".join(["t [s];set [kPa];tip [mm]", *(row.replace(",", ";") for row in rows)]) + "\n")
        self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--record", "rec", "--no-socket")
        self.softgrip("validate", "--model", TWIN, "--data", "log.csv", "--out", "judged")
        self.softgrip("baseline", "--data", "log.csv", "--model", TWIN, "--out", "base")

    def each(self, ending, check):
        exit_codes.each(self, FILE_COMMANDS, ending, check)

    @NEEDS_SHIM
    def test_a_successful_command_replaces_its_output_files_atomically(self):
        def check(name, command, cell):
            for line in (command.done, *command.more):
                done, created = self.runner.created(line)
                self.ended(done, cell)
                own = [path for path in created if not exit_codes.TEMPORARY.search(path)]
                self.assertEqual([path for path in own if not exit_codes.GROWING.search(path)], [], line)
                if command.writes:
                    self.assertTrue((self.folder / "out" / command.writes).exists(), line)
                    self.assertGreater(len(created), len(own), "the command must write something")

        self.each("done", check)
        self.assertEqual(list(self.folder.rglob(".softgrip-*")), [])

    def test_a_refused_command_exits_with_the_listed_code(self):
        def check(name, command, cell):
            done = self.runner.run(command.refused)
            self.ended(done, cell)
            said = done.stderr.decode()
            self.assertGreater(len(said.strip()), 20, "the command must say why in a sentence")
            self.assertNotIn("exception", said)
            self.assertNotIn("[json", said)

        self.each("refused", check)
        self.assertEqual(list((self.folder / "out").iterdir()), [])

    @NEEDS_SHIM
    def test_a_signal_ends_a_command_with_the_listed_code(self):
        def check(name, command, cell):
            for number in STOPPING:
                if command.hangs_at:
                    code = self.runner.stopped(command.done, number, command.hangs_at)
                elif command.writes:
                    code = self.runner.waiting(command.done, number)
                else:
                    code = self.runner.blocked(command.done, number)
                self.assertEqual(code, code_of(cell, number), f"{name}, signal {number}")

        self.each("signal", check)
        self.assertEqual([path for path in (self.folder / "out").rglob("*") if path.is_file()], [])

    def test_a_full_disk_ends_a_command_with_the_listed_code(self):
        disk = self.full_disk()
        def put_an_old_file(name, command, _):
            path = disk.folder / (command.writes or "output")
            path.parent.mkdir(exist_ok=True)
            if not command.new:
                # an empty file occupies no block of the disk, so the full disk has no space for the output
                path.write_text("old\n" if command.writes else "")

        self.each("full disk", put_an_old_file)
        disk.fill()
        def check(name, command, cell):
            path = disk.folder / (command.writes or "output")
            if command.writes:
                for line in (command.done, *command.more):
                    done = self.runner.run(line, "full", preexec_fn=disk.limit)
                    self.ended(done, cell)
                    self.assertRegex(done.stderr.decode(), NO_SPACE, line)
                self.assertEqual(path.read_text() if path.exists() else "", "" if command.new else "old\n", name)
            else:
                done = self.run_onto(disk, command.done)
                self.ended(done, cell)
                self.assertIn("cannot write to the standard output: ", done.stderr.decode())

        self.each("full disk", check)
        self.assertEqual(list(disk.folder.rglob(".softgrip-*")), [], "no incomplete file may remain")

    def test_a_closed_pipe_ends_a_command_with_the_listed_code(self):
        def check(name, command, cell):
            self.ended(self.runner.unread(command.done, ignored=False), cell, signal.SIGPIPE)
            if name != "study":
                done = self.runner.unread(command.done.replace("/new.", "/newer."), ignored=True)
                self.ended(done, "4")
                self.assertIn("standard output", done.stderr.decode())

        self.each("closed pipe", check)


class Clients(EndingsTest):
    """Tests the commands that send requests to the daemon."""

    def setUp(self):
        super().setUp()
        self.start_rig()
        self.write("short.yaml", SHORT)

    def ready_for(self, name):
        """Brings the daemon into a state in which the command has an effect."""
        if name in ("stop", "release", "vent"):
            self.softgripd.start("pick_stone")
            if name != "stop":
                self.softgripd.wait_for_event("grip_result", since=self.since, code="HOLDING", channel="left")
        elif name == "acknowledge":
            self.softgripd.start("pick_stone")
            self.softgripd.wait_for_event("grip_result", since=self.since, code="HOLDING", channel="left")
            self.settle()

    def settle(self):
        if self.softgripd.status()["state"] != "idle":
            self.softgripd.ask("vent")
        self.softgripd.wait_for_state("idle")
        bench.wait_for("fingers at rest", lambda: max(self.board.pressures_kpa()) < 0.5)
        self.since = self.softgripd.events()[-1]["id"]

    def each(self, ending, check):
        exit_codes.each(self, CLIENTS, ending, check)

    def test_a_successful_client_exits_with_the_listed_code(self):
        def check(name, command, cell):
            self.settle()
            self.ready_for(name)
            self.ended(self.runner.run(command.done), cell)

        self.each("done", check)

    def test_a_refused_client_exits_with_the_listed_code(self):
        def check(name, command, cell):
            self.settle()
            if name == "start --wait":
                self.softgripd.start("pick_stone")
            self.ended(self.runner.run(command.refused), cell)

        self.each("refused", check)

    def test_a_sequence_that_is_too_large_to_be_sent_is_refused_with_exit_code_3(self):
        self.settle()
        self.write("large.yaml", SHORT + "# a long comment\n" * 6000)
        for line in ("start large.yaml", "start large.yaml --wait"):
            done = self.runner.run(line)
            self.ended(done, 3)
            self.assertIn(b"large.yaml: the sequence is too large", done.stderr)
            self.assertIn(b"at most 65536 bytes", done.stderr)
            self.assertNotIn(b"stopped", done.stderr)
        self.assertNotIn("sequence_started", {event["kind"] for event in self.softgripd.events(self.since)})

    def test_a_signal_ends_a_client_with_the_listed_code(self):
        for number in STOPPING:
            self.settle()
            for name, line in (("watch", "watch"), ("start --wait", "start pick_stone --wait")):
                self.assertEqual(self.runner.waiting(line, number, pause_s=1), code_of(self.table[name]["signal"], number), name)
        self.assertNotEqual(self.softgripd.status()["state"], "faulted", "the rig continues")
        self.softgripd.send(signal.SIGSTOP)
        self.addCleanup(self.softgripd.send, signal.SIGCONT)
        def check(name, command, cell):
            if name not in ("watch", "start --wait"):
                for number in STOPPING:
                    self.assertEqual(self.runner.waiting(command.done, number), code_of(cell, number), name)

        self.each("signal", check)

    def test_a_fault_ends_a_client_with_the_listed_code(self):
        self.settle()
        # The board stops responding while a command waits for the end of a sequence.
        child = subprocess.Popen(Runner.words("start pick_stone --wait", ""), cwd=self.folder, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=self.runner.environment)
        with child:
            self.softgripd.wait_for_state("running")
            self.board.kill()
            self.assertEqual(child.wait(bench.PATIENCE_S), code_of(self.table["start --wait"]["fault"]))
        self.softgripd.end()
        def check(name, command, cell):
            if name != "start --wait":
                self.ended(self.runner.run(command.done), cell)

        self.each("fault", check)

    def test_a_full_disk_ends_a_client_with_the_listed_code(self):
        disk = self.full_disk()
        disk.fill()
        def check(name, command, cell):
            self.settle()
            self.ready_for(name)
            done = self.run_onto(disk, command.done)
            self.ended(done, cell)
            self.assertIn("standard output", done.stderr.decode())
            self.carried_out(name)

        self.each("full disk", check)

    def test_a_closed_pipe_ends_a_client_with_the_listed_code(self):
        def check(name, command, cell):
            for ignored in (False, True):
                self.settle()
                self.ready_for(name)
                self.ended(self.runner.unread(command.done, ignored), "4" if ignored else cell, signal.SIGPIPE)
                self.carried_out(name)

        self.each("closed pipe", check)

    def carried_out(self, name):
        """Checks that the command has moved the finger. The sentence that reports the motion may be on standard
        output or standard error."""
        if name in ("stop", "vent", "release"):
            self.softgripd.wait_for_state("idle", "stopping", "holding")
            self.softgripd.wait_for_event("sequence_finished", since=self.since)


class Motion(EndingsTest):
    """Tests the commands that move a rig. After any ending of a command, the outputs must be safe."""

    def setUp(self):
        super().setUp()
        self.write("short.yaml", SHORT)
        self.write("bad.yaml", "name: bad\nvalve: 3\n")
        (self.folder / "out").mkdir()
        self.faults = self.write("faults.yaml", "faults:\n  - {name: blind, kind: sensor_out_of_range, channel: left}\n")
        self.use_rested_fingers()
        self.count = 0

    def use_rested_fingers(self, name="softgrip-rig"):
        """Starts a new rig whose fingers have never been under pressure. After a pressure, a finger would creep for a
        minute, and this creep would disturb the comparison of the finger with the model."""
        self.board = self.emulator("--faults", self.faults, name=name)
        self.rig_path = self.rig(self.board.port).rename(self.folder / "config" / f"{name}.yaml")

    def each(self, ending, check, without=None):
        exit_codes.each(self, {name: command for name, command in MOTION.items() if name != without}, ending, check)

    def line(self, command, out="out", rig="softgrip-rig"):
        """Returns the words of the command line, with the rig file and the folders of this test."""
        self.use_rested_fingers(rig)
        self.count += 1
        (self.folder / out / str(self.count)).mkdir()
        return command.done.format(rig=self.rig_path, out=f"{out}/{self.count}")

    def check_safe(self, name):
        self.assertLess(max(self.board.commands_kpa()), 0.1, f"{name} has ended, and a finger is under pressure")

    def working(self, line, **keys):
        """Starts the command. Returns its process as soon as the command has raised a pressure."""
        child = subprocess.Popen(Runner.words(line, ""), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, env=self.runner.environment, **keys)
        self.addCleanup(child.kill)
        bench.wait_for(f"{line} to move the rig", lambda: child.poll() is not None or max(self.board.commands_kpa()) > 2,
                       pause_s=0.005)
        return child

    def test_a_refused_motion_exits_with_the_listed_code(self):
        def check(name, command, cell):
            self.ended(self.runner.run(command.refused.format(rig=self.rig_path, out="out")), cell)

        self.each("refused", check)

    def test_a_signal_ends_a_motion_with_the_listed_code_and_safe_outputs(self):
        def check(name, command, cell):
            for number in STOPPING:
                child = self.working(self.line(command))
                child.send_signal(number)
                said = child.communicate(timeout=bench.PATIENCE_S)[1].decode()
                self.assertEqual(child.returncode, code_of(cell, number), f"{name}, signal {number}: {said[-1500:]}")
                self.check_safe(name)

        self.each("signal", check)

    def test_a_lost_board_ends_a_motion_with_the_listed_code(self):
        self.assertEqual({name: cells[0] for name, cells in exit_codes.motion_faults().items()},
                         {name: self.table[name]["fault"] for name in MOTION})
        def check(name, command, cell):
            child = self.working(self.line(command))
            self.board.kill()
            said = child.communicate(timeout=bench.PATIENCE_S)[1].decode()
            self.assertEqual(child.returncode, code_of(cell), f"{name}: {said[-1500:]}")
            self.board.control.close()
            self.board = self.emulator("--faults", self.faults, port=self.board.port)

        self.each("fault", check)

    def test_a_sensor_fault_ends_a_motion_with_safe_outputs(self):
        """Tests a sensor that fails while its finger is pressurised. The board still responds."""
        for name, (_, cell) in exit_codes.motion_faults().items():
            with self.subTest(name):
                child = self.working(self.line(MOTION[name]))
                self.board.ask("fault blind")
                said = child.communicate(timeout=bench.PATIENCE_S)[1].decode()
                self.board.ask("clear blind")
                self.assertEqual(child.returncode, code_of(cell), f"{name}: {said[-1500:]}")
                self.check_safe(name)

    def test_a_completed_motion_has_the_listed_code_and_safe_outputs(self):
        def check(name, command, cell):
            done = self.runner.run(self.line(command))
            self.ended(done, cell)
            self.check_safe(name)
            if command.writes:
                self.assertTrue((self.folder / "out" / str(self.count) / command.writes).exists())

        self.each("done", check, without=LONG)

    def test_a_full_disk_ends_a_motion_with_the_listed_code(self):
        disk = self.full_disk()
        lines = {name: self.line(command, "full") for name, command in MOTION.items()}
        (disk.folder / "output").touch()
        disk.fill()

        def check(name, command, cell):
            self.use_rested_fingers()
            if command.writes:
                done = self.runner.run(lines[name], preexec_fn=disk.limit)
                self.assertRegex(done.stderr.decode(), NO_SPACE)
            else:
                done = self.run_onto(disk, lines[name])
                self.assertIn("standard output", done.stderr.decode())
            self.ended(done, cell)
            self.check_safe(name)

        self.each("full disk", check, without=LONG)

    def test_a_closed_pipe_ends_a_motion_with_the_listed_code(self):
        def check(name, command, cell):
            for ignored in (False, True):
                done = self.runner.unread(self.line(command), ignored)
                self.ended(done, "4" if ignored else cell, signal.SIGPIPE)
                self.check_safe(name)

        self.each("closed pipe", check, without=LONG)

    def test_the_long_motion_has_the_listed_codes_and_safe_outputs(self):
        """Causes three endings of the command LONG at the same time, on three rigs."""
        disk = self.full_disk()
        reader, writer = os.pipe()
        os.close(reader)
        self.addCleanup(os.close, writer)
        keys = {"done": {}, "full disk": {"preexec_fn": disk.limit}, "closed pipe": {"stdout": writer}}
        lines, boards = {}, {}
        for ending in keys:
            lines[ending] = self.line(MOTION[LONG], "full" if ending == "full disk" else "out", rig=ending.replace(" ", "-"))
            boards[ending] = self.board
        disk.fill()
        children = {ending: self.runner.start(lines[ending], **keys[ending]) for ending in keys}
        for ending, child in children.items():
            with self.subTest(ending):
                done = self.runner.end(child)
                self.ended(done, self.table[LONG][ending], signal.SIGPIPE)
                self.assertLess(max(boards[ending].commands_kpa()), 0.1)
                if ending == "full disk":
                    self.assertRegex(done.stderr.decode(), NO_SPACE)
                elif ending == "done":
                    self.assertTrue((self.folder / "out" / "1" / MOTION[LONG].writes).exists())


if __name__ == "__main__":
    bench.main()
