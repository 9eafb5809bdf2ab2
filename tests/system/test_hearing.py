"""A vent is heard whatever others do: floods, pipelines, silent crowds, files that never answer, a reader that hangs."""

import json
import os
import signal
import socket
import subprocess
import threading
import time

import bench

# From the client's line to the written output; a busy machine may add to that, the others may not.
VENT_BOUND_S = 0.5


class Hearing(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.board = self.emulator("--object", "stone")
        self.daemon_ = self.daemon(self.rig(self.board.port))
        self.daemon_.wait_for_state("idle")
        self.stop_ = threading.Event()
        self.addCleanup(self.stop_.set)

    def hold(self):
        self.daemon_.start("pick_stone")
        for channel in ("left", "right"):
            self.daemon_.wait_for_event("grip_result", code="HOLDING", channel=channel)

    def raw(self):
        client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        client.connect(str(self.daemon_.socket_path))
        self.addCleanup(client.close)
        return client

    def vents(self, patience_s=5):
        """How long a client that comes now waits for the written output [s], and the answer it gets."""
        began = time.monotonic()
        client = self.raw()
        client.settimeout(patience_s)
        client.sendall(b'{"command":"vent"}\n')
        bench.wait_for("falling outputs", lambda: max(self.board.commands_kpa()) < 1, pause_s=0.001)
        waited = time.monotonic() - began
        answer = json.loads(client.makefile().readline())
        self.assertTrue(answer["ok"], answer)
        return waited

    def in_background(self, body):
        thread = threading.Thread(target=body, daemon=True)
        thread.start()
        self.addCleanup(thread.join, 5)
        self.addCleanup(self.stop_.set)

    def flood(self, line, reads=True):
        """A client that sends as fast as it can, and takes its answers as fast, or never."""
        client = self.raw()
        client.settimeout(0.2)

        def until_stopped(step):
            while not self.stop_.is_set():
                try:
                    step()
                except TimeoutError:
                    pass
                except OSError:
                    return

        self.in_background(lambda: until_stopped(lambda: client.sendall(line * 500)))
        if reads:
            self.in_background(lambda: until_stopped(lambda: client.recv(1 << 20)))

    def check_vent(self):
        waited = self.vents()
        print(f"{self.id().rsplit('.')[-1]}: written after {waited * 1000:.0f} ms")
        self.assertLess(waited, VENT_BOUND_S)

    def test_behind_a_crowd_of_silent_connections(self):
        self.hold()
        crowd = []
        for _ in range(1000):
            client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            client.setblocking(False)
            try:
                client.connect(str(self.daemon_.socket_path))
            except BlockingIOError:
                time.sleep(0.001)
            crowd.append(client)
        try:
            self.check_vent()
        finally:
            for client in crowd:
                client.close()

    def test_beside_floods_of_acknowledgements(self):
        self.hold()
        for _ in range(4):
            self.flood(b'{"command":"acknowledge"}\n')
        time.sleep(0.5)
        self.check_vent()

    def test_beside_pipelines_of_events(self):
        self.hold()
        for reads in (True, False):
            self.flood(b'{"command":"events","limit":1000}\n', reads)
        time.sleep(0.5)
        self.check_vent()

    def test_a_pipe_among_the_sequences(self):
        os.mkfifo(self.folder / "config/sequences/pipe.yaml")
        refused = self.daemon_.ask("start", sequence="pipe")
        self.assertEqual(refused["error"]["code"], "sequence_refused")
        self.assertIn("no regular file", json.dumps(refused))
        self.hold()
        self.check_vent()
        self.assertEqual(self.daemon_.end(), 0)

    def test_a_disk_that_does_not_answer(self):
        """A file on a mount that is gone, as near as a test comes: a lease that nobody gives back."""
        path = self.folder / "config/sequences/leased.yaml"
        path.write_text((self.folder / "config/sequences/pick_stone.yaml").read_text())
        # Opening it waits in the kernel until the lease is broken, for /proc/sys/fs/lease-break-time seconds.
        holder = subprocess.Popen(["python3", "-c", f"""
import fcntl, os, signal, time
signal.signal(signal.SIGIO, signal.SIG_IGN)
fd = os.open({str(path)!r}, os.O_RDWR)
fcntl.fcntl(fd, fcntl.F_SETLEASE, fcntl.F_WRLCK)
print("leased", flush=True)
time.sleep(60)
"""], stdout=subprocess.PIPE, text=True)
        self.addCleanup(holder.wait)
        self.addCleanup(holder.kill)
        self.addCleanup(holder.stdout.close)
        if holder.stdout.readline() != "leased\n":
            self.skipTest("this file system gives no leases")
        self.hold()
        waiting = self.raw()
        waiting.sendall(b'{"command":"start","sequence":"leased"}\n')
        time.sleep(0.3)
        self.assertEqual(self.daemon_.ask("start", sequence="pick_stone")["error"]["code"], "busy")
        self.check_vent()
        began = time.monotonic()
        self.assertEqual(self.daemon_.end(), 0)
        self.assertLess(time.monotonic() - began, 5)

    def test_stop_passes_what_waits(self):
        self.hold()
        for _ in range(4):
            self.flood(b'{"command":"acknowledge"}\n')
        time.sleep(0.2)
        client = self.raw()
        client.sendall(b'{"command":"stop"}\n')
        self.assertTrue(json.loads(client.makefile().readline())["ok"])

    def test_refused_starts_leave_nothing_behind(self):
        self.hold()
        text = (self.folder / "config/sequences/pick_stone.yaml").read_text() + "#" * 55_000 + "\n"
        line = (json.dumps({"command": "start", "sequence": "mine", "sequence_text": text}) + "\n").encode()
        client = self.raw().makefile("rwb")

        def refuse(times):
            for _ in range(times):
                client.write(line)
                client.flush()
                self.assertEqual(json.loads(client.readline())["error"]["code"], "refused")

        refuse(20)
        before = self.daemon_.resident_kib()
        refuse(60)
        self.assertLess(self.daemon_.resident_kib() - before, 60 * 50, "60 KiB of text each, 206 KiB as a sequence")


class Ending(bench.BenchTest):
    def test_a_standard_error_that_nobody_reads(self):
        emulator = self.emulator("--object", "stone")
        rig = self.rig(emulator.port)
        reader, writer = os.pipe()
        self.addCleanup(os.close, reader)
        daemon = subprocess.Popen([bench.SOFTGRIPD, "--config", rig], stderr=writer, cwd=self.folder,
                                  stdin=subprocess.DEVNULL)
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.kill)
        bench.wait_for("the socket", lambda: (self.folder / "softgripd.sock").exists())
        # Not to block is a property of this descriptor alone: the daemon's must.
        filler = os.open(f"/proc/self/fd/{writer}", os.O_WRONLY | os.O_NONBLOCK)
        os.close(writer)
        try:
            while True:
                os.write(filler, b"x" * 4096)  # until it is full
        except BlockingIOError:
            os.close(filler)
        began = time.monotonic()
        daemon.send_signal(signal.SIGTERM)
        self.assertEqual(daemon.wait(20), 0)
        self.assertLess(time.monotonic() - began, 5)


