"""Observations, screens and the window of AtariEnv."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import error, spaces

from .. import images
from .._core import View
from .game import EnvWithGame
from .window import Window

__all__ = ["VIEWS", "EnvWithView", "Observation", "Pixels"]

Pixels: TypeAlias = npt.NDArray[np.uint8]
Observation: TypeAlias = Pixels | dict[str, Pixels]

SILENCE = 128
VIEWS = {"rgb": View.RGB, "grayscale": View.GRAYSCALE, "ram": View.RAM}


class EnvWithView(EnvWithGame):
    """Base class of environments that show the game.

    Examples:
        >>> import racebeam
        >>> racebeam.AtariEnv("beamfall", render_mode="rgb_array").render().shape
        (210, 160, 3)
    """

    _is_closed: bool
    _frameskip: int | tuple[int, int]
    _view: View
    _window: Window | None

    def _space_of_observations(self) -> spaces.Space[Any]:
        height, width = self.ale.getScreenDims()
        shape = {View.RGB: (height, width, 3), View.GRAYSCALE: (height, width), View.RAM: (self.ale.getRAMSize(),)}
        image = spaces.Box(0, 255, shape[self._view], np.uint8)
        if not self.sound_obs:
            return image
        return spaces.Dict({"image": image, "sound": spaces.Box(0, 255, (self._samples(),), np.uint8)})

    def _samples(self) -> int:
        frames = self._frameskip if isinstance(self._frameskip, int) else self._frameskip[1] - 1
        return int(self.ale.getAudioSize()) * (frames if self.sound_obs == "all" else 1)

    def _observation(self, image: Pixels) -> Observation:
        if not self.sound_obs:
            return image
        if self.sound_obs != "all":
            return {"image": image, "sound": self.ale.getAudio()}
        sound = np.full(self._samples(), SILENCE, np.uint8)
        samples = self.ale.getAllAudio()[: len(sound)]
        sound[: len(samples)] = samples
        return {"image": image, "sound": sound}

    def _get_obs(self) -> Observation:
        show = {View.RGB: self.ale.getScreenRGB, View.GRAYSCALE: self.ale.getScreenGrayscale, View.RAM: self.ale.getRAM}
        return self._observation(show[self._view]())

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

    def _check_open(self, what: str) -> None:
        if self._is_closed:
            raise closed_error(what, self._name)


def closed_error(what: str, game: str) -> error.ClosedEnvironmentError:
    """Makes the exception for a closed environment.

    Args:
        what: The attempted call, such as "render()".
        game: Name of its game.
    """
    return error.ClosedEnvironmentError(f"{what} is not possible: this environment of {game} was closed")
