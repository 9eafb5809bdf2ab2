"""Writes the results page of bench/foreign.py. The page contains the required and the reached values, followed by the
cases of each judge."""
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import results_page

from judge_identification import METHODS, held_out_percent, linear_is_better


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(str(cell).replace("|", "\\|").replace("\n", "<br>") for cell in row) + " |" for row in rows)]


def number(value, digits=3):
    """Formats a number with significant digits; `-` for None."""
    if value is None or not math.isfinite(value):
        return "-"
    return f"{value:.{digits}g}"


def of(count, total):
    return f"{count} of {total}"


def names_of(case):
    """Formats the causes that a diagnosis named, with their alternatives and sizes."""
    parts = []
    for name, rivals, size in zip(case["named"], case["alternatives"], case["sizes"]):
        text = " or ".join([name, *rivals])
        if isinstance(size, dict) and isinstance(size.get("value"), (int, float)):
            text += f" ({number(size['value'])} {size.get('unit', '')})".replace(" )", ")")
        parts.append(text)
    return "; ".join(parts) or "-"


def requirements(values):
    """Returns rows (sentence, required value, reached value) for each judge that ran."""
    summary = values.get("summary", {})
    rows = []
    for group, part in summary.get("repeats", {}).items():
        rows.append((f"{group} without a change: reported as changed", "at most 1 of 12" if group == "runs" else "-",
                     of(part["changed"], part["cases"])))
        rows.append((f"{group} without a change: `sensor_drift` named", "-", of(part["sensor_drift"], part["cases"])))
    if "changes" in summary:
        part = summary["changes"]
        rows += [("labelled changes beyond the run-to-run spread: detected", "80 %",
                  of(part["detected"], part["beyond_spread"])),
                 ("detected changes beyond the run-to-run spread: labelled cause named or listed", "50 %", of(part["named_or_listed"], part["detected"])),
                 ("labelled changes: only a wrong cause named", "at most 10 %", of(part["wrong_alone"], part["cases"])),
                 ("labelled changes within the spread: reported as unchanged", "all",
                  of(part["within_reported_unchanged"], part["within_spread"])),
                 ("all labelled changes: detected", "-", of(part["changed"], part["cases"]) if "changed" in part else "-"),
                 ("all labelled changes: labelled cause named or listed", "-", of(part["listed"], part["cases"]) if "listed" in part else "-")]
    if "stiction" in summary:
        sticking, others = summary["stiction"]["sticking"], summary["stiction"]["others"]
        rows += [("loops with a sticking valve: `valve_deadband` named", "9 of 13",
                  of(sticking["stiction_named"], sticking["cases"])),
                 ("other loops: `valve_deadband` named", "at most 1 of 16", of(others["stiction_named"], others["cases"])),
                 ("all loops: `sensor_drift` named alone", "none",
                  of(sticking["drift_alone"] + others["drift_alone"], sticking["cases"] + others["cases"])),
                 ("loops with a sticking valve: detected by Horch's phase test", "-", of(sticking["horch"], sticking["cases"])),
                 ("other loops: reported as sticking by Horch's phase test", "-", of(others["horch"], others["cases"]))]
    if "identification" in summary:
        part = summary["identification"]
        rows += [("identification: the error of a linear model of order 3 is more than 10 % smaller than that of `auto`", "none",
                  of(part["linear_better"]["auto"], part["rows"])),
                 ("identification: the error of a linear model of order 3 is more than 10 % smaller than that of `plain`", "-", of(part["linear_better"]["plain"], part["rows"])),
                 ("identification: `auto` or `plain` has the smallest error", "-",
                  of(part["first"]["auto"] + part["first"]["plain"], part["rows"]))]
    return rows


def required_table(values, reference):
    now = requirements(values)
    if not reference:
        return table(["criterion", "required", "reached"], now)
    before = {row[0]: row[2] for row in requirements(reference)}
    return table(["criterion", "required", f"reference: {reference['softgrip']['version']}", "reached"],
                 [(sentence, required, before.get(sentence, "-"), reached) for sentence, required, reached in now])


def plain_cells(case):
    plain = case["plain"]
    return [number(plain["fitted_mm"]), number(max(plain["left_out_mm"], default=math.nan)),
            number(plain["healthy_bound_mm"]), number(plain["later_mm"]),
            number(plain["over_bound"] or plain["over_fitted"])]


PLAIN_HEAD = ["fitted [mm]", "left out [mm]", "bound [mm]", "later [mm]", "ratio"]


