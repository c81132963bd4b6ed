"""The names of ale_py.vector_env."""

from racebeam.ale_py.vectors import ALEVectorInterface, AtariEnv, AtariVectorEnv

__all__ = ["ALEVectorInterface", "AtariEnv", "AtariVectorEnv"]
