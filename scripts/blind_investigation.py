#!/usr/bin/python3
"""Lets `softgrip investigate` resolve what a poor log leaves ambiguous, on blind worlds (tests/blind) as the rig.

    scripts/blind_investigation.py --work DIR [--build build/release] [--seeds 5] [--strength 8] [--causes ID ...]
                                   [--first-seed 3000] [--page docs/reference/blind-investigation.md]

Every world first writes one log of triangles; where the diagnosis of it is ambiguous with the truth listed, the
investigation plays the experiments that it proposes on the same world. Resumable as the campaign is.
"""
import argparse
import collections
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/blind"))

import judging  # noqa: E402

# Equal for every command as long as nothing else changes: an object, a second sensor, a gauge.
INDISTINGUISHABLE = [{"stiffening", "sensor_nonlinearity"}, {"contact", "sensor_saturation"},
                     {"contact", "sensor_nonlinearity"}, {"valve_lag", "sensor_lag"}]


def investigate(args, world):
    build = args.build
    with tempfile.TemporaryDirectory(dir=args.work) as name:
        work = pathlib.Path(name)
        options = ["--seed", str(world["seed"]), "--strength", str(world["strength"]), "--poor", "--cause",
                   ",".join(world["causes"])]
        program = build / "tests/blind/blind-world"
        subprocess.run([program, *options, "--out", work / "logs", "--truth", work / "truth.json"], check=True)
        logs = sorted((work / "logs").glob("*.csv"))
        first = subprocess.run([build / "tools/softgrip", "diagnose", "--model", judging.GIVEN, "--data", *logs, "--out",
                                work / "first", "--no-closed-loop", "--json"], capture_output=True, text=True)
        if first.returncode != 0:
            return {**world, "outcome": "failed", "message": first.stderr[-300:]}
        diagnosis = json.loads(first.stdout)
        before = judging.judge(world["causes"], diagnosis)
        result = {**world, "before": before, "rivals": [[c["id"], *r] for c, r in zip(diagnosis["causes"],
                                                                                    diagnosis["alternatives"])]}
        if before != "ambiguous_right":
            return {**result, "outcome": "not_ambiguous"}
        rig = shlex.join([sys.executable, str(ROOT / "tests/blind/rig.py"), str(program), str(work / "played"), *options])
        done = subprocess.run([build / "tools/softgrip", "investigate", "--model", judging.GIVEN, "--data", *logs, "--out",
                               work / "out", "--rig-command", rig, "--pressure-max-kpa", "60", "--yes",
                               "--no-closed-loop", "--json"], capture_output=True, text=True)
        if done.returncode not in (0, 6):
            return {**result, "outcome": "failed", "message": done.stderr[-300:]}
        report = json.loads(done.stdout)
        last = report["steps"][-1]
        after = judging.judge(world["causes"], {"verdict": last["verdict"], "causes": [{"id": c} for c in last["causes"]],
                                                "alternatives": last["alternatives"]})
        return {**result, "outcome": after, "end": report["end"], "experiments": len(report["steps"]) - 1,
                "minutes": report["spent_minutes"], "after": [[c, *r] for c, r in zip(last["causes"],
                                                                                    last["alternatives"])]}


def is_twin(result):
    """Whether the sets that were left cannot be told apart by any command."""
    return all(any(set(one) <= twins for twins in INDISTINGUISHABLE) for one in result.get("after", [[]]) if len(one) > 1)


def page(results, command):
    asked = [r for r in results if r["outcome"] != "not_ambiguous"]
    resolved = [r for r in asked if r["outcome"] == "right"]
    twins = [r for r in asked if r["outcome"] == "ambiguous_right" and is_twin(r)]
    others = len(asked) - len(twins)
    lines = ["# Blind investigations", "",
             f"Written by `{command}`: {len(results)} worlds with one log of triangles each; {len(asked)} diagnoses were "
             f"ambiguous with the truth listed. After `softgrip investigate` {len(resolved)} of them name the truth alone. "
             f"In {len(twins)} the rivals left give equal readings whatever the command (a bent actuator and a bent scale, "
             f"a stop and a sensor that clips, lags of valve and sensor): the diagnosis says so and what to change instead. "
             f"Of the other {others}, {len(resolved)} are resolved"
             f" ({100 * len(resolved) / others if others else 0:.0f} %).", "",
             "| hidden | seed | ambiguous among | after | experiments | minutes of rig time | outcome |",
             "|---|---|---|---|---|---|---|"]
    for r in sorted(asked, key=lambda r: (r["causes"], r["seed"])):
        before = "; ".join(" or ".join(one) for one in r["rivals"])
        after = "; ".join(" or ".join(one) for one in r.get("after", []))
        lines.append(f"| {'+'.join(r['causes'])} | {r['seed']} | {before} | {after} | {r.get('experiments', '-')} | "
                     f"{r.get('minutes', 0):.1f} | {r['outcome']}{' (twins)' if r in twins else ''} |")
    counts = collections.Counter(r["before"] for r in results if "before" in r)
    lines += ["", "First diagnoses of all worlds: " + ", ".join(f"{k} {v}" for k, v in counts.most_common()) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--strength", type=float, default=8)
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--first-seed", type=int, default=3000)
    parser.add_argument("--page", type=pathlib.Path)
    args = parser.parse_args()
    args.build = args.build.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    path = args.work / "investigations.jsonl"
    results = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    known = {(tuple(r["causes"]), r["strength"], r["seed"]) for r in results}
    ids, _ = judging.library(args.build)
    with path.open("a") as out:
        for k in range(args.seeds):
            for cause in args.causes or ids:
                world = {"causes": [cause], "strength": args.strength, "seed": args.first_seed + k}
                if (tuple(world["causes"]), world["strength"], world["seed"]) in known:
                    continue
                result = investigate(args, world)
                results.append(result)
                out.write(json.dumps(result) + "\n")
                out.flush()
                print(f"{cause} seed {world['seed']}: {result.get('before')} {result.get('rivals')} -> "
                      f"{result['outcome']} {result.get('after', '')} {result.get('end', '')} {result.get('message', '')}",
                      flush=True)
    if args.page:
        args.page.write_text(page(results, f"scripts/blind_investigation.py --work DIR --seeds {args.seeds} "
                                           f"--first-seed {args.first_seed} --page {args.page}"))


if __name__ == "__main__":
    main()
