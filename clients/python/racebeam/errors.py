"""What can go wrong, beside Python's own exceptions.

All bad input is an InvalidInput, which is a RuntimeError, as in ALE, and a ValueError. Its sentence says what was wrong
and what is accepted.
"""

from __future__ import annotations

from ._core import InvalidInput

__all__ = ["InvalidInput", "MissingImage", "UnknownGame"]


class UnknownGame(InvalidInput):
    """There is no game of this name."""


class MissingImage(InvalidInput, FileNotFoundError):
    """No cartridge image of the game was found. The sentence says where was looked."""
