"""AtariEnv: one game as an environment of Gymnasium, in this process or on a server."""

from __future__ import annotations

import numbers
import operator
from typing import Any, Literal, TypedDict, Union

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
    either,
    flag,
    image,
    listed,
    real,
    seconds,
    share,
    whole,
)
from .errors import InvalidInput
from .interface import ALEInterface
from .presets import preset as preset_of
from .window import Window
from .wire.remote import RemoteInterface

Pixels = npt.NDArray[np.uint8]
Observation = Union[Pixels, dict[str, Pixels]]
PlayerAction = Any  # an index, a pair of them, or (radius, angle, fire)
Rom = Union[images.Rom, bytearray, memoryview]
Played = tuple[Any, float, float, bool, bool, int, int, int]  # what ALEInterface.step() returns

VIEWS = {"rgb": View.RGB, "grayscale": View.GRAYSCALE, "ram": View.RAM}
RULES = ("ale-0.12", "fixed")
RENDER_MODES = (None, "human", "rgb_array")
FIRST_OF_B = 18  # player B's actions have the numbers after A's
KEYS = (("UP", "w"), ("DOWN", "s"), ("RIGHT", "d"), ("LEFT", "a"), ("FIRE", " "))
KEY_OF_NOOP = "e"
SIDES = {-1: "LEFT", 0: "", 1: "RIGHT"}
HEIGHTS = {-1: "DOWN", 0: "", 1: "UP"}


class _Told(TypedDict):
    lives: int
    episode_frame_number: int
    frame_number: int


class AtariEnvStepMetadata(_Told, total=False):
    """The info of a step or a reset."""

    seeds: tuple[int, int]  # of a reset with a seed: of np_random, and of the game
    reward_a: float  # of a step for two players
    reward_b: float


