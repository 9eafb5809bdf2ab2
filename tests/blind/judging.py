"""Simulates one world with hidden effects, diagnoses its logs, and judges the diagnosis. The fixed worlds of the test
suite and the campaign use this module.

The diagnosis is called as a user calls it and never receives the truth.
"""
import json
import pathlib
import subprocess
import tempfile

import varying

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIVEN = ROOT / "tests/blind/given.yaml"

# Maps an effect to those of its parameters that have the same meaning in the diagnosis and in the world. Each entry
# maps the name of the parameter in the diagnosis to a function. The function computes the true value from the
# parameters of the world.
SAME_MEANING = {
    "transport_delay": {"delay_s": lambda n: n["delay_s"]},
    "valve_lag": {"time_constant_s": lambda n: n["time_constant_s"]},
    "valve_deadband": {"band_kpa": lambda n: n["band_kpa"]},
    "pressure_saturation": {"limit_kpa": lambda n: n["limit_kpa"]},
    "actuator_threshold": {"threshold_kpa": lambda n: n["threshold_kpa"]},
    "stiffening": {"stiffening_per_mm": lambda n: n["per_mm"]},
    "slow_creep": {"gain_mm_per_kpa": lambda n: n["gain_mm_per_kpa"],
                   "time_constant_s": lambda n: n["time_constant_s"]},
    "thermal_gain": {"gain_per_c": lambda n: n["per_c"]},
    "ageing": {"gain_per_h": lambda n: 3600 * n["per_s"]},
    "contact": {"position_mm": lambda n: n["position_mm"], "stiffening": lambda n: n["stiffness_ratio"]},
    "inertia": {"period_s": lambda n: 1 / n["frequency_hz"], "damping_ratio": lambda n: n["damping"]},
    "backlash": {"gap_mm": lambda n: n["play_mm"]},
    "sensor_lag": {"time_constant_s": lambda n: n["time_constant_s"]},
    "sensor_saturation": {"upper_mm": lambda n: n["limit_mm"]},
    "periodic_disturbance": {"frequency_hz": lambda n: n["frequency_hz"]},
    "outliers": {"size_mm": lambda n: n["size_mm"], "probability": lambda n: n["share"]},
}

# Two effects that are not in the catalogue of causes: a lag that differs between filling and venting, and a hysteresis
# of a different shape. The table maps each effect to the causes of the catalogue that describe it correctly.
STRUCTURE_OF = {"outside_fill_vent_lag": {"valve_lag"}, "outside_stop_operators": {"hysteresis_shape"}}


def is_outside(cause):
    return cause.startswith("outside_")


def judge(hidden, diagnosis):
    """Returns the judgement of a diagnosis. `hidden` contains the ids of the effects that the world really has:

    right            the verdict is correct, and exactly the hidden causes are reported
    ambiguous_right  all hidden causes are reported or are alternatives of reported causes, and no wrong cause is
                     reported, but the conditions of `right` are not met
    partly           only some of several hidden causes are reported or are alternatives, and no wrong cause is reported
    missed           no cause is reported although an effect is hidden
    unexplained      no effect is hidden, but the verdict is that an error remains unexplained
    wrong            a cause is reported although neither this cause nor one of its alternatives is hidden

    If all hidden effects are outside the catalogue of causes, the judgement is also right if the verdict is
    unexplained, or if only causes of STRUCTURE_OF are reported.
    """
    verdict = diagnosis["verdict"]
    named = [cause["id"] for cause in diagnosis["causes"]]
    sets = [{cause, *rivals} for cause, rivals in zip(named, diagnosis["alternatives"])]
    if not hidden:
        return "wrong" if named else "unexplained" if verdict == "unexplained" else "right"
    if all(is_outside(cause) for cause in hidden):
        structure = set().union(*(STRUCTURE_OF.get(cause, set()) for cause in hidden))
        return "wrong" if set(named) - structure else "right" if named or verdict == "unexplained" else "missed"
    if not named:
        return "missed"
    if verdict == "cause_found" and set(named) == set(hidden):
        return "right"
    # A reported cause and its alternatives form a set. Each set must contain a hidden cause that is not already
    # assigned to another set.
    left = list(hidden)
    for one in sorted(sets, key=len):
        held = [cause for cause in left if cause in one]
        if not held:
            return "wrong"
        left.remove(held[0])
    return "partly" if left else "ambiguous_right"


def covered(hidden, truth, diagnosis):
    """Compares the parameters of the hidden causes that are reported with their true values. Only parameters with an
    interval and an entry in SAME_MEANING are compared. Returns {parameter: True if the interval covers the true value,
    otherwise False}."""
    found = {}
    for cause in diagnosis["causes"]:
        if cause["id"] not in hidden:
            continue
        numbers = truth["effects"][cause["id"]]["parameters"]
        for name, of_world in SAME_MEANING.get(cause["id"], {}).items():
            parameter = cause["parameters"].get(name)
            if parameter is None or parameter["ci95"] is None:
                continue
            low, high = parameter["ci95"]
            found[f"{cause['id']}.{name}"] = low <= of_world(numbers) <= high
    return found


def diagnose(build, model, logs, out, *options):
    """Runs `softgrip diagnose`. Returns (diagnosis, None), or (None, message) if the program fails."""
    done = subprocess.run([build / "tools/softgrip", "diagnose", "--model", model, "--data", *logs, "--out", out,
                           *options, "--json"], capture_output=True, text=True)
    return (json.loads(done.stdout), None) if done.returncode == 0 else (None, done.stderr[-300:])


def run_world(build, folder, world):
    """Simulates and diagnoses the world. Returns a copy of the world with the results added."""
    build = pathlib.Path(build).resolve()
    with tempfile.TemporaryDirectory(dir=folder) as name:
        work = pathlib.Path(name)
        make = [build / "tests/blind/blind-world", "--seed", str(world["seed"]), "--strength", str(world["strength"]),
                "--out", work / "logs", "--truth", work / "truth.json", *varying.of_generator(world)]
        if world["causes"]:
            make += ["--cause", ",".join(world["causes"])]
        subprocess.run(make, check=True)
        logs = sorted((work / "logs").glob("*.csv"))
        diagnosis, message = diagnose(build, GIVEN, logs, work / "out")
        if diagnosis is None:
            return {**world, "outcome": "failed", "message": message}
        truth = json.loads((work / "truth.json").read_text())
        return {**world, "outcome": judge(world["causes"], diagnosis), "verdict": diagnosis["verdict"],
                "named": [c["id"] for c in diagnosis["causes"]], "rivals": diagnosis["alternatives"],
                "separates": (diagnosis["next_experiment"] or {}).get("separates"),
                "gain_percent": diagnosis["gain_percent"]["value"],
                "unexplained_percent": diagnosis["unexplained_percent"],
                "covered": covered(world["causes"], truth, diagnosis), "wall_s": diagnosis["wall_s"],
                "reachable": all(e["reachable"] for e in truth["effects"].values())}


def library(build):
    """Returns two lists of ids of the effects that a world can hide. The effects of the first list are in the
    catalogue of causes, and the effects of the second list are not."""
    ids = subprocess.run([pathlib.Path(build) / "tests/blind/blind-world", "--list"], check=True, capture_output=True,
                         text=True).stdout.split()
    return [i for i in ids if not is_outside(i)], [i for i in ids if is_outside(i)]
