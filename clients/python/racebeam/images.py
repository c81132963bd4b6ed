"""Where the cartridge images of games are.

The games of our own are part of racebeam. For the others, these folders are searched, in this order: that of the
environment variable RACEBEAM_ROMS, that of ALE_ROMS_DIR, and the one in an installed ale_py, without their
subfolders. A file that ends in .bin, .a26 or .rom, also with .gz after it, counts by its MD5, whatever its name is
besides.
"""

from __future__ import annotations

import contextlib
import difflib
import functools
import importlib.machinery
import os
import pathlib
import types
from collections.abc import Mapping
from typing import Any, Union

from . import _core
from .errors import InvalidInput, MissingImage, UnknownGame

VARIABLES = ("RACEBEAM_ROMS", "ALE_ROMS_DIR")
BUILT_IN = "builtin:"

Rom = Union[str, os.PathLike[str], bytes]
Files = tuple[tuple[str, int, int], ...]  # paths, and what changes with the contents


@functools.lru_cache(maxsize=1)
def titles() -> Mapping[str, str]:
    """The title of each game by its name."""
    return types.MappingProxyType({name: title for name, title, _, _ in _core.games()})


def games() -> dict[str, str]:
    """The title of each game by its name. It is the caller's own."""
    return dict(titles())


@functools.lru_cache(maxsize=1)
def built_in() -> frozenset[str]:
    """The names of the games whose images are part of racebeam."""
    return frozenset(name for name, _, _, is_built_in in _core.games() if is_built_in)


def check_name(game: str) -> None:
    """Raises UnknownGame, with names that are like this one."""
    if isinstance(game, str) and game in titles():
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


def given(rom: Any) -> Rom:
    """A path as it is, and whatever else holds bytes as bytes. Raises TypeError."""
    if isinstance(rom, (str, bytes, os.PathLike)):
        return rom
    try:
        return bytes(memoryview(rom))
    except TypeError:
        raise TypeError(f"rom has the type {type(rom).__name__}; it takes a path, or the bytes of an image") from None


def _files(folder: pathlib.Path) -> Files:
    """Those that look like images."""
    files: list[tuple[str, int, int]] = []
    for file in _core.image_files(str(folder)):
        with contextlib.suppress(OSError):  # it has just been removed
            told = os.stat(file)
            files.append((file, told.st_size, told.st_ctime_ns))
    return tuple(files)


def _game_of(file: str) -> str | None:
    try:
        return _core.identify(file)[1]
    except InvalidInput:
        return None


@functools.lru_cache(maxsize=16)
def _images(files: Files) -> dict[str | None, str]:
    """The files by the game that they are, of several the first."""
    return {_game_of(file): file for file, _, _ in reversed(files)}


def _usual(folder: pathlib.Path, game: str) -> str | None:
    """The file with the name of the game, if it is its image."""
    file = str(folder / f"{game}.bin")
    return file if _game_of(file) == game else None


def _find_in(folder: pathlib.Path, game: str) -> str | None:
    """A file is identified at once: within a tick of the clock of file systems, one can change without a sign."""
    usual = _usual(folder, game)
    if usual is not None:
        return usual
    found = _images(_files(folder)).get(game)
    if found is None or _game_of(found) == game:
        return found
    _images.cache_clear()
    return _images(_files(folder)).get(game)


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
    raise MissingImage(
        f"no cartridge image of {game} was found; looked in {'; '.join(looked)}. Set RACEBEAM_ROMS to a folder "
        "of images, install ale-py, or give rom= a path or bytes"
    )


def find_all() -> dict[str, str]:
    """Each game that can be played here, with its image."""
    found = {game: BUILT_IN + game for game in built_in()}
    for _, folder in folders():
        if folder is not None and folder.is_dir():
            there = _images(_files(folder))
            found = {game: _usual(folder, game) or there[game] for game in there if game is not None} | found
    return {game: found[game] for game in titles() if game in found}
