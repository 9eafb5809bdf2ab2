"""Runs `softgrip investigate` on a simulated world. The program plays experiments and a gauge check to separate the
causes that fit the logs."""
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

import judging

HERE = pathlib.Path(__file__).resolve().parent
# Sets of causes that neither a command nor a gauge check can separate. A valve lag and a sensor lag have the same
# effect on the readings if the pressure is not recorded.
INDISTINGUISHABLE = [{"valve_lag", "sensor_lag"}]


def sets_of(step):
    return [[cause, *rivals] for cause, rivals in zip(step["causes"], step["alternatives"])]


def outcome_of(hidden, step):
    return judging.judge(hidden, {"verdict": step["verdict"], "causes": [{"id": c} for c in step["causes"]],
                                  "alternatives": step["alternatives"]})


def investigate_world(build, folder, world, gauge=True):
    """Investigates a simulated world. In the result, `before` is the judgement (judging.judge) of the first verdict,
    and `outcome` is the judgement of the last verdict. If `before` is not ambiguous_right, `outcome` is
    not_ambiguous. If `outcome` is right, `resolved_by` is the last experiment, otherwise None."""
    build = pathlib.Path(build).resolve()
    with tempfile.TemporaryDirectory(dir=folder) as name:
        work = pathlib.Path(name)
        options = ["--seed", str(world["seed"]), "--strength", str(world["strength"]), "--cause",
                   ",".join(world["causes"]), *(["--poor"] if world["poor"] else [])]
        program = build / "tests/blind/blind-world"
        subprocess.run([program, *options, "--out", work / "logs", "--truth", work / "truth.json"], check=True)

        def command(script):
            return shlex.join([sys.executable, str(HERE / script), str(program), str(work / "played"), *options])

        done = subprocess.run([build / "tools/softgrip", "investigate", "--model", judging.GIVEN, "--data",
                               *sorted((work / "logs").glob("*.csv")), "--out", work / "out", "--rig-command",
                               command("rig.py"), *(["--gauge-command", command("gauge.py")] if gauge else []),
                               "--pressure-max-kpa", "60", "--yes", "--no-closed-loop", "--json"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 6):
            return {**world, "outcome": "failed", "message": done.stderr[-300:]}
        report = json.loads(done.stdout)
        steps = report["steps"]
        before = outcome_of(world["causes"], steps[0])
        result = {**world, "before": before, "rivals": sets_of(steps[0])}
        if before != "ambiguous_right":
            return {**result, "outcome": "not_ambiguous"}
        played = [step["experiment"]["waveform"] for step in steps if step["experiment"]]
        outcome = outcome_of(world["causes"], steps[-1])
        return {**result, "outcome": outcome, "end": report["end"], "verdict": report["verdict"], "played": played,
                "resolved_by": played[-1] if outcome == "right" else None, "minutes": report["spent_minutes"],
                "after": sets_of(steps[-1])}


def is_indistinguishable(result):
    """Returns True if sets of several causes remain and neither a command nor a gauge check can separate the causes of
    any of these sets."""
    left = [set(one) for one in result.get("after", []) if len(one) > 1]
    return bool(left) and all(any(one <= twins for twins in INDISTINGUISHABLE) for one in left)
