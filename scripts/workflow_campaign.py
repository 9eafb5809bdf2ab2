#!/usr/bin/python3
"""Measures the workflow with many small logs. Runs it on the local cores, on a local Slurm, after a kill, and as a
plain loop.

    scripts/workflow_campaign.py --work DIR [--rows 1000] [--cores 2] [--batch 25] [--page docs/results/workflow-campaign.md]

Each row runs `softgrip identify` for a simulated log of 25 s at 20 Hz. Each log comes from a different finger. Slurm
needs root.
"""
import csv
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import results_page

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUN = ROOT / "workflows/run.py"
SAMPLES = 500


def make(args, program):
    """Writes the logs and the table of the workflow."""
    args.work.mkdir(parents=True, exist_ok=True)
    twin = (ROOT / "config/models/bench_twin.yaml").read_text()
    rng = random.Random(1)
    with (args.work / "rows.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("name", "task", "data"))
        for i in range(args.rows):
            name = f"finger{i + 1:04d}"
            alpha = 0.21105 * rng.uniform(0.8, 1.2)
            model = args.work / "finger.yaml"
            model.write_text(twin.replace("alpha_mm_per_kpa: 0.21105", f"alpha_mm_per_kpa: {alpha:.5f}"))
            log = args.work / f"{name}.csv"
            subprocess.run([program, "simulate", "--model", model, "--input", "tp1", "--rate-hz", "20", "--noise-mm", "0.04",
                            "--seed", str(i + 1), "--out", log], check=True, capture_output=True)
            log.write_text("\n".join(log.read_text().splitlines()[:SAMPLES + 1]) + "\n")
            table.writerow((name, "identify", log.name))


def plain_loop(args, program, out):
    shutil.rmtree(out, ignore_errors=True)
    began = time.monotonic()
    for i in range(args.rows):
        name = f"finger{i + 1:04d}"
        subprocess.run([program, "identify", "--data", args.work / f"{name}.csv", "--threads", "1", "--out", out / name],
                       capture_output=True, check=False)
    return time.monotonic() - began


def command(args, out, *more):
    return [sys.executable, RUN, args.work / "rows.csv", "--out", out, "--cores", str(args.cores), "--build", args.build, *more]


def workflow(words):
    began = time.monotonic()
    subprocess.run([str(word) for word in words], check=False, stdout=subprocess.DEVNULL)
    return time.monotonic() - began


def rows_of(out):
    return {path.parent.name: path.stat().st_mtime_ns for path in out.glob("identify/*/row.json")}


def killed(args, out):
    """Kills a run when half of its rows are done, and continues the run. Returns the time until the kill, the
    duration of the continuation, and the number of rows that ran twice."""
    shutil.rmtree(out, ignore_errors=True)
    began = time.monotonic()
    child = subprocess.Popen([str(word) for word in command(args, out)], start_new_session=True, stdout=subprocess.DEVNULL)
    while len(rows_of(out)) < args.rows // 2 and child.poll() is None:
        time.sleep(0.05)
    os.killpg(child.pid, signal.SIGKILL)
    child.wait()
    first_s, before = time.monotonic() - began, rows_of(out)
    second_s = workflow(command(args, out))
    after = rows_of(out)
    return first_s, second_s, len(before), sum(after[name] != when for name, when in before.items())


def models(folders):
    """Returns a hash over the models of all rows, and the number of models."""
    digest, count = hashlib.sha256(), 0
    for number, folder in enumerate(folders):
        model = folder / "model.yaml"
        if model.exists():
            digest.update(f"{number} ".encode() + model.read_bytes())
            count += 1
    return digest.hexdigest()[:16], count


def page(args, figures):
    rows, seconds = args.rows, [way[1] for way in figures["ways"]]
    same = len({way[2] for way in figures["ways"]}) == 1
    first_s, second_s, done, twice = figures["killed"]
    lines = [*results_page.head(
                 "The workflow compared with a plain loop",
                 f"For {rows} short rows (fits of a model to one log each), the workflow takes {seconds[1] / seconds[0]:.1f} times as long as a "
                 f"plain loop. After a kill, the restarted workflow repeats {twice} of the {done} completed rows.", results_page.version_of(args.build),
                 f"scripts/workflow_campaign.py --work DIR --rows {rows} --cores {args.cores} --batch {args.batch} --page {args.page}",
                 f"{os.cpu_count()} processors, which other programs also used"),
             "The column *load* contains the 1-minute load of the machine. Each row of the workflow runs `softgrip identify --threads 1` for a different simulated finger, with a log of 25 s at 20 Hz. The overhead of the workflow per row does not depend on the duration of the row. Short rows are therefore the worst case for the comparison with a plain loop.", "",
             "| method | wall time | wall time per row | load | number of models, hash over all models |", "|---|---|---|---|---|"]
    for name, seconds, (digest, count), load in figures["ways"]:
        lines.append(f"| {name} | {seconds:.0f} s | {seconds / rows:.2f} s | {load:.1f} | {count}, `{digest}` |")
    whole_s = figures["whole_s"]
    lines += ["", f"The models of all methods are {'identical, byte by byte' if same else 'NOT identical'}.", "",
              f"The workflow was killed with SIGKILL after {first_s:.0f} s, when {done} of {rows} rows were complete, and was then restarted. "
              f"The restarted workflow took {second_s:.0f} s, so the workflow before and after the kill took {first_s + second_s:.0f} s in total. A workflow without "
              f"a kill, which ran directly before, took {whole_s:.0f} s. The restarted workflow repeated {twice} of the completed rows."]
    return "\n".join(lines) + "\n"


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--rows", type=int, default=1000)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--batch", type=int, default=25)
    args = parser.parse_args()
    args.work = args.work.resolve()
    program = args.build / "tools/softgrip"
    figures = {"ways": []}
    make(args, program)
    names = [f"finger{i + 1:04d}" for i in range(args.rows)]

    def told(name, seconds, folders):
        figures["ways"].append((name, seconds, models(folders), os.getloadavg()[0]))
        print(name, f"{seconds:.1f} s", figures["ways"][-1][2], flush=True)

    loop = args.work / "loop"
    told("a plain loop that runs one row after another", plain_loop(args, program, loop), [loop / name for name in names])
    for name, out, words in (
            (f"the workflow, `--cores {args.cores}`", args.work / "cores", []),
            (f"the workflow with a Slurm server on this machine, {args.batch} rows per job", args.work / "slurm",
             ["--slurm", "--batch", str(args.batch)])):
        shutil.rmtree(out, ignore_errors=True)
        begin = ["bash", ROOT / "scripts/slurm_here.sh", args.work / "slurm_state"] if words else []
        told(name, workflow([*begin, *command(args, out, *words)]), [out / "identify" / n / "result" for n in names])
    out = args.work / "killed"
    shutil.rmtree(out, ignore_errors=True)
    figures["whole_s"] = workflow(command(args, out))
    figures["killed"] = killed(args, out)
    print("killed", figures["killed"], models([out / "identify" / n / "result" for n in names]), flush=True)
    (args.work / "figures.json").write_text(json.dumps(figures) + "\n")
    if args.page:
        args.page.write_text(page(args, figures))


if __name__ == "__main__":
    main()
