"""Input signals of the simulated rigs. Each function returns a signal from 0 to 1 at the given times. hold_s is the typical
duration of a level or the typical period."""
import numpy as np


def steps_and_ramps(time_s, rng, hold_s):
    """Returns random levels. A level is reached by a step or by a ramp, and a fifth of the levels is 0."""
    times, levels = [0.0, 0.4 * hold_s], [0.0, 0.0]
    while times[-1] < time_s[-1]:
        level = rng.uniform(0.15, 1.0) if rng.random() > 0.2 else 0.0
        ramp_s = hold_s * (0.005 if rng.random() < 0.5 else rng.uniform(0.3, 1.0))
        times += [times[-1] + ramp_s, times[-1] + ramp_s + hold_s * rng.uniform(0.5, 1.5)]
        levels += [level, level]
    return np.interp(time_s, times, levels)


def triangles(time_s, rng, hold_s):
    """Returns triangles of random height and rate. A third of the triangles return only a part of the way (minor loops). Half
    of the other triangles are followed by a rest at 0."""
    times, levels = [0.0, 0.4 * hold_s], [0.0, 0.0]
    while times[-1] < time_s[-1]:
        top = rng.uniform(0.4, 1.0)
        bottom = top * rng.uniform(0.2, 0.6) if rng.random() < 1 / 3 else 0.0
        for level in (top, bottom):
            times.append(times[-1] + hold_s * rng.uniform(0.4, 1.6))
            levels.append(level)
        if bottom == 0 and rng.random() < 0.5:
            times.append(times[-1] + hold_s * rng.uniform(0.4, 1.2))
            levels.append(0.0)
    return np.interp(time_s, times, levels)


def staircase(time_s, rng, hold_s):
    """Returns ascending and descending stairs with random heights of the steps."""
    times, levels, direction = [0.0, 0.4 * hold_s], [0.0, 0.0], 1
    while times[-1] < time_s[-1]:
        level = levels[-1] + direction * rng.uniform(0.12, 0.3)
        if not 0 < level < 1:
            level, direction = min(max(level, 0.0), 1.0), -direction
        times += [times[-1] + 0.02 * hold_s, times[-1] + hold_s * rng.uniform(0.6, 1.1)]
        levels += [level, level]
    return np.interp(time_s, times, levels)


def binary(time_s, rng, hold_s):
    """Returns a random binary signal between 2 levels of the run."""
    low, high = rng.uniform(0.0, 0.2), rng.uniform(0.75, 1.0)
    times, levels = [0.0, 0.4 * hold_s], [0.0, 0.0]
    while times[-1] < time_s[-1]:
        level = high if levels[-1] < 0.5 else low
        times += [times[-1] + 0.005 * hold_s, times[-1] + 0.5 * hold_s * rng.integers(1, 5)]
        levels += [level, level]
    return np.interp(time_s, times, levels)


def multisine(time_s, rng, hold_s):
    """Returns a sum of 15 sines up to the frequency 1/hold_s, after a start at 0 during 0.4 hold_s."""
    frequencies = np.arange(1, 16) / 15 / hold_s
    total = np.sum(np.cos(2 * np.pi * np.outer(time_s, frequencies) + rng.uniform(0, 2 * np.pi, 15)), axis=1)
    signal = (total - total.min()) / (total.max() - total.min())
    return signal * np.clip((time_s - 0.4 * hold_s) / hold_s, 0, 1)


def sines(time_s, rng, hold_s):
    """Returns a sine whose period decreases from 4 hold_s to hold_s, with a slowly varying amplitude."""
    share = time_s / time_s[-1]
    cycles = np.cumsum(np.gradient(time_s) * 4 ** share) / (4 * hold_s)
    amplitude = 0.75 + 0.25 * np.cos(2 * np.pi * (rng.uniform(0.5, 1.5) * share + rng.random()))
    return amplitude * (0.5 - 0.5 * np.cos(2 * np.pi * cycles))
