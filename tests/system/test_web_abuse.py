"""Tests softgrip-web with hostile clients. They must get only refusals, and they must not affect the daemon."""

import contextlib
import gzip
import pathlib
import random
import re
import socket
import time

import bench
import web

SECRET = "what no browser may see"
# 200 MiB of zeros, compressed by brotli to 317 bytes.
REPEATED = ("1fffffff00900088c302d0bdffe3ffff1f001200715800baf77ffcffff034002200e0b40f7fe8fffff7f004800c46101e8def"
            "ff1ffff0f000980382c00ddfb3ffeffff012001108705a07bffc7ffff3f002400e2b00074effff8ffff078004401c1680eefd")
BROTLI_BOMB = bytes.fromhex("cbffff3f002400e2b14072effff8ffff078004401c1680eefd" + REPEATED * 2 +
                            "1fffffff00900088c302d0bdffe3ffff1f001200715800baf77ffcffff034002200e0b40f7fe8fffff7f004800c46101"
                            "e8defff1ffff0f000980382c00ddfb3ffeffff012001108705a07bffc7ffff3f002400e2b00074efff06")


class Abuse(web.WebTest):
    def setUp(self):
        super().setUp()
        self.start_rig()
        self.told = self.start_web(access="without_token: look", most=16)
        (self.folder / "secret.svg").write_text(SECRET)
        (self.folder / "runs" / "one").mkdir(parents=True)
        (self.folder / "runs" / "one" / "picture.svg").write_text("<svg/>")

    def check_recordings(self):
        """Replaces the check of recordings, because the only recording is one that a test writes itself."""

    def connect(self):
        client = socket.create_connection(("127.0.0.1", self.told.port))
        self.addCleanup(client.close)
        client.settimeout(bench.PATIENCE_S)
        return client

    def say(self, data):
        """Sends exactly these bytes. Returns the complete answer."""
        with socket.create_connection(("127.0.0.1", self.told.port)) as client:
            client.settimeout(bench.PATIENCE_S)
            # the server may close the connection before it has received the whole request (EPIPE, ECONNRESET, ENOTCONN)
            with contextlib.suppress(OSError):
                client.sendall(data)
                client.shutdown(socket.SHUT_WR)
            answer = b""
            with contextlib.suppress(ConnectionResetError):
                while piece := client.recv(65536):
                    answer += piece
            return answer

    def status_of(self, data):
        answer = self.say(data)
        return int(answer.split()[1]) if answer else 0

    def assert_well(self):
        """Checks that softgrip-web answers and that the control loop of the daemon has continued."""
        def well():
            with contextlib.suppress(OSError):
                return self.told.ask("/api/status")[0] == 200
        bench.wait_for("an answer", well)
        self.assertTrue(self.told.running())
        status = self.softgripd.status()
        self.assertEqual((status["state"], status["fault"]), ("idle", None))
        self.assertNotIn("request_refused", {e["kind"] for e in self.softgripd.events()})
        self.assertNotIn("sequence_started", {e["kind"] for e in self.softgripd.events()})

    def test_no_path_gives_access_to_files_outside_the_recordings(self):
        ups = ("..", "%2e%2e", "..%2f..", "....//", "%252e%252e", "..\\", "%c0%ae%c0%ae", "..;", ".%00.")
        paths = [f"/{a}/{b}" for up in ups for a in (up, f"recordings/{up}", f"recordings/one/{up}")
                 for b in ("secret.svg", "etc/passwd", f"{up}/secret.svg", f"{up}/{up}/etc/passwd")]
        paths += ["/recordings/one/picture.svg/../../secret.svg", "//etc/passwd", "/recordings//etc/passwd",
                  f"/recordings/{self.folder}/secret.svg", "/recordings/one/picture.svg%00", "/page.html", "/config"]
        for path in paths:
            answer = self.say(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            self.assertIn(int(answer.split()[1]), (400, 404), path)
            self.assertNotIn(SECRET.encode(), answer)
            self.assertNotIn(b"root:", answer)
        self.assertEqual(self.told.ask("/recordings/one/picture.svg")[0], 200)
        self.assert_well()

    def test_too_large_requests_are_refused(self):
        head = b"POST /api/command HTTP/1.1\r\nHost: localhost\r\n"
        self.assertEqual(self.status_of(head + b"Content-Length: 16385\r\n\r\n" + b"x" * 16385), 413)
        self.assertEqual(self.status_of(head + b"Content-Length: 99999999999\r\n\r\n"), 413)
        self.assertEqual(self.status_of(head + b"Transfer-Encoding: chunked\r\n\r\nffffffff\r\n"), 501)
        self.assertEqual(self.status_of(b"GET /" + b"a" * 7000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n"), 414)
        self.assertEqual(self.status_of(b"GET / HTTP/1.1\r\nX: " + b"a" * 1_000_000), 431)
        self.assertEqual(self.status_of(b"GET / HTTP/1.1\r\n" + b"X: 1\r\n" * 65 + b"\r\n"), 431)
        self.assertEqual(self.status_of(b"\0" * 100_000), 400)
        self.assert_well()

    def test_a_compressed_body_is_refused_and_uses_no_memory(self):
        for encoding, body in (("br", BROTLI_BOMB), ("gzip", gzip.compress(bytes(15 << 20)))):
            head = (f"POST /api/session HTTP/1.1\r\nHost: localhost:{self.told.port}\r\n"
                    f"Origin: http://localhost:{self.told.port}\r\nContent-Type: application/json\r\n"
                    f"Content-Encoding: {encoding}\r\nContent-Length: {len(body)}\r\n\r\n")
            self.assertEqual(self.status_of(head.encode() + body), 415, encoding)
        process = pathlib.Path(f"/proc/{self.told.child.pid}/status").read_text()
        self.assertLess(int(re.search(r"VmHWM:\s+(\d+)", process).group(1)), 60 << 10, "largest memory [KiB]")
        self.assert_well()

    def test_a_thousand_connections_do_not_disturb_the_daemon(self):
        before = self.softgripd.status()["loop"]["ticks"]
        crowd = [self.connect() for _ in range(1000)]
        self.assertEqual(len(crowd), 1000)
        self.assert_well()
        metrics = self.told.metrics()
        self.assertLessEqual(metrics["softgrip_web_connections"], 16)
        self.assertGreater(metrics["softgrip_web_turned_away_total"], 900)
        self.assertGreater(self.softgripd.status()["loop"]["ticks"], before)

    def test_clients_that_send_single_bytes_are_disconnected(self):
        slow = [self.connect() for _ in range(16)]
        began = time.monotonic()
        gone = set()
        while len(gone) < len(slow) and time.monotonic() - began < bench.PATIENCE_S:
            for client in slow:
                if client in gone:
                    continue
                with contextlib.suppress(BlockingIOError):
                    try:
                        client.setblocking(False)
                        client.send(b"G")
                        if client.recv(100) == b"":
                            gone.add(client)
                    except (BrokenPipeError, ConnectionResetError):
                        gone.add(client)
            if time.monotonic() - began < 1:
                self.assert_well()  # a client that sends requests must still get a connection
            time.sleep(0.1)
        self.assertEqual(len(gone), len(slow))
        self.assert_well()

    def test_a_stream_client_that_does_not_read_is_disconnected(self):
        for _ in range(8):
            client = self.connect()
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
            client.sendall(b"GET /api/stream HTTP/1.1\r\nHost: localhost\r\n\r\n")
        bench.wait_for("the pages", lambda: self.told.metrics()["softgrip_web_pages"] == 8)
        bench.wait_for("their end", lambda: self.told.metrics()["softgrip_web_pages"] == 0, 120, 0.5)
        self.assert_well()

    def test_random_malformed_requests_do_not_disturb_the_daemon(self):
        seed = 20261121
        chance = random.Random(seed)
        whole = (b"POST /api/command?a=b HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
                 b"Cookie: softgrip=0123; a=b\r\nAuthorization: Bearer look\r\nContent-Type: application/json\r\n"
                 b"Range: bytes=0-1,2-3\r\nAccept-Encoding: gzip, br\r\nContent-Length: 18\r\n\r\n{\"command\":\"stop\"}")
        pieces = [b"\r\n", b"\n", b"\0", b"%00", b"\xff\xfe", b": ", b"bytes=" + b"0-," * 500, b"chunked", b"a" * 3000,
                  b"../" * 100, b"{" * 500, b"multipart/form-data; boundary=", b"-1", b"99999999999999999999", b";q=", b"*/*"]
        statuses = {}
        for turn in range(1500):
            data = bytearray(whole)
            for _ in range(chance.randrange(1, 5)):
                at = chance.randrange(len(data))
                what = chance.randrange(3)
                if what == 0:
                    data[at:at + chance.randrange(1, 20)] = b""
                elif what == 1:
                    data[at:at] = chance.choice(pieces)
                else:
                    data[at] = chance.randrange(256)
            status = self.status_of(bytes(data))
            statuses[status] = statuses.get(status, 0) + 1
            self.assertIn(status, (0, 200, 400, 401, 403, 404, 405, 413, 414, 415, 416, 417, 421, 431, 501, 503, 505),
                          f"seed {seed}, turn {turn}: {bytes(data)!r}")
        self.assertGreater(statuses.get(400, 0), 100, statuses)
        self.assert_well()


if __name__ == "__main__":
    bench.main()
