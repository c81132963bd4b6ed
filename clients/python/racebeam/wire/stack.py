"""Stacks of screens that the client makes."""

from __future__ import annotations

import collections

__all__ = ["Stack"]


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
