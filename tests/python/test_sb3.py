"""racebeam.sb3.VecEnv is an environment of Stable-Baselines3. Skipped where that is not installed."""

import os
import unittest

import package
import pytest

package.require("numpy", "gymnasium", "stable_baselines3")

import gymnasium
import numpy as np
from gymnasium.vector.utils import batch_space
from racebeam import AtariVectorEnv
from racebeam.sb3 import VecEnv
from racebeam.testing import VectorEnvironmentTests
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_atari_env
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv as Base
from stable_baselines3.common.vec_env import VecMonitor, VecVideoRecorder


class AsVector:
    """A VecEnv with the calls of a vector of Gymnasium."""

    def __init__(self, envs):
        self.envs, self.num_envs, self.metadata, self.unwrapped = envs, envs.num_envs, {}, self
        self.single_observation_space, self.single_action_space = envs.observation_space, envs.action_space
        self.observation_space = batch_space(envs.observation_space, envs.num_envs)

    def reset(self, *, seed):
        self.envs.seed(seed)
        return self.envs.reset(), {}

    def step(self, actions):
        observations, rewards, done, infos = self.envs.step(actions)
        truncated = np.array([info.get("TimeLimit.truncated", False) for info in infos])
        return observations, rewards, done & ~truncated, truncated, {}

    def close(self):
        self.envs.close()


class Contract(VectorEnvironmentTests, unittest.TestCase):
    def make_envs(self, count):
        return AsVector(VecEnv("beamfall", count, frameskip=20))


