"""AtariEnv with the errors of ale_py."""

from __future__ import annotations

from .. import env
from .interface import ALEInterface, check_game

__all__ = ["AtariEnv"]


class AtariEnv(env.AtariEnv):
    """racebeam.AtariEnv with the errors of ale_py, also those of its `ale`.

    Examples:
        >>> from racebeam.ale_py import AtariEnv
        >>> AtariEnv("beamfal")
        Traceback (most recent call last):
        racebeam.ale_py.interface.NoSuchGame: unknown game 'beamfal'; did you mean beamfall?
    """

    _local_interface = ALEInterface
    _check_game = staticmethod(check_game)
