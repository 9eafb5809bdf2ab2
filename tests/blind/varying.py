"""Handles the run-to-run variation (variation.h): the options of a campaign, the keys of a world, the options of the
generator program, and the text for the page of the campaign."""

KEYS = ("variation", "closed_loop", "baseline_runs")  # keys of a world; worlds of earlier versions do not have them
BASELINE_RUNS = 3


def add_options(parser, baseline_runs=False):
    parser.add_argument("--variation", type=float, default=0.0,
                        help="strength of the run-to-run variation; 1: the usual, 0: none")
    parser.add_argument("--closed-loop", action="store_true", help="a controller plays the commands of the logs")
    if baseline_runs:
        parser.add_argument("--baseline-runs", type=int, nargs="+", default=[BASELINE_RUNS], help="healthy logs of a world")


def of_world(args, baseline_runs=BASELINE_RUNS):
    """Returns the keys that the options of this campaign add to a world."""
    keys = {}
    if getattr(args, "variation", 0):
        keys["variation"] = args.variation
    if getattr(args, "closed_loop", False):
        keys["closed_loop"] = True
    if baseline_runs != BASELINE_RUNS:
        keys["baseline_runs"] = baseline_runs
    return keys


def belongs(row, args):
    """Returns True if a row of the ledger and this campaign have the same variation and the same closed-loop
    setting."""
    own = of_world(args)
    return all(row.get(key) == own.get(key) for key in ("variation", "closed_loop"))


def of_generator(world, closed_loop=True):
    """Returns the options of the program that writes the logs of a world. If `closed_loop` is True, the options
    include the closed-loop setting of the world."""
    options = ["--variation", str(world["variation"])] if "variation" in world else []
    return [*options, "--closed-loop"] if closed_loop and world.get("closed_loop") else options


def text(args):
    """Returns the sentences that describe the variation on the page of the campaign."""
    closed = " A controller plays the commands of the logs (closed loop)." if getattr(args, "closed_loop", False) else ""
    strength = getattr(args, "variation", 0)
    if not strength:
        return "The simulated fingers have no run-to-run variation." + closed
    return (f"Run-to-run variation of strength {strength:g}: each run has its own offset (standard deviation 0.3 % of the "
            "span), gain (1 %), temperature (2 degrees) and supply (2 %), each times the strength, and its own sampling rate "
            "(50, 100 or 200 Hz), input signal and unsettled initial state." + closed)
