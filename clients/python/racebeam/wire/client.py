"""A client of the racebeam line protocol (protocol/PROTOCOL.md). This file needs the standard library only, and can be
copied alone.

    with launch() as game:                                       # or connect("tcp://HOST:PORT"), or another address
        game.load("beamfall", seed=7, frame_skip=4)
        game.observe("reward", "ends", "ram", "screen:delta")
        while True:
            shown = game.act("FIRE")                             # {"reward": 0, "terminated": 0, ..., "screen": bytes}
            if shown["terminated"] or shown["truncated"]:
                break

A method for each command, in the order of the document. Numbers come as int or float, and bytes as bytes, or as arrays of
NumPy when the session was made with arrays=True. What the server refuses is raised as Refused, and the session goes on. A
server that has gone is a ConnectionError, and one that does not answer in time a TimeoutError; both end the session.
"""

from __future__ import annotations

import base64
import binascii
import collections
import contextlib
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
ANNOUNCEMENT = 1  # the version of announce files that this client reads
LONGEST_REPLY = 1 << 28  # bytes; a server that sends a longer line is taken for broken
MOST_UNSENT = 1 << 13  # bytes of requests that are gathered

# generated: fields, from protocol/protocol.toml
# What bytes are written in when `observe` does not say.
USUAL_ENCODING = {
    "ram": "hex",
    "tia": "hex",
    "screen": "rle",
    "rgb": "zlib",
    "grey": "zlib",
    "palette": "hex",
    "audio": "hex",
}
SHAPES: dict[str, tuple[int | str, ...]] = {
    "ram": (128,),
    "tia": (53,),
    "screen": ("height", 160),
    "rgb": ("height", 160, 3),
    "grey": ("height", 160),
    "palette": (256, 3),
    "audio": (512,),
}
# end of fields

WAIT = re.compile(r"(file:.+)\?wait=(.*)", re.DOTALL)
SECONDS = re.compile(r"[0-9]{1,9}(\.[0-9]+)?")
ADDRESSES = "it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, also in RACEBEAM_ADDRESS"
FILES = "file:PATH takes the --ready-file or --announce file of a server"
BETWEEN_TRIES = 0.05  # seconds

STACK = re.compile(r"(?:grey|rgb)(\d+)x(\d+)x(\d+)")  # fields such as grey100x50x4
NUMBER = re.compile(r"-?(0|[1-9]\d{0,14})(\.\d+)?")

RAW = re.compile(r" raw=(\S+)$")
Texts = dict[str, Any]  # texts by key, and bytes where the encoding is raw
Values = dict[str, Any]
Arrays = dict[str, bytearray]  # what deltas have made so far, by field
Opened = TypeVar("Opened")
Got = TypeVar("Got")


class Refused(Exception):
    """`error CODE sentence`."""

    def __init__(self, code: str, sentence: str) -> None:
        super().__init__(code, sentence)
        self.code, self.sentence = code, sentence

    def __str__(self) -> str:
        return f"{self.code}: {self.sentence}"


class Watched(NamedTuple):
    """What the deltas of a watched session belong to. With other fields or another height they begin anew."""

    fields: list[str]
    height: int
    arrays: Arrays


class Reply(NamedTuple):
    """A reply as it came."""

    words: list[str]  # of the request
    text: str  # after `ok `
    data: bytes | bytearray  # that followed the line


def decode_runs(data: bytes) -> bytes:
    """The bytes of runs: value and length."""
    return b"".join(data[at:at + 1] * data[at + 1] for at in range(0, len(data), 2))


def apply_delta(array: bytearray, text: str) -> None:
    """Changes `array` by the text of a delta. Raises ValueError, and may have changed the array, if it does not fit."""
    data, at, place = bytes.fromhex(text), 0, 0
    while at < len(data):
        place += data[at] << 8 | data[at + 1]
        runs, at = data[at + 2], at + 3
        for _ in range(runs):
            value, length, at = data[at], data[at + 1], at + 2
            if place + length > len(array):
                raise ValueError(f"a delta reaches byte {place + length} of {len(array)}")
            array[place:place + length] = bytes([value]) * length
            place += length


def decode_rewards(text: str) -> list[int]:
    """A list from R,R*TIMES,..."""
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


def number(text: str) -> int | float | str:
    """The number that a text is, or the text. An MD5 is none, nor are bytes such as 0046."""
    if not NUMBER.fullmatch(text):
        return text
    return float(text) if "." in text else int(text)


def _groups(text: str) -> list[Texts]:
    """Those of a reply's text after `ok`."""
    return [dict(word.split("=", 1) for word in group.split(" ") if "=" in word) for group in f" {text}".split(" |")]


def _watched_fields(words: list[str]) -> list[str]:
    """Of a request `watch NAME [since=FRAME] FIELD...`."""
    return [word for word in words[2:] if "=" not in word]


