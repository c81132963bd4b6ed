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

from .addresses import reach
from .connection import LONGEST_REPLY
from .messages import Refused, Values
from .opening import not_serving, server_command
from .session import Session
from .transport import open_socket, outlives_streams

Read = Callable[[str], Coroutine[Any, Any, Any]]  # converts the line of a reply to a value

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
    """Connects to a server through a socket.

    Args:
        address: A tcp://, tls:// or unix: address, or a file: address of a file that has one. Default: the value of
            RACEBEAM_ADDRESS.
        token: Token that the server requires. Default: that of the announce file, if there is one.
        tls: Context that verifies the server's certificate. Default: the authorities of the system.
        timeout: Seconds to wait for the connection and for each reply. Default: no limit.
        longest_reply: Bytes of the longest reply that is accepted.
        arrays: Whether bytes are returned as arrays of NumPy.

    Returns:
        The session.

    Raises:
        ValueError: If the address is invalid.
        OSError: If no server answers.
        TimeoutError: If no server answers in time.
        Refused: If the token is wrong.
    """
    opened = await asyncio.to_thread(reach, address, lambda found: open_socket(found, timeout))
    (connection, host), found, announcement = opened
    context = (tls or ssl.create_default_context()) if host else None
    opening = asyncio.open_connection(sock=connection, limit=longest_reply, ssl=context, server_hostname=host or None)
    try:
        reader, writer = await asyncio.wait_for(opening, timeout)
    except asyncio.TimeoutError:
        connection.close()
        raise TimeoutError(f"no server answers at {found}: timed out") from None
    session = AsyncSession(reader, writer, found, longest_reply, arrays, timeout=timeout)
    token = token or announcement
    session.again = lambda: connect(
        found, token=token, tls=tls, timeout=timeout, longest_reply=longest_reply, arrays=arrays
    )
    return await _greet(session, token)


async def launch(*options: str, program: str | None = None, arrays: bool = False) -> AsyncSession:
    """Starts a private server over standard streams. It stops when the session is closed or garbage-collected.

    Args:
        *options: Options of `racebeam serve`.
        program: Path of the program racebeam. Default: the installed one.
        arrays: Whether bytes are returned as arrays of NumPy.

    Returns:
        The session.

    Raises:
        FileNotFoundError: If the program is not found.
        ConnectionError: If the program does not serve.
    """
    pipe, command = asyncio.subprocess.PIPE, server_command(program, options)
    process = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, limit=LONGEST_REPLY)
    assert process.stdout is not None and process.stdin is not None
    try:
        session = AsyncSession(process.stdout, process.stdin, "", LONGEST_REPLY, arrays, process)
        session._must_terminate = outlives_streams(options)
        return await _greet(session, None)
    except ConnectionError as error:
        raise not_serving(command, error) from error


async def _greet(session: AsyncSession, token: str | None) -> AsyncSession:
    try:
        groups = await session.request("hello", **({} if token is None else {"token": token}))
        session._check_greeting(groups[0])
        return session
    except BaseException:
        await session.close()
        raise


