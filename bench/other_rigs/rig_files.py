"""Writes the logs of the simulated rigs, and for each rig the table foreign.yaml that bench/foreign.py reads."""
import csv

import rig_runs
from rigs_bending import RIGS as BENDING
from rigs_cylinders import RIGS as CYLINDERS
from rigs_muscles import RIGS as MUSCLES
from rigs_stages import RIGS as STAGES

RIGS = {rig.name: rig for rig in (*BENDING, *MUSCLES, *CYLINDERS, *STAGES)}
QUANTITIES = {"time": "time_s", "command": "pressure_command_kpa", "pressure": "pressure_kpa",
              "displacement": "displacement_mm"}
LABELS = ("rig", "log", "cause", "also", "text", "spread_percent", "ratio")


def log_text(columns):
    names = [name for name in rig_runs.COLUMNS if name in columns]
    rows = (",".join(f"{value:.7g}" for value in row) for row in zip(*(columns[name] for name in names)))
    return "\n".join([",".join(names), *rows, ""])


def table_text(rig):
    """Returns the table of a rig. All healthy runs are the baseline of all pairs."""
    columns = ", ".join(f"{quantity}: {name}" for quantity, name in QUANTITIES.items()
                        if quantity != "pressure" or rig.pressure_noise_kpa)
    baseline = ", ".join(f"healthy{number + 1}" for number in range(rig_runs.HEALTHY))
    lines = [f'title: "{rig.title} (simulation)"', "about: simulated by bench/other_rigs.py, not measured",
             f"same: {{{columns}}}", "logs:", '- {file: "*.csv"}', "repeats:"]
    for name, _, _, change in rig_runs.runs_of(rig):
        if name.startswith(("same", "other")):
            lines.append(f"- {{baseline: [{baseline}], later: {name}, group: {name.rstrip('0123456789')}, "
                         "because: simulated without a change}")
    lines.append("changes:")
    for name, _, _, change in rig_runs.runs_of(rig):
        if change:
            lines.append(f"- {{baseline: [{baseline}], later: {name}, label: \"{change.text}\", because: simulated, "
                         f"causes: [{', '.join((change.cause, *change.also))}]}}")
    return "\n".join([*lines, "identification: []", ""])


def write_rig(rig, out, length_s=None):
    """Writes the logs and the table of a rig to the folder out/NAME, and returns the rows of the labels."""
    folder = out / rig.name
    folder.mkdir(parents=True, exist_ok=True)
    spread, ratios = rig_runs.ratios(rig, length_s=length_s)
    rows = []
    for name, number, family, change in rig_runs.runs_of(rig):
        columns = rig_runs.run_columns(rig, number, family, change, length_s)
        (folder / f"{name}.csv").write_text(log_text(columns))
        known = (change.cause, " ".join(change.also), change.text) if change else ("", "", "unchanged")
        rows.append((rig.name, name, *known, f"{100 * spread:.3g}", f"{ratios[change.cause]:.3g}" if change else ""))
    (folder / "foreign.yaml").write_text(table_text(rig))
    return rows


def write_labels(path, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(LABELS)
        writer.writerows(rows)
