"""Tests the functions for models, logs and diagnosis on arrays. Their results must equal those of the commands and
must be picklable. Invalid arguments must raise an exception.

Needs the folder python of a build (SOFTGRIP_BUILD). This folder contains the extension module.
"""

import doctest
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
sys.path.insert(0, str(BUILD / "python"))

import numpy as np
import softgrip
from softgrip import Log, Model, diagnose, identify, validate

MODEL = SOURCE / "config/models/bench_twin.yaml"
PROGRAM = BUILD / "tools/softgrip"


def command(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def plain(report, *without):
    """Removes the values that differ between two calls, such as durations, and returns the rest of the result."""
    return {key: value for key, value in report.items() if key not in without}


def sine(samples=400, step_s=0.05, largest_kpa=40.0):
    t = np.arange(samples) * step_s
    return t, largest_kpa / 2 * (1 - np.cos(0.2 * np.pi * t))


def simulated(noise=0.05, seed=1, model=None):
    t, pressure = sine()
    model = model or Model.load(MODEL)
    return Log(t, pressure, model.simulate(t, pressure, noise=noise, seed=seed), name=f"sine {seed}")


class EqualToTheCommands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        Model.load(MODEL).with_parameter("bouc_wen.alpha_mm_per_kpa", 0.26).save(cls.at / "stiffer.yaml")
        for name, model, signal_name, seed in (("one", MODEL, "tp1", 1), ("two", MODEL, "sp1", 2),
                                               ("three", cls.at / "stiffer.yaml", "tp1", 3)):
            command("simulate", "--model", model, "--input", signal_name, "--rate-hz", 20, "--noise-mm", 0.05,
                    "--seed", seed, "--out", cls.at / f"{name}.csv")
        cls.logs = {name: Log.read(cls.at / f"{name}.csv") for name in ("one", "two", "three")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_simulate_returns_the_readings_of_the_command(self):
        log = self.logs["two"]
        moved = Model.load(MODEL).simulate(log.t, log.command, noise=0.05, seed=2)
        np.testing.assert_array_equal(moved, log.displacement)

    def test_identify_returns_the_report_of_the_command(self):
        expected = json.loads(command("identify", "--starts", 3, "--seed", 7, "--json", "--out", self.at / "out",
                                      "--data", self.at / "one.csv", self.at / "two.csv",
                                      "--validate", self.at / "three.csv"))
        stages = []
        found = identify([self.logs["one"], self.logs["two"]], starts=3, seed=7, validation=self.logs["three"],
                         progress=stages.append)
        self.assertEqual(plain(found.report, "call", "wall_s"), plain(expected, "call", "wall_s"))
        self.assertEqual(found.model, Model.load(self.at / "out/model.yaml"))
        self.assertEqual([len(one.error) for one in found.fit], [len(one.prediction) for one in found.fit])
        self.assertTrue(stages)
        self.assertIn("bouc_wen.alpha_mm_per_kpa", found._repr_html_())
        self.assertEqual(pickle.loads(pickle.dumps(found)).report, found.report)

    def test_identify_with_automatic_structure_equals_the_command(self):
        expected = json.loads(command("identify", "--structure", "auto", "--starts", 3, "--json", "--out",
                                      self.at / "auto", "--data", self.at / "one.csv"))
        found = identify(self.logs["one"], "auto", starts=3)
        self.assertEqual(plain(found.report, "call", "wall_s"), plain(expected, "call", "wall_s"))

    def test_a_choice_of_the_structure_refuses_the_settings_of_a_given_structure(self):
        for name, value in (("start", Model.load(MODEL)), ("branches", 3), ("fixed", ["no.such"]), ("robust", True),
                            ("free", ["kelvin_voigt.k0_kpa_per_mm"])):
            with self.assertRaises(softgrip.InvalidArgument) as raised:
                identify(self.logs["one"], "auto", **{name: value})
            self.assertEqual(raised.exception.argument, name)

    def test_identify_accepts_the_structures_of_the_command(self):
        t, pressure = sine(samples=200)
        log = Log(t, pressure, Model.load(MODEL).simulate(t, pressure, noise=0.05))
        found = identify(log, structure="prandtl_ishlinskii")
        self.assertTrue(any(name.startswith("prandtl_ishlinskii.") for name in found.model.parameters))
        with self.assertWarnsRegex(DeprecationWarning, "prandtl_ishlinskii"):
            self.assertEqual(identify(log, structure="play").model, found.model)
        with self.assertRaisesRegex(softgrip.InvalidArgument, "'start', 'auto', 'bouc_wen', 'prandtl_ishlinskii'"):
            identify(log, structure="plays")

    def test_validate_returns_the_report_of_the_command(self):
        expected = json.loads(command("validate", "--json", "--model", self.at / "stiffer.yaml", "--data",
                                      self.at / "one.csv", self.at / "two.csv"))
        found = validate(Model.load(self.at / "stiffer.yaml"), [self.logs["one"], self.logs["two"]])
        self.assertEqual(plain(found.report, "call", "wall_s"), plain(expected, "call", "wall_s"))
        self.assertEqual(found.predictions[0].rmse, expected["rmse_mm"]["one"])
        self.assertIn("RMSE", found._repr_html_())

    def test_diagnose_returns_the_report_of_the_command(self):
        differing = ("call", "wall_s", "stages_s", "software", "given", "model", "logs", "next_experiment", "closed_loop",
                     "experiments_judged", "experiment_advice", "gauge_check")
        fitted = identify(self.logs["one"], starts=3).model
        fitted.save(self.at / "fitted.yaml")
        expected = json.loads(command("diagnose", "--no-closed-loop", "--json", "--out", self.at / "diagnosis", "--model",
                                      self.at / "fitted.yaml", "--data", self.at / "one.csv"))
        found = diagnose(fitted, self.logs["one"])
        self.assertEqual(plain(found.report, *differing), plain(expected, *differing))
        self.assertEqual(found.causes[0].id, "transport_delay")
        self.assertIn("transport_delay", found._repr_html_())
        self.assertEqual(pickle.loads(pickle.dumps(found)).extended, found.extended)

    def test_diagnose_with_healthy_logs_equals_the_command(self):
        expected = json.loads(command("diagnose", "--json", "--out", self.at / "change", "--model", MODEL, "--healthy",
                                      self.at / "one.csv", self.at / "two.csv", "--data", self.at / "three.csv"))
        found = diagnose(Model.load(MODEL), self.logs["three"], healthy=[self.logs["one"], self.logs["two"]])
        self.assertEqual(plain(found.report, "wall_s"), plain(expected, "wall_s", "made_of"))
        self.assertIsInstance(found, softgrip.Change)
        reductions = [cause["heldout_error_reduction_percent"] for cause in expected["causes"]]
        self.assertEqual([one.error_reduction_percent for one in found.causes], [one["value"] for one in reductions])
        self.assertEqual([list(one.error_reduction_ci95) for one in found.causes], [one["ci95"] for one in reductions])
        self.assertIn(found.causes[0].id, found._repr_html_())
        import matplotlib
        matplotlib.use("Agg")
        labels = [one.get_text() for one in found.plot().get_yticklabels()]
        self.assertEqual([one.splitlines()[0] for one in labels], [cause.id for cause in found.causes])
        self.assertIn(found.causes[0].parameters[0].unit, labels[0])
        matplotlib.pyplot.close("all")


class Objects(unittest.TestCase):
    def test_a_written_log_is_read_back_unchanged(self):
        log = simulated()
        with tempfile.TemporaryDirectory() as folder:
            log.write(pathlib.Path(folder) / "log.csv")
            read = Log.read(pathlib.Path(folder) / "log.csv")
        for column in ("t", "command", "displacement"):
            np.testing.assert_array_equal(getattr(read, column), getattr(log, column))
        self.assertEqual(len(read.sha256), 64)
        copy = pickle.loads(pickle.dumps(log))
        np.testing.assert_array_equal(copy.displacement, log.displacement)

    def test_the_times_of_a_written_log_start_at_zero(self):
        log = simulated()
        with tempfile.TemporaryDirectory() as folder:
            Log(log.t + 128, log.command, log.displacement).write(pathlib.Path(folder) / "log.csv")
            read = Log.read(pathlib.Path(folder) / "log.csv")
        np.testing.assert_array_equal(read.t, log.t + 128 - 128)
        np.testing.assert_array_equal(read.displacement, log.displacement)

    def test_a_log_is_created_from_a_pandas_data_frame(self):
        import pandas
        log = simulated()
        frame = pandas.DataFrame({"time_s": log.t, "pressure_command_kpa": log.command, "displacement_mm": log.displacement})
        np.testing.assert_array_equal(Log.from_pandas(frame).displacement, log.displacement)
        with self.assertRaisesRegex(softgrip.InvalidArgument, "no column 'pressure_command_kpa'"):
            Log.from_pandas(frame.drop(columns="pressure_command_kpa"))

    def test_a_csv_file_of_another_program_is_converted(self):
        log = simulated()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "other.csv"
            path.write_text("Time [s];Pressure setpoint [bar];Displacement [mm]\n" + "".join(
                f"{t};{p / 100};{y}\n" for t, p, y in zip(log.t, log.command, log.displacement)))
            read = Log.read(path)
        np.testing.assert_allclose(read.command, log.command, atol=1e-9)
        self.assertIn("--command", read.notes[0])

    def test_a_log_copies_its_arrays_and_is_read_only(self):
        t, pressure = sine()
        log = Log(t, pressure, pressure)
        pressure[:] = 0
        self.assertGreater(log.command.max(), 1)
        with self.assertRaises(ValueError):
            log.command[0] = 1

    def test_a_masked_value_is_treated_as_nan(self):
        t, pressure = sine()
        masked = np.ma.masked_array(pressure, mask=t > 10)
        np.testing.assert_array_equal(np.isnan(Log(t, pressure, masked).displacement), t > 10)
        with self.assertRaisesRegex(softgrip.InvalidArgument, "^pressure: value 201 is nan"):
            Model.load(MODEL).simulate(t, masked)

    def test_a_file_that_cannot_be_opened_raises_an_os_error(self):
        with tempfile.TemporaryDirectory() as folder:
            missing, plain_file = pathlib.Path(folder, "x.yaml"), pathlib.Path(folder, "file")
            plain_file.write_text("name: [")
            for read in (Model.load, Log.read):
                with self.assertRaises(FileNotFoundError) as raised:
                    read(missing)
                self.assertIsInstance(raised.exception, softgrip.MalformedFile)
                self.assertEqual(str(raised.exception), f"[Errno 2] No such file or directory: '{missing}'")
                self.assertEqual(raised.exception.filename, str(missing))
                self.assertEqual(repr(pickle.loads(pickle.dumps(raised.exception))), repr(raised.exception))
                with self.assertRaises(softgrip.UnreadableFile) as raised:
                    read(plain_file / "x.yaml")
                self.assertIsInstance(raised.exception, OSError)
                with self.assertRaises(softgrip.MalformedFile) as raised:
                    read(plain_file)
                self.assertNotIsInstance(raised.exception, OSError)

    def test_an_exception_can_be_pickled(self):
        with self.assertRaises(softgrip.InvalidArgument) as caught:
            Model.load(MODEL).simulate([0, 1], [0, np.nan])
        copy = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((copy.argument, str(copy)), (caught.exception.argument, str(caught.exception)))

    def test_logs_and_validations_are_plotted(self):
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        log = simulated()
        self.assertEqual(len(log.plot()), 2)
        found = validate(Model.load(MODEL), log)
        upper, _ = found.plot(axes=plt.subplots(2, 1)[1])
        self.assertIn("RMSE", upper.get_title())
        with self.assertRaises(softgrip.InvalidArgument):
            found.plot("no such log")
        plt.close("all")

    def test_all_doctests_of_the_package_pass(self):
        before = os.getcwd()
        os.chdir(SOURCE)
        try:
            attempted = 0
            for name in ("models", "analysis", "control", "results"):
                module = __import__(f"softgrip.{name}", fromlist=["x"])
                failed, tried = doctest.testmod(module)
                attempted += tried
                self.assertEqual(failed, 0, name)
            self.assertGreater(attempted, 10)
        finally:
            os.chdir(before)


class Imports(unittest.TestCase):
    def run_python(self, program):
        return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python")})

    def test_the_client_can_be_imported_without_numpy(self):
        done = self.run_python("import sys; sys.modules['numpy'] = None; import softgrip; print(softgrip.Gripper.__name__)\n"
                               "try: softgrip.Model\nexcept ImportError as error: print(error)")
        self.assertEqual(done.stdout.splitlines()[0], "Gripper", done.stderr)
        self.assertIn("softgrip.Model needs python3-numpy", done.stdout)

    def test_an_import_loads_neither_numpy_nor_the_library(self):
        done = self.run_python("import time; began = time.process_time(); import softgrip, sys\n"
                               "print(time.process_time() - began, 'numpy' in sys.modules, 'softgrip._core' in sys.modules)")
        took_s, *loaded = done.stdout.split()
        self.assertEqual(loaded, ["False", "False"], done.stderr)
        self.assertLess(float(took_s), 0.15)


class HostileArguments(unittest.TestCase):
    """Tests that an invalid argument of any type raises an exception of the package and does not crash the
    process."""

    BAD = [None, "", "text", b"bytes", 1j, [], [[]], [1, 2, 3], [1], [np.nan, np.nan], [np.inf, 0], [0, -1], {}, {1: 2},
           object(), np.zeros((2, 2)), np.zeros(0), np.array(["a", "b"]), np.array([None, 1]), [True, False], 1e308,
           np.array([1e308, -1e308]), range(2), np.arange(2)[::-1], -1, 2**70, float("nan"), True, lambda: 0,
           np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[s]"), "a\0b", [0, 1e-320]]

    def refused(self, call):
        """Calls the function with each invalid value. Returns the number of values that the function refused."""
        count = 0
        for bad in self.BAD:
            try:
                call(bad)
            except (softgrip.SoftgripError, OSError):
                count += 1
        return count

    def test_model_functions_reject_invalid_arguments(self):
        model = Model.load(MODEL)
        t = [0.0, 0.01]
        calls = [Model, Model.load, Model.parse, lambda bad: Model.parse("name: x", bad),
                 lambda bad: model.simulate(bad, t), lambda bad: model.simulate(t, bad),
                 lambda bad: model.simulate(t, t, noise=bad), lambda bad: model.simulate(t, t, seed=bad),
                 lambda bad: model.simulate(t, t, supply=[] if bad is None else bad),
                 lambda bad: model.inverse(bad, t), lambda bad: model.inverse(t, bad),
                 lambda bad: model.inverse(t, t, pressure_max=bad), lambda bad: model.inverse(t, t, slew_up=bad),
                 lambda bad: model.inverse(t, t, start=bad), lambda bad: model.with_parameter(bad, 1),
                 lambda bad: model.with_parameter("transport_delay.delay_s", bad)]
        for number, call in enumerate(calls):
            self.assertGreater(self.refused(call), len(self.BAD) // 2, number)

    def test_log_functions_reject_invalid_arguments(self):
        t = np.arange(50) * 0.1
        for number, call in enumerate([lambda bad: Log(bad, t, t), lambda bad: Log(t, bad, t), lambda bad: Log(t, t, bad),
                                       lambda bad: Log(t, t, t, unit=bad), lambda bad: Log(t, t, t, name=bad).check(),
                                       Log.read, lambda bad: Log.read("/no/such", channel=bad)]):
            self.assertGreater(self.refused(call), len(self.BAD) // 2, number)

    def test_analysis_functions_reject_invalid_arguments(self):
        model, log = Model.load(MODEL), simulated()
        for number, call in enumerate([
                identify, lambda bad: identify(log, bad), lambda bad: identify([bad]),
                lambda bad: identify(log, fit_share=bad, starts=1), lambda bad: identify(log, starts=1, drive=bad),
                lambda bad: identify(log, starts=1, start="x" if bad is None else bad),
                lambda bad: identify(log, starts=1, progress="x" if bad is None or callable(bad) else bad),
                lambda bad: validate(bad, log), lambda bad: validate(model, bad), lambda bad: validate(model, log, drive=bad),
                lambda bad: diagnose(bad, log), lambda bad: diagnose(model, bad)]):
            self.assertGreater(self.refused(call), len(self.BAD) // 2, number)

    def test_identify_rejects_invalid_parameter_names_and_numbers(self):
        log = simulated()
        for bad in ({"fixed": "text"}, {"fixed": [1]}, {"fixed": 1}, {"fixed": ["no.such"]}, {"starts": 0}, {"starts": 1.5},
                    {"starts": 2**70}, {"branches": 9}, {"seed": -1}, {"threads": 10**6}, {"fit_share": 0}):
            with self.assertRaises(softgrip.SoftgripError, msg=bad):
                identify(log, **bad)

    def test_an_error_message_states_argument_shape_and_unit(self):
        with self.assertRaisesRegex(softgrip.InvalidArgument, r"pressure: shape \(2, 2\); .* in kPa") as caught:
            Model.load(MODEL).simulate([0, 1], np.zeros((2, 2)))
        self.assertEqual(caught.exception.argument, "pressure")

    def test_an_error_message_begins_with_the_name_of_the_python_argument(self):
        model, t = Model.load(MODEL), [0.0, 0.01]
        for name, call in (("t", lambda: model.simulate([1, 0], t)), ("pressure", lambda: model.simulate(t, [1])),
                           ("start", lambda: model.inverse(t, t, start=-1)), ("slew_up", lambda: model.inverse(t, t, slew_up=0)),
                           ("name", lambda: model.with_parameter("no.such", 1)),
                           ("fixed", lambda: identify(simulated(), fixed=["no.such"])),
                           ("free", lambda: identify(simulated(), start=model, free=["no.such"])),
                           ("t", lambda: Log([1, 0], t, t).check())):
            with self.assertRaisesRegex(softgrip.InvalidArgument, f"^{name}: ") as caught:
                call()
            self.assertEqual(caught.exception.argument, name)

    def test_invalid_flags_mappings_and_encodings_are_rejected(self):
        model, t, log = Model.load(MODEL), [0.0, 0.01], simulated()
        for name, call in (("held", lambda: model.simulate(t, t, held=np.array([True, False]))),
                           ("robust", lambda: identify(log, starts=1, robust="no")),
                           ("import_file", lambda: Log.read("x.csv", import_file=[1, 2])),
                           ("columns", lambda: Log.read("x.csv", columns=3)),
                           ("units", lambda: Log.read("x.csv", units=b"3")),
                           ("path", lambda: Model.load("\ud800")), ("name", lambda: model.with_parameter("\ud800", 1)),
                           ("noise", lambda: model.simulate(t, t, noise=np.array([1.0]))),
                           ("noise", lambda: model.simulate(t, t, noise=np.complex128(1))),
                           ("seed", lambda: model.simulate(t, t, seed=np.float64(1)))):
            with self.assertRaisesRegex(softgrip.InvalidArgument, f"^{name}: "):
                call()

    def test_read_only_and_strided_arrays_are_accepted(self):
        model = Model.load(MODEL)
        t, pressure = sine()
        expected = model.simulate(t, pressure)
        for array in (t, pressure):
            array.flags.writeable = False
        np.testing.assert_array_equal(model.simulate(t, pressure), expected)
        doubled = np.repeat(pressure, 2)
        np.testing.assert_array_equal(model.simulate(t, doubled[::2]), expected)
        np.testing.assert_array_equal(model.simulate(list(t), pressure.tolist()), expected)

    def test_an_unaligned_array_is_copied(self):
        unaligned = np.frombuffer(b"x" + np.arange(3.0).tobytes(), dtype=np.float64, offset=1)
        self.assertFalse(unaligned.flags.aligned)
        log = Log(unaligned, unaligned, unaligned)
        self.assertTrue(log.t.flags.aligned)
        np.testing.assert_array_equal(log.t, [0, 1, 2])


class Threads(unittest.TestCase):
    def test_other_threads_run_during_a_fit(self):
        log, ticks, done = simulated(), [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)
        other = threading.Thread(target=tick)
        other.start()
        identify(log, starts=50, threads=1)
        done.set()
        other.join()
        self.assertGreater(len(ticks), 3)  # if the fit held the GIL, the other thread would have added only one entry
                                           # to `ticks`

    def test_concurrent_fits_give_equal_models(self):
        from concurrent.futures import ThreadPoolExecutor
        log = simulated()
        with ThreadPoolExecutor(3) as pool:
            found = list(pool.map(lambda _: identify(log, starts=2).model, range(3)))
        self.assertEqual(len(set(found)), 1)

    def test_an_exception_of_the_callback_ends_the_call(self):
        def progress(stage):
            raise KeyError(stage)
        with self.assertRaises(KeyError):
            identify(simulated(), starts=1000, progress=progress)

    def test_ctrl_c_ends_a_call_within_a_second(self):
        t, pressure = sine(samples=300_000, step_s=0.005)
        model = Model.load(MODEL)
        long_log = Log(t, pressure, model.simulate(t, pressure, noise=0.05))
        start = time.monotonic()
        long_log.check()
        check_s = time.monotonic() - start  # validate() first checks the log, and then estimates its initial state
        for name, delay_s, call in (("identify", 0.3, lambda: identify(simulated(), starts=10000)),
                                    ("validate", 1.3 * check_s, lambda: validate(model, long_log, begin="unknown"))):
            began = []

            def interrupt():
                time.sleep(delay_s)
                began.append(time.monotonic())
                os.kill(os.getpid(), signal.SIGINT)
            with self.subTest(call=name):
                other = threading.Thread(target=interrupt)
                other.start()
                with self.assertRaises(KeyboardInterrupt):
                    call()
                self.assertLess(time.monotonic() - began[0], 1)
                other.join()


if __name__ == "__main__":
    unittest.main()
