"""Tests a PLC that grips through softgrip-plc. The tests cover counters, registers, a Modbus client (master) that
becomes silent, and the end and the start of a daemon."""

import contextlib
import socket
import time

import bench
import pauses
import plc
from pymodbus.exceptions import ModbusException


class Gateway(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.start_rig()

    def gateway(self, **keys):
        process = plc.Plc(self.folder, **keys)
        self.processes.append(process)
        return process

    def master(self, gateway):
        master = plc.Master(gateway)
        self.addCleanup(master.close)
        master.wait("state", plc.IDLE)
        return master

    def test_a_plc_grip_uses_the_requested_gripping_pressure(self):
        master = self.master(self.gateway())
        self.assertEqual(master.read("map_version"), 1)
        self.assertEqual(master.command(plc.START, recipe=1, squeeze=425), (plc.ACCEPTED, 0))
        master.wait("result", plc.HOLDING)
        self.assertEqual(self.softgripd.status()["sequence"]["parameters"]["squeeze_kpa"], 4.25)
        self.assertEqual(master.read("state"), plc.RUNNING)
        self.assertEqual(master.read("fingers"), 2)
        for finger in (0, 1):
            self.assertEqual(master.finger(finger, "result"), plc.HOLDING)
            self.assertAlmostEqual(master.finger(finger, "displacement") / 100, 12.3, delta=1)
            self.assertEqual(master.finger(finger, "valid"), 1)
        self.assertEqual(master.command(plc.RELEASE), (plc.ACCEPTED, 0))
        master.wait("result", plc.RELEASED)
        master.wait("state", plc.IDLE)
        self.assertEqual(len(plc.started(self.softgripd)), 1)

    def test_a_repeated_counter_value_starts_no_sequence(self):
        master = self.master(self.gateway())
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        for _ in range(50):
            master.write("command_counter", master.counter, plc.START, 1)
        self.assertEqual(master.command(plc.STOP)[0], plc.ACCEPTED)
        self.softgripd.wait_for_state("idle")
        for _ in range(50):
            master.write("command_counter", master.counter, plc.START, 1)
        self.assertEqual(len(plc.started(self.softgripd)), 1)
        self.assertEqual(self.softgripd.status()["state"], "idle")

    def test_an_old_command_block_of_a_second_client_starts_no_sequence(self):
        gateway = self.gateway()
        master = self.master(gateway)
        second = plc.Master(gateway, synchronise=False)
        self.addCleanup(second.close)
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        old = master.counter
        self.assertEqual(master.command(plc.VENT)[0], plc.ACCEPTED)
        self.softgripd.wait_for_state("idle")
        for _ in range(20):
            second.write("command_counter", old, plc.START, 1)
            # The client with the wrong counter reads the reason for the refusal. The other client reads the outcome of
            # its own command.
            self.assertEqual((second.read("outcome"), second.read("reason")), (plc.REFUSED, plc.NOT_NEXT))
            self.assertEqual(master.done(master.counter), (plc.ACCEPTED, 0))
        for wrong in (0, master.counter + 2, 65535):
            second.write("command_counter", wrong, plc.START, 1)
            self.assertEqual(second.read("reason"), plc.NOT_NEXT)
        self.assertEqual(second.read("done_counter"), master.counter)
        self.assertEqual(len(plc.started(self.softgripd)), 1)
        self.assertEqual(self.softgripd.status()["state"], "idle")
        second.synchronise()
        self.assertEqual(second.command(plc.START, recipe=1), (plc.ACCEPTED, 0))

    def test_the_late_rest_of_an_incomplete_request_starts_no_sequence(self):
        gateway = self.gateway()
        master = self.master(gateway)
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        late = []
        # Two late requests. The first one has an old counter value. The second one has the value that is the next one
        # when the rest of the request arrives.
        for counter in (master.counter, master.counter + 2):
            client = socket.create_connection(("127.0.0.1", gateway.port))
            self.addCleanup(client.close)
            client.settimeout(bench.PATIENCE_S)
            # Sends a complete request before the half request. When the reply to the complete request arrives, the
            # gateway has also received the half request.
            client.sendall(plc.block(master.counter, 0) + plc.block(counter, plc.START, 1)[:11])
            self.assertEqual(len(client.recv(100)), 12)
            late.append((client, plc.block(counter, plc.START, 1)[11:]))
        self.assertEqual(master.command(plc.VENT)[0], plc.ACCEPTED)
        for client, rest in late:
            with contextlib.suppress(ConnectionResetError, BrokenPipeError):
                client.sendall(rest)
                self.assertEqual(client.recv(1), b"")
        self.softgripd.wait_for_state("idle")
        self.assertEqual(master.read("done_counter"), master.counter)
        self.assertEqual(len(plc.started(self.softgripd)), 1)

    def test_registers_of_two_clients_are_not_combined_into_one_command(self):
        gateway = self.gateway()
        master = self.master(gateway)
        second = self.master(gateway)
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        master.write("command", plc.VENT)
        second.write("command", plc.START, 1)
        master.write("command_counter", master.counter + 1)
        self.assertEqual(master.done(master.counter + 1), (plc.ACCEPTED, 0))
        self.softgripd.wait_for_state("idle")
        self.assertEqual(len(plc.started(self.softgripd)), 1)

    def test_each_refusal_has_its_reason_code(self):
        master = self.master(self.gateway())
        self.assertEqual(master.command(9), (plc.REFUSED, plc.NO_SUCH_COMMAND))
        self.assertEqual(master.command(plc.START, recipe=77), (plc.REFUSED, plc.NO_SUCH_RECIPE))
        # The gripping pressure of this command is outside its permitted range.
        self.assertEqual(master.command(plc.START, recipe=1, squeeze=3000), (plc.REFUSED, 7))
        self.assertEqual(master.command(plc.STOP), (plc.REFUSED, 107))  # R07: there is no sequence to stop
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        self.assertEqual(master.command(plc.START, recipe=1), (plc.REFUSED, 102))  # R02: the daemon is not idle
        self.assertEqual(len(plc.started(self.softgripd)), 1)

    def test_a_restarted_gateway_does_not_execute_an_old_command(self):
        gateway = self.gateway()
        master = self.master(gateway)
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)
        counter = master.counter
        self.assertEqual(master.command(plc.STOP)[0], plc.ACCEPTED)
        self.softgripd.wait_for_state("idle")
        gateway.kill()
        again = plc.Plc(self.folder, name="softgrip-plc-again")
        self.processes.append(again)
        # A PLC that writes its registers in every cycle and does not detect the restart of the gateway.
        cyclic = plc.Master(again, synchronise=False)
        self.addCleanup(cyclic.close)
        for _ in range(20):
            cyclic.write("command_counter", counter, plc.START, 1)
        self.assertEqual(cyclic.done(counter), (plc.REFUSED, plc.FIRST_AFTER_START))
        time.sleep(0.3)
        self.assertEqual(len(plc.started(self.softgripd)), 1)
        cyclic.wait("state", plc.IDLE)
        cyclic.counter = counter
        self.assertEqual(cyclic.command(plc.START, recipe=1)[0], plc.ACCEPTED)

    def test_a_client_without_heartbeat_is_detected_and_the_rig_stops(self):
        master = self.master(self.gateway(changes=((r"silence_s: 2", "silence_s: 0.5"),)))
        self.assertEqual(master.command(plc.START, recipe=2)[0], plc.ACCEPTED)
        time.sleep(0.8)  # the gateway does not monitor a client that sends no heartbeat
        self.assertEqual((master.read("master"), self.softgripd.status()["state"]), (0, "running"))
        master.beat_until(lambda: master.read("result") == plc.HOLDING)
        self.assertEqual(master.read("master"), 1)
        ended = self.softgripd.wait_for_event("sequence_finished")
        self.assertEqual(ended["code"], "stopped")
        self.assertEqual(master.read("master"), 2)
        self.assertEqual(master.command(plc.START, recipe=1), (plc.REFUSED, plc.MASTER_SILENT))
        self.assertEqual(master.command(plc.VENT)[0], plc.ACCEPTED)
        self.softgripd.wait_for_state("idle")
        master.beat()
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)

    def test_the_reaction_to_a_silent_client_is_sent_to_the_next_daemon(self):
        """Tests a client that becomes silent. The daemon is killed before the gateway detects that the client is
        silent."""
        changes = ((r"silence_s: 2", "silence_s: 0.5"), (r"when_silent: stop", "when_silent: vent"))
        master = self.master(self.gateway(changes=changes))
        self.assertEqual(master.command(plc.START, recipe=2)[0], plc.ACCEPTED)
        master.beat_until(lambda: master.read("result") == plc.HOLDING)
        self.softgripd.kill()
        master.wait("master", 2)
        time.sleep(0.5)  # during this time, the gateway finds no daemon
        master.beat()
        # The gateway must send the stop for the silence even if the client returns.
        self.assertEqual(master.read("master"), 2)
        again = self.daemon(self.rig_path)
        again.wait_for_event("state_changed", client="softgrip-plc")
        master.beat_until(lambda: master.read("master") == 1)
        master.beat_until(lambda: master.read("state") == plc.IDLE)

    def test_the_reaction_to_a_silent_client_is_sent_after_a_daemon_stall(self):
        """Tests a client and a daemon that become silent within 40 ms. The control loop of the silent daemon continues
        the grip."""
        for lead_s in (-0.04, -0.02, 0, 0.02, 0.04):
            with self.subTest(lead_s=lead_s):
                master = self.master(self.gateway(changes=(("silence_s: [0-9.]+", "silence_s: 1.2"),)))
                self.assertEqual(master.command(plc.START, recipe=2)[0], plc.ACCEPTED)
                master.beat_until(lambda: master.read("result") == plc.HOLDING)
                newest = self.softgripd.events()[-1]["id"]
                time.sleep(max(0, lead_s))
                try:
                    pauses.pause(self.softgripd, "softgrip-serve", 3)
                except PermissionError as error:
                    self.skipTest(str(error))
                ended = self.softgripd.wait_for_event("sequence_finished", since=newest)
                self.assertEqual(ended["code"], "stopped")
                self.processes.pop().end()
                self.assertTrue(self.softgripd.ask("vent")["ok"])
                self.softgripd.wait_for_state("idle")

    def test_commands_are_refused_without_a_daemon_and_accepted_with_a_new_one(self):
        master = self.master(self.gateway())
        self.assertEqual(master.command(plc.START, recipe=2)[0], plc.ACCEPTED)
        self.softgripd.kill()
        master.wait("state", plc.NO_DAEMON_STATE)
        self.assertEqual((master.read("fingers"), master.finger(0, "displacement")), (0, plc.NOT_GIVEN))
        self.assertEqual(master.command(plc.VENT), (plc.REFUSED, plc.NO_DAEMON))
        before = master.read("heartbeat")
        bench.wait_for("its heartbeat", lambda: master.read("heartbeat") != before)
        again = self.daemon(self.rig_path)
        master.wait("state", plc.IDLE)
        self.assertEqual(plc.started(again), [])
        self.assertEqual(master.command(plc.START, recipe=1)[0], plc.ACCEPTED)

    def test_the_gateway_limits_clients_and_closes_idle_connections(self):
        gateway = self.gateway(changes=((r"max_masters: 4", "max_masters: 2"), (r"idle_s: 60", "idle_s: 5")))
        master = self.master(gateway)
        other = socket.create_connection(("127.0.0.1", gateway.port))
        self.addCleanup(other.close)
        bench.wait_for("its place", lambda: master.read("map_version") == 1)
        crowd = [socket.create_connection(("127.0.0.1", gateway.port)) for _ in range(50)]
        for client in crowd:
            client.settimeout(bench.PATIENCE_S)
            self.assertEqual(client.recv(1), b"")
            client.close()
            master.read("state")  # the gateway keeps the connection of a client that sends requests

        def others_place():
            master.read("state")
            other.settimeout(0.05)
            try:
                return other.recv(1) == b""
            except TimeoutError:
                return False
        bench.wait_for("the end of the silent connection", others_place)
        self.assertEqual(master.command(plc.VENT)[0], plc.ACCEPTED)

    def test_a_client_can_replace_its_dead_connections(self):
        """Tests that a client can replace its dead connections. The gateway keeps a dead connection for up to a
        minute, but must accept a new connection of the same client much earlier."""
        gateway = self.gateway()
        dead = [self.master(gateway) for _ in range(4)]
        alive = bench.wait_for("a place", lambda: self.connected(gateway))
        self.assertEqual(alive.command(plc.VENT)[0], plc.ACCEPTED)
        self.assertEqual(dead[0].client.socket.recv(1), b"")

    def connected(self, gateway):
        try:
            master = plc.Master(gateway)
        except (ConnectionError, ModbusException):
            return None
        self.addCleanup(master.close)
        return master

    def test_a_daemon_with_a_full_queue_does_not_block_the_clients(self):
        path = self.folder / "full.sock"
        full = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.addCleanup(full.close)
        full.bind(str(path))
        full.listen(0)
        with contextlib.suppress(BlockingIOError):
            for _ in range(100):
                client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
                self.addCleanup(client.close)
                client.setblocking(False)
                client.connect(str(path))
        gateway = self.gateway(socket=path)
        master = plc.Master(gateway)
        self.addCleanup(master.close)
        before = master.read("heartbeat")
        bench.wait_for("its heartbeat", lambda: master.read("heartbeat") != before)
        self.assertEqual(master.command(plc.VENT), (plc.REFUSED, plc.NO_DAEMON))

    def test_a_client_outside_the_allow_list_is_disconnected(self):
        gateway = self.gateway(changes=((r"allow: \[127.0.0.1\]", "allow: [127.0.0.2]"),))
        with socket.create_connection(("127.0.0.1", gateway.port)) as client:
            client.settimeout(bench.PATIENCE_S)
            self.assertEqual(client.recv(1), b"")

    def test_a_refused_address_is_printed_once(self):
        gateway = self.gateway(changes=((r"allow: \[127.0.0.1\]", "allow: [127.0.0.2]"),))
        for _ in range(2):
            with socket.create_connection(("127.0.0.1", gateway.port)) as client:
                client.settimeout(bench.PATIENCE_S)
                self.assertEqual(client.recv(1), b"")
        self.assertEqual(gateway.errors().count("refused a connection from 127.0.0.1"), 1, gateway.errors())

    def test_malformed_bytes_close_only_their_own_connection(self):
        gateway = self.gateway()
        master = self.master(gateway)
        for data in (b"GET / HTTP/1.1\r\n\r\n", b"\xff" * 5000, bytes([0, 1, 0, 0, 0, 0, 1, 3])):
            with socket.create_connection(("127.0.0.1", gateway.port)) as client:
                client.settimeout(bench.PATIENCE_S)
                client.sendall(data)
                with bench.contextlib.suppress(ConnectionResetError):
                    self.assertEqual(client.recv(1), b"")
        self.assertEqual(master.read("state"), plc.IDLE)


if __name__ == "__main__":
    bench.main()
