#!/usr/bin/python3
"""Resolves ambiguous diagnoses with `softgrip investigate`, with simulated worlds (tests/blind) as the rig.

    scripts/blind_investigation.py --work DIR [--build build/release] [--campaign DIR] [--seeds 5] [--strengths 8 2]
                                   [--causes ID ...] [--first-seed 3000] [--page docs/results/blind-investigation.md]

The script uses the ambiguous worlds of a campaign (scripts/blind_campaign.py --work DIR) and new worlds. A new world
first writes a single log of triangles, because many diagnoses of such a log are ambiguous. If the diagnosis lists the
true cause among its alternatives, the investigation plays the proposed experiments on the same world. If no waveform
separates the causes, the investigation checks the sensor of the world against a gauge. The script can be resumed, like
scripts/blind_campaign.py.
"""
import collections
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/blind"))
sys.path.insert(0, str(ROOT / "scripts"))

import judging  # noqa: E402
import results_page  # noqa: E402
from blind_page import interval  # noqa: E402
from investigating import investigate_world, is_indistinguishable  # noqa: E402
from ledger import Ledger  # noqa: E402


def worlds(args, ids):
    if args.campaign:
        for line in (args.campaign / "results.jsonl").read_text().splitlines():
            row = json.loads(line)
            if row["outcome"] == "ambiguous_right":
                yield {key: row[key] for key in ("causes", "strength", "seed")} | {"poor": False}
    for k in range(args.seeds):
        for strength in args.strengths:
            for cause in args.causes or ids:
                yield {"causes": [cause], "strength": strength, "seed": args.first_seed + k, "poor": True}


def share(part, whole):
    return f"{len(part)} of {len(whole)}, {interval(len(part), len(whole))}"


def page(results, command, version):
    asked = [r for r in results if r["outcome"] != "not_ambiguous"]
    resolved = [r for r in asked if r["outcome"] == "right"]
    by_gauge = [r for r in resolved if r["resolved_by"] == "gauge_check"]
    wrong = [r for r in asked if r["outcome"] == "wrong"]
    open_still = [r for r in asked if r["outcome"] == "ambiguous_right"]
    twins = [r for r in open_still if is_indistinguishable(r)]
    others = [r for r in asked if r not in resolved and r not in wrong and r not in open_still]
    meaning = (f"For {len(resolved)} of {len(asked)} ambiguous diagnoses of simulated fingers, `softgrip investigate` finds the true cause by "
               f"further experiments or a gauge check. In {len(wrong)} cases, `softgrip investigate` finds a wrong cause.")
    lines = [*results_page.head("Blind investigations", meaning, version, command,
                                f"{sum(not r['poor'] for r in results)} ambiguous cases of the campaign and "
                                f"{sum(r['poor'] for r in results)} cases with a single log of triangles"),
             f"In {len(asked)} cases, the first diagnosis was ambiguous and listed the true cause. For each of the {len(asked)} cases, `softgrip investigate` was run with the simulated finger in place of a rig. The gauge check of the sensor was also simulated. In the simulated gauge check, the position of the sensor's target has "
             "an error of 0.01 mm (standard deviation). Each reading of the gauge check is the mean over 2 s, and has the noise, quantisation, drift, disturbances and wrong samples of the simulated case.", "",
             "| result of `softgrip investigate` for a case with an ambiguous first diagnosis | number of cases, and percentage with its 95 % interval |",
             "|---|---|",
             f"| `investigate` finds the true cause | {share(resolved, asked)} |",
             f"| `investigate` finds the true cause by an experiment with a waveform | {len(resolved) - len(by_gauge)} |",
             f"| `investigate` finds the true cause by the gauge check | {len(by_gauge)} |",
             f"| `investigate` finds a wrong cause | {share(wrong, asked)} |",
             f"| the last diagnosis is ambiguous and lists the true cause | {len(open_still)} |",
             f"| the last diagnosis is ambiguous, because no experiment and no gauge check can separate the causes (lags of valve and sensor) | {len(twins)} |",
             f"| all other results of an investigation (verdict `unexplained` or `partly_explained`, or a failed run) | {len(others)} |", ""]
    for title, chosen in (("cases of the campaign", [r for r in asked if not r["poor"]]),
                          ("cases with one log of triangles", [r for r in asked if r["poor"]])):
        if chosen:
            lines += [f"For {title}, `investigate` finds the true cause in "
                      f"{share([r for r in chosen if r['outcome'] == 'right'], chosen)}.", ""]
    lines += ["| hidden cause | strength | seed | logs | causes of the first diagnosis | causes of the last diagnosis | experiments | rig time [min] | outcome |",
              "|---|---|---|---|---|---|---|---|---|"]
    for r in sorted(asked, key=lambda r: (r["poor"], r["causes"], -r["strength"], r["seed"])):
        before = "; ".join(" or ".join(one) for one in r.get("rivals", []))
        after = "; ".join(" or ".join(one) for one in r.get("after", []))
        lines.append(f"| {'+'.join(r['causes'])} | {r['strength']:g} | {r['seed']} | "
                     f"{'triangles' if r['poor'] else 'three'} | {before} | {after} | "
                     f"{', '.join(r.get('played', [])) or '-'} | {r.get('minutes', 0):.1f} | {r['outcome']} |")
    counts = collections.Counter(r["before"] for r in results if "before" in r)
    lines += ["", "Number of first diagnoses for each outcome: " + ", ".join(f"{k} {v}" for k, v in counts.most_common()) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--campaign", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--strengths", type=float, nargs="+", default=[8, 2])
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--first-seed", type=int, default=3000)
    parser.add_argument("--no-gauge", action="store_true", help="waveforms alone")
    args = parser.parse_args()
    ledger = Ledger(args.work / "investigations.jsonl", ("causes", "strength", "seed", "poor"))
    ids, _ = judging.library(args.build)
    for world in worlds(args, ids):
        if world in ledger:
            continue
        result = investigate_world(args.build, args.work, world, not args.no_gauge)
        ledger.add(result)
        print(f"{'+'.join(world['causes'])} {world['strength']:g} seed {world['seed']}: {result.get('before')} "
              f"{result.get('rivals')} -> {result['outcome']} {result.get('after', '')} {result.get('played', '')} "
              f"{result.get('end', '')} "
              f"{result.get('message', '')}", flush=True)
    if args.page:
        campaign = " --campaign DIR" if args.campaign else ""
        args.page.write_text(page(ledger.rows, f"scripts/blind_investigation.py --work DIR{campaign} --seeds {args.seeds} "
                                           f"--first-seed {args.first_seed} --page {args.page}",
                                  results_page.version_of(args.build)))


if __name__ == "__main__":
    main()
