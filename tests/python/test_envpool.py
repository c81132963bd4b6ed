"""racebeam.envpool has EnvPool's arguments, results and infos. What EnvPool itself shows was measured (EnvPool
1.2.5)."""

import copy
import pickle
import subprocess
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
import racebeam
from gymnasium.error import Error
from racebeam import InvalidInput, envpool

PATIENCE = 60  # seconds until something counts as hanging
HAS_VECTORS = hasattr(gymnasium.vector, "AutoresetMode")
INFO = {
    "env_id": "int32",
    "players": None,
    "lives": "int32",
    "reward": "float32",
    "terminated": "int32",
    "ram": "uint8",
    "elapsed_step": "int32",
}


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

    @unittest.skipUnless(HAS_VECTORS, "AtariVectorEnv needs Gymnasium 1.1")
    def test_colours_are_channels(self):
        grey, coloured = make(), make(gray_scale=False)
        seen = coloured.reset()[0]
        self.assertEqual((seen.shape, coloured.observation_space.shape), ((3, 12, 84, 84), (12, 84, 84)))
        self.assertTrue(np.array_equal(seen[:, :3], seen[:, 9:]))
        whole = racebeam.AtariVectorEnv("beamfall", 3, grayscale=False, start="noops-fire", stack_start="repeats")
        expected = whole.reset(seed=42)[0]
        self.assertTrue(
            all(
                np.array_equal(seen[:, 3 * frame + colour], expected[:, frame, :, :, colour])
                for frame in range(4)
                for colour in range(3)
            )
        )
        self.assertEqual(grey.reset()[0].shape, (3, 4, 84, 84))

    def test_the_first_step_is_the_reset(self):
        envs, others = make(), make()
        seen, *_, info = envs.step(np.full(3, 5))
        self.assertTrue(np.array_equal(seen, others.reset()[0]))
        self.assertEqual(info["elapsed_step"].tolist(), [0, 0, 0])

    def test_seeds(self):
        first = [make(seed=seed).reset()[0] for seed in (42, 7, [42, 43, 44])] + [
            make(env_seed=[7, 8, 9]).reset()[0],
            make().reset()[0],
        ]
        self.assertTrue(
            np.array_equal(first[0], first[2])
            and np.array_equal(first[0], first[4])
            and np.array_equal(first[1], first[3])
        )
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

    def test_a_reset_drops_what_was_not_received(self):
        ends = {
            "reset": lambda envs: envs.reset(),
            "mask": lambda envs: envs.reset(options={"reset_mask": [True] * 4}),
            "async_reset": lambda envs: (envs.async_reset(), envs.recv())[1],
        }
        for config in ({}, {"batch_size": 2}):
            for name, end in ends.items():
                with self.subTest(name=name, **config):
                    envs = make(num_envs=4, **config)
                    for _ in range(3):
                        *_, info = end(envs)
                        self.assertEqual(info["elapsed_step"].tolist(), [0] * envs.batch_size)
                        envs.send(np.zeros(envs.batch_size, np.int32))
                    self.assertIn(max(envs.recv()[-1]["elapsed_step"].tolist()), (0, 1) if config else (1,))

    def test_the_arrays_are_the_callers_own(self):
        envs, others = make(num_envs=4, batch_size=2, num_threads=1), make(num_envs=4, batch_size=2, num_threads=1)
        for one in (envs, others):
            _, info = one.reset()
            self.assertFalse(np.shares_memory(info["env_id"], info["players"]["env_id"]))
            if one is envs:
                info["env_id"][:] = 3
            one.send(np.zeros(2, np.int32))
            self.assertEqual(sorted([*one.recv()[4]["env_id"], *one.recv()[4]["env_id"]]), [0, 1, 2, 3])

    def test_options_of_a_reset(self):
        envs = make()
        envs.reset()
        for mask in ([True, False, True], np.array([1, 0, 2]), np.array([True, False, True])):
            self.assertEqual(envs.reset(options={"reset_mask": mask})[1]["env_id"].tolist(), [0, 2])
        self.assertEqual(envs.reset(options={"reset_mask": None})[1]["env_id"].tolist(), [0, 1, 2])
        for options, env_id, sentence in (
            ({"reset_mask": np.zeros(3, bool)}, None, "one environment or more"),
            ({"reset_mask": [True]}, None, "takes 3 values"),
            ({"reset_mask": "abc"}, None, "takes 3 values"),
            ({"foo": 1}, None, "options has 'foo'; it takes only reset_mask"),
            ({"reset_mask": [True] * 3}, np.array([1]), "env_id and reset_mask are given"),
        ):
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, sentence):
                envs.reset(env_id, options=options)

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
            expected, *_, info = others.step(
                {"action": np.array([4, 1, 3], np.int32), "env_id": np.array([2, 0, 1], np.int32)}
            )
            self.assertEqual(info["env_id"].tolist(), [2, 0, 1])  # results are in this order, too
            self.assertTrue(np.array_equal(seen[[2, 0, 1]], expected))

    def test_a_step_of_some(self):
        envs, others = make(episodic_life=True, frame_skip=60), make(episodic_life=True, frame_skip=60)
        for _step in range(30):
            seen, *whole, info = envs.step(np.array([1, 3, 4]))
            for ids in ([1], [2, 0]):
                part, *rest, told = others.step(
                    np.array([[1, 3, 4][env] for env in ids], np.int32), np.array(ids, np.int32)
                )
                self.assertTrue(np.array_equal(part, seen[ids]))
                self.assertEqual([one.tolist() for one in rest], [one[ids].tolist() for one in whole])
                self.assertEqual((told["env_id"].tolist(), told["players"]["env_id"].tolist()), (ids, ids))
                for key in set(INFO) - {"env_id", "players"}:
                    self.assertTrue(np.array_equal(told[key], info[key][ids]), key)
        others.send(np.zeros(2, np.int32), np.array([2, 1]))
        others.send(np.zeros(1, np.int32), np.array([0]))
        self.assertEqual(others.recv()[4]["env_id"].tolist(), [2, 1, 0])
        self.assertEqual(others.recv()[4]["env_id"].tolist(), [])  # none was sent

    def test_the_first_step_of_each_is_its_reset(self):
        envs, others = make(), make()
        seen = others.reset()[0]
        self.assertTrue(np.array_equal(envs.reset(np.array([1]))[0], seen[[1]]))
        shown, *_, info = envs.step(np.ones(3, np.int32))
        self.assertEqual(info["elapsed_step"].tolist(), [0, 1, 0])
        self.assertTrue(np.array_equal(shown[[0, 2]], seen[[0, 2]]))

    def test_a_reset_after_a_lost_life_is_a_new_game(self):
        envs = make(episodic_life=True, frame_skip=60, num_envs=1)
        _, info = envs.reset()
        lives = info["lives"][0]
        for _ in range(100):
            *_, terminated, _, info = envs.step(np.ones(1, np.int32))
            if terminated[0]:
                break
        self.assertEqual((info["lives"][0], info["terminated"][0]), (lives - 1, 0))
        _, info = envs.reset()
        self.assertEqual((info["lives"][0], info["elapsed_step"][0]), (lives, 0))

    def test_negative_seeds(self):
        seen = [make(seed=seed).reset()[0] for seed in (-1, [-1, 0, 1], [2**31 - 1, 0, 1])]
        self.assertTrue(np.array_equal(seen[0], seen[1]))
        self.assertTrue(np.array_equal(seen[1][1:], seen[2][1:]))


