"""Warns of frames that are skipped twice: by two wrappers, or by the environment and a wrapper."""

from __future__ import annotations

import math
import sys
from typing import Any

import gymnasium

from ..arguments import warn

__all__ = ["warn_of_second_skip"]

# Attributes with the number of steps per step: of AtariPreprocessing, and of MaxAndSkipObservation and MaxAndSkipEnv.
SKIPS = ("frame_skip", "_skip")


def warn_of_second_skip(env: gymnasium.Env[Any, Any], frameskip: int | tuple[int, int]) -> None:
    """Warns if the frames of an environment are skipped in more than one place.

    An environment does not know its wrappers. While they call `reset`, they are on the stack.

    Args:
        env: The environment, which is being reset.
        frameskip: Its frames per step, or (low, high) from which they are drawn.
    """
    own = frameskip if isinstance(frameskip, int) else frameskip[1] - 1
    counts = [(type(env).__name__, own)]
    counts += [(type(wrapper).__name__, _skip_of(wrapper)) for wrapper in _wrappers_on_stack(env)]
    skipping = [(name, count) for name, count in counts if count > 1]
    if len(skipping) > 1:
        names, numbers = zip(*skipping, strict=True)
        warn(
            f"a step plays {' x '.join(map(str, numbers))} = {math.prod(numbers)} frames, since {' and '.join(names)} "
            "skip frames; leave one of them out, or make the environment with frameskip=1"
        )


def _wrappers_on_stack(env: gymnasium.Env[Any, Any]) -> list[gymnasium.Wrapper[Any, Any, Any, Any]]:
    """Returns the wrappers of an environment whose methods are running, the innermost first."""
    wrappers = {}
    frame = sys._getframe()
    while frame.f_back is not None:
        frame = frame.f_back
        caller = frame.f_locals.get("self")
        if isinstance(caller, gymnasium.Wrapper) and _wraps(caller, env):
            wrappers[id(caller)] = caller
    return list(wrappers.values())


def _wraps(wrapper: gymnasium.Wrapper[Any, Any, Any, Any], env: gymnasium.Env[Any, Any]) -> bool:
    """Returns whether a wrapper is around an environment. One whose constructor still runs may not have it yet."""
    return "env" in vars(wrapper) and wrapper.unwrapped is env


def _skip_of(wrapper: gymnasium.Wrapper[Any, Any, Any, Any]) -> int:
    counts = [vars(wrapper).get(name) for name in SKIPS]
    return next((count for count in counts if isinstance(count, int)), 1)
