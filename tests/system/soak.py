"""Runs softgripd for hours at 1 kHz over TCP with softgrip-rig. It runs one sequence after the other while the
machine does other work. Disturbances are clients that connect and leave, pauses, and a full disk
(soak_disturbances.py).

scripts/soak.sh runs this program. Once a minute, the program writes a line to soak.csv: memory, descriptors,
overruns, dropped rows, faults. At the end it prints a verdict. The exit code is 0, or 6 if one of these values has
grown, data were lost, or a fault occurred.
"""

import argparse
import contextlib
import csv
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import sys
import tempfile
import time

import bench
import soak_disturbances

RATE_HZ = 1000
# Number of cycles without a bus exchange before a fault. They last 100 ms: on a shared machine, shorter pauses are
# caused by the machine, not by the bus.
PATIENCE_CYCLES = 100
# Each entry contains four values: the part between the fingers, the sequence, the required end of the sequence, and the
# required result of both fingers.
ROUND = (
    ("stone", "pick_stone", "done", "RELEASED"),
    ("out", "empty_grip", "failed", "NO PART"),
    ("13:0.05", "pick_screw", "done", "RELEASED"),
    ("out", "track_sine", "done", "RELEASED"),
)
# Permitted growth of the memory [KiB]. The daemon keeps its newest 10,000 events in memory; no other data may
# grow.
ALLOWED_GROWTH_KIB = 4096
COLUMNS = ("minute", "rss_kib", "descriptors", "threads", "ticks", "slips_woken_late", "slips_took_long",
           "bus_exchanges", "bus_failures", "bus_slips", "sessions", "dropped_rows", "faults", "sequences", "unexpected",
           "rows_read", "missing_ticks", "wake_up_p999_us", "exchange_p999_us", "load_average")


def load(folder):
    """Loads the machine. Uses a quarter of one processor and writes a few megabytes to the disk every second."""
    os.nice(19)
    block = random.Random(1).randbytes(1 << 20)
    path = folder / "load.bin"
    while True:
        end = time.monotonic() + 0.25
        while time.monotonic() < end:
            hashlib.sha256(block).digest()
        with open(path, "wb") as file:
            for _ in range(4):
                file.write(block)
            file.flush()
            os.fsync(file.fileno())
        time.sleep(0.7)


def rig(folder, port):
    text = (folder / "config" / "rig_tcp.yaml").read_text()
    for old, new in (("port: 1502", f"port: {port}"), ("rate_hz: 200", f"rate_hz: {RATE_HZ}"),
                     ("bus_down_cycles: 5", f"bus_down_cycles: {PATIENCE_CYCLES}"),
                     ("invalid_reading_cycles: 5", f"invalid_reading_cycles: {PATIENCE_CYCLES}"),
                     ("readback_cycles: 10", f"readback_cycles: {PATIENCE_CYCLES}"),
                     ("max_missed_commands: 10", f"max_missed_commands: {PATIENCE_CYCLES}"),
                     ("directory: /tmp/softgrip-runs", f"directory: {folder}/runs"),
                     ("path: /tmp/softgrip.sock", f"path: {folder}/softgripd.sock")):
        if old not in text:
            raise SystemExit(f"soak: rig_tcp.yaml has no `{old}`")
        text = text.replace(old, new)
    path = folder / "config" / "soak.yaml"
    path.write_text(text)
    return path