def pair_tables(values, judge, more_head, more_cells):
    cases = [case for case in values["cases"] if case["judge"] == judge and "error" not in case]
    head = ["set", "pair", "baseline runs", *PLAIN_HEAD, "verdict", "named", *more_head, "time [s]"]
    return table(head, [[case["set"], case["case"], case["baseline_runs"], *plain_cells(case), case["verdict"],
                         names_of(case), *more_cells(case), number(case["wall_s"])] for case in cases])


PLAIN_TEXT = [
    "The columns *fitted*, *left out* and *later* contain RMSE values of the plain identified model (`softgrip identify` without `--structure`). *fitted* is the RMSE on the baseline runs, to which the model was fitted.",
    "*left out* is the largest RMSE on a baseline run to which the model was not fitted. *later* is the RMSE on the later run of the pair.",
    "*bound* is the one-sided 95 % prediction bound (Student's t) for the RMSE on a further healthy run. The bound is computed from",
    "the RMSE values on the baseline runs to which the model was not fitted.",
    "*ratio* is *later* divided by *bound*. A pair with 1 baseline run has no *bound*, so its *ratio* is *later* divided by *fitted*."]


def repeats_section(values):
    return ["## Repeated runs without a change", "", *PLAIN_TEXT, "", *pair_tables(values, "repeats", [], lambda case: [])]


def changes_section(values):
    def cells(case):
        return [case["label"], ", ".join(case["causes"]),
                "-" if case["exceeds_spread"] is None else "yes" if case["exceeds_spread"] else "no",
                "named" if case["named_correctly"] else "listed" if case["listed"] else
                "only a wrong cause named" if case["wrong_alone"] else "not named"]
    repeats = any(case["judge"] == "repeats" for case in values["cases"])
    explained = [] if repeats else [*PLAIN_TEXT, ""]  # repeats_section() writes PLAIN_TEXT too
    return ["## Labelled changes", "", *explained, "A change exceeds the run-to-run spread if the RMSE in the column *later* is larger than the value in the column *bound*. Without a *bound*, the column *exceeds spread* contains `-`. The column *answer* contains *named* if an admissible cause is named, and *listed* if an admissible cause is only listed as an alternative.",
            "",
            *pair_tables(values, "changes", ["label", "admissible causes", "exceeds spread", "answer"], cells)]


STICTION_TEXT = [
    "The column *phase ratio* contains the statistic of Horch's phase test (A. Horch, Control Engineering Practice 7, 1999, 1221-1231), which `bench/foreign/horch.py` computes without softgrip. According to this test, the valve sticks",
    "if the phase ratio is above 2/3, and does not stick if the phase ratio is below 1/3. The authors knew which valves are labelled as sticking when they chose the form of the test, so the counts of this test are not an independent evaluation."]


def stiction_section(values):
    cases = [case for case in values["cases"] if case["judge"] == "stiction" and "error" not in case]
    head = ["loop", "labelled", "verdict", "named", "phase ratio", "Horch", "time [s]"]
    rows = [[case["case"], "sticks" if case["sticks"] else "free", case["verdict"], names_of(case),
             number(case["phase_ratio"]), case["horch"], number(case["wall_s"])] for case in cases]
    return ["## Stiction", "", *STICTION_TEXT, "", *table(head, rows)]


IDENTIFICATION_TEXT = [
    "The table contains the held-out RMSE in % of the span of the log. If a case has a single log, each method fits the first half of the log, and predicts the second half by a simulation",
    "from the start of the log. In a case `A -> B`, each method fits log A and predicts log B. The column *plain* is `softgrip identify`, and the column *auto* is",
    "`softgrip identify --structure auto`. The column *output error* is a linear output-error model of order 3 (`bench/foreign/output_error.py`). The order is 3 because the published model of the finger also has 3 states. The column *SciPy* is a Bouc-Wen model with 2 Kelvin-Voigt branches, which `least_squares` fits",
    "(`bench/foreign/scipy_bouc_wen.py`). For the prediction of log B, *output error* and *SciPy* estimate the offset from the first 5 % of log B (at least 2 s), and no other parameter.",
    "If the column *drive* contains *command*, the commanded pressure is the input of every model. If the column *drive* contains *measured*, the measured pressure is the input of every model.",
    "The authors knew the held-out errors on `piezo` and `hydraulic` when they chose the rule for the initial state of the linear model.",
    "The authors knew the errors on `asu_softarm` and `hydraulic` when they added these functions to *auto*: the start at rest, the bounded response, the second lag, the",
    "rate limit and the resonance. The counts on `asu_softarm` and `hydraulic` are therefore not an independent evaluation of these functions.",
    "The smallest error of each row is bold. The column *linear better* contains *yes* if the error of the linear model is more than 10 % smaller than the error of *auto*.",
    "In the column *structure of auto*, a creep ladder is a chain of Kelvin-Voigt elements."]


