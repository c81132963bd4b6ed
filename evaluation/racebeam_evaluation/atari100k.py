"""The report `atari100k`: human-normalised scores in 26 games after 400,000 frames.

Kaiser et al.: "Model-Based Reinforcement Learning for Atari", arXiv:1903.00374; aggregates as in Agarwal et al.
2021."""

import dataclasses

import pandas as pd

from . import aggregate, figure, notes
from .bootstrap import Bootstrap
from .errors import BadInput
from .figure import Picture
from .games import ATARI100K, HUMAN
from .normalise import Ranges
from .report import Report
from .results import Results
from .scores import Group, Scores, scores_of
from .table import Table

_RANGES = Ranges("human", HUMAN["random"], HUMAN["human"])


def evaluate(results: Results, bootstrap: Bootstrap) -> Report:
    """The report of evaluation episodes. Raises BadInput if none is of the 26 games."""
    scores = _of_its_games(scores_of(results))
    missing = [game for game in ATARI100K if game not in scores.means.index]
    report = Report("Evaluation on Atari 100k", list(scores.notes), results.sources)
    if missing:
        report.introduction.append(f"Of the 26 games, {len(missing)} are missing: {', '.join(missing)}.")
    for group in scores.groups:
        _add_group(report, scores, group, bootstrap)
    return report


def _of_its_games(scores: Scores) -> Scores:
    games = [game for game in scores.means.index if game in ATARI100K]
    if not games:
        raise BadInput(f"no game of RESULTS is one of Atari 100k; expected some of {', '.join(ATARI100K)}")
    return dataclasses.replace(
        scores, means=scores.means.loc[games], references=scores.references.loc[games], views=scores.views.loc[games]
    )


def _add_group(report: Report, scores: Scores, group: Group, bootstrap: Bootstrap) -> None:
    normalised = _RANGES.normalise(scores.columns(group.agents))
    columns = pd.concat([HUMAN.loc[normalised.index], scores.columns(group.agents)], axis=1)
    report.add_table(
        Table(
            f"{group.name}-scores",
            "Scores; random and human are published ones.",
            columns.rename_axis("game").reset_index(),
            report.sources,
            digits=1,
            best_of=group.agents,
        )
    )
    report.add_table(
        Table(
            f"{group.name}-human-normalised",
            "Human-normalised scores.",
            normalised.rename_axis("game").reset_index(),
            report.sources,
            best_of=group.agents,
        )
    )
    rows = aggregate.aggregate_rows(scores, _RANGES, group, bootstrap)
    report.add_table(
        Table(
            f"{group.name}-aggregates",
            "Aggregates of human-normalised scores; `above 1` counts games.",
            rows,
            report.sources,
            notes.of_aggregates(scores, group, [_RANGES]),
        )
    )
    profiles = aggregate.profile_rows(scores, _RANGES, group, bootstrap)
    if len(profiles):
        report.add_table(
            Table(
                f"{group.name}-profiles",
                "Share of trials above a normalised score, with its interval.",
                profiles,
                report.sources,
            )
        )
        report.parts.append(
            Picture(
                f"{group.name}-profiles",
                "Performance profiles of human-normalised scores.",
                figure.profiles(profiles),
                report.sources,
            )
        )
