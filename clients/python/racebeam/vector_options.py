"""The options of a vector of environments: as keyword arguments, and as an object that has checked them."""

from __future__ import annotations

import dataclasses
import secrets
import sys
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypedDict

from . import _core
from .arguments import (
    MOST,
    WrongType,
    WrongValue,
    accept_old_name,
    action_space,
    check_choice,
    check_names,
    console_of,
    flag,
    integer,
    join,
    member,
    optional_integer,
    real,
    share,
    sound_flag,
)
from .presets import VectorPreset, vector_preset
from .vector.autoreset import AutoresetMode

if sys.version_info >= (3, 11):
    from typing import Unpack
elif TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["SEEDS", "OptionArguments", "VectorOptions", "autoreset_of"]

OBS_TYPES = (None, "rgb", "grayscale", "ram")
RENDER_MODES = (None, "human", "rgb_array")
RULES = {"ale-0.12": _core.Rules.ALE_0_12, "fixed": _core.Rules.FIXED}
SEEDS = (0, 2**32 - 1)
MOST_ENVS = 10**7  # the memory sets a lower limit
MOST_THREADS = 1024

INTEGERS = {
    "num_envs": (1, MOST_ENVS),
    "num_threads": (0, MOST),
    "thread_affinity_offset": (-1, MOST),
    "frameskip": (1, 1000),
    "max_num_frames_per_episode": (0, MOST),
    "noop_max": (0, 1000),
    "stack_num": (1, 16),
    "img_width": (0, 1000),  # the screens of a game limit both further
    "img_height": (0, 1000),
    "seed": SEEDS,
}
FLAGS = ("continuous", "reward_clipping", "maxpool", "use_fire_reset", "grayscale")
NONE_IS_DEFAULT = (*VectorPreset._fields, "seed")
WORDS = {"life_loss": _core.LifeLoss, "start": _core.ResetOrder, "stack_start": _core.StackStart}
CONSOLE = ("scheme", "left", "right", "format", "ystart", "height")
CHOICES = {"obs_type": OBS_TYPES, "render_mode": RENDER_MODES, "rules": tuple(RULES)}


def autoreset_of(mode: object) -> AutoresetMode:
    """Converts an argument to a mode of autoreset.

    Args:
        mode: A mode, its name such as "SAME_STEP", or its value such as "SameStep".

    Returns:
        The mode.

    Raises:
        WrongType: If `mode` is neither a mode nor a string.
        WrongValue: If no mode has this name or value.
    """
    for one in AutoresetMode:
        if mode is one or (isinstance(mode, str) and mode in (one.name, one.value)):
            return one
    raise (WrongValue if isinstance(mode, str) else WrongType)(
        f"autoreset_mode is {mode!r}; it takes {join(one.value for one in AutoresetMode)}"
    )


class OptionArguments(TypedDict, total=False):
    """The options as keyword arguments, which `AtariVectorEnv` documents.

    Where None is accepted, it stands for the default.
    """

    batch_size: int
    num_threads: int
    thread_affinity_offset: int
    max_num_frames_per_episode: int | None
    repeat_action_probability: float | None
    full_action_space: bool | Literal["console"] | None
    continuous: bool
    continuous_action_threshold: float
    autoreset_mode: AutoresetMode | str
    img_height: int
    img_width: int
    grayscale: bool
    stack_num: int
    frameskip: int | None
    maxpool: bool
    noop_max: int | None
    reward_clipping: bool | None
    use_fire_reset: bool | None
    mode: int | None
    difficulty: int | None
    obs_type: Literal["rgb", "grayscale", "ram"] | None
    life_loss: str | None
    start: str
    stack_start: str
    rules: str
    scheme: str | None
    left: str | None
    right: str | None
    format: str | None
    ystart: int | None
    height: int | None
    seed: SupportsIndex | None
    render_mode: Literal["human", "rgb_array"] | None
    sound_obs: bool | Literal["all"]
    episodic_life: bool
    life_loss_info: bool
    lives: str | None


