"""Atari 2600 games for agents: bit-exact with ALE 0.12, in this process or on a server.

With Gymnasium installed, `import racebeam` registers ids such as racebeam/Pong-v5 and racebeam/PongNoFrameskip-v4:

    import gymnasium, racebeam
    env = gymnasium.make("racebeam/Beamfall-v5")

docs/python/ describes the package.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
from typing import TYPE_CHECKING, Any

from ._core import Action, ALEState, ConsoleAction, ControllerAction, LoggerMode
from .errors import InvalidInput, MissingImage, UnknownGame
from .extras import install_hint
from .images import find as find_image
from .images import find_all as find_images
from .images import games
from .interface import ALEInterface
from .wire.messages import Refused
from .wire.opening import connect, launch
from .wire.session import Session

if TYPE_CHECKING:
    import os

    from . import results as results
    from .env import AtariEnv
    from .single.record_log import RecordLog
    from .vector_env import AtariVectorEnv
    from .vector_options import VectorOptions

__version__ = importlib.metadata.version("racebeam")

__all__ = [
    "ALEInterface",
    "ALEState",
    "Action",
    "AtariEnv",
    "AtariVectorEnv",
    "ConsoleAction",
    "ControllerAction",
    "InvalidInput",
    "LoggerMode",
    "MissingImage",
    "RecordLog",
    "Refused",
    "Session",
    "UnknownGame",
    "VectorOptions",
    "connect",
    "find_image",
    "find_images",
    "games",
    "launch",
    "register",
    "register_ale_ids",
]

_NEED_GYMNASIUM = {
    "AtariEnv": ".env",
    "AtariVectorEnv": ".vector_env",
    "RecordLog": ".single.record_log",
    "VectorOptions": ".vector_options",
}
_HAS_GYMNASIUM = importlib.util.find_spec("gymnasium") is not None


def register_ale_ids() -> None:
    """Registers the ids of ale_py, such as ALE/Pong-v5 and Pong-v4, so that racebeam plays them.

    Raises:
        ImportError: If Gymnasium is not installed.
    """
    _check_gymnasium("register_ale_ids")
    from .registration import register_ale_ids as register

    register()


def register(game_file: str | os.PathLike[str], rom: Any, name: str | None = None) -> str:
    """Registers your own game with Gymnasium.

    Args:
        game_file: Path of the game file.
        rom: Path or bytes of the cartridge image.
        name: Name of the id in camel case. Default: that of the file, such as "MyGame" for my_game.toml.

    Returns:
        The id, such as "racebeam/MyGame-v5", for `gymnasium.make` and `gymnasium.make_vec`.

    Raises:
        ImportError: If Gymnasium is not installed.
        InvalidInput: If the file or the image cannot be read, or is wrong.
    """
    _check_gymnasium("register")
    from .registration import register as register_game

    return register_game(game_file, rom, name)


def _check_gymnasium(what: str) -> None:
    if not _HAS_GYMNASIUM:
        raise ImportError(f"racebeam.{what} needs Gymnasium; {install_hint('gymnasium')}")


def __dir__() -> list[str]:
    return sorted({*globals(), *(_NEED_GYMNASIUM if _HAS_GYMNASIUM else ())})


def __getattr__(name: str) -> Any:
    if name == "results":
        return importlib.import_module(".results", __name__)
    if name not in _NEED_GYMNASIUM:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    _check_gymnasium(name)
    return getattr(importlib.import_module(_NEED_GYMNASIUM[name], __name__), name)


if _HAS_GYMNASIUM:
    from .registration import register_own_ids

    register_own_ids()
