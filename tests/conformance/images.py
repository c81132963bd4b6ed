"""Cartridge images, from RACEBEAM_ROMS or from ale-py, and the games that the reference has no rule for."""

import os
import pathlib
import tempfile

import ale_py

# The reference can run an image without a rule if the file has the name of a known game. It then uses that
# game's rule and actions, but the image's own properties. These images are compared as VENTURE, whose rule
# needs no mode program and hardly ever ends an episode on them.
HOST = "venture"
WITHOUT_RULE = ("combat", "joust", "maze_craze", "warlords")


def folder():
    given = os.environ.get("RACEBEAM_ROMS")
    return pathlib.Path(given) if given else pathlib.Path(ale_py.__file__).parent / "roms"


def games():
    """The games with an image, sorted."""
    return sorted(path.stem for path in folder().glob("*.bin"))


def rule_of(game):
    """The game whose rule is used."""
    return HOST if game in WITHOUT_RULE else game


class Image:
    """`path` is where both sides read the image, during the lifetime of this object."""

    def __init__(self, game):
        self.path, self.link = folder() / f"{game}.bin", None
        if game in WITHOUT_RULE:
            self.link = tempfile.TemporaryDirectory()
            disguised = pathlib.Path(self.link.name) / f"{HOST}.bin"
            disguised.symlink_to(self.path)
            self.path = disguised
