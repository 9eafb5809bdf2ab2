#!/usr/bin/python3
"""Compares changed and unchanged fingers with their healthy logs by `softgrip diagnose --healthy`.

    scripts/changed_campaign.py --work DIR [--build build/release] [--seeds 4] [--unchanged 60] [--strengths 0.15 1]
                                [--columns pressure command] [--first-seed 1] [--workers 2] [--most-minutes M]
                                [--variation X] [--closed-loop] [--baseline-runs 3]
                                [--page docs/results/changed-campaign.md]

--seeds counts per family, cause, strength and kind of columns. The worlds are from both families (tests/blind,
tests/blind/textbook), with and without measured pressure. The later logs differ from the healthy logs in the input
signal, in the zero offset (by up to 0.5 mm) and in the temperature (by up to 4 degrees). If the hidden cause is the
temperature, the temperatures do not differ. The script can be stopped and continued. The outcome of every world is one
line of DIR/changed.jsonl, and the finished worlds are always a fair sample. --variation X sets the strength of the
run-to-run variation (tests/blind/variation.h). --closed-loop records the later logs in closed loop. --baseline-runs 1
3 6 gives the same fingers these numbers of healthy logs. The page states these options.
"""
import collections
import itertools
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
for folder in ("tests/blind", "scripts"):
    sys.path.insert(0, str(ROOT / folder))

import campaign  # noqa: E402
import changing  # noqa: E402
import results_page  # noqa: E402
import varying  # noqa: E402
from results_page import interval  # noqa: E402
from ledger import Ledger  # noqa: E402

KEYS = ("family", "cause", "strength", "seed", "columns", "zero_mm", "warmer_c", *varying.KEYS)
OF_PRESSURE = {"leak", "blocked_line"}
NOISE_MM = 0.04  # standard deviation of the simulated sensors
REQUIRED = {0.15: 90, 1: 97}  # share of the causes that must be named first without run-to-run variation [%]
OUTCOMES = ("first", "twin", "listed", "wrong", "unnamed", "missed")


def causes_of(build, family, columns):
    listed = subprocess.run([build / changing.PROGRAM[family], "--list"], check=True, capture_output=True, text=True).stdout
    ids = [i for i in listed.split() if not i.startswith("outside_")] + (["blocked_line"] if family == "textbook" else [])
    return [i for i in ids if columns == "pressure" or i not in OF_PRESSURE]


