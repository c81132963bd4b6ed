"""The actions of an episode in progress, as many as its log can have."""

from __future__ import annotations

__all__ = ["MOST_ACTS", "MOST_TURNS", "Played"]

MOST_ACTS = 2_000_000  # recording/episode_log.hpp, kMaxDecisions: with them, a log has at most two MiB
MOST_TURNS = 400_000  # kMaxTurns: the same, if strengths differ from 1


class Played:
    """The actions of an episode, with their strengths. One that has too many forgets them.

    Attributes:
        actions: Numbers of the actions.
        strengths: For each action, how far a paddle was turned.
        is_forgotten: Whether the actions are forgotten, so that the episode gets no log.

    Examples:
        >>> from racebeam.single.played import Played
        >>> played = Played()
        >>> played.add(3, 1.0)
        >>> played.actions
        [3]
    """

    def __init__(self) -> None:
        self.actions: list[int] = []
        self.strengths: list[float] = []
        self.is_forgotten = False
        self._turns = False

    def add(self, action: int, strength: float) -> str | None:
        """Adds an action, unless the actions are forgotten.

        Args:
            action: Number of the action.
            strength: How far a paddle is turned.

        Returns:
            Why the actions have just been forgotten, or None.
        """
        if self.is_forgotten:
            return None
        self._turns |= strength != 1
        most = MOST_TURNS if self._turns else MOST_ACTS
        if len(self.actions) >= most:
            self.actions, self.strengths, self.is_forgotten = [], [], True
            return f"it has more than {most} acts{' with strengths' if self._turns else ''}"
        self.actions.append(action)
        self.strengths.append(strength)
        return None