class OldGymnasium(unittest.TestCase):
    """Gymnasium 0.29.1, which CleanRL pins, has no AutoresetMode."""

    def test_without_AutoresetMode_envpool_plays_and_AtariVectorEnv_says_what_it_needs(self):
        script = (
            "import gymnasium.vector as v; vars(v).pop('AutoresetMode', None)\n"
            "import racebeam, racebeam.envpool as envpool\n"
            "for kind in ('gymnasium', 'gym', 'dm'):\n"
            "    envs = envpool.make('Beamfall-v5', env_type=kind, num_envs=2); envs.reset(); envs.step([0, 1]); "
            "envs.close(); envs.close()\n"
            "try: racebeam.AtariVectorEnv('beamfall', 2)\n"
            "except ImportError as error: print(error)"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        self.assertRegex(
            done.stdout,
            "AtariVectorEnv needs Gymnasium 1.1 or later, and this is .*; install it with: pip install",
            done.stderr,
        )


class Others(unittest.TestCase):
    def test_gym_has_its_old_interface(self):
        envs = make("gym", max_episode_steps=2)
        self.assertEqual(envs.reset().shape, (3, 4, 84, 84))
        for is_done in (False, True):
            seen, reward, done, info = envs.step(np.zeros(3, int))
            self.assertEqual((done.tolist(), info["TimeLimit.truncated"].tolist()), ([is_done] * 3, [is_done] * 3))
        self.assertEqual(len(make("gym", gym_reset_return_info=True).reset()), 2)
        self.assertEqual(len(envpool.make_gym("Beamfall-v5").reset()), 2)

    def test_spaces_are_those_of_gym_where_that_is_imported(self):
        self.assertIsInstance(make("gym").action_space, gymnasium.spaces.Discrete)
        box = unittest.mock.Mock(side_effect=lambda low, high, shape, dtype: ("box", low, high, shape, np.dtype(dtype)))
        theirs = types.SimpleNamespace(
            spaces=types.SimpleNamespace(Box=box, Discrete=lambda count: ("discrete", int(count)))
        )
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
        self.assertEqual(
            [[one.first().tolist(), one.mid().tolist(), one.last().tolist()] for one in shown[:3]],
            [[[part == kind] * 3 for part in range(3)] for kind in range(3)],
        )
        self.assertEqual(
            shown[0].observation._fields, ("env_id", "players", "obs", "lives", "reward", "terminated", "ram")
        )

    def test_actions_of_other_types(self):
        envs = make("dm")
        envs.reset()
        ids = np.arange(3, dtype=np.int32)
        envs.step(np.ones(3))
        envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int32)})
        with self.assertRaisesRegex(RuntimeError, "action of the action has the type int64; it must be int32"):
            envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int64)})
        envs.step({"action": np.ones(3, np.int32), "players": {"env_id": ids}, "env_id": ids, "more": np.ones(3)})
        for actions in (np.full(3, np.nan), [1e30] * 3, np.full(3, -1.5)):
            self.assertRaisesRegex(IndexError, "is out of range; there are 0 to 17", envs.step, actions)

    def test_a_fraction_of_an_action_is_cut_off(self):
        for cut, whole in (
            (np.full(3, 1.9), 1),
            ([True] * 3, 1),
            (np.full(3, -0.5), 0),
            (np.full(3, 3.0, np.float32), 3),
        ):
            shown = [
                [envs.step(action)[4]["ram"] for _ in range(9)]
                for envs, action in ((make(), cut), (make(), np.full(3, whole)))
            ]
            self.assertTrue(np.array_equal(*shown))

    def test_they_are_closed_at_the_end_of_a_block(self):
        for env_type in ("gymnasium", "gym", "dm"):
            with make(env_type) as envs:
                envs.reset()
            self.assertRaises(gymnasium.error.ClosedEnvironmentError, envs.reset)

    def test_what_wrappers_ask(self):
        for env_type in ("gymnasium", "gym"):
            envs = make(env_type, render_mode="rgb_array")
            self.assertIs(envs.unwrapped, envs)
            self.assertEqual(
                (envs.is_vector_env, envs.render_mode, envs.metadata["render_modes"]),
                (True, "rgb_array", ["rgb_array"]),
            )
        self.assertEqual(envs.reward_range, (-float("inf"), float("inf")))

    def test_the_spec_says_what_a_reset_returns(self):
        self.assertIs(envpool.make_spec("Beamfall-v5").config.gym_reset_return_info, True)
        for env_type, config, returns in (
            ("gymnasium", {}, True),
            ("dm", {}, True),
            ("gym", {}, False),
            ("gym", {"gym_reset_return_info": True}, True),
        ):
            self.assertIs(make(env_type, **config).spec.config.gym_reset_return_info, returns)

    def test_an_environment_is_one_of_gymnasium(self):
        for kind in (gymnasium.Env, gymnasium.vector.VectorEnv):
            self.assertIsInstance(make("gymnasium"), kind)

    def test_tasks(self):
        tasks = envpool.list_all_envs()
        self.assertTrue(
            {"Pong-v5", "SpaceInvaders-v5", "TicTacToe3d-v5", "Beamfall-v5"} <= set(tasks) and "Combat-v5" not in tasks
        )

    def test_bad_input(self):
        for task, env_type, config in (
            ("Pong-v4", "gym", {}),
            ("Combat-v5", "dm", {}),
            ("Beamfall-v5", "x", {}),
            ("Beamfall-v5", "gym", {"noops": 3}),
            ("Beamfall-v5", "gym", {"max_num_players": 2}),
            ("Beamfall-v5", "gym", {"use_inter_area_resize": False}),
            ("Beamfall-v5", "dm", {"seed": 2**31}),
            ("Beamfall-v5", "gym", {"seed": [1]}),
            ("Beamfall-v5", "gym", {"env_seed": "xyz"}),
            ("Beamfall-v5", "dm", {"batch_size": 4}),
            ("Beamfall-v5", "gym", {"mode": "x"}),
            (3, "gym", {}),
        ):
            with self.subTest(task=task, env_type=env_type, **config), self.assertRaises(InvalidInput) as raised:
                envpool.make(task, env_type=env_type, **{"num_envs": 3, **config})
            for theirs in (AssertionError, TypeError, RuntimeError, ValueError):  # EnvPool raises one or the other
                self.assertIsInstance(raised.exception, theirs)
        self.assertRaises(RuntimeError, make, mode=99)
        envs = make()
        envs.reset()
        with self.assertRaises(IndexError):
            envs.step(np.full(3, 99))
        with self.assertRaisesRegex(InvalidInput, r"actions have the shape \(2,\); they must have \(1,\)"):
            envs.step(np.zeros(2, int), env_id=np.array([1]))
        with self.assertRaisesRegex(InvalidInput, "each environment is named once"):
            envs.step(np.zeros(2, int), env_id=np.array([1, 1]))
        envs.send(np.zeros(1, int), np.array([1]))
        with self.assertRaisesRegex(InvalidInput, "machine 1 plays already; receive it first"):
            envs.send(np.zeros(1, int), np.array([1]))
        with self.assertRaisesRegex(InvalidInput, "1 machines play; receive them first"):
            envs.step(np.zeros(3, int))
        self.assertEqual(envs.recv()[0].shape[0], 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertRaises(UserWarning, envs.seed, 3)
        envs.close()
        with self.assertRaises(gymnasium.error.ClosedEnvironmentError):
            envs.step(np.zeros(3, int))


class Modules(unittest.TestCase):
    """What programs import from EnvPool."""

    def test_in_the_place_of_envpool(self):
        script = (
            "import sys, racebeam.envpool\n"
            "sys.modules['envpool'] = racebeam.envpool\n"
            "import envpool, envpool.registration, envpool.atari.registration\n"
            "from envpool.atari import AtariDMEnvPool, AtariEnvSpec, AtariGymnasiumEnvPool\n"
            "from envpool.python import protocol\n"
            "for name in ('EnvSpec', 'EnvPool', 'DMEnvPool', 'GymnasiumEnvPool'):\n"
            "    assert getattr(protocol, name) is getattr(envpool, name) and name in envpool.__all__\n"
            "assert envpool.registration.make is envpool.make and AtariEnvSpec is envpool.EnvSpec\n"
            "assert len(envpool.atari.registration.atari_game_list) == 104 and envpool.__version__\n"
            "envs = AtariGymnasiumEnvPool(AtariEnvSpec(AtariEnvSpec.gen_config(task='beamfall', num_envs=2)))\n"
            "print(envs.reset()[0].shape)"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, "(2, 4, 84, 84)\n"), done.stderr)

    def test_a_spec_of_settings(self):
        config = envpool.EnvSpec.gen_config(task="beamfall", num_envs=4, batch_size=5)
        self.assertEqual((config.batch_size, config.max_episode_steps), (5, 2**31 - 1))
        self.assertRaisesRegex(ValueError, "batch_size is 5; it takes 0 to 4", envpool.EnvSpec, config)
        self.assertRaisesRegex(TypeError, "there is no setting 'foo'", envpool.EnvSpec.gen_config, foo=3)
        self.assertRaisesRegex(InvalidInput, "there are 2 values; there must be 26", envpool.EnvSpec, (1, 2))
        for task in ("nope", ["x"], ""):
            self.assertRaisesRegex(
                racebeam.UnknownGame,
                "there is no task of a game",
                envpool.EnvSpec,
                envpool.EnvSpec.gen_config(task=task),
            )
        self.assertRaisesRegex(InvalidInput, "the spec is 3", envpool.GymnasiumEnvPool, 3)

    def test_the_raw_interface(self):
        from racebeam.envpool.atari.atari_envpool import _AtariEnvPool, _AtariEnvSpec

        config = {
            **dict(zip(_AtariEnvSpec._config_keys, _AtariEnvSpec._default_config_values)),
            "task": b"beamfall",
            "num_envs": 3,
        }
        raw, envs = _AtariEnvPool(_AtariEnvSpec(tuple(config.values()))), make("dm")
        raw._reset(np.arange(3, dtype=np.int32))
        time_step = envs.reset()
        for step in range(20):
            state = dict(zip(raw._state_keys, raw._recv()))
            for name, value in (
                ("obs", time_step.observation.obs),
                ("step_type", time_step.step_type),
                ("reward", time_step.reward),
                ("info:ram", time_step.observation.ram),
                ("discount", time_step.discount),
            ):
                self.assertTrue(np.array_equal(state[name], value), name)
            actions = np.array([step % 18, 1, 2])
            raw._send((state["info:env_id"], state["info:players.env_id"], actions))
            time_step = envs.step(actions)
        self.assertEqual(raw._state_keys, list(envs.spec.state_array_spec))
        self.assertRaisesRegex(InvalidInput, "the action has 1 arrays", raw._send, (actions,))

    def test_a_pool_is_not_copied(self):
        for copied in (pickle.dumps, copy.deepcopy):
            self.assertRaisesRegex(TypeError, "cannot be pickled or copied", copied, make())


