"""The state of a connection without its socket: the requests and their results. The blocking client and the asyncio
client add the socket."""

from __future__ import annotations

import collections
import json
import os
from collections.abc import Mapping
from typing import Any, Optional

from .decoding import checked, parsed
from .errors import (ConnectionLost, GripFailed, NotAnswered, Owned, ProtocolError, Refused, SequenceRefused,
                     SoftgripError, StopNotConfirmed)
from .messages import Event, Failure, Grip, Hello, Reply, Result, SequenceEnd, Subscribed

API = 1
LONGEST_LINE = 16 << 20
# Largest number of grips whose results are stored for later calls.
MOST_GRIPS = 64
# Value in place of the request number of a grip that was started before the daemon was restarted.
OF_ANOTHER_DAEMON = -1
FAILURES = frozenset({Result.NO_PART, Result.PART_LOST, Result.ERROR})
# Capability that the daemon reports in its first message: starts have ids, and a stop may name the id of a start.
START_ID = "start_id"
# Codes with which the daemon refuses a line without processing it.
UNREAD = ("bad_request", "too_long")
# Code with which the daemon refuses a stop that names a start if this start does not run and will not begin.
NOT_RUNNING = "named_start_not_running"


def default_path() -> str:
    """Returns the default path of softgripd's socket."""
    return os.environ.get("SOFTGRIP_SOCKET") or "/run/softgrip/softgripd.sock"


def start_keys(sequence: str, text: Optional[str], parameters: Mapping[str, float]) -> dict[str, Any]:
    keys: dict[str, Any] = {"sequence": sequence}
    if text is not None:
        keys["sequence_text"] = text
    if parameters:
        keys["parameters"] = dict(parameters)
    return keys


def error_of(error: Optional[Failure]) -> SoftgripError:
    """Returns the exception that corresponds to the error in a reply."""
    if error is None:
        return ProtocolError("a reply lacks 'error'")
    if error.code == "sequence_refused":
        return SequenceRefused(error.message, error.problems)
    if error.code == "refused" and error.refusal:
        return Refused(error.message, error.refusal.code, error.refusal.name)
    if error.code == "owned":
        return Owned(error.message, error.code, error.code)
    if error.code in ("busy", "abandoned", "not_allowed"):
        return Refused(error.message, error.code, error.code)
    if error.code == "no_answer":
        return NotAnswered(error.message)
    if error.code == "too_many_clients":
        return ConnectionLost(error.message)
    return ProtocolError(error.message, error.code)


class _Story:
    """The results of one grip, collected from the events of the grip."""

    def __init__(self) -> None:
        self.results: list[Result] = []  # results that wait_until() may return, in the order in which they were reported
        self.received = False  # True if the program has received the only result in `results`
        self.last = Result.NONE
        self.end: Optional[SequenceEnd] = None

    def report(self, result: Result) -> None:
        self._supersede()
        self.last = result
        self.results.append(result)

    def finish(self, end: SequenceEnd) -> None:
        self._supersede()
        self.end = end

    def _supersede(self) -> None:
        """Discards the result that the program has received, because it is no longer the state of the grip."""
        if self.received:
            self.results.clear()
        self.received = False

    def receive(self, wanted: frozenset[Result]) -> Optional[Result]:
        """Returns the first failure. If there is none, returns the first result in `wanted`, or None. A sequence that
        did not complete has no result except a failure. Discards the results before the returned result. If the
        returned result is the last one, it remains the result until `report()` or `finish()` is called."""
        completed = self.end in (None, SequenceEnd.DONE)
        found = next((result for result in self.results if result in FAILURES), None) or \
            next((result for result in self.results if result in wanted and completed), None)
        if found is None:
            return None
        place = self.results.index(found)
        if place + 1 < len(self.results):
            del self.results[:place + 1]
        else:
            del self.results[:place]
            self.received = True
        return found


