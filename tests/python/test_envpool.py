"""racebeam.envpool has EnvPool's arguments, results and infos. What EnvPool itself shows was measured (EnvPool 1.2.5)."""

import sys
import time
import types
import unittest
import unittest.mock
import warnings

import package

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
from gymnasium.error import Error

import racebeam
from racebeam import InvalidInput, envpool

PATIENCE = 60  # seconds until something counts as hanging
INFO = {"env_id": "int32", "players": None, "lives": "int32", "reward": "float32", "terminated": "int32", "ram": "uint8",
        "elapsed_step": "int32"}


def make(env_type="gymnasium", **config):
    return envpool.make("Beamfall-v5", env_type, **{"num_envs": 3, **config})


class Gymnasium(unittest.TestCase):
    def test_shapes_and_types(self):
        envs = make()
        self.assertIsInstance(envs, gymnasium.vector.VectorEnv)
        seen, info = envs.reset()
        shown = envs.step(np.zeros(3, int))
        for one in (seen, shown[0]):
            self.assertEqual((one.dtype, one.shape), (np.uint8, (3, 4, 84, 84)))
        self.assertEqual([value.dtype for value in shown[1:4]], [np.float32, bool, bool])
        for told in (info, shown[4]):
            self.assertEqual({key: None if key == "players" else str(value.dtype) for key, value in told.items()}, INFO)
            self.assertEqual(told["ram"].shape, (3, 128))
        self.assertEqual((envs.observation_space.shape, envs.action_space.n), ((4, 84, 84), 18))
        self.assertEqual((len(envs), envs.is_async, envs.all_env_ids.tolist()), (3, False, [0, 1, 2]))
        self.assertEqual(envs.render([0, 2]).shape, (2, 210, 160, 3))

    def test_colours_are_channels(self):
        grey, coloured = make(), make(gray_scale=False)
        seen = coloured.reset()[0]
        self.assertEqual((seen.shape, coloured.observation_space.shape), ((3, 12, 84, 84), (12, 84, 84)))
        self.assertTrue(np.array_equal(seen[:, :3], seen[:, 9:]))
        whole = racebeam.AtariVectorEnv("beamfall", 3, grayscale=False, start="noops-fire", stack_start="repeats")
        expected = whole.reset(seed=42)[0]
        self.assertTrue(all(np.array_equal(seen[:, 3 * frame + colour], expected[:, frame, :, :, colour])
                            for frame in range(4) for colour in range(3)))
        self.assertEqual(grey.reset()[0].shape, (3, 4, 84, 84))

    def test_the_first_step_is_the_reset(self):
        envs, others = make(), make()
        seen, *_, info = envs.step(np.full(3, 5))
        self.assertTrue(np.array_equal(seen, others.reset()[0]))
        self.assertEqual(info["elapsed_step"].tolist(), [0, 0, 0])

    def test_seeds(self):
        first = [make(seed=seed).reset()[0] for seed in (42, 7, [42, 43, 44])] + [make(env_seed=[7, 8, 9]).reset()[0], make().reset()[0]]
        self.assertTrue(np.array_equal(first[0], first[2]) and np.array_equal(first[0], first[4]) and np.array_equal(first[1], first[3]))
        self.assertFalse(np.array_equal(first[0], first[1]))
        with self.assertWarns(UserWarning):
            make().reset(seed=3)

    def test_a_limit_and_the_steps_so_far(self):
        envs = make(max_episode_steps=5)
        envs.reset()
        shown = [envs.step(np.zeros(3, int)) for _ in range(8)]
        self.assertEqual([int(one[4]["elapsed_step"][0]) for one in shown], [1, 2, 3, 4, 5, 0, 1, 2])
        self.assertEqual([bool(one[3][0]) for one in shown], [False] * 4 + [True] + [False] * 3)
        self.assertFalse(any(one[2].any() for one in shown))

    def test_a_lost_life_ends_the_episode_and_not_the_game(self):
        envs = make(episodic_life=True, frame_skip=60, reward_clip=True)
        envs.reset()
        shown = [envs.step(np.ones(3, int)) for _ in range(80)]
        done = np.array([one[2] for one in shown])
        over = np.array([one[4]["terminated"] for one in shown])
        steps = np.array([one[4]["elapsed_step"] for one in shown])
        self.assertGreater(done.sum(), over.sum())
        self.assertGreater(over.sum(), 0)
        for env in range(3):
            for step in np.flatnonzero(done[:-1, env]):
                self.assertEqual(steps[step + 1, env], 0 if over[step, env] else steps[step, env])
        raw = np.array([one[4]["reward"] for one in shown])
        self.assertTrue(np.array_equal(np.clip(raw, -1, 1), [one[1] for one in shown]))
        self.assertGreater(raw.max(), 1)

    def test_a_reset_of_some(self):
        envs = make()
        envs.reset()
        envs.step(np.zeros(3, int))
        for arguments in ({"env_id": np.array([2])}, {"options": {"reset_mask": np.array([False, False, True])}}):
            seen, info = envs.reset(**arguments)
            self.assertEqual((seen.shape[0], info["env_id"].tolist(), info["elapsed_step"].tolist()), (1, [2], [0]))
        self.assertEqual(envs.step(np.zeros(3, int))[4]["elapsed_step"].tolist(), [2, 2, 1])

    def test_some_at_a_time(self):
        envs = make(num_envs=4, batch_size=2)
        self.assertTrue(envs.is_async)
        envs.async_reset()
        counted, until = {}, time.monotonic() + PATIENCE
        # All have their turn, at the latest when the thread that plays one has its own: a busy machine may hold it up.
        while min([counted.get(env, -1) for env in range(4)]) < 5 and time.monotonic() < until:
            seen, *_, info = envs.recv()
            self.assertEqual(seen.shape, (2, 4, 84, 84))
            for env, steps in zip(info["env_id"].tolist(), info["elapsed_step"].tolist()):
                self.assertEqual(steps, counted.get(env, -1) + 1)
                counted[env] = steps
            envs.send(np.zeros(2, np.int32), info["env_id"][::-1].copy())
        self.assertEqual(len(counted), 4)
        self.assertGreaterEqual(min(counted.values()), 5)

    def test_actions_follow_their_environments(self):
        envs, others = make(), make()
        for one in (envs, others):
            one.reset()
        for _ in range(10):
            seen = envs.step(np.array([1, 3, 4]))[0]
            expected = others.step({"action": np.array([4, 1, 3], np.int32), "env_id": np.array([2, 0, 1], np.int32)})[0]
            self.assertTrue(np.array_equal(seen, expected))


