# Made from clients/python/racebeam/wire by protocol/description/generate. Do not change it by hand.
"""A client of the racebeam line protocol (protocol/PROTOCOL.md), which needs the standard library only.

    with launch() as game:  # or connect("tcp://HOST:PORT"), or another address
        game.load("beamfall", seed=7, frame_skip=4)
        game.observe("reward", "terminated", "truncated", "ram", "screen:delta")
        while True:
            reply = game.act("FIRE")  # {"reward": 0, "terminated": 0, ..., "screen": bytes}
            if reply["terminated"] or reply["truncated"]:
                break

A session has a method for each command, in the order of the document. It returns numbers as int or float, and bytes as
bytes; or as arrays of NumPy, if it was opened with arrays=True. If the server refuses a request, the method raises
Refused, and the session continues. It raises ConnectionError if the server is gone, and TimeoutError if the server does
not answer in time. Both end the session.
"""

from __future__ import annotations

import base64
import collections
import contextlib
import enum
import json
import math
import os
import re
import shlex
import shutil
import socket
import ssl
import stat
import subprocess
import sys
import time
import zlib
from collections.abc import Callable, Iterable, Mapping
from typing import IO, Any, NamedTuple, TypeVar

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


def decode_runs(data: bytes) -> bytes:
    """Decodes runs.

    Args:
        data: Pairs of a value and a length.

    Returns:
        The values, repeated.
    """
    return b"".join(data[at : at + 1] * data[at + 1] for at in range(0, len(data), 2))


def apply_delta(array: bytearray, text: str) -> None:
    """Changes an array by a delta.

    Args:
        array: The bytes before; the bytes after, when the function returns.
        text: The delta in hexadecimal.

    Raises:
        ValueError: If the delta does not fit the array, a part of which may have changed.
    """
    data, at, place = bytes.fromhex(text), 0, 0
    while at < len(data):
        place += data[at] << 8 | data[at + 1]
        runs, at = data[at + 2], at + 3
        for _ in range(runs):
            value, length, at = data[at], data[at + 1], at + 2
            if place + length > len(array):
                raise ValueError(f"a delta reaches byte {place + length} of {len(array)}")
            array[place : place + length] = bytes([value]) * length
            place += length


def decode_rewards(text: str) -> list[int]:
    """Decodes the rewards of a branch.

    Args:
        text: Rewards with their repetitions, such as "0*12,1,0*3".

    Returns:
        The reward of each act.
    """
    rewards: list[int] = []
    for run in filter(None, text.split(",")):
        reward, _, times = run.partition("*")
        rewards += [int(reward)] * int(times or 1)
    return rewards


DECODERS: dict[str, Callable[[Any], bytes]] = {
    "hex": bytes.fromhex,
    "rle": lambda text: decode_runs(bytes.fromhex(text)),
    "base64": base64.b64decode,
    "zlib": lambda text: zlib.decompress(base64.b64decode(text)),
    "raw": bytes,
}


# generated: fields, from protocol/protocol.toml
# The encoding of each field when `observe` does not name one.
USUAL_ENCODING = {
    "ram": "hex",
    "tia": "hex",
    "state_hash": "hex",
    "screen": "rle",
    "rgb": "zlib",
    "grey": "zlib",
    "palette": "hex",
    "audio": "hex",
    "audio_all": "hex",
}
SHAPES: dict[str, tuple[int | str, ...]] = {
    "ram": (128,),
    "tia": (53,),
    "state_hash": (8,),
    "screen": ("height", 160),
    "rgb": ("height", 160, 3),
    "grey": ("height", 160),
    "palette": (256, 3),
    "audio": (512,),
    "audio_all": (-1, 512),
}
# end of fields

STACK_FIELD = re.compile(r"(?:grey|rgb)(\d+)x(\d+)x(\d+)")  # fields such as grey100x50x4


def field_shape(field: str, height: int) -> tuple[int, ...]:
    """Returns the shape of a field of bytes.

    Args:
        field: Name of the field.
        height: Rows of the machine's screen.
    """
    if field.startswith("grey84") and field.count("x") < 2:
        screens = field.partition("x")[2]
        return (int(screens), 84, 84) if screens else (84, 84)
    if stack := STACK_FIELD.fullmatch(field):
        width, rows, depth = map(int, stack.groups())
        return (depth, rows, width, 3) if field.startswith("rgb") else (depth, rows, width)
    return tuple(height if length == "height" else int(length) for length in SHAPES[field])


def field_encodings(fields: Iterable[str]) -> dict[str, str]:
    """Returns the encodings of the fields of bytes.

    Args:
        fields: Fields as `observe` takes them, such as "ram" or "screen:delta".

    Returns:
        The encoding of each field of bytes by its name.
    """
    encodings = {}
    for name, _, encoding in (field.partition(":") for field in fields):
        is_stack = name.startswith("grey84") or STACK_FIELD.fullmatch(name)
        encodings[name] = encoding or USUAL_ENCODING.get(name, "zlib" if is_stack else "")
    return {name: encoding for name, encoding in encodings.items() if encoding}


Arrays = dict[str, bytearray]  # the bytes that the deltas of a field have made so far, by field


class WatchedGame(NamedTuple):
    """The deltas of a watched session. Other fields or another height start new deltas.

    Attributes:
        fields: Fields of the request.
        height: Rows of the screen.
        arrays: Bytes of each field.
    """

    fields: list[str]
    height: int
    arrays: Arrays


def _watched_fields(words: list[str]) -> list[str]:
    """Returns the fields of a request `watch NAME [since=FRAME] FIELD...`."""
    return [word for word in words[2:] if "=" not in word]


def _first_machine(words: list[str]) -> int:
    """Returns the machine of the first group: 0 for that of `load`, and from 1 for those of `open`.

    A request `restore NAME machine=I` is about machine I + 1.
    """
    restored = [word for word in words[2:] if word.startswith("machine=")] if words[:1] == ["restore"] else []
    return int(restored[0].partition("=")[2]) + 1 if restored else 0


