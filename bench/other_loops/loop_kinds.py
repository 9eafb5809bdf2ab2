"""Draws the simulated loops: sticking loops with four models of a sticking valve, and other loops.

The distributions of process, tuning, noise, interval, length and historian are the same for sticking and other loops. The
labels and the criterion for a visible effect were fixed before softgrip judged a loop.
"""
import dataclasses
import zlib

import numpy as np

import loop_loads as loads
import loop_parts as parts
import loop_valves as valves

SAMPLES = (500, 751, 751, 1000, 1500, 3000, 5000)
HALVES = ("first", "second")  # independent seeds; rules are developed with the first half only
PER_MODEL, PER_KIND = 12, 3
MOST_NOISE = 1.0  # standard deviation of the controller output that a well-tuned controller allows [%]
ORDER = ("flow", "level", "flow", "pressure", "gas_flow", "temperature", "flow", "composition")
OTHERS = {
    "aggressive": "gain margin of 1.03 to 1.2, with noise",
    "sine": "sinusoidal load of 1 to 4 %",
    "square": "square load of 1 to 4 %",
    "bursts": "intermittent sinusoidal load or pulses",
    "setpoint": "steps of the setpoint of up to 8 %",
    "load_steps": "steps of the load of up to 8 %",
    "random_walk": "load that is a random walk",
    "quiet": "sensor noise only",
    "cascade": "setpoint that another controller moves slowly",
    "nonlinear": "equal-percentage valve near the limit of stability, steps of the setpoint",
    "saturated": "load that exceeds the range of the valve at times",
    "sensor_band": "sensor that ignores small changes, or has a coarse resolution",
    "interacting": "second loop, aggressive or with a sticking valve, disturbs the loop",
    "compressed": "steps and a slowly varying load, recorded with strong compression"}


@dataclasses.dataclass
class Record:
    """The conditions of a record. Periods are in scans."""
    process: str
    samples: int
    per_sample: int
    interval_s: float
    period: float
    noise: float

    @property
    def scans(self):
        return 2 * self.samples * self.per_sample  # the first half is not recorded


@dataclasses.dataclass
class Simulated:
    name: str
    kind: str
    sticks: bool
    facts: dict
    columns: dict


def record(process, rng, noise):
    per_sample = round(float(rng.choice(parts.PROCESSES[process].intervals_s)) / parts.PROCESSES[process].scan_s)
    samples = int(rng.choice(SAMPLES))
    period = per_sample * float(np.exp(rng.uniform(*np.log((15, samples / 4)))))
    return Record(process, samples, per_sample, per_sample * parts.PROCESSES[process].scan_s, period, noise)


def loop_of(made, rng, valve, margin=None, noisy=True):
    """Returns a loop without load and with a constant setpoint."""
    process = parts.PROCESSES[made.process]
    plant = parts.drawn(process, rng)
    margin = margin or float(rng.uniform(2.5, 8))
    slowest = {"flow": 40, "gas_flow": 10, "pressure": 6}.get(made.process, 2.5)
    slower = float(np.exp(rng.uniform(*np.log((0.7, slowest))))) if margin > 1.3 else 1.0
    filter_s = float(rng.choice((0.0, 2 * plant.scan_s)))
    gain, integral_s = parts.gains(plant, margin, slower, filter_s)
    if margin > 1.3:
        gain = min(gain, MOST_NOISE / made.noise)
        integral_s = max(integral_s, 4 * plant.integrates_s / gain)  # damping ratio of a level loop of at least 1
    noise = made.noise * rng.standard_normal(made.scans) if noisy else np.zeros(made.scans)
    characteristic = valves.equal_percentage if process.equal_percentage else float
    return parts.Loop(plant, valve, gain, integral_s, np.full(made.scans, 50.0), np.zeros(made.scans), noise, characteristic,
                      filter_s=filter_s)


def sticking(model, number, rng):
    """Returns a record and a loop with a sticking valve."""
    process = ORDER[number % len(ORDER)]
    band = float(np.exp(rng.uniform(*np.log((0.5, 8)))))
    jump = band * (0.0 if number % 5 == 3 else float(rng.uniform(0.1, 1)))
    made = record(process, rng, band / float(np.exp(rng.uniform(*np.log((2, 40))))))
    loop = loop_of(made, rng, valves.STICKING[model](50.0, band, jump), noisy=model != "choudhury")
    wandering = band * float(rng.choice((0.02, 0.1, 0.5)))
    loop.load = loads.wander(made.scans, rng, wandering, made.period)
    if number % 3 == 2:
        loop.setpoint = 50 + loads.held(made.scans, rng, 2 * made.period, lambda: band * rng.uniform(-1.5, 1.5))
    return made, [loop], 0.0, {"model": model, "band": band, "jump": jump}


class ResolutionOrBand:
    """A sensor that ignores changes below its band, or that rounds."""

    def __init__(self, band, rounds):
        self.band, self.rounds, self.value = band, rounds, None

    def __call__(self, value):
        if self.rounds:
            return self.band * round(value / self.band)
        if self.value is None or abs(value - self.value) > self.band:
            self.value = value
        return self.value


