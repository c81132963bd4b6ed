"""The part of EnvPool's interface that both of its kinds of environments share."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import integer
from ..errors import InvalidInput
from ..vector.results import Info, Numbers, Pixels
from . import xla
from .envs import ROWS, Envs, parts_of
from .spec import EnvSpec, InvalidSetting, call_check
from .types import Results

__all__ = ["EnvPool"]


class EnvPool:
    """Base class of the environments. Subclasses convert results in `_format`.

    Args:
        spec: Spec of the task, as `make_spec` returns it.
        render_env_id: Index of the environment that `render` returns by default.
        render_mode: None or "rgb_array"; has no effect.

    Attributes:
        spec: The spec.
        config: The settings, as a dictionary.
        num_envs: Number of environments.
        batch_size: Number of environments that `recv` waits for.
        observation_space: Space of the observations of one environment.
        action_space: Space of the actions of one environment.

    Raises:
        InvalidSetting: If `spec` or `render_env_id` is wrong.
        MissingImage: If no image of the game is found.

    All methods raise ClosedEnvironmentError after `close`, and RuntimeError in a child process after a fork.

    Examples:
        >>> from racebeam import envpool
        >>> with envpool.make_gymnasium("Beamfall-v5", num_envs=4, batch_size=2) as envs:
        ...     envs.async_reset()
        ...     observations, *_, info = envs.recv()
        ...     envs.send([0, 1], info["env_id"])
        >>> observations.shape
        (2, 4, 84, 84)
    """

    def __init__(self, spec: EnvSpec, render_env_id: Any = 0, render_mode: str | None = None) -> None:
        if not isinstance(spec, EnvSpec):
            raise InvalidSetting(f"the spec is {spec!r}; it takes what make_spec() returns")
        self.spec: Any = spec
        self.config: dict[str, Any] = spec.config._asdict()
        self._check_size()
        self._envs = Envs(spec)
        self.num_envs, self.batch_size = self._envs.num_envs, self._envs.batch_size
        self._render_env_id = call_check(integer, "render_env_id", render_env_id, 0, self.num_envs - 1)
        self.render_mode = render_mode
        self.action_space = self.single_action_space = spec.action_space
        self.observation_space = self.single_observation_space = spec.observation_space

    def _check_size(self) -> None:
        """Refuses use_inter_area_resize=False unless the screens have full size, where all ways to resize agree."""
        if not self.config["use_inter_area_resize"] and (self.config["img_height"], self.config["img_width"]) != (
            ROWS,
            160,
        ):
            raise InvalidSetting(
                f"use_inter_area_resize is False; racebeam takes that if img_height is {ROWS} and img_width is 160"
            )

    def __len__(self) -> int:
        return self.num_envs

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        settings = ", ".join(f"{name}={value!r}" for name, value in self.config.items())
        return f"{type(self).__name__}<{self.spec.id}>({settings})"

    __str__ = __repr__

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(
            f"{type(self).__name__} cannot be pickled or copied, because it owns threads; "
            "make another one with the same settings"
        )

    @property
    def is_async(self) -> bool:
        """Whether `recv` waits for a part of the environments."""
        return self.batch_size < self.num_envs

    @property
    def all_env_ids(self) -> npt.NDArray[np.int32]:
        """Indices of all environments."""
        return np.arange(self.num_envs, dtype=np.int32)

    def observation_spec(self) -> Any:
        """Returns the spec of the observations for dm_env."""
        return self.spec.observation_spec()

    def action_spec(self) -> Any:
        """Returns the spec of the actions for dm_env."""
        return self.spec.action_spec()

    def seed(self, seed: Any = None) -> None:
        """Warns that it has no effect, as in EnvPool.

        Args:
            seed: Ignored.
        """
        warnings.warn("seed() has no effect; give seed to make()", stacklevel=2)

    def render(self, env_ids: Any = None, camera_id: Any = None) -> Pixels:
        """Returns the screens of some environments.

        Args:
            env_ids: One index or several. Default: `render_env_id`.
            camera_id: Ignored, as in EnvPool.

        Returns:
            uint8 array of shape (n, height, 160, 3).

        Raises:
            InvalidInput: If `env_ids` is empty.
        """
        pictures = self._envs.render() or ()
        envs = np.atleast_1d(self._render_env_id if env_ids is None else env_ids)
        if envs.size == 0:
            raise InvalidInput("env_ids is empty; it takes one environment or more")
        return np.stack([pictures[env][:ROWS] for env in envs])

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
        """Makes functions that programs compiled by JAX call.

        Errors of a compiled program are jax.errors.JaxRuntimeError.

        Returns:
            A handle, `recv(handle)`, `send(handle, action, env_id=None)` and `step(handle, action, env_id=None)`.
            `recv` returns the handle for the next call and what `recv` of this class returns, `send` returns the
            handle, and `step` does both.

        Raises:
            ImportError: If JAX is not installed.
        """
        return xla.functions(self._envs, self._format)

    def close(self) -> None:
        """Ends the threads, and frees the memory."""
        envs = self.__dict__.get("_envs")  # missing if the constructor failed
        if envs is not None:
            envs.close()

    def async_reset(self) -> None:
        """Begins new games of all environments, and drops what was not received. `recv` returns the first results."""
        self._send_resets(self._envs.every)

    def send(self, action: Any, env_id: Any = None) -> None:
        """Begins a step of some environments.

        Args:
            action: An action for each environment, or a dictionary with the parts "action" and "env_id", both int32.
            env_id: Indices of the environments. Default: all environments, or those that were received last if
                `batch_size` is below `num_envs`.

        Raises:
            IndexError: If an action is out of range.
            InvalidInput: If the shapes differ, or an index is wrong.
        """
        envs, actions = self._parse_action(action, env_id)
        self._envs.send_to(envs, actions)

    def _send_resets(self, env_id: Any) -> None:
        self._envs.send_resets_of(self._envs.parse_env_id(env_id))

    def _receive(self) -> Results:
        return self._envs.receive()

    def _reset(self, env_id: Any, options: Any = None) -> Any:
        if not isinstance(options, (Mapping, type(None))):
            raise InvalidInput(f"options is {options!r}; it takes a dictionary, or None")
        mask = _mask_of(options or {})
        if mask is not None and env_id is not None:
            raise InvalidInput("env_id and reset_mask are given; one of them chooses the environments")
        self._envs.send_resets_of(self._envs.select(mask) if env_id is None else self._envs.parse_env_id(env_id))
        return self._format(self._receive())

    def _step(self, action: Any, env_id: Any) -> Any:
        envs, actions = self._parse_action(action, env_id)
        if not self.is_async and np.array_equal(envs, self._envs.every):
            return self._format(self._envs.step_every(actions))
        self._envs.send_to(envs, actions)
        return self._format(self._receive())

    def _parse_action(self, action: Any, env_id: Any) -> tuple[Numbers, Any]:
        if isinstance(action, dict):
            parts = _checked_parts(action)
            action, env_id = parts["action"], parts.get("env_id", parts.get("players.env_id", env_id))
        if env_id is None:
            return (self._envs.received if self.is_async else self._envs.every), action
        return self._envs.parse_env_id(env_id), action

    def _format(self, results: Results) -> Any:
        raise NotImplementedError

    def _name_results(self, results: Results) -> dict[str, Any]:
        """Returns the results under the names of `spec.state_array_spec`."""
        observations, done = results.observations, results.terminated | results.truncated
        if observations.ndim == 5:  # colours become channels
            shape = self.spec.observation_space.shape
            observations = observations.transpose(0, 1, 4, 2, 3).reshape(len(observations), *shape)
        skip = self.config["frame_skip"]
        ends = done | (results.lives_lost > 0) if self.config["zero_discount_on_life_loss"] else done
        return {
            "info:env_id": results.env_id,
            "info:players.env_id": results.env_id.copy(),
            "elapsed_step": (results.elapsed + skip - 1) // skip,
            "done": done,
            "reward": results.rewards.astype(np.float32),
            "discount": (~ends).astype(np.float32),
            "step_type": ((results.acts > 0) * (1 + done)).astype(np.int32),
            "trunc": results.truncated,
            "obs": observations,
            "info:lives": results.lives,
            "info:reward": results.raw_rewards.astype(np.float32),
            "info:terminated": results.game_over.astype(np.int32),
            "info:ram": results.ram,
        }

    def _format_with_info(self, results: Results) -> tuple[Any, Any, Any, Any, Info]:
        """Returns observations, rewards, done, truncated and the info."""
        arrays = self._name_results(results)
        info = {name: arrays[f"info:{name}"] for name in ("env_id", "lives", "reward", "terminated", "ram")}
        info |= {"players": {"env_id": arrays["info:players.env_id"]}, "elapsed_step": arrays["elapsed_step"]}
        return arrays["obs"], arrays["reward"], arrays["done"], arrays["trunc"], info


def _checked_parts(action: dict[str, Any]) -> dict[str, Any]:
    parts = parts_of(action)
    for name in ("action", "env_id"):
        if name in parts and np.asarray(parts[name]).dtype != np.int32:
            raise InvalidInput(
                f"the part {name!r} of the action has the type {np.asarray(parts[name]).dtype}; it must be int32"
            )
    return parts


def _mask_of(options: Mapping[Any, Any]) -> Any:
    unknown = [name for name in options if name != "reset_mask"]
    if unknown:
        raise InvalidInput(f"options has {', '.join(map(repr, unknown))}; it takes only reset_mask")
    return options.get("reset_mask")
