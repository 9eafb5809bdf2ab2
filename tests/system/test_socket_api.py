"""Tests version 1 of the socket API: the identity and the permissions of a client, dry runs, and the delivery of all
events to a client."""

import json
import time

import api_schema
import bench


class Client:
    """A connection that separates the answers to its own requests from all other lines."""

    def __init__(self, path):
        self.lines = bench.Lines(path)
        # Uses a separate file object for reading. A file object for both directions discards its buffered input when it
        # writes.
        self.input = self.lines.socket.makefile("r", encoding="utf-8", newline="\n")
        self.told = []

    def close(self):
        self.input.close()
        self.lines.close()

    def ask(self, command, **keys):
        self.lines.socket.sendall(json.dumps({"id": 1, "command": command, **keys}).encode() + b"\n")
        while True:
            line = self.line()
            if "ok" in line:
                api_schema.check(line, command)
                return line
            self.told.append(line)

    def line(self):
        text = self.input.readline()
        if not text:
            raise AssertionError("the daemon closed the connection")
        line = json.loads(text)
        if "ok" not in line:
            api_schema.check(line)
        return line

    def events(self, until):
        """Returns the received events up to the first event for which `until` is true."""
        events = []
        while True:
            line = self.told.pop(0) if self.told else self.line()
            events.append(line["event"])
            if until(events[-1]):
                return events


