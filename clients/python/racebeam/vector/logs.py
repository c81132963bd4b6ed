"""Logs of the episodes of an AtariVectorEnv, as a submission that `racebeam verify` confirms (docs/evaluation.md)."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arguments import MOST, WrongType, integer, value_or
from ..episode_log import MOST_SEED, Origin, Start, play
from ..errors import InvalidInput
from ..single.played import Played
from ..single.submission import Submission
from ..vector_options import SEEDS, VectorOptions
from ..wire.action_words import joystick_actions
from .autoreset import AutoresetMode
from .machines import Actions, Joysticks, Seeds
from .making import Rom
from .results import Bools, Results

ARGUMENTS = ("folder", "agent", "version", "training_frames", "trial", "agent_seed", "about")


class VectorLogs:
    """Writes a log of each game of a vector of environments. Environment i plays the trial `trial` + i.

    A log begins at power-on, so each game begins with another seed. A game does not get a log if it was left before its
    end, if a state was restored in it, if it has more than 2,000,000 actions (400,000 with strengths), or if the log
    cannot be written. A warning then says why.

    Args:
        arguments: A dict with "folder", and with other arguments of `RecordLog` except `env` and `phrase`.
        options: The options of the environments.
        games: Name of the game of each environment.
        rom: The image of the game, or None to find it by the game's name.
        machines: The machines that play them.

    Attributes:
        logged: Number of games with a log.
        unlogged: Number of games without one.

    Raises:
        InvalidInput: If an argument is wrong, or the environments play what a log cannot repeat.
        FileExistsError: If the folder exists.
        OSError: If the folder cannot be made.
    """

    def __init__(
        self,
        arguments: dict[str, Any],
        options: VectorOptions,
        games: Sequence[str | None],
        rom: Rom | None,
        machines: Any,
    ) -> None:
        _check(options, games)
        self._options, self._machines = options, machines
        self._starts = [_start_of(options, str(game), rom) for game in games]
        words = _words_of(arguments)
        trial = integer("trial", words.pop("trial", 1), 1, MOST)
        agent_seed = integer("agent_seed", words.pop("agent_seed", 0), *SEEDS)
        origin = Origin(words.get("agent", "agent"), trial, 1, agent_seed)
        self._origins = [origin._replace(trial=origin.trial + env) for env in range(len(games))]
        self._submission = Submission(words.pop("folder"), self._starts[0], **words)
        self._numbers = [machines.actions_of(env) for env in range(len(games))]
        self._seeds = options.seed + np.arange(len(games), dtype=np.int64)  # seeds of the present games
        self._games = [_Game() for _ in games]
        self._is_over = np.zeros(len(games), np.bool_)  # whether the episode is over
        self.logged = self.unlogged = 0

    def seeds_of_reset(self, seeds: Seeds | None, mask: Bools | None) -> Seeds:
        """Returns the seeds of a reset. An unseeded environment gets its next seed.

        Args:
            seeds: Seeds of the caller, where -1 means unseeded, or None.
            mask: The environments to reset, or None for all.

        Returns:
            A seed for each environment.
        """
        chosen = np.ones(len(self._games), np.bool_) if mask is None else mask
        complete = np.full(len(self._games), -1, np.int64) if seeds is None else np.array(seeds)
        for env in np.flatnonzero(chosen & (complete < 0)).tolist():
            complete[env] = self._next_seed(env)
        return complete

    def record_reset(self, seeds: Seeds, mask: Bools | None) -> None:
        """Records a reset.

        Args:
            seeds: What `seeds_of_reset` returned.
            mask: The environments that were reset, or None for all.
        """
        chosen = np.ones(len(self._games), np.bool_) if mask is None else mask
        self._is_over[chosen] = False
        for env in np.flatnonzero(chosen).tolist():
            self._leave(env)
            self._begin(env, int(seeds[env]))

    def record_step(self, actions: Actions | Joysticks, results: Results) -> None:
        """Records a step, and writes the logs of games that are over.

        Args:
            actions: An index into the action set for each environment, or its joystick.
            results: What the step returned.
        """
        played = ~self._is_over
        ends = results.game_over | results.truncated
        if self._options.life_loss == "restart":
            ends |= results.terminated
        stays = self._options.autoreset_mode is AutoresetMode.DISABLED
        self._is_over = ends | (~played & stays)
        numbers, strengths = self._acts(actions)
        for env in np.flatnonzero(played).tolist():
            self._record(env, numbers[env], strengths[env], int(results.raw_rewards[env]))
            if ends[env]:
                self._finish(env, results)

    def _acts(self, actions: Actions | Joysticks) -> tuple[list[int], list[float]]:
        """Returns the number of each environment's action, and its strength."""
        if self._options.continuous:
            acts = joystick_actions(actions.astype(np.float32), self._options.continuous_action_threshold)
            return acts[0].tolist(), acts[1].tolist()
        return [self._numbers[env][action] for env, action in enumerate(actions)], [1.0] * len(self._games)

    def _record(self, env: int, action: int, strength: float, reward: int) -> None:
        game = self._games[env]
        game.score += reward
        if (why := game.played.add(action, strength)) is not None:
            self._skip(env, why)

    def _finish(self, env: int, results: Results) -> None:
        game, self._games[env] = self._games[env], _Game()
        if not game.played.is_forgotten and (why := self._write(env, game, results)) is not None:
            self._skip(env, why)
        if self._options.autoreset_mode is AutoresetMode.NEXT_STEP:
            seed = self._next_seed(env)
            self._machines.end_episodes(np.array([env], np.int32), np.array([seed], np.int64))
            self._begin(env, seed)

    def _write(self, env: int, game: _Game, results: Results) -> str | None:
        """Writes the log of a game. Returns why it cannot, or None."""
        start = self._starts[env]._replace(seed=int(self._seeds[env]))
        actions, strengths = game.played.actions, game.played.strengths
        try:
            episode = play(start, actions, strengths)
            seen = (game.score, results.episode_frames[env], results.lives[env], len(actions))
            if not episode.is_over or seen != (episode.score, episode.frames, episode.lives, episode.decisions):
                return "the same actions lead to another end; a state was restored in it"
            self._submission.add(start, actions, episode, self._origins[env], strengths)
        except (InvalidInput, OSError) as error:
            return str(error)
        self._origins[env] = self._origins[env]._replace(episode=self._origins[env].episode + 1)
        self.logged += 1
        return None

    def _leave(self, env: int) -> None:
        if self._games[env].played.actions:
            self._skip(env, "it was left before its end")

    def _begin(self, env: int, seed: int) -> None:
        self._seeds[env], self._games[env] = seed, _Game()

    def _next_seed(self, env: int) -> int:
        """Returns the next seed of an environment. Seeds count up over all environments; 1 follows the largest."""
        return int((self._seeds[env] + len(self._games) - 1) % MOST_SEED) + 1

    def _skip(self, env: int, why: str) -> None:
        self.unlogged += 1
        warnings.warn(f"a game of environment {env}, {self._starts[env].game}, has no log: {why}", stacklevel=5)


