"""Writes the page of the textbook campaign. Tables and two pictures show the found, wrong and missed causes by make,
cause, strength and columns."""
import collections
import json
import math
import pathlib
import statistics

import blind_page
import results_page
from results_page import interval
from trial import HELD_OUT_AT_MOST, NOISE_MM


def share(hits, count):
    return interval(hits, count) if count else "-"


def found_of(rows):
    return share(sum(len(r["found"]) for r in rows), sum(len(r["causes"]) for r in rows))


def wrong_of(rows):
    return share(sum(bool(r["wrong"]) for r in rows), len(rows))


def median(values):
    return f"{statistics.median(values):.2f}" if values else "-"


def instead(rows):
    count = collections.Counter(name for r in rows for name in r["wrong"])
    return ", ".join(f"{name} ({n})" for name, n in count.most_common())


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows), ""]


def within(rows, most):
    errors = [r["heldout_over_noise"] for r in rows if "heldout_over_noise" in r]
    return share(sum(e <= most for e in errors), len(errors))


def summary(rows):
    clean, singles = [r for r in rows if not r["causes"]], [r for r in rows if len(r["causes"]) == 1]
    lines = []

    def line(what, wanted, measured, among):
        if among:
            lines.append((what, wanted, measured, len(among)))

    for columns, most in HELD_OUT_AT_MOST.items():
        among = [r for r in clean if r["columns"] == columns]
        line(f"cases without an effect, {columns_text(columns)}: held-out error at most {most:g} times the sensor noise", "100 %",
             within(among, most), among)
    line("cases without an effect: no wrong cause is named", "at least 97 %",
         share(sum(not r["wrong"] for r in clean), len(clean)), clean)
    line("cases without an effect: no cause is named, but an unexplained error is reported (`unexplained`)", "-",
         share(sum(r["outcome"] == "unexplained" for r in clean), len(clean)), clean)
    wanted = {8: "at least 90 %", 2: "at least 70 %"}
    for strength in sorted({r["strength"] for r in singles}, reverse=True):
        among = [r for r in singles if r["strength"] == strength]
        line(f"one effect of strength {strength:g}: effect found", wanted.get(strength, "-"), found_of(among), among)
    line("cases with one effect: a wrong cause is named", "at most 3 %", wrong_of(singles), singles)
    for size, word in ((2, "two"), (3, "three")):
        among = [r for r in rows if len(r["causes"]) == size]
        line(f"cases with {word} effects: percentage of the effects that are found", "-", found_of(among), among)
        line(f"cases with {word} effects: {'both' if size == 2 else 'all'} effects are found", "-", share(sum(len(r["found"]) == size for r in among), len(among)), among)
        line(f"cases with {word} effects: a wrong cause is named", "-", wrong_of(among), among)
    closed = [r for r in rows if r.get("feedforward")]
    line("a feedforward can be computed from the model that the diagnosis has extended", "100 %", share(sum(r["feedforward"] != "none" for r in closed), len(closed)),
         closed)
    return lines


def columns_text(columns):
    return {"pressure": "measured pressure", "command": "command without a measured pressure"}[columns]


def clean_table(rows):
    """Returns the held-out error and the named causes of worlds without a hidden effect, for each make and each set of
    columns."""
    lines = []
    for make in sorted({r["make"] for r in rows}):
        for columns in sorted({r["columns"] for r in rows}, reverse=True):
            among = [r for r in rows if r["make"] == make and r["columns"] == columns and not r["causes"]]
            if not among:
                continue
            chosen = [r["heldout_over_noise"] for r in among if "heldout_over_noise" in r]
            extended = [r["heldout_rmse_mm"]["extended"] / NOISE_MM for r in among]
            own = collections.Counter(name for r in among for name in r["named"] if name not in r["wrong"])
            lines.append((make, columns_text(columns), len(among), median(chosen), f"{max(chosen, default=math.nan):.2f}",
                          median(extended), ", ".join(f"{name} ({n})" for name, n in own.most_common()),
                          instead(among)))
    return table(("make", "columns", "cases", "held-out error of `identify` / noise, median", "held-out error of `identify` / noise, largest",
                  "held-out error of the model of the diagnosis / noise, median", "named causes that describe own physics", "wrongly named causes"), lines)


