"""Learning curves: what training episodes scored, by the frames that the trial had been trained for."""

import numpy as np
import pandas as pd

from .games import in_order

_BINS = 50  # points of a curve


def with_trained_frames(curves: pd.DataFrame) -> pd.DataFrame:
    """The training episodes of curves.csv in order, with the column "trained": frames of the trial up to each one's
    end."""
    ordered = curves.sort_values(["game", "agent", "trial", "episode"], kind="stable", ignore_index=True)
    trained = ordered.groupby(["game", "agent", "trial"])["frames"].cumsum()
    return ordered.assign(trained=trained)


def learning_curves(curves: pd.DataFrame) -> pd.DataFrame:
    """For each game and agent, the mean score of training episodes in 50 equal stretches of frames.

    The standard error is that of the trials' means, NaN of a single trial. A stretch in which no episode ends has no
    row."""
    episodes = with_trained_frames(curves)
    longest = episodes.groupby("game")["trained"].transform("max")
    stretch = np.ceil(episodes["trained"] / longest * _BINS).clip(lower=1).astype(int)
    keys = ["game", "agent", "stretch"]
    of_trials = episodes.assign(stretch=stretch).groupby([*keys, "trial"])["score"].mean()
    rows = of_trials.groupby(keys).agg(["mean", "sem", "count"]).reset_index()
    frames = rows["stretch"] * rows["game"].map(episodes.groupby("game")["trained"].max()) / _BINS
    made = pd.DataFrame(
        {
            "game": rows["game"],
            "agent": rows["agent"],
            "frames": frames.round().astype(int),
            "trials": rows["count"],
            "score": rows["mean"],
            "standard error": rows["sem"],
        }
    )
    order = {game: index for index, game in enumerate(in_order(list(set(made["game"]))))}
    return made.sort_values(
        ["game", "agent", "frames"],
        kind="stable",
        ignore_index=True,
        key=lambda column: column.map(order) if column.name == "game" else column,
    )
