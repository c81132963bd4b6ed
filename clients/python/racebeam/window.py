"""A window that shows a game and plays its sound, by pygame."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InvalidInput

FRAMES_A_SECOND = 60
SAMPLES_A_FRAME = 512
SCALE = 2  # of a pixel, which is twice as wide as it is high


class Window:
    """One game's. pygame has one window in a process: all games share it, and it shows the game that played last. It is gone when
    each of them was closed. Raises ImportError, with what to install, where there is no pygame, and InvalidInput without a display.
    """

    _open: weakref.WeakSet[Window] = weakref.WeakSet()

    def __init__(self, title: str, width: int, height: int, sound: bool) -> None:
        try:
            import pygame
        except ModuleNotFoundError as missing:
            raise ImportError(
                'render_mode "human" needs pygame; install it with: pip install "racebeam[human]"'
            ) from missing
        self._pygame: Any = pygame
        self._title, self._size = title, (2 * SCALE * width, SCALE * height)
        self._surface()
        self._clock = pygame.time.Clock()
        self._channel = self._open_sound() if sound else None
        self._open.add(self)

    def _surface(self) -> Any:
        """That of the window, in the size of this game. Whatever else uses pygame may have closed it, or changed its size."""
        display = self._pygame.display
        try:
            display.init()
            if display.get_caption()[:1] != (self._title,):
                display.set_caption(self._title)
            surface = display.get_surface()
            return surface if surface and surface.get_size() == self._size else display.set_mode(self._size)
        except self._pygame.error as error:
            raise InvalidInput(
                f"render_mode is 'human', which needs a display: {error}; it takes None or 'rgb_array' here"
            ) from error

    def _open_sound(self) -> Any:
        """None where the computer has no sound."""
        mixer = self._pygame.mixer
        try:
            mixer.init(FRAMES_A_SECOND * SAMPLES_A_FRAME, 8, 1, SAMPLES_A_FRAME)
        except self._pygame.error:
            return None
        return mixer.find_channel()

    def show(self, rgb: npt.NDArray[np.uint8]) -> None:
        """A picture, height x width x 3."""
        picture = self._pygame.surfarray.make_surface(rgb.swapaxes(0, 1))
        self._pygame.transform.scale(picture, self._size, self._surface())
        self._pygame.event.pump()
        self._pygame.display.flip()

    def play(self, samples: npt.NDArray[np.uint8]) -> None:
        """The sound of one frame."""
        if self._channel is not None:
            self._channel.queue(self._pygame.mixer.Sound(buffer=samples.tobytes()))

    def wait(self) -> None:
        """Until the next frame is due."""
        self._clock.tick(FRAMES_A_SECOND)

    def close(self) -> None:
        """Once."""
        self._open.discard(self)
        if self._channel is not None and all(other._channel is None for other in self._open):
            self._pygame.mixer.quit()
        if not self._open:
            self._pygame.display.quit()