def _shape(field: str, height: int) -> tuple[int, ...]:
    """Of a field of bytes, of a machine whose screen has `height` rows."""
    if field.startswith("grey84") and field.count("x") < 2:
        screens = field.partition("x")[2]
        return (int(screens), 84, 84) if screens else (84, 84)
    if stack := STACK.fullmatch(field):
        width, rows, depth = map(int, stack.groups())
        return (depth, rows, width, 3) if field.startswith("rgb") else (depth, rows, width)
    return tuple(height if length == "height" else int(length) for length in SHAPES[field])


def _word(value: object) -> str:
    return str(int(value) if isinstance(value, bool) else value)


def _words(value: object) -> list[object]:
    """A word that may be left out."""
    return [] if value is None else [value]


def _pairs(**settings: object) -> list[str]:
    """KEY=VALUE of those that are not None."""
    return [f"{key}={_word(value)}" for key, value in settings.items() if value is not None]


def _line_of(words: Iterable[object], settings: Mapping[str, object]) -> str:
    """A request without its end."""
    line = " ".join([*map(_word, words), *_pairs(**settings)])
    if "\n" in line or line.lstrip(" ").startswith("#"):
        raise ValueError(f"a request is one line, and no comment: {line!r}")
    return line


def launch(*options: str, program: str | None = None, arrays: bool = False) -> Session:
    """A server of one's own, on standard streams, that ends with the session, or with the last reference to it.

    options: those of `racebeam serve`, such as "--roms", DIR. program: the program racebeam; None: the one that was installed
    with this package, or the one on the PATH. Raises FileNotFoundError where there is none, and ConnectionError when it ends
    instead of serving.
    """
    command = command_of(program, options)
    racebeam, _, _, *rest = command
    session = Session.start(racebeam, *rest, arrays=arrays)
    try:
        session.check_greeting(session.hello())
        return session
    except ConnectionError as error:
        raise not_serving(command, error) from error
    except BaseException:
        session.close_connection()
        raise


def not_serving(command: Iterable[str], error: ConnectionError) -> ConnectionError:
    """What launch() raises where the program does not greet. A program that refuses its arguments has written why."""
    return ConnectionError(f"this program does not serve: {shlex.join(command)}; standard error may say why; {error}")


def command_of(program: str | None, options: Iterable[str]) -> list[str]:
    """Starts a server on standard streams."""
    quiet = () if "--log-level" in options else ("--log-level", "warning")
    return [program or _program(), "serve", "--stdio", *quiet, *options]


def connect(address: str | None = None, *, token: str | None = None, tls: ssl.SSLContext | None = None,
            timeout: float | None = None, longest_reply: int = LONGEST_REPLY, arrays: bool = False) -> Session:
    """A session of the server at `address`; None: at that of the variable RACEBEAM_ADDRESS.

    address: one of
      tcp://HOST:PORT, tls://HOST:PORT, unix:PATH
      pipes:PREFIX   the named pipes PREFIX_out and PREFIX_in
      stdio          standard input and output of this process
      file:PATH      the first address in the server's --ready-file or --announce file that is one of these
      file:PATH?wait=SECONDS   the same; waits for the file, and for the server in it
    token: for servers that ask for one; None: that of the announce file, if there is one. tls: trusts the server's certificate;
    None: the system's authorities do. timeout: seconds to wait for a connection, and for each reply, on sockets; None: for ever.
    longest_reply: bytes.

    Raises ValueError for another address, and for a file that names none; OSError when nothing answers there; and Refused for
    a wrong token.
    """
    session, address, announced = reached(address, lambda found: _open(found, tls, timeout, arrays))
    token = token or announced
    try:
        session.address, session.longest_reply = address, longest_reply
        session._again = lambda: connect(address, token=token, tls=tls, timeout=timeout, longest_reply=longest_reply,
                                         arrays=arrays)
        session.check_greeting(session.hello(token))
        return session
    except BaseException:
        session.close_connection()
        raise


def _program() -> str:
    try:
        from .. import program
    except ImportError:  # this file was copied alone
        found = shutil.which("racebeam")
        if found is None:
            raise FileNotFoundError("the program racebeam is not on the PATH; give program=") from None
        return found
    return program.path()


