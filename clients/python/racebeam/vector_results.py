"""What many environments show after a call, in arrays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Bools", "Numbers", "Pixels", "Results"]

Pixels = npt.NDArray[np.uint8]
Numbers = npt.NDArray[np.int32]
Bools = npt.NDArray[np.bool_]


class Results(NamedTuple):
    """Memory that a call fills. Rows of numbers and flags have a value for each environment; the properties name them."""

    observations: Pixels | None  # None: not wanted
    ram: Pixels | None
    numbers: Numbers
    flags: Bools
    final_observations: Pixels | None  # with SAME_STEP, of the episodes that have ended
    final_numbers: Numbers | None  # lives, frames, episode_frames
    played: Numbers | None = None  # elapsed: frames of play in this game; acts: none in a reset; lives_lost: by them

    @property
    def rewards(self) -> Any:
        return self.numbers[0]

    @property
    def raw_rewards(self) -> Any:
        """Before they were clipped."""
        return self.numbers[1]

    @property
    def lives(self) -> Any:
        return self.numbers[2]

    @property
    def frames(self) -> Any:
        return self.numbers[3]

    @property
    def episode_frames(self) -> Any:
        return self.numbers[4]

    @property
    def env_id(self) -> Any:
        return self.numbers[5]

    @property
    def terminated(self) -> Any:
        return self.flags[0]

    @property
    def truncated(self) -> Any:
        return self.flags[1]

    @property
    def finished(self) -> Any:
        """With SAME_STEP: the episode is over."""
        return self.flags[2]

    @property
    def game_over(self) -> Any:
        """Whatever lives and limits say."""
        return self.flags[3]

    def of(self, envs: slice) -> Results:
        """The memory of some environments."""

        def some(array: Any, axis: int = 0) -> Any:
            return None if array is None else array[(slice(None),) * axis + (envs,)]

        return Results(
            some(self.observations),
            some(self.ram),
            some(self.numbers, 1),
            some(self.flags, 1),
            some(self.final_observations),
            some(self.final_numbers, 1),
            some(self.played, 1),
        )

    @classmethod
    def around(
        cls, observations: Pixels | None, ram: Pixels | None, envs: int, final_observations: Pixels | None
    ) -> Results:
        """With new numbers and flags."""
        final_numbers = None if final_observations is None else np.empty((3, envs), np.int32)
        return cls(
            observations,
            ram,
            np.empty((6, envs), np.int32),
            np.empty((4, envs), np.bool_),
            final_observations,
            final_numbers,
        )
