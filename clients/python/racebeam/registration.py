"""Registers the environments with Gymnasium: racebeam's own ids, and those of ale_py on request."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import os
import pathlib
import sys
import types
from collections.abc import Sequence
from typing import Any

import gymnasium

from . import ale_games, images

__all__ = [
    "register",
    "register_ale_ids",
    "register_own_ids",
    "register_v0_v4_envs",
    "register_v5_envs",
    "rom_id_to_name",
]

ALE_PACKAGE = "racebeam.ale_py"
FRAMES_OF_AN_EPISODE = 108000

# The ids of Gym before version 0.22, by the pattern of their names: repeat_action_probability and frameskip.
OLD_IDS: dict[str, tuple[float, int | tuple[int, int]]] = {
    "{}-v0": (0.25, (2, 5)),
    "{}-v4": (0.0, (2, 5)),
    "{}NoFrameskip-v0": (0.25, 1),
    "{}NoFrameskip-v4": (0.0, 1),
}


def rom_id_to_name(rom: str) -> str:
    """Converts the name of a game into that of its id.

    Args:
        rom: Name of the game, such as "space_invaders".

    Returns:
        The name in camel case, such as "SpaceInvaders".
    """
    return rom.title().replace("_", "")


def _register(env_id: str, package: str, has_vectors: bool, **arguments: Any) -> None:
    """Registers an id, and replaces another package's environment of this id without a warning.

    Args:
        env_id: The id.
        package: The package whose modules `env` and `vector_env` have the classes.
        has_vectors: Whether gymnasium.make_vec() makes an AtariVectorEnv of this id.
        **arguments: Arguments of the class.
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
    """Registers racebeam/Pong-v5, racebeam/PongNoFrameskip-v4 and so on.

    Ids such as racebeam/Pong-v5 have the settings of ALE/Pong-v5. The NoFrameskip ids play each frame, for wrappers
    that skip frames, and their actions are not sticky. Settings are a preset, which preset= of gymnasium.make()
    replaces.
    """
    for game in images.titles():
        name = f"racebeam/{rom_id_to_name(game)}"
        _register(f"{name}-v5", "racebeam", True, game=game, preset="gym-v5")
        every_frame = {"frameskip": 1, "repeat_action_probability": 0.0}
        _register(f"{name}NoFrameskip-v4", "racebeam", False, game=game, preset="gym-v5", **every_frame)


def register(game_file: str | os.PathLike[str], rom: images.Rom, name: str | None = None) -> str:
    """Registers your own game, with the settings of ALE/Pong-v5.

    Args:
        game_file: Path of the game file.
        rom: Path or bytes of the cartridge image.
        name: Name of the id in camel case. Default: that of the file, such as "MyGame" for my_game.toml.

    Returns:
        The id, such as "racebeam/MyGame-v5", for `gymnasium.make` and `gymnasium.make_vec`.

    Raises:
        InvalidInput: If the file or the image cannot be read, or is wrong.
    """
    from .env import AtariEnv

    path = os.path.abspath(game_file)
    image = rom if isinstance(rom, bytes) or str(rom).startswith(images.BUILT_IN) else os.path.abspath(rom)
    AtariEnv(game_file=path, rom=image).close()
    env_id = f"racebeam/{name or rom_id_to_name(pathlib.Path(path).stem)}-v5"
    _register(env_id, "racebeam", True, game_file=path, rom=image, preset="gym-v5")
    return env_id


def _v5_ids() -> dict[str, str]:
    """Returns the game of each id of version 5."""
    return {f"ALE/{rom_id_to_name(game)}-v5": game for game in ale_games.ALL if game not in ale_games.TWO_PLAYER}


def register_v5_envs(package: str = ALE_PACKAGE) -> None:
    """Registers ALE/Pong-v5 and so on.

    Args:
        package: The package that has the classes.
    """
    for env_id, game in _v5_ids().items():
        _register_as_ale(env_id, package, True, game, 0.25, 4)


def register_v0_v4_envs(package: str = ALE_PACKAGE) -> None:
    """Registers Pong-v0, Pong-v4, PongNoFrameskip-v0 and PongNoFrameskip-v4, and so on.

    Args:
        package: The package that has the classes.
    """
    for pattern, (sticky, frameskip) in OLD_IDS.items():
        for game in ale_games.OLD:
            _register_as_ale(pattern.format(rom_id_to_name(game)), package, False, game, sticky, frameskip)


def register_ale_ids(package: str = ALE_PACKAGE) -> None:
    """Registers all ids of ale_py.

    A later `import ale_py` would register its own classes under these ids. Afterwards, they are registered again.

    Args:
        package: The package that has the classes.
    """
    register_v0_v4_envs(package)
    register_v5_envs(package)
    if not any(isinstance(finder, _AleFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _AleFinder())


class _AleFinder(importlib.abc.MetaPathFinder):
    """Finds the installed ale_py, and makes its import register racebeam's environments afterwards."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        spec = importlib.machinery.PathFinder.find_spec(fullname, path, target) if fullname == "ale_py" else None
        if spec is not None and spec.loader is not None:
            spec.loader = _AleLoader(spec.loader)
        return spec


class _AleLoader(importlib.abc.Loader):
    """Loads ale_py by its own loader, then registers racebeam's environments again."""

    def __init__(self, loader: importlib.abc.Loader) -> None:
        self._loader = loader

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> types.ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: types.ModuleType) -> None:
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        old_ids = (pattern.format(rom_id_to_name(game)) for pattern in OLD_IDS for game in ale_games.OLD)
        for env_id in (*_v5_ids(), *old_ids):
            gymnasium.registry.pop(env_id, None)  # otherwise ale_py warns that it overrides the id
        self._loader.exec_module(module)
        register_v0_v4_envs()
        register_v5_envs()
