"""agent.toml of a submission. `racebeam verify` has the same rules, in agents/experiment/agent_file.cpp."""

import dataclasses
import pathlib
import re
from collections.abc import Callable
from typing import Any, NoReturn

from ..errors import BadInput, printable
from ..plan import PRESETS, read_toml
from ..results import ROLES

_MOST_BYTES = 2**16
_MOST_LETTERS = 4000  # of a text
_MOST_VERSION = 64  # letters
_MOST_QUOTE = 40  # letters of a value in an error
_MOST_FRAMES = 10**15 - 1
_AGENT = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
_LINK = re.compile(r"(https?://\S+)?", re.ASCII)
_PHRASE = re.compile(r'[^\x00-\x1f\x7f"\\]+')
_MOST_PHRASE_BYTES = 1000
_PRESETS = (*PRESETS, "other")
_REQUIRED = ("agent", "version", "preset", "training_frames")


@dataclasses.dataclass(frozen=True)
class About:
    """agent.toml."""

    agent: str
    version: str
    preset: str
    training_frames: int
    words: str = ""  # the authors'
    link: str = ""
    role: str = "learner"
    phrase: str = ""  # the seeds follow from it

    @property
    def name(self) -> str:
        """The name of the agent with its version."""
        return f"{self.agent} {self.version}"


_KEYS = tuple(field.name for field in dataclasses.fields(About))


def _is_phrase(text: str) -> bool:
    return _PHRASE.fullmatch(text) is not None and len(text.encode()) <= _MOST_PHRASE_BYTES


# By key: whether a text is good, and what is accepted.
_RULES: dict[str, tuple[Callable[[str], object], str]] = {
    "agent": (_AGENT.fullmatch, "1 to 64 letters, digits, '-', '_' and '.', a letter or a digit first"),
    "preset": (_PRESETS.__contains__, ", ".join(_PRESETS)),
    "link": (_LINK.fullmatch, "https://... or http://..."),
    "role": (ROLES.__contains__, ", ".join(ROLES)),
    "phrase": (_is_phrase, "1 to 1000 bytes, without quotation marks, backslashes and control characters"),
}


def read_about(path: pathlib.Path) -> About:
    """Reads agent.toml. Raises BadInput with a sentence if something in it is not as it must be."""
    found = read_toml(path, _MOST_BYTES)
    _check_keys(path, found)
    for key in _KEYS:
        if key == "training_frames":
            _check_frames(path, found[key])
        elif key in found:
            _check_text(path, key, found[key])
    return About(**found)


def _check_keys(path: pathlib.Path, found: dict[str, Any]) -> None:
    for key in found:
        if key not in _KEYS:
            raise BadInput(f"{path}: unknown key '{key}'; accepted: {', '.join(_KEYS)}")
    for key in _REQUIRED:
        if key not in found:
            raise BadInput(f"{path} lacks the key '{key}'; expected {', '.join(_REQUIRED)}")


def _check_frames(path: pathlib.Path, frames: object) -> None:
    if type(frames) is not int or not 0 <= frames <= _MOST_FRAMES:
        _refuse(path, "training_frames", frames, f"a whole number from 0 to {_MOST_FRAMES}")


def _check_text(path: pathlib.Path, key: str, value: object) -> None:
    if not isinstance(value, str):
        _refuse(path, key, value, "a text")
    least, most = (1, _MOST_VERSION) if key == "version" else (0, _MOST_LETTERS)
    if not least <= len(value) <= most:
        accepted = f"{least} to {most}" if least else f"at most {most}"
        raise BadInput(f"{path}: {key} has {len(value)} letters; expected {accepted}")
    is_good, accepted = _RULES.get(key, (lambda _: True, ""))
    if not is_good(value):
        _refuse(path, key, value, accepted)


def _refuse(path: pathlib.Path, key: str, value: object, accepted: str) -> NoReturn:
    raise BadInput(f"{path}: {key} is {_text_of(value)}; expected {accepted}")


def _text_of(value: object) -> str:
    """The value as errors show it."""
    if isinstance(value, str):
        return f"'{printable(value[:_MOST_QUOTE])}{'...' if len(value) > _MOST_QUOTE else ''}'"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return str(value)
    return "a list" if isinstance(value, list) else "a table" if isinstance(value, dict) else "a date or a time"