class Others(unittest.TestCase):
    def test_gym_has_its_old_interface(self):
        envs = make("gym", max_episode_steps=2)
        self.assertEqual(envs.reset().shape, (3, 4, 84, 84))
        for is_done in (False, True):
            seen, reward, done, info = envs.step(np.zeros(3, int))
            self.assertEqual((done.tolist(), info["TimeLimit.truncated"].tolist()), ([is_done] * 3, [is_done] * 3))
        self.assertEqual(len(make("gym", gym_reset_return_info=True).reset()), 2)

    def test_spaces_are_those_of_gym_where_that_is_imported(self):
        self.assertIsInstance(make("gym").action_space, gymnasium.spaces.Discrete)
        box = unittest.mock.Mock(side_effect=lambda low, high, shape, dtype: ("box", low, high, shape, np.dtype(dtype)))
        theirs = types.SimpleNamespace(spaces=types.SimpleNamespace(Box=box, Discrete=lambda count: ("discrete", int(count))))
        with unittest.mock.patch.dict(sys.modules, gym=theirs):
            envs = make("gym")
            self.assertEqual(envs.observation_space, ("box", 0, 255, (4, 84, 84), np.uint8))
            self.assertEqual((envs.action_space, envs.single_action_space), (("discrete", 18),) * 2)
            self.assertIsInstance(make().action_space, gymnasium.spaces.Discrete)

    def test_time_steps_of_dm(self):
        envs = make("dm", max_episode_steps=2)
        shown = [envs.reset(), *(envs.step(np.zeros(3, int)) for _ in range(3))]
        self.assertEqual([one.step_type.tolist() for one in shown], [[0] * 3, [1] * 3, [2] * 3, [0] * 3])
        self.assertEqual([one.discount.tolist() for one in shown], [[1] * 3, [1] * 3, [0] * 3, [1] * 3])
        self.assertEqual(shown[0].observation.obs.shape, (3, 4, 84, 84))
        self.assertEqual([[one.first().tolist(), one.mid().tolist(), one.last().tolist()] for one in shown[:3]],
                         [[[part == kind] * 3 for part in range(3)] for kind in range(3)])
        self.assertEqual(shown[0].observation._fields, ("env_id", "players", "obs", "lives", "reward", "terminated", "ram"))

    def test_actions_of_other_types(self):
        envs = make("dm")
        envs.reset()
        ids = np.arange(3, dtype=np.int32)
        envs.step(np.ones(3))
        envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int32)})
        with self.assertRaisesRegex(RuntimeError, "action of the action has the type int64; it must be int32"):
            envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int64)})
        with self.assertRaises(TypeError):
            envs.step(np.full(3, 0.5))

    def test_an_environment_is_one_of_gymnasium(self):
        for kind in (gymnasium.Env, gymnasium.vector.VectorEnv):
            self.assertIsInstance(make("gymnasium"), kind)

    def test_tasks(self):
        tasks = envpool.list_all_envs()
        self.assertTrue({"Pong-v5", "SpaceInvaders-v5", "Beamfall-v5"} <= set(tasks) and "Combat-v5" not in tasks)

    def test_bad_input(self):
        for task, env_type, config in (("Pong-v4", "gym", {}), ("Combat-v5", "dm", {}), ("Beamfall-v5", "x", {}), ("Beamfall-v5", "gym", {"noops": 3}),
                                       ("Beamfall-v5", "gym", {"max_num_players": 2}), ("Beamfall-v5", "gym", {"use_inter_area_resize": False})):
            with self.subTest(task=task, env_type=env_type, **config), self.assertRaises(InvalidInput):
                envpool.make(task, env_type=env_type, **config)
        envs = make()
        envs.reset()
        with self.assertRaises(IndexError):
            envs.step(np.full(3, 99))
        with self.assertRaisesRegex(InvalidInput, "env_id"):
            envs.step(np.zeros(1, int), env_id=np.array([1]))
        with self.assertRaises(NotImplementedError):
            envs.xla()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertRaises(UserWarning, envs.seed, 3)
        envs.close()
        with self.assertRaises(gymnasium.error.ClosedEnvironmentError):
            envs.step(np.zeros(3, int))


