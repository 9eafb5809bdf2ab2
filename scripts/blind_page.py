"""Writes the page of the blind campaign. Tables and two pictures (SVG) show which causes were found at each
strength."""
import collections
import fractions
import html
import math
import pathlib
import random
import statistics

import results_page
from judging import is_outside
from results_page import interval

OUTCOMES = [("right", "#2e7d4f"), ("ambiguous_right", "#8fbf9a"), ("partly", "#c9b458"), ("missed", "#b9bec6"),
            ("unexplained", "#8a93a3"), ("wrong", "#b3372e"), ("failed", "#000000")]
WORDS = {"ambiguous_right": "ambiguous, truth listed", "partly": "some of them"}


def group_of(result):
    causes = result["causes"]
    if not causes:
        return "clean"
    if len(causes) > 1:
        return {2: "two causes", 3: "three causes"}[len(causes)]
    return causes[0]


def share(rows, *outcomes):
    return 100 * sum(r["outcome"] in outcomes for r in rows) / len(rows) if rows else math.nan


def interval_by_seed(hits):
    """Returns the share [%] of hits among pairs (seed, hit), with its 95 % interval. The interval is a bootstrap over
    the seeds with 4,000 resamples. Worlds of one seed share their noise and actuator, so their errors are
    correlated."""
    seeds = collections.defaultdict(list)
    for seed, hit in hits:
        seeds[seed].append(bool(hit))
    groups = [(sum(of), len(of)) for of in seeds.values()]
    draw = random.Random(1)
    shares = []
    for _ in range(4000):
        drawn = draw.choices(groups, k=len(groups))
        shares.append(100 * sum(held for held, _ in drawn) / sum(count for _, count in drawn))
    lower, *_, upper = statistics.quantiles(shares, n=40)
    return f"{100 * sum(held for held, _ in groups) / len(hits):.1f} % ({lower:.1f} .. {upper:.1f}, by seeds)"


def summary(results):
    """Returns the rows of the table: (measure, target, value with its interval, number of worlds)."""
    singles = [r for r in results if len(r["causes"]) == 1 and not is_outside(r["causes"][0])]
    clean = [r for r in results if not r["causes"]]
    outside = [r for r in results if r["causes"] and is_outside(r["causes"][0])]
    pairs = [r for r in results if len(r["causes"]) > 1]
    rows = []

    def row(what, target, among, *outcomes):
        if among:
            rows.append((what, target, interval(sum(r["outcome"] in outcomes for r in among), len(among)), len(among)))

    for strength, target in ((8, "at least 98 %"), (2, "at least 90 %")):
        among = [r for r in singles if r["strength"] == strength]
        row(f"true cause named, or listed in an ambiguous verdict, at strength {strength}", target, among, "right",
            "ambiguous_right")
        row(f"true cause named without alternatives, at strength {strength}", "-", among, "right")
        row(f"wrong cause named, at strength {strength}", "at most 2 %", among, "wrong")
    row("cases without an effect: a cause is named (false alarms)", "at most 2 %", clean, "wrong")
    row("cases without an effect: an unexplained error is reported", "-", clean, "unexplained")
    row("effects that softgrip does not model: a wrong cause is named", "at most 5 %", outside, "wrong")
    row("effects that softgrip does not model: verdict `unexplained`, or only a suitable cause is named", "-", outside, "right")
    row("cases with two effects: both effects are found", "at least 80 %", pairs, "right", "ambiguous_right")
    held = [(r["seed"], value) for r in results if r["outcome"] == "right" for value in r.get("covered", {}).values()]
    if held:
        rows.append(("95 % intervals of parameters that contain the true value, in cases with the outcome *right*", "90 to 98 %",
                     interval_by_seed(held), len(held)))
    return rows


def by_group(results):
    groups = collections.defaultdict(list)
    for r in results:
        groups[(group_of(r), r["strength"])].append(r)
    return sorted(groups.items(), key=lambda item: (is_outside(item[0][0]), item[0][0] in ("clean", "two causes", "three causes"),
                                                    item[0][0], -item[0][1]))


