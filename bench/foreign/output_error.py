#!/usr/bin/python3
"""Fits a linear output-error model to a log. The error of this model is the reference that an actuator model should fall
below.

    output_error.py LOG.csv SPLIT ORDER [TEST.csv]     prints JSON: RMSE of the fitted and of the predicted part [mm]

The model has ORDER poles and ORDER zeros and is stable (L. Ljung, System Identification, 2nd edition, section 4.2). The
fit minimises the squared error of the simulation. A search finds the poles; for each set of poles, linear least squares
gives the residues, direct term, offset and initial state (variable projection: Golub and Pereyra, SIAM J. Numer. Anal.
10, 1973, 413-432). Two forms of the model are fitted: one in which all poles are real, and one in which 1 pair of poles
is complex. The form with the smaller error on the fitted part is used. On TEST, the first 5 % (at least 2 s) determine
the offset and the initial state. The prior of the initial state of TEST has the size of the initial state of LOG. The
program shares no code with softgrip.
"""
import itertools
import json
import sys

try:
    import numpy as np
    from scipy.optimize import least_squares
    from scipy.signal import cont2discrete, lfilter
except ImportError as error:
    sys.exit(f"{error}: install the package python3-scipy (scripts/packages.sh benchmarks)")

from held_out import beginning, first_share, read, rmse

# start points of the search: a grid over the range that the sampling can resolve
TIMES, FREQUENCIES, DAMPINGS = 7, 8, (0.05, 0.3, 0.9)
NEARLY_CANCELS = 1e-4  # smallest singular value that is used, relative to the largest singular value
REFINED = 4  # number of best start points from which the search continues
MOST_SAMPLES = 200000  # largest number of points of the grid on which a log is simulated


class Signals:
    """A log on a regular grid. Filtered signals are interpolated at the times of the log's samples."""

    def __init__(self, time, drive):
        step = float(np.median(np.diff(time)))
        length = time[-1] - time[0]
        self.step = max(step, length / MOST_SAMPLES)
        self.time = time
        self.grid = time[0] + self.step * np.arange(int(np.ceil(length / self.step)) + 1)
        self.drive = np.interp(self.grid, time, drive) - drive[0]
        self.impulse = np.zeros(len(self.grid))
        self.impulse[0] = 1.0

    def at_samples(self, values):
        return np.interp(self.time, self.grid, values)

    def forced(self, numerator, denominator):
        """Returns the response of a transfer function in s to the input, which is linear between samples."""
        b, a, _ = cont2discrete((numerator, denominator), self.step, "foh")
        return self.at_samples(lfilter(np.ravel(b), a, self.drive))

    def free(self, denominator):
        """Returns the response of each pole to its initial state without an input. The response to any initial state is a
        linear combination of these responses."""
        _, a, _ = cont2discrete(([1.0], denominator), self.step, "foh")
        motions = [lfilter([0.0] * k + [1.0], a, self.impulse) for k in range(len(a) - 1)]
        return [self.at_samples(motion / np.max(np.abs(motion))) for motion in motions]


class Form:
    """A form of the model: a number of real poles, and one complex pair of poles or no such pair. The search parameters have
    magnitudes of about 1 to 10."""

    def __init__(self, real, pair, step_s, length_s):
        self.real, self.pair = real, pair
        # Limits of the search. The log does not show responses that are slower than its fitted part or faster than its
        # sampling. An overdamped pair is excluded, because it equals 2 real poles.
        self.low = [np.log(step_s)] * real + ([np.log(2 * np.pi / length_s), np.log(0.01)] if pair else [])
        self.high = [np.log(length_s)] * real + ([np.log(0.5 * np.pi / step_s), 0.0] if pair else [])

    def starts(self):
        times = np.linspace(self.low[0] + 1, self.high[0] - 0.5, TIMES) if self.real else []
        reals = itertools.combinations(times, self.real)
        if not self.pair:
            return [np.array(real) for real in reals]
        frequencies = np.linspace(self.low[-2] + 0.5, self.high[-2] - 0.5, FREQUENCIES)
        return [np.array([*real, w, np.log(z)])
                for real, w, z in itertools.product(list(reals), frequencies, DAMPINGS)]

    def denominators(self, numbers):
        """Returns, for each real pole and for the complex pair, the denominator of its transfer functions and their
        numerators."""
        parts = [([tau, 1.0], [[1.0]]) for tau in np.exp(numbers[:self.real])]
        if self.pair:
            w, zeta = np.exp(numbers[-2:])
            parts.append(([1 / w ** 2, 2 * zeta / w, 1.0], [[1.0], [1 / w, 0.0]]))
        return parts

    def forced(self, numbers, signals):
        columns = [signals.at_samples(signals.drive)]
        for denominator, numerators in self.denominators(numbers):
            columns += [signals.forced(numerator, denominator) for numerator in numerators]
        return np.column_stack(columns)

    def free(self, numbers, signals):
        """Returns the columns for the offset and for the responses to initial states."""
        columns = [np.ones(len(signals.time))]
        for denominator, _ in self.denominators(numbers):
            columns += signals.free(denominator)
        return np.column_stack(columns)


