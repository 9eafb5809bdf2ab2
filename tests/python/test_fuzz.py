"""Calls every function of the package with random arguments from several threads at the same time. A call may raise an
exception of the package but must never crash.

    test_fuzz.py --seed 7 --calls 1000 [--threads 4]      makes the calls in this process and prints the seed

Without arguments, the program makes these calls in a child process, so that it can detect a crash. Needs the folder
python of a build (SOFTGRIP_BUILD). This folder contains the extension module. For a build with AddressSanitizer,
LD_PRELOAD must name the library of AddressSanitizer.
"""

import argparse
import array
import collections
import decimal
import faulthandler
import fractions
import inspect
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
sys.path.insert(0, str(BUILD / "python"))

import numpy as np
import softgrip
from softgrip import Log, Model, analysis, control, models, recordings, results

MODEL = SOURCE / "config/models/bench_twin.yaml"
LONGEST_CALL_S = 0.3
HUGE = 200_000
class Enough(Exception):
    """Exception that the progress callback raises to end a long call."""


class FromArgument(Exception):
    """Exception that a test argument raises when the package converts the argument."""


class Raises:
    def __float__(self):
        raise FromArgument("no number")

    def __index__(self):
        raise FromArgument("no number")

    def __array__(self, *_, **__):
        raise FromArgument("no array")

    def __fspath__(self):
        raise FromArgument("no path")

    def __iter__(self):
        raise FromArgument("no list")

    def __repr__(self):
        return "Raises()"


class Lies:
    """An argument whose conversion methods return values of the wrong type."""

    def __float__(self):
        return "1"

    def __index__(self):
        return 1.5

    def __fspath__(self):
        return 3


def vectors(chance):
    """Returns arguments to pass where a function expects a vector."""
    size = chance.choice([0, 1, 2, 3, 50, 51])
    t = np.arange(size) * 0.1
    frozen = t.copy()
    frozen.flags.writeable = False
    unaligned = np.frombuffer(b"x" + t.tobytes(), dtype=np.float64, offset=1) if size else t
    raising = np.empty(1, dtype=object)
    raising[0] = Raises()
    with_nan = t.copy()
    with_nan[chance.randrange(size) if size else slice(0)] = chance.choice([np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324])
    return [t, frozen, unaligned, with_nan, np.repeat(t, 2)[::2], t[::-1], t.reshape(-1, 1), np.asfortranarray(np.outer(t, t)),
            np.broadcast_to(1.0, (size,)), np.broadcast_to(np.nan, (HUGE,)), np.arange(HUGE) * 1e-3, np.zeros((0, 3)),
            np.float64(1), np.array(1.0), t.astype(">f8"), t.astype(np.float16), t.astype(np.longdouble), t.astype(np.uint8),
            t.astype(np.int64), t.astype(bool), t.astype(complex), t.astype(object), t.astype(str), t.astype("datetime64[s]"),
            np.array([None] * size), raising, np.array(["a", "b"]), np.zeros(size, dtype=[("x", float)]),
            np.ma.masked_array(t, mask=[True] * size), memoryview(t), array.array("d", t), array.array("i", [1, 2]), t.tolist(),
            list(map(str, t)), [[1, 2], [3]], [1, None], [2**70] * size, range(size), (one for one in t), bytes(8), bytearray(8),
            t.tobytes(), t[:0], [np.nan] * size, [Raises()], [decimal.Decimal(1)] * size, {0: 1}, {1.0, 2.0}]


def scalars(chance):
    """Returns arguments to pass where a function expects a number."""
    return [float("nan"), float("inf"), -float("inf"), 0, -0.0, -1, 1, 1.5, 1e308, -1e308, 5e-324, 2**31, 2**32, 2**63, 2**64,
            2**200, -2**63, -2**200, True, "3", b"3", None, [], [1], np.float32(1), np.int64(-1), np.uint64(2**64 - 1),
            np.array(1.0), np.array([1.0]), np.array([1.0, 2.0]), decimal.Decimal("1e400"), fractions.Fraction(1, 3), 1j,
            Raises(), Lies(), object(), chance.uniform(-10, 10), chance.randrange(100)]


