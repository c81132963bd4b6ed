"""Games and images of users: game files, unknown images, other dumps, and what the console must know."""

import contextlib
import copy
import pathlib
import pickle
import subprocess
import time
import warnings

import package
import pytest

package.require("gymnasium", "numpy")

import gymnasium as gym
import numpy as np
import racebeam
import racebeam.program

IMAGE = (package.SOURCE / "games/homebrew/beamfall.bin").read_bytes()
RULES = (package.SOURCE / "games/catalogue/beamfall.toml").read_text()
UNUSED = -6  # the 6507 has no NMI
DUMP = IMAGE[:UNUSED] + bytes([IMAGE[UNUSED] ^ 1]) + IMAGE[UNUSED + 1 :]
ACTIONS = [1, 3, 3, 1, 4, 0, 5, 1] * 12


def play(env):
    env.reset(seed=3)
    return [(step[0].tobytes(), *step[1:4]) for step in (env.step(action % env.action_space.n) for action in ACTIONS)]


class TestOwn:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path
        self.rom, self.file = self.folder / "image.bin", self.folder / "my_game.toml"
        self.rom.write_bytes(DUMP)
        self.file.write_text(RULES)

    @contextlib.contextmanager
    def quiet(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield

    def test_a_game_file_is_played_as_a_game_of_the_catalogue(self):
        with self.quiet():
            env = racebeam.AtariEnv(game_file=self.file, rom=self.rom)
        expected = play(racebeam.AtariEnv("beamfall"))
        assert play(env) == expected
        assert "my_game" in repr(env)
        assert sum(step[1] for step in expected) > 0

    def test_copies_keep_their_game(self):
        env = racebeam.AtariEnv(game_file=self.file, rom=DUMP, height=220)
        env.reset(seed=3)
        copies = [copy.deepcopy(env.ale), pickle.loads(pickle.dumps(env.ale))]
        rewards = [[ale.act(1) for _ in range(200)] for ale in (env.ale, *copies)]
        assert rewards[1:] == rewards[:1] * 2
        for ale in copies:
            assert ale.getGame() == "my_game"
            np.testing.assert_array_equal(ale.getScreen(), env.ale.getScreen())

    def test_vectors_and_ids(self, cleanup):
        expected = racebeam.AtariVectorEnv("beamfall", 2, seed=5)
        own_envs = racebeam.AtariVectorEnv(game_file=self.file, rom=self.rom, num_envs=2, seed=5)
        env_id = racebeam.register(self.file, self.rom)
        assert env_id == "racebeam/MyGame-v5"
        cleanup(gym.registry.pop, env_id)
        registered = gym.make_vec(env_id, num_envs=2, seed=5, preset="ale")
        frames = [envs.reset()[0] for envs in (expected, own_envs, registered)]
        for number in range(40):
            for frame in frames[1:]:
                np.testing.assert_array_equal(frame, frames[0])
            frames = [envs.step([number % 3, 1])[0] for envs in (expected, own_envs, registered)]
        assert gym.make(env_id).unwrapped._frameskip == 4

    def test_an_unknown_image_plays_without_score(self):
        env, expected = racebeam.AtariEnv(rom=DUMP), racebeam.AtariEnv("beamfall", full_action_space=True)
        env.reset(seed=3), expected.reset(seed=3)
        for action in ACTIONS:
            step, other = env.step(action), expected.step(action)
            np.testing.assert_array_equal(step[0], other[0])
            assert step[1:3] == (0, False)
        envs = racebeam.AtariVectorEnv(rom=self.rom, num_envs=2)
        envs.reset()
        assert envs.step([1, 2])[1].tolist() == [0, 0]
        with pytest.raises(racebeam.InvalidInput, match="no game is known"):
            racebeam.ALEInterface().loadROM(DUMP)

    def test_another_dump_is_warned_of_once(self):
        self.file.write_text(RULES + f"[[image]]\nmd5 = '{'0' * 32}'\nheight = 220\n")
        for make in (racebeam.AtariEnv, racebeam.AtariVectorEnv):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                env = make(game_file=self.file, rom=self.rom)
                env.reset(seed=1)
                env.reset(seed=2)
            assert len(caught) == 1
            assert "the rule of 'my_game' was written for" in str(caught[0].message)
            assert pathlib.Path(caught[0].filename).name == pathlib.Path(__file__).name
        assert racebeam.AtariEnv(game_file=self.file, rom=self.rom).observation_space.shape[0] == 220

    def test_the_console_is_set_and_what_does_not_fit_is_refused(self):
        env = racebeam.AtariEnv("beamfall", height=220, ystart=40, format="pal", left="paddles", scheme="2K")
        assert env.observation_space.shape == (220, 160, 3)
        assert racebeam.AtariEnv("beamfall", format="pal").observation_space.shape == (250, 160, 3)
        envs = racebeam.AtariVectorEnv("beamfall", 1, obs_type="rgb", height=220)
        assert envs.single_observation_space.shape[1] == 220
        for words, sentence in (
            ({"scheme": "F8"}, "8192"),
            ({"scheme": "BUS"}, "unsupported cartridge scheme 'BUS'"),
            ({"left": "mindlink"}, "joystick, paddles"),
            ({"height": 99}, "100 to 256"),
        ):
            for make in (racebeam.AtariEnv, racebeam.AtariVectorEnv):
                with pytest.raises(racebeam.InvalidInput, match=sentence):
                    make("beamfall", **words)

    def test_arguments_that_do_not_fit_together_are_refused(self):
        for make in (racebeam.AtariEnv, racebeam.AtariVectorEnv):
            with pytest.raises(ValueError, match="game is None"):
                make()
            with pytest.raises(ValueError, match="game is None"):
                make(game_file=self.file)
            with pytest.raises(ValueError, match="give one of them"):
                make("beamfall", game_file=self.file, rom=DUMP)
            with pytest.raises(ValueError, match="--game-file"):
                make(game_file=self.file, rom=DUMP, server="unix:s")
            with pytest.raises(TypeError, match="game_file is 3"):
                make(game_file=3, rom=DUMP)
            with pytest.raises(racebeam.InvalidInput):
                make(game_file=self.folder / "none.toml", rom=DUMP)

    @pytest.mark.needs_program
    def test_a_game_that_only_the_server_knows(self, cleanup):
        ready = self.folder / "ready"
        command = [
            racebeam.program.path(),
            "serve",
            "--listen",
            f"unix:{self.folder}/s",
            "--ready-file",
            str(ready),
            "--rom",
            str(self.rom),
            "--game-file",
            str(self.file),
        ]
        with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
            cleanup(process.wait)
            cleanup(process.kill)
            while not ready.exists():
                time.sleep(0.01)
            address = f"unix:{self.folder}/s"
            assert play(racebeam.AtariEnv("my_game", server=address)) == play(racebeam.AtariEnv("beamfall"))
            with pytest.raises(racebeam.UnknownGame):
                racebeam.AtariEnv("my_gam", server=address)
            tall = racebeam.AtariEnv("my_game", server=address, height=220)
            assert tall.observation_space.shape[0] == 220
            envs = racebeam.AtariVectorEnv("my_game", 2, server=address)
            assert envs.reset()[0].shape[0] == 2
            process.kill()
