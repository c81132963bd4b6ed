"""Settings of the literature, equal to the presets of the line protocol (protocol/PROTOCOL.md, "games and load")."""

from __future__ import annotations

from typing import NamedTuple

from .errors import InvalidInput


class Preset(NamedTuple):
    """Defaults for arguments of `AtariEnv`. Without a preset, they are those of ale_py.AtariEnv."""

    frameskip: int | tuple[int, int] = 4
    repeat_action_probability: float = 0.25
    full_action_space: bool = False
    max_num_frames_per_episode: int | None = None
    life_loss: str = "ignored"
    noop_max: int = 0
    reward_range: tuple[int, int] | None = None


PRESETS = {
    "ale": Preset(),
    "gym-v5": Preset(max_num_frames_per_episode=108000),
    "paper2013": Preset(5, 0.0, True, 18000),
    "dqn2015": Preset(4, 0.0, False, 18000, life_loss="restart", noop_max=30, reward_range=(-1, 1)),
    "machado2018": Preset(5, 0.25, True, 18000),
}


class VectorPreset(NamedTuple):
    """Defaults for arguments of `AtariVectorEnv`. Without a preset, they are those of ale_py.AtariVectorEnv."""

    frameskip: int = 4
    repeat_action_probability: float = 0.0
    full_action_space: bool = False
    max_num_frames_per_episode: int = 108000
    noop_max: int = 30
    use_fire_reset: bool = True
    life_loss: str = "ignored"
    reward_clipping: bool = True


# Episodes begin as in ale_py, except where the literature says how they begin.
VECTOR_PRESETS = {
    "ale": VectorPreset(),
    "gym-v5": VectorPreset(repeat_action_probability=0.25),
    "paper2013": VectorPreset(5, 0.0, True, 18000, 0, False, reward_clipping=False),
    "dqn2015": VectorPreset(4, 0.0, False, 18000, 30, False, "end"),
    "machado2018": VectorPreset(5, 0.25, True, 18000, 0, False, reward_clipping=False),
}


def preset(name: str) -> Preset:
    """Looks up the preset of this name for `AtariEnv`.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    check_name(name)
    return PRESETS[name]


def vector_preset(name: str) -> VectorPreset:
    """Looks up the preset of this name for `AtariVectorEnv`.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    check_name(name)
    return VECTOR_PRESETS[name]


def check_name(name: str) -> None:
    """Checks the name of a preset.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise InvalidInput(f"unknown preset {name!r}; accepted: {', '.join(PRESETS)}")
