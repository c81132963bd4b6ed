"""make() and the functions beside it."""

from __future__ import annotations

from typing import Any, Literal, overload

from ..arguments import flag
from .pools import DMEnvPool, GymEnvPool, GymnasiumEnvPool
from .spec import EnvSpec, InvalidSetting, call_check, games, without_rendering

__all__ = ["list_all_envs", "make", "make_dm", "make_gym", "make_gymnasium", "make_spec"]


def list_all_envs() -> list[str]:
    """Lists the tasks.

    Returns:
        Their ids, such as "Pong-v5".
    """
    return list(games())


def make_spec(task_id: str, **config: Any) -> EnvSpec:
    """Makes the spec of a task.

    Args:
        task_id: Id of the task, such as "Pong-v5".
        **config: Settings of `racebeam.envpool.spec.CONFIG`.

    Returns:
        The settings and the spaces of the task.

    Raises:
        InvalidSetting: If the task is unknown, or a setting is wrong.
    """
    return EnvSpec.from_task(task_id, without_rendering(config))


def make_gymnasium(task_id: str, **config: Any) -> GymnasiumEnvPool:
    """Makes environments with the interface of Gymnasium.

    Args:
        task_id: Id of the task, such as "Pong-v5".
        **config: Settings of `racebeam.envpool.spec.CONFIG`.

    Returns:
        The environments.

    Raises:
        InvalidSetting: If the task is unknown, or a setting is wrong.
    """
    _check_reset_info("gymnasium", config)
    return GymnasiumEnvPool(*_pool_arguments(task_id, config, True))


def make_gym(task_id: str, **config: Any) -> GymnasiumEnvPool:
    """Does the same as `make_gymnasium`. For the interface of Gym 0.21, call `make(env_type="gym")`.

    Args:
        task_id: Id of the task, such as "Pong-v5".
        **config: Settings of `racebeam.envpool.spec.CONFIG`.

    Returns:
        The environments.

    Raises:
        InvalidSetting: If the task is unknown, or a setting is wrong.
    """
    return make_gymnasium(task_id, **config)


def make_dm(task_id: str, **config: Any) -> DMEnvPool:
    """Makes environments with the interface of dm_env.

    Args:
        task_id: Id of the task, such as "Pong-v5".
        **config: Settings of `racebeam.envpool.spec.CONFIG`.

    Returns:
        The environments. They are a dm_env.Environment to a program that has imported dm_env.

    Raises:
        InvalidSetting: If the task is unknown, or a setting is wrong.
    """
    _check_reset_info("dm", config)
    return DMEnvPool(*_pool_arguments(task_id, config, True))


def _make_old_gym(task_id: str, **config: Any) -> GymEnvPool | GymnasiumEnvPool:
    if call_check(flag, "gym_reset_return_info", config.get("gym_reset_return_info")):
        return make_gymnasium(task_id, **config)
    return GymEnvPool(*_pool_arguments(task_id, config, False))


def _pool_arguments(task_id: str, config: dict[str, Any], returns_info: bool) -> tuple[EnvSpec, Any, Any]:
    """Returns the arguments of a pool.

    Args:
        task_id: Id of the task.
        config: Settings.
        returns_info: Value of `gym_reset_return_info` in the spec.
    """
    spec = make_spec(task_id, **{**config, "gym_reset_return_info": returns_info})
    return spec, config.get("render_env_id", 0), config.get("render_mode")


def _check_reset_info(env_type: str, config: dict[str, Any]) -> None:
    value = config.get("gym_reset_return_info")
    if value is not None and not call_check(flag, "gym_reset_return_info", value):
        raise InvalidSetting(
            f"gym_reset_return_info is {value!r}; {env_type} environments take True, "
            'and make(env_type="gym") takes both'
        )


MAKERS: dict[str, Any] = {"gymnasium": make_gymnasium, "gym": _make_old_gym, "dm": make_dm}


@overload
def make(task_id: str, env_type: Literal["gymnasium"], **config: Any) -> GymnasiumEnvPool: ...
@overload
def make(task_id: str, env_type: Literal["dm"], **config: Any) -> DMEnvPool: ...
@overload
def make(task_id: str, env_type: str, **config: Any) -> Any: ...
def make(task_id: str, env_type: str, **config: Any) -> Any:
    """Makes environments of a task.

    Args:
        task_id: Id of the task, such as "Pong-v5".
        env_type: "gymnasium", "gym" for the interface of Gym 0.21, or "dm" for that of dm_env.
        **config: Settings of `racebeam.envpool.spec.CONFIG`.

    Returns:
        The environments.

    Raises:
        InvalidSetting: If the task or the type is unknown, or a setting is wrong.

    Examples:
        >>> import racebeam.envpool
        >>> envs = racebeam.envpool.make("Beamfall-v5", env_type="gymnasium", num_envs=4)
        >>> observations, info = envs.reset()
        >>> observations.shape
        (4, 4, 84, 84)
        >>> envs.close()
    """
    if not isinstance(env_type, str) or env_type not in MAKERS:
        raise InvalidSetting(f"env_type is {env_type!r}; it takes {', '.join(MAKERS)}")
    return MAKERS[env_type](task_id, **config)