@unittest.skipUnless(package._is_there("jax"), "there is no jax")
class Compiled(unittest.TestCase):
    """xla()."""

    def test_it_shows_what_the_environments_show(self):
        import jax

        for env_type in ("gymnasium", "gym", "dm"):
            for config in (
                {"episodic_life": True, "frame_skip": 60, "reward_clip": True},
                {"gray_scale": False, "img_height": 30, "max_episode_steps": 7},
                {"zero_discount_on_life_loss": True, "frame_skip": 60},
            ):
                with self.subTest(env_type=env_type, **config):
                    envs, others = make(env_type, **config), make(env_type, **config)
                    handle, recv, send, step = envs.xla()
                    envs.async_reset()
                    others.async_reset()
                    handle, shown = recv(handle)
                    self.same(shown, others.recv())
                    compiled = jax.jit(step)
                    for number in range(40):
                        actions = np.array([number % 18, 1, 3], np.int32)
                        handle, shown = compiled(handle, actions)
                        self.same(shown, others.step(actions))
                    ids = np.array([2, 0, 1], np.int32)
                    handle, shown = step(handle, {"action": actions, "env_id": ids})
                    self.same(shown, others.step(actions, ids))

    def same(self, compiled, shown):
        import jax

        ours, theirs = jax.tree.flatten(compiled), jax.tree.flatten(shown)
        self.assertEqual(ours[1], theirs[1])
        for one, other in zip(ours[0], theirs[0]):
            self.assertEqual((one.dtype, one.shape), (other.dtype, other.shape))
            self.assertTrue(np.array_equal(one, other))

    def test_a_loop_of_some_at_a_time(self):
        import jax

        envs = make(num_envs=6, batch_size=2)
        handle, recv, send, _ = envs.xla()
        envs.async_reset()

        def step(_, carried):
            handle, steps = carried
            handle, (*_, info) = recv(handle)
            return send(handle, jax.numpy.ones(2, np.int32), info["env_id"]), steps.at[info["env_id"]].add(1)

        _, steps = jax.jit(lambda: jax.lax.fori_loop(0, 30, step, (handle, jax.numpy.zeros(6, np.int32))))()
        self.assertEqual(int(steps.sum()), 60)
        self.assertEqual(envs.recv()[4]["env_id"].shape, (2,))
        with self.assertRaisesRegex(InvalidInput, "env_id is None"):
            send(handle, np.ones(2, np.int32))

    def test_bad_input(self):
        import jax

        envs = make()
        handle, recv, send, step = envs.xla()
        self.assertRaisesRegex(
            InvalidInput, r"actions have the shape \(2,\); they must have \(3,\)", send, handle, np.ones(2, np.int32)
        )
        self.assertRaises(TypeError, send, handle, np.ones(3))
        for function, arguments, words in (
            (recv, (), "0 machines play, and a receive takes 3"),
            (step, (np.full(3, 99),), "out of range"),
            (step, (np.ones(1, np.int32), np.array([7])), "there is no machine 7"),
        ):
            with self.assertRaisesRegex(jax.errors.JaxRuntimeError, words):
                jax.block_until_ready(function(handle, *arguments))
        envs.close()
        with self.assertRaisesRegex(jax.errors.JaxRuntimeError, "closed"):
            jax.block_until_ready(step(handle, np.ones(3, np.int32)))


