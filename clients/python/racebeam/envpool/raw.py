"""EnvPool's raw interface: arrays in, arrays out, in the order of their names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..errors import InvalidInput
from .pools import EnvPool
from .spec import CONFIG, EnvSpec

__all__ = ["RawPool", "RawSpec"]


class RawSpec(EnvSpec):
    """Of the values of all settings, in their order. Texts may be bytes."""

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
    """Environments that are sent and received as tuples of arrays."""

    def __init__(self, spec: EnvSpec) -> None:
        self._pool, self._spec = EnvPool(spec), spec
        self._state_keys, self._action_keys = list(spec.state_array_spec), list(spec.action_array_spec)

    def _reset(self, env_ids: Any) -> None:
        self._pool._send_resets(env_ids)

    def _send(self, action: Iterable[Any]) -> None:
        parts = dict(zip(self._action_keys, action))
        if len(parts) < len(self._action_keys):
            raise InvalidInput(f"the action has {len(parts)} arrays; it must have {', '.join(self._action_keys)}")
        self._pool.send(parts["action"], parts["env_id"])

    def _recv(self) -> tuple[Any, ...]:
        told = self._pool._told_by_name(self._pool._receive())
        return tuple(np.asarray(told[key]) for key in self._state_keys)
