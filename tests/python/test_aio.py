"""Tests the asyncio client with several tasks and with a cancelled task. A cancelled program must end and must first stop
its sequence. A daemon is imitated in the same event loop, so the order of events is the same in each run."""

import asyncio
import contextlib
import json
import pathlib
import tempfile
import unittest

import package  # noqa: F401
import softgrip
from test_malformed import RESULTS

# Largest number of steps of the event loop before the cancellation. The program ends before this step.
MOST_STEPS = 150


class Daemon:
    """Answers each request. Stores the requests and the number of open connections."""

    def __init__(self):
        self.requests = []
        self.connections = 0

    async def serve(self, reader, writer):
        self.connections += 1
        with contextlib.suppress(ConnectionError):
            while line := await reader.readline():
                request = json.loads(line)
                self.requests.append(request["command"])
                result = RESULTS.get(request["command"], ({}, None))[0]
                writer.write(json.dumps({"id": request["id"], "ok": True, "result": result}).encode() + b"\n")
        self.connections -= 1
        writer.close()


class Cancellation(unittest.TestCase):
    def test_a_cancelled_program_ends_and_stops_its_sequence_at_each_step(self):
        stopped = ended = 0
        for steps in range(MOST_STEPS):
            with self.subTest(steps=steps):
                cancelled, requests = asyncio.run(self.cancelled_after(steps))
                if not cancelled:
                    ended += 1
                    continue
                self.assertEqual(requests.count("stop"), requests.count("start"), requests)
                stopped += requests.count("stop")
        self.assertGreater(stopped, 5, "too few cancellations while the sequence ran")
        self.assertGreater(ended, 5, "the last cancellations must come after the end of the program")

    async def cancelled_after(self, steps):
        """Returns True if the program was cancelled, or False if it had already ended; and the requests."""
        daemon = Daemon()
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder) / "daemon.sock")
            server = await asyncio.start_unix_server(daemon.serve, path)
            program = asyncio.create_task(self.program(path))
            for _ in range(steps):
                await asyncio.sleep(0)
            was_running = program.cancel()
            done, _ = await asyncio.wait({program}, timeout=10)
            for _ in range(MOST_STEPS):
                await asyncio.sleep(0)
            server.close()
            self.assertEqual(daemon.connections, 0, "the client left a connection open")
            self.assertTrue(done, "the program does not end")
            self.assertEqual(program.cancelled(), was_running, "the program continued after its cancellation")
            return was_running, daemon.requests

    @staticmethod
    async def program(path):
        async with softgrip.AsyncGripper(path, name="robot") as robot:
            await robot.status()
            await robot.start("pick")
            await robot.status()
            await robot.status()


class SlowDaemon(Daemon):
    """Replies to the second start only after `released` is set. The first sequence reports HOLDING and is done at once;
    the second sequence is stopped at once."""

    def __init__(self):
        super().__init__()
        self.released = asyncio.Event()
        self.event = 0

    async def serve(self, reader, writer):
        with contextlib.suppress(ConnectionError):
            while line := await reader.readline():
                request = json.loads(line)
                self.requests.append(request["command"])
                if request["command"] == "start":
                    await self.run(writer, request["id"], self.requests.count("start"))
                else:
                    self.reply(writer, request["id"], RESULTS.get(request["command"], ({}, None))[0])
        writer.close()

    async def run(self, writer, number, grip):
        if grip == 2:
            await self.released.wait()
        self.reply(writer, number, {"request": grip})
        told = (("overall_result", "HOLDING"), ("sequence_finished", "done"))
        for kind, code in told if grip == 1 else (("sequence_finished", "stopped"),):
            self.event += 1
            self.send(writer, id=1, event={"id": self.event, "time_s": 1.5, "at": "2026-11-21T09:00:00.000Z", "kind": kind,
                                           "severity": "information", "text": "t", "code": code, "request": grip})

    def reply(self, writer, number, result):
        self.send(writer, id=number, ok=True, result=result)

    @staticmethod
    def send(writer, **said):
        writer.write(json.dumps(said).encode() + b"\n")


class Tasks(unittest.TestCase):
    def test_a_task_that_waits_during_a_start_gets_the_result_of_this_start(self):
        asyncio.run(self.wait_during_a_start())

    async def wait_during_a_start(self):
        daemon = SlowDaemon()
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder) / "daemon.sock")
            server = await asyncio.start_unix_server(daemon.serve, path)
            async with softgrip.AsyncGripper(path, name="robot") as robot:
                await robot.start("pick")
                self.assertEqual(await robot.wait(timeout_s=5), softgrip.SequenceEnd.DONE)
                starting = asyncio.create_task(robot.start("pick"))
                while daemon.requests.count("start") < 2:
                    await asyncio.sleep(0)
                holding = asyncio.create_task(robot.wait_until(softgrip.Result.HOLDING, timeout_s=5))
                ending = asyncio.create_task(robot.wait(timeout_s=5))
                done, _ = await asyncio.wait({holding, ending}, timeout=0.05)
                self.assertFalse(done, "the call returned before the reply to the start")
                daemon.released.set()
                await starting
                self.assertEqual(await ending, softgrip.SequenceEnd.STOPPED)
                with self.assertRaises(softgrip.GripFailed):
                    await holding
            server.close()


if __name__ == "__main__":
    unittest.main()
