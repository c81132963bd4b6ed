"""The names of envpool.atari."""

from racebeam.envpool.pools import DMEnvPool as AtariDMEnvPool
from racebeam.envpool.pools import GymnasiumEnvPool as AtariGymnasiumEnvPool
from racebeam.envpool.spec import EnvSpec as AtariEnvSpec

__all__ = ["AtariDMEnvPool", "AtariEnvSpec", "AtariGymnasiumEnvPool"]
