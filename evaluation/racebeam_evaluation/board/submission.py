"""A submission: a folder with agent.toml, results.csv, logs, and curves.csv if the agent was trained."""

import dataclasses
import hashlib
import pathlib
import re

import pandas as pd

from ..csv_file import Kind, read
from ..errors import BadInput
from ..plan import preset_of
from ..results import DIVERGED, Results, read_folder, together
from .agent_file import About, read_about
from .episode_log import read_log

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,99}")  # of a unit, GAME-AGENT-TRIAL, and of an episode
_NAME_SAYS = "1 to 100 letters, digits, '-', '_' and '.', a letter or a digit first"
_FILES = ("agent.toml", "results.csv", "curves.csv", "agents.csv", "plan.toml")
# The columns of results.csv that the logs confirm.
_ROW = {
    name: Kind.TEXT
    for name in (
        *("unit", "game", "image_md5", "agent", "trial", "episode", "environment_seed", "agent_seed", "score"),
        *("frames", "decisions", "end", "lives", "state_hash", "log_digest", "version"),
    )
}


@dataclasses.dataclass(frozen=True)
class Episode:
    """A row of results.csv with its log, whose actions are not kept: a small file may hold very many."""

    row: dict[str, str]
    path: pathlib.Path
    replay: str  # EpisodeLog.link(); empty if nobody wants it


@dataclasses.dataclass(frozen=True)
class Submission:
    """A folder whose logs fit its rows."""

    about: About
    results: Results  # the agent is called About.name
    episodes: list[Episode]


def read_submission(folder: pathlib.Path, with_replays: bool = False) -> Submission:
    """Reads the folder. Raises BadInput with a sentence if something in it is not as it must be."""
    for name in _FILES:
        if (folder / name).is_symlink():
            raise BadInput(f"{folder / name} is a link; expected a file")
    about = read_about(folder / "agent.toml")
    results = read_folder(folder)
    rows = read(folder / "results.csv", _ROW)[0].astype("str")
    strangers = sorted(set(rows["agent"]) - {about.agent})
    if strangers:
        raise BadInput(
            f"{folder / 'results.csv'} has the agent '{strangers[0]}'; expected '{about.agent}', as agent.toml has"
        )
    lines = enumerate(rows.to_dict("records"), 2)
    episodes = [_episode(folder, line, row, about, with_replays) for line, row in lines if row["end"] != DIVERGED]
    if not episodes:
        raise BadInput(f"{folder / 'results.csv'}: every trial diverged; expected a score of one trial or more")
    return Submission(about, _named(results, about), episodes)


def _episode(folder: pathlib.Path, line: int, row: dict[str, str], about: About, with_replay: bool) -> Episode:
    place = f"{folder / 'results.csv'}, line {line}"
    for column in ("unit", "episode"):
        if not _NAME.fullmatch(row[column]):
            raise BadInput(f"{place}: {column} is '{row[column]}'; expected {_NAME_SAYS}")
    path = folder / "logs" / row["unit"] / f"{row['episode']}.episode"
    for above in (path.parent.parent, path.parent):
        if above.is_symlink():
            raise BadInput(f"{above} is a link; expected a folder")
    log = read_log(path)
    for column, value in row.items():
        if value != log.columns.get(column, ""):
            raise BadInput(f"{place}: {column} is '{value}'; its log has '{log.columns.get(column, '')}'")
    if about.preset != (found := preset_of(" ".join(f"{key}={value}" for key, value in log.settings.items()))):
        raise BadInput(f"{place}: the settings of its log are those of {found}; expected {about.preset}")
    if about.phrase and row["environment_seed"] != (seed := str(seed_of_phrase(about.phrase, row))):
        raise BadInput(f"{place}: environment_seed is '{row['environment_seed']}'; the phrase gives '{seed}'")
    return Episode(row, path, log.link(f"{row['unit']}, episode {row['episode']}") if with_replay else "")


def seed_of_phrase(phrase: str, row: dict[str, str]) -> int:
    """The seed of the row's episode (docs/episodes.md, "Seeds from a phrase")."""
    text = "\n".join((phrase, row["game"], row["trial"], row["episode"]))
    return max(int(hashlib.sha256(text.encode()).hexdigest()[:8], 16) & 0x7FFFFFFF, 1)


def _named(results: Results, about: About) -> Results:
    """Returns the results with About.name as the name of the agent."""
    whole = together([results])

    def renamed(frame: pd.DataFrame) -> pd.DataFrame:
        return frame[frame["agent"] == about.agent].assign(agent=about.name)

    curves = None if whole.curves is None else renamed(whole.curves)
    return dataclasses.replace(
        whole,
        episodes=renamed(whole.episodes),
        curves=curves if curves is not None and len(curves) else None,
        roles={about.name: about.role},
    )
