#!/usr/bin/env python3
"""Measures the response time of softgripd's socket while other clients load it: answer_times.py [--seconds S]

A daemon runs on the emulated rig at 1 kHz. One client sends a command every 5 ms. In every second turn, other clients
load the socket: watchers, clients that send floods of requests, and subscribers that never read. All turns have the
same length. The script prints the response times [ms], and the wake-up latency and the overruns of the loop. Needs a
release build (SOFTGRIP_BUILD).
"""

import argparse
import json
import pathlib
import socket
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/system"))
import bench  # noqa: E402

PAUSE_S = 0.005
COMMANDS = ("status", "events", "vent")


class Crowd:
    """Runs the load: five watchers, five clients that never read their responses, and three clients that send
    requests as fast as possible."""

    def __init__(self, path):
        self.stop = threading.Event()
        self.sockets, self.threads = [], []
        lines = [(b'{"command":"watch","rate_hz":50}\n', True)] * 5
        lines += [(b'{"command":"subscribe","since":0}\n{"command":"watch","rate_hz":50}\n', False)] * 5
        for line, reads in lines:
            self.connect(path).sendall(line)
            if reads:
                self.run(self.read, self.sockets[-1])
        for _ in range(3):
            client = self.connect(path)
            self.run(self.flood, client)
            self.run(self.read, client)

    def connect(self, path):
        client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        client.settimeout(0.2)
        client.connect(path)
        self.sockets.append(client)
        return client

    def run(self, body, client):
        def until_stopped():
            while not self.stop.is_set():
                try:
                    body(client)
                except TimeoutError:
                    pass
                except OSError:
                    return
        self.threads.append(threading.Thread(target=until_stopped, daemon=True))
        self.threads[-1].start()

    @staticmethod
    def read(client):
        client.recv(1 << 20)

    @staticmethod
    def flood(client):
        client.sendall(b'{"command":"status"}\n{"command":"events","limit":1000}\n{"command":"acknowledge"}\n')

    def end(self):
        self.stop.set()
        for thread in self.threads:
            thread.join()
        for client in self.sockets:
            client.close()


def measured(path, seconds):
    """Returns the response times of all commands [ms]."""
    lines = bench.Lines(path)
    times = {command: [] for command in COMMANDS}
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for command in COMMANDS:
            began = time.monotonic()
            lines.ask(json.dumps({"command": command}))
            times[command].append((time.monotonic() - began) * 1e3)
            time.sleep(PAUSE_S)
    lines.close()
    return times


def at(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


class Measurement(bench.BenchTest):
    seconds = 10.0

    def loop(self, daemon):
        loop = daemon.result("statistics")["loop"]
        return loop["slips_woken_late"] + loop["slips_took_long"]

    def runTest(self):
        emulator = self.emulator("--object", "stone")
        rig = self.rig(emulator.port, changes=((r"rate_hz: \d+", "rate_hz: 1000"),))
        daemon = self.idle_daemon(rig)
        path = str(daemon.socket_path)
        print(f"{'':12}{'command':10}{'asked':>8}{'p50':>8}{'p99':>8}{'max ms':>9}   periods lost")
        for turn in range(4):
            crowd = Crowd(path) if turn % 2 else None
            before = self.loop(daemon)
            times = measured(path, self.seconds)
            lost = self.loop(daemon) - before
            if crowd:
                crowd.end()
            for command, values in times.items():
                print(f"{'beside 13' if crowd else 'alone':12}{command:10}{len(values):8}{at(values, 0.5):8.2f}"
                      f"{at(values, 0.99):8.2f}{max(values):9.2f}{lost:12}")
        wake_up = daemon.result("statistics")["loop"]["wake_up"]
        print(f"loop: wake-up p50 {wake_up['p50_us']:.0f}, p99 {wake_up['p99_us']:.0f}, max {wake_up['max_us']:.0f} us "
              f"over {wake_up['count']} ticks")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10, help="duration of each of the four measurements [s]")
    Measurement.seconds = parser.parse_args().seconds
    outcome = bench.unittest.TextTestRunner(verbosity=0).run(Measurement())
    sys.exit(0 if outcome.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
