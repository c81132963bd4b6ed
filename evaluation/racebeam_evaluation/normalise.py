"""Normalised scores: (score - low) / (high - low), with a score range [low, high] for each game."""

import dataclasses

import pandas as pd

from .games import HUMAN
from .scores import BASELINES, Group, Scores


@dataclasses.dataclass(frozen=True)
class Ranges:
    """The score range of each game. A range that is not known is NaN."""

    name: str
    low: pd.Series  # a score for each game
    high: pd.Series  # the same
    notes: tuple[str, ...] = ()
    bounded: bool = False  # all normalised scores are from 0 to 1

    def normalise(self, scores: pd.DataFrame) -> pd.DataFrame:
        """The scores, a row for each game, normalised. NaN where the range is missing or empty."""
        low, span = self.low.reindex(scores.index), self.span.reindex(scores.index)
        return scores.sub(low, axis=0).div(span, axis=0)

    @property
    def span(self) -> pd.Series:
        """high - low; NaN where it is 0."""
        span = self.high - self.low
        return span.where(span != 0)

    def without(self, games: list[str]) -> list[str]:
        """The games that have no range, or an empty one."""
        names = self.span.dropna().index
        return [game for game in games if game not in names]


def all_ranges(scores: Scores, group: Group) -> list[Ranges]:
    """Returns the four normalisations of a group, except those without any range."""
    ranges = [_random(scores), _baseline(scores), _inter_algorithm(scores, group), human(scores.other_rewards)]
    return [each for each in ranges if len(each.without(list(scores.means.index))) < len(scores.means.index)]


def human_and_random(scores: Scores) -> list[Ranges]:
    """Returns the two normalisations that do not depend on a group, except those without any range."""
    return [each for each in (human(scores.other_rewards), _random(scores)) if len(each.span.dropna())]


def _random(scores: Scores) -> Ranges:
    """Ranges from 0 to the absolute value of the mean score of random play."""
    high = (
        scores.views["random"].abs() if "random" in scores.views else pd.Series(index=scores.means.index, dtype=float)
    )
    return Ranges("random", high * 0, high)


def _baseline(scores: Scores) -> Ranges:
    """Ranges from the lowest to the highest score of the references, which should be all 37 baselines."""
    counts = scores.references.notna().sum(axis=1)
    fewer = sorted(set(counts[(counts > 0) & (counts < BASELINES)]))
    notes = [
        f"Baseline scores: {_games(int((counts == count).sum()))} {count} of the {BASELINES} references."
        for count in fewer
    ]
    return Ranges("baseline", scores.references.min(axis=1), scores.references.max(axis=1), tuple(notes))


def _games(count: int) -> str:
    return "1 game has" if count == 1 else f"{count} games have"


def _inter_algorithm(scores: Scores, group: Group) -> Ranges:
    """Ranges from the lowest to the highest score of the group, in the games that all its agents have played."""
    matrix = scores.columns(group.agents).dropna()
    return Ranges("inter-algorithm", matrix.min(axis=1), matrix.max(axis=1), bounded=True)


def human(without: tuple[str, ...] = ()) -> Ranges:
    """Ranges from published scores of random play to those of a human tester, in 57 games except those of `without`."""
    comparable = HUMAN.drop(index=list(without))
    return Ranges("human", comparable["random"], comparable["human"])
