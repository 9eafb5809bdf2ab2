"""Tests how the clients interpret the lines that the daemon sends. The tests use no socket."""

import json
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
    def test_what_came_and_went_is_still_found(self):
        told = Events()
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        for code in ("HOLDING", "RELEASED"):
            told.tell("overall_result", code)
        told.tell("sequence_finished", "done")
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.DONE)
        self.assertFalse(told.session.starts)

    def test_another_end_than_was_waited_for_is_an_error(self):
        told = Events()
        told.tell("overall_result", "NO PART")
        with self.assertRaises(softgrip.GripFailed) as raised:
            told.reached(softgrip.Result.HOLDING)
        self.assertEqual(raised.exception.result, softgrip.Result.NO_PART)
        told.tell("sequence_finished", "failed")
        with self.assertRaises(softgrip.GripFailed) as raised:
            told.reached(softgrip.Result.HOLDING)
        self.assertEqual(raised.exception.end, softgrip.SequenceEnd.FAILED)

    def test_a_failure_may_be_what_is_waited_for(self):
        told = Events()
        told.tell("overall_result", "PART LOST")
        self.assertEqual(told.reached(softgrip.Result.PART_LOST), softgrip.Result.PART_LOST)

    def test_grips_of_others_do_not_count(self):
        told = Events()
        told.tell("overall_result", "HOLDING", request=2)
        told.tell("sequence_finished", "done", request=2)
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))
        self.assertEqual(list(told.session.starts.values()), [3])

    def test_events_before_the_answer_to_the_start_count(self):
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

    def test_a_subscription_goes_on_where_it_was(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        self.assertEqual(told.session.subscription(), {"since": 1, "started_at": "first"})
        told.session.subscribed({"since": 1, "started_at": "first"})
        self.assertTrue(told.session.starts)
        told.session.subscribed({"since": 0, "started_at": "second"})
        self.assertEqual(told.session.ended(), softgrip.SequenceEnd.FAULTED)
        self.assertFalse(told.session.starts, "what ran has ended with the daemon before")

    def test_another_daemon_counts_its_requests_anew(self):
        told = Events()
        told.tell("overall_result", "HOLDING")
        told.session.subscribed({"since": 0, "started_at": "second"})
        # The reply belongs to a request to the new daemon. Requests to the old and to the new daemon can have the same
        # number.
        told.tell("overall_result", "RELEASED")
        self.assertEqual(told.reached(softgrip.Result.HOLDING), softgrip.Result.HOLDING)
        told.session.grip = 3
        self.assertFalse(told.session.ended())
        self.assertEqual(told.reached(softgrip.Result.RELEASED), softgrip.Result.RELEASED)

    def test_results_of_one_finger_are_not_those_of_all(self):
        told = Events()
        told.tell("grip_result", "HOLDING")
        self.assertIsNone(told.reached(softgrip.Result.HOLDING))


class Starts(unittest.TestCase):
    def test_a_start_is_remembered_from_before_it_is_sent_until_it_cannot_run(self):
        session = Session()
        number, sent = session.request("start", {"sequence": "pick"})
        (start_id,) = session.starts
        self.assertEqual(json.loads(sent)["start_id"], start_id)
        session.forget(number)  # If an exception ends the wait for the reply, the client forgets the request.
        session.receive(line(id=number, ok=True, result={"request": 5}))
        self.assertEqual(session.starts, {start_id: 5})
        self.assertEqual(session.grip, 5)
        self.assertFalse(session.replies)

    def test_a_refused_start_does_not_run_and_one_without_an_answer_may(self):
        for error, runs in (({"code": "busy", "message": "m"}, False), ({"code": "no_answer", "message": "m"}, True),
                            ({"code": "refused", "message": "without its reason"}, True),
                            ({"code": "too_many_clients", "message": "m"}, True),
                            ({"code": "owned", "message": "m", "owner": "robot"}, False)):
            session = Session()
            number, _ = session.request("start", {"sequence": "pick"})
            session.receive(line(id=number, ok=False, error=error))
            self.assertEqual(bool(session.starts), runs, error)

    def test_a_start_that_is_refused_leaves_the_one_that_runs(self):
        told = Events()
        (own,) = told.session.starts
        number, _ = told.session.request("start", {"sequence": "pick"})
        told.session.receive(line(id=number, ok=False, error={
            "code": "refused", "message": "m", "refusal": {"code": "R02", "name": "not_idle"}}))
        self.assertEqual(told.session.starts, {own: 3})
        self.assertEqual(told.session.grip, 3)

    def test_no_two_starts_have_the_same_id_and_a_dry_run_has_none(self):
        session = Session()
        for _ in range(100):
            session.request("start", {"sequence": "pick"})
        self.assertEqual(len(session.starts), 100)
        _, sent = session.request("start", {"sequence": "pick", "dry_run": True})
        self.assertNotIn("start_id", json.loads(sent))
        self.assertEqual(len(session.starts), 100)

    def test_an_older_daemon_starts_nothing(self):
        session = Session()
        session.greeted(softgrip.Hello(1, "1.0", "first", "operate", ("start",), ("owner", "dry_run")))
        with self.assertRaisesRegex(softgrip.ProtocolError, "older"):
            session.request("start", {"sequence": "pick"})
        self.assertFalse(session.starts)
        session.request("status", {})
        session.request("start", {"sequence": "pick", "dry_run": True})


class Replies(unittest.TestCase):
    def test_come_to_who_asked_in_any_order(self):
        session = Session()
        first, first_line = session.request("status", {})
        second, _ = session.request("stop", {})
        self.assertEqual(json.loads(first_line), {"id": first, "command": "status"})
        session.receive(line(id=second, ok=True, result={"request": 9}))
        session.receive(line(id=first, ok=True, result={}))
        self.assertEqual(session.result_of(second), {"request": 9})
        self.assertEqual(session.result_of(first), {})

    def test_errors_are_exceptions(self):
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

    def test_what_is_no_line_of_the_daemon_is_an_error(self):
        for text in (b"HTTP/1.1 400 Bad Request", b"[]", b""):
            with self.assertRaises(softgrip.ProtocolError):
                Session().receive(text)

    def test_what_cannot_be_said_in_json_is_not_sent(self):
        with self.assertRaises(ValueError):
            Session().request("start", {"parameters": {"squeeze_kpa": float("nan")}})


if __name__ == "__main__":
    unittest.main()
