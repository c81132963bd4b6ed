"""AtariVectorEnv.xla(): steps environments from programs that JAX compiles, on the processor and without Python.

envpool/xla.py makes its calls in the same way.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Sequence
from typing import Any, Literal, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from . import _core
from .errors import InvalidInput
from .extras import install_hint
from .vector.machines import Machines

__all__ = ["RESULTS", "call", "check_shape", "functions", "handle_of", "import_jax", "integers"]

SEEDS = 2**31 - 1  # the largest seed that a custom call takes
Shapes: TypeAlias = Sequence[tuple[tuple[int, ...], Any]]  # a shape and a dtype for each array

# The results after the observations, in the order of bind_xla.cpp.
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


class Environments(Protocol):
    """The parts of a vector of environments that xla() uses."""

    num_envs: int
    batch_size: int
    metadata: dict[str, Any]
    single_observation_space: spaces.Space[Any]
    continuous: bool
    sound_obs: bool | Literal["all"]
    continuous_action_threshold: float

    def _open_machines(self) -> Machines:
        """Returns the machines that play the environments."""


def functions(envs: Environments, infos: tuple[str, ...]) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
    """Makes the functions that compiled programs call.

    Args:
        envs: The environments.
        infos: Keys of the infos that the functions return.

    Returns:
        A handle, `reset(handle, seed=None, reset_mask=None)` and `step(handle, actions)`.

    Raises:
        ImportError: If JAX is not installed.
        InvalidInput: If the options of the environments rule compiled programs out.
    """
    jax = import_jax()
    if envs.metadata["autoreset_mode"].name == "SAME_STEP":
        raise InvalidInput("autoreset_mode is SAME_STEP; xla() takes NEXT_STEP or DISABLED")
    if envs.batch_size < envs.num_envs:
        raise InvalidInput(f"batch_size is {envs.batch_size}; xla() steps all {envs.num_envs} environments")
    if envs.sound_obs:
        raise InvalidInput(f"sound_obs is {envs.sound_obs!r}; xla() takes False")
    count, shape = envs.num_envs, envs.single_observation_space.shape or ()
    shapes: Shapes = [((count, *shape), np.uint8), *(((count,), kind) for kind in RESULTS.values())]

    def play(name: str, handle: Any, *arguments: Any) -> tuple[Any, Any, dict[str, Any]]:
        """Returns the next handle, the observations, and the other results by name."""
        handle, observations, *rest = call(name, shapes, handle, *arguments)
        return handle, observations, dict(zip(RESULTS, rest, strict=True))

    def make_info(results: dict[str, Any]) -> dict[str, Any]:
        return {key: results[key] for key in infos}

    def reset(handle: Any, seed: Any = None, reset_mask: Any = None) -> tuple[Any, tuple[Any, dict[str, Any]]]:
        """Begins new episodes.

        Args:
            handle: The handle that the last call returned.
            seed: Seed of the first environment, from which the seeds count up, or an array of shape (num_envs,). -1
                means unseeded. Seeds end at 2**31 - 1; of the seeds in an array of JAX, the lower 31 bits are used.
            reset_mask: bool array of shape (num_envs,) that chooses the environments to reset; None for all.

        Returns:
            The next handle, and a tuple of observations and info.
        """
        seeds = _seeds(-1 if seed is None else seed, count)
        mask = jax.numpy.asarray(np.ones(count, np.bool_) if reset_mask is None else reset_mask)
        if mask.dtype != np.bool_:
            raise TypeError(f"reset_mask has the type {mask.dtype}; it must be bool")
        check_shape("seed", seeds, (count,))
        check_shape("reset_mask", mask, (count,))
        handle, observations, results = play("reset", handle, seeds, mask)
        return handle, (observations, make_info(results))

    def step(handle: Any, actions: Any) -> tuple[Any, tuple[Any, Any, Any, Any, dict[str, Any]]]:
        """Steps all environments.

        Args:
            handle: The handle that the last call returned.
            actions: Integer array of shape (num_envs,), or float32 of shape (num_envs, 3) with continuous actions.

        Returns:
            The next handle, and a tuple of observations, rewards, terminated, truncated and info.
        """
        if envs.continuous:
            sticks = jax.numpy.asarray(actions, np.float32)
            check_shape("actions", sticks, (count, 3))
            threshold = np.float32(envs.continuous_action_threshold).reshape(1)
            handle, observations, results = play("step_joysticks", handle, sticks, threshold)
        else:
            indices = integers("actions", actions)
            check_shape("actions", indices, (count,))
            handle, observations, results = play("step", handle, indices)
        ends = results["terminated"], results["truncated"]
        return handle, (observations, results["reward"], *ends, make_info(results))

    return jax.numpy.asarray(handle_of(envs)), reset, step


def handle_of(envs: Environments) -> npt.NDArray[np.uint8]:
    """Makes the handle that names environments in custom calls.

    Args:
        envs: The environments.

    Returns:
        uint8 array of shape (8,). It is valid until the environments are closed.

    Raises:
        InvalidInput: If the environments run on a server.
    """
    machines = envs._open_machines()
    if not isinstance(machines, _core.VectorMachines):
        raise InvalidInput("custom calls of XLA are not possible for environments on a server")
    return np.array([_core.xla_handle(machines)], np.uint64).view(np.uint8)


def import_jax() -> Any:
    """Imports JAX.

    Returns:
        The module `jax`.

    Raises:
        ImportError: If JAX is not installed.
    """
    try:
        importlib.import_module("jax.ffi")
    except ImportError:
        raise ImportError(f"xla() needs JAX; {install_hint('jax')}") from None
    return importlib.import_module("jax")


def call(name: str, shapes: Shapes, handle: Any, *arguments: Any) -> Any:
    """Makes a custom call of bind_xla.cpp.

    Args:
        name: Name of the call.
        shapes: Shape and dtype of each result.
        handle: The handle that the last call returned.
        *arguments: Arrays of arguments.

    Returns:
        The next handle, then the results.
    """
    _register()
    results = [import_jax().ShapeDtypeStruct(shape, kind) for shape, kind in [((8,), np.uint8), *shapes]]
    return import_jax().ffi.ffi_call(_target(name), results, has_side_effect=True)(handle, *arguments)


def _target(name: str) -> str:
    return f"racebeam_{name}"


@functools.cache
def _register() -> None:
    for name, target in _core.xla_targets().items():
        import_jax().ffi.register_ffi_target(_target(name), target, platform="cpu")


def integers(name: str, values: Any) -> Any:
    """Converts whole numbers to int32.

    Args:
        name: Name of the argument.
        values: Whole numbers. One beyond the range of int32 becomes the nearest end of the range, which is not the
            number of an action or of an environment.

    Returns:
        An int32 array of JAX.

    Raises:
        TypeError: If the values are not integers.
    """
    array = _integers(name, values)
    limits, of_array = np.iinfo(np.int32), np.iinfo(array.dtype)
    return import_jax().numpy.asarray(
        array.clip(max(limits.min, of_array.min), min(limits.max, of_array.max)), np.int32
    )


def _integers(name: str, values: Any) -> Any:
    """Converts to an array of NumPy, whose numbers JAX has not narrowed, or of JAX if a part of `values` is one."""
    jax = import_jax()
    is_of_jax = any(isinstance(part, jax.Array) for part in jax.tree.leaves(values))
    array = jax.numpy.asarray(values) if is_of_jax else np.asarray(values)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} have the type {array.dtype}; they must be integers")
    return array


def _seeds(values: Any, count: int) -> Any:
    """Converts seeds to int32, one for each environment; -1 means unseeded.

    Raises:
        InvalidInput: If a seed is too large, as far as its value is known before the program runs.
    """
    array = _integers("seed", values)
    offsets = np.arange(count if array.ndim == 0 else 1, dtype=np.uint32)
    if isinstance(array, np.ndarray):
        limit = SEEDS - int(offsets[-1])
        if (array > limit).any():
            raise InvalidInput(f"the seed is {array[array > limit][0]}; it takes up to {limit}")
    jax_numpy = import_jax().numpy
    numbers = (jax_numpy.asarray(array.astype(np.uint32)) + offsets) & np.uint32(SEEDS)
    return jax_numpy.where(array < 0, -1, numbers.astype(np.int32))


def check_shape(name: str, array: Any, shape: tuple[int, ...]) -> None:
    """Checks the shape of an array.

    Args:
        name: Name of the array, in the plural.
        array: An array of JAX.
        shape: The shape that it must have.

    Raises:
        InvalidInput: If `array` does not have this shape.
    """
    if array.shape != shape:
        raise InvalidInput(f"{name} have the shape {array.shape}; they must have {shape}")
