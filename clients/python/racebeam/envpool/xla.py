"""xla() of EnvPool's interface: environments that a program compiled by JAX sends and receives, without Python in between."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import xla
from ..errors import InvalidInput
from .envs import Envs, Shown, parts_of

__all__ = ["functions"]

# After the observations, in the order of bind_xla.cpp.
RESULTS = {**xla.RESULTS, "ram": np.uint8, "elapsed": np.int32, "acts": np.int32, "lives_lost": np.int32}
FIELDS = {"rewards": "reward", "raw_rewards": "raw_reward"}  # of Shown, where their names differ


def functions(
    envs: Envs, shown_as: Callable[[Shown], Any]
) -> tuple[Any, Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
    """A handle, recv, send and step. shown_as: what recv and step return of what is shown."""
    jax, count = xla.imported(), envs.batch_size
    shapes = [
        (count, *(envs.single_observation_space.shape or ())),
        *((count, 128) if name == "ram" else (count,) for name in RESULTS),
    ]
    kinds = [np.uint8, *RESULTS.values()]

    def recv(handle: Any) -> tuple[Any, Any]:
        handle, observations, *rest = xla.call("receive", list(zip(shapes, kinds)), handle)
        told = dict(zip(RESULTS, rest))
        fields = {name: told[FIELDS.get(name, name)] for name in Shown._fields if name != "observations"}
        return handle, shown_as(Shown(observations, **fields))

    def send(handle: Any, action: Any, env_id: Any = None) -> Any:
        if isinstance(action, dict):
            parts = parts_of(action)
            action, env_id = parts["action"], parts.get("env_id", parts.get("players.env_id", env_id))
        if env_id is None and count < envs.num_envs:
            raise InvalidInput(
                "env_id is None; with batch_size below num_envs, it takes the environments of the actions"
            )
        numbers = xla.whole("env_id", envs.every if env_id is None else env_id)
        actions = xla.whole("actions", action)
        xla.check_shape("env_id", numbers, (numbers.size,))
        xla.check_shape("actions", actions, numbers.shape)
        return xla.call("send", [], handle, actions, numbers)[0]

    def step(handle: Any, action: Any, env_id: Any = None) -> tuple[Any, Any]:
        return recv(send(handle, action, env_id))

    return jax.numpy.asarray(xla.handle_of(envs)), recv, send, step
