"""The settings and the spaces of a task: make_spec("Pong-v5"), and `spec` of environments."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np
from gymnasium import error, spaces

from .. import ale_games, images
from ..arguments import MOST, flag, integer, join, share
from ..errors import InvalidInput, UnknownGame
from ..extras import install_hint
from ..interface import ALEInterface
from .types import Players, State

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
TASK_DEFAULTS = {"max_episode_steps": 27000}  # defaults of make() that differ from those of CONFIG
FIXED = {"max_num_players": 1}  # settings with one accepted value
# Smallest and largest values of whole numbers. Those of batch_size and the seeds depend on num_envs.
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
# Arguments of make() for rendering, and their accepted values. render_env_id takes the index of an environment.
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
    """Raised for a wrong task or setting. EnvPool raises AssertionError or TypeError, depending on the setting."""


class UnknownTask(UnknownGame, InvalidSetting):
    """Raised for an id that no task has."""


def call_check(check: Callable[..., Value], *arguments: Any) -> Value:
    """Calls a check of `racebeam.arguments`.

    Args:
        check: The check.
        *arguments: Its arguments.

    Returns:
        What the check returns.

    Raises:
        InvalidSetting: If the check fails.
    """
    try:
        return check(*arguments)
    except error.Error as refusal:
        raise InvalidSetting(*refusal.args) from None


def games() -> dict[str, str]:
    """Returns the name of the game of each task."""
    return {_task_of(game): game for game in images.titles() if game not in ale_games.TWO_PLAYER}


def _task_of(game: str) -> str:
    """Returns the id of a game's task, such as "SpaceInvaders-v5". A digit does not begin a word: "TicTacToe3d-v5"."""
    return f"{''.join(map(str.capitalize, game.split('_')))}-v5"


