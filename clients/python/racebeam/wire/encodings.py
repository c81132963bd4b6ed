"""The encodings of bytes in replies."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Callable
from typing import Any


def decode_runs(data: bytes) -> bytes:
    """Decodes runs.

    Args:
        data: Pairs of a value and a length.

    Returns:
        The values, repeated.
    """
    return b"".join(data[at : at + 1] * data[at + 1] for at in range(0, len(data), 2))


def apply_delta(array: bytearray, text: str) -> None:
    """Changes an array by a delta.

    Args:
        array: The bytes before; the bytes after, when the function returns.
        text: The delta in hexadecimal.

    Raises:
        ValueError: If the delta does not fit the array, a part of which may have changed.
    """
    data, at, place = bytes.fromhex(text), 0, 0
    while at < len(data):
        place += data[at] << 8 | data[at + 1]
        runs, at = data[at + 2], at + 3
        for _ in range(runs):
            value, length, at = data[at], data[at + 1], at + 2
            if place + length > len(array):
                raise ValueError(f"a delta reaches byte {place + length} of {len(array)}")
            array[place : place + length] = bytes([value]) * length
            place += length


def decode_rewards(text: str) -> list[int]:
    """Decodes the rewards of a branch.

    Args:
        text: Rewards with their repetitions, such as "0*12,1,0*3".

    Returns:
        The reward of each act.
    """
    rewards: list[int] = []
    for run in filter(None, text.split(",")):
        reward, _, times = run.partition("*")
        rewards += [int(reward)] * int(times or 1)
    return rewards


DECODERS: dict[str, Callable[[Any], bytes]] = {
    "hex": bytes.fromhex,
    "rle": lambda text: decode_runs(bytes.fromhex(text)),
    "base64": base64.b64decode,
    "zlib": lambda text: zlib.decompress(base64.b64decode(text)),
    "raw": bytes,
}
