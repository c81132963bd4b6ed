"""The names of envpool.python.protocol."""

from racebeam.envpool.pools import DMEnvPool, EnvPool, GymnasiumEnvPool
from racebeam.envpool.spec import ArraySpec, EnvSpec

__all__ = ["ArraySpec", "DMEnvPool", "EnvPool", "EnvSpec", "GymnasiumEnvPool"]
