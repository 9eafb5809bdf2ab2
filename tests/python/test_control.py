"""Tests limits, PID, controller and boards from Python. Checks numerical results and the exceptions for invalid
arguments.

Needs the folder python of a build (SOFTGRIP_BUILD). This folder contains the extension module.
"""

import math
import os
import pathlib
import pickle
import sys
import threading
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("SOFTGRIP_BUILD", SOURCE / "build/release"))
sys.path.insert(0, str(BUILD / "python"))

import softgrip
from softgrip import (Controller, Limits, Model, Pid, PidSettings, Reading, Reference, SimulatedBoard, SimulatedFinger,
                      SimulatedObject, limit)

MODEL = SOURCE / "config/models/bench_twin.yaml"


class Parts(unittest.TestCase):
    def test_commands_are_limited_and_invalid_limits_are_rejected(self):
        limits = Limits(pressure_min=5, pressure_max=60, slew_up=100, slew_down=50)
        self.assertEqual(limit(limits, 50, 10, 0.1).command, 20)
        self.assertEqual(limit(limits, 0, 10, 0.1).command, 5)
        self.assertTrue(limit(limits, 70, 60, 0.1).saturated)
        held = limit(limits, math.nan, 10, 0.1)
        self.assertEqual((held.command, held.invalid), (10, True))
        for bad in ({"pressure_max": 0}, {"pressure_max": 5, "pressure_min": math.nan}, {"pressure_max": 5, "slew_up": 0},
                    {"pressure_max": 5, "displacement_max": -2e6}, {"pressure_max": "5"}, {"pressure_max": 5, "rest": None}):
            with self.assertRaises(softgrip.InvalidArgument, msg=bad):
                Limits(**bad)
        for bad in (lambda: limit(3, 1, 0, 0.1), lambda: limit(limits, 1, math.nan, 0.1), lambda: limit(limits, 1, 0, -1)):
            with self.assertRaises(softgrip.InvalidArgument):
                bad()

    def test_a_pid_integrates_until_its_output_saturates(self):
        pid = Pid(PidSettings(kp=2, ki=10, tracking_time=0.1), tick=0.1)
        free = [pid.step(1, 0) for _ in range(3)]
        self.assertEqual(free, [2, 3, 4])
        limited = Pid(PidSettings(kp=2, ki=10, tracking_time=0.1), tick=0.1)
        for _ in range(100):
            limited.step(1, 0)
            limited.sent(3)
        self.assertLess(limited.step(1, 0), 6)
        aligned = Pid(PidSettings(kp=2, ki=10), tick=0.1)
        aligned.align(7)
        self.assertEqual(aligned.step(0, 0), 7)
        for name, bad in (("kp", PidSettings(kp=math.nan)), ("derivative_filter", PidSettings(derivative_filter=-1)),
                          ("tracking_time", PidSettings(tracking_time=0)), ("setpoint_weight", PidSettings(setpoint_weight=2)),
                          ("anti_windup", PidSettings(anti_windup="no such"))):
            with self.assertRaisesRegex(softgrip.InvalidArgument, f"^{name}: "):
                Pid(bad, 0.1)
        with self.assertRaisesRegex(softgrip.InvalidArgument, "^tick: "):
            Pid(PidSettings(), 0)

    def test_a_reference_accepts_at_most_eight_segments(self):
        reference = Reference(2)
        for _ in range(7):
            reference.ramp_to(4, 1).at(0.5)
        with self.assertRaisesRegex(softgrip.InvalidArgument, "8 segments"):
            for _ in range(3):
                reference.hold_for(1)
        self.assertEqual(reference.at(-1), 2)
        for bad in (lambda: Reference(math.inf), lambda: Reference().ramp_to(1, 0), lambda: Reference().hold_for(math.nan),
                    lambda: Reference().sine(1, 1, 0, 1), lambda: Reference().at("now")):
            with self.assertRaises(softgrip.InvalidArgument):
                bad()


