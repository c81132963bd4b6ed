"""ALEInterface of ale_py: what it refuses is a RuntimeError, and of no narrower type. Errors of the other classes."""

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
    """There is no game of this name. AtariVectorEnv of ale_py raises AssertionError, and AtariEnv TypeError."""


def check_game(game: str) -> None:
    """Raises NoSuchGame."""
    try:
        images.check_name(game)
    except UnknownGame as error:
        raise NoSuchGame(*error.args) from None


REFUSING = (
    "setDifficulty",
    "setRAM",
    "setInt",
    "setBool",
    "setFloat",
    "setString",
    "getScreen",
    "getScreenRGB",
    "getScreenGrayscale",
)


def plain_errors(method: Method, kind: type[Exception] = RuntimeError) -> Method:
    """Raises an error of this kind where the method raises InvalidInput."""

    @functools.wraps(method)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return method(*arguments, **named)
        except InvalidInput as refusal:
            raise kind(*refusal.args) from None

    return cast(Method, call)


class ALEInterface(interface.ALEInterface):
    """racebeam.ALEInterface with the errors of ale_py."""

    isSupportedROM = staticmethod(plain_errors(interface.ALEInterface.isSupportedROM))

    @plain_errors
    def setMode(self, mode: int, /) -> None:
        """One of getAvailableModes(). Modes for two, which racebeam.ALEInterface has besides, are refused."""
        offered = self.getAvailableModes()
        if isinstance(mode, (int, np.integer)) and mode not in offered:
            raise InvalidInput(f"Invalid game mode requested: mode is {mode}; it takes {', '.join(map(str, offered))}")
        super().setMode(mode)


for _name in REFUSING:
    setattr(ALEInterface, _name, plain_errors(getattr(interface.ALEInterface, _name)))
