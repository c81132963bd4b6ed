"""Playing a vector of environments: reset, step, and its halves send and recv."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, SupportsIndex, TypeAlias

import numpy as np
import numpy.typing as npt

from ..arguments import value_or
from ..errors import InvalidInput
from ..wire.halves import Halves
from .each import VectorOfEach
from .inputs import indices_of, joysticks_of, mask_of, seeds_of
from .machines import Actions, Joysticks
from .machines import Seeds as SeedArray
from .results import Bools, Info, Numbers, Pixels, Step

if TYPE_CHECKING:
    from .logs import VectorLogs

__all__ = ["PlayedVector", "Seeds"]

Seeds: TypeAlias = SupportsIndex | Sequence[SupportsIndex | None] | npt.NDArray[np.integer[Any]]


class PlayedVector(VectorOfEach):
    """Base class of vectors whose environments are reset and stepped.

    Examples:
        >>> import racebeam
        >>> envs = racebeam.AtariVectorEnv("beamfall", 2, seed=7)
        >>> envs.send([1, 0])
        >>> observations, rewards, *_ = envs.recv()
        >>> rewards.tolist()
        [0, 0]
        >>> envs.close()
    """

    _logs: VectorLogs | None = None

    @property
    def logged(self) -> int:
        """Number of games with a log. Without `log`, it is 0."""
        return 0 if self._logs is None else self._logs.logged

    @property
    def unlogged(self) -> int:
        """Number of games without a log, although `log` was given."""
        return 0 if self._logs is None else self._logs.unlogged

    def reset(
        self, *, seed: Seeds | None = None, options: dict[str, Any] | None = None, out: Pixels | None = None
    ) -> tuple[Any, Info]:
        """Begins new episodes.

        Steps that were sent and not received are played to their end, and their results are dropped. An exception that
        a signal handler raises, such as KeyboardInterrupt, ends a long call, as in `step`.

        Args:
            seed: Seed of the first environment, from which seeds count up; or one for each environment, where None and
                -1 mean unseeded. A seed powers the environment on anew. Without a seed, the generators continue; the
                first reset uses the seed of the constructor.
            options: May have "reset_mask", a bool array of shape (num_envs,) that chooses the environments to reset.
                The others are returned as they are. Needs `batch_size` equal to `num_envs`.
            out: Array for the images. Default: a new array.

        Returns:
            Observations, uint8 of shape (n, stack_num, img_height, img_width), with 3 as a further axis for colours, or
            of shape (n, 128) for the RAM; and the info. With `sound_obs`, observations are a dict of "image", these
            arrays, and "sound", uint8 of shape (n, 512).

        Raises:
            TypeError: If a seed or the mask has a wrong type.
            InvalidInput: If a seed, the mask or `out` has a wrong value or shape.
        """
        self._check_open()
        if not isinstance(options, (dict, type(None))):
            raise TypeError(f"options are {options!r}; they must be a dict")
        mask = self._parse_mask((options or {}).get("reset_mask"))
        seeds = self._parse_seeds(value_or(seed, self._first_seed), mask)
        results = self._allocate_results(out)
        if mask is not None and self.batch_size < self.num_envs:
            raise InvalidInput("reset_mask is given with batch_size < num_envs; it needs batch_size to be num_envs")
        self._drop_pending()
        self._first_seed = None
        if self._logs is not None:
            seeds = self._logs.seeds_of_reset(seeds, mask)
        if self.batch_size == self.num_envs:
            self._machines.reset(mask, seeds, results)
        else:
            self._machines.send_resets(seeds)
            self._machines.receive(results)
        if self._logs is not None and seeds is not None:
            self._logs.record_reset(seeds, mask)
        observations, *_, info = self._format_step(results)
        return observations, info

    def _drop_pending(self) -> None:
        """Receives what was sent and not received, and drops it."""
        pending = int(self._machines.playing())
        if pending == 0:
            return
        receive = self._machines.drop if isinstance(self._machines, Halves) else self._machines.receive
        receive(self._allocate_results(None, pending))

    def step(self, actions: npt.ArrayLike, *, out: Pixels | None = None) -> Step:
        """Steps the environments.

        An exception that a signal handler raises, such as KeyboardInterrupt, ends a long call. Then some environments
        may have made the step, and others not; `reset` or `restore` makes them agree. With `batch_size` below
        `num_envs`, the step goes on, and `recv` returns it.

        Args:
            actions: An action for each environment, or for each of those that the last call returned if `batch_size` is
                below `num_envs`. Integers of shape (n,), or numbers of shape (n, 3) if `continuous`: the radius from 0
                to 1, the angle in radians, and fire.
            out: Array for the images. Default: a new array.

        Returns:
            Observations as in `reset`, rewards (int32), terminated (bool), truncated (bool) and the info.

        Raises:
            TypeError: If the actions have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions or `out` have a wrong shape, or a number is not finite.
        """
        self._check_open()
        parsed: Any = self._parse_joysticks(actions) if self.continuous else self._parse_actions(actions)
        if self.batch_size < self.num_envs:
            self._send(parsed)
            return self.recv(out=out)
        results = self._allocate_results(out)
        self._first_seed = None
        if self.continuous:
            self._machines.step_joysticks(parsed, self.continuous_action_threshold, results)
        else:
            self._machines.step(parsed, results)
        if self._logs is not None:
            self._logs.record_step(parsed, results)
        return self._format_step(results)

    def send(self, actions: npt.ArrayLike) -> None:
        """Begins a step of the environments that the last call returned; `recv` returns its results.

        Args:
            actions: As in `step`.

        Raises:
            TypeError: If the actions have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions have a wrong shape, or the environments write logs.
        """
        self._check_open()
        if self._logs is not None:
            raise InvalidInput("send() does not write logs; with log, step() steps the environments")
        self._send(self._parse_joysticks(actions) if self.continuous else self._parse_actions(actions))

    def recv(self, *, out: Pixels | None = None) -> Step:
        """Waits for the first `batch_size` environments that finish their step.

        After KeyboardInterrupt, the next call returns these results.

        Args:
            out: Array for the images. Default: a new array.

        Returns:
            The same as `step`.

        Raises:
            InvalidInput: If fewer than `batch_size` environments were sent, or `out` has a wrong shape.
        """
        self._check_open()
        results = self._allocate_results(out)
        self._machines.receive(results)
        return self._format_step(results)

    def _send(self, actions: npt.NDArray[Any]) -> None:
        envs = self._last_received()
        self._first_seed = None
        if self.continuous:
            self._machines.send_joysticks(actions, self.continuous_action_threshold, envs)
        else:
            self._machines.send(actions, envs)

    def _last_received(self) -> Numbers:
        """Returns the environments that the last call returned. Before the first call, those are all."""
        if len(self._received_ids) != self.batch_size:
            raise InvalidInput("send() steps environments that reset() or recv() returned; call reset() first")
        return self._received_ids

    def show(self) -> tuple[Any, Info]:
        """Returns the present observations of all environments, such as after `restore`.

        Returns:
            The same as `reset`, for all environments.
        """
        self._check_open()
        results = self._allocate_results(None, self.num_envs)
        self._machines.show(results)
        results.rewards[:] = results.raw_rewards[:] = 0  # nothing was played
        return self._observations(results), self._make_info(results)

    # Seeds and actions

    def _parse_seeds(self, seed: Any, mask: Bools | None) -> SeedArray | None:
        """Returns one seed for each environment, also for those that are not in the mask."""
        return None if seed is None else seeds_of(seed, self.num_envs)

    def _parse_mask(self, mask: Any) -> Bools | None:
        return mask_of(mask, self.num_envs)

    def _parse_actions(self, actions: Any, count: int | None = None) -> Actions:
        """Converts actions of `count` environments. Default: of a batch."""
        return indices_of(actions, value_or(count, self.batch_size), self._machines.numbers_of_actions()[0])

    def _parse_joysticks(self, actions: Any) -> Joysticks:
        return joysticks_of(actions, self.batch_size)
