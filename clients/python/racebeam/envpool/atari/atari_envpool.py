"""The names of envpool.atari.atari_envpool."""

from racebeam.envpool.raw import RawPool as _AtariEnvPool
from racebeam.envpool.raw import RawSpec as _AtariEnvSpec

__all__ = ["_AtariEnvPool", "_AtariEnvSpec"]
