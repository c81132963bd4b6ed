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


# generated: presets, from protocol/protocol.toml
PRESETS = {
    "ale": Preset(),
    "paper2013": Preset(5, 0.0, True, 18000),
    "dqn2015": Preset(4, 0.0, False, 18000, life_loss="restart", noop_max=30, reward_range=(-1, 1)),
    "machado2018": Preset(5, 0.25, True, 18000),
    "gym-v5": Preset(4, 0.25, False, 108000),
}
# end of presets


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


def _vector_preset_of(preset: Preset) -> VectorPreset:
    """The preset for `AtariVectorEnv`, with episodes that begin as in the literature.

    Where the protocol's preset begins a new game at a lost life, a vector ends the episode and goes on with the game,
    as the authors did.
    """
    return VectorPreset(
        *preset[:4],  # type: ignore[arg-type]  # only "ale" may draw its frames from a range
        noop_max=preset.noop_max,
        use_fire_reset=False,
        life_loss="end" if preset.life_loss == "restart" else preset.life_loss,
        reward_clipping=preset.reward_range is not None,
    )


VECTOR_PRESETS = {
    "ale": VectorPreset(),
    "gym-v5": VectorPreset(repeat_action_probability=0.25),
    **{name: _vector_preset_of(PRESETS[name]) for name in ("paper2013", "dqn2015", "machado2018")},
}


def preset(name: str) -> Preset:
    """Looks up a preset for `AtariEnv`.

    Args:
        name: Name of the preset.

    Returns:
        Its settings.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    check_name(name)
    return PRESETS[name]


def vector_preset(name: str) -> VectorPreset:
    """Looks up a preset for `AtariVectorEnv`.

    Args:
        name: Name of the preset.

    Returns:
        Its settings.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    check_name(name)
    return VECTOR_PRESETS[name]


def check_name(name: str) -> None:
    """Checks the name of a preset.

    Args:
        name: Name of the preset.

    Raises:
        InvalidInput: If the preset is unknown.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise InvalidInput(f"unknown preset {name!r}; accepted: {', '.join(PRESETS)}")
