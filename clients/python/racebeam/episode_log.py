"""Logs of episodes, which `racebeam verify` replays. docs/episodes.md describes the file."""

from __future__ import annotations

import hashlib
import importlib.metadata
import itertools
import operator
import os
import re
import struct
import zlib
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from . import _core, images
from .errors import InvalidInput
from .interface import ALEInterface

__all__ = ["Episode", "replay", "write_log"]

MAGIC, FORMAT = b"RBEPISOD", 1
DECISIONS_PER_HASH = 256
MOST_BYTES = 2**21  # before they are packed; readers refuse more
MOST_SEED = 2**32 - 2  # ALE takes the next one for the time of day
MOST_AGENT_SEED = 2**32 - 1
AGENT = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")


class Episode(NamedTuple):
    """The result of an episode.

    Attributes:
        score: Sum of the rewards.
        frames: Frames that were played.
        decisions: Actions that were played. Those after the end of the episode are not.
        is_over: Whether the episode is over.
        is_terminated: Whether the game is over. Otherwise, a limit of frames ended the episode.
        lives: Lives that are left.
        hashes: Hashes of the machine's state: after every 256 decisions, and at the end.
    """

    score: int
    frames: int
    decisions: int
    is_over: bool
    is_terminated: bool
    lives: int
    hashes: list[int]


class Start(NamedTuple):
    """The beginning of an episode at power-on, in the words of the line protocol's `load`.

    Attributes:
        game: Name of the game.
        seed: Seed of the game, from 0 to 2**32 - 2.
        frame_skip: Frames of an action.
        sticky: Probability that a frame repeats the previous action.
        max_episode_frames: Frames after which the episode is truncated; 0 for no limit.
        action_set: "full", "minimal" for the actions that have an effect in the game, or "console".
        rules: "ale-0.12" or "fixed".
        life_loss: "ignored", or "restart" if a lost life ends the episode.
        mode: Mode of the game, or None for its default.
        difficulty: Difficulty of the game. None: no reset follows power-on.
        rom: Path or bytes of the image, or None for that of the game.
    """

    game: str
    seed: int
    frame_skip: int
    sticky: float = 0.0
    max_episode_frames: int = 0
    action_set: str = "full"
    rules: str = "ale-0.12"
    life_loss: str = "ignored"
    mode: int | None = None
    difficulty: int | None = None
    rom: images.Rom | None = None

    @property
    def image(self) -> images.Rom:
        """The image of the game.

        Raises:
            MissingImage: If no image of the game is found.
        """
        return images.find(self.game) if self.rom is None else self.rom

    @property
    def settings(self) -> dict[str, str]:
        """The settings, as words of `load`."""
        words = {name: str(getattr(self, name)) for name in self._fields[1:-1] if getattr(self, name) is not None}
        return words | {"sticky": f"{self.sticky:.9g}"}

    def power_on(self) -> ALEInterface:
        """Returns an interface at the beginning of the episode.

        Raises:
            UnknownGame: If no game has this name.
            MissingImage: If no image of the game is found.
            InvalidInput: If a setting is out of range.
        """
        images.check_name(self.game)
        if not 0 <= self.seed <= MOST_SEED:
            raise InvalidInput(f"the seed is {self.seed}; it takes 0 to {MOST_SEED}")
        ale = ALEInterface()
        ale.setInt("random_seed", self.seed - 2**32 if self.seed >= 2**31 else self.seed)
        ale.setInt("frame_skip", self.frame_skip)
        ale.setFloat("repeat_action_probability", self.sticky)
        ale.setInt("max_num_frames_per_episode", self.max_episode_frames)
        ale.setString("rules", self.rules)
        ale.setBool("truncate_on_loss_of_life", self.life_loss == "restart")
        ale.loadROM(self.image, self.game)
        if self.mode is not None:
            ale.setMode(self.mode)
        if self.difficulty is not None:
            ale.setDifficulty(self.difficulty)
        if self.mode is not None or self.difficulty is not None:
            ale.reset_game()
        return ale


