"""The names of ale_py.roms: which games there are, and where their images are."""

from __future__ import annotations

import pathlib
import warnings

from racebeam import ale_games, images

__all__ = ["get_all_rom_ids", "get_rom_path"]


def get_all_rom_ids() -> list[str]:
    """The names of all games that ale_py has."""
    return list(ale_games.EVERY)


def get_rom_path(name: str) -> pathlib.Path | None:
    """The image of a game. Warns of an unknown name, and returns None. Raises MissingImage, a FileNotFoundError."""
    if name not in ale_games.EVERY:
        warnings.warn(f"Rom {name} not supported.", stacklevel=2)
        return None
    return pathlib.Path(images.find(name))
