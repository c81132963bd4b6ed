"""Checks of arguments.

Each check returns the value in the type that the package works with. A failed check raises `WrongType` or `WrongValue`,
whose message names the argument, its value and what is accepted.
"""

from __future__ import annotations

import difflib
import enum
import math
import operator
import os
import sys
import warnings
from collections.abc import Iterable, Sequence
from typing import Any, Literal, TypeVar

import gymnasium
from gymnasium import error

from . import images

Member = TypeVar("Member", bound=enum.Enum)
Word = TypeVar("Word", bound=str)
MOST = 2**31 - 1
LIBRARIES = tuple(os.path.dirname(os.path.abspath(file)) + os.sep for file in (__file__, gymnasium.__file__))


class WrongType(error.Error, TypeError):
    """Raised for an argument of a wrong type."""


class WrongValue(error.Error, ValueError):
    """Raised for an argument whose value is out of range or not one of the choices."""


def value_or(value: Any, default: Any) -> Any:
    """Returns `value`, or `default` if `value` is None."""
    return default if value is None else value


def accept_old_name(old: str, old_value: Any, name: str, value: Any) -> Any:
    """Returns the value of an argument that may be given by its old name, and warns of the old name.

    Args:
        old: Old name.
        old_value: Value under the old name, or None.
        name: Name.
        value: Value under the name, or None.

    Raises:
        WrongValue: If both are given.
    """
    if old_value is None:
        return value
    if value is not None:
        raise WrongValue(f"{old} is the old name of {name}; only one of them may be given")
    warn(f"{old} is the old name of {name}", DeprecationWarning)
    return old_value


def join(values: Iterable[object]) -> str:
    """Returns the values as a list for a message: "a, b, c"."""
    return ", ".join(map(str, values))


def check_choice(name: str, value: object, choices: tuple[str | None, ...]) -> None:
    """Checks that a value is one of the choices.

    Args:
        name: Name of the argument.
        value: Value of the argument.
        choices: Accepted words; may include None.

    Raises:
        WrongValue: If `value` is not one of `choices`.
    """
    if not any(value is choice or (isinstance(value, str) and value == choice) for choice in choices):
        raise WrongValue(f"{name} is {value!r}; it takes {join(choices)}")


def member(name: str, word: object, kind: type[Member]) -> Member:
    """Looks up the member of an enumeration that a word names.

    Args:
        name: Name of the argument.
        word: Name of the member in lower case with hyphens, such as "fire-noops" for FIRE_NOOPS.
        kind: The enumeration.

    Returns:
        The member.

    Raises:
        WrongValue: If no member has this name.
    """
    by_word = {one.name.lower().replace("_", "-"): one for one in kind}
    check_choice(name, word, tuple(by_word))
    return by_word[str(word)]


def integer(name: str, value: Any, low: int, high: int) -> int:
    """Checks a whole number.

    Args:
        name: Name of the argument.
        value: Any integer type, such as int or numpy.int64.
        low: Smallest accepted value.
        high: Largest accepted value.

    Returns:
        The number as an int.

    Raises:
        WrongType: If `value` is not a whole number.
        WrongValue: If `value` is not from `low` to `high`.
    """
    try:
        number = operator.index(value)
    except TypeError:
        raise WrongType(f"{name} is {value!r}; it takes a whole number") from None
    if not low <= number <= high:
        raise WrongValue(f"{name} is {number}; it takes {low} to {high}")
    return number


def optional_integer(name: str, value: Any) -> int | None:
    """Checks a whole number from 0, or None.

    Args:
        name: Name of the argument.
        value: Any integer type, or None.

    Returns:
        The number as an int, or None.

    Raises:
        WrongType: If `value` is neither a whole number nor None.
        WrongValue: If `value` is negative or above 2**31 - 1.
    """
    return None if value is None else integer(name, value, 0, MOST)


def _flag_or_word(name: str, value: Any, word: Word) -> bool | Word:
    """Checks an argument that takes a truth value, or a single word."""
    if not isinstance(value, str):
        return flag(name, value)
    if value != word:
        raise WrongValue(f"{name} is {value!r}; it takes True, False or {word!r}")
    return word


def action_space(name: str, value: Any) -> str:
    """Checks which actions an environment takes.

    Args:
        name: Name of the argument.
        value: True for all 18, False for those that have an effect in the game, or "console".

    Returns:
        The word of the line protocol's `action_set`: "legal", "minimal" or "console".

    Raises:
        WrongType: If `value` has no truth value, such as an array of several elements.
        WrongValue: If `value` is another word.
    """
    chosen = _flag_or_word(name, value, "console")
    return chosen if isinstance(chosen, str) else "legal" if chosen else "minimal"


def sound_flag(name: str, value: Any) -> bool | Literal["all"]:
    """Checks whether observations have sound.

    Args:
        name: Name of the argument.
        value: A truth value, or "all" for the samples of all frames.

    Returns:
        The truth value, or "all".

    Raises:
        WrongType: If `value` has no truth value, such as an array of several elements.
        WrongValue: If `value` is another word.
    """
    word: Literal["all"] = "all"
    return _flag_or_word(name, value, word)


def flag(name: str, value: Any) -> bool:
    """Checks a flag.

    Args:
        name: Name of the argument.
        value: Any value with a truth value.

    Returns:
        The truth value.

    Raises:
        WrongType: If `value` has no truth value, such as an array of several elements.
    """
    try:
        return bool(value)
    except (TypeError, ValueError):
        raise WrongType(f"{name} is {value!r}; it takes True or False") from None


