"""The client for asyncio."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable, Mapping
from types import TracebackType
from typing import Any, Optional, TypeVar

from .errors import ConnectionLost, NoDaemon, NotAnswered, ProtocolError, SoftgripError
from .messages import Checked, Event, Grip, Hello, Listing, Result, Sequence, SequenceEnd, Status
from .session import API, LONGEST_LINE, Session, default_path, start_keys

T = TypeVar("T")


class AsyncGripper:
    """As `Gripper`, for asyncio: `async with AsyncGripper(name="cell 4") as gripper:`. Tasks may share it."""

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
            if self._session.runs() and (await self.status()).json["sequence"]["ended"] is None:
                await self.stop()
        except SoftgripError:
            # It ended by itself meanwhile, or the daemon has gone, whose own rules hold then.
            pass
        finally:
            await self.close()

    async def connect(self) -> Hello:
        """Also after a ConnectionLost: no event is missed that the daemon still keeps."""
        await self.close()
        try:
            opened = asyncio.open_unix_connection(self.path, limit=LONGEST_LINE)
            reader, self._writer = await asyncio.wait_for(opened, self.answer_s)
        except (OSError, asyncio.TimeoutError) as error:
            raise NoDaemon(f"{self.path}: {error}") from error
        self._reading = asyncio.create_task(self._read(reader))
        try:
            self.hello = Hello.of(await self.ask("hello", client=self.name, api=API), "hello")
            self._session.subscribed(await self.ask("subscribe", **self._session.subscription()))
        except BaseException:
            await self.close()
            raise
        return self.hello

    async def close(self) -> None:
        """Ends the connection; what runs goes on running, owned by nobody."""
        if self._reading:
            self._reading.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._reading
        self._reading = None
        if self._writer:
            self._writer.close()
            with contextlib.suppress(OSError):
                await self._writer.wait_closed()
        self._writer = None

    async def status(self) -> Status:
        return Status.of(await self.ask("status"), "status")

    async def sequences(self) -> tuple[Sequence, ...]:
        return Listing.of(await self.ask("sequences"), "sequences").sequences

    async def start(self, sequence: str, *, text: Optional[str] = None, **parameters: float) -> Grip:
        grip = Grip.of(await self.ask("start", **start_keys(sequence, text, parameters)), "start")
        self._session.grip = grip.request
        return grip

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
        """Events as they come, none missed; ends when none has come for `timeout_s`."""
        while True:
            try:
                event = await self._until(
                    lambda: self._session.events.popleft() if self._session.events else None, timeout_s)
            except NotAnswered:
                return
            yield event

    async def ask(self, command: str, **keys: Any) -> Mapping[str, Any]:
        """Any command of the socket API, and its result."""
        if self._writer is None:
            raise ConnectionLost(f"{self.path}: not connected")
        number, line = self._session.request(command, keys)
        self._writer.write(line)
        try:
            return await self._until(
                lambda: self._session.result_of(number) if number in self._session.replies else None, self.answer_s)
        finally:
            self._session.forget(number)

    async def _until(self, look: Callable[[], Optional[T]], timeout_s: float) -> T:
        """What look() returns once it returns something."""
        end = asyncio.get_running_loop().time() + timeout_s
        while True:
            found = look()
            if found is not None:
                return found
            if self._reading is None or self._reading.done():
                raise self._session.failure or ConnectionLost(f"{self.path}: the daemon hung up")
            left = end - asyncio.get_running_loop().time()
            try:
                await asyncio.wait_for(self._changed.wait(), max(left, 0))
            except asyncio.TimeoutError:
                raise NotAnswered(f"{self.path}: it took too long") from None

    @staticmethod
    async def _line(reader: asyncio.StreamReader) -> bytes:
        try:
            return await reader.readline()
        except ValueError as error:
            raise ProtocolError(f"a line is longer than {LONGEST_LINE} bytes") from error

    async def _read(self, reader: asyncio.StreamReader) -> None:
        try:
            while line := await self._line(reader):
                self._session.receive(line)
                self._tell()
        except (OSError, SoftgripError) as error:
            self._session.failure = error if isinstance(error, SoftgripError) else ConnectionLost(str(error))
        finally:
            # Who waits shall look once more, when this task counts as done.
            asyncio.get_running_loop().call_soon(self._tell)

    def _tell(self) -> None:
        """Wakes all who wait at present."""
        self._changed.set()
        self._changed = asyncio.Event()
