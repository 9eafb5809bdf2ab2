"""A proxy on a Unix socket between a client and softgripd. Tests can disturb the connection while it is in use."""

import contextlib
import os
import select
import socket
import threading

TO_DAEMON, TO_CLIENT = "to_daemon", "to_client"


class SocketProxy:
    """Listens at `path`, passes the bytes of clients to the daemon at `daemon_path`, and passes the answers back.

    `held` contains the directions in which the proxy stores the bytes and does not forward them. If `refuses` is true,
    the proxy closes new connections. let_go() forwards the stored bytes, even if the client has closed its connection.
    The kernel does the same for a paused daemon.
    """

    def __init__(self, path, daemon_path):
        self.path, self.daemon_path = str(path), str(daemon_path)
        self.held = set()
        self.refuses = False
        self._lock = threading.Lock()
        self._pairs = []  # each entry: [client or None, daemon or None, bytes to the daemon, bytes to the client]
        self._wakes, self._waker = os.pipe()
        self._ended = False
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(self.path)
        self._listener.listen(64)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self._ended = True
        self._wake()
        self._thread.join(10)
        self.cut()
        self._listener.close()
        for end in (self._wakes, self._waker):
            os.close(end)

    def hold(self, *directions):
        with self._lock:
            self.held |= set(directions or (TO_DAEMON, TO_CLIENT))

    def let_go(self):
        with self._lock:
            self.held.clear()
        self._wake()

    def waiting(self, direction):
        """Returns the bytes that the proxy has stored, by connection."""
        with self._lock:
            return [pair[2 if direction == TO_DAEMON else 3] for pair in self._pairs]

    def inject(self, data):
        """Sends `data` to all clients, as if the daemon had sent it."""
        with self._lock:
            for pair in self._pairs:
                pair[3] += data
        self._wake()

    def cut(self):
        """Closes all connections on both sides and discards the stored bytes."""
        with self._lock:
            for pair in self._pairs:
                for end in pair[:2]:
                    if end:
                        with contextlib.suppress(OSError):
                            end.shutdown(socket.SHUT_RDWR)
                        end.close()
            self._pairs.clear()

    def _wake(self):
        os.write(self._waker, b"x")

    def _run(self):
        while not self._ended:
            with self._lock:
                reads = [end for pair in self._pairs for end in pair[:2] if end]
            try:
                ready, _, _ = select.select([self._listener, self._wakes, *reads], [], [], 0.1)
            except (OSError, ValueError):  # the connection was closed since the call of select()
                continue
            if self._wakes in ready:
                os.read(self._wakes, 4096)
            if self._listener in ready:
                self._accept()
            with self._lock:
                for pair in list(self._pairs):
                    self._pass(pair, ready)

    def _accept(self):
        client, _ = self._listener.accept()
        if self.refuses:
            client.close()
            return
        daemon = socket.socket(socket.AF_UNIX)
        try:
            daemon.connect(self.daemon_path)
        except OSError:
            client.close()
            daemon.close()
            return
        with self._lock:
            self._pairs.append([client, daemon, b"", b""])

    def _pass(self, pair, ready):
        for side, waits in ((0, 2), (1, 3)):
            if pair[side] in ready:
                try:
                    data = pair[side].recv(1 << 16)
                except OSError:
                    data = b""
                pair[waits] += data
                if not data:
                    pair[side].close()
                    pair[side] = None
        for waits, other, direction in ((2, 1, TO_DAEMON), (3, 0, TO_CLIENT)):
            if pair[waits] and direction not in self.held:
                if pair[other]:
                    with contextlib.suppress(OSError):
                        pair[other].sendall(pair[waits])
                pair[waits] = b""
        # If one side closes its connection, the proxy first forwards the remaining bytes of this side. It then closes
        # the connection on the other side.
        if (pair[0] is None and not pair[2]) or (pair[1] is None and not pair[3]):
            for end in pair[:2]:
                if end:
                    end.close()
            self._pairs.remove(pair)
