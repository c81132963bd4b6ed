"""A window that shows a game and plays its sound, by pygame."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FRAMES_A_SECOND = 60
SAMPLES_A_FRAME = 512
SCALE = 2  # of a pixel, which is twice as wide as it is high


class Window:
    """One game's. Raises ImportError, with what to install, where there is no pygame."""

    def __init__(self, title: str, width: int, height: int, sound: bool) -> None:
        try:
            import pygame
        except ModuleNotFoundError as missing:
            raise ImportError('render_mode "human" needs pygame; install it with: pip install "racebeam[human]"') from missing
        self._pygame: Any = pygame
        self._size = (2 * SCALE * width, SCALE * height)
        pygame.display.init()
        pygame.display.set_caption(title)
        self._screen = pygame.display.set_mode(self._size)
        self._clock = pygame.time.Clock()
        self._channel = self._open_sound() if sound else None

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
        self._pygame.transform.scale(picture, self._size, self._screen)
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
        """Once; the window is gone then."""
        if self._channel is not None:
            self._pygame.mixer.quit()
        self._pygame.display.quit()
