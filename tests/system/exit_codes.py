"""Reads the table of docs/reference/exit-codes.md and provokes each ending of a program in the table."""

import contextlib
import dataclasses
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time

import bench
import fail_nth

PAGE = bench.SOURCE / "docs" / "reference" / "exit-codes.md"
ENDINGS = ("done", "refused", "signal", "fault", "full disk", "closed pipe")
STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
IMPOSSIBLE = "-"
ELSEWHERE = ()
# Files that a command may create under their final name with other functions than those of base/files.h.
GROWING = re.compile(r"/run\.csv$|^/dev/|^/proc/self/fd/\d+$")
TEMPORARY = re.compile(r"/\.softgrip-[0-9a-f]{16}\.part$|^\.softgrip-[0-9a-f]{16}\.part$")


def table():
    """Returns {command: {ending: cell}} of the table on the page."""
    rows = {}
    for line in PAGE.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 1 + len(ENDINGS):
            rows[cells[0].strip("`")] = dict(zip(ENDINGS, cells[1:]))
    return rows


def motion_faults():
    """Reads the second table of the page. Returns {command: (exit code if the board does not respond, exit code if
    the outputs are safe)}."""
    rows = (line.strip("|").split("|") for line in PAGE.read_text().splitlines() if line.startswith("| `"))
    return {row[0].strip(" `"): tuple(cell.strip() for cell in row[1:]) for row in rows if len(row) == 3}


def each(test, commands, ending, check):
    """Runs check(name, command, cell) as a subtest for every command that can have this ending."""
    cells = table()
    for name, command in commands.items():
        if cells[name][ending] != IMPOSSIBLE:
            with test.subTest(name):
                check(name, command, cells[name][ending])


@dataclasses.dataclass
class Command:
    """The command of one row of the table, and the data with which the test provokes the endings of this command.
    `{out}` in a command line is the folder of the outputs."""

    done: str
    refused: str = ""
    hangs_at: str = ""  # end of the path of an input that the command opens during its run
    # File within {out} that the command replaces; empty if the command only writes to standard output.
    writes: str = ""
    new: bool = False  # true: the command never replaces an existing file
    more: tuple = ()  # additional command lines that write a file, for the test with a full disk


class FullDisk:
    """A folder on a disk that fill() fills. If this user may not mount a disk, a limit on the file size
    simulates the full disk."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir()
        options = ["mount", "-t", "tmpfs", "-o", "size=1m", "softgrip-test", str(self.folder)]
        self.mounted = os.geteuid() == 0 and subprocess.run(options, capture_output=True).returncode == 0

    def fill(self):
        if not self.mounted:
            return
        with contextlib.suppress(OSError), open(self.folder / "filler", "wb", buffering=0) as filler:
            while True:
                filler.write(bytes(4096))

    def limit(self):
        """Prepares the child process. Called in the child process before it executes the program."""
        if not self.mounted:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1, resource.RLIM_INFINITY))

    def close(self):
        if self.mounted:
            subprocess.run(["umount", str(self.folder)], check=True)


def code_of(cell, number=None):
    """Returns the return code of subprocess for a cell of the table. A signal has the return code -`number`."""
    return -number if cell == "signal" else int(cell)


class Runner:
    """Runs softgrip with one folder as the working directory."""

    def __init__(self, folder, environment=None):
        self.folder = pathlib.Path(folder)
        self.environment = {**os.environ, "SOFTGRIP_SOCKET": str(self.folder / "softgripd.sock"), **(environment or {})}

    @staticmethod
    def words(line, out):
        return [str(bench.SOFTGRIP), *line.format(out=out).split()]

    def start(self, line, out="out", **keys):
        """Starts a command. Returns its process."""
        keys.setdefault("stdout", subprocess.PIPE)
        keys["env"] = {**self.environment, **keys.get("env", {})}
        return subprocess.Popen(self.words(line, out), stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, cwd=self.folder, **keys)

    @staticmethod
    def end(child, expect_s=bench.PATIENCE_S * 8):  # baseline --rig takes 2 minutes
        """Waits for the end of a process. Returns the finished process."""
        with child:
            try:
                output, errors = child.communicate(timeout=expect_s)
            finally:
                child.kill()
        return subprocess.CompletedProcess(child.args, child.returncode, output, errors)

    def run(self, line, out="out", **keys):
        return self.end(self.start(line, out, **keys))

    def created(self, line, out="out"):
        """Runs a command. Returns the finished process and the paths of the files that it has created."""
        with tempfile.NamedTemporaryFile(prefix="softgrip_created_") as noted:
            done = self.run(line, out, env={"LD_PRELOAD": str(fail_nth.SHIM), "FAIL_CREATED": noted.name})
            return done, pathlib.Path(noted.name).read_text().splitlines()

    def stopped(self, line, number, hangs_at, out="out"):
        """Sends a signal while the command opens an input. Returns the return code of the command."""
        told = self.folder / "told"
        told.unlink(missing_ok=True)
        child = subprocess.Popen(self.words(line, out), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, env={**self.environment, "LD_PRELOAD": str(fail_nth.SHIM),
                                                              "FAIL_HANG": hangs_at, "FAIL_TOLD": str(told)})
        return self.end_of(child, number, lambda: told.exists() or child.poll() is not None)

    def waiting(self, line, number, out="out", pause_s=0.3):
        """Sends a signal while the command waits for a daemon or for the reader of its output. Returns the return
        code of the command."""
        child = subprocess.Popen(self.words(line, out), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, env=self.environment)
        time.sleep(pause_s)
        return self.end_of(child, number, lambda: True)

    def blocked(self, line, number, out="out"):
        """Sends a signal while the command waits for the reader of its standard output. Returns the return code of
        the command."""
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writer, bytes(4096))
        os.set_blocking(writer, True)
        child = subprocess.Popen(self.words(line, out), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=writer,
                                 stderr=subprocess.PIPE, env=self.environment)
        os.close(writer)
        try:
            # If a command sleeps and its processor time does not increase, it waits in the kernel for the pipe.
            def waits():
                state, used = self.state_and_ticks(child.pid)
                time.sleep(0.1)
                return state == "S" and (state, used) == self.state_and_ticks(child.pid)
            return self.end_of(child, number, waits)
        finally:
            os.close(reader)

    @staticmethod
    def state_and_ticks(pid):
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return fields[0], (fields[11], fields[12])

    @staticmethod
    def end_of(child, number, ready):
        with child:
            try:
                bench.wait_for("the command to work", ready)
                child.send_signal(number)
                return child.wait(bench.PATIENCE_S)
            finally:
                child.kill()

    def unread(self, line, ignored, out="out"):
        """Runs a command whose standard output the reader has closed. SIGPIPE is ignored if `ignored` is true.
        Returns the finished process."""
        reader, writer = os.pipe()
        os.close(reader)
        try:
            return self.run(line, out, stdout=writer, restore_signals=not ignored,
                            preexec_fn=(lambda: signal.signal(signal.SIGPIPE, signal.SIG_IGN)) if ignored else None)
        finally:
            os.close(writer)
