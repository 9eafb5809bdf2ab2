"""Tests the end of the `with` block of a Python client after any event in the block. The sequence of this client must
have ended, or an exception must state that it may still run. No sequence of another client may be stopped."""

import asyncio
import contextlib
import os
import random
import signal
import subprocess
import sys
import time
import traceback

import bench
import quiet_rig
from quiet_rig import LONG, SHORT
from socket_proxy import TO_CLIENT, TO_DAEMON, SocketProxy

sys.path.insert(0, str(bench.SOURCE / "python"))

import softgrip  # noqa: E402

# A failed test prints the seed of its random values. SOFTGRIP_SEEDS=FIRST:COUNT runs COUNT seeds from FIRST
# on.
FIRST_SEED, SEEDS = map(int, os.environ.get("SOFTGRIP_SEEDS", "1:25").split(":"))
# Time [s] for which a client waits for a reply, and a longer time for which the daemon is silent.
ANSWER_S = 0.4
SILENCE_S = 0.7

ROBOT = """
import sys
import softgrip
path, text, answer_s = sys.argv[1], sys.argv[2], float(sys.argv[3])
with softgrip.Gripper(path, name="robot", answer_s=answer_s) as gripper:
    print("ready", flush=True)
    gripper.start("long", text=text)
    print("started", flush=True)
    gripper.wait(timeout_s=60)
"""
ASYNCIO_ROBOT = """
import asyncio, sys
import softgrip
async def work(path, text, answer_s):
    async with softgrip.AsyncGripper(path, name="robot", answer_s=float(answer_s)) as gripper:
        print("ready", flush=True)
        await gripper.start("long", text=text)
        print("started", flush=True)
        await gripper.wait(timeout_s=60)
asyncio.run(work(*sys.argv[1:]))
"""