class _Game:
    """The actions and the score of a game since power-on."""

    def __init__(self) -> None:
        self.played = Played()
        self.score = 0


def _words_of(arguments: Any) -> dict[str, Any]:
    if not isinstance(arguments, dict) or "folder" not in arguments or not arguments.keys() <= set(ARGUMENTS):
        raise _wrong(arguments)
    return dict(arguments)


def _wrong(arguments: Any) -> WrongType:
    return WrongType(f"log is {arguments!r}; it takes a dict with folder, and optionally {', '.join(ARGUMENTS[1:])}")


def _check(options: VectorOptions, games: Sequence[str | None]) -> None:
    for wrong, sentence in (
        (None in games, "game is None; a log takes the name of a game"),
        (
            options.autoreset_mode is AutoresetMode.SAME_STEP,
            "autoreset_mode is SameStep; a log takes NextStep or Disabled",
        ),
        (not options.is_sync, f"batch_size is {options.batch_size}; a log takes {options.num_envs}, num_envs"),
        (options.noop_max > 1, f"noop_max is {options.noop_max}; a log takes 0, and the no-ops as actions"),
        (options.use_fire_reset, "use_fire_reset is True; a log takes False, and FIRE as an action"),
        (
            options.life_loss == "end",
            "life_loss is 'end', which stops a step at a lost life; a log takes ignored, reported or restart",
        ),
        (options.start != "fire-noops", f"start is {options.start!r}; a log takes 'fire-noops'"),
    ):
        if wrong:
            raise InvalidInput(sentence)


def _start_of(options: VectorOptions, game: str, rom: Rom | None) -> Start:
    """Returns the start of an environment's games, without a seed.

    It has a difficulty, since setting one resets the game after power-on, as an environment does.
    """
    return Start(
        game,
        0,
        options.frameskip,
        options.repeat_action_probability,
        options.max_num_frames_per_episode,
        "full" if options.continuous or options.action_set == "legal" else options.action_set,
        options.rules,
        "restart" if options.life_loss == "restart" else "ignored",
        options.mode,
        value_or(options.difficulty, 0),
        rom,
    )
