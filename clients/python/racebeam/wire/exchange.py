"""Requests: sending them, and receiving their replies in order."""

from __future__ import annotations

from collections.abc import Callable

from .connection import Result
from .messages import Reply, Texts, Values, format_request, parse_number
from .replies import Replies


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
