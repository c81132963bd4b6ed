"""AtariVectorEnv: many environments that are stepped together, in this process or on a server."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable, Sequence
from typing import Any, Literal, SupportsIndex

from . import images, xla
from .arguments import (
    WrongValue,
    check_source,
    console_of,
    image,
    path_of,
    real,
    renamed,
    seconds,
    value_or,
    warn_of,
)
from .errors import InvalidInput
from .presets import vector_preset
from .vector.autoreset import AutoresetMode, check_supported
from .vector.logs import VectorLogs
from .vector.making import Rom, make_local_machines, make_remote_machines, parse_games
from .vector.play import PlayedVector
from .vector_options import VectorOptions, life_loss_of, merge_life_flags

__all__ = ["AtariVectorEnv"]


class AtariVectorEnv(PlayedVector):
    """A vector of environments of one or several games, stepped on threads or on servers.

    With default arguments, it returns what ale_py's AtariVectorEnv returns, byte for byte. Arguments of None take the
    value of `preset`. Calls from two threads take turns. All returned arrays belong to the caller, and later calls
    leave them unchanged.

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
        num_envs: Number of environments. Default: 1, or the number of names in `game`.
        batch_size: Number of environments that `recv` waits for; 0 for all.
        num_threads: Number of threads; 0 for one per processor that the process may use.
        thread_affinity_offset: Index into the processors that the process may use. Threads are bound to this one and
            those after it; -1 does not bind them.
        max_num_frames_per_episode: Frames after which an episode is truncated; 0 for no limit.
        repeat_action_probability: Probability that a frame repeats the previous action.
        full_action_space: Whether actions are all 18 legal ones, or only those that have an effect in the game.
            "console" adds those of `ConsoleAction`, which press or move a switch of the console.
        continuous: Whether actions are float32 (radius, angle, fire) instead of indices.
        continuous_action_threshold: Deflection from which a direction or the button counts as pressed.
        autoreset_mode: NEXT_STEP, SAME_STEP or DISABLED of Gymnasium's AutoresetMode, or its name or value.
        img_height: Rows of an observation: 9 to twice those of the game's screen, or 0 for its own rows.
        img_width: Columns of an observation: 1 to 320, or 0 for the 160 of the screen.
        grayscale: Whether observations are shades of grey. If False, they have a last axis of 3 colours.
        stack_num: Screens in an observation, 1 to 16, oldest first.
        frameskip: Frames per step, 1 to 1000. A step stops early if the episode ends.
        maxpool: Whether a screen is the pixelwise maximum of the last two frames of a step.
        noop_max: Upper limit of the random number of NOOP frames that begin an episode: 0 to `noop_max` - 1.
        episodic_life: Same as `life_loss="restart"`; for compatibility with ale_py.
        life_loss_info: Same as `life_loss="reported"`; for compatibility with ale_py.
        reward_clipping: Whether rewards are clipped to [-1, 1].
        use_fire_reset: Whether an episode begins with FIRE, if the game has this action.
        preset: Name of a preset of `racebeam.presets`, which supplies the arguments that are None.
        mode: Mode of the game, or None for its default.
        difficulty: Difficulty of the game, or None for its default.
        obs_type: "rgb" or "grayscale" for screens of full size, or "ram" for the 128 bytes of RAM. Default: screens of
            `img_height` x `img_width`.
        life_loss: Effect of a lost life. "ignored": none. "reported": the step is terminated, and the episode goes on.
            "end": the episode ends, and the next one continues the game, as in DQN. "restart": the episode ends, and
            the next one is a new game.
        start: How an episode begins: "fire-noops" as in ale_py, "noops-fire" as in EnvPool, or "baselines" as in
            Stable-Baselines3.
        stack_start: Whether the first stack of an episode has "zeros", or "repeats" of its first screen.
        rules: "ale-0.12" for the rewards and ends of ALE 0.12, or "fixed" for corrected ones.
        rom: Path or bytes of the cartridge image. Default: the image that `racebeam.find_image` finds.
        game_file: Path of a game file with the rules of `rom`, instead of `game`. Without both, the image decides; an
            unknown one has no score.
        scheme: Cartridge scheme of the images, such as "F8", or "auto". Default: those of the games.
        left: Controller in the left port, "joystick" or "paddles". Default: that of the game.
        right: Controller in the right port, "joystick" or "paddles". Default: that of the game.
        format: Television standard, "ntsc", "pal", "pal60", "secam" or "auto". Default: that of the game.
        ystart: First line of the picture, 0 to 50. Default: that of the game.
        height: Lines of the picture, 100 to 256. Default: that of the game.
        seed: Seed of the first environment, from which seeds count up. The first `reset` uses it. Default: random.
        render_mode: "rgb_array" makes `render` return the screens. "human" opens a window, which shows the first 16
            environments at 60 frames per second.
        sound_obs: Whether an observation is a dict of "image" and "sound", the 512 samples of the last frame, or with
            "all" those of each frame of the step; frames that it did not run are silent. A server does not play it.
        server: Address of the server that runs the environments, or a list of addresses to spread them over. Needs one
            game, and `batch_size` equal to `num_envs`.
        token: Token that the server asks for.
        timeout: Seconds to wait for each reply of the server. Default: no limit.
        lives: Old name of `life_loss`.
        log: A dict with "folder", and with other arguments of `RecordLog` except `env` and `phrase`. `step` then writes
            a log of each game into this new folder, a submission. Environment i plays the trial `trial` + i. Each game
            begins at power-on, with a seed of its own. Needs NEXT_STEP or DISABLED, `noop_max=0`,
            `use_fire_reset=False`, and another `life_loss` than "end". Excludes `server`, `send` and `xla`.

    Raises:
        gymnasium.error.Error: If an argument is wrong; also a TypeError or a ValueError.
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If the game does not accept an argument, such as its mode.
        ImportError: If Gymnasium is older than 1.1.
        ConnectionError: If no server answers.

    All methods raise ClosedEnvironmentError after `close`, RuntimeError in a child process after a fork, and with a
    server also Refused, ConnectionError and TimeoutError. After the latter two, the environments cannot be used.

    Example:
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
        batch_size: int = 0,
        num_threads: int = 0,
        thread_affinity_offset: int = -1,
        max_num_frames_per_episode: int | None = None,
        repeat_action_probability: float | None = None,
        full_action_space: bool | Literal["console"] | None = None,
        continuous: bool = False,
        continuous_action_threshold: float = 0.5,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        img_height: int = 84,
        img_width: int = 84,
        grayscale: bool = True,
        stack_num: int = 4,
        frameskip: int | None = None,
        maxpool: bool = True,
        noop_max: int | None = None,
        episodic_life: bool = False,
        life_loss_info: bool = False,
        reward_clipping: bool | None = None,
        use_fire_reset: bool | None = None,
        preset: str = "ale",
        mode: int | None = None,
        difficulty: int | None = None,
        obs_type: Literal["rgb", "grayscale", "ram"] | None = None,
        life_loss: str | None = None,
        start: str = "fire-noops",
        stack_start: str = "zeros",
        rules: str = "ale-0.12",
        rom: Rom | None = None,
        game_file: str | os.PathLike[str] | None = None,
        scheme: str | None = None,
        left: str | None = None,
        right: str | None = None,
        format: str | None = None,
        ystart: int | None = None,
        height: int | None = None,
        seed: SupportsIndex | None = None,
        render_mode: Literal["human", "rgb_array"] | None = None,
        sound_obs: bool | Literal["all"] = False,
        server: str | Sequence[str] | None = None,
        token: str | None = None,
        timeout: float | None = None,
        lives: str | None = None,
        log: dict[str, Any] | None = None,
    ) -> None:
        check_supported("AtariVectorEnv")
        rom, own_file = image(rom), path_of(game_file)
        check_source(game, rom, own_file, server)
        names, game_of_env = parse_games(game, num_envs, self._check_game, server is None)
        console = console_of(scheme=scheme, left=left, right=right, format=format, ystart=ystart, height=height)
        defaults = vector_preset(preset)
        options = VectorOptions(
            num_envs=len(game_of_env),
            batch_size=batch_size,
            num_threads=num_threads,
            thread_affinity_offset=thread_affinity_offset,
            max_num_frames_per_episode=value_or(max_num_frames_per_episode, defaults.max_num_frames_per_episode),
            repeat_action_probability=value_or(repeat_action_probability, defaults.repeat_action_probability),
            full_action_space=value_or(full_action_space, defaults.full_action_space),
            continuous=continuous,
            autoreset_mode=autoreset_mode,
            img_height=img_height,
            img_width=img_width,
            grayscale=grayscale,
            stack_num=stack_num,
            frameskip=value_or(frameskip, defaults.frameskip),
            maxpool=maxpool,
            noop_max=value_or(noop_max, defaults.noop_max),
            reward_clipping=value_or(reward_clipping, defaults.reward_clipping),
            use_fire_reset=value_or(use_fire_reset, defaults.use_fire_reset),
            mode=mode,
            difficulty=difficulty,
            obs_type=obs_type,
            life_loss=value_or(
                merge_life_flags(
                    renamed("lives", life_loss_of(lives), "life_loss", life_loss), episodic_life, life_loss_info
                ),
                defaults.life_loss,
            ),
            start=start,
            stack_start=stack_start,
            rules=rules,
            render_mode=render_mode,
            sound_obs=sound_obs,
            seed=value_or(seed, secrets.randbits(32)),
        )
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        if server is None:
            machines = make_local_machines(names, game_of_env, rom, options, own_file, console)
        elif unplayed := [*console, *(["sound_obs"] if options.sound_obs else [])]:
            raise WrongValue(f"{' and '.join(unplayed)} cannot be given with server; AtariEnv takes both")
        else:
            machines = make_remote_machines(names, rom, options, server, token, seconds("timeout", timeout))
        warn_of(machines.image_warnings())
        self._use(machines, names, game_of_env, options, None if seed is None else options.seed)
        if log is not None:
            if own := [*console, *(["game_file"] if own_file else []), *(["server"] if server else [])]:
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
