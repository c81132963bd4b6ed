"""The fields of bytes in replies: their usual encodings and their shapes."""

from __future__ import annotations

import re
from collections.abc import Iterable

# generated: fields, from protocol/protocol.toml
# The encoding of each field when `observe` does not name one.
USUAL_ENCODING = {
    "ram": "hex",
    "tia": "hex",
    "state_hash": "hex",
    "screen": "rle",
    "rgb": "zlib",
    "grey": "zlib",
    "palette": "hex",
    "audio": "hex",
    "audio_all": "hex",
}
SHAPES: dict[str, tuple[int | str, ...]] = {
    "ram": (128,),
    "tia": (53,),
    "state_hash": (8,),
    "screen": ("height", 160),
    "rgb": ("height", 160, 3),
    "grey": ("height", 160),
    "palette": (256, 3),
    "audio": (512,),
    "audio_all": (-1, 512),
}
# end of fields

STACK_FIELD = re.compile(r"(?:grey|rgb)(\d+)x(\d+)x(\d+)")  # fields such as grey100x50x4


def field_shape(field: str, height: int) -> tuple[int, ...]:
    """Returns the shape of a field of bytes.

    Args:
        field: Name of the field.
        height: Rows of the machine's screen.
    """
    if field.startswith("grey84") and field.count("x") < 2:
        screens = field.partition("x")[2]
        return (int(screens), 84, 84) if screens else (84, 84)
    if stack := STACK_FIELD.fullmatch(field):
        width, rows, depth = map(int, stack.groups())
        return (depth, rows, width, 3) if field.startswith("rgb") else (depth, rows, width)
    return tuple(height if length == "height" else int(length) for length in SHAPES[field])


def field_encodings(fields: Iterable[str]) -> dict[str, str]:
    """Returns the encodings of the fields of bytes.

    Args:
        fields: Fields as `observe` takes them, such as "ram" or "screen:delta".

    Returns:
        The encoding of each field of bytes by its name.
    """
    encodings = {}
    for name, _, encoding in (field.partition(":") for field in fields):
        is_stack = name.startswith("grey84") or STACK_FIELD.fullmatch(name)
        encodings[name] = encoding or USUAL_ENCODING.get(name, "zlib" if is_stack else "")
    return {name: encoding for name, encoding in encodings.items() if encoding}