def other(kind, number, rng):
    """Returns a record, the loops and their coupling for a loop without a sticking valve."""
    process = str(rng.choice(("flow", "flow", "gas_flow", "pressure", "level", "temperature", "composition")))
    made = record(process, rng, float(np.exp(rng.uniform(*np.log((0.05, 0.5))))))
    margin = {"aggressive": (1.03, 1.2), "nonlinear": (1.3, 2.2)}.get(kind)
    loop = loop_of(made, rng, valves.Free(50.0), float(rng.uniform(*margin)) if margin else None)
    scans, size, coupling, loops = made.scans, float(rng.uniform(1, 4)), 0.0, [loop]
    if kind != "quiet":
        loop.load = loads.wander(scans, rng, 0.2 * size * float(rng.choice((0.1, 1.0))), made.period)
    if kind in ("sine", "square", "bursts"):
        loop.load = loop.load + getattr(loads, kind)(scans, rng, size, made.period)
    elif kind in ("setpoint", "compressed"):
        loop.setpoint = 50 + loads.held(scans, rng, 2 * made.period, lambda: rng.uniform(-2, 2) * size)
    elif kind == "load_steps":
        loop.load = loop.load + loads.held(scans, rng, 2 * made.period, lambda: rng.uniform(-2, 2) * size)
    elif kind == "random_walk":
        loop.load = loads.walk(scans, rng, size / made.period ** 0.5)
    elif kind == "cascade":
        loop.setpoint = 50 + loads.wander(scans, rng, 2 * size, 2 * made.period)
    elif kind == "nonlinear":
        loop.characteristic = valves.equal_percentage
        loop.setpoint = 50 + loads.held(scans, rng, 3 * made.period, lambda: rng.uniform(-15, 15))
    elif kind == "saturated":
        loop.load = loop.load + loads.held(scans, rng, 2 * made.period, lambda: float(rng.choice((-55, 0, 20, 55))))
    elif kind == "sensor_band":
        loop.sensor = ResolutionOrBand(float(rng.uniform(0.5, 2)), bool(number % 2))
    elif kind == "interacting":
        valve = valves.Free(50.0) if number % 2 else valves.He(50.0, 2 * size, 1.5 * size)
        second = loop_of(made, rng, valve, float(rng.uniform(1.03, 1.15)) if number % 2 else 3.0)
        second.plant = dataclasses.replace(second.plant, scan_s=loop.plant.scan_s)
        loops, coupling = [loop, second], float(rng.uniform(0.3, 0.6))
    return made, loops, coupling, {}


def visibility(plant, command, stem, made, noise, band):
    """Returns the 2.5 to 97.5 % range of the effect of the friction on the reading, divided by the noise, and the number
    of rests of the stem that last at least 5 samples, in which the command changes by at least half the band, and that
    end with a movement. A sticking loop is *visible* if the ratio is at least 4 and the number at least 2."""
    effect = parts.response(plant, stem - command)[-made.samples * made.per_sample:]
    line = np.arange(len(effect))
    effect = effect - np.polyval(np.polyfit(line, effect, 1), line)
    ratio = float(np.subtract(*np.percentile(effect, (97.5, 2.5)))) / noise
    stem, command = stem[-len(effect):], command[-len(effect):]
    moves = np.flatnonzero(np.abs(np.diff(stem)) > 1e-9)
    ends = zip(np.r_[0, moves[:-1] + 1], moves + 1) if len(moves) else ()
    rests = sum(end - begin >= 5 * made.per_sample and np.ptp(command[begin:end]) >= band / 2 for begin, end in ends)
    return ratio, int(rests)


def recorded(made, rng, command, measured, strong):
    """Returns what the historian returns for the recorded scans, as the set `stiction` is written: both signals begin at
    their smallest value, and the reading is scaled to the span of the controller output."""
    command, measured = (np.array(values[-made.samples * made.per_sample::made.per_sample]) for values in (command, measured))
    kind = "strong" if strong else str(rng.choice(("none", "rounded", "held", "interpolated"), p=(0.45, 0.2, 0.2, 0.15)))
    if kind == "rounded":
        command, measured = np.round(command / 0.05) * 0.05, np.round(measured / 0.05) * 0.05
    elif kind != "none":
        share = float(rng.uniform(*((0.05, 0.15) if strong else (0.005, 0.03))))
        command, measured = (parts.compressed(values, share * np.ptp(values), kind == "interpolated")
                             for values in (command, measured))
    command, measured = command - command.min(), measured - measured.min()
    if np.ptp(measured) > 0:
        measured = measured * np.ptp(command) / np.ptp(measured)
    stated_s = 1.0 if rng.random() < 0.25 else made.interval_s
    return kind, stated_s, {"time_s": stated_s * np.arange(made.samples), "pressure_command_kpa": command,
                            "displacement_mm": measured}


def built(half, kind, number, sticks):
    """Returns a simulated loop. Equal arguments give equal signals."""
    rng = np.random.default_rng([HALVES.index(half), zlib.crc32(kind.encode()), number])
    made, loops, coupling, facts = (sticking if sticks else other)(kind, number, rng)
    command, measured, value, stem = parts.simulated(loops, coupling)
    if facts.get("model") == "choudhury":
        measured = measured + made.noise * rng.standard_normal(made.scans)
    historian, stated_s, columns = recorded(made, rng, command, measured, kind == "compressed")
    span = float(np.ptp(command[-made.samples * made.per_sample:]))
    facts.update(process=made.process, interval_s=made.interval_s, stated_s=stated_s, samples=made.samples,
                 noise=made.noise, historian=historian, op_span=span)
    if sticks:
        ratio, rests = visibility(loops[0].plant, command, stem, made, made.noise, facts["band"])
        facts.update(effect_to_noise=ratio, rests=rests, visible=ratio >= 4 and rests >= 2,
                     share=facts["band"] / max(span, 1e-9))
    return Simulated(f"{'stick' if sticks else 'other'}_{kind}_{number + 1}", kind, sticks, facts, columns)


def planned(half):
    """Returns the arguments of built() for a half of the loops."""
    return [(half, model, number, True) for model in valves.STICKING for number in range(PER_MODEL)] + [
        (half, kind, number, False) for kind in OTHERS for number in range(PER_KIND)]
