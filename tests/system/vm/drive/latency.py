"""Measures the wake-up latency of softgripd and of cyclictest in turns, with and without load, and prints a table.
The clock of the guest counts instructions, so the host does not influence the result. The measured latency is therefore
that of the kernel and the program."""

import itertools
import pathlib
import re
import subprocess
import tempfile
import time

from guest import CONFIGURATION, DRIVE, Emulator, Failed, edit, expect, main_guard, sh, terminate

RATE_HZ = 1000
PRIORITY = 70
TURN_S = 10
ROUNDS = 3
LOADS = ["hackbench -g 2 -f 4 -l 1000", "find / -xdev -type f -exec true {} +",
         "dd if=/dev/zero of=/var/tmp/load bs=64k count=64 conv=fsync"]
# Largest permitted latency [us]. It is a quarter of a control period, and twice the longest wake-up latency
# of cyclictest under load on this kernel (123 us).
MOST_US = 250
RIG = CONFIGURATION / "rig_service.yaml"


def histogram(lines):
    """Reads the histogram in the output of cyclictest. Returns the count for each latency in microseconds."""
    counts = {}
    for line in lines:
        fields = line.split()
        if len(fields) >= 2 and fields[0].isdigit() and int(fields[1]) > 0:
            counts[int(fields[0])] = counts.get(int(fields[0]), 0) + int(fields[1])
    return counts


def merged(histograms):
    counts = {}
    for latency, number in itertools.chain.from_iterable(one.items() for one in histograms):
        counts[latency] = counts.get(latency, 0) + number
    return counts


def quantile(counts, share):
    seen, total = 0, sum(counts.values())
    for latency in sorted(counts):
        seen += counts[latency]
        if seen >= share * total:
            return latency
    raise Failed("an empty histogram")


def softgripd(folder):
    path = folder / "histograms"
    done = subprocess.run(["softgripd", "--config", RIG, "--no-socket", "--duration-s", str(TURN_S), "--histograms", path],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    expect(done.returncode == 0, f"softgripd: {done.stdout[-600:]}")
    expect("real time: all requested settings verified" in done.stdout, f"softgripd: {done.stdout}")
    text = path.read_text()
    wake_up = re.search(r"# Histogram \(loop wake-up, us\)\n(.*?)\n#", text, re.DOTALL).group(1)
    slips = sum(int(number) for number in re.findall(r"# Overruns, .*: (\d+)", text))
    failed = int(re.search(r"# Failed exchanges: (\d+)", text).group(1))
    return histogram(wake_up.splitlines()), slips, failed


def cyclictest(_):
    said = sh(f"cyclictest -m -q -t 1 -a 0 -p {PRIORITY} -i {1000000 // RATE_HZ} -D {TURN_S} -h 20000")
    return histogram(line for line in said.splitlines() if not line.startswith("#")), 0, 0


def measure(folder):
    rows, slips, failed = {"softgripd": [], "cyclictest": []}, 0, 0
    for _ in range(ROUNDS):
        for name, turn in (("softgripd", softgripd), ("cyclictest", cyclictest)):
            counts, slipped, lost = turn(folder)
            rows[name].append(counts)
            slips, failed = slips + slipped, failed + lost
    return {name: merged(counts) for name, counts in rows.items()}, slips, failed


def with_load(function, *arguments):
    loads = [subprocess.Popen(["bash", "-c", f"while true; do {load}; done"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, start_new_session=True)
             for load in LOADS]
    time.sleep(1)
    try:
        return function(*arguments)
    finally:
        for load in loads:
            sh(f"kill -9 -- -{load.pid}", check=False)
            load.wait()


def main():
    main_guard()
    sh(f"dpkg -i {sorted(DRIVE.glob('softgrip_*.deb'))[0]}")
    # If the load delays an exchange with the board, this must count as a missed bus cycle and must not end the run.
    edit(RIG, (r"host: .*", "host: 127.0.0.1"), (r"port: \d+", "port: 1502"), (r"cpus: \[1\]", "cpus: [0]"),
         (r"rate_hz: .*", f"rate_hz: {RATE_HZ}"), (r"priority: \d+", f"priority: {PRIORITY}"),
         (r"_cycles: [1-9]\d*", "_cycles: 100"), (r"max_missed_commands: \d+", "max_missed_commands: 100"))
    emulator = Emulator()
    print(f"{sh('uname -srv').strip()}; {RATE_HZ} Hz, SCHED_FIFO {PRIORITY}, {ROUNDS} turns of {TURN_S} s each",
          flush=True)
    print("| wake-up [us] | p50 | p99 | p99.9 | max | number |\n|---|---|---|---|---|---|", flush=True)
    beyond = []
    with tempfile.TemporaryDirectory() as folder:
        for name, result in (("idle", measure(pathlib.Path(folder))),
                             ("loaded", with_load(measure, pathlib.Path(folder)))):
            rows, slips, failed = result
            for program, counts in rows.items():
                cells = [quantile(counts, share) for share in (0.5, 0.99, 0.999, 1)] + [sum(counts.values())]
                print(f"| {program}, {name} | " + " | ".join(str(cell) for cell in cells) + " |", flush=True)
            print(f"softgripd {name}: {slips} overruns, {failed} failed exchanges", flush=True)
            if slips > 0 or quantile(rows["softgripd"], 1) > MOST_US:
                beyond.append(name)
    terminate(emulator.process)
    print(f"LATENCY: {'FAILED, ' + ' and '.join(beyond) if beyond else 'PASSED'}", flush=True)


if __name__ == "__main__":
    main()
