"""Reads the log of an episode (docs/episodes.md). Nothing is played again: `racebeam verify` does that."""

import base64
import dataclasses
import hashlib
import itertools
import json
import pathlib
import struct
import zlib

from ..csv_file import content_of
from ..errors import BadInput

_MOST_BYTES = 2 * 2**20  # of the file, and of its contents
_MAGIC = b"RBEPISOD"
_VERSION = 1
_HEAD = struct.Struct("<8sIQI")  # magic, version, size of the contents, checksum
_LINES = ("load", "image", "from", "ended")
_DECISIONS_PER_HASH = 256
_HASH_BYTES = 8
_STRENGTH_BYTES = 4
_ACTIONS = 18  # of a joystick
# All that docs/spec/controllers.md numbers: of a joystick, the console and a keyboard, then those with more buttons.
_CONSOLE_ACTIONS = frozenset({*range(38), *(first + action for first in (64, 96, 128, 160) for action in range(18))})


@dataclasses.dataclass(frozen=True)
class EpisodeLog:
    """What a log says."""

    game: str
    settings: dict[str, str]  # of `load`
    columns: dict[str, str]  # of the row of results.csv that belongs to it
    actions: bytes
    strengths: tuple[float, ...]  # of the paddle, for each action; empty if all are 1

    def link(self, title: str) -> str:
        """The part after # of an address of the viewer that replays the episode."""
        strengths = self.strengths or itertools.repeat(1.0)
        acts = [(key, len(list(run))) for key, run in itertools.groupby(zip(self.actions, strengths))]
        words = [_word(*act) + (f"*{times}" if times > 1 else "") for act, times in acts]
        text = json.dumps({"title": title, "game": self.game, "settings": self.settings, "acts": words})
        packed = base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip("=")
        return f"replay={packed}&frame=0"


def read_log(path: pathlib.Path) -> EpisodeLog:
    """Reads the log at `path`. Raises BadInput for a link, and for a file that is not a whole log."""
    if path.is_symlink():
        raise BadInput(f"{path} is a link; expected a file")
    content = content_of(path, _MOST_BYTES, "an episode log")
    contents = _opened(path, content)
    try:
        head, rest = contents.split(b"\n\n", 1)
        lines = [line.split(" ") for line in head.decode().split("\n")]
    except ValueError as error:
        raise BadInput(f"{path} is not an episode log: its text does not end; expected a whole log") from error
    if [line[0] for line in lines] != list(_LINES) or len(lines[0]) < 2 or len(lines[1]) != 2:
        raise BadInput(f"{path} is not an episode log: its text has other lines; expected {', '.join(_LINES)}")
    settings, values = _pairs(lines[0]), _pairs(lines[2]) | _pairs(lines[3])
    hashes, actions, strengths = _parts(path, values.get("decisions", ""), rest)
    _check_actions(path, actions, settings.get("action_set", ""))
    columns = values | {
        "game": lines[0][1],
        "image_md5": lines[1][1],
        "environment_seed": settings.get("seed", ""),
        "state_hash": hashes[-_HASH_BYTES:][::-1].hex(),
        "log_digest": hashlib.sha256(content).hexdigest(),
    }
    return EpisodeLog(lines[0][1], settings, columns, actions, strengths)


def _opened(path: pathlib.Path, content: bytes) -> bytes:
    """The contents that the seal protects."""
    if len(content) < _HEAD.size or not content.startswith(_MAGIC):
        raise BadInput(f"{path} is not an episode log; expected a file that begins with {_MAGIC.decode()}")
    _, version, size, checksum = _HEAD.unpack_from(content)
    if version != _VERSION:
        raise BadInput(f"{path} has version {version}; expected {_VERSION}")
    deflated = content[_HEAD.size :]
    if zlib.crc32(deflated, zlib.crc32(content[: _HEAD.size - 4])) != checksum:
        raise BadInput(f"{path} was altered or cut: its checksum does not fit; expected a whole log")
    if size > _MOST_BYTES:
        raise BadInput(f"{path} has contents of {size} bytes; expected at most {_MOST_BYTES}")
    stream = zlib.decompressobj()
    try:
        contents = stream.decompress(deflated, size + 1)
    except zlib.error as error:
        raise BadInput(f"{path} is damaged: {error}; expected a whole log") from error
    if len(contents) != size or not stream.eof:
        raise BadInput(f"{path} is damaged: its contents do not have {size} bytes; expected a whole log")
    return contents


def _pairs(words: list[str]) -> dict[str, str]:
    return dict(word.split("=", 1) for word in words if "=" in word)


def _word(action: int, strength: float) -> str:
    """The word of the line protocol's `act`."""
    return str(action) if strength == 1 else f"{action}@{strength:.9g}"


def _parts(path: pathlib.Path, decisions: str, rest: bytes) -> tuple[bytes, bytes, tuple[float, ...]]:
    """The hashes, the actions and the strengths."""
    count = int(decisions) if decisions.isascii() and decisions.isdecimal() and len(decisions) < 10 else -1
    hashes = _HASH_BYTES * (count // _DECISIONS_PER_HASH + 1)
    actions, strengths = rest[hashes : hashes + count], rest[hashes + count :]
    fits = count >= 0 and len(actions) == count and len(strengths) in (0, _STRENGTH_BYTES * count)
    if not fits:
        raise BadInput(f"{path} says decisions={decisions}, which does not fit its actions; expected a byte for each")
    return rest[:hashes], actions, struct.unpack(f"<{len(strengths) // _STRENGTH_BYTES}f", strengths)


def _check_actions(path: pathlib.Path, actions: bytes, action_set: str) -> None:
    accepted = _CONSOLE_ACTIONS if action_set == "console" else range(_ACTIONS)
    wrong = sorted(set(actions).difference(accepted))
    if wrong:
        raise BadInput(f"{path} has the action {wrong[0]}; expected 0 to 17, or others with action_set=console")