def split_table(rows, key, text=str):
    """Returns the found and wrong causes of worlds with hidden effects, grouped by `key` and strength."""
    strengths = sorted({r["strength"] for r in rows if r["causes"]}, reverse=True)
    lines = []
    for value in sorted({r[key] for r in rows}):
        among = [r for r in rows if r[key] == value and r["causes"]]
        by_strength = [found_of([r for r in among if r["strength"] == s]) for s in strengths]
        if among:
            lines.append((text(value), len(among), *by_strength, wrong_of(among), instead(among)))
    return table((key, "cases", *(f"found at strength {s:g}" for s in strengths), "cases with a wrongly named cause", "wrongly named causes"), lines)


def cause_table(rows):
    """Returns the outcomes of worlds with one hidden cause, by cause."""
    singles = [r for r in rows if len(r["causes"]) == 1]
    strengths = sorted({r["strength"] for r in singles}, reverse=True)
    lines = []
    for cause in sorted({r["causes"][0] for r in singles}):
        among = [r for r in singles if r["causes"][0] == cause]
        at = [[r for r in among if r["strength"] == s] for s in strengths]
        in_part = sum(cause in r["partial"] and not r["found"] for r in among)
        lines.append((cause, *(f"{sum(len(r['found']) for r in some)} of {len(some)}" for some in at),
                      share(sum(len(r["found"]) for r in among), len(among)),
                      sum(len(r["alone"]) for r in among), in_part, instead(among)))
    return table(("cause", *(f"found at strength {s:g}" for s in strengths), "found in total", "named without alternatives",
                  "only listed in `partial_causes`", "wrongly named causes"), lines)


def wrong_table(rows):
    """Lists every world for which a wrong cause was reported."""
    lines = [("+".join(r["causes"]) or "nothing", f"{r['strength']:g}", r["make"], columns_text(r["columns"]), r["seed"],
              ", ".join(r["wrong"]), ", ".join(name for name in r["named"] if name not in r["wrong"]), r["verdict"])
             for r in rows if r["wrong"]]
    return table(("hidden cause", "strength", "make", "columns", "seed", "wrongly named cause", "other named causes", "verdict"), sorted(lines))


def meaning(rows):
    measured = {what: text.split(" (")[0] for what, _, text, _ in summary(rows)}
    found = [measured.get(f"one effect of strength {strength}: effect found", "-") for strength in (8, 2)]
    return (f"In this campaign, the fingers and valves are simulated with textbook equations that softgrip does not use. If the hidden "
            f"effect changes the displacement by 8 times the sensor noise, the diagnosis finds the true cause in {found[0]} of the cases. "
            f"With a change of 2 times the sensor noise, it finds the true cause in {found[1]} of the cases. The diagnosis names a wrong "
            f"cause in {measured.get('cases with one effect: a wrong cause is named', '-')} of the cases with one effect.")


def made(results, planned):
    failed = [r for r in results if r["outcome"] == "failed"]
    walls = [r["wall_s"] for r in results if "wall_s" in r]
    of_planned = f" of {planned} planned" if len(results) < planned else ""
    unreachable = sum(not r.get("reachable", True) for r in results)
    return (f"{len(results)} simulated cases{of_planned}, of which {len(failed)} failed. In {unreachable} cases, the effect did not reach "
            f"the required strength. On one core of a shared machine, a diagnosis took {statistics.median(walls):.0f} s (median) and at most "
            f"{max(walls):.0f} s.")