class Observations:
    """The fields that a session observes, and the bytes that their deltas have made.

    Args:
        as_arrays: Whether bytes are returned as arrays of NumPy.

    Attributes:
        height: Rows of the screen of the loaded game.
    """

    def __init__(self, as_arrays: bool) -> None:
        self.height = 0
        self._as_arrays = as_arrays
        self._encodings: dict[str, str] = {}  # of the fields that observe chose
        self._arrays: dict[int, Arrays] = {}  # per machine; 0 is that of load
        self._watched: dict[str, WatchedGame] = {}  # by name

    def follow(self, words: list[str], first: Texts) -> None:
        """Keeps what a request changes about later replies.

        Args:
            words: Words of a request that the server granted.
            first: First group of its reply.

        Raises:
            KeyError: If the reply lacks a key.
            ValueError: If the reply is damaged.
        """
        command, *fields = words or [""]
        if command == "observe" and fields:
            self._encodings = field_encodings(fields)
            self._arrays.clear()
        elif command == "load":
            self.height = int(first["height"])
            self._arrays.clear()
        elif command == "open":
            self._arrays = {0: self._arrays.get(0, {})}

    def split_bytes(self, words: list[str], groups: list[Texts], data: bytes | bytearray) -> None:
        """Gives each field with the encoding raw its part of the bytes that followed a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply. Bytes replace the counts in them.
            data: Bytes that followed the reply.

        Raises:
            ValueError: If the counts do not add up to the bytes.
        """
        encodings, view, end = self._encodings_of(words), memoryview(data), 0
        for texts in groups:
            for key, text in texts.items():
                if encodings.get(key.removeprefix("final_")) == "raw":
                    begin, end = end, end + parse_count(text, len(data))
                    texts[key] = view[begin:end]
        if end != len(data):
            raise ValueError(f"its fields have {end} bytes, but {len(data)} followed its reply")

    def decode(self, words: list[str], groups: list[Texts]) -> list[Values]:
        """Decodes a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply.

        Returns:
            The groups with numbers, and bytes or arrays.

        Raises:
            IndexError: If a field is damaged.
            ValueError: If a field is damaged.
            zlib.error: If a field is damaged.
        """
        encodings = self._encodings_of(words)
        if words[:1] == ["watch"]:
            game = self._watched_game(words, groups[0])
            return [self._decode_group(texts, game.arrays, encodings, game.height) for texts in groups]
        return [
            self._decode_group(texts, self._arrays.setdefault(machine, {}), encodings, self.height)
            for machine, texts in enumerate(groups, _first_machine(words))
        ]

    def _encodings_of(self, words: list[str]) -> dict[str, str]:
        """Returns the encodings of the fields that a request names, or else of those that observe chose."""
        if words[:1] == ["watch"]:
            return field_encodings(_watched_fields(words))
        return field_encodings(words[1:]) if words[:1] == ["look"] and len(words) > 1 else self._encodings

    def _watched_game(self, words: list[str], texts: Texts) -> WatchedGame:
        fields, height = _watched_fields(words), int(texts.get("height", self.height))
        game = self._watched.get(words[1])
        if game is None or game[:2] != (fields, height):
            game = self._watched[words[1]] = WatchedGame(fields, height, {})
        return game

    def _decode_group(self, texts: Texts, arrays: Arrays, encodings: dict[str, str], height: int) -> Values:
        return {
            key: self._decode_value(key.removeprefix("final_"), text, arrays, encodings, height)
            for key, text in texts.items()
        }

    def _decode_value(self, field: str, text: str, arrays: Arrays, encodings: dict[str, str], height: int) -> Any:
        encoding = encodings.get(field)
        if encoding is None:
            return parse_number(text)
        if encoding != "delta":
            return self._shape(DECODERS[encoding](text), field, height)
        if field not in arrays:
            arrays[field] = bytearray(math.prod(field_shape(field, height)))
        apply_delta(arrays[field], text)
        return self._shape(bytes(arrays[field]), field, height)

    def _shape(self, data: bytes, field: str, height: int) -> Any:
        """Returns bytes as the session returns them."""
        if not self._as_arrays:
            return data
        import numpy

        return numpy.frombuffer(data, numpy.uint8).reshape(field_shape(field, height))


ANNOUNCEMENT = 1  # the version of announce files that this client reads
BETWEEN_TRIES = 0.05  # seconds
WAIT = re.compile(r"(file:.+)\?wait=(.*)", re.DOTALL)
SECONDS = re.compile(r"[0-9]{1,9}(\.[0-9]+)?")
ADDRESSES = (
    "it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, also in RACEBEAM_ADDRESS"
)
ON_WINDOWS = "on Windows, it takes tcp://HOST:PORT, tls://HOST:PORT, stdio or file:PATH"
IS_WINDOWS = os.name == "nt"
FILES = "file:PATH takes the --ready-file or --announce file of a server"

Opened = TypeVar("Opened")


def reach(address: str | None, open_address: Callable[[str], Opened]) -> tuple[Opened, str, str | None]:
    """Opens a connection. Tries again for as long as ?wait= of the address says.

    Args:
        address: Address of the server, or None for that of RACEBEAM_ADDRESS.
        open_address: Opens a connection to an address that is not a file.

    Returns:
        The connection, its address, and the token of the announce file or None.

    Raises:
        ValueError: If the address is invalid, or the file has no address.
        OSError: If no server answers.
    """
    address = address or os.environ.get("RACEBEAM_ADDRESS", "")
    if not address:
        raise ValueError(f"the address is missing, and the variable RACEBEAM_ADDRESS is not set; {ADDRESSES}")
    wait = WAIT.fullmatch(address)
    if wait and not SECONDS.fullmatch(wait[2]):
        raise ValueError(f"the address is {address!r}; ?wait= takes seconds, from 0 to 999999999")
    file = wait[1] if wait else address
    until = time.monotonic() + (float(wait[2]) if wait else 0)
    while True:
        found = file
        try:
            found, token = _read_file(file)
            if IS_WINDOWS and found.startswith(("unix:", "pipes:")):
                raise ValueError(f"the address is {found!r}; {ON_WINDOWS}")
            return open_address(found), found, token
        except OSError as error:
            if time.monotonic() >= until:
                source = "" if found == file else f", which {file.removeprefix('file:')} names"
                sentence = f"no server answers at {found}{source}: {error.strerror or error}"
                if not error.strerror:  # such as a TimeoutError
                    raise type(error)(sentence) from error
                error.strerror, error.args = sentence, (error.errno, sentence)  # the latter are what pickle copies
                raise
            time.sleep(BETWEEN_TRIES)


