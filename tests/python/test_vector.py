"""AtariVectorEnv: what ale_py's lacks, bad input, threads and forks, and Gymnasium's own wrappers."""

import copy
import dataclasses
import inspect
import pathlib
import pickle
import resource
import signal
import subprocess
import sys
import threading
import time
import unittest

import package

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
from gymnasium.error import ClosedEnvironmentError, Error
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.wrappers.vector import DictInfoToList, RecordEpisodeStatistics
from racebeam import AtariVectorEnv, InvalidInput, ale_py
from racebeam.vector_options import VectorOptions

GYMNASIUM = tuple(map(int, gymnasium.__version__.split(".")[:3]))
FLAGS = (
    "full_action_space",
    "continuous",
    "grayscale",
    "maxpool",
    "episodic_life",
    "life_loss_info",
    "reward_clipping",
    "use_fire_reset",
    "sound_obs",
)
SHORT = {"max_num_frames_per_episode": 12, "noop_max": 0}  # three steps an episode


def play(envs, steps, seed=0):
    """What random actions show."""
    random = np.random.default_rng(seed)
    return [envs.step(random.integers(0, envs.single_action_space.n, envs.batch_size)) for _ in range(steps)]


def same(one, other):
    """Whether two lists of what was shown are equal, their infos included."""
    return all(
        np.array_equal(a, b)
        for shown, expected in zip(one, other)
        for a, b in zip([*shown[:-1], *shown[-1].values()], [*expected[:-1], *expected[-1].values()])
    )


class Seeds(unittest.TestCase):
    def test_a_seed_decides_everything(self):
        envs = AtariVectorEnv("beamfall", 3, repeat_action_probability=0.25)
        shown = [(envs.reset(seed=seed), *play(envs, 30)) for seed in (3, np.int64(3), [3, 4, 5], np.array([3, 4, 6]))]
        self.assertTrue(same(shown[0], shown[1]) and same(shown[0], shown[2]))
        last, other = shown[0][-1][0], shown[3][-1][0]
        self.assertTrue(np.array_equal(last[:2], other[:2]))
        self.assertFalse(np.array_equal(last[2], other[2]))

    def test_the_seed_of_the_constructor_is_that_of_a_reset(self):
        envs, others = AtariVectorEnv("beamfall", 2, seed=9), AtariVectorEnv("beamfall", 2)
        others.reset(seed=9)
        self.assertTrue(same(play(envs, 10), play(others, 10)))

    def test_the_first_reset_has_the_seed_of_the_constructor(self):
        for settings in ({}, {"repeat_action_probability": 0.5, "noop_max": 30}):
            envs, others = AtariVectorEnv("beamfall", 2, seed=3, **settings), AtariVectorEnv("beamfall", 2, **settings)
            self.assertTrue(same([envs.reset()], [others.reset(seed=3)]))
            self.assertFalse(same([envs.reset(), envs.reset()], [others.reset(seed=3), others.reset(seed=3)]))
        seen, info = AtariVectorEnv("beamfall", 2, batch_size=1, seed=3, **settings).reset()
        self.assertTrue(np.array_equal(seen, others.reset(seed=3)[0][info["env_id"]]))

    def test_a_seed_of_the_constructor_ends_with_the_first_call_that_plays(self):
        for play_once in (
            lambda envs: envs.step([0, 0]),
            lambda envs: (envs.send([0, 0]), envs.recv()),
            lambda envs: envs.restore(0, envs.save(1)),
        ):
            envs = AtariVectorEnv("beamfall", 2, seed=3)
            begin = envs.show()[1]["frame_number"]
            play_once(envs)
            self.assertTrue((envs.reset()[1]["frame_number"] > begin).all())

    def test_some_have_seeds_and_some_have_none(self):
        envs = AtariVectorEnv("beamfall", 3, repeat_action_probability=0.5)
        envs.reset(seed=[5, 5, 5])
        play(envs, 10)
        frames = envs.reset(seed=[5, None, -1])[1]["frame_number"]
        self.assertLess(frames[0], 40)
        self.assertTrue((frames[1:] >= 40).all())


