"""The ids of Gymnasium: racebeam's own, and on request those of ale_py."""

from __future__ import annotations

from typing import Any

import gymnasium

from . import ale_games, images

ENTRY_POINT = "racebeam.env:AtariEnv"
VECTOR_ENTRY_POINT = "racebeam.vector_env:AtariVectorEnv"
ALE_VECTOR_ENTRY_POINT = "racebeam.ale_py.vector_env:AtariVectorEnv"
FRAMES_OF_AN_EPISODE = 108000

# The ids of Gym's time, by what is around the game's name: repeat_action_probability and frameskip.
OLD_IDS: dict[str, tuple[float, int | tuple[int, int]]] = {
    "{}-v0": (0.25, (2, 5)),
    "{}-v4": (0.0, (2, 5)),
    "{}NoFrameskip-v0": (0.25, 1),
    "{}NoFrameskip-v4": (0.0, 1),
}


def rom_id_to_name(rom: str) -> str:
    """SpaceInvaders of space_invaders."""
    return rom.title().replace("_", "")


def _register(env_id: str, vector: str | None, **arguments: Any) -> None:
    """Takes the place of another's environment of this id, without a warning: it was asked for. vector: the entry point of
    gymnasium.make_vec()."""
    gymnasium.registry.pop(env_id, None)
    gymnasium.register(env_id, ENTRY_POINT, vector_entry_point=vector, kwargs=arguments)


def _register_as_ale(env_id: str, vector: str | None, game: str, sticky: float, frameskip: int | tuple[int, int]) -> None:
    _register(env_id, vector, game=game, repeat_action_probability=sticky, full_action_space=False, frameskip=frameskip,
              max_num_frames_per_episode=FRAMES_OF_AN_EPISODE)


def register_own_ids() -> None:
    """racebeam/Pong-v5 and so on. Their settings are a preset, so that preset= of gymnasium.make() replaces all."""
    for game in images.titles():
        _register(f"racebeam/{rom_id_to_name(game)}-v5", VECTOR_ENTRY_POINT, game=game, preset="gym-v5")


def register_v5_envs() -> None:
    """ALE/Pong-v5 and so on."""
    for game in ale_games.EVERY:
        if game not in ale_games.FOR_TWO:
            _register_as_ale(f"ALE/{rom_id_to_name(game)}-v5", ALE_VECTOR_ENTRY_POINT, game, 0.25, 4)


def register_v0_v4_envs() -> None:
    """Pong-v0, Pong-v4, PongNoFrameskip-v0 and PongNoFrameskip-v4, and so on."""
    for pattern, (sticky, frameskip) in OLD_IDS.items():
        for game in ale_games.OF_OLD:
            _register_as_ale(pattern.format(rom_id_to_name(game)), None, game, sticky, frameskip)


def register_ale_ids() -> None:
    """All ids of ale_py."""
    register_v0_v4_envs()
    register_v5_envs()
