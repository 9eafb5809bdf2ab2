#!/usr/bin/python3
"""Measures how well controllers track a reference with textbook fingers over the network. Compares three controllers:
the feedforward of the identified model, PID alone, and the scheme of the paper.

    scripts/textbook_control.py --work DIR [--build build/release] [--fingers 10] [--side-by-side 5] [--page PAGE.md]
                                [--frequencies-hz 0.05 0.1 0.2 0.5]

For each finger (tests/blind/textbook), two models are identified from simulated logs of this finger: with `softgrip
identify --structure auto` and with `--structure bouc_wen`. After the identification, tests/blind/textbook/rig.cpp simulates four copies of the finger in real time on Modbus TCP, and `softgrip run` tracks one sine with all four copies at 200 Hz. In the first run,
four PID controllers track a sine of 0.2 Hz. `softgrip tune` computes the gains of the four PID controllers for maximum sensitivities of 2, 1.6, 1.3 and 1.15. In the second run, four controllers track the sines of all frequencies. The first and the second controller are the PID controllers with the smallest errors in the first run. The third controller is the feedforward of the
identified model with PID. The fourth controller is the scheme of the published paper: the inverse of the Bouc-Wen
element with PID. `softgrip tune` also computes the gains of the third and the fourth controller. The error is the root
mean square of reading minus reference at the time of the reading, from the second cycle of the sine on. The mean square
of the sensor noise is part of the mean square error of every controller, so the table also states a ratio of the errors
without the noise.
"""
import concurrent.futures
import csv
import math
import pathlib
import re
import statistics
import subprocess
import sys

import results_page

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOISE_MM = 0.04  # RMS noise of the displacement sensors [mm]
SENSITIVITIES = (2, 1.6, 1.3, 1.15)
PIDS = {f"pid_{sensitivity:g}".replace(".", "_"): ("auto", "none", sensitivity) for sensitivity in SENSITIVITIES}
OTHERS = {"identified": ("auto", "full_model", 2), "paper": ("bouc_wen", "bouc_wen", 2)}
SCHEMES = PIDS | OTHERS  # maps the channel name to (model, feedforward, largest sensitivity)
TRIAL_HZ = (0.2,)
RIG = """name: textbook
rate_hz: 200
board:
  modbus_tcp: {{map: {root}/config/boards/softgrip-sim.yaml, host: 127.0.0.1, port: {port}, unit: 1,
    exchange_deadline_s: 0.05, connect_deadline_s: 0.5, first_pause_s: 0.1, longest_pause_s: 2}}
channel_defaults:
  limits: {{pressure_min_kpa: 0, pressure_max_kpa: 60, slew_up_kpa_per_s: 300, slew_down_kpa_per_s: 600,
    displacement_min_mm: -3, displacement_max_mm: 40, displacement_margin_mm: 2}}
  valve: {{at_v: [0, 10], is_kpa: [0, 100], range_kpa: [0, 100], on_power_loss: vents}}
  sensor: {{at_v: [0, 10], is_mm: [-5, 45], valid_v: [0.1, 9.9]}}
  pressure_monitor: {{at_v: [0, 10], is_kpa: [0, 100], valid_v: [-0.2, 10]}}
channels:
{channels}
safety:
  safe_action: {{idle: vent, closing: vent, holding: hold, releasing: vent}}
  on_emergency_stop: vent
  max_missed_commands: 20
faults: {{bus_down_cycles: 20, invalid_reading_cycles: 10, displacement_cycles: 10, readback_cycles: 20,
  readback_tolerance_kpa: 1, readback_delay_s: 0.1, pressure_cycles: 200, pressure_tolerance_kpa: 20,
  pressure_delay_s: 0.5, overrun_cycles: 0, model_unfit_is_fault: false, unsteady_is_fault: false}}
plausibility: {{max_age_s: 0.1, max_speed_mm_per_s: 500, jump_margin_mm: 0.5, frozen_after_s: 1.0, frozen_band_mm: 0,
  frozen_command_kpa: 10}}
detection: {{margin_mm: 1.0}}
rest: {{band_mm: 0.5, time_s: 0.3, timeout_s: 10}}
model_health: {{model_error_mm: 0.2, correlation_time_s: 1.0, noise_mm: 0.05, unfit_mm: 3}}
real_time: {{required: false, priority: 70, cpus: [], lock_memory: true, cpu_dma_latency_us: 0}}
recorder: {{mode: sequences, directory: {work}}}
socket: {{path: {work}/socket, mode: "0660", sequence_directory: .}}
"""
CHANNEL = ("  - {{name: {name}, model: {work}/{model}/model.yaml, feedforward: {feedforward}, pid: {{{pid}}}, "
           "valve: {{output: {at}}}, sensor: {{input: {at}}}, pressure_monitor: {{input: {monitor}}}}}")
