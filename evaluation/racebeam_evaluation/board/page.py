"""The page of the board and those of its submissions, as HTML without scripts."""

import html
import math

from .submission import Episode, Submission

_STYLE = """body { font: 15px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0 }
th { vertical-align: bottom }
td:first-child { white-space: nowrap }
th, td { padding: .2em .7em; border-bottom: 1px solid #ddd; text-align: left }
.number { text-align: right; font-variant-numeric: tabular-nums }
img { max-width: 100% }
.broken { color: #a00 }"""

_PROOF = (
    "Each score is that of a log with the actions of its episode. "
    "The logs were read here, and fit the rows. They were not played again: <code>racebeam verify</code> does that. "
    "A log proves that its actions give its score. It does not prove who chose the actions."
)


def document(title: str, *parts: str) -> str:
    """A page."""
    return (
        f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>{text(title)}</title>\n'
        f"<style>\n{_STYLE}\n</style>\n<h1>{text(title)}</h1>\n" + "\n".join(parts) + "\n</html>\n"
    )


def text(words: str) -> str:
    """Returns words without markup."""
    return html.escape(words)


def number(value: float, digits: int = 1) -> str:
    """A number for readers."""
    return "n/a" if math.isnan(value) else f"{value:,.{digits}f}"


def link(address: str, words: str) -> str:
    """A link with these words."""
    return f'<a href="{html.escape(address)}">{text(words)}</a>'


def table(header: list[str], rows: list[list[str]], numbers: range) -> str:
    """A table of cells that are markup already. The columns of `numbers` hold numbers."""

    def line(tag: str, cells: list[str]) -> str:
        kinds = [' class="number"' if index in numbers else "" for index in range(len(cells))]
        return "<tr>" + "".join(f"<{tag}{kind}>{cell}</{tag}>" for kind, cell in zip(kinds, cells)) + "</tr>"

    lines = [line("th", [text(name) for name in header]), *(line("td", row) for row in rows)]
    return "\n".join(["<table>", *lines, "</table>"])


def of_submission(submission: Submission, logs: dict[str, Episode], viewer: str) -> str:
    """The page of one submission: a table for each game, a row for each episode. `logs`: by their paths in the site."""
    about = submission.about
    parts = [f"<p>{text(about.words)}</p>"] if about.words else []
    parts.append(f"<p>{link(about.link, about.link)}</p>" if about.link else "")
    parts.append(
        f"<p>Preset {text(about.preset)}, {about.training_frames:,} frames of training. {link('index.html', 'All')}</p>"
    )
    games: dict[str, list[list[str]]] = {}
    for path, episode in logs.items():
        games.setdefault(episode.row["game"], []).append(_row(path, episode, viewer))
    header = ["trial", "episode", "score", "frames", "end", "log"] + (["replay"] if viewer else [])
    for game, rows in games.items():
        parts.append(f'<h2 id="{text(game)}">{text(game)}</h2>\n' + table(header, rows, range(4)))
    return document(about.name, *parts, f"<p>{_PROOF}</p>")


def _row(path: str, episode: Episode, viewer: str) -> list[str]:
    row = episode.row
    cells = [text(row[name]) for name in ("trial", "episode", "score", "frames", "end")] + [link(path, "log")]
    if viewer:
        cells.append(link(f"{viewer}#{episode.replay}", "replay"))
    return cells


def proof() -> str:
    """What the page shows, and what it does not."""
    return f"<p>{_PROOF}</p>"