class Soak:
    def __init__(self, folder, out, with_load, seed):
        self.folder = folder
        self.runs = soak_disturbances.Runs(folder)
        self.disturbances = soak_disturbances.Disturbances(self, self.runs, seed)
        self.out = out
        self.sequences = self.faults = self.rows = self.missing = self.newest = 0
        self.unexpected = []
        self.samples = []
        self.emulator = bench.Emulator(folder, "--seed", 1)
        self.daemon = bench.Daemon(folder, rig(folder, self.emulator.port))
        self.load = os.fork() if with_load else 0
        if with_load and self.load == 0:
            with contextlib.suppress(KeyboardInterrupt):
                load(folder)
            os._exit(0)
        self.daemon.wait_for_state("idle")

    def end(self):
        if self.load:
            os.kill(self.load, signal.SIGTERM)
            os.waitpid(self.load, 0)
        code = self.daemon.end()
        self.emulator.end()
        self.runs.end()
        return code

    def note(self, sentence):
        self.unexpected.append(sentence)
        print(f"  {sentence}", flush=True)

    def take_events(self, awaited=()):
        """Reads new events. Counts and prints the faults among these events, except the expected faults."""
        events = self.daemon.events(self.newest)
        for event in events:
            self.newest = event["id"]
            if event["kind"] in ("fault_latched", "internal_error", "recording_failed") and event["kind"] not in awaited:
                self.faults += 1
                print(f"  {event['time_s']:.1f} s: {event['kind']} {event.get('code', '')}: {event['text']}", flush=True)
        return events

    def one(self, item, sequence, end, result):
        """Runs one sequence and checks that it ends with the required result."""
        self.emulator.ask(f"object {item}" if item == "out" else "object back")
        if item != "out":
            self.emulator.ask(f"object {item}")
        # Each sequence uses a new client, so connections are opened and closed during the whole run.
        client = bench.Lines(self.folder / "softgripd.sock")
        reply = json.loads(client.ask(json.dumps({"command": "start", "sequence": sequence})))
        client.close()
        if not reply["ok"]:
            self.note(f"{sequence}: {reply['error']['message']}")
            self.recover()
            return
        bench.wait_for(f"the end of {sequence}", lambda: self.daemon.status()["state"] in ("idle", "faulted"), 180, 0.25)
        status = self.daemon.status()
        self.sequences += 1
        came = (status["sequence"]["ended"], {c["result"] for c in status["channels"]})
        events = self.take_events()
        if came[0] != end or not (result in came[1] or any(e["kind"] == "grip_result" and e["code"] == result
                                                            for e in events) or sequence == "track_sine"):
            self.note(f"{sequence}: ended {came[0]}, {sorted(came[1])}")
        self.recover()
        time.sleep(1.2)  # waits until the recording has ended
        self.read_recordings()

    def recover(self):
        """Counts a fault and acknowledges it, so that the test can continue. The verdict at the end reports the
        fault."""
        if self.daemon.status()["state"] == "faulted":
            bench.wait_for("an acknowledged fault", lambda: self.daemon.ask("acknowledge")["ok"], 30, 0.5)
        self.daemon.wait_for_state("idle")

    def read_recordings(self):
        """Reads every recording to its end and then deletes the recording. The rows of both channels must have
        intervals of one tick, and no row may be missing."""
        for recording in sorted((self.folder / "runs").iterdir()):
            about = json.loads((recording / "run.json").read_text())
            if about["state"] == "recording":
                continue
            if about["state"] != "complete" or about["dropped_rows"] or about["error"]:
                self.note(f"{recording.name}: {about['state']}, {about['dropped_rows']} dropped, "
                          f"{about['error']}")
            rows = 0
            with open(recording / "run.csv", newline="") as file:
                for row in csv.reader(file):
                    rows += 1
            # The file has one header row and two rows per tick. The times of single rows vary with the wake-up of the
            # loop, so the number of missing ticks is computed from the total time.
            self.missing += max(0, round(float(row[0]) * RATE_HZ) + 1 - (rows - 1) // 2)
            if rows - 1 != about["rows"]:
                self.note(f"{recording.name}: {rows - 1} rows, run.json says {about['rows']}")
            self.rows += rows - 1
            shutil.rmtree(recording)

    def remove_recordings(self):
        """Deletes recordings that are incomplete because the disk was full. Their rows are not checked."""
        for recording in self.runs.path.iterdir():
            shutil.rmtree(recording)

    def sample(self, minute, writer):
        pid = self.daemon.child.pid
        status = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines())
        numbers = self.daemon.result("statistics")
        loop, bus = numbers["loop"], numbers["bus"]
        row = dict(zip(COLUMNS, (
            round(minute, 2), self.daemon.resident_kib(), len(os.listdir(f"/proc/{pid}/fd")),
            int(status["Threads"]), loop["ticks"], loop["slips_woken_late"], loop["slips_took_long"], bus["exchanges"],
            bus["failures"], bus["slips"], bus["sessions"], self.daemon.status()["recording"]["dropped_rows"],
            self.faults, self.sequences, len(self.unexpected), self.rows, self.missing, loop["wake_up"]["p999_us"],
            bus["exchange"]["p999_us"], os.getloadavg()[0])))
        self.samples.append(row)
        writer.writerow(row)

    def pauses(self, count):
        """Runs a number of long pauses and no other disturbance."""
        for _ in range(count):
            self.disturbances.long_pause()
            self.recover()
            self.remove_recordings()

    def run(self, minutes):
        began = time.monotonic()
        due = 1.0
        with open(self.out / "soak.csv", "w", newline="", buffering=1) as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            self.sample(0, writer)
            while time.monotonic() - began < minutes * 60 and self.daemon.running():
                for case in ROUND:
                    self.one(*case)
                    minute = (time.monotonic() - began) / 60
                    if minute >= due:
                        self.sample(minute, writer)
                        due = int(minute) + 1
                    if minute >= minutes:
                        break
                self.disturbances.round()
            self.take_events()
            self.sample((time.monotonic() - began) / 60, writer)

    def verdict(self, exit_code):
        """Returns a sentence for each requirement that is not met. The list is empty if all requirements are met."""
        # During the first round, buffers are filled for the first time. The memory is therefore compared with its value
        # after the first round.
        settled = self.samples[min(2, len(self.samples) - 1)]
        last = self.samples[-1]
        wrong = list(self.unexpected)
        if exit_code != 0:
            wrong.append(f"softgripd ended with {exit_code}")
        if self.faults:
            wrong.append(f"{self.faults} faults or failures without a cause")
        if last["dropped_rows"]:
            wrong.append(f"{last['dropped_rows']} rows dropped")
        if last["descriptors"] > settled["descriptors"]:
            wrong.append(f"descriptors grew from {settled['descriptors']} to {last['descriptors']}")
        if last["rss_kib"] > settled["rss_kib"] + ALLOWED_GROWTH_KIB:
            wrong.append(f"memory grew from {settled['rss_kib']} to {last['rss_kib']} KiB")
        slips = last["slips_woken_late"] + last["slips_took_long"]
        if self.missing > slips:
            wrong.append(f"{self.missing} ticks are missing in recordings, but only {slips} slipped")
        print(f"{last['minute']:.1f} minutes at {RATE_HZ} Hz, {last['ticks']} ticks, {slips} slips "
              f"({last['slips_woken_late']} woken late), {last['bus_failures']} of {last['bus_exchanges']} exchanges "
              f"failed, {last['sequences']} sequences, {self.faults} faults, {last['dropped_rows']} rows dropped")
        print(f"memory {settled['rss_kib']} -> {last['rss_kib']} KiB, descriptors {settled['descriptors']} -> "
              f"{last['descriptors']}; {self.rows} recorded rows read back, {self.missing} ticks missing in them")
        print("disturbed by " + ", ".join(f"{count} {what}" for what, count in self.disturbances.done.items()))
        return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("minutes", type=float, nargs="?", default=60)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("soak-output"))
    parser.add_argument("--no-load", action="store_true", help="without other work on the machine")
    parser.add_argument("--pauses", type=int, metavar="N", help="only N pauses longer than the board's watchdog")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31),
                        help="the seed of the disturbances")
    arguments = parser.parse_args()
    print(f"seed {arguments.seed}", flush=True)
    arguments.out.mkdir(parents=True, exist_ok=True)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_soak_"))
    try:
        shutil.copytree(bench.SOURCE / "config", folder / "config")
        soak = Soak(folder, arguments.out, not arguments.no_load, arguments.seed)
        print((soak.daemon.errors() + soak.daemon.output()).strip(), flush=True)
        try:
            if arguments.pauses is None:
                soak.run(arguments.minutes)
            else:
                soak.pauses(arguments.pauses)
        finally:
            code = soak.end()
            (arguments.out / "softgripd.log").write_text(soak.daemon.output() + soak.daemon.errors())
        wrong = soak.verdict(code) if arguments.pauses is None else soak.unexpected
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for sentence in wrong:
        print(f"  {sentence}")
    print("verdict: " + ("not acceptable" if wrong else "good"))
    return 6 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
