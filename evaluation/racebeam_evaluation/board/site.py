"""Builds the site from folders of submissions. A broken folder is named; the others are shown."""

import dataclasses
import pathlib

import pandas as pd

from ..aggregate import normalised_matrix
from ..bootstrap import AGGREGATES, Bootstrap, aggregates
from ..curves import learning_curves
from ..errors import BadInput
from ..games import in_order
from ..normalise import human
from ..output import figure
from ..output.figure import Picture
from ..results import Results, together
from ..scores import Scores, scores_of
from . import page
from .submission import Submission, read_submission

Files = dict[str, bytes | pathlib.Path]  # by their paths in the site: contents, or a file to copy

_HUMAN = human()
_MOST_CURVES = 200  # games, in the order of in_order(); a picture has a panel for each
_SHOWN = ("IQM", "median", "average")


@dataclasses.dataclass
class Site:
    """What a run writes."""

    files: Files
    broken: list[str]  # a sentence for each folder that is not shown
    submissions: int


def build(folders: list[pathlib.Path], bootstrap: Bootstrap, viewer: str) -> Site:
    """The pages of all folders that can be read. Raises BadInput if none of them can.

    viewer: the address of a viewer in which links replay episodes; without one, there are links to logs only."""
    found: dict[str, Submission] = {}
    images: dict[str, str] = {}
    broken = []
    for folder in folders:
        try:
            submission = read_submission(folder, with_replays=bool(viewer))
            if submission.about.name in found:
                raise BadInput(f"{folder} is of {submission.about.name}, which is there; expected another version")
            _check_images(folder, submission, images)
            found[submission.about.name] = submission
        except BadInput as error:
            broken.append((folder, str(error)))
    if not found:
        raise BadInput("; ".join(sentence for _, sentence in broken))
    return _site(list(found.values()), broken, bootstrap, viewer)


def _from_here(folder: pathlib.Path, sentence: str) -> str:
    """The sentence without the path of the folder's parent, which is nobody's business on a page."""
    return sentence.replace(f"{folder.parent}/", "")


def _check_images(folder: pathlib.Path, submission: Submission, images: dict[str, str]) -> None:
    """Scores of different images of a game are not compared: the first one counts. Trials that diverged count, too."""
    episodes = submission.results.episodes
    ours = {game: image for game, image in zip(episodes["game"], episodes["image_md5"]) if image}
    for game, image in ours.items():
        if images.get(game, image) != image:
            raise BadInput(f"{folder}: the image of {game} is {image}; expected {images[game]}, as the others have")
    images.update(ours)


def _site(
    submissions: list[Submission], broken: list[tuple[pathlib.Path, str]], bootstrap: Bootstrap, viewer: str
) -> Site:
    files: Files = {}
    pages = {}
    for place, submission in enumerate(submissions, 1):
        logs = {f"logs/{place}/{each.row['unit']}/{each.row['episode']}.episode": each for each in submission.episodes}
        files |= {path: each.path for path, each in logs.items()}
        pages[submission.about.name] = f"agent{place}.html"
        files[pages[submission.about.name]] = page.of_submission(submission, logs, viewer).encode()
    parts = [page.proof()]
    for preset in dict.fromkeys(each.about.preset for each in submissions):
        selection = [each for each in submissions if each.about.preset == preset]
        section, pictures = _section(preset, selection, pages, bootstrap)
        parts += section
        files |= pictures
    if broken:
        items = "".join(f'<li class="broken">{page.text(_from_here(*each))}</li>' for each in broken)
        parts.append(f"<h2>Not shown</h2>\n<ul>{items}</ul>")
    files["index.html"] = page.document("Scores of agents", *parts).encode()
    return Site(files, [sentence for _, sentence in broken], len(submissions))


def _section(
    preset: str, submissions: list[Submission], pages: dict[str, str], bootstrap: Bootstrap
) -> tuple[list[str], Files]:
    """Returns the section of a preset, and its pictures. Scores of different presets are not compared."""
    results = together([each.results for each in submissions])
    scores = scores_of(results)
    parts = [f"<h2>Preset {page.text(preset)}</h2>", _standings(submissions, scores, pages, bootstrap)]
    parts.append(_score_table(scores, submissions, pages))
    curves, pictures = _curves(preset, results)
    return parts + curves, pictures


def _standings(submissions: list[Submission], scores: Scores, pages: dict[str, str], bootstrap: Bootstrap) -> str:
    """A row for each agent, the highest IQM first."""
    rows = []
    for each in submissions:
        about = each.about
        games = [game for game in _scores_of(scores, about.name).dropna().index if not _HUMAN.without([game])]
        values = _aggregates(scores, about.name, games, bootstrap)
        cells = [page.link(pages[about.name], about.name), page.text(about.words[:200]), f"{about.training_frames:,}"]
        rows.append((values[0][0] if values else float("-inf"), [*cells, str(len(games)), *_cells(values)]))
    rows.sort(key=lambda row: -row[0])
    header = ["agent", "its authors' words", "training frames", "games with human scores"]
    header += [f"{name} (95 % interval)" for name in _SHOWN]
    note = (
        "<p>Human-normalised scores. Agents with different games are not comparable by them. "
        "An agent with a single trial in some game has no interval.</p>"
    )
    return page.table(header, [cells for _, cells in rows], range(2, 7)) + note


def _scores_of(scores: Scores, name: str) -> pd.Series:
    return (scores.references if name in scores.references else scores.means)[name]


def _aggregates(scores: Scores, name: str, games: list[str], bootstrap: Bootstrap) -> list[tuple[float, float, float]]:
    if not games:
        return []
    estimate = bootstrap.estimate(aggregates, normalised_matrix(scores, _HUMAN, name, games))
    order = [AGGREGATES.index(statistic) for statistic in _SHOWN]
    return [(float(estimate.value[i]), float(estimate.low[i]), float(estimate.high[i])) for i in order]


def _cells(values: list[tuple[float, float, float]]) -> list[str]:
    cells = [
        page.number(value, 3) + ("" if low != low else f" ({page.number(low, 3)} to {page.number(high, 3)})")
        for value, low, high in values
    ]
    return cells or ["n/a"] * len(_SHOWN)


def _score_table(scores: Scores, submissions: list[Submission], pages: dict[str, str]) -> str:
    """A row for each game. A score leads to its episodes."""
    names = [each.about.name for each in submissions]
    rows = []
    for game in scores.means.index:
        cells = [page.text(str(game))]
        for name in names:
            score = float(_scores_of(scores, name)[game])
            cells.append("" if score != score else page.link(f"{pages[name]}#{game}", page.number(score)))
        rows.append(cells)
    return page.table(["game", *names], rows, range(1, 1 + len(names)))


def _curves(preset: str, results: Results) -> tuple[list[str], Files]:
    """Returns the learning curves, and the files of their picture. Both are empty without training episodes."""
    if results.curves is None:
        return [], {}
    games = in_order(list(set(results.curves["game"])))
    curves = learning_curves(results.curves[results.curves["game"].isin(games[:_MOST_CURVES])])
    caption = "Scores of training episodes, which leave no logs and were not checked."
    if len(games) > _MOST_CURVES:
        caption += f" Of {len(games)} games, the first {_MOST_CURVES} are shown."
    picture = Picture(f"curves-{preset}", caption, figure.learning_curves(curves), results.curve_sources)
    return [f"<p>{caption}</p>", f'<img src="{picture.name}.svg" alt="{caption}">'], {**picture.files()}
