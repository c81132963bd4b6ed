"""make() and its like."""

from __future__ import annotations

from typing import Any, Literal, overload

from ..arguments import flag
from .pools import DMEnvPool, GymEnvPool, GymnasiumEnvPool
from .spec import EnvSpec, InvalidSetting, checked, games, without_rendering

__all__ = ["list_all_envs", "make", "make_dm", "make_gym", "make_gymnasium", "make_spec"]


def list_all_envs() -> list[str]:
    """Pong-v5 and so on."""
    return list(games())


def make_spec(task_id: str, **config: Any) -> EnvSpec:
    """The settings and the spaces of a task."""
    return EnvSpec.of(task_id, without_rendering(config))


def make_gymnasium(task_id: str, **config: Any) -> GymnasiumEnvPool:
    _check_info_wanted("gymnasium", config)
    return GymnasiumEnvPool(*_given(task_id, config, True))


def make_gym(task_id: str, **config: Any) -> GymnasiumEnvPool:
    """The same as make_gymnasium(); make(env_type="gym") has the interface of Gym 0.21."""
    return make_gymnasium(task_id, **config)


def make_dm(task_id: str, **config: Any) -> DMEnvPool:
    """It is a dm_env.Environment to a program that has imported dm_env."""
    _check_info_wanted("dm", config)
    return DMEnvPool(*_given(task_id, config, True))


def _make_old_gym(task_id: str, **config: Any) -> GymEnvPool | GymnasiumEnvPool:
    if checked(flag, "gym_reset_return_info", config.get("gym_reset_return_info")):
        return make_gymnasium(task_id, **config)
    return GymEnvPool(*_given(task_id, config, False))


def _given(task_id: str, config: dict[str, Any], returns_info: bool) -> tuple[EnvSpec, Any, Any]:
    """The arguments of a pool. returns_info: what its spec says of reset()."""
    spec = make_spec(task_id, **{**config, "gym_reset_return_info": returns_info})
    return spec, config.get("render_env_id", 0), config.get("render_mode")


def _check_info_wanted(env_type: str, config: dict[str, Any]) -> None:
    wanted = config.get("gym_reset_return_info")
    if wanted is not None and not checked(flag, "gym_reset_return_info", wanted):
        raise InvalidSetting(
            f'gym_reset_return_info is {wanted!r}; {env_type} environments take True, and make(env_type="gym") takes both'
        )


MAKERS: dict[str, Any] = {"gymnasium": make_gymnasium, "gym": _make_old_gym, "dm": make_dm}


@overload
def make(task_id: str, env_type: Literal["gymnasium"], **config: Any) -> GymnasiumEnvPool: ...
@overload
def make(task_id: str, env_type: Literal["dm"], **config: Any) -> DMEnvPool: ...
@overload
def make(task_id: str, env_type: str, **config: Any) -> Any: ...
def make(task_id: str, env_type: str, **config: Any) -> Any:
    """Environments of the task, such as "Pong-v5". config: the settings of racebeam.envpool.spec.CONFIG."""
    if not isinstance(env_type, str) or env_type not in MAKERS:
        raise InvalidSetting(f"env_type is {env_type!r}; it takes {', '.join(MAKERS)}")
    return MAKERS[env_type](task_id, **config)
