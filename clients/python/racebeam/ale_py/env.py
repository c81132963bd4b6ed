"""The names of ale_py.env."""

from racebeam.env import AtariEnv, AtariEnvStepMetadata

__all__ = ["AtariEnv", "AtariEnvStepMetadata"]
