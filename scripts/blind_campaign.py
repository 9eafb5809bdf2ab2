#!/usr/bin/python3
"""Simulates worlds with hidden effects (tests/blind), diagnoses them with `softgrip diagnose`, and counts the
outcomes.

    scripts/blind_campaign.py --work DIR [--build build/release] [--seeds 20] [--clean 200] [--outside 60] [--pairs 60]
                              [--strengths 8 2] [--causes ID ...] [--first-seed 1000] [--workers 1]
                              [--variation X] [--closed-loop] [--page docs/results/blind-campaign.md]

--variation X sets the strength of the run-to-run variation (tests/blind/variation.h). The page states the strength.
The campaign can be resumed: the outcome of every world is one line of DIR/results.jsonl, and the script skips worlds
in this file. --page writes the page with the table. It also writes the pictures to the folder of the page.
"""
import itertools
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/blind"))
sys.path.insert(0, str(ROOT / "scripts"))

import blind_page  # noqa: E402
import results_page  # noqa: E402
import campaign  # noqa: E402
import judging  # noqa: E402
import varying  # noqa: E402
from ledger import Ledger  # noqa: E402

# Pairs of causes whose readings are almost equal for every command. If both causes of a pair are hidden in a world, no
# data can separate them.
TWINS = [{"valve_lag", "sensor_lag", "transport_delay"}, {"stiffening", "sensor_nonlinearity"},
         {"pressure_saturation", "sensor_saturation", "contact"}, {"thermal_gain", "ageing"}]


def pairs(ids, count, seed):
    possible = [pair for pair in itertools.combinations(ids, 2) if not any(set(pair) <= twins for twins in TWINS)]
    return random.Random(seed).sample(possible, min(count, len(possible)))


def worlds(args, ids, outside):
    """Sorts the worlds so that all kinds alternate. An interrupted campaign then contains worlds of every kind."""
    kinds = []
    for cause, strength in itertools.product(args.causes or ids, args.strengths):
        kinds.append([([cause], strength)] * args.seeds)
    kinds.append([([], 0)] * args.clean)
    if not args.causes:
        kinds.append([([outside[k % len(outside)]], args.strengths[0]) for k in range(args.outside)])
        kinds.append([(list(pair), args.strengths[0]) for pair in pairs(ids, args.pairs, args.first_seed)])
    longest = max(len(kind) for kind in kinds)
    placed = []
    for kind in kinds:
        placed += [((k + 0.5) / len(kind) if len(kind) else 0, k, *what) for k, what in enumerate(kind)]
    placed.sort(key=lambda p: p[0])
    for _, k, causes, strength in placed[: longest * len(kinds)]:
        yield {"causes": causes, "strength": strength, "seed": args.first_seed + k, **varying.of_world(args)}


def told(world, result):
    return (f"{'+'.join(world['causes']) or 'clean'} {world['strength']:g} seed {world['seed']}: {result['outcome']} "
            f"{', '.join(result.get('named', []))} {result.get('rivals') if result['outcome'] == 'ambiguous_right' else ''}")


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--clean", type=int, default=200)
    parser.add_argument("--outside", type=int, default=60)
    parser.add_argument("--pairs", type=int, default=60)
    parser.add_argument("--strengths", type=float, nargs="+", default=[8, 2])
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--most-minutes", type=float, help="start no further simulated case after this time; run the script again to continue")
    parser.add_argument("--workers", type=int, default=1, help="number of diagnoses that run in parallel")
    varying.add_options(parser)
    args = parser.parse_args()
    ledger = Ledger(args.work / "results.jsonl", ("causes", "strength", "seed", *varying.KEYS))
    ids, outside = judging.library(args.build)
    planned = list(worlds(args, ids, outside))
    campaign.run(ledger, planned, "judging", args, told)
    if args.page:
        command = campaign.command("scripts/blind_campaign.py", parser, args, (
            "first_seed", "seeds", "clean", "outside", "pairs", "strengths", "causes", "variation", "closed_loop"))
        rows = [row for row in ledger.rows if varying.belongs(row, args)]
        keys = {ledger.key(world) for world in (*planned, *rows)}
        blind_page.write(args.page, rows, len(keys), command, varying.text(args), results_page.version_of(args.build))


if __name__ == "__main__":
    main()
