"""Scores of all games made one number for each agent: averages, medians, rliable's aggregates, distributions."""

import numpy as np
import pandas as pd

from .bootstrap import (
    AGGREGATES,
    FEWEST_TRIALS,
    Bootstrap,
    Estimate,
    Matrix,
    aggregates,
    improvement,
    padded,
    profile,
    trials_of,
)
from .games import sets
from .normalise import Ranges
from .scores import Group, Scores


def matrix(scores: Scores, agent: str, games: list[str]) -> Matrix:
    """The agent's trials, a row each, in each game; NaN where a game has fewer. Without trials, the means."""
    if scores.trials is None or agent in scores.views:
        return np.array([scores.columns((agent,)).loc[games, agent]], dtype=float)
    return padded([scores.trial_scores(agent, game) for game in games])


def normalised_matrix(scores: Scores, ranges: Ranges, agent: str, games: list[str]) -> Matrix:
    """The matrix of an agent's scores, normalised."""
    return np.asarray((matrix(scores, agent, games) - ranges.low[games].to_numpy()) / ranges.span[games].to_numpy())


def ranged_sets(scores: Scores, ranges: Ranges, group: Group) -> dict[str, tuple[list[str], list[str]]]:
    """Divides each set of the group's common games into games with a range and games without one."""
    split = {}
    for name, games in sets(scores.common(group)).items():
        without = ranges.without(games)
        split[name] = ([game for game in games if game not in without], without)
    return split


def aggregate_rows(scores: Scores, ranges: Ranges, group: Group, bootstrap: Bootstrap) -> pd.DataFrame:
    """A row for each set of games and agent."""
    rows = []
    names = statistics(scores, group)
    for name, (games, without) in ranged_sets(scores, ranges, group).items():
        for agent in group.agents if games else ():
            estimate = bootstrap.estimate(aggregates, normalised_matrix(scores, ranges, agent, games))
            means = ranges.normalise(scores.columns((agent,)).loc[games])[agent]
            rows.append(
                {
                    "normalisation": ranges.name,
                    "set": name,
                    "agent": agent,
                    "games": len(games),
                    "n/a": len(without),
                    "above 1": int((means > 1).sum()),
                    **{
                        key: value
                        for i, each in enumerate(names)
                        for key, value in _interval(each, estimate, i).items()
                    },
                }
            )
    return pd.DataFrame(rows)


def statistics(scores: Scores, group: Group) -> list[str]:
    """The names of AGGREGATES for the group. Without single trials, the last two are over the means of games."""
    means_only = scores.trials is None or all(agent in scores.views for agent in group.agents)
    return [*AGGREGATES[:2], *(f"{name} over game means" if means_only else name for name in AGGREGATES[2:])]


def _interval(name: str, estimate: Estimate, index: int) -> dict[str, float]:
    return {
        name: float(estimate.value[index]),
        f"{name} low": float(estimate.low[index]),
        f"{name} high": float(estimate.high[index]),
    }


def distribution_rows(scores: Scores, ranges: Ranges, group: Group) -> pd.DataFrame:
    """The score distribution: for each normalised score, the share of games in which the agent has it or more."""
    parts = []
    for name, (games, _) in ranged_sets(scores, ranges, group).items():
        normalised = ranges.normalise(scores.columns(group.agents).loc[games])
        for agent in group.agents if games else ():
            values = np.sort(normalised[agent].to_numpy())
            share = [float((values >= value).mean()) for value in values]
            parts.append(
                pd.DataFrame(
                    {
                        "normalisation": ranges.name,
                        "set": name,
                        "agent": agent,
                        "score": values,
                        "share of games": share,
                    }
                ).drop_duplicates()
            )
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def profile_rows(scores: Scores, ranges: Ranges, group: Group, bootstrap: Bootstrap) -> pd.DataFrame:
    """The performance profile of each agent, over all common games that have a range."""
    *_, (name, (games, _)) = ranged_sets(scores, ranges, group).items() or [("", ([], []))]
    parts = []
    for agent in group.agents if games else ():
        normalised = normalised_matrix(scores, ranges, agent, games)
        thresholds = np.linspace(0, 1 if ranges.bounded else 2, 41)
        estimate = bootstrap.estimate(profile(thresholds), normalised)
        parts.append(
            pd.DataFrame(
                {
                    "normalisation": ranges.name,
                    "set": name,
                    "agent": agent,
                    "threshold": thresholds,
                    "share of trials": estimate.value,
                    "low": estimate.low,
                    "high": estimate.high,
                }
            )
        )
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def improvement_rows(scores: Scores, group: Group, bootstrap: Bootstrap) -> pd.DataFrame:
    """The probability of improvement for each ordered pair of agents with trials, over the games that both have
    played."""
    rows = []
    for first in group.agents:
        for second in group.agents:
            games = list(scores.columns((first, second)).dropna().index) if first != second else []
            if not games:
                continue
            matrices = [matrix(scores, agent, games) for agent in (first, second)]
            if min(int(trials_of(each).min()) for each in matrices) < FEWEST_TRIALS:
                continue
            estimate = bootstrap.estimate(improvement, *matrices)
            rows.append(
                {"first": first, "second": second, "games": len(games), **_interval("probability", estimate, 0)}
            )
    return pd.DataFrame(rows)
