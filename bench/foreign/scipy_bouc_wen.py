#!/usr/bin/python3
"""Fits a Bouc-Wen element (exponent 1) with two Kelvin-Voigt branches to the first part of a log with SciPy.

    scipy_bouc_wen.py LOG.csv SPLIT SIMULATOR.so [TEST.csv]     prints JSON: RMSE of the fitted and of the predicted part [mm]

The program shares no code with softgrip: the simulator is the compiled bench/sysid_peer_simulator.c, and the optimiser
is scipy.optimize.least_squares. The input is the measured pressure if the log contains a measured pressure, otherwise
the command. The finger is assumed to be at rest under the first pressure. The zero of the readings is fitted together
with the other eight parameters. The result is the best of the fits from four start points. With TEST, the whole of LOG
is fitted and TEST is predicted.
"""
import ctypes
import json
import sys

try:
    import numpy as np
    from scipy.optimize import least_squares
except ImportError as error:
    sys.exit(f"{error}: install the package python3-scipy (scripts/packages.sh benchmarks)")

from held_out import first_share, read, rmse, rmse_with_own_offset

K0 = 1e12  # stiffness of the elastic spring: so large that the spring has no effect, because alpha already models it
STARTS, EVALUATIONS = 4, 200
POINTER = ctypes.POINTER(ctypes.c_double)


class Problem:
    """The fit of the model. Readings and pressures are divided by their ranges in the fitted log, so that all parameters
    have magnitudes of about one."""

    def __init__(self, log, fitted, library):
        self.simulator = ctypes.CDLL(library).simulate
        self.time, self.pressure, self.reading = log
        self.reading_range = np.nanmax(self.reading) - np.nanmin(self.reading)
        self.pressure_range = np.ptp(self.pressure)
        self.y = self.reading / self.reading_range
        self.fitted = fitted

    def simulate(self, z, time=None, pressure=None):
        time = self.time if time is None else time
        pressure = self.pressure if pressure is None else pressure
        p = np.ascontiguousarray((pressure - pressure[0]) / self.pressure_range)
        alpha, beta, gamma, eta = z[0], z[1], (z[2] + z[3]) / 2, (z[2] - z[3]) / 2
        compliance, tau = np.exp(z[4:8:2]), np.exp(z[5:8:2])
        branches = np.ravel(np.column_stack([1 / compliance, tau / compliance]))
        x = np.array([alpha, beta, gamma, eta, K0, *branches, z[8]])
        answer = np.empty(len(time))
        with np.errstate(all="ignore"):
            self.simulator(ctypes.c_size_t(len(answer)), time.ctypes.data_as(POINTER), p.ctypes.data_as(POINTER), 2,
                           x.ctypes.data_as(POINTER), answer.ctypes.data_as(POINTER))
        return np.nan_to_num(answer, nan=1e3, posinf=1e3, neginf=-1e3).clip(-1e3, 1e3)

    def error(self, z):
        return (self.simulate(z) - self.y)[self.fitted & np.isfinite(self.y)]

    def rmse_mm(self, z, where):
        return rmse((self.simulate(z) - self.y)[where]) * self.reading_range

    def rmse_on_mm(self, z, log):
        time, pressure, reading = log
        simulated = self.simulate(z, time, pressure) * self.reading_range
        return rmse_with_own_offset(time, simulated, reading)


def main():
    path, split, library, *test = sys.argv[1:]
    log = read(path)
    problem = Problem(log, first_share(log[0], 1.0 if test else float(split)), library)
    length = problem.time[-1] - problem.time[0]
    # Bounds of alpha, beta, gamma + eta (if it were below 0, the hysteresis would diverge), gamma - eta, the logarithms of
    # compliance and time constant of each branch, and the zero
    lower = np.array([-10, -10, 0, -50] + [np.log(1e-6), np.log(1e-3)] * 2 + [-10])
    upper = np.array([10, 10, 50, 50] + [np.log(10), np.log(100 * length)] * 2 + [10])
    first = problem.y[np.isfinite(problem.y)][0]
    middle = np.array([0.8, 0.3, 1, 1, np.log(0.1), np.log(0.01 * length), np.log(0.1), np.log(0.2 * length), first])
    random = np.random.default_rng(1)
    fits = []
    for start in range(STARTS):
        z = middle + (random.normal(size=9) * [0.4, 0.3, 1, 1, 1, 1, 1, 1, 0.05] if start else 0)
        fits.append(least_squares(problem.error, np.clip(z, lower + 1e-6, upper - 1e-6), bounds=(lower, upper),
                                  x_scale="jac", max_nfev=EVALUATIONS))
    best = min(fits, key=lambda fit: fit.cost)
    held_out = problem.rmse_on_mm(best.x, read(test[0])) if test else problem.rmse_mm(best.x, ~problem.fitted)
    json.dump({"fitted_mm": problem.rmse_mm(best.x, problem.fitted), "held_out_mm": held_out,
               "converged": bool(best.status > 0)}, sys.stdout)


if __name__ == "__main__":
    main()
