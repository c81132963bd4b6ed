"""AtariEnv: one game as an environment of Gymnasium, in this process or on a server."""

from __future__ import annotations

import inspect
import os
from typing import Any, Literal, NoReturn, TypeAlias, TypedDict

from . import images
from ._core import Action, ConsoleAction, View, controller_actions
from .arguments import (
    MOST,
    WrongType,
    WrongValue,
    accept_old_name,
    action_space,
    check_choice,
    check_names,
    check_source,
    check_token,
    console_of,
    flag,
    image,
    integer,
    optional_integer,
    path_of,
    real,
    seconds,
    share,
    sound_flag,
    value_or,
    warn,
)
from .interface import ALEInterface
from .presets import preset as preset_of
from .single.actions import PlayerAction
from .single.arguments import check_reward_range, check_rules, frameskip_of
from .single.life_loss import LIFE_LOSSES, LifeLoss
from .single.skipping import warn_of_second_skip
from .single.view import VIEWS, EnvWithView, Observation, closed_error
from .wire.remote import RemoteInterface

__all__ = ["AtariEnv", "AtariEnvStepMetadata"]

Rom: TypeAlias = images.Rom | bytearray | memoryview
# Results of ALEInterface.step(): observation, rewards of A and B, ends, lives, and frame numbers.
StepResults: TypeAlias = tuple[Any, float, float, bool, bool, int, int, int]

RENDER_MODES = (None, "human", "rgb_array")


class _Counts(TypedDict):
    lives: int
    episode_frame_number: int
    frame_number: int


class AtariEnvStepMetadata(_Counts, total=False):
    """The info of a step or a reset.

    Attributes:
        lives: Lives that are left.
        episode_frame_number: Frames since the episode began.
        frame_number: Frames since power-on.
        seeds: After a reset with a seed: the seeds of `np_random` and of the game.
        reward_a: With `two_player`, the reward of player A.
        reward_b: With `two_player`, the reward of player B.
    """

    seeds: tuple[int, int]
    reward_a: float
    reward_b: float


