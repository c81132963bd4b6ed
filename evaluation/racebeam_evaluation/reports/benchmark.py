"""The reports `atari100k` and `atari57`: human-normalised scores in the games of a benchmark.

Kaiser et al.: "Model-Based Reinforcement Learning for Atari", arXiv:1903.00374, has 26 games after 400,000 frames. The
57 games are those with published scores of people. Aggregates are as in Agarwal et al. 2021."""

import dataclasses

import pandas as pd

from .. import aggregate, notes
from ..bootstrap import Bootstrap
from ..errors import BadInput
from ..games import ATARI57, ATARI100K, HUMAN
from ..normalise import human
from ..output import figure
from ..output.figure import Picture
from ..output.report import Report
from ..output.table import Table
from ..results import Results
from ..scores import Group, Scores, scores_of

_RANGES = human()


def atari100k(results: Results, bootstrap: Bootstrap, _: bool = False) -> Report:
    """The report on 26 games."""
    return _evaluate("Atari 100k", ATARI100K, results, bootstrap)


def atari57(results: Results, bootstrap: Bootstrap, _: bool = False) -> Report:
    """The report on 57 games."""
    return _evaluate("Atari 57", ATARI57, results, bootstrap)


def _evaluate(name: str, games: tuple[str, ...], results: Results, bootstrap: Bootstrap) -> Report:
    """The report of evaluation episodes. Raises BadInput if none is of the games."""
    scores = _of_its_games(scores_of(results), name, games)
    missing = [game for game in games if game not in scores.means.index]
    report = Report(f"Evaluation on {name}", list(scores.notes), results.sources)
    if missing:
        report.introduction.append(f"Of the {len(games)} games, {len(missing)} are missing: {', '.join(missing)}.")
    for group in scores.groups:
        _add_group(report, scores, group, bootstrap)
    return report


def _of_its_games(scores: Scores, name: str, benchmark: tuple[str, ...]) -> Scores:
    games = [game for game in scores.means.index if game in benchmark]
    if not games:
        raise BadInput(f"no game of RESULTS is one of {name}; expected some of {', '.join(benchmark)}")
    return dataclasses.replace(
        scores, means=scores.means.loc[games], references=scores.references.loc[games], views=scores.views.loc[games]
    )


def _add_group(report: Report, scores: Scores, group: Group, bootstrap: Bootstrap) -> None:
    _add_scores(report, scores, group)
    _add_aggregates(report, scores, group, bootstrap)
    _add_profiles(report, scores, group, bootstrap)


def _add_scores(report: Report, scores: Scores, group: Group) -> None:
    normalised = _RANGES.normalise(scores.columns(group.agents))
    columns = pd.concat([HUMAN.loc[normalised.index], scores.columns(group.agents)], axis=1)
    for name, caption, frame, digits in (
        ("scores", "Scores; random and human are published ones.", columns, 1),
        ("human-normalised", "Human-normalised scores.", normalised, 3),
    ):
        rows = frame.rename_axis("game").reset_index()
        report.add_table(
            Table(f"{group.name}-{name}", caption, rows, report.sources, digits=digits, best_of=group.agents)
        )


def _add_aggregates(report: Report, scores: Scores, group: Group, bootstrap: Bootstrap) -> None:
    rows = aggregate.aggregate_rows(scores, _RANGES, group, bootstrap)
    if not len(rows):
        return
    caption = "Aggregates of human-normalised scores; `above 1` counts games."
    remarks = notes.of_aggregates(scores, group, [_RANGES])
    report.add_table(Table(f"{group.name}-aggregates", caption, rows, report.sources, remarks))
    whole = rows[rows["set"] == rows["set"].iloc[-1]]  # the set of all games is the last
    drawn = figure.intervals(whole, aggregate.statistics(scores, group))
    caption = "Aggregates of human-normalised scores with their intervals."
    report.parts.append(Picture(f"{group.name}-intervals", caption, drawn, report.sources))


def _add_profiles(report: Report, scores: Scores, group: Group, bootstrap: Bootstrap) -> None:
    rows = aggregate.profile_rows(scores, _RANGES, group, bootstrap)
    if not len(rows):
        return
    name = f"{group.name}-profiles"
    caption = "Share of trials above a normalised score, with its interval."
    report.add_table(Table(name, caption, rows, report.sources))
    caption = "Performance profiles of human-normalised scores."
    report.parts.append(Picture(name, caption, figure.profiles(rows), report.sources))