def reached(address: str | None, opened: Callable[[str], Opened]) -> tuple[Opened, str, str | None]:
    """What `opened` returns for `address`, and for RACEBEAM_ADDRESS without one; the address itself, or the one in the file that it
    names; and the token of an announce file. Tries again as long as the address says."""
    address = address or os.environ.get("RACEBEAM_ADDRESS", "")
    if not address:
        raise ValueError(f"there is no address, and the variable RACEBEAM_ADDRESS is not set; {ADDRESSES}")
    waits = WAIT.fullmatch(address)
    if waits and not SECONDS.fullmatch(waits[2]):
        raise ValueError(f"the address is {address!r}; ?wait= takes seconds, from 0 to 999999999")
    file = waits[1] if waits else address
    until = time.monotonic() + (float(waits[2]) if waits else 0)
    while True:
        found = file
        try:
            found, token = _in_file(file)
            return opened(found), found, token
        except OSError as error:
            if time.monotonic() >= until:
                source = "" if found == file else f", which {file.removeprefix('file:')} names"
                sentence = f"no server answers at {found}{source}: {error.strerror or error}"
                if not error.strerror:  # as of a TimeoutError
                    raise type(error)(sentence) from error
                error.strerror = sentence
                raise
            time.sleep(BETWEEN_TRIES)


def _in_file(address: str) -> tuple[str, str | None]:
    """The first address of a ready file or an announce file that this client can use, and the token of the latter. Another
    address as it is."""
    if not address.startswith("file:"):
        return address, None
    path = address.removeprefix("file:")
    if not stat.S_ISREG(os.stat(path).st_mode):  # a pipe might block
        raise ValueError(f"{path} is no regular file; {FILES}")
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        text = file.read()
    addresses, token = _announcement(path, text) if text.startswith("{") else (text.splitlines(), None)
    for line in addresses:
        if line.startswith(("tcp://", "tls://", "unix:", "pipes:")):
            return line, token
    if text.startswith(("{", "#")):
        raise ValueError(f"{path} names no address that this client can use")
    raise ValueError(f"{path} {'has other contents' if text else 'is empty'}; {FILES}")


def _announcement(path: str, text: str) -> tuple[list[str], str | None]:
    """The addresses and the token of an announce file. Raises ValueError for a file of another version, and for a part of one."""
    try:
        announced: dict[str, Any] = json.loads(text)
        version = announced["racebeam_announce"]
        if version == ANNOUNCEMENT:
            return announced["addresses"], announced["token"]
    except (KeyError, TypeError, ValueError, RecursionError):
        raise ValueError(f"{path} is not a whole announce file") from None
    raise ValueError(f"{path} is an announce file of version {version}; this client reads version {ANNOUNCEMENT}")


def _open(address: str, tls: ssl.SSLContext | None, timeout: float | None, arrays: bool) -> Session:
    """A session at `address`, without a greeting."""
    if address == "stdio":
        return Session(sys.stdin.buffer, sys.stdout.buffer, lambda: None, arrays)
    kind, _, rest = address.partition(":")
    if kind == "pipes" and rest:
        reader = open(f"{rest}_out", "rb")  # in this order, as the server opens them
        writer = open(f"{rest}_in", "wb")
        return Session(reader, writer, lambda: _close(writer, reader), arrays)
    return Session.connected(_socket(address, tls, timeout), arrays)


def _socket(address: str, tls: ssl.SSLContext | None, timeout: float | None) -> socket.socket:
    connection, host = connected(address, timeout)
    if not host:
        return connection
    try:
        return (tls or ssl.create_default_context()).wrap_socket(connection, server_hostname=host)
    except BaseException:
        connection.close()
        raise


def connected(address: str, timeout: float | None) -> tuple[socket.socket, str]:
    """A connection without TLS, and the name that the server has to prove by TLS; "" without it."""
    kind, _, rest = address.partition(":")
    host, _, port = rest.removeprefix("//").rpartition(":")
    if kind == "unix" and rest:
        connection = socket.socket(socket.AF_UNIX)
        connection.settimeout(timeout)
        try:
            connection.connect(rest)
        except BaseException:
            connection.close()
            raise
        return connection, ""
    if kind not in ("tcp", "tls") or not rest.startswith("//") or not host or not port.isdecimal():
        raise ValueError(f"the address is {address!r}; {ADDRESSES}")
    host = host.removeprefix("[").removesuffix("]")
    connection = socket.create_connection((host, int(port)), timeout)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection, host if kind == "tls" else ""


def _close(writer: IO[bytes], reader: IO[bytes]) -> None:
    """Closes pipes. A server that does not read gets no more: closing never waits."""
    os.set_blocking(writer.fileno(), False)
    for end in (writer, reader):
        try:
            end.close()
        except OSError:  # what was not sent cannot be
            continue