class AtariEnv(EnvWithView):
    """An Atari 2600 game. It returns what ale_py's AtariEnv returns, byte for byte, for the same arguments and actions.

    A new environment has random seeds. `reset(seed=S)` powers the console on anew with seeds derived from S. Without a
    seed, `reset` continues the random generators. A copy by `copy.deepcopy` or `pickle` continues where the original
    is. Calls from two threads take turns.

    Args:
        game: Name of the game, one of `racebeam.games()` or of the server's, or None with `rom`.
        mode: Mode of the game, or None for its default.
        difficulty: Difficulty of the game, or None for its default.
        obs_type: Type of the observations, all uint8: "rgb" of shape (height, 160, 3), "grayscale" of shape (height,
            160), or "ram" of shape (128,).
        frameskip: Frames per step, or (low, high) to sample uniformly from [low, high). A step always runs all its
            frames, even past game over.
        repeat_action_probability: Probability that a frame repeats the previous action.
        full_action_space: Whether actions are all 18 legal ones, or only those that have an effect in the game.
            "console" adds those of `ConsoleAction`, which press or move a switch of the console, and those of
            `ControllerAction` that the controllers have.
        continuous: Whether an action is a float32 array (radius, angle, fire) instead of an index. The radius is also
            the strength of a paddle. Selects all 18 actions.
        continuous_action_threshold: Deflection from which a direction or the button counts as pressed.
        max_num_frames_per_episode: Frames after which an episode is truncated; 0 for no limit.
        render_mode: "human" opens a window at 60 frames per second, or "rgb_array" makes `render` return the screen.
            All games of a process share one window, which shows the game that was stepped last.
        sound_obs: Whether an observation is a dict of "image" and "sound", the 512 samples of the last frame. "all":
            those of each frame of the step; frames that the step did not run are silent.
        preset: Name of a preset of `racebeam.presets`. It supplies `frameskip`, `repeat_action_probability`,
            `full_action_space`, `max_num_frames_per_episode`, `noop_max`, `life_loss` and `reward_range` where
            they are None.
        rules: "ale-0.12" for the rewards and ends of ALE 0.12, or "fixed" for corrected ones.
        rom: Path or bytes of the cartridge image. Default: the image that `racebeam.find_image` finds.
        game_file: Path of a game file with the rules of `rom`, instead of `game`. Without both, the image decides; an
            unknown one has no score.
        scheme: Cartridge scheme of the image, such as "F8", or "auto". Default: that of the game.
        left: Controller in the left port, such as "joystick" or "paddles". Default: that of the game. The
            setting `left` of the line protocol lists them all.
        right: Controller in the right port, such as "joystick" or "paddles". Default: that of the game. The
            setting `right` of the line protocol lists them all.
        format: Television standard, "ntsc", "pal", "pal60", "secam" or "auto". Default: that of the game.
        ystart: First line of the picture, 0 to 50. Default: that of the game.
        height: Lines of the picture, 100 to 256. Default: that of the game.
        two_player: Whether an action is a pair of indices for players A and B. `info` then has `reward_a`, which is
            also the reward, and `reward_b`.
        noop_max: Upper limit of the random number of NOOP frames that begin an episode: 0 to `noop_max` - 1.
        life_loss: Effect of a lost life. "ignored": none. "reported": the step is terminated; the episode continues.
            "end": the episode ends, and the next one continues the game, as in DQN. "restart": the episode ends, and
            the next one is a new game.
        life_loss_ends: Old word: a lost life truncates the episode, and the next one is a new game.
        reward_range: Pair (low, high) to which the reward of a step is clipped. (-inf, inf) overrides that of a preset.
        sound: Whether the window plays the sound.
        server: Address of the server that runs the game.
        token: Token that the server requires.
        timeout: Seconds to wait for each reply of the server. Default: no limit.
        **unknown: Other names are refused; the error suggests similar ones.

    Attributes:
        ale: The `ALEInterface` of the game.

    Raises:
        gymnasium.error.Error: If an argument is wrong; also a TypeError or a ValueError.
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If the game does not accept an argument, such as its mode.
        ConnectionError: If the server does not answer.

    All methods raise ClosedEnvironmentError after `close`. With a server, they also raise Refused, ConnectionError and
    TimeoutError, and RuntimeError in a child process after a fork.

    Examples:
        >>> import racebeam
        >>> env = racebeam.AtariEnv("beamfall")
        >>> observation, info = env.reset(seed=7)
        >>> observation.shape, info["lives"]
        ((210, 160, 3), 4)
        >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        >>> env.close()
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 30}
    _local_interface: type[ALEInterface] = ALEInterface
    _check_game = staticmethod(images.check_name)

    def __init__(
        self,
        game: str | None = None,
        mode: int | None = None,
        difficulty: int | None = None,
        obs_type: Literal["rgb", "grayscale", "ram"] = "rgb",
        frameskip: int | tuple[int, int] | None = None,
        repeat_action_probability: float | None = None,
        full_action_space: bool | Literal["console"] | None = None,
        continuous: bool = False,
        continuous_action_threshold: float = 0.5,
        max_num_frames_per_episode: int | None = None,
        render_mode: Literal["human", "rgb_array"] | None = None,
        sound_obs: bool | Literal["all"] = False,
        *,
        preset: str = "ale",
        rules: str = "ale-0.12",
        rom: Rom | None = None,
        game_file: str | os.PathLike[str] | None = None,
        scheme: str | None = None,
        left: str | None = None,
        right: str | None = None,
        format: str | None = None,
        ystart: int | None = None,
        height: int | None = None,
        two_player: bool = False,
        noop_max: int | None = None,
        life_loss: str | None = None,
        reward_range: tuple[float, float] | None = None,
        sound: bool = False,
        server: str | None = None,
        token: str | None = None,
        timeout: float | None = None,
        life_loss_ends: bool | None = None,
        **unknown: NoReturn,
    ) -> None:
        if unknown:
            check_names(unknown, [*inspect.signature(AtariEnv).parameters], "help(racebeam.AtariEnv)")
        defaults = preset_of(preset)
        check_rules(rules)
        check_choice("obs_type", obs_type, tuple(VIEWS))
        check_choice("render_mode", render_mode, RENDER_MODES)
        two_player, continuous = flag("two_player", two_player), flag("continuous", continuous)
        if two_player and continuous:
            raise WrongValue("two_player and continuous are both True; a game for two takes only indices of actions")
        self._game, self._rom, self._game_file = game, image(rom), path_of(game_file)
        check_source(game, self._rom, self._game_file, server)
        check_token(server, token)
        self._game_mode, self._game_difficulty = (
            optional_integer("mode", mode),
            optional_integer("difficulty", difficulty),
        )
        self._obs_type, self._view = obs_type, VIEWS[obs_type]
        self._frameskip = frameskip_of(value_or(frameskip, defaults.frameskip))
        self._noop_max = integer("noop_max", value_or(noop_max, defaults.noop_max), 0, MOST)
        self._reward_range: tuple[float, float] | None = value_or(reward_range, defaults.reward_range)
        self._two_player = two_player
        self.continuous = continuous
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        self.sound_obs = sound_flag("sound_obs", sound_obs)
        self.render_mode = render_mode
        self._sound = flag("sound", sound) and render_mode == "human"
        self._window = None
        self._is_closed = False
        self._was_reset = False
        self._name = str(game)
        check_reward_range(self._reward_range)
        sticky = share(
            "repeat_action_probability", value_or(repeat_action_probability, defaults.repeat_action_probability)
        )
        limit = optional_integer(
            "max_num_frames_per_episode", value_or(max_num_frames_per_episode, defaults.max_num_frames_per_episode)
        )
        truncates = flag(
            "life_loss_ends", value_or(accept_old_name("life_loss_ends", life_loss_ends, "life_loss", None), False)
        )
        word = value_or(life_loss, "ignored" if life_loss_ends is not None else defaults.life_loss)
        check_choice("life_loss", word, LIFE_LOSSES)
        self._life_loss = LifeLoss(word)
        actions = action_space("full_action_space", value_or(full_action_space, defaults.full_action_space))
        if continuous and actions == "console":
            raise WrongValue(
                "full_action_space is 'console'; with continuous, an action moves a joystick, not a switch"
            )
        if server is None and game is not None:
            self._check_game(game)
        self.ale: Any = self._interface(server, token, seconds("timeout", timeout))
        if isinstance(self.ale, RemoteInterface) and actions == "console":
            self.ale.action_set = actions
        self._set_keys(rules, sticky, limit, truncates or word == "restart")
        self._set_console(
            console_of(scheme=scheme, left=left, right=right, format=format),
            {"ystart": optional_integer("ystart", ystart), "height": optional_integer("height", height)},
        )
        self.seed_game()
        self.load_game()
        if warning := self.ale.image_warning():
            warn(warning)
        self._set_spaces(actions)
        self._open_window()

    def _interface(self, server: object, token: str | None, timeout: float | None) -> Any:
        if server is None:
            return self._local_interface()
        if not isinstance(server, str):
            raise WrongType(f"server is {server!r}; it takes the address of one server")
        return RemoteInterface(server, token, timeout)

    def __str__(self) -> str:
        name = self._name if self.spec is None else self.spec.id
        return f"<{type(self).__name__}<{name}>>"

    def __repr__(self) -> str:
        return f"{type(self).__name__}(game={self._name!r}, obs_type={self._obs_type!r}, frameskip={self._frameskip})"

    # Spaces

    def _set_spaces(self, actions: str) -> None:
        if actions == "console":
            left, right = self.ale.getControllers()
            self._action_set = [*Action, *ConsoleAction, *controller_actions(left)]
            self._actions_of_b = [*Action, *controller_actions(right)]
        else:
            is_full = actions == "legal" or self.continuous
            self._action_set = self.ale.getLegalActionSet() if is_full else self.ale.getMinimalActionSet()
            self._actions_of_b = self._action_set
        self.action_space = self._space_of_actions()
        self.observation_space = self._space_of_observations()

    # Playing

    def reset(  # type: ignore[override]  # a TypedDict is a dict at run time
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, AtariEnvStepMetadata]:
        """Begins an episode.

        The first call warns if a wrapper skips frames that are skipped already.

        Args:
            seed: Seed with which the console is powered on anew. Default: continue the random generators.
            options: Ignored.

        Returns:
            The observation, and the info. With a seed, the info has the `seeds` of `np_random` and of the game.

        Raises:
            gymnasium.error.Error: If `seed` is invalid.
        """
        self._check_open("reset()")
        if not self._was_reset:
            warn_of_second_skip(self, self._frameskip)
            self._was_reset = True
        seeds = None
        if seed is not None:
            seeds = self.seed_game(seed)
            self.load_game()
        if not (self._life_loss.continues and seed is None):
            self.ale.reset_game()
            self._play_noops()
        self._life_loss.continues = False
        self._show_window()
        info = self._get_info()
        if seeds is not None:
            info["seeds"] = seeds
        return self._get_obs(), info

    def _play_noops(self) -> None:
        """Plays the no-ops that begin an episode. If the episode ends meanwhile, begins another one without them."""
        frames = int(self.np_random.integers(self._noop_max)) if self._noop_max else 0
        if frames == 0:
            return
        _, _, _, terminated, truncated, *_ = self.ale.step(Action.NOOP.value, 1.0, frames, View.NONE)
        if terminated or truncated:
            self.ale.reset_game()

    def step(  # type: ignore[override]
        self, action: PlayerAction
    ) -> tuple[Observation, float, bool, bool, AtariEnvStepMetadata]:
        """Plays an action for the frames of a step, even past game over.

        Args:
            action: Index of an action; with `two_player`, a pair of indices; with `continuous`, a float32 array of
                shape (3,): the radius from 0 to 1, the angle in radians, and fire.

        Returns:
            The observation, the reward, terminated, truncated, and the info.

        Raises:
            TypeError: If the action has a wrong type.
            IndexError: If an index is out of range.
            AssertionError: If a continuous action is not a float32 array of shape (3,).
            InvalidInput: If a part of a continuous action is not finite.
        """
        self._check_open("step()")
        parsed = self._parse_action(action)
        frames = self._frameskip
        if isinstance(frames, tuple):
            frames = int(self.np_random.integers(*frames))
        play = self._play if self._window is None else self._play_in_window
        before = self._life_loss.lives_before(self.ale)
        seen, reward, reward_b, terminated, truncated, lives, episode_frame, frame = play(parsed, frames)
        ends = (terminated, truncated)
        terminated, truncated = self._life_loss.ends(self.ale, ends, before, lives, episode_frame)
        info: AtariEnvStepMetadata = {"lives": lives, "episode_frame_number": episode_frame, "frame_number": frame}
        reward = self._clip(reward)
        if self._two_player:
            info["reward_a"], info["reward_b"] = reward, self._clip(reward_b)
        return self._observation(seen), reward, terminated, truncated, info

    def _play(self, action: tuple[int, float, int, float], frames: int) -> StepResults:
        a, strength_a, b, strength_b = action
        results: StepResults = self.ale.step(a, strength_a, frames, self._view, b, strength_b)
        return results

    def _play_in_window(self, action: tuple[int, float, int, float], frames: int) -> StepResults:
        reward = reward_b = 0.0
        for _ in range(frames):
            seen, more, more_b, *after = self._play(action, 1)
            reward, reward_b = reward + more, reward_b + more_b
            self._show_window()
        return (seen, reward, reward_b, *after)

    def _clip(self, reward: float) -> float:
        if self._reward_range is None:
            return reward
        low, high = self._reward_range
        return float(min(max(reward, low), high))

    def _get_info(self) -> AtariEnvStepMetadata:
        return {
            "lives": self.ale.lives(),
            "episode_frame_number": self.ale.getEpisodeFrameNumber(),
            "frame_number": self.ale.getFrameNumber(),
        }

    # Copies, and the end

    def __getstate__(self) -> dict[str, Any]:
        """Returns the state of a copy, which continues where this game is, in the same window."""
        self._check_open("a copy")
        return {**self.__dict__, "_window": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._open_window()

    def close(self) -> None:
        """Closes the window, and the session with a server. A second call does nothing."""
        if self.__dict__.get("_is_closed", True):  # missing if the constructor failed
            return
        self._is_closed = True
        if self._window is not None:
            self._window.close()
            self._window = None
        if isinstance(self.ale, RemoteInterface):
            self.ale.close()
        self.ale = _Closed(self._name)


class _Closed:
    """Placeholder for the interface of a closed environment: any use raises ClosedEnvironmentError."""

    def __init__(self, game: str) -> None:
        self._game = game

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise closed_error(name, self._game)
