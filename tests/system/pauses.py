"""Pauses a daemon, either the whole process (SIGSTOP) or one of its threads (ptrace)."""

import contextlib
import pathlib
import signal
import subprocess
import sys
import time

HANG_THREAD = pathlib.Path(__file__).parent / "vm/drive/hang_thread.py"


def thread_of(daemon, name):
    for task in pathlib.Path(f"/proc/{daemon.child.pid}/task").iterdir():
        if (task / "comm").read_text().strip() == name:
            return task.name
    raise AssertionError(f"no thread {name}")


@contextlib.contextmanager
def whole_process(daemon):
    """Pauses the process during the `with` block."""
    daemon.send(signal.SIGSTOP)
    try:
        yield
    finally:
        daemon.send(signal.SIGCONT)


def pause(daemon, what, for_s):
    """Pauses the daemon for `for_s` seconds. `what` is "process" or the name of a thread. Raises PermissionError if
    this user may not trace another process."""
    if what == "process":
        with whole_process(daemon):
            time.sleep(for_s)
        return
    with subprocess.Popen([sys.executable, HANG_THREAD, thread_of(daemon, what)], stdout=subprocess.PIPE,
                          text=True) as hang:
        if hang.stdout.readline() != "hangs\n":
            raise PermissionError("this user may not trace another process")
        time.sleep(for_s)
        hang.kill()  # the thread continues when its tracer ends
