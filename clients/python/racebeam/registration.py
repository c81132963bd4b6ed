"""The ids of Gymnasium: racebeam's own, and on request those of ale_py."""

from __future__ import annotations

from typing import Any

import gymnasium

from . import ale_games, images

ALE_PACKAGE = "racebeam.ale_py"
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


def _register(env_id: str, package: str, has_vectors: bool, **arguments: Any) -> None:
    """Takes the place of another's environment of this id, without a warning: it was asked for. package: where its modules `env` and
    `vector_env` are. has_vectors: for gymnasium.make_vec(), too.
    """
    gymnasium.registry.pop(env_id, None)
    vectors = f"{package}.vector_env:AtariVectorEnv" if has_vectors else None
    gymnasium.register(env_id, f"{package}.env:AtariEnv", vector_entry_point=vectors, kwargs=arguments)


def _register_as_ale(
    env_id: str, package: str, has_vectors: bool, game: str, sticky: float, frameskip: int | tuple[int, int]
) -> None:
    _register(
        env_id,
        package,
        has_vectors,
        game=game,
        repeat_action_probability=sticky,
        full_action_space=False,
        frameskip=frameskip,
        max_num_frames_per_episode=FRAMES_OF_AN_EPISODE,
    )


def register_own_ids() -> None:
    """racebeam/Pong-v5 and so on. Their settings are a preset, so that preset= of gymnasium.make() replaces all."""
    for game in images.titles():
        _register(f"racebeam/{rom_id_to_name(game)}-v5", "racebeam", True, game=game, preset="gym-v5")


def register_v5_envs(package: str = ALE_PACKAGE) -> None:
    """ALE/Pong-v5 and so on."""
    for game in ale_games.EVERY:
        if game not in ale_games.FOR_TWO:
            _register_as_ale(f"ALE/{rom_id_to_name(game)}-v5", package, True, game, 0.25, 4)


def register_v0_v4_envs(package: str = ALE_PACKAGE) -> None:
    """Pong-v0, Pong-v4, PongNoFrameskip-v0 and PongNoFrameskip-v4, and so on."""
    for pattern, (sticky, frameskip) in OLD_IDS.items():
        for game in ale_games.OF_OLD:
            _register_as_ale(pattern.format(rom_id_to_name(game)), package, False, game, sticky, frameskip)


def register_ale_ids(package: str = ALE_PACKAGE) -> None:
    """All ids of ale_py."""
    register_v0_v4_envs(package)
    register_v5_envs(package)
