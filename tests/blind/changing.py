"""Simulates one world in which the finger changes, diagnoses the change and judges the diagnosis. The fixed worlds of
the test suite and the campaign use this module.

A world has these keys: family (`textbook` or `first`), cause (or `none`), strength (1: the option `--strength 8` of
the generator), seed, columns (`pressure` or `command`), and zero_mm and warmer_c of the later logs. The healthy logs
are campaign 0 of the finger. The later logs are campaign 1, with other waveforms and other noise than campaign 0. The
diagnosis is called as a user calls it. A world may also have the keys of varying.py. If `closed_loop` is true, the
later logs are recorded in closed loop.
"""
import json
import pathlib
import subprocess
import tempfile

import judging
import varying

GIVEN = {"textbook": pathlib.Path(__file__).resolve().parent / "textbook/given.yaml", "first": judging.GIVEN}
PROGRAM = {"textbook": "tests/blind/textbook/textbook-world", "first": "tests/blind/blind-world"}
USUAL = 8
# Maps a cause to the indistinguishable causes: they change the readings in the same way, so that no log can distinguish
# them from the cause.
TWINS = {"stiffening": {"sensor_nonlinearity"}, "sensor_nonlinearity": {"stiffening"}}


# Maps the name of a parameter in a simulated world to its name in a diagnosis. The table contains only parameters with
# the same meaning in both. In the textbook family, valve lag and sensor lag have a different meaning. The band of a
# dead band is omitted, because it can be a band of stiction or of drag.
SAME_NUMBERS = {"transport_delay": {"delay_s": "delay_s"}, "valve_lag": {"time_constant_s": "time_constant_s"},
                "pressure_saturation": {"limit_kpa": "limit_kpa"}, "actuator_threshold": {"threshold_kpa": "threshold_kpa"},
                "sensor_lag": {"time_constant_s": "time_constant_s"},
                "slow_creep": {"gain_mm_per_kpa": "gain_mm_per_kpa", "time_constant_s": "time_constant_s"},
                "contact": {"position_mm": "position_mm"}, "sensor_saturation": {"limit_mm": "upper_mm"},
                "periodic_disturbance": {"frequency_hz": "frequency_hz"}}


OTHERWISE_IN_TEXTBOOKS = {"valve_lag", "sensor_lag"}


def intervals(family, cause, diagnosis, truth):
    """If the first reported cause is the true change, compares its parameters with the true values. Returns a list
    with one entry per parameter that has the same meaning in the diagnosis and in the world. An entry contains the
    true value, the reported value and its interval. It also states if the interval covers the true value."""
    if not diagnosis["causes"] or diagnosis["causes"][0]["id"] != cause:
        return []
    if family == "textbook" and cause in OTHERWISE_IN_TEXTBOOKS:
        return []
    answer, true = diagnosis["causes"][0]["parameters"], truth["effects"][cause]["parameters"]
    told = []
    for name, own in SAME_NUMBERS.get(cause, {}).items():
        interval = answer[own]["ci95"] if own in answer else None
        if interval:
            told.append({"number": name, "true": true[name], "value": answer[own]["value"], "ci95": interval,
                         "held": interval[0] <= true[name] <= interval[1]})
    return told


def judge(cause, diagnosis):
    """Returns the judgement of a diagnosis. If the finger has not changed, the judgement is unchanged, false_alarm or
    unexplained. If the finger has changed, it is one of these: first (the true cause is reported first), twin (an
    indistinguishable cause is reported first), listed (the true cause is reported later or as an alternative), missed
    (no change is reported), unnamed (a change is reported without a cause) or wrong."""
    named = [c["id"] for c in diagnosis["causes"]]
    if cause == "none":
        return "false_alarm" if named else diagnosis["verdict"]
    if not named:
        return "unnamed" if diagnosis["verdict"] == "unexplained" else "missed"
    if named[0] == cause:
        return "first"
    if named[0] in TWINS.get(cause, set()):
        return "twin"
    return "listed" if cause in named or any(cause in rivals for rivals in diagnosis["alternatives"]) else "wrong"


def is_changed(truth):
    """Returns False if the logs of a world are the same with and without the hidden cause, for example because the
    commands do not reach a limit. Rows of earlier versions do not state the change of the displacement."""
    return truth.get("recorded_change_mm", 1) > 0


def make(build, world, work):
    """Writes the logs of a world. Returns (healthy logs, later logs, truth)."""
    program = [build / PROGRAM[world["family"]], "--seed", str(world["seed"])]
    program += ["--pressure"] if world["columns"] == "pressure" else []
    runs = ["--runs", str(world.get("baseline_runs", varying.BASELINE_RUNS)), *varying.of_generator(world, False)]
    subprocess.run([*program, *runs, "--out", work / "healthy", "--truth", work / "healthy.json"], check=True)
    later = ["--campaign", "1", "--zero-mm", str(world["zero_mm"]), "--warmer-c", str(world["warmer_c"]),
             *varying.of_generator(world)]
    if world["cause"] != "none":
        later += ["--cause", world["cause"], "--strength", str(USUAL * world["strength"])]
    subprocess.run([*program, *later, "--out", work / "later", "--truth", work / "truth.json"], check=True)
    logs = [sorted((work / name).glob("*.csv")) for name in ("healthy", "later")]
    return (*logs, json.loads((work / "truth.json").read_text()))


def run_world(build, folder, world, threads=1):
    """Simulates and diagnoses the world. Returns a copy of the world with the results added."""
    build = pathlib.Path(build).resolve()
    with tempfile.TemporaryDirectory(dir=folder) as name:
        work = pathlib.Path(name)
        healthy, later, truth = make(build, world, work)
        diagnosis, message = judging.diagnose(build, GIVEN[world["family"]], later, work / "out", "--threads", str(threads),
                                              "--healthy", *healthy)
        if diagnosis is None:
            return {**world, "outcome": "failed", "message": message}
        return {**world, "outcome": judge(world["cause"] if is_changed(truth) else "none", diagnosis),
                "recorded_change_mm": truth["recorded_change_mm"], "verdict": diagnosis["verdict"],
                "named": [c["id"] for c in diagnosis["causes"]], "rivals": diagnosis["alternatives"],
                "sizes": [c["size"] for c in diagnosis["causes"]],
                "intervals": intervals(world["family"], world["cause"], diagnosis, truth), "readings": [
                    {key: r[key] for key in ("reading", "healthy_heldout_rms", "later_rms", "explained_rms", "misfit")} |
                    {"tried": r["tried"][:3]} for r in diagnosis["readings"]],
                "excess_mm": {k: e["excess_mm"] for k, e in truth["effects"].items()}, "wall_s": diagnosis["wall_s"]}