def texts(chance):
    """Returns arguments to pass where a function expects a text or a path."""
    return ["", "text", "x" * 300_000, "a\0b", "\ud800", "\udcff", "\U0001f600", b"bytes", b"\xff", None, 3, [], "/", "/dev/null",
            "/no/such", "..", " ", "\n", "name: x", "[" * 1000, "{a: &a [*a]}", "auto", "command", "rest", "mm", "deg", "day",
            "full_model", "back_calculation", "play", pathlib.Path("/no/such"), Raises(), Lies(), np.str_("text"),
            chance.choice("abc")]


def anything(chance):
    return chance.choice([vectors, scalars, texts])(chance)


class World:
    """The functions under test and valid arguments for them."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.model = model = Model.load(MODEL)
        t = np.arange(200) * 0.1
        command = 20 - 20 * np.cos(0.2 * np.pi * t)
        log = self.log = Log(t, command, model.simulate(t, command, noise=0.05))
        log.write(self.folder / "log.csv")
        limits, board = control.Limits(pressure_max=80), control.SimulatedBoard([control.SimulatedFinger(model)])
        validation = softgrip.validate(model, log)
        prediction, cause = validation.predictions[0], results.Cause("x", "x", 1.0, (0.0, 2.0), (), ())
        change = results.Change("x", "x", (), (cause,), "mm", "{}", "")
        vector, number, text, other = vectors, scalars, texts, anything
        # Maps the name of a function to its call and its arguments. Each argument has a valid value and a
        # function that returns other values. Positional arguments are named "0", "1".
        self.targets = {}

        def target(name, call, /, **arguments):
            self.targets[name] = (call, arguments)

        target("Model", Model, core=(model._core, other))
        target("Model.load", Model.load, path=(MODEL, text))
        target("Model.parse", Model.parse, yaml=(model.yaml, text), name=("x", text))
        target("Model.save", model.save, path=(self.folder / "model.yaml", lambda c: bad_paths(c)))
        target("Model.with_parameter", model.with_parameter, name=("transport_delay.delay_s", text), value=(0.1, number))
        target("Model.simulate", model.simulate, t=(t, vector), pressure=(command, vector), held=(False, other),
               noise=(0, number), seed=(1, number), supply=(None, vector), temperature=(None, vector))
        target("Model.inverse", model.inverse, t=(t, vector), displacement=(0.1 * command, vector),
               **{name: (value, number) for name, value in (("pressure_min", 0), ("pressure_max", 80), ("slew_up", 300),
                                                            ("slew_down", 300), ("start", 0))})
        target("Log", lambda **columns: Log(**columns).check(), t=(t, vector), command=(command, vector),
               displacement=(command, vector), pressure=((), vector), temperature=((), vector), supply=((), vector),
               unit=("mm", text), name=("x", text), path=("", text), sha256=("", text), notes=((), other))
        target("Log.read", Log.read, path=(self.folder / "log.csv", text), channel=("", text), columns=(None, other),
               units=(None, other), rate_hz=(None, number), sheet=("", text), import_file=(True, other))
        target("Log.from_pandas", Log.from_pandas, frame=(Frame(t), lambda c: [Frame(one) for one in vectors(c)]),
               name=("x", text))
        target("Log.write", log.write, path=(self.folder / "written.csv", lambda c: bad_paths(c)))
        target("Log.check", log.check)
        logs = (log, self.logs)
        target("identify", analysis.identify, logs=logs, structure=("start", text), start=(None, other), branches=(2, number),
               fixed=((), other), free=((), other), starts=(1, number), seed=(1, number), robust=(False, other),
               fit_share=(1, number), threads=(1, number), drive=("command", text), begin=("auto", text), held=(False, other),
               validation=((), self.logs), progress=(None, other))
        target("validate", analysis.validate, model=(model, other), logs=logs, drive=("command", text), begin=("auto", text),
               held=(False, other))
        target("diagnose", analysis.diagnose, model=(model, other), logs=logs, healthy=(None, self.logs), seed=(1, number),
               threads=(1, number), null_campaigns=(0, number), drive=("command", text), begin=("auto", text),
               held=(False, other), progress=(None, other))
        target("health", analysis.health, recordings=([self.folder], lambda c: [*texts(c), texts(c), *vectors(c)]),
               baseline=(self.folder, text), points=("day", text), false_alarm_points=(100, number), notes=(None, text),
               scores=(None, lambda c: bad_paths(c)), progress=(None, other))
        target("limit", control.limit, limits=(limits, other), wanted=(1, number), last=(0, number), elapsed=(0.1, number))
        target("Limits", control.Limits, **{name: (getattr(limits, name), number) for name in vars(limits)})
        target("Pid", lambda tick, **gains: control.Pid(control.PidSettings(**gains), tick), tick=(0.01, number),
               anti_windup=("none", text), **{name: (0.5, number) for name in ("kp", "ki", "kd", "derivative_filter",
                                                                               "setpoint_weight", "tracking_time")})
        pid = control.Pid(control.PidSettings(1, 1, 1), 0.01)
        target("Pid.align", pid.align, command=(1, number))
        target("Pid.step", pid.step, reference=(1, number), measurement=(1, number), feedforward=(0, number))
        target("Pid.hold", pid.hold, feedforward=(0, number))
        target("Pid.sent", pid.sent, command=(1, number))
        target("Reference", control.Reference, value=(0, number), start=(0, number))
        target("Reference.ramp_to", lambda **k: control.Reference().ramp_to(**k).at(1), value=(0, number), duration=(1, number))
        target("Reference.hold_for", lambda **k: control.Reference().hold_for(**k).at(1), duration=(1, number))
        target("Reference.sine", lambda **k: control.Reference().sine(**k).at(1), mean=(0, number), amplitude=(1, number),
               frequency=(1, number), cycles=(1, number))
        target("Reference.at", control.Reference().at, time=(1, number))
        target("SimulatedBoard", lambda tick, fingers, **k: control.SimulatedBoard(
            fingers if fingers is not None else [control.SimulatedFinger(**k)], tick), tick=(0.005, number), fingers=(None, other),
            model=(model, other), object=(None, other), noise=(0, number), pressure_min=(0, number), pressure_max=(80, number),
            seed=(1, number))
        target("SimulatedBoard.connect", board.connect, deadline=(1, number))
        target("SimulatedBoard.exchange", board.exchange, commands=([1], vector), deadline=(1, number))
        target("SimulatedBoard.describe", board.describe)
        target("SimulatedBoard.advance", board.advance, duration=(0.005, number))
        target("SimulatedBoard.set_object", lambda channel, value, position, yielding: board.set_object(
            channel, control.SimulatedObject(position, yielding) if value is None else value), channel=(0, number), value=(None, other),
            position=(4, number), yielding=(0, number))
        target("SimulatedBoard.displacement", board.displacement, channel=(0, number))
        pid_settings = control.PidSettings(2, 1)
        target("Controller", control.Controller, model=(model, other), limits=(limits, other), pid=(pid_settings, other),
               feedforward=("none", text), extra_latency=(0, number), tick=(0.01, number), sensor_noise=(0.05, number),
               reading_max_age=(0.05, number))
        controller = control.Controller(model, limits, pid_settings, feedforward="none")
        target("Controller.start", controller.start, command=(0, number))
        target("Controller.follow", controller.follow, reference=(control.Reference(1), other))
        target("Controller.hold", controller.hold)
        target("Controller.vent", controller.vent)
        target("Controller.pressure", controller.pressure, pressure=(3, number))
        target("Controller.tick", lambda now, whole, **k: controller.tick(now, control.Reading(**k) if whole is None else whole), now=(1, number),
               whole=(None, other), displacement=(1, number), pressure=(1, number), temperature=(1, number),
               sampled_at=(1, number), sequence=(1, number), validity=("valid", text))
        target("Board.connect", board.connect, deadline=(1, number))
        target("FingerHealth.indicator", lambda name: results.FingerHealth("x", "x", "x", "mm", 1, (), (), (), (), (), "").
               indicator(name), name=("gain_mm", text))
        target("Health.finger", lambda name: results.Health(False, (), (), (), "{}").finger(name), name=("left", text))
        target("read_columns", recordings.read_columns, path=(self.folder / "log.csv", text))
        target("read_report", recordings.read_report, path=(self.folder / "log.csv", text))
        target("Recording.read", recordings.Recording.read, folder=(self.folder, text))
        # matplotlib draws the picture. This test covers only the checks that the package makes before the drawing.
        target("plots", lambda log, axes: (validation.plot(log, axes), prediction.plot(axes), change.plot(axes)),
               log=("no such log", text), axes=(3, lambda c: [[], [1], [1, 2, 3], 3]))

    def logs(self, chance):
        """Returns arguments to pass where a function expects logs."""
        t = self.log.t[:chance.choice([2, 3, 20, 200])]
        odd = [Log(t, chance.choice([t, 0 * t, -t]), chance.choice([t, t * np.nan, 0 * t, t * 1e300]),
                   unit=chance.choice(["mm", "deg"])) for _ in range(2)]
        return [[], odd, odd[0], [self.log, odd[1]], [self.log, 3], [None], *scalars(chance), *texts(chance)]


class Frame(collections.UserDict):
    """A table whose columns have to_numpy(), like a pandas data frame."""

    def __init__(self, values):
        super().__init__()
        for name in ("time_s", "pressure_command_kpa", "displacement_mm"):
            self[name] = Column(values)
        self.columns = list(self)


class Column:
    def __init__(self, values):
        self.values = values

    def to_numpy(self):
        return self.values


def bad_paths(chance):
    """Returns paths to which no file can be written. The test must not write to any other path."""
    return [one for one in texts(chance) if not isinstance(one, (str, pathlib.Path))] + ["", "a\0b", "\ud800", "x" * 300_000, ".."]


def run(world, seed, calls, problems):
    chance = random.Random(seed)
    outcomes = collections.Counter()
    for number in range(calls):
        name = chance.choice(list(world.targets))
        call, arguments = world.targets[name]
        wrong = set(chance.sample(list(arguments), chance.randint(1, min(3, len(arguments))))) if arguments else set()
        given = {key: chance.choice(others(chance)) if key in wrong else good for key, (good, others) in arguments.items()}
        if given.get("progress", 0) is None:
            end = time.monotonic() + LONGEST_CALL_S

            def enough(_):
                if time.monotonic() > end:
                    raise Enough
            given["progress"] = enough
        try:
            call(**given)
            outcomes["accepted"] += 1
        except (softgrip.SoftgripError, OSError, Enough, FromArgument):
            outcomes["refused"] += 1
        except Exception:
            problems.append(f"seed {seed}, call {number}: {name}({', '.join(f'{key}={str(given[key])[:80]!r}' for key in wrong)})\n"
                            f"{traceback.format_exc()}")
    return outcomes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--calls", type=int, default=1000, help="of each thread")
    parser.add_argument("--threads", type=int, default=4)
    args = parser.parse_args()
    faulthandler.enable()
    sys.stdout.reconfigure(errors="backslashreplace")
    print(f"seed {args.seed}, {args.threads} threads with {args.calls} calls each", flush=True)
    problems = []
    with tempfile.TemporaryDirectory() as folder, np.errstate(all="ignore"):
        os.chdir(folder)
        world = World(folder)
        counts = [None] * args.threads

        def work(index):
            counts[index] = run(world, args.seed + 1000 * index, args.calls, problems)
        threads = [threading.Thread(target=work, args=[index]) for index in range(args.threads)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        os.chdir("/")
    for problem in problems[:5]:
        print(problem)
    print(f"{sum((one or collections.Counter() for one in counts), collections.Counter())}, {len(problems)} other exceptions")
    return 1 if problems or None in counts else 0


class Fuzz(unittest.TestCase):
    def test_random_calls_raise_only_expected_exceptions(self):
        seed = int(os.environ.get("SOFTGRIP_FUZZ_SEED", "1"))
        done = subprocess.run([sys.executable, __file__, "--seed", str(seed), "--calls",
                               os.environ.get("SOFTGRIP_FUZZ_CALLS", "400")], capture_output=True, text=True)
        print(done.stdout)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_public_function_is_a_fuzz_target(self):
        with tempfile.TemporaryDirectory() as folder:
            called = set(World(folder).targets) | {"Identification.plot", "Validation.plot", "Prediction.plot", "Change.plot",
                                                   "Log.plot", "Diagnosis.plot", "FingerHealth.plot", "Health.plot",
                                                   "Inverse", "Parameter", "Recording"}
        for module in (models, analysis, control, recordings, results):
            for name, value in vars(module).items():
                if name.startswith("_") or getattr(value, "__module__", "") != module.__name__:
                    continue
                if inspect.isfunction(value) and name != "two_axes":
                    self.assertIn(name, called)
                elif inspect.isclass(value):
                    for method, function in vars(value).items():
                        inner = getattr(function, "__func__", function)
                        if inspect.isfunction(inner) and not method.startswith("_") and method != "save_html" and \
                                not getattr(inner, "__isabstractmethod__", False) and name != "Board":
                            self.assertIn(f"{name}.{method}", called)


if __name__ == "__main__":
    if sys.argv[1:2] and sys.argv[1].startswith("--"):
        sys.exit(main())
    unittest.main()
