"""AtariVectorEnv: many environments that are stepped together, in this process or on a server."""

from __future__ import annotations

import operator
import os
import secrets
from collections.abc import Callable, Sequence
from typing import Any, Literal, SupportsIndex, TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import error, spaces
from gymnasium.vector.utils import batch_space

from . import _core, images, xla
from .arguments import (
    WrongType,
    WrongValue,
    check_source,
    console_of,
    image,
    path_of,
    real,
    seconds,
    value_or,
    warn_of,
    whole,
)
from .autoreset import AutoresetMode, VectorEnv, check_supported
from .errors import InvalidInput
from .machines import Actions, Joysticks, Machines
from .machines import Seeds as SeedArray
from .presets import vector_preset
from .vector_inputs import indices_of, joysticks_of, mask_of, seeds_of
from .vector_options import MOST_ENVS, VectorOptions, autoreset_of, merge_life_flags
from .vector_results import Bools, Numbers, Pixels, Results
from .window import Grid
from .wire.remote_machines import Halves, RemoteMachines
from .wire.spread_machines import SpreadMachines

__all__ = ["AtariVectorEnv"]

Rom: TypeAlias = str | os.PathLike[str] | bytes
Info: TypeAlias = dict[str, Any]
Seeds: TypeAlias = SupportsIndex | Sequence[SupportsIndex | None] | npt.NDArray[np.integer[Any]]
# Observations, rewards, terminated, truncated and info.
Step: TypeAlias = tuple[Pixels, npt.NDArray[np.int32], Bools, Bools, Info]
RAM_SIZE, SCREEN_WIDTH = 128, 160


