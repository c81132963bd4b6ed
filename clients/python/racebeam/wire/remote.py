"""ALEInterface of a game that runs on a server, with the same results, over the line protocol."""

from __future__ import annotations

import contextlib
import copy
import functools
import os
import pathlib
import struct
import threading
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt

from .. import images
from .._core import Action, ALEState, View
from ..errors import InvalidInput, MissingImage, UnknownGame
from ..interface import ALEInterface, png
from .messages import Refused
from .opening import connect
from .session import Session

Pixels = npt.NDArray[np.uint8]
Method = TypeVar("Method", bound=Callable[..., Any])

STATE = "racebeam-env"  # the name under which states pass through the session
STATE_HEAD = struct.Struct("<8s4i")  # what ALEState.serialize() has before the server's bytes
NO_LIMITS = {-(2**31): "none", 2**31 - 1: "none"}
MOST_AHEAD = 64  # requests whose replies fit into what a connection buffers
ALWAYS = ("reward", "reward_b", "ends", "lives", "episode_frame", "frame", "acts")
FIELDS = {
    View.RGB: ("screen:delta",),
    View.GRAYSCALE: ("screen:delta",),
    View.PALETTE: ("screen:delta",),
    View.RAM: ("ram:hex",),
    View.NONE: (),
}
OWN_ERRORS = {
    "unknown-game": UnknownGame,
    "bad-value": InvalidInput,
    "bad-image": InvalidInput,
    "bad-state": InvalidInput,
    "bad-action": InvalidInput,
    "no-game": InvalidInput,
}


def _exclusive(method: Method) -> Method:
    """Makes threads take turns. Aborts the session if a call leaves a request unanswered."""

    @functools.wraps(method)
    def call(self: RemoteInterface, *words: Any, **settings: Any) -> Any:
        self.session.check_process()  # after a fork, a thread that the child lacks may hold the lock
        with self.turn:
            try:
                return method(self, *words, **settings)
            except BaseException:
                if self.session.unanswered:
                    self.session.abort()
                raise

    return cast(Method, call)


def _check_types(method: Method) -> Method:
    """Makes a method raise the TypeError of the method of ALEInterface, which checks types before it needs a game."""

    @functools.wraps(method)
    def call(self: RemoteInterface, *words: Any, **settings: Any) -> Any:
        with contextlib.suppress(InvalidInput):  # that interface has no game
            getattr(self._keys, method.__name__)(*words, **settings)
        return method(self, *words, **settings)

    return cast(Method, call)


