"""Sessions of the line protocol."""

from __future__ import annotations

import contextlib
import socket
import ssl
import subprocess
from collections.abc import Callable
from typing import IO

from .commands import Commands
from .transport import SocketStream, close_pipes, open_secure_socket, outlives_streams

__all__ = ["Session"]


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
