"""Sessions of the line protocol for asyncio.

    session = await aio.connect("unix:PATH")
    await session.request("load", "beamfall", seed=7)
    one, two = await asyncio.gather(session.request("act", "FIRE"), session.request("act", "LEFT"))
    await session.close()

Requests that are made together are sent ahead, and answered in their order.
"""

from __future__ import annotations

import asyncio
import collections
import ssl
from collections.abc import Awaitable, Callable
from typing import IO, Any, cast

from . import client
from .client import LONGEST_REPLY, Refused, Texts, Values

__all__ = ["AsyncSession", "connect", "launch"]


async def connect(address: str | None = None, *, token: str | None = None, tls: ssl.SSLContext | None = None,
                  timeout: float | None = None, longest_reply: int = LONGEST_REPLY, arrays: bool = False) -> AsyncSession:
    """As racebeam.connect(), of sockets: tcp://, tls:// and unix: addresses, and file: with one of these."""
    opened = await asyncio.to_thread(client.reached, address, lambda found: client.connected(found, timeout))
    (connection, host), found, announced = opened
    context = (tls or ssl.create_default_context()) if host else None
    opening = asyncio.open_connection(sock=connection, limit=longest_reply, ssl=context, server_hostname=host or None)
    try:
        reader, writer = await asyncio.wait_for(opening, timeout)
    except asyncio.TimeoutError:
        connection.close()
        raise TimeoutError(f"no server answers at {found}: timed out") from None
    session = AsyncSession(reader, writer, found, longest_reply, arrays, timeout=timeout)
    token = token or announced
    session.again = lambda: connect(found, token=token, tls=tls, timeout=timeout, longest_reply=longest_reply, arrays=arrays)
    return await _greeted(session, token)


async def launch(*options: str, program: str | None = None, arrays: bool = False) -> AsyncSession:
    """As racebeam.launch()."""
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(*client.command_of(program, options), stdin=pipe, stdout=pipe, limit=LONGEST_REPLY)
    assert process.stdout is not None and process.stdin is not None
    return await _greeted(AsyncSession(process.stdout, process.stdin, "", LONGEST_REPLY, arrays, process), None)


async def _greeted(session: AsyncSession, token: str | None) -> AsyncSession:
    try:
        said = await session.request("hello", **({} if token is None else {"token": token}))
        session.check_greeting(said[0])
        return session
    except BaseException:
        await session.close()
        raise


class AsyncSession:
    """One session. connect() and launch() make them. A request that is cancelled is carried out all the same."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, address: str, longest_reply: int, arrays: bool,
                 process: asyncio.subprocess.Process | None = None, timeout: float | None = None) -> None:
        self._reader, self._writer, self._process = reader, writer, process
        self._session = client.Session(cast(IO[bytes], None), cast(IO[bytes], writer), writer.close, arrays)
        self._session.address, self._session.longest_reply = address, longest_reply
        self._timeout, self._heard = timeout, 0.0  # when the last reply came
        self.again: Callable[[], Awaitable[AsyncSession]] | None = None
        self._answers: collections.deque[asyncio.Future[list[Values]]] = collections.deque()  # of the requests, in order
        self._reading = asyncio.create_task(self._read())

    async def __aenter__(self) -> AsyncSession:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    def check_greeting(self, said: Values) -> None:
        """Raises ConnectionError for another version of the protocol."""
        self._session.check_greeting(said)

    async def request(self, *words: object, **settings: object) -> list[Values]:
        """The groups of the reply, with numbers, and bytes or arrays. Raises Refused; ConnectionError when the server has gone; and
        TimeoutError when nothing came from it for as long as `timeout` of connect() says."""
        self._session.send(*words, **settings)
        answer: asyncio.Future[list[Values]] = asyncio.get_running_loop().create_future()
        self._answers.append(answer)
        if self._timeout is None:
            await self._writer.drain()
            return await answer
        try:
            await self._await_reply(answer, self._timeout)
        except asyncio.CancelledError:
            answer.cancel()
            raise
        return answer.result()

    async def _await_reply(self, answer: asyncio.Future[list[Values]], limit: float) -> None:
        """Returns when it is there. Each reply to an earlier request begins the time anew."""
        clock = asyncio.get_running_loop().time
        begin = clock()
        while not answer.done():
            left = max(begin, self._heard) + limit - clock()
            if left <= 0:
                answer.cancel()
                raise self._session.lost(TimeoutError())
            await asyncio.wait([answer], timeout=left)

    async def reconnect(self) -> AsyncSession:
        """A new session of the same server, after the old one ended. It has no game yet. Only for sessions of connect()."""
        if self.again is None:
            raise ValueError("this session cannot be opened again: connect() did not make it")
        await self.close()
        return await self.again()

    async def close(self) -> None:
        """Ends the session. More than once does nothing."""
        self._session.close_connection()
        self._reading.cancel()
        await asyncio.gather(self._reading, return_exceptions=True)
        if self._process is not None:
            await self._process.wait()

    async def _read(self) -> None:
        """Answers requests until the connection ends; then each that is left gets the error."""
        error: BaseException = ConnectionError("the session was closed")
        try:
            while True:
                await self._read_reply()
        except asyncio.IncompleteReadError:
            error = self._session.lost(None)
        except (OSError, asyncio.LimitOverrunError) as why:
            error = why if isinstance(why, ConnectionError) else self._session.lost(why)
        finally:
            self._session.close_connection()
            for answer in self._answers:
                if not answer.done():
                    answer.set_exception(error)

    async def _read_reply(self) -> None:
        line = await self._reader.readuntil(b"\n")
        try:
            reply = self._session.read_line(line.decode("latin-1").rstrip("\n"))
            values = await self._values(*reply)
        except Refused as refused:
            self._answer(lambda answer: answer.set_exception(refused))
        else:
            self._answer(lambda answer: answer.set_result(values))

    async def _values(self, words: list[str], groups: list[Texts], count: int) -> list[Values]:
        if count:
            self._session.take_bytes(words, groups, await self._reader.readexactly(count))
        return self._session.all_decoded(words, groups)

    def _answer(self, how: Any) -> None:
        """The oldest request, if it still waits."""
        self._heard = asyncio.get_running_loop().time()
        if self._answers and len(self._answers) != len(self._session.unanswered) + 1:  # Ctrl-C came between send() and append()
            raise self._session.lost(ConnectionError("it was interrupted between a request and the end of its reply"))
        if self._answers and not (oldest := self._answers.popleft()).done():
            how(oldest)