class _Socket:
    """Reads lines and bytes from a socket, and gathers what is sent. Each takes the time limit of the socket at most."""

    def __init__(self, connection: socket.socket) -> None:
        self.connection, self.limit, self.data = connection, connection.gettimeout(), b""
        self.unsent = bytearray()

    def write(self, data: bytes) -> None:
        self.unsent += data
        if len(self.unsent) > MOST_UNSENT:
            self.flush()

    def flush(self) -> None:
        data, self.unsent = self.unsent, bytearray()
        if data:
            self.connection.sendall(data)

    def readline(self, most: int) -> bytes:
        """As that of a file. Raises TimeoutError if the line takes longer than the limit."""
        until = None if self.limit is None else time.monotonic() + self.limit
        pieces, length = [self.data], len(self.data)
        while (end := pieces[-1].find(b"\n")) < 0 and length < most:
            if until is not None:
                self.connection.settimeout(max(until - time.monotonic(), 1e-6))
            pieces.append(self.connection.recv(1 << 16))
            length += len(pieces[-1])
            if not pieces[-1]:
                break
        if until is not None:
            self.connection.settimeout(self.limit)
        last, self.data = pieces[-1][:end + 1], pieces[-1][end + 1:]
        return b"".join([*pieces[:-1], last])

    def read(self, count: int) -> bytearray:
        """As many bytes, or fewer at the end. Raises TimeoutError as readline() does."""
        until = None if self.limit is None else time.monotonic() + self.limit
        data = bytearray(count)
        have = min(count, len(self.data))
        data[:have], self.data = self.data[:have], self.data[have:]
        with memoryview(data) as room:
            while have < count:
                if until is not None:
                    self.connection.settimeout(max(until - time.monotonic(), 1e-6))
                got = self.connection.recv_into(room[have:])
                if got == 0:
                    break
                have += got
        if until is not None:
            self.connection.settimeout(self.limit)
        del data[have:]
        return data

    def close(self) -> None:
        """Without waiting for a server that does not read. Another thread that reads or writes gets an error."""
        with contextlib.suppress(OSError):  # the server has closed it
            self.connection.shutdown(socket.SHUT_RDWR)
        self.connection.close()


class Stack:
    """A stack of screens that the client makes, as the server does for grey84xN: of the last `depth`, oldest first, zeros
    where there was none. For `observe("grey84:delta")`, of which a reply has fewer bytes than of a stack."""

    def __init__(self, depth: int) -> None:
        self._screens: collections.deque[bytes] = collections.deque(maxlen=depth)

    def clear(self) -> None:
        """Begins anew, as after a reset."""
        self._screens.clear()

    def push(self, screen: bytes) -> bytes:
        """Adds a screen. Returns the stack."""
        self._screens.append(screen)
        return bytes(len(screen)) * ((self._screens.maxlen or 0) - len(self._screens)) + b"".join(self._screens)


