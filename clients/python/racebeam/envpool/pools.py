"""Environments with EnvPool's interface, of the kinds of Gymnasium, Gym 0.21 and dm_env."""

from __future__ import annotations

import math
import sys
from typing import Any

import gymnasium
from gymnasium import spaces

from ..arguments import flag
from ..vector.autoreset import AutoresetMode, VectorEnv
from ..vector.results import Info
from .base import EnvPool
from .spec import EnvSpec, dm_specs
from .types import Players, Results, State, TimeStep

__all__ = ["DMEnvPool", "EnvPool", "GymEnvPool", "GymnasiumEnvPool"]


class GymnasiumEnvPool(EnvPool, VectorEnv[Any, Any, Any], gymnasium.Env[Any, Any]):  # type: ignore[misc]
    """Environments with the interface of Gymnasium, made by make(env_type="gymnasium").

    `info` has `env_id`, `players`, `lives`, `reward` (before clipping), `terminated` (whether the game is over), `ram`
    and `elapsed_step`.

    Examples:
        >>> from racebeam import envpool
        >>> envs = envpool.make_gymnasium("Beamfall-v5", num_envs=2)
        >>> observations, info = envs.reset()
        >>> observations, rewards, terminated, truncated, info = envs.step([1, 0])
        >>> rewards.dtype, info["lives"].tolist()
        (dtype('float32'), [4, 4])
        >>> envs.close()
    """

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": ["rgb_array"]}
    is_vector_env = True

    def reset(self, env_id: Any = None, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begins new games.

        Args:
            env_id: Indices of the environments. Default: all.
            seed: Ignored with a warning, as in EnvPool.
            options: May have "reset_mask", which chooses environments.

        Returns:
            Observations, uint8 of shape (n, channels, img_height, img_width), and info.

        Raises:
            InvalidInput: If an index, the mask or an option is wrong.
        """
        if seed is not None:
            self.seed(seed)
        observations, *_, info = self._reset(env_id, options)
        return observations, info

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Any, Info]:
        """Steps some environments.

        Args:
            action: As in `send`.
            env_id: As in `send`.

        Returns:
            Observations, rewards (float32), terminated (bool), truncated (bool) and info.

        Raises:
            IndexError: If an action is out of range.
            InvalidInput: If the shapes differ, or an index is wrong.
        """
        results: tuple[Any, Any, Any, Any, Info] = self._step(action, env_id)
        return results

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        """Waits for environments that were sent.

        Args:
            reset: Whether to return what `reset` returns.
            return_info: Ignored, as in EnvPool.

        Returns:
            What `step` or `reset` returns.

        Raises:
            InvalidInput: If fewer than `batch_size` environments were sent.
        """
        observations, *rest, info = self._format(self._receive())
        return (observations, info) if flag("reset", reset) else (observations, *rest, info)

    def _format(self, results: Results) -> tuple[Any, Any, Any, Any, Info]:
        observations, rewards, done, truncated, info = self._format_with_info(results)
        return observations, rewards, done & ~truncated, truncated, info


class GymEnvPool(EnvPool):
    """Environments with the interface of Gym 0.21, made by make(env_type="gym").

    `reset` returns observations, and `step` has one flag `done`. In a program that has imported gym, the spaces are
    those of that package. The environments have the attributes that wrappers of gym read.

    Args:
        spec: Spec of the task, as `make_spec` returns it.
        render_env_id: Index of the environment that `render` returns by default.
        render_mode: None or "rgb_array"; has no effect.

    Examples:
        >>> from racebeam import envpool
        >>> envs = envpool.make("Beamfall-v5", env_type="gym", num_envs=2)
        >>> envs.reset().shape
        (2, 4, 84, 84)
        >>> observations, rewards, done, info = envs.step([1, 0])
        >>> envs.close()
    """

    metadata: dict[str, Any] = {"render.modes": ["rgb_array"], "render_modes": ["rgb_array"]}
    reward_range = (-math.inf, math.inf)
    is_vector_env = True

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        super().__init__(spec, render_env_id, render_mode)
        if "gym" in sys.modules:
            theirs, box, actions = sys.modules["gym"].spaces, self.single_observation_space, self.single_action_space
            assert isinstance(actions, spaces.Discrete)
            self.observation_space = self.single_observation_space = theirs.Box(0, 255, box.shape, box.dtype)
            self.action_space = self.single_action_space = theirs.Discrete(actions.n)

    @property
    def unwrapped(self) -> GymEnvPool:
        """These environments."""
        return self

    def reset(self, env_id: Any = None) -> Any:
        """Begins new games.

        Args:
            env_id: Indices of the environments. Default: all.

        Returns:
            Observations, uint8 of shape (n, channels, img_height, img_width).

        Raises:
            InvalidInput: If an index is wrong.
        """
        return self._reset(env_id)[0]

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Info]:
        """Steps some environments.

        Args:
            action: As in `send`.
            env_id: As in `send`.

        Returns:
            Observations, rewards (float32), done (bool), and info, which has "TimeLimit.truncated".

        Raises:
            IndexError: If an action is out of range.
            InvalidInput: If the shapes differ, or an index is wrong.
        """
        results: tuple[Any, Any, Any, Info] = self._step(action, env_id)
        return results

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        """Waits for environments that were sent.

        Args:
            reset: Whether to return what `reset` returns.
            return_info: Ignored, as in EnvPool.

        Returns:
            What `step` or `reset` returns.

        Raises:
            InvalidInput: If fewer than `batch_size` environments were sent.
        """
        results = self._format(self._receive())
        return results[0] if flag("reset", reset) else results

    def _format(self, results: Results) -> tuple[Any, Any, Any, Info]:
        observations, rewards, done, truncated, info = self._format_with_info(results)
        return observations, rewards, done, {**info, "TimeLimit.truncated": truncated}


class DMEnvPool(EnvPool):
    """Environments with the interface of dm_env, made by make(env_type="dm").

    They are a dm_env.Environment to a program that has imported dm_env.

    Args:
        spec: Spec of the task, as `make_spec` returns it.
        render_env_id: Index of the environment that `render` returns by default.
        render_mode: None or "rgb_array"; has no effect.

    Examples:
        >>> from racebeam import envpool
        >>> envs = envpool.make_dm("Beamfall-v5", num_envs=2)
        >>> envs.reset().first().tolist()
        [True, True]
        >>> envs.step([1, 0]).observation.obs.shape
        (2, 4, 84, 84)
        >>> envs.close()
    """

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        super().__init__(spec, render_env_id, render_mode)
        if "dm_env" in sys.modules:
            sys.modules["dm_env"].Environment.register(DMEnvPool)

    def reset(self, env_id: Any = None) -> TimeStep:
        """Begins new games.

        Args:
            env_id: Indices of the environments. Default: all.

        Returns:
            The first step.

        Raises:
            InvalidInput: If an index is wrong.
        """
        time_step: TimeStep = self._reset(env_id)
        return time_step

    def step(self, action: Any, env_id: Any = None) -> TimeStep:
        """Steps some environments.

        Args:
            action: As in `send`.
            env_id: As in `send`.

        Returns:
            The step.

        Raises:
            IndexError: If an action is out of range.
            InvalidInput: If the shapes differ, or an index is wrong.
        """
        time_step: TimeStep = self._step(action, env_id)
        return time_step

    def recv(self, reset: bool = False, return_info: bool = True) -> TimeStep:
        """Waits for environments that were sent.

        Args:
            reset: Ignored: `reset` and `step` return the same.
            return_info: Ignored, as in EnvPool.

        Returns:
            The step.

        Raises:
            InvalidInput: If fewer than `batch_size` environments were sent.
        """
        return self._format(self._receive())

    def reward_spec(self) -> Any:
        """Returns the spec of the rewards for dm_env."""
        return dm_specs().Array((), float, "reward")

    def discount_spec(self) -> Any:
        """Returns the spec of the discounts for dm_env."""
        return dm_specs().BoundedArray((), float, 0.0, 1.0, "discount")

    def _format(self, results: Results) -> TimeStep:
        arrays = self._name_results(results)
        info = {name: arrays[f"info:{name}"] for name in ("env_id", "lives", "reward", "terminated", "ram")}
        state = State(players=Players(arrays["info:players.env_id"]), obs=arrays["obs"], **info)
        return TimeStep(arrays["step_type"], arrays["reward"], arrays["discount"], state)
