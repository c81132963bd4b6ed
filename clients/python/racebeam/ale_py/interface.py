"""ALEInterface with the errors of ale_py: a refused argument is a plain RuntimeError instead of an InvalidInput."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from .. import images, interface
from ..errors import InvalidInput, UnknownGame

__all__ = ["ALEInterface", "NoSuchGame", "check_game", "plain_errors"]

Method = TypeVar("Method", bound=Callable[..., Any])


class NoSuchGame(UnknownGame, AssertionError, TypeError):
    """Raised for a name that no game has. ale_py's AtariVectorEnv raises AssertionError, and its AtariEnv TypeError."""


def check_game(game: str) -> None:
    """Checks the name of a game.

    Args:
        game: Name of the game.

    Raises:
        NoSuchGame: If no game has this name.
    """
    try:
        images.check_name(game)
    except UnknownGame as error:
        raise NoSuchGame(*error.args) from None


def plain_errors(method: Method, kind: type[Exception] = RuntimeError) -> Method:
    """Converts the InvalidInput that a method raises.

    Args:
        method: The method.
        kind: Class of the exception to raise instead.

    Returns:
        The method with other exceptions.
    """

    @functools.wraps(method)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return method(*arguments, **named)
        except InvalidInput as refusal:
            raise kind(*refusal.args) from None

    return cast(Method, call)


class ALEInterface(interface.ALEInterface):
    """racebeam.ALEInterface with the errors of ale_py.

    Examples:
        >>> from racebeam.ale_py import ALEInterface
        >>> ale = ALEInterface()
        >>> ale.loadROM("builtin:beamfall")
        >>> ale.setMode(99)
        Traceback (most recent call last):
        RuntimeError: Invalid game mode requested: mode is 99; it takes 0
    """

    isSupportedROM = staticmethod(plain_errors(interface.ALEInterface.isSupportedROM))
    setDifficulty = plain_errors(interface.ALEInterface.setDifficulty)
    setRAM = plain_errors(interface.ALEInterface.setRAM)
    setInt = plain_errors(interface.ALEInterface.setInt)
    setBool = plain_errors(interface.ALEInterface.setBool)
    setFloat = plain_errors(interface.ALEInterface.setFloat)
    setString = plain_errors(interface.ALEInterface.setString)
    getScreen = plain_errors(interface.ALEInterface.getScreen)
    getScreenRGB = plain_errors(interface.ALEInterface.getScreenRGB)
    getScreenGrayscale = plain_errors(interface.ALEInterface.getScreenGrayscale)

    @plain_errors
    def setMode(self, mode: int, /) -> None:
        """Selects a mode for one player. racebeam.ALEInterface also accepts modes for two.

        Args:
            mode: One of `getAvailableModes()`.

        Raises:
            RuntimeError: If the game does not have the mode.
        """
        modes = self.getAvailableModes()
        if isinstance(mode, (int, np.integer)) and mode not in modes:
            raise InvalidInput(f"Invalid game mode requested: mode is {mode}; it takes {', '.join(map(str, modes))}")
        super().setMode(mode)
