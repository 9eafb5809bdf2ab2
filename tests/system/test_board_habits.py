"""Tests boards with unusual behaviour that users have reported. The status, the events and softgrip doctor must
describe this behaviour."""

import datetime
import json
import socket
import socketserver
import threading

import bench


class OneTable(socketserver.ThreadingTCPServer):
    """A proxy in front of an emulator. The emulator answers both read functions. Through the proxy, only one of the two
    functions can read the inputs (registers 0 to 15)."""
    daemon_threads = allow_reuse_address = True

    def __init__(self, behind, function, code):
        class Connection(socketserver.BaseRequestHandler):
            def handle(self):
                with socket.create_connection(("127.0.0.1", behind)) as board:
                    while request := self.request.recv(300):
                        of_inputs = request[7] in (3, 4) and int.from_bytes(request[8:10], "big") < 16
                        if of_inputs and request[7] != function:
                            self.request.sendall(request[:4] + bytes([0, 3, request[6], request[7] | 128, code]))
                        else:
                            board.sendall(request)
                            self.request.sendall(board.recv(300))
        super().__init__(("127.0.0.1", 0), Connection)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class BoardHabits(bench.BenchTest):
    def habit(self, kind, *arguments):
        """Starts an emulator that has this unusual behaviour from the start."""
        emulator = self.emulator("--faults", self.write("habit.yaml", f"faults:\n  - {{name: it, kind: {kind}}}\n"),
                                 *arguments)
        emulator.ask("fault it")
        return emulator

    def kinds(self, daemon):
        return [event["kind"] for event in daemon.events()]

    def test_a_connection_closed_at_once_does_not_count_as_connected(self):
        emulator = self.habit("disconnect")
        rig = self.rig(emulator.port)
        finding = next(f for f in json.loads(self.softgrip("doctor", "--rig", rig, "--json", expect=6).stdout)["findings"]
                       if f["name"] == "board")
        self.assertIn("closed it before the first response", finding["text"])
        self.assertIn("no further client", finding["advice"])
        daemon = self.daemon(rig)
        bench.wait_for("what happens", lambda: daemon.status()["bus"]["failure_kind"] == "closed_at_once")
        bench.wait_for("more attempts", lambda: daemon.status()["bus"]["attempts"] > 3)
        status = daemon.status()["bus"]
        self.assertFalse(status["connected"])
        self.assertIn("closed it before the first response", status["failure"])
        self.assertNotIn("bus_connected", self.kinds(daemon))
        self.assertIn("closed it before", " ".join(self.softgrip("status").stdout.split()))
        finding = next(f for f in json.loads(self.softgrip("doctor", "--json", expect=6).stdout)["findings"]
                       if f["name"] == "board")
        self.assertIn("no further client", finding["advice"])
        emulator.ask("clear it")
        daemon.wait_for_state("idle")
        self.assertIn("bus_connected", self.kinds(daemon))
        self.assertIsNone(daemon.status()["bus"]["failure_kind"])

    def test_a_board_that_ignores_early_requests_needs_settle_s(self):
        emulator = self.habit("settling, settle_s: 0.6")
        changes = [(r"connect_deadline_s: [\d.]+", "connect_deadline_s: 3")]
        self.assertNotIn("settle_s", self.rig(emulator.port, changes).read_text())
        daemon = self.daemon(self.rig(emulator.port, changes))
        bench.wait_for("attempts", lambda: daemon.status()["bus"]["attempts"] > 2, patience_s=30)
        self.assertEqual(daemon.status()["state"], "starting")
        daemon.end()
        changes = [(r"connect_deadline_s: [\d.]+", "connect_deadline_s: 3\n    settle_s: 0.6")]
        daemon = self.idle_daemon(self.rig(emulator.port, changes))
        emulator.ask("clear it")

    def test_a_silent_board_is_used_within_0_5_s_of_its_first_response(self):
        emulator = self.habit("lost_request")
        daemon = self.daemon(self.rig(emulator.port))
        bench.wait_for("attempts", lambda: daemon.status()["bus"]["attempts"] > 2, patience_s=30)
        self.assertEqual(daemon.status()["state"], "starting")
        emulator.ask("clear it")
        daemon.wait_for_state("idle")
        at = {event["kind"]: datetime.datetime.fromisoformat(event["at"].replace("Z", "+00:00"))
              for event in reversed(daemon.events()) if event["kind"] == "bus_connected" or event.get("code") == "idle"}
        took_s = (at["state_changed"] - at["bus_connected"]).total_seconds()
        print(f"idle {took_s:.3f} s after the first answer of the board")
        self.assertLess(took_s, 0.5)

    def board(self, name, *changes):
        """Writes a changed copy of the emulator's board map as config/boards/NAME.yaml."""
        text = (self.folder / "config/boards/softgrip-sim.yaml").read_text().replace("timeout_s: 0.2", "timeout_s: 2")
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / f"config/boards/{name}.yaml").write_text(text)
        return name

    def described(self, port, board, session=""):
        """Writes a rig file that uses this board map. `session` contains additional keys of the session."""
        return self.rig(port, [(r"map: boards/adam-6024.yaml", f"map: boards/{board}.yaml"), (r"unit: 1", "unit: 1" + session)])

    def examined(self, described, emulated, *arguments, fault="", session="", in_front=None):
        """Returns the report of softgrip doctor about a board that does not match its board map."""
        if fault:
            arguments += ("--faults", self.write("fault.yaml", f"faults:\n  - {{name: it, kind: {fault}}}\n"))
        emulator = self.emulator(*arguments, board=emulated)
        if fault:
            emulator.ask("fault it")
        port = in_front(emulator.port) if in_front else emulator.port
        report = json.loads(self.softgrip("doctor", "--rig", self.described(port, described, session), "--json",
                                          expect=6).stdout)
        found = [f for f in report["findings"] if f["name"].startswith("modbus ")]
        self.assertEqual(len(found), 1, report)
        self.assertEqual(found[0]["verdict"], "fail")
        return found[0]

    def assert_says(self, finding, text, advice):
        self.assertIn(text, finding["text"])
        self.assertIn(advice, finding["advice"])

    def test_doctor_suggests_the_correct_word_order(self):
        plain = self.board("plain")
        for order in ("low_first", "high_first_bytes_swapped", "low_first_bytes_swapped"):
            with self.subTest(order):
                other = self.board(order, ("word_order: high_first", f"word_order: {order}"))
                self.assert_says(self.examined(plain, other), "are implausible with the word order `high_first`", f"word_order: {order}")

    def test_doctor_reports_addresses_that_are_off_by_one(self):
        inputs = "function: 3\n  address: 0\n  count: 8"
        at = {n: self.board(f"at_{n}", (inputs, inputs.replace("0", str(n)))) for n in (1, 400, 401)}
        self.assert_says(self.examined(at[1], self.board("plain")), "One register lower", "address_base: 1")
        self.assert_says(self.examined(at[400], at[401]), "accepts the request if it begins one register higher, at 401", "by one")

    def test_doctor_suggests_the_read_function_that_the_board_accepts(self):
        inputs, apart = "function: 3\n  address: 0\n  count: 8", ("fc23: true", "fc23: false")
        of = {3: self.board("of_3", apart), 4: self.board("of_4", apart, (inputs, inputs.replace("3", "4", 1)))}
        plain = self.board("plain")

        def only(function, code):
            def in_front(port):
                server = OneTable(port, function, code)
                self.addCleanup(server.server_close)
                self.addCleanup(server.shutdown)
                return server.server_address[1]
            return in_front

        for function, other in ((3, 4), (4, 3)):
            for code in (1, 2):
                with self.subTest(function=function, code=code):
                    self.assert_says(self.examined(of[function], of[other], in_front=only(other, code)),
                                     f"(exception {code}); function {other} is accepted",
                                     f"write `function: {other}` for `inputs` in the board map")
        self.assert_says(self.examined(plain, plain, in_front=only(4, 2)), "function 4 is accepted", "`inputs` and `fc23: false`")

    def test_doctor_explains_modbus_exceptions(self):
        plain = self.board("plain")
        self.assert_says(self.examined(plain, plain, "--unit", "3"), "(exception 11); unit id 3 responds", "unit: 3")
        self.assert_says(self.examined(plain, plain, fault="few_registers, most: 8"), "(exception 3); the board accepts a request of 8 registers",
                         "max_registers: 8")
        self.assert_says(self.examined(plain, plain, fault="exception_reply, code: 1"), "(exception 1)", "with the manual")
        self.assert_says(self.examined(plain, plain, fault="exception_reply, code: 4"), "(exception 4)", "internal failure")

    def test_doctor_reports_another_framing_and_wrong_transaction_ids(self):
        plain = self.board("plain")
        self.assert_says(self.examined(plain, plain, "--rtu-over-tcp"), "the other framing", "framing: rtu")
        self.assert_says(self.examined(plain, plain, fault="wrong_transaction"), "responses of the board are correct",
                         "accept_no_transaction_id")

    def test_a_rig_file_that_describes_the_unusual_behaviour_works(self):
        plain = self.board("plain")
        few = self.board("few", ("fc23: true", "fc23: true\nmax_registers: 8"))
        risk = 'accept_no_transaction_id: "a late answer may pass for the answer to a later request"'
        for board, session, kind, arguments in (
                (plain, "framing: rtu", "stray_bytes, before: 1, behind: 2", ("--rtu-over-tcp",)),
                (plain, risk, "wrong_transaction", ()),
                (few, "repeat_after_s: 0.02", "few_registers, most: 8", ())):
            with self.subTest(kind):
                emulator = self.emulator("--faults", self.write("f.yaml", f"faults:\n  - {{name: it, kind: {kind}}}\n"),
                                         *arguments, board=board)
                emulator.ask("fault it")
                daemon = self.idle_daemon(self.described(emulator.port, board, f"\n    {session}"))
                self.assertEqual(daemon.end(), 0)

    def check(self, session):
        return self.softgrip("check", self.described(1502, self.board("plain"), session), expect=3).stderr

    def test_invalid_session_settings_are_rejected_with_their_line(self):
        for session, message in (
                ("settle_s: 0.5", "`settle_s` is not below `connect_deadline_s` (0.5 s)"),
                ("settle_s: -1", "`settle_s`"),
                ("repeat_after_s: 0.15", "`repeat_after_s` is not below `exchange_deadline_s` (0.15 s)"),
                ("framing: ascii", "`framing` must be `tcp` or `rtu`"),
                ("silence_s: 0.01", "silence_s"),
                ("accept_no_transaction_id: yes", "does not state the accepted risk word by word")):
            with self.subTest(session):
                told = self.check(f"\n    {session}")
                self.assertRegex(told, r"test_rig.yaml:14:\d+: ")
                self.assertIn(message, told)


if __name__ == "__main__":
    bench.main()
