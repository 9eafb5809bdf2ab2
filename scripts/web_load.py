#!/usr/bin/env python3
"""Checks that browsers do not slow down the control loop. Compares minutes with many clients of softgrip-web with
minutes without clients.

    scripts/web_load.py [--build build/release] [--pairs 5] [--seconds 60] [--rate-hz 1000] [--browsers 30] [--slow 16]

Starts softgripd on the simulated rig of config/rig.yaml at the given rate, and softgrip-web. In a loaded minute,
--browsers pages read the stream and are loaded again every 5 s, and --slow sockets read a stream or send a request at
1 byte per second. For every minute, the script prints the wake-up latency and the overruns of the loop (from the
daemon's own histogram) and the resources that softgrip-web uses. Loaded and unloaded minutes form pairs, whose order
alternates.
"""

import argparse
import json
import os
import pathlib
import re
import selectors
import shutil
import socket
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "tests/system"))
import bench  # noqa: E402

STREAM = b"GET /api/stream HTTP/1.1\r\nHost: localhost\r\n\r\n"
PAGE = b"GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n"


class Daemon:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(str(path))
        self.lines = self.socket.makefile("rw")

    def ask(self, **request):
        self.lines.write(json.dumps(request) + "\n")
        self.lines.flush()
        return json.loads(self.lines.readline())["result"]

    def loop(self):
        loop = self.ask(command="statistics", histograms=True)["loop"]
        return (dict(map(tuple, loop["wake_up"]["bins_us"])), loop["slips_woken_late"] + loop["slips_took_long"], loop["ticks"])


class Crowd:
    """The sockets of all clients in a loaded minute. One thread serves all of them."""

    def __init__(self, port, browsers, slow):
        self.port, self.wanted, self.slow = port, browsers, slow
        self.selector = selectors.DefaultSelector()
        self.taken = 0
        self.refused = 0

    def open(self, request, kind, buffer=None):
        client = socket.socket()
        if buffer:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        try:
            client.connect(("127.0.0.1", self.port))
            if request:
                client.sendall(request)
        except OSError:
            client.close()
            self.refused += 1
            return
        client.setblocking(False)
        self.selector.register(client, selectors.EVENT_READ, kind)

    def drop(self, client):
        self.selector.unregister(client)
        client.close()

    def count(self, kind):
        return sum(key.data == kind for key in self.selector.get_map().values())

    def run(self, seconds):
        end, due, slow_due = time.monotonic() + seconds, 0.0, 0.0
        while (now := time.monotonic()) < end:
            for _ in range(self.wanted - self.count("browser")):
                self.open(STREAM, "browser")
            if now >= due:
                due = now + 5
                for _ in range(self.wanted):
                    self.open(PAGE, "page")
            if now >= slow_due:
                slow_due = now + 1
                self.dribble()
            for key, _ in self.selector.select(0.05):
                if key.data in ("browser", "page"):
                    self.read(key.fileobj, 65536)
        for key in list(self.selector.get_map().values()):
            self.drop(key.fileobj)

    def dribble(self):
        for key in list(self.selector.get_map().values()):
            if key.data == "slow reader":
                self.read(key.fileobj, 1)
            elif key.data == "slow asker":
                try:
                    key.fileobj.send(b"G")
                    self.read(key.fileobj, 1)
                except OSError:
                    self.drop(key.fileobj)
        for kind, request in (("slow reader", STREAM), ("slow asker", b"")):
            for _ in range(self.slow // 2 - self.count(kind)):
                self.open(request, kind, buffer=1024)

    def read(self, client, size):
        try:
            data = client.recv(size)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        self.taken += len(data)
        if not data:
            self.drop(client)


def quantile(bins, share):
    left = share * sum(bins.values())
    for lower in sorted(bins):
        left -= bins[lower]
        if left <= 0:
            return lower
    return 0


def usage_of(pid):
    """Returns the resident memory [kB] and the processor time [s] of a process."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return bench.resident_kib(pid), (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(name, daemon, web, seconds, act):
    before, slips, ticks = daemon.loop()
    _, used = usage_of(web.pid)
    act(seconds)
    after, slips_after, ticks_after = daemon.loop()
    resident, used_after = usage_of(web.pid)
    bins = {lower: count - before.get(lower, 0) for lower, count in after.items() if count > before.get(lower, 0)}
    print(f"{name:8} {ticks_after - ticks:8} {slips_after - slips:9} {quantile(bins, .5):8.1f} {quantile(bins, .99):8.1f} "
          f"{quantile(bins, .999):8.1f} {max(bins, default=0):9.1f} {resident:9} {100 * (used_after - used) / seconds:6.1f}",
          flush=True)


def start(arguments, log, ready):
    with open(log, "wb") as output:
        process = subprocess.Popen(arguments, stdout=output, stderr=output)
    for _ in range(200):
        if process.poll() is not None:
            break
        if found := ready():
            return process, found
        time.sleep(0.05)
    raise SystemExit(f"{arguments[0]} did not start:\n{log.read_text()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build/release")
    for name, default in (("pairs", 5), ("seconds", 60), ("rate-hz", 1000), ("browsers", 30), ("slow", 16)):
        parser.add_argument(f"--{name}", type=int, default=default)
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_web_load_"))
    shutil.copytree(SOURCE / "config", work / "config")
    rig = work / "config/rig.yaml"
    path = work / "sock"
    text = re.sub(r"rate_hz: \d+", f"rate_hz: {options.rate_hz}", rig.read_text(), count=1)
    rig.write_text(re.sub(r"path: \S+\.sock", f"path: {path}", text))
    processes = []
    try:
        softgripd, _ = start([options.build / "daemon/softgripd", "--config", rig], work / "softgripd.log", path.exists)
        processes.append(softgripd)
        log = work / "web.log"
        web, port = start(
            ["nice", "-n", "10", options.build / "tools/softgrip-web", "--config", work / "config/web.yaml", "--socket", path,
             "--port", "0"], log, lambda: (f := re.search(r":(\d+)/", log.read_text())) and int(f.group(1)))
        processes.append(web)
        daemon = Daemon(path)
        time.sleep(2)
        crowd = Crowd(port, options.browsers, options.slow)
        print("minute      ticks  overruns   p50 us   p99 us p99.9 us    max us  web kB  web %")
        for pair in range(options.pairs):
            minutes = [("quiet", time.sleep), ("crowd", crowd.run)]
            for name, act in minutes if pair % 2 == 0 else reversed(minutes):
                measure(name, daemon, web, options.seconds, act)
        print(f"the simulated browsers received {crowd.taken / 1e6:.1f} MB; {crowd.refused} connections were refused")
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait()
        shutil.rmtree(work)


if __name__ == "__main__":
    main()
