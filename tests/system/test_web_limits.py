"""Tests the limits of softgrip-web. A user who only views must not use up the resources that an operator needs for a
stop or a vent."""

import contextlib
import os
import pathlib
import resource
import socket
import threading
import time
import unittest

import bench
import web

STUCK_DISK = bench.BUILD / "tests" / "system" / "libstuck_disk.so"
MIB_IN_KIB = 1024
LARGEST_FILE = 16 << 20
# Memory limit in systemd/softgrip-web.service.in. systemd ends the process if it exceeds this limit.
MEMORY_OF_UNIT_KIB = 128 * MIB_IN_KIB


def processor_s(pid):
    """Returns the processor time of a process [s]. Unlike the elapsed time, it does not depend on other processes."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Limits(web.WebTest):
    def setUp(self):
        super().setUp()
        self.start_rig()
        self.runs = self.folder / "runs"
        (self.runs / "one").mkdir(parents=True)

    def check_recordings(self):
        """Replaces the check of recordings, because the tests of this file record nothing or fill the folder of
        recordings themselves."""

    def send(self, told, path, receive_buffer=None, headers=""):
        """Opens a connection that sends a request and does not read the answer. `headers` are further lines of the
        request."""
        client = socket.socket()
        self.addCleanup(client.close)
        client.settimeout(bench.PATIENCE_S)
        if receive_buffer:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        client.connect(("127.0.0.1", told.port))
        client.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n{headers}\r\n".encode())
        return client

    def all_of(self, client):
        answer = b""
        while piece := client.recv(65536):
            answer += piece
        return answer

    def log_in(self, told, token):
        """Opens a session and returns its cookie."""
        status, _, headers = told.ask("/api/session", {"token": token})
        self.assertEqual(status, 200)
        return headers["Set-Cookie"].partition(";")[0]

    def assert_heard(self, told):
        """Checks that a stop, a vent and a request for the metrics each get an answer at the first attempt."""
        status, answer = told.command("stop")
        self.assertEqual((status, answer["details"]["refusal"]["name"]), (409, "nothing_to_stop"),
                         "the daemon must answer")
        status, answer = told.command("vent")
        self.assertEqual(status, 200, answer)
        self.assertEqual(told.metrics()["softgrip_up"], 1)

    def test_logins_of_viewers_do_not_end_the_session_of_an_operator(self):
        told = self.start_web(access="without_token: none")
        operator = self.log_in(told, web.OPERATE)
        for _ in range(70):
            viewer = self.log_in(told, web.LOOK)
        self.assertEqual(told.ask("/api/status", headers={"Cookie": viewer})[0], 200)
        status, text, _ = told.ask("/api/command", {"command": "vent"}, headers={"Cookie": operator})
        self.assertEqual(status, 200, text)

    def test_unread_downloads_use_less_than_16_mib_of_memory(self):
        with open(self.runs / "one" / "run.csv", "wb") as file:
            file.truncate(LARGEST_FILE)
        told = self.start_web()
        self.assert_heard(told)
        before = told.resident_kib()
        for _ in range(30):
            self.send(told, "/recordings/one/run.csv", receive_buffer=4096)
            self.assertLess(told.resident_kib(), before + 16 * MIB_IN_KIB)
        time.sleep(0.5)
        self.assert_heard(told)
        self.assertLess(told.resident_kib(), before + 16 * MIB_IN_KIB)

    def test_unread_replies_to_600_requests_use_less_than_64_mib(self):
        with open(self.runs / "one" / "run.csv", "wb") as file:
            file.truncate(LARGEST_FILE)
        names = [f"{number:03}-" + "x" * 110 + ".csv" for number in range(50)]
        for run in range(200):
            folder = self.runs / f"run-{run:03}-{'y' * 100}"
            folder.mkdir()
            for name in names:
                (folder / name).touch()
        told = self.start_web(access="without_token: look", most=512)
        held = []
        for number in range(600):
            path = ("/recordings/one/run.csv", "/api/stream", "/api/recordings", "/chart.js")[number % 4]
            # The server may close the connection while the client is sending, because the request exceeds the limit.
            with contextlib.suppress(OSError):
                held.append(self.send(told, path, receive_buffer=4096))
            if number % 50 == 49:
                self.assertEqual(told.metrics()["softgrip_up"], 1)
                self.assertLess(told.resident_kib(), MEMORY_OF_UNIT_KIB / 2)
        time.sleep(1)
        metrics = told.metrics()
        self.assertGreater(metrics["softgrip_web_unsent_bytes"], 0)
        self.assertLessEqual(metrics["softgrip_web_unsent_bytes"], 16 << 20)
        self.assertLess(told.resident_kib(), MEMORY_OF_UNIT_KIB / 2)
        status, text, _ = told.ask("/api/command", {"command": "vent"}, token=web.OPERATE)
        self.assertEqual(status, 200, text)

    def test_unread_downloads_do_not_prevent_a_vent(self):
        with open(self.runs / "one" / "run.csv", "wb") as file:
            file.truncate(LARGEST_FILE)
        told = self.start_web(most=8)
        for _ in range(20):
            self.send(told, "/recordings/one/run.csv", receive_buffer=4096)
            self.assert_heard(told)

    def test_clients_that_accept_compressed_files_do_not_delay_a_vent(self):
        """Measures the processor time of the server, because all requests after a request wait for this time."""
        told = self.start_web()
        self.assert_heard(told)
        before = processor_s(told.child.pid)
        clients = [self.send(told, "/chart.js", headers="Accept-Encoding: gzip, deflate, br\r\n") for _ in range(4)]
        status, answer = told.command("vent")
        self.assertEqual(status, 200, answer)
        self.assertLess(processor_s(told.child.pid) - before, 0.5, "processor time [s]")
        for client in clients:
            head = self.all_of(client).partition(b"\r\n\r\n")[0]
            self.assertTrue(head.startswith(b"HTTP/1.1 200"), head)
            self.assertNotIn(b"content-encoding", head.lower())

    def test_open_pages_of_viewers_do_not_block_an_operator(self):
        told = self.start_web(access="without_token: look", most=8)
        viewers = [self.send(told, "/api/stream") for _ in range(6)]
        for viewer in viewers:
            self.assertTrue(viewer.recv(100).startswith(b"HTTP/1.1 200"))
        self.assertTrue(self.send(told, "/api/stream").recv(100).startswith(b"HTTP/1.1 503"))
        operator = socket.create_connection(("127.0.0.1", told.port), bench.PATIENCE_S)
        self.addCleanup(operator.close)
        operator.sendall(f"GET /api/stream HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {web.OPERATE}\r\n\r\n"
                         .encode())
        self.assertTrue(operator.recv(100).startswith(b"HTTP/1.1 200"))
        self.assertEqual(told.metrics()["softgrip_web_pages"], 6)

    def test_the_list_of_recordings_is_cached_for_all_viewers(self):
        """Tests six viewers that list 20,000 folders. The test measures the processor time for the lists, because the
        lists delay all other requests by this time."""
        for number in range(20_000):
            (self.runs / f"run-{number:06}").mkdir()
        (self.runs / "run-999999").mkdir()
        (self.runs / "run-999999" / "run.csv").touch()
        told = self.start_web()
        time.sleep(2.5)  # waits until the change is old: the server reads a recently changed folder a second time
        lists = []

        def view():
            for _ in range(5):
                lists.append(told.ask("/api/recordings")[1])
        view()
        lists.clear()
        before = processor_s(told.child.pid)
        viewers = [threading.Thread(target=view) for _ in range(6)]
        for viewer in viewers:
            viewer.start()
        for viewer in viewers:
            viewer.join()
        used_s = processor_s(told.child.pid) - before
        self.assertEqual(lists, ['{"recordings":[{"name":"run-999999","files":["run.csv"]}]}'] * 30)
        self.assertLess(used_s, 0.5)

    @unittest.skipUnless(STUCK_DISK.exists(), "the shim is not built: a sanitizer's runtime must be loaded first")
    def test_a_disk_that_does_not_respond_does_not_delay_stop_and_vent(self):
        (self.runs / "one" / "run.csv").write_text("time\n")
        (self.runs / "health").mkdir()
        (self.runs / "health" / "health.json").write_text('{"made_unix_s": 7, "fingers": []}')
        stuck = self.folder / "stuck"
        told = self.start_web(environment={"LD_PRELOAD": str(STUCK_DISK), "STUCK_WHILE": str(stuck),
                                           "STUCK_FOLDER": str(self.runs)})
        self.assertEqual(told.metrics()["softgrip_health_timestamp_seconds"], 7)
        for path in ("/api/recordings", "/recordings/one/run.csv", "/metrics"):
            with self.subTest(path=path):
                stuck.touch()
                pending = [self.send(told, path) for _ in range(6)]
                waits = pathlib.Path(f"{stuck}.waits")
                bench.wait_for("a request to the disk", waits.exists)
                self.assert_heard(told)
                self.assertEqual(told.metrics()["softgrip_health_timestamp_seconds"], 7,
                                 "the metric must keep the last value that was read")
                stuck.unlink()
                waits.unlink()
                for client in pending:
                    self.assertTrue(self.all_of(client).startswith(b"HTTP/1.1 200"))

    @unittest.skipUnless(STUCK_DISK.exists(), "the shim is not built: a sanitizer's runtime must be loaded first")
    def test_a_disk_that_never_responds_is_reported_with_status_503(self):
        stuck = self.write("stuck", "")
        told = self.start_web(environment={"LD_PRELOAD": str(STUCK_DISK), "STUCK_WHILE": str(stuck),
                                           "STUCK_FOLDER": str(self.runs)})
        status, text, _ = told.ask("/api/recordings")
        self.assertEqual(status, 503, text)
        self.assertIn("the disk with the recordings does not respond", text)
        self.assert_heard(told)
        self.assertEqual(told.end(), 0)

    def test_softgrip_web_without_free_descriptors_does_not_busy_wait(self):
        told = self.start_web(access="without_token: operate")
        page = self.send(told, "/api/stream")
        self.assertTrue(page.recv(100).startswith(b"HTTP/1.1 200"))
        self.assert_heard(told)
        in_use = len(os.listdir(f"/proc/{told.child.pid}/fd"))
        resource.prlimit(told.child.pid, resource.RLIMIT_NOFILE, (in_use, in_use))
        crowd = []
        for _ in range(12):
            crowd.append(socket.create_connection(("127.0.0.1", told.port), bench.PATIENCE_S))
            self.addCleanup(crowd[-1].close)
        time.sleep(1)
        before = processor_s(told.child.pid)
        time.sleep(4)
        self.assertLess(processor_s(told.child.pid) - before, 0.4, "processor time in 4 s")
        self.assertIn(b"event: state", page.recv(1 << 20), "an open page must continue")
        self.assert_heard(told)  # the server closes connections that send no request, so it must answer this request

    def test_a_lowered_descriptor_limit_closes_only_open_pages(self):
        told = self.start_web()
        pages = [self.send(told, "/api/stream") for _ in range(40)]
        for page in pages:
            self.assertTrue(page.recv(100).startswith(b"HTTP/1.1 200"))
        resource.prlimit(told.child.pid, resource.RLIMIT_NOFILE, (30, 30))
        bench.wait_for("the server to close pages", lambda: len(os.listdir(f"/proc/{told.child.pid}/fd")) < 30)
        self.assert_heard(told)

    def test_the_descriptor_limit_reduces_the_number_of_connections(self):
        limited = ["prlimit", "--nofile=40", str(web.SOFTGRIP_WEB)]
        self.addCleanup(setattr, web, "SOFTGRIP_WEB", web.SOFTGRIP_WEB)
        script = self.write("limited.sh", f"#!/bin/sh\nexec {' '.join(limited)} \"$@\"\n")
        script.chmod(0o755)
        web.SOFTGRIP_WEB = script
        with open(self.runs / "one" / "run.csv", "wb") as file:
            file.truncate(LARGEST_FILE)
        told = self.start_web()
        self.assertIn("the limit of open files allows 8 connections, not 64", told.errors())
        for _ in range(12):
            self.send(told, "/recordings/one/run.csv", receive_buffer=4096)
            self.assert_heard(told)


if __name__ == "__main__":
    bench.main()
