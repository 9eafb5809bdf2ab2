"""Grips simulated parts with the shipped recipe, in virtual time or over a real connection. The results are judged
without values of the controller. The gripping pressure is computed from the values of the simulated plant and from a
curve of `softgrip simulate`."""

import csv
import dataclasses
import json
import pathlib
import random
import re
import shutil
import subprocess
import time
import types

import bench

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODEL = ROOT / "config/models/bench_twin.yaml"
REACH_MM = 10  # the fingers search for a part up to this distance [mm] beyond its expected position
APPROACH_MM = 4  # the approach ends at this distance [mm] before the expected position
# Tolerance of a pressure limit [kPa]. It covers the sensor noise, the resolution of the board and the filter
# of the readings.
TOLERANCE_KPA = 0.5


@dataclasses.dataclass(frozen=True)
class Part:
    name: str
    expected_mm: float
    # Motion of the finger after contact with the part, as a fraction of its free motion beyond the surface of the part.
    yielding: float


PARTS = (Part("stone", 12, 0.1), Part("spring", 10, 0.5), Part("screw", 17, 0.05), Part("nut", 14, 0.02),
         Part("washer", 18, 0.02))


@dataclasses.dataclass(frozen=True)
class Trial:
    part: Part | None  # None if there is no part
    fingers: int
    offset_mm: float  # position of the part relative to the position that the recipe expects
    tilt_mm: float  # additional distance [mm] between the part and the second finger
    seed: int

    @property
    def slips(self):
        """Returns True if the part slips away while the fingers hold it. This happens in one of five trials over the
        real connection."""
        return self.part is not None and random.Random(f"slips {self.seed}").random() < 0.2

    def place_mm(self, finger):
        return max(1.0, self.part.expected_mm + self.offset_mm + (self.tilt_mm if finger else 0))


@dataclasses.dataclass
class Judged:
    answers: list
    peak_kpa: float  # largest gripping pressure; 0 if no finger touched a part
    answered_s: float | None  # time from the start of the motion to the first grip result
    end: str
    slipped: bool = False  # true: the part was removed while the fingers held it


class Finger:
    """The true behaviour of the simulated fingers. The displacement of a finger is that of the model, increased by a
    given percentage. Also computes the pressure that moves the free finger to a given displacement within 3 s after a
    jump."""

    def __init__(self, softgrip, folder, farther_percent=0):
        self.softgrip, self.model = softgrip, folder / f"finger_{farther_percent:g}.yaml"
        factor = 1 + farther_percent / 100
        scaled = {"alpha_mm_per_kpa": factor, "beta_mm_per_kpa": factor, "k0_kpa_per_mm": 1 / factor,
                  "k1_kpa_per_mm": 1 / factor, "k2_kpa_per_mm": 1 / factor, "c1_kpa_s_per_mm": 1 / factor,
                  "c2_kpa_s_per_mm": 1 / factor}
        self.model.write_text(re.sub(r"(\w+): ([\d.]+)\n", lambda found: (
            f"{found[1]}: {float(found[2]) * scaled.get(found[1], 1):.8g}\n"), MODEL.read_text()))
        self.points = self.rests(folder)

    def answer(self, rows, folder):
        """Returns the displacement of the free finger for rows of (time, pressure), as `softgrip simulate` computes
        it."""
        log, answer = folder / "commands.csv", folder / "free.csv"
        log.write_text("time_s,pressure_command_kpa\n" + "".join(f"{time_s},{kpa}\n" for time_s, kpa in rows))
        subprocess.run([self.softgrip, "simulate", "--model", self.model, "--input", log, "--out", answer], check=True,
                       capture_output=True)
        with open(answer, newline="") as file:
            return [float(row["displacement_mm"]) for row in csv.DictReader(file)]

    def rests(self, folder, most_kpa=75, step_kpa=2.5):
        points = [(0.0, 0.0)]
        for k in range(1, round(most_kpa / step_kpa) + 1):
            jump = [(0, 0), (0.0001, k * step_kpa)] + [(0.02 * i, k * step_kpa) for i in range(1, 160)]
            points.append((self.answer(jump, folder)[-1], k * step_kpa))
        return points

    def needs_kpa(self, displacement_mm):
        for (y0, p0), (y1, p1) in zip(self.points, self.points[1:]):
            if displacement_mm <= y1:
                return p0 + (displacement_mm - y0) / (y1 - y0) * (p1 - p0)
        return self.points[-1][1]


def drawn(seed):
    """Draws a trial with or without a part, for one or two fingers. The part is up to 8 mm away from its expected
    position."""
    random_ = random.Random(seed)
    part = None if random_.random() < 0.1 else random_.choice(PARTS)
    return Trial(part, random_.choice((1, 2)), random_.uniform(-8, 8), random_.uniform(-1, 1), seed)


def recipe(trial):
    """Returns the shipped recipe with the expected position of the part. Without a part, the recipe
    expects a stone."""
    expected_mm = (trial.part or PARTS[0]).expected_mm
    text = (ROOT / "config/sequences/pick_stone.yaml").read_text()
    text = text.replace("displacement_mm: 8", f"displacement_mm: {expected_mm - APPROACH_MM}", 1)
    text = text.replace("displacement_mm: 17", f"displacement_mm: {expected_mm + REACH_MM}", 1)
    if trial.fingers == 1:
        text = text.replace("\nsteps:", "\nchannels: [left]\nsteps:", 1)
    return text