class Observations(unittest.TestCase):
    def test_they_are_the_callers_own(self):
        envs = AtariVectorEnv("beamfall", 2)
        shown = [envs.reset(seed=1)[0], envs.step(np.zeros(2, int))[0]]
        before = [one.copy() for one in shown]
        play(envs, 20)
        self.assertTrue(all(map(np.array_equal, shown, before)))

    def test_infos_are_the_callers_own_too(self):
        envs = AtariVectorEnv("beamfall", 4, batch_size=2, seed=1)
        _, info = envs.reset()
        info["env_id"][:] = 3
        envs.step([0, 0])
        self.assertEqual(sorted([*envs._received_ids, *envs.recv()[4]["env_id"]]), [0, 1, 2, 3])

    def test_they_go_where_the_caller_wants_them(self):
        envs, others = (AtariVectorEnv("beamfall", 2) for _ in range(2))
        out = np.zeros(envs.observation_space.shape, np.uint8)
        self.assertIs(envs.reset(seed=1, out=out)[0], out)
        self.assertTrue(np.array_equal(out, others.reset(seed=1)[0]))
        self.assertIs(envs.step(np.ones(2, int), out=out)[0], out)
        self.assertTrue(np.array_equal(out, others.step(np.ones(2, int))[0]))
        half = np.zeros((4, *out.shape[1:]), np.uint8)
        frozen = out.copy()
        frozen.setflags(write=False)
        for wrong in (out[:1], out.astype(np.int32), half[::2], frozen, out.tolist()):
            with self.assertRaisesRegex(InvalidInput, "^out "):
                envs.step(np.ones(2, int), out=wrong)

    def test_kinds(self):
        for settings, shape in (
            ({"obs_type": "grayscale"}, (4, 210, 160)),
            ({"obs_type": "rgb", "stack_num": 1}, (1, 210, 160, 3)),
            ({"obs_type": "ram"}, (128,)),
            ({"img_height": 20, "img_width": 31}, (4, 20, 31)),
            ({"img_height": 224, "img_width": 224}, (4, 224, 224)),
            ({"img_height": 420, "img_width": 320}, (4, 420, 320)),
            ({"grayscale": False}, (4, 84, 84, 3)),
            ({"img_height": 0, "img_width": 0}, (4, 210, 160)),
        ):
            with self.subTest(**settings):
                envs = AtariVectorEnv("beamfall", 2, **settings)
                self.assertEqual(envs.reset(seed=1)[0].shape, (2, *shape))
                self.assertIn(play(envs, 5)[-1][0], envs.observation_space)

    def test_full_ones_are_those_of_AtariEnv(self):
        for kind in ("rgb", "grayscale", "ram"):
            envs = AtariVectorEnv(
                "beamfall", 1, obs_type=kind, noop_max=0, use_fire_reset=False, maxpool=False, stack_num=1
            )
            env = racebeam.AtariEnv("beamfall", obs_type=kind, repeat_action_probability=0.0)
            envs.reset(seed=3)
            env.ale.setInt("random_seed", 3)
            env.load_game()
            env.ale.reset_game()
            for action in (1, 3, 4, 0, 1):
                seen = envs.step([action])[0].reshape(env.observation_space.shape)
                self.assertTrue(np.array_equal(seen, env.step(action)[0]), kind)

    def test_the_sound_is_that_of_AtariEnv(self):
        settings = {"obs_type": "ram", "sound_obs": True}
        envs = AtariVectorEnv("beamfall", 2, noop_max=0, use_fire_reset=False, frameskip=1, **settings)
        self.assertEqual(list(envs.single_observation_space), ["image", "sound"])
        env = racebeam.AtariEnv("beamfall", frameskip=1, repeat_action_probability=0.0, **settings)
        seen, _ = envs.reset(seed=3)
        env.ale.setInt("random_seed", 3)
        env.load_game()
        env.ale.reset_game()
        heard = set()
        for step in range(60):
            self.assertIn(seen, envs.observation_space)
            self.assertEqual({name: part.shape for name, part in seen.items()}, {"image": (2, 128), "sound": (2, 512)})
            seen, single = envs.step([1, 0])[0], env.step(1)[0]
            for name, part in single.items():
                self.assertTrue(np.array_equal(seen[name][0], part), (name, step))
            heard.add(seen["sound"][0].tobytes())
        self.assertGreater(len(heard), 5)
        self.assertTrue(np.array_equal(envs.show()[0]["sound"], seen["sound"]))

    def test_the_sound_of_some_environments(self):
        envs, others = (
            AtariVectorEnv("beamfall", 3, sound_obs=True, **settings) for settings in ({"batch_size": 1}, {})
        )
        expected = others.reset(seed=1)[0]
        seen, info = envs.reset(seed=1)
        env = info["env_id"][0]
        self.assertTrue(np.array_equal(seen["sound"][0], expected["sound"][env]))
        out = np.zeros((1, 4, 84, 84), np.uint8)
        self.assertIs(envs.step([0], out=out)[0]["image"], out)

    def test_render_shows_each_environment(self):
        for kind in ("ram", None):
            envs = AtariVectorEnv("beamfall", 2, obs_type=kind, render_mode="rgb_array")
            full = AtariVectorEnv("beamfall", 2, obs_type="rgb", stack_num=1, maxpool=False)
            for one in (envs, full):
                one.reset(seed=1)
            shown = [play(one, 7)[-1][0] for one in (envs, full)]
            pictures = envs.render()
            self.assertEqual(len(pictures), 2)
            self.assertTrue(all(np.array_equal(picture, seen[0]) for picture, seen in zip(pictures, shown[1])))
        with self.assertRaisesRegex(Error, "render_mode"):
            full.render()

    def test_a_stack_may_begin_with_repeats(self):
        envs = AtariVectorEnv("beamfall", 1, stack_start="repeats")
        stack = envs.reset(seed=1)[0][0]
        self.assertTrue(all(np.array_equal(stack[0], screen) for screen in stack) and stack.any())


