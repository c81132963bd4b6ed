"""Settings files in TOML: plan.toml, which `racebeam experiment` writes, and the settings of an agent in it."""

import dataclasses
import json
import pathlib
import sys
from collections.abc import Iterator
from typing import Any

from .csv_file import content_of
from .errors import BadInput

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_MOST_BYTES = 2**24
_MOST_LEVELS = 50
_LEAST, _MOST = -(2**63), 2**63 - 1  # TOML's whole numbers
_UNKNOWN = "unknown"

_NAMES = ("frame_skip", "sticky", "action_set", "max_episode_frames", "noop_max")
# The values of `load` that make a preset of evaluation (docs/experiments.md), in the order of _NAMES.
# generated: evaluation presets, from protocol/protocol.toml
PRESETS = {
    "paper2013": ("5", "0", "full", "18000", "0"),
    "machado2018": ("5", "0.25", "full", "18000", "0"),
    "atari100k": ("4", "0", "minimal", "108000", "30"),
    "dqn2015": ("4", "0", "minimal", "18000", "30"),
}
# end of evaluation presets
_USUAL = {"noop_max": "0", "life_loss": "ignored", "life_loss_ends": "0"}  # of words that leave it out
_BUDGETS = ("simulations", "frames")  # an agent's settings that bound its search for a decision


@dataclasses.dataclass(frozen=True)
class Protocol:
    """How scores were made. "unknown" where nobody says it; "" where it does not apply."""

    preset: str = _UNKNOWN  # of the environment
    frame_skip: str = _UNKNOWN  # frames of a decision
    budget: str = _UNKNOWN  # of a decision
    training: str = _UNKNOWN
    trials: str = _UNKNOWN
    episodes: str = _UNKNOWN  # of evaluation, in each trial

    def differences(self, other: "Protocol") -> list[str]:
        """The names of what decides scores and differs, or is unknown on a side. Trials and episodes are not among
        them: they decide how exact a mean is."""
        return [
            name
            for name in ("preset", "frame_skip", "budget", "training")
            if _UNKNOWN in (getattr(self, name), getattr(other, name)) or getattr(self, name) != getattr(other, name)
        ]


def read_toml(path: pathlib.Path, limit: int = _MOST_BYTES) -> dict[str, Any]:
    """The tables of a TOML file. Raises BadInput if it cannot be read."""
    content = content_of(path, limit, "a TOML file")
    try:
        tables = tomllib.loads(content.decode())
    except (ValueError, RecursionError) as error:  # ValueError: also of a number of more digits than Python reads
        raise BadInput(f"{path} is not TOML: {error}; expected a TOML file in UTF-8") from error
    levels = 0
    for values in _by_level(tables):
        levels += 1
        if any(type(value) is int and not _LEAST <= value <= _MOST for value in values):
            raise BadInput(f"{path} has a whole number of more than 64 bits; expected {_LEAST} to {_MOST}")
    if levels > _MOST_LEVELS:
        raise BadInput(f"{path} has tables within tables on {levels} levels; expected at most {_MOST_LEVELS}")
    return tables


def _by_level(tables: dict[str, Any]) -> Iterator[list[Any]]:
    """The values of all tables and arrays that lie equally deep. It does not recurse: dotted keys make thousands of
    levels."""
    layer: list[Any] = [tables]
    while layer:
        values = [value for each in layer for value in (each.values() if isinstance(each, dict) else each)]
        yield values
        layer = [value for value in values if isinstance(value, dict | list)]


@dataclasses.dataclass(frozen=True)
class Plan:
    """A plan.toml, or nothing."""

    tables: dict[str, Any]

    @property
    def games(self) -> set[str]:
        """The games whose images the plan names: users may have games of their own."""
        return set(self._table("images"))

    def _table(self, name: str) -> dict[str, Any]:
        """The table with this name; an empty one if the plan lacks it, or has another kind of value there."""
        found = self.tables.get(name)
        return found if isinstance(found, dict) else {}

    def settings(self) -> dict[str, str]:
        """All settings by KEY or TABLE.KEY, as TOML writes them."""
        return dict(_flat("", self.tables))

    def protocol(self, agent: str) -> Protocol:
        """How the agent was run."""
        agents = self._table("agent")
        settings = agents.get(agent) or agents.get(agent.split("_")[0])
        if not isinstance(settings, dict):
            return Protocol()
        return Protocol(
            preset=preset_of(str(self.tables.get("environment", ""))),
            frame_skip=str(settings.get("frame_skip", _UNKNOWN)),
            budget=_budget(settings),
            training=_training(settings),
            trials=_count(settings.get("trials")),
            episodes=_count(settings.get("evaluation_episodes")),
        )


def plan_of(folder: pathlib.Path) -> Plan:
    """The plan of a folder of results; an empty one without plan.toml."""
    path = folder / "plan.toml"
    return Plan(read_toml(path) if path.is_file() else {})


def preset_of(environment: str) -> str:
    """The preset with these words of `load`; "other" if no preset has them."""
    words = dict(word.split("=", 1) for word in environment.split() if "=" in word)
    if not words:
        return _UNKNOWN
    words = _USUAL | words
    values = tuple(words.get(name) for name in _NAMES)
    preset = next((name for name, preset_values in PRESETS.items() if values == preset_values), "other")
    return preset if (words["life_loss"], words["life_loss_ends"]) == ("ignored", "0") else "other"


def _flat(above: str, tables: dict[str, Any]) -> list[tuple[str, str]]:
    settings = []
    for key, value in tables.items():
        name = f"{above}.{key}" if above else key
        settings += _flat(name, value) if isinstance(value, dict) else [(name, json.dumps(value, default=str))]
    return settings


def _count(value: object) -> str:
    return f"{value:,}" if isinstance(value, int) else _UNKNOWN


def _budget(settings: dict[str, Any]) -> str:
    words = [f"{settings[key]:,.0f} {key}" for key in _BUDGETS if isinstance(settings.get(key), int | float)]
    if "simulations" in settings and isinstance(settings.get("depth_frames"), int | float):
        words.append(f"of {settings['depth_frames']:,.0f} frames")
    return " ".join(words)


def _training(settings: dict[str, Any]) -> str:
    for key in ("training_episodes", "training_frames"):
        if settings.get(key):
            return f"{_count(settings[key])} {key.removeprefix('training_')}"
    return ""
