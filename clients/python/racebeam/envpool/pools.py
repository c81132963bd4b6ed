"""Many environments with EnvPool's interface, of the kinds of Gymnasium, Gym 0.21 and dm_env."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv

from ..arguments import flag, whole
from ..errors import InvalidInput
from ..vector_env import Info
from ..vector_results import Numbers, Pixels
from . import xla
from .envs import ROWS, Envs, Shown, parts_of
from .spec import EnvSpec, InvalidSetting, checked, dm_specs

__all__ = ["DMEnvPool", "EnvPool", "GymEnvPool", "GymnasiumEnvPool", "State", "TimeStep"]


class EnvPool:
    """What all kinds have. A kind says in _shown_as() what its results look like."""

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        if not isinstance(spec, EnvSpec):
            raise InvalidSetting(f"the spec is {spec!r}; it takes what make_spec() returns")
        self.spec: Any = spec
        self.config: dict[str, Any] = spec.config._asdict()
        self._check_size()
        self._envs = Envs(spec)
        self.num_envs, self.batch_size = self._envs.num_envs, self._envs.batch_size
        self._shown_by_render = checked(whole, "render_env_id", render_env_id, 0, self.num_envs - 1)
        self.render_mode = render_mode
        self.action_space = self.single_action_space = spec.action_space
        self.observation_space = self.single_observation_space = spec.observation_space

    def _check_size(self) -> None:
        """Without another size, all ways to resize are the same."""
        if not self.config["use_inter_area_resize"] and (self.config["img_height"], self.config["img_width"]) != (
            ROWS,
            160,
        ):
            raise InvalidSetting(
                f"use_inter_area_resize is False; racebeam takes that where img_height and img_width are {ROWS} and 160"
            )

    def __len__(self) -> int:
        return self.num_envs

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"{type(self).__name__}<{self.spec.id}>({', '.join(f'{name}={value!r}' for name, value in self.config.items())})"

    __str__ = __repr__

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(
            f"{type(self).__name__} has threads, and can be neither pickled nor copied; make another one with the same settings"
        )

    @property
    def is_async(self) -> bool:
        return self.batch_size < self.num_envs

    @property
    def all_env_ids(self) -> npt.NDArray[np.int32]:
        return np.arange(self.num_envs, dtype=np.int32)

    def observation_spec(self) -> Any:
        """As dm_env has it."""
        return self.spec.observation_spec()

    def action_spec(self) -> Any:
        """As dm_env has it."""
        return self.spec.action_spec()

    def seed(self, seed: Any = None) -> None:
        """Has no effect, as in EnvPool."""
        warnings.warn("seed() has no effect; give seed to make()", stacklevel=2)

    def render(self, env_ids: Any = None, camera_id: Any = None) -> Pixels:
        """The pictures of these environments. camera_id has no effect, as in EnvPool."""
        pictures = self._envs.render() or ()
        chosen = np.atleast_1d(self._shown_by_render if env_ids is None else env_ids)
        if chosen.size == 0:
            raise InvalidInput("env_ids is empty; it takes one environment or more")
        return np.stack([pictures[env][:ROWS] for env in chosen])

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
        """For programs that JAX compiles: a handle, recv(handle), send(handle, action, env_id=None) and step(handle, action, env_id=None).

        recv returns the handle for the next call and what recv() returns, send the handle, and step does both. Results are of batch_size
        environments. Errors of a compiled program are jax.errors.JaxRuntimeError. Raises ImportError without JAX.
        """
        return xla.functions(self._envs, self._shown_as)

    def close(self) -> None:
        self._envs.close()

    def async_reset(self) -> None:
        """Begins new games of all environments; recv() returns the first. What was not received before is dropped."""
        self._send_resets(self._envs.every)

    def send(self, action: Any, env_id: Any = None) -> None:
        """Begins a step of these environments; None: of all, or with batch_size, of those that were received last."""
        envs, actions = self._meant(action, env_id)
        self._envs.send_to(envs, actions)

    def _send_resets(self, env_id: Any) -> None:
        self._envs.send_resets_of(self._envs.numbers_of(env_id))

    def _receive(self) -> Shown:
        return self._envs.receive()

    def _reset(self, env_id: Any, options: Any = None) -> Any:
        if not isinstance(options, (Mapping, type(None))):
            raise InvalidInput(f"options is {options!r}; it takes a dictionary, or None")
        mask = _mask_of(options or {})
        if mask is not None and env_id is not None:
            raise InvalidInput("env_id and reset_mask are given; one of them chooses the environments")
        self._envs.send_resets_of(self._envs.chosen(mask) if env_id is None else self._envs.numbers_of(env_id))
        return self._shown_as(self._receive())

    def _step(self, action: Any, env_id: Any) -> Any:
        envs, actions = self._meant(action, env_id)
        if not self.is_async and np.array_equal(envs, self._envs.every):
            return self._shown_as(self._envs.step_every(actions))
        self._envs.send_to(envs, actions)
        return self._shown_as(self._receive())

    def _meant(self, action: Any, env_id: Any) -> tuple[Numbers, Any]:
        if isinstance(action, dict):
            parts = _checked_parts(action)
            action, env_id = parts["action"], parts.get("env_id", parts.get("players.env_id", env_id))
        if env_id is None:
            return (self._envs.received if self.is_async else self._envs.every), action
        return self._envs.numbers_of(env_id), action

    def _shown_as(self, shown: Shown) -> Any:
        raise NotImplementedError

    def _told_by_name(self, shown: Shown) -> dict[str, Any]:
        """Under the names of spec.state_array_spec."""
        observations, done = shown.observations, shown.terminated | shown.truncated
        if observations.ndim == 5:  # colours become channels
            observations = observations.transpose(0, 1, 4, 2, 3).reshape(
                len(observations), *self.spec.observation_space.shape
            )
        skip = self.config["frame_skip"]
        ends = done | (shown.lives_lost > 0) if self.config["zero_discount_on_life_loss"] else done
        return {
            "info:env_id": shown.env_id,
            "info:players.env_id": shown.env_id.copy(),
            "elapsed_step": (shown.elapsed + skip - 1) // skip,
            "done": done,
            "reward": shown.rewards.astype(np.float32),
            "discount": (~ends).astype(np.float32),
            "step_type": ((shown.acts > 0) * (1 + done)).astype(np.int32),
            "trunc": shown.truncated,
            "obs": observations,
            "info:lives": shown.lives,
            "info:reward": shown.raw_rewards.astype(np.float32),
            "info:terminated": shown.game_over.astype(np.int32),
            "info:ram": shown.ram,
        }

    def _shown_with_info(self, shown: Shown) -> tuple[Any, Any, Any, Any, Info]:
        """Observations, rewards, done, truncated and the info."""
        told = self._told_by_name(shown)
        info = {name: told[f"info:{name}"] for name in ("env_id", "lives", "reward", "terminated", "ram")}
        info |= {"players": {"env_id": told["info:players.env_id"]}, "elapsed_step": told["elapsed_step"]}
        return told["obs"], told["reward"], told["done"], told["trunc"], info


def _checked_parts(action: dict[str, Any]) -> dict[str, Any]:
    parts = parts_of(action)
    for name in ("action", "env_id"):
        if name in parts and np.asarray(parts[name]).dtype != np.int32:
            raise InvalidInput(f"{name} of the action has the type {np.asarray(parts[name]).dtype}; it must be int32")
    return parts


def _mask_of(options: Mapping[Any, Any]) -> Any:
    unknown = [name for name in options if name != "reset_mask"]
    if unknown:
        raise InvalidInput(f"options has {', '.join(map(repr, unknown))}; it takes reset_mask alone")
    return options.get("reset_mask")


class GymnasiumEnvPool(EnvPool, VectorEnv[Any, Any, Any], gymnasium.Env[Any, Any]):  # type: ignore[misc]
    """env_type="gymnasium"."""

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": ["rgb_array"]}
    is_vector_env = True

    def reset(self, env_id: Any = None, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        if seed is not None:
            self.seed(seed)
        observations, *_, info = self._reset(env_id, options)
        return observations, info

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Any, Info]:
        shown: tuple[Any, Any, Any, Any, Info] = self._step(action, env_id)
        return shown

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        observations, *rest, info = self._shown_as(self._receive())
        return (observations, info) if flag("reset", reset) else (observations, *rest, info)

    def _shown_as(self, shown: Shown) -> tuple[Any, Any, Any, Any, Info]:
        observations, rewards, done, truncated, info = self._shown_with_info(shown)
        return observations, rewards, done & ~truncated, truncated, info


class GymEnvPool(EnvPool):
    """make(env_type="gym"): reset() returns observations, and a step has one end, `done`.

    To a program that has imported gym, the spaces are those of that package. Wrappers of gym find what they ask for.
    """

    metadata: dict[str, Any] = {"render.modes": ["rgb_array"], "render_modes": ["rgb_array"]}
    reward_range = (-math.inf, math.inf)
    is_vector_env = True

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        super().__init__(spec, render_env_id, render_mode)
        if "gym" in sys.modules:
            theirs, box, actions = sys.modules["gym"].spaces, self.single_observation_space, self.single_action_space
            assert isinstance(actions, spaces.Discrete)
            self.observation_space = self.single_observation_space = theirs.Box(0, 255, box.shape, box.dtype)
            self.action_space = self.single_action_space = theirs.Discrete(actions.n)

    @property
    def unwrapped(self) -> GymEnvPool:
        return self

    def reset(self, env_id: Any = None) -> Any:
        return self._reset(env_id)[0]

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Info]:
        shown: tuple[Any, Any, Any, Info] = self._step(action, env_id)
        return shown

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        shown = self._shown_as(self._receive())
        return shown[0] if flag("reset", reset) else shown

    def _shown_as(self, shown: Shown) -> tuple[Any, Any, Any, Info]:
        observations, rewards, done, truncated, info = self._shown_with_info(shown)
        return observations, rewards, done, {**info, "TimeLimit.truncated": truncated}


class State(NamedTuple):
    """The observation of a TimeStep."""

    env_id: Any
    players: Any
    obs: Any
    lives: Any
    reward: Any
    terminated: Any
    ram: Any


class TimeStep(NamedTuple):
    """As dm_env has it, for each environment: step_type is 0 for the first of an episode, 1, or 2 for the last."""

    step_type: npt.NDArray[np.int32]
    reward: npt.NDArray[np.float32]
    discount: npt.NDArray[np.float32]
    observation: State

    def first(self) -> Any:
        """Of which environments it is the first of an episode."""
        return self.step_type == 0

    def mid(self) -> Any:
        return self.step_type == 1

    def last(self) -> Any:
        return self.step_type == 2


class Players(NamedTuple):
    env_id: Any


class DMEnvPool(EnvPool):
    """env_type="dm". It is a dm_env.Environment to a program that has imported dm_env."""

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        super().__init__(spec, render_env_id, render_mode)
        if "dm_env" in sys.modules:
            sys.modules["dm_env"].Environment.register(DMEnvPool)

    def reset(self, env_id: Any = None) -> TimeStep:
        time_step: TimeStep = self._reset(env_id)
        return time_step

    def step(self, action: Any, env_id: Any = None) -> TimeStep:
        time_step: TimeStep = self._step(action, env_id)
        return time_step

    def recv(self, reset: bool = False, return_info: bool = True) -> TimeStep:
        return self._shown_as(self._receive())

    def reward_spec(self) -> Any:
        """As dm_env has it, and EnvPool."""
        return dm_specs().Array((), float, "reward")

    def discount_spec(self) -> Any:
        """As dm_env has it, and EnvPool."""
        return dm_specs().BoundedArray((), float, 0.0, 1.0, "discount")

    def _shown_as(self, shown: Shown) -> TimeStep:
        told = self._told_by_name(shown)
        info = {name: told[f"info:{name}"] for name in ("env_id", "lives", "reward", "terminated", "ram")}
        state = State(players=Players(told["info:players.env_id"]), obs=told["obs"], **info)
        return TimeStep(told["step_type"], told["reward"], told["discount"], state)