class AsyncSession:
    """One session of the line protocol. `connect` and `launch` make sessions.

    The server carries out a request even if its task is cancelled. A session ends with the last reference to it.

    Args:
        reader: Stream of replies.
        writer: Stream of requests.
        address: Address of the server.
        longest_reply: Bytes of the longest reply that is accepted.
        arrays: Whether bytes are returned as arrays of NumPy.
        process: Process of the server, if the session started it.
        timeout: Seconds to wait for each reply, or None.

    Attributes:
        again: Opens a new session of the same server, or None.

    Examples:
        >>> import asyncio
        >>> from racebeam.wire import aio
        >>> async def play():
        ...     async with await aio.launch() as session:
        ...         await session.request("load", "beamfall", seed=7)
        ...         return await session.request("act", "FIRE*10")
        >>> asyncio.run(play())[0]["lives"]
        4
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
        self._must_terminate = False  # the process serves other addresses, too
        self._session = Session(cast(IO[bytes], None), cast(IO[bytes], writer), writer.close, arrays)
        self._session.address, self._session.longest_reply = address, longest_reply
        self._timeout = timeout
        self.again: Callable[[], Awaitable[AsyncSession]] | None = None
        self._replies = _Replies(reader, self._session)
        self._reading = asyncio.create_task(self._replies.read())

    def __del__(self) -> None:
        with contextlib.suppress(Exception):  # the constructor failed, or the event loop has ended
            self._session._check_process()
            self._reading.get_loop().call_soon_threadsafe(self._reading.cancel)  # which ends the session

    async def __aenter__(self) -> AsyncSession:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    def _check_greeting(self, greeting: Values) -> None:
        """Checks the reply to the first request.

        Args:
            greeting: Values of the reply.

        Raises:
            ConnectionError: If the server speaks another version of the protocol.
        """
        self._session._check_greeting(greeting)

    async def request(self, *words: object, **settings: object) -> list[Values]:
        """Sends a request, and waits for its reply.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as key=value.

        Returns:
            The groups of the reply, with numbers, and bytes or arrays.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If nothing comes from the server for as long as `timeout` says.
        """
        answer: list[Values] = await self._exchange(self._replies.values, *words, **settings)
        return answer

    async def help(self, *words: str) -> str:
        """Returns the server's help.

        Args:
            *words: What the help is about.

        Raises:
            Refused: If the server has no such help.
            ConnectionError: If the server is gone.
        """
        text: str = await self._exchange(self._replies.text, "help", *words)
        return text

    async def _exchange(self, read: Read, *words: object, **settings: object) -> Any:
        """Sends a request, and returns what `read` makes of its reply."""
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
        """Waits for an answer. Each reply to an earlier request restarts the time limit."""
        clock = asyncio.get_running_loop().time
        begin = clock()
        while not answer.done():
            remaining = max(begin, self._replies.last_reply) + limit - clock()
            if remaining <= 0:
                answer.cancel()
                raise self._session._fail(TimeoutError())
            await asyncio.wait([answer], timeout=remaining)

    async def reconnect(self) -> AsyncSession:
        """Opens a new session of the same server, without a game, and closes this one.

        Returns:
            The new session.

        Raises:
            ValueError: If `connect` did not make this session.
        """
        if self.again is None:
            raise ValueError("reconnect() is not possible, because connect() did not open this session")
        await self.close()
        return await self.again()

    async def close(self) -> None:
        """Ends the session. A second call does nothing."""
        self._session.close_connection()
        self._reading.cancel()
        await asyncio.gather(self._reading, return_exceptions=True)
        if self._process is not None:
            if self._must_terminate and self._process.returncode is None:
                self._process.terminate()
            await self._process.wait()


class _Replies:
    """Reads the replies of a session, and gives each to its request.

    It does not refer to its AsyncSession, which can be garbage-collected while this waits.

    Attributes:
        awaited: For each request without a reply, in order, its future and its reader.
        last_reply: Time of the last reply, on the clock of the event loop.
    """

    def __init__(self, reader: asyncio.StreamReader, session: Session) -> None:
        self._reader, self._session = reader, session
        self.awaited: collections.deque[tuple[asyncio.Future[Any], Read]] = collections.deque()
        self.last_reply = 0.0

    async def read(self) -> None:
        """Answers requests until the connection ends. Then the other requests raise the error."""
        error: BaseException = ConnectionError("the session was closed")
        try:
            while True:
                await self._read_reply()
        except asyncio.IncompleteReadError:
            error = self._session._fail(None)
        except (OSError, asyncio.LimitOverrunError) as why:
            error = why if isinstance(why, ConnectionError) else self._session._fail(why)
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
        except Refused as error:
            refusal = error
            self._answer(lambda answer: answer.set_exception(refusal))
        else:
            self._answer(lambda answer: answer.set_result(value))

    async def values(self, line: str) -> list[Values]:
        """Returns the groups of a reply.

        Args:
            line: Line of the reply.
        """
        words, groups, count = self._session._parse_reply(line)
        if count:
            self._session._split_bytes(words, groups, await self._reader.readexactly(count))
        return self._session._decode(words, groups)

    async def text(self, line: str) -> str:
        """Returns a reply without its status.

        Args:
            line: Line of the reply.
        """
        return self._session._read_status(line)[1]

    def _answer(self, how: Callable[[asyncio.Future[Any]], None]) -> None:
        """Answers the oldest request, if it still waits."""
        self.last_reply = asyncio.get_running_loop().time()
        # The numbers differ if Ctrl-C came between send() and append().
        if self.awaited and len(self.awaited) != len(self._session._unanswered) + 1:
            raise self._session._fail(ConnectionError("it was interrupted between a request and the end of its reply"))
        if self.awaited and not (oldest := self.awaited.popleft()[0]).done():
            how(oldest)
