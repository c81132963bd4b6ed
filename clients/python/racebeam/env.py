"""AtariEnv: one game as an environment of Gymnasium, in this process or on a server."""

from __future__ import annotations

import numbers
import operator
import os
from typing import Any, Literal, TypeAlias, TypedDict

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import error, spaces
from gymnasium.utils import seeding

from . import images
from ._core import Action, ALEState, View
from .arguments import (
    MOST,
    WrongType,
    WrongValue,
    check_choice,
    check_source,
    console_of,
    flag,
    image,
    join,
    optional_whole,
    path_of,
    real,
    seconds,
    share,
    value_or,
    warn_of,
    whole,
)
from .errors import InvalidInput
from .interface import ALEInterface
from .presets import preset as preset_of
from .window import Window
from .wire.remote import RemoteInterface

__all__ = ["AtariEnv", "AtariEnvStepMetadata"]

Pixels: TypeAlias = npt.NDArray[np.uint8]
Observation: TypeAlias = Pixels | dict[str, Pixels]
PlayerAction: TypeAlias = Any  # an index, a pair of indices, or (radius, angle, fire)
Rom: TypeAlias = images.Rom | bytearray | memoryview
# What ALEInterface.step() returns: observation, rewards of A and B, ends, lives, and frame numbers.
StepResults: TypeAlias = tuple[Any, float, float, bool, bool, int, int, int]

VIEWS = {"rgb": View.RGB, "grayscale": View.GRAYSCALE, "ram": View.RAM}
RULES = ("ale-0.12", "fixed")
RENDER_MODES = (None, "human", "rgb_array")
FIRST_OF_B = 18  # player B's actions have the numbers after A's
KEYS = (("UP", "w"), ("DOWN", "s"), ("RIGHT", "d"), ("LEFT", "a"), ("FIRE", " "))
KEY_OF_NOOP = "e"
SIDES = {-1: "LEFT", 0: "", 1: "RIGHT"}
HEIGHTS = {-1: "DOWN", 0: "", 1: "UP"}


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


