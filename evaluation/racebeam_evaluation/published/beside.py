"""Tables of scores beside published ones: with the settings of both sides, and whether they agree."""

import dataclasses

import numpy as np
import pandas as pd
import scipy.stats

from ..bootstrap import FEWEST_TRIALS
from ..plan import Protocol
from ..results import Results
from ..scores import Scores
from .paper import published_scores
from .protocols import cause, not_comparable, published_protocols, sources

_CONFIDENCE = 0.95
_UNEXPLAINED = "the cause is not known"
_NOT_COMPARABLE = "not comparable"


@dataclasses.dataclass(frozen=True)
class Beside:
    """Our scores and published ones of the same agents."""

    settings: pd.DataFrame  # a row for each side of each agent that both have
    scores: pd.DataFrame  # a row for each game and agent
    left_out: tuple[str, ...]  # a sentence for each agent that was made otherwise here, and each game


def beside_published(scores: Scores, results: Results, mix: bool = False) -> Beside:
    """Our agents that have the name of a published one. Leaves out agents that were made otherwise, unless `mix`."""
    theirs, protocols = published_scores(), published_protocols()
    ours = pd.concat([scores.means, scores.views], axis=1)
    shared = [agent for agent in ours if agent in theirs and _games(ours[agent], theirs[agent])]
    sides = {agent: results.protocols(agent) for agent in shared}
    different = {agent: _differences(sides[agent], protocols[agent]) for agent in shared}
    compared = [agent for agent in shared if mix or not different[agent]]
    rows = [
        _row(scores, agent, game, float(theirs.loc[game, agent]), different[agent])
        for game in ours.index
        for agent in compared
        if game in _games(ours[agent], theirs[agent])
    ]
    sentences = [
        f"{agent} is not beside the published scores: {', '.join(different[agent])} differ or are unknown; "
        "--mix shows them all the same."
        for agent in shared
        if agent not in compared
    ]
    sentences += [f"{row['agent']} in {row['game']}: {row['agrees']}." for row in rows if _is_excluded(row)]
    return Beside(_settings(sides, protocols), pd.DataFrame(rows), tuple(sentences))


def columns_of_the_paper(scores: Scores) -> pd.DataFrame:
    """A row for each game with published scores: those of our agents, whatever they are called, then all published
    ones."""
    theirs = published_scores()
    ours = scores.means.loc[[game for game in scores.means.index if game in theirs.index]]
    renamed = theirs.loc[ours.index].rename(columns="published {}".format)
    return pd.concat([ours, renamed.dropna(axis=1, how="all")], axis=1).rename_axis("game").reset_index()


def _is_excluded(row: dict[str, object]) -> bool:
    return str(row["agrees"]).startswith(_NOT_COMPARABLE)


def _games(ours: pd.Series, theirs: pd.Series) -> list[str]:
    return [game for game in ours.dropna().index if game in theirs.dropna().index]


def _differences(ours: list[Protocol], theirs: Protocol) -> list[str]:
    """The names of settings, in any of our plans."""
    return list(dict.fromkeys(name for each in ours for name in each.differences(theirs)))


def _settings(ours: dict[str, list[Protocol]], theirs: dict[str, Protocol]) -> pd.DataFrame:
    """A row for each side."""
    who = sources()
    rows = []
    for agent, protocols in ours.items():
        for side, protocol in [*(("here", each) for each in protocols), (who[agent], theirs[agent])]:
            rows.append({"agent": agent, "side": side, **dataclasses.asdict(protocol)})
    return pd.DataFrame(rows)


def _row(scores: Scores, agent: str, game: str, published: float, different: list[str]) -> dict[str, object]:
    sample = scores.sample(agent, game)
    score = float(scores.columns((agent,)).loc[game, agent])
    low, high = interval(sample)
    return {
        "game": game,
        "agent": agent,
        "score": score,
        "low": low,
        "high": high,
        "published": published,
        "agrees": _agrees((low, high), agent, game, score, published, different),
    }


def _agrees(
    bounds: tuple[float, float], agent: str, game: str, score: float, published: float, different: list[str]
) -> str:
    """Whether the published mean is within our interval; if not, why."""
    reason = not_comparable(agent, game)
    if reason is not None:
        return f"{_NOT_COMPARABLE}: {reason}"
    if score == published or bounds[0] <= published <= bounds[1]:
        return "yes"
    if np.isnan(bounds[0]):
        return "unknown: one sample has no interval"
    if different:
        return f"no: {' and '.join(different)} differ or are unknown"
    return f"no: {cause(agent, game) or _UNEXPLAINED}"


def interval(sample: np.ndarray[tuple[int], np.dtype[np.float64]]) -> tuple[float, float]:
    """The 95 % interval of the mean, by Student's t; NaN of fewer than two samples."""
    if len(sample) < FEWEST_TRIALS:
        return float("nan"), float("nan")
    reach = scipy.stats.t.ppf((1 + _CONFIDENCE) / 2, len(sample) - 1) * sample.std(ddof=1) / np.sqrt(len(sample))
    return float(sample.mean() - reach), float(sample.mean() + reach)