def _read_file(address: str) -> tuple[str, str | None]:
    """Returns the first usable address of a ready file or an announce file, and its token.

    Other addresses are returned as they are.
    """
    if not address.startswith("file:"):
        return address, None
    path = address.removeprefix("file:")
    if not stat.S_ISREG(os.stat(path).st_mode):  # a pipe might block
        raise ValueError(f"{path} is not a regular file; {FILES}")
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        text = file.read()
    addresses, token = _parse_announcement(path, text) if text.startswith("{") else (text.splitlines(), None)
    for line in addresses:
        if line.startswith(("tcp://", "tls://", "unix:", "pipes:")):
            return line, token
    if text.startswith(("{", "#")):
        raise ValueError(f"{path} names no address that this client can use")
    raise ValueError(f"{path} {'has other contents' if text else 'is empty'}; {FILES}")


def _parse_announcement(path: str, text: str) -> tuple[list[str], str | None]:
    """Returns the addresses and the token of an announce file."""
    try:
        announcement: dict[str, Any] = json.loads(text)
        version = announcement["racebeam_announce"]
        if version == ANNOUNCEMENT:
            return announcement["addresses"], announcement["token"]
    except (KeyError, TypeError, ValueError, RecursionError):
        raise ValueError(f"{path} is not a whole announce file") from None
    raise ValueError(f"{path} is an announce file of version {version}; this client reads version {ANNOUNCEMENT}")


MOST_UNSENT = 1 << 13  # bytes of requests that are gathered


def open_socket(address: str, timeout: float | None) -> tuple[socket.socket, str]:
    """Opens a connection without TLS.

    Args:
        address: Address tcp://HOST:PORT, tls://HOST:PORT or unix:PATH.
        timeout: Seconds to wait for the connection, or None for no limit.

    Returns:
        The socket, and the name that the server proves by TLS; "" without TLS.

    Raises:
        ValueError: If the address is invalid.
        OSError: If no server answers.
    """
    kind, _, rest = address.partition(":")
    host, _, port = rest.removeprefix("//").rpartition(":")
    if kind == "unix" and rest:
        return _open_unix_socket(rest, timeout), ""
    if kind not in ("tcp", "tls") or not rest.startswith("//") or not host or not port.isdecimal():
        raise ValueError(f"the address is {address!r}; {ADDRESSES}")
    host = host.removeprefix("[").removesuffix("]")
    connection = socket.create_connection((host, int(port)), timeout)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection, host if kind == "tls" else ""


def _open_unix_socket(path: str, timeout: float | None) -> socket.socket:
    connection = socket.socket(socket.AF_UNIX)
    connection.settimeout(timeout)
    try:
        connection.connect(path)
    except BaseException:
        connection.close()
        raise
    return connection


def open_secure_socket(address: str, tls: ssl.SSLContext | None, timeout: float | None) -> socket.socket:
    """Opens a connection, with TLS for an address tls://HOST:PORT.

    Args:
        address: Address as `open_socket` takes it.
        tls: Context that verifies the server's certificate. Default: the authorities of the system.
        timeout: Seconds to wait for the connection, or None for no limit.

    Returns:
        The socket.

    Raises:
        ValueError: If the address is invalid.
        OSError: If no server answers, or its certificate is not trusted.
    """
    connection, host = open_socket(address, timeout)
    if not host:
        return connection
    try:
        return (tls or ssl.create_default_context()).wrap_socket(connection, server_hostname=host)
    except BaseException:
        connection.close()
        raise


def outlives_streams(options: Iterable[str]) -> bool:
    """Returns whether a server has another address, so that the end of its standard streams does not end it.

    Args:
        options: Options of `racebeam serve`.
    """
    return any(option.partition("=")[0] in ("--listen", "--pipes") for option in options)


def close_pipes(writer: IO[bytes], reader: IO[bytes]) -> None:
    """Closes pipes without waiting for a server that does not read.

    Args:
        writer: Pipe of the requests.
        reader: Pipe of the replies.
    """
    os.set_blocking(writer.fileno(), False)
    for end in (writer, reader):
        with contextlib.suppress(OSError):  # unsent requests are lost
            end.close()


class SocketStream:
    """Reads lines and bytes from a socket, and gathers what it sends. Each call keeps the socket's time limit.

    Args:
        connection: The socket.

    Attributes:
        connection: The socket.
    """

    def __init__(self, connection: socket.socket) -> None:
        self.connection, self._limit, self._data = connection, connection.gettimeout(), b""
        self._unsent = bytearray()

    def write(self, data: bytes) -> None:
        """Gathers bytes to send. Sends them when there are many.

        Args:
            data: The bytes.

        Raises:
            OSError: If the connection is lost.
            TimeoutError: If sending takes longer than the limit.
        """
        self._unsent += data
        if len(self._unsent) > MOST_UNSENT:
            self.flush()

    def flush(self) -> None:
        """Sends the bytes that `write` gathered.

        Raises:
            OSError: If the connection is lost.
            TimeoutError: If sending takes longer than the limit.
        """
        data, self._unsent = self._unsent, bytearray()
        if data:
            self.connection.sendall(data)

    def readline(self, most: int) -> bytes:
        """Reads a line.

        Args:
            most: Limit of its bytes.

        Returns:
            The line with its end; without it, if the line is too long or the connection ended.

        Raises:
            OSError: If the connection is lost.
            TimeoutError: If the line takes longer than the limit.
        """
        if (end := self._data.find(b"\n")) >= 0:
            line, self._data = self._data[: end + 1], self._data[end + 1 :]
            return line
        until = self._deadline()
        pieces, length = [self._data], len(self._data)
        while (end := pieces[-1].find(b"\n")) < 0 and length < most:
            self._limit_wait(until)
            pieces.append(self.connection.recv(1 << 16))
            length += len(pieces[-1])
            if not pieces[-1]:
                break
        self._restore_limit(until)
        size = end + 1 if end >= 0 else len(pieces[-1])
        last, self._data = pieces[-1][:size], pieces[-1][size:]
        return b"".join([*pieces[:-1], last])

    def read(self, count: int) -> bytearray:
        """Reads bytes.

        Args:
            count: Number of bytes.

        Returns:
            The bytes; fewer if the connection ended.

        Raises:
            OSError: If the connection is lost.
            TimeoutError: If the bytes take longer than the limit.
        """
        until = self._deadline()
        data = bytearray(count)
        have = min(count, len(self._data))
        data[:have], self._data = self._data[:have], self._data[have:]
        with memoryview(data) as view:
            while have < count:
                self._limit_wait(until)
                size = self.connection.recv_into(view[have:])
                if size == 0:
                    break
                have += size
        self._restore_limit(until)
        del data[have:]
        return data

    def close(self) -> None:
        """Closes the socket without waiting. Another thread that reads or writes gets an error."""
        with contextlib.suppress(OSError):  # the server has closed it
            self.connection.shutdown(socket.SHUT_RDWR)
        self.connection.close()

    def _deadline(self) -> float | None:
        return None if self._limit is None else time.monotonic() + self._limit

    def _limit_wait(self, until: float | None) -> None:
        if until is not None:
            self.connection.settimeout(max(until - time.monotonic(), 1e-6))

    def _restore_limit(self, until: float | None) -> None:
        if until is not None:
            self.connection.settimeout(self._limit)


