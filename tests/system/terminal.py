"""Runs a program on a pseudo-terminal and returns the text that a person would read there."""

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import termios
import time

import pyte


class Terminal:
    """Runs a program on its own terminal. Stores the output as the text on the screen and as bytes."""

    def __init__(self, arguments, folder, columns=80, rows=24, environment=None):
        self.master, self.slave = pty.openpty()
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.raw = b""
        self.resize(columns, rows, tell=False)
        self.before = termios.tcgetattr(self.slave)
        self.child = subprocess.Popen(
            [str(a) for a in arguments], stdin=self.slave, stdout=self.slave, stderr=self.slave, cwd=folder,
            preexec_fn=self._own_terminal,
            env={**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", "TZ": "UTC", **(environment or {})})

    def _own_terminal(self):
        """Makes the pseudo-terminal the controlling terminal of the program, so that Ctrl-C, Ctrl-Z and a hang-up have
        the same effect as on a real terminal."""
        os.setsid()
        fcntl.ioctl(self.slave, termios.TIOCSCTTY, 0)

    def resize(self, columns, rows, tell=True):
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.screen.resize(rows, columns)
        if tell:
            self.child.send_signal(signal.SIGWINCH)

    def type(self, keys):
        os.write(self.master, keys.encode())

    def read(self, seconds=0.05):
        """Reads the output of the program for `seconds`."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            ready, _, _ = select.select([self.master], [], [], left)
            if ready:
                data = os.read(self.master, 65536)
                self.raw += data
                self.stream.feed(data)

    def lines(self):
        self.read()
        return [line.rstrip() for line in self.screen.display]

    def text(self):
        return "\n".join(self.lines())

    def wait_for(self, what, patience_s=30):
        """Waits until the text `what` is on the screen. If `what` is a function, waits until what(screen) is true.
        Returns the screen."""
        shows = what if callable(what) else lambda text: what in text
        end = time.monotonic() + patience_s
        while not shows(text := self.text()):
            if time.monotonic() > end:
                raise AssertionError(f"waited {patience_s} s in vain for {what!r} on\n{text}")
        return text

    def wait(self, patience_s=30):
        """Waits until the program ends; returns its exit code."""
        end = time.monotonic() + patience_s
        while self.child.poll() is None:
            self.read()
            if time.monotonic() > end:
                raise AssertionError(f"it did not end:\n{self.text()}")
        self.read()
        return self.child.returncode

    def restored(self):
        """Returns True if the program has restored the terminal. The cursor must be visible, the original screen must
        be shown, and the keyboard must have its initial settings."""
        self.read()
        shown = self.raw.rfind(b"\x1b[?25h") > self.raw.rfind(b"\x1b[?25l")
        back = self.raw.rfind(b"\x1b[?1049l") > self.raw.rfind(b"\x1b[?1049h")
        return shown and back and termios.tcgetattr(self.slave) == self.before

    def close(self):
        if self.child.poll() is None:
            self.child.kill()
            self.child.wait()
        os.close(self.master)
        os.close(self.slave)
