"""Identifies the demo's finger with SciPy from 20 start points: identify.py FIT.csv PREDICT.csv... (simulator.so must
be in the same folder)."""
import ctypes
import json
import pathlib
import sys

import numpy as np
from scipy.optimize import least_squares

library = ctypes.CDLL(str(pathlib.Path(__file__).with_name("simulator.so")))
doubles = np.ctypeslib.ndpointer(dtype=float, flags="C")
library.simulate.argtypes = [ctypes.c_size_t, doubles, doubles, ctypes.c_int, doubles, doubles]


def read(path):
    data = np.genfromtxt(path, delimiter=",", names=True)
    return [np.ascontiguousarray(data[name]) for name in ("time_s", "pressure_command_kpa", "displacement_mm")]


def simulated(z, t, p):
    x = np.concatenate([z[:4], [325.9], np.exp(z[4:]), [0.0]])
    y = np.empty(len(t))
    library.simulate(len(t), t, p, 2, x, y)
    return y


def rmse(z, log):
    return float(np.sqrt(np.mean((simulated(z, *log[:2]) - log[2]) ** 2)))


fit, *others = [read(path) for path in sys.argv[1:]]
published = np.array([0.07079, 0.17207, 0.02093, 0.02, *np.log([18, 246.1, 2, 1.2])])
random = np.random.default_rng(1)
best, reached = None, []
for start in range(20):
    z0 = published + (np.concatenate([published[:4] * random.uniform(-0.6, 0.6, 4), random.uniform(-1, 1, 4)])
                      if start else 0)
    found = least_squares(lambda z: simulated(z, *fit[:2]) - fit[2], z0, x_scale="jac", max_nfev=300)
    reached.append(rmse(found.x, fit))
    if best is None or found.cost < best.cost:
        best = found
covariance = np.linalg.inv(best.jac.T @ best.jac) * 2 * best.cost / (len(fit[0]) - len(best.x))
print(json.dumps({
    "rmse_mm": rmse(best.x, fit), "held_out_rmse_mm": [rmse(best.x, log) for log in others],
    "reached": sum(r < 1.001 * min(reached) for r in reached), "beta": best.x[1],
    "beta_ci95": 1.96 * float(np.sqrt(covariance[1, 1])), "alpha": best.x[0]}))
