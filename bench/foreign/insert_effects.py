#!/usr/bin/python3
"""Inserts known effects into recorded repeated runs, and writes the results as data sets for bench/foreign.py.

    bench/foreign/insert_effects.py --out DIR [--data DIR] [--pulses]
    bench/foreign.py --data DIR --only changes --out RESULTS --page PAGE

The runs are those between which a laboratory changed nothing (`repeats` in the table of a data set). An effect is
inserted into the readings of the later run. The baseline runs remain as recorded. Therefore, the finger, the valve, the
noise and the differences between runs are real, and only the effect is artificial. DIR contains 1 new data set for each
data set of --data. With --pulses, the pulses of one recording are used in place of runs: 1 healthy pulse, and the next
pulse with an effect. Sizes of effects are shares of the stroke (highest minus lowest reading). An effect that removes
noise from the readings is followed by new white noise (0.1 % of the stroke, seed 1).
"""
import argparse
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import set_table  # noqa: E402
from log_reading import OUTPUT, read_log  # noqa: E402

SHARED = HERE.parent.parent.parent / "shared/data"
DELAY_S, LAG_S = 0.25, 0.3


def noisy(readings, stroke):
    return readings + 0.001 * stroke * np.random.default_rng(1).standard_normal(len(readings))


def later_by(time_s, values, by_s):
    return np.interp(np.asarray(time_s) - by_s, time_s, values)


def lagged(time_s, readings, lag_s):
    out, state, steps = [], readings[0], np.diff(time_s, prepend=time_s[0])
    for reading, step_s in zip(readings, steps):
        state += (reading - state) * -np.expm1(-step_s / lag_s)
        out.append(state)
    return np.array(out)


def with_play(readings, width):
    out, state = [], readings[0]
    for reading in readings:
        state = min(max(state, reading - width / 2), reading + width / 2)
        out.append(state)
    return np.array(out)


# name: (label, causes that are correct answers, function of time, readings, lowest reading and stroke that returns the new
# readings)
EFFECTS = {
    "contact": ("an object at 60 % of the stroke, beyond which the finger is 4 times as stiff as in free motion", ["contact"],
                lambda t, y, low, s: np.where(y > low + 0.6 * s, low + 0.6 * s + 0.25 * (y - low - 0.6 * s), y)),
    "stop": ("a mechanical stop at 70 % of the stroke", ["contact", "sensor_saturation"],
             lambda t, y, low, s: noisy(np.minimum(y, low + 0.7 * s), s)),
    "gain": ("the stroke is reduced by 15 %", ["ageing", "payload", "stress_softening", "thermal_gain"],
             lambda t, y, low, s: low + 0.85 * (y - low)),
    "weight": ("a weight, which reduces the stroke by 10 % and all readings by 5 % of the stroke", ["payload", "ageing"],
               lambda t, y, low, s: low - 0.05 * s + 0.9 * (y - low)),
    "drift": ("the zero offset of the sensor drifts by 20 % of the stroke during the run", ["sensor_drift"],
              lambda t, y, low, s: y + 0.2 * s * (np.asarray(t) - t[0]) / (t[-1] - t[0])),
    "delay": (f"displacement and pressure are delayed by {DELAY_S} s relative to the command", ["transport_delay", "valve_lag", "sensor_lag"],
              lambda t, y, low, s: later_by(t, y, DELAY_S)),
    "filter": (f"a low-pass filter with a time constant of {LAG_S} s after the sensor", ["sensor_lag", "valve_lag", "transport_delay"],
               lambda t, y, low, s: lagged(t, y, LAG_S)),
    "play": ("mechanical play of 10 % of the stroke between the finger and the sensor", ["backlash", "hysteresis_shape", "asymmetric_hysteresis"],
             lambda t, y, low, s: noisy(with_play(y, 0.1 * s), s)),
    "bend": ("a nonlinear sensor: in the middle of the stroke, the readings are too high by 10 % of the stroke", ["sensor_nonlinearity", "stiffening"],
             lambda t, y, low, s: y + 0.4 * (y - low) * (1 - (y - low) / s)),
}


def filled(values):
    """Interpolates missing readings between their neighbours, because an effect acts on every sample."""
    values = np.array(values, dtype=float)
    known = np.isfinite(values)
    return np.interp(np.arange(len(values)), np.flatnonzero(known), values[known])


def inserted(log, effect):
    """Returns the columns of a log after an effect was inserted into the readings."""
    readings = filled(log.columns["displacement"])
    low, stroke = readings.min(), np.ptp(readings)
    columns = {**log.columns, "displacement": EFFECTS[effect][2](log.time_s, readings, low, stroke)}
    if effect == "delay" and "pressure" in columns:
        columns["pressure"] = later_by(log.time_s, columns["pressure"], DELAY_S)
    return columns


def write_set(data_set, pairs, folder):
    """Writes the logs and the table of 1 new data set. `pairs` are the pairs of `repeats` in `data_set` that are used."""
    folder.mkdir(parents=True, exist_ok=True)
    entries, changes = {}, []

    def written(name, log, begin):
        log_name = name.replace(" ", "_")
        (folder / f"{log_name}.csv").write_text(log.text())
        columns = ", ".join(f"{column}: {OUTPUT[column]}" for column in OUTPUT if column in log.columns)
        entries[log_name] = f"- {{name: {log_name}, file: {log_name}.csv, begin: {begin}, time: time_s, {columns}}}"
        return log_name

    def log_of(name):
        return read_log(data_set.logs[name], data_set.folder), data_set.logs[name].begin

    for pair in pairs:
        baseline = [written(name, *log_of(name)) for name in pair.baseline]
        for effect, (label, causes, _) in EFFECTS.items():
            log, begin = log_of(pair.later)
            log.columns = inserted(log, effect)
            later = written(f"{pair.later}-{effect}", log, begin)
            changes.append(f"- {{baseline: [{', '.join(baseline)}], later: {later}, label: \"{label}\", "
                           f"causes: [{', '.join(causes)}], because: inserted by bench/foreign/insert_effects.py}}")
    about = " ".join([*data_set.about.split(), "Each later run has an inserted effect (`bench/foreign/insert_effects.py`)."])
    (folder / set_table.OWN_TABLE).write_text("\n".join([
        f"title: \"{data_set.title}, with inserted effects\"", f"about: \"{about}\"", f"source: \"{data_set.source}\"",
        f"licence: \"{data_set.licence}\"", "logs:", *entries.values(), "changes:", *changes, "identification: []", ""]))


def chosen(pairs, pulses=False):
    """For each later run, returns the element of `pairs` with the largest number of baseline runs."""
    most = {}
    for pair in pairs:
        if (pair.group != "runs") == pulses and len(pair.baseline) > len(getattr(most.get(pair.later), "baseline", [])):
            most[pair.later] = pair
    return list(most.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=SHARED if SHARED.is_dir() else HERE / "data")
    parser.add_argument("--pulses", action="store_true", help="pulses of one recording instead of runs")
    args = parser.parse_args()
    sets, problems = set_table.find_sets([args.data], HERE / "sets", args.out / "tables")
    for problem in problems:
        print(problem, file=sys.stderr)
    for data_set in sets:
        pairs = chosen(data_set.repeats, args.pulses)
        if pairs:
            write_set(data_set, pairs, args.out / f"{data_set.name}_inserted")
            print(f"{args.out / data_set.name}_inserted: {len(pairs)} runs with {len(EFFECTS)} effects each")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
