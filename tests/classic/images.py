"""Cartridge images, from RACEBEAM_ROMS or from the ale-py that scripts/reference installs; named as the games are."""

import os
import pathlib

SKIPPED = 77  # exit status that ctest reads as "skipped"
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def folder():
    """Where they are, or would be."""
    found = sorted((SOURCE / ".venv/lib").glob("python*/site-packages/ale_py/roms"))
    return pathlib.Path(os.environ.get("RACEBEAM_ROMS") or (found[0] if found else SOURCE / ".venv"))


def images():
    """The games that there are images of, sorted."""
    return sorted(path.stem for path in folder().glob("*.bin"))


def image(game):
    """The path of a game's image. Raises ValueError with a sentence."""
    path = folder() / f"{game}.bin"
    if not path.exists():
        raise ValueError(f"there is no image of '{game}' in {folder()}")
    return str(path)