class AtariEnv(gymnasium.Env[Any, Any]):
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
        continuous: Whether an action is a float32 array (radius, angle, fire) instead of an index. The radius is also
            the strength of a paddle. Selects all 18 actions.
        continuous_action_threshold: Deflection from which a direction or the button counts as pressed.
        max_num_frames_per_episode: Frames after which an episode is truncated; 0 for no limit.
        render_mode: "human" opens a window at 60 frames per second, or "rgb_array" makes `render` return the screen.
            All games of a process share one window, which shows the game that was stepped last.
        sound_obs: Whether an observation is a dict of "image" and "sound", the 512 samples of the last frame.
        preset: Name of a preset of `racebeam.presets`. It supplies `frameskip`, `repeat_action_probability`,
            `full_action_space`, `max_num_frames_per_episode`, `noop_max`, `life_loss_ends` and `reward_range` where
            they are None.
        rules: "ale-0.12" for the rewards and ends of ALE 0.12, or "fixed" for corrected ones.
        rom: Path or bytes of the cartridge image. Default: the image that `racebeam.find_image` finds.
        game_file: Path of a game file with the rules of `rom`, instead of `game`. Without both, the image decides; an
            unknown one has no score.
        scheme: Cartridge scheme of the image, such as "F8", or "auto". Default: that of the game.
        left: Controller in the left port, "joystick" or "paddles". Default: that of the game.
        right: Controller in the right port, "joystick" or "paddles". Default: that of the game.
        format: Television standard, "ntsc", "pal", "pal60", "secam" or "auto". Default: that of the game.
        ystart: First line of the picture, 0 to 50. Default: that of the game.
        height: Lines of the picture, 100 to 256. Default: that of the game.
        two_player: Whether an action is a pair of indices for players A and B. `info` then has `reward_a`, which is
            also the reward, and `reward_b`.
        noop_max: Upper limit of the random number of NOOP frames that begin an episode: 0 to `noop_max` - 1.
        life_loss_ends: Whether a lost life truncates the episode.
        reward_range: Pair (low, high) to which the reward of a step is clipped. (-inf, inf) overrides that of a preset.
        sound: Whether the window plays the sound.
        server: Address of the server that runs the game.
        token: Token that the server asks for.
        timeout: Seconds to wait for each reply of the server. Default: no limit.

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

    Example:
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
        full_action_space: bool | None = None,
        continuous: bool = False,
        continuous_action_threshold: float = 0.5,
        max_num_frames_per_episode: int | None = None,
        render_mode: Literal["human", "rgb_array"] | None = None,
        sound_obs: bool = False,
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
        life_loss_ends: bool | None = None,
        reward_range: tuple[float, float] | None = None,
        sound: bool = False,
        server: str | None = None,
        token: str | None = None,
        timeout: float | None = None,
    ) -> None:
        usual = preset_of(preset)
        _check_rules(rules)
        check_choice("obs_type", obs_type, tuple(VIEWS))
        check_choice("render_mode", render_mode, RENDER_MODES)
        two_player, continuous = flag("two_player", two_player), flag("continuous", continuous)
        if two_player and continuous:
            raise WrongValue("two_player and continuous are both True; a game for two takes only indices of actions")
        self._game, self._rom, self._game_file = game, image(rom), path_of(game_file)
        check_source(game, self._rom, self._game_file, server)
        self._game_mode, self._game_difficulty = optional_whole("mode", mode), optional_whole("difficulty", difficulty)
        self._obs_type, self._view = obs_type, VIEWS[obs_type]
        self._frameskip = _frameskip(value_or(frameskip, usual.frameskip))
        self._noop_max = whole("noop_max", value_or(noop_max, usual.noop_max), 0, MOST)
        self._reward_range: tuple[float, float] | None = value_or(reward_range, usual.reward_range)
        self._two_player = two_player
        self.continuous = continuous
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        self.sound_obs = flag("sound_obs", sound_obs)
        self.render_mode = render_mode
        self._sound = flag("sound", sound) and render_mode == "human"
        self._window: Window | None = None
        self._is_closed = False
        self._name = str(game)
        _check_reward_range(self._reward_range)
        sticky = share(
            "repeat_action_probability", value_or(repeat_action_probability, usual.repeat_action_probability)
        )
        limit = optional_whole(
            "max_num_frames_per_episode", value_or(max_num_frames_per_episode, usual.max_num_frames_per_episode)
        )
        life_loss_ends = flag("life_loss_ends", value_or(life_loss_ends, usual.life_loss_ends))
        is_full = flag("full_action_space", value_or(full_action_space, usual.full_action_space))
        if server is None and game is not None:
            self._check_game(game)
        self.ale: Any = self._interface(server, token, seconds("timeout", timeout))
        self._set_keys(rules, sticky, limit, life_loss_ends)
        self._set_console(
            console_of(scheme=scheme, left=left, right=right, format=format),
            {"ystart": optional_whole("ystart", ystart), "height": optional_whole("height", height)},
        )
        self.seed_game()
        self.load_game()
        warn_of(list(filter(None, [self.ale.doubt()])))
        self._set_spaces(is_full)
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

    def _set_keys(self, rules: str, sticky: float, limit: int | None, life_loss_ends: bool) -> None:
        """Sets what takes effect when the game is loaded."""
        self.ale.setString("rules", rules)
        self.ale.setFloat("repeat_action_probability", sticky)
        if limit is not None:
            self.ale.setInt("max_num_frames_per_episode", limit)
        self.ale.setBool("truncate_on_loss_of_life", life_loss_ends)
        self.ale.setBool("sound_obs", self.sound_obs or self._sound)

    def _set_console(self, words: dict[str, str], numbers: dict[str, int | None]) -> None:
        """Sets what the console must know of your own image."""
        self.ale.setString("game_file", self._game_file or "")
        self.ale.setBool("unknown_images", self._game is None)
        for key, word in words.items():
            self.ale.setString(key, word)
        for key, number in numbers.items():
            if number is not None:
                self.ale.setInt(key, number)

    # Seeds and images

    def seed_game(self, seed: int | None = None) -> tuple[int, int]:
        """Seeds `np_random`, and the game from its next `load_game` on.

        Args:
            seed: Seed from 0, or None for a random one.

        Returns:
            The seeds of `np_random` and of the game, uint32.

        Raises:
            gymnasium.error.Error: If `seed` is invalid.
        """
        seeding.np_random(seed)  # raises Error if `seed` is invalid
        step_seed, game_seed = np.random.SeedSequence(seed).generate_state(2)
        self._np_random, _ = seeding.np_random(int(step_seed))
        self._np_random_seed = -1 if seed is None else seed
        self.ale.setInt("random_seed", int(game_seed.astype(np.int32)))
        return step_seed, game_seed

    def load_game(self) -> None:
        """Powers the console on, with the mode and the difficulty of the constructor.

        Raises:
            InvalidInput: If the game does not have the mode or the difficulty.
        """
        if isinstance(self.ale, RemoteInterface):
            self.ale.loadROM(self._rom, self._game)
        else:
            rom = images.find(str(self._game)) if self._rom is None else self._rom
            self.ale.loadROM(rom, self._game)
        if self._game is None:
            self._name = str(self.ale.getGame())
        mode = self._mode_for_two() if self._two_player else self._mode_for_one()
        if mode is not None:
            self.ale.setMode(mode)
        if self._game_difficulty is not None:
            self.ale.setDifficulty(self._game_difficulty)

    def _mode_for_one(self) -> int | None:
        offered: list[int] = self.ale.getAvailableModes()
        if (
            self._game_mode is not None
            and self._game_mode in self.ale.getTwoPlayerModes()
            and self._game_mode not in offered
        ):
            raise InvalidInput(
                f"{self._name} has mode {self._game_mode} only for two, which two_player=True plays; "
                f"for one it offers {join(offered)}"
            )
        return self._game_mode

    def _mode_for_two(self) -> int:
        offered: list[int] = self.ale.getTwoPlayerModes()
        if not offered:
            raise InvalidInput(f"two_player is True, but {self._name} has no mode for two")
        if self._game_mode is None:
            return offered[0]
        if self._game_mode not in offered:
            raise InvalidInput(f"{self._name} has no mode {self._game_mode} for two; it offers {join(offered)}")
        return self._game_mode

    # Spaces

    def _set_spaces(self, full: bool) -> None:
        is_full = full or self.continuous
        self._action_set: list[Action] = self.ale.getLegalActionSet() if is_full else self.ale.getMinimalActionSet()
        self.action_space = self._space_of_actions()
        self.observation_space = self._space_of_observations()

    def _space_of_actions(self) -> spaces.Space[Any]:
        count = len(self._action_set)
        if self.continuous:
            low, high = np.array([0, -np.pi, 0], np.float32), np.array([1, np.pi, 1], np.float32)
            return spaces.Box(low, high, (3,), np.float32)
        return spaces.MultiDiscrete([count, count]) if self._two_player else spaces.Discrete(count)

    def _space_of_observations(self) -> spaces.Space[Any]:
        height, width = self.ale.getScreenDims()
        shape = {View.RGB: (height, width, 3), View.GRAYSCALE: (height, width), View.RAM: (self.ale.getRAMSize(),)}
        image = spaces.Box(0, 255, shape[self._view], np.uint8)
        if not self.sound_obs:
            return image
        return spaces.Dict({"image": image, "sound": spaces.Box(0, 255, (self.ale.getAudioSize(),), np.uint8)})

    # Playing

    def reset(  # type: ignore[override]  # a TypedDict is a dict at run time
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, AtariEnvStepMetadata]:
        """Begins an episode.

        Args:
            seed: Seed with which the console is powered on anew. Default: continue the random generators.
            options: Ignored.

        Returns:
            The observation, and the info. With a seed, the info has the `seeds` of `np_random` and of the game.

        Raises:
            gymnasium.error.Error: If `seed` is invalid.
        """
        self._check_open("reset()")
        seeds = None
        if seed is not None:
            seeds = self.seed_game(seed)
            self.load_game()
        self.ale.reset_game()
        self._play_noops()
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
        seen, reward, reward_b, terminated, truncated, lives, episode_frame, frame = play(parsed, frames)
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

    # Actions

    def _parse_action(self, action: PlayerAction) -> tuple[int, float, int, float]:
        """Returns the number of A's action and the strength of its paddle, then those of B."""
        if self.continuous:
            return (*self._parse_continuous(action), FIRST_OF_B, 0.0)
        if not self._two_player:
            return self._look_up(action), 1.0, FIRST_OF_B, 0.0
        try:
            a, b = action
        except (TypeError, ValueError):
            raise TypeError(f"action is {action!r}; it must be a pair of indices, for players A and B") from None
        return self._look_up(a), 1.0, FIRST_OF_B + self._look_up(b), 1.0

    def _look_up(self, action: Any) -> int:
        try:
            index = operator.index(action)
        except TypeError:
            raise TypeError(f"action {action!r} has the type {type(action).__name__}; it must be an integer") from None
        if not 0 <= index < len(self._action_set):
            raise IndexError(f"action {index} is out of range; there are 0 to {len(self._action_set) - 1}")
        return self._action_set[index].value

    def _parse_continuous(self, action: Any) -> tuple[int, float]:
        if not (isinstance(action, np.ndarray) and action.dtype == np.float32 and action.shape == (3,)):
            raise AssertionError(f"action is {action!r}; it must be a float32 array of 3: radius, angle and fire")
        if not np.isfinite(action).all():
            raise InvalidInput(f"action is {action!r}; each part must be a finite number")
        radius, angle, fire = action
        threshold = np.float32(self.continuous_action_threshold)  # the comparisons are those of float32
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        chosen = self.map_action_idx(
            left_center_right=int(x > threshold) - int(x < -threshold),
            down_center_up=int(y > threshold) - int(y < -threshold),
            fire=bool(fire > threshold),
        )
        return chosen.value, float(radius)

    @staticmethod
    def map_action_idx(left_center_right: int, down_center_up: int, fire: bool) -> Action:
        """Converts the position of a joystick to an action.

        Args:
            left_center_right: -1 for left, 0 for the centre, 1 for right.
            down_center_up: -1 for down, 0 for the centre, 1 for up.
            fire: Whether the button is pressed.

        Returns:
            The action.

        Raises:
            LookupError: If a position is not -1, 0 or 1.
        """
        if left_center_right not in SIDES or down_center_up not in HEIGHTS:
            raise LookupError(
                f"left_center_right is {left_center_right} and down_center_up is {down_center_up}; "
                "each must be -1, 0 or 1"
            )
        name = HEIGHTS[down_center_up] + SIDES[left_center_right] + ("FIRE" if flag("fire", fire) else "")
        return Action[name or "NOOP"]

    def get_action_meanings(self) -> list[str]:
        """Returns the names of the actions in the order of their indices, such as ["NOOP", "FIRE"]."""
        return [action.name for action in self._action_set]

    def get_keys_to_action(self) -> dict[tuple[str, ...], int]:
        """Maps the keys that a player holds to actions.

        Returns:
            The index of an action by the keys w, a, s, d and space that are held; e is for NOOP.

        Raises:
            AttributeError: With `continuous` or `two_player`.
        """
        if self.continuous or self._two_player:
            setting = "continuous" if self.continuous else "two_player"
            raise AttributeError(
                f"`get_keys_to_action` can't be provided for this Atari environment as `{setting}=True`: "
                "keys move one joystick"
            )
        return {_keys_of(name): index for index, name in enumerate(self.get_action_meanings())}

    # Observations

    def _observation(self, image: Pixels) -> Observation:
        return {"image": image, "sound": self.ale.getAudio()} if self.sound_obs else image

    def _get_obs(self) -> Observation:
        show = {View.RGB: self.ale.getScreenRGB, View.GRAYSCALE: self.ale.getScreenGrayscale, View.RAM: self.ale.getRAM}
        return self._observation(show[self._view]())

    def _get_info(self) -> AtariEnvStepMetadata:
        return {
            "lives": self.ale.lives(),
            "episode_frame_number": self.ale.getEpisodeFrameNumber(),
            "frame_number": self.ale.getFrameNumber(),
        }

    def render(self) -> Pixels | None:
        """Returns the screen.

        Returns:
            uint8 array of shape (height, 160, 3) if `render_mode` is "rgb_array"; None if it is "human", since the
            window shows the screen already.

        Raises:
            gymnasium.error.Error: If `render_mode` is None.
        """
        self._check_open("render()")
        if self.render_mode == "human":
            return None
        if self.render_mode != "rgb_array":
            raise error.Error(
                f"render_mode is {self.render_mode!r}, so render() shows nothing; make the environment "
                "with render_mode human or rgb_array"
            )
        picture: Pixels = self.ale.getScreenRGB()
        return picture

    def _open_window(self) -> None:
        if self.render_mode == "human":
            height, width = self.ale.getScreenDims()
            self._window = Window(images.titles().get(self._name, self._name), width, height, self._sound)

    def _show_window(self) -> None:
        if self._window is None:
            return
        self._window.show(self.ale.getScreenRGB())
        if self._sound:
            self._window.play(self.ale.getAudio())
        self._window.wait()

    # States, copies, the end

    def clone_state(self, include_rng: bool = False) -> ALEState:
        """Saves the state of the game, without `np_random`.

        Args:
            include_rng: Whether the state has the generator of sticky actions.

        Returns:
            A state that can be pickled, and restored in another process.
        """
        state: ALEState = self.ale.cloneState(include_rng=include_rng)
        return state

    def restore_state(self, state: ALEState) -> None:
        """Restores a state of the game.

        Args:
            state: A state that `clone_state` returned.

        Raises:
            InvalidInput: If the state belongs to another game.
        """
        self.ale.restoreState(state)

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

    def _check_open(self, what: str) -> None:
        if self._is_closed:
            raise _closed_error(what, self._name)