def bars(results):
    """Draws stacked bars of the outcomes for each hidden cause and strength."""
    rows = by_group(results)
    height, left, width = 15, 250, 460
    total = 46 + height * len(rows)
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + width + 60} {total}" font-family="sans-serif" '
           'font-size="11"><rect width="100%" height="100%" fill="white"/>']
    x = 10
    for outcome, colour in OUTCOMES[:6]:
        svg.append(f'<rect x="{x}" y="10" width="10" height="10" fill="{colour}"/>'
                   f'<text x="{x + 14}" y="19">{WORDS.get(outcome, outcome)}</text>')
        x += 40 + 6.3 * len(WORDS.get(outcome, outcome))
    for k, ((name, strength), among) in enumerate(rows):
        y = 34 + height * k
        label = html.escape(f"{name}, {strength:g} x noise" if strength else name)
        svg.append(f'<text x="{left - 6}" y="{y + 10}" text-anchor="end">{label}</text>')
        at = left
        for outcome, colour in OUTCOMES:
            part = sum(r["outcome"] == outcome for r in among) / len(among) * width
            if part:
                svg.append(f'<rect x="{at:.1f}" y="{y}" width="{part:.1f}" height="{height - 3}" fill="{colour}"/>')
            at += part
        svg.append(f'<text x="{left + width + 6}" y="{y + 10}">n = {len(among)}</text>')
    return "\n".join(svg) + "\n</svg>\n"


def confusion(results):
    """Draws a matrix of the hidden causes and the named causes, over all strengths. If a world has several named
    causes or alternatives, it counts for each of them with a fraction."""
    singles = [r for r in results if len(r["causes"]) == 1]
    hidden = sorted({r["causes"][0] for r in singles}, key=lambda c: (is_outside(c), c)) + ["nothing"]
    named = [c for c in hidden if c != "nothing" and not is_outside(c)] + ["nothing", "unexplained"]
    table = {row: collections.Counter() for row in hidden}
    for r in singles + [r for r in results if not r["causes"]]:
        row = table[r["causes"][0] if r["causes"] else "nothing"]
        if not r.get("named"):
            row["unexplained" if r.get("verdict") == "unexplained" else "nothing"] += 1
            continue
        for cause, rivals in zip(r["named"], r["rivals"]):
            for one in [cause, *rivals]:
                # Use fractions, so that the sum does not depend on the order of the rows.
                row[one] += fractions.Fraction(1, len(r["named"]) * (1 + len(rivals)))
    size, left, top = 21, 190, 175
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + size * len(named) + 45} '
           f'{top + size * len(hidden) + 20}" font-family="sans-serif" font-size="11">'
           '<rect width="100%" height="100%" fill="white"/>'
           f'<text x="10" y="{top - 10}">hidden</text><text x="{left - 50}" y="20">named</text>']
    for j, name in enumerate(named):
        x = left + size * j + 14
        svg.append(f'<text transform="translate({x},{top - 6}) rotate(-60)">{name}</text>')
    for i, row in enumerate(hidden):
        y = top + size * i
        svg.append(f'<text x="{left - 6}" y="{y + 14}" text-anchor="end">{row}</text>')
        count = sum(table[row].values())
        for j, name in enumerate(named):
            part = float(table[row][name] / count) if count else 0
            x = left + size * j
            right = name == row or (is_outside(row) and name == "unexplained")
            colour = "46,125,79" if right else "70,80,100"
            svg.append(f'<rect x="{x}" y="{y}" width="{size - 1}" height="{size - 1}" '
                       f'fill="rgba({colour},{max(0.04, part):.2f})"/>')
            if part >= 0.005:
                ink = "white" if part > 0.5 else "black"
                svg.append(f'<text x="{x + 10}" y="{y + 14}" text-anchor="middle" font-size="9" fill="{ink}">'
                           f'{100 * part:.0f}</text>')
    return "\n".join(svg) + "\n</svg>\n"


def detection_limits(results):
    """Returns two results for each cause: the fraction of worlds in which it was found at each strength, and the
    smallest strength at which it was found in 90 % of the worlds."""
    singles = [r for r in results if len(r["causes"]) == 1 and not is_outside(r["causes"][0])]
    strengths = sorted({r["strength"] for r in singles}, reverse=True)
    lines = ["| cause | " + " | ".join(f"found at strength {s:g}" for s in strengths) + " | smallest strength at which the cause is found in at least 90 % of the cases |",
             "|---|" + "---|" * (len(strengths) + 1)]
    for cause in sorted({r["causes"][0] for r in singles}):
        rates = {s: share([r for r in singles if r["causes"][0] == cause and r["strength"] == s], "right",
                          "ambiguous_right") for s in strengths}
        limit = None
        for s in strengths:
            if not rates[s] >= 90:
                break
            limit = s
        cells = " | ".join("-" if math.isnan(rates[s]) else f"{rates[s]:.0f} %" for s in strengths)
        lines.append(f"| {cause} | {cells} | {f'{limit:g}' if limit else 'not reached'} |")
    return lines