class Origin(NamedTuple):
    """The player of an episode, and its number.

    Attributes:
        agent: Name of the agent, a word.
        trial: Number of the trial, from 1.
        episode: Number of the episode, from 1.
        agent_seed: Seed of the agent.
    """

    agent: str = "agent"
    trial: int = 1
    episode: int = 1
    agent_seed: int = 0


def play(start: Start, actions: Sequence[int], strengths: Sequence[float] | None = None) -> Episode:
    """Plays actions from the start to the end of the episode.

    Args:
        start: How the episode begins.
        actions: Numbers of `Action`, 0 to 17, and of `ConsoleAction`, 18 to 25.
        strengths: For each action, how far a paddle is turned; 1 if None.

    Returns:
        How the episode ended.

    Raises:
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If an action or a setting is out of range.
    """
    ale = start.power_on()
    score, played, first = 0, 0, ale.getFrameNumber()
    hashes = []
    for action, strength in zip(actions, itertools.repeat(1.0) if strengths is None else strengths):
        if ale.game_over():
            break
        score += int(ale.step(action, strength, 1, _core.View.NONE)[1])
        played += 1
        if played % DECISIONS_PER_HASH == 0:
            hashes.append(_core.state_hash(ale))
    hashes.append(_core.state_hash(ale))
    is_terminated = _is_terminated(ale, start)
    return Episode(score, ale.getFrameNumber() - first, played, ale.game_over(), is_terminated, ale.lives(), hashes)


def _is_terminated(ale: ALEInterface, start: Start) -> bool:
    """Returns whether the episode terminated. With life_loss=restart, a lost life terminates it."""
    if start.life_loss != "restart" or ale.game_over(with_truncation=False):
        return bool(ale.game_over(with_truncation=False))
    return ale.game_over() and not 0 < start.max_episode_frames <= ale.getEpisodeFrameNumber()


def log_of(
    start: Start, actions: Sequence[int], episode: Episode, origin: Origin, strengths: Sequence[float] | None = None
) -> tuple[bytes, dict[str, str]]:
    """Creates the log of an episode, and its row of results.csv.

    Args:
        start: The beginning of the episode.
        actions: Its actions.
        episode: Its result.
        origin: Its player and number.
        strengths: For each action, how far a paddle was turned; 1 if None.

    Returns:
        The bytes of the log, and the row's columns by name.

    Raises:
        InvalidInput: If the log has more than 2 MiB before it is packed.
    """
    result = {
        "score": str(episode.score),
        "frames": str(episode.frames),
        "decisions": str(episode.decisions),
        "end": "terminated" if episode.is_terminated else "truncated",
        "lives": str(episode.lives),
    }
    source = {
        "unit": f"{start.game}-{origin.agent}-{origin.trial}",
        "agent": origin.agent,
        "trial": str(origin.trial),
        "episode": str(origin.episode),
        "agent_seed": str(origin.agent_seed),
        "version": importlib.metadata.version("racebeam"),
    }
    md5, _ = _core.identify(start.image)
    text = f"load {start.game} {_words(start.settings)}\nimage {md5}\nfrom {_words(source)}\nended {_words(result)}\n\n"
    hashes = struct.pack(f"<{len(episode.hashes)}Q", *episode.hashes)
    played = list(strengths or ())[: episode.decisions]
    turns = struct.pack(f"<{len(played)}f", *played) if any(strength != 1 for strength in played) else b""
    log = _seal(text.encode() + hashes + bytes(actions[: episode.decisions]) + turns)
    row = source | result | {"game": start.game, "image_md5": md5, "environment_seed": str(start.seed)}
    digest = hashlib.sha256(log).hexdigest()
    return log, row | {"state_hash": f"{episode.hashes[-1]:016x}", "log_digest": digest}


def check_agent(name: object) -> str:
    """Checks the name of an agent, which is a part of the names of folders.

    Args:
        name: The name.

    Returns:
        The name.

    Raises:
        InvalidInput: If it is not a text of 1 to 64 letters, digits, "-", "_" and ".", a letter or a digit first.
    """
    if not isinstance(name, str) or not AGENT.fullmatch(name):
        raise InvalidInput(
            f"agent is {name!r}; it takes 1 to 64 letters, digits, '-', '_' and '.', a letter or a digit first"
        )
    return name


