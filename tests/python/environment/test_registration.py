"""The ids of Gymnasium that racebeam registers."""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import warnings

import package
import pytest

package.require("gymnasium", "numpy")

import gymnasium as gym
import racebeam
from gymnasium.utils.env_checker import check_env


class TestRegistration:
    def test_every_game_has_an_id_and_ours_can_be_made(self):
        ids = [env_id for env_id in gym.registry if env_id.startswith("racebeam/")]
        assert len([env_id for env_id in ids if env_id.endswith("-v5")]) == len(racebeam.games())
        assert len([env_id for env_id in ids if env_id.endswith("NoFrameskip-v4")]) == len(racebeam.games())
        assert len(ids) == 220
        for env_id in ("racebeam/Beamfall-v5", "racebeam/Updraft-v5"):
            env = gym.make(env_id)
            assert type(env.unwrapped).__name__ == "AtariEnv"
            assert env.unwrapped._frameskip == 4
            assert env.unwrapped.ale.getInt("max_num_frames_per_episode") == 108000
            assert env.unwrapped.ale.getFloat("repeat_action_probability") == 0.25

    def test_ids_without_frame_skipping_are_for_wrappers_that_skip(self):
        env = gym.make("racebeam/BeamfallNoFrameskip-v4")
        env.reset(seed=1)
        assert env.step(0)[4]["episode_frame_number"] == 1
        assert env.unwrapped.ale.getFloat("repeat_action_probability") == 0
        assert env.unwrapped.ale.getInt("max_num_frames_per_episode") == 108000
        if importlib.util.find_spec("cv2"):
            gym.wrappers.AtariPreprocessing(env).reset(seed=1)
            with pytest.raises(ValueError):
                gym.wrappers.AtariPreprocessing(gym.make("racebeam/Beamfall-v5"))

    def warnings_of(self, env):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            env.reset(seed=1)
            env.reset()
        return [(str(one.message), one.filename) for one in caught if "skip frames" in str(one.message)]

    def test_frames_that_are_skipped_twice_are_warned_of_once(self, subtests):
        every_frame, skip = "racebeam/BeamfallNoFrameskip-v4", gym.wrappers.MaxAndSkipObservation
        for env, sentence in (
            (skip(gym.make("racebeam/Beamfall-v5"), 4), "4 x 4 = 16 frames, since AtariEnv and MaxAndSkipObservation"),
            (skip(skip(gym.make(every_frame), 2), 3), "2 x 3 = 6 frames, since MaxAndSkipObservation and MaxAndSkip"),
            (skip(racebeam.AtariEnv("beamfall", frameskip=(2, 5)), 2), "4 x 2 = 8 frames"),
        ):
            with subtests.test(sentence=sentence):
                [(message, file)] = self.warnings_of(env)
                assert sentence in message
                assert file == __file__
        assert self.warnings_of(skip(gym.make(every_frame), 4)) == []
        assert self.warnings_of(gym.make("racebeam/Beamfall-v5")) == []

    def test_a_wrapper_may_reset_before_it_has_its_environment(self):
        env = gym.make("racebeam/Beamfall-v5", obs_type="ram", render_mode="rgb_array")
        seen, _ = gym.wrappers.AddRenderObservation(env, render_only=False).reset(seed=1)
        assert seen["pixels"].shape == (210, 160, 3)

    @pytest.mark.needs_modules("cv2")
    def test_AtariPreprocessing_that_skips_twice_is_warned_of(self):
        every_frame, wrap = gym.make("racebeam/BeamfallNoFrameskip-v4"), gym.wrappers.AtariPreprocessing
        assert self.warnings_of(wrap(every_frame, screen_size=84)) == []
        twice = wrap(gym.wrappers.MaxAndSkipObservation(gym.make("racebeam/BeamfallNoFrameskip-v4"), 4))
        [(message, _)] = self.warnings_of(twice)
        assert "4 x 4 = 16 frames, since MaxAndSkipObservation and AtariPreprocessing" in message

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
        assert done.stdout.strip() == "(2, 210, 160, 3)", done.stderr

    @pytest.mark.needs_modules("ale_py")
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
            assert done.stdout.split("\n")[:2] == ["racebeam.ale_py.env:AtariEnv"] * 2, done.stderr
            assert done.stdout.split("\n")[2:4] == ["True ale_py._ale_py", "True"], done.stderr

    @pytest.mark.parametrize("obs_type", ("rgb", "grayscale", "ram"))
    def test_the_checker_of_gymnasium_finds_nothing(self, obs_type):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            env = gym.make("racebeam/Beamfall-v5", obs_type=obs_type, render_mode="rgb_array")
            check_env(env.unwrapped, skip_render_check=importlib.util.find_spec("pygame") is None)

    def test_the_ids_of_ale_have_the_settings_of_its_documents(self):
        script = (
            "import gymnasium as gym, racebeam\n"
            "racebeam.register_ale_ids()\n"
            "for name in ('Pong-v0', 'Pong-v4', 'PongNoFrameskip-v0', 'PongNoFrameskip-v4', 'ALE/Pong-v5'):\n"
            "    spec = gym.spec(name)\n"
            "    print(name, spec.kwargs.pop('repeat_action_probability'), spec.kwargs.pop('frameskip'), spec.kwargs,\n"
            "          spec.vector_entry_point, sep='|')"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        others = "{'game': 'pong', 'full_action_space': False, 'max_num_frames_per_episode': 108000}"
        assert done.stdout.splitlines() == [
            f"Pong-v0|0.25|(2, 5)|{others}|None",
            f"Pong-v4|0.0|(2, 5)|{others}|None",
            f"PongNoFrameskip-v0|0.25|1|{others}|None",
            f"PongNoFrameskip-v4|0.0|1|{others}|None",
            f"ALE/Pong-v5|0.25|4|{others}|racebeam.ale_py.vector_env:AtariVectorEnv",
        ]

    def test_the_ids_of_ale_come_when_they_are_asked_for(self):
        script = (
            "import gymnasium as gym, racebeam\n"
            "before = {i for i, s in gym.registry.items() if str(s.entry_point).startswith('racebeam')}\n"
            "racebeam.register_ale_ids(); racebeam.register_ale_ids()\n"
            "ours = {i for i, s in gym.registry.items() if str(s.entry_point).startswith('racebeam')} - before\n"
            "print(len(before), len(ours), sorted(ours)[0], 'PongNoFrameskip-v4' in ours, 'ALE/Combat-v5' in ours)"
        )
        done = subprocess.run([sys.executable, "-W", "error", "-c", script], capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["220", "352", "ALE/Adventure-v5", "True", "False"]
        assert done.stderr == ""