class AtariEnv(gymnasium.Env[Any, Any]):
    """A game, the same as ale_py's AtariEnv: for the same seed, arguments and actions, the same bytes.

    game: its name, as racebeam.games() has it. mode, difficulty: None leaves the game's own.
    obs_type: "rgb" (height, 160, 3), "grayscale" (height, 160) or "ram" (128,), of uint8. With sound_obs, an
        observation is a dict of "image" and "sound", the 512 samples of the last frame.
    frameskip: frames of a step, or (low, high): each step draws low to high - 1. A step does not stop at a game's end.
    repeat_action_probability: of a frame, that it repeats the action before it.
    full_action_space: all 18 actions, and not those alone that have an effect in this game.
    continuous: an action is float32 (radius, angle, fire). A direction is pressed, and fire, where its part is more
        than continuous_action_threshold; the radius is the strength of a paddle. All 18 actions are used.
    max_num_frames_per_episode: the episode is truncated after them; 0: never.
    render_mode: "human" opens a window, at 60 frames a second; "rgb_array" lets render() return the picture. All games of a
        process share one window, which shows the one that played last.
    preset: of racebeam.presets. It says what frameskip, repeat_action_probability, full_action_space,
        max_num_frames_per_episode, noop_max, life_loss_ends and reward_range are where they are None.
    rules: "ale-0.12", or "fixed". rom: the image, a path or its bytes, of any type that holds bytes; None: the one that
        racebeam.find_image() finds.
    two_player: an action is a pair, for A and B; info has reward_a, which is also the reward, and reward_b.
    noop_max: an episode begins with 0 to noop_max - 1 frames of NOOP, drawn from np_random.
    life_loss_ends: a lost life truncates the episode.
    reward_range: (low, high): the reward of a step, of either player, is clipped; (-inf, inf) undoes a preset's.
    sound: the window plays the sound. server: the game runs there; token, timeout: as racebeam.connect() has them.

    A new environment has random seeds. reset(seed=S) powers the console on anew, with seeds that S gives; a reset
    without seed continues the generators. A copy, by copy.deepcopy or pickle, continues where the original is.

    Raises gymnasium.error.Error for a wrong argument or seed; UnknownGame, MissingImage, or InvalidInput for what the
    game does not accept; TypeError or IndexError for a wrong action, and AssertionError for a continuous one that is no
    float32 array of 3; ClosedEnvironmentError after close(). With a server: also Refused, ConnectionError and
    TimeoutError, and RuntimeError in a child process after a fork.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 30}
    _local_interface: type[ALEInterface] = ALEInterface
    _check_game = staticmethod(images.check_name)

    def __init__(
        self,
        game: str,
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
            raise WrongValue("two_player and continuous are both True; a game for two takes indices of actions alone")
        self._game, self._rom = game, image(rom)
        self._game_mode, self._game_difficulty = _optional("mode", mode), _optional("difficulty", difficulty)
        self._obs_type, self._view = obs_type, VIEWS[obs_type]
        self._frameskip = _frameskip(either(frameskip, usual.frameskip))
        self._noop_max = whole("noop_max", either(noop_max, usual.noop_max), 0, MOST)
        self._reward_range: tuple[float, float] | None = either(reward_range, usual.reward_range)
        self._two_player = two_player
        self.continuous = continuous
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        self.sound_obs = flag("sound_obs", sound_obs)
        self.render_mode = render_mode
        self._sound = flag("sound", sound) and render_mode == "human"
        self._window: Window | None = None
        self._is_closed = False
        _check_reward_range(self._reward_range)
        sticky = share("repeat_action_probability", either(repeat_action_probability, usual.repeat_action_probability))
        limit = _optional(
            "max_num_frames_per_episode", either(max_num_frames_per_episode, usual.max_num_frames_per_episode)
        )
        life_loss_ends = flag("life_loss_ends", either(life_loss_ends, usual.life_loss_ends))
        is_full = flag("full_action_space", either(full_action_space, usual.full_action_space))
        self._check_game(game)
        self.ale: Any = self._interface(server, token, seconds("timeout", timeout))
        self._set_keys(rules, sticky, limit, life_loss_ends)
        self.seed_game()
        self.load_game()
        self._set_spaces(is_full)
        self._open_window()

    def _interface(self, server: object, token: str | None, timeout: float | None) -> Any:
        if server is None:
            return self._local_interface()
        if not isinstance(server, str):
            raise WrongType(f"server is {server!r}; it takes the address of one server")
        return RemoteInterface(server, token, timeout)

    def _set_keys(self, rules: str, sticky: float, limit: int | None, life_loss_ends: bool) -> None:
        """The settings that take effect when the game is loaded."""
        self.ale.setString("rules", rules)
        self.ale.setFloat("repeat_action_probability", sticky)
        if limit is not None:
            self.ale.setInt("max_num_frames_per_episode", limit)
        self.ale.setBool("truncate_on_loss_of_life", life_loss_ends)
        self.ale.setBool("sound_obs", self.sound_obs or self._sound)

    # Seeds and images

    def seed_game(self, seed: int | None = None) -> tuple[int, int]:
        """Seeds np_random, and the game when it is loaded the next time. None: at random. Returns both seeds."""
        seeding.np_random(seed)  # raises Error for what is no seed
        of_steps, of_game = np.random.SeedSequence(seed).generate_state(2)
        self._np_random, _ = seeding.np_random(int(of_steps))
        self._np_random_seed = -1 if seed is None else seed
        self.ale.setInt("random_seed", int(of_game.astype(np.int32)))
        return of_steps, of_game

    def load_game(self) -> None:
        """Powers the console on, in the mode and the difficulty of the arguments."""
        if isinstance(self.ale, RemoteInterface):
            self.ale.loadROM(self._rom, self._game)
        else:
            self.ale.loadROM(images.find(self._game) if self._rom is None else self._rom, self._game)
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
                f"{self._game} has mode {self._game_mode} for two alone, which two_player=True plays; "
                f"for one it offers {listed(offered)}"
            )
        return self._game_mode

    def _mode_for_two(self) -> int:
        offered: list[int] = self.ale.getTwoPlayerModes()
        if not offered:
            raise InvalidInput(f"two_player is True, but {self._game} has no mode for two")
        if self._game_mode is None:
            return offered[0]
        if self._game_mode not in offered:
            raise InvalidInput(f"{self._game} has no mode {self._game_mode} for two; it offers {listed(offered)}")
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
        """Begins an episode; with a seed, the game from power-on. There are no options."""
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
        """An episode that ends meanwhile begins again, without them."""
        frames = int(self.np_random.integers(self._noop_max)) if self._noop_max else 0
        if frames == 0:
            return
        _, _, _, terminated, truncated, *_ = self.ale.step(Action.NOOP.value, 1.0, frames, View.NONE)
        if terminated or truncated:
            self.ale.reset_game()

    def step(  # type: ignore[override]
        self, action: PlayerAction
    ) -> tuple[Observation, float, bool, bool, AtariEnvStepMetadata]:
        """Plays an action for the frames of a step, all of them, also where the game ends before."""
        self._check_open("step()")
        meant = self._meant(action)
        frames = self._frameskip
        if isinstance(frames, tuple):
            frames = int(self.np_random.integers(*frames))
        play = self._play if self._window is None else self._play_in_window
        seen, reward, reward_b, terminated, truncated, lives, episode_frame, frame = play(meant, frames)
        info: AtariEnvStepMetadata = {"lives": lives, "episode_frame_number": episode_frame, "frame_number": frame}
        reward = self._clipped(reward)
        if self._two_player:
            info["reward_a"], info["reward_b"] = reward, self._clipped(reward_b)
        return self._observation(seen), reward, terminated, truncated, info

    def _play(self, action: tuple[int, float, int, float], frames: int) -> Played:
        a, strength_a, b, strength_b = action
        played: Played = self.ale.step(a, strength_a, frames, self._view, b, strength_b)
        return played

    def _play_in_window(self, action: tuple[int, float, int, float], frames: int) -> Played:
        reward = reward_b = 0.0
        for _ in range(frames):
            seen, more, more_b, *after = self._play(action, 1)
            reward, reward_b = reward + more, reward_b + more_b
            self._show_window()
        return (seen, reward, reward_b, *after)

    def _clipped(self, reward: float) -> float:
        if self._reward_range is None:
            return reward
        low, high = self._reward_range
        return float(min(max(reward, low), high))

    # Actions

    def _meant(self, action: PlayerAction) -> tuple[int, float, int, float]:
        """The number of A's action and the strength of its paddle, then B's."""
        if self.continuous:
            return (*self._of_continuous(action), FIRST_OF_B, 0.0)
        if not self._two_player:
            return self._number(action), 1.0, FIRST_OF_B, 0.0
        try:
            a, b = action
        except (TypeError, ValueError):
            raise TypeError(f"action is {action!r}; it must be a pair of indices, for players A and B") from None
        return self._number(a), 1.0, FIRST_OF_B + self._number(b), 1.0

    def _number(self, action: Any) -> int:
        try:
            index = operator.index(action)
        except TypeError:
            raise TypeError(f"action {action!r} has the type {type(action).__name__}; it must be an integer") from None
        if not 0 <= index < len(self._action_set):
            raise IndexError(f"action {index} is out of range; there are 0 to {len(self._action_set) - 1}")
        return self._action_set[index].value

    def _of_continuous(self, action: Any) -> tuple[int, float]:
        if not (isinstance(action, np.ndarray) and action.dtype == np.float32 and action.shape == (3,)):
            raise AssertionError(f"action is {action!r}; it must be a float32 array of 3: radius, angle and fire")
        if not np.isfinite(action).all():
            raise InvalidInput(f"action is {action!r}; each part must be a finite number")
        radius, angle, fire = action
        threshold = np.float32(self.continuous_action_threshold)  # the comparisons are those of float32
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        meant = self.map_action_idx(
            left_center_right=int(x > threshold) - int(x < -threshold),
            down_center_up=int(y > threshold) - int(y < -threshold),
            fire=bool(fire > threshold),
        )
        return meant.value, float(radius)

    @staticmethod
    def map_action_idx(left_center_right: int, down_center_up: int, fire: bool) -> Action:
        """The action of a stick that is at -1, 0 or 1 from left to right and from down to up."""
        if left_center_right not in SIDES or down_center_up not in HEIGHTS:
            raise LookupError(
                f"left_center_right is {left_center_right} and down_center_up is {down_center_up}; "
                "each must be -1, 0 or 1"
            )
        name = HEIGHTS[down_center_up] + SIDES[left_center_right] + ("FIRE" if flag("fire", fire) else "")
        return Action[name or "NOOP"]

    def get_action_meanings(self) -> list[str]:
        """The name of each action."""
        return [action.name for action in self._action_set]

    def get_keys_to_action(self) -> dict[tuple[str, ...], int]:
        """The index of each action by the keys that are held for it: w, a, s, d, space; e for none."""
        if self.continuous or self._two_player:
            setting = "continuous" if self.continuous else "two_player"
            raise AttributeError(
                f"`get_keys_to_action` can't be provided for this Atari environment as `{setting}=True`: keys are of one stick"
            )
        return {_keys_of(name): index for index, name in enumerate(self.get_action_meanings())}

    # What is seen and told

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
        """The picture, for "rgb_array"; None for "human", whose window shows it already."""
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
            self._window = Window(images.titles()[self._game], width, height, self._sound)

    def _show_window(self) -> None:
        if self._window is None:
            return
        self._window.show(self.ale.getScreenRGB())
        if self._sound:
            self._window.play(self.ale.getAudio())
        self._window.wait()

    # States, copies, the end

    def clone_state(self, include_rng: bool = False) -> ALEState:
        """The state of the game; with include_rng, also of the generator of sticky actions. Not that of np_random."""
        state: ALEState = self.ale.cloneState(include_rng=include_rng)
        return state

    def restore_state(self, state: ALEState) -> None:
        """Raises InvalidInput for a state of another game."""
        self.ale.restoreState(state)

    def __getstate__(self) -> dict[str, Any]:
        """The game as it is. A copy with render_mode "human" shows itself in the window, too."""
        self._check_open("a copy")
        return {**self.__dict__, "_window": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._open_window()

    def close(self) -> None:
        """Closes the window, and the session with a server. A second call does nothing."""
        if self.__dict__.get("_is_closed", True):  # there is none where the constructor failed
            return
        self._is_closed = True
        if self._window is not None:
            self._window.close()
            self._window = None
        if isinstance(self.ale, RemoteInterface):
            self.ale.close()
        self.ale = _Closed(self._game)

    def _check_open(self, what: str) -> None:
        if self._is_closed:
            raise _closed(what, self._game)


class _Closed:
    """In the place of the interface of an environment that was closed."""

    def __init__(self, game: str) -> None:
        self._game = game

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise _closed(name, self._game)


def _closed(what: str, game: str) -> error.ClosedEnvironmentError:
    return error.ClosedEnvironmentError(f"{what} is not possible: this environment of {game} was closed")


def _keys_of(action: str) -> tuple[str, ...]:
    return tuple(key for part, key in KEYS if part in action) or (KEY_OF_NOOP,)


def _check_rules(rules: object) -> None:
    if not isinstance(rules, str) or rules not in RULES:
        raise InvalidInput(f"rules is {rules!r}; it takes {' or '.join(RULES)}")


def _optional(name: str, value: Any) -> int | None:
    return None if value is None else whole(name, value, 0, MOST)


def _is_whole(value: object) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def _frameskip(given: Any) -> int | tuple[int, int]:
    """Checked, in Python's own ints."""
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
