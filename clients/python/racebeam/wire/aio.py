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
import contextlib
import ssl
from collections.abc import Awaitable, Callable, Coroutine
from typing import IO, Any, cast

from . import client
from .client import LONGEST_REPLY, Refused, Values

Read = Callable[[str], Coroutine[Any, Any, Any]]  # makes a value of the line of a reply

__all__ = ["AsyncSession", "connect", "launch"]


async def connect(
    address: str | None = None,
    *,
    token: str | None = None,
    tls: ssl.SSLContext | None = None,
    timeout: float | None = None,
    longest_reply: int = LONGEST_REPLY,
    arrays: bool = False,
) -> AsyncSession:
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
    session.again = lambda: connect(
        found, token=token, tls=tls, timeout=timeout, longest_reply=longest_reply, arrays=arrays
    )
    return await _greeted(session, token)


async def launch(*options: str, program: str | None = None, arrays: bool = False) -> AsyncSession:
    """As racebeam.launch()."""
    pipe, command = asyncio.subprocess.PIPE, client.command_of(program, options)
    process = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, limit=LONGEST_REPLY)
    assert process.stdout is not None and process.stdin is not None
    try:
        return await _greeted(AsyncSession(process.stdout, process.stdin, "", LONGEST_REPLY, arrays, process), None)
    except ConnectionError as error:
        raise client.not_serving(command, error) from error


async def _greeted(session: AsyncSession, token: str | None) -> AsyncSession:
    try:
        said = await session.request("hello", **({} if token is None else {"token": token}))
        session.check_greeting(said[0])
        return session
    except BaseException:
        await session.close()
        raise


class AsyncSession:
    """One session. connect() and launch() make them. A request that is cancelled is carried out all the same. Without the last
    reference to it, a session ends.
    """

    def __init__(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        address: str,
        longest_reply: int,
        arrays: bool,
        process: asyncio.subprocess.Process | None = None,
        timeout: float | None = None,
    ) -> None:
        self._writer, self._process = writer, process
        self._session = client.Session(cast(IO[bytes], None), cast(IO[bytes], writer), writer.close, arrays)
        self._session.address, self._session.longest_reply = address, longest_reply
        self._timeout = timeout
        self.again: Callable[[], Awaitable[AsyncSession]] | None = None
        self._replies = _Replies(reader, self._session)
        self._reading = asyncio.create_task(self._replies.read())

    def __del__(self) -> None:
        with contextlib.suppress(Exception):  # where the constructor failed, or the event loop has ended
            self._session.check_process()
            self._reading.get_loop().call_soon_threadsafe(self._reading.cancel)  # which ends the session

    async def __aenter__(self) -> AsyncSession:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    def check_greeting(self, said: Values) -> None:
        """Raises ConnectionError for another version of the protocol."""
        self._session.check_greeting(said)

    async def request(self, *words: object, **settings: object) -> list[Values]:
        """The groups of the reply, with numbers, and bytes or arrays. Raises Refused; ConnectionError when the server has gone; and
        TimeoutError when nothing came from it for as long as `timeout` of connect() says.
        """
        answer: list[Values] = await self._exchange(self._replies.values, *words, **settings)
        return answer

    async def help(self, *words: str) -> str:
        """As Session.help()."""
        text: str = await self._exchange(self._replies.text, "help", *words)
        return text

    async def _exchange(self, read: Read, *words: object, **settings: object) -> Any:
        """What `read` makes of the reply to a request."""
        self._session.send(*words, **settings)
        answer: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._replies.awaited.append((answer, read))
        if self._timeout is None:
            await self._writer.drain()
            return await answer
        try:
            await self._await_reply(answer, self._timeout)
        except asyncio.CancelledError:
            answer.cancel()
            raise
        return answer.result()

    async def _await_reply(self, answer: asyncio.Future[Any], limit: float) -> None:
        """Returns when it is there. Each reply to an earlier request begins the time anew."""
        clock = asyncio.get_running_loop().time
        begin = clock()
        while not answer.done():
            left = max(begin, self._replies.heard) + limit - clock()
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


class _Replies:
    """Reads the replies of a session, and gives each to its request. An AsyncSession has one. It does not refer to the AsyncSession,
    which can end while this waits.
    """

    def __init__(self, reader: asyncio.StreamReader, session: client.Session) -> None:
        self._reader, self._session = reader, session
        self.awaited: collections.deque[tuple[asyncio.Future[Any], Read]] = (
            collections.deque()
        )  # of the requests, in order
        self.heard = 0.0  # when the last reply came

    async def read(self) -> None:
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
            for answer, _ in self.awaited:
                if not answer.done():
                    answer.set_exception(error)

    async def _read_reply(self) -> None:
        line = (await self._reader.readuntil(b"\n")).decode("latin-1").rstrip("\n")
        read = self.awaited[0][1] if self.awaited else self.values
        try:
            value = await read(line)
        except Refused as refused:
            self._answer(lambda answer: answer.set_exception(refused))
        else:
            self._answer(lambda answer: answer.set_result(value))

    async def values(self, line: str) -> list[Values]:
        """The groups of a reply."""
        words, groups, count = self._session.read_line(line)
        if count:
            self._session.take_bytes(words, groups, await self._reader.readexactly(count))
        return self._session.all_decoded(words, groups)

    async def text(self, line: str) -> str:
        """A reply without its status."""
        return self._session.read_status(line)[1]

    def _answer(self, how: Callable[[asyncio.Future[Any]], None]) -> None:
        """The oldest request, if it still waits."""
        self.heard = asyncio.get_running_loop().time()
        if (
            self.awaited and len(self.awaited) != len(self._session.unanswered) + 1
        ):  # Ctrl-C came between send() and append()
            raise self._session.lost(ConnectionError("it was interrupted between a request and the end of its reply"))
        if self.awaited and not (oldest := self.awaited.popleft()[0]).done():
            how(oldest)