class Rendering(unittest.TestCase):
    def test_what_envpool_takes_for_it(self):
        for arguments in ({"render_mode": "rgb_array"}, {"render_mode": None}, {"from_pixels": False}, {"render_camera_id": -1}):
            envs = make("gymnasium", **arguments)
            self.assertNotIn(*arguments, envs.config)
            self.assertEqual(envs.render().shape, (1, 210, 160, 3))
        for arguments in ({"render_mode": "human"}, {"from_pixels": True}, {"render_width": 100}, {"render_height": 3}, {"render_camera_id": 4}):
            with self.subTest(**arguments), self.assertRaisesRegex(racebeam.InvalidInput, "racebeam has"):
                make("gymnasium", **arguments)

    def test_the_environment_that_is_shown(self):
        first, second = (make("gymnasium", num_envs=2, env_seed=[1, 9], render_env_id=env) for env in (0, 1))
        for envs in (first, second):
            envs.reset()
            for _ in range(20):
                envs.step(np.array([3, 4]))
        self.assertTrue(np.array_equal(second.render(), first.render(1)))
        self.assertFalse(np.array_equal(second.render(), first.render()))
        for env in (2, -1, "x", None):
            with self.subTest(env=env), self.assertRaisesRegex(Error, "render_env_id"):
                make("gymnasium", num_envs=2, render_env_id=env)

    def test_a_reset_without_infos_is_of_gym_alone(self):
        for env_type in ("gymnasium", "dm"):
            with self.assertRaisesRegex(ValueError, "gym_reset_return_info is False"):
                make(env_type, gym_reset_return_info=False)
        self.assertEqual(make("gym", gym_reset_return_info=False).reset().ndim, 4)

    def test_rewards_and_discounts_of_dm(self):
        try:
            from dm_env import specs
        except ImportError:
            self.skipTest("there is no dm_env")
        envs = make("dm")
        self.assertEqual(envs.reward_spec(), specs.Array((), float, "reward"))
        self.assertEqual(envs.discount_spec(), specs.BoundedArray((), float, 0.0, 1.0, "discount"))


class Found(unittest.TestCase):
    """By fuzz.py."""

    def test_counts_that_are_none(self):
        for config in ({"num_envs": np.ones(210, np.uint8)}, {"num_envs": 0}, {"max_episode_steps": "2"}, {"frame_skip": [4]}):
            with self.subTest(**config), self.assertRaises(gymnasium.error.Error):
                make(**config)

    def test_arrays_for_single_values(self):
        many = np.ones(3)
        for config in ({"episodic_life": many}, {"mode": many}, {"max_num_players": many}, {"use_inter_area_resize": many}):
            with self.subTest(**config), self.assertRaises((gymnasium.error.Error, InvalidInput)):
                make(**config)
        envs = make()
        envs.async_reset()
        self.assertRaisesRegex(gymnasium.error.Error, "reset is .* takes True or False", envs.recv, many)

    def test_pictures_of_no_environment(self):
        envs = make()
        envs.reset()
        self.assertRaises(InvalidInput, envs.render, np.zeros(0, np.int32))
        self.assertRaises(IndexError, envs.render, [99])

    def test_numbers_of_environments_that_are_none(self):
        envs = make()
        envs.reset()
        for env_id in ([[0], [0, 1, 2]], [99], [-1], [0.5], np.zeros((1, 3), int), "0"):
            with self.subTest(env_id=env_id):
                self.assertRaisesRegex(InvalidInput, "env_id is .* takes whole numbers from 0 to 2", envs.reset, env_id)
                self.assertRaisesRegex(InvalidInput, "env_id is .* takes whole numbers from 0 to 2", envs.step, np.zeros(3, int), env_id)
        self.assertRaisesRegex(InvalidInput, "options is .* takes a dictionary", envs.reset, options=np.ones(3))
        envs.step(np.zeros(3, int), env_id=np.array([2, 0, 1]))

    def test_an_action_without_its_part(self):
        envs = make()
        envs.reset()
        with self.assertRaisesRegex(InvalidInput, "one must be 'action'"):
            envs.step({"env_id": np.arange(3, dtype=np.int32)})


