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

SEEDS = 2**31 - 1  # the greatest that a custom call takes
Arrays = Sequence[tuple[tuple[int, ...], Any]]  # a shape and a type each

# After the observations, in the order of bind_xla.cpp.
RESULTS = {
    "reward": np.int32,
    "terminated": np.bool_,
    "truncated": np.bool_,
    "env_id": np.int32,
    "lives": np.int32,
    "frame_number": np.int32,
    "episode_frame_number": np.int32,
    "raw_reward": np.int32,
    "game_over": np.bool_,
}


def functions(envs: AtariVectorEnv, infos: tuple[str, ...]) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
    """A handle, reset and step. `infos`: the keys of the infos. Raises ImportError without JAX, and InvalidInput for
    environments that cannot be stepped so.
    """
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
        Seeds end at 2**31 - 1; an array of JAX gives their lower 31 bits. reset_mask: which environments; the others
        are shown. Returns the handle and what is shown.
        """
        seeds = _seeds(-1 if seed is None else seed, count)
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
            handle, observations, results = play(
                "step_joysticks", handle, meant, np.float32(envs.continuous_action_threshold).reshape(1)
            )
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
    """As an array of int32. What is beyond its range becomes the nearest end, which names no action and no environment.
    Raises TypeError.
    """
    array = _integers(name, values)
    limits, of_array = np.iinfo(np.int32), np.iinfo(array.dtype)
    return imported().numpy.asarray(array.clip(max(limits.min, of_array.min), min(limits.max, of_array.max)), np.int32)


def _integers(name: str, values: Any) -> Any:
    """As an array of NumPy, whose numbers JAX has not narrowed, or of JAX if a part of it is one. Raises TypeError."""
    jax = imported()
    is_of_jax = any(isinstance(part, jax.Array) for part in jax.tree.leaves(values))
    array = jax.numpy.asarray(values) if is_of_jax else np.asarray(values)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} have the type {array.dtype}; they must be integers")
    return array


def _seeds(values: Any, count: int) -> Any:
    """Of each environment, in int32; -1 is none. One seed counts up. Raises InvalidInput for one that is too large, as far
    as it is known before the program runs.
    """
    array = _integers("seed", values)
    offsets = np.arange(count if array.ndim == 0 else 1, dtype=np.uint32)
    if isinstance(array, np.ndarray):
        most = SEEDS - int(offsets[-1])
        if (array > most).any():
            raise InvalidInput(f"the seed is {array[array > most][0]}; it takes up to {most}")
    jax_numpy = imported().numpy
    numbers = (jax_numpy.asarray(array.astype(np.uint32)) + offsets) & np.uint32(SEEDS)
    return jax_numpy.where(array < 0, -1, numbers.astype(np.int32))


def check_shape(name: str, array: Any, shape: tuple[int, ...]) -> None:
    """Raises InvalidInput."""
    if array.shape != shape:
        raise InvalidInput(f"{name} have the shape {array.shape}; they must have {shape}")
