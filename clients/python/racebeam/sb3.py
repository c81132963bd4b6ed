"""Environments for Stable-Baselines3: VecEnv, in the place of make_atari_env() and VecFrameStack.

    from racebeam.sb3 import VecEnv
    model = stable_baselines3.PPO("CnnPolicy", VecEnv("breakout", 8, seed=1))

Importing this module needs Stable-Baselines3: pip install "racebeam[sb3]".
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode
from stable_baselines3.common import monitor, vec_env  # type: ignore[import-not-found,unused-ignore]

from .arguments import WrongValue
from .vector_env import AtariVectorEnv
from .vector_settings import autoreset_of

__all__ = ["VecEnv"]

USUAL: dict[str, Any] = {"autoreset_mode": "SameStep", "start": "baselines", "lives": "end"}


def _check(settings: dict[str, Any]) -> None:
    """Raises WrongValue or WrongType for what AtariVectorEnv takes and VecEnv does not."""
    mode = settings.get("autoreset_mode", AutoresetMode.SAME_STEP)
    if autoreset_of(mode) is not AutoresetMode.SAME_STEP:
        raise WrongValue(f"autoreset_mode is {mode!r}; VecEnv takes SameStep")
    if settings.get("lives") == "told":
        raise WrongValue(
            "lives is 'told', with which an episode goes on after a step that is done; VecEnv takes ignored, "
            "end, restart"
        )
    if settings.get("batch_size"):
        raise WrongValue(f"batch_size is {settings['batch_size']!r}; VecEnv takes 0, for all environments")


class VecEnv(vec_env.VecEnv):  # type: ignore[misc,unused-ignore]
    """AtariVectorEnv as a VecEnv, with the preprocessing of AtariWrapper and VecFrameStack.

    settings: those of AtariVectorEnv, but for batch_size; autoreset_mode is SAME_STEP, and lives="told" is not taken,
    since an episode ends where a step is done. Observations are stack x height x width. A lost life ends an episode, and the
    game goes on. infos have "lives", and where an episode ends "terminal_observation" and "TimeLimit.truncated". Where the
    game ends they have "episode": the sum of the rewards as the game gives them, its frames, and the seconds. That is also
    where it ends in the frames before the next life is played.

    For the same seeds, rewards, ends and lives are those of make_atari_env() over AtariEnv, where noop_max is 0 and no
    action is sticky: the numbers are drawn otherwise here. A pixel is the brighter of two frames in grey, and there in
    each colour, so that some differ.
    """

    def __init__(
        self, game: str | Sequence[str], num_envs: int | None = None, *, seed: int | None = None, **settings: Any
    ) -> None:
        _check(settings)
        self._envs = AtariVectorEnv(game, num_envs, seed=seed, **{**USUAL, **settings})
        self._restarts = settings.get("lives") == "restart"  # each episode is a game
        self._began = time.time()
        self._actions: Any = None
        count = self._envs.num_envs
        self._returns = np.zeros(count, np.int64)
        super().__init__(count, self._envs.single_observation_space, self._envs.single_action_space)

    def reset(self) -> npt.NDArray[np.uint8]:
        seeds = None if all(seed is None for seed in self._seeds) else self._seeds
        observations, info = self._envs.reset(seed=seeds)
        self._reset_seeds()
        self._reset_options()
        self._returns[:] = 0
        self.reset_infos = [{"lives": int(lives)} for lives in info["lives"]]
        seen: npt.NDArray[np.uint8] = observations
        return seen

    def step_async(self, actions: Any) -> None:
        self._actions = actions

    def step_wait(self) -> tuple[Any, npt.NDArray[np.float32], npt.NDArray[np.bool_], list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, info = self._envs.step(self._actions)
        self._returns += info["raw_reward"]
        infos: list[dict[str, Any]] = [{"lives": lives} for lives in info["lives"].tolist()]
        done = terminated | truncated
        for env in np.flatnonzero(done):
            self.reset_infos[env] = infos[env]
            infos[env] = self._end_of(int(env), info, bool(truncated[env]))
        return observations, rewards.astype(np.float32), done, infos

    def _end_of(self, env: int, info: dict[str, Any], is_truncated: bool) -> dict[str, Any]:
        final = info["final_info"]
        told = {
            "lives": int(final["lives"][env]),
            "terminal_observation": info["final_obs"][env],
            "TimeLimit.truncated": is_truncated,
        }
        frames = int(final["episode_frame_number"][env])
        # The game may end in the frames before the next life is played, too, and with a lost life at the limit of frames.
        is_next_game = (
            self._restarts
            or is_truncated
            or info["game_over"][env]
            or info["lives"][env] > told["lives"]
            or info["episode_frame_number"][env] < frames
        )
        if is_next_game:
            told["episode"] = {"r": float(self._returns[env]), "l": frames, "t": round(time.time() - self._began, 6)}
            self._returns[env] = 0
        return told

    def close(self) -> None:
        self._envs.close()

    def get_images(self) -> list[npt.NDArray[np.uint8] | None]:
        return list(self._envs.render() or [])

    # What wrappers and callbacks ask of each environment

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self._envs, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Of all environments, whose attributes are the same."""
        setattr(self._envs, attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Methods that take the number of an environment, such as save()."""
        method = getattr(self._envs, method_name)
        return [method(env, *method_args, **method_kwargs) for env in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """Whether the infos have what a Monitor adds."""
        return [wrapper_class is monitor.Monitor for _ in self._get_indices(indices)]