class Boards(unittest.TestCase):
    def test_a_simulated_board_simulates_free_and_blocked_fingers(self):
        model = Model.load(MODEL)
        board = SimulatedBoard([SimulatedFinger(model), SimulatedFinger(model, SimulatedObject(4))])
        board.connect()
        for _ in range(1000):
            free, blocked = board.exchange([20, 20])
            board.advance(0.005)
        self.assertGreater(free.displacement, 9)
        self.assertLess(blocked.displacement, 5)
        self.assertEqual((free.validity, free.sequence, board.channels), ("valid", 1000, 2))
        self.assertAlmostEqual(board.now, 6)
        self.assertAlmostEqual(board.displacement(0), free.displacement, delta=0.05)
        board.set_object(1, None)
        self.assertIsInstance(board, softgrip.Board)
        self.assertIn("simulated", board.describe())
        self.assertEqual(repr(pickle.loads(pickle.dumps(free))), repr(free))

    def test_displacement_and_objects_apply_at_the_time_of_the_clock(self):
        board = SimulatedBoard([SimulatedFinger(Model.load(MODEL))])
        board.connect()
        board.exchange([30])
        board.advance(5)
        moved = board.displacement()
        self.assertGreater(moved, 5)
        board.set_object(0, SimulatedObject(2, 0))
        self.assertEqual(board.displacement(), moved, "the object does not move the finger at once")

    def test_other_threads_run_during_a_long_exchange(self):
        board = SimulatedBoard([SimulatedFinger(Model.load(MODEL))])
        board.connect()
        board.exchange([30])
        board.advance(10000)
        other = threading.Thread(target=lambda: board.exchange([20]))
        other.start()
        count = 0
        while other.is_alive():
            time.sleep(0.001)
            count += 1
        other.join()
        self.assertGreater(count, 20, "the exchange held the global interpreter lock")

    def test_two_boards_with_the_same_seed_give_equal_readings(self):
        model = Model.load(MODEL)

        def played():
            board = SimulatedBoard([SimulatedFinger(model, noise=0.03, seed=5)])
            board.connect()
            readings = []
            for i in range(200):
                readings.append(board.exchange([0.1 * i])[0].displacement)
                board.advance(0.005)
            return readings
        self.assertEqual(played(), played())

    def test_a_controller_follows_a_reference_and_vents_without_readings(self):
        model = Model.load(MODEL)
        board = SimulatedBoard([SimulatedFinger(model)])
        with self.assertRaisesRegex(softgrip.BusError, "^disconnected: "):
            board.exchange([0])
        board.connect()
        controller = Controller(model, Limits(pressure_max=80), PidSettings(kp=2.7, ki=13), extra_latency=0.005)
        controller.follow(Reference(0, start=1).ramp_to(6, 2).hold_for(5))
        command = 0
        while board.now < 6:
            reading, = board.exchange([command])
            output = controller.tick(board.now, reading)
            command = output.command
            board.advance(0.005)
        self.assertAlmostEqual(output.reference, 6)
        self.assertAlmostEqual(board.displacement(), 6, delta=0.05)
        old = controller.tick(board.now + 10, reading)
        self.assertEqual(old.validity, "stale")
        controller.vent()
        for i in range(200):
            output = controller.tick(board.now + 10 + 0.005 * i, Reading(math.nan, validity="none_yet"))
        self.assertEqual(output.command, 0)

    def test_boards_and_controllers_reject_invalid_arguments(self):
        model = Model.load(MODEL)
        finger = SimulatedFinger(model)
        board = SimulatedBoard([finger])
        controller = Controller(model, Limits(pressure_max=80))
        reading = Reading(0)
        for name, call in (
                ("fingers", lambda: SimulatedBoard([])), ("fingers", lambda: SimulatedBoard([model])),
                ("fingers", lambda: SimulatedBoard([finger] * 17)), ("fingers", lambda: SimulatedBoard(3)),
                ("noise", lambda: SimulatedBoard([SimulatedFinger(model, noise=-1)])),
                ("object", lambda: SimulatedBoard([SimulatedFinger(model, object=3)])),
                ("tick", lambda: SimulatedBoard([finger], math.nan)), ("commands", lambda: board.exchange([1, 2])),
                ("commands", lambda: board.exchange(3)), ("commands", lambda: board.exchange(["3"])),
                ("deadline", lambda: board.exchange([1], -1)), ("duration", lambda: board.advance(-1)),
                ("duration", lambda: board.advance(math.nan)), ("duration", lambda: board.advance(1e300)),
                ("channel", lambda: board.displacement(1)), ("channel", lambda: board.set_object(-1, None)),
                ("object", lambda: board.set_object(0, SimulatedObject(1, 2))),
                ("model", lambda: Controller(3, Limits(pressure_max=80))), ("limits", lambda: Controller(model, None)),
                ("feedforward", lambda: Controller(model, Limits(pressure_max=80), feedforward="no such")),
                ("tick", lambda: Controller(model, Limits(pressure_max=80), tick=2)),
                ("reading", lambda: controller.tick(1, 3)), ("now", lambda: controller.tick(math.inf, reading)),
                ("validity", lambda: controller.tick(1, Reading(0, validity="good"))),
                ("sequence", lambda: controller.tick(1, Reading(0, sequence=2**40))),
                ("reference", lambda: controller.follow(6)), ("pressure", lambda: controller.pressure(math.nan))):
            with self.assertRaisesRegex(softgrip.InvalidArgument, f"^{name}: "):
                call()

    def test_a_bus_error_can_be_pickled(self):
        error = pickle.loads(pickle.dumps(softgrip.BusError("timed_out", "no response")))
        self.assertEqual((error.status, error.detail, str(error)), ("timed_out", "no response", "timed_out: no response"))


if __name__ == "__main__":
    unittest.main()