class Episodes(unittest.TestCase):
    def test_the_modes_of_autoreset(self):
        for mode in ("NextStep", "SAME_STEP", AutoresetMode.DISABLED):
            envs = AtariVectorEnv("beamfall", 2, autoreset_mode=mode, **SHORT)
            envs.reset(seed=2)
            shown = play(envs, 5)
            kind = envs.metadata["autoreset_mode"]
            self.assertIsInstance(kind, AutoresetMode)
            self.assertEqual(
                [int(one[3][0]) for one in shown],
                [
                    0,
                    0,
                    1,
                    *{AutoresetMode.NEXT_STEP: (0, 0), AutoresetMode.SAME_STEP: (0, 0), AutoresetMode.DISABLED: (1, 1)}[
                        kind
                    ],
                ],
            )
            frames = [int(one[4]["episode_frame_number"][0]) for one in shown]
            self.assertEqual(frames[3] == frames[2], kind is AutoresetMode.DISABLED)
            self.assertEqual("final_obs" in shown[2][4], kind is AutoresetMode.SAME_STEP)
            self.assertFalse(any("final_obs" in shown[step][4] for step in (0, 1, 3, 4)))
        self.assertNotIn("autoreset_mode", VectorEnv.metadata)

    def test_final_observations_are_those_of_the_episode_that_ended(self):
        for kind in (None, "ram"):
            envs, others = (
                AtariVectorEnv(
                    "beamfall", 3, autoreset_mode=mode, obs_type=kind, noop_max=20, max_num_frames_per_episode=40
                )
                for mode in ("SameStep", "Disabled")
            )
            envs.reset(seed=2)
            others.reset(seed=2)
            for (_, _, _, truncated, info), (seen, *_, expected) in zip(play(envs, 10), play(others, 10)):
                self.assertEqual("final_obs" in info, truncated.any())
                if not truncated.any():
                    continue
                self.assertTrue(
                    np.array_equal(info["_final_obs"], truncated) and np.array_equal(info["_final_info"], truncated)
                )
                self.assertEqual(info["final_obs"].dtype, object)
                for env in range(3):
                    if not truncated[env]:
                        self.assertIsNone(info["final_obs"][env])
                        continue
                    self.assertTrue(np.array_equal(info["final_obs"][env], seen[env]))
                    for key in ("lives", "frame_number", "episode_frame_number"):
                        self.assertEqual(info["final_info"][key][env], expected[key][env])
                        self.assertTrue(info["final_info"][f"_{key}"][env])

    def test_final_observations_have_the_sound_of_the_episode_that_ended(self):
        for theirs in (AtariVectorEnv, ale_py.AtariVectorEnv):
            settings = {"sound_obs": True, "noop_max": 20, "max_num_frames_per_episode": 40}
            envs = theirs("beamfall", 3, autoreset_mode="SameStep", **settings)
            others = AtariVectorEnv("beamfall", 3, autoreset_mode="Disabled", **settings)
            envs.reset(seed=2)
            others.reset(seed=2)
            for (_, _, _, truncated, info), (seen, *_) in zip(play(envs, 10), play(others, 10)):
                for env in np.flatnonzero(truncated):
                    finals = info["final_obs"]
                    final = finals[env] if theirs is AtariVectorEnv else {key: finals[key][env] for key in finals}
                    self.assertTrue(all(np.array_equal(final[key], seen[key][env]) for key in seen))
            self.assertTrue(truncated.any())

    def test_a_reset_of_some(self):
        envs = AtariVectorEnv("beamfall", 3, autoreset_mode="Disabled", noop_max=0)
        envs.reset(seed=1)
        before = play(envs, 5)[-1][0]
        seen, info = envs.reset(options={"reset_mask": np.array([True, False, False])})
        self.assertEqual([frames < 5 for frames in info["episode_frame_number"]], [True, False, False])
        self.assertTrue(np.array_equal(seen[1:], before[1:]))
        self.assertFalse(np.array_equal(seen[0], before[0]))

    def test_the_info_has_unclipped_rewards_and_true_ends(self):
        envs = AtariVectorEnv("beamfall", 2, frameskip=60, lives="end")
        envs.reset(seed=1)
        shown = [envs.step([1, 1]) for _ in range(60)]
        raw = np.array([one[4]["raw_reward"] for one in shown])
        self.assertTrue(np.array_equal(np.clip(raw, -1, 1), [one[1] for one in shown]))
        self.assertGreater(raw.max(), 1)
        ends, games = (np.array(one) for one in zip(*((one[2], one[4]["game_over"]) for one in shown)))
        self.assertGreater(games.sum(), 0)
        self.assertGreater(ends.sum(), games.sum())

    def test_what_a_lost_life_does(self):
        frames = {}
        for lives in ("ignored", "told", "end", "restart"):
            envs = AtariVectorEnv("beamfall", 1, frameskip=60, lives=lives, noop_max=0)
            envs.reset(seed=1)
            shown = [envs.step([1]) for _ in range(40)]
            first = next(step for step, one in enumerate(shown) if one[2][0])
            frames[lives] = [int(one[4]["lives"][0]) for one in shown[first : first + 2]]
        self.assertEqual(
            {lives: after for lives, (_, after) in frames.items()}, {"ignored": 4, "told": 3, "end": 3, "restart": 4}
        )

    def test_presets(self):
        envs = AtariVectorEnv("beamfall", 1, preset="paper2013")
        envs.reset(seed=1)
        self.assertEqual(envs.single_action_space.n, 18)
        self.assertEqual(int(envs.step([0])[4]["episode_frame_number"][0]), 5)
        with self.assertRaisesRegex(InvalidInput, "preset 'dqn'"):
            AtariVectorEnv("beamfall", 1, preset="dqn")

    def test_several_games(self):
        envs = AtariVectorEnv(["beamfall", "updraft", "beamfall"], full_action_space=True, seed=1)
        alone = AtariVectorEnv("updraft", 3, full_action_space=True, seed=1)
        together, expected = play(envs, 10), play(alone, 10)
        self.assertTrue(all(np.array_equal(one[0][1], other[0][1]) for one, other in zip(together, expected)))
        self.assertFalse(np.array_equal(together[-1][0][0], together[-1][0][1]))
        for arguments in ((["beamfall", "updraft"], 3), ([],)):
            with self.assertRaises(Error):
                AtariVectorEnv(*arguments)
        with self.assertRaisesRegex(Error, "^there are 2 games"):
            AtariVectorEnv(["beamfall", "updraft"], rom=b"", full_action_space=True)


