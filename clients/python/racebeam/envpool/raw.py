"""EnvPool's raw interface, which takes and returns arrays in the order of their names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..errors import InvalidInput
from .pools import EnvPool
from .spec import CONFIG, EnvSpec

__all__ = ["RawPool", "RawSpec"]


class RawSpec(EnvSpec):
    """The spec of a task, made from the values of all settings in their order.

    Args:
        values: A value for each setting of `CONFIG`. Text may be bytes.

    Raises:
        InvalidSetting: If a value is wrong.

    Examples:
        >>> from racebeam.envpool.raw import RawSpec
        >>> config = dict(zip(RawSpec._config_keys, RawSpec._default_config_values)) | {"task": b"beamfall"}
        >>> RawSpec(config.values()).id
        'Beamfall-v5'
    """

    _config_keys = list(CONFIG)
    _default_config_values = tuple(CONFIG.values())

    def __init__(self, values: Iterable[Any]) -> None:
        super().__init__(value.decode() if isinstance(value, bytes) else value for value in values)
        self._config_values = tuple(self.config)

    @property
    def _state_keys(self) -> list[str]:
        return list(self.state_array_spec)

    @property
    def _action_keys(self) -> list[str]:
        return list(self.action_array_spec)


class RawPool:
    """Environments that are sent and received as tuples of arrays.

    Args:
        spec: Spec of the task.

    Examples:
        >>> from racebeam.envpool import make_spec
        >>> from racebeam.envpool.raw import RawPool
        >>> pool = RawPool(make_spec("Beamfall-v5", num_envs=2))
        >>> pool._reset([0, 1])
        >>> dict(zip(pool._state_keys, pool._recv()))["obs"].shape
        (2, 4, 84, 84)
    """

    def __init__(self, spec: EnvSpec) -> None:
        self._pool, self._spec = EnvPool(spec), spec
        self._state_keys, self._action_keys = list(spec.state_array_spec), list(spec.action_array_spec)

    def _reset(self, env_ids: Any) -> None:
        self._pool._send_resets(env_ids)

    def _send(self, action: Iterable[Any]) -> None:
        parts = dict(zip(self._action_keys, action, strict=False))
        if len(parts) < len(self._action_keys):
            raise InvalidInput(f"the action has {len(parts)} arrays; it must have {', '.join(self._action_keys)}")
        self._pool.send(parts["action"], parts["env_id"])

    def _recv(self) -> tuple[Any, ...]:
        arrays = self._pool._name_results(self._pool._receive())
        return tuple(np.asarray(arrays[key]) for key in self._state_keys)
