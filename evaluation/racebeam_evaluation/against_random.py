"""In how many games an agent is better than random play: by means, with an interval, and by a test."""

import numpy as np
import numpy.typing as npt
import pandas as pd

from .bootstrap import FEWEST_TRIALS, Bootstrap
from .paired import verdict
from .scores import Scores

RANDOM = "random"


def rows(scores: Scores, agents: tuple[str, ...], bootstrap: Bootstrap) -> pd.DataFrame:
    """A row for each agent. Samples are the means of trials of those that were trained, else episodes."""
    if RANDOM not in scores.views or scores.trials is None:
        return pd.DataFrame()
    return pd.DataFrame([row for agent in agents if (row := _row(scores, agent, bootstrap))])


def _row(scores: Scores, agent: str, bootstrap: Bootstrap) -> dict[str, object] | None:
    games = list(scores.columns((agent, RANDOM)).dropna().index)
    if not games:
        return None
    samples = [(scores.sample(agent, game), scores.sample(RANDOM, game)) for game in games]
    found = [verdict(*pair) for pair in samples]
    low, high = _interval(samples, bootstrap)
    return {
        "agent": agent,
        "games": len(games),
        "above": sum(bool(ours.mean() > theirs.mean()) for ours, theirs in samples),
        "low": low,
        "high": high,
        "significantly above": found.count("better"),
        "significantly below": found.count("worse"),
        "not tested": found.count("few") + found.count("constant"),
    }


def _interval(
    samples: list[tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]], bootstrap: Bootstrap
) -> tuple[float, float]:
    """Returns the interval of the number of games above random play. Each sample is drawn anew within its game.

    Its bounds are NaN if a sample has a single score: drawn anew, it would never vary."""
    if min(len(sample) for pair in samples for sample in pair) < FEWEST_TRIALS:
        return float("nan"), float("nan")
    generator = np.random.default_rng(bootstrap.seed)
    above = np.zeros(bootstrap.repetitions)
    for ours, theirs in samples:
        above += _means(ours, bootstrap, generator) > _means(theirs, bootstrap, generator)
    tail = 50 * (1 - bootstrap.confidence)
    low, high = np.percentile(above, [tail, 100 - tail])
    return float(low), float(high)


def _means(
    sample: npt.NDArray[np.float64], bootstrap: Bootstrap, generator: np.random.Generator
) -> npt.NDArray[np.float64]:
    indices = generator.integers(0, len(sample), (bootstrap.repetitions, len(sample)))
    return np.asarray(sample[indices].mean(axis=1))
