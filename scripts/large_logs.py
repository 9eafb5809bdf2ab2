#!/usr/bin/python3
"""Measures the run time of softgrip for large logs: 40,000 rows with `diagnose`, and 600,000 rows with `identify
--structure auto`.

    scripts/large_logs.py [--build build/release] [--threads 2] [--only CASE ...] [--page docs/results/large-logs.md]

The commands are ramps to random pressures (the seeds are in this file), and the fingers are models of config/models.
The cases run one after the other and include all steps of the command: reading the files, closed loop and report. Run
nothing else at the same time.
"""
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import results_page

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODELS = ROOT / "config/models"
TWIN, GIVEN, PLAY = MODELS / "bench_twin.yaml", MODELS / "zhang2025.yaml", MODELS / "soft_arm_play.yaml"
MOST_S = {"diagnose": 30, "identify": 20}
MEDIAN_S = 10


def command(length_s, rate_hz, seed):
    """Returns times [s] and pressures [kPa] of a command. The command consists of ramps of 0.1 to 4 s to 0 kPa or to
    a pressure between 5 and 60 kPa. After each ramp, the pressure is held for 0.5 to 6 s."""
    random = np.random.default_rng(seed)
    knots, at_s = [(0, 0), (2, 0)], 2
    while at_s < length_s - 4:
        level = random.choice([0, 0, random.uniform(5, 60)])
        ramp_s, hold_s = random.uniform(0.1, 4), random.uniform(0.5, 6)
        knots += [(at_s + ramp_s, level), (at_s + ramp_s + hold_s, level)]
        at_s += ramp_s + hold_s
    times, levels = zip(*knots, (length_s, 0))
    time_s = np.arange(int(length_s * rate_hz)) / rate_hz
    return time_s, np.interp(time_s, times, levels)


class Logs:
    def __init__(self, softgrip, folder):
        self.softgrip, self.folder, self.count = softgrip, folder, 0

    def write(self, header, *columns):
        self.count += 1
        path = self.folder / f"log{self.count}.csv"
        np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="", fmt="%.7g")
        return path

    def answer(self, model, time_s, pressure_kpa, seed):
        driven = self.write("time_s,pressure_command_kpa", time_s, pressure_kpa)
        out = driven.with_name(f"answer_{driven.name}")
        subprocess.run([self.softgrip, "simulate", "--model", model, "--input", driven, "--noise-mm", "0.04", "--seed", str(seed),
                        "--out", out], check=True, capture_output=True)
        return out

    def made(self, model, length_s, rate_hz, seed):
        return self.answer(model, *command(length_s, rate_hz, seed), seed)

    def slowed(self, path, factor, walk_mm=0.0):
        """Multiplies the times of a log by a factor, and adds a random walk to its readings. `walk_mm` is the standard
        deviation of the walk after 100 samples."""
        log = np.genfromtxt(path, delimiter=",", names=True)
        walk = np.cumsum(np.random.default_rng(9).standard_normal(len(log))) * walk_mm / 10
        return self.write(",".join(log.dtype.names), factor * log["time_s"], log["pressure_command_kpa"],
                          log["displacement_mm"] + walk)

    def slowed_model(self, model, factor):
        """Multiplies the time constants of the creep of a model by a factor."""
        path = self.folder / f"slow_{model.name}"
        path.write_text(re.sub(r"(c\d_kpa_s_per_mm: )([\d.]+)", lambda found: f"{found[1]}{factor * float(found[2]):.6g}",
                               model.read_text()))
        return path

    def measured(self, model, length_s, rate_hz, seed):
        """Changes the model so that its input is a measured pressure. This pressure follows the command with a lag of
        0.1 s and has noise of 0.05 kPa."""
        time_s, command_kpa = command(length_s, rate_hz, seed)
        pressure_kpa, kept = np.empty_like(command_kpa), np.exp(-1 / (rate_hz * 0.1))
        state = 0.0
        for i, kpa in enumerate(command_kpa):
            state = kept * state + (1 - kept) * kpa
            pressure_kpa[i] = state
        displacement = np.genfromtxt(self.answer(model, time_s, pressure_kpa, seed), delimiter=",", names=True)["displacement_mm"]
        noise = 0.05 * np.random.default_rng(seed).standard_normal(len(time_s))
        return self.write("time_s,pressure_command_kpa,pressure_kpa,displacement_mm", time_s, command_kpa, pressure_kpa + noise,
                          displacement)