class AtariVectorEnv(VectorEnv[Any, Any, Any]):
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
        episodic_life: Same as `lives="restart"`; for compatibility with ale_py.
        life_loss_info: Same as `lives="told"`; for compatibility with ale_py.
        reward_clipping: Whether rewards are clipped to [-1, 1].
        use_fire_reset: Whether an episode begins with FIRE, if the game has this action.
        preset: Name of a preset of `racebeam.presets`, which supplies the arguments that are None.
        mode: Mode of the game, or None for its default.
        difficulty: Difficulty of the game, or None for its default.
        obs_type: "rgb" or "grayscale" for screens of full size, or "ram" for the 128 bytes of RAM. Default: screens of
            `img_height` x `img_width`.
        lives: Effect of a lost life. "ignored": none. "told": the step is terminated, and the episode goes on. "end":
            the episode ends, and the next one continues the game, as in DQN. "restart": the episode ends, and the next
            one is a new game.
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
        server: Address of the server that runs the environments, or a list of addresses to spread them over. Needs one
            game, and `batch_size` equal to `num_envs`.
        token: Token that the server asks for.
        timeout: Seconds to wait for each reply of the server. Default: no limit.

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
    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 15}
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
        full_action_space: bool | None = None,
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
        lives: str | None = None,
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
        server: str | Sequence[str] | None = None,
        token: str | None = None,
        timeout: float | None = None,
    ) -> None:
        check_supported("AtariVectorEnv")
        rom, own_file = image(rom), path_of(game_file)
        check_source(game, rom, own_file, server)
        names, game_of_env = self._parse_games(game, num_envs, server is None)
        console = console_of(scheme=scheme, left=left, right=right, format=format, ystart=ystart, height=height)
        usual = vector_preset(preset)
        options = VectorOptions(
            num_envs=len(game_of_env),
            batch_size=batch_size,
            num_threads=num_threads,
            thread_affinity_offset=thread_affinity_offset,
            max_num_frames_per_episode=value_or(max_num_frames_per_episode, usual.max_num_frames_per_episode),
            repeat_action_probability=value_or(repeat_action_probability, usual.repeat_action_probability),
            full_action_space=value_or(full_action_space, usual.full_action_space),
            continuous=continuous,
            autoreset_mode=autoreset_mode,
            img_height=img_height,
            img_width=img_width,
            grayscale=grayscale,
            stack_num=stack_num,
            frameskip=value_or(frameskip, usual.frameskip),
            maxpool=maxpool,
            noop_max=value_or(noop_max, usual.noop_max),
            reward_clipping=value_or(reward_clipping, usual.reward_clipping),
            use_fire_reset=value_or(use_fire_reset, usual.use_fire_reset),
            mode=mode,
            difficulty=difficulty,
            obs_type=obs_type,
            lives=value_or(merge_life_flags(lives, episodic_life, life_loss_info), usual.lives),
            start=start,
            stack_start=stack_start,
            rules=rules,
            render_mode=render_mode,
            seed=value_or(seed, secrets.randbits(32)),
        )
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        if server is None:
            machines = make_local_machines(names, game_of_env, rom, options, own_file, console)
        elif console:
            raise WrongValue(f"{' and '.join(console)} are given with server; AtariEnv takes both")
        else:
            machines = _remote_machines(names, rom, options, server, token, seconds("timeout", timeout))
        warn_of(machines.doubts())
        self._use(machines, names, game_of_env, options, None if seed is None else options.seed)

    def _use(
        self,
        machines: Machines,
        names: list[str | None],
        game_of_env: Numbers,
        options: VectorOptions,
        first_seed: int | None = None,
    ) -> None:
        """Sets the attributes, for machines that were made with these options.

        Args:
            machines: The machines.
            names: Names of the games.
            game_of_env: For each environment, the index of its game.
            options: The options.
            first_seed: Seed of the first reset. It is forgotten when something is played before.
        """
        self._first_seed = first_seed
        self._machines: Any = machines
        self._options = options
        self._games = [names[index] for index in game_of_env]
        self.num_envs = options.num_envs
        self.batch_size: int = options.batch_size
        self.autoreset_mode = autoreset_of(options.autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.autoreset_mode}
        self.render_mode = options.render_mode
        self.grayscale: bool = not options.is_rgb
        self.continuous = options.continuous
        self._shows_ram = options.obs_type == "ram"
        self._has_finals = self.autoreset_mode is AutoresetMode.SAME_STEP
        self._received = np.arange(self.num_envs, dtype=np.int32)
        self._make_spaces()
        self._window: Grid | None = None
        if self.render_mode == "human":
            title = images.titles().get(str(names[0]), "racebeam") if len(names) == 1 else "racebeam"
            self._window = Grid(title, self.num_envs, SCREEN_WIDTH, self._machines.height())

    def _parse_games(
        self, game: str | Sequence[str] | None, num_envs: int | None, is_local: bool = True
    ) -> tuple[list[str | None], Numbers]:
        """Returns the names of the games, and for each environment the index of its game.

        A server checks its names itself, since it may know others.
        """
        if isinstance(game, str) or game is None:
            if game is not None and is_local:
                self._check_game(game)
            return [game], np.zeros(whole("num_envs", value_or(num_envs, 1), 1, MOST_ENVS), np.int32)
        if not isinstance(game, Sequence):
            raise WrongType(f"game is {game!r}; it takes a name, or a list of names")
        if num_envs is not None and num_envs != len(game):
            raise WrongValue(f"game has {len(game)} names, but num_envs is {num_envs!r}")
        whole("num_envs", len(game), 1, MOST_ENVS)
        for name in game:
            if not isinstance(name, str):
                raise WrongType(f"game has {name!r} in its list; it takes names of games")
        names: list[str | None] = list(dict.fromkeys(game))
        for each in names:
            self._check_game(str(each))
        return names, np.array([names.index(name) for name in game], np.int32)

    def _make_spaces(self) -> None:
        shape: tuple[int, ...] = (RAM_SIZE,)
        if not self._shows_ram:
            settings = self._options.core_settings()
            shape = (settings.stack, settings.height or self._machines.height(), settings.width or SCREEN_WIDTH)
            shape += () if self.grayscale else (3,)
        self.single_observation_space = spaces.Box(0, 255, shape, np.uint8)
        counts = sorted(set(self._machines.numbers_of_actions()))
        if self.continuous:
            low, high = np.array([0, -np.pi, 0], np.float32), np.array([1, np.pi, 1], np.float32)
            self.single_action_space: spaces.Space[Any] = spaces.Box(low, high, dtype=np.float32)
        elif len(counts) == 1:
            self.single_action_space = spaces.Discrete(counts[0])
        else:
            raise InvalidInput(
                f"the games have {' and '.join(map(str, counts))} actions; full_action_space=True gives them the same"
            )
        self.observation_space = batch_space(self.single_observation_space, self.batch_size)
        self.action_space = batch_space(self.single_action_space, self.batch_size)
        self._shape = shape

    def __repr__(self) -> str:
        game = self._games[0] if len(set(self._games)) == 1 else self._games
        return f"{type(self).__name__}(game={game!r}, num_envs={self.num_envs})"

    # Playing

    def reset(
        self, *, seed: Seeds | None = None, options: dict[str, Any] | None = None, out: Pixels | None = None
    ) -> tuple[Pixels, Info]:
        """Begins new episodes.

        Steps that were sent and not received are played to their end, and their results are dropped. What a signal's
        handler raises, such as KeyboardInterrupt, ends a long call, as in `step`.

        Args:
            seed: Seed of the first environment, from which seeds count up; or one for each environment, where None and
                -1 mean unseeded. A seed powers the environment on anew. Without a seed, the generators continue; the
                first reset uses the seed of the constructor.
            options: May have "reset_mask", a bool array of shape (num_envs,) that chooses the environments to reset.
                The others are returned as they are. Needs `batch_size` equal to `num_envs`.
            out: Array for the observations. Default: a new array.

        Returns:
            Observations, uint8 of shape (n, stack_num, img_height, img_width), with 3 as a further axis for colours, or
            of shape (n, 128) for the RAM; and the info.

        Raises:
            TypeError: If a seed or the mask has a wrong type.
            InvalidInput: If a seed, the mask or `out` has a wrong value or shape.
        """
        self._check_open()
        if not isinstance(options, (dict, type(None))):
            raise TypeError(f"options are {options!r}; they must be a dict")
        mask = self._parse_mask((options or {}).get("reset_mask"))
        seeds = self._parse_seeds(value_or(seed, self._first_seed), mask)
        results = self._allocate_results(out)
        if mask is not None and self.batch_size < self.num_envs:
            raise InvalidInput("reset_mask is given with batch_size < num_envs; it needs batch_size to be num_envs")
        self._drop_pending()
        self._first_seed = None
        if self.batch_size == self.num_envs:
            self._machines.reset(mask, seeds, results)
        else:
            self._machines.send_resets(seeds)
            self._machines.receive(results)
        observations, *_, info = self._format_step(results)
        return observations, info

    def _drop_pending(self) -> None:
        """Receives what was sent and not received, and drops it."""
        pending = int(self._machines.playing())
        if pending == 0:
            return
        receive = self._machines.drop if isinstance(self._machines, Halves) else self._machines.receive
        receive(self._allocate_results(None, pending))

    def step(self, actions: npt.ArrayLike, *, out: Pixels | None = None) -> Step:
        """Steps the environments.

        What a signal's handler raises, such as KeyboardInterrupt, ends a long call. Each environment has then either
        made the step or not, and `reset` or `restore` makes them agree. With `batch_size` below `num_envs`, the step
        goes on, and `recv` returns it.

        Args:
            actions: An action for each environment, or for each of those that the last call returned if `batch_size` is
                below `num_envs`. Integers of shape (n,), or numbers of shape (n, 3) if `continuous`: the radius from 0
                to 1, the angle in radians, and fire.
            out: Array for the observations. Default: a new array.

        Returns:
            Observations as in `reset`, rewards (int32), terminated (bool), truncated (bool) and the info.

        Raises:
            TypeError: If the actions have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions or `out` have a wrong shape, or a number is not finite.
        """
        self._check_open()
        parsed: Any = self._parse_joysticks(actions) if self.continuous else self._parse_actions(actions)
        if self.batch_size < self.num_envs:
            self._send(parsed)
            return self.recv(out=out)
        results = self._allocate_results(out)
        self._first_seed = None
        if self.continuous:
            self._machines.step_joysticks(parsed, self.continuous_action_threshold, results)
        else:
            self._machines.step(parsed, results)
        return self._format_step(results)

    def send(self, actions: npt.ArrayLike) -> None:
        """Begins a step of the environments that the last call returned; `recv` returns its results.

        Args:
            actions: As in `step`.

        Raises:
            TypeError: If the actions have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions have a wrong shape.
        """
        self._check_open()
        self._send(self._parse_joysticks(actions) if self.continuous else self._parse_actions(actions))

    def recv(self, *, out: Pixels | None = None) -> Step:
        """Waits for the first `batch_size` environments that finish their step.

        After KeyboardInterrupt, the next call returns these results.

        Args:
            out: Array for the observations. Default: a new array.

        Returns:
            The same as `step`.

        Raises:
            InvalidInput: If fewer than `batch_size` environments were sent, or `out` has a wrong shape.
        """
        self._check_open()
        results = self._allocate_results(out)
        self._machines.receive(results)
        return self._format_step(results)

    def _send(self, actions: npt.NDArray[Any]) -> None:
        envs = self._last_received()
        self._first_seed = None
        if self.continuous:
            self._machines.send_joysticks(actions, self.continuous_action_threshold, envs)
        else:
            self._machines.send(actions, envs)

    def _last_received(self) -> Numbers:
        """Returns the environments that the last call returned. Before the first call, those are all."""
        if len(self._received) != self.batch_size:
            raise InvalidInput("no environment was received yet; call reset() first")
        return self._received

    def show(self) -> tuple[Pixels, Info]:
        """Returns the present observations of all environments, such as after `restore`.

        Returns:
            The same as `reset`, for all environments.
        """
        self._check_open()
        results = self._allocate_results(None, self.num_envs)
        self._machines.show(results)
        results.rewards[:] = results.raw_rewards[:] = 0  # nothing was played
        return self._observations(results), self._make_info(results)

    # Seeds and actions

    def _parse_seeds(self, seed: Any, mask: Bools | None) -> SeedArray | None:
        """Returns one seed for each environment, also for those that are not in the mask."""
        return None if seed is None else seeds_of(seed, self.num_envs)

    def _parse_mask(self, mask: Any) -> Bools | None:
        return mask_of(mask, self.num_envs)

    def _parse_actions(self, actions: Any, count: int | None = None) -> Actions:
        """Converts actions of `count` environments. Default: of a batch."""
        return indices_of(actions, value_or(count, self.batch_size), self._machines.numbers_of_actions()[0])

    def _parse_joysticks(self, actions: Any) -> Joysticks:
        return joysticks_of(actions, self.batch_size)

    # Results

    def _allocate_results(self, out: Pixels | None, count: int | None = None) -> Results:
        """Allocates results for `count` environments. Default: for a batch."""
        shape = (self.batch_size if count is None else count, *self._shape)
        if out is None:
            out = np.empty(shape, np.uint8)
        elif not (isinstance(out, np.ndarray) and out.dtype == np.uint8 and out.shape == shape and out.flags.carray):
            raise InvalidInput(f"out must be a writable, contiguous array of uint8 with the shape {shape}")
        finals = np.empty(shape, np.uint8) if self._has_finals else None
        observations, ram = (None, out) if self._shows_ram else (out, None)
        return Results.allocate(observations, ram, shape[0], finals)

    def _observations(self, results: Results) -> Any:
        return results.ram if self._shows_ram else results.observations

    def _format_step(self, results: Results) -> Step:
        self._received = results.env_id.copy()
        self._show_window()
        observations, info = self._observations(results), self._make_info(results)
        if self._has_finals and results.finished.any():
            self._add_finals(info, observations, results)
        return observations, results.rewards, results.terminated, results.truncated, info

    def _make_info(self, results: Results) -> Info:
        lost = {"lost": self._machines.lost} if isinstance(self._machines, SpreadMachines) else {}
        return {
            "env_id": results.env_id,
            "lives": results.lives,
            "frame_number": results.frames,
            "episode_frame_number": results.episode_frames,
            "raw_reward": results.raw_rewards,
            "game_over": results.game_over,
            **lost,
        }

    def _add_finals(self, info: Info, observations: Any, results: Results) -> None:
        """Adds the keys of SAME_STEP as Gymnasium defines them: arrays of objects, None where no episode ended."""
        finished, finals = results.finished, results.final_observations
        assert finals is not None and results.final_numbers is not None
        objects = np.empty(self.batch_size, object)
        for env in np.flatnonzero(finished):
            objects[env] = finals[env].copy()
        numbers = np.where(finished, results.final_numbers, 0)
        named = dict(zip(("lives", "frame_number", "episode_frame_number"), numbers, strict=True))
        info["final_obs"], info["_final_obs"] = objects, finished
        info["final_info"], info["_final_info"] = {**named, **{f"_{key}": finished for key in named}}, finished

    def _show_window(self) -> None:
        """Shows the environments that the last call returned."""
        if self._window is not None:
            shown = (int(env) for env in self._received if self._window.shows(int(env)))
            self._window.show(((env, self._machines.screen(env)) for env in shown), self._options.frameskip)

    def render(self) -> tuple[Pixels, ...] | None:
        """Returns the screen of each environment.

        Returns:
            uint8 arrays of shape (height, 160, 3) if `render_mode` is "rgb_array"; None if it is "human", since the
            window shows the screens already.

        Raises:
            gymnasium.error.Error: If `render_mode` is None.
        """
        self._check_open()
        if self.render_mode is None:
            raise error.Error(
                "render_mode is None, so render() shows nothing; make the environments with render_mode='rgb_array'"
            )
        if self.render_mode == "human":
            return None
        return tuple(self._machines.screen(env) for env in range(self.num_envs))

    # Attributes of the environments

    def get_action_meanings(self, env: int = 0) -> list[str]:
        """Names the actions of an environment.

        Args:
            env: Index of the environment.

        Returns:
            The names in the order of their indices, such as ["NOOP", "FIRE"].

        Raises:
            IndexError: If there is no such environment.
        """
        self._check_open()
        self._check_env(env)
        return [_core.Action(number).name for number in self._machines.actions_of(env)]

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Calls a method once for each environment, as SyncVectorEnv of Gymnasium does.

        Args:
            name: Name of a method whose first parameter is the index of an environment, such as "save" or
                "get_action_meanings".
            *args: Further arguments of each call.
            **kwargs: Keyword arguments of each call.

        Returns:
            What the calls return, in the order of the environments.

        Raises:
            AttributeError: If the environments have no such method.
        """
        if name not in ("get_action_meanings", "restore", "save"):
            raise AttributeError(f"environments have no method {name!r}; they have get_action_meanings, restore, save")
        method = getattr(self, name)
        return tuple(method(env, *args, **kwargs) for env in range(self.num_envs))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Reads an attribute of each environment, as SyncVectorEnv of Gymnasium does.

        Args:
            name: Name of an attribute. "game" is the name of the environment's game; other attributes of this class
                have the same value for all environments.

        Returns:
            The values in the order of the environments.

        Raises:
            AttributeError: If there is no such attribute.
        """
        if name == "game":
            return tuple(self._games)
        return (getattr(self, name),) * self.num_envs

    def _check_env(self, env: int) -> None:
        if not 0 <= operator.index(env) < self.num_envs:
            raise IndexError(f"there is no environment {env}; there are 0 to {self.num_envs - 1}")

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
        """Makes functions that programs compiled by JAX call. Results stay on the processor.

        From this call on, a reset without a seed continues the random generators, also the first one. Errors of a
        compiled program are jax.errors.JaxRuntimeError.

        Returns:
            A handle, `reset(handle, seed=None, reset_mask=None)` and `step(handle, actions)`. Both functions return the
            handle for the next call, and a tuple of what `reset` and `step` of this class return, as arrays of JAX.
            Seeds end at 2,147,483,647. Of the seeds in an array of JAX, the lower 31 bits are used, so that
            jax.random.bits() may draw them.

        Raises:
            ImportError: If JAX is not installed.
            InvalidInput: With SAME_STEP, with `batch_size` below `num_envs`, or with a server.
        """
        self._check_open()
        functions = xla.functions(self, self._xla_infos)
        self._first_seed = None
        return functions

    def machines(self) -> Machines:
        """Returns the machines that play the environments; for other modules of this package."""
        self._check_open()
        machines: Machines = self._machines
        return machines

    # States and the end

    def save(self, env: int, *, include_rng: bool = True) -> _core.SavedMachine:
        """Saves the state of one environment, with its stack of screens.

        Args:
            env: Index of the environment.
            include_rng: Whether to save the generators of sticky actions and of no-ops, so that later episodes are the
                same.

        Returns:
            A state that can be pickled, copied and restored in another process.

        Raises:
            IndexError: If there is no such environment.
        """
        self._check_open()
        return self.machines().save(operator.index(env), include_rng)

    def restore(self, env: int, state: _core.SavedMachine) -> None:
        """Restores the state of one environment. `show` returns its observation.

        Args:
            env: Index of the environment.
            state: A state that `save` returned, of any environment of the same game.

        Raises:
            IndexError: If there is no such environment.
            TypeError: If `state` is not a state.
            InvalidInput: If the state belongs to another game, or its observations have another shape.
        """
        self._check_open()
        self._machines.restore(operator.index(env), state)
        self._first_seed = None

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(
            f"{type(self).__name__} cannot be pickled or copied, because it owns threads; make another one with the "
            "same arguments, and restore() the states that save() returns, which can be pickled"
        )

    def close_extras(self, **kwargs: Any) -> None:
        """Stops the threads or ends the sessions, and frees the memory. `close` calls it.

        Args:
            **kwargs: Ignored.
        """
        machines = self.__dict__.get("_machines")  # missing if the constructor failed
        window = self.__dict__.get("_window")
        self._machines, self._window = _Closed(), None
        if window is not None:
            window.close()
        if isinstance(machines, (RemoteMachines, SpreadMachines)):
            machines.close()

    def _check_open(self) -> None:
        if self.closed:
            raise _closed_error()


