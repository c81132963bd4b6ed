"""Checks of the arguments that only AtariEnv has."""

from __future__ import annotations

import numbers
from typing import Any

import numpy as np

from ..arguments import MOST, WrongType, WrongValue
from ..errors import InvalidInput

__all__ = ["check_reward_range", "check_rules", "frameskip_of"]

RULES = ("ale-0.12", "fixed")


def check_rules(rules: object) -> None:
    """Checks the name of the rules.

    Args:
        rules: The argument `rules` of `AtariEnv`.

    Raises:
        InvalidInput: If the rules are unknown.
    """
    if not isinstance(rules, str) or rules not in RULES:
        raise InvalidInput(f"rules is {rules!r}; it takes {' or '.join(RULES)}")


def frameskip_of(value: Any) -> int | tuple[int, int]:
    """Checks a frameskip, and converts its numbers to int.

    Args:
        value: A number of frames, or a tuple (low, high).

    Returns:
        The number or the tuple.

    Raises:
        WrongType: If `value` is neither a whole number nor a tuple of such numbers.
        WrongValue: If a number is out of range, or `low` is not below `high`.
    """
    accepted = f"it takes an int from 1 to {MOST}, or a tuple (low, high) of such ints with low < high"
    if not isinstance(value, tuple) and not _is_whole(value):
        raise WrongType(f"frameskip has the type {type(value).__name__}; {accepted}")
    ends = value if isinstance(value, tuple) else (value, MOST + 1)
    if not all(map(_is_whole, ends)):
        raise WrongType(f"frameskip is {value}; {accepted}")
    if not (len(ends) == 2 and 0 < ends[0] < ends[1] <= MOST + (ends is not value)):
        raise WrongValue(f"frameskip is {value}; {accepted}")
    return (int(ends[0]), int(ends[1])) if ends is value else int(value)


def check_reward_range(reward_range: object) -> None:
    """Checks a range of rewards.

    Args:
        reward_range: The argument `reward_range` of `AtariEnv`.

    Raises:
        WrongType: If it is neither None nor a pair of numbers.
        WrongValue: If it does not have two numbers, or the first exceeds the second.
    """
    if reward_range is None:
        return
    sentence = f"reward_range is {reward_range!r}; it takes None, or two numbers (low, high), low <= high"
    if not isinstance(reward_range, (tuple, list)) or not all(isinstance(end, numbers.Real) for end in reward_range):
        raise WrongType(sentence)
    if len(reward_range) != 2 or not reward_range[0] <= reward_range[1]:  # as with NaN
        raise WrongValue(sentence)


def _is_whole(value: object) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)