class Spec(unittest.TestCase):
    """What make_spec() of EnvPool 1.2.5 shows of Pong-v5, but for the number of actions."""

    def test_spaces_and_settings(self):
        for config, shape, actions in (({"num_envs": 4}, (4, 84, 84), 18), ({"gray_scale": False, "img_width": 50}, (12, 84, 50), 18)):
            spec = envpool.make_spec("Beamfall-v5", **config)
            self.assertEqual((spec.observation_space.shape, spec.gymnasium_observation_space.dtype), (shape, np.uint8))
            self.assertEqual((spec.action_space.n, spec.gymnasium_action_space.n, spec.reward_threshold), (actions, actions, None))
            self.assertEqual((spec.config.num_envs, spec.config.batch_size), (config.get("num_envs", 1),) * 2)
            self.assertEqual((spec.config.seed, spec.config.max_episode_steps, spec.config.task), (42, 27000, "Beamfall-v5"))
            self.assertTrue(repr(spec).startswith(f"AtariEnvSpec(num_envs={spec.config.num_envs}, "))
            envs = make(**config)
            self.assertEqual((envs.observation_space, envs.action_space), (spec.observation_space, spec.action_space))
            self.assertIn("Beamfall-v5", str(envs))  # Gymnasium takes it from the spec
            self.assertEqual(envs.spec.config._replace(num_envs=1, batch_size=1), spec.config._replace(num_envs=1, batch_size=1))

    def test_arrays(self):
        spec = envpool.make_spec("Beamfall-v5")
        self.assertEqual({name: (array.shape, np.dtype(array.dtype).name, array.minimum, array.maximum) for name, array in spec.state_array_spec.items()}, {
            "info:env_id": ([], "int32", -2**31, 2**31 - 1), "info:players.env_id": ([-1], "int32", -2**31, 2**31 - 1),
            "elapsed_step": ([], "int32", -2**31, 2**31 - 1), "done": ([], "bool", False, True),
            "reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max), "discount": ([-1], "float32", 0, 1),
            "step_type": ([], "int32", -2**31, 2**31 - 1), "trunc": ([], "bool", False, True), "obs": ([4, 84, 84], "uint8", 0, 255),
            "info:lives": ([-1], "int32", -2**31, 2**31 - 1),
            "info:reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max),
            "info:terminated": ([-1], "int32", 0, 1), "info:ram": ([128], "uint8", 0, 255)})
        self.assertEqual(spec.action_array_spec["action"], (np.int32, [-1], 0, 17))

    def test_what_is_made_fits(self):
        envs = make("dm")
        shown = envs.reset()
        names = {name.removeprefix("info:"): array for name, array in envs.spec.state_array_spec.items()}
        for name, array in names.items():
            value = {"players.env_id": shown.observation.players.env_id, "step_type": shown.step_type, "discount": shown.discount}.get(
                name, getattr(shown.observation, name, None))
            if value is not None:
                self.assertEqual((value.dtype, value.shape[1:]), (array.dtype, tuple(length for length in array.shape if length != -1)), name)

    @unittest.skipUnless(package._is_there("dm_env"), "there is no dm_env")
    def test_specs_of_dm_env(self):
        from dm_env import specs

        envs = make("dm")
        self.assertEqual(envs.action_spec(), specs.DiscreteArray(18, np.int32, "action"))
        seen = envs.observation_spec()
        shown = envs.reset().observation
        for name in ("obs", "lives", "reward", "terminated", "ram"):
            getattr(seen, name).validate(getattr(shown, name)[0])
        seen.players.env_id.validate(shown.players.env_id[0])
        self.assertIsInstance(seen.terminated, specs.DiscreteArray)

    def test_bad_input_is_refused(self):
        self.assertRaises(racebeam.UnknownGame, envpool.make_spec, "Nope-v5")
        self.assertRaises(InvalidInput, envpool.make_spec, "Beamfall-v5", foo=1)
        self.assertRaises(InvalidInput, envpool.make_spec, "Beamfall-v5", max_num_players=2)


if __name__ == "__main__":
    package.main()