class BlockExit(quiet_rig.QuietRigTest):
    def proxy(self):
        proxy = SocketProxy(self.folder / "proxy.sock", self.path)
        self.addCleanup(proxy.close)
        return proxy

    def gripper(self, path=None, name="robot", answer_s=bench.PATIENCE_S):
        return softgrip.Gripper(path or self.path, name=name, answer_s=answer_s)

    def starts(self, client="robot"):
        return [event["request"] for event in self.softgripd.events()
                if event["kind"] == "sequence_started" and event.get("client") == client]

    def test_the_end_of_a_block_does_not_stop_another_client(self):
        with self.gripper() as robot:
            first = robot.start("short", text=SHORT).request
            self.wait_until_ended(first)
            self.softgripd.wait_for_state("idle")
            other = self.gripper(name="other")
            self.addCleanup(other.close)
            theirs = other.start("long", text=LONG).request
            # The robot program has not read yet that its own sequence has ended and that the sequence of another client
            # runs.
        self.assertEqual(self.running(), theirs)
        other.status()
        other.stop()
        self.assertEqual(self.wait_until_ended(theirs), "stopped")

    def test_the_end_of_an_async_block_does_not_stop_another_client(self):
        async def work():
            async with softgrip.AsyncGripper(self.path, name="robot", answer_s=bench.PATIENCE_S) as robot:
                await robot.start("short", text=SHORT)
                # The event loop of asyncio is blocked during this code, so the client reads nothing.
                self.wait_until_ended(self.starts()[-1])
                self.softgripd.wait_for_state("idle")
                return other.start("long", text=LONG).request

        other = self.gripper(name="other")
        self.addCleanup(other.close)
        theirs = asyncio.run(work())
        self.assertEqual(self.running(), theirs)

    def test_an_unconfirmed_stop_is_executed_when_the_daemon_resumes(self):
        """Tests a paused daemon and a stalled connection. The stop request then waits in the socket, and an exception
        must state that the stop is not confirmed."""
        proxy = self.proxy()
        for path, pause, resume in (
                (self.path, lambda: self.softgripd.send(signal.SIGSTOP), lambda: self.softgripd.send(signal.SIGCONT)),
                (proxy.path, proxy.hold, proxy.let_go)):
            with self.subTest(path):
                self.softgripd.wait_for_state("idle")
                with self.assertRaises(softgrip.StopNotConfirmed) as raised, self.gripper(path, answer_s=ANSWER_S) as robot:
                    request = robot.start("long", text=LONG).request
                    pause()
                    try:
                        robot.status()
                        self.fail("the daemon answers although it is paused")
                    except softgrip.NotAnswered:
                        pass
                self.assertIn(f"request {request}", str(raised.exception))
                self.assertIsInstance(raised.exception.__cause__, softgrip.NotAnswered)
                resume()
                self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_start_without_a_reply_is_stopped(self):
        proxy = self.proxy()
        for held in ((TO_CLIENT,), (TO_DAEMON,), (TO_DAEMON, TO_CLIENT)):
            with self.subTest(held):
                self.softgripd.wait_for_state("idle")
                before = self.starts()
                with self.assertRaises(softgrip.StopNotConfirmed) as raised, \
                        self.gripper(proxy.path, answer_s=ANSWER_S) as robot:
                    proxy.hold(*held)
                    robot.start("long", text=LONG)
                self.assertIn("without a reply", str(raised.exception))
                self.assertIn("NotAnswered", "".join(traceback.format_exception(raised.exception)))
                proxy.let_go()
                for request in self.starts()[len(before):]:
                    self.assertEqual(self.wait_until_ended(request), "stopped")
                time.sleep(0.2)
                self.assertIsNone(self.running(), "a stopped sequence must not begin later")

    def test_a_sequence_is_stopped_after_a_closed_connection(self):
        proxy = self.proxy()
        with self.gripper(proxy.path) as robot:
            request = robot.start("long", text=LONG).request
            proxy.cut()
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_an_async_sequence_is_stopped_after_a_closed_connection(self):
        async def work():
            async with softgrip.AsyncGripper(proxy.path, name="robot", answer_s=bench.PATIENCE_S) as robot:
                grip = await robot.start("long", text=LONG)
                proxy.cut()
                return grip.request

        proxy = self.proxy()
        self.assertEqual(self.wait_until_ended(asyncio.run(work())), "stopped")

    def test_an_unreachable_daemon_raises_stop_not_confirmed(self):
        proxy = self.proxy()
        with self.assertRaises(softgrip.StopNotConfirmed) as raised, self.gripper(proxy.path) as robot:
            request = robot.start("long", text=LONG).request
            proxy.refuses = True
            proxy.cut()
        self.assertIn("softgrip stop", str(raised.exception))
        self.assertEqual(self.running(), request, "the sequence must still run, because no stop was possible")

    def test_an_explicit_close_lets_the_sequence_continue(self):
        with self.gripper() as robot:
            request = robot.start("long", text=LONG).request
            robot.close()
        self.assertEqual(self.running(), request)

    def interrupted(self, path, chance):
        """Runs a robot's program. The program receives a SIGINT during start() or shortly after it."""
        program = chance.choice((ROBOT, ROBOT, ASYNCIO_ROBOT))
        robot = subprocess.Popen([sys.executable, "-c", program, path, LONG, str(bench.PATIENCE_S)], text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 env={**os.environ, "PYTHONPATH": str(bench.SOURCE / "python")})
        self.addCleanup(robot.kill)
        self.assertEqual(robot.stdout.readline(), "ready\n")
        time.sleep(chance.choice((0.002, 0.01, 0.05)) * chance.random())
        robot.send_signal(signal.SIGINT)
        _, errors = robot.communicate(timeout=bench.PATIENCE_S)
        self.assertEqual(robot.returncode, -signal.SIGINT, errors)
        self.assertIn("KeyboardInterrupt", errors)

    def test_ctrl_c_during_a_start_leaves_no_sequence_running(self):
        proxy = self.proxy()
        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            with self.subTest(seed=seed):
                chance = random.Random(seed)
                self.softgripd.wait_for_state("idle")
                self.interrupted(chance.choice((self.path, proxy.path)), chance)
                self.assertIsNone(self.running(), "the stop at the end of the block was confirmed")
        time.sleep(0.2)
        self.assertIsNone(self.running(), "a sequence started after its stop")
        self.assertEqual({self.ended(request) for request in self.starts()} - {"stopped"}, set())

    def test_a_cancelled_start_leaves_no_sequence_running(self):
        async def work(chance):
            async with softgrip.AsyncGripper(self.path, name="robot", answer_s=bench.PATIENCE_S) as robot:
                starting = asyncio.create_task(robot.start("long", text=LONG))
                await asyncio.sleep(0.02 * chance.random())
                starting.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await starting

        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            with self.subTest(seed=seed):
                self.softgripd.wait_for_state("idle")
                asyncio.run(work(random.Random(seed)))
                self.assertIsNone(self.running())
        time.sleep(0.2)
        self.assertIsNone(self.running())
        self.assertEqual({self.ended(request) for request in self.starts()} - {"stopped"}, set())

    def test_other_clients_do_not_displace_an_owner_or_a_subscriber(self):
        with self.gripper() as robot:
            request = robot.start("long", text=LONG).request
            subscriber = self.gripper(name="subscriber")
            self.addCleanup(subscriber.close)
            # Clients that send requests continuously use all other connections of the daemon.
            crowd = [bench.Lines(self.path) for _ in range(13)]
            for client in crowd:
                self.addCleanup(client.close)
            began = time.monotonic()
            refused = 0
            while time.monotonic() - began < 6:  # longer than the time after which the daemon closes the connection of
                                                 # a silent client
                self.softgripd.status()
                for client in crowd:
                    client.ask('{"command":"sequences"}')
                late = bench.Lines(self.path)
                refused += "at most 16 clients" in late.ask('{"command":"status"}')
                late.close()
                time.sleep(0.1)
            self.assertGreater(refused, 0)
            self.assertEqual(self.softgripd.status()["owner"], "robot")
            self.assertEqual(subscriber.status().owner, "robot")
            self.assertEqual(robot.status().sequence.request, request)
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_17th_client_is_refused_and_an_owner_can_still_stop(self):
        proxy = self.proxy()
        # The test itself uses one of the 16 connections.
        subscribers = [self.gripper(path, name="subscriber") for path in [proxy.path] + 14 * [self.path]]
        for subscriber in subscribers:
            self.addCleanup(subscriber.close)
        time.sleep(5.5)
        self.softgripd.status()
        with self.assertRaisesRegex(softgrip.ConnectionLost, "at most 16 clients"):
            self.gripper(name="late")
        # The daemon must execute a stop although all connections are in use. This also holds if the stopping program
        # has lost its connection.
        with subscribers[0] as robot:
            request = robot.start("long", text=LONG).request
            proxy.cut()
            late = self.gripper(name="takes the place")
            self.addCleanup(late.close)
        self.assertEqual(self.wait_until_ended(request), "stopped")
        for subscriber in subscribers[1:]:
            self.assertEqual(subscriber.status().state, softgrip.State.IDLE)

    def test_a_sequence_is_stopped_after_a_malformed_line(self):
        """Tests a server that sends arbitrary lines. The client must raise an exception of the package, and the
        sequence must be stopped."""
        proxy = self.proxy()
        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            with self.subTest(seed=seed):
                chance = random.Random(seed)
                self.softgripd.wait_for_state("idle")
                before = len(self.starts())
                said = chance.choice((b"\n", b"{\n", b"[]\n", b'{"ok":1}\n', b'{"event":{}}\n', b'{"id":[],"ok":true}\n',
                                      b'{"id":2,"ok":true,"result":7}\n', b"\xff\xfe\n", b"[" * 100_000 + b"\n",
                                      bytes(chance.randrange(256) for _ in range(50)) + b"\n",
                                      b'{"id":3,"ok":false,"error":{"code":"refused","message":"m"}}\n'))
                with contextlib.suppress(softgrip.SoftgripError), self.gripper(proxy.path, answer_s=ANSWER_S) as robot:
                    when = chance.randrange(3)
                    if when == 0:
                        proxy.inject(said)
                    robot.start("long", text=LONG)
                    if when == 1:
                        proxy.inject(said)
                    robot.status()
                    if when == 2:
                        proxy.inject(said)
                    robot.wait(timeout_s=0.3)
                for request in self.starts()[before:]:
                    self.assertEqual(self.wait_until_ended(request), "stopped")
                self.assertIsNone(self.running())

    def test_an_endless_line_raises_a_protocol_error(self):
        proxy = self.proxy()
        for use in (self.read_sync, self.read_async):
            with self.subTest(use.__name__), self.assertRaisesRegex(softgrip.ProtocolError, "longer than"):
                use(proxy)

    def read_sync(self, proxy):
        with self.gripper(proxy.path) as robot:
            proxy.inject(b"x" * (17 << 20))
            robot.status()

    def read_async(self, proxy):
        async def work():
            async with softgrip.AsyncGripper(proxy.path, name="robot", answer_s=bench.PATIENCE_S) as robot:
                proxy.inject(b"x" * (17 << 20))
                await robot.status()
                await robot.wait(timeout_s=bench.PATIENCE_S)

        asyncio.run(work())

    def test_two_random_faults_leave_no_unreported_sequence_running(self):
        """Runs random stalls, closed connections, damaged lines and exceptions. Two clients use the rig in turn. The
        seed determines the series of events."""
        proxy = self.proxy()
        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            with self.subTest(seed=seed):
                self.softgripd.wait_for_state("idle")
                self.one_world(random.Random(seed), proxy)
                proxy.refuses = False
                proxy.cut()
                proxy.let_go()

    def one_world(self, chance, proxy):
        before = len(self.starts())
        other = self.gripper(name="other")
        theirs = None
        raised = None

        def fault():
            chance.choice((proxy.cut, proxy.hold, lambda: proxy.hold(TO_CLIENT), lambda: proxy.hold(TO_DAEMON),
                           lambda: proxy.inject(b"\xff\n"), lambda: None, lambda: setattr(proxy, "refuses", True)))()

        class Interrupt(BaseException):
            pass

        def sequence_of_another():
            nonlocal theirs
            if chance.random() < 0.5:
                with contextlib.suppress(softgrip.SoftgripError):
                    theirs = other.start("long", text=LONG).request

        try:
            with self.gripper(proxy.path, answer_s=ANSWER_S) as robot:
                robot.start("robot", text=chance.choice((SHORT, LONG)))
                fault()
                time.sleep(chance.choice((0, 0.3)))
                sequence_of_another()
                fault()
                if chance.random() < 0.5:
                    raise Interrupt
                robot.start("robot", text=LONG)
        except (softgrip.SoftgripError, Interrupt) as error:
            raised = error
        own = self.starts()[before:]
        proxy.let_go()
        if isinstance(raised, softgrip.StopNotConfirmed):
            # If the connection was not closed, the daemon executes the requests that waited in the socket.
            time.sleep(0.1)
        else:
            self.assertNotIn(self.running(), own, raised)
        if theirs is not None:
            self.assertIsNone(self.ended(theirs), "the robot has stopped the sequence of another client")
        with contextlib.suppress(softgrip.Refused):
            other.stop()
        other.close()


if __name__ == "__main__":
    bench.main()
