"""AtariEnv with the errors of ale_py's."""

from __future__ import annotations

from .. import env
from .interface import ALEInterface, check_game

__all__ = ["AtariEnv"]


class AtariEnv(env.AtariEnv):
    """racebeam.AtariEnv with the errors of ale_py's."""

    _local_interface = ALEInterface
    _check_game = staticmethod(check_game)
