"""The names of ale_py.registration."""

from racebeam.registration import register_v0_v4_envs, register_v5_envs, rom_id_to_name

__all__ = ["register_v0_v4_envs", "register_v5_envs", "rom_id_to_name"]
