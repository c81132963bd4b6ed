"""The report `paper2013`: the metrics of Bellemare et al. 2013, section 4, and those of Agarwal et al. 2021."""

import functools

import pandas as pd

from .. import against_random, aggregate, notes, paired
from ..bootstrap import Bootstrap
from ..csv_file import Source
from ..games import PAPER, sets
from ..normalise import Ranges, all_ranges
from ..output import figure
from ..output.figure import Picture
from ..output.report import Report
from ..output.table import Table
from ..published.beside import beside_published, columns_of_the_paper
from ..results import Results
from ..scores import Group, Scores, scores_of
from .training import add_training

_OWN_FIGURES = ("random", "baseline", "inter-algorithm")  # the normalisations that the paper draws


def evaluate(results: Results, bootstrap: Bootstrap, mix: bool = False) -> Report:
    """The report of results. `mix`: scores stand beside published ones that were made otherwise, too."""
    scores = scores_of(results)
    introduction = [*scores.notes, *notes.of_left_out(scores, results)]
    report = Report("Evaluation", introduction, results.sources)
    _add_published(report, scores, results, mix)
    add_groups(report, scores, bootstrap)
    add_training(report, results, scores, bootstrap)
    return report


def _add_published(report: Report, scores: Scores, results: Results, mix: bool) -> None:
    beside = beside_published(scores, results, mix)
    for name, caption, frame, digits in (
        ("published-settings", "How scores were made, here and by those who published scores.", beside.settings, 1),
        (
            "beside-published",
            "Scores with the 95 % interval of the mean, beside published ones of the same settings.",
            beside.scores,
            1,
        ),
        ("published", "Scores beside all that the paper and its successors print.", columns_of_the_paper(scores), 1),
    ):
        of_scores = beside.left_out if name == "beside-published" else ()
        report.add_table(Table(name, caption, frame, report.sources, of_scores, digits))
    if not len(beside.scores):
        report.introduction += beside.left_out


def add_groups(report: Report, scores: Scores, bootstrap: Bootstrap) -> None:
    """Adds all tables and figures of each group of agents."""
    report.introduction.append(f"Games: {_count_text(list(scores.means.index))}.")
    report.add_table(_against(scores, report.sources))
    report.add_table(_above_random(scores, report.sources, bootstrap))
    for group in scores.groups:
        ranges = all_ranges(scores, group)
        _add_scores(report, scores, group)
        _add_normalised(report, scores, group, ranges)
        _add_aggregates(report, scores, group, ranges, bootstrap)
        if scores.trials is not None and group.name != "baselines":
            _add_pairs(report, scores, group, bootstrap)


def _count_text(games: list[str]) -> str:
    each = {name: those for name, those in sets(games).items() if " + " not in name}
    return ", ".join(
        f"{len(those)} of the {name} set" if name != "other" else f"{len(those)} that the paper lacks"
        for name, those in each.items()
    )