INTRODUCTION = """\
The simulations of this campaign use none of the equations of softgrip's models. The flow through the simulated valve
follows ISO 6358. A PI controller positions the spool of the valve, which has overlap and pilot hysteresis. The simulated
fingers are of five types (column `make`), which differ in the equations for hysteresis and creep: generalised play
operators, Maxwell-slip elements, Preisach relays, a rubber tube that is divided into slices and has a Prony series, and
play operators with fractional creep. All five types have creep with time constants over five decades, and a slightly
nonlinear characteristic. Each case has three logs. The standard deviation of the noise is 0.04 mm for the displacement
readings, 0.05 kPa for the measured pressures and 0.3 kPa for the supply pressures.

The strength of an effect is the RMS of the displacement change that the effect causes in the logs of the case, divided by
the sensor noise of 0.04 mm. The strength does not include the part of the displacement change that a refit of the model can absorb. A
refit can absorb any change of the zero offset and of the gain. A refit can also absorb any hysteresis width, curvature
and creep that fingers of this type can have. For a leak, the strength includes the complete displacement change. *Own
physics* are mechanisms that the simulated finger and valve have even without the hidden effect. A mechanism belongs to
the own physics only if its removal changes the displacement by more than 25 % of the sensor noise. A named cause is not
counted as wrong if it describes the own physics of the simulated finger and valve. A hidden cause that is named is
counted as found, even if it also describes the own physics. An example of such a cause is an additional valve lag.

The diagnosis starts from a plain Bouc-Wen model of a different finger (`tests/blind/textbook/given.yaml`). The plain model represents a user who identifies a model on one finger and uses the model for a second finger of the same type. With `--given
commissioned`, the diagnosis starts from a model that `softgrip identify --structure auto` has fitted to different logs of
the same finger, without the effect. A cause is *found* if it is named or is an alternative of a named cause, regardless of the verdict. One named cause is counted for at most one hidden cause. A named cause is *wrong* if the finger contains
neither this cause nor one of its alternatives. The held-out error of `identify` is the error of `softgrip identify
--structure auto` on blocks of the log that were left out of the fit. The held-out error of the model of the diagnosis is the error on the held-out
blocks of the diagnosis. If the logs contain a measured pressure, this pressure is the input of the models (`--drive
measured`). For logs without a measured pressure, the commanded pressure is the input of the models. With a measured pressure, the diagnosis finds
causes in the valve by a comparison of the measured with the commanded pressure."""


def write(path, results, planned, command, variation, version):
    """Writes the page. `variation` contains the sentences about the run-to-run variation."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    bars_path, confusion_path = (path.with_name(f"{path.stem}-{what}.svg") for what in ("outcomes", "confusion"))
    rows = [r for r in results if r["outcome"] != "failed"]
    rows_path = path.with_suffix(".jsonl")
    rows_path.write_text("".join(sorted(json.dumps(r) + "\n" for r in results)))
    bars_path.write_text(blind_page.bars(rows))
    # The picture omits the causes that a finger has even without a hidden effect, because the diagnosis names them
    # correctly in almost all worlds.
    plain = [{**r, "named": [], "rivals": []} for r in rows]
    for r, full in zip(plain, rows):
        for name, rivals in zip(full["named"], full["rivals"]):
            if {name, *rivals} & {*r["causes"]} or name in r["wrong"]:
                r["named"].append(name)
                r["rivals"].append(rivals)
    confusion_path.write_text(blind_page.confusion(plain))
    lines = [*results_page.head("Textbook campaign", meaning(rows), version, command, made(results, planned)),
             f"Every line of [{rows_path.name}]({rows_path.name}) contains the outcome of one case. If you copy `{rows_path.name}` to `DIR/textbook.jsonl`, `scripts/textbook_campaign.py` skips the cases that the file contains.",
             "", *INTRODUCTION.splitlines(), "", variation, "",
             *table(("measure", "required", "measured (95 % interval)", "number of cases"), summary(rows)),
             "## Without an effect", "", *clean_table(rows), "## By cause, hidden alone", "", *cause_table(rows),
             f"![Outcomes by hidden cause]({bars_path.name})", "",
             f"![Named cause by hidden cause, without own physics]({confusion_path.name})", "",
             "## Cases with a wrong cause", "", *wrong_table(rows), "## By make", "", *split_table(rows, "make"), "## By columns", "", *split_table(rows, "columns", columns_text)]
    if len({r["given"] for r in rows}) > 1:
        lines += ["## By the model that was given", "", *split_table(rows, "given")]
    path.write_text("\n".join(lines).rstrip() + "\n")
