"""RecordLog: the episodes of an AtariEnv as a submission, which `racebeam verify` confirms (docs/evaluation.md)."""

from __future__ import annotations

import hashlib
import os
import warnings
from typing import Any, SupportsFloat

import gymnasium
import numpy as np

from ..arguments import MOST, integer
from ..env import AtariEnv
from ..episode_log import MOST_SEED, Origin, Start, play
from ..errors import InvalidInput
from ..vector_options import SEEDS
from .played import Played
from .submission import Submission

__all__ = ["RecordLog"]


class RecordLog(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Writes a log of each episode of an `AtariEnv` into a new folder, a submission.

    It wraps the environment directly, or what `gymnasium.make` returns: wrappers that change actions go around it. A
    game that `life_loss` splits into several episodes is one episode of the log. Without a seed, `reset` draws one
    and powers the game on with it, because a log contains the seed of its episode. `reset(seed=S)` also determines what
    later resets draw.

    An episode does not get a log if it was abandoned before its end, if a state was restored in it, if it has more than
    2,000,000 actions (400,000 with strengths), or if the log cannot be written. A warning then says why.

    Args:
        env: The environment. Its `frameskip` is a number, its `noop_max` 0, and it does not clip rewards.
        folder: Path of the folder, which does not exist yet.
        agent: Name of the agent: letters, digits, "_", "." and "-".
        version: Version of the agent.
        training_frames: Frames that the agent was trained on.
        trial: Number of the trial, from 1.
        agent_seed: Seed of the agent.
        phrase: The phrase that the seeds of the episodes follow from, or None.
        about: Other keys of agent.toml: "words", "link" and "role".

    Attributes:
        logged: Number of episodes with a log.
        unlogged: Number of episodes without one.

    Raises:
        InvalidInput: If an argument is wrong, or the environment plays what a log cannot repeat.
        ValueError: If a number is out of range.
        FileExistsError: If the folder exists.
        OSError: If the folder cannot be made.

    Examples:
        >>> import tempfile
        >>> import racebeam
        >>> env = racebeam.AtariEnv("beamfall", preset="machado2018")
        >>> env = racebeam.RecordLog(env, tempfile.mkdtemp() + "/mine", agent="still")
        >>> observation, info = env.reset()
        >>> over = False
        >>> while not over:
        ...     _, _, terminated, truncated, _ = env.step(0)
        ...     over = terminated or truncated
        >>> env.logged
        1
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        folder: str | os.PathLike[str],
        *,
        agent: str = "agent",
        version: str = "1",
        training_frames: int = 0,
        trial: int = 1,
        agent_seed: int = 0,
        phrase: str | None = None,
        about: dict[str, str] | None = None,
    ) -> None:
        super().__init__(env)
        self._base = _base_of(env)
        self._template = _template_of(self._base)
        seed = integer("agent_seed", agent_seed, *SEEDS)
        self._origin, self._phrase = Origin(agent, integer("trial", trial, 1, MOST), 1, seed), phrase
        self._seeds = np.random.default_rng()
        self._start: Start | None = None  # the start of the present episode
        self._played = Played()
        self.logged = self.unlogged = 0
        self._submission = Submission(
            folder,
            self._template,
            agent=agent,
            version=version,
            training_frames=training_frames,
            phrase=phrase,
            about=about,
        )

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode, at power-on if the game is over or has not begun.

        Args:
            seed: Seed, as `AtariEnv.reset` takes it; not with a phrase.
            options: As `AtariEnv.reset` takes them.

        Returns:
            The observation, and the info.

        Raises:
            InvalidInput: If a seed is given where the phrase gives it.
        """
        if seed is not None and self._phrase is not None:
            raise InvalidInput(f"the seed is {seed}; with a phrase, reset() takes no seed")
        if self._start is not None and seed is None and self._base._life_loss.continues:
            return self.env.reset(options=options)  # the next life of the same game
        self._leave()
        if seed is None:
            game_seed = self._next_seed()
            self._base.ale.setInt("random_seed", game_seed - 2**32 if game_seed >= 2**31 else game_seed)
            self._base.load_game()
            self._base._life_loss.continues = False
            result = self.env.reset(options=options)
        else:
            result = self.env.reset(seed=seed, options=options)
            game_seed = int(result[1]["seeds"][1])
            self._seeds = np.random.default_rng(seed)
        self._start = self._template._replace(seed=game_seed, difficulty=self._base.ale.getDifficulty())
        return result

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Plays an action, and writes the log if the game is over.

        Args:
            action: Index of an action.

        Returns:
            What the environment returns.
        """
        result = self.env.step(action)
        if self._start is not None:
            self._record(action)
            if self._base.ale.game_over():
                self._finish(self._start)
        return result

    def close(self) -> None:
        """Closes the environment."""
        self._leave()
        super().close()

    def _next_seed(self) -> int:
        if self._phrase is None:
            return int(self._seeds.integers(1, MOST_SEED, endpoint=True))
        facts = (self._phrase, self._template.game, str(self._origin.trial), str(self.logged + 1))
        digits = hashlib.sha256("\n".join(facts).encode()).hexdigest()[:8]
        return max(int(digits, 16) & 0x7FFFFFFF, 1)

    def _record(self, action: Any) -> None:
        number, strength, *_ = self._base._parse_action(action)
        if (why := self._played.add(number, strength)) is not None:
            self._skip(why)

    def _leave(self) -> None:
        if self._start is not None and self._played.actions:
            self._skip("it was left before its end")
        self._start, self._played = None, Played()

    def _finish(self, start: Start) -> None:
        played = self._played
        self._start, self._played = None, Played()
        if played.is_forgotten:
            return
        try:
            episode = play(start, played.actions, played.strengths)
            if not episode.is_over or episode.hashes[-1] != self._base.ale.state_hash():
                return self._skip("the same actions lead to another state; a state was restored in it, or RAM was set")
            origin = self._origin._replace(episode=self.logged + 1)
            self._submission.add(start, played.actions, episode, origin, played.strengths)
            self.logged += 1
        except (InvalidInput, OSError) as error:
            self._skip(str(error))

    def _skip(self, why: str) -> None:
        self.unlogged += 1
        warnings.warn(f"an episode of {self._template.game} has no log: {why}", stacklevel=4)


