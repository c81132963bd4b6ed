"""The names of ale_py.env."""

from racebeam import registration
from racebeam.ale_py.single import AtariEnv
from racebeam.env import AtariEnvStepMetadata

__all__ = ["AtariEnv", "AtariEnvStepMetadata"]

if __name__ == "ale_py.env":  # this package replaces ale_py, also in the ids
    registration.register_ale_ids("ale_py")