def identification_row(case, row):
    values = [held_out_percent(row, method) for method in METHODS]
    known = [value for value in values if value is not None]
    cells = ["failed" if value is None else f"**{number(value)}**" if value == min(known) else number(value)
             for value in values]
    structure = (row["methods"].get("auto") or {}).get("structure") or "-"
    return [case["set"], case["case"], row["drive"], *cells, "yes" if linear_is_better(row, "auto") else "no", structure]


def identification_section(values):
    cases = [case for case in values["cases"] if case["judge"] == "identification" and "error" not in case]
    head = ["set", "log", "drive", "plain [%]", "auto [%]", "output error [%]", "SciPy [%]", "linear better",
            "structure of auto", "time [s]"]
    rows = [[*identification_row(case, row), number(case["wall_s"]) if k == 0 else ""]
            for case in cases for k, row in enumerate(case["rows"])]
    return ["## Identification", "", *IDENTIFICATION_TEXT, "", *table(head, rows)]


SECTIONS = {"repeats": repeats_section, "changes": changes_section, "stiction": stiction_section,
            "identification": identification_section}


def sets_section(values):
    used = {case["set"] for case in values["cases"]}
    rows = [[name, s["title"], s["source"], s["licence"], s["about"].replace("\n", " ")]
            for name, s in values["sets"].items() if name in used]
    return ["## Data sets", "", *table(["set", "title", "source", "licence", "content"], rows)]


def failures_section(values):
    rows = [[case["judge"], case["set"], case["case"], case["error"]] for case in values["cases"] if "error" in case]
    rows += [[case["judge"], case["set"], f"{case['case']}, {row['drive']}, {method}", text] for case in values["cases"]
             for row in case.get("rows", []) for method, text in row["errors"].items()]
    return ["## Failed cases", "", *table(["judge", "set", "case", "reason"], rows)] if rows else []


def meaning(values, subject="data of other laboratories"):
    """Returns sentences with the numbers of right and wrong answers of softgrip on these data."""
    summary, parts = values.get("summary", {}), []
    if "runs" in summary.get("repeats", {}):
        part = summary["repeats"]["runs"]
        parts.append(f"{of(part['changed'], part['cases'])} repeated runs without a change are reported as changed")
    if "changes" in summary:
        part = summary["changes"]
        parts.append(f"the labelled cause is named or listed for {of(part.get('listed', '-'), part['cases'])} labelled changes, and "
                     f"only a wrong cause is named for {of(part['wrong_alone'], part['cases'])} labelled changes")
    if "stiction" in summary:
        part = summary["stiction"]["sticking"]
        parts.append(f"stiction is named for {of(part['stiction_named'], part['cases'])} sticking valves")
    if "identification" in summary:
        part = summary["identification"]
        parts.append(f"the error of a linear model is more than 10 % smaller than the error of `softgrip identify --structure auto` in {of(part['linear_better']['auto'], part['rows'])} "
                     "fits")
    parts = parts or ["nothing was evaluated"]
    return " ".join([f"For {subject}, {parts[0]}.", *(f"{part[0].upper()}{part[1:]}." for part in parts[1:])])


def head(values, title, command):
    machine = values["machine"]
    loads = [case["load_1min"] for case in values["cases"] if case["load_1min"] is not None]
    load = f"{number(min(loads))} to {number(max(loads))}" if loads else "-"
    lines = results_page.head(title, meaning(values, title[0].lower() + title[1:]), values["softgrip"]["version"], command,
                              f"{machine['processors']} processors, {machine['threads']} thread per call, 1-minute load {load}",
                              values["began"][:10])
    return [*lines, "The column *time* contains the total duration of all calls of softgrip for a case. If two cases use the same identification, the times of both cases include the duration of this identification. "
            "[How to repeat the measurements](../how-to/measure.md#data-of-other-laboratories)."]


def write(path, values, reference=None, title="Data of other laboratories", command="bench/foreign.py --out DIR --page"):
    sections = [head(values, title, command), required_table(values, reference)]
    judges = {case["judge"] for case in values["cases"]}
    sections += [section(values) for judge, section in SECTIONS.items() if judge in judges]
    sections += [failures_section(values), sets_section(values)]
    text = "\n\n".join("\n".join(lines) for lines in sections if lines)
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{text}\n")