def worlds(args, build):
    """Returns all planned worlds. For every N, the first N worlds are a fair sample of all worlds. The result of a
    world does not depend on the other worlds."""
    planned = []
    for family, columns in itertools.product(("textbook", "first"), args.columns):
        kinds = [("none", 0, args.unchanged // 2 // len(args.columns))]
        kinds += [(c, s, args.seeds) for c, s in itertools.product(causes_of(build, family, columns), args.strengths)]
        for cause, strength, count in kinds:
            rng = random.Random(f"{args.first_seed} {family} {cause} {strength} {columns}")
            for _ in range(count):
                warmer = 0 if cause == "thermal_gain" else round(rng.uniform(-4, 4), 2)
                world = {"family": family, "cause": cause, "strength": strength, "seed": rng.randrange(10**6),
                         "columns": columns, "zero_mm": round(rng.uniform(-0.5, 0.5), 3), "warmer_c": warmer}
                planned += [{**world, **varying.of_world(args, runs)} for runs in args.baseline_runs]
    random.Random(args.first_seed).shuffle(planned)
    return planned


def table(rows, keys, outcomes):
    lines = ["| " + " | ".join((*keys, "cases", *outcomes)) + " |", "|" + "---|" * (len(keys) + 1 + len(outcomes))]
    groups = collections.defaultdict(collections.Counter)
    for row in rows:
        groups[tuple(row[key] for key in keys)][row["outcome"]] += 1
    for group, counts in sorted(groups.items(), key=str):
        cells = [str(g) for g in group] + [str(sum(counts.values()))] + [str(counts[o]) for o in outcomes]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def with_runs(rows):
    """Returns the rows with this number of healthy logs."""
    return [{**row, "baseline runs": row.get("baseline_runs", varying.BASELINE_RUNS)} for row in rows]


def is_found(row):
    return row["outcome"] in ("first", "twin", "listed")


def smallest_found(changed):
    """Returns the smallest strength at which 90 % of the causes are named or listed, for each number of baseline
    runs."""
    lines = ["| baseline runs | smallest strength found in 90 % of the worlds |", "|---|---|"]
    for runs in sorted({row["baseline runs"] for row in changed}):
        smallest = "-"
        for strength in sorted({row["strength"] for row in changed}, reverse=True):
            own = [row for row in changed if (row["baseline runs"], row["strength"]) == (runs, strength)]
            if not own or sum(map(is_found, own)) < 0.9 * len(own):
                break
            smallest = f"{strength:g}"
        lines.append(f"| {runs} | {smallest} |")
    return lines


def by_change(changed):
    """Returns a table with the share of the causes that are named or listed, by the displacement change in the later
    logs and by the number of baseline runs. Rows without this change are left out."""
    limits = (0, 1, 2, 4, 8, 16, float("inf"))
    runs = sorted({row["baseline runs"] for row in changed})
    lines = ["| displacement change in the later logs | " +
             " | ".join(f"{count} baseline run{'s' * (count > 1)}: cause named or listed, cases" for count in runs) + " |",
             "|---|" + "---|" * len(runs)]
    for low, high in zip(limits, limits[1:]):
        cells = [f"{low} to {high} times the noise" if high < float("inf") else f"more than {low} times the noise"]
        for count in runs:
            own = [row for row in changed if row["baseline runs"] == count
                   and low * NOISE_MM < row.get("recorded_change_mm", 0) <= high * NOISE_MM]
            cells.append(f"{interval(sum(map(is_found, own)), len(own))}, {len(own)}" if own else "-")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def meaning(changed, still):
    def share(among, good):
        return interval(sum(r["outcome"] in good for r in among), len(among)).split(" (")[0]

    first = [f"{share([r for r in changed if r['strength'] == strength], ('first',))} of the cases with strength {strength:g}"
             for strength in sorted({r["strength"] for r in changed}, reverse=True)]
    return ("For simulated fingers that have changed since their healthy logs, the diagnosis names the true cause first in " +
            " and ".join(", ".join(first).rsplit(", ", 1)) + f". The diagnosis reports {share(still, ('unchanged',))} of the unchanged "
            "fingers as unchanged.")


def page(rows, command, planned, variation, version):
    rows = with_runs(rows)
    judged = [r for r in rows if r["outcome"] != "failed"]
    changed = [r for r in judged if r["cause"] != "none" and changing.is_changed(r)]
    still = [r for r in judged if r not in changed]
    failed = sum(r["outcome"] == "failed" for r in rows)
    stopped = (" The campaign was stopped before its end, so the simulated cases are a random sample of the planned cases."
               if len(rows) < planned else "")
    varied = any("variation" in r for r in rows)
    title = "Campaign of changed fingers" + (" with run-to-run variation" if varied else "")
    lines = [*results_page.head(title, meaning(changed, still), version, command,
                                f"{len(rows)} of {planned} planned cases were simulated, and {failed} of these cases failed.{stopped}"),
             *changing_text(), "", variation, *absent_text(still), "", "| measure | required | measured (95 % interval) | number of cases |", "|---|---|---|---|"]
    for strength in sorted({r["strength"] for r in changed}):
        own = [r for r in changed if r["strength"] == strength]
        wanted = None if varied else REQUIRED.get(strength)
        for name, good in (("true cause named first", ("first",)), ("true cause named first, or outcome `twin`", ("first", "twin")),
                           ("true cause named or listed", ("first", "twin", "listed"))):
            lines.append(f"| strength {strength:g}: {name} | {f'at least {wanted} %' if wanted and len(good) == 1 else '-'} | "
                         f"{interval(sum(r['outcome'] in good for r in own), len(own))} | {len(own)} |")
        lines.append(f"| strength {strength:g}: only a wrong cause is named | - | "
                     f"{interval(sum(r['outcome'] == 'wrong' for r in own), len(own))} | {len(own)} |")
    told = [one["held"] for r in changed for one in r["intervals"]]
    lines.append(f"| 95 % intervals that contain the true value | 92 to 97 % | {interval(sum(told), len(told))} | {len(told)} |")
    lines.append("| unchanged fingers that are reported as unchanged | at least 98 % | "
                 f"{interval(sum(r['outcome'] == 'unchanged' for r in still), len(still))} | {len(still)} |")
    if len({row["baseline runs"] for row in rows}) > 1:
        lines += ["", "## By baseline runs", "", *smallest_found(changed), "", *by_change(changed), "",
                  *table(changed, ("baseline runs", "strength"), OUTCOMES), "",
                  *table(still, ("baseline runs",), ("unchanged", "false_alarm", "unexplained"))]
    lines += ["", "## By family and recorded signals (`command`: no measured pressure; `pressure`: measured pressure)", "", *table(changed, ("family", "columns", "strength"), OUTCOMES), "",
              *table(still, ("family", "columns"), ("unchanged", "false_alarm", "unexplained")), "",
              "## By cause", "", *table(changed, ("cause", "strength"), OUTCOMES), "", "## Cases without the true cause named first", "",
              "| hidden cause | strength | family | columns | seed | outcome | verdict | named causes |", "|---|---|---|---|---|---|---|---|"]
    for row in sorted((r for r in changed + still if r["outcome"] not in ("first", "unchanged")), key=lambda r: r["cause"]):
        lines.append(f"| {row['cause']} | {row['strength']} | {row['family']} | {row['columns']} | {row['seed']} | "
                     f"{row['outcome']} | {row['verdict']} | {', '.join(row['named'])} |")
    return "\n".join(lines) + "\n"


def absent_text(still):
    """Returns the sentences about the cases whose hidden cause does not change the later logs."""
    absent = sum(r["cause"] != "none" for r in still)
    return [f"In {absent} cases with a hidden cause, the later logs are the same as without the cause, for example because the "
            "commands do not reach a limit. These cases are counted as unchanged fingers."] if absent else []


def changing_text():
    return [
        "In each case, the healthy logs of a finger are simulated without a hidden cause. The number of healthy logs per finger",
        "is 3, if a table of this page states no other number. The later logs of the finger have different waveforms and",
        "different noise than the healthy logs, and contain one hidden cause or no cause. The excess error of a change is the",
        "RMS of the displacement change that a refit of the model cannot absorb. With strength 1, the excess error is 0.32 mm,",
        "which is 8 times the sensor noise of 0.04 mm. The pages of the other campaigns call this excess error strength 8. The",
        "excess error is proportional to the strength. It is computed for three logs without run-to-run variation. The",
        "displacement change is the RMS change of the displacement by the cause in the later logs, after the mean change of",
        "each log is subtracted. The zero offset of the sensor is not equal in the healthy and in the later logs. The",
        "temperature also differs, except in the cases with the cause `thermal_gain`. The outcome `first` means that the true",
        "cause is named first. The outcome `twin` means that stiffening is named first although the sensor scale is nonlinear,",
        "or that a nonlinear sensor scale is named although the finger stiffens. The outcome `listed` means that the true cause",
        "is named after a wrong cause, or is listed as an alternative. The outcome `unnamed` means that a change is reported,",
        "but no cause is named. The outcome `missed` means that the finger is reported as unchanged. The outcome `wrong` means",
        "that only a wrong cause is named. The coverage of the confidence intervals is computed for changes whose true cause is",
        "named first, and for parameters that have the same meaning in the simulation and in the result. The cases of the",
        "family `first` are simulated as in the [blind campaign](blind-campaign.md), and the cases of the family `textbook` as",
        "in the [textbook campaign](textbook-campaign.md). The simulated valve of the family `textbook` and the pressure",
        "regulator in the models of softgrip use the same equations (ISO 6358, a controller with integral action). The cases of",
        "the family `textbook` therefore do not show the performance on a valve that does not follow ISO 6358."]


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--unchanged", type=int, default=60)
    parser.add_argument("--strengths", type=float, nargs="+", default=[0.15, 1])
    parser.add_argument("--columns", nargs="+", default=["pressure", "command"])
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--most-minutes", type=float)
    varying.add_options(parser, baseline_runs=True)
    args = parser.parse_args()
    build = args.build
    ledger = Ledger(args.work / "changed.jsonl", KEYS)
    planned = worlds(args, build)
    campaign.run(ledger, planned, "changing", args,
                 lambda world, result: f"{world['family']} {world['columns']} {world['cause']} {world['strength']:g}: "
                 f"{result['outcome']} {result.get('named', '')} {result.get('wall_s', 0):.0f} s")
    if args.page:
        command = campaign.command("scripts/changed_campaign.py", parser, args,
                                   ("seeds", "unchanged", "strengths", "columns", "first_seed", "variation",
                                    "closed_loop", "baseline_runs"))
        wanted = {ledger.key(world) for world in planned}
        rows = [row for row in ledger.rows if ledger.key(row) in wanted]
        args.page.write_text(page(rows, command, len(planned), varying.text(args), results_page.version_of(build)))


if __name__ == "__main__":
    main()
