"""Makes the machines of an AtariVectorEnv, in this process or on servers."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from .. import _core, images
from ..arguments import WrongType, WrongValue, integer, value_or
from ..vector_options import MOST_ENVS, VectorOptions
from ..wire.remote_machines import RemoteMachines
from ..wire.spread_machines import SpreadMachines
from .machines import Machines
from .results import Numbers

__all__ = ["Rom", "make_local_machines", "make_remote_machines", "parse_games"]

Rom: TypeAlias = str | os.PathLike[str] | bytes


def parse_games(
    game: str | Sequence[str] | None, num_envs: int | None, check: Callable[[str], None], is_local: bool = True
) -> tuple[list[str | None], Numbers]:
    """Reads the arguments `game` and `num_envs`.

    Args:
        game: Name of a game, one name for each environment, or None.
        num_envs: Number of environments, or None.
        check: Function that takes a name, and raises an exception if no game has it.
        is_local: Whether to check a single name. A server checks its names itself, since it may know others.

    Returns:
        The names of the games, and for each environment the index of its game.

    Raises:
        WrongType: If `game` is neither a name nor a list of names.
        WrongValue: If `num_envs` is out of range, or contradicts `game`.
    """
    if isinstance(game, str) or game is None:
        if game is not None and is_local:
            check(game)
        return [game], np.zeros(integer("num_envs", value_or(num_envs, 1), 1, MOST_ENVS), np.int32)
    if not isinstance(game, Sequence):
        raise WrongType(f"game is {game!r}; it takes a name, or a list of names")
    if num_envs is not None and num_envs != len(game):
        raise WrongValue(
            f"num_envs is {num_envs!r}; with a list of games, it must be the length of the list, {len(game)}"
        )
    integer("num_envs", len(game), 1, MOST_ENVS)
    for name in game:
        if not isinstance(name, str):
            raise WrongType(f"game has {name!r} in its list; it takes names of games")
    names: list[str | None] = list(dict.fromkeys(game))
    for each in names:
        check(str(each))
    return names, np.array([names.index(name) for name in game], np.int32)


def make_local_machines(
    names: list[str | None],
    game_of_env: Numbers,
    rom: Rom | None,
    options: VectorOptions,
    game_file: str | None = None,
) -> Machines:
    """Makes the machines of a vector in this process.

    Args:
        names: Names of the games.
        game_of_env: For each environment, the index of its game.
        rom: Path or bytes of the image, or None to find the images.
        options: Options of the environments.
        game_file: Path of a game file, or None.

    Returns:
        The machines.

    Raises:
        WrongValue: If `rom` is given for several games.
        MissingImage: If no image of a game is found.
    """
    if len(names) > 1 and rom is not None:
        raise WrongValue(f"there are {len(names)} games; rom and server require a single game")
    found = [(images.find(str(name)) if rom is None else rom, name) for name in names]
    return _core.VectorMachines(found, game_of_env, options._core_settings(), game_file, options._console())


def make_remote_machines(
    names: list[str | None],
    rom: Rom | None,
    options: VectorOptions,
    server: str | Sequence[str],
    token: str | None,
    timeout: float | None,
) -> Machines:
    """Makes the machines of a vector on one server, or on several.

    Args:
        names: Names of the games.
        rom: Path or bytes of the image to send, or None for the server's own.
        options: Options of the environments.
        server: Address of the server, or a list of addresses.
        token: Token that the server requires, or None.
        timeout: Seconds to wait for each reply, or None.

    Returns:
        The machines.

    Raises:
        WrongValue: If there are several games.
        InvalidInput: If a server does not play these options.
        ConnectionError: If no server answers.
    """
    if len(names) > 1:
        raise WrongValue(f"there are {len(names)} games; rom and server require a single game")
    game = str(names[0])  # a server needs the name of the game
    if isinstance(server, str):
        return RemoteMachines(server, token, timeout, game, rom, options)
    return SpreadMachines(server, token, timeout, game, rom, options)
