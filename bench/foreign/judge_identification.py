"""Implements judge 4: identification compared with a linear output-error model and with a Bouc-Wen fit by SciPy.

Each method fits the first part of a log and predicts the rest, with a simulation from the start of the log. For some
logs, each method fits the whole log and predicts another log. A log with a command and a measured pressure is
identified twice: once with the command as the input (the measured pressure is removed), and once with the measured
pressure as the input.
"""
import json
import pathlib
import sys

from outcomes import Failed, checksum, output_of
from runner import result_of, slug

HERE = pathlib.Path(__file__).resolve().parent
OUTPUT_ERROR, SCIPY, HELD_OUT = HERE / "output_error.py", HERE / "scipy_bouc_wen.py", HERE / "held_out.py"
SIMULATOR = HERE.parent / "sysid_peer_simulator.c"
ORDER = 3  # states of the published Bouc-Wen model: its hysteresis and 2 creep branches
METHODS = ("plain", "auto", "output_error", "scipy")
WORSE = 1.1  # required: the held-out error is at most 10 % larger than that of the linear model


def only(scores):
    return next(iter(scores.values()))


def softgrip(runner, data_set, log, test, split, drive, words):
    words = ["--drive", "measured" if drive == "measured" else "command", *words]
    if not test:
        words += ["--fit-share", f"{split:g}"]
    answer = result_of(runner.identify(data_set, [log], [test] if test else [], words)[1])
    held_out = answer["validation"] if test else answer["held_out"]
    return {"fitted_mm": only(answer["rmse_mm"]), "held_out_mm": only(held_out["rmse_mm"]),
            "structure": (answer.get("structure") or {}).get("description")}


def library(runner):
    """Compiles the simulator of the SciPy fit if necessary. Returns the path of the simulator."""
    path = runner.out / "simulator.so"
    if not path.exists() or path.stat().st_mtime < SIMULATOR.stat().st_mtime:
        output_of(["cc", "-O2", "-shared", "-fPIC", "-o", path, SIMULATOR, "-lm"], runner.at_most_s)
    return path


def peer(runner, data_set, log, test, script, words):
    """Runs a program for comparison that shares no code with softgrip. Returns the result of the program."""
    files = [log.path, *([test.path] if test else [])]
    sources = [script, HELD_OUT, SIMULATOR]
    name = f"{script.stem} {log.name} {test.name if test else ''} {log.path.parent.name}"
    folder = runner.out / data_set.name / "peers" / slug(name)
    text = [str(word) for word in words]
    return result_of(runner.kept(folder, checksum(*files, *sources, *text), lambda _: json.loads(output_of(
        [sys.executable, script, log.path, *text, *([test.path] if test else [])], runner.at_most_s))))


def methods_of(runner, data_set, fit, drive):
    """Returns the log, and a function for each method that returns the result of the method."""
    log = runner.log(data_set, fit.log, drive)
    test = runner.log(data_set, fit.test, drive) if fit.test else None
    split = data_set.logs[fit.log].split
    order = fit.order or ORDER
    return log, {
        "plain": lambda: softgrip(runner, data_set, log, test, split, drive, []),
        "auto": lambda: softgrip(runner, data_set, log, test, split, drive, ["--structure", "auto"]),
        "output_error": lambda: peer(runner, data_set, log, test, OUTPUT_ERROR, [f"{split:g}", order]),
        "scipy": lambda: peer(runner, data_set, log, test, SCIPY, [f"{split:g}", library(runner)])}


def drives(data_set, fit):
    both = {"command", "pressure"} <= set(data_set.logs[fit.log].columns)
    return ("command", "measured") if both else ("command",)


def judge_fit(runner, data_set, fit):
    if fit.problems:
        raise Failed("\n".join(fit.problems))
    rows = []
    for drive in drives(data_set, fit):
        log, methods = methods_of(runner, data_set, fit, drive)
        row = {"drive": drive, "span_mm": log.span_mm, "samples": log.samples, "length_s": log.length_s, "methods": {},
               "errors": {}}
        for name, method in methods.items():
            try:
                row["methods"][name] = method()
            except Failed as failed:
                row["errors"][name] = str(failed)
        rows.append(row)
    return {"order": fit.order or ORDER, "rows": rows}


def held_out_percent(row, method):
    """Returns the held-out error of a method in percent of the span; None if the method failed."""
    result = row["methods"].get(method)
    return None if result is None else 100 * result["held_out_mm"] / row["span_mm"]


def linear_is_better(row, method):
    """Returns True if the held-out error of `method` exceeds that of the linear model by more than 10 %."""
    own, linear = held_out_percent(row, method), held_out_percent(row, "output_error")
    return own is not None and linear is not None and own > WORSE * linear


def said(case):
    def cell(row, method):
        value = held_out_percent(row, method)
        return f"{method} {value:.2f}" if value is not None else f"{method} failed"
    return "; ".join(f"{row['drive']}: " + ", ".join(cell(row, method) for method in METHODS) for row in case["rows"])


def summary(cases):
    rows = [row for case in cases if "error" not in case for row in case["rows"]]
    complete = [row for row in rows if not row["errors"]]

    def best(row):
        return min(METHODS, key=lambda method: held_out_percent(row, method))
    return {"rows": len(rows), "failed": sum("error" in case for case in cases), "methods_failed": sum(
        len(row["errors"]) for row in rows), "linear_better": {method: sum(linear_is_better(row, method) for row in rows)
                                                              for method in ("plain", "auto")},
            "first": {method: sum(best(row) == method for row in complete) for method in METHODS}}
