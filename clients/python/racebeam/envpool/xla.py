"""xla() of EnvPool's interface: programs that JAX compiles send and receive environments, without Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import xla
from ..errors import InvalidInput
from .envs import Envs, parts_of
from .types import Results

__all__ = ["functions"]

# The results after the observations, in the order of bind_xla.cpp.
RESULTS = {**xla.RESULTS, "ram": np.uint8, "elapsed": np.int32, "acts": np.int32, "lives_lost": np.int32}
FIELDS = {"rewards": "reward", "raw_rewards": "raw_reward"}  # names of Results that differ from those of RESULTS


def functions(
    envs: Envs, format_results: Callable[[Results], Any]
) -> tuple[Any, Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
    """Makes the functions that compiled programs call.

    Args:
        envs: The environments.
        format_results: Converts results to what `recv` and `step` return.

    Returns:
        A handle, `recv(handle)`, `send(handle, action, env_id=None)` and `step(handle, action, env_id=None)`.

    Raises:
        ImportError: If JAX is not installed.
    """
    jax, count = xla.import_jax(), envs.batch_size
    observation_shape = (count, *(envs.single_observation_space.shape or ()))
    shapes = [observation_shape, *((count, 128) if name == "ram" else (count,) for name in RESULTS)]
    kinds = [np.uint8, *RESULTS.values()]

    def recv(handle: Any) -> tuple[Any, Any]:
        """Waits for the first `batch_size` environments that finish."""
        handle, observations, *rest = xla.call("receive", list(zip(shapes, kinds, strict=True)), handle)
        arrays = dict(zip(RESULTS, rest, strict=True))
        fields = {name: arrays[FIELDS.get(name, name)] for name in Results._fields if name != "observations"}
        return handle, format_results(Results(observations, **fields))

    def send(handle: Any, action: Any, env_id: Any = None) -> Any:
        """Begins a step of some environments."""
        if isinstance(action, dict):
            parts = parts_of(action)
            action, env_id = parts["action"], parts.get("env_id", parts.get("players.env_id", env_id))
        if env_id is None and count < envs.num_envs:
            raise InvalidInput(
                "env_id is None; with batch_size below num_envs, it takes the environments of the actions"
            )
        ids = xla.integers("env_id", envs.every if env_id is None else env_id)
        actions = xla.integers("actions", action)
        xla.check_shape("env_id", ids, (ids.size,))
        xla.check_shape("actions", actions, ids.shape)
        return xla.call("send", [], handle, actions, ids)[0]

    def step(handle: Any, action: Any, env_id: Any = None) -> tuple[Any, Any]:
        """Steps some environments."""
        return recv(send(handle, action, env_id))

    return jax.numpy.asarray(xla.handle_of(envs)), recv, send, step
