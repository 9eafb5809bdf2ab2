"""The page of bench/measured.py: tables in Markdown, two pictures (SVG) beside it."""
import html
import math
import pathlib
import re

# What is run, as it is called on the page, its colour.
STRUCTURES = [("identify", "published element", "#8a93a3"), ("auto", "auto", "#2e7d4f"),
              ("bouc_wen", "bouc_wen", "#3b6fb5"), ("prandtl_ishlinskii", "prandtl_ishlinskii", "#c98a2b"),
              ("scipy", "scipy", "#b3372e")]
MISFIT = [("as_given", "as identified", "#b3372e"), ("recalibrated", "recalibrated", "#c98a2b"),
          ("extended", "with what is named", "#2e7d4f"), ("noise", "noise", "#8a93a3")]
UNLOADS = 0.5
MEANING = """Percentages are of a log's span (largest minus smallest reading). **Continuation**: the model is fitted to
the first part of a log and simulated on through the rest, nothing re-seeded; that rest is scored. **Interleaved
blocks**: what is scored lies between parts that were fitted. Where the pressure is measured, it drives the finger.
*published element* is `softgrip identify` as it is called without `--structure`; the next three are what stands behind
`--structure`; *scipy* is Bouc-Wen with two Kelvin-Voigt branches fitted by `least_squares`, which shares nothing with
softgrip (`bench/foreign/scipy_bouc_wen.py`). *fitted part unloads*: how far the pressure that drives comes down there,
of how far it goes; what unloading does cannot be learnt where there is none."""


def result_of(row, step):
    return row["outcomes"].get(step, {}).get("result")


def percent(value_mm, row):
    return math.nan if value_mm is None or not row.get("span_mm") else 100 * value_mm / row["span_mm"]


def continuation(row, step):
    return percent((result_of(row, step) or {}).get("continuation_mm"), row)


def number(value, digits=2):
    return "-" if not math.isfinite(value) else f"{value:.{digits}f}" if value < 1000 else f"{value:.2g}"


def time_of(rows):
    """(what, key): of processors, where every run has it; outcomes of an earlier version have the clock's only."""
    outcomes = [outcome for row in rows for outcome in row["outcomes"].values()]
    known = all("processor_s" in outcome for outcome in outcomes)
    return ("processor time", "processor_s") if known else ("time by the clock", "wall_s")


def geometric_mean(values):
    known = [value for value in values if math.isfinite(value) and value > 0]
    return math.exp(sum(map(math.log, known)) / len(known)) if known else math.nan


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |" for row in rows)]


def groups(rows):
    """(what, rows) over which means are taken: each set and all, and of each those whose fitted part unloads; alike for
    every structure, so without a log on which one failed."""
    rows = [row for row in rows if all(math.isfinite(continuation(row, step)) for step, _, _ in STRUCTURES)]
    named = [(name, [r for r in rows if r["set"] == name]) for name in dict.fromkeys(r["set"] for r in rows) if name]
    found = []
    for name, among in [*named, ("all", rows)]:
        unloading = [row for row in among if row["unloading"] >= UNLOADS]
        for what, part in ((name, among), (f"{name}, first part unloads", unloading)):
            if len(part) > 1 and all(part != other for _, other in found):
                found.append((what, part))
    return found


def held_out_table(rows):
    head = ["log", "fitted part unloads [%]", *(f"{label} [%]" for _, label, _ in STRUCTURES),
            f"{time_of(rows)[0]} of all five [s]"]
    lines = []
    for row in rows:
        values = [continuation(row, step) for step, _, _ in STRUCTURES]
        best = min((value for value in values if math.isfinite(value)), default=math.nan)
        seconds = sum(row["outcomes"].get(step, {}).get(time_of(rows)[1], 0) for step, _, _ in STRUCTURES)
        lines.append([row["name"], f"{100 * row['unloading']:.0f}",
                      *(f"**{number(v)}**" if v == best else number(v) for v in values), number(seconds, 1)])
    for what, among in groups(rows):
        lines.append([f"geometric mean of {len(among)}: {what}", "",
                      *(number(geometric_mean([continuation(row, step) for row in among]))
                        for step, _, _ in STRUCTURES), ""])
    return table(head, lines)