LONGEST_REPLY = 1 << 28  # bytes; a server that sends a longer line is faulty

Result = TypeVar("Result")


class Connection:
    """The streams of a session. Every error of a stream ends the session.

    This class and those above it are the base classes of `Session`. Their names with an underscore are for the modules
    of this folder.

    Args:
        reader: Stream of replies.
        writer: Stream of requests.
        close: Closes the streams.

    Attributes:
        address: Address of the server, or "".
        longest_reply: Bytes of the longest reply that is accepted.
    """

    def __init__(
        self, reader: IO[bytes] | SocketStream, writer: IO[bytes] | SocketStream, close: Callable[[], object]
    ) -> None:
        self._reader, self._writer, self._close = reader, writer, close
        self._process = os.getpid()
        self._end_reason = ""
        self.address = ""
        self.longest_reply = LONGEST_REPLY

    def close_connection(self) -> None:
        """Ends the session. A second call does nothing. In a child process, the parent's session continues."""
        self._end("the session was closed")

    def _abort(self) -> None:
        """Ends the session because a request may lack its reply."""
        self._end("the session has ended: it was interrupted between a request and the end of its reply")

    def _fail(self, error: Exception | None) -> OSError:
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
            if os.getpid() == self._process:
                self._close()

    def _check(self) -> None:
        """Checks that the session can send a request.

        Raises:
            ConnectionError: If the session has ended.
            RuntimeError: In a child process after a fork.
        """
        self._check_process()
        if self._end_reason:
            raise ConnectionError(self._end_reason)

    def _check_process(self) -> None:
        """Checks that this process opened the session.

        Raises:
            RuntimeError: In a child process after a fork.
        """
        if os.getpid() != self._process:
            raise RuntimeError("this session of a server was opened before the process forked; open a new one")

    def _abort_on_interrupt(self, call: Callable[[], Result]) -> Result:
        """Runs `call`. If it is interrupted, such as by Ctrl-C, aborts the session."""
        try:
            return call()
        except Refused:
            raise
        except BaseException:
            self._abort()
            raise

    def _write_line(self, line: str) -> None:
        try:
            self._writer.write(f"{line}\n".encode())
        except OSError as error:
            raise self._fail(error) from error

    def _flush(self) -> None:
        try:
            self._writer.flush()
        except ConnectionError:
            pass  # the server may have written why it ends
        except OSError as error:
            raise self._fail(error) from error

    def _read_line(self) -> str:
        self._flush()
        try:
            line = self._reader.readline(self.longest_reply)
        except OSError as error:  # such as a TimeoutError in the middle of a reply
            raise self._fail(error) from error
        if not line.endswith(b"\n"):
            is_long = len(line) >= self.longest_reply
            too_long = ConnectionError(f"its reply is longer than {self.longest_reply} bytes")
            raise self._fail(too_long if is_long else None)
        return line.decode("latin-1").rstrip("\n")

    def _read_bytes(self, count: int) -> bytes | bytearray:
        try:
            data = self._reader.read(count)
        except OSError as error:
            raise self._fail(error) from error
        if len(data) < count:
            raise self._fail(None)
        return data


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


class Exchange(Replies):
    """Sends requests, and receives their replies in order.

    A call that is interrupted between a request and the end of its reply aborts the session. Otherwise, the next reply
    would be paired with the wrong request. `Connection` and `Replies` describe the arguments and the attributes.
    """

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
        self._check()
        self._abort_on_interrupt(lambda: self._write(line))

    def _begin(self, *words: object, **settings: object) -> None:
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
        self._check()
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
        self._check()
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
        self._check()
        return self._abort_on_interrupt(self._receive_values)

    def _await_plain(self) -> Reply:
        """Receives the next reply, to a request that does not change later replies, such as `step`.

        Returns:
            The reply for `_decode_plain`.

        Raises:
            Refused: If the server refuses the request.
            ConnectionError: If the server is gone.
            TimeoutError: If the server does not answer in time.
        """
        self._check()
        return self._abort_on_interrupt(self._receive_plain)

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

    def _values_of(self, *words: object, **settings: object) -> Values:
        """Sends a request whose reply has no bytes.

        Args:
            *words: Words of the request.
            **settings: Settings of the request, sent as KEY=VALUE.

        Returns:
            The first group of the reply, with numbers. Raises what `ask` raises.
        """
        return {key: parse_number(text) for key, text in self.ask(*words, **settings)[0].items()}

    def _list_of(self, key: str, *words: object) -> list[str]:
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
        return [int(text) for text in self._list_of(key, *words)]

    def _exchange(self, read: Callable[[], Result], *words: object, **settings: object) -> Result:
        """Sends a request, and returns what `read` returns for its reply."""
        line = format_request(words, settings)
        self._check()
        self._check_answered()

        def exchange() -> Result:
            self._write(line)
            return read()

        return self._abort_on_interrupt(exchange)

    def _check_answered(self) -> None:
        if self._unanswered:
            raise ValueError(f"{len(self._unanswered)} requests were sent ahead; receive their replies first")

    def _write(self, line: str) -> None:
        self._unanswered.append(line.split())
        self._write_line(line)


