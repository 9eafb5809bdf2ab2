"""Tests how the clients interpret the lines that the daemon sends. The tests use no socket."""

import copy
import json
import pickle
import unittest

import package  # noqa: F401
import softgrip
from softgrip import errors
from softgrip.session import Session


def line(**said):
    return json.dumps(said).encode()


class Events:
    """A client session that receives the events of one grip."""

    def __init__(self, request=3):
        self.session = Session()
        self.session.subscribed({"since": 0, "started_at": "first"})
        self.id = 0
        self.number, _ = self.session.request("start", {"sequence": "pick"})
        if request:
            self.reply(ok=True, result={"request": request})

    def reply(self, **said):
        self.session.receive(line(id=self.number, **said))

    def tell(self, kind, code, request=3):
        self.id += 1
        self.session.receive(line(id=1, event={"id": self.id, "time_s": 1.5, "at": "2026-11-21T09:00:00.000Z",
                                               "kind": kind, "severity": "information", "text": "It is told.",
                                               "code": code, "request": request}))

    def reached(self, *wanted):
        return self.session.reached(frozenset(wanted))


class Story(unittest.TestCase):
    def test_a_result_that_has_passed_is_still_reported(self):
        told = Events()
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        for code in ("HOLDING", "RELEASED"):
            told.tell("overall_result", code)
        told.tell("sequence_finished", "done")
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.DONE)
        self.assertFalse(told.session.starts)

    def test_a_result_is_returned_again_until_a_later_result(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        for _ in range(3):
            self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        self.assertIsNone(told.reached(softgrip.Result.RELEASED))
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        told.tell("overall_result", "RELEASED")
        self.assertIsNone(told.reached(softgrip.Result.HOLDING), "the hold that was received has ended")
        told.tell("overall_result", "HOLDING")
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        told.tell("sequence_finished", "done")
        with self.assertRaises(softgrip.GripFailed):
            told.reached(softgrip.Result.HOLDING)

    def test_a_result_before_a_returned_result_is_not_returned_later(self):
        told = Events()
        for code in ("HOLDING", "RELEASED"):
            told.tell("overall_result", code)
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))

    def test_a_failure_takes_precedence_over_an_earlier_hold(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        told.tell("overall_result", "PART LOST")
        for _ in range(2):
            with self.assertRaises(softgrip.GripFailed) as raised:
                told.reached(softgrip.Result.HOLDING)
            self.assertEqual(raised.exception.result, softgrip.Result.PART_LOST)
        self.assertEqual(told.reached(softgrip.Result.HOLDING, softgrip.Result.PART_LOST), softgrip.Result.PART_LOST)

    def test_a_hold_of_a_stopped_sequence_is_not_reported(self):
        for end in ("stopped", "faulted", "failed"):
            told = Events()
            told.tell("overall_result", "HOLDING")
            told.tell("sequence_finished", end)
            with self.assertRaises(softgrip.GripFailed) as raised:
                told.reached(softgrip.Result.HOLDING)
            self.assertEqual((raised.exception.result, raised.exception.end.value), (softgrip.Result.HOLDING, end))

    def test_an_unexpected_result_or_end_raises_grip_failed(self):
        told = Events()
        told.tell("overall_result", "NO PART")
        with self.assertRaises(softgrip.GripFailed) as raised:
            told.reached(softgrip.Result.HOLDING)
        self.assertEqual(raised.exception.result, softgrip.Result.NO_PART)
        told.tell("sequence_finished", "failed")
        with self.assertRaises(softgrip.GripFailed) as raised:
            told.reached(softgrip.Result.HOLDING)
        self.assertEqual(raised.exception.end, softgrip.SequenceEnd.FAILED)

    def test_a_failure_result_can_be_awaited_without_an_exception(self):
        told = Events()
        told.tell("overall_result", "PART LOST")
        self.assertEqual(told.reached(softgrip.Result.PART_LOST), softgrip.Result.PART_LOST)

    def test_events_of_other_requests_are_ignored(self):
        told = Events()
        told.tell("overall_result", "HOLDING", request=2)
        told.tell("sequence_finished", "done", request=2)
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        self.assertEqual(list(told.session.starts.values()), [3])

    def test_events_before_the_reply_to_the_start_are_counted(self):
        told = Events(request=None)
        told.tell("overall_result", "HOLDING", request=7)
        told.reply(ok=True, result={"request": 7})
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        told = Events(request=None)
        told.tell("sequence_finished", "failed", request=7)
        self.assertEqual(list(told.session.starts.values()), [None], "the start's number is not known yet")
        told.reply(ok=True, result={"request": 7})
        self.assertFalse(told.session.starts)
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.FAILED)

    def test_a_subscription_resumes_and_a_restarted_daemon_ends_the_grip(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        self.assertEqual(told.session.subscription(), {"since": 1, "started_at": "first"})
        told.session.subscribed({"since": 1, "started_at": "first"})
        self.assertTrue(told.session.starts)
        told.session.subscribed({"since": 0, "started_at": "second"})
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.FAULTED)
        self.assertFalse(told.session.starts, "the sequence must have ended with the previous daemon")

    def test_equal_request_numbers_of_two_daemons_are_not_confused(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        told.session.subscribed({"since": 0, "started_at": "second"})
        # The reply belongs to a request to the new daemon. Requests to the old and to the new daemon can have the same
        # number.
        told.tell("overall_result", "RELEASED")
        with self.assertRaises(softgrip.GripFailed) as raised:
            told.reached(softgrip.Result.HOLDING)
        self.assertEqual((raised.exception.result, raised.exception.end),
                         (softgrip.Result.HOLDING, softgrip.SequenceEnd.FAULTED))
        told.session.grip = 3
        self.assertFalse(told.session.ended())
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)

    def test_the_result_of_one_finger_is_not_the_overall_result(self):
        told = Events()
        told.tell("grip_result", "HOLDING")
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))


