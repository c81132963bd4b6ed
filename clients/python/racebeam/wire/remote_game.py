"""A game that runs on a server: the session, the settings, and the cartridge."""

from __future__ import annotations

import contextlib
import functools
import os
import pathlib
import threading
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from .. import images
from .._core import Action, View
from ..errors import InvalidInput, MissingImage, UnknownGame
from ..interface import ALEInterface
from .messages import Refused
from .opening import connect
from .session import Session

Method = TypeVar("Method", bound=Callable[..., Any])

NO_LIMITS = {-(2**31): "none", 2**31 - 1: "none"}
OWN_ERRORS = {
    "unknown-game": UnknownGame,
    "bad-value": InvalidInput,
    "bad-image": InvalidInput,
    "bad-state": InvalidInput,
    "bad-action": InvalidInput,
    "no-game": InvalidInput,
}


def exclusive(method: Method) -> Method:
    """Makes threads take turns. Aborts the session if a call leaves a request unanswered."""

    @functools.wraps(method)
    def call(self: RemoteGame, *words: Any, **settings: Any) -> Any:
        self.session._check_process()  # after a fork, a thread that the child lacks may hold the lock
        with self.turn:
            try:
                return method(self, *words, **settings)
            except BaseException:
                if self.session._unanswered:
                    self.session._abort()
                raise

    return cast(Method, call)


def check_types(method: Method) -> Method:
    """Makes a method raise the TypeError of the method of ALEInterface, which checks types before it needs a game."""

    @functools.wraps(method)
    def call(self: RemoteGame, *words: Any, **settings: Any) -> Any:
        with contextlib.suppress(InvalidInput):  # that interface has no game
            getattr(self._keys, method.__name__)(*words, **settings)
        return method(self, *words, **settings)

    return cast(Method, call)


class RemoteGame:
    """A session with a game on a server: settings, loading, and what the game has.

    `RemoteInterface` describes the arguments, the attributes and the errors.
    """

    def __init__(self, server: str, token: str | None = None, timeout: float | None = None) -> None:
        self._server, self._token, self._timeout = server, token, timeout
        self._keys = ALEInterface()
        self.action_set = "full"
        self._all_audio = b""
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
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")

    @exclusive
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
            **({"life_loss": "restart"} if keys.getBool("truncate_on_loss_of_life") else {}),
            "rules": keys.getString("rules"),
            **({"action_set": self.action_set} if self.action_set != "full" else {}),
            "color_averaging": int(keys.getBool("color_averaging")),
            "sound": int(keys.getBool("sound_obs")),
            **{key: keys.getString(key) for key in ("scheme", "left", "right", "format") if keys.getString(key)},
            **{key: keys.getInt(key) for key in ("ystart", "height") if keys.getInt(key) != -1},
            **{side: NO_LIMITS.get(limit, limit) for side, limit in limits.items()},
        }

    @exclusive
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

    @exclusive
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
            arguments = {"as_": game} if game is not None else {}
            self.ask(self.session.load, "inline", image=_read_image(rom), **arguments, **settings)
        self._loaded = rom, game, settings
        self._colours = np.array(self.session.palette(), np.uint8)
        self._greys = np.append(self._colours[1:, 2], np.uint8(0))  # the blue of the entry after it

    def _fields_of_ends(self) -> tuple[str, ...]:
        """Returns the fields of a reply from which `_ends` tells how the episode ends."""
        return ("terminated", "truncated", *(["game_over"] if self._restarts() else []))

    def _ends(self, fields: dict[str, Any]) -> tuple[bool, bool]:
        """Returns whether the episode is terminated and truncated. A lost life truncates it, as in ALE.

        Args:
            fields: The fields of a reply. With life_loss=restart, a lost life terminates.
        """
        terminated, truncated = bool(fields["terminated"]), bool(fields["truncated"])
        if not self._restarts() or fields["game_over"]:
            return terminated, truncated
        return False, terminated or truncated

    def _restarts(self) -> bool:
        return self._loaded is not None and self._loaded[2].get("life_loss") == "restart"

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

    @exclusive
    def getGame(self) -> str:
        """Returns the name of the game."""
        return str(self.ask(self.session.settings)["game"])

    @exclusive
    def getControllers(self) -> tuple[str, str]:
        """Returns the names of the controllers of players A and B, such as "joystick"."""
        values = self.ask(self.session.settings)
        return str(values["left"]), str(values["right"])

    @exclusive
    def image_warning(self) -> str:
        """Returns a warning if the game's rule was written for another image, or if the image may not run."""
        values = self.ask(self.session.settings)
        if values.get("image") == "doubtful":
            return (
                f"no code of this image selects a bank of the cartridge scheme {values['scheme']}, "
                "which its size suggests; it may not run. The setting scheme names another one"
            )
        if values.get("image") != "other":
            return ""
        return (
            f"the MD5 of this image, {values['md5']}, is not that of the image which the rule of '{values['game']}' "
            "was written for; score and end may be wrong"
        )

    def _list(self, key: str, command: str) -> list[int]:
        return [int(number) for number in self.ask(self.session._list_of, key, command)]

    def _actions(self, key: str) -> list[Action]:
        return [Action(number) for number in self._list(key, "actions")]

    @exclusive
    def getLegalActionSet(self) -> list[Action]:
        """Returns all 18 actions."""
        return self._actions("legal")

    @exclusive
    def getMinimalActionSet(self) -> list[Action]:
        """Returns the actions that have an effect in the game."""
        return self._actions("minimal")

    @exclusive
    def getAvailableModes(self) -> list[int]:
        """Returns the modes for one player."""
        return self._list("modes", "modes")

    @exclusive
    def getTwoPlayerModes(self) -> list[int]:
        """Returns the modes for two players."""
        return self._list("two_player_modes", "modes")

    @exclusive
    def getAvailableDifficulties(self) -> list[int]:
        """Returns the difficulties of the game."""
        return self._list("difficulties", "difficulties")

    @exclusive
    def getMode(self) -> int:
        """Returns the present mode."""
        return int(self.ask(self.session._values_of, "modes")["mode"])

    @exclusive
    def getDifficulty(self) -> int:
        """Returns the present difficulty."""
        return int(self.ask(self.session._values_of, "difficulties")["difficulty"])

    @exclusive
    @check_types
    def setMode(self, mode: int) -> None:
        """Selects a mode, which takes effect at the next reset.

        Args:
            mode: One of the modes of the game.

        Raises:
            InvalidInput: If the game does not have the mode.
        """
        self.ask(self.session.set, mode=int(mode))

    @exclusive
    @check_types
    def setDifficulty(self, difficulty: int) -> None:
        """Selects a difficulty, which takes effect at the next frame.

        Args:
            difficulty: One of the difficulties of the game.

        Raises:
            InvalidInput: If the game does not have the difficulty.
        """
        self.ask(self.session.set, difficulty=int(difficulty))


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
