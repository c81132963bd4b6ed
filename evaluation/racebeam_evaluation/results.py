"""What `racebeam experiment` leaves in its folder: evaluation episodes in results.csv, training episodes in curves.csv,
and the settings of both in plan.toml, and the roles of agents in agents.csv."""

import dataclasses
import pathlib

import pandas as pd

from .csv_file import Kind, Source, read
from .errors import BadInput
from .games import check_games

DIVERGED = "diverged"  # the end of a trial whose weights are not finite; its row has no score

_RESULTS = {
    "game": Kind.NAME,
    "image_md5": Kind.TEXT,
    "agent": Kind.NAME,
    "trial": Kind.WHOLE,
    "episode": Kind.WHOLE,
    "score": Kind.OPTIONAL,
    "end": Kind.TEXT,
}
_CURVES = {
    "game": Kind.NAME,
    "agent": Kind.NAME,
    "trial": Kind.WHOLE,
    "episode": Kind.WHOLE,
    "score": Kind.DECIMAL,
    "frames": Kind.WHOLE,
}
_AGENTS = {"agent": Kind.NAME, "role": Kind.TEXT}
_KEY = ["game", "agent", "trial", "episode"]

_OWN = {"name", "seed", "games", "agents", "trials"}  # keys in which the plans of one report may differ
_OWN_TABLES = {"images"}  # images are compared in results.csv

ROLES = ("learner", "planner", "baseline")

_Settings = dict[str, str]  # by KEY or TABLE.KEY, as the plan has it


@dataclasses.dataclass(frozen=True)
class Results:
    """The episodes of one or more folders."""

    episodes: pd.DataFrame  # a row for each evaluation episode; the columns of _RESULTS
    curves: (
        pd.DataFrame | None
    )  # a row for each training episode; the columns of _CURVES; None without training episodes
    sources: tuple[Source, ...]  # of episodes
    curve_sources: tuple[Source, ...]
    notes: tuple[str, ...] = ()  # sentences on what the folders' plans say differently
    roles: dict[str, str] = dataclasses.field(default_factory=dict)  # of ROLES, by agent; of those that agents.csv has


def read_results(folders: list[pathlib.Path]) -> Results:
    """Reads the results of all folders. Raises BadInput if one cannot be read, or if two contradict each other."""
    episodes, sources = zip(*(_episodes(folder) for folder in folders))
    found = [curves for folder in folders if (curves := _curves(folder))]
    together = _joined(list(episodes))
    _check_once(together, "evaluation")
    _check_images(together)
    curves = _joined([frame for frame, _ in found]) if found else None
    if curves is not None:
        _check_once(curves, "training")
    return Results(
        together, curves, sources, tuple(source for _, source in found), _differences(folders), _roles(folders)
    )


def _episodes(folder: pathlib.Path) -> tuple[pd.DataFrame, Source]:
    path = folder / "results.csv"
    frame, source = read(path, _RESULTS)
    unscored = frame["score"].isna() & (frame["end"] != DIVERGED)
    if unscored.any():
        raise BadInput(
            f"{path}, line {unscored.idxmax() + 2}: score is ''; expected a decimal number, or the end {DIVERGED}"
        )
    check_games(path, frame["game"], _games_of_plan(folder / "plan.toml"))
    return frame, source


def _curves(folder: pathlib.Path) -> tuple[pd.DataFrame, Source] | None:
    """None if no agent was trained: `racebeam experiment` then writes a file without rows."""
    path = folder / "curves.csv"
    if not path.exists():
        return None
    frame, source = read(path, _CURVES, may_be_empty=True)
    return (frame, source) if len(frame) else None


def _roles(folders: list[pathlib.Path]) -> dict[str, str]:
    """By agent. Raises BadInput for a role that there is not, and for an agent with two."""
    roles: dict[str, str] = {}
    for folder in folders:
        path = folder / "agents.csv"
        rows = read(path, _AGENTS, may_be_empty=True)[0].astype("str").itertuples() if path.exists() else ()
        for line, row in enumerate(rows, 2):
            if row.role not in ROLES:
                raise BadInput(
                    f"{path}, line {line}: role is '{row.role}'; expected {', '.join(ROLES[:-1])} or {ROLES[-1]}"
                )
            if roles.setdefault(row.agent, row.role) != row.role:
                raise BadInput(
                    f"{path}, line {line}: {row.agent} is a {row.role}, and a {roles[row.agent]} before; "
                    "expected one role of each agent"
                )
    return roles


def _joined(frames: list[pd.DataFrame]) -> pd.DataFrame:
    frame = pd.concat([frame.astype({"game": "str", "agent": "str"}) for frame in frames], ignore_index=True)
    return frame.sort_values(_KEY, kind="stable", ignore_index=True)


def _check_once(episodes: pd.DataFrame, kind: str) -> None:
    twice = episodes[episodes.duplicated(_KEY)]
    if len(twice):
        row = twice.iloc[0]
        raise BadInput(
            f"{kind} episode {row.episode} of trial {row.trial} of {row.agent} on {row.game} occurs twice; "
            f"expected each episode once, in all results together"
        )


def _check_images(episodes: pd.DataFrame) -> None:
    for game, images in episodes.groupby("game")["image_md5"]:
        different = sorted(set(images))
        if len(different) > 1:
            raise BadInput(f"{game} has the images {' and '.join(different)}; expected one image of each game")


def _differences(folders: list[pathlib.Path]) -> tuple[str, ...]:
    """A sentence for each setting that two plans have with different values. A folder without plan.toml is left out.

    A key that only one plan has does not count as a difference: the other plan lacks the agent."""
    seen: dict[str, tuple[str, str]] = {}
    sentences: dict[str, str] = {}
    for folder in folders:
        path = folder / "plan.toml"
        for key, value in (_settings(path) if path.is_file() else {}).items():
            first, other = seen.setdefault(key, (value, folder.name))
            if first != value:
                sentences.setdefault(
                    key,
                    f"The plans differ: {key} is {first} in {other}, and {value} in {folder.name}; scores are of both.",
                )
    return tuple(sentences.values())


def _games_of_plan(path: pathlib.Path) -> set[str]:
    """The games whose images a plan names: a user may have games of one's own."""
    games = set()
    table = ""
    for line in path.read_text(errors="replace").splitlines() if path.is_file() else ():
        if line.startswith("["):
            table = line
        elif table == "[images]":
            games.add(line.partition(" = ")[0])
    return games


def _settings(path: pathlib.Path) -> _Settings:
    """Of a plan as racebeam writes it: a table's head, or a key and its value, on each line."""
    settings: _Settings = {}
    table = ""
    for line in path.read_text(errors="replace").splitlines():
        if line.startswith("[") and line.endswith("]"):
            table = line[1:-1]
            continue
        key, equals, value = line.partition(" = ")
        if equals and key not in _OWN and table not in _OWN_TABLES:
            settings[f"{table}.{key}" if table else key] = value
    return settings
