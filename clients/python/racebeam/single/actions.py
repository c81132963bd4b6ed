"""The actions of AtariEnv."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any, TypeAlias

import gymnasium
import numpy as np
from gymnasium import spaces

from .._core import Action, ConsoleAction, ControllerAction
from ..arguments import flag
from ..errors import InvalidInput

__all__ = ["EnvWithActions", "PlayerAction", "meaning_of"]

AnyAction: TypeAlias = Action | ConsoleAction | ControllerAction
PlayerAction: TypeAlias = Any  # an index, a pair of indices, or (radius, angle, fire)

FIRST_OF_B = 18  # player B's actions have the numbers after A's
KEYS = (("UP", "w"), ("DOWN", "s"), ("RIGHT", "d"), ("LEFT", "a"), ("FIRE", " "))
KEY_OF_NOOP = "e"
SIDES = {-1: "LEFT", 0: "", 1: "RIGHT"}
HEIGHTS = {-1: "DOWN", 0: "", 1: "UP"}
ACTIONS: dict[int, AnyAction] = {
    action.value: action for kind in (Action, ConsoleAction, ControllerAction) for action in kind
}


class EnvWithActions(gymnasium.Env[Any, Any]):
    """Base class of environments that convert actions to numbers of `Action`.

    Examples:
        >>> from racebeam.single.actions import EnvWithActions
        >>> EnvWithActions.map_action_idx(1, 1, True).name
        'UPRIGHTFIRE'
    """

    continuous: bool
    continuous_action_threshold: float
    _action_set: list[AnyAction]
    _actions_of_b: list[AnyAction]  # those of a joystick and of a controller; the switches are player A's
    _two_player: bool

    def _space_of_actions(self) -> spaces.Space[Any]:
        count = len(self._action_set)
        if self.continuous:
            low, high = np.array([0, -np.pi, 0], np.float32), np.array([1, np.pi, 1], np.float32)
            return spaces.Box(low, high, (3,), np.float32)
        count_of_b = len(self._actions_of_b)
        return spaces.MultiDiscrete([count, count_of_b]) if self._two_player else spaces.Discrete(count)

    def _parse_action(self, action: PlayerAction) -> tuple[int, float, int, float]:
        """Returns the number of A's action and the strength of its paddle, then those of B."""
        if self.continuous:
            return (*self._parse_continuous(action), FIRST_OF_B, 0.0)
        if not self._two_player:
            return _look_up(action, self._action_set), 1.0, FIRST_OF_B, 0.0
        try:
            a, b = action
        except (TypeError, ValueError):
            raise TypeError(f"action is {action!r}; it must be a pair of indices, for players A and B") from None
        return _look_up(a, self._action_set), 1.0, FIRST_OF_B + _look_up(b, self._actions_of_b), 1.0

    def _parse_continuous(self, action: Any) -> tuple[int, float]:
        if not (isinstance(action, np.ndarray) and action.dtype == np.float32 and action.shape == (3,)):
            raise AssertionError(f"action is {action!r}; it must be a float32 array of 3: radius, angle and fire")
        if not np.isfinite(action).all():
            raise InvalidInput(f"action is {action!r}; each part must be a finite number")
        radius, angle, fire = action
        threshold = np.float32(self.continuous_action_threshold)  # the comparisons are those of float32
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        index = self.map_action_idx(
            left_center_right=int(x > threshold) - int(x < -threshold),
            down_center_up=int(y > threshold) - int(y < -threshold),
            fire=bool(fire > threshold),
        )
        return index.value, float(radius)

    @staticmethod
    def map_action_idx(left_center_right: int, down_center_up: int, fire: bool) -> Action:
        """Converts the position of a joystick to an action.

        Args:
            left_center_right: -1 for left, 0 for the centre, 1 for right.
            down_center_up: -1 for down, 0 for the centre, 1 for up.
            fire: Whether the button is pressed.

        Returns:
            The action.

        Raises:
            LookupError: If a position is not -1, 0 or 1.
        """
        if left_center_right not in SIDES or down_center_up not in HEIGHTS:
            raise LookupError(
                f"left_center_right is {left_center_right} and down_center_up is {down_center_up}; "
                "each must be -1, 0 or 1"
            )
        name = HEIGHTS[down_center_up] + SIDES[left_center_right] + ("FIRE" if flag("fire", fire) else "")
        return Action[name or "NOOP"]

    def get_action_meanings(self) -> list[str]:
        """Returns the names of the actions in the order of their indices, such as ["NOOP", "FIRE"]."""
        return [meaning_of(action.value) for action in self._action_set]

    def get_keys_to_action(self) -> dict[tuple[str, ...], int]:
        """Maps the keys that a player holds to actions.

        Returns:
            The index of an action by the keys w, a, s, d and space that are held; e is for NOOP.

        Raises:
            AttributeError: With `continuous` or `two_player`.
        """
        if self.continuous or self._two_player:
            setting = "continuous" if self.continuous else "two_player"
            raise AttributeError(
                f"`get_keys_to_action` can't be provided for this Atari environment as `{setting}=True`: "
                "keys move one joystick"
            )
        joystick = [action.name for action in self._action_set if isinstance(action, Action)]
        return {_keys_of(name): index for index, name in enumerate(joystick)}


def _look_up(action: Any, actions: Sequence[AnyAction]) -> int:
    try:
        index = operator.index(action)
    except TypeError:
        raise TypeError(f"action {action!r} has the type {type(action).__name__}; it must be an integer") from None
    if not 0 <= index < len(actions):
        raise IndexError(f"action {index} is out of range; accepted: 0 to {len(actions) - 1}")
    return int(actions[index].value)


def meaning_of(number: int) -> str:
    """Names an action as the line protocol does.

    Args:
        number: Number of a member of `Action`, `ConsoleAction` or `ControllerAction`.

    Returns:
        The name, such as "UP+C" for UP_C.
    """
    action = ACTIONS[number]
    return action.name.replace("_", "+") if isinstance(action, ControllerAction) else str(action.name)


def _keys_of(action: str) -> tuple[str, ...]:
    return tuple(key for part, key in KEYS if part in action) or (KEY_OF_NOOP,)
