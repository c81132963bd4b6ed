"""The interface of EnvPool 1.2.5 for Atari: make("Pong-v5", env_type="gymnasium", num_envs=8).

Code that was written for EnvPool runs on racebeam after

    import sys, racebeam.envpool
    sys.modules["envpool"] = racebeam.envpool

The arguments and the keys of the infos are those of EnvPool. These are the differences:

1.  The games are those of ALE 0.12 instead of 0.7.5. Images are found as racebeam.find_image() finds them; base_path
    has no effect.
2.  make(env_type="gym") has the interface of Gym 0.21, as in EnvPool 0.6: reset() returns observations, and step() four
    values. gym_reset_return_info=True selects the other interface. make_gym() is make_gymnasium(), as in EnvPool 1.2.5.
3.  An action that is out of range is an IndexError; EnvPool reads past its actions. There must be as many actions as
    environments. Each environment must be named once, and received before it is sent again. Otherwise an InvalidInput
    is raised.
4.  A wrong setting is an InvalidSetting; EnvPool raises AssertionError or TypeError, takes some, and ends the process
    for others.
5.  recv() raises InvalidInput if fewer than batch_size environments play; EnvPool waits for ever. close() ends the
    threads, and later calls raise ClosedEnvironmentError. Actions may be lists. reset() and async_reset() of all
    environments drop what was not received; in EnvPool, a later call returns it.
6.  With batch_size below num_envs, actions without env_id are for the environments that were received last; xla() needs
    env_id.
7.  Resizing is by area: use_inter_area_resize=False is accepted only for screens of full size, 210 x 160.
    max_num_players is 1. Screens have 1 to 320 columns and 9 to 420 rows. stack_num ends at 16, noop_max and frame_skip
    at 1000. EnvPool takes more.
8.  The least reward in a spec is negative. render() also returns the screens with render_mode=None; it has no other
    size, and no window. make(env_type="gym") has gym_reset_return_info False in its config, unless it is given.
9.  register() is missing: the tasks are the games of racebeam. The internals of racebeam.envpool.atari are missing,
    except for the raw interface, _AtariEnvPool with _reset(), _send() and _recv().

It runs on Gymnasium 0.29.1, and on 1.1 and later.
"""

import importlib.util as _util

from racebeam.extras import install_hint as _install_hint

if _util.find_spec("gymnasium") is None:
    raise ImportError(f"racebeam.envpool needs Gymnasium; {_install_hint('gymnasium')}")

from racebeam.envpool.making import list_all_envs, make, make_dm, make_gym, make_gymnasium, make_spec
from racebeam.envpool.pools import DMEnvPool, EnvPool, GymEnvPool, GymnasiumEnvPool
from racebeam.envpool.spec import EnvSpec, InvalidSetting
from racebeam.envpool.types import TimeStep

__version__ = "1.2.5"

__all__ = [
    "make",
    "make_dm",
    "make_gym",
    "make_gymnasium",
    "make_spec",
    "list_all_envs",
    "EnvSpec",
    "EnvPool",
    "DMEnvPool",
    "GymnasiumEnvPool",
    "GymEnvPool",
    "InvalidSetting",
    "TimeStep",
]
