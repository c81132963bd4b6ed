"""AtariEnv: what ale_py's lacks, bad input, copies, and Gymnasium's own checks."""

import copy
import importlib.util
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings

import package

package.require("gymnasium", "numpy")

import gymnasium as gym
import numpy as np
import racebeam
from gymnasium.utils.env_checker import check_env
from racebeam import images

os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
if "DISPLAY" not in os.environ:
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
HOMEBREW = package.SOURCE / "games/homebrew"


def played(env, actions):
    """What some steps show, as comparable values."""
    return [(step[0].tobytes(), *step[1:]) for step in (env.step(action) for action in actions)]


class Registration(unittest.TestCase):
    def test_every_game_has_an_id_and_ours_can_be_made(self):
        ids = [env_id for env_id in gym.registry if env_id.startswith("racebeam/")]
        self.assertEqual(len([env_id for env_id in ids if env_id.endswith("-v5")]), len(racebeam.games()))
        self.assertEqual(len([env_id for env_id in ids if env_id.endswith("NoFrameskip-v4")]), len(racebeam.games()))
        self.assertEqual(len(ids), 220)
        for env_id in ("racebeam/Beamfall-v5", "racebeam/Updraft-v5"):
            env = gym.make(env_id)
            self.assertEqual(type(env.unwrapped).__name__, "AtariEnv")
            self.assertEqual(env.unwrapped._frameskip, 4)
            self.assertEqual(env.unwrapped.ale.getInt("max_num_frames_per_episode"), 108000)
            self.assertEqual(env.unwrapped.ale.getFloat("repeat_action_probability"), 0.25)

    def test_ids_without_frame_skipping_are_for_wrappers_that_skip(self):
        env = gym.make("racebeam/BeamfallNoFrameskip-v4")
        env.reset(seed=1)
        self.assertEqual(env.step(0)[4]["episode_frame_number"], 1)
        self.assertEqual(env.unwrapped.ale.getFloat("repeat_action_probability"), 0)
        self.assertEqual(env.unwrapped.ale.getInt("max_num_frames_per_episode"), 108000)
        if importlib.util.find_spec("cv2"):
            gym.wrappers.AtariPreprocessing(env).reset(seed=1)
            self.assertRaises(ValueError, gym.wrappers.AtariPreprocessing, gym.make("racebeam/Beamfall-v5"))

    def test_a_spawned_process_makes_an_id_that_names_the_module(self):
        script = (
            "import gymnasium as gym, sys\n"
            "if __name__ == '__main__':\n"
            "    envs = gym.make_vec('racebeam:racebeam/Beamfall-v5', 2, vectorization_mode='async', "
            "vector_kwargs={'context': 'spawn'})\n"
            "    print(envs.reset(seed=1)[0].shape); envs.close()\n"
        )
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "spawn.py")
            file.write_text(script)
            done = subprocess.run([sys.executable, file], capture_output=True, text=True)
        self.assertEqual(done.stdout.strip(), "(2, 210, 160, 3)", done.stderr)

    @unittest.skipUnless(importlib.util.find_spec("ale_py"), "there is no ale_py")
    def test_a_later_import_of_ale_py_does_not_take_the_ids_back(self):
        for ours in ("racebeam.register_ale_ids()", "import racebeam.ale_py"):
            script = (
                f"import gymnasium as gym, racebeam\n{ours}\n"
                "import ale_py, inspect, sys\n"
                "for env_id in ('ALE/Pong-v5', 'PongNoFrameskip-v4'): print(gym.spec(env_id).entry_point)\n"
                "print(type(ale_py.__loader__) is type(ale_py.__spec__.loader), ale_py.ALEInterface.__module__)\n"
                "print('ALEState' in inspect.getsource(ale_py))"
            )
            done = subprocess.run([sys.executable, "-W", "error", "-c", script], capture_output=True, text=True)
            self.assertEqual(done.stdout.split("\n")[:2], ["racebeam.ale_py.env:AtariEnv"] * 2, done.stderr)
            self.assertEqual(done.stdout.split("\n")[2:4], ["True ale_py._ale_py", "True"], done.stderr)

    def test_the_checker_of_gymnasium_finds_nothing(self):
        for obs_type in ("rgb", "grayscale", "ram"):
            with self.subTest(obs_type=obs_type), warnings.catch_warnings():
                warnings.simplefilter("error")
                env = gym.make("racebeam/Beamfall-v5", obs_type=obs_type, render_mode="rgb_array")
                check_env(env.unwrapped, skip_render_check=importlib.util.find_spec("pygame") is None)

    def test_the_ids_of_ale_come_when_they_are_asked_for(self):
        script = (
            "import gymnasium as gym, racebeam\n"
            "before = {i for i, s in gym.registry.items() if str(s.entry_point).startswith('racebeam')}\n"
            "racebeam.register_ale_ids(); racebeam.register_ale_ids()\n"
            "ours = {i for i, s in gym.registry.items() if str(s.entry_point).startswith('racebeam')} - before\n"
            "print(len(before), len(ours), sorted(ours)[0], 'PongNoFrameskip-v4' in ours, 'ALE/Combat-v5' in ours)"
        )
        done = subprocess.run([sys.executable, "-W", "error", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split(), ["220", "352", "ALE/Adventure-v5", "True", "False"])
        self.assertEqual(done.stderr, "")


class Playing(unittest.TestCase):
    def setUp(self):
        self.env = racebeam.AtariEnv("beamfall")
        self.env.reset(seed=11)
        self.actions = [int(action) for action in np.random.default_rng(5).integers(18, size=200)]

    def test_the_same_seed_is_the_same_game_and_another_is_not(self):
        first = played(self.env, self.actions)
        self.env.reset(seed=11)
        self.assertEqual(played(self.env, self.actions), first)
        self.env.reset(seed=12)
        self.assertNotEqual(played(self.env, self.actions), first)

    def test_a_restored_state_shows_what_it_showed(self):
        played(self.env, self.actions[:20])
        seen, ram, info = self.env.ale.getScreenRGB(), self.env.ale.getRAM(), self.env._get_info()
        state = self.env.clone_state(include_rng=True)
        first = played(self.env, self.actions)
        self.env.restore_state(state)
        self.assertEqual(self.env.ale.getScreenRGB().tobytes(), seen.tobytes())
        self.assertEqual(self.env.ale.getRAM().tobytes(), ram.tobytes())
        self.assertEqual(self.env._get_info(), info)
        self.assertEqual(played(self.env, self.actions), first)

    def test_a_state_as_bytes_goes_to_another_environment(self):
        played(self.env, self.actions[:20])
        state = racebeam.ALEState(self.env.clone_state(include_rng=True).serialize())
        first = played(self.env, self.actions)
        other = racebeam.AtariEnv("beamfall")
        other.reset(seed=99)
        other.restore_state(pickle.loads(pickle.dumps(state)))
        self.assertEqual(played(other, self.actions), first)

    def test_copies_go_on_where_the_game_is(self):
        played(self.env, self.actions[:30])
        self.env.action_space.seed(3)
        copies = [
            copy.deepcopy(self.env),
            pickle.loads(pickle.dumps(self.env)),
            pickle.loads(pickle.dumps(gym.make("racebeam/Updraft-v5", frameskip=(2, 5)))),
        ]
        first = played(self.env, self.actions), self.env.action_space.sample()
        for env in copies[:2]:
            self.assertEqual((played(env, self.actions), env.action_space.sample()), first)
        self.assertEqual(
            played(copies[0].reset(seed=11) and copies[0], self.actions),
            played(self.env.reset(seed=11) and self.env, self.actions),
        )

    def test_a_copy_draws_the_same_frameskips(self):
        env = racebeam.AtariEnv("updraft", frameskip=(2, 9))
        env.reset(seed=1)
        actions = [action % env.action_space.n for action in self.actions]
        self.assertEqual(played(copy.deepcopy(env), actions), played(env, actions))

    def test_observations_are_the_callers_own(self):
        first = self.env.step(0)[0]
        before = first.copy()
        played(self.env, self.actions[:20])
        self.assertTrue(np.array_equal(first, before))
        first[:] = 7
        self.assertFalse(np.array_equal(self.env.ale.getScreenRGB(), first))

    def test_two_players_are_both_rewarded(self):
        if "pong" not in package.roms():
            self.skipTest("there is no image of pong")
        env = racebeam.AtariEnv("pong", two_player=True, frameskip=8)
        env.reset(seed=1)
        self.assertEqual(env.action_space.nvec.tolist(), [6, 6])
        self.assertIn(env.ale.getMode(), env.ale.getTwoPlayerModes())
        rewards = []
        for _ in range(400):
            _, reward, _, _, info = env.step((1, 2))
            self.assertEqual(info["reward_a"], reward)
            rewards.append((info["reward_a"], info["reward_b"]))
        self.assertEqual([b for _, b in rewards], [-a for a, _ in rewards])
        self.assertTrue(any(a for a, _ in rewards))

    def test_player_b_moves(self):
        if "pong" not in package.roms():
            self.skipTest("there is no image of pong")
        screens = []
        for b in (2, 3):
            env = racebeam.AtariEnv("pong", two_player=True, repeat_action_probability=0.0)
            env.reset(seed=1)
            for _ in range(30):
                seen = env.step((0, b))[0]
            screens.append(seen.tobytes())
        self.assertNotEqual(*screens)

    def test_a_mode_for_two_needs_two_players(self):
        if "pong" not in package.roms():
            self.skipTest("there is no image of pong")
        with self.assertRaisesRegex(racebeam.InvalidInput, "pong has mode 5 only for two.*for one it offers 0, 1$"):
            racebeam.AtariEnv("pong", mode=5)
        self.assertEqual(racebeam.AtariEnv("pong", mode=5, two_player=True).ale.getMode(), 5)

    def test_presets_are_the_settings_of_the_literature(self):
        def settings(**arguments):
            env = racebeam.AtariEnv("beamfall", **arguments)
            ale = env.ale
            return (
                env._frameskip,
                ale.getFloat("repeat_action_probability"),
                env.action_space.n,
                ale.getInt("max_num_frames_per_episode"),
                ale.getBool("truncate_on_loss_of_life"),
                env._noop_max,
                env._reward_range,
            )

        self.assertEqual(settings(), (4, 0.25, 18, 0, False, 0, None))
        self.assertEqual(settings(preset="paper2013"), (5, 0.0, 18, 18000, False, 0, None))
        self.assertEqual(settings(preset="dqn2015"), (4, 0.0, 18, 18000, True, 30, (-1, 1)))
        self.assertEqual(settings(preset="machado2018", frameskip=3), (3, 0.25, 18, 18000, False, 0, None))

    def test_presets_are_those_of_the_line_protocol(self):
        with racebeam.launch() as session:
            for name in ("paper2013", "dqn2015", "machado2018", "gym-v5"):
                told = session.load("beamfall", preset=name)
                env = racebeam.AtariEnv("beamfall", preset=name)
                low, high = env._reward_range or ("none", "none")
                self.assertEqual(
                    (
                        told["frame_skip"],
                        told["sticky"],
                        told["max_episode_frames"],
                        told["life_loss_ends"],
                        told["noop_max"],
                        told["reward_min"],
                        told["reward_max"],
                    ),
                    (
                        env._frameskip,
                        env.ale.getFloat("repeat_action_probability"),
                        env.ale.getInt("max_num_frames_per_episode"),
                        int(env.ale.getBool("truncate_on_loss_of_life")),
                        env._noop_max,
                        low,
                        high,
                    ),
                    name,
                )

    def test_a_lost_life_ends_the_episode_of_dqn_and_rewards_are_clipped(self):
        env = racebeam.AtariEnv("beamfall", preset="dqn2015")
        _, info = env.reset(seed=3)
        rewards, truncated = set(), False
        while not truncated:
            _, reward, terminated, truncated, after = env.step(1)
            rewards.add(reward)
            self.assertFalse(terminated)
        self.assertEqual(after["lives"], info["lives"] - 1)
        self.assertEqual(rewards, {0.0, 1.0})

    def test_the_first_frames_of_dqn_differ(self):
        env = racebeam.AtariEnv("beamfall", preset="dqn2015")
        begins = {env.reset(seed=seed)[1]["episode_frame_number"] for seed in range(40)}
        self.assertGreater(len(begins), 10)
        self.assertEqual((min(begins) >= 0, max(begins) <= 29), (True, True))

    def test_fixed_rules_are_a_choice(self):
        self.assertEqual(racebeam.AtariEnv("beamfall", rules="fixed").ale.getString("rules"), "fixed")
        with self.assertRaisesRegex(racebeam.InvalidInput, "it takes ale-0.12 or fixed"):
            racebeam.AtariEnv("beamfall", rules="mended")

    def test_sound_is_heard(self):
        env = racebeam.AtariEnv("beamfall", sound_obs=True)
        env.reset(seed=1)
        heard = {env.step(1)[0]["sound"].tobytes() for _ in range(40)}
        self.assertGreater(len(heard), 3)

    def test_a_long_step_is_one_step(self):
        whole, parts = (racebeam.AtariEnv("beamfall", frameskip=frames) for frames in (5000, 1))
        whole.reset(seed=2)
        parts.reset(seed=2)
        seen = whole.step(1)
        reward = sum(parts.step(1)[1] for _ in range(5000))
        self.assertEqual(
            (seen[0].tobytes(), seen[1], seen[4]), (parts.ale.getScreenRGB().tobytes(), reward, parts._get_info())
        )


class BadInput(unittest.TestCase):
    def refused(self, error, sentence, call, *words, **arguments):
        with self.assertRaisesRegex(error, sentence):
            call(*words, **arguments)

    def test_arguments(self):
        make, wrong = racebeam.AtariEnv, gym.error.Error
        self.refused(racebeam.UnknownGame, "game 'beamfal'.* beamfall", make, "beamfal")
        self.refused(racebeam.UnknownGame, r"game \[1\]", make, [1])
        self.refused(wrong, "^obs_type .*'text'", make, "beamfall", obs_type="text")
        self.refused(
            wrong, "render_mode is 'ansi'; it takes None, human, rgb_array", make, "beamfall", render_mode="ansi"
        )
        self.refused(wrong, "frameskip has the type float", make, "beamfall", frameskip=4.0)
        for frameskip in (0, -1, (0, 3), (3, 3), (4, 3), (1, 2, 3), ()):
            self.refused(wrong, "frameskip is", make, "beamfall", frameskip=frameskip)
        self.refused(RuntimeError, "mode 7", make, "beamfall", mode=7)
        self.refused(RuntimeError, "difficulty 9", make, "beamfall", difficulty=9)
        self.refused(racebeam.InvalidInput, "preset 'dqn'", make, "beamfall", preset="dqn")
        self.refused(racebeam.InvalidInput, r"preset \[1\]", make, "beamfall", preset=[1])
        self.refused(racebeam.InvalidInput, "^rules .*5", make, "beamfall", rules=5)
        for probability in (2, -0.5, "x", float("nan"), [0.5]):
            self.refused(wrong, "repeat_action_probability is", make, "beamfall", repeat_action_probability=probability)
        for name, values in (
            ("mode", ("x", 1.0, -1, 2**40)),
            ("difficulty", ("x", -1)),
            ("max_num_frames_per_episode", (1.5, -5, 2**40)),
            ("noop_max", (1.5, -1, 10**12)),
            ("frameskip", (2**31, (1, 2**31), (1.0, 2), True)),
            ("server", (5, ["unix:x"])),
            ("continuous_action_threshold", ("x", float("nan"), None)),
            ("timeout", ("x", 0, -1, float("nan"))),
        ):
            for value in values:
                self.refused(wrong, f"{name} (is|has)", make, "beamfall", **{name: value})
        for name in ("frameskip", "max_num_frames_per_episode", "noop_max"):
            make("beamfall", **{name: np.int64(4)}).reset(seed=1)
        make("beamfall", frameskip=(np.int64(2), 5), mode=np.int32(0), difficulty=np.int64(1)).reset(seed=1)
        self.refused(racebeam.InvalidInput, "beamfall has no mode for two", make, "beamfall", two_player=True)
        for arguments, kind in (
            ({"frameskip": 0}, ValueError),
            ({"frameskip": (3, 3)}, ValueError),
            ({"frameskip": "x"}, TypeError),
            ({"frameskip": (1.0, 2)}, TypeError),
            ({"reward_range": (2, 1)}, ValueError),
            ({"server": 3}, TypeError),
            ({"reward_range": (0, float("nan"))}, ValueError),
            ({"reward_range": (1,)}, ValueError),
            ({"reward_range": ("a", 1)}, TypeError),
            ({"reward_range": 5}, TypeError),
            ({"rom": 5}, TypeError),
            ({"two_player": True, "continuous": True}, ValueError),
        ):
            for also in (wrong, kind):
                self.refused(also, next(iter(arguments)), make, "beamfall", **arguments)
        for flag in ("two_player", "continuous", "sound", "sound_obs", "life_loss_ends", "full_action_space"):
            self.refused(
                wrong, f"{flag} is array.*; it takes True or False", make, "beamfall", **{flag: np.ones(2, bool)}
            )

    def test_actions(self):
        env = racebeam.AtariEnv("beamfall")
        env.reset(seed=1)
        for action in (18, -1, 10**30):
            self.refused(IndexError, "^action ", env.step, action)
        for action in (1.5, "FIRE", None, np.zeros(2)):
            self.refused(TypeError, "", env.step, action)
        before = env.ale.getFrameNumber()
        for action in (3, np.int64(3), np.array(3), np.uint8(3), True):
            env.step(action)
        self.assertEqual(env.ale.getFrameNumber(), before + 20)

    def test_images(self):
        good = (HOMEBREW / "beamfall.bin").read_bytes()
        env = racebeam.AtariEnv("beamfall", rom=good)
        self.assertEqual(env.reset(seed=1)[0].tobytes(), racebeam.AtariEnv("beamfall").reset(seed=1)[0].tobytes())
        for rom in (bytearray(good), memoryview(good), np.frombuffer(good, np.uint8)):
            env = racebeam.AtariEnv("beamfall", rom=rom)
            self.assertEqual(pickle.loads(pickle.dumps(env)).reset(seed=1)[0].tobytes(), env.reset(seed=1)[0].tobytes())
            env.ale.loadROM(rom)
            self.assertEqual(racebeam.ALEInterface.isSupportedROM(rom), "beamfall")
        for rom in (5, [1], env):
            for call in (lambda rom: racebeam.AtariEnv("beamfall", rom=rom), env.ale.loadROM, env.ale.isSupportedROM):
                self.refused(TypeError, "^rom ", call, rom)
        for rom, sentence in (
            (b"", "it is empty"),
            (b"x" * 600000, "larger than the largest image"),
            ("/nowhere/x.bin", "there is no such file"),
            ("/dev/zero", "image /dev/zero"),
        ):
            self.refused(racebeam.InvalidInput, sentence, racebeam.AtariEnv, "beamfall", rom=rom)

    def test_seeds(self):
        env = racebeam.AtariEnv("beamfall")
        for seed in (-1, 1.5, "x", np.int64(3)):
            self.refused(gym.error.Error, "Seed must be", env.reset, seed=seed)
        self.assertEqual(len(env.reset(seed=2**100)[1]["seeds"]), 2)

    def test_a_missing_image_says_where_was_looked(self):
        script = (
            "import racebeam\ntry: racebeam.AtariEnv('pong')\nexcept FileNotFoundError as e: print(type(e).__name__, e)"
        )
        with_path = dict(os.environ, RACEBEAM_ROMS="/nowhere", ALE_ROMS_DIR=str(HOMEBREW), PYTHONPATH="")
        blind = (
            "import importlib.machinery as m; m.PathFinder.find_spec = classmethod(lambda *a, "
            "_f=m.PathFinder.find_spec: "
        )
        blind += "None if a[1:2] == ('ale_py',) else _f(*a[1:]));"
        done = subprocess.run(
            [sys.executable, "-c", blind + script], env=with_path, capture_output=True, text=True, check=True
        )
        self.assertIn(
            "MissingImage no cartridge image of pong was found; racebeam searched RACEBEAM_ROMS, /nowhere (not a "
            "folder); "
            f"ALE_ROMS_DIR, {HOMEBREW} (no file has an MD5 of the game); an installed ale_py",
            done.stdout,
        )

    def test_an_image_is_found_by_its_md5(self):
        if "pong" not in package.roms():
            self.skipTest("there is no image of pong")
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "something.a26").write_bytes(pathlib.Path(racebeam.find_image("pong")).read_bytes())
            pathlib.Path(folder, "pong.bin").write_bytes(b"no image of pong")
            script = "import racebeam; print(racebeam.find_image('pong'))"
            done = subprocess.run(
                [sys.executable, "-c", script],
                env=dict(os.environ, RACEBEAM_ROMS=folder),
                capture_output=True,
                text=True,
                check=True,
            )
            self.assertEqual(done.stdout.strip(), str(pathlib.Path(folder, "something.a26")))

    def test_a_file_that_is_overwritten_is_identified_again(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, RACEBEAM_ROMS=folder):
            image, game = pathlib.Path(folder, "something.rom"), "updraft"
            with unittest.mock.patch.object(images, "built_in", frozenset):
                for name, expected in (("updraft", str(image)), ("beamfall", None), ("updraft", str(image))):
                    image.write_bytes((HOMEBREW / f"{name}.bin").read_bytes())
                    self.assertEqual(images.find_all().get(game), expected)
                    if expected is None:
                        self.refused(racebeam.MissingImage, "no file has an MD5 of the game", racebeam.find_image, game)
                    else:
                        self.assertEqual(racebeam.find_image(game), expected)

    def test_what_counts_as_an_image_is_in_the_document(self):
        told = re.search(
            r"A file that ends in (.*?) is identified",
            (package.SOURCE / "docs/python.md").read_text().replace("\n", " "),
        )[1]
        self.assertEqual(told, "`.bin`, `.a26` or `.rom`, also with `.gz` after it,")
        with tempfile.TemporaryDirectory() as folder:
            names = ("a.bin", "b.a26", "c.rom", "d.bin.gz", "e.BIN", "f", "g.foo", "h.bin.bak", "i.zip", "sub/j.bin")
            pathlib.Path(folder, "sub").mkdir()
            for name in names:
                pathlib.Path(folder, name).write_bytes(b"x")
            self.assertEqual(
                racebeam._core.image_files(folder),
                [str(pathlib.Path(folder, name)) for name in (*names[:5], "i.zip")],
            )

    def test_the_games_are_the_callers_own(self):
        racebeam.games().clear()
        self.assertEqual(len(racebeam.games()), 110)
        self.assertEqual(racebeam.games()["beamfall"], "Beamfall")

    def test_after_close(self):
        env = racebeam.AtariEnv("beamfall")
        env.close()
        env.close()
        ours = racebeam.AtariEnv("beamfall")
        for call in (
            lambda: env.step(0),
            env.reset,
            env.render,
            env.clone_state,
            lambda: env.restore_state(ours.clone_state()),
            env.seed_game,
            env.load_game,
            lambda: env.ale.act(0),
            lambda: env.ale.getScreenRGB(),
            lambda: copy.copy(env),
            lambda: copy.deepcopy(env),
            lambda: pickle.dumps(env),
        ):
            self.refused(gym.error.ClosedEnvironmentError, "was closed", call)
        self.assertEqual(env.get_action_meanings(), ours.get_action_meanings())

    def test_states(self):
        env = racebeam.AtariEnv("beamfall")
        env.reset(seed=1)
        whole = env.clone_state().serialize()
        for data, sentence in (
            (b"nonsense", "are not a state"),
            (b"", "of no game"),
            (whole[:-9], ""),
            (whole + b"x", ""),
        ):
            self.refused(racebeam.InvalidInput, sentence, lambda data=data: env.restore_state(racebeam.ALEState(data)))
        self.refused(
            racebeam.InvalidInput, "the state is of", racebeam.AtariEnv("updraft").restore_state, env.clone_state()
        )
        self.assertEqual(env.clone_state().serialize(), whole)


