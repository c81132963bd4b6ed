"""racebeam.sb3.VecEnv is an environment of Stable-Baselines3. Skipped where that is not installed."""

import unittest

import package

package.require("numpy", "gymnasium", "stable_baselines3")

import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv as Base
from stable_baselines3.common.vec_env import VecMonitor

from racebeam import AtariVectorEnv
from racebeam.sb3 import VecEnv


class Interface(unittest.TestCase):
    def setUp(self):
        self.envs = VecEnv("beamfall", 2, seed=1, frameskip=60, render_mode="rgb_array")

    def test_it_shows_what_AtariVectorEnv_shows(self):
        self.assertIsInstance(self.envs, Base)
        other = AtariVectorEnv("beamfall", 2, seed=1, frameskip=60, autoreset_mode="SameStep", start="baselines", lives="end")
        self.assertTrue(np.array_equal(self.envs.reset(), other.reset()[0]))
        returns, lengths, episodes, ends = np.zeros(2), np.zeros(2), 0, 0
        frames_before = np.zeros(2)
        for step in range(120):
            seen, rewards, done, infos = self.envs.step(np.full(2, step % 6))
            expected, theirs, terminated, truncated, told = other.step(np.full(2, step % 6))
            self.assertTrue(np.array_equal(seen, expected) and np.array_equal(rewards, theirs))
            self.assertEqual((rewards.dtype, done.tolist()), (np.float32, (terminated | truncated).tolist()))
            returns, lengths = returns + told["raw_reward"], lengths + 1
            for env, info in enumerate(infos):
                self.assertEqual("terminal_observation" in info, done[env])
                frames = told["episode_frame_number"][env]
                self.assertEqual("episode" in info, frames < frames_before[env])
                if told["game_over"][env]:
                    self.assertIn("episode", info)
                frames_before[env] = frames
                ends += done[env]
                if done[env]:
                    self.assertTrue(np.array_equal(info["terminal_observation"], told["final_obs"][env]))
                    self.assertIs(info["TimeLimit.truncated"], False)
                if "episode" in info:
                    self.assertEqual((info["episode"]["r"], info["episode"]["l"]), (returns[env], lengths[env]))
                    returns[env] = lengths[env] = 0
                    episodes += 1
        self.assertGreater(ends, episodes)
        self.assertGreater(episodes, 0)

    def test_policies_are_evaluated_by_whole_games(self):
        class Fire:
            def predict(self, observations, state, **_):
                return np.ones(len(observations), int), state
        mean, deviation = evaluate_policy(Fire(), self.envs, n_eval_episodes=4)
        self.assertGreater(mean, 0)

    def test_seeds(self):
        self.envs.seed(5)
        first = self.envs.reset()
        self.envs.step(np.zeros(2, int))
        self.envs.seed(5)
        self.assertTrue(np.array_equal(self.envs.reset(), first))

    def test_what_wrappers_ask(self):
        self.assertEqual(self.envs.env_is_wrapped(Monitor), [True, True])
        self.assertEqual(self.envs.env_is_wrapped(VecMonitor), [False, False])
        self.assertEqual(self.envs.get_attr("num_envs", 0), [2])
        self.assertEqual(len(self.envs.env_method("save")), 2)
        self.assertEqual(self.envs.get_images()[1].shape, (210, 160, 3))
        self.envs.close()

    def test_it_learns(self):
        PPO("CnnPolicy", VecEnv("beamfall", 2, seed=1), n_steps=16, batch_size=16, n_epochs=1).learn(64)


if __name__ == "__main__":
    package.main()
