"""AtariVectorEnv with the infos and the checks of ale_py's."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import vector_env
from ..vector_results import Bools, Numbers, Results
from ..wire.remote_machines import STICK
from .interface import check_game, plain_errors
from .single import AtariEnv
from .vector_interface import ALEVectorInterface

__all__ = ["ALEVectorInterface", "AtariEnv", "AtariVectorEnv"]


class AtariVectorEnv(vector_env.AtariVectorEnv):
    """racebeam.AtariVectorEnv with the infos and the checks of ale_py's."""

    _xla_infos = ("env_id", "lives", "frame_number", "episode_frame_number")
    is_xla_registered = False
    _was_reset = False
    _check_game = staticmethod(check_game)

    @functools.cached_property
    def map_action_idx(self) -> Numbers:
        """The number of the action of each continuous one: from left to right, from down to up, then without fire."""
        return np.ascontiguousarray(STICK.transpose(2, 1, 0), np.int32)

    @property
    def ale(self) -> ALEVectorInterface:
        """The same environments as lists and arrays."""
        return ALEVectorInterface.of(self)

    def reset(
        self, *, seed: Any = None, options: dict[str, Any] | None = None, out: Any = None
    ) -> tuple[Any, vector_env.Info]:
        return plain_errors(self._reset_as_ale, ValueError)(seed, options, out)

    def _reset_as_ale(self, seed: Any, options: dict[str, Any] | None, out: Any) -> tuple[Any, vector_env.Info]:
        mask = self._mask(options.get("reset_mask")) if isinstance(options, dict) else None
        if not (self._was_reset or mask is None or mask.all()):
            raise RuntimeError(
                f"reset_mask chooses {mask.sum()} of {self.num_envs}; the first reset() must reset every environment"
            )
        shown = super().reset(seed=seed, options=options, out=out)
        self._was_reset = True
        return shown

    def _seeds(self, seed: Any, mask: Bools | None) -> npt.NDArray[np.int64] | None:
        """Given for the environments of the mask alone, and counted over them."""
        if seed is None or mask is None:
            return super()._seeds(seed, mask)
        seeds = np.full(self.num_envs, -1, np.int64)
        seeds[mask] = self._seeds_of(seed, int(mask.sum()))
        return seeds

    def step(self, actions: Any, *, out: Any = None) -> vector_env.Step:
        self._check_reset()
        return super().step(actions, out=out)

    def send(self, actions: Any) -> None:
        self._check_reset()
        super().send(actions)

    def _check_reset(self) -> None:
        self._check_open()
        if not self._was_reset:
            raise RuntimeError("these environments were not reset yet; call reset() first")

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
        functions = super().xla()
        self.is_xla_registered = self._was_reset = True
        return functions

    def action_numbers(self) -> list[int]:
        """Those of the actions that step() takes indices of."""
        return self.machines().actions_of(0)

    def send_strengths(self, actions: Any, strengths: Any) -> None:
        """As send(), with how far each paddle is turned, 0 to 1."""
        self._check_reset()
        turned = vector_env.array_of(strengths)
        if turned.dtype.kind not in "fiu":
            raise TypeError(f"paddle strengths have the type {turned.dtype}; they must be numbers")
        self._check_shape(turned, ())
        self.machines().send_strengths(
            vector_env.AtariVectorEnv._indices(self, actions), turned.astype(np.float32), self._ready()
        )

    def _indices(self, actions: Any, count: int | None = None) -> npt.NDArray[np.int64]:
        assert isinstance(actions, np.ndarray) and actions.dtype in (np.int32, np.int64), (
            f"actions are {actions!r}; they must be an array of int32 or int64"
        )
        assert actions.shape == (self.batch_size,), (
            f"actions have the shape {actions.shape}; they must have {(self.batch_size,)}"
        )
        return super()._indices(actions, count)

    def _joysticks(self, actions: Any) -> npt.NDArray[np.float32]:
        assert isinstance(actions, np.ndarray) and actions.dtype == np.float32, (
            f"actions are {actions!r}; they must be an array of float32"
        )
        assert actions.shape == (self.batch_size, 3), (
            f"actions have the shape {actions.shape}; they must have {(self.batch_size, 3)}"
        )
        return super()._joysticks(actions)

    def _info(self, results: Results) -> vector_env.Info:
        return {
            "env_id": results.env_id,
            "lives": results.lives,
            "frame_number": results.frames,
            "episode_frame_number": results.episode_frames,
        }

    def _add_finals(self, info: vector_env.Info, observations: Any, results: Results) -> None:
        """One array of all environments. Where no episode ended, it has the present observation."""
        finals = results.final_observations
        assert finals is not None
        goes_on = ~results.finished
        finals[goes_on] = observations[goes_on]
        info["final_obs"] = finals