class _Closed:
    """Placeholder for the interface of a closed environment: any use raises ClosedEnvironmentError."""

    def __init__(self, game: str) -> None:
        self._game = game

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise _closed_error(name, self._game)


def _closed_error(what: str, game: str) -> error.ClosedEnvironmentError:
    return error.ClosedEnvironmentError(f"{what} is not possible: this environment of {game} was closed")


def _keys_of(action: str) -> tuple[str, ...]:
    return tuple(key for part, key in KEYS if part in action) or (KEY_OF_NOOP,)


def _check_rules(rules: object) -> None:
    if not isinstance(rules, str) or rules not in RULES:
        raise InvalidInput(f"rules is {rules!r}; it takes {' or '.join(RULES)}")


def _is_whole(value: object) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def _frameskip(given: Any) -> int | tuple[int, int]:
    """Checks a frameskip, and converts its numbers to int."""
    accepted = f"it takes an int from 1 to {MOST}, or a tuple (low, high) of such ints with low < high"
    if not isinstance(given, tuple) and not _is_whole(given):
        raise WrongType(f"frameskip has the type {type(given).__name__}; {accepted}")
    ends = given if isinstance(given, tuple) else (given, MOST + 1)
    if not all(map(_is_whole, ends)):
        raise WrongType(f"frameskip is {given}; {accepted}")
    if not (len(ends) == 2 and 0 < ends[0] < ends[1] <= MOST + (ends is not given)):
        raise WrongValue(f"frameskip is {given}; {accepted}")
    return (int(ends[0]), int(ends[1])) if ends is given else int(given)


def _check_reward_range(reward_range: object) -> None:
    if reward_range is None:
        return
    sentence = f"reward_range is {reward_range!r}; it takes None, or two numbers (low, high), low <= high"
    if not isinstance(reward_range, (tuple, list)) or not all(isinstance(end, numbers.Real) for end in reward_range):
        raise WrongType(sentence)
    if len(reward_range) != 2 or not reward_range[0] <= reward_range[1]:  # as with NaN
        raise WrongValue(sentence)
