"""Requests and their replies."""

from __future__ import annotations

import collections
import contextlib
import os
import re
import zlib
from collections.abc import Callable, Iterator
from typing import IO, TypeVar

from .messages import (
    PROTOCOL,
    Refused,
    Reply,
    Texts,
    Values,
    format_request,
    parse_count,
    parse_groups,
    parse_number,
)
from .observations import Observations
from .transport import SocketStream

LONGEST_REPLY = 1 << 28  # bytes; a server that sends a longer line is faulty
RAW_COUNT = re.compile(r" raw=(\S+)$")

Result = TypeVar("Result")


class Exchange:
    """Sends requests, and pairs each reply with its request.

    A call that is interrupted between a request and the end of its reply aborts the session. Otherwise, the next reply
    would be paired with the wrong request.

    Args:
        reader: Stream of replies.
        writer: Stream of requests.
        close: Closes the streams.
        arrays: Whether bytes are returned as arrays of NumPy.

    Attributes:
        reader: Stream of replies.
        writer: Stream of requests.
        address: Address of the server, or "".
        longest_reply: Bytes of the longest reply that is accepted.
        offered: Encodings that the server offers, after a greeting.
        unanswered: Words of each request without a reply, in order.
    """

    def __init__(
        self,
        reader: IO[bytes] | SocketStream,
        writer: IO[bytes] | SocketStream,
        close: Callable[[], object],
        arrays: bool = False,
    ) -> None:
        self.reader, self.writer, self._close = reader, writer, close
        self._observations = Observations(arrays)
        self._process = os.getpid()
        self._end_reason = ""
        self.address = ""
        self.longest_reply = LONGEST_REPLY
        self.offered: list[str] = []
        self.unanswered: collections.deque[list[str]] = collections.deque()

    @property
    def height(self) -> int:
        """Rows of the screen of the loaded game."""
        return self._observations.height

    def close_connection(self) -> None:
        """Ends the session. A second call does nothing. In a child process, the parent's session goes on."""
        self._end("the session was closed")

    def abort(self) -> None:
        """Ends the session because a request may lack its reply."""
        self._end("the session has ended: it was interrupted between a request and the end of its reply")

    def fail(self, error: Exception | None) -> OSError:
        """Ends the session because of an error.

        Args:
            error: The error, or None if the server closed the connection.

        Returns:
            The error to raise: TimeoutError for a TimeoutError, otherwise ConnectionError.
        """
        at = f" at {self.address}" if self.address else ""
        if isinstance(error, TimeoutError):
            self._end(f"the server{at} did not answer in time; the session has ended")
            return TimeoutError(self._end_reason)
        sentence = f"the session of the server{at} has ended" + (f": {error}" if error else "")
        self._end(sentence)
        return ConnectionError(sentence)

    def _end(self, reason: str) -> None:
        if not self._end_reason:
            self._end_reason = reason
            self.unanswered.clear()
            if os.getpid() == self._process:
                self._close()

    def check(self) -> None:
        """Checks that the session can send a request.

        Raises:
            ConnectionError: If the session has ended.
            RuntimeError: In a child process after a fork.
        """
        self.check_process()
        if self._end_reason:
            raise ConnectionError(self._end_reason)

    def check_process(self) -> None:
        """Checks that this process opened the session.

        Raises:
            RuntimeError: In a child process after a fork.
        """
        if os.getpid() != self._process:
            raise RuntimeError("this session of a server was opened before the process forked; open a new one")

    def check_greeting(self, greeting: Values) -> None:
        """Checks the reply to hello.

        Args:
            greeting: Values of the reply.

        Raises:
            ConnectionError: If the server speaks another version of the protocol.
        """
        version = greeting.get("protocol")
        if version != PROTOCOL:
            sentence = f"it speaks version {version} of the protocol; this client speaks {PROTOCOL}"
            raise self.fail(ConnectionError(sentence))
        self.offered = str(greeting.get("encodings", "")).split(",")

    def send(self, *words: object, **settings: object) -> None:
        """Sends a request ahead. `receive` returns the replies in order.

        A server stops reading if its replies are not received. Send some dozens of requests at a time.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Raises:
            ConnectionError: If the server is gone.
            TimeoutError: If sending takes too long.
            ValueError: If the request is not one line.
        """
        line = format_request(words, settings)
        self.check()
        self._abort_on_interrupt(lambda: self._write(line))

    def begin(self, *words: object, **settings: object) -> None:
        """Sends one request at once. `receive` returns its reply.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Raises:
            ConnectionError: If the server is gone.
            TimeoutError: If sending takes too long.
            ValueError: If the request is not one line, or other requests lack their replies.
        """
        self._check_answered()
        self.send(*words, **settings)
        self.flush()

    def flush(self) -> None:
        """Sends the requests that `send` gathered. `receive` does so too.

        Raises:
            ConnectionError: If the server is gone.
            TimeoutError: If sending takes too long.
        """
        self.check()
        self._abort_on_interrupt(self._flush)

    def receive(self) -> list[Texts]:
        """Receives the next reply.

        Returns:
            The groups of the reply, as texts.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
        """
        self.check()
        return self._abort_on_interrupt(self._receive)[1]

    def receive_values(self) -> list[Values]:
        """Receives the next reply, and decodes it.

        Returns:
            The groups of the reply, with numbers, and bytes or arrays.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
        """
        self.check()
        return self._abort_on_interrupt(self._receive_values)

    def receive_plain(self) -> Reply:
        """Receives the next reply, to a request that does not change later replies, such as `step`.

        Returns:
            The reply for `decode_plain`.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
        """
        self.check()
        return self._abort_on_interrupt(self._receive_plain)

    def decode_plain(self, reply: Reply) -> list[Values]:
        """Decodes a reply of `receive_plain`.

        Args:
            reply: The reply.

        Returns:
            The groups of the reply, with numbers, and bytes or arrays.

        Raises:
            ConnectionError: If the reply is damaged.
        """
        groups = parse_groups(reply.text)
        if groups[-1].pop("raw", None):
            self.split_bytes(reply.words, groups, reply.data)
        return self.decode(reply.words, groups)

    def request(self, *words: object, **settings: object) -> list[Values]:
        """Sends any request, and decodes its reply.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Returns:
            The groups of the reply, with numbers, and bytes or arrays.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
            ValueError: If the request is not one line, or other requests lack their replies.
        """
        return self._exchange(self._receive_values, *words, **settings)

    def ask(self, *words: object, **settings: object) -> list[Texts]:
        """Sends any request, and returns its reply as texts.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Returns:
            The groups of the reply, as texts.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
            ValueError: If the request is not one line, or other requests lack their replies.
        """
        return self._exchange(lambda: self._receive()[1], *words, **settings)

    def values(self, *words: object, **settings: object) -> Values:
        """Sends a request whose reply has no bytes.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Returns:
            The first group of the reply, with numbers. Raises what `ask` raises.
        """
        return {key: parse_number(text) for key, text in self.ask(*words, **settings)[0].items()}

    def list_of(self, key: str, *words: object) -> list[str]:
        """Sends a request whose reply has a list.

        Args:
            key: Key of the list.
            *words: Words of the request.

        Returns:
            The list in the first group of the reply. Raises what `ask` raises.
        """
        text = self.ask(*words)[0][key]
        return text.split(",") if text else []

    def _first(self, *words: object) -> Values:
        """Returns the first group of a reply, decoded."""
        return self.request(*words)[0]

    def _rest(self, *words: object) -> list[Values]:
        """Returns the groups after the first, decoded."""
        return self.request(*words)[1:]

    def _ints_of(self, key: str, *words: object) -> list[int]:
        return [int(text) for text in self.list_of(key, *words)]

    def _exchange(self, read: Callable[[], Result], *words: object, **settings: object) -> Result:
        """Sends a request, and returns what `read` returns for its reply."""
        line = format_request(words, settings)
        self.check()
        self._check_answered()

        def exchange() -> Result:
            self._write(line)
            return read()

        return self._abort_on_interrupt(exchange)

    def _check_answered(self) -> None:
        if self.unanswered:
            raise ValueError(f"{len(self.unanswered)} requests were sent ahead; receive their replies first")

    def _abort_on_interrupt(self, call: Callable[[], Result]) -> Result:
        """Runs `call`. If it is interrupted, such as by Ctrl-C, aborts the session."""
        try:
            return call()
        except Refused:
            raise
        except BaseException:
            self.abort()
            raise

    def _write(self, line: str) -> None:
        self.unanswered.append(line.split())
        try:
            self.writer.write(f"{line}\n".encode())
        except OSError as error:
            raise self.fail(error) from error

    def _flush(self) -> None:
        try:
            self.writer.flush()
        except ConnectionError:
            pass  # the server may have written why it ends
        except OSError as error:
            raise self.fail(error) from error

    def _receive_values(self) -> list[Values]:
        return self.decode(*self._receive())

    def _receive_plain(self) -> Reply:
        words, text = self.read_status(self._read_line())
        count = RAW_COUNT.search(text)
        return Reply(words, text, self._read_bytes(self._parse_count(count[1])) if count else b"")

    def _receive(self) -> tuple[list[str], list[Texts]]:
        """Returns the words of the oldest request without a reply, and the groups of its reply."""
        words, groups, count = self.parse_reply(self._read_line())
        if count:
            self.split_bytes(words, groups, self._read_bytes(count))
        return words, groups

    def _read_line(self) -> str:
        self._flush()
        try:
            line = self.reader.readline(self.longest_reply)
        except OSError as error:  # such as a TimeoutError in the middle of a reply
            raise self.fail(error) from error
        if not line.endswith(b"\n"):
            is_long = len(line) >= self.longest_reply
            too_long = ConnectionError(f"its reply is longer than {self.longest_reply} bytes")
            raise self.fail(too_long if is_long else None)
        return line.decode("latin-1").rstrip("\n")

    def _read_bytes(self, count: int) -> bytes | bytearray:
        try:
            data = self.reader.read(count)
        except OSError as error:
            raise self.fail(error) from error
        if len(data) < count:
            raise self.fail(None)
        return data

    # A session of asyncio reads replies by itself. It passes each line to `parse_reply` or `read_status`, the bytes
    # that follow to `split_bytes`, and the groups to `decode`.

    def parse_reply(self, line: str) -> tuple[list[str], list[Texts], int]:
        """Parses the line of a reply.

        Args:
            line: The line without its end.

        Returns:
            The words of the request, the groups of the reply, and the number of bytes that follow the line.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the reply is damaged.
        """
        words, text = self.read_status(line)
        groups = parse_groups(text)
        with self._fail_if_damaged():
            self._observations.follow(words, groups[0])
        return words, groups, self._parse_count(groups[-1].pop("raw", "0"))

    def read_status(self, line: str) -> tuple[list[str], str]:
        """Reads the status of a reply.

        Args:
            line: The line of the reply without its end.

        Returns:
            The words of the oldest request without a reply, and the text after `ok `.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the line is not a reply.
        """
        # Without a request, the server writes why it ends.
        words = self.unanswered.popleft() if self.unanswered else [""]
        status, _, rest = line.partition(" ")
        if status == "error" and rest:
            code, _, sentence = rest.partition(" ")
            raise Refused(code, sentence)
        if status != "ok":
            raise self.fail(ConnectionError(f"it sent {line[:60]!r}, which is not a reply"))
        return words, rest

    def split_bytes(self, words: list[str], groups: list[Texts], data: bytes | bytearray) -> None:
        """Gives each field with the encoding raw its part of the bytes that followed a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply. Bytes replace the counts in them.
            data: Bytes that followed the reply.

        Raises:
            ConnectionError: If the counts do not add up to the bytes.
        """
        with self._fail_if_damaged():
            self._observations.split_bytes(words, groups, data)

    def decode(self, words: list[str], groups: list[Texts]) -> list[Values]:
        """Decodes a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply, as texts.

        Returns:
            The groups with numbers, and bytes or arrays.

        Raises:
            ConnectionError: If a field is damaged.
        """
        with self._fail_if_damaged():
            return self._observations.decode(words, groups)

    def _parse_count(self, text: str) -> int:
        with self._fail_if_damaged():
            return parse_count(text, self.longest_reply)

    @contextlib.contextmanager
    def _fail_if_damaged(self) -> Iterator[None]:
        try:
            yield
        except (ValueError, KeyError, IndexError, zlib.error) as error:
            raise self.fail(ConnectionError(f"its reply is damaged: {error}")) from error
