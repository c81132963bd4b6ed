"""AtariVectorEnv.xla(): environments that a program compiled by JAX steps, on the processor, without Python in between.

envpool/xla.py makes its calls in the same way.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import InvalidInput

if TYPE_CHECKING:
    from .vector_env import AtariVectorEnv

__all__ = ["RESULTS", "call", "check_shape", "functions", "handle_of", "imported", "whole"]

Arrays = Sequence[tuple[tuple[int, ...], Any]]  # a shape and a type each

# After the observations, in the order of bind_xla.cpp.
RESULTS = {"reward": np.int32, "terminated": np.bool_, "truncated": np.bool_, "env_id": np.int32, "lives": np.int32, "frame_number": np.int32,
           "episode_frame_number": np.int32, "raw_reward": np.int32, "game_over": np.bool_}


def functions(envs: AtariVectorEnv, infos: tuple[str, ...]) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
    """A handle, reset and step. `infos`: the keys of the infos. Raises ImportError without JAX, and InvalidInput for
    environments that cannot be stepped so."""
    jax = imported()
    if envs.metadata["autoreset_mode"].name == "SAME_STEP":
        raise InvalidInput("autoreset_mode is SAME_STEP; xla() takes NEXT_STEP or DISABLED")
    if envs.batch_size < envs.num_envs:
        raise InvalidInput(f"batch_size is {envs.batch_size}; xla() steps all {envs.num_envs} environments")
    count, shape = envs.num_envs, envs.single_observation_space.shape or ()
    arrays: Arrays = [((count, *shape), np.uint8), *(((count,), kind) for kind in RESULTS.values())]

    def play(name: str, handle: Any, *arguments: Any) -> tuple[Any, Any, dict[str, Any]]:
        """The next handle, the observations, and the other results by name."""
        handle, observations, *rest = call(name, arrays, handle, *arguments)
        return handle, observations, dict(zip(RESULTS, rest))

    def told(results: dict[str, Any]) -> dict[str, Any]:
        return {key: results[key] for key in infos}

    def reset(handle: Any, seed: Any = None, reset_mask: Any = None) -> tuple[Any, tuple[Any, dict[str, Any]]]:
        """New episodes. seed: of the first environment, and the next has one more; or one for each; -1 is none.
        reset_mask: which environments; the others are shown. Returns the handle and what is shown."""
        seeds = whole("seed", -1 if seed is None else seed)
        if seeds.ndim == 0:
            seeds = jax.numpy.where(seeds < 0, seeds, seeds + np.arange(count, dtype=np.int32))
        mask = jax.numpy.asarray(np.ones(count, np.bool_) if reset_mask is None else reset_mask)
        if mask.dtype != np.bool_:
            raise TypeError(f"reset_mask has the type {mask.dtype}; it must be bool")
        check_shape("seed", seeds, (count,))
        check_shape("reset_mask", mask, (count,))
        handle, observations, results = play("reset", handle, seeds, mask)
        return handle, (observations, told(results))

    def step(handle: Any, actions: Any) -> tuple[Any, tuple[Any, Any, Any, Any, dict[str, Any]]]:
        """An action for each environment. Returns the handle and what is shown."""
        if envs.continuous:
            meant = jax.numpy.asarray(actions, np.float32)
            check_shape("actions", meant, (count, 3))
            handle, observations, results = play("step_joysticks", handle, meant, np.float32(envs.continuous_action_threshold).reshape(1))
        else:
            meant = whole("actions", actions)
            check_shape("actions", meant, (count,))
            handle, observations, results = play("step", handle, meant)
        return handle, (observations, results["reward"], results["terminated"], results["truncated"], told(results))

    return jax.numpy.asarray(handle_of(envs)), reset, step


def handle_of(envs: AtariVectorEnv) -> npt.NDArray[np.uint8]:
    """Names the environments in custom calls. The name holds until they are closed."""
    machines = envs.machines()
    if not isinstance(machines, _core.VectorMachines):
        raise InvalidInput("custom calls of XLA are not possible for environments on a server")
    return np.array([_core.xla_handle(machines)], np.uint64).view(np.uint8)


def imported() -> Any:
    """JAX. Raises ImportError without it."""
    try:
        importlib.import_module("jax.ffi")
    except ImportError:
        raise ImportError('xla() needs JAX; install it with: pip install "racebeam[jax]"') from None
    return importlib.import_module("jax")


def call(name: str, results: Arrays, handle: Any, *arguments: Any) -> Any:
    """What a custom call of bind_xla.cpp returns: the next handle, and results of these shapes and types."""
    _register()
    shapes = [imported().ShapeDtypeStruct(shape, kind) for shape, kind in [((8,), np.uint8), *results]]
    return imported().ffi.ffi_call(_target(name), shapes, has_side_effect=True)(handle, *arguments)


def _target(name: str) -> str:
    return f"racebeam_{name}"


@functools.cache
def _register() -> None:
    for name, target in _core.xla_targets().items():
        imported().ffi.register_ffi_target(_target(name), target, platform="cpu")


def whole(name: str, values: Any) -> Any:
    """As an array of int32. Raises TypeError."""
    array = imported().numpy.asarray(values)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} have the type {array.dtype}; they must be integers")
    return array.astype(np.int32)


def check_shape(name: str, array: Any, shape: tuple[int, ...]) -> None:
    """Raises InvalidInput."""
    if array.shape != shape:
        raise InvalidInput(f"{name} have the shape {array.shape}; they must have {shape}")
