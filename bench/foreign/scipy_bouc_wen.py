#!/usr/bin/python3
"""Bouc-Wen (exponent 1) with two Kelvin-Voigt branches, fitted by scipy's least_squares to the first part of a log.

    scipy_bouc_wen.py LOG.csv SPLIT SIMULATOR.so     prints JSON: RMSE of what was fitted and of the continuation [mm]

Shares nothing with softgrip: the chain is bench/sysid_peer_simulator.c, compiled. Driven by the measured pressure where
there is one. The log is taken to begin at rest under its first pressure; the readings' zero is fitted with the other
eight numbers. Four starts, the best of which counts.
"""
import ctypes
import json
import sys

try:
    import numpy as np
    from scipy.optimize import least_squares
except ImportError as error:
    sys.exit(f"{error}: install the package python3-scipy (scripts/packages.sh benchmarks)")

K0 = 1e12  # the elastic spring only adds to alpha
STARTS, EVALUATIONS = 4, 200
POINTER = ctypes.POINTER(ctypes.c_double)


class Problem:
    """In units of the log's own ranges, so that every number is of the order of one."""

    def __init__(self, log, split, library):
        self.simulator = ctypes.CDLL(library).simulate
        self.time, self.pressure, self.reading = log
        self.reading_range = np.nanmax(self.reading) - np.nanmin(self.reading)
        self.p = np.ascontiguousarray((self.pressure - self.pressure[0]) / np.ptp(self.pressure))
        self.y = self.reading / self.reading_range
        self.fitted = np.arange(len(self.time)) < int(split * len(self.time))

    def simulate(self, z):
        alpha, beta, gamma, eta = z[0], z[1], (z[2] + z[3]) / 2, (z[2] - z[3]) / 2
        compliance, tau = np.exp(z[4:8:2]), np.exp(z[5:8:2])
        branches = np.ravel(np.column_stack([1 / compliance, tau / compliance]))
        x = np.array([alpha, beta, gamma, eta, K0, *branches, z[8]])
        answer = np.empty(len(self.time))
        with np.errstate(all="ignore"):
            self.simulator(ctypes.c_size_t(len(answer)), self.time.ctypes.data_as(POINTER),
                           self.p.ctypes.data_as(POINTER), 2, x.ctypes.data_as(POINTER), answer.ctypes.data_as(POINTER))
        return np.nan_to_num(answer, nan=1e3, posinf=1e3, neginf=-1e3).clip(-1e3, 1e3)

    def error(self, z, where):
        where = where & np.isfinite(self.y)
        return (self.simulate(z) - self.y)[where]

    def rmse_mm(self, z, where):
        return float(np.sqrt(np.mean(self.error(z, where) ** 2)) * self.reading_range)


def read(path):
    data = np.genfromtxt(path, delimiter=",", names=True)
    drive = data["pressure_kpa"] if "pressure_kpa" in data.dtype.names else data["pressure_command_kpa"]
    known = np.isfinite(drive)
    drive = np.interp(data["time_s"], data["time_s"][known], drive[known])
    return [np.ascontiguousarray(values, dtype=float) for values in (data["time_s"], drive, data["displacement_mm"])]


def main():
    path, split, library = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    problem = Problem(read(path), split, library)
    length = problem.time[-1] - problem.time[0]
    # alpha, beta, gamma + eta (below 0 the hysteresis would run away), gamma - eta, then ln compliance and ln time
    # constant of each branch, the zero
    lower = np.array([-10, -10, 0, -50] + [np.log(1e-6), np.log(1e-3)] * 2 + [-10])
    upper = np.array([10, 10, 50, 50] + [np.log(10), np.log(100 * length)] * 2 + [10])
    first = problem.y[np.isfinite(problem.y)][0]
    middle = np.array([0.8, 0.3, 1, 1, np.log(0.1), np.log(0.01 * length), np.log(0.1), np.log(0.2 * length), first])
    random = np.random.default_rng(1)
    fits = []
    for start in range(STARTS):
        z = middle + (random.normal(size=9) * [0.4, 0.3, 1, 1, 1, 1, 1, 1, 0.05] if start else 0)
        fits.append(least_squares(problem.error, np.clip(z, lower + 1e-6, upper - 1e-6), bounds=(lower, upper),
                                  x_scale="jac", max_nfev=EVALUATIONS, args=(problem.fitted,)))
    best = min(fits, key=lambda fit: fit.cost)
    json.dump({"fitted_mm": problem.rmse_mm(best.x, problem.fitted),
               "continuation_mm": problem.rmse_mm(best.x, ~problem.fitted), "converged": bool(best.status > 0)},
              sys.stdout)


if __name__ == "__main__":
    main()