def cases(logs):
    """Returns {name: (program, arguments)} of the cases. The files of a case are written when the case is run."""
    def diagnose(given, data, healthy=()):
        return "diagnose", ["--model", given, "--data", *data, *(["--healthy", *healthy] if healthy else [])]

    def healthy(make):
        return [make(TWIN, 100, 100, seed) for seed in (2, 3, 4)]

    return {
        "model without an error, log of 400 s at 100 Hz": lambda: diagnose(TWIN, [logs.made(TWIN, 400, 100, 1)]),
        "model lacks delay and lag, log of 400 s at 100 Hz": lambda: diagnose(GIVEN, [logs.made(TWIN, 400, 100, 1)]),
        "model lacks delay and lag, log of 40 s at 1 kHz": lambda: diagnose(GIVEN, [logs.made(TWIN, 40, 1000, 7)]),
        "finger with a different model structure, log of 400 s at 100 Hz": lambda: diagnose(GIVEN, [logs.made(PLAY, 400, 100, 1)]),
        "model lacks delay and lag, log of 400,000 s with one sample per 10 s": lambda: diagnose(
            logs.slowed_model(GIVEN, 1000), [logs.slowed(logs.made(TWIN, 400, 100, 1), 1000)]),
        "the same, with a random walk of the readings": lambda: diagnose(
            logs.slowed_model(GIVEN, 1000), [logs.slowed(logs.made(TWIN, 400, 100, 1), 1000, walk_mm=0.15)]),
        "model lacks delay and lag, 4 logs with a measured pressure, 100 s at 100 Hz each": lambda: diagnose(
            GIVEN, [logs.measured(TWIN, 100, 100, seed) for seed in (2, 3, 4, 5)]),
        "3 healthy logs and 1 log of the unchanged finger, 100 s at 100 Hz each": lambda: diagnose(
            GIVEN, [logs.made(TWIN, 100, 100, 5)], healthy(logs.made)),
        "3 healthy logs and 1 log of a different finger, 100 s at 100 Hz each": lambda: diagnose(
            GIVEN, [logs.made(GIVEN, 100, 100, 5)], healthy(logs.made)),
        "3 healthy logs and 1 log of a different finger, with a measured pressure": lambda: diagnose(
            GIVEN, [logs.measured(GIVEN, 100, 100, 5)], healthy(logs.measured)),
        "log of 600 s at 1 kHz, finger with the published model structure": lambda: (
            "identify", ["--structure", "auto", "--data", logs.made(TWIN, 600, 1000, 6)]),
        "log of 600 s at 1 kHz, finger with play operators": lambda: (
            "identify", ["--structure", "auto", "--data", logs.made(PLAY, 600, 1000, 6)]),
    }


def timed(softgrip, name, made, threads, folder):
    program, arguments = made()
    paths = [a for a in arguments if isinstance(a, pathlib.Path) and a.suffix == ".csv"]
    rows = sum(len(path.read_text().splitlines()) - 1 for path in paths)
    began, before = time.monotonic(), os.times()
    done = subprocess.run([softgrip, program, *arguments, "--threads", str(threads), "--out", folder / program, "--json"],
                          capture_output=True, text=True, check=False)
    after = os.times()
    if done.returncode not in (0, 6):
        sys.exit(f"{name}: {done.stderr}")
    answer = json.loads(done.stdout)
    verdict = answer["verdict"] if program == "diagnose" else next(
        c["description"] for c in answer["structure"]["candidates"] if c["chosen"])
    return {"name": name, "program": program, "rows": rows, "wall_s": time.monotonic() - began,
            "processor_s": after.children_user - before.children_user, "verdict": verdict, "load": os.getloadavg()[0]}


def page(args, rows):
    lines, by_program = [], {}
    for row in rows:
        by_program.setdefault(row["program"], []).append(row["wall_s"])
        lines.append(f"| `{row['program']}` | {row['name']} | {row['rows']:,} | {row['verdict']} | {row['wall_s']:.1f} | "
                     f"{row['processor_s']:.1f} | {MOST_S[row['program']]} | {row['load']:.1f} |")
    meaning = ". ".join(f"{name} takes at most {max(times):.0f} s (median {statistics.median(times):.0f} s)"
                        for name, times in (("a diagnosis of 40,000 rows", by_program.get("diagnose", [])),
                                            ("`softgrip identify --structure auto` with 600,000 rows", by_program.get("identify", []))) if times)
    loads = [row["load"] for row in rows]
    return "\n".join([
        *results_page.head("Duration for large logs", meaning[0].upper() + meaning[1:] + ".", results_page.version_of(args.build),
                           "scripts/large_logs.py --page", f"{os.cpu_count()} processors, {args.threads} threads, 1-minute load "
                           f"{min(loads):.1f} to {max(loads):.1f}"),
        f"Required: a diagnosis takes at most {MOST_S['diagnose']} s, and the median of all diagnoses is at most {MEDIAN_S} s. "
        f"`softgrip identify` is required to take at most {MOST_S['identify']} s.", "",
        "| command | case | rows | result | duration [s] | processor time [s] | allowed duration [s] | 1-minute load |", "|---|---|---|---|---|---|---|---|",
        *lines, ""])


def main():
    parser = results_page.arguments(__doc__)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", nargs="+", help="run only the cases whose name contains one of these texts")
    args = parser.parse_args()
    softgrip, rows = args.build / "tools/softgrip", []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name, made in cases(Logs(softgrip, work)).items():
            if args.only and not any(part in name for part in args.only):
                continue
            rows.append(timed(softgrip, name, made, args.threads, work))
            row = rows[-1]
            print(f"{row['program']}, {name}: {row['wall_s']:.1f} s, {row['processor_s']:.1f} s of processor time, {row['verdict']}",
                  flush=True)
    if not rows:
        parser.error("no name of a case contains one of these texts")
    text = page(args, rows)
    args.page.write_text(text) if args.page else print(text, end="")


if __name__ == "__main__":
    main()
