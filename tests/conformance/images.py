"""Cartridge images, from RACEBEAM_ROMS or from ale-py; and the games that the reference has no rule for."""

import os
import pathlib
import tempfile

import ale_py

# The reference runs an image that it has no rule for when the file has the name of a game it knows: with that game's
# rule and actions, but with the image's own properties. These machines are compared as VENTURE, whose rule needs no
# mode program and hardly ever ends an episode on them.
HOST = "venture"
WITHOUT_RULE = ("combat", "joust", "maze_craze", "warlords")


def folder():
    given = os.environ.get("RACEBEAM_ROMS")
    return pathlib.Path(given) if given else pathlib.Path(ale_py.__file__).parent / "roms"


def games():
    """All that there are images of, sorted."""
    return sorted(path.stem for path in folder().glob("*.bin"))


def rule_of(game):
    """The game whose rule it is played by."""
    return HOST if game in WITHOUT_RULE else game


class Image:
    """`path` is where both sides read it, for as long as this lives."""

    def __init__(self, game):
        self.path, self.link = folder() / f"{game}.bin", None
        if game in WITHOUT_RULE:
            self.link = tempfile.TemporaryDirectory()
            disguised = pathlib.Path(self.link.name) / f"{HOST}.bin"
            disguised.symlink_to(self.path)
            self.path = disguised
