"""ALEInterface, with what needs nothing of the machine."""

from __future__ import annotations

import os
import struct
import zlib
from typing import Any

import numpy as np

from . import _core, images


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(rgb: np.ndarray[Any, np.dtype[np.uint8]]) -> bytes:
    """A picture, height x width x 3, as a PNG file."""
    height, width, _ = rgb.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each row begins with its filter: none
    rows[:, 1:] = rgb.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", head)
        + _chunk(b"IDAT", zlib.compress(rows.tobytes()))
        + _chunk(b"IEND", b"")
    )


class ALEInterface(_core.ALEInterface):
    """A game in this process, with the methods of ale_py.ALEInterface and some more."""

    def loadROM(self, rom: Any, game: str | None = None) -> None:
        """Powers the machine on. rom: a path, builtin:NAME, or the bytes of an image. game: whose rule it has; None: the
        image decides.
        """
        super().loadROM(images.given(rom), game)

    @staticmethod
    def isSupportedROM(rom: Any) -> str | None:
        """The name of the image's game, or None."""
        return _core.ALEInterface.isSupportedROM(images.given(rom))

    def saveScreenPNG(self, path: str | os.PathLike[str]) -> None:
        """Writes the screen as a PNG file, in which each pixel is doubled in width. Raises OSError."""
        name = os.fspath(path)  # a number would be an open file of the program
        picture = png(np.repeat(self.getScreenRGB(), 2, axis=1))
        with open(name, "wb") as file:
            file.write(picture)
