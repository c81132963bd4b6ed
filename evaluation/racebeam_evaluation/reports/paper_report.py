"""The report `--paper`: the metrics of the scores that the paper prints, and what it prints beside what was rebuilt."""

import pandas as pd

from .. import paired
from ..bootstrap import Bootstrap
from ..csv_file import Source, digest
from ..games import DATA, published
from ..output.report import Report
from ..output.table import Table
from ..published.paper import paper_scores
from ..scores import Scores
from .paper2013 import add_groups, columns

# The row "Times Best" of the two tables of scores.
_TIMES_BEST = {
    "learning": {"basic": 6, "bass": 17, "disco": 1, "lsh": 8, "ram": 8, "random": 2, "const": 9, "perturb": 4},
    "planning": {"full_tree": 4, "uct": 45, "best_learner": 3, "best_baseline": 3},
}


def evaluate_paper(bootstrap: Bootstrap) -> Report:
    """The report on the paper's scores."""
    scores = paper_scores()
    sources = tuple(digest(DATA / f"paper2013/{name}.csv") for name in ("learners", "planners"))
    report = Report("The scores that the paper prints", list(scores.notes), sources)
    report.add_table(_claims(scores, sources))
    add_groups(report, scores, bootstrap)
    report.add_table(_paired_counts(scores, sources))
    report.add_table(
        Table(
            "beginner",
            "Scores of a beginner in five games.",
            published("paper2013/human").reset_index(),
            (digest(DATA / "paper2013/human.csv"),),
        )
    )
    return report


def _claims(scores: Scores, sources: tuple[Source, ...]) -> Table:
    """Statements of the paper that its tables of scores decide."""
    rows = []
    for group in scores.groups:
        best, _ = paired.times_best(columns(scores, group))
        rows += [(f"times best: {agent}", value, int(best[agent])) for agent, value in _TIMES_BEST[group.name].items()]
    learners, planners = (scores.columns(group.agents) for group in scores.groups)
    for name, value, first, second in (
        ("learners above baselines", 40, learners, scores.views),
        ("planners above both", 49, planners, pd.concat([learners, scores.views], axis=1)),
    ):
        above, equal, _ = paired.group_against(first, second)
        rows += [(name, value, len(above)), (f"{name} or equal", value, len(above) + len(equal))]
    frame = pd.DataFrame(rows, columns=["statement", "printed", "rebuilt"])
    return Table("claims", "What the paper says of its scores, and what they give.", frame, sources)


def _paired_counts(scores: Scores, sources: tuple[Source, ...]) -> Table:
    """The printed paired tests beside the counts of means, which any significant difference is one of."""
    table = published("paper2013/paired").reset_index()
    pairs = {(pair.first, pair.second): pair for group in scores.groups for pair in paired.pairs(scores, group)}
    found = [pairs[row.first, row.second] for row in table.itertuples()]
    frame = table.assign(
        higher=[len(pair.higher) for pair in found],
        lower=[len(pair.lower) for pair in found],
        tied=[len(pair.games) - len(pair.higher) - len(pair.lower) for pair in found],
    )
    note = (
        "A test that finds a difference finds it in the direction of the means. Means that are printed as "
        "tied may differ."
    )
    return Table(
        "paired",
        "Printed tests (better, worse) beside the games with a higher, lower and tied printed mean.",
        frame,
        (*sources, digest(DATA / "paper2013/paired.csv")),
        (note,),
    )