def without_rendering(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Removes the arguments for rendering.

    Args:
        settings: Settings and arguments for rendering.

    Returns:
        The settings.

    Raises:
        InvalidSetting: If an argument for rendering has a value that is not accepted.
    """
    for name in RENDERING.keys() & settings.keys():
        accepted = RENDERING[name]
        if accepted and not any(settings[name] is one or _equals(settings[name], one) for one in accepted):
            raise InvalidSetting(f"{name} is {settings[name]!r}; racebeam has only {join(map(repr, accepted))}")
    return {name: value for name, value in settings.items() if name not in RENDERING}


def _equals(value: Any, expected: Any) -> bool:
    """Compares values. An array of several values does not equal a number."""
    return bool(np.array_equal(value, expected))


def _checked_config(config: Iterable[Any]) -> Any:
    """Checks the values of all settings, and returns them as a Config."""
    items = tuple(config)
    if len(items) != len(CONFIG):
        raise InvalidSetting(f"there are {len(items)} values; there must be {len(CONFIG)}: {', '.join(CONFIG)}")
    values = dict(zip(CONFIG, items, strict=True))
    if values["task"] not in games().values():
        raise UnknownTask(f"unknown game {values['task']!r}; list_all_envs() lists the tasks")
    for name, value in FIXED.items():
        if not _equals(values[name], value):
            raise InvalidSetting(f"{name} is {values[name]!r}; racebeam has only {value!r}")
    for name, (low, high) in LIMITS.items():
        values[name] = call_check(integer, name, values[name], low, high)
    for name, value in CONFIG.items():
        if isinstance(value, bool):
            values[name] = call_check(flag, name, values[name])
    values["repeat_action_probability"] = call_check(
        share, "repeat_action_probability", values["repeat_action_probability"]
    )
    values["batch_size"] = (
        call_check(integer, "batch_size", values["batch_size"], 0, values["num_envs"]) or values["num_envs"]
    )
    return Config(**values)


def seeds_of(config: Any) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Returns the seed of each environment.

    Args:
        config: Checked settings, except for the seeds.

    Returns:
        int64 array of shape (num_envs,), from 0. A negative seed, which EnvPool accepts, counts from 2**32 down.

    Raises:
        InvalidSetting: If a seed is not an int32, or the number of seeds is wrong.
    """
    name = "env_seed" if np.size(config.env_seed) else "seed"
    seed_setting = getattr(config, name)
    if np.ndim(seed_setting) == 0 and not isinstance(seed_setting, str):
        seeds = call_check(integer, name, seed_setting, INT.min, INT.max) + np.arange(config.num_envs, dtype=np.int64)
        return seeds % 2**32
    if len(seed_setting) != config.num_envs:
        raise InvalidSetting(
            f"{name} has {len(seed_setting)} seeds; accepted: {config.num_envs}, one for each environment"
        )
    return np.array([call_check(integer, name, seed, INT.min, INT.max) for seed in seed_setting], np.int64) % 2**32


class ArraySpec(NamedTuple):
    """The spec of an array of one environment.

    Attributes:
        dtype: Type of the elements.
        shape: Shape of the array. A length of -1 means the number of players.
        minimum: Smallest value.
        maximum: Largest value.
    """

    dtype: Any
    shape: list[int]
    minimum: Any
    maximum: Any

    @property
    def is_discrete(self) -> bool:
        """Whether the values are indices."""
        return self.minimum == 0 and self.maximum != INT.max and np.issubdtype(self.dtype, np.int32)


def _numbers(*shape: int) -> ArraySpec:
    return ArraySpec(np.int32, [*shape], INT.min, INT.max)


def _rewards() -> ArraySpec:
    return ArraySpec(np.float32, [-1], FLOAT.min, FLOAT.max)


class EnvSpec:
    """The settings and the spaces of a task. Its specs of dm_env need that package.

    Args:
        config: A value for each setting of `CONFIG`, in their order.

    Attributes:
        config: The checked settings, as a named tuple.
        seeds: Seed of each environment, int64 of shape (num_envs,).
        observation_space: Space of the observations of one environment, uint8 of shape
            (stack_num, img_height, img_width); colours are channels.

    Raises:
        InvalidSetting: If a value is wrong.

    Examples:
        >>> from racebeam.envpool import make_spec
        >>> spec = make_spec("Beamfall-v5", num_envs=4)
        >>> spec.id, spec.config.num_envs, spec.observation_space.shape
        ('Beamfall-v5', 4, (4, 84, 84))
    """

    reward_threshold = None

    @staticmethod
    def gen_config(**settings: Any) -> Any:
        """Completes settings.

        Args:
            **settings: Some settings.

        Returns:
            All settings as a named tuple. A setting that is not given has its value in `CONFIG`.

        Raises:
            InvalidSetting: If the setting is unknown.
        """
        for name in settings:
            if name not in CONFIG:
                raise InvalidSetting(f"unknown setting {name!r}; accepted: {', '.join(CONFIG)}")
        return Config(**{**CONFIG, **settings})

    @classmethod
    def from_task(cls, task_id: str, settings: Mapping[str, Any]) -> EnvSpec:
        """Makes the spec of a task.

        Args:
            task_id: Id of the task, such as "Pong-v5".
            settings: Some settings.

        Returns:
            The spec.

        Raises:
            InvalidSetting: If the task is unknown, or a setting is wrong.
        """
        if not isinstance(task_id, str) or task_id not in games():
            raise UnknownTask(f"unknown task {task_id!r}; list_all_envs() lists them")
        return cls(cls.gen_config(**{**TASK_DEFAULTS, **settings, "task": games()[task_id]}))

    def __init__(self, config: Iterable[Any]) -> None:
        self.config = _checked_config(config)
        self.seeds = seeds_of(self.config)
        self.observation_space = self.gymnasium_observation_space = _observations(self.config)

    @property
    def id(self) -> str:
        """Id of the task, such as "Pong-v5"."""
        return _task_of(self.config.task)

    @property
    def action_space(self) -> spaces.Discrete:
        """Space of the actions of one environment. Needs the image of the game."""
        return self.gymnasium_action_space

    @functools.cached_property
    def gymnasium_action_space(self) -> spaces.Discrete:
        """Space of the actions of one environment. Needs the image of the game."""
        game = ALEInterface()
        game.loadROM(images.find(self.config.task))
        return spaces.Discrete(
            len(game.getLegalActionSet() if self.config.full_action_space else game.getMinimalActionSet())
        )

    @property
    def action_array_spec(self) -> dict[str, ArraySpec]:
        """Specs of the arrays that `send` takes, by name."""
        return {
            "env_id": _numbers(),
            "players.env_id": _numbers(-1),
            "action": ArraySpec(np.int32, [-1], 0, int(self.action_space.n) - 1),
        }

    @property
    def state_array_spec(self) -> dict[str, ArraySpec]:
        """Specs of the arrays that `recv` returns, by name."""
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
        """Returns the spec of the observations for dm_env: a State of specs.

        Raises:
            ImportError: If dm_env is not installed.
        """
        arrays = {name.removeprefix("info:"): array for name, array in self.state_array_spec.items()}
        env_id = _dm_spec("env_id", arrays["env_id"])
        fields = {name: _dm_spec(name, arrays[name]) for name in State._fields if name not in ("env_id", "players")}
        return State(
            env_id=env_id, players=Players(env_id), **{**fields, "reward": _dm_spec("reward", arrays["reward"])}
        )

    def action_spec(self) -> Any:
        """Returns the spec of the actions for dm_env.

        Raises:
            ImportError: If dm_env is not installed.
        """
        return _dm_spec("action", self.action_array_spec["action"])

    def __repr__(self) -> str:
        return f"AtariEnvSpec({', '.join(f'{name}={value!r}' for name, value in self.config._asdict().items())})"


def _observations(config: Any) -> spaces.Box:
    """Returns the space of the observations of one environment. Colours are channels."""
    return spaces.Box(
        0, 255, (config.stack_num * (1 if config.gray_scale else 3), config.img_height, config.img_width), np.uint8
    )


def dm_specs() -> Any:
    """Imports dm_env.specs.

    Returns:
        The module.

    Raises:
        ImportError: If dm_env is not installed.
    """
    try:
        return importlib.import_module("dm_env.specs")
    except ImportError:
        raise ImportError(f"a spec of dm_env needs that package; {install_hint('dm_env')}") from None


def _dm_spec(name: str, array: ArraySpec) -> Any:
    specs = dm_specs()
    if array.is_discrete:
        return specs.DiscreteArray(array.maximum + 1, np.int32, name)
    shape = [length for length in array.shape if length != -1]
    return specs.BoundedArray(shape, array.dtype, array.minimum, array.maximum, name)
