"""Finds cartridge images: our own are built in, others are in RACEBEAM_ROMS, else in ale-py."""

import importlib.util
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Images that may be distributed; they are inside the program.
OURS = tuple(sorted(path.stem for path in (ROOT / "games/homebrew").glob("*.bin")))
WITHOUT_RULE = ("combat", "joust", "maze_craze", "warlords")  # the reference has images of them, but cannot play them


def folder():
    """The folder of images, or None if it is missing."""
    if roms := os.environ.get("RACEBEAM_ROMS"):
        candidates = [pathlib.Path(roms)]
    else:
        here = importlib.util.find_spec("ale_py")
        candidates = [pathlib.Path(here.origin).parent / "roms"] if here else []
        candidates += ROOT.glob(".venv/lib/python*/site-packages/ale_py/roms")
    return next((path for path in candidates if path.is_dir()), None)


def games():
    """The games that the reference can play and that there are images of, sorted."""
    place = folder()
    names = [] if place is None else sorted(path.stem for path in place.glob("*.bin"))
    return [name for name in names if name not in WITHOUT_RULE]


def image(game):
    """The argument of --rom. Raises LookupError, with a sentence, if no image of the game is found."""
    if game in OURS:
        return f"builtin:{game}"
    place = folder()
    if place is None:
        raise LookupError(
            f"no image of {game} was found in RACEBEAM_ROMS, nor in an ale-py in .venv "
            f"(scripts/reference installs it); our own games are {' and '.join(OURS)}"
        )
    path = place / f"{game}.bin"
    if not path.is_file():
        raise LookupError(f"no image of {game} was found in {place}")
    return str(path)


def image_or_own(game):
    """The argument of --rom: the image of the game, or Beamfall's if that is missing. Tables name what was played."""
    try:
        return image(game)
    except LookupError:
        return "builtin:beamfall"


def name_of(rom):
    """The name of the game whose image image_or_own() returned."""
    return rom.removeprefix("builtin:") if rom.startswith("builtin:") else pathlib.Path(rom).stem
