"""The settings of many environments: the arguments of AtariVectorEnv, checked, as the core names them.

The names are those of _core.VectorSettings, and mostly those of the line protocol (protocol/PROTOCOL.md, "games and load").
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from typing import Any

from gymnasium.vector import AutoresetMode

from . import _core
from .arguments import MOST, WrongType, WrongValue, check_choice, either, flag, member, share, whole
from .presets import vector_preset

OBS_TYPES = (None, "rgb", "grayscale", "ram")
RULES = {"ale-0.12": _core.Rules.ALE_0_12, "fixed": _core.Rules.FIXED}
SEEDS = (0, 2**32 - 1)
SIDES = (0, 1000)  # the screens of a game limit them further


def autoreset_of(mode: object) -> AutoresetMode:
    """A mode, or its name: of the member, or as Gymnasium writes it."""
    for one in AutoresetMode:
        if mode is one or (isinstance(mode, str) and mode in (one.name, one.value)):
            return one
    raise (WrongValue if isinstance(mode, str) else WrongType)(
        f"autoreset_mode is {mode!r}; it takes {', '.join(one.value for one in AutoresetMode)}"
    )


def settings_of(given: Mapping[str, Any], num_envs: int) -> dict[str, Any]:
    """`given`: the arguments of AtariVectorEnv by name."""
    usual = {
        **given,
        **{name: either(given[name], value) for name, value in vector_preset(given["preset"])._asdict().items()},
    }
    check_choice("obs_type", given["obs_type"], OBS_TYPES)
    check_choice("render_mode", given["render_mode"], (None, "rgb_array"))
    check_choice("rules", given["rules"], tuple(RULES))
    _check_lives(given)
    return {
        "seed": secrets.randbits(32) if given["seed"] is None else whole("seed", given["seed"], *SEEDS),
        "rules": RULES[given["rules"]],
        "mode": _optional(given, "mode"),
        "difficulty": _optional(given, "difficulty"),
        **_of_steps(usual),
        **_of_episodes(usual),
        **_of_observations(given),
        "screens": given["render_mode"] is not None,
        "batch_size": whole("batch_size", given["batch_size"], 0, num_envs),
        "threads": min(whole("num_threads", given["num_threads"], 0, MOST), num_envs, 1024),
        "first_processor": whole("thread_affinity_offset", given["thread_affinity_offset"], -1, MOST),
    }


def _optional(given: Mapping[str, Any], name: str) -> int | None:
    return None if given[name] is None else whole(name, given[name], 0, MOST)


def _flag(given: Mapping[str, Any], name: str) -> bool:
    return flag(name, given[name])


def _of_steps(given: Mapping[str, Any]) -> dict[str, Any]:
    all_legal = _flag(given, "full_action_space") or _flag(given, "continuous")
    low, high = (-1, 1) if _flag(given, "reward_clipping") else (-MOST - 1, MOST)
    return {
        "frame_skip": whole("frameskip", given["frameskip"], 1, 1000),
        "sticky": share("repeat_action_probability", given["repeat_action_probability"]),
        "action_set": _core.ActionSet.LEGAL if all_legal else _core.ActionSet.MINIMAL,
        "reward_min": low,
        "reward_max": high,
        "pool": _flag(given, "maxpool"),
    }


def _check_lives(given: Mapping[str, Any]) -> None:
    if given["lives"] is None:
        return
    member("lives", given["lives"], _core.LifeLoss)
    for name, word in (("episodic_life", "restart"), ("life_loss_info", "told")):
        if given["lives"] != word and _flag(given, name):
            raise WrongValue(f"{name} is True, which means lives={word!r}, but lives is {given['lives']!r}")


def _of_episodes(given: Mapping[str, Any]) -> dict[str, Any]:
    lives = "restart" if _flag(given, "episodic_life") else "told" if _flag(given, "life_loss_info") else given["lives"]
    return {
        "max_episode_frames": whole("max_num_frames_per_episode", given["max_num_frames_per_episode"], 0, MOST),
        "noop_max": whole("noop_max", given["noop_max"], 0, 1000),
        "fire": _flag(given, "use_fire_reset"),
        "start": member("start", given["start"], _core.ResetOrder),
        "lives": member("lives", lives, _core.LifeLoss),
        "stack_start": member("stack_start", given["stack_start"], _core.StackStart),
        "autoreset": _core.Autoreset[autoreset_of(given["autoreset_mode"]).name],
    }


def _of_observations(given: Mapping[str, Any]) -> dict[str, Any]:
    obs_type = given["obs_type"]
    is_small = obs_type is None
    return {
        "stack": 0 if obs_type == "ram" else whole("stack_num", given["stack_num"], 1, 16),
        "width": whole("img_width", given["img_width"], *SIDES) if is_small else 0,
        "height": whole("img_height", given["img_height"], *SIDES) if is_small else 0,
        "rgb": not _flag(given, "grayscale") if is_small else obs_type == "rgb",
    }
