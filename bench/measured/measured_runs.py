"""What is run on one measured log: identifications, a fit by scipy, diagnoses. Each outcome is kept in a file, with a
checksum of all that it depends on, so that what was done is not done again."""
import json
import pathlib
import re
import sys

from outcomes import Failed, checksum, outcome_in, output_of

BENCH = pathlib.Path(__file__).resolve().parent.parent
SCIPY = BENCH / "foreign/scipy_bouc_wen.py"
SIMULATOR = BENCH / "sysid_peer_simulator.c"
STRUCTURES = ("auto", "bouc_wen", "prandtl_ishlinskii")
REFUSED = 3


class Runs:
    """All runs on one log; `folder` holds it as log.csv."""

    def __init__(self, entry, log, folder, options):
        self.entry, self.log, self.folder, self.options = entry, log, folder, options
        self.file = folder / "log.csv"
        self.two_stages = "pressure" in entry.columns and "command" in entry.columns

    def steps(self):
        """(name, function, what its outcome depends on besides the log), in the order in which they must be run."""
        program = self.options.program_checksum
        share = ("--fit-share", f"{self.entry.split:g}")
        drives = ["command", "measured"] if self.two_stages else [self.finger_drive()]
        steps = [("identify", lambda out: self.identify(out, self.finger_drive(), *share), (program, *share))]
        for structure in STRUCTURES:
            words = ("--structure", structure, *share)
            # Where both are recorded, command to pressure and pressure to displacement are fitted apart.
            drive = "command" if self.two_stages else self.finger_drive()
            steps.append((structure, lambda out, w=words, d=drive: self.identify(out, d, *w), (program, *words)))
        steps.append(("scipy", self.scipy, (SCIPY, SIMULATOR, self.entry.split)))
        if self.options.diagnosis:
            for drive in drives:
                steps.append((f"given_{drive}", lambda out, d=drive: self.identify(out, d), (program,)))
                steps.append((f"diagnosis_{drive}", lambda out, d=drive: self.diagnose(out, d),
                              (program, self.options.nulls)))
        for name, _, depends in steps[:]:
            if name == "auto" or name.startswith("diagnosis"):
                steps.append((f"inverse_{name}", lambda out, n=name: self.inverse(out, self.folder / n / "model.yaml"),
                              ("inverse", *depends)))
        return steps

    def finger_drive(self):
        return "measured" if "pressure" in self.entry.columns else "command"

    def identify(self, out, drive, *words):
        text = output_of([self.options.softgrip, "identify", "--data", self.file, "--drive", drive, "--begin",
                          self.entry.begin, "--out", out, "--json", *words], self.options.at_most_s)
        return identified(json.loads(text))

    def diagnose(self, out, drive):
        model = self.folder / f"given_{drive}" / "model.yaml"
        if not model.exists():
            raise Failed("there is no identified model to diagnose")
        text = output_of([self.options.softgrip, "diagnose", "--model", model, "--data", self.file, "--drive", drive,
                          "--begin", self.entry.begin, "--out", out, "--nulls", self.options.nulls,
                          "--no-closed-loop", "--json"], self.options.at_most_s)
        return diagnosed(json.loads(text))

    def inverse(self, out, model):
        """Whether a controller can compute its pressure from this model."""
        if not model.exists():
            raise Failed("there is no model")
        try:
            output_of([self.options.softgrip, "tune", "--model", model, "--rate-hz", "200", "--feedforward",
                       "full_model", "--out", out / "pid.yaml"], self.options.at_most_s)
        except Failed as failed:
            if failed.code != REFUSED:
                raise
            return {"inverse": False, "why": self.in_the_users_words(failed)}
        return {"inverse": True}

    def scipy(self, _):
        library = self.options.out / "simulator.so"
        if not library.exists() or library.stat().st_mtime < SIMULATOR.stat().st_mtime:
            output_of(["cc", "-O2", "-shared", "-fPIC", "-o", library, SIMULATOR, "-lm"], self.options.at_most_s)
        return json.loads(output_of([sys.executable, SCIPY, self.file, self.entry.split, library],
                                    self.options.at_most_s))

    def in_the_users_words(self, error):
        """Of log.csv the user knows nothing, but of the file from which it was made."""
        if not isinstance(error, Failed):
            return f"its answer was not understood: {error!r}"
        lines = [0, *self.log.lines]  # the header, then a sample per line
        text = re.sub(re.escape(str(self.file)) + r":(\d+)(:\d+)?",
                      lambda found: f"{self.entry.file}:{lines[min(int(found[1]), len(lines)) - 1] or 1}", str(error))
        return text.replace(f"{self.folder}/", "")

    def outcome(self, step):
        """(outcome, whether it was there before) of one of steps(): {"wall_s", "processor_s", "result" or "error"}."""
        name, function, depends = step
        of = checksum(self.file, self.entry.begin, *depends)
        return outcome_in(self.folder / name, of, function, self.in_the_users_words)


def only(scores):
    return next(iter(scores.values()))


def identified(json_of_run):
    result = {"fitted_mm": only(json_of_run["rmse_mm"]), "converged": json_of_run["converged"]}
    if "held_out" in json_of_run:
        result["continuation_mm"] = only(json_of_run["held_out"]["rmse_mm"])
    structure = json_of_run.get("structure")
    if structure:
        chosen = next(candidate for candidate in structure["candidates"] if candidate["chosen"])
        result.update(description=structure["description"], blocks_mm=chosen["heldout_rmse_mm"])
        if "valve" in structure:
            result.update(valve_percent=structure["valve"]["rmse_percent_of_range"],
                          from_command_mm=only(structure["valve"]["from_command"]["rmse_mm"]))
    return result


def diagnosed(d):
    def causes(listed, rivals):
        return [{"id": cause["id"], "inclusion": cause["inclusion"], "share_percent": cause["share_percent"],
                 "rivals": others} for cause, others in zip(listed, rivals)]
    return {"verdict": d["verdict"], "causes": causes(d["causes"], d["alternatives"]),
            "partial": causes(d["partial_causes"], [[]] * len(d["partial_causes"])), "base": d["base"],
            "blocks_mm": d["heldout_rmse_mm"], "noise_mm": d["noise_mm"], "budget": d["budget"],
            "p_value": (d["null_calibration"] or {}).get("p_value")}
