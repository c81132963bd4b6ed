"""Actions as words of the line protocol's `step`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..vector.machines import Joysticks

# The numbers of actions. The axes are: without or with fire, down to up, left to right.
STICK = np.array([[[9, 5, 8], [4, 0, 3], [7, 2, 6]], [[17, 13, 16], [12, 1, 11], [15, 10, 14]]])


def joystick_actions(joysticks: Joysticks, threshold: float) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
    """Converts continuous actions to actions and the strengths of paddles.

    Compares in float32, as the emulator does.

    Args:
        joysticks: float32 array of shape (n, 3): radius, angle in radians and fire.
        threshold: Deflection from which a direction or the button counts as pressed.

    Returns:
        The numbers of the actions, int64 of shape (n,), and the strengths, float32 of shape (n,).
    """
    radius, angle, fire = joysticks.T
    limit = np.float32(threshold)
    parts = [(radius * part(angle.astype(np.float64)).astype(np.float32)) for part in (np.cos, np.sin)]
    column, row = (1 + (part > limit).astype(int) - (part < -limit) for part in parts)
    return STICK[(fire > limit).astype(int), row, column], radius


def joystick_words(joysticks: Joysticks, threshold: float) -> list[str]:
    """Converts continuous actions to the words of `step`, ACTION@STRENGTH.

    Args:
        joysticks: As `joystick_actions` takes them.
        threshold: As `joystick_actions` takes it.

    Returns:
        A word for each machine.
    """
    actions, strengths = joystick_actions(joysticks, threshold)
    return with_strengths(actions.tolist(), strengths)


def with_strengths(words: Sequence[object], strengths: npt.NDArray[np.float32]) -> list[str]:
    """Adds the strengths of paddles to the words of `step`.

    Args:
        words: A word for each machine.
        strengths: A strength for each machine.

    Returns:
        The words as ACTION@STRENGTH.
    """
    return [f"{word}@{strength:.9g}" for word, strength in zip(words, strengths, strict=True)]
