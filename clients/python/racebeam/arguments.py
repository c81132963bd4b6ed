"""Checks of arguments. They raise gymnasium.error.Error, in a sentence with the name, the value and what is accepted: a WrongType, which
is also a TypeError, or a WrongValue, which is also a ValueError.
"""

from __future__ import annotations

import enum
import math
import operator
from typing import Any, TypeVar

from gymnasium import error

from . import images

Member = TypeVar("Member", bound=enum.Enum)
MOST = 2**31 - 1


class WrongType(error.Error, TypeError):
    """An argument is of no type that is accepted."""


class WrongValue(error.Error, ValueError):
    """An argument is none of the values that are accepted."""


def either(given: Any, usual: Any) -> Any:
    """What was given, or else what is usual."""
    return usual if given is None else given


def listed(values: Any) -> str:
    return ", ".join(map(str, values))


def check_choice(name: str, value: object, choices: tuple[str | None, ...]) -> None:
    if not any(value is choice or (isinstance(value, str) and value == choice) for choice in choices):
        raise WrongValue(f"{name} is {value!r}; it takes {listed(choices)}")


def member(name: str, word: object, kind: type[Member]) -> Member:
    """The member of an enumeration whose name is FIRE_NOOPS, of the word "fire-noops"."""
    by_word = {one.name.lower().replace("_", "-"): one for one in kind}
    check_choice(name, word, tuple(by_word))
    return by_word[str(word)]


def whole(name: str, value: Any, low: int, high: int) -> int:
    """A whole number from low to high."""
    try:
        number = operator.index(value)
    except TypeError:
        raise WrongType(f"{name} is {value!r}; it takes a whole number") from None
    if not low <= number <= high:
        raise WrongValue(f"{name} is {number}; it takes {low} to {high}")
    return number


def flag(name: str, value: Any) -> bool:
    """What Python takes for true or false. An array of several values is neither."""
    try:
        return bool(value)
    except (TypeError, ValueError):
        raise WrongType(f"{name} is {value!r}; it takes True or False") from None


def share(name: str, value: Any) -> float:
    """A number from 0 to 1."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise WrongType(f"{name} is {value!r}; it takes a number from 0 to 1") from None
    if not 0 <= number <= 1:
        raise WrongValue(f"{name} is {number}; it takes 0 to 1")
    return number


def real(name: str, value: Any) -> float:
    """A number, which may be infinite."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise WrongType(f"{name} is {value!r}; it takes a number") from None
    if math.isnan(number):
        raise WrongValue(f"{name} is {value!r}; it takes a number")
    return number


def image(value: Any) -> images.Rom | None:
    """A path or bytes, or None."""
    try:
        return None if value is None else images.given(value)
    except TypeError as wrong:
        raise WrongType(*wrong.args) from None


def seconds(name: str, value: Any) -> float | None:
    """A time limit, or None."""
    number = None if value is None else real(name, value)
    if number is not None and not 0 < number <= MOST:
        raise WrongValue(f"{name} is {number}; it takes None, or seconds above 0")
    return number
