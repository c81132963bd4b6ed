"""The types of the results of environments."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Players", "Results", "State", "TimeStep"]


class Results(NamedTuple):
    """Results of n environments, as arrays of NumPy, or of JAX in a compiled program.

    Attributes:
        observations: Screens, uint8 of shape (n, stack_num, img_height, img_width), with 3 as a further axis for
            colours.
        ram: RAM, uint8 of shape (n, 128).
        rewards: Rewards of the step, clipped if `reward_clip` says so; int32.
        raw_rewards: Rewards of the step before clipping; int32.
        terminated: Whether the episode was terminated.
        truncated: Whether the episode was truncated.
        game_over: Whether the game is over.
        env_id: Index of the environment of each row; int32.
        lives: Lives that are left; int32.
        elapsed: Frames that were played in this game; int32.
        acts: Acts of this step; 0 for a reset; int32.
        lives_lost: Lives that these acts lost; int32.
    """

    observations: Any
    ram: Any
    rewards: Any
    raw_rewards: Any
    terminated: Any
    truncated: Any
    game_over: Any
    env_id: Any
    lives: Any
    elapsed: Any
    acts: Any
    lives_lost: Any


class Players(NamedTuple):
    """The players of a TimeStep.

    Attributes:
        env_id: Index of the environment of each player.
    """

    env_id: Any


class State(NamedTuple):
    """The observation of a TimeStep.

    Attributes:
        env_id: Index of the environment of each row, int32 of shape (n,).
        players: The players of the environments.
        obs: Screens, uint8 of shape (n, channels, img_height, img_width).
        lives: Lives that are left, int32 of shape (n,).
        reward: Rewards before clipping, float32 of shape (n,).
        terminated: Whether the game is over, int32 of shape (n,).
        ram: RAM, uint8 of shape (n, 128).
    """

    env_id: Any
    players: Any
    obs: Any
    lives: Any
    reward: Any
    terminated: Any
    ram: Any


class TimeStep(NamedTuple):
    """A step of n environments, with the attributes of dm_env.TimeStep.

    Attributes:
        step_type: 0 for the first step of an episode, 2 for the last and 1 for the others; int32 of shape (n,).
        reward: Rewards, float32 of shape (n,).
        discount: Discounts, float32 of shape (n,).
        observation: The observation.
    """

    step_type: npt.NDArray[np.int32]
    reward: npt.NDArray[np.float32]
    discount: npt.NDArray[np.float32]
    observation: State

    def first(self) -> Any:
        """Returns the mask of the environments at the first step of an episode, bool of shape (n,)."""
        return self.step_type == 0

    def mid(self) -> Any:
        """Returns the mask of the environments within an episode, bool of shape (n,)."""
        return self.step_type == 1

    def last(self) -> Any:
        """Returns the mask of the environments at the last step of an episode, bool of shape (n,)."""
        return self.step_type == 2
