"""Interrupts softgrip start with a signal. The program must stop only the sequence that it has started, and must end
by the signal."""

import json
import os
import random
import signal
import socket
import subprocess
import threading
import time

import bench
import quiet_rig
from socket_proxy import TO_CLIENT, TO_DAEMON, SocketProxy

FIRST_SEED, SEEDS = map(int, os.environ.get("SOFTGRIP_SEEDS", "1:25").split(":"))


class StartInterrupted(quiet_rig.QuietRigTest):
    def setUp(self):
        super().setUp()
        self.long = self.write("long.yaml", quiet_rig.LONG)
        self.short = self.write("short.yaml", quiet_rig.SHORT)

    def start(self, *arguments, sequence=None, path=None, output=subprocess.DEVNULL, restore_signals=True):
        process = subprocess.Popen([bench.SOFTGRIP, "start", *arguments, sequence or self.long], cwd=self.folder, text=True,
                                   stdout=output, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                                   restore_signals=restore_signals,
                                   env={**os.environ, "SOFTGRIP_SOCKET": str(path or self.path)})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until_running(self):
        return bench.wait_for("a sequence that runs", self.running)

    def ended_by(self, process):
        _, errors = process.communicate(timeout=bench.PATIENCE_S)
        return process.returncode, errors

    def test_a_signal_stops_the_sequence_and_ends_the_program(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
            with self.subTest(number):
                self.softgripd.wait_for_state("idle")
                process = self.start("--wait")
                request = self.wait_until_running()
                process.send_signal(number)
                self.assertEqual(self.ended_by(process), (-number, "softgrip: sequence stopped\n"))
                self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_signal_does_not_stop_the_sequence_of_another_client(self):
        process = self.start("--wait", sequence=self.short)
        request = self.wait_until_running()
        process.send_signal(signal.SIGSTOP)  # pauses the program, so that it does not detect the end of its sequence
        self.wait_until_ended(request)
        self.softgripd.wait_for_state("idle")
        theirs = self.softgripd.result("start", sequence="long", sequence_text=quiet_rig.LONG)["request"]
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGCONT)
        self.ended_by(process)
        self.assertEqual(self.running(), theirs)

    def test_an_interrupted_start_leaves_no_sequence_running(self):
        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            with self.subTest(seed=seed):
                chance = random.Random(seed)
                self.softgripd.wait_for_state("idle")
                process = self.start(*chance.choice(([], ["--wait"])))
                time.sleep(chance.choice((0.01, 0.1)) * chance.random())
                process.send_signal(signal.SIGINT)
                code, errors = self.ended_by(process)
                if code == 0:  # exit code 0: the daemon accepted the start before the signal, so the program did not
                               # wait
                    self.wait_until_running()
                    self.softgripd.result("stop")
                else:
                    self.assertEqual(code, -signal.SIGINT, errors)
                    self.assertIsNone(self.running(), errors)
        time.sleep(0.2)
        self.assertIsNone(self.running())

    def test_an_unconfirmed_stop_is_executed_when_the_daemon_resumes(self):
        proxy = SocketProxy(self.folder / "proxy.sock", self.path)
        self.addCleanup(proxy.close)
        for held in ((TO_CLIENT,), (TO_DAEMON, TO_CLIENT)):
            with self.subTest(held):
                self.softgripd.wait_for_state("idle")
                process = self.start("--wait", path=proxy.path)
                request = self.wait_until_running()
                proxy.hold(*held)
                code, errors = self.ended_by(process)
                self.assertEqual(code, 4, errors)
                self.assertIn("the stop was not confirmed", errors)
                proxy.let_go()
                self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_second_signal_ends_the_wait_for_the_confirmation(self):
        proxy = SocketProxy(self.folder / "proxy.sock", self.path)
        self.addCleanup(proxy.close)
        process = self.start("--wait", path=proxy.path)
        request = self.wait_until_running()
        proxy.hold()
        process.send_signal(signal.SIGINT)
        bench.wait_for("the stop to be sent", lambda: any(b"stop" in text for text in proxy.waiting(TO_DAEMON)))
        process.send_signal(signal.SIGTERM)
        code, errors = self.ended_by(process)
        self.assertEqual(code, -signal.SIGINT)
        self.assertIn("may still run", errors)
        proxy.let_go()
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_an_output_error_stops_the_sequence(self):
        for name in ("a closed pipe", "a closed pipe, SIGPIPE ignored", "a full disk"):
            with self.subTest(name):
                self.softgripd.wait_for_state("idle")
                if name == "a full disk":
                    with open("/dev/full", "w") as full:
                        code, errors = self.ended_by(self.start("--wait", output=full))
                    self.assertEqual(code, 4, errors)
                else:
                    reader, writer = os.pipe()
                    os.close(reader)
                    ignored = name.endswith("ignored")
                    process = self.start("--wait", output=writer, restore_signals=not ignored)
                    os.close(writer)
                    code, errors = self.ended_by(process)
                    self.assertEqual(code, 4 if ignored else -signal.SIGPIPE, errors)
                self.assertIn("sequence stopped", errors)
                self.assertIsNone(self.running())

    def test_start_refuses_a_daemon_without_start_ids(self):
        """Tests a simulated daemon that answers hello like an early daemon of version 1. Such a daemon does not know
        ids of starts, so the program must not send it a start."""
        heard = []
        listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(listener.close)
        path = self.folder / "older.sock"
        listener.bind(str(path))
        listener.listen()

        def serve():
            client, _ = listener.accept()
            with client, client.makefile("rw") as lines:
                for line in lines:
                    heard.append(json.loads(line)["command"])
                    lines.write(json.dumps({"id": None, "ok": True, "result": {
                        "api": 1, "version": "1.0", "capabilities": ["event_ids", "overall_result", "owner", "dry_run"]}})
                        + "\n")
                    lines.flush()

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        code, errors = self.ended_by(self.start(path=path))
        self.assertEqual(code, 5, errors)
        self.assertIn("older", errors)
        thread.join(bench.PATIENCE_S)
        self.assertEqual(heard, ["hello"])


if __name__ == "__main__":
    bench.main()