def _resolve(arguments: OptionArguments) -> dict[str, Any]:
    """Converts keyword arguments to fields of `VectorOptions`, and merges those that say the same."""
    check_names(arguments, tuple(OptionArguments.__annotations__), "help(racebeam.AtariVectorEnv)")
    fields: dict[str, Any] = dict(arguments)
    lives = fields.pop("lives", None)
    if isinstance(lives, str) and lives == "told":
        lives = "reported"
    life_loss = accept_old_name("lives", lives, "life_loss", fields.pop("life_loss", None))
    flags = {name: fields.pop(name, False) for name in ("life_loss_info", "episodic_life")}
    fields["life_loss"] = _merge_life_flags(life_loss, **flags)
    return {name: value for name, value in fields.items() if value is not None or name not in NONE_IS_DEFAULT}


def _merge_life_flags(life_loss: str | None, life_loss_info: object, episodic_life: object) -> str | None:
    """Merges ale_py's two flags of life loss into `life_loss`.

    Args:
        life_loss: The argument `life_loss`.
        life_loss_info: The flag that means life_loss="reported".
        episodic_life: The flag that means life_loss="restart". It takes precedence, as in ale_py.

    Returns:
        The word for `life_loss`, or None if none of the three arguments was given.

    Raises:
        WrongValue: If a flag contradicts `life_loss`.
    """
    if life_loss is not None:
        member("life_loss", life_loss, _core.LifeLoss)
    merged = life_loss
    flags = (("life_loss_info", life_loss_info, "reported"), ("episodic_life", episodic_life, "restart"))
    for name, value, word in flags:
        if not flag(name, value):
            continue
        if life_loss not in (None, word):
            raise WrongValue(f"{name} is True, which means life_loss={word!r}, but life_loss is {life_loss!r}")
        merged = word
    return merged