class Session:
    def __init__(self) -> None:
        self.replies: dict[int, Reply] = {}
        self.events: collections.deque[Event] = collections.deque(maxlen=10_000)
        self.started_at = ""
        self.last_event: Optional[int] = None
        self.grip = 0  # request number of the last start whose number is known
        self.failure: Optional[Exception] = None  # reason that the daemon gave before it closed the connection
        # The starts of this client that may still run, by start id. The value is the start's request number in the daemon's
        # events, once this number is known.
        self.starts: dict[str, Optional[int]] = {}
        self._names_starts = True
        self._last_id = 0
        self._waiting: set[int] = set()
        # Start ids by the ids of the starts that may have begun, but whose request numbers are not known.
        self._start_of: dict[int, str] = {}
        self._known_start = 0  # id of the start to which `grip` belongs
        self._last_unanswered = 0  # id of the last start whose reply can no longer arrive
        self._stories: collections.OrderedDict[int, _Story] = collections.OrderedDict()

    def raise_unconfirmed(self, failure: Optional[SoftgripError]) -> None:
        """Raises StopNotConfirmed if starts may still run after this client has tried to stop each of them."""
        if self.starts and failure:
            which = ", ".join("a start without a reply" if request is None else f"request {request}"
                              for request in self.starts.values())
            raise StopNotConfirmed(f"the daemon did not confirm the stop of this program's sequences ({which}): {failure}. "
                                   "The sequences may still run. `softgrip status` shows them, `softgrip stop` stops them") from failure

    def greeted(self, hello: Hello) -> None:
        self._names_starts = START_ID in hello.capabilities

    def request(self, command: str, keys: Mapping[str, Any]) -> tuple[int, bytes]:
        """Returns the line to be sent for a request, and the id that the reply will have. A start is stored with a
        unique id before it is sent, because an exception can occur at any time after this call."""
        number = self._last_id + 1
        starts = command == "start" and not keys.get("dry_run")
        if starts:
            keys = {START_ID: self._new_start_id(), **keys}
        line = json.dumps({"id": number, "command": command, **keys}, allow_nan=False)
        self._last_id = number
        self._waiting.add(number)
        if starts:
            self._start_of[number] = keys[START_ID]
            self.starts[keys[START_ID]] = None
        return number, line.encode() + b"\n"

    def _new_start_id(self) -> str:
        if not self._names_starts:
            raise ProtocolError("softgripd is older than this package and cannot stop the sequence of a single client, so "
                                "no sequence was started")
        return os.urandom(16).hex()

    def forget(self, number: int) -> None:
        """Stores that the reply to this request must be discarded."""
        self._waiting.discard(number)
        self.replies.pop(number, None)

    def subscription(self) -> dict[str, Any]:
        """Returns the keys of a subscription that continues after the last received event."""
        if self.last_event is None:
            return {}
        return {"since": self.last_event, "started_at": self.started_at}

    def subscribed(self, result: Mapping[str, Any]) -> None:
        """Processes the reply to a subscription. If the daemon was restarted, its request numbers start from the
        beginning, and all sequences that ran before the restart have ended."""
        reply = Subscribed.of(result, "subscribe")
        if self.started_at not in ("", reply.started_at):
            started = bool(self.grip or self._start_of)
            story = _Story() if self._number_is_unknown() else self._story(self.grip)
            self.starts.clear()
            self._start_of.clear()
            if story.end is None:
                story.finish(SequenceEnd.FAULTED)
            self._stories.clear()
            if started:
                self.grip = OF_ANOTHER_DAEMON
                self._stories[self.grip] = story
        self._last_unanswered = max(self._start_of, default=0)
        self.started_at = reply.started_at
        self.last_event = reply.since

    def receive(self, line: bytes) -> None:
        """Processes a line from the daemon. Raises ProtocolError if the line is malformed."""
        said = parsed(line)
        if "event" in said:
            self._take(Event.of(said["event"], "event"))
        elif "ok" in said:
            self._take_reply(Reply.of(said, "reply"))

    def _take_reply(self, reply: Reply) -> None:
        if reply.id is None:
            self.failure = None if reply.ok else error_of(reply.error)
            return
        if reply.id in self._start_of:
            self._take_start(reply.id, reply)
        if reply.id in self._waiting:
            self.replies[reply.id] = reply

    def _take_start(self, number: int, reply: Reply) -> None:
        """Processes the reply to a start, also if the program no longer waits for this reply. After a refusal, the
        sequence will not begin. After any other error, the sequence may begin nevertheless, and its number remains
        unknown."""
        if reply.ok:
            request = Grip.of(reply.result, "start").request
            if number > self._known_start:
                self._known_start = number
                self.grip = request
            self.starts[self._start_of.pop(number)] = request
            self._drop_ended()
            return
        error = error_of(reply.error)
        if isinstance(error, (Refused, SequenceRefused)) or (isinstance(error, ProtocolError) and error.code in UNREAD):
            self.starts.pop(self._start_of.pop(number), None)
        else:
            self._last_unanswered = max(self._last_unanswered, number)

    def _number_is_unknown(self) -> bool:
        """Returns True if the request number of the last start is not known, so that no event can be assigned to it."""
        return max(self._start_of, default=0) > self._known_start

    def _awaits_number(self) -> bool:
        """Returns True if the reply to the last start has not arrived yet. Raises NotAnswered if the request number of the
        last start is unknown and no reply will arrive."""
        if not self._number_is_unknown():
            return False
        if max(self._start_of) <= self._last_unanswered:
            raise NotAnswered("the daemon sent no usable reply to the last start, so its result is not known; status() shows "
                              "whether its sequence runs")
        return True

    def _drop_ended(self) -> None:
        self.starts = {start_id: request for start_id, request in self.starts.items()
                       if request is None or self._story(request).end is None}

    def result_of(self, number: int) -> Mapping[str, Any]:
        """Returns the result in a received reply and discards the reply. If the reply is an error, raises the
        corresponding exception."""
        reply = self.replies.pop(number)
        if not reply.ok:
            raise error_of(reply.error)
        if reply.result is None:
            raise ProtocolError("a reply lacks 'result'")
        return reply.result

    def _take(self, event: Event) -> None:
        self.last_event = event.id
        self.events.append(event)
        if event.request is None:
            return
        if event.kind == "overall_result" and event.code:
            self._story(event.request).report(checked(Result, event.code, "event.code"))
        elif event.kind == "sequence_finished" and event.code:
            self._story(event.request).finish(checked(SequenceEnd, event.code, "event.code"))
            self._drop_ended()

    def _story(self, request: int) -> _Story:
        story = self._stories.setdefault(request, _Story())
        while len(self._stories) > MOST_GRIPS:
            self._stories.popitem(last=False)
        return story

    def reached(self, wanted: frozenset[Result]) -> Optional[Result]:
        """Returns the result of the last start if this result is in `wanted`; None if the last start has no result or no
        reply yet. Raises GripFailed if the grip failed or the sequence ended."""
        if self._awaits_number():
            return None
        story = self._story(self.grip)
        result = story.receive(wanted)
        if result in wanted:
            return result
        if result is not None or story.end:
            raise GripFailed(result or story.last, story.end)
        return None

    def ended(self) -> Optional[SequenceEnd]:
        """Returns the reason for which the sequence of the last start ended; None if the sequence still runs or the start
        has no reply yet."""
        return None if self._awaits_number() else self._story(self.grip).end