class AnotherMaster(bench.BenchTest):
    def test_is_noticed_where_the_board_reads_back(self):
        emulator = self.emulator("--object", "stone")
        daemon = self.daemon(self.rig(emulator.port))
        daemon.wait_for_state("idle")
        daemon.start("pick_stone")
        for channel in ("left", "right"):
            daemon.wait_for_event("grip_result", code="HOLDING", channel=channel)
        other = socket.create_connection(("127.0.0.1", emulator.port))
        self.addCleanup(other.close)
        # FC16: outputs 10 and 11 to 0, again and again, as a forgotten script would.
        frame = bytes([0, 1, 0, 0, 0, 11, 1, 16, 0, 10, 0, 2, 4, 0, 0, 0, 0])
        began = time.monotonic()
        while time.monotonic() - began < 5 and daemon.status()["state"] != "faulted":
            other.sendall(frame)
            other.recv(256)
            time.sleep(0.005)
        codes = [e["code"] for e in daemon.events() if e["kind"] == "fault_latched"]
        self.assertTrue(set(codes) & {"F304", "F302", "F301"}, codes)
        bench.wait_for("vented outputs", lambda: max(emulator.commands_kpa()) < 1)
        for _ in range(50):
            self.assertLess(max(emulator.commands_kpa()), 1)
            time.sleep(0.005)


if __name__ == "__main__":
    bench.main()
