"""Results as pandas frames, for programs and notebooks."""

import pathlib
from typing import NamedTuple

import pandas as pd

from .aggregate import aggregate_rows
from .bootstrap import Bootstrap
from .errors import BadInput
from .foreign.read import read_file
from .normalise import all_ranges
from .results import Results, differences, read_folder, together
from .scores import Scores, scores_of


class Frames(NamedTuple):
    """What `load` returns."""

    episodes: pd.DataFrame  # game, image_md5, agent, trial, episode, score, end: a row for each evaluation episode
    curves: pd.DataFrame  # game, agent, trial, episode, score, frames: a row for each training episode
    trials: pd.DataFrame  # game, agent, trial, score: the mean of each trial's evaluation episodes
    scores: pd.DataFrame  # a row for each game, a column for each agent: the means of trials
    roles: dict[str, str]  # learner, planner or baseline, of the agents that agents.csv has
    results: Results  # for the functions of this package

    def aggregates(self, bootstrap: Bootstrap | None = None) -> pd.DataFrame:
        """Average, median, interquartile mean and optimality gap of each group and normalisation, with intervals."""
        scores = scores_of(self.results)
        parts = [
            aggregate_rows(scores, ranges, group, bootstrap or Bootstrap()).assign(group=group.name)
            for group in scores.groups
            for ranges in all_ranges(scores, group)
        ]
        found = [part for part in parts if len(part)]
        return pd.concat(found, ignore_index=True) if found else pd.DataFrame()


def load(*paths: str | pathlib.Path, mix: bool = False) -> Frames:
    """Reads folders of results, and files of Dopamine, DQN Zoo and rliable. Raises BadInput for others."""
    results = read_all([pathlib.Path(path) for path in paths], mix)
    scores: Scores = scores_of(results)
    episodes = results.episodes.dropna(subset=["score"])
    trials = episodes.groupby(["game", "agent", "trial"], as_index=False)["score"].mean()
    curves = pd.DataFrame(columns=["game", "agent", "trial", "episode", "score", "frames"])
    return Frames(
        results.episodes,
        curves if results.curves is None else results.curves,
        trials,
        pd.concat([scores.means, scores.references], axis=1),
        results.roles,
        results,
    )


def read_all(paths: list[pathlib.Path], mix: bool = False) -> Results:
    """The results of folders, and of files of other programs, together."""
    if not paths:
        raise BadInput("no results are named; expected a folder or a file")
    files = [path for path in paths if path.is_file()]
    folders = [path for path in paths if path not in files]
    notes = differences(folders, mix)
    return together([*map(read_folder, folders), *map(read_file, files)], notes)
