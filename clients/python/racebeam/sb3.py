"""Environments for Stable-Baselines3: VecEnv replaces make_atari_env() and VecFrameStack.

    from racebeam.sb3 import VecEnv
    model = stable_baselines3.PPO("CnnPolicy", VecEnv("breakout", 8, seed=1))

Importing this module needs Stable-Baselines3: pip install "stable-baselines3>=2.4".
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode

from .arguments import WrongType, WrongValue
from .extras import install_hint
from .vector_env import AtariVectorEnv, VectorArguments
from .vector_options import autoreset_of

try:
    from stable_baselines3.common import monitor, vec_env  # type: ignore[import-not-found,unused-ignore]
except ModuleNotFoundError as error:
    if not str(error.name).startswith("stable_baselines3"):
        raise
    raise ImportError(f"racebeam.sb3 needs Stable-Baselines3; {install_hint('stable_baselines3')}") from error

if sys.version_info >= (3, 11):
    from typing import Unpack
elif TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["VecEnv"]

DEFAULTS: VectorArguments = {"autoreset_mode": "SameStep", "start": "baselines", "life_loss": "end"}


def _check(arguments: VectorArguments) -> None:
    """Checks the arguments that AtariVectorEnv accepts and VecEnv does not."""
    if "options" in arguments:
        raise WrongType("options are given; VecEnv takes them one by one, as keyword arguments")
    mode = arguments.get("autoreset_mode", AutoresetMode.SAME_STEP)
    if autoreset_of(mode) is not AutoresetMode.SAME_STEP:
        raise WrongValue(f"autoreset_mode is {mode!r}; VecEnv takes SameStep")
    if arguments.get("life_loss") == "reported":
        raise WrongValue(
            "life_loss is 'reported', with which an episode goes on after a step that is done; VecEnv takes ignored, "
            "end, restart"
        )
    if arguments.get("batch_size"):
        raise WrongValue(f"batch_size is {arguments['batch_size']!r}; VecEnv takes 0, for all environments")


class VecEnv(vec_env.VecEnv):  # type: ignore[misc,unused-ignore]
    """AtariVectorEnv as a VecEnv, with the preprocessing of AtariWrapper and VecFrameStack.

    Observations are uint8 of shape (num_envs, stack_num, img_height, img_width), which CnnPolicy takes as they are. A
    lost life ends an episode, and the next one continues the game.

    `infos` have "lives". Where an episode ends, they have "terminal_observation" and "TimeLimit.truncated". Where a
    game ends, also in the frames before the next life is played, they have "episode". It has the sum of the unclipped
    rewards "r", the frames "l" and the seconds "t".

    For the same seeds, rewards, ends and lives are those of make_atari_env() over AtariEnv, if `noop_max` and
    `repeat_action_probability` are 0. Otherwise the random numbers differ. Some pixels differ: here a pixel is the
    maximum of two frames in grey, there the maximum in each colour.

    Args:
        game: Name of a game, or one name for each environment.
        num_envs: Number of environments. Default: 1, or the number of names in `game`.
        **arguments: Keyword arguments of `AtariVectorEnv` such as `seed`, except `batch_size` and `options`.
            `autoreset_mode` must be SAME_STEP, and `life_loss` must not be "reported", since an episode ends where a
            step is done.

    Raises:
        gymnasium.error.Error: If an argument is wrong; also a TypeError or a ValueError.

    The constructor also raises what that of `AtariVectorEnv` raises.

    Examples:
        >>> from racebeam.sb3 import VecEnv
        >>> envs = VecEnv("beamfall", 2, seed=1)
        >>> envs.reset().shape
        (2, 4, 84, 84)
        >>> observations, rewards, dones, infos = envs.step([0, 1])
        >>> envs.close()
    """

    def __init__(
        self, game: str | Sequence[str], num_envs: int | None = None, **arguments: Unpack[VectorArguments]
    ) -> None:
        _check(arguments)
        merged: VectorArguments = {**DEFAULTS, **arguments}
        self._envs = AtariVectorEnv(game, num_envs, **merged)
        self._restarts = merged.get("life_loss") == "restart"  # each episode is a game
        self._start_time = time.time()
        self._actions: Any = None
        count = self._envs.num_envs
        self._returns = np.zeros(count, np.int64)
        super().__init__(count, self._envs.single_observation_space, self._envs.single_action_space)
        self.metadata = self._envs.metadata

    def __repr__(self) -> str:
        return repr(self._envs).replace(type(self._envs).__name__, type(self).__name__, 1)

    def reset(self) -> Any:
        """Begins new episodes, with the seeds that `seed` set.

        Returns:
            Observations, uint8 of shape (num_envs, stack_num, img_height, img_width).
        """
        seeds = None if all(seed is None for seed in self._seeds) else self._seeds
        observations, info = self._envs.reset(seed=seeds)
        self._reset_seeds()
        self._reset_options()
        self._returns[:] = 0
        self.reset_infos = [{"lives": int(lives)} for lives in info["lives"]]
        return observations

    def step_async(self, actions: Any) -> None:
        """Keeps the actions for `step_wait`.

        Args:
            actions: Integers of shape (num_envs,).
        """
        self._actions = actions

    def step_wait(self) -> tuple[Any, npt.NDArray[np.float32], npt.NDArray[np.bool_], list[dict[str, Any]]]:
        """Steps the environments with the actions that `step_async` kept.

        Returns:
            Observations, rewards (float32), done (bool), and a list of infos.

        Raises:
            TypeError: If the actions have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions have a wrong shape.
        """
        observations, rewards, terminated, truncated, info = self._envs.step(self._actions)
        self._returns += info["raw_reward"]
        infos: list[dict[str, Any]] = [{"lives": lives} for lives in info["lives"].tolist()]
        done = terminated | truncated
        for env in np.flatnonzero(done):
            self.reset_infos[env] = infos[env]
            infos[env] = self._make_final_info(int(env), info, bool(truncated[env]))
        return observations, rewards.astype(np.float32), done, infos

    def _make_final_info(self, env: int, info: dict[str, Any], is_truncated: bool) -> dict[str, Any]:
        final = info["final_info"]
        final_info = {
            "lives": int(final["lives"][env]),
            "terminal_observation": info["final_obs"][env],
            "TimeLimit.truncated": is_truncated,
        }
        frames = int(final["episode_frame_number"][env])
        # A game may also end in the frames before the next life is played, and when a life is lost at the limit of
        # frames.
        is_next_game = (
            self._restarts
            or is_truncated
            or info["game_over"][env]
            or info["lives"][env] > final_info["lives"]
            or info["episode_frame_number"][env] < frames
        )
        if is_next_game:
            final_info["episode"] = {
                "r": float(self._returns[env]),
                "l": frames,
                "t": round(time.time() - self._start_time, 6),
            }
            self._returns[env] = 0
        return final_info

    def close(self) -> None:
        """Closes the environments."""
        self._envs.close()

    def get_images(self) -> list[npt.NDArray[np.uint8] | None]:
        """Returns the screens, uint8 of shape (height, 160, 3), if `render_mode` is "rgb_array"."""
        return list(self._envs.render() or [])

    def render(self, mode: str | None = None) -> npt.NDArray[np.uint8] | None:
        """Returns the screens as one picture, which `render_mode` "rgb_array" allows.

        Args:
            mode: Ignored if `render_mode` is "human", since the window shows the screens already.

        Returns:
            uint8 array of shape (height, width, 3), or None.
        """
        return None if self.render_mode == "human" else super().render(mode)

    # Calls of wrappers and callbacks

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Reads an attribute of some environments, as `AtariVectorEnv.get_attr` does.

        Args:
            attr_name: Name of the attribute.
            indices: Indices of the environments, or None for all.

        Returns:
            The values, in the order of `indices`.
        """
        values = self._envs.get_attr(attr_name)
        return [values[env] for env in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Sets an attribute of all environments, which share it.

        Args:
            attr_name: Name of the attribute.
            value: Its value.
            indices: Ignored.
        """
        setattr(self._envs, attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Calls a method of some environments.

        Args:
            method_name: Name of a method of `AtariVectorEnv` whose first parameter is the index of an environment, such
                as "save" or "get_action_meanings".
            *method_args: Further arguments of each call.
            indices: Indices of the environments, or None for all.
            **method_kwargs: Keyword arguments of each call.

        Returns:
            What the calls return, in the order of `indices`.
        """
        method = getattr(self._envs, method_name)
        return [method(env, *method_args, **method_kwargs) for env in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """Returns whether the infos have what a wrapper adds, which is true of Monitor.

        Args:
            wrapper_class: Class of the wrapper.
            indices: Indices of the environments, or None for all.
        """
        return [wrapper_class is monitor.Monitor for _ in self._get_indices(indices)]
