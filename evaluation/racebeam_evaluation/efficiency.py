"""Sample efficiency: the interquartile mean over trials of all games, by frames or decisions of training."""

import itertools

import numpy as np
import pandas as pd

from .bootstrap import AGGREGATES, Bootstrap, aggregates, padded
from .curves import checkpoint, with_trained
from .normalise import Ranges

_STANDARD = (10_000_000, 50_000_000, 100_000_000, 200_000_000)  # frames
_STRETCHES = 10  # of shorter training
_IQM = AGGREGATES.index("IQM")


def rows(curves: pd.DataFrame, ranges: Ranges, bootstrap: Bootstrap) -> pd.DataFrame:
    """Returns the IQM of the last 100 training episodes before each point, for each axis and agent.

    The games are those that all agents were trained in, and that have a range. Points are 10, 50, 100 and 200 million
    frames if each trial has reached two of them, else ten equal parts of the shortest training."""
    axes = [name for name in ("frames", "decisions") if name in curves and curves[name].notna().all()]
    parts = [_of_axis(curves, axis, ranges, bootstrap) for axis in axes]
    return pd.DataFrame(list(itertools.chain.from_iterable(parts)))


def _of_axis(curves: pd.DataFrame, axis: str, ranges: Ranges, bootstrap: Bootstrap) -> list[dict[str, object]]:
    trained = with_trained(curves, axis)
    agents = list(dict.fromkeys(trained["agent"]))
    games = _common_games(trained, agents, ranges)
    trained = trained[trained["game"].isin(games)]
    if not len(trained):
        return []
    frames = []
    for point in _points(trained, axis):
        for agent in agents:
            columns = [_scores_at(trained, agent, game, point, ranges) for game in games]
            if not all(map(len, columns)):
                continue
            estimate = bootstrap.estimate(aggregates, padded(columns))
            frames.append(
                {
                    "normalisation": ranges.name,
                    "axis": axis,
                    "agent": agent,
                    "trained for": point,
                    "games": len(games),
                    "IQM": float(estimate.value[_IQM]),
                    "IQM low": float(estimate.low[_IQM]),
                    "IQM high": float(estimate.high[_IQM]),
                }
            )
    return frames


def _common_games(trained: pd.DataFrame, agents: list[str], ranges: Ranges) -> list[str]:
    counts = trained.groupby("game")["agent"].nunique()
    common = [str(game) for game in counts.index[counts == len(agents)]]
    without = ranges.without(common)
    return [game for game in common if game not in without]


def _points(trained: pd.DataFrame, axis: str) -> list[int]:
    shortest = int(trained.groupby(["game", "agent", "trial"])["trained"].max().min())
    points = [point for point in _STANDARD if axis == "frames" and shortest + _longest(trained) >= point]
    if len(points) > 1:
        return points
    return [max(1, shortest * part // _STRETCHES) for part in range(1, _STRETCHES + 1)]


def _longest(trained: pd.DataFrame) -> int:
    """Frames of the longest episode: how far short of a point the last whole one may end."""
    return int(trained["frames"].max())


def _scores_at(
    trained: pd.DataFrame, agent: str, game: str, point: int, ranges: Ranges
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """The normalised score of each trial that an episode has ended in by then."""
    rows = trained[(trained["agent"] == agent) & (trained["game"] == game)]
    scores = [checkpoint(trial, point, fewest=1) for _, trial in rows.groupby("trial")]
    defined = np.array([score for score in scores if score == score])
    return np.asarray((defined - ranges.low[game]) / ranges.span[game])
