"""A window that shows a game and plays its sound, made with pygame."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InvalidInput

FRAMES_PER_SECOND = 60
SAMPLES_PER_FRAME = 512
SCALE = 2  # of a pixel, which is twice as wide as it is high


class Window:
    """The window of one game.

    pygame has one window per process. All games share it: it shows the game that was stepped last, and closes with the
    last game that is closed.
    """

    _open: weakref.WeakSet[Window] = weakref.WeakSet()

    def __init__(self, title: str, width: int, height: int, sound: bool) -> None:
        """Opens the window, or joins the open one.

        Args:
            title: Title of the window.
            width: Width of a screen in pixels of the Atari 2600.
            height: Height of a screen in rows.
            sound: Whether sound is played.

        Raises:
            ImportError: If pygame is not installed.
            InvalidInput: If there is no display.
        """
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
        """Returns the surface of the window in the size of this game.

        Another user of pygame may have closed the window, or changed its size; then this opens it again.
        """
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
        """Returns a channel of the mixer, or None if the computer has no sound."""
        mixer = self._pygame.mixer
        try:
            mixer.init(FRAMES_PER_SECOND * SAMPLES_PER_FRAME, 8, 1, SAMPLES_PER_FRAME)
        except self._pygame.error:
            return None
        return mixer.find_channel()

    def show(self, rgb: npt.NDArray[np.uint8]) -> None:
        """Shows a screen.

        Args:
            rgb: uint8 array of shape (height, width, 3).
        """
        picture = self._pygame.surfarray.make_surface(rgb.swapaxes(0, 1))
        self._pygame.transform.scale(picture, self._size, self._surface())
        self._pygame.event.pump()
        self._pygame.display.flip()

    def play(self, samples: npt.NDArray[np.uint8]) -> None:
        """Queues the sound of one frame.

        Args:
            samples: uint8 array of shape (512,), at 30,720 samples per second.
        """
        if self._channel is not None:
            self._channel.queue(self._pygame.mixer.Sound(buffer=samples.tobytes()))

    def wait(self) -> None:
        """Waits until the next frame is due."""
        self._clock.tick(FRAMES_PER_SECOND)

    def close(self) -> None:
        """Leaves the window, and closes it if no other game uses it. Must be called once."""
        self._open.discard(self)
        if self._channel is not None and all(other._channel is None for other in self._open):
            self._pygame.mixer.quit()
        if not self._open:
            self._pygame.display.quit()
