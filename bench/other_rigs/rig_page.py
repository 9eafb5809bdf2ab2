"""Writes the tables of bench/other_rigs.py: on the screen, and as a page of docs/results."""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import results_page
from results_page import interval

from foreign_page import names_of, number, of, table

import rig_files
import rig_judge
import rig_runs

LABEL_TEXT = ("The authors corrected some labels after they had seen the first answers. A narrow valve also admits `blocked_line`, "
              "and friction without a measured pressure also admits `valve_deadband`. Payloads that shifted only the zero of "
              "the readings were replaced or changed.")
TITLE = "Seventeen simulated rigs of other kinds"


def by_healthy(values):
    return {healthy: [case for case in values["cases"] if case["healthy"] == healthy] for healthy in values["healthy"]}


def summary_table(values):
    """Returns one row per criterion, and one column per number of healthy runs."""
    columns = {healthy: rig_judge.counts(cases) for healthy, cases in by_healthy(values).items() if cases}
    rows = [[row[0], *(f"{of(row_of[k][1], row_of[k][2])}: {interval(row_of[k][1], row_of[k][2])}"
                       for row_of in columns.values())] for k, row in enumerate(next(iter(columns.values()), []))]
    return table(["criterion", *(f"{healthy} healthy run{'s' if healthy > 1 else ''}" for healthy in columns)], rows)


def cause_table(values):
    """Returns, per labelled cause, the outcomes of the changes."""
    changes = [case for case in values["cases"] if case["group"] == rig_judge.CHANGES]
    outcomes = [name for name in rig_judge.OUTCOMES if any(case["outcome"] == name for case in changes)]
    rows = [[f"`{cause}`", *(sum(case["cause"] == cause and case["outcome"] == name for case in changes)
                             for name in outcomes)] for cause in sorted({case["cause"] for case in changes})]
    return table(["cause", *outcomes], rows)


def case_row(case):
    label = f"{case['cause']}: {case['text']}" if case["cause"] else "unchanged"
    return [case["rig"], case["log"], label, number(case["ratio"]), case["verdict"], names_of(case), case["outcome"]]


CASE_HEAD = ["rig", "run", "label", "ratio", "verdict", "named causes, `or` their alternatives (size)", "outcome"]


def case_tables(values):
    for healthy, cases in by_healthy(values).items():
        if cases:
            yield "\n".join([f"## Cases with {healthy} healthy run{'s' if healthy > 1 else ''}", "",
                             *table(CASE_HEAD, [case_row(case) for case in cases])])


def rigs_table(values):
    spreads = {case["rig"]: case["spread_percent"] for case in values["rigs"]}
    rows = [[rig.name, rig.title, f"{1000 * rig.step_s:g} ms", f"{rig.length_s:g} s", f"{rig.span_mm:g} mm",
             f"{rig.noise_mm:g} mm, {rig.resolution_mm:g} mm", "yes" if rig.pressure_noise_kpa else "no",
             rig.family.__name__.replace("_", " "), rig.other.__name__.replace("_", " "), f"{spreads[rig.name]:.3g} %"]
            for rig in rig_files.RIGS.values() if rig.name in spreads]
    return table(["rig", "simulation", "interval", "length", "span", "noise, resolution", "measured pressure",
                  "kind of input", "other kind of input", "difference between runs"], rows)


def percent(value):
    return f"{100 * value:g} %"


def variation_text():
    return ("Each run begins after a random motion, with an unsettled state. Runs of a rig have different input signals, "
            "different noise and different conditions. The standard deviations of the conditions are: "
            f"gain {percent(rig_runs.GAIN)}, offset {percent(rig_runs.OFFSET_SHARE)} of the span, "
            f"temperature {rig_runs.TEMPERATURE_K:g} K (stiffness {percent(rig_runs.STIFFNESS_PER_K)} per K, "
            f"friction {percent(rig_runs.FRICTION_PER_K)} per K), supply {percent(rig_runs.SUPPLY)}, "
            f"offset of the pressure sensor {percent(rig_runs.PRESSURE_OFFSET_SHARE)} of the range, "
            f"jitter of the sampling {percent(rig_runs.JITTER)} of the interval.")


def meaning_of(healthy, cases):
    rows = {sentence: of(count, total) for sentence, count, total in rig_judge.counts(cases)}
    repeats = [case for case in cases if case["group"] in rig_judge.REPEATS and case["outcome"] != "failed"]
    changed = sum(case["outcome"] == "false alarm" for case in repeats)
    return (f"With {healthy} healthy run{'s' if healthy > 1 else ''} of each simulated rig, {of(changed, len(repeats))} repeats "
            f"without a change are reported as changed. {rows['changes: detected']} labelled changes are detected. The "
            f"correct cause is named or listed for {rows['changes: correct cause named or listed']} changes. Only wrong causes are "
            f"named for {rows['changes: only wrong causes named']} changes.")


def meaning(values):
    """Returns the sentences for each number of healthy runs."""
    return " ".join(meaning_of(healthy, cases) for healthy, cases in by_healthy(values).items() if cases)


def number_of_cases(values):
    """Returns the number of judged cases. If a run was interrupted, it also returns the number of all cases."""
    judged = len(values["cases"])
    planned = len(values["healthy"]) * sum(len(list(rig_runs.runs_of(rig_files.RIGS[case["rig"]]))) - rig_runs.HEALTHY
                                           for case in values["rigs"])
    return f"{judged} cases" if judged == planned else f"{judged} of {planned} cases (the run was interrupted)"


def write(path, values, command):
    rigs = len(values["rigs"])
    head = results_page.head(TITLE, meaning(values), values["version"], command,
                             f"{rigs} rigs, {number_of_cases(values)}, 1 thread per call", values["began"][:10])
    outcomes = [[name, text] for name, text in rig_judge.OUTCOMES.items()
                if any(case["outcome"] == name for case in values["cases"])]
    sections = [
        "\n".join([*head, "The rigs are simulations with equations that softgrip does not use. The logs are not measurements. "
                   "[How to repeat the measurements](../how-to/measure.md#simulated-rigs-of-other-kinds)."]),
        "\n".join(["## Summary", "", "Each cell contains a count, a share and its 95 % interval (Wilson). The cases of one rig "
                   "use the same healthy runs, so they are not independent.", "", *summary_table(values)]),
        "\n".join(["## Outcomes by cause", "", "The table contains the changes for all numbers of healthy runs.", "",
                   *cause_table(values)]),
        "\n".join(["## Outcomes", "", *table(["outcome", "meaning"], outcomes)]),
        "\n".join(["## Rigs", "", variation_text(), "", "The column *difference between runs* contains the RMS difference of 2 "
                   "healthy runs with the same input and without noise, as a share of the span. The mean difference is "
                   "subtracted, because a different zero of the sensor is no change. In the tables of the cases, "
                   "*ratio* is the RMS effect of the change divided by this difference. If the ratio of the measured pressure "
                   "is larger, *ratio* is the ratio of the measured pressure.", "", *rigs_table(values), "", LABEL_TEXT]),
        *case_tables(values)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n\n".join(sections) + "\n")


def screen_lines(values):
    """Returns the lines of the cases and of the summary for the screen."""
    for case in values["cases"]:
        yield " | ".join(str(cell) for cell in [case["healthy"], *case_row(case)])
    for healthy, cases in by_healthy(values).items():
        for sentence, count, total in rig_judge.counts(cases) if cases else ():
            yield f"{healthy} healthy: {sentence}: {of(count, total)}: {interval(count, total)}"
