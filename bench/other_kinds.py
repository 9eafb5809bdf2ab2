#!/usr/bin/python3
"""Simulates rigs of other kinds than soft grippers, with textbook equations. The logs are simulations, not measurements.
The parameters are typical and do not describe a certain rig.

    bench/other_kinds.py --out DIR

Each rig has a folder in DIR with its logs and foreign.yaml, which bench/foreign.py reads. The runs of a rig differ in gain,
offset, initial state and noise. Equal seeds give equal files.
"""
import argparse
import pathlib
import zlib

import numpy as np
from scipy.signal import cont2discrete, lfilter

DRYER_STEP_S, DRYER_SAMPLES, DRYER_DELAY_SAMPLES, DRYER_LONG_DELAY_SAMPLES = 0.08, 1000, 3, 7
EXCHANGER_STEP_S, EXCHANGER_SAMPLES, EXCHANGER_GAIN_C, FOULED_SHARE = 1.0, 4000, -8, 0.8
DRIVES_STEP_S, DRIVES_SAMPLES, BELT_RAD_PER_S, SLACK_SHARE = 0.02, 1000, 9.0, 0.8
KINDS_OF_INPUT = (0, 0, 1, 2, 0)  # of the runs r1 to r5, none of which has a change


def steps(time_s, rng, hold_s):
    """Returns random levels from 0 to 1 that are held for 0.5 to 1.5 times hold_s."""
    times, levels, now = [0.0, hold_s * 0.3], [0.0, 0.0], hold_s * 0.3
    ramp_s = hold_s * 0.002
    while now < time_s[-1]:
        level = rng.uniform(0.1, 1.0) if rng.random() > 0.2 else 0.0
        times.append(now + ramp_s)
        now += ramp_s + hold_s * rng.uniform(0.5, 1.5)
        times.append(now)
        levels += [level, level]
    return np.interp(time_s, times, levels)


def binary(time_s, rng, clock_s, probability):
    """Returns a random binary signal that changes with the given probability at each tick of the clock."""
    ticks, bits = (time_s / clock_s).astype(int), [0]
    for _ in range(ticks[-1] + 1):
        bits.append(bits[-1] if rng.random() > probability else 1 - bits[-1])
    return np.array(bits)[ticks] * 1.0


def multisine(time_s, rng, highest_hz):
    frequencies = np.arange(1, 26) / 25 * highest_hz
    phases = rng.uniform(0, 2 * np.pi, 25)
    total = np.sum(np.cos(2 * np.pi * np.outer(time_s, frequencies) + phases), axis=1)
    return (total - total.min()) / (total.max() - total.min())


def linear(numerator, denominator, step_s, signal):
    sampled_numerator, sampled_denominator, _ = cont2discrete((numerator, denominator), step_s, "zoh")
    return lfilter(np.ravel(sampled_numerator), sampled_denominator, signal)


def coloured(rng, samples, step_s, constant_s, deviation):
    pole = np.exp(-step_s / constant_s)
    return lfilter([np.sqrt(1 - pole * pole) * deviation], [1, -pole], rng.standard_normal(samples))


def variation(rng):
    """Returns the gain, the offset and the initial state of a run."""
    return 1 + 0.01 * rng.standard_normal(), 0.003 * rng.standard_normal(), rng.uniform(-1, 1)


def dryer(rng, kind, change=None):
    """Heater power [V] to air temperature [V]: two lags and a delay."""
    time_s = np.arange(DRYER_SAMPLES) * DRYER_STEP_S
    gain, offset, initial = variation(rng)
    signal = (lambda: binary(time_s, rng, 0.4, 0.45), lambda: binary(time_s, rng, 0.8, 0.5), lambda: steps(time_s, rng, 5))
    power = 3.41 + 3.0 * signal[kind]()
    delay = DRYER_LONG_DELAY_SAMPLES if change == "delay" else DRYER_DELAY_SAMPLES
    delayed = np.r_[np.full(delay, power[0]), power[:-delay]] - power[0]
    heat = linear([0.9], [0.22 * 0.45, 0.22 + 0.45, 1], DRYER_STEP_S, delayed * gain)
    heat = heat * 0.8 if change == "gain" else heat
    heat = heat + initial * 0.5 * np.exp(-time_s / 0.5)
    noise = coloured(rng, DRYER_SAMPLES, DRYER_STEP_S, 0.25, 0.035)
    return time_s, power, 4.0 + heat + offset * 3 + noise + 0.01 * rng.standard_normal(DRYER_SAMPLES)


