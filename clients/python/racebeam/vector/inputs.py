"""Checks and conversions of what callers pass to a vector of environments: seeds, masks and actions."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import InvalidInput
from ..vector_options import SEEDS
from .machines import Actions, Joysticks, Seeds
from .results import Bools

__all__ = ["array_of", "check_shape", "indices_of", "joysticks_of", "mask_of", "seeds_of"]


def array_of(values: Any) -> npt.NDArray[Any]:
    """Converts values to an array.

    Args:
        values: Numbers, or sequences of numbers.

    Returns:
        The array.

    Raises:
        InvalidInput: If the rows have different lengths.
    """
    try:
        return np.asarray(values)
    except ValueError:
        raise InvalidInput(f"expected a rectangular array, not {values!r}; its rows have different lengths") from None


def check_shape(name: str, array: npt.NDArray[Any], shape: tuple[int, ...]) -> None:
    """Checks the shape of an array.

    Args:
        name: Name of the array, in the plural.
        array: The array.
        shape: The shape that it must have.

    Raises:
        InvalidInput: If `array` does not have this shape.
    """
    if array.shape != shape:
        raise InvalidInput(f"{name} have the shape {array.shape}; they must have {shape}")


def _seed(value: Any, least: int = SEEDS[0]) -> int:
    try:
        seed = operator.index(value)
    except TypeError:
        raise TypeError(f"the seed is {value!r}; it takes a whole number") from None
    if not least <= seed <= SEEDS[1]:
        raise InvalidInput(f"the seed is {seed}; it takes {least} to {SEEDS[1]}")
    return seed


def seeds_of(seed: Any, count: int) -> Seeds:
    """Converts an argument to one seed for each environment.

    Args:
        seed: The seed of the first environment, from which the seeds count up; or a sequence or array with a seed for
            each, where None and -1 mean unseeded.
        count: Number of environments.

    Returns:
        int64 array of shape (count,).

    Raises:
        TypeError: If a seed is not an integer.
        InvalidInput: If a seed is out of range, or their number is wrong.
    """
    is_array = isinstance(seed, np.ndarray) and seed.ndim > 0
    if isinstance(seed, (str, bytes)) or not (is_array or isinstance(seed, Sequence)):
        return _seed(seed) + np.arange(count, dtype=np.int64)
    if is_array and seed.dtype.kind not in "iuO":
        raise TypeError(f"the seeds have the type {seed.dtype}; they must be integers")
    if is_array and seed.ndim > 1:
        raise InvalidInput(f"the seeds have the shape {seed.shape}; they must have {(count,)}")
    seeds = [-1 if one is None else _seed(one, -1) for one in seed]
    if len(seeds) != count:
        raise InvalidInput(
            f"there are {len(seeds)} seeds for {count} environments; give one entry per sub-environment, or one seed"
        )
    return np.array(seeds, np.int64)


def mask_of(mask: Any, count: int) -> Bools | None:
    """Checks a reset mask.

    Args:
        mask: bool array of shape (count,), or None.
        count: Number of environments.

    Returns:
        The mask as a contiguous array, or None.

    Raises:
        TypeError: If `mask` is not an array of bools.
        InvalidInput: If `mask` has another shape.
    """
    if mask is None:
        return None
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
        raise TypeError(f"reset_mask is {mask!r}; it must be a boolean numpy array")
    if mask.shape != (count,):
        raise InvalidInput(f"reset_mask has the shape {mask.shape}; it must have the shape {(count,)}")
    return np.ascontiguousarray(mask)


def indices_of(actions: Any, count: int, action_count: int) -> Actions:
    """Converts discrete actions. The machines check their range, except that of numbers beyond int64.

    Args:
        actions: Integers of shape (count,).
        count: Number of environments.
        action_count: Number of actions, for the message.

    Returns:
        int64 array of shape (count,).

    Raises:
        TypeError: If the actions are not integers.
        InvalidInput: If their shape is wrong.
        IndexError: If an action exceeds int64.
    """
    array = array_of(actions)
    if array.dtype.kind not in "iu":
        raise TypeError(f"actions have the type {array.dtype}; they must be integers")
    check_shape("actions", array, (count,))
    if array.dtype.kind == "u" and (large := array[array > np.iinfo(np.int64).max]).size:
        raise IndexError(f"action {large[0]} is out of range; accepted: 0 to {action_count - 1}")
    return np.ascontiguousarray(array, np.int64)


def joysticks_of(actions: Any, count: int) -> Joysticks:
    """Converts continuous actions.

    Args:
        actions: Numbers of shape (count, 3): radius, angle in radians, and fire.
        count: Number of environments.

    Returns:
        float32 array of shape (count, 3).

    Raises:
        TypeError: If the actions are not numbers.
        InvalidInput: If their shape is wrong, or a number is not finite.
    """
    array = array_of(actions)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"actions have the type {array.dtype}; they must be numbers: radius, angle and fire")
    check_shape("actions", array, (count, 3))
    with np.errstate(over="ignore"):
        joysticks = np.ascontiguousarray(array, np.float32)
    if not np.isfinite(joysticks).all():
        wrong = joysticks[~np.isfinite(joysticks)][0]
        raise InvalidInput(f"actions have the value {wrong}; each must be a finite number")
    return joysticks
