"""racebeam.ale_py has the names of ale_py, the same types and errors, and each difference that its docstring lists."""

import copy
import inspect
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

import package

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import ale_py.env
import ale_py.registration
import ale_py.roms
import ale_py.vector_env
import gymnasium
import numpy as np
import racebeam
import racebeam.ale_py as drop_in
import racebeam.ale_py._ale_py
from ale_py import _ale_py

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)

# What is below ALEVectorInterface (difference 15).
INTERNAL = {"AutoresetMode", "VectorXLAReset", "VectorXLAResetGPU", "VectorXLAStep", "VectorXLAStepGPU"}
PONG = None if "pong" not in package.roms() else racebeam.find_image("pong")


def pong():
    """The interface of either package, with a game that was loaded with a seed."""
    both = []
    for module in (drop_in, ale_py):
        ale = module.ALEInterface()
        ale.setInt("random_seed", 7)
        ale.setBool("sound_obs", True)
        ale.loadROM(PONG)
        both.append(ale)
    return both


def in_process(script, **environment):
    return subprocess.run(
        [sys.executable, "-c", script], env={**os.environ, **environment}, capture_output=True, text=True
    )


def interfaces(count, **settings):
    """The vector interface of either package."""
    return [module.ALEVectorInterface(PONG, count, **settings) for module in (drop_in, ale_py)]


