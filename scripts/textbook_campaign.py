#!/usr/bin/python3
"""Diagnoses simulated worlds with textbook equations (tests/blind/textbook) by `softgrip diagnose`. The worlds have
or do not have a hidden effect.

    scripts/textbook_campaign.py --work DIR [--build build/release] [--clean 100] [--seeds 4] [--pairs 40] [--triples 20]
                                 [--strengths 8 4 2] [--columns pressure command] [--given plain] [--first-seed 1000]
                                 [--workers 2] [--variation X] [--closed-loop]
                                 [--page docs/results/textbook-campaign.md]

--seeds counts per cause, strength and kind of columns; --clean, --pairs and --triples count per kind of columns. The
campaign can be resumed: the outcome of every world is one line of DIR/textbook.jsonl, and the script skips worlds
in this file. At any time, the finished worlds are a fair sample of all planned worlds. --page writes the page with the
tables, and the pictures to the folder of the page. With --most-minutes 0, the page is written from the finished worlds
alone. --variation X sets the strength of the run-to-run variation (tests/blind/variation.h). The page states the
strength.
"""
import itertools
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
for folder in ("tests/blind", "tests/blind/textbook", "scripts"):
    sys.path.insert(0, str(ROOT / folder))

import campaign  # noqa: E402
import results_page  # noqa: E402
import textbook_page  # noqa: E402
import trial  # noqa: E402
import varying  # noqa: E402
from blind_campaign import TWINS  # noqa: E402
from ledger import Ledger  # noqa: E402

KEYS = ("causes", "strength", "seed", "make", "columns", "given", *varying.KEYS)


def groups_of(ids, size, count, rng):
    """Returns sets of causes. No set contains two causes that give almost the same readings."""
    possible = [group for group in itertools.combinations(ids, size)
                if not any(len(twins & {*group}) > 1 for twins in TWINS)]
    return rng.sample(possible, min(count, len(possible)))


def worlds(args, ids, makes):
    """Returns all planned worlds. For every N, the first N worlds are a fair sample of all worlds. The result of a
    world does not depend on the other worlds."""
    planned = []
    for columns in args.columns:
        # If the pressure is not measured, a leak looks like a smaller gain of the finger.
        visible = [cause for cause in ids if cause != "leak" or columns == "pressure"]
        kinds = [([], 0, args.clean)]
        kinds += [([cause], strength, args.seeds)
                  for cause, strength in itertools.product(args.causes or visible, args.strengths)]
        if not args.causes:
            for size, count in ((2, args.pairs), (3, args.triples)):
                groups = groups_of(visible, size, count, random.Random(f"{args.first_seed} {size} {columns}"))
                kinds += [(list(group), args.strengths[k % len(args.strengths)], 1) for k, group in enumerate(groups)]
        for causes, strength, count in kinds:
            rng = random.Random(f"{args.first_seed} {causes} {strength} {columns}")
            turn = rng.randrange(len(makes))
            for number in range(count):
                world = {"causes": causes, "strength": strength, "seed": rng.randrange(10**6),
                         "make": makes[(turn + number) % len(makes)], "columns": columns, **varying.of_world(args)}
                planned += [{**world, "given": given} for given in args.given]
    random.Random(args.first_seed).shuffle(planned)
    return planned


def called(world):
    return (f"{'+'.join(world['causes']) or 'clean'} {world['strength']:g} {world['make']} {world['columns']} "
            f"{world['given']} seed {world['seed']}")


def told(world, result):
    return (f"{called(world)}: {result['outcome']}, named {', '.join(result.get('named', [])) or 'nothing'}"
            f"{', wrong ' + ', '.join(result['wrong']) if result.get('wrong') else ''}")


def main():
    parser = results_page.arguments(__doc__, work=True)
    parser.add_argument("--clean", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--pairs", type=int, default=40)
    parser.add_argument("--triples", type=int, default=20)
    parser.add_argument("--strengths", type=float, nargs="+", default=[8, 4, 2])
    parser.add_argument("--causes", nargs="+")
    parser.add_argument("--columns", nargs="+", choices=["pressure", "command"], default=["pressure", "command"])
    parser.add_argument("--given", nargs="+", choices=["plain", "commissioned"], default=["plain"])
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--most-minutes", type=float, help="start no further simulated case after this time; run the script again to continue")
    parser.add_argument("--workers", type=int, default=1, help="number of diagnoses that run in parallel, each on one core")
    varying.add_options(parser)
    args = parser.parse_args()
    ledger = Ledger(args.work / "textbook.jsonl", KEYS)
    planned = worlds(args, trial.listed(args.build, "--list"), trial.listed(args.build, "--makes"))
    campaign.run(ledger, planned, "trial", args, told)
    if args.page:
        command = campaign.command("scripts/textbook_campaign.py", parser, args, (
            "clean", "seeds", "pairs", "triples", "strengths", "columns", "given", "causes", "first_seed",
            "variation", "closed_loop"))
        rows = [row for row in ledger.rows if varying.belongs(row, args)]
        keys = {ledger.key(world) for world in (*planned, *rows)}
        textbook_page.write(args.page, rows, len(keys), command, varying.text(args), results_page.version_of(args.build))


if __name__ == "__main__":
    main()