class Starts(unittest.TestCase):
    def test_a_start_is_recorded_even_if_the_wait_for_the_reply_ends(self):
        session = Session()
        number, sent = session.request("start", {"sequence": "pick"})
        (start_id,) = session.starts
        self.assertEqual(json.loads(sent)["start_id"], start_id)
        session.forget(number)  # If an exception ends the wait for the reply, the client forgets the request.
        session.receive(line(id=number, ok=True, result={"request": 5}))
        self.assertEqual(session.starts, {start_id: 5})
        self.assertEqual(session.grip, 5)
        self.assertFalse(session.replies)

    def test_a_start_without_a_definite_refusal_counts_as_running(self):
        for error, runs in (({"code": "busy", "message": "m"}, False), ({"code": "no_answer", "message": "m"}, True),
                            ({"code": "refused", "message": "without its reason"}, True),
                            ({"code": "too_many_clients", "message": "m"}, True),
                            ({"code": "owned", "message": "m", "owner": "robot"}, False)):
            session = Session()
            number, _ = session.request("start", {"sequence": "pick"})
            session.receive(line(id=number, ok=False, error=error))
            self.assertEqual(bool(session.starts), runs, error)

    def test_a_refused_start_does_not_affect_the_running_start(self):
        told = Events()
        (own,) = told.session.starts
        number, _ = told.session.request("start", {"sequence": "pick"})
        told.session.receive(line(id=number, ok=False, error={
            "code": "refused", "message": "m", "refusal": {"code": "R02", "name": "not_idle"}}))
        self.assertEqual(told.session.starts, {own: 3})
        self.assertEqual(told.session.grip, 3)

    def start_again(self, told):
        """Ends the grip of `told` and sends another start. Returns the id of this start."""
        told.tell("overall_result", "HOLDING")
        told.tell("sequence_finished", "done")
        number, _ = told.session.request("start", {"sequence": "pick"})
        return number

    def assert_waits(self, told):
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        self.assertIsNone(told.session.ended())

    def assert_unknown(self, told):
        for ask in (lambda: told.reached(softgrip.Result.HOLDING), told.session.ended):
            with self.assertRaises(softgrip.NotAnswered):
                ask()

    def test_a_start_without_a_reply_does_not_have_the_result_of_the_previous_grip(self):
        told = Events()
        number = self.start_again(told)
        self.assert_waits(told)
        told.session.forget(number)  # start() has raised NotAnswered
        self.assert_waits(told)
        told.tell("overall_result", "RELEASED", request=4)
        told.session.receive(line(id=number, ok=True, result={"request": 4}))
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)
        told.tell("sequence_finished", "stopped", request=4)
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.STOPPED)

    def test_the_result_of_the_previous_grip_counts_again_after_a_refused_start(self):
        for code, restored in (("busy", True), ("owned", True), ("sequence_refused", True), ("bad_request", True),
                               ("no_answer", False)):
            told = Events()
            number = self.start_again(told)
            told.session.receive(line(id=number, ok=False, error={"code": code, "message": "m", "owner": "robot", "problems": []}))
            if restored:
                self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
                self.assertEqual(told.session.ended(), softgrip.SequenceEnd.DONE)
            else:
                self.assert_unknown(told)

    def test_the_result_of_a_start_whose_reply_was_lost_is_reported_as_unknown(self):
        told = Events()
        self.start_again(told)
        self.assert_waits(told)
        told.session.subscribed({"since": 2, "started_at": "first"})  # a new connection to the same daemon
        self.assert_unknown(told)
        number, _ = told.session.request("start", {"sequence": "pick"})
        self.assert_waits(told)
        told.session.receive(line(id=number, ok=True, result={"request": 5}))
        told.tell("sequence_finished", "done", request=5)
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.DONE)

    def test_a_late_reply_does_not_replace_a_later_start(self):
        told = Events()
        first = self.start_again(told)
        second, _ = told.session.request("start", {"sequence": "pick"})
        told.session.receive(line(id=second, ok=True, result={"request": 5}))
        self.assert_waits(told)
        told.session.receive(line(id=first, ok=True, result={"request": 4}))
        self.assertEqual(told.session.grip, 5)
        third, _ = told.session.request("start", {"sequence": "pick"})
        fourth, _ = told.session.request("start", {"sequence": "pick"})
        told.session.receive(line(id=third, ok=True, result={"request": 6}))
        told.tell("sequence_finished", "done", request=6)
        self.assert_waits(told)
        told.session.receive(line(id=fourth, ok=False, error={"code": "busy", "message": "m"}))
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.DONE)

    def test_a_restarted_daemon_ends_a_start_without_a_reply(self):
        told = Events()
        self.start_again(told)
        told.session.subscribed({"since": 0, "started_at": "second"})
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.FAULTED)
        with self.assertRaises(softgrip.GripFailed):
            told.reached(softgrip.Result.HOLDING)

    def test_each_start_has_a_unique_id_and_a_dry_run_has_none(self):
        session = Session()
        for _ in range(100):
            session.request("start", {"sequence": "pick"})
        self.assertEqual(len(session.starts), 100)
        _, sent = session.request("start", {"sequence": "pick", "dry_run": True})
        self.assertNotIn("start_id", json.loads(sent))
        self.assertEqual(len(session.starts), 100)

    def test_a_start_is_rejected_if_the_daemon_does_not_support_start_ids(self):
        session = Session()
        session.greeted(softgrip.Hello(1, "1.0", "first", "operate", ("start",), ("owner", "dry_run")))
        with self.assertRaisesRegex(softgrip.ProtocolError, "older"):
            session.request("start", {"sequence": "pick"})
        self.assertFalse(session.starts)
        session.request("status", {})
        session.request("start", {"sequence": "pick", "dry_run": True})