class Names(unittest.TestCase):
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
            self.assertEqual({name for name in names if not hasattr(ours, name)}, set())
        for module in ("env", "registration", "roms", "vector_env"):
            ours = __import__(f"racebeam.ale_py.{module}", fromlist=["x"])
            theirs = sys.modules[f"ale_py.{module}"]
            own = {
                name
                for name, value in vars(theirs).items()
                if getattr(value, "__module__", "").startswith("ale_py.") and not name.startswith("_")
            }
            self.assertEqual({name for name in own if not hasattr(ours, name)}, set(), module)
        self.assertEqual(set(ale_py.__all__) - INTERNAL, set(drop_in.__all__) - INTERNAL)

    def test_every_method_is_there(self):
        for name in ("ALEInterface", "ALEState", "ALEVectorInterface", "AtariEnv", "AtariVectorEnv"):
            theirs, ours = getattr(ale_py, name), getattr(drop_in, name)
            self.assertEqual(
                {method for method in dir(theirs) if not hasattr(ours, method)} - {"__slotnames__"}, set(), name
            )

    def test_the_arguments_of_AtariEnv_are_in_the_same_order(self):
        theirs = list(inspect.signature(ale_py.AtariEnv).parameters)
        self.assertEqual(list(inspect.signature(drop_in.AtariEnv).parameters)[: len(theirs)], theirs)

    def test_the_arguments_of_ALEVectorInterface_are_the_same(self):
        theirs = re.findall(r"(\w+): [^=,]*(?: = ([^,)]*))?[,)]", ale_py.ALEVectorInterface.__init__.__doc__)
        ours = inspect.signature(drop_in.ALEVectorInterface).parameters.values()
        self.assertEqual([(one.name, "" if one.default is one.empty else repr(one.default)) for one in ours], theirs)

    def test_actions_are_the_same_enumeration(self):
        self.assertEqual(
            {name: action.value for name, action in drop_in.Action.__members__.items()},
            {name: action.value for name, action in ale_py.Action.__members__.items()},
        )
        self.assertNotEqual(drop_in.Action.FIRE, 1)
        self.assertRaises(TypeError, int, drop_in.Action.FIRE)
        self.assertEqual([mode.name for mode in drop_in.LoggerMode], [mode.name for mode in ale_py.LoggerMode])

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
            self.skipTest("there is no image of pong")
        done = in_process(script)
        self.assertEqual((done.returncode, done.stdout), (0, "108\n"), done.stderr)

    def test_each_module_can_be_imported_in_the_place_of_ale_py(self):
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
            with self.subTest(line=line):
                done = in_process(script.format(line))
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_names_that_are_imported_late_are_listed(self):
        listed = in_process(
            "import racebeam, racebeam.ale_py; print(*dir(racebeam)); print(*dir(racebeam.ale_py))"
        ).stdout.splitlines()
        self.assertLessEqual(set(racebeam.__all__), set(listed[0].split()))
        self.assertLessEqual(
            {*drop_in.__all__, "env", "registration", "roms", "vector_env", "register_v5_envs"}, set(listed[1].split())
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
        self.assertEqual(ours.stdout, theirs.stdout)
        self.assertEqual(ours.stdout.count("'repeat_action_probability'"), 352)


@unittest.skipIf(PONG is None, "there is no image of pong")
class Interface(unittest.TestCase):
    def outcome(self, call, ale):
        """What a call returns, or exactly which type it raises."""
        try:
            value = call(ale)
        except Exception as error:
            return type(error)
        if isinstance(value, np.ndarray):
            return value.dtype, value.shape, value.flags.writeable, value.flags.c_contiguous, value.tobytes()
        if isinstance(value, list) and value and hasattr(value[0], "name"):
            return [action.name for action in value]
        return type(value), value

    CALLS = [
        lambda ale: [ale.act(action % 18) for action in range(300)],
        lambda ale: ale.act(1, 0.5),
        lambda ale: ale.act(action=3, paddle_strength=0.25),
        lambda ale: ale.act("FIRE"),
        lambda ale: ale.act(-1),
        lambda ale: ale.act(1.0),
        lambda ale: ale.act(None),
        lambda ale: ale.getScreen(),
        lambda ale: ale.getScreenRGB(),
        lambda ale: ale.getScreenGrayscale(),
        lambda ale: ale.getRAM(),
        lambda ale: ale.getAudio(),
        lambda ale: ale.getScreenDims(),
        lambda ale: ale.getRAMSize(),
        lambda ale: ale.getAudioSize(),
        lambda ale: ale.lives(),
        lambda ale: ale.game_over(),
        lambda ale: ale.game_over(False),
        lambda ale: ale.game_over(with_truncation=True),
        lambda ale: ale.game_truncated(),
        lambda ale: ale.getFrameNumber(),
        lambda ale: ale.getEpisodeFrameNumber(),
        lambda ale: ale.getLegalActionSet(),
        lambda ale: ale.getMinimalActionSet(),
        lambda ale: ale.getAvailableModes(),
        lambda ale: ale.getAvailableDifficulties(),
        lambda ale: ale.setMode(99),
        lambda ale: ale.setMode(5),
        lambda ale: ale.setDifficulty(99),
        lambda ale: ale.setMode("x"),
        lambda ale: ale.setRAM(5, 77),
        lambda ale: ale.getRAM(),
        lambda ale: ale.setRAM(128, 0),
        lambda ale: ale.setRAM(-1, 0),
        lambda ale: ale.setRAM(0, 256),
        lambda ale: ale.setRAM(0, -1),
        lambda ale: ale.getScreenRGB(np.zeros((5, 5, 3), np.uint8)),
        lambda ale: ale.getScreenRGB(np.zeros((210, 160, 3), np.int32)),
        lambda ale: ale.getScreen(np.zeros((160, 210), np.uint8)),
        lambda ale: ale.getScreenGrayscale(np.zeros(3, np.uint8)),
        lambda ale: ale.getScreen(np.zeros((210, 320), np.uint8)[:, ::2]),
        lambda ale: ale.getRAM(np.zeros(5, np.uint8)),
        lambda ale: ale.getAudio(np.zeros(5, np.uint8)),
        lambda ale: ale.getRAM([0] * 128),
        lambda ale: ale.getRAM(buffer=np.zeros(128, np.uint8)),
        lambda ale: ale.getInt("random_seed"),
        lambda ale: ale.getInt("nonsense"),
        lambda ale: ale.getBool("nonsense"),
        lambda ale: ale.getFloat("nonsense"),
        lambda ale: ale.getString("nonsense"),
        lambda ale: ale.getInt("frame_skip"),
        lambda ale: ale.getInt("max_num_frames"),
        lambda ale: ale.getInt("max_num_frames_per_episode"),
        lambda ale: ale.getInt("system_random_seed"),
        lambda ale: ale.getInt("reward_min"),
        lambda ale: ale.getInt("reward_max"),
        lambda ale: ale.getFloat("repeat_action_probability"),
        lambda ale: ale.getBool("color_averaging"),
        lambda ale: ale.getBool("display_screen"),
        lambda ale: ale.getBool("sound"),
        lambda ale: ale.getBool("sound_obs"),
        lambda ale: ale.getBool("send_rgb"),
        lambda ale: ale.getBool("truncate_on_loss_of_life"),
        lambda ale: ale.getString("cpu"),
        lambda ale: ale.getString("record_screen_dir"),
        lambda ale: ale.getString("rom_file"),
        lambda ale: ale.setInt("nonsense", 1),
        lambda ale: ale.setBool("random_seed", True),
        lambda ale: ale.setInt("cpu", 1),
        lambda ale: ale.setFloat("random_seed", 1.0),
        lambda ale: ale.setString("nonsense", "x"),
        lambda ale: ale.setInt("frame_skip", "4"),
        lambda ale: ale.setFloat("repeat_action_probability", 0),
        lambda ale: ale.setInt("random_seed", np.int32(-5)),
        lambda ale: ale.isSupportedROM("/nowhere"),
        lambda ale: ale.isSupportedROM("/etc/hostname"),
        lambda ale: ale.isSupportedROM(PONG),
        lambda ale: ale.isSupportedROM(pathlib.Path(PONG)),
        lambda ale: ale.setLoggerMode(3.5),
        lambda ale: ale.reset_game(),
        lambda ale: ale.getFrameNumber(),
        lambda ale: ale.getEpisodeFrameNumber(),
        lambda ale: [ale.act(action % 6) for action in range(400)],
        lambda ale: ale.getScreenRGB(),
        lambda ale: ale.getAudio(),
    ]

    def test_all_calls_have_the_same_outcome(self):
        ours, theirs = pong()
        for number, call in enumerate(self.CALLS):
            with self.subTest(call=number, line=inspect.getsource(call).strip()[:60]):
                self.assertEqual(self.outcome(call, ours), self.outcome(call, theirs))

    def test_buffers_are_filled(self):
        for ale in pong():
            for method, shape in (
                (ale.getScreen, (210, 160)),
                (ale.getScreenRGB, (210, 160, 3)),
                (ale.getScreenGrayscale, (210, 160)),
                (ale.getRAM, (128,)),
                (ale.getAudio, (512,)),
            ):
                buffer = np.full(shape, 99, np.uint8)
                self.assertIsNone(method(buffer))
                self.assertTrue(np.array_equal(buffer, method()))

    def test_settings_have_the_effect_that_they_have_in_ale(self):
        settings = (
            (),
            (("setInt", "frame_skip", 3),),
            (("setInt", "reward_max", 0),),
            (("setBool", "color_averaging", True),),
            (("setInt", "max_num_frames_per_episode", 50),),
            (("setFloat", "repeat_action_probability", 0.9),),
            (("setInt", "paddle_min", 100000), ("setInt", "paddle_max", 300000)),
            (("setInt", "system_random_seed", 5),),
        )
        for wanted in settings:
            with self.subTest(settings=wanted):
                seen = []
                for ale in pong():
                    for setter, key, value in wanted:
                        getattr(ale, setter)(key, value)
                    ale.loadROM(PONG)
                    rewards = [ale.act(step * 7 % 6) for step in range(1200)]
                    seen.append(
                        (
                            rewards,
                            ale.getScreenRGB().tobytes(),
                            ale.getRAM().tobytes(),
                            ale.getAudio().tobytes(),
                            ale.game_truncated(),
                            ale.getFrameNumber(),
                        )
                    )
                self.assertEqual(seen[0], seen[1])

    def test_states_agree_on_what_is_played_after_them(self):
        seen = []
        for ale in pong():
            told = [[ale.act(step % 6) for step in range(100)]]
            plain, system = ale.cloneState(), ale.cloneSystemState()
            told.append(
                (plain.getFrameNumber(), plain.getEpisodeFrameNumber(), plain.getDifficulty(), plain.getCurrentMode())
            )
            told.append((plain == ale.cloneState(), plain.equals(ale.cloneState(include_rng=False)), plain == plain))
            for state, restore in (
                (system, ale.restoreSystemState),
                (plain, ale.restoreState),
                (pickle.loads(pickle.dumps(system)), ale.restoreState),
            ):
                restore(state)
                told.append(
                    ([ale.act(step * 5 % 6) for step in range(100)], ale.getRAM().tobytes(), ale.getScreen().tobytes())
                )
            seen.append(told)
        self.assertEqual(seen[0], seen[1])

    def test_a_picture_is_the_same_file_to_a_reader(self):
        import struct
        import zlib

        def pixels(path):
            data = pathlib.Path(path).read_bytes()
            at, packed, head = 8, b"", b""
            while at < len(data):
                size, kind = struct.unpack(">I4s", data[at : at + 8])
                head, packed = (
                    (data[at + 8 : at + 8 + size], packed)
                    if kind == b"IHDR"
                    else (head, packed + data[at + 8 : at + 8 + size] if kind == b"IDAT" else packed)
                )
                at += size + 12
            rows = zlib.decompress(packed)
            width, height = struct.unpack(">II", head[:8])
            self.assertEqual({rows[row * (3 * width + 1)] for row in range(height)}, {0})
            return head[:10], rows

        with tempfile.TemporaryDirectory() as folder:
            files = [f"{folder}/{number}.png" for number in range(2)]
            for ale, file in zip(pong(), files):
                ale.act(1)
                ale.saveScreenPNG(file)
            self.assertEqual(pixels(files[0]), pixels(files[1]))


@unittest.skipIf(PONG is None, "there is no image of pong")
@unittest.skipIf(PONG is None, "there is no image of pong")
class Vectors(unittest.TestCase):
    def check(self, one, other):
        if isinstance(other, dict):
            self.assertEqual(set(one), set(other))
            one, other = [one[key] for key in other], list(other.values())
        if isinstance(other, (tuple, list)):
            self.assertEqual(len(one), len(other))
            return [self.check(*pair) for pair in zip(one, other)]
        self.assertEqual((one.dtype, one.shape), (other.dtype, other.shape))
        return self.assertTrue(np.array_equal(one, other))

    def check_step(self, one, other):
        """Where no episode ended, ale_py's final_obs is not defined."""
        done = other[2] | other[3]
        for *_, info in (one, other):
            if "final_obs" in info:
                info["final_obs"] = info["final_obs"][done]
        self.check(one, other)

    def test_all_calls_have_the_same_outcome(self):
        for settings in (
            {},
            {"autoreset_mode": "SameStep", "max_episode_steps": 20},
            {"grayscale": False, "stack_num": 2},
            {"full_action_space": True},
        ):
            with self.subTest(**settings):
                ours, theirs = both = interfaces(3, **settings)
                self.assertEqual(
                    [action.name for action in ours.get_action_set()],
                    [action.name for action in theirs.get_action_set()],
                )
                self.assertEqual(
                    (ours.get_num_envs(), ours.get_observation_shape()), (3, theirs.get_observation_shape())
                )
                self.assertEqual(
                    (ours.handle().dtype, ours.handle().shape), (theirs.handle().dtype, theirs.handle().shape)
                )
                for ids, seeds in (
                    ([0, 1, 2], [5, 6, 7]),
                    ([1], [9]),
                    ([2, 0], [-1, -1]) if not settings else ([0], [3]),
                ):
                    self.check(*(each.reset(ids, seeds) for each in both))
                    for step in range(8):
                        for each in both:
                            each.send([step % 3, 1, 2], [1.0, 0.5, 0.0])
                        self.check_step(*(each.recv() for each in both))

    def test_bad_input_is_refused_as_ale_py_does(self):
        ours, theirs = both = interfaces(3)
        for each in both:
            each.reset([0, 1, 2], [1, 2, 3])
        for call, error in (
            (lambda each: each.reset([0, 1], [3]), ValueError),
            (lambda each: each.send([0], [1.0]), ValueError),
            (lambda each: each.reset([7], [3]), IndexError),
            (lambda each: each.send([0, 1, 2], [1.0]), ValueError),
            (lambda each: type(each)(PONG, 2, autoreset_mode="x"), Exception),
        ):
            for each in both:
                self.assertRaises(error, call, each)

    def test_the_environments_of_AtariVectorEnv(self):
        ours, theirs = both = [module.AtariVectorEnv("pong", 2) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
            envs.ale.reset([1], [5])
        self.check(*(envs.step(np.array([1, 2])) for envs in both))
        self.check(*(envs.map_action_idx for envs in both))

    def test_seeds_are_those_of_the_environments_that_are_reset(self):
        both = [module.AtariVectorEnv("pong", 3) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
        for mask in ([False, False, True], [True, False, True], [True, True, True]):
            chosen = np.array(mask)
            for seed in (50, np.arange(60, 60 + sum(mask))):
                self.check(*(envs.reset(seed=seed, options={"reset_mask": chosen}) for envs in both))
                self.check(*(envs.step(np.array([1, 2, 3])) for envs in both))
            for envs in both:
                self.assertRaises(ValueError, envs.reset, seed=np.arange(4), options={"reset_mask": chosen})
        for envs in both:
            self.assertRaises(
                ValueError, envs.reset, seed=np.arange(3), options={"reset_mask": np.array([True, False, False])}
            )

    def test_a_reset_drops_what_was_not_received(self):
        for batch_size in (2, 4):
            for module in (drop_in, ale_py):
                envs = module.AtariVectorEnv("pong", 4, batch_size=batch_size)
                for seed in (1, 2):
                    _, info = envs.reset(seed=seed)
                    self.assertEqual(info["env_id"].shape, (batch_size,))
                    envs.send(np.zeros(batch_size, np.int64))


@unittest.skipIf(PONG is None, "there is no image of pong")
class Refusals(unittest.TestCase):
    """Code that catches what ale_py raises catches what the drop-in raises."""

    def test_every_type_is_caught(self):
        def make(name, *arguments, **named):
            return lambda module: getattr(module, name)(*arguments, **named)

        def call(name, method, *arguments, **named):
            return lambda module: getattr(self.made(module, name), method)(*arguments, **named)

        calls = [make("AtariEnv", game) for game in ("nope", 3)]
        calls += [make("AtariVectorEnv", "nope", 2)]
        calls += [
            make("AtariEnv", "pong", **{name: value})
            for name, value in (
                ("mode", 99),
                ("mode", "x"),
                ("difficulty", 99),
                ("difficulty", 1.5),
                ("obs_type", "x"),
                ("frameskip", 0),
                ("frameskip", 2.0),
                ("frameskip", (3, 2)),
                ("repeat_action_probability", "x"),
                ("max_num_frames_per_episode", "x"),
                ("render_mode", "x"),
                ("foo", 1),
            )
        ]
        calls += [
            make("AtariVectorEnv", "pong", 2, **{name: value})
            for name, value in (
                ("batch_size", -1),
                ("num_threads", "x"),
                ("img_height", "x"),
                ("img_height", -3),
                ("stack_num", -1),
                ("frameskip", 0),
                ("frameskip", (2, 5)),
                ("noop_max", "x"),
                ("autoreset_mode", "x"),
                ("autoreset_mode", 3),
                ("repeat_action_probability", "x"),
                ("foo", 1),
            )
        ]
        calls += [
            call("AtariEnv", *words)
            for words in (
                ("step", "x"),
                ("step", 99),
                ("step", None),
                ("render",),
                ("get_keys_to_action", 1),
                ("restore_state", 3),
            )
        ]
        calls += [
            call("AtariVectorEnv", "step", actions)
            for actions in ([0, 0], np.zeros(3, int), np.zeros(2), np.zeros(2, np.int8), None, np.zeros((2, 1), int))
        ]
        calls += [
            call("AtariVectorEnv", "reset", seed=seed)
            for seed in ("x", 2**70 * 1.5, np.zeros(3, int), np.zeros((2, 1), int))
        ]
        calls += [
            call("AtariVectorEnv", "reset", options={"reset_mask": mask})
            for mask in (3, [True, False], np.zeros(2, int), np.zeros(3, bool), np.zeros((2, 1), bool))
        ]
        calls += [
            lambda module: module.AtariVectorEnv("pong", 2).step(np.zeros(2, int)),
            lambda module: module.AtariVectorEnv("pong", 2).reset(options={"reset_mask": np.array([True, False])}),
        ]
        calls += [
            lambda module: self.made(module, "AtariVectorEnv").ale.reset([0, 1], [1]),
            lambda module: self.made(module, "AtariVectorEnv").ale.send([0, 0], [1.0]),
        ]
        for number, refused in enumerate(calls):
            with self.subTest(call=number):
                raised = []
                for module in (ale_py, drop_in):
                    with warnings.catch_warnings(), self.assertRaises(Exception) as refusal:
                        warnings.simplefilter("ignore")
                        refused(module)
                    raised.append(type(refusal.exception))
                self.assertTrue(issubclass(raised[1], raised[0]), raised)

    def made(self, module, name):
        env = getattr(module, name)(*(["pong", 2] if name == "AtariVectorEnv" else ["pong"]))
        env.reset(seed=1)
        return env


class Differences(unittest.TestCase):
    """A test for each number in the docstring."""

    def test_each_number_has_a_test(self):
        numbers = [int(number) for number in re.findall(r"(?m)^(\d+)\. ", drop_in.__doc__)]
        tests = sorted(int(name.split("_")[1]) for name in dir(self) if re.match(r"test_\d", name))
        self.assertEqual(numbers, tests)

    def test_01_a_bad_image_is_an_exception(self):
        with tempfile.TemporaryDirectory() as folder:
            cut = pathlib.Path(folder, "cut.bin")
            cut.write_bytes(pathlib.Path(PONG).read_bytes()[:1000])
            for image in ("/nowhere.bin", str(cut), "/dev/null"):
                with self.subTest(image=image):
                    self.assertRaises(RuntimeError, drop_in.ALEInterface().loadROM, image)
                    done = in_process(f"import ale_py; ale_py.ALEInterface().loadROM({image!r})")
                    self.assertNotIn("Traceback", done.stderr)  # it has ended the process itself
                    self.assertNotEqual(done.returncode, 0)

    def test_02_without_an_image_every_method_raises_or_answers(self):
        unloaded = drop_in.ALEInterface()
        for name in (
            "act",
            "reset_game",
            "getRAM",
            "getScreen",
            "getScreenRGB",
            "getScreenGrayscale",
            "getAudio",
            "lives",
            "game_over",
            "game_truncated",
            "getFrameNumber",
            "getEpisodeFrameNumber",
            "getScreenDims",
            "cloneState",
            "cloneSystemState",
            "getLegalActionSet",
            "getMinimalActionSet",
            "getAvailableModes",
            "getAvailableDifficulties",
            "state_hash",
        ):
            with self.subTest(method=name), self.assertRaisesRegex(RuntimeError, "ROM not set"):
                getattr(unloaded, name)(*([0] if name == "act" else []))
        for method, words in ((unloaded.setMode, [0]), (unloaded.setDifficulty, [0]), (unloaded.setRAM, [0, 0])):
            self.assertRaisesRegex(RuntimeError, "ROM not set", method, *words)
        self.assertLess(in_process("import ale_py; ale_py.ALEInterface().getRAM()").returncode, 0)

    def test_03_a_number_that_is_no_action(self):
        ours, theirs = pong()
        for number in (18, 99):
            self.assertRaisesRegex(ValueError, f"there is no action {number}; there are 0 to 17", ours.act, number)
            self.assertEqual(theirs.act(number), 0)
        self.assertRaisesRegex(ValueError, "there is no action", ours.act, 2**31)
        self.assertRaises(IndexError, drop_in.AtariEnv("pong").step, -1)
        ale_py.AtariEnv("pong").step(-1)

    def test_04_choices_are_named(self):
        self.assertRaisesRegex(RuntimeError, "mode is 77; it takes 0, 1$", pong()[0].setMode, 77)
        self.assertRaisesRegex(
            RuntimeError, "pong has no difficulty 77; it offers 0, 1, 2, 3", pong()[0].setDifficulty, 77
        )

    def test_05_states_are_exact(self):
        exact = []
        for ale in pong():
            [ale.act(step % 6) for step in range(100)]
            state, screen, sound = ale.cloneState(True), ale.getScreenRGB(), ale.getAudio()
            [ale.act(step % 6) for step in range(100)]
            ale.restoreState(state)
            exact.append(np.array_equal(ale.getScreenRGB(), screen) and np.array_equal(ale.getAudio(), sound))
        self.assertEqual(exact, [True, False])

    def test_06_states_hash_as_they_compare(self):
        ours, theirs = pong()
        self.assertEqual(hash(ours.cloneState()), hash(ours.cloneState()))
        two = [theirs.cloneState() for _ in range(2)]
        self.assertTrue(two[0] == two[1] and hash(two[0]) != hash(two[1]))
        self.assertFalse(ours.cloneState() == 3)
        with self.assertRaises(TypeError):
            theirs.cloneState() == 3  # noqa: B015

    def test_07_copies_have_the_game(self):
        frames = []
        for module in (drop_in, ale_py):
            env = module.AtariEnv("pong")
            env.reset(seed=1)
            env.step(0)
            frames.append(copy.deepcopy(env).ale.getFrameNumber())
        self.assertEqual(frames, [4, 0])
        self.assertEqual(pickle.loads(pickle.dumps(pong()[0])).getInt("random_seed"), 7)
        self.assertRaises(TypeError, pickle.dumps, pong()[1])

    def test_08_images_of_other_kinds(self):
        ale = drop_in.ALEInterface()
        ale.loadROM(pathlib.Path(PONG).read_bytes())
        self.assertEqual(ale.getGame(), "pong")
        ale.loadROM("builtin:updraft")
        self.assertEqual(ale.getGame(), "updraft")
        self.assertEqual(str(drop_in.roms.get_rom_path("pong")), PONG)

    def test_09_nothing_is_logged(self):
        script = "import {} as m; m.ALEInterface.setLoggerMode(m.LoggerMode.Info); m.ALEInterface().loadROM({!r})"
        self.assertEqual(in_process(script.format("racebeam.ale_py", PONG)).stderr, "")
        self.assertNotEqual(in_process(script.format("ale_py", PONG)).stderr, "")

    def test_10_there_is_no_SDL(self):
        self.assertEqual((drop_in.SDL_SUPPORT, ale_py.SDL_SUPPORT), (False, True))
        ale = drop_in.ALEInterface()
        ale.setBool("display_screen", True)
        ale.loadROM(PONG)
        ale.setString("record_screen_dir", "/tmp")
        self.assertRaisesRegex(RuntimeError, "record_screen_dir is '/tmp'", ale.loadROM, PONG)

    def test_11_getters_know_their_type(self):
        ours, theirs = pong()
        self.assertEqual((ours.getFloat("random_seed"), theirs.getFloat("random_seed")), (-1.0, 7.0))

    def test_12_a_closed_environment(self):
        env = drop_in.AtariEnv("pong")
        env.close()
        self.assertRaises(Exception, env.reset)  # noqa: B017
        theirs = ale_py.AtariEnv("pong")
        theirs.close()
        theirs.reset()

    def test_13_many_environments_take_more(self):
        for autoreset in ("NextStep", "Disabled"):
            envs = drop_in.AtariVectorEnv("pong", 2, autoreset_mode=autoreset, lives="end", render_mode="rgb_array")
            envs.reset(seed=[3, 4])
            envs.reset(seed=np.int64(3))
            self.assertEqual(envs.render()[1].shape, (210, 160, 3))
            self.assertEqual(
                set(envs.step(np.zeros(2, np.int64))[4]), {"env_id", "lives", "frame_number", "episode_frame_number"}
            )
        self.assertRaises(ValueError, ale_py.AtariVectorEnv, "pong", 2, autoreset_mode="Disabled")
        theirs = ale_py.AtariVectorEnv("pong", 2)
        for seed in ([3, 4], np.int64(3)):
            self.assertRaises(TypeError, theirs.reset, seed=seed)
        self.assertRaises(NotImplementedError, theirs.render)
        self.assertIs(theirs.metadata, ale_py.AtariVectorEnv.metadata)
        self.assertIsNot(envs.metadata, drop_in.AtariVectorEnv.metadata)

    def test_14_many_environments_raise(self):
        both = [module.AtariVectorEnv("pong", 2) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
            for actions in ([0, 0], np.zeros(3, np.int64), np.zeros(2, np.float32)):
                self.assertRaises(AssertionError, envs.step, actions)
            for mask, error in (([True, False], TypeError), (np.array([True]), ValueError)):
                self.assertRaises(error, envs.reset, options={"reset_mask": mask})
            self.assertRaises(ValueError, envs.reset, seed=np.array([1]))
            self.assertRaises(TypeError, envs.reset, seed="x")
        self.assertRaises(IndexError, both[0].step, np.array([0, 99]))
        self.assertRaises(gymnasium.error.Error, drop_in.AtariVectorEnv, "pong", 2, stack_num=0)
        ale_py.AtariVectorEnv("pong", 2, stack_num=0)
        for envs in both:
            envs.close()
        self.assertRaises(gymnasium.error.ClosedEnvironmentError, both[0].step, np.zeros(2, np.int64))
        both[1].step(np.zeros(2, np.int64))

    def test_15_ALEVectorInterface_and_xla(self):
        for name in INTERNAL:
            self.assertFalse(hasattr(drop_in, name) or hasattr(drop_in._ale_py, name), name)
        ours, theirs = interfaces(3)
        for each in (ours, theirs):
            self.assertRaises(RuntimeError, each.reset, [0], [4])
        ours.reset([0, 1, 2], [4, 5, 6])
        ours.send([0, 1, 2], [1.0] * 3)
        self.assertRaises(IndexError, ours.send, [0, 99, 0], [1.0] * 3)
        ours.recv()
        self.assertRaises(racebeam.InvalidInput, drop_in.ALEVectorInterface, __file__, 2)

    def test_16_a_strength_is_finite(self):
        for radius in (np.nan, np.inf, -np.inf):
            action = np.array([radius, 0, 0], np.float32)
            ours, theirs = (module.AtariEnv("pong", continuous=True) for module in (drop_in, ale_py))
            many = drop_in.AtariVectorEnv("pong", 2, continuous=True)
            for env in (ours, theirs, many):
                env.reset(seed=1)
            with np.errstate(invalid="ignore"):
                theirs.step(action)
                self.assertRaisesRegex(racebeam.InvalidInput, "must be a finite number", ours.step, action)
            self.assertRaisesRegex(racebeam.InvalidInput, "must be a finite number", many.step, np.array([action] * 2))
            self.assertRaisesRegex(racebeam.InvalidInput, "must be a finite number", ours.ale.act, 0, radius)
        for env, action in (
            (ours, np.array([0, np.inf, 0], np.float32)),
            (many, np.array([[0, 0, 0], [0, 0, np.inf]], np.float32)),
        ):
            self.assertRaisesRegex(racebeam.InvalidInput, "finite number", env.step, action)

    def test_17_arguments_of_AtariEnv_are_checked(self):
        for arguments in (
            {"repeat_action_probability": 2},
            {"max_num_frames_per_episode": -5},
            {"frameskip": 2**31},
            {"continuous_action_threshold": "x"},
            {"continuous_action_threshold": float("nan"), "continuous": True},
        ):
            with self.subTest(**arguments):
                self.assertRaises(gymnasium.error.Error, drop_in.AtariEnv, "pong", **arguments)
                ale_py.AtariEnv("pong", **arguments)
        drop_in.AtariEnv("pong", frameskip=np.int64(4))
        self.assertRaises(gymnasium.error.Error, ale_py.AtariEnv, "pong", frameskip=np.int64(4))

    def test_18_limits_of_many_environments(self):
        for arguments in (
            {"img_width": 321},
            {"img_height": 421},
            {"img_height": 8},
            {"stack_num": 17},
            {"noop_max": 1001},
            {"frameskip": 1001},
        ):
            with self.subTest(**arguments):
                with self.assertRaises((gymnasium.error.Error, racebeam.InvalidInput)):
                    drop_in.AtariVectorEnv("pong", 1, **arguments)
                ale_py.AtariVectorEnv("pong", 1, **arguments)

    def test_screens_that_grow_are_the_same(self):
        for size in ((224, 224), (256, 256), (420, 320), (84, 200), (211, 100)):
            settings = {"img_height": size[0], "img_width": size[1], "stack_num": 1}
            shown = []
            for module in (drop_in, ale_py):
                envs = module.AtariVectorEnv("pong", 1, **settings)
                envs.reset(seed=1)
                shown.append(np.stack([envs.step(np.array([step % 3]))[0] for step in range(10)]))
            self.assertTrue(np.array_equal(*shown), size)

    def test_19_no_frames(self):
        ours, theirs = (module.AtariVectorEnv("pong", 2, max_num_frames_per_episode=0) for module in (drop_in, ale_py))
        for envs, ends in ((ours, False), (theirs, True)):
            envs.reset(seed=1)
            for _ in range(5):
                self.assertEqual(envs.step(np.zeros(2, np.int64))[3].tolist(), [ends] * 2)

    def test_20_means_of_a_half(self):
        ours, theirs = (module.AtariVectorEnv("pong", 2, img_height=105, img_width=80) for module in (drop_in, ale_py))
        far = 0
        for envs in (ours, theirs):
            envs.reset(seed=1)
        for step in range(20):
            one, other = (envs.step(np.full(2, step % 3))[0].astype(int) for envs in (ours, theirs))
            far = max(far, np.abs(one - other).max())
        self.assertLessEqual(far, 1)


if __name__ == "__main__":
    package.main()