class States(unittest.TestCase):
    def test_an_image_is_given_as_bytes_of_any_kind(self):
        image = (package.SOURCE / "games/homebrew/beamfall.bin").read_bytes()
        shown = [
            AtariVectorEnv("beamfall", 1, rom=rom).reset(seed=1)[0]
            for rom in (image, bytearray(image), memoryview(image))
        ]
        self.assertTrue(np.array_equal(shown[0], shown[1]) and np.array_equal(shown[0], shown[2]))
        self.assertRaisesRegex(TypeError, "^rom .* int", AtariVectorEnv, "beamfall", 1, rom=3)

    def test_one_environment_goes_back(self):
        envs = AtariVectorEnv("beamfall", 2, repeat_action_probability=0.25, seed=1)
        before = play(envs, 10)[-1][0]
        state = envs.save(1)
        first = play(envs, 20)
        envs.restore(1, state)
        seen = envs.show()[0]
        self.assertTrue(np.array_equal(seen[1], before[1]) and np.array_equal(seen[0], first[-1][0][0]))
        second = play(envs, 20)
        self.assertTrue(
            all(
                np.array_equal(one[0][1], other[0][1]) and one[1][1] == other[1][1] for one, other in zip(first, second)
            )
        )
        self.assertFalse(np.array_equal(first[-1][0][0], second[-1][0][0]))

    def test_a_state_goes_to_another_environment_but_not_to_another_game(self):
        envs, others = AtariVectorEnv("beamfall", 2, seed=1), AtariVectorEnv("updraft", 1)
        play(envs, 10)
        envs.restore(0, envs.save(1))
        first = envs.show()[0]
        self.assertTrue(np.array_equal(first[0], first[1]))
        with self.assertRaises(InvalidInput):
            others.restore(0, envs.save(0))
        with self.assertRaises(IndexError):
            envs.save(2)
        with self.assertRaises(IndexError):
            envs.restore(-1, envs.save(0))
        with self.assertRaises(TypeError):
            envs.restore(0, None)

    def test_later_episodes_are_the_same(self):
        for mode in ("NextStep", "SameStep", "Disabled"):
            for sticky in (0.0, 0.25):
                envs = AtariVectorEnv(
                    "beamfall",
                    2,
                    autoreset_mode=mode,
                    repeat_action_probability=sticky,
                    max_num_frames_per_episode=100,
                    seed=1,
                )
                play(envs, 33)
                states = [envs.save(env) for env in range(2)]

                def on():
                    shown = []
                    for step in range(100):
                        shown.append(envs.step([step % 4, 1]))
                        ended = shown[-1][2] | shown[-1][3]
                        if mode == "Disabled" and ended.any():
                            observations, info = envs.reset(options={"reset_mask": ended})
                            shown.append((observations, info))
                    return shown

                first = on()
                for env in range(2):
                    envs.restore(env, states[env])
                second = on()
                with self.subTest(mode=mode, sticky=sticky):
                    lengths = {int(one[-1]["frame_number"][0]) for one in first}
                    self.assertGreater(len(lengths), 50)
                    self.assertTrue(
                        all(
                            np.array_equal(a[0], b[0]) and np.array_equal(a[-1]["frame_number"], b[-1]["frame_number"])
                            for a, b in zip(first, second)
                        )
                    )

    def test_a_state_of_other_screens_is_refused(self):
        envs = AtariVectorEnv("beamfall", 1, seed=1)
        before = play(envs, 5)[-1][0]
        for settings, sentence in (
            ({"stack_num": 2}, "stack of 2 .* stack of 4"),
            ({"img_height": 50}, "84 x 50"),
            ({"img_width": 42, "img_height": 168}, "42 x 168"),
            ({"grayscale": False}, "4 colour screens"),
            ({"obs_type": "ram"}, "no stack of screens"),
        ):
            with self.subTest(**settings), self.assertRaisesRegex(InvalidInput, sentence):
                envs.restore(0, AtariVectorEnv("beamfall", 1, seed=9, **settings).save(0))
        self.assertTrue(np.array_equal(envs.show()[0], before))

    def test_a_state_is_pickled_and_copied(self):
        for settings in (
            {},
            {"obs_type": "ram"},
            {"lives": "end", "grayscale": False},
            {"noop_max": 7, "rules": "fixed"},
        ):
            envs = AtariVectorEnv("beamfall", 1, seed=1, max_num_frames_per_episode=90, **settings)
            play(envs, 10)
            state = envs.save(0)
            expected = play(envs, 60)
            others = AtariVectorEnv("beamfall", 1, seed=2, max_num_frames_per_episode=90, **settings)
            for copied in (
                pickle.loads(pickle.dumps(state)),
                copy.deepcopy(state),
                pickle.loads(pickle.dumps(copy.copy(state))),
            ):
                others.restore(0, copied)
                with self.subTest(**settings):
                    self.assertTrue(same(play(others, 60), expected))
            envs.close()
            del envs
            self.assertEqual(pickle.dumps(state), pickle.dumps(copied))

    def test_pickled_bytes_that_were_altered_are_refused(self):
        envs, others = AtariVectorEnv("beamfall", 1, seed=1), AtariVectorEnv("updraft", 1)
        state = envs.save(0).__getstate__()
        kind = type(envs.save(0))

        def restored(data):
            copied = kind.__new__(kind)
            copied.__setstate__(data)
            envs.restore(0, copied)

        restored(state)
        for wrong in (
            b"",
            b"x" * 100,
            state[:-1],
            state + b"x",
            state[:500] + b"\0\1\2" + state[503:],
            state[:8] + b"\7" + state[9:],
        ):
            with self.assertRaises(InvalidInput):
                restored(wrong)
        with self.assertRaises(TypeError):
            restored(3)
        with self.assertRaisesRegex(InvalidInput, "^the state "):
            others.restore(0, pickle.loads(pickle.dumps(envs.save(0))))

    def test_environments_say_how_they_are_carried(self):
        envs = AtariVectorEnv("beamfall", 1)
        for carry in (pickle.dumps, copy.copy, copy.deepcopy):
            with self.assertRaisesRegex(TypeError, "^AtariVectorEnv "):
                carry(envs)


