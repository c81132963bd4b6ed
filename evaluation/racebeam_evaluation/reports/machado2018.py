"""The report `machado2018`: averages of the last 100 training episodes after fixed numbers of frames.

M. C. Machado et al.: "Revisiting the Arcade Learning Environment", Journal of Artificial Intelligence Research 61,
2018."""

import pandas as pd

from ..bootstrap import Bootstrap
from ..curves import WINDOW, checkpoint, with_trained
from ..errors import BadInput
from ..games import in_order, published
from ..output.report import Report
from ..output.table import Table
from ..results import Results
from ..scores import scores_of
from .training import add_training

_CHECKPOINTS = (10_000_000, 50_000_000, 100_000_000, 200_000_000)  # frames of a trial
_LONGEST = 18_000  # frames of an episode, which is how far short of a checkpoint the last whole one may end


def evaluate(results: Results, bootstrap: Bootstrap, _: bool = False) -> Report:
    """The report of training episodes. Raises BadInput without training episodes."""
    if results.curves is None:
        raise BadInput(
            "the report machado2018 is of training episodes, and no curves.csv of RESULTS has one; expected learners"
        )
    sources = results.curve_sources
    report = Report("Evaluation as in Machado et al. 2018", list(results.notes), sources)
    report.add_table(
        Table(
            "machado2018",
            f"Mean score of the last {WINDOW} training episodes at four numbers of frames, and its "
            "standard deviation over trials.",
            checkpoints(results.curves),
            sources,
            (f"n/a: fewer frames, or fewer than {WINDOW} episodes; a deviation needs two trials.",),
            digits=1,
        )
    )
    theirs = published_checkpoints(list(set(results.curves["game"])))
    if not theirs.empty:
        report.add_table(
            Table(
                "machado2018-published",
                "The same of the agents of Machado et al. 2018, in these games.",
                theirs,
                sources,
                digits=1,
            )
        )
    add_training(report, results, scores_of(results), bootstrap)
    return report


def checkpoints(curves: pd.DataFrame) -> pd.DataFrame:
    """A row for each game and agent: at each checkpoint mean and standard deviation over the trials that have reached
    it."""
    trained = with_trained(curves)
    rows = []
    for game in in_order(list(set(trained["game"]))):
        for agent, episodes in trained[trained["game"] == game].groupby("agent"):
            trials = [trial for _, trial in episodes.groupby("trial")]
            row: dict[str, object] = {"game": game, "agent": agent, "trials": len(trials)}
            for frames in _CHECKPOINTS:
                means = pd.Series([_at(trial, frames) for trial in trials], dtype=float).dropna()
                millions = f"{frames // 1_000_000} M"
                row |= {millions: means.mean(), f"{millions} deviation": means.std(), f"{millions} trials": len(means)}
            rows.append(row)
    return pd.DataFrame(rows)


def published_checkpoints(games: list[str]) -> pd.DataFrame:
    """A row for each of the games and each agent of Machado et al. 2018, as `checkpoints` has them."""
    theirs = published("machado2018")
    return theirs.loc[[game for game in in_order(games) if game in theirs.index]].reset_index()


def _at(trial: pd.DataFrame, frames: int) -> float:
    """The score at a checkpoint; NaN if the trial has not got so far."""
    short = trial["trained"].iloc[-1] < frames - max(_LONGEST, trial["frames"].max())
    return float("nan") if short else checkpoint(trial, frames)
