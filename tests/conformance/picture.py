"""Two screens side by side in one PNG, and their difference."""

import struct
import zlib

import numpy

GAP = 8  # pixels between the panels
LIGHT, DARK = numpy.array([255, 0, 255], numpy.uint8), 4  # a difference; the divisor of what is the same


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(pixels):
    """Writes an array of height x width x 3 bytes to a file."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def write_comparison(path, screen, rgb, other_screen, other_rgb):
    """Draws reference, racebeam and difference. Returns how many pixels differ."""
    shape = len(other_screen) // 160, 160
    other = numpy.frombuffer(other_rgb, numpy.uint8).reshape(*shape, 3)
    rows = min(len(rgb), len(other))  # heights may differ, too
    differs = numpy.ones((max(len(rgb), len(other)), 160), bool)
    differs[:rows] = screen[:rows] != numpy.frombuffer(other_screen, numpy.uint8).reshape(shape)[:rows]
    differs[:rows] |= (rgb[:rows] != other[:rows]).any(axis=2)
    panels = []
    for panel in (rgb, other, numpy.where(differs[: len(rgb), :, None], LIGHT, rgb // DARK)):
        full = numpy.zeros((len(differs), 160, 3), numpy.uint8)
        full[: len(panel)] = panel
        panels += [full.repeat(2, axis=1), numpy.full((len(differs), GAP, 3), 128, numpy.uint8)]
    path.write_bytes(png(numpy.concatenate(panels[:-1], axis=1)))
    return int(differs.sum())