class Halves(unittest.TestCase):
    def test_each_environment_shows_the_same_as_in_whole_steps(self):
        together, envs = AtariVectorEnv("beamfall", 4), AtariVectorEnv("beamfall", 4, batch_size=2, num_threads=2)
        expected = [[together.reset(seed=1)[0][env]] for env in range(4)]
        for step in range(20):
            seen = together.step(np.full(4, step % 3))[0]
            for env in range(4):
                expected[env].append(seen[env])
        steps = [0] * 4

        def check(observations, info):
            for env, seen in zip(info["env_id"], observations):
                if steps[env] <= 20:
                    self.assertTrue(np.array_equal(seen, expected[env][steps[env]]))
                steps[env] += 1

        observations, info = envs.reset(seed=1)
        self.assertEqual(envs.action_space.shape, (2,))
        while min(steps) <= 20:
            check(observations, info)
            envs.send(np.array([(steps[env] - 1) % 3 for env in info["env_id"]]))
            observations, *_, info = envs.recv()

    def test_show_returns_all_environments(self):
        for settings in ({"batch_size": 1}, {"autoreset_mode": "SameStep", **SHORT}):
            envs = AtariVectorEnv("beamfall", 4, seed=1, **settings)
            if "batch_size" not in settings:
                self.assertIn("final_obs", play(envs, 3)[-1][4])
            seen, info = envs.show()
            self.assertEqual((seen.shape, info["env_id"].tolist()), ((4, 4, 84, 84), [0, 1, 2, 3]))
            self.assertNotIn("final_obs", info)

    def test_what_plays_is_not_touched(self):
        envs = AtariVectorEnv("beamfall", 4, batch_size=2)
        envs.reset(seed=1)
        for call in (envs.show, lambda: [envs.save(env) for env in range(4)]):
            with self.assertRaisesRegex(InvalidInput, "play"):
                call()
        envs.recv()
        with self.assertRaisesRegex(InvalidInput, "0 machines play"):
            envs.recv()
        with self.assertRaisesRegex(InvalidInput, "reset_mask"):
            envs.reset(options={"reset_mask": np.ones(4, bool)})

    def test_a_reset_drops_what_was_not_received(self):
        for settings in ({"batch_size": 2}, {}, {"autoreset_mode": "SameStep", **SHORT}):
            envs, others = (
                AtariVectorEnv("beamfall", 4, **settings),
                AtariVectorEnv("beamfall", 4, **{**settings, "batch_size": 0}),
            )
            for seed in (1, 2):
                (seen, info), (expected, _) = envs.reset(seed=seed), others.reset(seed=seed)
                with self.subTest(seed=seed, **settings):
                    self.assertTrue(np.array_equal(seen, expected[info["env_id"]]))
                envs.send([0] * envs.batch_size)

    def test_a_reset_of_some_drops_too(self):
        envs = AtariVectorEnv("beamfall", 2, seed=1)
        before = envs.reset()[1]["frame_number"]
        envs.send([0, 0])
        after = envs.reset(options={"reset_mask": np.array([True, False])})[1]["frame_number"]
        self.assertEqual(after[1], before[1] + 4)  # it has made its step


class Attributes(unittest.TestCase):
    def test_the_actions_of_each_environment(self):
        envs = AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)
        names = [action.name for action in racebeam.Action]
        self.assertEqual(envs.get_action_meanings(1), names)
        self.assertEqual(envs.call("get_action_meanings"), (names, names))
        single = racebeam.AtariEnv("beamfall")
        self.assertEqual(AtariVectorEnv("beamfall", 2).get_action_meanings(), single.get_action_meanings())
        for env in (2, -1):
            self.assertRaisesRegex(IndexError, f"environment {env}", envs.get_action_meanings, env)

    def test_attributes_and_calls(self):
        envs = AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)
        self.assertEqual(envs.get_attr("game"), ("beamfall", "updraft"))
        self.assertEqual(envs.get_attr("grayscale"), (True, True))
        self.assertEqual(len(envs.call("save", include_rng=False)), 2)
        self.assertRaises(AttributeError, envs.get_attr, "colour")
        self.assertRaisesRegex(AttributeError, "get_action_meanings", envs.call, "step")

    def test_the_text_names_the_game(self):
        self.assertEqual(repr(AtariVectorEnv("beamfall", 2)), "AtariVectorEnv(game='beamfall', num_envs=2)")
        self.assertEqual(
            repr(AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)),
            "AtariVectorEnv(game=['beamfall', 'updraft'], num_envs=2)",
        )
        self.assertEqual(
            repr(racebeam.AtariEnv("beamfall", frameskip=(2, 5))),
            "AtariEnv(game='beamfall', obs_type='rgb', frameskip=(2, 5))",
        )
        self.assertEqual(str(racebeam.AtariEnv("beamfall")), "<AtariEnv<beamfall>>")
        self.assertEqual(str(gymnasium.make("racebeam/Beamfall-v5").unwrapped), "<AtariEnv<racebeam/Beamfall-v5>>")


