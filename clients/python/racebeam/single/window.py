"""A window that shows games and plays their sound, made with pygame."""

from __future__ import annotations

import math
import os
import weakref
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import warn
from ..errors import InvalidInput
from ..extras import install_hint

FRAMES_PER_SECOND = 60
SAMPLES_PER_FRAME = 512
SCALE = 2  # height of a shown pixel, which is twice as wide
MOST_SHOWN = 16  # environments in one window
SLOWEST, FASTEST = 1 / 8, 8  # times the usual speed
KEYS = {"p": "pause", "+": "faster", "=": "faster", "-": "slower"}  # "=" is the key of "+" without shift


class _Speed:
    """The speed of all games of the process, which the keys of the window set."""

    def __init__(self) -> None:
        self.factor, self.is_paused = 1.0, False

    def press(self, key: str) -> None:
        """Changes the speed, if the key is one of those that do.

        Args:
            key: The character of the key.
        """
        action = KEYS.get(key)
        if action == "pause":
            self.is_paused = not self.is_paused
        elif action == "faster":
            self.factor = min(2 * self.factor, FASTEST)
        elif action == "slower":
            self.factor = max(self.factor / 2, SLOWEST)


class Window:
    """The window of one game.

    The key P pauses and continues, + doubles the speed, and - halves it. The speed is that of all games of the process.
    Sound is played at the usual speed only.

    pygame has one window per process. All games share it: it shows the game that was stepped last, and closes with the
    last game that is closed. The close button also closes it. The games that were open then go on without a window.
    """

    _open: weakref.WeakSet[Window] = weakref.WeakSet()
    _speed = _Speed()

    def __init__(self, title: str, width: int, height: int, sound: bool, scale: int = SCALE) -> None:
        """Opens the window, or joins the open one.

        Args:
            title: Title of the window.
            width: Width of a screen in pixels of the Atari 2600.
            height: Height of a screen in rows.
            sound: Whether sound is played.
            scale: Height of a shown pixel; its width is twice as large.

        Raises:
            ImportError: If pygame is not installed.
            InvalidInput: If the computer has no display.
        """
        try:
            import pygame
        except ModuleNotFoundError as missing:
            raise ImportError(f'render_mode "human" needs pygame; {install_hint("pygame")}') from missing
        self._pygame: Any = pygame
        self._title, self._size = title, (2 * scale * width, scale * height)
        self._is_dismissed = False  # by the close button
        self._surface()
        self._warn_of_hidden_window()
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

    def _warn_of_hidden_window(self) -> None:
        """Warns if SDL found no display, and chose by itself a driver that shows nothing."""
        if self._pygame.display.get_driver() == "offscreen" and "SDL_VIDEODRIVER" not in os.environ:
            warn(
                "render_mode is 'human', which needs a display: SDL found none, and nobody sees the window; it takes "
                "None or 'rgb_array' here"
            )

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
        if self._is_dismissed:
            return
        picture = self._pygame.surfarray.make_surface(rgb.swapaxes(0, 1))
        self._pygame.transform.scale(picture, self._size, self._surface())
        self._pygame.display.flip()
        self._handle_events()
        while self._speed.is_paused and not self._is_dismissed:
            self._clock.tick(FRAMES_PER_SECOND)
            self._handle_events()

    def _handle_events(self) -> None:
        """Handles the keys that were pressed, and the close button. Other events are left to the program."""
        pygame = self._pygame
        for event in pygame.event.get([pygame.QUIT, pygame.KEYDOWN]):
            if event.type == pygame.QUIT:
                self._dismiss()
                break
            self._speed.press(getattr(event, "unicode", ""))

    def _dismiss(self) -> None:
        """Closes the window for all games that are open, which then go on at full speed."""
        self._speed.is_paused = False
        for window in self._open:
            window._is_dismissed = True
        self._pygame.mixer.quit()
        self._pygame.display.quit()

    def play(self, samples: npt.NDArray[np.uint8]) -> None:
        """Queues the sound of one frame.

        Args:
            samples: uint8 array of shape (512,), at 30,720 samples per second.
        """
        if self._channel is not None and not self._is_dismissed and self._speed.factor == 1:
            self._channel.queue(self._pygame.mixer.Sound(buffer=samples.tobytes()))

    def wait(self, frames: int = 1) -> None:
        """Waits until the next screen is due.

        Args:
            frames: Frames from one screen to the next.
        """
        if not self._is_dismissed:
            self._clock.tick(self._speed.factor * FRAMES_PER_SECOND / frames)

    def close(self) -> None:
        """Leaves the window, and closes it if no other game uses it. Must be called once."""
        self._open.discard(self)
        if self._is_dismissed:
            return
        others = [window for window in self._open if not window._is_dismissed]
        if self._channel is not None and all(other._channel is None for other in others):
            self._pygame.mixer.quit()
        if not others:
            self._pygame.display.quit()


class Grid:
    """The window of several games, which stand in rows and columns. It shows the first 16 of them.

    Args:
        title: Title of the window.
        count: Number of games.
        width: Width of a screen in pixels of the Atari 2600.
        height: Height of the tallest screen in rows.

    Raises:
        ImportError: If pygame is not installed.
        InvalidInput: If the computer has no display.
    """

    def __init__(self, title: str, count: int, width: int, height: int) -> None:
        self._count = min(count, MOST_SHOWN)
        self._columns = math.ceil(math.sqrt(self._count))
        rows = math.ceil(self._count / self._columns)
        self._width, self._height = width, height
        self._picture = np.zeros((rows * height, self._columns * width, 3), np.uint8)
        scale = SCALE if self._columns <= 2 else 1
        self._window = Window(title, self._columns * width, rows * height, False, scale)

    def show(self, screens: Iterable[tuple[int, npt.NDArray[np.uint8]]], frames: int) -> None:
        """Shows the screens of some games, and waits until the next ones are due.

        Args:
            screens: The index of each game, and its screen as a uint8 array of shape (height, width, 3).
            frames: Frames from one screen to the next.
        """
        for index, screen in screens:
            row, column = divmod(index, self._columns)
            top, left = row * self._height, column * self._width
            self._picture[top : top + screen.shape[0], left : left + self._width] = screen
        self._window.show(self._picture)
        self._window.wait(frames)

    def shows(self, index: int) -> bool:
        """Returns whether the window has a place for a game.

        Args:
            index: Index of the game.
        """
        return index < self._count

    def close(self) -> None:
        """Leaves the window, and closes it if no other game uses it. Must be called once."""
        self._window.close()
