"""Simulates runs of a rig: run-to-run variation, sensor, sampling and changes. docs/results/other-rigs.md states the values.

A run begins after a random earlier motion, so its initial state is unsettled. Each run has its own input signal, gain,
offset, temperature, supply, noise and jitter of the sampling. The variation is a property of the rigs and does not depend
on results of softgrip.
"""
import dataclasses
import zlib

import numpy as np

import rig_elements as elements

GAIN, OFFSET_SHARE, TEMPERATURE_K, SUPPLY = 0.01, 0.003, 2.0, 0.01  # standard deviations of the variation
PRESSURE_OFFSET_SHARE, JITTER = 0.002, 0.02
STIFFNESS_PER_K, FRICTION_PER_K = -0.002, -0.01  # of soft materials and of lubricated contacts
BEFORE_HOLDS = 5  # duration of the earlier motion, in multiples of hold_s
HEALTHY, SAME, OTHER = 6, 2, 1
COLUMNS = ("time_s", "pressure_command_kpa", "pressure_kpa", "displacement_mm")


@dataclasses.dataclass(frozen=True)
class Change:
    """A change of a rig. `cause` is the correct name, `also` contains causes that give the same readings, and `sizes` maps
    a parameter of the simulation to its new value."""
    cause: str
    text: str
    sizes: dict
    also: tuple = ()


@dataclasses.dataclass(frozen=True)
class Rig:
    """A rig. simulate(step_s, command, run) returns the displacement [mm] and the pressure [kPa], or None in place of the
    pressure. `low` and `high` are the limits of the command."""
    name: str
    title: str
    simulate: object
    step_s: float
    length_s: float
    fine_s: float
    low: float
    high: float
    span_mm: float
    noise_mm: float
    resolution_mm: float
    family: object
    other: object
    hold_s: float
    changes: tuple
    pressure_noise_kpa: float = 0.0


@dataclasses.dataclass
class Run:
    """The conditions of a run. run("name", healthy) returns the value of a parameter: the changed value, if the change of
    this run has one, otherwise the healthy value."""
    gain: float
    offset: float
    warmer_k: float
    stiffness: float
    friction: float
    supply: float
    pressure_offset: float
    earlier: tuple
    sizes: dict = dataclasses.field(default_factory=dict)

    def __call__(self, name, healthy):
        return self.sizes.get(name, healthy)


def varied(rng):
    """Returns the conditions of a random healthy run."""
    warmer_k = TEMPERATURE_K * rng.standard_normal()
    return Run(1 + GAIN * rng.standard_normal(), OFFSET_SHARE * rng.standard_normal(), warmer_k, 1 + STIFFNESS_PER_K * warmer_k,
               1 + FRICTION_PER_K * warmer_k, 1 + SUPPLY * rng.standard_normal(),
               PRESSURE_OFFSET_SHARE * rng.standard_normal(), (rng.uniform(0.2, 1.0), rng.uniform(0.3, 0.7)))


def command_with_earlier_motion(rig, time_s, signal, run):
    """Returns the normalised command. Before the time 0, the rig holds a random level, and then rests at 0."""
    level, share = run.earlier
    held = -time_s / (BEFORE_HOLDS * rig.hold_s)  # 1 at the begin of the earlier motion, 0 at its end
    earlier = np.where((held > 1 - share) & (held < 0.98), level, 0.0)
    command = earlier.copy()
    command[time_s >= 0] = signal
    return command


def sensed(rig, time_s, position, run):
    """Returns the readings without noise."""
    reading = elements.lag(position, rig.fine_s, run("sensor_lag_s", 0.0))
    reading = reading * run.gain * run("sensor_gain", 1.0) + run.offset * rig.span_mm
    share = np.clip(time_s / rig.length_s, 0, 1)
    reading = reading + run("drift_mm", 0.0) * (1 - np.exp(-2.5 * share)) / (1 - np.exp(-2.5))
    reading = reading + run("bow_mm", 0.0) * 4 * (reading / rig.span_mm) * (1 - reading / rig.span_mm)
    reading = reading + run("hum_mm", 0.0) * np.sin(2 * np.pi * run("hum_hz", 1.0) * time_s)
    return np.clip(reading, None, run("clip_mm", np.inf))