class Commands(Exchange):
    """A method for each command. The commands whose request or reply needs more than its words come first.

    The other methods follow in the order of the document. Each returns what `Exchange.request` returns, unless its
    docstring says otherwise.
    """

    def help(self, *words: str) -> str:
        """Explain.

        Args:
            *words: A command, a setting or a chapter. Default: all commands.

        Returns:
            The text of the reply.
        """
        return self._exchange(lambda: self._read_status(self._read_line())[1], "help", *words)

    def game(self, name: str) -> Values:
        """Describe one game.

        Args:
            name: Name of the game.

        Returns:
            A dictionary with what `games NAME` replies, such as its modes and the MD5 of its image.
        """
        return self._first("games", name)

    def load(self, game: str, image: bytes | None = None, **settings: object) -> Values:
        """Power on and begin an episode.

        Args:
            game: Name of the game, MD5 of its image, or "inline".
            image: The bytes of a cartridge, if `game` is "inline".
            **settings: Settings of the protocol. `as_` is its setting `as`, the game whose rules apply.

        Returns:
            A dictionary with what `load` replies, such as the MD5 of the image and the size of the screen.
        """
        rules = settings.pop("as_", None)
        data = None if image is None else base64.b64encode(image).decode()
        return self._first("load", game, *key_values(image=data, **{"as": rules}, **settings))

    def two_player_modes(self) -> list[int]:
        """List the modes of the game for two players.

        Returns:
            The numbers of the modes.
        """
        return self._ints_of("two_player_modes", "modes")

    def actions(self) -> dict[int, str]:
        """List the actions that act accepts.

        Returns:
            The names of the actions by their numbers.
        """
        pairs = (pair.split(":") for pair in self._list_of("actions", "actions"))
        return {int(action): name for action, name in pairs}

    def names(self) -> tuple[dict[int, str], list[str]]:
        """List the names of bytes of the fields ram and tia.

        Returns:
            The names of bytes of `ram` by their indices, and the names of the bytes of `tia` in order.
        """
        found = self.ask("names")[0]
        pairs = (pair.split(":") for pair in found["ram_names"].split(",") if pair)
        return {int(index): name for index, name in pairs}, found["tia_names"].split(",")

    def palette(self) -> list[tuple[int, int, int]]:
        """List the colours of the field screen.

        Returns:
            Red, green and blue, 0 to 255, of each value of a pixel.
        """
        data = bytes.fromhex(self.ask("look", "palette:hex")[0]["palette"])
        return [(data[at], data[at + 1], data[at + 2]) for at in range(0, len(data), 3)]

    def peek(self, index: int, count: int = 1) -> bytes:
        """Read bytes of RAM.

        Args:
            index: Index of the first byte, 0 to 127.
            count: Number of bytes.

        Returns:
            The bytes.
        """
        return bytes.fromhex(self.ask("peek", index, count)[0]["bytes"])

    def poke(self, index: int, data: bytes | Iterable[int]) -> None:
        """Write bytes of RAM.

        Args:
            index: Index of the first byte, 0 to 127.
            data: The bytes, or numbers from 0 to 255.

        Raises:
            TypeError: If `data` is something else.
        """
        try:
            written = bytes(list(data))
        except (TypeError, ValueError):
            raise TypeError(f"data is {data!r}; it takes bytes, or numbers from 0 to 255") from None
        self.ask("poke", index, written.hex().upper())

    def export_state(self, name: str, episode: bool | int = False, whole: bool | int = False) -> bytes:
        """Return a state, for later or for another process.

        Args:
            name: Name of the state.
            episode: Whether the score, the progress of the episode and the stack of screens are included.
            whole: Old name of `episode`.

        Returns:
            The state as bytes, which `import_state` takes.
        """
        return base64.b64decode(self.ask("export", name, *key_values(episode=episode or whole or None))[0]["data"])

    def import_state(self, name: str, data: bytes) -> None:
        """Save an exported state.

        Args:
            name: Name of the state.
            data: What `export_state` returned.
        """
        self.ask("import", name, base64.b64encode(data).decode())

    def branch(self, name: str, *sequences: Iterable[object], keep: str | None = None) -> list[Values]:
        """Play lists of actions from a state; the session itself does not change.

        Args:
            name: Name of the state.
            *sequences: Lists of actions.
            keep: Prefix of the names under which the last states are saved: PREFIX0, PREFIX1 and so on.

        Returns:
            The values of each list. `rewards`, and `rewards_b` with two players, are lists of a reward for each act.
        """
        words = [*key_values(keep=keep), *(",".join(map(format_word, actions)) for actions in sequences)]
        return [
            {
                key: decode_rewards(text) if key.startswith("rewards") else parse_number(text)
                for key, text in texts.items()
            }
            for texts in self.ask("branch", name, *words)[1:]
        ]

    def close(self) -> None:
        """Close the machines, as `close_machines` does. The session continues."""
        self.close_machines()

    def save_png(self, path: str | os.PathLike[str], machine: int | None = None) -> None:
        """Save a picture of the screen as a PNG file.

        Args:
            path: Path of the file, on this computer.
            machine: The index of a machine of open, from 0. Default: the machine of load.
        """
        data = base64.b64decode(self.ask("shot", *key_values(machine=machine))[0]["data"])
        with open(path, "wb") as file:
            file.write(data)

    def stop_recording(self) -> Values:
        """End the recording.

        Returns:
            A dictionary with what `record stop` replies: the files, and the frames that they have.
        """
        return self._first("record", "stop")

    # generated: commands, from protocol/protocol.toml

    def hello(self, token: str | None = None) -> Values:
        """Greet the server; the reply has its name, version and limits.

        Args:
            token: A token that the server accepts.

        Returns:
            A dictionary with `server`, `protocol`, `max_line`, `max_machines`, `max_states`, `max_request_frames`,
            `max_reply`, `max_idle`, `threads`, `recording`, `admitted`, `encodings` and `presets`.
        """
        return self._first("hello", *key_values(token=token))

    def games(self, which: str | None = None) -> list[str]:
        """List the games whose image is here, or all known games; or describe one.

        Args:
            which: All for all known games, or the name of a game to describe.

        Returns:
            The list `games` of the reply, as texts.
        """
        return self._list_of("games", "games", *optional_words(which))

    def settings(self) -> Values:
        """Show the settings in effect.

        Returns:
            A dictionary with `game`, `md5`, `rule`, `width`, `height` and `format`, and `image` where it applies, and
            each setting.
        """
        return self._first("settings")

    def set(self, mode: int | None = None, difficulty: int | None = None) -> Values:
        """Change the mode, from the next reset on, or the difficulty, at once.

        Args:
            mode: A number that modes lists.
            difficulty: A number that difficulties lists.

        Returns:
            A dictionary with `mode` and `difficulty`.
        """
        return self._first("set", *key_values(mode=mode, difficulty=difficulty))

    def modes(self) -> list[int]:
        """List the game's modes.

        Returns:
            The list `modes` of the reply, as numbers.
        """
        return self._ints_of("modes", "modes")

    def difficulties(self) -> list[int]:
        """List the game's difficulties.

        Returns:
            The list `difficulties` of the reply, as numbers.
        """
        return self._ints_of("difficulties", "difficulties")

    def observe(self, *fields: str) -> list[str]:
        """Select the fields of replies.

        Args:
            *fields: The fields, such as lives or screen:rle, or none; without them, the selection does not change.

        Returns:
            The list `fields` of the reply, as texts.
        """
        return self._list_of("fields", "observe", *fields)

    def look(self, *fields: str) -> Values:
        """Show these fields once; without fields, the selected ones.

        Args:
            *fields: The fields, such as lives or screen:rle.

        Returns:
            A dictionary with these fields, and `over` where it applies.
        """
        return self._first("look", *fields)

    def act(self, *actions: object) -> Values:
        """Play actions until the episode ends.

        Args:
            *actions: Names or numbers of actions, also with marks, such as RIGHT*10.

        Returns:
            A dictionary with the selected fields, and `recording_ended`, `log_ended` and `over` where they apply.
        """
        return self._first("act", *actions)

    def reset(self, seed: int | str | None = None) -> Values:
        """Begin an episode; with a seed, power on anew with it.

        Args:
            seed: The seed with which the console is powered on anew, or random.

        Returns:
            A dictionary with the selected fields.
        """
        return self._first("reset", *key_values(seed=seed))

    def save(
        self,
        name: str,
        generator: bool | int | None = None,
        machine: int | None = None,
        random: bool | int | None = None,
    ) -> None:
        """Save the state; generator=1: with the random generator.

        Args:
            name: A name for the state.
            generator: 1: the state includes the random generator.
            machine: The index of a machine of open, from 0.
            random: Old name of `generator`.
        """
        self.ask("save", name, *key_values(generator=generator, machine=machine, random=random))

    def restore(self, name: str, machine: int | None = None) -> Values:
        """Restore a saved state.

        Args:
            name: The name of the state.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with the selected fields, and `over` where it applies.
        """
        return self._first("restore", name, *key_values(machine=machine))

    def drop(self, *names: str) -> None:
        """Delete states.

        Args:
            *names: The names of the states, or all.
        """
        self.ask("drop", *names)

    def states(self) -> list[str]:
        """List the names of the states.

        Returns:
            The list `states` of the reply, as texts.
        """
        return self._list_of("states", "states")

    def open(
        self,
        count: int,
        autoreset: str | None = None,
        steps: str | None = None,
        start: str | None = None,
        life_loss: str | None = None,
        stack: str | None = None,
        pool: bool | int | None = None,
        lives: str | None = None,
    ) -> list[Values]:
        """Create N machines with the loaded game and settings; their seeds count up.

        Args:
            count: The number of machines.
            autoreset: What happens at the end of an episode.
            steps: What a step is.
            start: How an episode begins; requires steps=frames.
            life_loss: What a lost life does.
            stack: What a stack of screens begins with; requires steps=frames.
            pool: Which frames a stack shows; requires steps=frames.
            lives: Old name of `life_loss`.

        Returns:
            A dictionary for each machine, with the selected fields.
        """
        return self._rest(
            "open",
            count,
            *key_values(
                autoreset=autoreset, steps=steps, start=start, life_loss=life_loss, stack=stack, pool=pool, lives=lives
            ),
        )

    def step(self, *actions: object) -> list[Values]:
        """Play one act on each machine: an action each, or one for all.

        Args:
            *actions: An action for each machine, or one for all.

        Returns:
            A dictionary for each machine, with the selected fields, and `over` where it applies.
        """
        return self._rest("step", *actions)

    def restart(self, mask: str | None = None, seed: int | str | None = None) -> list[Values]:
        """Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.

        Args:
            mask: A 0 or a 1 for each machine, such as 0110.
            seed: The seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on.

        Returns:
            A dictionary for each machine, with the selected fields, and `over` where it applies.
        """
        return self._rest("restart", *optional_words(mask), *key_values(seed=seed))

    def close_machines(self) -> None:
        """Close the machines."""
        self.ask("close")

    def record(self, kinds: str, name: str, machine: int | None = None) -> Values:
        """Record frames, sound or both into the server's folder.

        Args:
            kinds: The kinds of files, separated by commas, such as gif,wav.
            name: A name for the files, without an extension.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `recording`, `recorded`, `frames`, `bytes`, `complete` and `recording_ended` where they
            apply.
        """
        return self._first("record", kinds, name, *key_values(machine=machine))

    def log(
        self,
        name: str,
        agent: str | None = None,
        version: str | None = None,
        agent_seed: int | None = None,
        trial: int | None = None,
        training_frames: int | None = None,
        phrase: str | None = None,
        role: str | None = None,
        link: str | None = None,
        machine: int | None = None,
    ) -> Values:
        """Log the episodes from the next reset on, so that anybody can verify them.

        Args:
            name: A name for the submission, or inline; last answers with the last log, and stop ends logging.
            agent: The agent's name (default: agent).
            version: The agent's version (default: 1).
            agent_seed: The agent's seed (default: 0).
            trial: The number of the trial (default: 1).
            training_frames: Frames that the agent was trained on (default: 0).
            phrase: The phrase that the episodes' seeds follow from, with _ for a blank.
            role: What the agent is.
            link: A page about the agent.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `log`, `unit`, `logged`, `unlogged`, `complete`, `log_ended`, `episode`, `row`, `bytes`
            and `data` where they apply.
        """
        return self._first(
            "log",
            name,
            *key_values(
                agent=agent,
                version=version,
                agent_seed=agent_seed,
                trial=trial,
                training_frames=training_frames,
                phrase=phrase,
                role=role,
                link=link,
                machine=machine,
            ),
        )

    def shot(self, name: str | None = None, machine: int | None = None) -> Values:
        """Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.

        Args:
            name: A name for the file, without .png.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `width`, `height` and `bytes`, and `picture` and `data` where they apply.
        """
        return self._first("shot", *optional_words(name), *key_values(machine=machine))

    def share(self, name: str, watchers: int | None = None) -> Values:
        """Let other sessions watch the game under this name.

        Args:
            name: A name for the shared session.
            watchers: The most sessions that may watch at the same time.

        Returns:
            A dictionary with `share` and `watchers`.
        """
        return self._first("share", name, *key_values(watchers=watchers))

    def unshare(self) -> None:
        """Stop sharing the game."""
        self.ask("unshare")

    def shared(self) -> list[Values]:
        """List the shared sessions.

        Returns:
            A dictionary for each session, with `name`, `game`, `frame`, `score`, `episode` and `fps`.
        """
        return self._rest("shared")

    def watch(self, name: str, *fields: str, since: int | None = None) -> Values:
        """Show the latest copy of a shared session.

        Args:
            name: The name of the shared session.
            *fields: Fields among screen, ram and palette, such as screen:delta.
            since: The frame of the last reply; the fields come only if there is a newer one.

        Returns:
            A dictionary with these fields, and `game`, `frame`, `score`, `episode`, `over`, `lives`, `reward`, `action`
            and `height`.
        """
        return self._first("watch", name, *key_values(since=since), *fields)

    def stats(self) -> Values:
        """Show counters of this session.

        Returns:
            A dictionary with `requests`, `errors`, `acts`, `frames`, `episodes`, `bytes_in`, `bytes_out`, `states` and
            `machines`.
        """
        return self._first("stats")

    def quit(self) -> None:
        """End the session."""
        self.ask("quit")

    # end of commands