class RemoteInterface:
    """One game on a server, with the methods of `racebeam.ALEInterface`.

    The interface keeps the settings, and sends them when it loads an image. If the server lacks the image, the
    interface sends it. Threads take turns; only `close` interrupts the call of another thread.

    Every method raises what the method of ALEInterface raises. It also raises ConnectionError if the server is gone,
    TimeoutError if it does not answer in time, RuntimeError in a child process after a fork, and Refused for a limit of
    the server.

    Args:
        server: Address of the server, as `racebeam.connect` takes it.
        token: Token that the server asks for, or None.
        timeout: Seconds to wait for each reply, or None for no limit.

    Attributes:
        session: The session with the server.
        turn: The lock of the thread that uses the session.

    Raises:
        ConnectionError: If no server answers.
        TimeoutError: If no server answers in time.
    """

    def __init__(self, server: str, token: str | None = None, timeout: float | None = None) -> None:
        self._server, self._token, self._timeout = server, token, timeout
        self._keys = ALEInterface()
        self.turn = threading.RLock()
        try:
            self.session: Session = connect(server, token=token, timeout=timeout)
        except OSError as error:
            kind = TimeoutError if isinstance(error, TimeoutError) else ConnectionError
            raise kind(error.strerror or str(error)) from error
        self._view: View | None = None
        self._colours = np.zeros((256, 3), np.uint8)
        self._greys = np.zeros(256, np.uint8)
        self._loaded: tuple[Any, str | None, dict[str, object]] | None = None

    def __getattr__(self, name: str) -> Any:
        if name.startswith(
            ("getInt", "getBool", "getFloat", "getString", "setInt", "setBool", "setFloat", "setString")
        ):
            return getattr(self._keys, name)
        raise AttributeError(f"RemoteInterface has no attribute {name!r}")

    @_exclusive
    def ask(self, method: Any, *words: Any, **settings: Any) -> Any:
        """Calls a method of the session.

        Args:
            method: The method.
            *words: Its arguments.
            **settings: Its keyword arguments.

        Returns:
            What the method returns.

        Raises:
            InvalidInput: If the server refuses the request.
        """
        try:
            return method(*words, **settings)
        except Refused as refused:
            raise OWN_ERRORS.get(refused.code, InvalidInput)(f"{self._server}: {refused.sentence}") from refused

    def _look(self, *fields: str) -> dict[str, Any]:
        values: dict[str, Any] = self.ask(self.session.look, *fields)
        return values

    def close(self) -> None:
        """Ends the session."""
        self.session.close_connection()

    isSupportedROM = staticmethod(ALEInterface.isSupportedROM)
    setLoggerMode = staticmethod(ALEInterface.setLoggerMode)

    # The game

    def _settings(self) -> dict[str, object]:
        keys = self._keys
        limits = {side: keys.getInt(side) for side in ("reward_min", "reward_max")}
        return {
            "seed": keys.getInt("random_seed") % 2**32,
            "system_seed": keys.getInt("system_random_seed") % 2**32,
            "frame_skip": max(keys.getInt("frame_skip"), 1),
            "sticky": keys.getFloat("repeat_action_probability"),
            "max_episode_frames": keys.getInt("max_num_frames_per_episode"),
            "life_loss_ends": int(keys.getBool("truncate_on_loss_of_life")),
            "rules": keys.getString("rules"),
            "color_averaging": int(keys.getBool("color_averaging")),
            "sound": int(keys.getBool("sound_obs")),
            **{key: keys.getString(key) for key in ("scheme", "left", "right", "format") if keys.getString(key)},
            **{key: keys.getInt(key) for key in ("ystart", "height") if keys.getInt(key) != -1},
            **{side: NO_LIMITS.get(limit, limit) for side, limit in limits.items()},
        }

    @_exclusive
    def loadROM(self, rom: Any = None, game: str | None = None) -> None:
        """Inserts a cartridge and powers the machine on, with the settings that were made before.

        Args:
            rom: Path or bytes of the image to send, or None for the server's own image of `game`.
            game: Name of the game whose rules apply, or None to identify the image.

        Raises:
            MissingImage: If neither the server nor this computer has an image.
            InvalidInput: If the image cannot be read, or is unknown and `game` is None.
        """
        self.load(rom, game, self._settings())

    @_exclusive
    def load(self, rom: Any, game: str | None, settings: dict[str, object]) -> None:
        """Loads an image as `loadROM` does, with the settings of the line protocol.

        Args:
            rom: Path or bytes of the image to send, or None for the server's own image of `game`.
            game: Name of the game whose rules apply, or None to identify the image.
            settings: Settings of `load` of the line protocol.

        Raises:
            MissingImage: If neither the server nor this computer has an image.
            InvalidInput: If the image cannot be read, or is unknown and `game` is None.
        """
        self._view = None
        if rom is None:
            rom = self._image_to_send(game)
        if rom is None:
            self.ask(self.session.load, game, **settings)
        else:
            named = {"as_": game} if game is not None else {}
            self.ask(self.session.load, "inline", image=_read_image(rom), **named, **settings)
        self._loaded = rom, game, settings
        self._colours = np.array(self.session.palette(), np.uint8)
        self._greys = np.append(self._colours[1:, 2], np.uint8(0))  # the blue of the entry after it

    def _image_to_send(self, game: str | None) -> str | None:
        """Returns the path of an image, or None if the server has one."""
        try:
            is_here = int(self.session.game(str(game))["here"]) == 1
        except Refused:
            images.check_name(str(game))
            raise
        if is_here:
            return None
        try:
            return images.find(str(game))
        except MissingImage as missing:
            raise MissingImage(f"{self._server} has no image of {game}, and here {missing}") from missing

    @_exclusive
    def getGame(self) -> str:
        """Returns the name of the game."""
        return str(self.ask(self.session.settings)["game"])

    @_exclusive
    def doubt(self) -> str:
        """Returns a warning if the game's rule was written for another image, else an empty string."""
        shown = self.ask(self.session.settings)
        if shown.get("image") != "other":
            return ""
        return (
            f"the MD5 of this image, {shown['md5']}, is not that of the image which the rule of '{shown['game']}' was "
            "written for; score and end may be wrong"
        )

    def _list(self, key: str, command: str) -> list[int]:
        return [int(number) for number in self.ask(self.session.list_of, key, command)]

    def _actions(self, key: str) -> list[Action]:
        return [Action(number) for number in self._list(key, "actions")]

    @_exclusive
    def getLegalActionSet(self) -> list[Action]:
        """Returns all 18 actions."""
        return self._actions("legal")

    @_exclusive
    def getMinimalActionSet(self) -> list[Action]:
        """Returns the actions that have an effect in the game."""
        return self._actions("minimal")

    @_exclusive
    def getAvailableModes(self) -> list[int]:
        """Returns the modes for one player."""
        return self._list("modes", "modes")

    @_exclusive
    def getTwoPlayerModes(self) -> list[int]:
        """Returns the modes for two players."""
        return self._list("two_player_modes", "modes")

    @_exclusive
    def getAvailableDifficulties(self) -> list[int]:
        """Returns the difficulties of the game."""
        return self._list("difficulties", "difficulties")

    @_exclusive
    def getMode(self) -> int:
        """Returns the present mode."""
        return int(self.ask(self.session.values, "modes")["mode"])

    @_exclusive
    def getDifficulty(self) -> int:
        """Returns the present difficulty."""
        return int(self.ask(self.session.values, "difficulties")["difficulty"])

    @_exclusive
    @_check_types
    def setMode(self, mode: int) -> None:
        """Selects a mode, which begins a new episode.

        Args:
            mode: One of the modes of the game.

        Raises:
            InvalidInput: If the game does not have the mode.
        """
        self.ask(self.session.set, mode=int(mode))

    @_exclusive
    @_check_types
    def setDifficulty(self, difficulty: int) -> None:
        """Selects a difficulty, which begins a new episode.

        Args:
            difficulty: One of the difficulties of the game.

        Raises:
            InvalidInput: If the game does not have the difficulty.
        """
        self.ask(self.session.set, difficulty=int(difficulty))

    # Playing

    def _observe(self, view: View) -> None:
        if view is not self._view:
            self.ask(self.session.observe, *ALWAYS, *FIELDS[view])
            self._view = view

    @_exclusive
    @_check_types
    def step(
        self,
        action: int,
        paddle_strength: float,
        times: int,
        view: View,
        action_b: int = 18,
        paddle_strength_b: float = 0.0,
    ) -> tuple[Any, float, float, bool, bool, int, int, int]:
        """Plays an action several times.

        Args:
            action: Number of player A's action.
            paddle_strength: How far A's paddle is turned, 0 to 1.
            times: How often the action is played.
            view: What is observed at the end.
            action_b: Number of player B's action, which are those from 18.
            paddle_strength_b: How far B's paddle is turned, 0 to 1.

        Returns:
            The observation, the rewards of A and B, terminated, truncated, lives, and the frames since the episode and
            the game began.
        """
        view = View(view)
        self._observe(view)
        word = f"{int(action)}@{float(paddle_strength):.9g}/{int(action_b) - 18}@{float(paddle_strength_b):.9g}"
        shown = self.ask(self.session.act, f"{word}*{int(times)}")
        self._act_after_the_end(word, times - max(shown["acts"], 1))
        return (
            self._decode(shown, view),
            float(shown["reward"]),
            float(shown["reward_b"]),
            bool(shown["terminated"]),
            bool(shown["truncated"]),
            shown["lives"],
            shown["episode_frame"],
            shown["frame"],
        )

    def _act_after_the_end(self, word: str, acts: int) -> None:
        """Sends the acts after the end of the game, which run no frame, but advance the generator of sticky actions.

        The server plays one of them per request, and stops reading while its replies are not read.
        """
        while acts > 0:
            burst = min(acts, MOST_AHEAD)
            for _ in range(burst):
                self.session.send("act", word)
            for _ in range(burst):
                self.session.receive_values()
            acts -= burst

    @_exclusive
    @_check_types
    def act(self, action: int | Action, paddle_strength: float = 1.0) -> int:
        """Plays an action, and returns its reward.

        Args:
            action: The action or its number.
            paddle_strength: How far the paddle is turned, 0 to 1.
        """
        number = action.value if isinstance(action, Action) else action
        return int(self.step(number, paddle_strength, 1, View.NONE)[1])

    @_exclusive
    def reset_game(self) -> None:
        """Begins an episode."""
        self.ask(self.session.reset)

    def _decode(self, shown: dict[str, Any], view: View) -> Any:
        if view is View.NONE:
            return None
        if view is View.RAM:
            return np.frombuffer(shown["ram"], np.uint8).copy()
        screen = np.frombuffer(shown["screen"], np.uint8).reshape(-1, 160)
        if view is View.PALETTE:
            return screen.copy()
        return self._colours[screen] if view is View.RGB else self._greys[screen]

    @_exclusive
    @_check_types
    def game_over(self, with_truncation: bool = True) -> bool:
        """Returns whether the episode has ended.

        Args:
            with_truncation: Whether the limit of frames counts as an end.
        """
        ends = self._look("ends")
        return bool(ends["terminated"] or (with_truncation and ends["truncated"]))

    @_exclusive
    def game_truncated(self) -> bool:
        """Returns whether the episode has reached its limit of frames."""
        return bool(self._look("truncated")["truncated"])

    @_exclusive
    def lives(self) -> int:
        """Returns the lives that are left."""
        return int(self._look("lives")["lives"])

    @_exclusive
    def getFrameNumber(self) -> int:
        """Returns the frames since power-on."""
        return int(self._look("frame")["frame"])

    @_exclusive
    def getEpisodeFrameNumber(self) -> int:
        """Returns the frames since the episode began."""
        return int(self._look("episode_frame")["episode_frame"])

    # Screens, RAM and sound

    def _show(self, view: View, buffer: Pixels | None) -> Pixels | None:
        seen: Pixels = self._decode(self._look("ram:hex" if view is View.RAM else "screen:zlib"), view)
        return _fill(seen, buffer)

    @_exclusive
    @_check_types
    def getScreen(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen as palette indices, uint8 of shape (height, 160), or fills `buffer` and returns None."""
        return self._show(View.PALETTE, buffer)

    @_exclusive
    @_check_types
    def getScreenRGB(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen in colour, uint8 of shape (height, 160, 3), or fills `buffer` and returns None."""
        return self._show(View.RGB, buffer)

    @_exclusive
    @_check_types
    def getScreenGrayscale(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen in shades of grey, uint8 of shape (height, 160), or fills `buffer` and returns None."""
        return self._show(View.GRAYSCALE, buffer)

    @_exclusive
    @_check_types
    def getRAM(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the RAM, uint8 of shape (128,), or fills `buffer` and returns None."""
        return self._show(View.RAM, buffer)

    @_exclusive
    @_check_types
    def getAudio(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the samples of the last frame, uint8 of shape (512,), or fills `buffer` and returns None."""
        if not self._keys.getBool("sound_obs"):
            return _fill(np.zeros(512, np.uint8), buffer)
        return _fill(np.frombuffer(self._look("audio")["audio"], np.uint8).copy(), buffer)

    @_exclusive
    def getScreenDims(self) -> tuple[int, int]:
        """Returns the height and the width of the screen."""
        return self.session.height, 160

    @_exclusive
    def getRAMSize(self) -> int:
        """Returns the number of bytes of RAM."""
        return 128

    @_exclusive
    def getAudioSize(self) -> int:
        """Returns the number of samples in a frame."""
        return 512

    @_exclusive
    @_check_types
    def setRAM(self, index: int, value: int) -> None:
        """Writes a byte of the RAM.

        Args:
            index: Index of the byte, 0 to 127.
            value: Its value, 0 to 255.

        Raises:
            InvalidInput: If `index` is out of range.
        """
        self.ask(self.session.poke, int(index), bytes([value]))

    @_exclusive
    def state_hash(self) -> int:
        """Returns a hash of the state, which is that of the same state in this process.

        Raises:
            MissingImage: If only the server has the image.
        """
        state = self.cloneState(True)
        assert self._loaded is not None
        rom, game, _ = self._loaded
        here = copy.deepcopy(self._keys)
        here.loadROM(images.find(str(game)) if rom is None else rom, game)
        here.restoreState(state)
        return here.state_hash()

    @_exclusive
    @_check_types
    def saveScreenPNG(self, path: str) -> None:
        """Writes the screen as a PNG file of 320 columns.

        Args:
            path: Path of the file.

        Raises:
            OSError: If the file cannot be written.
        """
        picture = self.getScreenRGB()
        assert picture is not None
        pathlib.Path(path).write_bytes(png(np.repeat(picture, 2, axis=1)))

    # States

    @_exclusive
    @_check_types
    def cloneState(self, include_rng: bool = False) -> ALEState:
        """Returns the state, which can also be restored in this process.

        Args:
            include_rng: Whether the state has the generator of sticky actions.
        """
        self.ask(self.session.save, STATE, random=int(include_rng))
        data = self.ask(self.session.export_state, STATE)
        self.ask(self.session.drop, STATE)
        now = self._look("frame", "episode_frame")
        head = STATE_HEAD.pack(b"RBALE001", now["frame"], now["episode_frame"], self.getDifficulty(), self.getMode())
        return ALEState(head + data)

    @_exclusive
    def restoreState(self, state: ALEState) -> None:
        """Restores a state.

        Args:
            state: A state of the same game.

        Raises:
            TypeError: If `state` is not an ALEState.
            InvalidInput: If the state belongs to another game.
        """
        if not isinstance(state, ALEState):
            raise TypeError(f"state is {state!r}; it takes an ALEState")
        self.ask(self.session.import_state, STATE, state.serialize()[STATE_HEAD.size :])
        self.ask(self.session.restore, STATE)
        self.ask(self.session.drop, STATE)

    @_exclusive
    def cloneSystemState(self) -> ALEState:
        """Returns the state with the generator of sticky actions."""
        return self.cloneState(True)

    restoreSystemState = restoreState

    @_exclusive
    def __getstate__(self) -> dict[str, Any]:
        """Returns what a copy needs to continue, with its own session, where this game is."""
        return {
            "server": self._server,
            "token": self._token,
            "timeout": self._timeout,
            "keys": self._keys,
            "loaded": self._loaded,
            "state": self.cloneState(True) if self._loaded else None,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        RemoteInterface.__init__(self, state["server"], state["token"], state["timeout"])
        self._keys = state["keys"]
        if state["loaded"]:
            self.load(*state["loaded"])
            self.restoreState(state["state"])


def _read_image(rom: Any) -> bytes:
    rom = images.path_or_bytes(rom)
    if isinstance(rom, bytes):
        return rom
    if str(rom).startswith(images.BUILT_IN):
        raise InvalidInput(f"{rom} is an image of the server's: give only the name of its game")
    try:
        return pathlib.Path(os.fspath(rom)).read_bytes()
    except OSError as error:
        raise InvalidInput(f"image {rom}: {error.strerror}") from error


def _fill(values: Pixels, buffer: Pixels | None) -> Pixels | None:
    """Returns the values, or writes them to `buffer` and returns None."""
    if buffer is None:
        return values
    memory = np.asarray(buffer)  # the memory of the buffer, which may be any object that holds bytes
    if memory.shape != values.shape:
        raise InvalidInput(f"Invalid shape {memory.shape}, expecting shape {values.shape}")
    memory[:] = values
    return None
