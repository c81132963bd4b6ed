"""EnvPool's interface: make("Pong-v5", env_type="gymnasium", num_envs=8), with its arguments and the keys of its infos.

    import sys, racebeam.envpool
    sys.modules["envpool"] = racebeam.envpool

runs code that was written for EnvPool 1.2.5 and Atari. What differs:

1.  The games are those of ALE 0.12, and not 0.7.5. Images are found as racebeam.find_image() finds them; base_path has no effect.
2.  make(env_type="gym") has the interface of Gym 0.21, as EnvPool 0.6 had it: reset() returns observations, and step() four values.
    gym_reset_return_info=True undoes that. make_gym() is make_gymnasium(), as in EnvPool 1.2.5.
3.  An action that is out of range is an IndexError; EnvPool reads past its actions. There are as many actions as environments, each
    environment is named once, and it is received before it is sent again; else an InvalidInput is raised.
4.  A wrong setting is an InvalidSetting: EnvPool raises AssertionError or TypeError, takes some, and ends the process for others.
5.  recv() raises InvalidInput where EnvPool waits for ever: fewer than batch_size environments play. close() ends the threads, and
    what is called after it raises ClosedEnvironmentError. Actions may be lists. reset() and async_reset() of all
    environments drop what was not received; in EnvPool, a later call returns it.
6.  With batch_size below num_envs, actions without env_id are of the environments that were received last; xla() needs env_id.
7.  Resizing is by area: use_inter_area_resize=False is taken where the screens keep their size, 210 x 160. max_num_players is 1.
    Screens have 1 to 160 columns and 9 to 210 rows; EnvPool enlarges them, too. stack_num ends at 16, noop_max and
    frame_skip at 1000; EnvPool takes more.
8.  A spec's least reward is negative. render() returns the pictures with render_mode=None, too; there is neither another size nor a
    window. make(env_type="gym") has gym_reset_return_info False in its config, unless it is given.
9.  register() is not there: the tasks are the games of racebeam. What is below the classes of racebeam.envpool.atari is EnvPool's
    own, but for the raw interface, _AtariEnvPool with _reset(), _send() and _recv().
"""

from racebeam.envpool.making import list_all_envs, make, make_dm, make_gym, make_gymnasium, make_spec
from racebeam.envpool.pools import DMEnvPool, EnvPool, GymEnvPool, GymnasiumEnvPool, TimeStep
from racebeam.envpool.spec import EnvSpec, InvalidSetting

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
