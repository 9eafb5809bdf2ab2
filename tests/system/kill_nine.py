"""Kills the daemon with kill -9 at random times during a recording. After the kill, the recording must be readable. At
most its last second may be missing. The board must vent.

scripts/kill_nine.sh runs this test a hundred times; test_kill.py runs it a few times.
"""

import argparse
import concurrent.futures
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

import bench

ALLOWED_LOSS_S = 1
SEQUENCE = """name: killed
steps:
  - move: {displacement_mm: 9, speed_mm_per_s: 10, settle_s: 0.2}
  - track: {mean_mm: 12, amplitude_mm: 3, frequency_hz: 0.5, cycles: 20}
  - release: {duration_s: 0.5, purge_s: 0.3, timeout_s: 5, on_fail: vent}
"""


def rig(folder, port):
    text = (folder / "config" / "rig_tcp.yaml").read_text()
    for pattern, replacement in ((r"port: \d+", f"port: {port}"), (r"exchange_deadline_s: [\d.]+", "exchange_deadline_s: 0.15"),
                                 (r"bus_down_cycles: \d+", "bus_down_cycles: 60"), (r"max_age_s: [\d.]+", "max_age_s: 0.6"),
                                 (r"invalid_reading_cycles: \d+", "invalid_reading_cycles: 120"),
                                 (r"max_missed_commands: \d+", "max_missed_commands: 120"),
                                 (r"real_time: .*", "real_time: {required: false, priority: 70, cpus: [], lock_memory: false}"),
                                 (r"directory: /tmp/softgrip-runs", f"directory: {folder}/runs"),
                                 (r"path: /tmp/softgrip.sock", f"path: {folder}/softgripd.sock")):
        text = re.sub(pattern, replacement, text)
    path = folder / "config" / "killed.yaml"
    path.write_text(text)
    return path


def opens(folder, recording, *arguments):
    done = subprocess.run([str(a) for a in (bench.SOFTGRIP, *arguments)], capture_output=True, text=True, cwd=folder,
                          timeout=60, stdin=subprocess.DEVNULL)
    if done.returncode not in (0, 6):
        raise AssertionError(f"softgrip {arguments[0]} refuses {recording}: {done.stdout}{done.stderr}")


def once(number, seed):
    """Starts one daemon and kills it after a random time. Returns the duration [s] that the recording has lost, and
    the time [s] until the board vented."""
    chance = random.Random(f"{seed}/{number}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_killed_"))
    processes = []
    try:
        shutil.copytree(bench.SOURCE / "config", folder / "config")
        emulator = bench.Emulator(folder)
        processes.append(emulator)
        daemon = bench.Daemon(folder, rig(folder, emulator.port))
        processes.append(daemon)
        daemon.wait_for_state("idle")
        bench.wait_for("a start", lambda: daemon.ask("start", sequence="killed", sequence_text=SEQUENCE)["ok"])
        # Time 0 of the recording is the time of the tick in which the daemon accepted the sequence.
        began = daemon.wait_for_event("sequence_started")["time_s"]
        time.sleep(chance.uniform(0.1, 5))
        killed_at = daemon.status()["time_s"] - began
        daemon.kill()
        killed = time.monotonic()
        bench.wait_for("vented outputs", lambda: max(emulator.commands_kpa()) == 0, 10)
        vented_s = time.monotonic() - killed
        (recording,) = [path.parent for path in (folder / "runs").glob("*/run.csv")]
        text = (recording / "run.csv").read_text()
        whole = text[:text.rfind("\n") + 1].splitlines()
        columns = whole[0].count(",")
        if any(row.count(",") != columns for row in whole):
            raise AssertionError(f"{recording}: a torn row before the last")
        lost_s = killed_at - (float(whole[-1].split(",")[0]) if len(whole) > 1 else 0)
        if lost_s > ALLOWED_LOSS_S:
            raise AssertionError(f"{lost_s:.3f} s lost of {killed_at:.3f} s")
        if (recording / "run.json").exists():
            json.loads((recording / "run.json").read_text())
        if len(whole) > 3:
            opens(folder, recording, "plot", recording, "--out", folder / "run.svg")
        if killed_at > 2: # the fingers have moved if the daemon ran for more than 2 s
            opens(folder, recording, "validate", "--model", "config/models/bench_twin.yaml", "--data", recording,
                  "--channel", "left")
        return {"number": number, "killed_at_s": killed_at, "lost_s": lost_s, "vented_s": vented_s, "wrong": None}
    except Exception as error:  # the error is printed and counted, and the next run starts
        return {"number": number, "wrong": f"{type(error).__name__}: {error}"}
    finally:
        for process in reversed(processes):
            if process.running():
                process.kill()
            (process.control if hasattr(process, "control") else process.lines).close()
        shutil.rmtree(folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("times", type=int, nargs="?", default=100)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    parser.add_argument("--jobs", type=int, default=3)
    arguments = parser.parse_args()
    print(f"seed {arguments.seed}", flush=True)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(once, range(arguments.times), [arguments.seed] * arguments.times))
    good = [r for r in results if not r["wrong"]]
    for result in results:
        if result["wrong"]:
            print(f"  kill {result['number']}: {result['wrong']}")
    if good:
        print(f"{len(good)} of {len(results)} kills: every recording opens; lost at most {max(r['lost_s'] for r in good):.3f} s "
              f"(mean {sum(r['lost_s'] for r in good) / len(good):.3f} s); vented after at most "
              f"{max(r['vented_s'] for r in good):.2f} s; killed {min(r['killed_at_s'] for r in good):.2f} to "
              f"{max(r['killed_at_s'] for r in good):.2f} s into the recording")
    return 6 if len(good) < len(results) else 0


if __name__ == "__main__":
    sys.exit(main())
