"""Runs a campaign of diagnoses of simulated worlds. The workflow in workflows/ simulates and diagnoses several worlds
in parallel. It runs the worlds that have no result yet. It stops when all worlds are done or the time limit is
reached. The module also returns the command that repeats a campaign, for the page of the campaign."""
import csv
import hashlib
import json
import pathlib
import subprocess
import sys
import time

WORKFLOW = pathlib.Path(__file__).resolve().parents[2] / "workflows/run.py"


def name_of(world):
    return "world-" + hashlib.sha256(json.dumps(world, sort_keys=True).encode()).hexdigest()[:16]


def write_table(path, worlds, judge):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("name", "task", "judge", "world"))
        writer.writerows((name_of(world), "world", judge, json.dumps(world)) for world in worlds)


def collect(ledger, worlds, out, planned, told):
    """Adds the results of the workflow to the ledger. Returns one text line for each world whose run failed."""
    wrong = []
    for world in worlds:
        row = out / "world" / name_of(world) / "row.json"
        if world in ledger or not row.exists():
            continue
        done = json.loads(row.read_text())
        if "world" not in done:
            wrong.append(f"{name_of(world)} {json.dumps(world)}: {done['error']}")
            continue
        ledger.add(done["world"])
        print(f"{len(ledger.rows)}/{planned} {told(world, done['world'])}", flush=True)
    return wrong


def run(ledger, planned, judge, args, told):
    """Runs all planned worlds that are not in the ledger, and adds the results of `judge`.run_world(build, folder,
    world) to the ledger. told(world, result) returns the line that is printed for a result. After args.most_minutes,
    starts no other world. If args.most_minutes is None, runs all worlds."""
    left = list({name_of(world): world for world in planned if world not in ledger}.values())
    if not left or args.most_minutes == 0:
        return
    worlds, out = args.work / "worlds.csv", args.work / "worlds"
    write_table(worlds, left, judge)
    until = [] if args.most_minutes is None else ["--until", str(time.time() + 60 * args.most_minutes)]
    try:
        subprocess.run([sys.executable, WORKFLOW, worlds, "--out", out, "--cores", str(args.workers), "--build", args.build,
                        "--progress", *until], check=False)
    finally:
        wrong = collect(ledger, left, out, len(planned), told)
    if wrong:
        sys.exit("\n".join(wrong))


def command(script, parser, args, options):
    """Returns the command line that repeats a campaign. The line contains each of the `options` whose value is not the
    default. It also contains the page, and `--work DIR` if the script has this option."""
    line = f"{script} --work DIR" if hasattr(args, "work") else script
    for option in options:
        value = getattr(args, option)
        if value != parser.get_default(option):
            words = [] if value is True else value if isinstance(value, list) else [value]
            line += f" --{option.replace('_', '-')} {' '.join(f'{w:g}' if isinstance(w, float) else str(w) for w in words)}".rstrip()
    return f"{line} --page {args.page}"