class Rendering(unittest.TestCase):
    def test_what_envpool_takes_for_it(self):
        for arguments in (
            {"render_mode": "rgb_array"},
            {"render_mode": None},
            {"from_pixels": False},
            {"render_camera_id": -1},
        ):
            envs = make("gymnasium", **arguments)
            self.assertNotIn(*arguments, envs.config)
            self.assertEqual(envs.render().shape, (1, 210, 160, 3))
        for arguments in (
            {"render_mode": "human"},
            {"from_pixels": True},
            {"render_width": 100},
            {"render_height": 3},
            {"render_camera_id": 4},
        ):
            with self.subTest(**arguments), self.assertRaisesRegex(racebeam.InvalidInput, "racebeam has"):
                make("gymnasium", **arguments)

    @unittest.skipUnless(HAS_VECTORS, "Gymnasium has no AddRenderObservation")
    def test_the_metadata_has_the_mode_and_wrappers_use_it(self):
        self.assertIsNone(make().render_mode)
        envs = gymnasium.wrappers.AddRenderObservation(make(render_mode="rgb_array"))
        self.assertEqual((envs.reset()[0].shape, envs.observation_space.shape), ((1, 210, 160, 3),) * 2)
        self.assertEqual(envs.unwrapped.render(env_ids=2, camera_id=-1).shape, (1, 210, 160, 3))

    @unittest.skipUnless("air_raid" in package.roms(), "there is no image of air_raid")
    def test_the_upper_210_rows_of_higher_screens_are_seen(self):
        envs = envpool.make_gymnasium(
            "AirRaid-v5", gray_scale=False, stack_num=1, img_height=210, img_width=160, use_inter_area_resize=False
        )
        seen = envs.reset()[0]
        self.assertEqual(envs.render().shape, (1, 210, 160, 3))
        self.assertTrue(np.array_equal(seen[0].transpose(1, 2, 0), envs.render()[0]))
        self.assertEqual(racebeam.AtariVectorEnv("air_raid", 1, obs_type="rgb").reset()[0].shape, (1, 4, 250, 160, 3))

    def test_render_returns_the_chosen_environment(self):
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
        for config in (
            {"num_envs": np.ones(210, np.uint8)},
            {"num_envs": 0},
            {"max_episode_steps": "2"},
            {"frame_skip": [4]},
        ):
            with self.subTest(**config), self.assertRaises(gymnasium.error.Error):
                make(**config)

    def test_arrays_for_single_values(self):
        many = np.ones(3)
        for config in (
            {"episodic_life": many},
            {"mode": many},
            {"max_num_players": many},
            {"use_inter_area_resize": many},
        ):
            with self.subTest(**config), self.assertRaises(envpool.InvalidSetting):
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
                self.assertRaisesRegex(
                    InvalidInput, "env_id is .* takes whole numbers from 0 to 2", envs.step, np.zeros(3, int), env_id
                )
        self.assertRaisesRegex(InvalidInput, "options is .* takes a dictionary", envs.reset, options=np.ones(3))
        envs.step(np.zeros(3, int), env_id=np.array([2, 0, 1]))

    def test_an_action_without_its_part(self):
        envs = make()
        envs.reset()
        with self.assertRaisesRegex(InvalidInput, "one must be 'action'"):
            envs.step({"env_id": np.arange(3, dtype=np.int32)})