def _base_of(env: gymnasium.Env[Any, Any]) -> AtariEnv:
    """Returns the environment below the wrappers, if logs can have its episodes."""
    base = env.unwrapped
    if not isinstance(base, AtariEnv):
        raise InvalidInput(f"env is of class {type(env).__name__}; RecordLog takes an AtariEnv, or wrappers around one")
    low, high = base._reward_range or (-np.inf, np.inf)
    for wrong, sentence in (
        (base._two_player, "two_player is True; a log has the actions of player A"),
        (not isinstance(base._frameskip, int), f"frameskip is {base._frameskip!r}; a log takes a number"),
        (base._noop_max != 0, f"noop_max is {base._noop_max}; a log takes 0, and the no-ops as actions"),
        (base._game is None or base._game_file, "the game comes from a game file; a log takes a game of the catalogue"),
        ((low, high) != (-np.inf, np.inf), f"reward_range is ({low}, {high}); a log has whole rewards"),
    ):
        if wrong:
            raise InvalidInput(sentence)
    return base


def _template_of(base: AtariEnv) -> Start:
    """The start of the environment's episodes, without a seed and a difficulty."""
    frames: Any = base._frameskip
    words = {len(base.ale.getMinimalActionSet()): "minimal", len(base.ale.getLegalActionSet()): "full"}
    return Start(
        str(base._game),
        0,
        frames,
        base.ale.getFloat("repeat_action_probability"),
        base.ale.getInt("max_num_frames_per_episode"),
        "full" if base.continuous else words.get(len(base._action_set), "console"),
        base.ale.getString("rules"),
        "restart" if base._life_loss.word == "restart" else "ignored",
        base._game_mode,
        rom=base._rom,
    )
