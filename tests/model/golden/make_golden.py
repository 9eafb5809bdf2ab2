#!/usr/bin/python3
"""Solves the continuous equations with Python and SciPy and writes chain_golden.csv. The solution is independent of
the C++ code of the project.

The script intentionally contains its own copy of the signals and parameters, so that it reads nothing from model/ or
config/. Needs python3-scipy. Usage: ./make_golden.py > chain_golden.csv
"""
from scipy.integrate import solve_ivp

TP1_CYCLE = [(60, 10), (40, 5), (50, 4), (20, 4), (30, 2)]
STEP_LEVELS = [0, 12, 24, 36, 48, 60, 48, 36, 24, 12, 0]

MODELS = {
    "zhang2025": dict(delay=0, lag=0, alpha=0.07079, beta=0.17207, gamma=0.02093, eta=0.02, k0=325.9,
                      branches=[(18.0, 246.1), (2.0, 1.2)]),
    "bench_twin": dict(delay=0.130, lag=0.044, alpha=0.21105, beta=0.1713, gamma=0.01625, eta=0.02428, k0=325.9,
                       branches=[(18.16, 299.8), (2.761, 1.621)]),
}


def tp1():
    corners, t = [(0.0, 0.0)], 0.0
    for peak, length in TP1_CYCLE * 2:
        corners += [(t + length / 2, peak), (t + length, 0.0)]
        t += length
    return corners


def steps():
    corners, t, level = [(0.0, 0.0), (1.0, 0.0)], 1.0, 0.0
    for target in STEP_LEVELS[1:]:
        corners += [(t + 0.2, float(target)), (t + 6.0, float(target))]
        t += 6.0
    corners[-1] = (65.0, 0.0)
    return corners


def integrate(m, corners, times):
    """Returns the displacement at `times`. Integrates each linear segment of the delayed command separately."""
    corners = [(0.0, 0.0)] + [(t + m["delay"], p) for t, p in corners if t + m["delay"] > 0]
    corners.append((times[-1] + 1, corners[-1][1]))
    state = [0.0, 0.0] + [0.0] * len(m["branches"])
    result, pending = [], list(times)

    def displacement(t, s, u):
        p = s[0] if m["lag"] else u(t)
        return m["alpha"] * p - s[1] + p / m["k0"] + sum(s[2:])

    for (t0, p0), (t1, p1) in zip(corners, corners[1:]):
        if t1 <= t0:
            continue
        slope = (p1 - p0) / (t1 - t0)

        def u(t):
            return p0 + slope * (t - t0)

        def rate(t, s):
            p = s[0] if m["lag"] else u(t)
            dp = (u(t) - s[0]) / m["lag"] if m["lag"] else slope
            h = s[1]
            dh = m["beta"] * dp - m["gamma"] * dp * abs(h) - m["eta"] * abs(dp) * h
            return [dp if m["lag"] else 0.0, dh] + [(p - k * x) / c for (k, c), x in zip(m["branches"], s[2:])]

        inside = [t for t in pending if t <= t1 + 1e-12]
        pending = pending[len(inside):]
        points = sorted(set(inside + [t1]))
        solution = solve_ivp(rate, (t0, max(t1, points[-1])), state, method="DOP853", rtol=1e-12, atol=1e-13,
                             t_eval=points, max_step=0.02)
        for t, column in zip(solution.t, solution.y.T):
            if t in inside:
                result.append(displacement(t, column, u))
        state = list(solution.y[:, list(solution.t).index(t1)] if t1 in solution.t else solution.y[:, -1])
        if not pending:
            break
    return result


print("model,signal,time_s,displacement_mm")
for name, parameters in MODELS.items():
    for signal, corners in (("tp1", tp1()), ("steps", steps())):
        last = corners[-1][0]
        times = [round(0.7 * i, 6) for i in range(1, int(last / 0.7) + 1)]
        for t, y in zip(times, integrate(parameters, corners, times)):
            print(f"{name},{signal},{t},{y:.12f}")
