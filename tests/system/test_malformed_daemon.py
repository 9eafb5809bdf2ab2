"""Tests the programs with a server that sends lines that softgripd never sends. Each command must report such a line
in a sentence and end with exit code 4. A gateway must behave as if no daemon were running."""

import contextlib
import json
import socket
import threading

import bench
import plc
import web

LEVELS = 100_000
DAMAGED = {
    "no reply": b"{}\n",
    "no object": b"[]\n",
    "ok is no flag": b'{"ok":1}\n',
    "ok without a result": b'{"id":null,"ok":true}\n',
    "a refusal without a reason": b'{"id":null,"ok":false}\n',
    "a number as the reason": b'{"id":null,"ok":false,"error":{"code":3,"message":4}}\n',
    "an empty state": b'{"id":1,"watch":{}}\n',
    "an empty event in a list of others": b'{"id":1,"ok":true,"result":{"events":[{},3],"state":7}}\n',
    "deep nesting": b'{"ok":true,"result":' + b"[" * LEVELS + b"]" * LEVELS + b"}\n",
    "no UTF-8": b'{"ok":true,"result":{"a":"\xff\xfe"}}\n',
    "no JSON": b"\x00\x01HTTP/1.1 400\n",
    "half a line": b'{"ok":tr\n',
}
ENDLESS = "an endless line"
COMMANDS = ("status", "status --json", "sequences", "events", "watch --count 1", "start pick_stone", "start pick_stone --wait",
            "stop", "release", "vent", "acknowledge")
HELLO = {"api": 1, "version": "1", "capabilities": ["start_id"]}


class FakeDaemon:
    """Serves requests. `answer(request)` returns the bytes of the answer, or None for a line that never ends."""

    def __init__(self, path, answer):
        self.answer = answer
        self.requests = []
        self.connections = 0
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen(64)
        threading.Thread(target=self._run, daemon=True).start()

    def close(self):
        self._listener.close()

    def _run(self):
        with contextlib.suppress(OSError):
            while True:
                client, _ = self._listener.accept()
                self.connections += 1
                threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client):
        with client, contextlib.suppress(OSError), client.makefile("rb") as lines:
            for line in lines:
                self.requests.append(json.loads(line))
                said = self.answer(self.requests[-1])
                while said is None:
                    client.sendall(b"x" * 65536)
                client.sendall(said)


def well(asked, /, **result):
    return json.dumps({"id": asked.get("id"), "ok": True, "result": result}).encode() + b"\n"


def fake(test, answer):
    daemon = FakeDaemon(test.folder / "softgripd.sock", answer)
    test.addCleanup(daemon.close)
    return daemon


class Commands(bench.BenchTest):
    def check_end(self, line):
        done = self.softgrip(*line.split(), expect=4)
        self.assertRegex(done.stderr, r"^softgrip: softgripd sent a malformed reply: [^\n]+\n$")
        self.assertNotRegex(done.stderr, r"json\.exception|terminate|basic_string")
        self.assertEqual(done.stdout, "")

    def test_every_command_reports_a_malformed_reply_with_exit_code_4(self):
        daemon = fake(self, lambda request: said)
        for name, said in {**DAMAGED, ENDLESS: None}.items():
            for line in COMMANDS if name != ENDLESS else ("status", "start pick_stone"):
                with self.subTest(name, line=line):
                    self.check_end(line)
        self.assertGreater(daemon.connections, len(COMMANDS))

    def test_a_malformed_reply_to_a_start_stops_the_sequence(self):
        """Tests a malformed reply to a start. The sequence may have started nevertheless. The client must open a new
        connection and stop the sequence by the id of its start."""
        said = b""
        def answer(request):
            if request["command"] == "hello":
                return well(request, **HELLO)
            if request["command"] == "events":
                return well(request, events=[], newest=0)
            return well(request, request=0) if request["command"] == "stop" else said

        daemon = fake(self, answer)
        for name, said in {**DAMAGED, "no number": b'{"ok":true,"result":{}}\n'}.items():
            with self.subTest(name):
                daemon.requests.clear()
                done = self.softgrip("start", "pick_stone", expect=4)
                self.assertRegex(done.stderr,
                                 r"^softgrip: softgripd sent a malformed reply: [^\n]+; sequence stopped\n$")
                start, stop = (r for r in daemon.requests if r["command"] in ("start", "stop"))
                self.assertEqual(stop["start_id"], start["start_id"])

    def test_malformed_events_after_a_start_stop_the_sequence(self):
        def answer(request):
            if request["command"] == "hello":
                return well(request, **HELLO)
            if request["command"] == "events" and request["limit"] == 1:
                return well(request, events=[], newest=0)
            return DAMAGED["an empty event in a list of others"] if request["command"] == "events" else well(request, request=1)

        fake(self, answer)
        done = self.softgrip("start", "pick_stone", "--wait", expect=4)
        self.assertRegex(done.stderr, r"^softgrip: softgripd sent a malformed reply: [^\n]+; sequence stopped\n$")


class Gateways(bench.BenchTest):
    """Tests that a gateway treats a malformed line like a lost connection and connects a second time."""

    def setUp(self):
        super().setUp()
        self.said = DAMAGED["no reply"]
        self.daemon = fake(self, lambda request: self.said)

    def check_each(self, well_without_a_daemon):
        for name, self.said in {**DAMAGED, ENDLESS: None}.items():
            with self.subTest(name):
                before = self.daemon.connections
                bench.wait_for("two new connections", lambda: self.daemon.connections >= before + 2)
                well_without_a_daemon()

    def test_softgrip_web_treats_a_malformed_line_as_a_missing_daemon(self):
        gateway = web.Web(self.folder)
        self.processes.append(gateway)

        def check():
            self.assertEqual(gateway.metrics()["softgrip_up"], 0)
            status, answer = gateway.command("stop")
            self.assertEqual((status, answer["code"]), (503, "no_answer"), answer)

        self.check_each(check)
        self.assertEqual(gateway.end(), 0)

    def test_softgrip_plc_treats_a_malformed_line_as_a_missing_daemon(self):
        gateway = plc.Plc(self.folder)
        self.processes.append(gateway)
        master = plc.Master(gateway)
        self.addCleanup(master.close)
        self.check_each(lambda: self.assertEqual(master.read("state"), plc.NO_DAEMON_STATE))
        self.assertEqual(gateway.end(), 0)


if __name__ == "__main__":
    bench.main()
