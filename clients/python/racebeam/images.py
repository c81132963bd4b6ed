"""Where the cartridge images of games are.

The games of our own are part of racebeam. For the others, these folders are searched, in this order: that of the
environment variable RACEBEAM_ROMS, that of ALE_ROMS_DIR, and the one in an installed ale_py. A file counts by its
MD5, whatever its name is.
"""

from __future__ import annotations

import difflib
import functools
import importlib.machinery
import os
import pathlib

from . import _core
from .errors import InvalidInput, MissingImage, UnknownGame

VARIABLES = ("RACEBEAM_ROMS", "ALE_ROMS_DIR")
BUILT_IN = "builtin:"


@functools.lru_cache(maxsize=1)
def titles() -> dict[str, str]:
    """The title of each game by its name."""
    return {name: title for name, title, _, _ in _core.games()}


@functools.lru_cache(maxsize=1)
def built_in() -> frozenset[str]:
    """The names of the games whose images are part of racebeam."""
    return frozenset(name for name, _, _, is_built_in in _core.games() if is_built_in)


def check_name(game: str) -> None:
    """Raises UnknownGame, with names that are like this one."""
    if game in titles():
        return
    near = difflib.get_close_matches(str(game), titles(), n=3)
    hint = f"; did you mean {' or '.join(near)}?" if near else "; racebeam.games() lists them"
    raise UnknownGame(f"there is no game {game!r}{hint}")


def ale_folder() -> pathlib.Path | None:
    """The folder of images in an installed ale_py, which is not imported."""
    found = importlib.machinery.PathFinder.find_spec("ale_py")
    if found is None or found.origin is None:
        return None
    return pathlib.Path(found.origin).parent / "roms"


def folders() -> list[tuple[str, pathlib.Path | None]]:
    """The places that are searched: what names them, and the folder, if there is one."""
    named: list[tuple[str, pathlib.Path | None]] = []
    for variable in VARIABLES:
        value = os.environ.get(variable)
        named.append((variable, pathlib.Path(value) if value else None))
    named.append(("an installed ale_py", ale_folder()))
    return named


@functools.lru_cache(maxsize=16)
def _images(folder: str, _changed: int) -> dict[str, str]:
    """The files of a folder by the game that they are."""
    images: dict[str, str] = {}
    for file in _core.image_files(folder):
        try:
            _, game = _core.identify(file)
        except InvalidInput:
            continue
        if game is not None:
            images.setdefault(game, file)
    return images


def _is_image_of(file: pathlib.Path, game: str) -> bool:
    try:
        return _core.identify(file)[1] == game
    except InvalidInput:
        return False


def _find_in(folder: pathlib.Path, game: str) -> str | None:
    usual = folder / f"{game}.bin"
    if _is_image_of(usual, game):
        return str(usual)
    return _images(str(folder), folder.stat().st_mtime_ns).get(game)


def find(game: str) -> str:
    """The path of the game's image, or builtin:NAME. Raises UnknownGame, or MissingImage."""
    check_name(game)
    if game in built_in():
        return BUILT_IN + game
    looked: list[str] = []
    for named, folder in folders():
        if folder is None:
            looked.append(f"{named} (not there)" if named not in VARIABLES else f"{named} (not set)")
        elif not folder.is_dir():
            looked.append(f"{named}, {folder} (no folder)")
        else:
            found = _find_in(folder, game)
            if found is not None:
                return found
            looked.append(f"{named}, {folder} (no file with an MD5 of it)")
    raise MissingImage(f"no cartridge image of {game} was found; looked in {'; '.join(looked)}. Set RACEBEAM_ROMS to a folder "
                       "of images, install ale-py, or give rom= a path or bytes")


def find_all() -> dict[str, str]:
    """Each game that can be played here, with its image."""
    found: dict[str, str] = {}
    for game in titles():
        try:
            found[game] = find(game)
        except MissingImage:
            continue
    return found
