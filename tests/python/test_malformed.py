"""Tests the package with lines that softgripd never sends. Each line must raise a ProtocolError or have no effect. No
line may raise a built-in exception of Python."""

import json
import random
import unittest

import package  # noqa: F401
import softgrip
from softgrip.messages import Checked, Listing, Status
from softgrip.session import LONGEST_LINE, Session

SEEDS = 300

PROBLEM = {"file": "a.yaml", "line": 3, "column": 5, "line_text": "x", "message": "no", "hint": ""}
EVENT = {"id": 7, "time_s": 1.5, "at": "2026-11-21T09:00:00.000Z", "kind": "overall_result", "severity": "information",
         "text": "The result is HOLDING.", "code": "HOLDING", "request": 3, "client": "cell", "value": 1.5,
         "parameters": {"squeeze_kpa": 4}}
CHANNEL = {"name": "left", "command_kpa": 1, "pressure_kpa": None, "displacement_mm": 2.5, "reference_mm": None,
           "residual_mm": 0, "deficit_mm": None, "squeeze_kpa": None, "age_s": 0.01, "validity": "valid",
           "result": "HOLDING", "evidence": "none", "limit": None, "health": "healthy"}
STATUS = {"state": "running", "result": "HOLDING", "channels": [CHANNEL], "owner": None, "rig": "r", "version": "1",
          "rate_hz": 100, "time_s": 5.5,
          "fault": {"code": "F202", "name": "n", "meaning": "m", "remedy": "r", "channel": None, "next": "x"},
          "sequence": {"name": "pick", "request": 3, "client": None, "parameters": {"a": 1}, "step": 0, "step_name": "s",
                       "steps": 2, "ended": None}}
PARAMETER = {"name": "a", "unit": "kpa", "lower": 0, "upper": 9, "default": 4, "about": ""}
# Maps each request to a valid result of the request and to the function of the package that reads this result.
RESULTS = {
    "status": (STATUS, lambda result: Status.of(result, "status")),
    "sequences": ({"sequences": [{"name": "a", "about": "", "parameters": [PARAMETER], "problems": [PROBLEM]}]},
                  lambda result: Listing.of(result, "sequences")),
    "start": ({"request": 3, "warnings": [PROBLEM]}, lambda result: None),
    "check": ({"request": 3, "would_start": {"name": "a", "parameters": {}, "steps": 2}, "warnings": [PROBLEM]},
              lambda result: Checked.of(result, "start")),
    "subscribe": ({"since": 3, "oldest": 1, "newest": 9, "started_at": "x"}, lambda result: Session().subscribed(result)),
    "hello": ({"api": 1, "version": "1", "started_at": "x", "role": "operate", "client": None, "commands": ["start"],
               "capabilities": ["start_id"], "bounds": {}}, lambda result: softgrip.Hello.of(result, "hello")),
}
ERRORS = ({"code": "refused", "message": "m", "refusal": {"code": "R02", "name": "not_idle"}, "request": 4},
          {"code": "sequence_refused", "message": "m", "problems": [PROBLEM]}, {"code": "busy", "message": "m"})
OTHERS = (None, True, False, 0, -1, 1.5, 10**400, "", "x", "\ud800", [], [1], {}, {"a": None}, [[[]]])


class DeprecatedNames(unittest.TestCase):
    def test_a_new_name_has_the_value_of_the_deprecated_name(self):
        channel = Status.of({**STATUS, "channels": [{**CHANNEL, "deficit_mm": 1.5}]}, "status").channels[0]
        self.assertEqual((channel.shortfall_mm, channel.deficit_mm), (1.5, 1.5))
        hello = RESULTS["hello"][0]
        for role, read_only in (("look", True), ("operate", False)):
            self.assertIs(softgrip.Hello.of({**hello, "role": role}, "hello").read_only, read_only)


