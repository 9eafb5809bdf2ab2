"""Writes the tables of bench/other_loops.py: on the screen, and as a page of docs/results."""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import results_page
from results_page import interval

from foreign_page import names_of, number, of, table

import loop_judge
import loop_kinds

TITLE = "Simulated control loops with and without a sticking valve"
LABEL = {"visible": "sticking, visible", "hidden": "sticking, not visible", "others": "other"}
CRITERION = ("The effect of a sticking valve is *visible* if two conditions are met. First, the friction changes the reading by "
             "at least 4 standard deviations of the sensor noise (2.5 to 97.5 % range). Second, the stem rests at least twice "
             "for 5 samples or more while the output changes by at least S/2, and then moves. This criterion was fixed before "
             "softgrip judged a loop.")
HALF_TEXT = ("The 2 halves have the same kinds of loops with different random numbers. Rules of softgrip were developed with the "
             "first half and with loops of other seeds. Before the last change of the rules (other explanations, depending on the "
             "correlation of command and reading), the authors had seen the answers of an earlier version for the second half.")


def by_half(values):
    return {half: [case for case in values["cases"] if case["half"] == half] for half in values["halves"]}


def summary_table(values):
    columns = [loop_judge.counts(cases) for cases in by_half(values).values()]
    texts = [text for rows in columns for text, _, _ in rows]
    found = [{text: f"{of(count, total)}: {interval(count, total)}" for text, count, total in rows} for rows in columns]
    return table(["criterion", *(f"{half} half" for half in values["halves"])],
                 [[text, *(column.get(text, "-") for column in found)] for text in dict.fromkeys(texts)])


def outcomes_row(text, cases):
    outcomes = [case["outcome"] for case in cases]
    return [text, len(cases), outcomes.count("named"), outcomes.count("listed"), outcomes.count("not"),
            outcomes.count("failed"), sum(case["horch"] == "sticks" for case in cases)]


OUTCOME_HEAD = ["loops", "number", "named", "listed", "not", "error", "Horch: sticks"]


def sticking_table(cases):
    return table(OUTCOME_HEAD, [outcomes_row(text, found) for text, found in loop_judge.groups_of_sticking(cases) if found])


def others_table(cases):
    good = [case for case in cases if not case["sticks"]]
    rows = [outcomes_row(f"{kind.replace('_', ' ')}: {text}", [case for case in good if case["kind"] == kind])
            for kind, text in loop_kinds.OTHERS.items()]
    return table(OUTCOME_HEAD, [row for row in rows if row[1]])


CASE_HEAD = ["loop", "process", "interval", "samples", "historian", "S, J [%]", "S / span", "effect / noise, rests", "verdict",
             "named causes, `or` their alternatives (size)", "outcome", "Horch", "time [s]"]


def case_row(case):
    sticks = case["sticks"]
    return [case["loop"], case["process"], f"{case['interval_s']:g} s", case["samples"], case["historian"],
            f"{case['band']:.2f}, {case['jump']:.2f}" if sticks else "-", number(case.get("share")),
            f"{number(case['effect_to_noise'])}, {case['rests']}" if sticks else "-", case["verdict"], names_of(case),
            case["outcome"], case["horch"], number(case["wall_s"])]


def case_section(half, cases):
    lines = [f"## Cases of the {half} half"]
    for group, text in LABEL.items():
        found = [case for case in cases if loop_judge.group_of(case) == group]
        if found:
            lines += ["", f"### {text[0].upper()}{text[1:]}, {half} half", "", *table(CASE_HEAD, map(case_row, found))]
    return "\n".join(lines)


def count_of(rows, beginning):
    return next((of(count, total) for text, count, total in rows if text.startswith(beginning)), "0 of 0")


def meaning(values):
    half, cases = list(by_half(values).items())[-1]
    rows = loop_judge.counts(cases)
    longest = max((case["wall_s"] for case in cases), default=0.0)
    return (f"On the simulated control loops of the {half} half, stiction is named for "
            f"{count_of(rows, 'sticking valves with a visible effect: `valve_deadband` named')} sticking valves whose effect is "
            f"visible, and for {count_of(rows, 'other loops: `valve_deadband` named')} other loops. `sensor_drift` is named alone "
            f"for {count_of(rows, 'all loops: `sensor_drift`')} loops. The longest identification and diagnosis of a loop take "
            f"{longest:.0f} s. Required for real loops: at least 9 of 13, at most 1 of 16, and none.")


def write(path, values, command):
    load = max((case.get("load_1min") or 0 for case in values["cases"]), default=0)
    head = results_page.head(TITLE, meaning(values), values["version"], command,
                             f"{len(values['cases'])} loops, 1 thread per call; a call is stopped after {values['at_most_s']:g} s of "
                             f"real time, and then counts as an error; 1-minute load up to {load:.1f}", values["began"][:10])
    sections = ["\n".join([*head, "The loops are simulations with equations that softgrip does not use. The logs are not "
                           "measurements. Each loop is identified with `softgrip identify` and then diagnosed with this model. "
                           "[How to repeat the measurements](../how-to/measure.md#simulated-control-loops)."]),
                "\n".join(["## Summary", "", "Each cell contains a count, a share and its 95 % interval (Wilson). An error of softgrip counts "
                           "as not named. " + HALF_TEXT,
                           "", CRITERION, "", *summary_table(values)])]
    for half, cases in by_half(values).items():
        sections += ["\n".join([f"## Sticking valves with a visible effect, {half} half", "",
                                "*S* is the deadband plus stick band, and *J* is the slip jump. One loop is in several rows.", "",
                                *sticking_table(cases)]),
                     "\n".join([f"## Other loops, {half} half", "", *others_table(cases)])]
    sections += [case_section(half, cases) for half, cases in by_half(values).items()]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n\n".join(sections) + "\n")


def screen_lines(values):
    for half, cases in by_half(values).items():
        yield from (f"{half}: {text}: {of(count, total)}: {interval(count, total)}"
                    for text, count, total in loop_judge.counts(cases))
        yield from sticking_table(cases)
        yield from others_table(cases)
        yield f"{half}: longest time of a loop: {max((case['wall_s'] for case in cases), default=0.0):.0f} s"
