"""What racebeam.envpool says of a task before its environments are made: make_spec("Pong-v5") and `spec` of environments."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces

from .arguments import flag, listed, whole
from .errors import InvalidInput

__all__ = ["CONFIG", "ArraySpec", "EnvSpec", "whole_config"]

CONFIG: dict[str, Any] = {
    "num_envs": 1,
    "batch_size": 0,
    "num_threads": 0,
    "max_num_players": 1,
    "thread_affinity_offset": -1,
    "base_path": "",
    "seed": 42,
    "env_seed": [],
    "gym_reset_return_info": None,
    "max_episode_steps": 27000,
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
FIXED = {"max_num_players": 1, "use_inter_area_resize": True}  # no other value is played
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


def whole_config(task_id: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """All settings of a task. Raises InvalidInput for one that is not there or not played."""
    given = {name: value for name, value in given.items() if not _is_of_rendering(name, value)}
    for name, value in given.items():
        if name not in CONFIG:
            raise InvalidInput(f"there is no setting {name!r}; there are {', '.join(CONFIG)}")
        if name in FIXED and not _is(value, FIXED[name]):
            raise InvalidInput(f"{name} is {value!r}; racebeam has {FIXED[name]!r} alone")
    flags = {name: flag(name, value) for name, value in given.items() if isinstance(CONFIG[name], bool)}
    return {**CONFIG, **given, **flags, "task": task_id}


def rendered_env(given: Mapping[str, Any], num_envs: int) -> int:
    """The environment that render() shows."""
    return whole("render_env_id", given.get("render_env_id", 0), 0, num_envs - 1)


def _is_of_rendering(name: str, value: Any) -> bool:
    """Raises InvalidInput for a value that is not played."""
    played = RENDERING.get(name, ())
    if played and not any(value is one or _is(value, one) for one in played):
        raise InvalidInput(f"{name} is {value!r}; racebeam has {listed(map(repr, played))} alone")
    return name in RENDERING


def _is(value: Any, wanted: Any) -> bool:
    """An array of several values is not the one that is wanted."""
    return bool(np.array_equal(value, wanted))


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
    """The settings and the spaces of a task. Its specs of dm_env need that package."""

    reward_threshold = None
    gen_config = Config

    def __init__(self, config: Mapping[str, Any], actions: int, observations: spaces.Box) -> None:
        self.id = config["task"]
        self.config = Config(**{**config, "batch_size": config["batch_size"] or config["num_envs"]})
        self.observation_space = self.gymnasium_observation_space = observations
        self.action_space = self.gymnasium_action_space = spaces.Discrete(actions)
        self._actions = actions

    @property
    def action_array_spec(self) -> dict[str, ArraySpec]:
        """What send() takes, by name."""
        return {"env_id": _numbers(), "players.env_id": _numbers(-1), "action": ArraySpec(np.int32, [-1], 0, self._actions - 1)}

    @property
    def state_array_spec(self) -> dict[str, ArraySpec]:
        """What is shown, by name."""
        flag = ArraySpec(np.bool_, [], False, True)
        return {
            "info:env_id": _numbers(), "info:players.env_id": _numbers(-1), "elapsed_step": _numbers(), "done": flag, "reward": _rewards(),
            "discount": ArraySpec(np.float32, [-1], 0.0, 1.0), "step_type": _numbers(), "trunc": flag,
            "obs": ArraySpec(np.uint8, list(self.observation_space.shape), 0, 255), "info:lives": _numbers(-1), "info:reward": _rewards(),
            "info:terminated": ArraySpec(np.int32, [-1], 0, 1), "info:ram": ArraySpec(np.uint8, [128], 0, 255),
        }

    def observation_spec(self) -> Any:
        """As dm_env has it: a State of specs."""
        from .envpool import Players, State

        arrays = {name.removeprefix("info:"): array for name, array in self.state_array_spec.items()}
        env_id = _dm_spec("env_id", arrays["env_id"])
        fields = {name: _dm_spec(name, arrays[name]) for name in State._fields if name not in ("env_id", "players")}
        return State(env_id=env_id, players=Players(env_id), **{**fields, "reward": _dm_spec("reward", arrays["reward"])})

    def action_spec(self) -> Any:
        """As dm_env has it."""
        return _dm_spec("action", self.action_array_spec["action"])

    def __repr__(self) -> str:
        return f"AtariEnvSpec({', '.join(f'{name}={value!r}' for name, value in self.config._asdict().items())})"


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
