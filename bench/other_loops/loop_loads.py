"""Draws the disturbances and setpoints of the simulated loops. Each function returns one value per scan."""
import numpy as np


def held(scans, rng, mean_hold, draw):
    """Returns a staircase: draw() gives each level, and a level lasts mean_hold * (0.3 to 1.7) scans."""
    values = np.empty(scans)
    at = 0
    while at < scans:
        until = at + max(2, int(mean_hold * rng.uniform(0.3, 1.7)))
        values[at:until], at = draw(), until
    return values


def wander(scans, rng, deviation, memory):
    """Returns a first-order autoregressive load with a standard deviation and a memory [scans]."""
    keep = np.exp(-1 / memory)
    steps = deviation * np.sqrt(1 - keep * keep) * rng.standard_normal(scans)
    values, state = np.empty(scans), deviation * rng.standard_normal()
    for k in range(scans):
        state = values[k] = keep * state + steps[k]
    return values


def walk(scans, rng, per_scan, limit=30.0):
    """Returns a random walk that is reflected at a limit."""
    values = np.cumsum(per_scan * rng.standard_normal(scans))
    return limit - np.abs((values + limit) % (4 * limit) - 2 * limit)


def sine(scans, rng, amplitude, period):
    """Returns a sinusoid whose phase varies slowly."""
    phase = rng.uniform(0, 2 * np.pi) + np.cumsum(0.02 * rng.standard_normal(scans)) / np.sqrt(period)
    return amplitude * np.sin(2 * np.pi * np.arange(scans) / period + phase)


def square(scans, rng, amplitude, period):
    return amplitude * np.sign(sine(scans, rng, 1.0, period))


def bursts(scans, rng, amplitude, period):
    """Returns a sinusoid or rectangular pulses during about a third of the time."""
    on = held(scans, rng, 5 * period, lambda: float(rng.random() < 0.35))
    return on * (sine if rng.random() < 0.5 else square)(scans, rng, amplitude, period)