def chosen_table(rows):
    head = ["log", "`--structure auto` takes", "fitted [%]", "interleaved blocks of the fitted part [%]",
            "continuation [%]", "valve: command to pressure, fitted [% of range]",
            "both in a row from the command, whole log [%]", "inverse"]
    lines = []
    for row in rows:
        result = result_of(row, "auto")
        if result:
            lines.append([row["name"], result["description"], *(number(percent(result.get(key), row)) for key in
                                                                ("fitted_mm", "blocks_mm", "continuation_mm")),
                          number(result.get("valve_percent", math.nan)),
                          number(percent(result.get("from_command_mm"), row)), inverse(row, "auto")])
    return table(head, lines)


def inverse(row, step):
    result = result_of(row, f"inverse_{step}")
    return "-" if result is None else "yes" if result["inverse"] else "no"


def names_of(causes):
    def one(cause):
        rivals = "".join(f" or {rival}" for rival in cause["rivals"])
        return f"{cause['id']}{rivals} (inclusion {cause['inclusion']:.2f}, share {cause['share_percent']:.0f} %)"
    return "; ".join(map(one, causes)) or "-"


def diagnoses(rows):
    for row in rows:
        for drive in ("command", "measured"):
            result = result_of(row, f"diagnosis_{drive}")
            if result:
                seconds = row["outcomes"][f"diagnosis_{drive}"][time_of(rows)[1]]
                yield row, drive, result, seconds


def diagnosis_table(rows):
    nulls = any(result["p_value"] is not None for _, _, result, _ in diagnoses(rows))
    head = ["log", "driven by", "verdict", "named", "part of it", "base that it found", "inverse",
            f"{time_of(rows)[0]} [s]",
            *(["p"] if nulls else [])]
    lines = [[row["name"], drive, f"`{result['verdict']}`", names_of(result["causes"]), names_of(result["partial"]),
              result["base"] or "-", inverse(row, f"diagnosis_{drive}"),
              number(seconds, 1),
              *(["-" if result["p_value"] is None else f"{result['p_value']:.2f}"] if nulls else [])]
             for row, drive, result, seconds in diagnoses(rows)]
    return table(head, lines)


def misfit(row, result):
    """RMSE by key of MISFIT [% of span]."""
    values = dict(result["blocks_mm"], noise=result["noise_mm"])
    return {key: percent(values.get(key), row) for key, _, _ in MISFIT}


def budget_table(rows):
    head = ["log", "driven by", *(f"{label} [%]" for _, label, _ in MISFIT), "recalibrated [mm²]", "brought by [mm²]",
            "left beyond the noise [mm²]", "noise [mm²]"]
    lines = []
    for row, drive, result, _ in diagnoses(rows):
        budget = result["budget"]
        brought = "; ".join(f"{cause} {spread['value']:.3g} ({spread['ci95'][0]:.3g} .. {spread['ci95'][1]:.3g})"
                            for cause, spread in budget["causes"].items()) or "-"
        lines.append([row["name"], drive, *map(number, misfit(row, result).values()),
                      "-" if budget["recalibrated"] is None else f"{budget['recalibrated']:.3g}", brought,
                      f"{budget['left']:.3g}", f"{budget['noise']:.3g}"])
    return table(head, lines)


def dots(rows, series, axis):
    """One line of dots per row (label, {key: value}) on a logarithmic axis, at whose end stands what is beyond it."""
    values = [v for _, marks in rows for v in marks.values() if math.isfinite(v) and v > 0]
    if not values:
        return ""
    low, high = math.log10(min(values)) - 0.05, math.log10(min(max(values), 1000 * min(values))) + 0.05
    left, width, height, top = 250, 560, 24, 48
    bottom = top + height * len(rows)

    def x(value):
        return left + width * min(max((math.log10(value) - low) / (high - low), 0), 1)

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + width + 30} {bottom + 44}" '
           'font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="white"/>']
    at = 10
    for _, label, colour in series:
        svg.append(f'<circle cx="{at + 5}" cy="15" r="4.5" fill="{colour}"/><text x="{at + 14}" y="19">{label}</text>')
        at += 30 + 6.5 * len(label)
    for tick in [m * 10.0 ** e for e in range(-4, 7) for m in (1, 2, 3, 5)]:
        if low <= math.log10(tick) <= high:
            svg.append(f'<line x1="{x(tick):.1f}" x2="{x(tick):.1f}" y1="{top - 8}" y2="{bottom}" stroke="#dde1e7"/>'
                       f'<text x="{x(tick):.1f}" y="{bottom + 15}" text-anchor="middle">{tick:g}</text>')
    for k, (label, marks) in enumerate(rows):
        y = top + height * k
        svg.append(f'<text x="{left - 8}" y="{y + 4}" text-anchor="end">{html.escape(label)}</text>'
                   f'<line x1="{left}" x2="{left + width}" y1="{y}" y2="{y}" stroke="#eceff3"/>')
        for j, (key, _, colour) in enumerate(series):
            value = marks.get(key, math.nan)
            if math.isfinite(value) and value > 0:
                at = y + 3.5 * (j - (len(series) - 1) / 2)  # none hides another
                svg.append(f'<circle cx="{x(value):.1f}" cy="{at:.1f}" r="3.8" fill="{colour}">'
                           f'<title>{value:.3g}</title></circle>')
    svg.append(f'<text x="{left + width / 2}" y="{bottom + 34}" text-anchor="middle">{html.escape(axis)}</text></svg>')
    return "\n".join(svg) + "\n"


