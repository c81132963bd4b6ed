"""Exceptions of the package.

Invalid input raises `InvalidInput`. It is a RuntimeError, as in ALE, and a ValueError. Its message says what is wrong,
and what is accepted.
"""

from __future__ import annotations

from ._core import InvalidInput

__all__ = ["InvalidInput", "MissingImage", "UnknownGame"]


class UnknownGame(InvalidInput):
    """Raised for a name that no game has."""


class MissingImage(InvalidInput, FileNotFoundError):
    """Raised if no cartridge image of a game is found. The message lists the places that were searched."""