def exchanger(rng, kind, change=None):
    """Liquid flow to outlet temperature [deg C]: negative gain, inverse response."""
    time_s = np.arange(EXCHANGER_SAMPLES) * EXCHANGER_STEP_S
    gain, offset, initial = variation(rng)
    signal = (lambda: steps(time_s, rng, 80), lambda: binary(time_s, rng, 30, 0.4), lambda: multisine(time_s, rng, 0.012))
    flow = signal[kind]() * 0.7 + 0.1
    effect = flow - 0.35 * (flow - 0.4) ** 2
    effect = effect - effect[0]
    full = EXCHANGER_GAIN_C * FOULED_SHARE if change == "fouling" else EXCHANGER_GAIN_C
    response = linear([-6, 1], [22 * 35.0, 57, 1], EXCHANGER_STEP_S, np.r_[np.zeros(6), effect[:-6]])
    reading = 97 + full * gain * response + offset * 6 + initial * 0.6 * np.exp(-time_s / 40)
    reading = reading + coloured(rng, EXCHANGER_SAMPLES, EXCHANGER_STEP_S, 60, 0.12)
    reading = reading + 0.04 * rng.standard_normal(EXCHANGER_SAMPLES)
    return time_s, flow, np.round(reading / 0.01) * 0.01


def drives(rng, kind, change=None):
    """Motor voltage [V] to absolute belt speed: a lag and a resonance."""
    time_s = np.arange(DRIVES_SAMPLES) * DRIVES_STEP_S
    gain, offset, _ = variation(rng)
    signal = (lambda: binary(time_s, rng, 1.0, 0.5) * 2 - 1, lambda: binary(time_s, rng, 0.5, 0.4) * 2.4 - 1.2,
              lambda: 2 * multisine(time_s, rng, 1.5) - 1)
    voltage = signal[kind]()
    belt = BELT_RAD_PER_S * (SLACK_SHARE if change == "slack" else 1.0)
    motor = linear([1], [0.28, 1], DRIVES_STEP_S, voltage)
    speed = np.abs(linear([belt**2], [1, 2 * 0.2 * belt, belt**2], DRIVES_STEP_S, motor) * gain * 1.6)
    speed = speed + 0.004 * rng.standard_normal(DRIVES_SAMPLES) + offset * 2
    return time_s, voltage, np.round(speed / 0.005) * 0.005


# For each rig: the function, and the admissible causes of each change. In the logs, a shifted clock looks like a delay.
# Without a thermometer, a gain that follows the temperature looks like a permanent change of the gain. A lower resonance is
# caused by a larger ratio of mass to stiffness.
RIGS = {"dryer": (dryer, {"delay": ["transport_delay", "clock_offset"], "gain": ["ageing", "thermal_gain"]}),
        "exchanger": (exchanger, {"fouling": ["ageing", "thermal_gain"]}),
        "drives": (drives, {"slack": ["inertia"]})}


def write_log(path, columns):
    lines = [",".join(f"{value:.7g}" for value in row) for row in zip(*columns)]
    path.write_text("\n".join(["time_s,pressure_command_kpa,displacement_mm", *lines, ""]))


def write_rig(name, out):
    """Writes the logs and foreign.yaml of a rig. The seed is the checksum of the name and the number of the run."""
    simulate, changes = RIGS[name]
    folder, base = out / name, zlib.crc32(name.encode())
    folder.mkdir(parents=True, exist_ok=True)
    for run, kind in enumerate(KINDS_OF_INPUT):
        write_log(folder / f"r{run + 1}.csv", simulate(np.random.default_rng([base, run]), kind))
    lines = [f'title: "{name} (simulation)"', "about: simulated with textbook equations, not measured",
             "same: {time: time_s, command: pressure_command_kpa, displacement: displacement_mm}", "logs:",
             '- {file: "*.csv"}', "repeats:", "- {baseline: r1, later: r2, because: simulated without a change}",
             *(f"- {{baseline: [r1, r2, r3], later: {later}, because: simulated without a change}}" for later in ("r4", "r5")),
             "changes:"]
    for number, (change, causes) in enumerate(changes.items()):
        columns = simulate(np.random.default_rng([base, 20 + number]), (0, 2)[number % 2], change)
        write_log(folder / f"c_{change}.csv", columns)
        lines.append(f"- {{baseline: [r1, r2, r3], later: c_{change}, label: {change}, because: simulated, "
                     f"causes: [{', '.join(causes)}]}}")
    (folder / "foreign.yaml").write_text("\n".join([*lines, "identification:", "- {log: r1, order: 3}", ""]))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    for rig in RIGS:
        write_rig(rig, options.out)