class Session:
    """One session. connect() and launch() make them."""

    def __init__(self, reader: IO[bytes] | _Socket, writer: IO[bytes] | _Socket, close: Callable[[], object],
                 arrays: bool = False) -> None:
        self.reader, self.writer, self._close = reader, writer, close
        self.arrays_wanted = arrays
        self.longest_reply = LONGEST_REPLY
        self.unanswered: collections.deque[list[str]] = collections.deque()  # the words of requests
        self.encodings: dict[str, str] = {}  # of the fields that observe chose
        self.offered: list[str] = []  # the server's encodings, after a greeting
        self.height = 0
        self.arrays: dict[int, Arrays] = {}  # of machines; 0 is that of load
        self.watched: dict[str, Watched] = {}  # by name
        self.address = ""
        self._again: Callable[[], Session] | None = None
        self._process = os.getpid()
        self._ended = ""  # why the session has ended

    @classmethod
    def start(cls, racebeam: str = "racebeam", *options: str, arrays: bool = False) -> Session:
        """As launch(), of a program that is named."""
        process = subprocess.Popen([racebeam, "serve", "--stdio", *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        writer, reader = process.stdin, process.stdout
        assert writer is not None and reader is not None

        def close() -> None:
            _close(writer, reader)
            process.wait()
        return cls(reader, writer, close, arrays)

    @classmethod
    def tcp(cls, host: str, port: int, tls: ssl.SSLContext | None = None) -> Session:
        """A TCP connection without a greeting. `tls`: trusts the server's certificate."""
        return cls.connected(_socket(f"{'tls' if tls else 'tcp'}://{host}:{port}", tls, None))

    @classmethod
    def unix(cls, path: str) -> Session:
        """A Unix socket, without a greeting."""
        return cls.connected(_socket(f"unix:{path}", None, None))

    @classmethod
    def connected(cls, connection: socket.socket, arrays: bool = False) -> Session:
        """A session on a socket, which it closes."""
        both = _Socket(connection)
        return cls(both, both, both.close, arrays)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close_connection()

    def __del__(self) -> None:
        """Without the last reference to it, a session ends."""
        with contextlib.suppress(Exception):  # where the constructor failed, or Python itself is ending
            self.close_connection()

    def close_connection(self) -> None:
        """Ends the session. More than once does nothing; in a child process after a fork, the parent's goes on."""
        self._end("the session was closed")

    def cut(self) -> None:
        """Ends the session, where a request may be left without its reply."""
        self._end("the session has ended: it was interrupted between a request and the end of its reply")

    def _end(self, why: str) -> None:
        if not self._ended:
            self._ended = why
            self.unanswered.clear()
            if os.getpid() == self._process:
                self._close()

    def reconnect(self) -> Session:
        """A new session of the same server, after the old one ended. It has no game yet. Only for sessions of connect()."""
        if self._again is None:
            raise ValueError("this session cannot be opened again: connect() did not make it")
        self.close_connection()
        return self._again()

    # Requests and replies

    def check(self) -> None:
        """Raises what stands in the way of a request: ConnectionError after the session's end, or as check_process() does."""
        self.check_process()
        if self._ended:
            raise ConnectionError(self._ended)

    def check_process(self) -> None:
        """Raises RuntimeError in a child process after a fork."""
        if os.getpid() != self._process:
            raise RuntimeError("this session of a server was opened before the process forked; open a new one")

    def send(self, *words: object, **settings: object) -> None:
        """A request without waiting for its reply; receive() gives the replies in their order. A server whose replies are not
        received stops reading: of many requests, send some dozens at a time."""
        line = _line_of(words, settings)
        self.check()
        self._uncut(lambda: self._write(line))

    def begin(self, *words: object, **settings: object) -> None:
        """A request that is sent at once, and alone; receive() gives its reply. Raises ValueError where others were sent ahead."""
        self._check_alone()
        self.send(*words, **settings)
        self.flush()

    def flush(self) -> None:
        """Passes the requests on that send() has buffered, as receive() does first."""
        self.check()
        self._uncut(self._flush)

    def _uncut(self, call: Callable[[], Got]) -> Got:
        """What a part of an exchange returns. Where it is cut off, such as by Ctrl-C, the session ends: a reply that is read later
        would be taken for another's."""
        try:
            return call()
        except Refused:
            raise
        except BaseException:
            self.cut()
            raise

    def _write(self, line: str) -> None:
        self.unanswered.append(line.split())
        try:
            self.writer.write(f"{line}\n".encode())
        except OSError as error:
            raise self.lost(error) from error

    def _flush(self) -> None:
        try:
            self.writer.flush()
        except ConnectionError:
            pass  # the server may have said why it ends, before it did
        except OSError as error:
            raise self.lost(error) from error

    def receive(self) -> list[Texts]:
        """The groups of the next reply, each a dictionary of texts."""
        self.check()
        return self._uncut(self._receive)[1]

    def received(self) -> list[Values]:
        """The groups of the next reply, with numbers and bytes."""
        self.check()
        return self._uncut(self._received)

    def _received(self) -> list[Values]:
        return self.all_decoded(*self._receive())

    def receive_plain(self) -> Reply:
        """The next reply, to a request that changes nothing about later replies, such as `step`."""
        self.check()
        return self._uncut(self._receive_plain)

    def _receive_plain(self) -> Reply:
        words, text = self.read_status(self._line())
        count = RAW.search(text)
        return Reply(words, text, self._bytes(self._count_of(count[1])) if count else b"")

    def decode_plain(self, reply: Reply) -> list[Values]:
        """Its groups, as received() returns them."""
        groups = _groups(reply.text)
        if groups[-1].pop("raw", None):
            self.take_bytes(reply.words, groups, reply.data)
        return self.all_decoded(reply.words, groups)

    def all_decoded(self, words: list[str], groups: list[Texts]) -> list[Values]:
        """The groups of the reply to a request of these words, with numbers and bytes."""
        encodings = self._encodings_of(words)
        if words[:1] == ["watch"]:
            watched = self._watched(words, groups[0])
            return [self.decoded(texts, watched.arrays, encodings, watched.height) for texts in groups]
        return [self.decoded(texts, self.arrays.setdefault(machine, {}), encodings, self.height)
                for machine, texts in enumerate(groups)]

    def _receive(self) -> tuple[list[str], list[Texts]]:
        """The words of the oldest request without a reply, and the groups of its reply."""
        words, groups, count = self.read_line(self._line())
        if count:
            self.take_bytes(words, groups, self._bytes(count))
        return words, groups

    def read_line(self, line: str) -> tuple[list[str], list[Texts], int]:
        """The same, of a reply's line, and how many bytes follow it, which go to take_bytes()."""
        words, text = self.read_status(line)
        groups = _groups(text)
        self._follow(words, groups[0])
        return words, groups, self._count_of(groups[-1].pop("raw", "0"))

    def read_status(self, line: str) -> tuple[list[str], str]:
        """The words of the oldest request without a reply, and the reply's text after `ok`. Raises Refused."""
        words = self.unanswered.popleft() if self.unanswered else [""]  # without one, the server says why it ends
        status, _, rest = line.partition(" ")
        if status == "error" and rest:
            code, _, sentence = rest.partition(" ")
            raise Refused(code, sentence)
        if status != "ok":
            raise self.lost(ConnectionError(f"it sent {line[:60]!r}, which is no reply"))
        return words, rest

    def _count_of(self, text: str) -> int:
        count = int(text) if text.isdecimal() else -1
        if not 0 <= count <= self.longest_reply:
            raise self.lost(ConnectionError(f"{text!r} bytes follow its reply; it may have {self.longest_reply}"))
        return count

    def take_bytes(self, words: list[str], groups: list[Texts], data: bytes | bytearray) -> None:
        """Gives each value that is encoded as raw its part of the bytes that followed the line."""
        encodings, all_bytes, end = self._encodings_of(words), memoryview(data), 0
        for texts in groups:
            for key, text in texts.items():
                if encodings.get(key.removeprefix("final_")) == "raw":
                    begin, end = end, end + self._count_of(text)
                    texts[key] = all_bytes[begin:end]
        if end != len(data):
            raise self.lost(ConnectionError(f"its fields have {end} bytes, but {len(data)} followed its reply"))

    def _follow(self, words: list[str], told: Texts) -> None:
        """Remembers what a request that was granted changes about later replies."""
        command, *fields = words or [""]
        if command == "observe" and fields:
            self.encodings = self._encodings(fields)
            self.arrays.clear()
        elif command == "load":
            self.height = int(told["height"])
            self.arrays.clear()
        elif command == "open":
            self.arrays = {0: self.arrays.get(0, {})}

    def _bytes(self, count: int) -> bytes | bytearray:
        """Those that follow a line."""
        try:
            data = self.reader.read(count)
        except OSError as error:
            raise self.lost(error) from error
        if len(data) < count:
            raise self.lost(None)
        return data

    def _line(self) -> str:
        self._flush()
        try:
            line = self.reader.readline(self.longest_reply)
        except OSError as error:  # a TimeoutError is one, too: half a reply may have been read
            raise self.lost(error) from error
        if not line.endswith(b"\n"):
            long = ConnectionError(f"its reply is longer than {self.longest_reply} bytes")
            raise self.lost(long if len(line) >= self.longest_reply else None)
        return line.decode("latin-1").rstrip("\n")

    def lost(self, error: Exception | None) -> OSError:
        """Ends the session. Returns what says so."""
        at = f" at {self.address}" if self.address else ""
        is_late = isinstance(error, TimeoutError)
        ended = f"the session of the server{at} has ended" + (f": {error}" if error else "")
        self._end(f"the server{at} did not answer in time; the session has ended" if is_late else ended)
        return TimeoutError(self._ended) if is_late else ConnectionError(ended)

    def ask(self, *words: object, **settings: object) -> list[Texts]:
        """A request and its reply."""
        return self._exchange(lambda: self._receive()[1], *words, **settings)

    def request(self, *words: object, **settings: object) -> list[Values]:
        """A request and its reply, with numbers and bytes: what the methods below do, for any request."""
        return self._exchange(self._received, *words, **settings)

    def _exchange(self, read: Callable[[], Got], *words: object, **settings: object) -> Got:
        """What `read` makes of the reply to a request."""
        line = _line_of(words, settings)
        self.check()
        self._check_alone()

        def both() -> Got:
            self._write(line)
            return read()
        return self._uncut(both)

    def _check_alone(self) -> None:
        if self.unanswered:
            raise ValueError(f"{len(self.unanswered)} requests were sent ahead; receive their replies first")

    def values(self, *words: object, **settings: object) -> Values:
        """The first group of a reply, with numbers."""
        return {key: number(text) for key, text in self.ask(*words, **settings)[0].items()}

    def list_of(self, key: str, *words: object) -> list[str]:
        """A list in the first group of a reply."""
        text = self.ask(*words)[0][key]
        return text.split(",") if text else []

    def check_greeting(self, said: Values) -> None:
        """Of the reply to hello. Raises ConnectionError for another version of the protocol."""
        if said.get("protocol") != PROTOCOL:
            raise self.lost(ConnectionError(f"it speaks version {said.get('protocol')} of the protocol; "
                                             f"this client speaks {PROTOCOL}"))
        self.offered = str(said.get("encodings", "")).split(",")

    # Observations

    def decoded(self, texts: Texts, arrays: Arrays, encodings: dict[str, str], height: int) -> Values:
        """The fields of one group, as numbers and bytes. Screens have `height` rows."""
        try:
            return {key: self._value(key.removeprefix("final_"), text, arrays, encodings, height) for key, text in texts.items()}
        except (ValueError, IndexError, zlib.error, binascii.Error) as error:
            raise self.lost(ConnectionError(f"a field of its reply is damaged: {error}")) from error

    def _value(self, field: str, text: str, arrays: Arrays, encodings: dict[str, str], height: int) -> Any:
        encoding = encodings.get(field)
        if encoding is None:
            return number(text)
        if encoding != "delta":
            return self._shaped(DECODERS[encoding](text), field, height)
        if field not in arrays:
            arrays[field] = bytearray(math.prod(_shape(field, height)))
        apply_delta(arrays[field], text)
        return self._shaped(bytes(arrays[field]), field, height)

    def _encodings_of(self, words: list[str]) -> dict[str, str]:
        """Of the fields in the reply to a request of these words: those that it names, or else those that observe chose."""
        if words[:1] == ["watch"]:
            return self._encodings(_watched_fields(words))
        return self._encodings(words[1:]) if words[:1] == ["look"] and len(words) > 1 else self.encodings

    def _watched(self, words: list[str], texts: Texts) -> Watched:
        fields, height = _watched_fields(words), int(texts.get("height", self.height))
        kept = self.watched.get(words[1])
        if kept is None or kept[:2] != (fields, height):
            kept = self.watched[words[1]] = Watched(fields, height, {})
        return kept

    def _shaped(self, data: bytes, field: str, height: int) -> Any:
        if not self.arrays_wanted:
            return data
        import numpy

        return numpy.frombuffer(data, numpy.uint8).reshape(_shape(field, height))

    def _first(self, *words: object) -> Values:
        """The first group of a reply, with numbers and bytes."""
        return self.request(*words)[0]

    def _rest(self, *words: object) -> list[Values]:
        """The groups after the first."""
        return self.request(*words)[1:]

    def _ints_of(self, key: str, *words: object) -> list[int]:
        return [int(text) for text in self.list_of(key, *words)]

    @staticmethod
    def _encodings(fields: Iterable[str]) -> dict[str, str]:
        pairs = [field.partition(":") for field in fields]
        usual = {
            name: USUAL_ENCODING.get(name, "zlib" if name.startswith("grey84") or STACK.fullmatch(name) else "")
            for name, _, _ in pairs
        }
        return {name: encoding or usual[name] for name, _, encoding in pairs if encoding or usual[name]}

    # Commands. Those that need more than their words, and then the others, in the order of the document.

    def help(self, *words: str) -> str:
        return self._exchange(self._help, "help", *words)

    def _help(self) -> str:
        return self.read_status(self._line())[1]

    def game(self, name: str) -> Values:
        """What is known of one game."""
        return self._first("games", name)

    def load(self, game: str, image: bytes | None = None, **settings: object) -> Values:
        """Power on and begin an episode.

        Args:
            image: The bytes of a cartridge, when `game` is "inline".
            settings: Those of the protocol. `as_` is its setting `as`, the game whose rules apply.
        """
        rules = settings.pop("as_", None)
        data = None if image is None else base64.b64encode(image).decode()
        return self._first("load", game, *_pairs(image=data, **{"as": rules}, **settings))

    def two_player_modes(self) -> list[int]:
        return self._ints_of("two_player_modes", "modes")

    def actions(self) -> dict[int, str]:
        """Names by number."""
        pairs = (pair.split(":") for pair in self.list_of("actions", "actions"))
        return {int(action): name for action, name in pairs}

    def names(self) -> tuple[dict[int, str], list[str]]:
        """Names for bytes of `ram`, by their indices, and for those of `tia`, in their order."""
        found = self.ask("names")[0]
        pairs = (pair.split(":") for pair in found["ram_names"].split(",") if pair)
        return {int(index): name for index, name in pairs}, found["tia_names"].split(",")

    def palette(self) -> list[tuple[int, int, int]]:
        """Red, green and blue of each value that a pixel of `screen` can have."""
        data = bytes.fromhex(self.ask("look", "palette:hex")[0]["palette"])
        return [(data[at], data[at + 1], data[at + 2]) for at in range(0, len(data), 3)]

    def peek(self, index: int, count: int = 1) -> bytes:
        return bytes.fromhex(self.ask("peek", index, count)[0]["bytes"])

    def poke(self, index: int, data: bytes) -> None:
        self.ask("poke", index, data.hex().upper())

    def export_state(self, name: str, whole: bool | int = False) -> bytes:
        """Return a state, for later or for another process.

        Args:
            whole: With the score, the progress of the episode and the stack of screens.
        """
        return base64.b64decode(self.ask("export", name, *_pairs(whole=whole or None))[0]["data"])

    def import_state(self, name: str, data: bytes) -> None:
        self.ask("import", name, base64.b64encode(data).decode())

    def branch(self, name: str, *sequences: Iterable[object], keep: str | None = None) -> list[Values]:
        """Each sequence is a list of actions. Returns a dictionary for each, with `rewards`, and `rewards_b` if there are, as
        lists."""
        words = [*_pairs(keep=keep), *(",".join(map(str, actions)) for actions in sequences)]
        return [{key: decode_rewards(text) if key.startswith("rewards") else number(text) for key, text in texts.items()}
                for texts in self.ask("branch", name, *words)[1:]]

    def close(self) -> None:
        """Close the machines, as close_machines() does. The session goes on."""
        self.close_machines()

    def stop_recording(self) -> Values:
        return self._first("record", "stop")

    # generated: commands, from protocol/protocol.toml

    def hello(self, token: str | None = None) -> Values:
        """The server's name, version and limits.

        Args:
            token: That the server requires.
        """
        return self._first("hello", *_pairs(token=token))

    def games(self, which: str | None = None) -> list[str]:
        """List the games whose image is here, or all known games; or describe one."""
        return self.list_of("games", "games", *_words(which))

    def settings(self) -> Values:
        """The settings in effect."""
        return self._first("settings")

    def set(self, mode: int | None = None, difficulty: int | None = None) -> Values:
        """Change the mode, from the next reset on, or the difficulty, at once.

        Args:
            mode: See modes.
            difficulty: See difficulties.
        """
        return self._first("set", *_pairs(mode=mode, difficulty=difficulty))

    def modes(self) -> list[int]:
        """The game's modes."""
        return self._ints_of("modes", "modes")

    def difficulties(self) -> list[int]:
        """The game's difficulties."""
        return self._ints_of("difficulties", "difficulties")

    def observe(self, *fields: str) -> list[str]:
        """Select the fields of replies.

        Args:
            fields: Without them, asks for the selection.
        """
        return self.list_of("fields", "observe", *fields)

    def look(self, *fields: str) -> Values:
        """Show these fields once; without fields, the selected ones."""
        return self._first("look", *fields)

    def act(self, *actions: object) -> Values:
        """Play actions until the episode ends."""
        return self._first("act", *actions)

    def reset(self, seed: int | str | None = None) -> Values:
        """Begin an episode; with a seed, power on anew with it.

        Args:
            seed: Powers on anew with it.
        """
        return self._first("reset", *_pairs(seed=seed))

    def save(self, name: str, random: bool | int | None = None, machine: int | None = None) -> None:
        """Save the state; random=1: with the random generator.

        Args:
            random: 1: with the random generator.
            machine: One of those of open, 0 the first.
        """
        self.ask("save", name, *_pairs(random=random, machine=machine))

    def restore(self, name: str, machine: int | None = None) -> Values:
        """Restore a saved state.

        Args:
            machine: One of those of open, 0 the first.
        """
        return self._first("restore", name, *_pairs(machine=machine))

    def drop(self, *names: str) -> None:
        """Delete states."""
        self.ask("drop", *names)

    def states(self) -> list[str]:
        """The names of the states."""
        return self.list_of("states", "states")

    def open(
        self,
        count: int,
        autoreset: str | None = None,
        steps: str | None = None,
        start: str | None = None,
        lives: str | None = None,
        stack: str | None = None,
        pool: bool | int | None = None,
    ) -> list[Values]:
        """Create N machines with the loaded game and settings; their seeds count up.

        Args:
            autoreset: What happens at the end of an episode.
            steps: What a step is.
            start: How an episode begins; with steps=frames.
            lives: What a lost life does; with steps=frames.
            stack: What a stack of screens begins with; with steps=frames.
            pool: Which frames a stack shows; with steps=frames.
        """
        return self._rest(
            "open",
            count,
            *_pairs(autoreset=autoreset, steps=steps, start=start, lives=lives, stack=stack, pool=pool),
        )

    def step(self, *actions: object) -> list[Values]:
        """Play one act on each machine: an action each, or one for all."""
        return self._rest("step", *actions)

    def restart(self, mask: str | None = None, seed: int | str | None = None) -> list[Values]:
        """Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.

        Args:
            seed: Powers on anew: machine 0 with N, machine 1 with N + 1, and so on.
        """
        return self._rest("restart", *_words(mask), *_pairs(seed=seed))

    def close_machines(self) -> None:
        """Close the machines."""
        self.ask("close")

    def record(self, kinds: str, name: str, machine: int | None = None) -> Values:
        """Record frames, sound or both into the server's folder.

        Args:
            machine: One of those of open, 0 the first.
        """
        return self._first("record", kinds, name, *_pairs(machine=machine))

    def share(self, name: str, watchers: int | None = None) -> Values:
        """Let other sessions watch the game under this name.

        Args:
            watchers: How many may watch at the same time.
        """
        return self._first("share", name, *_pairs(watchers=watchers))

    def unshare(self) -> None:
        """End what share has begun."""
        self.ask("unshare")

    def shared(self) -> list[Values]:
        """List the shared sessions."""
        return self._rest("shared")

    def watch(self, name: str, *fields: str, since: int | None = None) -> Values:
        """Show a shared session as it was lately.

        Args:
            since: The frame of the last reply; the fields come only if there is a newer one.
        """
        return self._first("watch", name, *_pairs(since=since), *fields)

    def stats(self) -> Values:
        """Counters of this session."""
        return self._first("stats")

    def quit(self) -> None:
        """End the session."""
        self.ask("quit")

    # end of commands
