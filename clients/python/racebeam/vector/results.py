"""The arrays that a call of a vector of environments fills."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = ["Bools", "Info", "Numbers", "Pixels", "Results", "Step"]

Pixels = npt.NDArray[np.uint8]
Numbers = npt.NDArray[np.int32]
Bools = npt.NDArray[np.bool_]
Info: TypeAlias = dict[str, Any]
# Observations, rewards, terminated, truncated and info. With `sound_obs`, observations are a dict of arrays.
Step: TypeAlias = tuple[Any, Numbers, Bools, Bools, Info]


class Results(NamedTuple):
    """Memory for the results of `n` environments. The properties name the rows of `numbers` and `flags`.

    Attributes:
        observations: uint8 array of shape (n, ...), or None if screens are not observed.
        ram: uint8 array of shape (n, 128), or None if the RAM is not observed.
        numbers: int32 array of shape (6, n).
        flags: bool array of shape (4, n).
        final_observations: With SAME_STEP, the last observations of the episodes that ended; else None.
        final_numbers: With SAME_STEP, int32 array of shape (3, n): their lives, frames and frames of the episode.
        counts: int32 array of shape (3, n), or None: frames that were played in this game, acts of this step (0 in a
            reset), and lives that these acts lost.
        sound: uint8 array of shape (n, 512), or None if the sound is not observed.
        final_sound: With SAME_STEP, the sound at the ends of episodes; else None.
    """

    observations: Pixels | None
    ram: Pixels | None
    numbers: Numbers
    flags: Bools
    final_observations: Pixels | None
    final_numbers: Numbers | None
    counts: Numbers | None = None
    sound: Pixels | None = None
    final_sound: Pixels | None = None

    @property
    def rewards(self) -> Numbers:
        """Rewards of the step, clipped if the options say so."""
        row: Numbers = self.numbers[0]
        return row

    @property
    def raw_rewards(self) -> Numbers:
        """Rewards of the step before clipping."""
        row: Numbers = self.numbers[1]
        return row

    @property
    def lives(self) -> Numbers:
        """Lives that are left."""
        row: Numbers = self.numbers[2]
        return row

    @property
    def frames(self) -> Numbers:
        """Frames since power-on."""
        row: Numbers = self.numbers[3]
        return row

    @property
    def episode_frames(self) -> Numbers:
        """Frames since the episode began."""
        row: Numbers = self.numbers[4]
        return row

    @property
    def env_id(self) -> Numbers:
        """Index of the environment that each column belongs to."""
        row: Numbers = self.numbers[5]
        return row

    @property
    def terminated(self) -> Bools:
        """Whether the episode was terminated."""
        row: Bools = self.flags[0]
        return row

    @property
    def truncated(self) -> Bools:
        """Whether the episode was truncated."""
        row: Bools = self.flags[1]
        return row

    @property
    def finished(self) -> Bools:
        """Whether an episode ended in this step and the next one has begun; only with SAME_STEP."""
        row: Bools = self.flags[2]
        return row

    @property
    def game_over(self) -> Bools:
        """Whether the game is over, regardless of lives and time limits."""
        row: Bools = self.flags[3]
        return row

    def select(self, envs: slice) -> Results:
        """Returns views of the columns of some environments.

        Args:
            envs: Which environments.

        Returns:
            Results that share their memory with these.
        """

        def view(array: Any, axis: int = 0) -> Any:
            return None if array is None else array[(slice(None),) * axis + (envs,)]

        return Results(
            view(self.observations),
            view(self.ram),
            view(self.numbers, 1),
            view(self.flags, 1),
            view(self.final_observations),
            view(self.final_numbers, 1),
            view(self.counts, 1),
            view(self.sound),
            view(self.final_sound),
        )

    @classmethod
    def allocate(
        cls, observations: Pixels | None, ram: Pixels | None, count: int, final_observations: Pixels | None
    ) -> Results:
        """Allocates numbers and flags beside the given arrays of observations.

        Args:
            observations: Array for screens, or None.
            ram: Array for the RAM, or None.
            count: Number of environments.
            final_observations: Array for the observations at the ends of episodes, or None.

        Returns:
            Results whose numbers and flags are uninitialised.
        """
        final_numbers = None if final_observations is None else np.empty((3, count), np.int32)
        return cls(
            observations,
            ram,
            np.empty((6, count), np.int32),
            np.empty((4, count), np.bool_),
            final_observations,
            final_numbers,
        )
