"""Cartridge images, from RACEBEAM_ROMS or from the ale-py that scripts/reference installs. Files have the
games' names."""

import os
import pathlib

SKIPPED = 77  # exit status that ctest reads as "skipped"
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def folder():
    """The folder of the images, which may not exist."""
    found = sorted((SOURCE / ".venv/lib").glob("python*/site-packages/ale_py/roms"))
    return pathlib.Path(os.environ.get("RACEBEAM_ROMS") or (found[0] if found else SOURCE / ".venv"))


def images():
    """The games with an image, sorted."""
    return sorted(path.stem for path in folder().glob("*.bin"))


def image(game):
    """The path of a game's image. Raises ValueError with a sentence."""
    path = folder() / f"{game}.bin"
    if not path.exists():
        raise ValueError(f"no image of '{game}' was found in {folder()}")
    return str(path)