def rig(trial, finger_model, folder):
    text = (ROOT / "config/rig.yaml").read_text()
    text = text.replace("models/", f"{ROOT}/config/models/").replace("seed: 1", f"seed: {trial.seed}", 1)
    plants, channels = text.split("\nchannel_defaults:", 1)
    text = re.sub(r"model: \S+", f"model: {finger_model}", plants) + "\nchannel_defaults:" + channels
    # The judgement uses the pressure without noise.
    text = text.replace("pressure_noise_kpa: 0.1", "pressure_noise_kpa: 0")
    text = re.sub(r"directory: \S+}", f"directory: {folder}/runs}}", text)
    text = re.sub(r"path: /\S+,", f"path: {folder}/softgrip.sock,", text)
    objects = iter(range(2))

    def place(found):
        finger = next(objects)
        if trial.part is None or finger >= trial.fingers:
            return ""
        return f"object: {{position_mm: {trial.place_mm(finger)}, yielding: {trial.part.yielding}}}"

    return re.sub(r"object: \{.*\}.*", place, text)


def bound_kpa(text):
    """Returns the largest gripping pressure that any step of a recipe allows."""
    return max(float(value) for value in re.findall(r"squeeze_max_kpa: ([\d.]+)", text))


def play(trial, finger, folder):
    """Runs a trial in virtual time."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rig.yaml").write_text(rig(trial, finger.model, folder))
    (folder / "recipe.yaml").write_text(recipe(trial))
    done = subprocess.run([finger.softgrip, "run", folder / "recipe.yaml", "--rig", folder / "rig.yaml", "--virtual-time",
                           "--record", folder / "run", "--quiet", "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 6):
        raise RuntimeError(f"{trial}: {done.stdout}{done.stderr}")
    return judged(trial, finger, folder, folder / "run", json.loads(done.stdout.splitlines()[-1])["sequence_end"])


def play_on_the_wire(trial, finger, folder):
    """Runs a trial with softgripd and softgrip-rig in real time. Both fingers get the part position that the trial
    states for the first finger."""
    shutil.copytree(ROOT / "config", folder / "config")
    (folder / "config/sequences/recipe.yaml").write_text(recipe(trial))
    there = () if trial.part is None else ("--object", f"{trial.place_mm(0)}:{trial.part.yielding}")
    emulated = bench.Emulator(folder, "--seed", trial.seed, "--pressure-noise-kpa", 0, *there)
    daemon = None
    try:
        daemon = bench.Daemon(folder, bench.BenchTest.rig(types.SimpleNamespace(folder=folder), emulated.port))
        daemon.wait_for_state("idle")
        daemon.start("recipe")
        if trial.slips:
            daemon.wait_for_event("grip_result", code="HOLDING")
            time.sleep(1)
            emulated.ask("object out")
        finished = bench.wait_for("the recipe's end", lambda: next(
            (event for event in daemon.events() if event["kind"] == "sequence_finished"), None), patience_s=90)
        daemon.end()
    finally:
        for process in (daemon, emulated):
            if process and process.running():
                process.kill()
    recording = next((folder / "runs").glob("*/run.json")).parent
    one = judged(dataclasses.replace(trial, tilt_mm=0), finger, folder, recording, finished["code"])
    return dataclasses.replace(one, slipped=trial.slips)


def judged(trial, finger, folder, recording, end):
    """Computes the result of a trial from the recording of the trial."""
    story = json.loads((recording / "run.json").read_text())
    with open(recording / "run.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    names = story["channels"][:trial.fingers]
    told = [event for event in story["events"] if event["kind"] == "grip_result"]
    began = next(event["time_s"] for event in story["events"] if event["kind"] == "step_started")
    answers = [[event["code"] for event in told if event["channel"] == name] for name in names]
    peak = max(peak_squeeze([row for row in rows if row["channel"] == name], trial, i, finger, folder)
               for i, name in enumerate(names))
    return Judged(answers, peak, told[0]["time_s"] - began if told else None, end)


def peak_squeeze(rows, trial, number, finger, folder):
    """Returns the largest gripping pressure. It is computed from the true position of the finger, which depends on
    the sent commands and on the position of the part."""
    if trial.part is None:
        return 0
    free = finger.answer([(row["time_s"], row["pressure_command_kpa"]) for row in rows], folder)
    place_mm, peak = trial.place_mm(number), 0.0
    for row, free_mm in zip(rows, free):
        if free_mm > place_mm:
            touched_mm = place_mm + trial.part.yielding * (free_mm - place_mm)
            peak = max(peak, float(row["pressure_kpa"]) - finger.needs_kpa(touched_mm))
    return peak


def broken(trial, judged, allowed_kpa):
    """Returns the requirements on a grip that this trial has violated. Returns an empty list if no requirement is
    violated."""
    told = [answer for answers in judged.answers for answer in answers]
    problems = []
    if judged.peak_kpa > allowed_kpa + TOLERANCE_KPA:
        problems.append(f"squeezed by {judged.peak_kpa:.1f} kPa, {allowed_kpa:g} allowed")
    if trial.part is None and "HOLDING" in told:
        problems.append("HOLDING although there is no part")
    if trial.part is not None and "NO PART" in told:
        problems.append("NO PART although there is a part")
    if judged.slipped and "PART LOST" not in told:
        problems.append("a part slipped away, but there was no PART LOST")
    if not all(judged.answers):
        problems.append("no answer")
    return problems
