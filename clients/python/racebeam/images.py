"""Finds the cartridge images of games.

racebeam contains the images of Beamfall and Updraft. For the others, it searches these folders in this order, without
their subfolders: the one that RACEBEAM_ROMS names, the one that ALE_ROMS_DIR names, and the one in an installed ale_py.
A file that ends in .bin, .a26 or .rom, optionally followed by .gz, or a .zip archive with one such file, is identified
by its MD5. Its name is ignored.
"""

from __future__ import annotations

import contextlib
import difflib
import functools
import importlib.machinery
import os
import pathlib
import re
import types
from collections.abc import Mapping
from typing import Any, TypeAlias

from . import _core
from .errors import InvalidInput, MissingImage, UnknownGame

VARIABLES = ("RACEBEAM_ROMS", "ALE_ROMS_DIR")
BUILT_IN = "builtin:"
SIMILAR = 0.65  # as difflib compares a wrong name with one that is suggested
ID = re.compile(r"(?:.*/)?(.+?)(?:-ram)?(?:Deterministic|NoFrameskip)?-v\d+")  # of Gymnasium

Rom: TypeAlias = str | os.PathLike[str] | bytes
Files: TypeAlias = tuple[
    tuple[str, int, int], ...
]  # path, size and time of change; the latter two change with contents


@functools.lru_cache(maxsize=1)
def titles() -> Mapping[str, str]:
    """Returns a read-only mapping from the name of each game to its title."""
    return types.MappingProxyType({name: title for name, title, _, _ in _core.games()})


def games() -> dict[str, str]:
    """Lists the games that racebeam knows, whether or not their images are installed.

    Returns:
        A new dictionary from the name of each game to its title.

    Examples:
        >>> import racebeam
        >>> racebeam.games()["beamfall"]
        'Beamfall'
    """
    return dict(titles())


@functools.lru_cache(maxsize=1)
def built_in() -> frozenset[str]:
    """Returns the names of the games whose images are part of racebeam."""
    return frozenset(name for name, _, _, is_built_in in _core.games() if is_built_in)


def check_name(game: str) -> None:
    """Checks the name of a game.

    Args:
        game: Name of the game.

    Raises:
        UnknownGame: If no game has this name. The message suggests similar names.
    """
    if isinstance(game, str) and game in titles():
        return
    near = difflib.get_close_matches(_name_in_id(str(game)).lower(), titles(), n=3, cutoff=SIMILAR)
    hint = f"; did you mean {' or '.join(near)}?" if near else "; racebeam.games() lists them"
    raise UnknownGame(f"unknown game {game!r}{hint}")


def _name_in_id(text: str) -> str:
    """Returns the name in an id of Gymnasium, such as "Pong" in "ALE/Pong-v5", and another text as it is."""
    found = ID.fullmatch(text)
    return found[1] if found else text


def ale_folder() -> pathlib.Path | None:
    """Returns the folder of images in an installed ale_py, or None. Does not import ale_py."""
    found = importlib.machinery.PathFinder.find_spec("ale_py")
    if found is None or found.origin is None:
        return None
    return pathlib.Path(found.origin).parent / "roms"


def folders() -> list[tuple[str, pathlib.Path | None]]:
    """Lists the places that are searched, in order.

    Returns:
        For each place its description, and its folder or None if it is not set.
    """
    places: list[tuple[str, pathlib.Path | None]] = []
    for variable in VARIABLES:
        value = os.environ.get(variable)
        places.append((variable, pathlib.Path(value) if value else None))
    places.append(("an installed ale_py", ale_folder()))
    return places


def path_or_bytes(rom: Any) -> Rom:
    """Converts an argument that means an image.

    Args:
        rom: A path, or an object that holds bytes.

    Returns:
        The path as given, or the contents as bytes.

    Raises:
        TypeError: If `rom` is something else.
    """
    if isinstance(rom, (str, bytes, os.PathLike)):
        return rom
    try:
        return bytes(memoryview(rom))
    except TypeError:
        raise TypeError(f"rom has the type {type(rom).__name__}; it takes a path, or the bytes of an image") from None


def _files(folder: pathlib.Path) -> Files:
    """Lists the files of a folder whose names end like those of images."""
    files: list[tuple[str, int, int]] = []
    for file in _core.image_files(str(folder)):
        with contextlib.suppress(OSError):  # the file was removed meanwhile
            status = os.stat(file)
            files.append((file, status.st_size, status.st_ctime_ns))
    return tuple(files)


def _identify(file: str) -> str | None:
    try:
        return _core.identify(file)[1]
    except InvalidInput:
        return None


@functools.lru_cache(maxsize=16)
def _images(files: Files) -> dict[str | None, str]:
    """Maps each game to the first of its images."""
    return {_identify(file): file for file, _, _ in reversed(files)}


def _find_by_name(folder: pathlib.Path, game: str) -> str | None:
    """Returns the file that is named after the game, if it is an image of the game."""
    file = str(folder / f"{game}.bin")
    return file if _identify(file) == game else None


def _find_in(folder: pathlib.Path, game: str) -> str | None:
    """Finds an image of the game in a folder.

    Identifies the file again even if the cache has it. A file can change within one tick of the file system's clock
    without a visible sign.
    """
    file = _find_by_name(folder, game)
    if file is not None:
        return file
    found = _images(_files(folder)).get(game)
    if found is None or _identify(found) == game:
        return found
    _images.cache_clear()
    return _images(_files(folder)).get(game)


def find(game: str) -> str:
    """Finds the cartridge image of a game.

    Args:
        game: Name of the game, one of `racebeam.games()`.

    Returns:
        The path of the image, or "builtin:NAME" for a game that is part of racebeam.

    Raises:
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.

    Examples:
        >>> import racebeam
        >>> racebeam.find_image("beamfall")
        'builtin:beamfall'
    """
    check_name(game)
    if game in built_in():
        return BUILT_IN + game
    searched: list[str] = []
    for place, folder in folders():
        if folder is None:
            searched.append(f"{place} (not there)" if place not in VARIABLES else f"{place} (not set)")
        elif not folder.is_dir():
            searched.append(f"{place}, {folder} (not a folder)")
        else:
            found = _find_in(folder, game)
            if found is not None:
                return found
            searched.append(f"{place}, {folder} (no file has an MD5 of the game)")
    raise MissingImage(
        f"no cartridge image of {game} was found; racebeam searched {'; '.join(searched)}. "
        "Set RACEBEAM_ROMS to a folder of images, install ale-py, or pass rom= a path or bytes"
    )


def find_all() -> dict[str, str]:
    """Finds the images of all games.

    Returns:
        A dictionary from the name of each game that can be played here to its image, as `find` returns it.
    """
    found = {game: BUILT_IN + game for game in built_in()}
    for _, folder in folders():
        if folder is not None and folder.is_dir():
            there = _images(_files(folder))
            found = {game: _find_by_name(folder, game) or there[game] for game in there if game is not None} | found
    return {game: found[game] for game in titles() if game in found}