class _Closed:
    """Placeholder for closed machines: any use raises ClosedEnvironmentError, also in the call of another thread."""

    def __getattr__(self, name: str) -> Any:
        raise _closed_error()


def _closed_error() -> error.ClosedEnvironmentError:
    return error.ClosedEnvironmentError("these environments were closed; make new ones")


def make_local_machines(
    names: list[str | None],
    game_of_env: Numbers,
    rom: Rom | None,
    options: VectorOptions,
    game_file: str | None = None,
    console: dict[str, str] | None = None,
) -> Machines:
    """Makes the machines of a vector in this process.

    Args:
        names: Names of the games.
        game_of_env: For each environment, the index of its game.
        rom: Path or bytes of the image, or None to find the images.
        options: Options of the environments.
        game_file: Path of a game file, or None.
        console: What the console must know of the images, as texts.

    Returns:
        The machines.

    Raises:
        WrongValue: If `rom` is given for several games.
        MissingImage: If no image of a game is found.
    """
    if len(names) > 1 and rom is not None:
        raise WrongValue(f"there are {len(names)} games; rom and server take one")
    found = [(images.find(str(name)) if rom is None else rom, name) for name in names]
    return _core.VectorMachines(found, game_of_env, options.core_settings(), game_file, console or {})


def _remote_machines(
    names: list[str | None],
    rom: Rom | None,
    options: VectorOptions,
    server: str | Sequence[str],
    token: str | None,
    timeout: float | None,
) -> Machines:
    """Makes machines on one server, or on several."""
    if len(names) > 1:
        raise WrongValue(f"there are {len(names)} games; rom and server take one")
    game = str(names[0])  # a server is told the game
    if isinstance(server, str):
        return RemoteMachines(server, token, timeout, game, rom, options)
    return SpreadMachines(server, token, timeout, game, rom, options)
