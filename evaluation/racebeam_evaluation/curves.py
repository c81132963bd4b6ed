"""Learning curves: what training episodes scored, by the frames that the trial had been trained for."""

import numpy as np
import pandas as pd

from .games import in_order

WINDOW = 100  # training episodes that a checkpoint is the mean of
_BINS = 50  # points of a curve


def with_trained(curves: pd.DataFrame, axis: str = "frames") -> pd.DataFrame:
    """The training episodes of curves.csv in order, with the column "trained": frames, or what `axis` says, of the
    trial up to each one's end."""
    ordered = curves.sort_values(["game", "agent", "trial", "episode"], kind="stable", ignore_index=True)
    totals = ordered.groupby(["game", "agent", "trial"])[axis].cumsum()
    return ordered.assign(trained=totals)


def checkpoint(trial: pd.DataFrame, point: int, fewest: int = WINDOW) -> float:
    """The mean score of the last 100 episodes of a trial that had ended by a point; NaN if there are fewer than
    `fewest`. Rows that say with "window" of how many rows a mean is made are themselves means of many episodes."""
    window = int(trial["window"].iloc[0]) if "window" in trial and trial["window"].notna().all() else WINDOW
    finished = trial[trial["trained"] <= point]
    return float(finished["score"].tail(window).mean()) if len(finished) >= min(fewest, window) else float("nan")


def learning_curves(curves: pd.DataFrame) -> pd.DataFrame:
    """Returns the mean score of training episodes in 50 equal stretches of frames, for each game and agent.

    The standard error is that of the trials' means, and NaN for a single trial. A stretch has no row if no episode
    ends in it."""
    episodes = with_trained(curves)
    longest = episodes.groupby("game")["trained"].transform("max").clip(lower=1)  # DQN Zoo begins with 0 frames
    stretch = np.ceil(episodes["trained"] * _BINS / longest).clip(lower=1).astype(int)
    keys = ["game", "agent", "stretch"]
    of_trials = episodes.assign(stretch=stretch).groupby([*keys, "trial"])["score"].mean()
    rows = of_trials.groupby(keys).agg(["mean", "sem", "count"]).reset_index()
    frames = rows["stretch"] * rows["game"].map(episodes.groupby("game")["trained"].max()) / _BINS
    frame = pd.DataFrame(
        {
            "game": rows["game"],
            "agent": rows["agent"],
            "frames": frames.round().astype(int),
            "trials": rows["count"],
            "score": rows["mean"],
            "standard error": rows["sem"],
        }
    )
    order = {game: index for index, game in enumerate(in_order(list(set(frame["game"]))))}
    return frame.sort_values(
        ["game", "agent", "frames"],
        kind="stable",
        ignore_index=True,
        key=lambda column: column.map(order) if column.name == "game" else column,
    )
