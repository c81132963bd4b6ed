"""The game of AtariEnv: its seeds, its image, its mode and its states."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from gymnasium.utils import seeding

from .. import images
from .._core import ALEState
from ..arguments import join
from ..errors import InvalidInput
from ..wire.remote import RemoteInterface
from .actions import EnvWithActions

__all__ = ["EnvWithGame"]


class EnvWithGame(EnvWithActions):
    """Base class of environments that load a game.

    Examples:
        >>> import racebeam
        >>> env = racebeam.AtariEnv("beamfall")
        >>> state = env.clone_state()
        >>> env.restore_state(state)
    """

    ale: Any
    sound_obs: bool | Literal["all"]
    _game: str | None
    _game_file: str | None
    _game_mode: int | None
    _game_difficulty: int | None
    _name: str
    _rom: images.Rom | None
    _sound: bool
    _two_player: bool

    def _set_keys(self, rules: str, sticky: float, limit: int | None, life_loss_truncates: bool) -> None:
        """Sets the keys that take effect when the game is loaded."""
        self.ale.setString("rules", rules)
        self.ale.setFloat("repeat_action_probability", sticky)
        if limit is not None:
            self.ale.setInt("max_num_frames_per_episode", limit)
        self.ale.setBool("truncate_on_loss_of_life", life_loss_truncates)
        self.ale.setBool("sound_obs", bool(self.sound_obs) or self._sound)
        self.ale.setBool("all_audio", self.sound_obs == "all")

    def _set_console(self, words: dict[str, str], numbers: dict[str, int | None]) -> None:
        """Sets the keys of the console for an image."""
        self.ale.setString("game_file", self._game_file or "")
        self.ale.setBool("unknown_images", self._game is None)
        for key, word in words.items():
            self.ale.setString(key, word)
        for key, number in numbers.items():
            if number is not None:
                self.ale.setInt(key, number)

    @property
    def state_hash(self) -> int:
        """Hash of the machine's state, as logs of episodes have it. Games with equal hashes continue equally."""
        return int(self.ale.state_hash())

    # Seeds and images

    def seed_game(self, seed: int | None = None) -> tuple[int, int]:
        """Seeds `np_random`, and the game from its next `load_game` on.

        Args:
            seed: Seed from 0, or None for a random one.

        Returns:
            The seeds of `np_random` and of the game, uint32.

        Raises:
            gymnasium.error.Error: If `seed` is invalid.
        """
        seeding.np_random(seed)  # raises Error if `seed` is invalid
        step_seed, game_seed = np.random.SeedSequence(seed).generate_state(2)
        self._np_random, _ = seeding.np_random(int(step_seed))
        self._np_random_seed = -1 if seed is None else seed
        self.ale.setInt("random_seed", int(game_seed.astype(np.int32)))
        return step_seed, game_seed

    def load_game(self) -> None:
        """Powers the console on, with the mode and the difficulty of the constructor.

        Raises:
            InvalidInput: If the game does not have the mode or the difficulty.
        """
        if isinstance(self.ale, RemoteInterface):
            self.ale.loadROM(self._rom, self._game)
        else:
            rom = images.find(str(self._game)) if self._rom is None else self._rom
            self.ale.loadROM(rom, self._game)
        if self._game is None:
            self._name = str(self.ale.getGame())
        mode = self._mode_for_two() if self._two_player else self._mode_for_one()
        if mode is not None:
            self.ale.setMode(mode)
        if self._game_difficulty is not None:
            self.ale.setDifficulty(self._game_difficulty)

    def _mode_for_one(self) -> int | None:
        modes: list[int] = self.ale.getAvailableModes()
        if (
            self._game_mode is not None
            and self._game_mode in self.ale.getTwoPlayerModes()
            and self._game_mode not in modes
        ):
            raise InvalidInput(
                f"{self._name} has mode {self._game_mode} only for two, which two_player=True plays; "
                f"for one it offers {join(modes)}"
            )
        return self._game_mode

    def _mode_for_two(self) -> int:
        modes: list[int] = self.ale.getTwoPlayerModes()
        if not modes:
            raise InvalidInput(f"two_player is True, but {self._name} has no mode for two")
        if self._game_mode is None:
            return modes[0]
        if self._game_mode not in modes:
            raise InvalidInput(f"{self._name} has no mode {self._game_mode} for two; it offers {join(modes)}")
        return self._game_mode

    # States

    def clone_state(self, include_rng: bool = False) -> ALEState:
        """Saves the state of the game, without `np_random`.

        Args:
            include_rng: Whether the state includes the generator of sticky actions.

        Returns:
            A state that can be pickled, and restored in another process.
        """
        state: ALEState = self.ale.cloneState(include_rng=include_rng)
        return state

    def restore_state(self, state: ALEState) -> None:
        """Restores a state of the game.

        Args:
            state: A state that `clone_state` returned.

        Raises:
            TypeError: If `state` is not an ALEState.
            InvalidInput: If the state belongs to another game.
        """
        if not isinstance(state, ALEState):
            raise TypeError(f"state has the type {type(state).__name__}; it takes an ALEState, as of clone_state()")
        self.ale.restoreState(state)