def places(value, path=()):
    """Yields the path of `value` and the paths of all values inside `value`. The test replaces the value at each
    path."""
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from places(value[key], (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from places(item, (*path, index))


def put(value, path, other):
    """Returns a copy of `value` with `other` at `path`. If `other` is the function `put` itself, the copy has no
    value at `path`."""
    if not path:
        return other
    copy = dict(value) if isinstance(value, dict) else list(value)
    if len(path) == 1 and other is put:
        del copy[path[0]]
    else:
        copy[path[0]] = put(copy[path[0]], path[1:], other)
    return copy


class Malformed(unittest.TestCase):
    def hear(self, command, said):
        """Sends the request `command` and passes the line `said` to the session as the reply to this request.
        Returns "taken", "malformed" or "error"."""
        session = Session()
        session.subscribed({"since": 0, "started_at": "x"})
        number, _ = session.request("start" if command == "check" else command,
                                    {"dry_run": True} if command == "check" else {})
        try:
            session.receive(said if isinstance(said, bytes) else json.dumps(said).encode())
            if number in session.replies:
                RESULTS[command][1](session.result_of(number))
            session.reached(frozenset(softgrip.Result))
            return "taken"
        except softgrip.ProtocolError as error:
            self.assertNotEqual(str(error), "")
            return "malformed"
        except softgrip.SoftgripError:
            return "error"

    def test_no_replaced_value_raises_a_built_in_exception(self):
        heard = {}
        for command, (result, _) in RESULTS.items():
            lines = [{"id": 1, "ok": True, "result": result}, {"id": 4, "event": EVENT}]
            lines += [{"id": 1, "ok": False, "error": error} for error in ERRORS]
            lines.append({"id": None, "ok": False, "error": ERRORS[-1]})
            for line in lines:
                self.assertNotEqual(self.hear(command, line), "malformed", line)
                for path in places(line):
                    for other in (*OTHERS, *([put] if path else [])):
                        with self.subTest(command=command, path=path, other=str(other)[:20]):
                            outcome = self.hear(command, put(line, path, other))
                            heard[outcome] = heard.get(outcome, 0) + 1
        self.assertGreater(heard["malformed"], 1000, heard)

    def test_damaged_bytes_raise_no_built_in_exception(self):
        whole = [json.dumps({"id": 1, "ok": True, "result": STATUS}).encode(),
                 json.dumps({"id": 4, "event": EVENT}).encode()]
        for seed in range(SEEDS):
            chance = random.Random(seed)
            text = bytearray(chance.choice(whole))
            for _ in range(chance.randrange(1, 4)):
                at = chance.randrange(len(text))
                if chance.random() < 0.5:
                    text[at] = chance.randrange(256)
                else:
                    del text[at:at + chance.randrange(1, 40)]
            with self.subTest(seed=seed):
                self.hear("status", bytes(text))

    def test_invalid_json_raises_a_protocol_error(self):
        for text in (b"", b"\xff", b"[" * 100_000, b"{\"a\":" * 100_000, b"{\"event\":NaN}", b"{\"id\":1,\"ok\":Infinity}",
                     b"1" * 100_000):
            self.assertEqual(self.hear("status", text), "malformed", text[:20])
        for number in (b"NaN", b"Infinity", b"1e999", b"1" + b"0" * 400):
            said = json.dumps({"id": 1, "ok": True, "result": STATUS}).encode().replace(b"5.5", number)
            self.assertEqual(self.hear("status", said), "malformed", number[:20])

    def test_the_error_states_the_path_of_the_malformed_value(self):
        for path, other, text in ((("channels", 0, "age_s"), "1", "status.channels[0].age_s is not a finite number"),
                                  (("state",), "dancing", "status.state is not one of starting, idle"),
                                  (("sequence", "step"), 1.5, "status.sequence.step is not a whole number"),
                                  (("fault", "next"), put, "status.fault lacks 'next'")):
            with self.assertRaisesRegex(softgrip.ProtocolError, text.replace("[", r"\[")):
                Status.of(put(STATUS, path, other), "status")

    def test_replies_without_a_request_are_not_kept(self):
        session = Session()
        for number in range(10_000):
            session.receive(json.dumps({"id": number, "ok": True, "result": {}}).encode())
        self.assertEqual(len(session.replies), 0)
        self.assertGreater(LONGEST_LINE, 1 << 20)


if __name__ == "__main__":
    unittest.main()
