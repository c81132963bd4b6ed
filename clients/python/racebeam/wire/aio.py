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
from typing import IO, Any, cast

from . import client
from .client import LONGEST_REPLY, Refused, Texts, Values

__all__ = ["AsyncSession", "connect", "launch"]


async def connect(address: str | None = None, *, token: str | None = None, tls: ssl.SSLContext | None = None,
                  longest_reply: int = LONGEST_REPLY, arrays: bool = False) -> AsyncSession:
    """As racebeam.connect(), of sockets: tcp://, tls:// and unix: addresses, and file: with one of these."""
    (connection, host), address, announced = await asyncio.to_thread(client.reached, address, lambda found: client.connected(found, None))
    context = (tls or ssl.create_default_context()) if host else None
    reader, writer = await asyncio.open_connection(sock=connection, limit=longest_reply, ssl=context,
                                                   server_hostname=host or None)
    return await _greeted(AsyncSession(reader, writer, address, longest_reply, arrays), token or announced)


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
                 process: asyncio.subprocess.Process | None = None) -> None:
        self._reader, self._writer, self._process = reader, writer, process
        self._session = client.Session(cast(IO[bytes], None), cast(IO[bytes], writer), writer.close, arrays)
        self._session.address, self._session.longest_reply = address, longest_reply
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
        """The groups of the reply, with numbers, and bytes or arrays. Raises Refused, and ConnectionError when the server has
        gone."""
        self._session.send(*words, **settings)
        answer: asyncio.Future[list[Values]] = asyncio.get_running_loop().create_future()
        self._answers.append(answer)
        await self._writer.drain()
        return await answer

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
        if self._answers and not (oldest := self._answers.popleft()).done():
            how(oldest)
