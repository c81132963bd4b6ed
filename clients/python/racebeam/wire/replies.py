"""Replies: their lines, the bytes that follow them, and their values."""

from __future__ import annotations

import collections
import re
import zlib
from collections.abc import Callable
from typing import IO

from .connection import Connection
from .messages import PROTOCOL, Refused, Reply, Texts, Values, parse_count, parse_groups
from .observations import Observations
from .transport import SocketStream

RAW_COUNT = re.compile(r" raw=(\S+)$")
DAMAGES = (ValueError, KeyError, IndexError, zlib.error)  # what decoding a damaged reply raises


class Replies(Connection):
    """Pairs each reply with its request, and decodes it.

    Args:
        reader: Stream of replies.
        writer: Stream of requests.
        close: Closes the streams.
        arrays: Whether bytes are returned as arrays of NumPy.
    """

    def __init__(
        self,
        reader: IO[bytes] | SocketStream,
        writer: IO[bytes] | SocketStream,
        close: Callable[[], object],
        arrays: bool = False,
    ) -> None:
        super().__init__(reader, writer, close)
        self._observations = Observations(arrays)
        self._offered: list[str] = []  # encodings that the server offers, after a greeting
        self._unanswered: collections.deque[list[str]] = collections.deque()  # words of requests without a reply

    @property
    def height(self) -> int:
        """Rows of the screen of the loaded game."""
        return self._observations.height

    def _check_greeting(self, greeting: Values) -> None:
        """Checks the reply to hello.

        Args:
            greeting: Values of the reply.

        Raises:
            ConnectionError: If the server speaks another version of the protocol.
        """
        version = greeting.get("protocol")
        if version != PROTOCOL:
            sentence = f"it speaks version {version} of the protocol; this client speaks {PROTOCOL}"
            raise self._fail(ConnectionError(sentence))
        self._offered = str(greeting.get("encodings", "")).split(",")

    def _decode_plain(self, reply: Reply) -> list[Values]:
        """Decodes a reply of `_await_plain`.

        Args:
            reply: The reply.

        Returns:
            The groups of the reply, with numbers, and bytes or arrays.

        Raises:
            ConnectionError: If the reply is damaged.
        """
        groups = parse_groups(reply.text)
        if groups[-1].pop("raw", None):
            self._split_bytes(reply.words, groups, reply.data)
        return self._decode(reply.words, groups)

    def _receive_values(self) -> list[Values]:
        return self._decode(*self._receive())

    def _receive_plain(self) -> Reply:
        words, text = self._read_status(self._read_line())
        count = RAW_COUNT.search(text)
        return Reply(words, text, self._read_bytes(self._parse_count(count[1])) if count else b"")

    def _receive(self) -> tuple[list[str], list[Texts]]:
        """Returns the words of the oldest request without a reply, and the groups of its reply."""
        words, groups, count = self._parse_reply(self._read_line())
        if count:
            self._split_bytes(words, groups, self._read_bytes(count))
        return words, groups

    # A session of asyncio reads replies by itself. It passes each line to `_parse_reply` or `_read_status`, the
    # bytes that follow to `_split_bytes`, and the groups to `_decode`.

    def _parse_reply(self, line: str) -> tuple[list[str], list[Texts], int]:
        """Parses the line of a reply.

        Args:
            line: The line without its end.

        Returns:
            The words of the request, the groups of the reply, and the number of bytes that follow the line.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the reply is damaged.
        """
        words, text = self._read_status(line)
        groups = parse_groups(text)
        try:
            self._observations.follow(words, groups[0])
            count = groups[-1].pop("raw", None)
            return words, groups, parse_count(count, self.longest_reply) if count is not None else 0
        except DAMAGES as error:
            raise self._fail_decoding(error) from error

    def _read_status(self, line: str) -> tuple[list[str], str]:
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
        words = self._unanswered.popleft() if self._unanswered else [""]
        status, _, rest = line.partition(" ")
        if status == "error" and rest:
            code, _, sentence = rest.partition(" ")
            raise Refused(code, sentence)
        if status != "ok":
            raise self._fail(ConnectionError(f"it sent {line[:60]!r}, which is not a reply"))
        return words, rest

    def _split_bytes(self, words: list[str], groups: list[Texts], data: bytes | bytearray) -> None:
        """Gives each field with the encoding raw its part of the bytes that followed a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply. Bytes replace the counts in them.
            data: Bytes that followed the reply.

        Raises:
            ConnectionError: If the counts do not add up to the bytes.
        """
        try:
            self._observations.split_bytes(words, groups, data)
        except DAMAGES as error:
            raise self._fail_decoding(error) from error

    def _decode(self, words: list[str], groups: list[Texts]) -> list[Values]:
        """Decodes a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply, as texts.

        Returns:
            The groups with numbers, and bytes or arrays.

        Raises:
            ConnectionError: If a field is damaged.
        """
        try:
            return self._observations.decode(words, groups)
        except DAMAGES as error:
            raise self._fail_decoding(error) from error

    def _end(self, reason: str) -> None:
        self._unanswered.clear()
        super()._end(reason)

    def _parse_count(self, text: str) -> int:
        try:
            return parse_count(text, self.longest_reply)
        except DAMAGES as error:
            raise self._fail_decoding(error) from error

    def _fail_decoding(self, error: Exception) -> OSError:
        """Ends the session because a reply is damaged. Returns the error to raise."""
        return self._fail(ConnectionError(f"its reply is damaged: {error}"))