def table(results):
    lines = ["| hidden cause | strength | number of cases | right | ambiguous, true cause listed | partly | missed, unexplained or failed | wrong | causes that are named instead |",
             "|---|---|---|---|---|---|---|---|---|"]
    for (name, strength), rows in by_group(results):
        count = collections.Counter(r["outcome"] for r in rows)
        instead = collections.Counter("+".join(r.get("named", [])) for r in rows if r["outcome"] == "wrong")
        lines.append(f"| {name} | {strength:g} | {len(rows)} | {count['right']} | {count['ambiguous_right']} | "
                     f"{count['partly']} | {count['missed'] + count['failed'] + count['unexplained']} | "
                     f"{count['wrong']} | {', '.join(f'{n} ({k})' for n, k in instead.most_common())} |")
    return lines


def meaning(rows):
    measured = {what: text.split(" (")[0] for what, _, text, _ in rows}
    found = [measured.get(f"true cause named, or listed in an ambiguous verdict, at strength {strength}", "-") for strength in (8, 2)]
    return (f"If a hidden effect in a simulated finger causes an error of 8 times the sensor noise, the diagnosis names or lists the "
            f"true cause in {found[0]} of the cases. With an error of 2 times the sensor noise, it names or lists the true cause in "
            f"{found[1]} of the cases. If softgrip does not model the effect, the diagnosis wrongly names a cause in "
            f"{measured.get('effects that softgrip does not model: a wrong cause is named', '-')} of the cases.")


def write(path, results, planned, command, variation, version):
    """Writes the page. `variation` contains the sentences about the run-to-run variation."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    bars_path, confusion_path = (path.with_name(f"{path.stem}-{what}.svg") for what in ("outcomes", "confusion"))
    bars_path.write_text(bars(results))
    confusion_path.write_text(confusion(results))
    of_planned = f" of {planned} planned (it was stopped before the end)" if len(results) < planned else ""
    unreachable = sum(not r.get("reachable", True) for r in results)
    lines = [*results_page.head("Blind campaign", meaning(summary(results)), version, command,
                                f"{len(results)} simulated cases{of_planned}"),
             "In each case, a separate program simulates a finger and writes logs; most fingers have a hidden effect. `softgrip diagnose` reads the logs and a model of the finger without the effect. The parameters of the model deviate from the parameters of the simulated finger by a few per cent. The strength of an effect is the RMS of the displacement change that the effect causes, divided by the sensor noise (0.04 mm). The part of the displacement change that a refit of the model parameters can explain is subtracted before the RMS is computed.",
             "", variation, "", "| measure | target | measured (95 % interval) | number of cases |", "|---|---|---|---|"]
    lines += [f"| {what} | {target} | {measured} | {count} |" for what, target, measured, count in summary(results)]
    walls = [r["wall_s"] for r in results if "wall_s" in r]
    lines += ["", f"The median wall time of a diagnosis of three logs of 8,000 samples was {statistics.median(walls):.1f} s. In "
              f"{unreachable} cases, the effect cannot physically reach the required strength, and has its largest possible size.",
              "", f"![Outcomes by hidden cause]({bars_path.name})", "",
              f"![Named cause by hidden cause, in percent]({confusion_path.name})", "", "A cause is counted as found if it is named alone or is listed in an ambiguous verdict.", "",
              *detection_limits(results), "", *table(results), "",
              "An outcome is *right* if exactly the true causes are named, each without an alternative. In a case without an effect (*clean*), an outcome is right if no cause is named and no error remains unexplained. "
              "In a case with an effect that softgrip does not model (*outside*), an outcome is right if the verdict is `unexplained`, or if only the cause is named that describes the effect correctly "
              "(`valve_lag` for `outside_fill_vent_lag`, `hysteresis_shape` for `outside_stop_operators`). An outcome is *partly* right if only some of several true causes are named or listed. "
              "An outcome is *missed* if no cause is named although the finger has an effect. An outcome is *unexplained* if "
              "the finger has no effect, but an error remains unexplained. A case is *failed* if the diagnosis gives no result. An outcome is *wrong* if the finger has neither a named cause nor any of its alternatives, "
              "also if the true cause is named as well."]
    path.write_text("\n".join(lines) + "\n")
