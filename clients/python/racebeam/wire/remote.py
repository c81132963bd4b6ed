"""ALEInterface of a game that runs on a server: the same answers, over the line protocol."""

from __future__ import annotations

import copy
import functools
import inspect
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
from .client import Refused, Session, connect

Pixels = npt.NDArray[np.uint8]
Kind = TypeVar("Kind")
Method = TypeVar("Method", bound=Callable[..., Any])

STATE = "racebeam-env"  # the name under which states pass through the session
STATE_HEAD = struct.Struct("<8s4i")  # what ALEState.serialize() has before the server's bytes
NO_LIMITS = {-(2**31): "none", 2**31 - 1: "none"}
MOST_AHEAD = 64  # requests, whose replies fit into what a connection buffers
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


def _takes_turns(kind: type[Kind]) -> type[Kind]:
    """Each public method is a turn of one thread, except close(), which ends the turn of another."""
    for name, method in list(vars(kind).items()):
        if inspect.isfunction(method) and name != "close" and (not name.startswith("_") or name == "__getstate__"):
            setattr(kind, name, _turn(method))
    return kind


def _turn(method: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(method)
    def taken(self: RemoteInterface, *words: Any, **settings: Any) -> Any:
        self.session.check_process()  # the turn may be that of a thread which a child does not have
        with self.turn:
            try:
                return method(self, *words, **settings)
            except BaseException:
                if self.session.unanswered:
                    self.session.cut()
                raise

    return taken


def _typed(method: Method) -> Method:
    """Raises the TypeError of ALEInterface's method. Without a game, that checks types first, and raises InvalidInput then."""

    @functools.wraps(method)
    def checked(self: RemoteInterface, *words: Any, **settings: Any) -> Any:
        try:
            getattr(self._keys, method.__name__)(*words, **settings)
        except InvalidInput:
            pass
        return method(self, *words, **settings)

    return cast(Method, checked)


@_takes_turns
class RemoteInterface:
    """Settings are kept here, and go to the server when an image is loaded. The server needs the image, or it is sent.

    Threads take turns. Raises what ALEInterface does; ConnectionError when there is no server, or it has gone; TimeoutError when it
    is silent for `timeout` seconds; RuntimeError in a child process after a fork; and Refused for a limit of the server.
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

    def ask(self, method: Any, *words: Any, **settings: Any) -> Any:
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
            **{side: NO_LIMITS.get(limit, limit) for side, limit in limits.items()},
        }

    def loadROM(self, rom: Any = None, game: str | None = None) -> None:
        """rom: as ALEInterface.loadROM() takes it, sent to the server; None: the server's own image of `game`."""
        self.load(rom, game, self._settings())

    def load(self, rom: Any, game: str | None, settings: dict[str, object]) -> None:
        self._view = None
        if rom is None:
            rom = self._image_to_send(game)
        if rom is None:
            self.ask(self.session.load, game, **settings)
        else:
            named = {"as": game} if game is not None else {}
            self.ask(self.session.load, "inline", image=_bytes_of(rom), **named, **settings)
        self._loaded = rom, game, settings
        self._colours = np.array(self.session.palette(), np.uint8)
        self._greys = np.append(self._colours[1:, 2], np.uint8(0))  # the blue of the entry after it

    def _image_to_send(self, game: str | None) -> str | None:
        """None where the server has one itself."""
        images.check_name(str(game))
        if int(self.session.game(str(game))["here"]) == 1:
            return None
        try:
            return images.find(str(game))
        except MissingImage as missing:
            raise MissingImage(f"{self._server} has no image of {game}, and here {missing}") from missing

    def getGame(self) -> str:
        return str(self.ask(self.session.settings)["game"])

    def _list(self, key: str, command: str) -> list[int]:
        return [int(number) for number in self.ask(self.session.list_of, key, command)]

    def _actions(self, key: str) -> list[Action]:
        return [Action(number) for number in self._list(key, "actions")]

    def getLegalActionSet(self) -> list[Action]:
        return self._actions("legal")

    def getMinimalActionSet(self) -> list[Action]:
        return self._actions("minimal")

    def getAvailableModes(self) -> list[int]:
        return self._list("modes", "modes")

    def getTwoPlayerModes(self) -> list[int]:
        return self._list("two_player_modes", "modes")

    def getAvailableDifficulties(self) -> list[int]:
        return self._list("difficulties", "difficulties")

    def getMode(self) -> int:
        return int(self.ask(self.session.values, "modes")["mode"])

    def getDifficulty(self) -> int:
        return int(self.ask(self.session.values, "difficulties")["difficulty"])

    @_typed
    def setMode(self, mode: int) -> None:
        self.ask(self.session.set, mode=int(mode))

    @_typed
    def setDifficulty(self, difficulty: int) -> None:
        self.ask(self.session.set, difficulty=int(difficulty))

    # Playing

    def _observe(self, view: View) -> None:
        if view is not self._view:
            self.ask(self.session.observe, *ALWAYS, *FIELDS[view])
            self._view = view

    @_typed
    def step(
        self,
        action: int,
        paddle_strength: float,
        times: int,
        view: View,
        action_b: int = 18,
        paddle_strength_b: float = 0.0,
    ) -> tuple[Any, float, float, bool, bool, int, int, int]:
        """As ALEInterface's."""
        view = View(view)
        self._observe(view)
        word = f"{int(action)}@{float(paddle_strength):.9g}/{int(action_b) - 18}@{float(paddle_strength_b):.9g}"
        shown = self.ask(self.session.act, f"{word}*{int(times)}")
        self._act_after_the_end(word, times - max(shown["acts"], 1))
        return (
            self._seen(shown, view),
            float(shown["reward"]),
            float(shown["reward_b"]),
            bool(shown["terminated"]),
            bool(shown["truncated"]),
            shown["lives"],
            shown["episode_frame"],
            shown["frame"],
        )

    def _act_after_the_end(self, word: str, acts: int) -> None:
        """Such acts run no frame; but the generator of sticky actions goes on, as it does in this process. The server plays one in
        a request, and stops reading while its replies are not read.
        """
        while acts > 0:
            burst = min(acts, MOST_AHEAD)
            for _ in range(burst):
                self.session.send("act", word)
            for _ in range(burst):
                self.session.received()
            acts -= burst

    @_typed
    def act(self, action: int | Action, paddle_strength: float = 1.0) -> int:
        number = action.value if isinstance(action, Action) else action
        return int(self.step(number, paddle_strength, 1, View.NONE)[1])

    def reset_game(self) -> None:
        self.ask(self.session.reset)

    def _seen(self, shown: dict[str, Any], view: View) -> Any:
        if view is View.NONE:
            return None
        if view is View.RAM:
            return np.frombuffer(shown["ram"], np.uint8).copy()
        screen = np.frombuffer(shown["screen"], np.uint8).reshape(-1, 160)
        if view is View.PALETTE:
            return screen.copy()
        return self._colours[screen] if view is View.RGB else self._greys[screen]

    @_typed
    def game_over(self, with_truncation: bool = True) -> bool:
        ends = self._look("ends")
        return bool(ends["terminated"] or (with_truncation and ends["truncated"]))

    def game_truncated(self) -> bool:
        return bool(self._look("truncated")["truncated"])

    def lives(self) -> int:
        return int(self._look("lives")["lives"])

    def getFrameNumber(self) -> int:
        return int(self._look("frame")["frame"])

    def getEpisodeFrameNumber(self) -> int:
        return int(self._look("episode_frame")["episode_frame"])

    # What is seen and heard

    def _show(self, view: View, buffer: Pixels | None) -> Pixels | None:
        seen: Pixels = self._seen(self._look("ram:hex" if view is View.RAM else "screen:zlib"), view)
        return _given(seen, buffer)

    @_typed
    def getScreen(self, buffer: Pixels | None = None) -> Pixels | None:
        return self._show(View.PALETTE, buffer)

    @_typed
    def getScreenRGB(self, buffer: Pixels | None = None) -> Pixels | None:
        return self._show(View.RGB, buffer)

    @_typed
    def getScreenGrayscale(self, buffer: Pixels | None = None) -> Pixels | None:
        return self._show(View.GRAYSCALE, buffer)

    @_typed
    def getRAM(self, buffer: Pixels | None = None) -> Pixels | None:
        return self._show(View.RAM, buffer)

    @_typed
    def getAudio(self, buffer: Pixels | None = None) -> Pixels | None:
        if not self._keys.getBool("sound_obs"):
            return _given(np.zeros(512, np.uint8), buffer)
        return _given(np.frombuffer(self._look("audio")["audio"], np.uint8).copy(), buffer)

    def getScreenDims(self) -> tuple[int, int]:
        return self.session.height, 160

    def getRAMSize(self) -> int:
        return 128

    def getAudioSize(self) -> int:
        return 512

    @_typed
    def setRAM(self, index: int, value: int) -> None:
        self.ask(self.session.poke, int(index), bytes([value]))

    def state_hash(self) -> int:
        """As ALEInterface's, which has it of the state. Raises MissingImage where only the server has the image."""
        state = self.cloneState(True)
        assert self._loaded is not None
        rom, game, _ = self._loaded
        here = copy.deepcopy(self._keys)
        here.loadROM(images.find(str(game)) if rom is None else rom, game)
        here.restoreState(state)
        return here.state_hash()

    @_typed
    def saveScreenPNG(self, path: str) -> None:
        picture = self.getScreenRGB()
        assert picture is not None
        pathlib.Path(path).write_bytes(png(np.repeat(picture, 2, axis=1)))

    # States

    @_typed
    def cloneState(self, include_rng: bool = False) -> ALEState:
        """The state comes here; it can be restored in this process, too."""
        self.ask(self.session.save, STATE, random=int(include_rng))
        data = self.ask(self.session.export_state, STATE)
        self.ask(self.session.drop, STATE)
        now = self._look("frame", "episode_frame")
        head = STATE_HEAD.pack(b"RBALE001", now["frame"], now["episode_frame"], self.getDifficulty(), self.getMode())
        return ALEState(head + data)

    def restoreState(self, state: ALEState) -> None:
        if not isinstance(state, ALEState):
            raise TypeError(f"state is {state!r}; it takes an ALEState")
        self.ask(self.session.import_state, STATE, state.serialize()[STATE_HEAD.size :])
        self.ask(self.session.restore, STATE)
        self.ask(self.session.drop, STATE)

    def cloneSystemState(self) -> ALEState:
        return self.cloneState(True)

    restoreSystemState = restoreState

    def __getstate__(self) -> dict[str, Any]:
        """A copy has a session of its own."""
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


def _bytes_of(rom: Any) -> bytes:
    rom = images.given(rom)
    if isinstance(rom, bytes):
        return rom
    if str(rom).startswith(images.BUILT_IN):
        raise InvalidInput(f"{rom} is an image of the server's: give the name of its game alone")
    try:
        return pathlib.Path(os.fspath(rom)).read_bytes()
    except OSError as error:
        raise InvalidInput(f"image {rom}: {error.strerror}") from error


def _given(seen: Pixels, buffer: Pixels | None) -> Pixels | None:
    if buffer is None:
        return seen
    room = np.asarray(buffer)  # the same memory, of whatever else holds bytes
    if room.shape != seen.shape:
        raise InvalidInput(f"Invalid shape {room.shape}, expecting shape {seen.shape}")
    room[:] = seen
    return None
