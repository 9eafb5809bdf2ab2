"""Identifies many logs with the workflow of softgrip, on Slurm or on this machine: logs_on_slurm.py OUT LOG... [--local]

The workflow is workflows/run.py in the source of softgrip (WORKFLOW). After an interruption, the workflow continues
with the unfinished logs. This script writes the table of the workflow and collects the results.
"""

import csv
import json
import os
import pathlib
import subprocess
import sys

import softgrip

WORKFLOW = pathlib.Path(os.environ.get("WORKFLOW", pathlib.Path(__file__).resolve().parents[2] / "workflows/run.py"))


def main(out: str, logs: list[str], local: bool) -> int:
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "logs.csv"
    names = [f"{number:04}-{pathlib.Path(log).stem}" for number, log in enumerate(logs)]
    with table.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["name", "task", "data", "options"])
        for name, log in zip(names, logs):
            rows.writerow([name, "identify", pathlib.Path(log).resolve(), "--starts 5"])

    where = ["--cores", str(os.cpu_count())] if local else ["--slurm", "--batch", "20"]
    code = subprocess.run([sys.executable, WORKFLOW, table, "--out", folder, *where]).returncode
    if code not in (0, 6):  # exit code 6: some rows of the table failed
        return code
    for name in names:
        row = json.loads((folder / "identify" / name / "row.json").read_text())
        if row["status"] == "failed":
            print(f"{name}: {row['error'].splitlines()[0]}")
            continue
        model = softgrip.Model.load(folder / "identify" / name / "result/model.yaml")
        print(f"{name}: RMSE {row['found']}, {len(model.parameters)} parameters")
    return code


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if word != "--local"]
    sys.exit(main(words[0], words[1:], "--local" in sys.argv))
