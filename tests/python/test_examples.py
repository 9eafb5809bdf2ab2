"""Tests that each example in examples/python runs, is a single file and has at most 80 lines. Also runs the Python code of
docs/how-to/python.md."""

import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
EXAMPLES = SOURCE / "examples/python"
MODEL = SOURCE / "config/models/bench_twin.yaml"


class Examples(unittest.TestCase):
    ran = {"nightly_health.py"}  # test_health.py runs the example nightly_health.py

    def run_example(self, name, *arguments, expect=0):
        done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        self.ran.add(name)
        return done.stdout

    def test_every_example_runs_with_the_expected_output(self):
        with tempfile.TemporaryDirectory() as folder:
            at = pathlib.Path(folder)
            self.assertIn("bench_twin: 0.00 to", self.run_example("simulate_finger.py", MODEL, at / "log.csv"))
            self.assertTrue((at / "log.csv").read_text().startswith("time_s,pressure_command_kpa,displacement_mm"))
            self.assertRegex(self.run_example("invert_finger.py", MODEL), r"largest error \d\.\de-0[4-9] mm")
            for name, seed in (("one", 1), ("two", 2)):
                subprocess.run([BUILD / "tools/softgrip", "simulate", "--model", MODEL, "--input", "tp1", "--rate-hz", "20",
                                "--noise-mm", "0.05", "--seed", str(seed), "--out", at / f"{name}.csv"], check=True,
                               capture_output=True)
            rows = [line.split(",") for line in (at / "one.csv").read_text().splitlines()[1:]]
            (at / "other.csv").write_text("Time [s];Pressure setpoint [bar];Displacement [mm]\n" + "".join(
                f"{t};{float(p) / 100};{y}\n" for t, p, y in rows))
            self.assertIn("transport_delay: delay_s", self.run_example("diagnose_csv.py", at / "other.csv", at / "r.html"))
            self.assertIn("<html", (at / "r.html").read_text())
            self.assertIn("parameters differ", self.run_example("compare_fingers.py", at / "one.csv", at / "two.csv"))
            lines = self.run_example("many_logs.py", at / "one.csv", at / "two.csv", at / "none.csv").splitlines()
            self.assertEqual([": RMSE 0.0" in line for line in lines], [True, True, False])
            self.check_workflow(at)
            self.assertRegex(self.run_example("closed_loop.py", MODEL), r"RMSE of the last cycle: 0\.0\d+ mm")
            self.assertIn("20.0 kPa: valid, 4.0 mm", self.run_example("board_driver.py"))
            self.check_grip(at)
        self.assertEqual(self.ran, {path.name for path in EXAMPLES.glob("*.py")})

    def run_driver(self, code):
        """Returns the output lines of a program that imports examples/python/board_driver.py."""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, cwd=EXAMPLES,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_the_board_driver_uses_no_late_response(self):
        code = """
import socket, threading
import board_driver, softgrip
answer = threading.Event()
def device(line):
    with line, line.makefile("r") as commands:
        for command in commands:
            pressure = float(command.split()[1])
            if pressure == 10:
                answer.wait()
            try:
                line.sendall(f"POS {0.2 * pressure:.3f}\\n".encode())
            except BrokenPipeError:
                return
def dial():
    here, there = socket.socketpair()
    threading.Thread(target=device, args=[there]).start()
    return here
board = board_driver.LineBoard(dial)
board.connect(deadline=1)
for pressure in (5, 10, 20, None, 30):
    if pressure is None:
        answer.set()
        board.connect(deadline=1)
        continue
    try:
        print(pressure, board.exchange([pressure], deadline=0.2 if pressure == 10 else 30)[0].displacement)
    except softgrip.BusError as error:
        print(pressure, error.status)
board.close()
"""
        self.assertEqual(self.run_driver(code), ["5 1.0", "10 timed_out", "20 disconnected", "30 6.0"])

    def test_the_board_driver_reports_the_kind_of_each_failure(self):
        code = """
import socket, threading, time
import board_driver, softgrip
def refused():
    raise ConnectionRefusedError("no board")
def slow(line):
    for byte in b"POS 2.000\\n":
        time.sleep(0.15)
        try:
            line.sendall(bytes([byte]))
        except OSError:
            return
def closed(line):
    line.recv(64)
    line.close()
def other(line):
    line.recv(64)  # without this, the line can be closed before the command is sent
    line.sendall(b"ERR 5\\n")
def endless(line):
    try:
        while True:
            line.sendall(b"POS 2.0" * 20)
    except OSError:
        return
def dial_of(device):
    def dial():
        here, there = socket.socketpair()
        threading.Thread(target=device, args=[there], daemon=True).start()
        return here
    return dial
for dial in (refused, dial_of(slow), dial_of(closed), dial_of(other), dial_of(endless)):
    board = board_driver.LineBoard(dial)
    begin = time.monotonic()
    try:
        board.connect(deadline=1)
        print(board.exchange([10], deadline=0.4))
    except softgrip.BusError as error:
        print(error.status, "detail" if error.detail else "no detail", time.monotonic() - begin < 1)
"""
        self.assertEqual(self.run_driver(code), [
            "disconnected detail True", "timed_out detail True", "disconnected detail True", "bad_reply detail True",
            "bad_reply detail True"])

    def check_workflow(self, at):
        if not shutil.which("snakemake"):
            self.ran.add("logs_on_slurm.py")
            return
        said = self.run_example("logs_on_slurm.py", at / "rows", at / "one.csv", at / "none.csv", "--local", expect=6)
        self.assertRegex(said, r"0000-one: RMSE 0\.0\d+ mm, \d+ parameters")
        self.assertRegex(said, r"0001-none: .*none\.csv")

    def check_grip(self, at):
        """Runs the examples that need a daemon."""
        with self.daemon(at):
            said = self.run_example("grip_and_wait.py", at / "socket")
            self.assertIn("result: HOLDING", said)
            self.assertIn("end: done", said)
            self.assertIn("did you mean", subprocess.run(
                [sys.executable, EXAMPLES / "grip_and_wait.py", at / "socket", "pick_stome"], capture_output=True, text=True,
                env={**os.environ, "PYTHONPATH": str(SOURCE / "python")}).stderr)

    @contextlib.contextmanager
    def daemon(self, at):
        """Runs a daemon whose board is simulated and whose socket is `at / "socket"`."""
        text = (SOURCE / "config/rig.yaml").read_text()
        for before, after in (("/tmp/softgrip.sock", f"{at}/socket"), ("/tmp/softgrip-runs", f"{at}/runs"),
                              ("models/bench_twin.yaml", str(MODEL)),
                              ("sequence_directory: sequences", f"sequence_directory: {SOURCE}/config/sequences")):
            self.assertIn(before, text)
            text = text.replace(before, after)
        (at / "rig.yaml").write_text(text)
        with (at / "daemon.log").open("w") as log, subprocess.Popen(
                [BUILD / "daemon/softgripd", "--config", at / "rig.yaml"], stdout=log, stderr=log) as daemon:
            try:
                end = time.monotonic() + 30
                while not (at / "socket").exists() and time.monotonic() < end:
                    time.sleep(0.05)
                yield
            finally:
                daemon.terminate()

    def run_snippet(self, at, code):
        """Runs code of the page in the folder `at`, in which the file names of the code are relative."""
        if "async with" in code:
            inner = "\n".join("    " + line for line in code.splitlines())
            code = f"import asyncio, softgrip\nasync def main():\n{inner}\nasyncio.run(main())"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=at, timeout=300,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python"), "SOFTGRIP_SOCKET": str(at / "socket")})
        self.assertEqual(done.returncode, 0, code + done.stderr)

    def test_the_code_of_the_page_runs(self):
        page = (SOURCE / "docs/how-to/python.md").read_text()
        robot, tasks, models, recordings = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        with tempfile.TemporaryDirectory() as folder:
            at = pathlib.Path(folder)
            shutil.copy(MODEL, at / "model.yaml")
            for command in (["simulate", "--model", "model.yaml", "--input", "tp1", "--rate-hz", "20", "--noise-mm", "0.05",
                             "--out", "measured.csv"],
                            ["diagnose", "--model", "model.yaml", "--data", "measured.csv", "--out", "OUT"]):
                subprocess.run([BUILD / "tools/softgrip", *command], check=True, capture_output=True, cwd=at)
            self.run_snippet(at, models)
            self.assertTrue((at / "extended.yaml").exists())
            with self.daemon(at):
                self.run_snippet(at, robot)
            (run,) = (at / "runs").iterdir()
            code, replaced = re.subn(r"/var/lib/softgrip/runs/[^\"]*", str(run), recordings)
            self.assertEqual(replaced, 1)
            self.run_snippet(at, code)
            shutil.rmtree(at / "runs")
            with self.daemon(at):
                self.run_snippet(at, tasks)

    def test_every_example_has_at_most_80_lines(self):
        for path in EXAMPLES.glob("*.py"):
            self.assertLessEqual(len(path.read_text().splitlines()), 80, path.name)


if __name__ == "__main__":
    unittest.main()