def picture(page, what, alternative, svg):
    """Written beside the page; the line that shows it."""
    if not svg:
        return []
    path = page.with_name(f"{page.stem}-{what}.svg")
    path.write_text(svg)
    return [f"![{alternative}]({path.name})", ""]


def log_lines(rows):
    lines = [f"- {row['name']}: {row['samples']} samples in {row['length_s']:.0f} s, fitted share {row['split']:g}."
             + "".join(f" {note[0].upper()}{note[1:]}." for note in row["notes"]) for row in rows if "error" not in row]
    return lines


def in_short(text):
    """Without the lines that only show the place again, or count."""
    said = [line for line in text.splitlines() if not re.match(r"\s(?!\s*hint:)|\d+ errors?$", line)]
    return "<br>".join(re.sub(r"^\s*hint: ", "", line) for line in said)


def failures(rows):
    lines = []
    for row in rows:
        errors = [("the log", row["error"])] if "error" in row else [
            (step, outcome["error"]) for step, outcome in row["outcomes"].items() if "error" in outcome]
        for text in dict.fromkeys(text for _, text in errors):
            lines.append([row["name"], ", ".join(step for step, other in errors if other == text), in_short(text)])
    return ["## What could not be run", "", *table(["log", "what", "why"], lines), ""] if lines else []


def write(path, described, rows, origin):
    """`origin`: by which table and which version of softgrip."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    good = [row for row in rows if "error" not in row]
    planned = len(described.logs)
    of_planned = f" {len(rows)} of the table's {planned} logs." if len(rows) < planned else ""
    lines = [f"# {described.title}", "",
             f"Written by `bench/measured.py` from {origin}.{of_planned} {described.about}", "", MEANING, ""]
    if good:
        shown = [(row["name"], {step: continuation(row, step) for step, _, _ in STRUCTURES}) for row in good]
        lines += ["## Foretold from the first part (continuation)", "",
                  *picture(path, "held-out", "Held-out error of every structure on every log",
                           dots(shown, STRUCTURES, "held-out RMSE (continuation), % of span")),
                  *held_out_table(good), ""]
    if any(result_of(row, "auto") for row in good):
        lines += ["## What the data chose", "", *chosen_table(good), ""]
    if any(True for _ in diagnoses(good)):
        shown = [(f"{row['name']}, {drive}", misfit(row, result)) for row, drive, result, _ in diagnoses(good)]
        lines += ["## Diagnosed", "", "The model given is what `softgrip identify` finds on the whole log. *share* is "
                  "what a cause explains of what the recalibrated model leaves beyond the noise, on interleaved "
                  "blocks; shares need not add up, for causes stand in for each other. *as identified*: with that "
                  "model's numbers and no zero fitted to the log. *inverse*: whether a controller can compute its "
                  "pressure from the extended model.", "",
                  *diagnosis_table(good), "", "## Where the misfit goes (interleaved blocks)", "",
                  *picture(path, "budget", "What each model leaves, and the noise",
                           dots(shown, MISFIT, "RMSE (interleaved blocks), % of span")), *budget_table(good), ""]
    lines += failures(rows)
    if good:
        lines += ["## Logs", "", *log_lines(good)]
    path.write_text("\n".join(lines).rstrip() + "\n")
