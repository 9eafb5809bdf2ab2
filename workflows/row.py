"""Runs the command of one row of a table and writes the result to row.json.

    row.py TABLE NAME --program softgrip [--threads 1] [--most-minutes 60] [--build BUILD] [--until UNIX_TIME]

workflows/Snakefile calls this program in the output folder. Whatever the command does, the exit code is 0.
TASK/NAME/row.json is written at the end in one step. So a row that was killed has no row.json, and the next call runs
it from its beginning. After the time --until, no row is started, and the exit code is 75.
"""
import argparse
import importlib
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import table

TESTS = pathlib.Path(__file__).resolve().parent.parent / "tests/blind"
LONGEST_ERROR = 1000
NOT_BEGUN = 75


def command_of(row, program, out, threads):
    words = [program, row.task]
    if row.task == "health":
        words += map(str, row.logs())
    elif row.get("data"):
        words += ["--data", *map(str, row.logs())]
    if row.get("rig"):
        words += ["--rig", str(row.path("rig"))]
    if row.get("model"):
        words += ["--start" if row.task == "identify" else "--model", str(row.path("model"))]
    other = row.other_baseline()
    if other:
        words += ["--baseline", str(pathlib.Path(row.result(other)).parent.resolve() / "result")]
    elif row.get("baseline"):
        words += ["--baseline", str(row.path("baseline"))]
    words += ["--out", str(out)]
    if row.task != "health":
        words += ["--threads", str(threads)]
    return words + shlex.split(row.get("options"))


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return {}


def found_in(task, out):
    """Returns a short text about a result, for the page."""
    if task == "identify":
        told = read_json(out / "identify.json")
        unit = told.get("output_unit", "mm")
        return ", ".join(f"{value:.3g} {unit}" for value in told.get("rmse_mm", {}).values() if isinstance(value, float))
    if task == "diagnose":
        told = read_json(out / "diagnosis.json")
        return ": ".join([told.get("verdict", ""), ", ".join(cause["id"] for cause in told.get("causes", []))]).strip(": ")
    if task == "baseline":
        told = read_json(out / "baseline.json")
        return (told.get("check") or {"verdict": "no second run"}).get("verdict", "")
    fingers = read_json(out / "health.json").get("fingers", [])
    return ", ".join(f"{finger.get('finger') or 'the finger'}: {finger.get('state')}" for finger in fingers)


def run_command(row, args, out):
    words = command_of(row, args.program, out, args.threads)
    try:
        done = subprocess.run(words, cwd=row.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              errors="replace", timeout=60 * args.most_minutes)
    except subprocess.TimeoutExpired:
        return {"status": "failed", "error": f"took longer than {args.most_minutes:g} minutes", "command": words}
    except OSError as error:
        return {"status": "failed", "error": f"{args.program}: {error.strerror}", "command": words}
    status = {0: "done", 6: "not_acceptable"}.get(done.returncode, "failed")
    told = {"status": status, "exit_code": done.returncode, "found": found_in(row.task, out), "command": words}
    if status == "failed":
        told["error"] = done.stderr.strip()[-LONGEST_ERROR:] or f"exit code {done.returncode}"
    return told


def run_world(row, args, out):
    sys.path[:0] = [str(TESTS), str(TESTS / "textbook")]
    out.mkdir()
    world = json.loads(row.get("world"))
    try:
        judged = importlib.import_module(row.get("judge")).run_world(pathlib.Path(args.build), out, world)
    except Exception as error:  # an error in one world must not affect the other rows
        return {"status": "failed", "error": f"{type(error).__name__}: {error}"[-LONGEST_ERROR:]}
    return {"status": "done", "found": str(judged.get("outcome")), "world": judged}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("name")
    parser.add_argument("--program", default="softgrip")
    parser.add_argument("--build", default=".")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--most-minutes", type=float, default=60)
    parser.add_argument("--until", type=float, default=0)
    args = parser.parse_args()
    if args.until and time.time() > args.until:
        return NOT_BEGUN
    row = next(row for row in table.read(args.table) if row.name == args.name)
    place = pathlib.Path(row.result()).parent.resolve()
    place.mkdir(parents=True, exist_ok=True)
    for left in place.glob("running-*"):  # these folders are left from rows that were killed
        shutil.rmtree(left, ignore_errors=True)
    running = pathlib.Path(tempfile.mkdtemp(prefix="running-", dir=place))
    began = time.monotonic()
    told = (run_world if row.task == "world" else run_command)(row, args, running / "result")
    told = {"name": row.name, "task": row.task, **told, "seconds": round(time.monotonic() - began, 3)}
    shutil.rmtree(place / "result", ignore_errors=True)
    if (running / "result").exists():
        (running / "result").rename(place / "result")
        if "command" in told:
            told["command"] = [word.replace(str(running), str(place)) for word in told["command"]]
    pages = sorted((place / "result").glob("*.html"), key=lambda page: page.name != "report.html")
    told["reports"] = [f"result/{page.name}" for page in pages]
    (running / "row.json").write_text(json.dumps(told, indent=1) + "\n")
    os.replace(running / "row.json", place / "row.json")
    shutil.rmtree(running, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
