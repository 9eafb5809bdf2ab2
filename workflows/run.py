#!/usr/bin/python3
"""Runs the tasks in a table on the cores of this machine or on Slurm, and shows all results on one page.

    workflows/run.py TABLE --out DIR [--cores 2] [--slurm [--jobs 64] [--batch 20]] [--again]

workflows/table.py describes the table. The same command continues an interrupted run. A finished row is run a second
time only if its line or a file that it reads has changed. With --again, rows that have failed are also run a second
time. The results are DIR/overview.html, DIR/overview.json, and for each row DIR/TASK/NAME/ with row.json and result/.
Exit codes: 0 all rows done, 1 the workflow was stopped, 2 usage, 3 the table is refused, 4 a program is missing, 5
another run uses DIR, 6 some rows failed or have results that are not acceptable.
"""
import argparse
import fcntl
import json
import pathlib
import shutil
import subprocess
import sys

import table

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--cores", type=int, default=1, help="rows side by side on this machine")
    parser.add_argument("--slurm", action="store_true", help="hand the rows to Slurm instead")
    parser.add_argument("--jobs", type=int, default=64, help="with --slurm: in its queue at once")
    parser.add_argument("--batch", type=int, default=20, help="with --slurm: rows per job")
    parser.add_argument("--threads", type=int, default=1, help="of one row")
    parser.add_argument("--most-minutes", type=float, default=60, help="of one row; it has failed then")
    parser.add_argument("--until", type=float, default=0, help="no row is begun after this time (seconds of Unix)")
    parser.add_argument("--again", action="store_true", help="run failed rows again")
    parser.add_argument("--progress", action="store_true", help="say how far it is")
    parser.add_argument("--program", help="[build/release/tools/softgrip beside this folder, or the installed one]")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="of the blind worlds")
    return parser.parse_args()


def program_of(args):
    """Returns the absolute path of softgrip, because each row runs in the folder of the table; None if softgrip does not
    exist. With --slurm, a name without a folder is returned unchanged, because the machines of the cluster search for it."""
    built = args.build.resolve() / "tools/softgrip"
    program = args.program or (str(built) if built.exists() else "softgrip")
    if args.slurm and "/" not in program:
        return program
    found = shutil.which(program)
    return found and str(pathlib.Path(found).resolve())


def snakemake(args, program, *more):
    words = ["snakemake", "--snakefile", HERE / "Snakefile", "--directory", args.out.resolve(), "--quiet",
             "rules" if args.progress else "all", "--rerun-incomplete", "--rerun-triggers", "mtime", "params", "input",
             "--nolock"]
    if args.slurm:
        words += ["--profile", HERE / "slurm", "--jobs", args.jobs, "--group-components", f"rows={args.batch}",
                  "--cores", args.threads]
    else:
        words += ["--cores", args.cores]
    config = {"table": args.table.resolve(), "program": program, "build": args.build.resolve(),
              "threads": args.threads, "most_minutes": args.most_minutes, "until": f"{args.until:.0f}"}
    words += [*more, "--config", *(f"{key}={value}" for key, value in config.items())]
    return subprocess.run([str(word) for word in words], stdin=subprocess.DEVNULL, check=False).returncode


def failed_rows(args, rows):
    for row in rows:
        told = args.out / row.result()
        if told.exists() and json.loads(told.read_text())["status"] == "failed":
            yield told


def main():
    args = arguments()
    try:
        rows = table.read(args.table)
    except table.Refused as refused:
        print(refused, file=sys.stderr)
        return 3
    except OSError as error:
        print(f"{args.table}: {error.strerror}", file=sys.stderr)
        return 4
    if not shutil.which("snakemake"):
        print("snakemake is missing: apt install snakemake (scripts/packages.sh workflows)", file=sys.stderr)
        return 4
    program = program_of(args)
    if not program and any(row.task != "world" for row in rows):
        print(f"{args.program or 'softgrip'}: no such program; --program states its path", file=sys.stderr)
        return 4
    args.out.mkdir(parents=True, exist_ok=True)
    # When Snakemake is killed, its own lock file remains. The kernel releases this lock when the process
    # ends.
    with (args.out / ".in_use").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            print(f"{args.out} is in use by another run", file=sys.stderr)
            return 5
        if args.again:
            for told in failed_rows(args, rows):
                told.unlink()
        if snakemake(args, program or "softgrip") != 0:
            print(f"stopped; the same command goes on: {sum((args.out / r.result()).exists() for r in rows)} of "
                  f"{len(rows)} rows are there", file=sys.stderr)
            return 1
    counts = json.loads((args.out / "overview.json").read_text())["counts"]
    print(", ".join(f"{count} {status}" for status, count in counts.items()) + f": {args.out / 'overview.html'}")
    return 0 if counts["done"] == len(rows) else 6


if __name__ == "__main__":
    sys.exit(main())
