"""Paired tests: in how many games is one agent better than another, and better by more than chance?"""

import dataclasses
import itertools
import warnings

import numpy as np
import numpy.typing as npt
import pandas as pd
import scipy.stats

from .bootstrap import FEWEST_TRIALS
from .scores import Group, Scores

Sample = npt.NDArray[np.float64]

SIGNIFICANCE = 0.01  # 99 % confidence, two-tailed


@dataclasses.dataclass(frozen=True)
class Pair:
    """Two agents, compared in the games that both have played."""

    first: str
    second: str
    games: list[str]  # that both have played
    lacking: list[str]  # that only one has
    higher: list[str]  # in which the first has the higher mean
    lower: list[str]
    better: list[str]  # in which the first is significantly better
    worse: list[str]
    few: list[str]  # not tested: one has fewer than two trials
    constant: list[str]  # not tested: neither varies

    @property
    def tested(self) -> list[str]:
        """The games with a test."""
        return [game for game in self.games if game not in self.few and game not in self.constant]


def pairs(scores: Scores, group: Group) -> list[Pair]:
    """All pairs of the group's agents."""
    return [_pair(scores, *agents) for agents in itertools.combinations(group.agents, 2)]


def _pair(scores: Scores, first: str, second: str) -> Pair:
    both = scores.columns((first, second))
    games = list(both.dropna().index)
    means = both.loc[games]
    found: dict[str, list[str]] = {name: [] for name in ("better", "worse", "even", "few", "constant")}
    for game in games:
        found[verdict(scores.trial_scores(first, game), scores.trial_scores(second, game))].append(game)
    return Pair(
        first,
        second,
        games,
        lacking=list(both.index[both.isna().sum(axis=1) == 1]),
        higher=list(means.index[means[first] > means[second]]),
        lower=list(means.index[means[first] < means[second]]),
        better=found["better"],
        worse=found["worse"],
        few=found["few"],
        constant=found["constant"],
    )


def verdict(first: Sample, second: Sample) -> str:
    """What Welch's test says of the first, or why it cannot be made."""
    if min(len(first), len(second)) < FEWEST_TRIALS:
        return "few"
    if np.ptp(first) == 0 and np.ptp(second) == 0:
        return "constant"
    if welch(first, second) >= SIGNIFICANCE:
        return "even"
    return "better" if first.mean() > second.mean() else "worse"


def welch(first: Sample, second: Sample) -> float:
    """The two-tailed p-value of Welch's t-test. At least one sample varies."""
    with warnings.catch_warnings():
        # Of nearly equal values, whose p-value is right to fewer digits.
        warnings.simplefilter("ignore", RuntimeWarning)
        return float(scipy.stats.ttest_ind(first, second, equal_var=False).pvalue)


def counts(found: list[Pair], agents: tuple[str, ...], better: str, worse: str, of: str) -> pd.DataFrame:
    """The paper's table: in row A and column B, the number of games in which A is better than B, and worse.

    better, worse, of: names of lists of a Pair; without a game in the last one, the cell is "n/a"."""
    cells = pd.DataFrame("---", index=pd.Index(agents, name="agent"), columns=list(agents))
    for pair in found:
        more, less = len(getattr(pair, better)), len(getattr(pair, worse))
        is_defined = bool(getattr(pair, of))
        cells.loc[pair.first, pair.second] = f"{more}--{less}" if is_defined else "n/a"
        cells.loc[pair.second, pair.first] = f"{less}--{more}" if is_defined else "n/a"
    return cells.reset_index()


def times_best(scores: pd.DataFrame) -> tuple[pd.Series, dict[str, list[str]]]:
    """In how many games each column has the highest score, and the ties of each game that has some.

    As in the paper, only the first column of a tie counts."""
    matrix = scores.dropna()
    ties = {str(game): list(row.index[row == row.max()]) for game, row in matrix.iterrows()}
    best = matrix.idxmax(axis=1).value_counts().reindex(scores.columns, fill_value=0)
    return best, {game: tied for game, tied in ties.items() if len(tied) > 1}


def group_against(first: pd.DataFrame, second: pd.DataFrame) -> tuple[list[str], list[str], list[str]]:
    """The games in which the best of the first columns is above, equal to, and below the best of the second."""
    best = pd.concat([first.max(axis=1), second.max(axis=1)], axis=1).dropna()
    above, equal, below = best[0] > best[1], best[0] == best[1], best[0] < best[1]
    return list(best.index[above]), list(best.index[equal]), list(best.index[below])
