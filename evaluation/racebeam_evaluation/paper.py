"""The scores that the paper prints, and what it says about them."""

import pandas as pd

from .games import PAPER, published
from .scores import BASELINE_VIEWS, Scores

_NOTES = (
    "Of the 37 references the paper prints 3: random play, and the best Const and Perturb policy of each game.",
    "It prints no single trials: tests between trials, and intervals, cannot be rebuilt.",
    "Skiing's reward was near 0 then, and is about -17,000 for random play now: it has no human-normalised score.",
)


def paper_scores() -> Scores:
    """The printed scores of the paper's 55 games."""
    learners, planners = published("paper2013/learners"), published("paper2013/planners")
    views = learners[list(BASELINE_VIEWS)]
    means = pd.concat([learners.drop(columns=list(BASELINE_VIEWS)), planners[["full_tree", "uct"]]], axis=1)
    return Scores(
        means=means.loc[PAPER.index],
        trials=None,
        references=views,
        views=views,
        notes=_NOTES,
        other_rewards=("skiing",),
    )


def beside_published(scores: Scores) -> pd.DataFrame:
    """A row for each game and agent with a published score: ours, and that of the paper or of a successor."""
    paper = paper_scores()
    ours = pd.concat([scores.means, scores.views], axis=1)
    theirs = pd.concat([paper.means, paper.views, published("successors")], axis=1)
    shared = [agent for agent in ours if agent in theirs]
    rows = [
        {"game": game, "agent": agent, "score": ours.loc[game, agent], "published": theirs.loc[game, agent]}
        for game in ours.index
        if game in theirs.index
        for agent in shared
    ]
    return pd.DataFrame(rows).dropna() if rows else pd.DataFrame()