class TestInterface:
    @pytest.fixture(autouse=True)
    def set_up(self):
        self.envs = VecEnv("beamfall", 2, seed=1, frameskip=60, render_mode="rgb_array")

    def test_it_shows_what_AtariVectorEnv_shows(self):
        assert isinstance(self.envs, Base)
        other = AtariVectorEnv(
            "beamfall", 2, seed=1, frameskip=60, autoreset_mode="SameStep", start="baselines", life_loss="end"
        )
        assert np.array_equal(self.envs.reset(), other.reset()[0])
        returns, episodes, ends = np.zeros(2), 0, 0
        frames_before = np.zeros(2)
        for step in range(120):
            seen, rewards, done, infos = self.envs.step(np.full(2, step % 6))
            expected, theirs, terminated, truncated, other_infos = other.step(np.full(2, step % 6))
            assert np.array_equal(seen, expected) and np.array_equal(rewards, theirs)
            assert (rewards.dtype, done.tolist()) == (np.float32, (terminated | truncated).tolist())
            returns += other_infos["raw_reward"]
            for env, info in enumerate(infos):
                assert ("terminal_observation" in info) == done[env]
                frames = other_infos["episode_frame_number"][env]
                assert ("episode" in info) == (frames < frames_before[env])
                if other_infos["game_over"][env]:
                    assert "episode" in info
                frames_before[env] = frames
                ends += done[env]
                if done[env]:
                    assert np.array_equal(info["terminal_observation"], other_infos["final_obs"][env])
                    assert info["TimeLimit.truncated"] is False
                if "episode" in info:
                    frames = other_infos["final_info"]["episode_frame_number"][env]
                    assert (info["episode"]["r"], info["episode"]["l"]) == (returns[env], frames)
                    returns[env] = 0
                    episodes += 1
        assert ends > episodes
        assert episodes > 0

    def test_policies_are_evaluated_by_whole_games(self):
        class Fire:
            def predict(self, observations, state, **_):
                return np.ones(len(observations), int), state

        mean, deviation = evaluate_policy(Fire(), self.envs, n_eval_episodes=4)
        assert mean > 0

    @pytest.mark.needs_modules("cv2")
    def test_it_plays_what_make_atari_env_plays(self):
        ours = VecEnv("beamfall", 1, noop_max=0, reward_clipping=False)
        theirs = make_atari_env(
            lambda **more: gymnasium.make("racebeam/Beamfall-v5", frameskip=1, repeat_action_probability=0.0, **more),
            1,
            seed=3,
            wrapper_kwargs={"noop_max": 0, "clip_reward": False},
        )
        ours.seed(3)
        observations, expected, ends = ours.reset()[:, -1:], theirs.reset(), 0
        for step in range(800):
            assert (observations != expected.transpose(0, 3, 1, 2)).mean() < 0.05
            action = np.array([ours.action_space.n * (step // 3 * 7 % 11) // 11])
            observations, rewards, done, infos = ours.step(action)
            expected, *rest = theirs.step(action)
            observations = observations[:, -1:]
            assert (rewards.tolist(), done.tolist(), infos[0]["lives"]) == (
                *(part.tolist() for part in rest[:2]),
                rest[2][0]["lives"],
            )
            parts = [
                [info["episode"][key] for key in "rl"] if "episode" in info else None for info in (infos[0], rest[2][0])
            ]
            assert parts[0] == parts[1]
            ends += parts[0] is not None
        assert ends > 0

    def test_the_infos_have_each_game_that_ends(self, subtests):
        for settings in (
            {"max_num_frames_per_episode": 8},
            {"max_num_frames_per_episode": 40, "life_loss": "restart", "frameskip": 60},
        ):
            envs = VecEnv("beamfall", 2, seed=1, **settings)
            envs.reset()
            ends = 0
            for _ in range(60):
                _, _, done, infos = envs.step(np.ones(2, int))
                ends += done.sum()
                with subtests.test(**settings):
                    assert ["episode" in info for info in infos] == done.tolist()
            assert ends > 20

    def test_settings_that_are_not_those_of_a_VecEnv_are_refused(self, subtests):
        for settings, sentence in (
            ({"autoreset_mode": "NextStep"}, "autoreset_mode is 'NextStep'; VecEnv takes SameStep"),
            ({"life_loss": "reported"}, "VecEnv takes ignored, end, restart"),
            ({"batch_size": 1}, "batch_size is 1; VecEnv takes 0"),
        ):
            with subtests.test(**settings), pytest.raises(ValueError, match=sentence):
                VecEnv("beamfall", 2, **settings)
        VecEnv("beamfall", 2, autoreset_mode="SAME_STEP")

    def test_seeds(self):
        self.envs.seed(5)
        first = self.envs.reset()
        self.envs.step(np.zeros(2, int))
        self.envs.seed(5)
        assert np.array_equal(self.envs.reset(), first)

    def test_the_methods_that_wrappers_call(self):
        assert self.envs.env_is_wrapped(Monitor) == [True, True]
        assert self.envs.env_is_wrapped(VecMonitor) == [False, False]
        assert self.envs.get_attr("num_envs", 0) == [2]
        assert len(self.envs.env_method("save")) == 2
        assert self.envs.get_images()[1].shape == (210, 160, 3)
        assert (self.envs.render_mode, "rgb_array" in self.envs.metadata["render_modes"]) == ("rgb_array", True)
        self.envs.close()

    @pytest.mark.needs_modules("pygame")
    def test_films_have_the_speed_of_the_game(self, tmp_path):
        film = VecVideoRecorder(self.envs, str(tmp_path), lambda step: False)
        assert film.frames_per_sec == AtariVectorEnv.metadata["render_fps"] == 15  # of 60, with a frameskip of 4

    def test_a_person_sees_the_environments(self):
        os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
        envs = VecEnv("beamfall", 2, render_mode="human", frameskip=1)
        envs.reset()
        envs.step([0, 0])
        assert envs.render("human") is None
        assert envs.render() is None
        envs.close()

    def test_the_sound_is_a_part_of_the_observations(self):
        envs = VecEnv("beamfall", 2, sound_obs=True, max_num_frames_per_episode=8)
        assert envs.reset()["sound"].shape == (2, 512)
        for _ in range(2):
            *_, infos = envs.step([0, 0])
        assert set(infos[0]["terminal_observation"]) == {"image", "sound"}

    def test_it_learns(self):
        PPO("CnnPolicy", VecEnv("beamfall", 2, seed=1), n_steps=16, batch_size=16, n_epochs=1).learn(64)
