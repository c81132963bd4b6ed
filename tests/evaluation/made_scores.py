"""Makes results, curves and an estimator for tests of the statistics."""

import package

package.require()

import pandas as pd
from racebeam_evaluation import bootstrap
from racebeam_evaluation.results import Results

FEW = bootstrap.Bootstrap(seed=5, repetitions=200)


def results_of(scores, ends=None):
    """Results of {(agent, game): [scores of the episodes of each trial]}."""
    rows = [
        (game, "m", agent, trial, episode, score, "over")
        for (agent, game), trials in scores.items()
        for trial, episodes in enumerate(trials)
        for episode, score in enumerate(episodes)
    ]
    columns = ["game", "image_md5", "agent", "trial", "episode", "score", "end"]
    return Results(pd.DataFrame(rows + (ends or []), columns=columns), None, (), ())


def curves_of(episodes):
    """A frame of curves.csv of (game, agent, trial, episode, score, frames)."""
    return pd.DataFrame(episodes, columns=["game", "agent", "trial", "episode", "score", "frames"])