class Session(Commands):
    """A session with a server, with a method for each command of the protocol.

    `connect` and `launch` open sessions. A session ends with its block, or with the last reference to it. Several
    threads must not use a session at the same time; only `close_connection` interrupts the call of another thread.

    Every method that sends a request raises one of three errors. Refused: the server refuses the request, and the
    session continues. ConnectionError: the server is gone. TimeoutError: the server does not answer in time. The last
    two end the session.

    Args:
        reader: Stream of replies.
        writer: Stream of requests.
        close: Closes the streams.
        arrays: Whether bytes are returned as arrays of NumPy.

    Attributes:
        again: Opens a new session with the same server, or None.

    Examples:
        >>> import racebeam
        >>> with racebeam.launch() as session:
        ...     game = session.load("beamfall", seed=7, frame_skip=4)
        ...     fields = session.observe("reward", "lives", "ram")
        ...     reply = session.act("FIRE*10")
        ...     reply["lives"], len(reply["ram"])
        (4, 128)
    """

    def __init__(
        self,
        reader: IO[bytes] | SocketStream,
        writer: IO[bytes] | SocketStream,
        close: Callable[[], object],
        arrays: bool = False,
    ) -> None:
        super().__init__(reader, writer, close, arrays)
        self.again: Callable[[], Session] | None = None

    @classmethod
    def start(cls, racebeam: str = "racebeam", *options: str, arrays: bool = False) -> Session:
        """Starts a private server over standard streams, without a greeting.

        Args:
            racebeam: Path of the program.
            *options: Options of `racebeam serve`.
            arrays: Whether bytes are returned as arrays of NumPy.

        Returns:
            The session. The server stops when the session ends.

        Raises:
            FileNotFoundError: If the program is not found.
        """
        command = [racebeam, "serve", "--stdio", *options]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        writer, reader = process.stdin, process.stdout
        assert writer is not None and reader is not None

        def close() -> None:
            close_pipes(writer, reader)
            if outlives_streams(options):
                process.terminate()
            process.wait()

        return cls(reader, writer, close, arrays)

    @classmethod
    def tcp(cls, host: str, port: int, tls: ssl.SSLContext | None = None) -> Session:
        """Connects to a server over TCP, without a greeting.

        Args:
            host: Name or address of the host.
            port: Port of the server.
            tls: Context that verifies the server's certificate, or None for a connection without TLS.

        Raises:
            OSError: If no server answers.
        """
        return cls.on_socket(open_secure_socket(f"{'tls' if tls else 'tcp'}://{host}:{port}", tls, None))

    @classmethod
    def unix(cls, path: str) -> Session:
        """Connects to a server over a Unix socket, without a greeting.

        Args:
            path: Path of the socket.

        Raises:
            OSError: If no server answers.
        """
        return cls.on_socket(open_secure_socket(f"unix:{path}", None, None))

    @classmethod
    def on_socket(cls, connection: socket.socket, arrays: bool = False) -> Session:
        """Makes a session on a socket, without a greeting.

        Args:
            connection: The socket. The session closes it.
            arrays: Whether bytes are returned as arrays of NumPy.
        """
        stream = SocketStream(connection)
        return cls(stream, stream, stream.close, arrays)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close_connection()

    def __reduce__(self) -> str:
        raise TypeError("a session cannot be pickled or copied; connect() opens another one")

    def __del__(self) -> None:
        with contextlib.suppress(Exception):  # the constructor failed, or Python itself is ending
            self.close_connection()

    def reconnect(self) -> Session:
        """Opens a new session with the same server, without a game, and closes this one.

        Returns:
            The new session.

        Raises:
            ValueError: If `connect` did not open this session.
            OSError: If no server answers.
        """
        if self.again is None:
            raise ValueError("reconnect() is not possible, because connect() did not open this session")
        self.close_connection()
        return self.again()