@dataclasses.dataclass(frozen=True)
class VectorOptions:
    """Options of a vector of environments, checked when the object is made.

    `AtariVectorEnv` documents the options, and takes such an object as `options`. It cannot be changed;
    `dataclasses.replace` copies it with changes.

    Attributes:
        num_envs: Number of environments.
        rows: Number of rows of the screen that observations show, from the top; 0 for all.

    Raises:
        WrongType: If an option has a wrong type.
        WrongValue: If the value of an option is not accepted.

    Examples:
        >>> import racebeam
        >>> options = racebeam.VectorOptions.of_preset("machado2018", num_envs=8, obs_type="ram", seed=7)
        >>> options.frameskip, options.repeat_action_probability
        (5, 0.25)
        >>> envs = racebeam.AtariVectorEnv("beamfall", options=options)
        >>> envs.num_envs, envs.single_observation_space.shape
        (8, (128,))
        >>> racebeam.VectorOptions(frameskip=0)
        Traceback (most recent call last):
        racebeam.arguments.WrongValue: frameskip is 0; it takes 1 to 1000
    """

    num_envs: int = 1
    batch_size: int = 0
    num_threads: int = 0
    thread_affinity_offset: int = -1
    max_num_frames_per_episode: int = 108000
    repeat_action_probability: float = 0.0
    full_action_space: bool | str = False
    continuous: bool = False
    continuous_action_threshold: float = 0.5
    autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP
    img_height: int = 84
    img_width: int = 84
    grayscale: bool = True
    stack_num: int = 4
    frameskip: int = 4
    maxpool: bool = True
    noop_max: int = 30
    reward_clipping: bool = True
    use_fire_reset: bool = True
    mode: int | None = None
    difficulty: int | None = None
    obs_type: str | None = None
    life_loss: str = "ignored"
    start: str = "fire-noops"
    stack_start: str = "zeros"
    rules: str = "ale-0.12"
    scheme: str | None = None
    left: str | None = None
    right: str | None = None
    format: str | None = None
    ystart: int | None = None
    height: int | None = None
    seed: int = dataclasses.field(default_factory=lambda: secrets.randbits(32))
    render_mode: str | None = None
    sound_obs: bool | Literal["all"] = False
    rows: int = 0

    def __post_init__(self) -> None:
        """Checks all options, and converts them to the types that the fields declare."""
        for name, (low, high) in INTEGERS.items():
            self._set(name, integer(name, getattr(self, name), low, high))
        for name in FLAGS:
            self._set(name, flag(name, getattr(self, name)))
        self._set("sound_obs", sound_flag("sound_obs", self.sound_obs))
        if self.action_set == "console" and self.continuous:
            raise WrongValue(
                "full_action_space is 'console'; with continuous, an action moves a joystick, not a switch"
            )
        for name in ("mode", "difficulty"):
            self._set(name, optional_integer(name, getattr(self, name)))
        for name, kind in WORDS.items():
            member(name, getattr(self, name), kind)
        for name, choices in CHOICES.items():
            check_choice(name, getattr(self, name), choices)
        self._set("repeat_action_probability", share("repeat_action_probability", self.repeat_action_probability))
        self._set("continuous_action_threshold", real("continuous_action_threshold", self.continuous_action_threshold))
        self._set("batch_size", integer("batch_size", self.batch_size, 0, self.num_envs) or self.num_envs)
        self._set("autoreset_mode", autoreset_of(self.autoreset_mode))

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    @classmethod
    def of_preset(cls, preset: str = "ale", num_envs: int = 1, **arguments: Unpack[OptionArguments]) -> VectorOptions:
        """Makes options whose defaults are those of a preset.

        Args:
            preset: Name of a preset of `racebeam.presets`.
            num_envs: Number of environments.
            **arguments: Options that differ from the preset, as keyword arguments of `AtariVectorEnv`.

        Returns:
            The options.

        Raises:
            InvalidInput: If the preset is unknown.
            WrongType: If an option is unknown, or has a wrong type.
            WrongValue: If the value of an option is not accepted.
        """
        return cls(num_envs=num_envs, **{**vector_preset(preset)._asdict(), **_resolve(arguments)})

    def with_changes(self, num_envs: int, **arguments: Unpack[OptionArguments]) -> VectorOptions:
        """Copies the options with changes.

        Args:
            num_envs: Number of environments.
            **arguments: Options that change, as keyword arguments of `AtariVectorEnv`.

        Returns:
            The options. If `batch_size` was all environments, it still is.

        Raises:
            WrongType: If an option is unknown, or has a wrong type.
            WrongValue: If the value of an option is not accepted.
        """
        batch_size = 0 if self.is_sync else self.batch_size
        return dataclasses.replace(self, num_envs=num_envs, **{"batch_size": batch_size, **_resolve(arguments)})

    @property
    def is_sync(self) -> bool:
        """Whether each call returns all environments."""
        return self.batch_size == self.num_envs

    @property
    def action_set(self) -> str:
        """The word of the line protocol for the actions: "legal", "minimal" or "console"."""
        return action_space("full_action_space", self.full_action_space)

    @property
    def is_rgb(self) -> bool:
        """Whether observations are screens in colour."""
        return self.obs_type == "rgb" if self.obs_type else not self.grayscale

    def _console(self) -> dict[str, str]:
        """Returns the settings of the console that are given, as texts."""
        return console_of(**{name: getattr(self, name) for name in CONSOLE})

    def _core_settings(self) -> _core.VectorSettings:
        """Converts the options to the settings of `_core.VectorMachines`."""
        core = _core.VectorSettings()
        core.seed = self.seed
        core.rules = RULES[self.rules]
        core.mode = self.mode
        core.difficulty = self.difficulty
        core.frame_skip = self.frameskip
        core.sound = bool(self.sound_obs)
        core.all_audio = self.sound_obs == "all"
        core.sticky = self.repeat_action_probability
        core.action_set = _core.ActionSet.LEGAL if self.continuous else _core.ActionSet[self.action_set.upper()]
        core.reward_min, core.reward_max = (-1, 1) if self.reward_clipping else (-MOST - 1, MOST)
        core.pool = self.maxpool
        core.max_episode_frames = self.max_num_frames_per_episode
        core.noop_max = self.noop_max
        core.fire = self.use_fire_reset
        core.start = member("start", self.start, _core.ResetOrder)
        core.lives = member("life_loss", self.life_loss, _core.LifeLoss)
        core.stack_start = member("stack_start", self.stack_start, _core.StackStart)
        core.autoreset = _core.Autoreset[autoreset_of(self.autoreset_mode).name]
        core.stack = 0 if self.obs_type == "ram" else self.stack_num
        core.width, core.height = (0, 0) if self.obs_type else (self.img_width, self.img_height)
        core.rgb = self.is_rgb
        core.rows = self.rows
        core.screens = self.render_mode is not None
        core.batch_size = self.batch_size
        core.threads = min(self.num_threads, self.num_envs, MOST_THREADS)
        core.first_processor = self.thread_affinity_offset
        return core