START = ("kp_kpa_per_mm: 1, ki_kpa_per_mm_s: 5, kd_kpa_s_per_mm: 0, derivative_filter_s: 0.02, setpoint_weight: 1, "
         "anti_windup: back_calculation, tracking_time_s: 0.5")


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))} ends with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def write_rig(work, port, gains):
    channels = [CHANNEL.format(name=name, work=work, model=SCHEMES[name][0], feedforward=SCHEMES[name][1], pid=pid, at=at,
                               monitor=4 + at) for at, (name, pid) in enumerate(gains.items())]
    (work / "rig.yaml").write_text(RIG.format(root=ROOT, port=port, work=work, channels="\n".join(channels)))


def tuned(softgrip, work):
    """Returns the controller gains of every scheme, as the key `pid` of a rig file."""
    gains = {}
    for name, (model, feedforward, sensitivity) in SCHEMES.items():
        write_rig(work, 1, {name: START})
        snippet = run(softgrip, "tune", "--rig", work / "rig.yaml", "--model", work / model / "model.yaml", "--feedforward",
                      feedforward, "--max-sensitivity", sensitivity, "--out", "-")
        gains[name] = ", ".join(line.strip() for line in snippet.splitlines() if line.startswith("  "))
    return gains


def cycles_at(hz):
    return 2 if hz < 0.1 else 3 if hz < 0.3 else 6


