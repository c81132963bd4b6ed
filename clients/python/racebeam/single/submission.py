"""The folder of a submission, which `racebeam verify` confirms (docs/evaluation.md)."""

from __future__ import annotations

import os
import pathlib
import sys
import time
from typing import IO, Any

from ..arguments import WrongType
from ..episode_log import Episode, Origin, Start, log_of
from .agent_file import agent_file

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

COLUMNS = (
    "unit,game,image_md5,agent,trial,episode,environment_seed,agent_seed,score,frames,decisions,end,lives,state_hash,"
    "log_digest,version"
)
PATIENCE = 5  # seconds, for the lock of the table
LOCKED_BYTE = 1 << 40  # of Windows: others cannot read what is locked, so it lies beyond the contents
# The presets of evaluation: frame_skip, sticky, action_set and max_episode_frames. Those with no-ops are missing, since
# no-ops that an environment plays are not in a log.
# generated: evaluation presets, from protocol/protocol.toml
PRESETS = {
    "paper2013": (5, 0.0, "full", 18000),
    "machado2018": (5, 0.25, "full", 18000),
}
# end of evaluation presets


class Submission:
    """A new folder that logs are added to.

    Args:
        folder: Path of the folder, which does not exist yet.
        start: The beginning of the episodes; its seed is ignored.
        agent: Name of the agent: letters, digits, "_", "." and "-".
        version: Version of the agent.
        training_frames: Frames that the agent was trained on.
        phrase: The phrase that the seeds of the episodes follow from, or None.
        about: Other keys of agent.toml: "words", "link" and "role".

    Raises:
        InvalidInput: If the name of the agent, the phrase or the link is wrong.
        WrongType: If an argument has a wrong type, or `about` has another key.
        WrongValue: If the number or the role is out of range.
        FileExistsError: If the folder exists.
        OSError: If the folder cannot be made.
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        start: Start,
        *,
        agent: str = "agent",
        version: str = "1",
        training_frames: int = 0,
        phrase: str | None = None,
        about: dict[str, str] | None = None,
    ) -> None:
        text = agent_file(agent, version, _preset_of(start), training_frames, phrase, about)
        self._folder = _new_folder(folder)
        _write(self._folder / "agent.toml", text)
        _write(self._folder / "results.csv", COLUMNS + "\n")

    def add(self, start: Start, actions: list[int], episode: Episode, origin: Origin, strengths: list[float]) -> None:
        """Writes the log of an episode and its row, or neither.

        Args:
            start: The beginning of the episode.
            actions: Its actions.
            episode: Its result.
            origin: Its player and number.
            strengths: How far each action turned a paddle.

        Raises:
            OSError: If the log or the row cannot be written.
        """
        log, row = log_of(start, actions, episode, origin, strengths)
        unit = self._folder / "logs" / row["unit"]
        unit.mkdir(parents=True, exist_ok=True)
        path = unit / f"{row['episode']}.episode"
        _write(path, log)
        try:
            _append(self._folder / "results.csv", ",".join(row[column] for column in COLUMNS.split(",")) + "\n")
        except OSError:
            path.unlink()
            raise


def _new_folder(folder: Any) -> pathlib.Path:
    try:
        path = pathlib.Path(folder)
        path.mkdir()
    except TypeError:
        raise WrongType(f"folder is {folder!r}; it takes a path") from None
    except FileExistsError as error:
        error.strerror = "a submission takes a new folder, and this one exists"
        raise
    return path


def _append(table: pathlib.Path, line: str) -> None:
    """Appends a whole line or nothing. Servers that log into the folder take the same lock."""
    with open(table, "ab", buffering=0) as file:
        _lock(file, table)
        size = file.seek(0, os.SEEK_END)
        text = line.encode()
        try:
            while text:
                text = text[file.write(text) :]
        except OSError:
            file.truncate(size)
            raise


def _lock(file: IO[bytes], path: pathlib.Path) -> None:
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return _try_lock(file)
        except (BlockingIOError, PermissionError):
            if time.monotonic() > end:
                raise TimeoutError(f"another program has had the lock of {path} for {PATIENCE} seconds") from None
        time.sleep(0.01)


def _try_lock(file: IO[bytes]) -> None:
    """Locks a file until it is closed."""
    if sys.platform == "win32":
        file.seek(LOCKED_BYTE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _write(path: pathlib.Path, contents: bytes | str) -> None:
    """Writes a whole file or none."""
    aside = path.with_name(f".{path.name}.part")
    try:
        aside.write_bytes(contents.encode() if isinstance(contents, str) else contents)
        aside.replace(path)
    except OSError:
        aside.unlink(missing_ok=True)
        raise


def _preset_of(start: Start) -> str:
    if start.rules != "ale-0.12" or start.life_loss != "ignored":
        return "other"
    settings = (start.frame_skip, start.sticky, start.action_set, start.max_episode_frames)
    return next((name for name, preset in PRESETS.items() if preset == settings), "other")