class SocketApi(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.board = self.emulator("--object", "stone")
        self.look = self.folder / "look.sock"
        self.rig_path = self.rig(self.board.port, changes=(
            ("sequence_directory: sequences",
             f'sequence_directory: sequences, read_only: {{path: {self.look}, mode: "0666"}}'),))
        self.softgripd = self.idle_daemon(self.rig_path)

    def client(self, name=None, path=None):
        client = Client(path or self.softgripd.socket_path)
        self.addCleanup(client.close)
        if name:
            client.ask("hello", client=name)
        return client

    def code(self, reply):
        self.assertFalse(reply["ok"], reply)
        return reply["error"]["code"]

    def test_hello_states_the_role_and_the_permitted_commands(self):
        operator = self.client().ask("hello", client="cell 4", api=1)["result"]
        self.assertEqual((operator["role"], operator["read_only"], operator["client"]), ("operate", False, "cell 4"))
        self.assertIn("start", operator["commands"])
        viewer = self.client(path=self.look).ask("hello")["result"]
        self.assertEqual((viewer["role"], viewer["read_only"], viewer["client"]), ("look", True, None))
        self.assertEqual(set(operator["commands"]) - set(viewer["commands"]),
                         {"start", "stop", "vent", "release", "acknowledge"})
        self.assertEqual(self.code(self.client().ask("hello", api=2)), "wrong_api")
        self.assertEqual(self.code(self.client().ask("hello", client="a\nb")), "bad_request")

    def test_a_read_only_client_cannot_move_the_rig(self):
        viewer = self.client("display", self.look)
        for command, keys in (("start", {"sequence": "pick_stone"}), ("stop", {}), ("vent", {}), ("release", {}),
                              ("acknowledge", {}), ("start", {"sequence": "pick_stone", "dry_run": True})):
            self.assertEqual(self.code(viewer.ask(command, **keys)), "not_allowed")
        self.softgripd.start("pick_stone")
        self.softgripd.wait_for_state("running")
        self.assertEqual(self.code(viewer.ask("vent")), "not_allowed")
        self.assertEqual(viewer.ask("status")["result"]["state"], "running")
        self.assertTrue(viewer.ask("statistics", histograms=True)["ok"])

    def test_read_only_clients_use_no_connections_of_operators(self):
        crowd = [self.client("viewer", self.look) for _ in range(16)]
        self.assertTrue(self.client("robot").ask("vent")["ok"])
        self.assertTrue(crowd[0].ask("status")["ok"])

    def test_other_clients_can_stop_but_not_start_or_release(self):
        robot, other = self.client("robot"), self.client("other")
        request = robot.ask("start", sequence="pick_stone")["result"]["request"]
        self.softgripd.wait_for_state("running")
        status = self.softgripd.status()
        self.assertEqual((status["owner"], status["sequence"]["client"]), ("robot", "robot"))
        for command, keys in (("start", {"sequence": "pick_stone"}), ("release", {}), ("acknowledge", {})):
            reply = other.ask(command, **keys)
            self.assertEqual(self.code(reply), "owned")
            self.assertEqual(reply["error"]["owner"], "robot")
        self.assertEqual(robot.ask("start", sequence="pick_stone")["error"]["refusal"]["name"], "not_idle")
        self.assertTrue(other.ask("stop")["ok"])
        self.softgripd.wait_for_state("idle")
        self.assertIsNone(self.softgripd.status()["owner"])
        by = {event["kind"]: event.get("client") for event in self.softgripd.events()
              if event.get("request") == request or event["kind"] == "state_changed"}
        self.assertEqual(by["sequence_started"], "robot")
        self.assertIn("other", [e.get("client") for e in self.softgripd.events() if e["kind"] == "state_changed"])

    def test_the_ownership_ends_when_the_owner_disconnects(self):
        robot, other = self.client("robot"), self.client("other")
        robot.ask("start", sequence="pick_stone")
        self.softgripd.wait_for_event("grip_result", code="HOLDING", channel="left")
        self.assertEqual(self.code(other.ask("release")), "owned")
        robot.close()
        bench.wait_for("no owner", lambda: self.softgripd.status()["owner"] is None)
        self.assertTrue(other.ask("release")["ok"])

    def test_a_dry_run_moves_nothing(self):
        robot = self.client("robot")
        reply = robot.ask("start", sequence="pick_stone", parameters={"squeeze_kpa": 4}, dry_run=True)
        would = reply["result"]["would_start"]
        self.assertEqual((would["name"], would["parameters"]["squeeze_kpa"]), ("pick_stone", 4))
        status = self.softgripd.status()
        self.assertEqual((status["state"], status["sequence"]), ("idle", None))
        checked = self.softgripd.wait_for_event("start_checked")
        self.assertEqual(checked["client"], "robot")
        self.assertEqual(max(self.board.commands_kpa()), min(self.board.commands_kpa()))
        for keys in ({"sequence": "none"}, {"sequence": "pick_stone", "parameters": {"squeeze_kpa": 400}}):
            self.assertEqual(self.code(robot.ask("start", dry_run=True, **keys)), "sequence_refused")
        self.softgripd.start("pick_stone")
        self.softgripd.wait_for_state("running")
        refused = robot.ask("start", sequence="pick_stone", dry_run=True)
        self.assertEqual(refused["error"]["refusal"]["name"], "not_idle")
        self.assertEqual(self.softgripd.status()["state"], "running")

    def test_the_overall_result_follows_the_results_of_the_fingers(self):
        self.assertEqual(self.softgripd.status()["result"], "-")
        self.softgripd.start("pick_stone")
        bench.wait_for("both fingers", lambda: self.softgripd.status()["result"] == "HOLDING")
        self.assertEqual(self.softgripd.results(), ["HOLDING", "HOLDING"])
        self.board.ask("object out")
        bench.wait_for("fingers without their part", lambda: self.softgripd.status()["result"] == "PART LOST")

    def test_a_reconnected_subscriber_receives_every_event(self):
        first = self.client("watcher")
        first.ask("subscribe", since=0)
        self.softgripd.start("pick_stone")
        seen = first.events(lambda e: e["kind"] == "sequence_started")
        first.close()
        self.softgripd.wait_for_event("grip_result", code="HOLDING", channel="left")
        second = self.client("watcher")
        begun = second.ask("subscribe", since=seen[-1]["id"])["result"]
        self.assertEqual(begun["since"], seen[-1]["id"])
        seen += second.events(lambda e: e["kind"] == "sequence_finished")
        self.assertEqual([e["id"] for e in seen], list(range(1, len(seen) + 1)))
        self.assertEqual(self.softgripd.end(), 0)
        # A new daemon numbers its events from one. A client must therefore receive all events of the new daemon,
        # regardless of the events that it has received from the previous daemon.
        again = self.idle_daemon(self.rig_path)
        third = self.client("watcher")
        new = third.ask("subscribe", since=seen[-1]["id"], started_at=begun["started_at"])["result"]
        self.assertEqual(new["since"], 0)
        self.assertNotEqual(new["started_at"], begun["started_at"])
        self.assertEqual(third.events(lambda e: e["kind"] == "daemon_started")[0]["id"], 1)

    def test_a_slow_subscriber_blocks_no_client_and_receives_every_event(self):
        slow = self.client("slow")
        slow.ask("subscribe", since=0)
        slow.ask("watch", rate_hz=50)
        time.sleep(3)  # meanwhile, lines with the state fill the kernel's buffers of this connection
        asking = self.client("busy")
        for _ in range(5):  # each acknowledgement causes an event
            asking.ask("acknowledge")
        newest = self.softgripd.result("events", limit=1)["newest"]
        told = slow.told
        ids = []
        while not ids or ids[-1] != newest:
            try:
                told.append(slow.line())
            except AssertionError:
                # The daemon closes a connection whose data the client has not read for ten seconds. On a very busy
                # machine, this may have happened here.
                slow = self.client("slow")
                slow.ask("subscribe", since=ids[-1] if ids else 0)
                told += slow.told
            ids = [line["event"]["id"] for line in told if "event" in line]
        self.assertEqual(ids, list(range(1, newest + 1)))

    def test_deprecated_names_have_the_values_of_their_successors(self):
        status, statistics = self.softgripd.status(), self.softgripd.result("statistics")
        for channel in status["channels"]:
            self.assertEqual(channel["deficit_mm"], channel["shortfall_mm"])
        self.assertEqual(status["loop"]["slips"], status["loop"]["overruns"])
        for kind in ("woken_late", "took_long"):
            self.assertEqual(statistics["loop"][f"slips_{kind}"], statistics["loop"][f"overruns_{kind}"])
        self.assertEqual(statistics["bus"]["slips"], statistics["bus"]["overruns"])
        steps = status["real_time"]["steps"]
        self.assertTrue(steps)
        for step in steps:
            self.assertEqual(step["outcome"], "not asked for" if step["result"] == "not_requested" else step["result"])
        self.assertIn("not_requested", {step["result"] for step in steps})


class Thermometer(bench.BenchTest):
    def test_the_measured_temperature_is_shown_by_status_and_screen(self):
        text = (self.folder / "config/rig.yaml").read_text()
        for old, new in (("displacement_noise_mm: 0.03", "displacement_noise_mm: 0.03\n        temperature_c: 31"),
                         ("channel_defaults:", "channel_defaults:\n  temperature_sensor: "
                          "{input: 7, at_v: [0, 10], is_c: [-20, 80], valid_v: [0.1, 9.9]}\n#"),
                         ("/tmp/softgrip-runs", f"{self.folder}/runs"), ("/tmp/softgrip.sock", f"{self.folder}/softgripd.sock")):
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        rig = self.folder / "config/warm.yaml"
        rig.write_text(text)
        softgripd = self.idle_daemon(rig)
        temperatures = [channel["temperature_c"] for channel in softgripd.status()["channels"]]
        self.assertAlmostEqual(temperatures[0], 31, delta=0.1)
        self.assertAlmostEqual(temperatures[1], 20, delta=0.1)
        self.assertIn(", 31.0 C", self.softgrip("status").stdout)


class Schema(bench.unittest.TestCase):
    def test_the_schema_rejects_wrong_unknown_and_missing_values(self):
        reply = {"id": None, "ok": True, "result": {"request": 1}}
        api_schema.check(reply, "vent")
        for wrong in ({"request": "1"}, {"request": 1, "more": 2}, {}):
            with self.assertRaises(AssertionError):
                api_schema.check({**reply, "result": wrong}, "vent")
        with self.assertRaises(AssertionError):
            api_schema.check({"id": 1, "ok": False, "error": {"code": "new", "message": ""}})


if __name__ == "__main__":
    bench.main()
