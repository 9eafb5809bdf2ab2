#!/usr/bin/python3
"""Hides effects in worlds (tests/blind), lets `softgrip diagnose` find them, counts.

    scripts/blind_campaign.py --build build/release --work DIR [--seeds 20] [--strengths 8 2] [--causes ID ...]
                              [--clean 200] [--first-seed 1000] [--page docs/reference/blind-campaign.md]

Resumable: every world's outcome is one line of DIR/results.jsonl, and worlds that stand there are not run again.
The engine is called as a user calls it; it never sees the truth.
"""
import argparse
import collections
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def outcome(truth, diagnosis):
    """right, ambiguous_right, wrong, missed, false_alarm, quiet"""
    verdict = diagnosis["verdict"]
    named = [cause["id"] for cause in diagnosis["causes"]]
    if not truth:
        return "quiet" if not named and verdict in ("adequate", "recalibrate") else (
            "false_alarm" if named else "unexplained")
    if not named:
        return "missed"
    sets = [{cause, *rivals} for cause, rivals in zip(named, diagnosis["alternatives"])]
    if set(named) == set(truth) and verdict == "cause_found":
        return "right"
    if len(sets) == len(truth) and all(any(t in s for s in sets) for t in truth):
        return "ambiguous_right" if verdict == "ambiguous" else "wrong"
    return "wrong"


def run_world(args, world):
    folder = pathlib.Path(tempfile.mkdtemp(dir=args.work))
    try:
        make = [args.build / "tests/blind/blind-world", "--seed", str(world["seed"]), "--strength",
                str(world["strength"]), "--out", folder / "logs", "--truth", folder / "truth.json"]
        if world["causes"]:
            make += ["--cause", ",".join(world["causes"])]
        subprocess.run(make, check=True)
        logs = sorted((folder / "logs").glob("*.csv"))
        done = subprocess.run([args.build / "tools/softgrip", "diagnose", "--model", ROOT / "tests/blind/given.yaml",
                               "--data", *logs, "--out", folder / "out", "--json"], capture_output=True, text=True)
        if done.returncode != 0:
            return {**world, "outcome": "failed", "message": done.stderr[-300:]}
        diagnosis = json.loads(done.stdout)
        truth = json.loads((folder / "truth.json").read_text())
        library = [c for c in world["causes"] if not c.startswith("outside_")]
        result = outcome(library, diagnosis)
        if world["causes"] and not library:
            result = {"false_alarm": "wrong", "quiet": "missed"}.get(outcome([], diagnosis), "unexplained")
        return {**world, "outcome": result, "verdict": diagnosis["verdict"],
                "named": [c["id"] for c in diagnosis["causes"]], "rivals": diagnosis["alternatives"],
                "unexplained_percent": diagnosis["unexplained_percent"], "wall_s": diagnosis["wall_s"],
                "reachable": all(e["reachable"] for e in truth["effects"].values())}
    finally:
        shutil.rmtree(folder)


def worlds(args):
    listed = subprocess.run([args.build / "tests/blind/blind-world", "--list"], check=True, capture_output=True,
                            text=True).stdout.split()
    seed = args.first_seed
    for _ in range(args.clean):
        seed += 1
        yield {"causes": [], "strength": 0, "seed": seed}
    for cause in args.causes or listed:
        for strength in args.strengths:
            for k in range(args.seeds):
                yield {"causes": [cause], "strength": strength, "seed": args.first_seed + 1000 + k}


def page(results, command):
    lines = ["# Blind campaign", "", f"Written by `{command}`; {len(results)} worlds. A world is right when its cause is "
             "named alone, ambiguous when the verdict lists it among rivals, missed when nothing is named (the verdict "
             "is then recalibrate or unexplained), wrong when something else is named.", "",
             "| hidden | strength | worlds | right | ambiguous | missed | wrong | named instead |",
             "|---|---|---|---|---|---|---|---|"]
    groups = collections.defaultdict(list)
    for r in results:
        groups[("+".join(r["causes"]) or "nothing", r["strength"])].append(r)
    for (cause, strength), rows in sorted(groups.items()):
        count = collections.Counter(r["outcome"] for r in rows)
        instead = collections.Counter("+".join(r.get("named", [])) for r in rows
                                      if r["outcome"] in ("wrong", "false_alarm"))
        right = count["right"] + count["quiet"] + (count["unexplained"] if cause.startswith("outside_") else 0)
        missed = count["missed"] + count["failed"] + (0 if cause.startswith("outside_") else count["unexplained"])
        lines.append(f"| {cause} | {strength:g} | {len(rows)} | {right} | {count['ambiguous_right']} | {missed} | "
                     f"{count['wrong'] + count['false_alarm']} | "
                     f"{', '.join(f'{n} x{k}' for n, k in instead.items())} |")
    lines += ["", "For worlds with an effect outside the library (`outside_`), right is the verdict unexplained."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--clean", type=int, default=200)
    parser.add_argument("--strengths", type=float, nargs="+", default=[8, 2])
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--page", type=pathlib.Path)
    args = parser.parse_args()
    args.build = args.build.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    path = args.work / "results.jsonl"
    results = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    known = {(tuple(r["causes"]), r["strength"], r["seed"]) for r in results}
    planned = list(worlds(args))
    with path.open("a") as out:
        for number, world in enumerate(planned, 1):
            if (tuple(world["causes"]), world["strength"], world["seed"]) in known:
                continue
            result = run_world(args, world)
            results.append(result)
            out.write(json.dumps(result) + "\n")
            out.flush()
            print(f"{number}/{len(planned)} {'+'.join(world['causes']) or 'clean'} {world['strength']:g} "
                  f"seed {world['seed']}: {result['outcome']} {result.get('named', '')}", flush=True)
    if args.page:
        words = [word for word in sys.argv[1:]]
        args.page.write_text(page(results, "scripts/blind_campaign.py " + " ".join(words)))


if __name__ == "__main__":
    main()
