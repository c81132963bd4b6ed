"""Opens sessions: on a server that runs, or on one that is started."""

from __future__ import annotations

import shlex
import shutil
import ssl
import sys
from collections.abc import Iterable

from .addresses import reach
from .connection import LONGEST_REPLY
from .session import Session
from .transport import close_pipes, open_secure_socket


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
