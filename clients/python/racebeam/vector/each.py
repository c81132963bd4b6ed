"""The single environments of a vector: their attributes, screens and states."""

from __future__ import annotations

import operator
from typing import Any

from gymnasium import error

from .. import _core
from ..single.actions import meaning_of
from .base import VectorBase
from .machines import Machines
from .results import Pixels

__all__ = ["VectorOfEach"]


class VectorOfEach(VectorBase):
    """Base class of vectors that give access to each of their environments.

    Examples:
        >>> import racebeam
        >>> envs = racebeam.AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)
        >>> envs.get_attr("game")
        ('beamfall', 'updraft')
        >>> envs.close()
    """

    def render(self) -> tuple[Pixels, ...] | None:
        """Returns the screen of each environment.

        Returns:
            uint8 arrays of shape (height, 160, 3) if `render_mode` is "rgb_array"; None if it is "human", since the
            window shows the screens already.

        Raises:
            gymnasium.error.Error: If `render_mode` is None.
        """
        self._check_open()
        if self.render_mode is None:
            raise error.Error(
                "render_mode is None, so render() shows nothing; make the environments with render_mode='rgb_array'"
            )
        if self.render_mode == "human":
            return None
        return tuple(self._machines.screen(env) for env in range(self.num_envs))

    # Attributes of the environments

    def get_action_meanings(self, env: int = 0) -> list[str]:
        """Names the actions of an environment.

        Args:
            env: Index of the environment.

        Returns:
            The names in the order of their indices, such as ["NOOP", "FIRE"].

        Raises:
            IndexError: If the index is out of range.
        """
        self._check_open()
        self._check_env(env)
        return [meaning_of(number) for number in self._machines.actions_of(env)]

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Calls a method once for each environment, as SyncVectorEnv of Gymnasium does.

        Args:
            name: Name of a method whose first parameter is the index of an environment, such as "save" or
                "get_action_meanings".
            *args: Further arguments of each call.
            **kwargs: Keyword arguments of each call.

        Returns:
            What the calls return, in the order of the environments.

        Raises:
            AttributeError: If the environments have no such method.
        """
        if name not in ("get_action_meanings", "restore", "save"):
            raise AttributeError(f"environments have no method {name!r}; they have get_action_meanings, restore, save")
        method = getattr(self, name)
        return tuple(method(env, *args, **kwargs) for env in range(self.num_envs))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Reads an attribute of each environment, as SyncVectorEnv of Gymnasium does.

        Args:
            name: Name of an attribute. "game" is the name of the environment's game; other attributes of this class
                have the same value for all environments.

        Returns:
            The values in the order of the environments.

        Raises:
            AttributeError: If the environments lack the attribute.
        """
        if name == "game":
            return tuple(self._games)
        return (getattr(self, name),) * self.num_envs

    def _check_env(self, env: int) -> None:
        if not 0 <= self._index_of(env) < self.num_envs:
            raise IndexError(f"environment {env} is out of range; accepted: 0 to {self.num_envs - 1}")

    def _index_of(self, env: int) -> int:
        try:
            return operator.index(env)
        except TypeError:
            raise TypeError(f"environment {env!r} is not a whole number; accepted: 0 to {self.num_envs - 1}") from None

    def _open_machines(self) -> Machines:
        """Returns the machines that play the environments; for other modules of this package."""
        self._check_open()
        machines: Machines = self._machines
        return machines

    # States

    def save(self, env: int, *, include_rng: bool = True) -> _core.SavedMachine:
        """Saves the state of one environment, with its stack of screens.

        Args:
            env: Index of the environment.
            include_rng: Whether to save the generators of sticky actions and of no-ops, so that later episodes are the
                same.

        Returns:
            A state that can be pickled, copied and restored in another process.

        Raises:
            IndexError: If the index is out of range.
            TypeError: If it is not an integer.
        """
        self._check_open()
        return self._open_machines().save(self._index_of(env), include_rng)

    def restore(self, env: int, state: _core.SavedMachine) -> None:
        """Restores the state of one environment. `show` returns its observation.

        Args:
            env: Index of the environment.
            state: A state that `save` returned, of any environment of the same game.

        Raises:
            IndexError: If the index is out of range.
            TypeError: If the index is not an integer, or `state` is not a state.
            InvalidInput: If the state belongs to another game, or its observations have another shape.
        """
        self._check_open()
        if not isinstance(state, _core.SavedMachine):
            raise TypeError(f"the state has the type {type(state).__name__}; it takes what save() returned")
        self._machines.restore(self._index_of(env), state)
        self._first_seed = None
