"""The text of requests and replies of the line protocol."""

from __future__ import annotations

import enum
import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

PROTOCOL = 1  # the version that this client speaks
NUMBER = re.compile(r"-?(0|[1-9]\d{0,14})(\.\d+)?")

Texts = dict[str, Any]  # texts by key; bytes where the encoding is raw
Values = dict[str, Any]  # numbers, texts, and bytes or arrays, by key


class Refused(Exception):
    """The server refused a request. The session continues.

    Args:
        code: Code of the error, such as "bad-value".
        sentence: What the server says about the error.

    Attributes:
        code: Code of the error.
        sentence: What the server says about the error.
    """

    def __init__(self, code: str, sentence: str) -> None:
        super().__init__(code, sentence)
        self.code, self.sentence = code, sentence

    def __str__(self) -> str:
        return f"{self.code}: {self.sentence}"


class Reply(NamedTuple):
    """A reply before it is decoded.

    Attributes:
        words: Words of the request.
        text: Text after `ok `.
        data: Bytes that followed the line.
    """

    words: list[str]
    text: str
    data: bytes | bytearray


def parse_number(text: str) -> int | float | str:
    """Parses a number.

    Args:
        text: Text of a value.

    Returns:
        The number; or the text itself, such as an MD5 or the bytes 0046.
    """
    if not NUMBER.fullmatch(text):
        return text
    return float(text) if "." in text else int(text)


def parse_groups(text: str) -> list[Texts]:
    """Parses the groups of a reply, which " |" separates.

    Args:
        text: Text after `ok`.

    Returns:
        The texts of each group by their keys.
    """
    return [dict(word.split("=", 1) for word in group.split(" ") if "=" in word) for group in f" {text}".split(" |")]


def parse_count(text: str, limit: int) -> int:
    """Parses a number of bytes.

    Args:
        text: Decimal number.
        limit: The largest number that is accepted.

    Returns:
        The number.

    Raises:
        ValueError: If the text is not such a number.
    """
    count = int(text) if text.isdecimal() else -1
    if not 0 <= count <= limit:
        raise ValueError(f"{text!r} bytes follow its reply; the limit is {limit}")
    return count


def format_word(value: object) -> str:
    """Formats a word of a request.

    Args:
        value: Value of the word. A bool becomes 0 or 1, and a member of an enumeration, such as Action.FIRE, its value.
    """
    plain = value.value if isinstance(value, enum.Enum) else value
    return str(int(plain) if isinstance(plain, bool) else plain)


def optional_words(value: object) -> list[object]:
    """Lists a word that a request can omit.

    Args:
        value: The word, or None.

    Returns:
        A list of the word; empty for None.
    """
    return [] if value is None else [value]


def key_values(**settings: object) -> list[str]:
    """Formats settings as KEY=VALUE.

    Args:
        **settings: Values by key. A request omits those that are None.
    """
    return [f"{key}={format_word(value)}" for key, value in settings.items() if value is not None]


def format_request(words: Iterable[object], settings: Mapping[str, object]) -> str:
    """Formats a request.

    Args:
        words: Words of the request.
        settings: Settings of the request by key.

    Returns:
        The line without its end.

    Raises:
        ValueError: If the request has a line break, or is a comment.
    """
    line = " ".join(map(format_word, words))
    if settings:
        line = " ".join([line, *key_values(**settings)])
    if "\n" in line or line.lstrip(" ").startswith("#"):
        raise ValueError(f"a request is one line that does not begin with #, not {line!r}")
    return line
