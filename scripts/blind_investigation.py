#!/usr/bin/python3
"""Lets `softgrip investigate` resolve what is ambiguous, on blind worlds (tests/blind) as the rig.

    scripts/blind_investigation.py --work DIR [--build build/release] [--campaign DIR] [--seeds 5] [--strengths 8 2]
                                   [--causes ID ...] [--first-seed 3000] [--page docs/reference/blind-investigation.md]

The worlds are the ambiguous ones of a campaign (scripts/blind_campaign.py --work DIR) and fresh ones that first write
one log of triangles alone, where much is ambiguous. Where the diagnosis of the logs lists the truth among rivals, the
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
from ledger import Ledger  # noqa: E402

# Equal for every command as long as nothing else changes: an object, a second sensor, a gauge.
INDISTINGUISHABLE = [{"stiffening", "sensor_nonlinearity"}, {"contact", "sensor_saturation"},
                     {"contact", "sensor_nonlinearity"}, {"valve_lag", "sensor_lag"}]


def investigate(args, world):
    build = args.build
    with tempfile.TemporaryDirectory(dir=args.work) as name:
        work = pathlib.Path(name)
        options = ["--seed", str(world["seed"]), "--strength", str(world["strength"]), "--cause",
                   ",".join(world["causes"]), *(["--poor"] if world["poor"] else [])]
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


def worlds(args, ids):
    if args.campaign:
        for line in (args.campaign / "results.jsonl").read_text().splitlines():
            row = json.loads(line)
            if row["outcome"] == "ambiguous_right":
                yield {key: row[key] for key in ("causes", "strength", "seed")} | {"poor": False}
    for k in range(args.seeds):
        for strength in args.strengths:
            for cause in args.causes or ids:
                yield {"causes": [cause], "strength": strength, "seed": args.first_seed + k, "poor": True}


def page(results, command):
    asked = [r for r in results if r["outcome"] != "not_ambiguous"]
    resolved = [r for r in asked if r["outcome"] == "right"]
    twins = [r for r in asked if r["outcome"] == "ambiguous_right" and is_twin(r)]
    others = len(asked) - len(twins)
    lines = ["# Blind investigations", "",
             f"Written by `{command}`: {sum(not r['poor'] for r in results)} ambiguous worlds of the campaign and "
             f"{sum(r['poor'] for r in results)} worlds that wrote one log of triangles alone. {len(asked)} diagnoses were "
             f"ambiguous with the truth listed. After `softgrip investigate` {len(resolved)} of them name the truth alone. "
             f"In {len(twins)} the rivals that are left give equal readings whatever the command (a bent actuator and a "
             f"bent scale, a stop and a sensor that clips, lags of valve and sensor): the diagnosis says so, and what to "
             f"change instead. Of the other {others}, {len(resolved)} are resolved.", "",
             "| hidden | strength | seed | logs | ambiguous among | after | experiments | minutes of rig time | outcome |",
             "|---|---|---|---|---|---|---|---|---|"]
    for r in sorted(asked, key=lambda r: (r["poor"], r["causes"], -r["strength"], r["seed"])):
        before = "; ".join(" or ".join(one) for one in r["rivals"])
        after = "; ".join(" or ".join(one) for one in r.get("after", []))
        lines.append(f"| {'+'.join(r['causes'])} | {r['strength']:g} | {r['seed']} | {'triangles' if r['poor'] else 'three'} | "
                     f"{before} | {after} | {r.get('experiments', '-')} | {r.get('minutes', 0):.1f} | "
                     f"{r['outcome']}{' (twins)' if r in twins else ''} |")
    counts = collections.Counter(r["before"] for r in results if "before" in r)
    lines += ["", "First diagnoses: " + ", ".join(f"{k} {v}" for k, v in counts.most_common()) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--campaign", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--strengths", type=float, nargs="+", default=[8, 2])
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--first-seed", type=int, default=3000)
    parser.add_argument("--page", type=pathlib.Path)
    args = parser.parse_args()
    args.build = args.build.resolve()
    ledger = Ledger(args.work / "investigations.jsonl", ("causes", "strength", "seed", "poor"))
    ids, _ = judging.library(args.build)
    for world in worlds(args, ids):
        if world in ledger:
            continue
        result = investigate(args, world)
        ledger.add(result)
        print(f"{'+'.join(world['causes'])} {world['strength']:g} seed {world['seed']}: {result.get('before')} "
              f"{result.get('rivals')} -> {result['outcome']} {result.get('after', '')} {result.get('end', '')} "
              f"{result.get('message', '')}", flush=True)
    if args.page:
        campaign = " --campaign DIR" if args.campaign else ""
        args.page.write_text(page(ledger.rows, f"scripts/blind_investigation.py --work DIR{campaign} --seeds {args.seeds} "
                                           f"--first-seed {args.first_seed} --page {args.page}"))


if __name__ == "__main__":
    main()
