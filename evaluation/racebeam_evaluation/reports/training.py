"""What reports have of training episodes: learning curves and sample efficiency."""

import pandas as pd

from .. import efficiency
from ..bootstrap import Bootstrap
from ..curves import learning_curves
from ..normalise import human_and_random
from ..output import figure
from ..output.figure import Picture
from ..output.report import Report
from ..output.table import Table
from ..results import Results
from ..scores import Scores


def add_training(report: Report, results: Results, scores: Scores, bootstrap: Bootstrap) -> None:
    """Adds the tables and the figures of training episodes, if there are some."""
    if results.curves is None:
        return
    sources = results.curve_sources
    parts = [efficiency.rows(results.curves, ranges, bootstrap) for ranges in human_and_random(scores)]
    found = [part for part in parts if len(part)]
    if found:
        rows = pd.concat(found, ignore_index=True)
        caption = (
            "Interquartile mean over trials of all games, by how long the agents had been trained; a trial's score is "
            "the mean of its last 100 training episodes."
        )
        report.add_table(Table("efficiency", caption, rows, sources))
        report.parts.append(Picture("efficiency", caption, figure.efficiency(rows), sources))
    curves = learning_curves(results.curves)
    report.add_table(
        Table("learning-curves", "Scores of training episodes by the frames trained for.", curves, sources)
    )
    caption = "Scores of training episodes, with their standard error over trials."
    report.parts.append(Picture("learning-curves", caption, figure.learning_curves(curves), sources))