class Stack:
    r"""A stack of the last screens, as the server makes it for the field grey84x84xN.

    With `observe("grey84x84x1:delta")`, a reply has fewer bytes than with a stack of the server.

    Args:
        depth: Number of screens in the stack.

    Examples:
        >>> from racebeam.wire.client import Stack
        >>> stack = Stack(3)
        >>> stack.push(b"ab")
        b'\x00\x00\x00\x00ab'
        >>> stack.push(b"cd")
        b'\x00\x00abcd'
    """

    def __init__(self, depth: int) -> None:
        self._screens: collections.deque[bytes] = collections.deque(maxlen=depth)

    def clear(self) -> None:
        """Removes all screens, as a reset does."""
        self._screens.clear()

    def push(self, screen: bytes) -> bytes:
        """Adds a screen.

        Args:
            screen: Bytes of the screen.

        Returns:
            The stack, oldest screen first. Missing screens are zeros.
        """
        self._screens.append(screen)
        return bytes(len(screen)) * ((self._screens.maxlen or 0) - len(self._screens)) + b"".join(self._screens)


def launch(*options: str, program: str | None = None, arrays: bool = False) -> Session:
    """Starts a private server over standard streams. It stops when the session is closed or garbage-collected.

    Args:
        *options: Options of `racebeam serve`, such as "--roms", DIR.
        program: Path of the program racebeam. Default: the one of this package, or else the one on the PATH.
        arrays: Whether bytes are returned as arrays of NumPy.

    Returns:
        The session.

    Raises:
        FileNotFoundError: If the program is not found.
        ConnectionError: If the program ends instead of serving.
    """
    command = server_command(program, options)
    racebeam, _, _, *rest = command
    session = Session.start(racebeam, *rest, arrays=arrays)
    try:
        session._check_greeting(session.hello())
        return session
    except ConnectionError as error:
        raise not_serving(command, error) from error
    except BaseException:
        session.close_connection()
        raise


