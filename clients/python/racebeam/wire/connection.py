"""The streams of a session, and how a session ends."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import IO, TypeVar

from .messages import Refused
from .transport import SocketStream

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
