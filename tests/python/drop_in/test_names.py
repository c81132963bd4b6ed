"""racebeam.ale_py has the names of ale_py, and code for ale_py runs on it."""

import inspect
import re
import sys

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import ale_py.env
import ale_py.registration
import ale_py.roms
import ale_py.vector_env
import racebeam
import racebeam.ale_py as drop_in
import racebeam.ale_py._ale_py
from ale_py import _ale_py
from both import INTERNAL, PONG, in_process


class TestNames:
    def test_every_public_name_is_there(self):
        for ours, theirs in (
            (drop_in, ale_py),
            (
                drop_in._ale_py
                if hasattr(drop_in, "_ale_py")
                else __import__("racebeam.ale_py._ale_py", fromlist=["x"]),
                _ale_py,
            ),
        ):
            names = {name for name in dir(theirs) if not name.startswith("_")} - INTERNAL
            names -= {
                "importlib",
                "metadata",
                "os",
                "platform",
                "warnings",
                "packagedir",
                "env",
                "registration",
                "roms",
                "vector_env",
            }
            assert {name for name in names if not hasattr(ours, name)} == set()
        for module in ("env", "registration", "roms", "vector_env"):
            ours = __import__(f"racebeam.ale_py.{module}", fromlist=["x"])
            theirs = sys.modules[f"ale_py.{module}"]
            additions = {
                name
                for name, value in vars(theirs).items()
                if getattr(value, "__module__", "").startswith("ale_py.") and not name.startswith("_")
            }
            assert {name for name in additions if not hasattr(ours, name)} == set(), module
        assert set(ale_py.__all__) - INTERNAL == set(drop_in.__all__) - INTERNAL

    def test_every_method_is_there(self):
        for name in ("ALEInterface", "ALEState", "ALEVectorInterface", "AtariEnv", "AtariVectorEnv"):
            theirs, ours = getattr(ale_py, name), getattr(drop_in, name)
            assert {method for method in dir(theirs) if not hasattr(ours, method)} - {"__slotnames__"} == set(), name

    def test_the_arguments_of_AtariEnv_are_in_the_same_order(self):
        theirs = list(inspect.signature(ale_py.AtariEnv).parameters)
        assert list(inspect.signature(drop_in.AtariEnv).parameters)[: len(theirs)] == theirs

    def test_the_arguments_of_ALEVectorInterface_are_the_same(self):
        theirs = re.findall(r"(\w+): [^=,]*(?: = ([^,)]*))?[,)]", ale_py.ALEVectorInterface.__init__.__doc__)
        ours = inspect.signature(drop_in.ALEVectorInterface).parameters.values()
        assert [(one.name, "" if one.default is one.empty else repr(one.default)) for one in ours] == theirs

    def test_actions_are_the_same_enumeration(self):
        assert {name: action.value for name, action in drop_in.Action.__members__.items()} == {
            name: action.value for name, action in ale_py.Action.__members__.items()
        }
        assert drop_in.Action.FIRE != 1
        with pytest.raises(TypeError):
            int(drop_in.Action.FIRE)
        assert [mode.name for mode in drop_in.LoggerMode] == [mode.name for mode in ale_py.LoggerMode]

    def test_code_for_ale_runs_on_it(self):
        script = (
            "import sys, racebeam.ale_py\n"
            "sys.modules['ale_py'] = racebeam.ale_py\n"
            "import ale_py, gymnasium as gym\n"
            "from ale_py import ALEInterface, Action, roms\n"
            "from ale_py.env import AtariEnv\n"
            "from ale_py.registration import register_v5_envs\n"
            "import ale_py.roms\n"
            "gym.register_envs(ale_py)\n"
            "env = gym.make('ALE/Pong-v5'); env.reset(seed=1)\n"
            "assert type(env.unwrapped) is AtariEnv is racebeam.ale_py.AtariEnv, type(env.unwrapped)\n"
            "old = gym.make('PongNoFrameskip-v4'); assert old.unwrapped._frameskip == 1\n"
            "ale = ALEInterface(); ale.loadROM(roms.get_rom_path('pong')); ale.act(Action.FIRE)\n"
            "print(len(roms.get_all_rom_ids()))"
        )
        if PONG is None:
            pytest.skip("no image of pong was found")
        done = in_process(script)
        assert (done.returncode, done.stdout) == (0, "108\n"), done.stderr

    def test_each_module_can_be_imported_in_the_place_of_ale_py(self, subtests):
        script = (
            "import sys, racebeam.ale_py\n"
            "sys.modules['ale_py'] = racebeam.ale_py\n"
            "{}\n"
            "import racebeam.ale_py.vector_env, racebeam.ale_py._ale_py\n"
            "for name in ('AtariEnv', 'AtariVectorEnv', 'ALEInterface', 'ALEVectorInterface', 'Action'):\n"
            "    for module in ('ale_py', 'ale_py.env', 'ale_py.vector_env', 'ale_py._ale_py'):\n"
            "        if hasattr(sys.modules.get(module), name):\n"
            "            assert getattr(sys.modules[module], name) is getattr(racebeam.ale_py, name), (module, name)"
        )
        for line in (
            "import ale_py._ale_py",
            "from ale_py import _ale_py",
            "from ale_py._ale_py import ALEInterface, ALEVectorInterface",
            "import ale_py; ale_py._ale_py",
            "from ale_py.vector_env import AtariVectorEnv",
            "import ale_py.vector_env",
            "from ale_py import AtariVectorEnv, vector_env",
            "import ale_py.env, ale_py.registration, ale_py.roms",
            "from ale_py import *; AtariEnv, AtariVectorEnv",
        ):
            with subtests.test(line=line):
                done = in_process(script.format(line))
                assert (done.returncode, done.stderr) == (0, "")

    def test_names_that_are_imported_late_are_listed(self):
        names = in_process(
            "import racebeam, racebeam.ale_py; print(*dir(racebeam)); print(*dir(racebeam.ale_py))"
        ).stdout.splitlines()
        assert set(racebeam.__all__) <= set(names[0].split())
        assert {*drop_in.__all__, "env", "registration", "roms", "vector_env", "register_v5_envs"} <= set(
            names[1].split()
        )

    def test_the_ids_are_those_of_ale_py(self):
        tell = (
            "import gymnasium as gym, {0}; print(sorted((i, sorted(s.kwargs.items(), key=str), "
            "s.max_episode_steps, s.nondeterministic)"
            " for i, s in gym.registry.items() if '{1}' in str(s.entry_point) and not i.startswith('racebeam/')))"
        )
        ours, theirs = (
            in_process(tell.format("racebeam.ale_py", "racebeam")),
            in_process(tell.format("ale_py", "ale_py")),
        )
        assert ours.stdout == theirs.stdout
        assert ours.stdout.count("'repeat_action_probability'") == 352
