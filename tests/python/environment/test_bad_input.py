"""AtariEnv refuses bad input, and says where it looks for images."""

import copy
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import package
import pytest

package.require("gymnasium", "numpy")

import gymnasium as gym
import numpy as np
import racebeam
from racebeam import images

HOMEBREW = package.SOURCE / "games/homebrew"


class TestBadInput:
    def check_refusal(self, error, sentence, call, *words, **arguments):
        with pytest.raises(error, match=sentence):
            call(*words, **arguments)

    def test_arguments(self):
        make, wrong = racebeam.AtariEnv, gym.error.Error
        self.check_refusal(racebeam.UnknownGame, "game 'beamfal'.* beamfall", make, "beamfal")
        self.check_refusal(racebeam.UnknownGame, r"game \[1\]", make, [1])
        for name in ("Pong", "PONG", "ALE/Pong-v5", "PongNoFrameskip-v4", "Pong-ramDeterministic-v0"):
            self.check_refusal(racebeam.UnknownGame, f"game '{name}'; did you mean pong\\?", make, name)
        self.check_refusal(racebeam.UnknownGame, r"games\(\) lists them", make, "nothing")
        self.check_refusal(wrong, "^obs_type .*'text'", make, "beamfall", obs_type="text")
        self.check_refusal(
            wrong, "render_mode is 'ansi'; it takes None, human, rgb_array", make, "beamfall", render_mode="ansi"
        )
        self.check_refusal(wrong, "frameskip has the type float", make, "beamfall", frameskip=4.0)
        for name, hint in (
            ("frame_skip", "did you mean frameskip"),
            ("max_episode_steps", "max_num_frames_per_episode takes the frames"),
            ("seed", r"reset\(\) takes the seed"),
            ("colour", r"help\(racebeam.AtariEnv\) lists the options"),
        ):
            sentence = f"unknown option '{name}'; {hint}"
            self.check_refusal(wrong, sentence, make, "beamfall", **{name: 4})
        self.check_refusal(TypeError, "did you mean frameskip", gym.make, "racebeam/Beamfall-v5", frame_skip=4)
        assert gym.make("racebeam/Beamfall-v5", max_episode_steps=4).spec.max_episode_steps == 4  # of Gymnasium
        for frameskip in (0, -1, (0, 3), (3, 3), (4, 3), (1, 2, 3), ()):
            self.check_refusal(wrong, "frameskip is", make, "beamfall", frameskip=frameskip)
        self.check_refusal(RuntimeError, "mode 7", make, "beamfall", mode=7)
        self.check_refusal(RuntimeError, "difficulty 9", make, "beamfall", difficulty=9)
        self.check_refusal(racebeam.InvalidInput, "preset 'dqn'", make, "beamfall", preset="dqn")
        self.check_refusal(racebeam.InvalidInput, r"preset \[1\]", make, "beamfall", preset=[1])
        self.check_refusal(racebeam.InvalidInput, "^rules .*5", make, "beamfall", rules=5)
        for probability in (2, -0.5, "x", "0.5", b"0.5", float("nan"), [0.5]):
            self.check_refusal(
                wrong, "repeat_action_probability is", make, "beamfall", repeat_action_probability=probability
            )
        for name, values in (
            ("mode", ("x", 1.0, -1, 2**40)),
            ("difficulty", ("x", -1)),
            ("max_num_frames_per_episode", (1.5, -5, 2**40)),
            ("noop_max", (1.5, -1, 10**12)),
            ("frameskip", (2**31, (1, 2**31), (1.0, 2), True)),
            ("server", (5, ["unix:x"])),
            ("continuous_action_threshold", ("x", "0.5", float("nan"), None)),
            ("timeout", ("x", 0, -1, float("nan"))),
        ):
            for value in values:
                self.check_refusal(wrong, f"{name} (is|has)", make, "beamfall", **{name: value})
        for name in ("frameskip", "max_num_frames_per_episode", "noop_max"):
            make("beamfall", **{name: np.int64(4)}).reset(seed=1)
        make("beamfall", frameskip=(np.int64(2), 5), mode=np.int32(0), difficulty=np.int64(1)).reset(seed=1)
        self.check_refusal(racebeam.InvalidInput, "beamfall has no mode for two", make, "beamfall", two_player=True)
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
                self.check_refusal(also, next(iter(arguments)), make, "beamfall", **arguments)
        for flag in ("two_player", "continuous", "sound", "sound_obs", "life_loss_ends", "full_action_space"):
            self.check_refusal(
                wrong, f"{flag} is array.*; it takes True or False", make, "beamfall", **{flag: np.ones(2, bool)}
            )

    def test_actions(self):
        env = racebeam.AtariEnv("beamfall")
        env.reset(seed=1)
        for action in (18, -1, 10**30):
            self.check_refusal(IndexError, "^action ", env.step, action)
        for action in (1.5, "FIRE", None, np.zeros(2)):
            self.check_refusal(TypeError, "", env.step, action)
        before = env.ale.getFrameNumber()
        for action in (3, np.int64(3), np.array(3), np.uint8(3), True):
            env.step(action)
        assert env.ale.getFrameNumber() == before + 20

    def test_images(self):
        good = (HOMEBREW / "beamfall.bin").read_bytes()
        env = racebeam.AtariEnv("beamfall", rom=good)
        assert env.reset(seed=1)[0].tobytes() == racebeam.AtariEnv("beamfall").reset(seed=1)[0].tobytes()
        for rom in (bytearray(good), memoryview(good), np.frombuffer(good, np.uint8)):
            env = racebeam.AtariEnv("beamfall", rom=rom)
            assert pickle.loads(pickle.dumps(env)).reset(seed=1)[0].tobytes() == env.reset(seed=1)[0].tobytes()
            env.ale.loadROM(rom)
            assert racebeam.ALEInterface.isSupportedROM(rom) == "beamfall"
        for rom in (5, [1], env):
            for call in (lambda rom: racebeam.AtariEnv("beamfall", rom=rom), env.ale.loadROM, env.ale.isSupportedROM):
                self.check_refusal(TypeError, "^rom ", call, rom)
        for rom, sentence in (
            (b"", "it is empty"),
            (b"x" * 600000, "larger than the largest image"),
            ("/nowhere/x.bin", "no such file"),
            ("/dev/zero", "image /dev/zero"),
        ):
            self.check_refusal(racebeam.InvalidInput, sentence, racebeam.AtariEnv, "beamfall", rom=rom)

    def test_seeds(self):
        env = racebeam.AtariEnv("beamfall")
        for seed in (-1, 1.5, "x", np.int64(3)):
            self.check_refusal(gym.error.Error, "Seed must be", env.reset, seed=seed)
        assert len(env.reset(seed=2**100)[1]["seeds"]) == 2

    def test_the_error_for_a_missing_image_names_the_searched_places(self):
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
        assert (
            "MissingImage no cartridge image of pong was found; racebeam searched RACEBEAM_ROMS, "
            f"{pathlib.Path('/nowhere')} (not a folder); "
            f"ALE_ROMS_DIR, {HOMEBREW} (no file has an MD5 of the game); an installed ale_py"
        ) in done.stdout

    def test_an_image_is_found_by_its_md5(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
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
            assert done.stdout.strip() == str(pathlib.Path(folder, "something.a26"))

    def test_a_file_that_is_overwritten_is_identified_again(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, RACEBEAM_ROMS=folder):
            image, game = pathlib.Path(folder, "something.rom"), "updraft"
            with unittest.mock.patch.object(images, "built_in", frozenset):
                for name, expected in (("updraft", str(image)), ("beamfall", None), ("updraft", str(image))):
                    image.write_bytes((HOMEBREW / f"{name}.bin").read_bytes())
                    assert images.find_all().get(game) == expected
                    if expected is None:
                        self.check_refusal(
                            racebeam.MissingImage, "no file has an MD5 of the game", racebeam.find_image, game
                        )
                    else:
                        assert racebeam.find_image(game) == expected

    def test_what_counts_as_an_image_is_in_the_document(self):
        table = re.search(
            r"A file that ends in (.*?) is identified",
            (package.SOURCE / "docs/python/reference.md").read_text().replace("\n", " "),
        )[1]
        assert table == "`.bin`, `.a26` or `.rom`, also with `.gz` after it,"
        with tempfile.TemporaryDirectory() as folder:
            names = ("a.bin", "b.a26", "c.rom", "d.bin.gz", "e.BIN", "f", "g.foo", "h.bin.bak", "i.zip", "sub/j.bin")
            pathlib.Path(folder, "sub").mkdir()
            for name in names:
                pathlib.Path(folder, name).write_bytes(b"x")
            assert racebeam._core.image_files(folder) == [
                str(pathlib.Path(folder, name)) for name in (*names[:5], "i.zip")
            ]

    def test_the_list_of_games_belongs_to_the_caller(self):
        before = dict(racebeam.games())
        racebeam.games().clear()
        assert racebeam.games() == before
        assert racebeam.games()["beamfall"] == "Beamfall"

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
            self.check_refusal(gym.error.ClosedEnvironmentError, "was closed", call)
        assert env.get_action_meanings() == ours.get_action_meanings()

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
            self.check_refusal(
                racebeam.InvalidInput, sentence, lambda data=data: env.restore_state(racebeam.ALEState(data))
            )
        self.check_refusal(
            racebeam.InvalidInput, "the state is of", racebeam.AtariEnv("updraft").restore_state, env.clone_state()
        )
        assert env.clone_state().serialize() == whole