def least(columns, values):
    """Returns the least-squares weights of the columns, which may have any magnitude. Linear combinations of columns whose
    sum is nearly zero get no weight."""
    scale = np.linalg.norm(columns, axis=0) + 1e-300
    return np.linalg.lstsq(columns / scale, values, rcond=NEARLY_CANCELS)[0] / scale


class Fit:
    """A model of one form, fitted to the samples `fitted` of a log."""

    def __init__(self, form, signals, reading, fitted):
        self.form, self.signals, self.reading = form, signals, reading
        self.used = fitted & np.isfinite(reading)
        starts = sorted(((self.cost(start), k) for k, start in enumerate(form.starts())))
        starts = [form.starts()[k] for _, k in starts[:REFINED]]
        fits = [least_squares(self.error, np.clip(start, np.array(form.low) + 1e-9, np.array(form.high) - 1e-9),
                              bounds=(form.low, form.high), x_scale=1.0, max_nfev=100) for start in starts]
        self.numbers = min(fits, key=lambda fit: fit.cost).x
        columns, weights = self.solve(self.numbers)
        forced = form.forced(self.numbers, signals).shape[1]
        self.residues, self.start = weights[:forced], weights[forced + 1:]
        self.simulated = columns @ weights
        error = (self.simulated - reading)[self.used]
        self.fitted_mm = rmse(error)
        correlation = np.clip(error[1:] @ error[:-1] / (error @ error), 0, 0.9999)
        # number of correlated errors that have the information of 1 independent error
        self.samples_per_error = (1 + correlation) / (1 - correlation)

    def solve(self, numbers):
        columns = np.hstack([self.form.forced(numbers, self.signals), self.form.free(numbers, self.signals)])
        return columns, least(columns[self.used], self.reading[self.used])

    def error(self, numbers):
        columns, weights = self.solve(numbers)
        return (columns @ weights - self.reading)[self.used]

    def cost(self, numbers):
        error = self.error(numbers)
        return float(error @ error)

    def predict(self, time, drive, reading):
        """Predicts another log. The beginning of that log determines its offset and its initial state."""
        signals = Signals(time, drive)
        forced = self.form.forced(self.numbers, signals) @ self.residues
        free = self.form.free(self.numbers, signals)
        used = beginning(time) & np.isfinite(reading)
        # The offset has no prior. The prior of an initial state has the mean 0 and, as standard deviation, the size of the
        # initial state of the fitted log.
        width = np.maximum(np.abs(self.start), self.fitted_mm) / np.sqrt(self.samples_per_error)
        priors = np.eye(free.shape[1])[1:] * (self.fitted_mm / width)[:, None]
        weights = least(np.vstack([free[used], priors]),
                        np.concatenate([(reading - forced)[used], np.zeros(len(priors))]))
        return forced + free @ weights


def fitted(time, drive, reading, mask, order):
    """Fits all forms of the model with this order. Returns the fit with the smallest error."""
    signals = Signals(time, drive)
    length = float(time[mask][-1] - time[0])
    forms = [Form(order, False, signals.step, length)]
    if order > 1:
        forms.append(Form(order - 2, True, signals.step, length))
    fits = [Fit(form, signals, reading, mask) for form in forms]
    return min(fits, key=lambda fit: fit.cost(fit.numbers))


def main():
    path, split, order, *test = sys.argv[1:]
    time, drive, reading = read(path)
    mask = first_share(time, 1.0 if test else float(split))
    fit = fitted(time, drive, reading, mask, int(order))
    answer = {"fitted_mm": fit.fitted_mm, "resonance": fit.form.pair}
    if test:
        time, drive, reading = read(test[0])
        answer["held_out_mm"] = rmse(fit.predict(time, drive, reading) - reading)
    else:
        answer["held_out_mm"] = rmse((fit.simulated - reading)[~mask])
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
