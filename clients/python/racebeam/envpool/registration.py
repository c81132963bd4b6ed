"""The names of envpool.registration."""

from racebeam.envpool.making import list_all_envs, make, make_dm, make_gym, make_gymnasium, make_spec

__all__ = ["list_all_envs", "make", "make_dm", "make_gym", "make_gymnasium", "make_spec"]
