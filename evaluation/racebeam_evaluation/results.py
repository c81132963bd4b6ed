"""What `racebeam experiment` leaves in its folder: evaluation episodes in results.csv, training episodes in curves.csv,
and the settings of both in plan.toml, and the roles of agents in agents.csv."""

import dataclasses
import pathlib

import pandas as pd

from .csv_file import Kind, Source, read
from .errors import BadInput
from .games import check_games
from .plan import Plan, Protocol, plan_of

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
_MAY_HAVE = {"decisions": Kind.WHOLE}
_AGENTS = {"agent": Kind.NAME, "role": Kind.TEXT}
_KEY = ["game", "agent", "trial", "episode"]

_OWN = {"name", "seed", "games", "agents", "trials"}  # keys in which the plans of one report may differ
_OWN_TABLES = ("images.", "backgrounds.")  # images are compared in results.csv
_HARMLESS = {"version", "evaluation_episodes"}  # keys that may differ if the report says so

ROLES = ("learner", "planner", "baseline")


@dataclasses.dataclass(frozen=True)
class Results:
    """The episodes of one or more folders."""

    episodes: pd.DataFrame  # a row for each evaluation episode; the columns of _RESULTS
    curves: pd.DataFrame | None  # a row for each training episode; the columns of _CURVES; None without any
    sources: tuple[Source, ...]  # of episodes
    curve_sources: tuple[Source, ...]
    notes: tuple[str, ...] = ()  # sentences on what the folders' plans say differently
    roles: dict[str, str] = dataclasses.field(default_factory=dict)  # of ROLES, by agent; of those that agents.csv has
    plans: tuple[Plan, ...] = ()  # of the folders

    def protocols(self, agent: str) -> list[Protocol]:
        """How the plans say that the agent was run, each way once; one that is unknown if no plan says it."""
        protocols = [self._as_far_as_run(plan.protocol(agent), agent) for plan in self.plans]
        return list(dict.fromkeys(each for each in protocols if each != Protocol())) or [Protocol()]

    def _as_far_as_run(self, protocol: Protocol, agent: str) -> Protocol:
        """The protocol with the number of trials that are here, if an experiment goes on: "1 of 3"."""
        trials = self.episodes[self.episodes["agent"] == agent].groupby("game")["trial"].nunique()
        planned = protocol.trials.replace(",", "")
        if not len(trials) or not planned.isdigit() or trials.min() >= int(planned):
            return protocol
        return dataclasses.replace(protocol, trials=f"{trials.min()} of {protocol.trials}")


def read_folder(folder: pathlib.Path) -> Results:
    """The results of one folder."""
    plan = plan_of(folder)
    episodes, source = _episodes(folder, plan)
    curves, curve_source = _curves(folder, plan) or (None, None)
    sources = (curve_source,) if curve_source else ()
    return Results(episodes, curves, (source,), sources, roles=_roles(folder), plans=(plan,))


def together(parts: list[Results], notes: tuple[str, ...] = ()) -> Results:
    """Results as one. Raises BadInput if two contradict each other."""
    episodes = _joined([part.episodes for part in parts])
    _check_once(episodes, "evaluation")
    _check_images(episodes)
    tables = [part.curves for part in parts if part.curves is not None]
    curves = _joined(tables) if tables else None
    if curves is not None:
        _check_once(curves, "training")
    roles: dict[str, str] = {}
    for part in parts:
        for agent, role in part.roles.items():
            if roles.setdefault(agent, role) != role:
                raise BadInput(f"{agent} is a {role}, and a {roles[agent]} elsewhere; expected one role of each agent")
    return Results(
        episodes,
        curves,
        tuple(source for part in parts for source in part.sources),
        tuple(source for part in parts for source in part.curve_sources),
        (*notes, *(note for part in parts for note in part.notes)),
        roles,
        tuple(plan for part in parts for plan in part.plans),
    )


def _episodes(folder: pathlib.Path, plan: Plan) -> tuple[pd.DataFrame, Source]:
    path = folder / "results.csv"
    frame, source = read(path, _RESULTS)
    unscored = frame["score"].isna() & (frame["end"] != DIVERGED)
    if unscored.any():
        raise BadInput(
            f"{path}, line {unscored.idxmax() + 2}: score is ''; expected a decimal number, or the end {DIVERGED}"
        )
    check_games(path, frame["game"], plan.games)
    return frame, source


def _curves(folder: pathlib.Path, plan: Plan) -> tuple[pd.DataFrame, Source] | None:
    """The training episodes; None if no agent was trained: the file then has no rows."""
    path = folder / "curves.csv"
    if not path.exists():
        return None
    frame, source = read(path, _CURVES, may_be_empty=True, optional=_MAY_HAVE)
    check_games(path, frame["game"], plan.games)
    return (frame, source) if len(frame) else None


def _roles(folder: pathlib.Path) -> dict[str, str]:
    """Returns the role of each agent. Raises BadInput for an unknown role, and for an agent with two."""
    roles: dict[str, str] = {}
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
        different = sorted(set(images) - {""})  # files of other programs do not name the image
        if len(different) > 1:
            raise BadInput(f"{game} has the images {' and '.join(different)}; expected one image of each game")


def differences(folders: list[pathlib.Path], mix: bool) -> tuple[str, ...]:
    """A sentence for each setting that two plans have with different values. A folder without plan.toml is left out.

    A key that only one plan has does not count as a difference: the other plan lacks the agent. Raises BadInput with
    the first sentence if the setting changes scores, unless `mix`."""
    sources: dict[str, tuple[str, str]] = {}
    sentences: dict[str, str] = {}
    for folder in folders:
        for key, value in plan_of(folder).settings().items():
            if key.split(".")[-1] in _OWN or key.startswith(_OWN_TABLES):
                continue
            first, other = sources.setdefault(key, (value, folder.name))
            if first == value or key in sentences:
                continue
            words = f"The plans differ: {key} is {first} in {other}, and {value} in {folder.name}"
            if not mix and key.split(".")[-1] not in _HARMLESS:
                raise BadInput(f"{words}; expected equal settings, or --mix")
            sentences[key] = f"{words}; scores are of both."
    return tuple(sentences.values())
