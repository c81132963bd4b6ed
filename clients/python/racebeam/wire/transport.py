"""Sockets and pipes to a server."""

from __future__ import annotations

import contextlib
import os
import socket
import ssl
import time
from collections.abc import Iterable
from typing import IO

from .addresses import ADDRESSES

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
