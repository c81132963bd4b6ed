"""The scores that the paper prints, and what it says about them."""

import pandas as pd

from ..games import PAPER, published
from ..scores import BASELINE_VIEWS, Scores

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


def published_scores() -> pd.DataFrame:
    """A row for each game, a column for each agent: those of the paper and of its successors. NaN: not published."""
    paper = paper_scores()
    return pd.concat([paper.means, paper.views, published("successors")], axis=1)
