"""AtariVectorEnv with the settings of EnvPool. Any of its environments can be sent and received."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arguments import MOST
from ..errors import InvalidInput
from ..vector.inputs import array_of
from ..vector.machines import Actions
from ..vector.making import make_local_machines
from ..vector.results import Numbers, Pixels
from ..vector.results import Results as VectorResults
from ..vector_env import AtariVectorEnv
from ..vector_options import VectorOptions
from .spec import EnvSpec
from .types import Results

__all__ = ["ROWS", "Envs", "parts_of"]

ROWS = 210  # EnvPool observes the first 210 rows of screens that have more


class Envs(AtariVectorEnv):
    """A vector of environments with the semantics of EnvPool.

    The first step of an environment is its reset. With `batch_size` equal to `num_envs`, results have the order in
    which environments were sent.

    Args:
        spec: Spec of the task.

    Examples:
        >>> from racebeam.envpool import make_spec
        >>> from racebeam.envpool.envs import Envs
        >>> envs = Envs(make_spec("Beamfall-v5", num_envs=3))
        >>> envs.send_resets_of(envs.every[:2])
        >>> envs.receive().env_id.tolist()
        [0, 1]
        >>> envs.close()
    """

    def __init__(self, spec: EnvSpec) -> None:
        config = spec.config
        options = VectorOptions(
            num_envs=config.num_envs,
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
            life_loss="end" if config.episodic_life else "ignored",
            start="noops-fire",
            stack_start="repeats",
            render_mode="rgb_array",
            rows=ROWS,
        )
        game_of_env = np.zeros(config.num_envs, np.int32)
        machines = make_local_machines([config.task], game_of_env, None, options)
        self._use(machines, [config.task], game_of_env, options)
        self.every: Numbers = np.arange(config.num_envs, dtype=np.int32)
        self._machines.end_episodes(self.every, spec.seeds)

    @property
    def received(self) -> Numbers:
        """Environments of the last results. Raises InvalidInput before the first results."""
        return self._last_received()

    def send_resets_of(self, envs: Numbers) -> None:
        """Begins new games. If they are those of all environments, what was sent and not received is dropped.

        Args:
            envs: int32 array with indices of environments.
        """
        self._check_open()
        if len(envs) == self.num_envs:
            self._drop_pending()
        self._machines.end_episodes(envs)
        self._machines.send(np.zeros(len(envs), np.int64), envs)

    def send_to(self, envs: Numbers, actions: Any) -> None:
        """Begins a step of some environments.

        Args:
            envs: int32 array with indices of environments.
            actions: An action for each of them.
        """
        self._check_open()
        self._machines.send(self._parse_actions(actions, len(envs)), envs)

    def step_every(self, actions: Any) -> Results:
        """Steps all environments. Does the same as `send_to` and `receive`, but faster.

        Args:
            actions: An action for each environment.

        Returns:
            Results of all environments.
        """
        self._check_open()
        results = self._allocate_results(None)
        self._machines.step(self._parse_actions(actions), results)
        return self._convert(results)

    def receive(self) -> Results:
        """Waits for environments.

        Returns:
            Results of the first `batch_size` environments that finish; if that is `num_envs`, of all that were sent.
        """
        self._check_open()
        is_sync = self.batch_size == self.num_envs
        results = self._allocate_results(None, self._machines.playing() if is_sync else self.batch_size)
        self._machines.receive(results)
        return self._convert(results)

    def _allocate_results(self, out: Pixels | None, count: int | None = None) -> VectorResults:
        size = self.batch_size if count is None else count
        results = super()._allocate_results(out, size)
        return results._replace(ram=np.empty((size, 128), np.uint8), counts=np.empty((3, size), np.int32))

    def _convert(self, results: VectorResults) -> Results:
        self._received_ids = results.env_id.copy()
        assert results.counts is not None
        return Results(
            results.observations,
            results.ram,
            results.rewards,
            results.raw_rewards,
            results.terminated,
            results.truncated,
            results.game_over,
            results.env_id,
            results.lives,
            *results.counts,
        )

    def select(self, mask: Any) -> Numbers:
        """Converts a reset mask to indices.

        Args:
            mask: A value for each environment that is true or false, at least one of them true; or None for all.

        Returns:
            int32 array with the indices of the chosen environments.

        Raises:
            InvalidInput: If `mask` has another shape or type, or chooses no environment.
        """
        if mask is None:
            return self.every
        array = array_of(mask)
        if array.shape != self.every.shape or array.dtype.kind not in "biuf":
            raise InvalidInput(f"reset_mask is {mask!r}; it takes {self.num_envs} values that are true or false")
        if not array.any():
            raise InvalidInput(f"reset_mask is {mask!r}; it takes one environment or more")
        return self.every[array.astype(np.bool_)]

    def _parse_actions(self, actions: Any, count: int | None = None) -> Actions:
        """Converts actions as EnvPool does: cuts fractions off, and takes flags as 0 and 1."""
        array = array_of(actions)
        if array.dtype.kind not in "bf":
            return super()._parse_actions(array, count)
        if (far := array[~(np.abs(array) <= MOST)]).size:
            highest = self._machines.numbers_of_actions()[0] - 1
            raise IndexError(f"action {far[0]} is out of range; accepted: 0 to {highest}")
        return super()._parse_actions(array.astype(np.int64), count)

    def parse_env_id(self, env_id: Any) -> Numbers:
        """Checks indices of environments.

        Args:
            env_id: One index or a sequence of indices, each once.

        Returns:
            int32 array with the indices.

        Raises:
            InvalidInput: If an index is not that of an environment, or occurs twice.
        """
        try:
            ids = np.atleast_1d(env_id)
        except ValueError:  # rows of different lengths
            ids = np.empty((0, 0))
        if ids.ndim != 1 or (ids.dtype.kind not in "iu" and ids.size) or not np.isin(ids, self.every).all():
            raise InvalidInput(
                f"env_id is {env_id!r}; it takes whole numbers from 0 to {self.num_envs - 1}, in one row"
            )
        if len(np.unique(ids)) < len(ids):
            raise InvalidInput(f"env_id is {env_id!r}; each index may occur once")
        return np.ascontiguousarray(ids, np.int32)


def parts_of(action: dict[str, Any]) -> dict[str, Any]:
    """Flattens an action that is a dictionary.

    Args:
        action: Parts by name, such as {"action": actions, "players": {"env_id": ids}}.

    Returns:
        The parts with dotted names, such as "players.env_id".

    Raises:
        InvalidInput: If the part "action" is missing.
    """
    parts: dict[str, Any] = {}
    for name, part in action.items():
        parts |= {f"{name}.{key}": value for key, value in part.items()} if isinstance(part, dict) else {name: part}
    if "action" not in parts:
        raise InvalidInput(f"the action has the parts {', '.join(map(str, parts))}; it needs the part 'action'")
    return parts


def _optional(number: int) -> int | None:
    return None if number == -1 else number