def connect(
    address: str | None = None,
    *,
    token: str | None = None,
    tls: ssl.SSLContext | None = None,
    timeout: float | None = None,
    longest_reply: int = LONGEST_REPLY,
    arrays: bool = False,
) -> Session:
    """Opens a session with a server.

    Args:
        address: Address of the server: tcp://HOST:PORT, tls://HOST:PORT or unix:PATH; pipes:PREFIX for the named pipes
            PREFIX_out and PREFIX_in; stdio for the standard streams of this process; file:PATH for the first usable
            address of a --ready-file or --announce file; or file:PATH?wait=SECONDS, which waits for the file and its
            server. Default: the value of RACEBEAM_ADDRESS.
        token: Token that the server requires. Default: that of the announce file, if there is one.
        tls: Context that verifies the server's certificate. Default: the authorities of the system.
        timeout: Seconds to wait for the connection and for each reply on a socket. Default: no limit.
        longest_reply: Bytes of the longest reply that is accepted.
        arrays: Whether bytes are returned as arrays of NumPy.

    Returns:
        The session.

    Raises:
        ValueError: If the address is invalid, or its file has no usable address.
        OSError: If no server answers.
        TimeoutError: If no server answers in time.
        Refused: If the token is wrong.
    """
    session, address, announcement = reach(address, lambda found: _open(found, tls, timeout, arrays))
    token = token or announcement
    try:
        session.address, session.longest_reply = address, longest_reply
        session.again = lambda: connect(
            address, token=token, tls=tls, timeout=timeout, longest_reply=longest_reply, arrays=arrays
        )
        session._check_greeting(session.hello(token))
        return session
    except BaseException:
        session.close_connection()
        raise


def server_command(program: str | None, options: Iterable[str]) -> list[str]:
    """Returns the command that starts a server on standard streams.

    Args:
        program: Path of the program racebeam, or None for the installed one.
        options: Options of `racebeam serve`.

    Raises:
        FileNotFoundError: If the program is not found.
    """
    quiet = () if "--log-level" in options else ("--log-level", "warning")
    return [program or _find_program(), "serve", "--stdio", *quiet, *options]


def not_serving(command: Iterable[str], error: ConnectionError) -> ConnectionError:
    """Returns the error of a program that does not greet. The program has written the reason to standard error.

    Args:
        command: Command that started the program.
        error: Error of the session.
    """
    return ConnectionError(
        f"the program did not start to serve: {shlex.join(command)}; see its standard error; {error}"
    )


def _find_program() -> str:
    try:
        from .. import program
    except ImportError:  # the single file, without the package
        found = shutil.which("racebeam")
        if found is None:
            raise FileNotFoundError("the program racebeam is not on the PATH; give program=") from None
        return found
    return program.path()


def _open(address: str, tls: ssl.SSLContext | None, timeout: float | None, arrays: bool) -> Session:
    """Opens a session without a greeting."""
    if address == "stdio":
        return Session(sys.stdin.buffer, sys.stdout.buffer, lambda: None, arrays)
    kind, _, rest = address.partition(":")
    if kind == "pipes" and rest:
        reader = open(f"{rest}_out", "rb")  # noqa: SIM115  (in this order, as the server opens them)
        writer = open(f"{rest}_in", "wb")  # noqa: SIM115
        return Session(reader, writer, lambda: close_pipes(writer, reader), arrays)
    return Session.on_socket(open_secure_socket(address, tls, timeout), arrays)


__all__ = [
    "ANNOUNCEMENT",
    "DECODERS",
    "LONGEST_REPLY",
    "PROTOCOL",
    "SHAPES",
    "USUAL_ENCODING",
    "Refused",
    "Reply",
    "Session",
    "Stack",
    "Texts",
    "Values",
    "apply_delta",
    "connect",
    "decode_rewards",
    "decode_runs",
    "launch",
]