def _float(value: Any) -> float:
    """Converts a number, and refuses texts, which float() parses."""
    if isinstance(value, (str, bytes, bytearray)):
        raise TypeError
    return float(value)


def share(name: str, value: Any) -> float:
    """Checks a probability.

    Args:
        name: Name of the argument.
        value: A number from 0 to 1.

    Returns:
        The number as a float.

    Raises:
        WrongType: If `value` is not a number.
        WrongValue: If `value` is not from 0 to 1.
    """
    try:
        number = _float(value)
    except (TypeError, ValueError):
        raise WrongType(f"{name} is {value!r}; it takes a number from 0 to 1") from None
    if not 0 <= number <= 1:
        raise WrongValue(f"{name} is {number}; it takes 0 to 1")
    return number


def real(name: str, value: Any) -> float:
    """Checks a real number.

    Args:
        name: Name of the argument.
        value: A number, which may be infinite.

    Returns:
        The number as a float.

    Raises:
        WrongType: If `value` is not a number.
        WrongValue: If `value` is NaN.
    """
    try:
        number = _float(value)
    except (TypeError, ValueError, OverflowError):
        raise WrongType(f"{name} is {value!r}; it takes a number") from None
    if math.isnan(number):
        raise WrongValue(f"{name} is {value!r}; it takes a number")
    return number


def image(value: Any) -> images.Rom | None:
    """Checks a cartridge image.

    Args:
        value: A path, an object that holds bytes, or None.

    Returns:
        The path as given, the image as bytes, or None.

    Raises:
        WrongType: If `value` is something else.
    """
    try:
        return None if value is None else images.path_or_bytes(value)
    except TypeError as wrong:
        raise WrongType(*wrong.args) from None


def seconds(name: str, value: Any) -> float | None:
    """Checks a time limit.

    Args:
        name: Name of the argument.
        value: Seconds above 0, or None for no limit.

    Returns:
        The number as a float, or None.

    Raises:
        WrongType: If `value` is neither a number nor None.
        WrongValue: If `value` is not above 0, or exceeds 2**31 - 1.
    """
    number = None if value is None else real(name, value)
    if number is not None and not 0 < number <= MOST:
        raise WrongValue(f"{name} is {number}; it takes None, or seconds above 0")
    return number


# Your own games and images


def path_of(game_file: Any) -> str | None:
    """Converts the path of a game file.

    Args:
        game_file: A path, or None.

    Returns:
        The path as a string, or None.

    Raises:
        WrongType: If `game_file` is not a path.
    """
    if game_file is None:
        return None
    if isinstance(game_file, (str, os.PathLike)) and isinstance(os.fspath(game_file), str):
        return os.fspath(game_file)
    raise WrongType(f"game_file is {game_file!r}; it takes a path")


def check_source(game: Any, rom: images.Rom | None, game_file: str | None, server: object) -> None:
    """Checks that the arguments say which image is played by which rules, and only once.

    Args:
        game: Name of the game, or names of several, or None.
        rom: The image, or None.
        game_file: Path of the game file, or None.
        server: Address of the server, or None.

    Raises:
        WrongValue: If they do not.
    """
    if game_file is not None and game is not None:
        raise WrongValue(f"game is {game!r} and game_file is {game_file!r}; give one of them")
    if game_file is not None and server is not None:
        raise WrongValue("game_file is given with server; start the server with --game-file, and name the game")
    if game is None and rom is None:
        raise WrongValue("game is None; it takes a name, or None with rom=, or with rom= and game_file=")


def check_token(server: object, token: object) -> None:
    """Checks that a token is given with a server only.

    Args:
        server: Address of the server, addresses of several, or None.
        token: Token, or None.

    Raises:
        WrongValue: If it is given without a server.
    """
    if server is None and token is not None:
        raise WrongValue("token is given without server; give the address of the server, too")


def console_of(**settings: Any) -> dict[str, str]:
    """Returns the settings of the console that are not None, as texts."""
    return {key: str(value) for key, value in settings.items() if value is not None}


# Names and warnings


# Options of others, and what is meant by them here.
OTHER_NAMES = {
    "max_episode_steps": "max_num_frames_per_episode takes the frames of an episode",
    "terminal_on_life_loss": "life_loss takes the effect of a lost life",
    "episodic_life": "life_loss takes the effect of a lost life",
    "seed": "reset() takes the seed",
}


def check_names(names: Iterable[str], known: Sequence[str], where: str) -> None:
    """Checks the names of options.

    Args:
        names: The names.
        known: Accepted names.
        where: What lists the accepted names.

    Raises:
        WrongType: If a name is not one of `known`. The message suggests similar names.
    """
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=3)
            hint = f"did you mean {' or '.join(near)}?" if near else f"{where} lists the options"
            hint = OTHER_NAMES.get(name, hint)
            raise WrongType(f"unknown option {name!r}; {hint}")


def warn(sentence: str, category: type[Warning] = UserWarning) -> None:
    """Warns of a line of the program that uses this package, also through Gymnasium.

    Args:
        sentence: Text of the warning.
        category: Class of the warning.
    """
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_code.co_filename.startswith(LIBRARIES):
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, category, stacklevel=level)
