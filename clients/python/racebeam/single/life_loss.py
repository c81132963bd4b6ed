"""The effect of a lost life on an episode of a single game."""

from __future__ import annotations

from typing import Any

LIFE_LOSSES = ("ignored", "reported", "end", "restart")


class LifeLoss:
    """Decides which steps are terminated by a lost life.

    The interface ends an episode at a lost life only by its key `truncate_on_loss_of_life`, which "restart" uses.

    Args:
        word: One of `LIFE_LOSSES`.

    Attributes:
        continues: Whether the next episode continues the game.
    """

    def __init__(self, word: str) -> None:
        self.word = word
        self.continues = False

    def lives_before(self, ale: Any) -> int:
        """Counts the lives before a step.

        Args:
            ale: Interface of the game.

        Returns:
            The lives that are left, or 0 if a lost life has no effect.
        """
        return int(ale.lives()) if self.word in ("reported", "end") else 0

    def ends(self, ale: Any, ends: tuple[bool, bool], before: int, lives: int, episode_frame: int) -> tuple[bool, bool]:
        """Returns whether a step is terminated and truncated.

        Args:
            ale: Interface of the game.
            ends: The same without lost lives; with "restart", a lost life truncates.
            before: Lives before the step.
            lives: Lives after the step.
            episode_frame: Frames since the game began.
        """
        terminated, truncated = ends
        if self.word == "restart" and truncated:
            limit = ale.getInt("max_num_frames_per_episode")
            is_long = 0 < limit <= episode_frame
            return terminated or not is_long, is_long
        is_lost = 0 < lives < before
        self.continues = self.word == "end" and is_lost and not any(ends)
        return terminated or is_lost, truncated
