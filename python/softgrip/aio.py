"""The client of softgripd for asyncio."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from types import TracebackType
from typing import Any, Optional, TypeVar

from .errors import ConnectionLost, NoDaemon, NotAnswered, ProtocolError, Refused, SoftgripError
from .messages import Checked, Event, Grip, Hello, Listing, Result, Sequence, SequenceEnd, Status
from .session import API, LONGEST_LINE, NOT_RUNNING, START_ID, Session, default_path, start_keys

T = TypeVar("T")


class AsyncGripper:
    """The client of softgripd for asyncio: `async with AsyncGripper(name="cell 4") as gripper:`. It has the methods of
    `Gripper`, but `connect()` in place of `reconnect()`. Several tasks may share an object."""

    def __init__(self, path: Optional[str] = None, *, name: str, answer_s: float = 5.0) -> None:
        self.path = path or default_path()
        self.name = name
        self.answer_s = answer_s
        self.hello: Optional[Hello] = None
        self._session = Session()
        self._writer: Optional[asyncio.StreamWriter] = None
        self._reading: Optional[asyncio.Task[None]] = None
        self._changed = asyncio.Event()

    async def __aenter__(self) -> AsyncGripper:
        await self.connect()
        return self

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        traceback: Optional[TracebackType]) -> None:
        try:
            await self._stop_own()
        finally:
            await self.close()

    async def connect(self) -> Hello:
        """Connects to the daemon, also after a ConnectionLost. After this call, `events()` returns the events that the
        client has missed, as far as the daemon still stores them."""
        await self._hang_up()
        reader, self._writer = await self._open()
        self._session.failure = None  # it belonged to the previous connection
        self._reading = asyncio.create_task(self._read(reader))
        try:
            self.hello = Hello.of(await self.ask("hello", client=self.name, api=API), "hello")
            self._session.greeted(self.hello)
            self._session.subscribed(await self.ask("subscribe", **self._session.subscription()))
        except BaseException:
            await self._hang_up()
            raise
        return self.hello

    async def close(self) -> None:
        """Ends the connection. A running sequence continues and has no owner. After this call, the end of the `async
        with` block does not stop the sequence."""
        self._session.starts.clear()
        await self._hang_up()

    async def _open(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        opening = asyncio.create_task(asyncio.open_unix_connection(self.path, limit=LONGEST_LINE))
        try:
            return await _within(opening, self.answer_s)
        except asyncio.CancelledError:
            if opening.done() and not opening.cancelled() and not opening.exception():
                opening.result()[1].close()
            raise
        except (OSError, asyncio.TimeoutError) as error:
            raise NoDaemon(f"{self.path}: {error}") from error

    async def _hang_up(self) -> None:
        reading, self._reading = self._reading, None
        writer, self._writer = self._writer, None
        if writer:
            writer.close()
        if reading:
            reading.cancel()
            await asyncio.wait({reading})
        if writer:
            with contextlib.suppress(OSError):
                await writer.wait_closed()

    async def status(self) -> Status:
        return Status.of(await self.ask("status"), "status")

    async def sequences(self) -> tuple[Sequence, ...]:
        return Listing.of(await self.ask("sequences"), "sequences").sequences

    async def start(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Grip:
        return Grip.of(await self.ask("start", **start_keys(sequence, text, parameters)), "start")

    async def check(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Checked:
        return Checked.of(await self.ask("start", dry_run=True, **start_keys(sequence, text, parameters)), "start")

    async def stop(self) -> None:
        await self.ask("stop")

    async def vent(self) -> None:
        await self.ask("vent")

    async def release(self) -> None:
        await self.ask("release")

    async def acknowledge(self) -> None:
        await self.ask("acknowledge")

    async def wait_until(self, *wanted: Result, timeout_s: float) -> Result:
        return await self._until(lambda: self._session.reached(frozenset(wanted)), timeout_s)

    async def wait(self, *, timeout_s: float) -> SequenceEnd:
        return await self._until(self._session.ended, timeout_s)

    async def events(self, *, timeout_s: float) -> AsyncIterator[Event]:
        """Yields all events in the order in which they occurred. The iteration ends after `timeout_s` seconds without
        an event."""
        while True:
            try:
                event = await self._until(
                    lambda: self._session.events.popleft() if self._session.events else None, timeout_s)
            except NotAnswered:
                return
            yield event

    async def ask(self, command: str, **keys: Any) -> Mapping[str, Any]:
        """Sends a request of the socket API and returns its result. `command` is the name of the request."""
        if self._writer is None:
            raise ConnectionLost(f"{self.path}: not connected")
        number, line = self._session.request(command, keys)
        self._writer.write(line)
        try:
            return await self._until(
                lambda: self._session.result_of(number) if number in self._session.replies else None, self.answer_s)
        finally:
            self._session.forget(number)

    async def _stop_own(self) -> None:
        """Stops the sequences that this client started, as Gripper does."""
        failure: Optional[SoftgripError] = None
        for start_id in tuple(self._session.starts):
            try:
                await self._stop_start(start_id)
                self._session.starts.pop(start_id, None)
            except SoftgripError as error:
                failure = error
        self._session.raise_unconfirmed(failure)

    async def _stop_start(self, start_id: str) -> None:
        try:
            try:
                await self.ask("stop", **{START_ID: start_id})
            except (ConnectionLost, ProtocolError):
                await self._stop_over_another(start_id)
        except Refused as refused:
            if refused.name != NOT_RUNNING:
                raise

    async def _stop_over_another(self, start_id: str) -> None:
        """Sends a stop request over a new connection, because the first connection has failed."""
        session = Session()
        number, line = session.request("stop", {START_ID: start_id})
        reader, writer = await self._open()
        try:
            writer.write(line)
            await _within(self._take_until(reader, session, number), self.answer_s)
        except asyncio.TimeoutError:
            raise NotAnswered(f"{self.path}: time limit exceeded") from None
        except OSError as error:
            raise ConnectionLost(f"{self.path}: {error}") from error
        finally:
            writer.close()
        session.result_of(number)

    async def _take_until(self, reader: asyncio.StreamReader, session: Session, number: int) -> None:
        while number not in session.replies:
            line = await self._line(reader)
            if not line:
                raise session.failure or ConnectionLost(f"{self.path}: the daemon closed the connection")
            session.receive(line)

    @staticmethod
    async def _line(reader: asyncio.StreamReader) -> bytes:
        try:
            return await reader.readline()
        except ValueError as error:
            raise ProtocolError(f"a line is longer than {LONGEST_LINE} bytes") from error

    async def _until(self, look: Callable[[], Optional[T]], timeout_s: float) -> T:
        """Calls look() after each line from the daemon. Returns the first value of look() that is not None."""
        end = asyncio.get_running_loop().time() + timeout_s
        while True:
            found = look()
            if found is not None:
                return found
            if self._reading is None or self._reading.done():
                raise self._session.failure or ConnectionLost(f"{self.path}: the daemon closed the connection")
            left = end - asyncio.get_running_loop().time()
            try:
                await _within(self._changed.wait(), max(left, 0))
            except asyncio.TimeoutError:
                raise NotAnswered(f"{self.path}: time limit exceeded") from None

    async def _read(self, reader: asyncio.StreamReader) -> None:
        try:
            while line := await self._line(reader):
                self._session.receive(line)
                self._tell()
        except (OSError, SoftgripError) as error:
            self._session.failure = error if isinstance(error, SoftgripError) else ConnectionLost(str(error))
        finally:
            # After this task has ended, the waiting tasks must check their conditions again.
            asyncio.get_running_loop().call_soon(self._tell)

    def _tell(self) -> None:
        """Wakes all tasks that are waiting."""
        self._changed.set()
        self._changed = asyncio.Event()


async def _within(work: Awaitable[T], timeout_s: float) -> T:
    """Returns the result of `work`. Raises asyncio.TimeoutError after `timeout_s` seconds. Before Python 3.12,
    asyncio.wait_for() ignores a cancellation, for example by Ctrl-C, at the moment at which the result arrives. The
    program and its sequence would then continue."""
    task = asyncio.ensure_future(work)
    try:
        await asyncio.wait({task}, timeout=timeout_s)
        if task.done():
            return task.result()
        raise asyncio.TimeoutError
    finally:
        if not task.cancel() and not task.cancelled():
            task.exception()  # otherwise, asyncio reports that nobody has read the exception