class Options(unittest.TestCase):
    def test_they_are_checked_and_cannot_be_changed(self):
        options = VectorOptions(num_envs=np.int64(4), autoreset_mode="SAME_STEP", seed=np.int64(3))
        self.assertEqual(
            (type(options.num_envs), options.batch_size, options.autoreset_mode), (int, 4, AutoresetMode.SAME_STEP)
        )
        with self.assertRaises(dataclasses.FrozenInstanceError):
            options.seed = 4
        self.assertRaisesRegex(Error, "batch_size is 5", dataclasses.replace, options, batch_size=5)

    def test_the_constructor_takes_each_of_them(self):
        taken = set(inspect.signature(AtariVectorEnv).parameters)
        self.assertEqual({field.name for field in dataclasses.fields(VectorOptions)} - taken, {"rows"})

    def test_the_core_has_what_they_say(self):
        core = VectorOptions(
            obs_type="ram", lives="end", max_num_frames_per_episode=7, reward_clipping=False
        ).core_settings()
        self.assertEqual(
            (core.stack, core.lives.name, core.max_episode_frames, core.reward_max), (0, "END", 7, 2**31 - 1)
        )


class Gymnasium(unittest.TestCase):
    def test_make_vec(self):
        envs = gymnasium.make_vec("racebeam/Beamfall-v5", 3, img_height=50)
        self.assertIsInstance(envs.unwrapped, AtariVectorEnv)
        self.assertEqual(envs.reset(seed=1)[0].shape, (3, 4, 50, 84))
        sticky = AtariVectorEnv("beamfall", 3, img_height=50, repeat_action_probability=0.25)
        sticky.reset(seed=1)
        self.assertTrue(same(play(envs.unwrapped, 20), play(sticky, 20)))

    def test_wrappers(self):
        envs = RecordEpisodeStatistics(AtariVectorEnv("beamfall", 2, frameskip=60, seed=1))
        infos = [envs.step(np.ones(2, int))[4] for _ in range(60)]
        self.assertTrue(any("episode" in info for info in infos))

    @unittest.skipIf(GYMNASIUM < (1, 2, 3), "DictInfoToList needs a mask for each key")
    def test_infos_as_lists(self):
        envs = DictInfoToList(AtariVectorEnv("beamfall", 2, autoreset_mode="SameStep", **SHORT))
        envs.reset(seed=1)
        infos = [envs.step(np.ones(2, int))[4] for _ in range(3)]
        self.assertEqual(infos[2][1]["final_obs"].shape, (4, 84, 84))
        self.assertEqual(infos[2][1]["final_info"]["episode_frame_number"], 13)
        self.assertNotIn("final_obs", infos[1][1])


