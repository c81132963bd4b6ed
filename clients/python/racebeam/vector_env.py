"""AtariVectorEnv: many environments that are stepped together, in this process or on a server."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from . import images, xla
from .arguments import WrongType, WrongValue, check_source, check_token, image, path_of, seconds, value_or, warn
from .errors import InvalidInput
from .vector.autoreset import check_supported
from .vector.logs import VectorLogs
from .vector.machines import Machines
from .vector.making import Rom, make_local_machines, make_remote_machines, parse_games
from .vector.play import PlayedVector
from .vector_options import OptionArguments, VectorOptions

if sys.version_info >= (3, 11):
    from typing import Unpack
elif TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["AtariVectorEnv", "VectorArguments"]


class VectorArguments(OptionArguments, total=False):
    """The keyword arguments of `AtariVectorEnv` except `options`, for functions that pass them on."""

    preset: str | None
    rom: Rom | None
    game_file: str | os.PathLike[str] | None
    server: str | Sequence[str] | None
    token: str | None
    timeout: float | None
    log: dict[str, Any] | None


class AtariVectorEnv(PlayedVector):
    """A vector of environments of one or several games, stepped on threads or on servers.

    With default arguments, it returns what ale_py's AtariVectorEnv returns, byte for byte. Calls from two threads take
    turns. All returned arrays belong to the caller, and later calls leave them unchanged.

    Rewards are int32. In the shapes below, n is `batch_size`. `info` has these arrays of shape (n,):

    - `env_id` (int32): index of the environment that the row belongs to.
    - `lives` (int32): lives that are left.
    - `frame_number`, `episode_frame_number` (int32): frames since power-on, and since the episode began.
    - `raw_reward` (int32): reward before clipping.
    - `game_over` (bool): whether the game is over, regardless of lives and time limits.
    - `lost` (bool): with several servers, whether the server of the environment was lost in this call.

    With SAME_STEP, `info` has `final_obs`, `_final_obs`, `final_info` and `_final_info` in steps that end an episode,
    in the form that Gymnasium defines.

    Args:
        game: Name of a game, or one name for each environment. Several games must have the same number of actions,
            which `full_action_space=True` ensures.
        num_envs: Number of environments. Default: that of `options`, or the number of names in `game`, or 1.
        options: Options that are the defaults of the keyword arguments below.
        preset: Name of a preset of `racebeam.presets`, which supplies the defaults that are said to be its own.
            Default: "ale". Excludes `options`.
        rom: Path or bytes of the cartridge image. Default: the image that `racebeam.find_image` finds.
        game_file: Path of a game file with the rules of `rom`, instead of `game`. Without both, the image decides; an
            unknown one has no score.
        server: Address of the server that runs the environments, or a list of addresses to spread them over. Needs one
            game, and `batch_size` equal to `num_envs`.
        token: Token that the server requires.
        timeout: Seconds to wait for each reply of the server. Default: no limit.
        log: A dict with "folder", and with other arguments of `RecordLog` except `env` and `phrase`. `step` then writes
            a log of each game into this new folder, a submission. Environment i plays the trial `trial` + i. Each game
            begins at power-on, with another seed. Needs NEXT_STEP or DISABLED, `noop_max=0`, `use_fire_reset=False`,
            and another `life_loss` than "end". Excludes `server`, `send` and `xla`.
        **arguments: The options below. `help(racebeam.vector_options.OptionArguments)` lists their types.

    Keyword Args:
        batch_size: Number of environments that `recv` waits for. Default: 0, for all.
        num_threads: Number of threads. Default: 0, for one per processor that the process may use.
        thread_affinity_offset: Index into the processors that the process may use. Threads are bound to this one and
            those after it. Default: -1, which does not bind them.
        max_num_frames_per_episode: Frames after which an episode is truncated; 0 for no limit. Default: the preset's,
            108000 with "ale".
        repeat_action_probability: Probability that a frame repeats the previous action. Default: the preset's, 0 with
            "ale".
        full_action_space: Whether actions are all 18 legal ones, or only those that have an effect in the game.
            "console" adds those of `ConsoleAction`, which press or move a switch of the console, and those of
            `ControllerAction` that the left controller has. Default: the preset's, False with "ale".
        continuous: Whether actions are float32 (radius, angle, fire) instead of indices. Default: False.
        continuous_action_threshold: Deflection from which a direction or the button counts as pressed. Default: 0.5.
        autoreset_mode: NEXT_STEP, SAME_STEP or DISABLED of Gymnasium's AutoresetMode, or its name or value. Default:
            NEXT_STEP.
        img_height: Rows of an observation: 9 to twice those of the game's screen, or 0 for its own rows. Default: 84.
        img_width: Columns of an observation: 1 to 320, or 0 for the 160 of the screen. Default: 84.
        grayscale: Whether observations are shades of grey. If False, they have a last axis of 3 colours. Default: True.
        stack_num: Screens in an observation, 1 to 16, oldest first. Default: 4.
        frameskip: Frames per step, 1 to 1000. A step stops early if the episode ends. Default: the preset's, 4 with
            "ale".
        maxpool: Whether a screen is the pixelwise maximum of the last two frames of a step. Default: True.
        noop_max: Upper limit of the random number of NOOP frames that begin an episode: 0 to `noop_max` - 1. Default:
            the preset's, 30 with "ale".
        reward_clipping: Whether rewards are clipped to [-1, 1]. Default: the preset's, True with "ale".
        use_fire_reset: Whether an episode begins with FIRE, if the game has this action. Default: the preset's, True
            with "ale".
        mode: Mode of the game. Default: that of the game.
        difficulty: Difficulty of the game. Default: that of the game.
        obs_type: "rgb" or "grayscale" for screens of full size, or "ram" for the 128 bytes of RAM. Default: screens of
            `img_height` x `img_width`.
        life_loss: Effect of a lost life. "ignored": none. "reported": the step is terminated; the episode continues.
            "end": the episode ends, and the next one continues the game, as in DQN. "restart": the episode ends, and
            the next one is a new game. Default: the preset's, "ignored" with "ale".
        start: How an episode begins: "fire-noops" as in ale_py, "noops-fire" as in EnvPool, or "baselines" as in
            Stable-Baselines3. Default: "fire-noops".
        stack_start: Whether the first stack of an episode has "zeros", or "repeats" of its first screen. Default:
            "zeros".
        rules: "ale-0.12" for the rewards and ends of ALE 0.12, or "fixed" for corrected ones. Default: "ale-0.12".
        scheme: Cartridge scheme of the images, such as "F8", or "auto". Default: those of the games.
        left: Controller in the left port, such as "joystick" or "paddles". Default: that of the game. The
            setting `left` of the line protocol lists them all.
        right: Controller in the right port, such as "joystick" or "paddles". Default: that of the game. The
            setting `right` of the line protocol lists them all.
        format: Television standard, "ntsc", "pal", "pal60", "secam" or "auto". Default: that of the game.
        ystart: First line of the picture, 0 to 50. Default: that of the game.
        height: Lines of the picture, 100 to 256. Default: that of the game.
        seed: Seed of the first environment, from which seeds count up. The first `reset` uses it. Default: random.
        render_mode: "rgb_array" makes `render` return the screens. "human" opens a window, which shows the first 16
            environments at 60 frames per second. Default: None.
        sound_obs: Whether an observation is a dict of "image" and "sound", the 512 samples of the last frame, or with
            "all" those of each frame of the step; frames that it did not run are silent. A server does not play it.
            Default: False.
        episodic_life: Same as `life_loss="restart"`; for compatibility with ale_py.
        life_loss_info: Same as `life_loss="reported"`; for compatibility with ale_py.
        lives: Old name of `life_loss`.

    Raises:
        gymnasium.error.Error: If an argument is wrong; also a TypeError or a ValueError.
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If the game does not accept an argument, such as its mode.
        ImportError: If Gymnasium is older than 1.1.
        ConnectionError: If no server answers.

    All methods raise ClosedEnvironmentError after `close`, RuntimeError in a child process after a fork, and with a
    server also Refused, ConnectionError and TimeoutError. After the latter two, the environments cannot be used.

    Examples:
        >>> import racebeam
        >>> envs = racebeam.AtariVectorEnv("beamfall", 4, seed=7)
        >>> observations, info = envs.reset()
        >>> observations.shape, observations.dtype
        ((4, 4, 84, 84), dtype('uint8'))
        >>> observations, rewards, terminated, truncated, info = envs.step([1, 0, 0, 1])
        >>> rewards.shape, info["lives"].tolist()
        ((4,), [4, 4, 4, 4])
        >>> envs.close()
    """

    _xla_infos: tuple[str, ...] = (
        "env_id",
        "lives",
        "frame_number",
        "episode_frame_number",
        "raw_reward",
        "game_over",
    )
    _check_game = staticmethod(images.check_name)

    def __init__(
        self,
        game: str | Sequence[str] | None = None,
        num_envs: int | None = None,
        *,
        options: VectorOptions | None = None,
        preset: str | None = None,
        rom: Rom | None = None,
        game_file: str | os.PathLike[str] | None = None,
        server: str | Sequence[str] | None = None,
        token: str | None = None,
        timeout: float | None = None,
        log: dict[str, Any] | None = None,
        **arguments: Unpack[OptionArguments],
    ) -> None:
        check_supported("AtariVectorEnv")
        rom, own_file = image(rom), path_of(game_file)
        check_source(game, rom, own_file, server)
        check_token(server, token)
        if isinstance(options, VectorOptions) and (game is None or isinstance(game, str)):
            num_envs = value_or(num_envs, options.num_envs)
        names, game_of_env = parse_games(game, num_envs, self._check_game, server is None)
        is_seeded = options is not None or arguments.get("seed") is not None
        options = _merge(options, preset, len(game_of_env), arguments)
        machines: Machines
        if server is None:
            machines = make_local_machines(names, game_of_env, rom, options, own_file)
        elif options.sound_obs:
            raise WrongValue("sound_obs cannot be given with server; AtariEnv takes both")
        else:
            machines = make_remote_machines(names, rom, options, server, token, seconds("timeout", timeout))
        for warning in machines.image_warnings():
            warn(warning)
        self._use(machines, names, game_of_env, options, options.seed if is_seeded else None)
        if log is not None:
            if own := [*options._console(), *(["game_file"] if own_file else []), *(["server"] if server else [])]:
                raise WrongValue(f"{' and '.join(own)} cannot be given with log")
            self._logs = VectorLogs(log, options, [names[game] for game in game_of_env], rom, machines)

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
        """Makes functions that programs compiled by JAX call. Results stay on the processor.

        From this call on, a reset without a seed continues the random generators, also the first one. Errors of a
        compiled program are jax.errors.JaxRuntimeError.

        Returns:
            A handle, `reset(handle, seed=None, reset_mask=None)` and `step(handle, actions)`. Both functions return the
            handle for the next call, and a tuple of what `reset` and `step` of this class return, as arrays of JAX.
            Seeds end at 2,147,483,647. An array of JAX may have other seeds: their lower 31 bits are used, so that
            jax.random.bits() may draw them.

        Raises:
            ImportError: If JAX is not installed.
            InvalidInput: With SAME_STEP, with `batch_size` below `num_envs`, with `sound_obs`, with a server, or with
                `log`.
        """
        self._check_open()
        if self._logs is not None:
            raise InvalidInput("xla() does not write logs; with log, step() steps the environments")
        functions = xla.functions(self, self._xla_infos)
        self._first_seed = None
        return functions


def _merge(
    options: VectorOptions | None, preset: str | None, num_envs: int, arguments: OptionArguments
) -> VectorOptions:
    """Merges the two forms in which options are given: an object, and keyword arguments."""
    if options is None:
        return VectorOptions.of_preset(value_or(preset, "ale"), num_envs, **arguments)
    if not isinstance(options, VectorOptions):
        raise WrongType(f"options are {options!r}; they must be VectorOptions")
    if preset is not None:
        raise WrongValue(f"preset is {preset!r} and options are given; VectorOptions.of_preset() takes a preset")
    return options.with_changes(num_envs, **arguments)