class Spec(unittest.TestCase):
    """What make_spec() of EnvPool 1.2.5 shows of Pong-v5, except the number of actions."""

    def test_spaces_and_settings(self):
        for config, shape, actions in (
            ({"num_envs": 4}, (4, 84, 84), 18),
            ({"gray_scale": False, "img_width": 50}, (12, 84, 50), 18),
        ):
            spec = envpool.make_spec("Beamfall-v5", **config)
            self.assertEqual((spec.observation_space.shape, spec.gymnasium_observation_space.dtype), (shape, np.uint8))
            self.assertEqual(
                (spec.action_space.n, spec.gymnasium_action_space.n, spec.reward_threshold), (actions, actions, None)
            )
            self.assertEqual((spec.config.num_envs, spec.config.batch_size), (config.get("num_envs", 1),) * 2)
            self.assertEqual(
                (spec.config.seed, spec.config.max_episode_steps, spec.config.task), (42, 27000, "beamfall")
            )
            self.assertTrue(repr(spec).startswith(f"AtariEnvSpec(num_envs={spec.config.num_envs}, "))
            envs = make(**config)
            self.assertEqual((envs.observation_space, envs.action_space), (spec.observation_space, spec.action_space))
            self.assertIn("Beamfall-v5", str(envs))  # Gymnasium takes it from the spec
            self.assertEqual(
                envs.spec.config._replace(num_envs=1, batch_size=1), spec.config._replace(num_envs=1, batch_size=1)
            )

    def test_arrays(self):
        spec = envpool.make_spec("Beamfall-v5")
        self.assertEqual(
            {
                name: (array.shape, np.dtype(array.dtype).name, array.minimum, array.maximum)
                for name, array in spec.state_array_spec.items()
            },
            {
                "info:env_id": ([], "int32", -(2**31), 2**31 - 1),
                "info:players.env_id": ([-1], "int32", -(2**31), 2**31 - 1),
                "elapsed_step": ([], "int32", -(2**31), 2**31 - 1),
                "done": ([], "bool", False, True),
                "reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max),
                "discount": ([-1], "float32", 0, 1),
                "step_type": ([], "int32", -(2**31), 2**31 - 1),
                "trunc": ([], "bool", False, True),
                "obs": ([4, 84, 84], "uint8", 0, 255),
                "info:lives": ([-1], "int32", -(2**31), 2**31 - 1),
                "info:reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max),
                "info:terminated": ([-1], "int32", 0, 1),
                "info:ram": ([128], "uint8", 0, 255),
            },
        )
        self.assertEqual(spec.action_array_spec["action"], (np.int32, [-1], 0, 17))

    def test_what_is_made_fits(self):
        envs = make("dm")
        shown = envs.reset()
        names = {name.removeprefix("info:"): array for name, array in envs.spec.state_array_spec.items()}
        for name, array in names.items():
            value = {
                "players.env_id": shown.observation.players.env_id,
                "step_type": shown.step_type,
                "discount": shown.discount,
            }.get(name, getattr(shown.observation, name, None))
            if value is not None:
                self.assertEqual(
                    (value.dtype, value.shape[1:]),
                    (array.dtype, tuple(length for length in array.shape if length != -1)),
                    name,
                )

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