@unittest.skipIf(importlib.util.find_spec("pygame") is None, "there is no pygame")
class Window(unittest.TestCase):
    """By SDL's driver that shows nothing; under a display, set SDL_VIDEODRIVER."""

    def check(self, script, *said, **variables):
        """What a script says at last."""
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, env={**os.environ, **variables}
        )
        self.assertEqual((done.returncode, done.stdout.split()[-len(said) :]), (0, [*said]), done.stderr)

    def test_a_person_sees_each_frame(self):
        script = (
            "import racebeam, time\n"
            "env = racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "quiet = racebeam.AtariEnv('beamfall')\n"
            "assert (env.reset(seed=1)[0] == quiet.reset(seed=1)[0]).all() and env.render() is None\n"
            "begin = time.monotonic()\n"
            "for action in range(15):\n"
            "    a, b = env.step(action), quiet.step(action)\n"
            "    assert (a[0] == b[0]).all() and a[1:] == b[1:], (a[1:], b[1:])\n"
            "took = time.monotonic() - begin\n"
            "import pygame\n"
            "shown = pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "assert (shown == a[0]).all()\n"
            "env.close()\n"
            "print(0.8 < took)"
        )
        self.check(script, "True")

    def test_games_share_the_window_until_each_is_closed(self):
        self.check(
            "import copy, pygame, racebeam\n"
            "def shown(): return pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "games = [racebeam.AtariEnv(game, render_mode='human', sound=True) for game in ('beamfall', 'updraft')]\n"
            "games.append(copy.deepcopy(games[0]))\n"
            "for _ in range(2):\n"
            "    for game in games:\n"
            "        assert (game.reset(seed=1)[0] == shown()).all()\n"
            "        print(pygame.display.get_caption()[0])\n"
            "for game in games[:2]:\n"
            "    game.close()\n"
            "assert (games[2].step(1)[0] == shown()).all()\n"
            "games[2].close()\n"
            "assert not pygame.display.get_init() and not pygame.mixer.get_init()\n"
            "games = [racebeam.AtariEnv('beamfall', render_mode='human') for _ in range(2)]\n"
            "pygame.quit()  # as another's environment does\n"
            "games[0].reset(); del games[0], game; games[0].close()\n"
            "assert not pygame.display.get_init()\n",
            *("Beamfall", "Updraft", "Beamfall") * 2,
        )

    def test_the_close_button_closes_the_window_and_the_games_go_on(self):
        self.check(
            "import pygame, racebeam, time\n"
            "games = [racebeam.AtariEnv('beamfall', render_mode='human', sound=True) for _ in range(2)]\n"
            "for game in games: game.reset(seed=1)\n"
            "pygame.event.post(pygame.event.Event(pygame.QUIT))\n"
            "games[0].step(1)\n"
            "assert not pygame.display.get_init() and not pygame.mixer.get_init()\n"
            "begin = time.monotonic()\n"
            "for _ in range(300): games[0].step(1), games[1].step(1)\n"
            "print(time.monotonic() - begin < 5, pygame.display.get_init())\n"
            "later = racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "later.reset(), games[0].close(), later.step(0)\n"
            "print(pygame.display.get_init())\n"
            "later.close()\n"
            "print(pygame.display.get_init())\n",
            *("True", "False", "True", "False"),
        )

    def test_keys_change_the_speed_and_pause(self):
        self.check(
            "import pygame, racebeam, threading, time\n"
            "def press(key): pygame.event.post(pygame.event.Event(pygame.KEYDOWN, unicode=key))\n"
            "def seconds(game, frames):\n"
            "    begin = time.monotonic()\n"
            "    for _ in range(frames): game.step(0)\n"
            "    return time.monotonic() - begin\n"
            "game = racebeam.AtariEnv('beamfall', render_mode='human', frameskip=1)\n"
            "game.reset(seed=1)\n"
            "for _ in range(3): press('-'); game.step(0)\n"
            "print(seconds(game, 4) > 0.4)  # 7.5 frames a second\n"
            "for _ in range(3): press('+'); game.step(0)\n"
            "press('x')\n"
            "print(seconds(game, 30) > 0.4)\n"
            "press('=')\n"
            "game.step(0)\n"
            "print(game._window._speed.factor)\n"
            "press('p')\n"
            "threading.Timer(0.6, press, 'p').start()\n"
            "print(seconds(game, 1) > 0.5)\n"
            "press('p')\n"
            "threading.Timer(0.3, pygame.event.post, [pygame.event.Event(pygame.QUIT)]).start()\n"
            "game.step(0), game.close()\n",
            *("True", "True", "2.0", "True"),
        )

    def test_a_person_sees_the_environments_of_a_vector(self):
        self.check(
            "import numpy as np, pygame, racebeam, time\n"
            "def shown(): return pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 3, seed=1, obs_type='rgb', stack_num=1, maxpool=False,\n"
            "    render_mode='human')\n"
            "envs.reset()\n"
            "begin = time.monotonic()\n"
            "for step in range(6):\n"
            "    screens = envs.step([step, 1, 0])[0][:, 0]\n"
            "took = time.monotonic() - begin\n"
            "empty = np.zeros_like(screens[0])\n"
            "assert (shown() == np.block([[[screens[0]], [screens[1]]], [[screens[2]], [empty]]])).all()\n"
            "print(pygame.display.get_caption()[0], 0.25 < took, envs.render())\n"
            "envs.close()\n"
            "print(pygame.display.get_init())\n",
            *("Beamfall", "True", "None", "False"),
        )

    def test_the_first_sixteen_of_many_environments_are_shown(self):
        self.check(
            "import pygame, racebeam\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 20, batch_size=5, render_mode='human', frameskip=60)\n"
            "envs.reset()\n"
            "pygame.event.post(pygame.event.Event(pygame.QUIT))\n"
            "print(pygame.display.get_surface().get_size())\n"
            "for _ in range(10): envs.step([0] * 5)\n"
            "print(pygame.display.get_init())\n",
            *("(1280,", "840)", "False"),
        )

    def test_without_a_display_a_sentence_says_so(self):
        self.check(
            "import racebeam\n"
            "try: racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "except racebeam.InvalidInput as error: print('needs a display' in str(error))",
            "True",
            SDL_VIDEODRIVER="x11",
            DISPLAY="",
        )


if __name__ == "__main__":
    package.main()
