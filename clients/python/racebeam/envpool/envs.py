"""AtariVectorEnv with the settings of EnvPool, of which any environments are sent and received."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..arguments import MOST
from ..errors import InvalidInput
from ..vector_env import AtariVectorEnv, array_of
from ..vector_results import Numbers, Pixels, Results
from .spec import EnvSpec

__all__ = ["ROWS", "Envs", "Shown", "parts_of"]

ROWS = 210  # EnvPool sees no more, of games that have them, too


class Shown(NamedTuple):
    """What environments show: arrays of NumPy, or of JAX in a compiled program."""

    observations: Any
    ram: Any
    rewards: Any
    raw_rewards: Any
    terminated: Any
    truncated: Any
    game_over: Any
    env_id: Any
    lives: Any
    elapsed: Any  # frames of play in this game
    acts: Any  # 0: a reset
    lives_lost: Any


class Envs(AtariVectorEnv):
    """The first step of an environment is its reset. Without batch_size, results are in the order in which environments were sent."""

    def __init__(self, spec: EnvSpec) -> None:
        config = spec.config
        super().__init__(
            config.task,
            config.num_envs,
            batch_size=config.batch_size,
            num_threads=config.num_threads,
            thread_affinity_offset=config.thread_affinity_offset,
            stack_num=config.stack_num,
            max_num_frames_per_episode=min(config.max_episode_steps * config.frame_skip, MOST),
            frameskip=config.frame_skip,
            noop_max=config.noop_max,
            use_fire_reset=config.use_fire_reset,
            reward_clipping=config.reward_clip,
            img_height=config.img_height,
            img_width=config.img_width,
            grayscale=config.gray_scale,
            mode=_optional(config.mode),
            difficulty=_optional(config.difficulty),
            full_action_space=config.full_action_space,
            repeat_action_probability=config.repeat_action_probability,
            lives="end" if config.episodic_life else "ignored",
            start="noops-fire",
            stack_start="repeats",
            render_mode="rgb_array",
        )
        self.every: Numbers = np.arange(config.num_envs, dtype=np.int32)
        self._machines.end_episodes(self.every, spec.seeds)

    def _settings(self, arguments: dict[str, Any], num_envs: int) -> dict[str, Any]:
        return {**super()._settings(arguments, num_envs), "rows": ROWS}

    @property
    def received(self) -> Numbers:
        """The environments of the last results. Raises InvalidInput before them."""
        return self._ready()

    def send_resets_of(self, envs: Numbers) -> None:
        """Begins new games. Where those are of all environments, what was sent and not received is dropped."""
        self._check_open()
        if len(envs) == self.num_envs:
            self._drop_pending()
        self._machines.end_episodes(envs)
        self._machines.send(np.zeros(len(envs), np.int64), envs)

    def send_to(self, envs: Numbers, actions: Any) -> None:
        """Begins a step of these environments."""
        self._check_open()
        self._machines.send(self._indices(actions, len(envs)), envs)

    def step_every(self, actions: Any) -> Shown:
        """Of all environments. The same as send_to() and receive(), and faster."""
        self._check_open()
        results = self._room(None)
        self._machines.step(self._indices(actions), results)
        return self._told(results)

    def receive(self) -> Shown:
        """The first batch_size that finish; without batch_size, all that were sent."""
        self._check_open()
        is_sync = self.batch_size == self.num_envs
        results = self._room(None, self._machines.playing() if is_sync else self.batch_size)
        self._machines.receive(results)
        return self._told(results)

    def _room(self, out: Pixels | None, envs: int | None = None) -> Results:
        count = self.batch_size if envs is None else envs
        return (
            super()
            ._room(out, count)
            ._replace(ram=np.empty((count, 128), np.uint8), played=np.empty((3, count), np.int32))
        )

    def _told(self, results: Results) -> Shown:
        self._received = results.env_id.copy()
        assert results.played is not None
        return Shown(
            results.observations,
            results.ram,
            results.rewards,
            results.raw_rewards,
            results.terminated,
            results.truncated,
            results.game_over,
            results.env_id,
            results.lives,
            *results.played,
        )

    def chosen(self, mask: Any) -> Numbers:
        """The environments of a mask, of one or more; None: all."""
        if mask is None:
            return self.every
        array = array_of(mask)
        if array.shape != self.every.shape or array.dtype.kind not in "biuf":
            raise InvalidInput(f"reset_mask is {mask!r}; it takes {self.num_envs} values that are true or false")
        if not array.any():
            raise InvalidInput(f"reset_mask is {mask!r}; it takes one environment or more")
        return self.every[array.astype(np.bool_)]

    def _indices(self, actions: Any, count: int | None = None) -> npt.NDArray[np.int64]:
        """A fraction is cut off, and a flag is 0 or 1."""
        array = array_of(actions)
        if array.dtype.kind not in "bf":
            return super()._indices(array, count)
        if (far := array[~(np.abs(array) <= MOST)]).size:
            most = self._machines.numbers_of_actions()[0] - 1
            raise IndexError(f"action {far[0]} is out of range; there are 0 to {most}")
        return super()._indices(array.astype(np.int64), count)

    def numbers_of(self, env_id: Any) -> Numbers:
        """Of environments, checked."""
        try:
            ids = np.atleast_1d(env_id)
        except ValueError:  # of rows of several lengths
            ids = np.empty((0, 0))
        if ids.ndim != 1 or (ids.dtype.kind not in "iu" and ids.size) or not np.isin(ids, self.every).all():
            raise InvalidInput(
                f"env_id is {env_id!r}; it takes whole numbers from 0 to {self.num_envs - 1}, in one row"
            )
        if len(np.unique(ids)) < len(ids):
            raise InvalidInput(f"env_id is {env_id!r}; each environment is named once")
        return np.ascontiguousarray(ids, np.int32)


def parts_of(action: dict[str, Any]) -> dict[str, Any]:
    """By name: {"players": {"env_id": ids}} has the part players.env_id. Raises InvalidInput if `action` is missing."""
    parts: dict[str, Any] = {}
    for name, part in action.items():
        parts |= {f"{name}.{key}": value for key, value in part.items()} if isinstance(part, dict) else {name: part}
    if "action" not in parts:
        raise InvalidInput(f"the parts of the action are {', '.join(map(str, parts))}; one must be 'action'")
    return parts


def _optional(number: int) -> int | None:
    return None if number == -1 else number
