"""The names of ale_py.roms: lists games, and finds their images."""

from __future__ import annotations

import pathlib
import warnings

from racebeam import ale_games, images

__all__ = ["get_all_rom_ids", "get_rom_path"]


def get_all_rom_ids() -> list[str]:
    """Returns the names of all games of ale_py."""
    return list(ale_games.ALL)


def get_rom_path(name: str) -> pathlib.Path | None:
    """Finds the image of a game.

    Args:
        name: Name of the game.

    Returns:
        The path of the image, or None with a warning if the name is unknown.

    Raises:
        MissingImage: If no image is found. It is a FileNotFoundError.
    """
    if name not in ale_games.ALL:
        warnings.warn(f"Rom {name} not supported.", stacklevel=2)
        return None
    return pathlib.Path(images.find(name))
