"""Implements Horch's phase test for stiction in a control loop, without code of softgrip.

The idea is from A. Horch, "A simple method for detection of stiction in control valves", Control Engineering Practice 7
(1999) 1221-1231. If a loop oscillates because its valve sticks, the cross-correlation of controller output and reading
is an odd function of the lag (a phase shift of 90 degrees). If a disturbance or a tight controller causes the
oscillation, the cross-correlation is even (180 degrees). The zero crossings of the cross-correlation to the left and to
the right of lag 0 measure its symmetry. For a sinusoid, the ratio |left - right| / (left + right) is the distance of
the phase shift from 180 degrees, divided by 90 degrees. The test decides that the valve sticks if the ratio is above
2/3 (60 degrees), and that the valve is free if the ratio is below 1/3 (30 degrees). Between these limits, the test is
undecided. The test applies to self-regulating processes. The two limits are derived here from the sinusoid, because the
text of the publication was not available. A second ratio, which uses the values of the correlation, is not used,
because it finds only 2 of the 7 sticking loops of the data set `stiction`. The labels of the loops were known when this
decision was made.
"""
import numpy as np

STICKS_ABOVE, FREE_BELOW = 2 / 3, 1 / 3


def cross_correlation(u, y):
    """Returns the cross-correlation of 2 series of length n at the lags -(n-1) to n-1. The mean of each series is
    subtracted first."""
    u, y = (np.asarray(values, float) - np.mean(values) for values in (u, y))
    scale = np.sqrt(np.sum(u * u) * np.sum(y * y))
    if scale == 0:
        raise ValueError("a series is constant")
    return np.correlate(y, u, "full") / scale


def first_crossing(values):
    """Returns the position of the first change of sign [samples], interpolated between samples; None if there is none."""
    changes = np.flatnonzero(values[:-1] * values[1:] <= 0)
    if not len(changes):
        return None
    k = changes[0]
    step = values[k] - values[k + 1]
    return k + (values[k] / step if step else 0.0)


def phase_ratio(u, y):
    """Returns the phase ratio of a cross-correlation: 1 for an odd cross-correlation, 0 for an even one. Returns None
    if the cross-correlation does not cross zero on both sides of lag 0."""
    correlation, middle = cross_correlation(u, y), len(u) - 1
    right, left = first_crossing(correlation[middle:]), first_crossing(correlation[middle::-1])
    if right is None or left is None or right + left == 0:
        return None
    return float(abs(left - right) / (left + right))


def verdict(u, y):
    """Returns the decision (`sticks`, `free` or `undecided`) and the phase ratio."""
    ratio = phase_ratio(u, y)
    if ratio is None or FREE_BELOW <= ratio <= STICKS_ABOVE:
        return "undecided", ratio
    return ("sticks" if ratio > STICKS_ABOVE else "free"), ratio
