"""The figures, as SVG and PNG. The same data give the same bytes."""

import dataclasses
import io
from collections.abc import Iterator

import matplotlib
import matplotlib.lines
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, MaxNLocator

from ..csv_file import Source
from ..errors import printable
from .table import made_from

_STYLE = matplotlib.rc_context(
    {  # a decorator
        "svg.hashsalt": "racebeam",
        "svg.fonttype": "path",
        "font.family": "DejaVu Sans",
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.dpi": 100,
    }
)
_DOTS_PER_INCH = 150


@dataclasses.dataclass(frozen=True)
class Picture:
    """One figure."""

    name: str  # of the files, without ending
    caption: str  # a sentence
    figure: Figure
    sources: tuple[Source, ...]

    @_STYLE
    def files(self) -> dict[str, bytes]:
        """Both forms by file name."""
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")  # the layout is settled, for both forms
        about = "; ".join(made_from(self.sources))
        return {
            f"{self.name}.svg": self._encode("svg", {"Date": None, "Creator": None, "Description": about}),
            f"{self.name}.png": self._encode("png", {"Software": None, "Description": about}),
        }

    def _encode(self, form: str, metadata: dict[str, str | None]) -> bytes:
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format=form, dpi=_DOTS_PER_INCH, metadata=metadata)
        return buffer.getvalue()