def simulated(rig, rng, run, family, length_s=None):
    """Simulates a run. Returns the columns without noise, and the random generator's draws for the noise remain."""
    length_s = length_s or rig.length_s
    before = round(BEFORE_HOLDS * rig.hold_s / rig.fine_s)
    time_s = (np.arange(round(length_s / rig.fine_s) + 2 + before) - before) * rig.fine_s
    now = time_s >= 0
    share = command_with_earlier_motion(rig, time_s, family(time_s[now], rng, rig.hold_s), run)
    command = rig.low + (rig.high - rig.low) * share
    position, pressure = rig.simulate(rig.fine_s, elements.delayed(command, rig.fine_s, run("delay_s", 0.0)), run)
    reading = sensed(rig, time_s, position, run)
    samples = int(length_s / rig.step_s)
    jitter = np.clip(JITTER * rng.standard_normal(samples), -0.2, 0.2)
    jitter[0] = 0.0
    times = (np.arange(samples) + jitter) * rig.step_s
    columns = {"time_s": times, "pressure_command_kpa": np.interp(times, time_s, command)}
    if rig.pressure_noise_kpa:
        columns["pressure_kpa"] = np.interp(times, time_s, pressure) + run.pressure_offset * (rig.high - rig.low)
    columns["displacement_mm"] = np.interp(times - run("clock_s", 0.0), time_s, reading)
    return columns


def rounded(values, resolution):
    return np.round(values / resolution) * resolution


def recorded(rig, rng, columns):
    """Returns the columns with noise and with the resolution of the sensors."""
    samples, columns = len(columns["time_s"]), dict(columns)
    noise = rig.noise_mm * (0.9 * rng.standard_normal(samples) + 0.4 * np.convolve(
        rng.standard_normal(samples + 4), np.full(5, 5 ** -0.5), "valid"))
    columns["displacement_mm"] = rounded(columns["displacement_mm"] + noise, rig.resolution_mm)
    if "pressure_kpa" in columns:
        measured = columns["pressure_kpa"] + rig.pressure_noise_kpa * rng.standard_normal(samples)
        columns["pressure_kpa"] = rounded(measured, rig.pressure_noise_kpa / 2)
    return columns


def base_seed(rig):
    return zlib.crc32(rig.name.encode())


def runs_of(rig):
    """Yields (name, number of the seed, family, change) for each run of a rig."""
    for number in range(HEALTHY):
        yield f"healthy{number + 1}", number, rig.family, None
    for number in range(SAME):
        yield f"same{number + 1}", 20 + number, rig.family, None
    for number in range(OTHER):
        yield f"other{number + 1}", 40 + number, rig.other, None
    for number, change in enumerate(rig.changes):
        yield f"change_{change.cause}", 60 + number, rig.family, change


def run_columns(rig, number, family, change=None, length_s=None):
    """Returns the columns of a run. Equal arguments give equal columns."""
    rng = np.random.default_rng([base_seed(rig), number])
    run = varied(rng)
    run.sizes = dict(change.sizes) if change else {}
    return recorded(rig, rng, simulated(rig, rng, run, family, length_s))


def distance(rig, one, two):
    """Returns the RMS differences of 2 runs: of the displacement as a share of the span and, if it is measured, of the
    pressure as a share of the range of the command. The mean difference of the displacement is subtracted, because a
    different zero of the sensor is no change (docs/how-to/watch-a-finger.md)."""
    def rms(name, unit):
        difference = one[name] - two[name]
        if name == "displacement_mm":
            difference = difference - difference.mean()
        return float(np.sqrt(np.mean(difference ** 2)) / unit)
    shares = [rms("displacement_mm", rig.span_mm)]
    if "pressure_kpa" in one:
        shares.append(rms("pressure_kpa", abs(rig.high - rig.low)))
    return shares


def ratios(rig, draws=6, length_s=None):
    """Returns the run-to-run RMS difference (share of the span) and, for each cause, the RMS effect of the change divided by
    this difference. All runs of a comparison have the same input, and no noise. The ratio of the pressure is used if it
    is larger than the ratio of the displacement."""
    def columns(number, draw, change=None):
        run = varied(np.random.default_rng([base_seed(rig), 100 + draw]))
        run.sizes = dict(change.sizes) if change else {}
        return simulated(rig, np.random.default_rng([base_seed(rig), number]), run, rig.family, length_s)

    healthy = [columns(0, draw) for draw in range(draws)]
    pairs = [distance(rig, healthy[i], healthy[j]) for i in range(draws) for j in range(i)]
    noise = [rig.noise_mm / rig.span_mm, rig.pressure_noise_kpa / abs(rig.high - rig.low)]
    spread = np.maximum(np.sqrt(np.mean(np.square(pairs), axis=0)), noise[:len(pairs[0])])
    found = {}
    for number, change in enumerate(rig.changes):
        effect = distance(rig, columns(60 + number, 0, change), columns(60 + number, 0))
        found[change.cause] = float(np.max(effect / spread))
    return float(spread[0]), found
