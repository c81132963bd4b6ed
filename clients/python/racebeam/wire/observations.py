"""Decodes the fields of replies to numbers and bytes."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from .encodings import DECODERS, apply_delta
from .fields import field_encodings, field_shape
from .messages import Texts, Values, parse_count, parse_number

Arrays = dict[str, bytearray]  # the bytes that the deltas of a field have made so far, by field


class WatchedGame(NamedTuple):
    """The deltas of a watched session. Other fields or another height start new deltas.

    Attributes:
        fields: Fields of the request.
        height: Rows of the screen.
        arrays: Bytes of each field.
    """

    fields: list[str]
    height: int
    arrays: Arrays


def _watched_fields(words: list[str]) -> list[str]:
    """Returns the fields of a request `watch NAME [since=FRAME] FIELD...`."""
    return [word for word in words[2:] if "=" not in word]


def _first_machine(words: list[str]) -> int:
    """Returns the machine of the first group: 0 for that of `load`, and from 1 for those of `open`.

    A request `restore NAME machine=I` is about machine I + 1.
    """
    restored = [word for word in words[2:] if word.startswith("machine=")] if words[:1] == ["restore"] else []
    return int(restored[0].partition("=")[2]) + 1 if restored else 0


class Observations:
    """The fields that a session observes, and the bytes that their deltas have made.

    Args:
        as_arrays: Whether bytes are returned as arrays of NumPy.

    Attributes:
        height: Rows of the screen of the loaded game.
    """

    def __init__(self, as_arrays: bool) -> None:
        self.height = 0
        self._as_arrays = as_arrays
        self._encodings: dict[str, str] = {}  # of the fields that observe chose
        self._arrays: dict[int, Arrays] = {}  # per machine; 0 is that of load
        self._watched: dict[str, WatchedGame] = {}  # by name

    def follow(self, words: list[str], first: Texts) -> None:
        """Keeps what a request changes about later replies.

        Args:
            words: Words of a request that the server granted.
            first: First group of its reply.

        Raises:
            KeyError: If the reply lacks a key.
            ValueError: If the reply is damaged.
        """
        command, *fields = words or [""]
        if command == "observe" and fields:
            self._encodings = field_encodings(fields)
            self._arrays.clear()
        elif command == "load":
            self.height = int(first["height"])
            self._arrays.clear()
        elif command == "open":
            self._arrays = {0: self._arrays.get(0, {})}

    def split_bytes(self, words: list[str], groups: list[Texts], data: bytes | bytearray) -> None:
        """Gives each field with the encoding raw its part of the bytes that followed a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply. Bytes replace the counts in them.
            data: Bytes that followed the reply.

        Raises:
            ValueError: If the counts do not add up to the bytes.
        """
        encodings, view, end = self._encodings_of(words), memoryview(data), 0
        for texts in groups:
            for key, text in texts.items():
                if encodings.get(key.removeprefix("final_")) == "raw":
                    begin, end = end, end + parse_count(text, len(data))
                    texts[key] = view[begin:end]
        if end != len(data):
            raise ValueError(f"its fields have {end} bytes, but {len(data)} followed its reply")

    def decode(self, words: list[str], groups: list[Texts]) -> list[Values]:
        """Decodes a reply.

        Args:
            words: Words of the request.
            groups: Groups of the reply.

        Returns:
            The groups with numbers, and bytes or arrays.

        Raises:
            IndexError: If a field is damaged.
            ValueError: If a field is damaged.
            zlib.error: If a field is damaged.
        """
        encodings = self._encodings_of(words)
        if words[:1] == ["watch"]:
            game = self._watched_game(words, groups[0])
            return [self._decode_group(texts, game.arrays, encodings, game.height) for texts in groups]
        return [
            self._decode_group(texts, self._arrays.setdefault(machine, {}), encodings, self.height)
            for machine, texts in enumerate(groups, _first_machine(words))
        ]

    def _encodings_of(self, words: list[str]) -> dict[str, str]:
        """Returns the encodings of the fields that a request names, or else of those that observe chose."""
        if words[:1] == ["watch"]:
            return field_encodings(_watched_fields(words))
        return field_encodings(words[1:]) if words[:1] == ["look"] and len(words) > 1 else self._encodings

    def _watched_game(self, words: list[str], texts: Texts) -> WatchedGame:
        fields, height = _watched_fields(words), int(texts.get("height", self.height))
        game = self._watched.get(words[1])
        if game is None or game[:2] != (fields, height):
            game = self._watched[words[1]] = WatchedGame(fields, height, {})
        return game

    def _decode_group(self, texts: Texts, arrays: Arrays, encodings: dict[str, str], height: int) -> Values:
        return {
            key: self._decode_value(key.removeprefix("final_"), text, arrays, encodings, height)
            for key, text in texts.items()
        }

    def _decode_value(self, field: str, text: str, arrays: Arrays, encodings: dict[str, str], height: int) -> Any:
        encoding = encodings.get(field)
        if encoding is None:
            return parse_number(text)
        if encoding != "delta":
            return self._shape(DECODERS[encoding](text), field, height)
        if field not in arrays:
            arrays[field] = bytearray(math.prod(field_shape(field, height)))
        apply_delta(arrays[field], text)
        return self._shape(bytes(arrays[field]), field, height)

    def _shape(self, data: bytes, field: str, height: int) -> Any:
        """Returns bytes as the session returns them."""
        if not self._as_arrays:
            return data
        import numpy

        return numpy.frombuffer(data, numpy.uint8).reshape(field_shape(field, height))
