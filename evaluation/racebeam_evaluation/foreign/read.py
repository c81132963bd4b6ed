"""Reads results files of Dopamine, DQN Zoo and rliable, and tells them apart by their contents."""

import hashlib
import io
import json
import pathlib
from collections.abc import Sequence
from typing import TypeGuard

import pandas as pd

from ..csv_file import MOST_DECIMAL, MOST_WHOLE, Kind, Source, content_of, read
from ..errors import BadInput
from ..results import Results
from .names import our_name

_MOST_BYTES = 2**28
_FRAMES_OF_A_DECISION = 4  # of Dopamine and of DQN Zoo
_FRAMES_OF_AN_ITERATION = 1_000_000  # of Dopamine
_ZOO = {
    "environment_name": Kind.NAME,
    "seed": Kind.WHOLE,
    "frame": Kind.WHOLE,
    "eval_episode_return": Kind.DECIMAL,
}
_SCORES = "decimal numbers from -1e15 to 1e15"
_ACCEPTED = (
    "a list of objects with Agent, Iteration and Value (Dopamine), or an object with a list of scores for each game "
    "(rliable)"
)


def read_file(path: pathlib.Path) -> Results:
    """The results in a file GAME.json of Dopamine, AGENT.csv of DQN Zoo, or AGENT.json of rliable."""
    if path.suffix == ".csv":
        return _dqn_zoo(path)
    if path.suffix != ".json":
        raise BadInput(f"{path} is neither a folder, nor a file .csv of DQN Zoo, nor .json of Dopamine or rliable")
    content = content_of(path, _MOST_BYTES, "a JSON file")
    try:
        found = json.load(io.BytesIO(content))
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path} is not JSON: {error}; expected {_ACCEPTED}") from error
    source = Source(path.name, hashlib.sha256(content).hexdigest())
    return _dopamine(path, found, source) if isinstance(found, list) else _rliable(path, found, source)


def _dopamine(path: pathlib.Path, found: list[object], source: Source) -> Results:
    """A row for each iteration of 1,000,000 frames, with the mean of its training episodes. A trial of an agent begins
    where its iterations begin anew. The score of a trial is that of its last iteration."""
    game = our_name(path, path.stem)
    rows = []
    trials: dict[str, tuple[int, int]] = {}  # by agent: the trial and its last iteration
    for number, entry in enumerate(found):
        agent, iteration, value = _entry(path, number, entry)
        trial, before = trials.get(agent, (0, -1))
        trials[agent] = (trial + (iteration <= before), iteration)
        rows.append((game, _agent(agent), trials[agent][0], iteration, value, _FRAMES_OF_AN_ITERATION))
    return _of_iterations(path, rows, source)


def _entry(path: pathlib.Path, number: int, entry: object) -> tuple[str, int, float]:
    if isinstance(entry, dict):
        agent, iteration, value = (entry.get(key) for key in ("Agent", "Iteration", "Value"))
        if isinstance(agent, str) and agent and _is_iteration(iteration) and _is_score(value):
            return agent, iteration, float(value)
    raise BadInput(f"{path}: entry {number + 1} is {json.dumps(entry)[:100]}; expected {_ACCEPTED}")


def _dqn_zoo(path: pathlib.Path) -> Results:
    """A row for each iteration of a seed, with the mean of its evaluation. The agent is named by the file."""
    frame, source = read(path, _ZOO)
    frame = frame.sort_values(["environment_name", "seed", "frame"], kind="stable")
    totals = frame.groupby(["environment_name", "seed"], observed=True)["frame"]
    each = totals.diff().fillna(frame["frame"]).astype(int)
    names = {name: our_name(path, str(name)) for name in frame["environment_name"].unique()}
    rows = [
        (names[row.environment_name], _agent(path.stem), row.seed, iteration, row.eval_episode_return, frames)
        for row, iteration, frames in zip(frame.itertuples(), totals.cumcount(), each)
    ]
    return _of_iterations(path, rows, source)


def _rliable(path: pathlib.Path, found: object, source: Source) -> Results:
    """A score for each trial of each game. The agent is named by the file."""
    if not isinstance(found, dict) or not found:
        raise BadInput(f"{path} has {json.dumps(found)[:100]}; expected {_ACCEPTED}")
    rows = []
    for name, scores in found.items():
        if not isinstance(scores, list) or not scores or not all(map(_is_score, scores)):
            raise BadInput(f"{path}: {name} has {json.dumps(scores)[:100]}; expected a list of {_SCORES}")
        game = our_name(path, name)
        rows += [(game, "", _agent(path.stem), trial, 0, float(score), "") for trial, score in enumerate(scores)]
    return Results(pd.DataFrame(rows, columns=_RESULT), None, (source,), ())


_RESULT = ["game", "image_md5", "agent", "trial", "episode", "score", "end"]
_CURVE = ["game", "agent", "trial", "episode", "score", "frames"]


def _of_iterations(path: pathlib.Path, rows: Sequence[tuple[object, ...]], source: Source) -> Results:
    """Curves, and the last row of each trial as its score."""
    if not rows:
        raise BadInput(f"{path} has no iterations; expected one or more")
    curves = pd.DataFrame(rows, columns=_CURVE)
    decisions = curves["frames"] // _FRAMES_OF_A_DECISION
    last = curves.groupby(["game", "agent", "trial"], sort=False).tail(1)
    episodes = last.assign(image_md5="", episode=0, end="")[_RESULT]
    return Results(episodes, curves.assign(decisions=decisions, window=1), (source,), (source,))


def _is_iteration(value: object) -> TypeGuard[int]:
    return type(value) is int and 0 <= value <= MOST_WHOLE


def _is_score(value: object) -> TypeGuard[float]:
    """Whether Kind.DECIMAL accepts the value, which must be finite for that."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= MOST_DECIMAL


def _agent(name: str) -> str:
    """A name without spaces, such as "dqn_adam_mse_in_jax"."""
    words = "".join(letter if letter.isalnum() else " " for letter in name.lower()).split()
    return "_".join(words) or "agent"
