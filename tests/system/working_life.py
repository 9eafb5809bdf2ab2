"""Simulates a rig that works for months, in virtual time. `softgrip run` records grips with fingers that change.

A finger changes only in the simulated plant: by a different gain of its model, a leak, or a sensor with a wrong
scale. The recordings are not changed, with one exception. The date and time are written to run.json afterwards,
because a run in virtual time has none."""
import dataclasses
import json
import pathlib
import re
import shutil
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]
MODEL = SOURCE / "config/models/bench_twin.yaml"
# Model parameters that increase with the gain of the finger (GAINS), and model parameters that decrease when the gain
# increases (STIFFNESSES).
GAINS = {"alpha_mm_per_kpa": 0.21105, "beta_mm_per_kpa": 0.1713}
STIFFNESSES = {"k0_kpa_per_mm": 325.9, "k1_kpa_per_mm": 18.16, "c1_kpa_s_per_mm": 299.8, "k2_kpa_per_mm": 2.761,
               "c2_kpa_s_per_mm": 1.621}
VALVE_LAG_S = 0.044
THERMOMETER = "temperature_sensor: {input: 7, at_v: [0, 10], is_c: [-20, 80], valid_v: [0.1, 9.9]}"
THERMOMETER_NOISE_C = 0.2


@dataclasses.dataclass(frozen=True)
class Finger:
    """Describes how a simulated finger differs from the healthy finger."""
    gain: float = 1
    zero_mm: float = 0
    leak: float = 0  # fraction of the pressure that the finger loses by a leak
    valve_lag_s: float = VALVE_LAG_S
    gain_per_c: float = 0


@dataclasses.dataclass(frozen=True)
class Grip:
    at: str  # date and time in UTC, such as "2026-08-01T08:00:00Z"
    seed: int
    fingers: dict  # changes of the fingers by the name of the finger
    sequence: str = "pick_stone"
    part_mm: float = 12  # position of the part [mm]
    temperature_c: float = 20
    thermometer: bool = False  # true: the rig has one thermometer for all channels


class Rig:
    """Runs grips and stores the recordings in the folder `recordings`."""

    def __init__(self, softgrip, folder):
        self.softgrip = softgrip
        self.folder = pathlib.Path(folder)
        self.recordings = self.folder / "recordings"
        self.recordings.mkdir(parents=True, exist_ok=True)

    def baseline(self):
        """Writes logs of the healthy finger, and the result of `softgrip baseline` for these logs."""
        logs = []
        for signal in ("tp1", "steps", "sp2"):
            logs.append(self.folder / f"{signal}.csv")
            self._call("simulate", "--model", MODEL, "--input", signal, "--out", logs[-1], "--noise-mm", "0.03")
        self._call("baseline", "--data", *logs, "--model", MODEL, "--out", self.folder / "baseline")
        return self.folder / "baseline"

    def _run_of(self, grip):
        return self.recordings / f"{grip.at.replace(':', '-')}_{grip.sequence}"

    def has(self, grip):
        """Returns True if play() has already recorded this grip completely."""
        story = self._run_of(grip) / "run.json"
        return story.exists() and "started_at" in json.loads(story.read_text())

    def play(self, grip):
        run = self._run_of(grip)
        shutil.rmtree(run, ignore_errors=True)
        self._call("run", SOURCE / f"config/sequences/{grip.sequence}.yaml", "--rig", self._rig_of(grip), "--virtual-time",
                   "--seed", str(grip.seed), "--record", run, "--quiet", "--no-socket", may_fail=True)
        story = json.loads((run / "run.json").read_text())
        story["started_at"] = grip.at
        (run / "run.json").write_text(json.dumps(story))
        return run

    def _rig_of(self, grip):
        head, plants = (SOURCE / "config/rig.yaml").read_text().split("    plants:", 1)
        happens, models = [], {}
        for name, finger in grip.fingers.items():
            if finger.leak > 0:
                happens.append(f"{{at_s: 0, channel: {name}, line: leaking, share: {finger.leak:.6f}}}")
            if finger.zero_mm:
                happens.append(f"{{at_s: 0, channel: {name}, sensor: offset, value_mm: {finger.zero_mm:.6f}}}")
            models[name] = self._model_of(name, finger)
        events = "    events:\n" + "".join(f"      - {one}\n" for one in happens) if happens else ""
        plants, rest = plants.split("\nchannel_defaults:", 1)
        for name, model in models.items():
            before, after = plants.split(f"      {name}:\n", 1)
            plants = f"{before}      {name}:\n" + after.replace("models/bench_twin.yaml", str(model), 1)
        plants = plants.replace("position_mm: 12", f"position_mm: {grip.part_mm:.4f}")
        plants = plants.replace("        pressure_noise_kpa:", f"        temperature_c: {grip.temperature_c:.4f}\n"
                                f"        temperature_noise_c: {THERMOMETER_NOISE_C}\n        pressure_noise_kpa:")
        rest = rest.replace("models/bench_twin.yaml", str(MODEL)).replace(
            "sequence_directory: sequences", f"sequence_directory: {SOURCE / 'config/sequences'}")
        path = self.folder / "rig.yaml"
        if grip.thermometer:
            comment, keys = rest.split("\n", 1)
            rest = f"{comment}\n  {THERMOMETER}\n{keys}"
        path.write_text(f"{head}{events}    plants:{plants}\nchannel_defaults:{rest}")
        return path

    def _model_of(self, name, finger):
        text = MODEL.read_text()
        changed = {key: value * finger.gain for key, value in GAINS.items()}
        changed |= {key: value / finger.gain for key, value in STIFFNESSES.items()}
        for key, value in changed.items():
            text, count = re.subn(rf"{key}: [\d.]+", f"{key}: {value:.8f}", text)
            assert count == 1, key
        text = text.replace(f"time_constant_s: {VALVE_LAG_S}", f"time_constant_s: {finger.valve_lag_s:.6f}")
        if finger.gain_per_c:
            text += f"  - thermal_gain:\n      gain_per_c: {finger.gain_per_c:.6f}\n"
        path = self.folder / f"{name}.yaml"
        path.write_text(text)
        return path

    def _call(self, *arguments, may_fail=False):
        done = subprocess.run([str(self.softgrip), *map(str, arguments)], capture_output=True, text=True)
        if done.returncode and not may_fail:
            raise AssertionError(f"{' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}")
        return done
