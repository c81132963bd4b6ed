"""What the tests of racebeam.envpool share. What EnvPool itself shows was measured (EnvPool 1.2.5)."""

import gymnasium
from racebeam import envpool

HAS_VECTORS = hasattr(gymnasium.vector, "AutoresetMode")


def make(env_type="gymnasium", **config):
    return envpool.make("Beamfall-v5", env_type, **{"num_envs": 3, **config})
