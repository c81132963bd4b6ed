"""The settings and the spaces of a task: make_spec("Pong-v5"), and `spec` of environments."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np
from gymnasium import error, spaces

from .. import ale_games, images
from ..arguments import MOST, flag, listed, share, whole
from ..errors import InvalidInput, UnknownGame
from ..interface import ALEInterface

__all__ = ["CONFIG", "ArraySpec", "EnvSpec", "InvalidSetting"]

Value = TypeVar("Value")

CONFIG: dict[str, Any] = {
    "num_envs": 1,
    "batch_size": 0,
    "num_threads": 0,
    "max_num_players": 1,
    "thread_affinity_offset": -1,
    "base_path": "",
    "seed": 42,
    "env_seed": [],
    "gym_reset_return_info": True,
    "max_episode_steps": MOST,
    "stack_num": 4,
    "frame_skip": 4,
    "noop_max": 30,
    "zero_discount_on_life_loss": False,
    "episodic_life": False,
    "reward_clip": False,
    "use_fire_reset": True,
    "img_height": 84,
    "img_width": 84,
    "task": "",
    "mode": -1,
    "difficulty": -1,
    "full_action_space": False,
    "repeat_action_probability": 0.0,
    "use_inter_area_resize": True,
    "gray_scale": True,
}
OF_TASKS = {"max_episode_steps": 27000}  # where they differ, for make()
FIXED = {"max_num_players": 1}  # no other value is played
# Whole numbers: the least and the greatest. batch_size and seeds depend on num_envs.
LIMITS = {
    "num_envs": (1, 10**7),
    "num_threads": (0, MOST),
    "thread_affinity_offset": (-1, MOST),
    "max_episode_steps": (1, MOST),
    "stack_num": (1, 16),
    "frame_skip": (1, 1000),
    "noop_max": (0, 1000),
    "img_height": (1, 1000),
    "img_width": (1, 1000),
    "mode": (-1, MOST),
    "difficulty": (-1, MOST),
}
# What make() takes beside the settings, and the values that are played; render_env_id takes an environment.
RENDERING: dict[str, tuple[Any, ...]] = {
    "render_mode": (None, "rgb_array"),
    "render_env_id": (),
    "render_width": (None, 0),
    "render_height": (None, 0),
    "render_camera_id": (None, -1),
    "from_pixels": (None, False),
}
Config = NamedTuple("Config", [(name, Any) for name in CONFIG])  # type: ignore[misc]

INT = np.iinfo(np.int32)
FLOAT = np.finfo(np.float32)


class InvalidSetting(InvalidInput, error.Error, AssertionError, TypeError):
    """A task or a setting is wrong. EnvPool raises AssertionError or TypeError, by the setting."""


class UnknownTask(UnknownGame, InvalidSetting):
    """There is no task of this name."""


def checked(check: Callable[..., Value], *arguments: Any) -> Value:
    """What a check of racebeam.arguments returns. Raises InvalidSetting."""
    try:
        return check(*arguments)
    except error.Error as refusal:
        raise InvalidSetting(*refusal.args) from None


def games() -> dict[str, str]:
    """The game of each task."""
    return {_task_of(game): game for game in images.titles() if game not in ale_games.FOR_TWO}


def _task_of(game: str) -> str:
    """SpaceInvaders-v5 of space_invaders. A digit does not begin a word: TicTacToe3d-v5."""
    return f"{''.join(map(str.capitalize, game.split('_')))}-v5"


def without_rendering(given: Mapping[str, Any]) -> dict[str, Any]:
    """The settings. Raises InvalidSetting for what is given for rendering and not played."""
    for name in RENDERING.keys() & given.keys():
        played = RENDERING[name]
        if played and not any(given[name] is one or _is(given[name], one) for one in played):
            raise InvalidSetting(f"{name} is {given[name]!r}; racebeam has {listed(map(repr, played))} alone")
    return {name: value for name, value in given.items() if name not in RENDERING}


def _is(value: Any, wanted: Any) -> bool:
    """An array of several values is not the one that is wanted."""
    return bool(np.array_equal(value, wanted))


def _checked_config(given: Iterable[Any]) -> Any:
    """A Config. Raises InvalidSetting."""
    told = tuple(given)
    if len(told) != len(CONFIG):
        raise InvalidSetting(f"there are {len(told)} values; there must be {len(CONFIG)}: {', '.join(CONFIG)}")
    values = dict(zip(CONFIG, told))
    if values["task"] not in games().values():
        raise UnknownTask(f"there is no task of a game {values['task']!r}; list_all_envs() lists the tasks")
    for name, value in FIXED.items():
        if not _is(values[name], value):
            raise InvalidSetting(f"{name} is {values[name]!r}; racebeam has {value!r} alone")
    for name, (low, high) in LIMITS.items():
        values[name] = checked(whole, name, values[name], low, high)
    for name, value in CONFIG.items():
        if isinstance(value, bool):
            values[name] = checked(flag, name, values[name])
    values["repeat_action_probability"] = checked(
        share, "repeat_action_probability", values["repeat_action_probability"]
    )
    values["batch_size"] = (
        checked(whole, "batch_size", values["batch_size"], 0, values["num_envs"]) or values["num_envs"]
    )
    return Config(**values)


def seeds_of(config: Any) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Of each environment, from 0. A negative seed, which EnvPool takes, counts from the end."""
    name = "env_seed" if np.size(config.env_seed) else "seed"
    given = getattr(config, name)
    if np.ndim(given) == 0 and not isinstance(given, str):
        seeds = checked(whole, name, given, INT.min, INT.max) + np.arange(config.num_envs, dtype=np.int64)
        return seeds % 2**32
    if len(given) != config.num_envs:
        raise InvalidSetting(f"{name} has {len(given)} seeds; there are {config.num_envs} environments")
    return np.array([checked(whole, name, seed, INT.min, INT.max) for seed in given], np.int64) % 2**32


