"""A connection without its socket: what is sent, and what came of it. Both clients are this with a socket."""

from __future__ import annotations

import collections
import json
import os
from collections.abc import Mapping
from typing import Any, Optional

from .decoding import checked, parsed
from .errors import (ConnectionLost, GripFailed, NotAnswered, Owned, ProtocolError, Refused, SequenceRefused,
                     SoftgripError)
from .messages import Event, Failure, Reply, Result, SequenceEnd, Subscribed

API = 1
LONGEST_LINE = 16 << 20
# Grips whose story is kept for who asks late.
MOST_GRIPS = 64
# In the place of a request's number.
OF_ANOTHER_DAEMON = -1
FAILURES = frozenset({Result.NO_PART, Result.PART_LOST, Result.ERROR})


def default_path() -> str:
    """Where softgripd listens unless told otherwise."""
    return os.environ.get("SOFTGRIP_SOCKET") or "/run/softgrip/softgripd.sock"


def start_keys(sequence: str, text: Optional[str], parameters: Mapping[str, float]) -> dict[str, Any]:
    keys: dict[str, Any] = {"sequence": sequence}
    if text is not None:
        keys["sequence_text"] = text
    if parameters:
        keys["parameters"] = dict(parameters)
    return keys


def error_of(error: Optional[Failure]) -> SoftgripError:
    """The exception that the error of a reply stands for."""
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
    """What events said of one grip."""

    def __init__(self) -> None:
        self.results: collections.deque[Result] = collections.deque()
        self.last = Result.NONE
        self.end: Optional[SequenceEnd] = None


class Session:
    def __init__(self) -> None:
        self.replies: dict[int, Reply] = {}
        self.events: collections.deque[Event] = collections.deque(maxlen=10_000)
        self.started_at = ""
        self.last_event: Optional[int] = None
        self.grip = 0  # the request of the last start
        self.failure: Optional[Exception] = None  # what the daemon said before it hung up
        self._last_id = 0
        self._waiting: set[int] = set()
        self._stories: collections.OrderedDict[int, _Story] = collections.OrderedDict()

    def request(self, command: str, keys: Mapping[str, Any]) -> tuple[int, bytes]:
        """A line, and the id that its reply will have."""
        self._last_id += 1
        self._waiting.add(self._last_id)
        line = json.dumps({"id": self._last_id, "command": command, **keys}, allow_nan=False)
        return self._last_id, line.encode() + b"\n"

    def forget(self, number: int) -> None:
        """Nobody waits for that reply any more."""
        self._waiting.discard(number)
        self.replies.pop(number, None)

    def subscription(self) -> dict[str, Any]:
        """The keys of a subscribe that goes on where the last connection left off."""
        if self.last_event is None:
            return {}
        return {"since": self.last_event, "started_at": self.started_at}

    def subscribed(self, result: Mapping[str, Any]) -> None:
        """Another daemon than before counts its requests anew, and what ran has ended with the one before."""
        reply = Subscribed.of(result, "subscribe")
        if self.started_at not in ("", reply.started_at):
            story = self._story(self.grip)
            story.end = story.end or SequenceEnd.FAULTED
            self._stories.clear()
            if self.grip:
                self.grip = OF_ANOTHER_DAEMON
                self._stories[self.grip] = story
        self.started_at = reply.started_at
        self.last_event = reply.since

    def receive(self, line: bytes) -> None:
        """A line of the daemon. ProtocolError if it is malformed."""
        said = parsed(line)
        if "event" in said:
            self._take(Event.of(said["event"], "event"))
        elif "ok" in said:
            self._take_reply(Reply.of(said, "reply"))

    def _take_reply(self, reply: Reply) -> None:
        if reply.id is None:
            self.failure = None if reply.ok else error_of(reply.error)
        elif reply.id in self._waiting:
            self.replies[reply.id] = reply

    def result_of(self, number: int) -> Mapping[str, Any]:
        """The result of a reply that has come, once; or the exception that it stands for."""
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
            story = self._story(event.request)
            story.last = checked(Result, event.code, "event.code")
            story.results.append(story.last)
        elif event.kind == "sequence_finished" and event.code:
            self._story(event.request).end = checked(SequenceEnd, event.code, "event.code")

    def _story(self, request: int) -> _Story:
        story = self._stories.setdefault(request, _Story())
        while len(self._stories) > MOST_GRIPS:
            self._stories.popitem(last=False)
        return story

    def reached(self, wanted: frozenset[Result]) -> Optional[Result]:
        """What the last start has come to, if that is wanted; None if it is still under way. Else GripFailed."""
        story = self._story(self.grip)
        while story.results:
            result = story.results.popleft()
            if result in wanted:
                return result
            if result in FAILURES:
                raise GripFailed(result, story.end)
        if story.end:
            raise GripFailed(story.last, story.end)
        return None

    def ended(self) -> Optional[SequenceEnd]:
        """How the last start has ended; None if it has not."""
        return self._story(self.grip).end

    def runs(self) -> bool:
        """A sequence of this client runs, as far as it was told."""
        return self.grip != 0 and self.ended() is None
