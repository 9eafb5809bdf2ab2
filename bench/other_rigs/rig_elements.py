"""Physical elements that several simulated rigs contain. All functions work on signals with a constant interval."""
import math

import numpy as np
from scipy.signal import fftconvolve, lfilter


def lag(values, step_s, constant_s):
    """Returns the response of a first-order lag that is at rest before the first sample."""
    if constant_s <= 0:
        return np.array(values, dtype=float)
    pole = math.exp(-step_s / constant_s)
    return lfilter([1 - pole], [1, -pole], values, zi=[pole * values[0]])[0]


def second_order(values, step_s, hertz, damping):
    """Returns the response of an oscillator with unit static gain. The oscillator is at rest before the first sample."""
    omega = 2 * math.pi * hertz
    decay, turn = math.exp(-damping * omega * step_s), omega * step_s * math.sqrt(1 - damping * damping)
    a1, a2 = -2 * decay * math.cos(turn), decay * decay
    gain = 1 + a1 + a2
    return lfilter([gain], [1, a1, a2], values, zi=[values[0] * (1 - gain), -a2 * values[0]])[0]


def delayed(values, step_s, by_s):
    """Returns the signal at an earlier time, interpolated between samples."""
    index = np.arange(len(values))
    return np.interp(index - by_s / step_s, index, values)


def memory(values, kernel):
    """Returns the convolution of the increments of a signal with a step response (hereditary integral). kernel[k] is the
    response k samples after a unit step."""
    return fftconvolve(np.diff(values, prepend=values[0]), kernel)[:len(values)] + values[0] * kernel[0]


def logarithmic(samples, step_s, constant_s):
    return np.log1p(np.arange(samples) * step_s / constant_s) / math.log(10)


def stretched(samples, step_s, constant_s, exponent):
    return 1 - np.exp(-(np.arange(samples) * step_s / constant_s) ** exponent)


def power_law(samples, step_s, constant_s, exponent):
    return (np.arange(samples) * step_s / constant_s) ** exponent


def play(values, radius):
    """Returns the output of a play operator (backlash of the width 2 radius)."""
    return stiction(values, radius, 0.0)


def prandtl_ishlinskii(values, radii, weights):
    """Returns the weighted sum of play operators. The signal itself has the weight 1 - sum(weights)."""
    return (1 - sum(weights)) * values + sum(weight * play(values, radius) for radius, weight in zip(radii, weights))


def dahl(values, force, stiffness):
    """Returns the friction force of the Dahl model on a given motion."""
    out, state, last = [], 0.0, float(values[0])
    for value in values.tolist():
        move = value - last
        state += stiffness * move * (1 - state / force * (1 if move > 0 else -1))
        state = min(max(state, -force), force)
        out.append(state)
        last = value
    return np.array(out)


def preisach(values, relays=30, spread=0.22, middle=0.25):
    """Returns the output (0 to 1) of a Preisach model on a signal from 0 to 1. The density of the relays is normal in the
    width, and in the centre, of a relay."""
    grid = (np.arange(relays) + 0.5) / relays
    up, down = (axis.ravel() for axis in np.meshgrid(grid, grid, indexing="ij"))
    use = up >= down
    up, down = up[use], down[use]
    density = np.exp(-((up - down - middle) / 0.12) ** 2 / 2 - ((up + down - 1) / 2 / spread) ** 2 / 2)
    density /= density.sum()
    state, out, last = (up + down < 0).astype(float), [], -1.0
    total = 0.0
    for value in values.tolist():
        if value != last:
            state[up <= value] = 1.0
            state[down >= value] = 0.0
            # between 2 relays the output is continuous, because a real material has many more domains
            total, last = float(density @ state), value
        out.append(total)
    return np.array(out)


def stiction(values, band, jump):
    """Returns the position of a valve with stiction (He et al. 2007): the stem remains until the force exceeds the static
    friction `band`, and then follows with the kinetic friction band - jump."""
    out, position, kinetic = [], float(values[0]), band - jump
    for value in values.tolist():
        if value - position > band:
            position = value - kinetic
        elif position - value > band:
            position = value + kinetic
        out.append(position)
    return np.array(out)


def pressed(position, at, factor):
    """Returns the position of a compliant actuator that touches an object at `at`. Beyond `at`, the actuator and the object
    together are `factor` times as stiff as the actuator alone."""
    return position - (1 - 1 / factor) * np.maximum(position - at, 0)
