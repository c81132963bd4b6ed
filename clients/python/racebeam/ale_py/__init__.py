"""The interface of ale_py 0.12.1.

Code that was written for ALE runs on racebeam after

    import sys, racebeam.ale_py
    sys.modules["ale_py"] = racebeam.ale_py

and `import racebeam.ale_py` registers ale_py's ids with Gymnasium, as `import ale_py` does. Observations, rewards, ends
and infos are equal to the byte for the same seeds and actions. These are the differences:

1.  loadROM() raises an exception for an image that is missing, cut or unknown; ale_py ends the process.
2.  A method that needs a game raises a RuntimeError before loadROM(); in ale_py most of them end the process.
3.  act() raises ValueError for a number without an action; ale_py plays NOOP. AtariEnv.step() refuses negative indices.
4.  The message about an invalid mode or difficulty lists the choices.
5.  A state has the picture, the sound and the sticky action of the moment of cloning; == compares them, too. In ale_py
    the first picture after restoring has old pixels. A frame that is open when a state is cloned, as in Tetris and
    Qbert after a reset, goes on after restoring; in ale_py it does not. serialize() gives other bytes, and only
    racebeam reads them.
6.  Equal ALEStates have equal hashes, and comparing one with another type gives False.
7.  A pickled or copied AtariEnv or ALEInterface continues the game; ale_py's copy begins anew.
8.  loadROM() also takes bytes, and builtin:beamfall or builtin:updraft, our own games. roms.get_rom_path() also
    searches RACEBEAM_ROMS, and prints nothing.
9.  Nothing is logged: setLoggerMode() has no effect.
10. SDL_SUPPORT is False: the settings display_screen and sound have no effect. AtariEnv(render_mode="human") opens a
    window with pygame. record_screen_dir and record_sound_filename take only "".
11. getInt(), getBool(), getFloat() and getString() each know only the settings of their type.
12. A closed AtariEnv raises ClosedEnvironmentError.
13. AtariVectorEnv takes the arguments that racebeam.AtariVectorEnv adds to those of ale_py. Seeds may have any integer
    type from 0, or be a list. autoreset_mode may be DISABLED, and render() works. Each object has its own metadata.
14. In AtariVectorEnv, an action that is out of range is an IndexError. A step in a child process after a fork is a
    RuntimeError; ale_py hangs. A wrong argument is an Error, an InvalidInput or an UnknownGame; ale_py takes some, and
    ends the process for others. After close(), ClosedEnvironmentError is raised; ale_py goes on.
15. The internals of ALEVectorInterface and xla() are missing: AutoresetMode, VectorXLAReset and VectorXLAStep. xla()
    does not need chex. The handle of closed environments is an error. ALEVectorInterface needs Gymnasium.
16. A paddle's strength, or a part of a continuous action, that is infinite or NaN is an InvalidInput; ale_py plays it.
17. AtariEnv refuses a repeat_action_probability outside of 0 to 1, a negative max_num_frames_per_episode, a
    continuous_action_threshold that is not a number, and a frameskip above 2,147,483,647. It takes integers of NumPy.
18. AtariVectorEnv has screens of 1 to 320 columns, and of 9 rows to twice those of the game's screen. stack_num ends
    at 16, noop_max and frameskip at 1000. ale_py takes more.
19. AtariVectorEnv with max_num_frames_per_episode=0 has no limit; ale_py truncates each step.
20. loadROM() refuses a reward_min above reward_max, a paddle_min above paddle_max, and a negative frame_skip. ale_py
    takes the first two, and hangs with the third.
21. An unknown image that has the file name of a game also has the game's properties, such as paddles or more rows. In
    ale_py it has only the rule, and the default properties.
"""

from __future__ import annotations

import importlib
import importlib.util
from typing import TYPE_CHECKING, Any

from .._core import Action, ALEState, LoggerMode
from .interface import ALEInterface

if TYPE_CHECKING:
    from ..env import AtariEnvStepMetadata as AtariEnvStepMetadata
    from ..registration import register_v0_v4_envs as register_v0_v4_envs
    from ..registration import register_v5_envs as register_v5_envs
    from .single import AtariEnv as AtariEnv
    from .vectors import ALEVectorInterface as ALEVectorInterface
    from .vectors import AtariVectorEnv as AtariVectorEnv

__version__ = "0.12.1"
SDL_SUPPORT = False

__all__ = ["ALEInterface", "ALEState", "Action", "LoggerMode", "SDL_SUPPORT"]

_HAS_GYMNASIUM = importlib.util.find_spec("gymnasium") is not None
_NEED_GYMNASIUM = {
    "ALEVectorInterface": "racebeam.ale_py.vectors",
    "AtariEnv": "racebeam.ale_py.single",
    "AtariEnvStepMetadata": "racebeam.env",
    "AtariVectorEnv": "racebeam.ale_py.vectors",
    "register_v0_v4_envs": "racebeam.registration",
    "register_v5_envs": "racebeam.registration",
}

# The submodules of ale_py. They use absolute imports: Python loads their files once more under names such as
# `ale_py.env`.
_SUBMODULES = ("_ale_py", "env", "registration", "roms", "vector_env")


def __dir__() -> list[str]:
    return sorted({*globals(), *((*_SUBMODULES, *_NEED_GYMNASIUM) if _HAS_GYMNASIUM else ())})


def __getattr__(name: str) -> Any:
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _NEED_GYMNASIUM:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_NEED_GYMNASIUM[name]), name)


if _HAS_GYMNASIUM:
    from ..registration import register_ale_ids

    register_ale_ids()
    __all__ += ["ALEVectorInterface", "AtariEnv", "AtariEnvStepMetadata", "AtariVectorEnv"]
