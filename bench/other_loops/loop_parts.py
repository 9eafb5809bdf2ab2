"""Simulates a control loop: process, PI controller, sensor, load, and the record of a historian.

Process: a gain of 1, first-order lags in series, a dead time, and for a level an integrator. The flow through the valve plus
the load is the input of the process. Signals are deviations in % of the range around 50 %. The controller is a PI controller
with limits of 0 and 100 % and without windup. Its integral time follows the SIMC rule: S. Skogestad, "Simple analytic rules
for model reduction and PID controller tuning", Journal of Process Control 13 (2003) 291-309. Its gain is the ultimate gain
(phase of -180 degrees) divided by a gain margin, so that a gain margin slightly above 1 is a loop at its limit of stability.
"""
import dataclasses
import math

import numpy as np


@dataclasses.dataclass(frozen=True)
class Process:
    """A kind of process with the ranges of its time constants [s]. `intervals` are the usual intervals of the records."""
    name: str
    lags_s: tuple
    delay_s: tuple
    intervals_s: tuple
    scan_s: float
    integrates_s: tuple = ()
    equal_percentage: bool = False


PROCESSES = {process.name: process for process in (
    Process("flow", ((0.5, 3), (0.3, 1.5)), (0, 1), (1, 2, 5, 10), 0.5),
    Process("gas_flow", ((2, 8), (5, 20)), (0, 2), (2, 5, 10), 1.0, equal_percentage=True),
    Process("pressure", ((10, 60), (1, 4)), (0, 3), (2, 5, 10), 1.0),
    Process("level", ((2, 10),), (1, 5), (5, 10, 20), 2.5, (100, 600)),
    Process("temperature", ((60, 300), (10, 40)), (15, 60), (5, 10, 20), 2.5),
    Process("composition", ((600, 1800), (60, 200)), (120, 300), (15, 30), 15.0))}


@dataclasses.dataclass
class Plant:
    lags_s: tuple
    delay_s: float
    integrates_s: float
    scan_s: float


def drawn(process, rng):
    """Returns a plant with random time constants within the ranges of its kind."""
    integrates = float(np.exp(rng.uniform(*np.log(process.integrates_s)))) if process.integrates_s else 0.0
    return Plant(tuple(float(rng.uniform(*limits)) for limits in process.lags_s), float(rng.uniform(*process.delay_s)),
                 integrates, process.scan_s)


def gains(plant, margin, slower=1.0, filter_s=0.0):
    """Returns the gain and the integral time [s] of the PI controller for a gain margin of the sampled loop. `slower`
    multiplies the integral time."""
    longest, rest = max(plant.lags_s), sum(plant.lags_s) - max(plant.lags_s)
    delay = plant.delay_s + plant.scan_s
    dead = delay + rest / 2 + filter_s
    integral_s = slower * (8 * dead if plant.integrates_s else min(longest + rest / 2, 8 * dead))
    back = np.exp(-1j * np.exp(np.linspace(np.log(1e-6), np.log(math.pi), 4000)))  # shift by one scan
    response = (1 + plant.scan_s / integral_s / (1 - back)) * back ** (1 + round(plant.delay_s / plant.scan_s))
    for lag_s in (*plant.lags_s, *((filter_s,) if filter_s else ())):
        pole = math.exp(-plant.scan_s / lag_s)
        response = response * (1 - pole) / (1 - pole * back)
    if plant.integrates_s:
        response = response * plant.scan_s / plant.integrates_s / (1 - back)
    phase = np.unwrap(np.angle(response))
    below = np.flatnonzero(phase <= -math.pi)
    below = below[below > np.argmax(phase)] if len(below) else below
    at = below[0] if len(below) else -1
    return float(1 / abs(response[at]) / margin), float(integral_s)


class Line:
    """The state of a process."""

    def __init__(self, plant, start):
        self.poles = [math.exp(-plant.scan_s / lag_s) for lag_s in plant.lags_s]
        self.states = [0.0 if plant.integrates_s else start] * len(plant.lags_s)
        self.waiting = [0.0 if plant.integrates_s else start] * max(1, round(plant.delay_s / plant.scan_s) + 1)
        self.level, self.rate, self.at = start, plant.scan_s / plant.integrates_s if plant.integrates_s else 0.0, 0

    def step(self, value):
        self.waiting[self.at] = value
        self.at = (self.at + 1) % len(self.waiting)
        value = self.waiting[self.at]
        for k, pole in enumerate(self.poles):
            value = self.states[k] = pole * self.states[k] + (1 - pole) * value
        if not self.rate:
            return value
        self.level += self.rate * value
        return self.level


@dataclasses.dataclass
class Loop:
    """A loop. `setpoint`, `load` and `noise` have one value per scan [%]. sensor(value) returns the measured value."""
    plant: Plant
    valve: object
    gain: float
    integral_s: float
    setpoint: np.ndarray
    load: np.ndarray
    noise: np.ndarray
    characteristic: object = float
    sensor: object = float
    filter_s: float = 0.0
    start: float = 50.0


class Running:
    def __init__(self, loop):
        self.loop, self.line = loop, Line(loop.plant, loop.start - 50.0)
        self.value = self.filtered = loop.start
        self.command = self.total = loop.start
        self.stem = loop.valve.stem
        self.keep = math.exp(-loop.plant.scan_s / loop.filter_s) if loop.filter_s else 0.0

    def step(self, k, from_other=0.0):
        """Simulates scan k. `from_other` is the load that another loop causes."""
        loop = self.loop
        self.measured = loop.sensor(self.value + float(loop.noise[k]))
        self.filtered = self.keep * self.filtered + (1 - self.keep) * self.measured
        error = float(loop.setpoint[k]) - self.filtered
        total = self.total + loop.gain * loop.plant.scan_s / loop.integral_s * error
        wanted = total + loop.gain * error
        self.command = min(max(wanted, 0.0), 100.0)
        if self.command == wanted or (wanted > 100) != (error > 0):
            self.total = total
        self.stem = loop.valve.step(self.command, loop.plant.scan_s)
        flow = loop.characteristic(self.stem) - 50.0 + float(loop.load[k]) + from_other
        self.value = self.line.step(flow) + 50.0


def simulated(loops, coupling=0.0):
    """Simulates a loop, or 2 loops with equal scans that are each other's load. Returns the commands, the measured values,
    the values without noise and the stem positions of the first loop, one row per scan."""
    running, rows = [Running(loop) for loop in loops], []
    for k in range(len(loops[0].load)):
        loads = [coupling * (running[1 - n].stem - 50.0) if len(running) > 1 else 0.0 for n in range(len(running))]
        for one, load in zip(running, loads):
            one.step(k, load)
        rows.append((running[0].command, running[0].measured, running[0].value, running[0].stem))
    return np.array(rows).T


def response(plant, flow):
    """Returns the response of the process to a flow whose mean is subtracted, without controller."""
    line = Line(plant, 0.0)
    flow = flow - np.mean(flow)
    return np.array([line.step(float(value)) for value in flow])


def compressed(values, deviation, interpolates):
    """Returns the values that a historian with an exception deviation returns: a value is stored if it differs by more than
    `deviation` from the last stored value. The historian returns the last stored value, or interpolates."""
    stored = [0]
    for k, value in enumerate(values):
        if abs(value - values[stored[-1]]) > deviation:
            stored.append(k)
    if interpolates:
        return np.interp(np.arange(len(values)), stored, values[stored])
    last = np.zeros(len(values), int)
    last[stored] = stored
    return values[np.maximum.accumulate(last)]
