"""ALEVectorInterface of ale_py: many environments of one game, whose calls take and return lists and arrays."""

from __future__ import annotations

import operator
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core, xla
from ..errors import InvalidInput
from .interface import plain_errors

if TYPE_CHECKING:
    from .vectors import AtariVectorEnv

__all__ = ["ALEVectorInterface"]


class ALEVectorInterface:
    """The arguments are those of AtariVectorEnv, but for rom_path, an image. max_episode_steps counts frames, as ale_py's does.

    Raises ValueError; IndexError for an environment or an action that is not there.
    """

    def __init__(
        self,
        rom_path: str | os.PathLike[str],
        num_envs: int,
        frame_skip: int = 4,
        stack_num: int = 4,
        img_height: int = 84,
        img_width: int = 84,
        grayscale: bool = True,
        maxpool: bool = True,
        noop_max: int = 30,
        use_fire_reset: bool = True,
        episodic_life: bool = False,
        life_loss_info: bool = False,
        reward_clipping: bool = True,
        max_episode_steps: int = 108000,
        repeat_action_probability: float = 0.0,
        full_action_space: bool = False,
        batch_size: int = 0,
        num_threads: int = 0,
        thread_affinity_offset: int = -1,
        autoreset_mode: str = "NextStep",
    ) -> None:
        from .vectors import AtariVectorEnv

        md5, game = _core.identify(rom_path)
        if game is None:
            raise InvalidInput(f"image {os.fspath(rom_path)} has the MD5 {md5}, which is of no known game")
        self._use(
            AtariVectorEnv(
                game,
                num_envs,
                rom=rom_path,
                frameskip=frame_skip,
                stack_num=stack_num,
                img_height=img_height,
                img_width=img_width,
                grayscale=grayscale,
                maxpool=maxpool,
                noop_max=noop_max,
                use_fire_reset=use_fire_reset,
                episodic_life=episodic_life,
                life_loss_info=life_loss_info,
                reward_clipping=reward_clipping,
                max_num_frames_per_episode=max_episode_steps,
                repeat_action_probability=repeat_action_probability,
                full_action_space=full_action_space,
                batch_size=batch_size,
                num_threads=num_threads,
                thread_affinity_offset=thread_affinity_offset,
                autoreset_mode=autoreset_mode,
            )
        )

    def _use(self, envs: AtariVectorEnv) -> None:
        self._envs = envs

    @classmethod
    def of(cls, envs: AtariVectorEnv) -> ALEVectorInterface:
        """The interface of environments that are there."""
        interface = cls.__new__(cls)
        interface._use(envs)
        return interface

    def reset(self, env_ids: Sequence[int], seeds: Sequence[int], /) -> tuple[Any, dict[str, Any]]:
        """New episodes of these environments; a seed of -1 is none. Returns what all of them show, or the first batch_size."""
        count, ids = self._envs.num_envs, [operator.index(env) for env in env_ids]
        if len(ids) != len(seeds):
            raise ValueError(f"there are {len(seeds)} seeds for {len(ids)} environments")
        for env in ids:
            if not 0 <= env < count:
                raise IndexError(f"environment {env} is out of range; there are 0 to {count - 1}")
        if len(set(ids)) < len(ids):
            raise ValueError(f"there is a duplicate env_id in {ids}; each is reset once")
        every = np.full(count, -1, np.int64)
        every[ids] = [operator.index(seed) for seed in seeds]
        chosen = np.isin(np.arange(count), ids)
        return self._envs.reset(seed=every[chosen], options=None if chosen.all() else {"reset_mask": chosen})

    def send(self, action_ids: Sequence[int], paddle_strengths: Sequence[float], /) -> None:
        """Begins a step of the environments that were received last. An action is a place in get_action_set()."""
        plain_errors(self._envs.send_strengths, ValueError)(action_ids, paddle_strengths)

    def recv(self) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """What those show that have finished: observations, rewards, terminated, truncated and the info."""
        return self._envs.recv()

    def get_action_set(self) -> list[_core.Action]:
        return [_core.Action(number) for number in self._envs.action_numbers()]

    def get_num_envs(self) -> int:
        return self._envs.num_envs

    def get_observation_shape(self) -> tuple[int, ...]:
        """Of one environment."""
        return self._envs.single_observation_space.shape or ()

    def handle(self) -> npt.NDArray[np.uint8]:
        """Names the environments in custom calls of XLA."""
        return xla.handle_of(self._envs)