def _numbers_of(actions: Iterable[Any]) -> list[int]:
    numbers = []
    for index, action in enumerate(actions):
        try:
            numbers.append(operator.index(getattr(action, "value", action)))
        except TypeError:
            raise TypeError(f"actions[{index}] is {action!r}; it takes a member of Action, or its number") from None
    return numbers


def _words(pairs: dict[str, str]) -> str:
    return " ".join(f"{key}={value}" for key, value in pairs.items())


def replay(
    game: str, actions: Iterable[Any], *, seed: int, frame_skip: int, sticky: float = 0.0, max_episode_frames: int = 0
) -> Episode:
    """Plays actions in this process, from power-on to the end of the episode.

    Args:
        game: Name of the game.
        actions: Members of `Action` and of `ConsoleAction`, or their numbers, 0 to 17 and 18 to 25.
        seed: Seed of `load`, from 0 to 2**32 - 2.
        frame_skip: Frames of an action.
        sticky: Probability that a frame repeats the previous action.
        max_episode_frames: Frames after which the episode is truncated; 0 for no limit.

    Returns:
        How the episode ended.

    Raises:
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If the seed, an action or a setting is out of range.
        TypeError: If an action is neither a member nor a number.

    Examples:
        >>> from racebeam.episode_log import replay
        >>> replay("beamfall", [1] * 10, seed=7, frame_skip=4).frames
        40
    """
    return play(Start(game, seed, frame_skip, sticky, max_episode_frames), _numbers_of(actions))


def write_log(
    path: str | os.PathLike[str],
    game: str,
    actions: Iterable[Any],
    *,
    seed: int,
    frame_skip: int,
    sticky: float = 0.0,
    max_episode_frames: int = 0,
    agent: str = "agent",
    agent_seed: int = 0,
) -> Episode:
    """Replays an episode, and writes its log, which `racebeam verify PATH` confirms.

    Args:
        path: Path of the log. It ends in ".episode".
        game: Name of the game.
        actions: Members of `Action` and of `ConsoleAction`, or their numbers, up to the end of the episode.
        seed: Seed of `load`, from 0 to 2**32 - 2.
        frame_skip: Frames of an action.
        sticky: Probability that a frame repeats the previous action.
        max_episode_frames: Frames after which the episode is truncated; 0 for no limit.
        agent: Name of the agent: letters, digits, "_", "." and "-".
        agent_seed: Seed of the agent, from 0 to 2**32 - 1.

    Returns:
        How the episode ended.

    Raises:
        InvalidInput: If the episode is not over after the actions, or too long for a log, the agent is wrong, or
            `replay` raises it.
        TypeError: If an action is neither a member nor a number.
        OSError: If the file cannot be written.
    """
    name = os.fspath(path)
    if not name.endswith(".episode"):
        raise InvalidInput(f"the log is {name!r}; its name must end in .episode")
    if not 0 <= agent_seed <= MOST_AGENT_SEED:
        raise InvalidInput(f"agent_seed is {agent_seed}; it takes 0 to {MOST_AGENT_SEED}")
    origin = Origin(check_agent(agent), agent_seed=agent_seed)
    start = Start(game, seed, frame_skip, sticky, max_episode_frames)
    numbers = _numbers_of(actions)
    episode = play(start, numbers)
    if not episode.is_over:
        raise InvalidInput(f"the episode is not over after {len(numbers)} actions; a log has a whole episode")
    log, _ = log_of(start, numbers, episode, origin)
    with open(name, "wb") as file:
        file.write(log)
    return episode


def _seal(contents: bytes) -> bytes:
    if len(contents) > MOST_BYTES:
        raise InvalidInput(f"the log has {len(contents)} bytes before it is packed; it takes at most {MOST_BYTES}")
    deflated = zlib.compress(contents, 9)
    head = MAGIC + struct.pack("<IQ", FORMAT, len(contents))
    return head + struct.pack("<I", zlib.crc32(head + deflated)) + deflated
