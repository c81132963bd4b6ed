"""Cartridge images: from RACEBEAM_ROMS or from ale-py, the games that the reference has no rule for, and
random programs."""

import os
import pathlib
import tempfile

import ale_py
import programs

# The reference can run an image without a rule if the file has the name of a known game. It then uses that
# game's rule and actions, but the image's own properties. These images are compared as VENTURE, whose rule
# needs no mode program and hardly ever ends an episode on them.
HOST = "venture"
WITHOUT_RULE = ("combat", "joust", "maze_craze", "warlords")
# Random programs are compared as this game, for the same reason. Its rule reads RAM[$C7] last, which the next
# instruction can find on the bus (docs/spec/console.md, 4).
PROGRAM_HOST = "pitfall2"


def folder():
    folder = os.environ.get("RACEBEAM_ROMS")
    return pathlib.Path(folder) if folder else pathlib.Path(ale_py.__file__).parent / "roms"


def games():
    """The games with an image, sorted."""
    return sorted(path.stem for path in folder().glob("*.bin"))


def rule_of(game):
    """The game whose rule is used."""
    if game in programs.KINDS:
        return PROGRAM_HOST
    return HOST if game in WITHOUT_RULE else game


class Image:
    """`path` is where both sides read the image, during the lifetime of this object."""

    def __init__(self, run):
        self.path, self.folder = folder() / f"{run.game}.bin", None
        host = rule_of(run.game)
        if host == run.game:
            return
        self.folder = tempfile.TemporaryDirectory()
        disguised = pathlib.Path(self.folder.name) / f"{host}.bin"
        if run.game in programs.KINDS:
            disguised.write_bytes(programs.image_of(run.game, run.seed))
        else:
            disguised.symlink_to(self.path)
        self.path = disguised