class BadInput(unittest.TestCase):
    def test_arguments(self):
        for name, values in {
            "num_envs": (0, -1, 2.5, "2", 10**9),
            "batch_size": (-1, 3),
            "num_threads": (-1, None),
            "frameskip": (0, 1001, 2.5, (2, 5)),
            "img_width": (-1, "84"),
            "stack_num": (0, 17),
            "noop_max": (-1, 1001),
            "repeat_action_probability": (-0.1, 1.1, float("nan"), "x"),
            "autoreset_mode": ("Never", None, 3),
            "lives": ("hurts",),
            "start": ("ale",),
            "stack_start": ("x",),
            "obs_type": ("sound",),
            "rules": ("x",),
            "render_mode": ("ansi",),
            "seed": (-1, 2**32, "x"),
            "mode": (-1, "x"),
            "thread_affinity_offset": (-2,),
            "max_num_frames_per_episode": (-1, 2**31),
            **{flag: (np.ones(2, bool), np.zeros((2, 3))) for flag in FLAGS},
        }.items():
            for value in values:
                with self.subTest(**{name: value}), self.assertRaisesRegex(Error, name):
                    AtariVectorEnv("beamfall", **{"num_envs": 2, name: value})
        for arguments in (
            {"img_width": 321},
            {"img_height": 421},
            {"img_height": 5},
            {"mode": 99},
            {"difficulty": 9},
            {"rom": b"x" * 6},
            {"rom": "/nowhere.bin"},
        ):
            with self.subTest(**arguments), self.assertRaises(InvalidInput):
                AtariVectorEnv("beamfall", 2, **arguments)
        with self.assertRaises(racebeam.UnknownGame):
            AtariVectorEnv("beamfal", 2)

    def test_arguments_that_are_wrong_together(self):
        two = ["beamfall", "updraft"]
        for game, arguments, error, sentence in (
            (["beamfall"], {"num_envs": 3}, ValueError, "num_envs is 3"),
            ("beamfall", {"lives": "end", "episodic_life": True}, ValueError, "episodic_life is True"),
            (two, {"rom": b"", "full_action_space": True}, ValueError, "^there are 2 games"),
            (["beamfall", ["x"]], {}, TypeError, r"^game .*\['x'\]"),
            (b"beamfall", {}, TypeError, "^game .* 98 "),
            (3, {}, TypeError, "game is 3"),
            ("beamfall", {"sound_obs": True, "server": "unix:/nowhere"}, ValueError, "^sound_obs "),
        ):
            with self.subTest(sentence=sentence), self.assertRaisesRegex(error, sentence) as raised:
                AtariVectorEnv(game, **arguments)
            self.assertIsInstance(raised.exception, Error)

    def test_more_environments_than_the_memory_has(self):
        for count in (10**6, 10**7):
            with self.assertRaisesRegex(InvalidInput, "this process may use"):
                AtariVectorEnv("beamfall", count)

    def test_memory_that_runs_out(self):
        """Where more than the machines take it: thousands of them fail."""
        script = (
            "import pathlib, racebeam, resource\n"
            "few = racebeam.AtariVectorEnv('beamfall', 2, num_threads=2)\n"
            "used = int(pathlib.Path('/proc/self/statm').read_text().split()[0]) * resource.getpagesize()\n"
            "resource.setrlimit(resource.RLIMIT_AS, (used + (1000 << 20), -1))\n"
            "try: racebeam.AtariVectorEnv('beamfall', 4000, img_height=210, img_width=160, stack_num=16, "
            "grayscale=False)\n"
            "except MemoryError: print('refused')\n"
            "try: racebeam.AtariVectorEnv('beamfall', 50_000)\n"
            "except racebeam.InvalidInput as error: print('this process may use' in str(error))\n"
            "few.step([0, 0]); print('on')"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=Threads.PATIENCE)
        self.assertEqual(done.stdout.split(), ["refused", "True", "on"], done.stderr)

    def test_more_threads_than_environments(self):
        settings = racebeam._core.VectorSettings()
        settings.threads = settings.first_processor = 2**31 - 1
        machines = racebeam._core.VectorMachines([("builtin:beamfall", "beamfall")], np.zeros(2, np.int32), settings)
        self.assertEqual(len(machines.numbers_of_actions()), 2)

    def test_actions(self):
        envs, sticks = AtariVectorEnv("beamfall", 2, seed=1), AtariVectorEnv("beamfall", 2, continuous=True)
        for one, cases in (
            (
                envs,
                (
                    ([0, 99], IndexError),
                    ([-1, 0], IndexError),
                    ([0, 2**40], IndexError),
                    (np.array([0, 2**64 - 1], np.uint64), IndexError),
                    ([0], InvalidInput),
                    ([[0, 0]], InvalidInput),
                    ([[0], [0, 1]], InvalidInput),
                    (0, InvalidInput),
                    ([0.5, 1], TypeError),
                    (None, TypeError),
                    (["a", "b"], TypeError),
                    ([True, False], TypeError),
                ),
            ),
            (
                sticks,
                (
                    ([[0, 0, 0]], InvalidInput),
                    ([[0, 0]] * 2, InvalidInput),
                    ([0, 0], InvalidInput),
                    ([[float("nan"), 0, 0]] * 2, InvalidInput),
                    ([[float("inf"), 0, 0]] * 2, InvalidInput),
                    (None, TypeError),
                    ([["a", "b", "c"]] * 2, TypeError),
                ),
            ),
        ):
            for actions, error in cases:
                with self.subTest(actions=actions), self.assertRaises(error):
                    one.step(actions)
        self.assertEqual(envs.step([0, 0])[0].shape, (2, 4, 84, 84))
        for number in (2**63, 2**64 - 1):
            with self.assertRaisesRegex(IndexError, f"action {number} "):
                envs.step(np.array([0, number], np.uint64))

    def test_actions_before_the_first_reset_of_a_batch(self):
        for arguments, action in (({}, [0]), ({"continuous": True}, [[0, 0, 0]])):
            envs = AtariVectorEnv("beamfall", 2, batch_size=1, seed=1, **arguments)
            for call in (envs.send, envs.step):
                with self.assertRaisesRegex(InvalidInput, "reset"):
                    call(action)
            envs.reset()
            envs.step(action)

    def test_a_lost_life_has_one_effect(self):
        for flag, others in (("episodic_life", ("end", "told", "ignored")), ("life_loss_info", ("end", "restart"))):
            for lives in others:
                with (
                    self.subTest(flag=flag, lives=lives),
                    self.assertRaisesRegex(Error, f"{flag} is True.* but lives is '{lives}'"),
                ):
                    AtariVectorEnv("beamfall", 2, lives=lives, **{flag: True})
        for lives in (3, np.zeros(2)):
            self.assertRaisesRegex(Error, "lives is", AtariVectorEnv, "beamfall", 2, lives=lives, episodic_life=True)
        AtariVectorEnv("beamfall", 2, lives="restart", episodic_life=True)
        AtariVectorEnv("beamfall", 2, preset="dqn2015", episodic_life=True)

    def test_seeds_and_masks(self):
        envs = AtariVectorEnv("beamfall", 2, seed=1)
        for seed, error in (
            ("12", TypeError),
            (1.5, TypeError),
            (-3, InvalidInput),
            ([1], InvalidInput),
            ([1, -5], InvalidInput),
            (2**32, InvalidInput),
            ([1, "x"], TypeError),
            (np.zeros((2, 3)), TypeError),
        ):
            with self.subTest(seed=seed), self.assertRaisesRegex(error, "seed"):
                envs.reset(seed=seed)
        self.assertRaisesRegex(
            InvalidInput,
            r"seeds .*\(2, 1\)",
            envs.reset,
            seed=np.zeros((2, 1), int),
        )
        self.assertTrue(np.array_equal(envs.reset(seed=np.array(3))[0], envs.reset(seed=3)[0]))
        for options in (3, "x", [("reset_mask", None)]):
            with self.assertRaises(TypeError):
                envs.reset(options=options)
        for mask, error in (
            ([True, False], TypeError),
            (np.array([1, 0]), TypeError),
            (np.array([True]), InvalidInput),
        ):
            with self.subTest(mask=mask), self.assertRaises(error):
                envs.reset(options={"reset_mask": mask})

    def test_after_close(self):
        envs = AtariVectorEnv("beamfall", 2, render_mode="rgb_array")
        envs.close()
        envs.close()
        for call in (
            envs.reset,
            lambda: envs.step([0, 0]),
            lambda: envs.send([0, 0]),
            envs.recv,
            envs.show,
            envs.render,
            lambda: envs.save(0),
            lambda: envs.restore(0, None),
        ):
            with self.assertRaises(ClosedEnvironmentError):
                call()


