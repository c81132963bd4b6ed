"""agent.toml: the player of a submission, as `racebeam verify` and the board read it (docs/evaluation.md)."""

from __future__ import annotations

import json
import re
from typing import Any

from ..arguments import WrongType, check_choice, integer
from ..episode_log import check_agent
from ..errors import InvalidInput

__all__ = ["agent_file"]

KEYS = ("words", "link", "role")  # of `about`
ROLES = ("learner", "planner", "baseline")
MOST_FRAMES = 10**15 - 1  # the board accepts as many
PHRASE = re.compile(r'[^\x00-\x1f\x7f"\\]+')
LINK = re.compile(r"(https?://\S+)?", re.ASCII)
MOST_BYTES = 1000  # of a phrase
MOST_VERSION = 64  # letters
MOST_LETTERS = 4000  # of another text


def agent_file(
    agent: str, version: str, preset: str, training_frames: int, phrase: str | None, about: dict[str, str] | None
) -> str:
    """Returns the text of agent.toml.

    Args:
        agent: Name of the agent: letters, digits, "_", "." and "-".
        version: Version of the agent: 1 to 64 letters.
        preset: Preset of the settings.
        training_frames: Frames that the agent was trained on.
        phrase: The phrase that the seeds of the episodes follow from, or None.
        about: Other keys: "words", "link" and "role".

    Raises:
        InvalidInput: If the agent, the phrase or the link is wrong, or a text is too long.
        WrongType: If an argument has a wrong type, or `about` has another key.
        WrongValue: If the number or the role is out of range.
    """
    words: dict[str, object] = {
        "agent": check_agent(agent),
        "version": _text("version", version, 1, MOST_VERSION),
        "preset": preset,
        "training_frames": integer("training_frames", training_frames, 0, MOST_FRAMES),
        **({} if phrase is None else {"phrase": _phrase(phrase)}),
        **_check_about(about or {}),
    }
    return "".join(f"{key} = {_toml(word)}\n" for key, word in words.items())


def _check_about(about: Any) -> dict[str, str]:
    if not isinstance(about, dict) or not about.keys() <= set(KEYS):
        raise WrongType(f"about is {about!r}; it takes a dict with {', '.join(KEYS)}")
    words = {key: _text(key, word) for key, word in about.items()}
    if "role" in words:
        check_choice("role", words["role"], ROLES)
    if "link" in words and not LINK.fullmatch(words["link"]):
        raise InvalidInput(f"link is {words['link']!r}; it takes https://... or http://...")
    return words


def _text(name: str, value: Any, least: int = 0, most: int = MOST_LETTERS) -> str:
    if not isinstance(value, str):
        raise WrongType(f"{name} is {value!r}; it takes a text")
    if not least <= len(value) <= most:
        raise InvalidInput(f"{name} has {len(value)} letters; it takes {f'{least} to' if least else 'at most'} {most}")
    return value


def _phrase(value: Any) -> str:
    phrase = _text("phrase", value)
    if not PHRASE.fullmatch(phrase) or len(phrase.encode()) > MOST_BYTES:
        raise InvalidInput(
            f"phrase is {phrase!r}; it takes 1 to {MOST_BYTES} bytes, without quotation marks, backslashes and control "
            "characters"
        )
    return phrase


def _toml(word: object) -> str:
    """Returns a text or a number as TOML has it, which is as in JSON but for the character 127."""
    return json.dumps(word, ensure_ascii=False).replace("\x7f", "\\u007f")
