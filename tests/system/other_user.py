"""Runs a process of another user who has no permission for the rig. Tests use
this process to find out what every local user can do."""

import hashlib
import os
import pathlib
import select
import signal
import socket
import time

import bench

NOBODY = 65534
NEEDS_ROOT = "only root can run this test as another user"


def board_name(port):
    """Returns the abstract socket name that a program occupies to lock the emulated board."""
    return "\0softgrip-board-" + hashlib.sha256(f"modbus 127.0.0.1 port {port} unit 1".encode()).hexdigest()


def lock_folders():
    """Returns the folders in which a daemon of this user can have its lock file."""
    user = os.geteuid()
    places = ("/run/softgrip", f"/run/user/{user}/softgrip", f"/tmp/softgrip-{user}")
    return [place for place in map(pathlib.Path, places) if place.is_dir()]


class OtherUser:
    """A process of another user that occupies a socket name or a path while it runs. If `backlog` is None, the socket
    does not listen. If it is 0, the socket accepts no connection."""

    def __init__(self, test, address, backlog=5):
        ready, told = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            try:
                self._hold(address, backlog, told)
            finally:
                os._exit(1)
        os.close(told)
        self.ended = False
        test.addCleanup(self.end)
        readable, _, _ = select.select([ready], [], [], bench.PATIENCE_S)
        test.assertTrue(readable and os.read(ready, 1) == b"1", "the other user did not get the name")
        os.close(ready)

    @staticmethod
    def _hold(address, backlog, told):
        os.setgroups([])
        os.setresgid(NOBODY, NOBODY, NOBODY)
        os.setresuid(NOBODY, NOBODY, NOBODY)
        held = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        give_up = time.monotonic() + bench.PATIENCE_S
        while True:
            try:
                held.bind(address)
                break
            except OSError:
                if time.monotonic() > give_up:
                    raise
        if backlog is not None:
            held.listen(backlog)
        if backlog == 0:  # fills the queue of the socket, so that every new connection has to wait
            full = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            full.connect(address)
        os.write(told, b"1")
        signal.pause()

    def end(self):
        if self.ended:
            return
        self.ended = True
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