class Threads(unittest.TestCase):
    PATIENCE = 60

    def test_two_threads_take_turns(self):
        envs, failures = AtariVectorEnv("beamfall", 4, num_threads=2, autoreset_mode="SameStep", **SHORT), []
        calls = (lambda: envs.step(np.zeros(4, int)), envs.reset, lambda: envs.restore(1, envs.save(2)), envs.show)

        def work(first):
            try:
                for step in range(100):
                    calls[(first + step) % len(calls)]()
            except Exception as error:
                failures.append(error)

        threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(self.PATIENCE)
        self.assertEqual((failures, [thread for thread in threads if thread.is_alive()]), ([], []))

    def test_a_child_after_a_fork_is_refused_and_ends(self):
        script = (
            "import os, racebeam\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 4, num_threads=2, seed=1); envs.step([0] * 4)\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "    refused = 0\n"
            "    for call in (lambda: envs.step([0] * 4), envs.reset, lambda: envs.save(0)):\n"
            "        try: call()\n"
            "        except RuntimeError as error: refused += 'before the process forked' in str(error)\n"
            "    envs.close(); del envs\n"
            "    os._exit(refused)\n"
            "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])); envs.step([0] * 4); print('on')"
        )
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=self.PATIENCE
        )
        self.assertEqual(done.stdout.split(), ["3", "on"], done.stderr)

    def test_the_memory_of_results_is_given_back(self):
        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

        envs = AtariVectorEnv("beamfall", 8, seed=1)
        play(envs, 20)
        before = resident()
        for _ in range(50):
            play(envs, 10)  # 110 MB of observations in all
        self.assertLess(resident() - before, 20 << 20)


class Interrupts(unittest.TestCase):
    """Ctrl-C ends what takes long, and leaves the environments so that they can go on."""

    LONG = {"num_envs": 500, "frameskip": 1000, "noop_max": 1000}

    def interrupt(self, call, raised=KeyboardInterrupt, handler=signal.default_int_handler):
        """`call` raises that, soon after a signal. Returns the seconds of processors it took."""
        before = signal.signal(signal.SIGALRM, handler)
        begin = time.process_time()
        try:
            with self.assertRaises(raised):
                signal.setitimer(signal.ITIMER_REAL, 0.1)
                call()
                time.sleep(1)  # a signal that comes late
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        return time.process_time() - begin

    def test_a_step_and_a_reset(self):
        envs = AtariVectorEnv("beamfall", **self.LONG, seed=1)
        for call in (lambda: envs.step([1] * 500), lambda: envs.reset(seed=1)):
            before = envs.show()[1]["frame_number"]
            self.interrupt(call)
            self.assertTrue((envs.show()[1]["frame_number"] == before).any())
        self.assertEqual(envs.reset(seed=1)[0].shape[0], 500)

    def test_making_them(self):
        begin = time.process_time()
        AtariVectorEnv("beamfall", **self.LONG)
        whole = time.process_time() - begin
        self.assertLess(self.interrupt(lambda: AtariVectorEnv("beamfall", **self.LONG)), whole)

    def test_what_is_received_later_is_not_lost(self):
        envs, others = (AtariVectorEnv("beamfall", **self.LONG, seed=1) for _ in range(2))
        envs.send([1] * 500)
        self.interrupt(envs.recv)
        self.assertTrue(same([envs.recv()], [others.step([1] * 500)]))
        envs.send([1] * 500)
        self.interrupt(envs.recv)
        self.assertTrue(same([envs.reset(seed=1)], [others.reset(seed=1)]))

    def test_a_handler_that_uses_them(self):
        envs = AtariVectorEnv("beamfall", **self.LONG)
        self.interrupt(lambda: envs.step([1] * 500), RuntimeError, lambda *_: envs.save(0))


class Found(unittest.TestCase):
    """By fuzz.py."""

    def test_calls_after_close_extras(self):
        envs = AtariVectorEnv("beamfall", 2)
        envs.close_extras()
        for call in (
            lambda: envs.step([0, 0]),
            envs.reset,
            envs.show,
            envs.recv,
            lambda: envs.send([0, 0]),
            lambda: envs.save(0),
        ):
            self.assertRaises(gymnasium.error.ClosedEnvironmentError, call)
        envs.close()

    def test_arguments_of_ALEVectorInterface(self):
        envs = ale_py.ALEVectorInterface("builtin:beamfall", 2)
        envs.reset([0, 1], [1, 2])
        for error, call in (
            (TypeError, lambda: envs.send([0, 1], "ab")),
            (ValueError, lambda: envs.send([0, 1], [[1], [2, 3]])),
            (TypeError, lambda: envs.reset([0, 1], ["x", None])),
            (TypeError, lambda: envs.reset(np.ones((2, 2)), [1, 2])),
        ):
            self.assertRaises(error, call)


if __name__ == "__main__":
    package.main()
