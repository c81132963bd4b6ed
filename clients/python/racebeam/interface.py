"""ALEInterface: the compiled class and the methods that do not need the machine."""

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
    """Encodes a picture as a PNG file.

    Args:
        rgb: uint8 array of shape (height, width, 3).

    Returns:
        The contents of the file.
    """
    height, width, _ = rgb.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # the first byte of a row is 0: no filter
    rows[:, 1:] = rgb.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in chunks)


class ALEInterface(_core.ALEInterface):
    """One game in this process, with the methods of ale_py.ALEInterface and others.

    Two threads that use one interface take turns. `loadROM`, `reset_game`, `act` and `step` release the GIL. A copy by
    `copy.deepcopy` or `pickle` continues where the original is.

    Examples:
        >>> import racebeam
        >>> ale = racebeam.ALEInterface()
        >>> ale.setInt("random_seed", 123)
        >>> ale.loadROM(racebeam.find_image("beamfall"))
        >>> ale.act(racebeam.Action.FIRE)
        0
        >>> ale.getScreenRGB().shape
        (210, 160, 3)
    """

    def loadROM(self, rom: Any, game: str | None = None) -> None:
        """Inserts a cartridge and powers the machine on, with the settings that were made before.

        Args:
            rom: A path, "builtin:NAME", or the bytes of an image.
            game: Name of the game whose rules apply, or None to identify the image.

        Raises:
            InvalidInput: If the image cannot be read, or is unknown and `game` is None.
            TypeError: If `rom` is neither a path nor bytes.
        """
        super().loadROM(images.path_or_bytes(rom), game)

    @staticmethod
    def isSupportedROM(rom: Any) -> str | None:
        """Identifies an image.

        Args:
            rom: A path, "builtin:NAME", or the bytes of an image.

        Returns:
            The name of its game, or None if the image is unknown.
        """
        return _core.ALEInterface.isSupportedROM(images.path_or_bytes(rom))

    def saveScreenPNG(self, path: str | os.PathLike[str]) -> None:
        """Writes the screen as a PNG file of 320 columns: pixels of the Atari 2600 are twice as wide as high.

        Args:
            path: Path of the file.

        Raises:
            OSError: If the file cannot be written.
        """
        name = os.fspath(path)  # a number would be an open file of the program
        picture = png(np.repeat(self.getScreenRGB(), 2, axis=1))
        with open(name, "wb") as file:
            file.write(picture)
