"""Fits the logs of bench/sysid_starts.cpp with SciPy's least_squares and a compiled simulator, from the start points of
sysid_starts."""
import ctypes
import sys
import time

import numpy as np
from scipy.optimize import least_squares

folder, count = sys.argv[1], int(sys.argv[2])
library = ctypes.CDLL(folder + "/simulator.so")
pointer = ctypes.POINTER(ctypes.c_double)
K0 = 325.9

logs = []
for number in (1, 2, 3):
    data = np.genfromtxt(f"{folder}/log{number}.csv", delimiter=",", skip_header=1)
    logs.append([np.ascontiguousarray(data[:, i]) for i in range(3)])
starts = np.loadtxt(folder + "/starts.txt", ndmin=2)[:count]
ours = np.loadtxt(folder + "/ours.txt")
our_rmse, our_cpu_s = ours[:-1], ours[-1]


def simulate(x, t, p):
    y = np.empty(len(t))
    full = np.array([x[0], x[1], x[2], x[3], K0, x[4], x[5], x[6], x[7], 0.0])
    library.simulate(ctypes.c_size_t(len(t)), t.ctypes.data_as(pointer), p.ctypes.data_as(pointer), 2,
                     full.ctypes.data_as(pointer), y.ctypes.data_as(pointer))
    return y


def natural(z):
    """Converts the fitted numbers to the parameters of the model. As in softgrip, the fitted numbers are the logarithms
    of stiffnesses and dampings; all other parameters are fitted directly."""
    return np.concatenate([z[:4], np.exp(z[4:])])


def residuals(z):
    x = natural(z)
    return np.concatenate([simulate(x, t, p) - y for t, p, y in logs])


lower = np.array([0, 0, -10, 0] + [np.log(1e-9)] * 4)
upper = np.array([10, 10, 10, 10] + [np.log(1e9)] * 4)
rmse, seconds, evaluations = [], [], 0
for start in starts:
    z0 = np.concatenate([start[:4], np.log(start[4:])])
    began = time.process_time()
    result = least_squares(residuals, z0, bounds=(lower, upper), x_scale="jac", max_nfev=200)
    seconds.append(time.process_time() - began)
    rmse.append(np.sqrt(2 * result.cost / sum(len(log[0]) for log in logs)))
    evaluations += result.nfev + result.njev * len(z0)
began = time.process_time()
residuals(np.concatenate([starts[0][:4], np.log(starts[0][4:])]))
one = time.process_time() - began
per_start = np.mean(seconds)
ours_per_start = our_cpu_s / len(our_rmse)
print(f"scipy least_squares: {per_start:.3f} s of CPU per start ({evaluations / len(starts):.0f} simulations of {1e3 * one:.2f} ms),"
      f" best RMSE {min(rmse):.6f} mm")
better = sum(a <= b * (1 + 1e-6) for a, b in zip(our_rmse, rmse))
print(f"  RMSE from the same start: softgrip's is equal or lower in {better} of {len(rmse)}; softgrip's best {min(our_rmse):.6f} mm")
for a, b, s in zip(our_rmse, rmse, seconds):
    print(f"    softgrip {a:.6f} mm   scipy {b:.6f} mm in {s:.2f} s")
print(f"  ratio of CPU times per start, one thread each: {per_start / ours_per_start:.0f}")