def _with_set(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows of games with the name and the set of each."""
    table = frame.rename_axis("game").reset_index()
    table.insert(0, "set", [PAPER["set"].get(game, "other") for game in table["game"]])
    return table


def columns(scores: Scores, group: Group) -> pd.DataFrame:
    """The columns of the group's table of scores, as in the paper."""
    if group.name != "planning":
        views = () if group.name == "baselines" else tuple(scores.views)
        return scores.columns(group.agents + views).dropna(how="all")
    best = {
        f"best_{kind}": others.max(axis=1)
        for kind, others in (("learner", _learners(scores)), ("baseline", scores.views))
        if len(others.columns)
    }
    return pd.concat([scores.columns(group.agents), pd.DataFrame(best)], axis=1).dropna(
        how="all", subset=list(group.agents)
    )


def _learners(scores: Scores) -> pd.DataFrame:
    agents = [agent for group in scores.groups if group.name == "learning" for agent in group.agents]
    return scores.means[agents]


def _against(scores: Scores, sources: tuple[Source, ...]) -> Table:
    """Learners against baselines, and planners against both."""
    planners = scores.means.drop(columns=_learners(scores).columns)
    others = pd.concat([_learners(scores), scores.views], axis=1)
    rows = []
    for name, first, second in (
        ("learners above baselines", _learners(scores), scores.views),
        ("planners above learners and baselines", planners, others),
    ):
        if len(first.columns) and len(second.columns):
            above, equal, below = paired.group_against(first, second)
            rows.append(
                {
                    "comparison of the best": name,
                    "above": len(above),
                    "equal": len(equal),
                    "below": len(below),
                    "games that are equal": " ".join(equal),
                }
            )
    return Table(
        "groups", "Games in which the best of one group is above the best of others.", pd.DataFrame(rows), sources
    )


def _above_random(scores: Scores, sources: tuple[Source, ...], bootstrap: Bootstrap) -> Table:
    """Each learner and planner against random play."""
    return Table(
        "above-random",
        "Games in which the mean is above that of random play, with the interval of their number, and those in which "
        "Welch's test (two-tailed, 99 %) finds a difference.",
        against_random.rows(scores, tuple(scores.means), bootstrap),
        sources,
        ("For a trained agent, a sample is the mean of a trial; for others, it is an episode.",),
        digits=0,
    )


def _add_scores(report: Report, scores: Scores, group: Group) -> None:
    rows = columns(scores, group)
    best_of = "of const and perturb, the best policy" if group.name != "planning" else "beside the best of the others"
    caption = f"Scores of the group {group.name} in each game; {best_of}."
    report.add_table(
        Table(f"{group.name}-scores", caption, _with_set(rows), report.sources, digits=1, best_of=tuple(rows))
    )
    best, ties = paired.times_best(rows)
    notes = [f"Tied in {game}: {', '.join(tied)}." for game, tied in ties.items()]
    report.add_table(
        Table(
            f"{group.name}-times-best",
            "Games in which each has the highest score; the first of a tie counts.",
            best.rename_axis("agent").rename("times best").reset_index(),
            report.sources,
            tuple(notes),
        )
    )


def _add_normalised(report: Report, scores: Scores, group: Group, ranges: list[Ranges]) -> None:
    matrix = scores.columns(group.agents).dropna()
    normalised = {each.name: each.normalise(matrix) for each in ranges}
    parts = [
        pd.concat({name: _with_set(frame)}, names=["normalisation"]).reset_index(0)
        for name, frame in normalised.items()
    ]
    if not len(matrix) or not parts:
        return
    report.add_table(
        Table(
            f"{group.name}-normalised",
            f"Normalised scores of the group {group.name}.",
            pd.concat(parts, ignore_index=True),
            report.sources,
        )
    )
    frames = {name: frame for name, frame in normalised.items() if name in _OWN_FIGURES}
    if frames:
        report.parts.append(
            Picture(
                f"{group.name}-normalised",
                f"Normalised scores of the group {group.name}.",
                figure.normalised_scores(frames),
                report.sources,
            )
        )


def _add_aggregates(report: Report, scores: Scores, group: Group, ranges: list[Ranges], bootstrap: Bootstrap) -> None:
    rows = _joined([aggregate.aggregate_rows(scores, each, group, bootstrap) for each in ranges])
    report.add_table(
        Table(
            f"{group.name}-aggregates",
            f"Aggregates of normalised scores of the group {group.name}.",
            rows,
            report.sources,
            notes.of_aggregates(scores, group, ranges),
        )
    )
    drawn = [each for each in ranges if each.name != "random"]  # the random-normalised are too large to draw
    _add_figures(report, scores, group, drawn, rows, bootstrap)


def _add_figures(
    report: Report, scores: Scores, group: Group, ranges: list[Ranges], rows: pd.DataFrame, bootstrap: Bootstrap
) -> None:
    """Returns the figures of `rows`, of the distributions and of the profiles, and the tables of the last two."""
    distributions = _joined([aggregate.distribution_rows(scores, each, group) for each in ranges])
    profiles = _joined([aggregate.profile_rows(scores, each, group, bootstrap) for each in ranges])
    selection = rows[rows["normalisation"] != "random"] if len(rows) else rows
    for name, caption, data, draw in (
        ("aggregates", "Average and median normalised scores", selection, figure.aggregate_scores),
        (
            "intervals",
            "Average, median, interquartile mean and optimality gap with their intervals",
            selection,
            functools.partial(figure.intervals, statistics=aggregate.statistics(scores, group)),
        ),
        ("distribution", "Share of games with a normalised score or a higher one", distributions, figure.distributions),
        ("profiles", "Share of trials above a normalised score, with its interval", profiles, figure.profiles),
    ):
        if not len(data):
            continue
        if name not in ("aggregates", "intervals"):
            report.add_table(Table(f"{group.name}-{name}", f"{caption}.", data, report.sources))
        whole = data["set"].iloc[-1]  # the set of all games is the last
        report.parts.append(
            Picture(
                f"{group.name}-{name}",
                f"{caption}, group {group.name}, games: {whole}.",
                draw(data[data["set"] == whole]),
                report.sources,
            )
        )


def _joined(parts: list[pd.DataFrame]) -> pd.DataFrame:
    found = [part for part in parts if len(part)]
    return pd.concat(found, ignore_index=True) if found else pd.DataFrame()


def _add_pairs(report: Report, scores: Scores, group: Group, bootstrap: Bootstrap) -> None:
    found = paired.pairs(scores, group)
    if not found:
        return
    report.untested += notes.of_untested(scores, group, found)
    report.add_table(
        Table(
            f"{group.name}-tests",
            "Games in which the agent of the row is significantly better--worse than that "
            "of the column (Welch's t-test over trials, two-tailed, 99 %).",
            paired.counts(found, group.agents, "better", "worse", "tested"),
            report.sources,
            (*notes.of_lacking(found), *notes.of_untested(scores, group, found)),
        )
    )
    report.add_table(
        Table(
            f"{group.name}-means",
            "Games in which the agent of the row has a higher--lower mean than that of the column.",
            paired.counts(found, group.agents, "higher", "lower", "games"),
            report.sources,
            notes.of_lacking(found),
        )
    )
    caption = "Probability that a trial of the first scores more than one of the second."
    rows = aggregate.improvement_rows(scores, group, bootstrap)
    name = f"{group.name}-improvement"
    report.add_table(Table(name, caption, rows, report.sources, notes.of_trials(scores, group)))
    if len(rows):
        report.parts.append(Picture(name, caption, figure.improvements(rows), report.sources))
