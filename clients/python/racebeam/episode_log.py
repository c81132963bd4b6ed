"""Logs of episodes, which `racebeam verify` plays again. docs/episodes.md describes the file."""

from __future__ import annotations

import importlib.metadata
import os
import struct
import zlib
from collections.abc import Sequence
from typing import NamedTuple

from . import _core, images
from .errors import InvalidInput
from .interface import ALEInterface

__all__ = ["Episode", "replay", "write_log"]

MAGIC, FORMAT = b"RBEPISOD", 1
DECISIONS_PER_HASH = 256
MOST_SEED = 2**32 - 2  # ALE takes the next one for the time of day


class Episode(NamedTuple):
    """How an episode ended.

    Attributes:
        score: Sum of the rewards.
        frames: Frames that were played.
        decisions: Actions that were played. Those after the end of the episode are not.
        is_over: Whether the episode is over.
        is_terminated: Whether the game is over; else a limit of frames ended the episode.
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


def replay(
    game: str, actions: Sequence[int], *, seed: int, frame_skip: int, sticky: float = 0.0, max_episode_frames: int = 0
) -> Episode:
    """Plays actions in this process, from power-on to the end of the episode.

    Args:
        game: Name of the game.
        actions: Numbers of `Action`, 0 to 17.
        seed: Seed of `load`, from 1 to 2**32 - 2.
        frame_skip: Frames of an action.
        sticky: Probability that a frame repeats the previous action.
        max_episode_frames: Frames after which the episode is truncated; 0 for no limit.

    Returns:
        How the episode ended.

    Raises:
        UnknownGame: If no game has this name.
        MissingImage: If no image of the game is found.
        InvalidInput: If the seed, an action or a setting is out of range.

    Example:
        >>> from racebeam.episode_log import replay
        >>> replay("beamfall", [1] * 10, seed=7, frame_skip=4).frames
        40
    """
    images.check_name(game)
    if not 1 <= seed <= MOST_SEED:
        raise InvalidInput(f"the seed is {seed}; it takes 1 to {MOST_SEED}")
    ale = ALEInterface()
    ale.setInt("random_seed", seed - 2**32 if seed >= 2**31 else seed)
    ale.setInt("frame_skip", frame_skip)
    ale.setFloat("repeat_action_probability", sticky)
    ale.setInt("max_num_frames_per_episode", max_episode_frames)
    ale.loadROM(images.find(game), game)
    score, played, first = 0, 0, ale.getFrameNumber()
    hashes = []
    for action in actions:
        if ale.game_over():
            break
        score += ale.act(action)
        played += 1
        if played % DECISIONS_PER_HASH == 0:
            hashes.append(_core.state_hash(ale))
    if len(hashes) < played // DECISIONS_PER_HASH + 1:
        hashes.append(_core.state_hash(ale))
    is_terminated = ale.game_over(with_truncation=False)
    return Episode(score, ale.getFrameNumber() - first, played, ale.game_over(), is_terminated, ale.lives(), hashes)


def write_log(
    path: str | os.PathLike[str],
    game: str,
    actions: Sequence[int],
    *,
    seed: int,
    frame_skip: int,
    sticky: float = 0.0,
    max_episode_frames: int = 0,
    agent: str = "agent",
    agent_seed: int = 0,
) -> Episode:
    """Plays an episode again, and writes its log, which `racebeam verify PATH` confirms.

    Args:
        path: Path of the log. It ends in ".episode".
        game: Name of the game.
        actions: Numbers of `Action`, 0 to 17, up to the end of the episode.
        seed: Seed of `load`, from 1 to 2**32 - 2.
        frame_skip: Frames of an action.
        sticky: Probability that a frame repeats the previous action.
        max_episode_frames: Frames after which the episode is truncated; 0 for no limit.
        agent: Name of the agent, a word.
        agent_seed: Seed of the agent.

    Returns:
        How the episode ended.

    Raises:
        InvalidInput: If the episode is not over after the actions, or `replay` raises it.
        OSError: If the file cannot be written.
    """
    name = os.fspath(path)
    if not name.endswith(".episode"):
        raise InvalidInput(f"the log is {name!r}; its name must end in .episode")
    episode = replay(
        game, actions, seed=seed, frame_skip=frame_skip, sticky=sticky, max_episode_frames=max_episode_frames
    )
    if not episode.is_over:
        raise InvalidInput(f"the episode is not over after {len(actions)} actions; a log has a whole episode")
    md5, _ = _core.identify(images.find(game))
    end = "terminated" if episode.is_terminated else "truncated"
    text = (
        f"load {game} seed={seed} frame_skip={frame_skip} sticky={sticky:.9g} "
        f"max_episode_frames={max_episode_frames}\n"
        f"image {md5}\n"
        f"from unit={game}-{agent}-1 agent={agent} trial=1 episode=1 agent_seed={agent_seed} "
        f"version={importlib.metadata.version('racebeam')}\n"
        f"ended score={episode.score} frames={episode.frames} decisions={episode.decisions} end={end} "
        f"lives={episode.lives}\n\n"
    )
    hashes = struct.pack(f"<{len(episode.hashes)}Q", *episode.hashes)
    with open(name, "wb") as file:
        file.write(_seal(text.encode() + hashes + bytes(actions[: episode.decisions])))
    return episode


def _seal(contents: bytes) -> bytes:
    deflated = zlib.compress(contents, 9)
    head = MAGIC + struct.pack("<IQ", FORMAT, len(contents))
    return head + struct.pack("<I", zlib.crc32(head + deflated)) + deflated