class Replies(unittest.TestCase):
    def test_replies_are_matched_to_their_requests_in_any_order(self):
        session = Session()
        first, first_line = session.request("status", {})
        second, _ = session.request("stop", {})
        self.assertEqual(json.loads(first_line), {"id": first, "command": "status"})
        session.receive(line(id=second, ok=True, result={"request": 9}))
        session.receive(line(id=first, ok=True, result={}))
        self.assertEqual(session.result_of(second), {"request": 9})
        self.assertEqual(session.result_of(first), {})

    def test_each_error_code_raises_its_exception_class(self):
        problem = {"file": "a.yaml", "line": 3, "column": 5, "line_text": "x", "message": "no", "hint": ""}
        for error, kind in (
                ({"code": "refused", "message": "m", "refusal": {"code": "R02", "name": "not_idle"}}, errors.Refused),
                ({"code": "sequence_refused", "message": "m", "problems": [problem]}, errors.SequenceRefused),
                ({"code": "owned", "message": "m", "owner": "robot"}, errors.Owned),
                ({"code": "not_allowed", "message": "m"}, errors.Refused),
                ({"code": "no_answer", "message": "m"}, errors.NotAnswered),
                ({"code": "bad_request", "message": "m"}, errors.ProtocolError)):
            session = Session()
            number, _ = session.request("start", {})
            session.receive(line(id=number, ok=False, error=error))
            with self.assertRaises(kind) as raised:
                session.result_of(number)
            self.assertIs(type(raised.exception), kind)
            if kind is errors.SequenceRefused:
                self.assertEqual(str(raised.exception), "m\na.yaml:3:5: no")

    def test_each_exception_can_be_pickled(self):
        problem = softgrip.messages.Problem("a.yaml", 3, 5, "x", "no", "")
        arguments = {errors.ProtocolError: ("m", "bad_request"), errors.Refused: ("m (x)", "R02", "not_idle"),
                     errors.Owned: ("m", "owned", "owned"), errors.SequenceRefused: ("m", (problem,)),
                     errors.GripFailed: (softgrip.Result.NO_PART, softgrip.SequenceEnd.FAILED),
                     errors.UnreadableFile: (13, "m", "file"), errors.MissingFile: (2, "m", "file"),
                     errors.InvalidArgument: ("time_s", "time_s: m"), errors.BusError: ("timed_out", "m")}
        kinds = [kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, Exception)]
        self.assertLessEqual(set(arguments), set(kinds))
        for kind in kinds:
            error = kind(*arguments.get(kind, ("m",)))
            for copied in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
                self.assertIs(type(copied), kind)
                self.assertEqual((str(copied), vars(copied)), (str(error), vars(error)))

    def test_a_line_that_is_not_a_json_object_raises_a_protocol_error(self):
        for text in (b"HTTP/1.1 400 Bad Request", b"[]", b""):
            with self.assertRaises(softgrip.ProtocolError):
                Session().receive(text)

    def test_a_request_with_a_nan_parameter_is_rejected(self):
        with self.assertRaises(ValueError):
            Session().request("start", {"parameters": {"squeeze_kpa": float("nan")}})


if __name__ == "__main__":
    unittest.main()