def _grid(rows: int, columns: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def _show_all(axes: Axes, scores: pd.Series) -> None:
    """Makes the scale of scores logarithmic beyond -1 and 1 if some are far beyond."""
    if not scores.dropna().between(-2, 2).all():
        axes.set_xscale("symlog", linthresh=1)


def _colours(agents: list[str]) -> dict[str, str]:
    return {agent: f"C{index % 10}" for index, agent in enumerate(agents)}


def _literal(name: str) -> str:
    """The name as a label: not as a formula, which matplotlib reads between two $, and without what XML has not."""
    return printable(name).replace("$", r"\$")


def _parts(rows: pd.DataFrame, by: str) -> Iterator[tuple[str, pd.DataFrame]]:
    """The rows of each value of a column, in the order of their first appearance."""
    for value in dict.fromkeys(rows[by]):
        yield str(value), rows[rows[by] == value]


@_STYLE
def normalised_scores(normalised: dict[str, pd.DataFrame]) -> Figure:
    """A panel for each normalisation, a row for each game, a dot for each agent."""
    games = list(next(iter(normalised.values())).index)
    figure, panels = _grid(1, len(normalised), 3.2 * len(normalised), 1.2 + 0.19 * len(games))
    for axes, (name, scores) in zip(panels, normalised.items()):
        _show_all(axes, scores.stack())
        for agent, colour in _colours(list(scores)).items():
            axes.plot(scores[agent], range(len(games)), "o", color=colour, markersize=4, label=_literal(agent))
        axes.set(
            title=f"{name} scores",
            yticks=range(len(games)),
            ylim=(len(games) - 0.5, -0.5),
            yticklabels=[_literal(game) for game in games] if axes is panels[0] else [],
        )
        axes.grid(axis="y", linewidth=0.3)
    panels[-1].legend(loc="upper left", bbox_to_anchor=(1, 1))
    return figure


@_STYLE
def aggregate_scores(rows: pd.DataFrame) -> Figure:
    """Two panels for each normalisation: the average and the median of each agent."""
    names = list(dict.fromkeys(rows["normalisation"]))
    figure, panels = _grid(len(names), 2, 6.4, 1.9 * len(names))
    for line, name in enumerate(names):
        selection = rows[rows["normalisation"] == name]
        for axes, statistic in zip(panels[2 * line :], ("average", "median")):
            axes.bar(
                selection["agent"].map(_literal),
                selection[statistic],
                color=list(_colours(list(selection["agent"])).values()),
            )
            axes.set(title=f"{statistic} {name} score")
            axes.axhline(0, color="black", linewidth=0.5)
    return figure


@_STYLE
def intervals(rows: pd.DataFrame, statistics: list[str]) -> Figure:
    """A line of panels for each normalisation, a panel for each statistic: the interval of each agent."""
    names = list(dict.fromkeys(rows["normalisation"]))
    agents = list(dict.fromkeys(rows["agent"]))
    colours = _colours(agents)
    figure, panels = _grid(len(names), len(statistics), 2.4 * len(statistics), (0.9 + 0.26 * len(agents)) * len(names))
    for line, (name, shown) in enumerate(_parts(rows, "normalisation")):
        for column, (axes, statistic) in enumerate(zip(panels[line * len(statistics) :], statistics)):
            _bars(axes, shown, statistic, [colours[agent] for agent in shown["agent"]])
            axes.set(
                title=f"{statistic}\n{name}",
                yticklabels=[_literal(agent) for agent in shown["agent"]] if column == 0 else [],
            )
    return figure


@_STYLE
def improvements(rows: pd.DataFrame) -> Figure:
    """A row for each pair of agents: the probability that a trial of the first scores more, with its interval."""
    pairs = rows.assign(pair=rows["first"] + " over " + rows["second"])
    figure, (axes,) = _grid(1, 1, 6.4, 0.9 + 0.26 * len(pairs))
    colours = _colours(list(dict.fromkeys(pairs["first"])))
    _bars(axes, pairs, "probability", [colours[agent] for agent in pairs["first"]])
    axes.axvline(0.5, color="black", linewidth=0.5)
    axes.set(yticklabels=[_literal(pair) for pair in pairs["pair"]], xlim=(0, 1), xlabel="probability of improvement")
    return figure


def _bars(axes: Axes, rows: pd.DataFrame, statistic: str, colours: list[str]) -> None:
    """A bar from "low" to "high" of the statistic for each row, in the row's colour, with a mark at its value."""
    places = np.arange(len(rows))
    value, low, high = (
        rows[name].to_numpy(dtype=float) for name in (statistic, f"{statistic} low", f"{statistic} high")
    )
    axes.barh(
        places,
        np.nan_to_num(high - low),
        left=np.where(np.isnan(low), value, low),
        height=0.6,
        color=colours,
        alpha=0.6,
    )
    axes.vlines(value, places - 0.3, places + 0.3, color="black", linewidth=1.2)
    axes.set(yticks=places, ylim=(len(rows) - 0.5, -0.5))
    axes.use_sticky_edges = False  # else the panel begins where the lowest bar does
    axes.margins(x=0.05)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.grid(axis="x", linewidth=0.3)


@_STYLE
def efficiency(rows: pd.DataFrame) -> Figure:
    """A panel for frames and one for decisions: the IQM of each agent by how long it was trained, with its interval."""
    kinds = list(dict.fromkeys(zip(rows["normalisation"], rows["axis"])))
    figure, panels = _grid(-(-len(kinds) // 2), min(2, len(kinds)), 3.6 * min(2, len(kinds)), 2.8 * -(-len(kinds) // 2))
    colours = _colours(list(dict.fromkeys(rows["agent"])))
    for axes, (name, axis) in zip(panels, kinds):
        selection = rows[(rows["normalisation"] == name) & (rows["axis"] == axis)]
        for agent, curve in _parts(selection, "agent"):
            band = (curve["IQM low"], curve["IQM high"])
            _curve_with_band(axes, curve["trained for"], curve["IQM"], band, colours[agent], _literal(agent))
        axes.set(xlabel=axis, ylabel=f"IQM of {name} scores")
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))
    for axes in panels[len(kinds) :]:
        axes.set_axis_off()
    panels[0].legend()
    return figure


@_STYLE
def distributions(rows: pd.DataFrame) -> Figure:
    """A panel for each normalisation: the share of games with a score or a higher one, as steps."""
    names = list(dict.fromkeys(rows["normalisation"]))
    figure, panels = _grid(1, len(names), 3.4 * len(names), 3)
    for axes, (name, shown) in zip(panels, _parts(rows, "normalisation")):
        _show_all(axes, shown["score"])
        colours = _colours(list(dict.fromkeys(shown["agent"])))
        for agent, steps in _parts(shown, "agent"):
            # Up to a score, the share is that of the games that have this score or more.
            axes.step(steps["score"], steps["share of games"], where="pre", color=colours[agent], label=_literal(agent))
        axes.set(title=f"{name} scores", xlabel="score", ylabel="share of games", ylim=(0, 1.02))
    panels[-1].legend()
    return figure


@_STYLE
def profiles(rows: pd.DataFrame) -> Figure:
    """A panel for each normalisation: performance profiles with their intervals."""
    names = list(dict.fromkeys(rows["normalisation"]))
    figure, panels = _grid(1, len(names), 3.4 * len(names), 3)
    for axes, (name, shown) in zip(panels, _parts(rows, "normalisation")):
        colours = _colours(list(dict.fromkeys(shown["agent"])))
        for agent, curve in _parts(shown, "agent"):
            _curve_with_band(
                axes,
                curve["threshold"],
                curve["share of trials"],
                (curve["low"], curve["high"]),
                colours[agent],
                _literal(agent),
            )
        axes.set(title=f"{name} scores", xlabel="threshold", ylabel="share of trials above it", ylim=(0, 1.02))
    panels[-1].legend()
    return figure


@_STYLE
def learning_curves(rows: pd.DataFrame) -> Figure:
    """A panel for each game: the score of training episodes against frames, with the standard error over trials."""
    games = list(dict.fromkeys(rows["game"]))
    columns = min(3, len(games))
    lines = -(-len(games) // columns)
    figure, panels = _grid(lines, columns, 3.4 * columns, 2.4 * lines)
    colours = _colours(list(dict.fromkeys(rows["agent"])))
    for axes, (game, shown) in zip(panels, _parts(rows, "game")):
        for agent, curve in _parts(shown, "agent"):
            error = curve["standard error"].fillna(0)
            _curve_with_band(
                axes,
                curve["frames"],
                curve["score"],
                (curve["score"] - error, curve["score"] + error),
                colours[agent],
                _literal(agent),
            )
        axes.set(title=_literal(game), xlabel="frames", ylabel="score")
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))
    for axes in panels[len(games) :]:
        axes.set_axis_off()
    handles = [
        matplotlib.lines.Line2D([], [], color=colour, label=_literal(agent)) for agent, colour in colours.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(8, len(handles)))
    return figure


def _curve_with_band(
    axes: Axes, x: pd.Series, y: pd.Series, band: tuple[pd.Series, pd.Series], colour: str, label: str
) -> None:
    axes.plot(x, y, color=colour, label=label, linewidth=1.2)
    low, high = (np.asarray(bound, dtype=float) for bound in band)
    axes.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