class ArraySpec(NamedTuple):
    """Of one environment. A length of -1 in `shape` is one for each player."""

    dtype: Any
    shape: list[int]
    minimum: Any
    maximum: Any

    @property
    def is_discrete(self) -> bool:
        return self.minimum == 0 and self.maximum != INT.max and np.issubdtype(self.dtype, np.int32)


def _numbers(*shape: int) -> ArraySpec:
    return ArraySpec(np.int32, [*shape], INT.min, INT.max)


def _rewards() -> ArraySpec:
    return ArraySpec(np.float32, [-1], FLOAT.min, FLOAT.max)


class EnvSpec:
    """The settings and the spaces of a task. Its specs of dm_env need that package. Raises InvalidSetting."""

    reward_threshold = None

    @staticmethod
    def gen_config(**settings: Any) -> Any:
        """All settings, with those of CONFIG where they are not given."""
        for name in settings:
            if name not in CONFIG:
                raise InvalidSetting(f"there is no setting {name!r}; there are {', '.join(CONFIG)}")
        return Config(**{**CONFIG, **settings})

    @classmethod
    def of(cls, task_id: str, settings: Mapping[str, Any]) -> EnvSpec:
        """Of a task such as "Pong-v5"."""
        if not isinstance(task_id, str) or task_id not in games():
            raise UnknownTask(f"there is no task {task_id!r}; list_all_envs() lists them")
        return cls(cls.gen_config(**{**OF_TASKS, **settings, "task": games()[task_id]}))

    def __init__(self, config: Iterable[Any]) -> None:
        self.config = _checked_config(config)
        self.seeds = seeds_of(self.config)
        self.observation_space = self.gymnasium_observation_space = _observations(self.config)

    @property
    def id(self) -> str:
        """Pong-v5 of pong."""
        return _task_of(self.config.task)

    @property
    def action_space(self) -> spaces.Discrete:
        return self.gymnasium_action_space

    @functools.cached_property
    def gymnasium_action_space(self) -> spaces.Discrete:
        """The image of the game is needed for it."""
        game = ALEInterface()
        game.loadROM(images.find(self.config.task))
        return spaces.Discrete(
            len(game.getLegalActionSet() if self.config.full_action_space else game.getMinimalActionSet())
        )

    @property
    def action_array_spec(self) -> dict[str, ArraySpec]:
        """What send() takes, by name."""
        return {
            "env_id": _numbers(),
            "players.env_id": _numbers(-1),
            "action": ArraySpec(np.int32, [-1], 0, int(self.action_space.n) - 1),
        }

    @property
    def state_array_spec(self) -> dict[str, ArraySpec]:
        """What is shown, by name."""
        flag = ArraySpec(np.bool_, [], False, True)
        return {
            "info:env_id": _numbers(),
            "info:players.env_id": _numbers(-1),
            "elapsed_step": _numbers(),
            "done": flag,
            "reward": _rewards(),
            "discount": ArraySpec(np.float32, [-1], 0.0, 1.0),
            "step_type": _numbers(),
            "trunc": flag,
            "obs": ArraySpec(np.uint8, list(self.observation_space.shape), 0, 255),
            "info:lives": _numbers(-1),
            "info:reward": _rewards(),
            "info:terminated": ArraySpec(np.int32, [-1], 0, 1),
            "info:ram": ArraySpec(np.uint8, [128], 0, 255),
        }

    def observation_spec(self) -> Any:
        """As dm_env has it: a State of specs."""
        from .pools import Players, State

        arrays = {name.removeprefix("info:"): array for name, array in self.state_array_spec.items()}
        env_id = _dm_spec("env_id", arrays["env_id"])
        fields = {name: _dm_spec(name, arrays[name]) for name in State._fields if name not in ("env_id", "players")}
        return State(
            env_id=env_id, players=Players(env_id), **{**fields, "reward": _dm_spec("reward", arrays["reward"])}
        )

    def action_spec(self) -> Any:
        """As dm_env has it."""
        return _dm_spec("action", self.action_array_spec["action"])

    def __repr__(self) -> str:
        return f"AtariEnvSpec({', '.join(f'{name}={value!r}' for name, value in self.config._asdict().items())})"


def _observations(config: Any) -> spaces.Box:
    """Of one environment. Colours are channels."""
    return spaces.Box(
        0, 255, (config.stack_num * (1 if config.gray_scale else 3), config.img_height, config.img_width), np.uint8
    )


def dm_specs() -> Any:
    """dm_env.specs, if it is installed."""
    try:
        return importlib.import_module("dm_env.specs")
    except ImportError:
        raise ImportError("a spec of dm_env needs that package; install it with: pip install dm-env") from None


def _dm_spec(name: str, array: ArraySpec) -> Any:
    specs = dm_specs()
    if array.is_discrete:
        return specs.DiscreteArray(array.maximum + 1, np.int32, name)
    shape = [length for length in array.shape if length != -1]
    return specs.BoundedArray(shape, array.dtype, array.minimum, array.maximum, name)
