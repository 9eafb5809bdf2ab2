"""Simulates one world with textbook equations, diagnoses its logs and judges the diagnosis. The fixed worlds and the
campaign use this module.

A world has these keys: causes, strength, seed, make, columns and given. `columns` is `pressure` if the measured
pressure is recorded, otherwise `command`. `given` selects the model with which the diagnosis starts, see
given_model().
"""
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import judging  # noqa: E402
import varying  # noqa: E402

GIVEN = HERE / "given.yaml"
NOISE_MM = 0.04  # RMS noise of the readings that textbook-world writes [mm]
# Largest permitted ratio of the held-out error of the identified structure to the noise, in a world without a hidden
# effect.
HELD_OUT_AT_MOST = {"pressure": 1.6, "command": 5}


def program(build):
    return pathlib.Path(build).resolve() / "tests/blind/textbook/textbook-world"


def listed(build, option):
    return subprocess.run([program(build), option], check=True, capture_output=True, text=True).stdout.split()


def judge(hidden, own, diagnosis):
    """Returns the judgement of a diagnosis. `hidden` contains the ids of the hidden effects. `own` contains the
    causes that the world has even without a hidden effect.

    found    hidden causes that are reported or are alternatives of a reported cause; each report finds at most one
    alone    found causes that are reported without alternatives
    wrong    reported causes for which neither the cause nor one of its alternatives is hidden or own
    outcome  wrong, right (all are alone), ambiguous_right (all are found), partly, missed; for a world without a hidden
             effect: wrong, unexplained (an error remains and no own cause is reported) or right
    """
    sets = [[cause["id"], *rivals] for cause, rivals in zip(diagnosis["causes"], diagnosis["alternatives"])]
    wrong = [one[0] for one in sets if not {*hidden, *own} & {*one}]
    found, alone = [], []
    for one in sorted(sets, key=len):
        held = [cause for cause in hidden if cause in one and cause not in found]
        if held:
            found.append(held[0])
            alone += held[:1] if len(one) == 1 else []
    if wrong:
        outcome = "wrong"
    elif not hidden:
        outcome = "unexplained" if diagnosis["verdict"] == "unexplained" else "right"
    elif len(found) < len(hidden):
        outcome = "partly" if found else "missed"
    else:
        outcome = "right" if len(alone) == len(hidden) else "ambiguous_right"
    return {"found": found, "alone": alone, "wrong": wrong, "outcome": outcome}


def hiding(world):
    """Returns the options for make_logs() that add the hidden effects of the world."""
    return ["--cause", ",".join(world["causes"]), "--strength", str(world["strength"])] if world["causes"] else []


def make_logs(build, work, world, *options):
    """Writes the logs of the world. Returns (paths of the logs, truth)."""
    command = [program(build), "--seed", str(world["seed"]), "--make", world["make"], "--out", work / "logs", "--truth",
               work / "truth.json", *varying.of_generator(world), *options]
    if world["columns"] == "pressure":
        command.append("--pressure")
    subprocess.run(command, check=True)
    return sorted((work / "logs").glob("*.csv")), json.loads((work / "truth.json").read_text())


def identified(build, logs, out, threads):
    """Identifies a model from the logs. Returns the content of identify.json, or None if the program fails."""
    done = subprocess.run([build / "tools/softgrip", "identify", "--structure", "auto", "--data", *logs, "--out", out,
                           "--threads", str(threads)], capture_output=True, text=True)
    return json.loads((out / "identify.json").read_text()) if done.returncode == 0 else None


def given_model(build, work, world, threads):
    """Returns the path of the model with which the diagnosis starts. `plain`: a Bouc-Wen model of a different finger.
    `commissioned`: the model that `softgrip identify --structure auto` identifies from another campaign of this
    finger without a hidden effect."""
    if world["given"] == "plain":
        return GIVEN
    logs, _ = make_logs(build, work / "healthy", world, "--campaign", "1")
    return work / "healthy/model/model.yaml" if identified(build, logs, work / "healthy/model", threads) else None


def held_out(build, logs, work, threads):
    """Identifies a model from the logs. Returns its held-out error divided by the noise, the description of its
    structure, and the duration of the identification. Returns {} if the program fails."""
    report = identified(build, logs, work / "identified", threads)
    if report is None:
        return {}
    chosen = next(c for c in report["structure"]["candidates"] if c["chosen"])
    return {"heldout_over_noise": chosen["heldout_rmse_mm"] / NOISE_MM, "structure": chosen["description"],
            "identify_s": report["wall_s"]}


def named_in(diagnosis, judged):
    """Returns the values that the ledger stores for a diagnosis and its judgement."""
    closed_loop = diagnosis.get("closed_loop") or {}
    return {"verdict": diagnosis["verdict"], "named": [c["id"] for c in diagnosis["causes"]],
            "rivals": diagnosis["alternatives"], "partial": [c["id"] for c in diagnosis["partial_causes"]],
            "base": diagnosis["base"], "feedforward": closed_loop.get("gains", {}).get("extended", {}).get("feedforward"),
            "heldout_rmse_mm": diagnosis["heldout_rmse_mm"], "wall_s": diagnosis["wall_s"], **judged}


def diagnosed(build, model, logs, work, world, threads):
    """Diagnoses the world. If the pressure is recorded, it is the input of the finger model and the output of the
    valve model."""
    drive = ("--drive", "measured") if world["columns"] == "pressure" else ()
    return judging.diagnose(build, model, logs, work / "out", "--threads", str(threads), *drive)


def run_world(build, folder, world, threads=1):
    """Simulates and diagnoses the world. Returns a copy of the world with the results added."""
    build = pathlib.Path(build).resolve()
    with tempfile.TemporaryDirectory(dir=folder) as name:
        work = pathlib.Path(name)
        logs, truth = make_logs(build, work, world, *hiding(world))
        model = given_model(build, work, world, threads)
        if model is None:
            return {**world, "outcome": "failed", "message": "no model could be identified from the healthy logs"}
        diagnosis, message = diagnosed(build, model, logs, work, world, threads)
        if diagnosis is None:
            return {**world, "outcome": "failed", "message": message}
        own = truth["own_physics_mm"]
        result = {**world, **named_in(diagnosis, judge(world["causes"], own, diagnosis)), "own": sorted(own),
                  "reachable": all(e["reachable"] for e in truth["effects"].values())}
        return result if world["causes"] else {**result, **held_out(build, logs, work, threads)}