def errors_mm(recording, names, frequencies_hz):
    """Returns the RMS [mm] of reading minus reference by (frequency, scheme), without the first cycle. A reading is
    older than its row by age_s. It is compared with the reference at the time of the reading."""
    rows = {}
    with open(recording / "run.csv", encoding="ascii") as file:
        for row in csv.DictReader(file):
            if row["reference_mm"] and row["displacement_mm"]:
                rows.setdefault((int(row["step"]), row["channel"]), []).append(
                    [float(row[name]) for name in ("time_s", "reference_mm", "displacement_mm", "age_s")])
    errors = {}
    for number, hz in enumerate(frequencies_hz):
        for name in names:
            found = rows[2 * number + 1, name]
            values = []
            for before, now in zip(found, found[1:]):
                back = now[3] / (now[0] - before[0])
                values.append(now[2] - (now[1] + back * (before[1] - now[1])))
            values = values[len(values) // cycles_at(hz):]
            errors[hz, name] = math.sqrt(statistics.fmean(value * value for value in values))
    return errors


def followed(build, work, finger, span_mm, gains, frequencies_hz):
    """Runs several controllers in parallel, each on its own copy of the same finger. Returns their errors."""
    make, seed = finger
    mean_mm, amplitude_mm = 0.45 * span_mm, 0.25 * span_mm
    low = f"  - move: {{displacement_mm: {mean_mm - amplitude_mm:.3f}, speed_mm_per_s: 5, settle_s: 3, on_contact: ignore}}\n"
    steps = "".join(low + f"  - track: {{mean_mm: {mean_mm:.3f}, amplitude_mm: {amplitude_mm:.3f}, frequency_hz: {hz:g}, "
                    f"cycles: {cycles_at(hz)}}}\n" for hz in frequencies_hz)
    (work / "sines.yaml").write_text("name: sines\nsteps:\n" + steps +
                                     "  - release: {duration_s: 1, purge_s: 0.5, timeout_s: 15, on_fail: vent}\n")
    with subprocess.Popen([build / "tests/blind/textbook/textbook-rig", "--seed", str(seed), "--make", make, "--fingers",
                           str(len(gains))], stdout=subprocess.PIPE, text=True) as rig:
        try:
            write_rig(work, re.search(r":(\d+)$", rig.stdout.readline().strip())[1], gains)
            recording = work / f"recording.{'.'.join(gains)}"
            run(build / "tools/softgrip", "run", work / "sines.yaml", "--rig", work / "rig.yaml", "--record", recording,
                "--no-socket", "--quiet")
        finally:
            rig.terminate()
    return errors_mm(recording, gains, frequencies_hz)


def span_of(work):
    with open(work / "logs/log_1.csv", encoding="ascii") as file:
        return max(float(row["displacement_mm"]) for row in csv.DictReader(file))


def follow(build, work, finger, frequencies_hz):
    """Runs all steps for one finger: campaign, identification, and control. Returns the errors."""
    make, seed = finger
    work.mkdir(parents=True, exist_ok=True)
    run(build / "tests/blind/textbook/textbook-world", "--seed", seed, "--make", make, "--out", work / "logs", "--truth",
        work / "truth.json")
    for structure in ("auto", "bouc_wen"):
        run(build / "tools/softgrip", "identify", "--structure", structure, "--data", *sorted((work / "logs").glob("*.csv")),
            "--out", work / structure, "--threads", 1)
    gains = tuned(build / "tools/softgrip", work)
    span_mm = span_of(work)
    trial = followed(build, work, finger, span_mm, {name: gains[name] for name in PIDS}, TRIAL_HZ)
    pids = sorted(PIDS, key=lambda name: trial[TRIAL_HZ[0], name])[:2]
    errors = followed(build, work, finger, span_mm, {name: gains[name] for name in (*OTHERS, *pids)}, frequencies_hz)
    return {"make": make, "seed": seed, "span_mm": span_mm, "pids": pids, "errors_mm": errors}


def beyond_noise(error_mm):
    """Returns the error without the noise of the sensor. The result is at least 10 % of this noise."""
    return math.sqrt(max(error_mm**2 - NOISE_MM**2, (NOISE_MM / 10)**2))


def best_pid(result, hz):
    return min(result["errors_mm"][hz, name] for name in result["pids"])


def ratios(results, hz, scheme, measure):
    return [measure(best_pid(r, hz)) / measure(r["errors_mm"][hz, scheme]) for r in results]


def page(results, frequencies_hz, command, version):
    every = [x for hz in frequencies_hz for x in ratios(results, hz, "identified", beyond_noise)]
    raw = [x for hz in frequencies_hz for x in ratios(results, hz, "identified", float)]
    exact = [best_pid(r, hz) / NOISE_MM for r in results for hz in frequencies_hz]
    meaning = (f"With the feedforward of an identified model and a PID controller, the RMS tracking error is {statistics.median(raw):.1f} times smaller than with the "
               f"best PID controller alone. Because of the sensor noise, even a perfect controller could reduce the RMS tracking error of the best PID controller by at most a factor of {statistics.median(exact):.1f}.")
    lines = [*results_page.head("Tracking control of fingers that are simulated with equations from textbooks", meaning, version, command,
                                f"{len(results)} simulated fingers in real time on Modbus TCP, 200 Hz"),
             " ".join(__doc__.split("\n\n")[2].replace("(tests/blind/textbook)", "(`tests/blind/textbook`)").split()), "",
             f"The study contains {len(results)} simulated fingers. The amplitude of the sines is 25 % of the displacement span of the finger. The standard deviation of the sensor noise is "
             f"{NOISE_MM} mm. The RMS error includes the sensor noise, so no controller can have an RMS error below {NOISE_MM} mm. If the error after subtraction of the noise is below 10 % of the noise, the ratios use 10 % of the noise.", "",
             "| frequency | error: identified model and PID | error: best PID alone | error: scheme of the paper | error of the best PID / error of identified model and PID, median of all fingers | "
             "error of the best PID / error of identified model and PID, smallest value of all fingers | ratio of the errors after subtraction of the sensor noise, best PID to identified model and PID, median of all fingers | error of the best PID / error of the scheme of the paper, median of all fingers |", "|---|---|---|---|---|---|---|---|"]
    for hz in frequencies_hz:
        median = [statistics.median(r["errors_mm"][hz, "identified"] for r in results),
                  statistics.median(best_pid(r, hz) for r in results),
                  statistics.median(r["errors_mm"][hz, "paper"] for r in results)]
        read, free = ratios(results, hz, "identified", float), ratios(results, hz, "identified", beyond_noise)
        paper = ratios(results, hz, "paper", float)
        lines.append(f"| {hz:g} Hz | " + " | ".join(f"{m:.3f} mm" for m in median) +
                     f" | {statistics.median(read):.1f} times | {min(read):.1f} times | {statistics.median(free):.1f} times | "
                     f"{statistics.median(paper):.1f} times |")
    lines += ["", f"With the identified model and PID, the RMS error of the readings is {statistics.median(raw):.1f} times smaller than with the "
              f"best PID (median over all fingers and frequencies). If the finger followed the reference exactly, the RMS error of the readings would be {statistics.median(exact):.1f} times smaller than with the best PID. "
              f"After subtraction of the sensor noise, the RMS error with the identified model and PID is {statistics.median(every):.1f} times smaller than with the best PID.", "", "## RMS errors of the readings for each finger, in mm", "",
              "| kind of the simulated finger | seed | reference (mean ± amplitude) | " + " | ".join(f"{hz:g} Hz: identified, best PID, paper" for hz in frequencies_hz) + " |",
              "|---" * (3 + len(frequencies_hz)) + "|"]
    for r in results:
        cells = [", ".join(f"{e:.3f}" for e in (r["errors_mm"][hz, "identified"], best_pid(r, hz), r["errors_mm"][hz, "paper"]))
                 for hz in frequencies_hz]
        lines.append(f"| {r['make']} | {r['seed']} | {0.45 * r['span_mm']:.1f} ± {0.25 * r['span_mm']:.1f} mm | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--fingers", type=int, default=10)
    parser.add_argument("--side-by-side", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--frequencies-hz", type=float, nargs="+", default=[0.05, 0.1, 0.2, 0.5])
    args = parser.parse_args()
    build, work = args.build, args.work.resolve()
    makes = run(build / "tests/blind/textbook/textbook-world", "--makes").split()
    fingers = [(makes[i % len(makes)], args.first_seed + i) for i in range(args.fingers)]
    results = []
    with concurrent.futures.ThreadPoolExecutor(args.side_by_side) as pool:
        for result in pool.map(lambda f: follow(build, work / f"{f[0]}.{f[1]}", f, args.frequencies_hz), fingers):
            results.append(result)
            print(f"{result['make']} {result['seed']}: " + "; ".join(
                f"{hz:g} Hz {result['errors_mm'][hz, 'identified']:.3f}, best PID {best_pid(result, hz):.3f}, paper "
                f"{result['errors_mm'][hz, 'paper']:.3f} mm" for hz in args.frequencies_hz), flush=True)
    if args.page:
        command = f"scripts/textbook_control.py --work DIR --fingers {args.fingers} --page {args.page}"
        args.page.write_text(page(results, args.frequencies_hz, command, results_page.version_of(build)), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
