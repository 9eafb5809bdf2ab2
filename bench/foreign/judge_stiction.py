"""Implements judge 3: control loops whose valves engineers labelled as sticking or not sticking.

Each loop is identified with `softgrip identify`. After that, it is diagnosed with `softgrip diagnose` and the
identified model, as a user would do. Horch's phase test (horch.py) is applied to the same signals for comparison.
"""
import csv

import horch
from outcomes import Failed
from runner import names_in, result_of, slug

STICTION, DRIFT = {"valve_deadband"}, "sensor_drift"


def signals(path):
    """Returns command and reading of the samples that have a command and a reading."""
    with path.open(newline="") as file:
        rows = [(row["pressure_command_kpa"], row["displacement_mm"]) for row in csv.DictReader(file)]
    known = [(float(u), float(y)) for u, y in rows if u and y]
    return [u for u, _ in known], [y for _, y in known]


def judged_names(names):
    """Judges the diagnosis of one control loop. Returns the keys that the case of this loop has in addition to the
    common keys."""
    alternatives = {rival for rivals in names["alternatives"] for rival in rivals}
    named, drift = bool(STICTION & set(names["named"])), DRIFT in names["named"]
    return {"stiction_named": named, "stiction_listed": named or bool(STICTION & (alternatives | set(names["partial"]))),
            "drift_named": drift, "drift_alone": names["named"] == [DRIFT] and names["alternatives"] == [[]]}


def judge_loop(runner, data_set, loop):
    if loop.problems:
        raise Failed("\n".join(loop.problems))
    log = runner.log(data_set, loop.log)
    by_phase, ratio = horch.verdict(*signals(log.path))
    case = {"sticks": loop.sticks, "horch": by_phase, "phase_ratio": ratio}
    folder, outcome = runner.identify(data_set, [log])
    result_of(outcome)
    diagnosis = result_of(runner.diagnose(runner.out / data_set.name / "stiction" / slug(loop.log),
                                          folder / "model.yaml", [log]))
    names = names_in(diagnosis)
    return {**case, **names, **judged_names(names), "diagnosis_s": diagnosis["wall_s"]}


def said(case):
    return f"{case['verdict']}: {', '.join(case['named']) or 'nothing named'}; Horch: {case['horch']}"


def summary(cases):
    found = {}
    for label, sticks in (("sticking", True), ("others", False)):
        good = [case for case in cases if "error" not in case and case["sticks"] is sticks]
        found[label] = {"cases": len(good), **{key: sum(case[key] for case in good) for key in (
            "stiction_named", "stiction_listed", "drift_named", "drift_alone")},
            "horch": sum(case["horch"] == "sticks" for case in good)}
    found["failed"] = sum("error" in case for case in cases)
    return found
