"""Playing a game that runs on a server, and what it shows."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import Action, ConsoleAction, ControllerAction, View
from ..errors import InvalidInput
from ..interface import png
from .remote_game import RemoteGame, check_types, exclusive

Pixels = npt.NDArray[np.uint8]

MOST_AHEAD = 64  # requests whose replies fit into what a connection buffers
ALWAYS = ("reward", "reward_b", "lives", "episode_frame", "frame", "acts")
FIELDS = {
    View.RGB: ("screen:delta",),
    View.GRAYSCALE: ("screen:delta",),
    View.PALETTE: ("screen:delta",),
    View.RAM: ("ram:hex",),
    View.NONE: (),
}


class RemotePlay(RemoteGame):
    """The part of `RemoteInterface` that plays, and shows screens, RAM and sound."""

    def _observe(self, view: View) -> None:
        if view is not self._view:
            sound = ("audio_all",) if self._keys.getBool("all_audio") else ()
            self.ask(self.session.observe, *ALWAYS, *self._fields_of_ends(), *FIELDS[view], *sound)
            self._view = view

    @exclusive
    @check_types
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
            action_b: Number of player B's action, from 18 on.
            paddle_strength_b: How far B's paddle is turned, 0 to 1.

        Returns:
            The observation, the rewards of A and B, terminated, truncated, lives, and the frames since the episode and
            the game began.
        """
        view = View(view)
        self._observe(view)
        word = f"{int(action)}@{float(paddle_strength):.9g}/{int(action_b) - 18}@{float(paddle_strength_b):.9g}"
        result = self.ask(self.session.act, f"{word}*{int(times)}")
        self._all_audio = result.get("audio_all", b"")
        self._act_after_the_end(word, times - max(result["acts"], 1))
        return (
            self._decode(result, view),
            float(result["reward"]),
            float(result["reward_b"]),
            *self._ends(result),
            result["lives"],
            result["episode_frame"],
            result["frame"],
        )

    def _act_after_the_end(self, word: str, acts: int) -> None:
        """Sends the acts after the end of the game. They run no frames, but advance the generator of sticky actions.

        The server plays one of them per request, and stops reading while its replies are not read.
        """
        while acts > 0:
            burst = min(acts, MOST_AHEAD)
            for _ in range(burst):
                self.session.send("act", word)
            for _ in range(burst):
                self.session.receive_values()
            acts -= burst

    @exclusive
    @check_types
    def act(self, action: int | Action | ConsoleAction | ControllerAction, paddle_strength: float = 1.0) -> int:
        """Plays an action, and returns its reward.

        Args:
            action: The action or its number.
            paddle_strength: How far the paddle is turned, 0 to 1; for a light gun, the place x + 256 * y.
        """
        number = action.value if isinstance(action, (Action, ConsoleAction, ControllerAction)) else action
        return int(self.step(number, paddle_strength, 1, View.NONE)[1])

    @exclusive
    def reset_game(self) -> None:
        """Begins an episode."""
        self.ask(self.session.reset)

    def _decode(self, fields: dict[str, Any], view: View) -> Any:
        if view is View.NONE:
            return None
        if view is View.RAM:
            return np.frombuffer(fields["ram"], np.uint8).copy()
        screen = np.frombuffer(fields["screen"], np.uint8).reshape(-1, 160)
        if view is View.PALETTE:
            return screen.copy()
        return self._colours[screen] if view is View.RGB else self._greys[screen]

    @exclusive
    @check_types
    def game_over(self, with_truncation: bool = True) -> bool:
        """Returns whether the episode has ended.

        Args:
            with_truncation: Whether the limit of frames counts as an end.
        """
        terminated, truncated = self._ends(self._look(*self._fields_of_ends()))
        return terminated or (with_truncation and truncated)

    @exclusive
    def game_truncated(self) -> bool:
        """Returns whether the episode has reached its limit of frames, or has ended at a lost life."""
        return self._ends(self._look(*self._fields_of_ends()))[1]

    @exclusive
    def lives(self) -> int:
        """Returns the lives that are left."""
        return int(self._look("lives")["lives"])

    @exclusive
    def getFrameNumber(self) -> int:
        """Returns the frames since power-on."""
        return int(self._look("frame")["frame"])

    @exclusive
    def getEpisodeFrameNumber(self) -> int:
        """Returns the frames since the episode began."""
        return int(self._look("episode_frame")["episode_frame"])

    # Screens, RAM and sound

    def _show(self, view: View, buffer: Pixels | None) -> Pixels | None:
        pixels: Pixels = self._decode(self._look("ram:hex" if view is View.RAM else "screen:zlib"), view)
        return _fill(pixels, buffer)

    @exclusive
    @check_types
    def getScreen(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen as palette indices, uint8 of shape (height, 160), or fills `buffer` and returns None."""
        return self._show(View.PALETTE, buffer)

    @exclusive
    @check_types
    def getScreenRGB(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen in colour, uint8 of shape (height, 160, 3), or fills `buffer` and returns None."""
        return self._show(View.RGB, buffer)

    @exclusive
    @check_types
    def getScreenGrayscale(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the screen in shades of grey, uint8 of shape (height, 160), or fills `buffer` and returns None."""
        return self._show(View.GRAYSCALE, buffer)

    @exclusive
    @check_types
    def getRAM(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the RAM, uint8 of shape (128,), or fills `buffer` and returns None."""
        return self._show(View.RAM, buffer)

    @exclusive
    @check_types
    def getAudio(self, buffer: Pixels | None = None) -> Pixels | None:
        """Returns the samples of the last frame, uint8 of shape (512,), or fills `buffer` and returns None."""
        if not self._keys.getBool("sound_obs"):
            return _fill(np.zeros(512, np.uint8), buffer)
        return _fill(np.frombuffer(self._look("audio")["audio"], np.uint8).copy(), buffer)

    @exclusive
    def getAllAudio(self) -> Pixels:
        """Returns 512 samples for each frame of the last `step`, with the key `all_audio`."""
        return np.frombuffer(self._all_audio, np.uint8).copy()

    @exclusive
    def getScreenDims(self) -> tuple[int, int]:
        """Returns the height and the width of the screen."""
        return self.session.height, 160

    @exclusive
    def getRAMSize(self) -> int:
        """Returns the number of bytes of RAM."""
        return 128

    @exclusive
    def getAudioSize(self) -> int:
        """Returns the number of samples in a frame."""
        return 512

    @exclusive
    @check_types
    def setRAM(self, index: int, value: int) -> None:
        """Writes a byte of the RAM.

        Args:
            index: Index of the byte, 0 to 127.
            value: Its value, 0 to 255.

        Raises:
            InvalidInput: If `index` is out of range.
        """
        self.ask(self.session.poke, int(index), bytes([value]))

    @exclusive
    @check_types
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


def _fill(values: Pixels, buffer: Pixels | None) -> Pixels | None:
    """Returns the values, or writes them to `buffer` and returns None."""
    if buffer is None:
        return values
    memory = np.asarray(buffer)  # the memory of the buffer, which may be any object that holds bytes
    if memory.shape != values.shape:
        raise InvalidInput(f"Invalid shape {memory.shape}, expecting shape {values.shape}")
    memory[:] = values
    return None
