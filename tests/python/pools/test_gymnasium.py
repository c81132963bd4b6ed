"""racebeam.envpool with the interface of Gymnasium."""

import re
import subprocess
import sys
import time

import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
from pools import HAS_VECTORS, make

PATIENCE = 60  # seconds until something counts as hanging

INFO = {
    "env_id": "int32",
    "players": None,
    "lives": "int32",
    "reward": "float32",
    "terminated": "int32",
    "ram": "uint8",
    "elapsed_step": "int32",
}


class TestGymnasium:
    def test_shapes_and_types(self):
        envs = make()
        assert isinstance(envs, gymnasium.vector.VectorEnv)
        observations, info = envs.reset()
        result = envs.step(np.zeros(3, int))
        for one in (observations, result[0]):
            assert (one.dtype, one.shape) == (np.uint8, (3, 4, 84, 84))
        assert [value.dtype for value in result[1:4]] == [np.float32, bool, bool]
        for infos in (info, result[4]):
            assert {key: None if key == "players" else str(value.dtype) for key, value in infos.items()} == INFO
            assert infos["ram"].shape == (3, 128)
        assert (envs.observation_space.shape, envs.action_space.n) == ((4, 84, 84), 18)
        assert (len(envs), envs.is_async, envs.all_env_ids.tolist()) == (3, False, [0, 1, 2])
        assert envs.render([0, 2]).shape == (2, 210, 160, 3)

    @pytest.mark.skipif(not HAS_VECTORS, reason="AtariVectorEnv needs Gymnasium 1.1")
    def test_colours_are_channels(self):
        grey, coloured = make(), make(gray_scale=False)
        observations = coloured.reset()[0]
        assert (observations.shape, coloured.observation_space.shape) == ((3, 12, 84, 84), (12, 84, 84))
        assert np.array_equal(observations[:, :3], observations[:, 9:])
        whole = racebeam.AtariVectorEnv("beamfall", 3, grayscale=False, start="noops-fire", stack_start="repeats")
        expected = whole.reset(seed=42)[0]
        assert all(
            np.array_equal(observations[:, 3 * frame + colour], expected[:, frame, :, :, colour])
            for frame in range(4)
            for colour in range(3)
        )
        assert grey.reset()[0].shape == (3, 4, 84, 84)

    def test_the_first_step_is_the_reset(self):
        envs, others = make(), make()
        seen, *_, info = envs.step(np.full(3, 5))
        assert np.array_equal(seen, others.reset()[0])
        assert info["elapsed_step"].tolist() == [0, 0, 0]

    def test_seeds(self):
        first = [make(seed=seed).reset()[0] for seed in (42, 7, [42, 43, 44])] + [
            make(env_seed=[7, 8, 9]).reset()[0],
            make().reset()[0],
        ]
        assert (
            np.array_equal(first[0], first[2])
            and np.array_equal(first[0], first[4])
            and np.array_equal(first[1], first[3])
        )
        assert not np.array_equal(first[0], first[1])
        with pytest.warns(UserWarning):
            make().reset(seed=3)

    def test_the_limit_of_steps_and_elapsed_steps(self):
        envs = make(max_episode_steps=5)
        envs.reset()
        results = [envs.step(np.zeros(3, int)) for _ in range(8)]
        assert [int(one[4]["elapsed_step"][0]) for one in results] == [1, 2, 3, 4, 5, 0, 1, 2]
        assert [bool(one[3][0]) for one in results] == [False] * 4 + [True] + [False] * 3
        assert not any(one[2].any() for one in results)

    def test_a_lost_life_ends_the_episode_and_not_the_game(self):
        envs = make(episodic_life=True, frame_skip=60, reward_clip=True)
        envs.reset()
        results = [envs.step(np.ones(3, int)) for _ in range(80)]
        done = np.array([one[2] for one in results])
        over = np.array([one[4]["terminated"] for one in results])
        steps = np.array([one[4]["elapsed_step"] for one in results])
        assert done.sum() > over.sum()
        assert over.sum() > 0
        for env in range(3):
            for step in np.flatnonzero(done[:-1, env]):
                assert steps[step + 1, env] == (0 if over[step, env] else steps[step, env])
        raw = np.array([one[4]["reward"] for one in results])
        assert np.array_equal(np.clip(raw, -1, 1), [one[1] for one in results])
        assert raw.max() > 1

    def test_a_reset_of_some(self):
        envs = make()
        envs.reset()
        envs.step(np.zeros(3, int))
        for arguments in ({"env_id": np.array([2])}, {"options": {"reset_mask": np.array([False, False, True])}}):
            seen, info = envs.reset(**arguments)
            assert (seen.shape[0], info["env_id"].tolist(), info["elapsed_step"].tolist()) == (1, [2], [0])
        assert envs.step(np.zeros(3, int))[4]["elapsed_step"].tolist() == [2, 2, 1]

    def test_a_reset_drops_what_was_not_received(self, subtests):
        ends = {
            "reset": lambda envs: envs.reset(),
            "mask": lambda envs: envs.reset(options={"reset_mask": [True] * 4}),
            "async_reset": lambda envs: (envs.async_reset(), envs.recv())[1],
        }
        for config in ({}, {"batch_size": 2}):
            for name, end in ends.items():
                with subtests.test(name=name, **config):
                    envs = make(num_envs=4, **config)
                    for _ in range(3):
                        *_, info = end(envs)
                        assert info["elapsed_step"].tolist() == [0] * envs.batch_size
                        envs.send(np.zeros(envs.batch_size, np.int32))
                    assert max(envs.recv()[-1]["elapsed_step"].tolist()) in ((0, 1) if config else (1,))

    def test_the_arrays_belong_to_the_caller(self):
        envs, others = make(num_envs=4, batch_size=2, num_threads=1), make(num_envs=4, batch_size=2, num_threads=1)
        for one in (envs, others):
            _, info = one.reset()
            assert not np.shares_memory(info["env_id"], info["players"]["env_id"])
            if one is envs:
                info["env_id"][:] = 3
            one.send(np.zeros(2, np.int32))
            assert sorted([*one.recv()[4]["env_id"], *one.recv()[4]["env_id"]]) == [0, 1, 2, 3]

    def test_options_of_a_reset(self, subtests):
        envs = make()
        envs.reset()
        for mask in ([True, False, True], np.array([1, 0, 2]), np.array([True, False, True])):
            assert envs.reset(options={"reset_mask": mask})[1]["env_id"].tolist() == [0, 2]
        assert envs.reset(options={"reset_mask": None})[1]["env_id"].tolist() == [0, 1, 2]
        for options, env_id, sentence in (
            ({"reset_mask": np.zeros(3, bool)}, None, "one environment or more"),
            ({"reset_mask": [True]}, None, "takes 3 values"),
            ({"reset_mask": "abc"}, None, "takes 3 values"),
            ({"foo": 1}, None, "options has 'foo'; it takes only reset_mask"),
            ({"reset_mask": [True] * 3}, np.array([1]), "env_id and reset_mask are given"),
        ):
            with subtests.test(options=options), pytest.raises(ValueError, match=sentence):
                envs.reset(env_id, options=options)

    def test_some_at_a_time(self):
        envs = make(num_envs=4, batch_size=2)
        assert envs.is_async
        envs.async_reset()
        counted, until = {}, time.monotonic() + PATIENCE
        # All have their turn, at the latest when the thread that plays one has its own: a busy machine may hold it up.
        while min([counted.get(env, -1) for env in range(4)]) < 5 and time.monotonic() < until:
            seen, *_, info = envs.recv()
            assert seen.shape == (2, 4, 84, 84)
            for env, steps in zip(info["env_id"].tolist(), info["elapsed_step"].tolist()):
                assert steps == counted.get(env, -1) + 1
                counted[env] = steps
            envs.send(np.zeros(2, np.int32), info["env_id"][::-1].copy())
        assert len(counted) == 4
        assert min(counted.values()) >= 5

    def test_actions_follow_their_environments(self):
        envs, others = make(), make()
        for one in (envs, others):
            one.reset()
        for _ in range(10):
            observations = envs.step(np.array([1, 3, 4]))[0]
            expected, *_, info = others.step(
                {"action": np.array([4, 1, 3], np.int32), "env_id": np.array([2, 0, 1], np.int32)}
            )
            assert info["env_id"].tolist() == [2, 0, 1]  # results are in this order, too
            assert np.array_equal(observations[[2, 0, 1]], expected)

    def test_a_step_of_some(self):
        envs, others = make(episodic_life=True, frame_skip=60), make(episodic_life=True, frame_skip=60)
        for _step in range(30):
            seen, *whole, info = envs.step(np.array([1, 3, 4]))
            for ids in ([1], [2, 0]):
                part, *rest, infos = others.step(
                    np.array([[1, 3, 4][env] for env in ids], np.int32), np.array(ids, np.int32)
                )
                assert np.array_equal(part, seen[ids])
                assert [one.tolist() for one in rest] == [one[ids].tolist() for one in whole]
                assert (infos["env_id"].tolist(), infos["players"]["env_id"].tolist()) == (ids, ids)
                for key in set(INFO) - {"env_id", "players"}:
                    assert np.array_equal(infos[key], info[key][ids]), key
        others.send(np.zeros(2, np.int32), np.array([2, 1]))
        others.send(np.zeros(1, np.int32), np.array([0]))
        assert others.recv()[4]["env_id"].tolist() == [2, 1, 0]
        assert others.recv()[4]["env_id"].tolist() == []  # none was sent

    def test_the_first_step_of_each_is_its_reset(self):
        envs, others = make(), make()
        observations = others.reset()[0]
        assert np.array_equal(envs.reset(np.array([1]))[0], observations[[1]])
        shown, *_, info = envs.step(np.ones(3, np.int32))
        assert info["elapsed_step"].tolist() == [0, 1, 0]
        assert np.array_equal(shown[[0, 2]], observations[[0, 2]])

    def test_a_reset_after_a_lost_life_is_a_new_game(self):
        envs = make(episodic_life=True, frame_skip=60, num_envs=1)
        _, info = envs.reset()
        lives = info["lives"][0]
        for _ in range(100):
            *_, terminated, _, info = envs.step(np.ones(1, np.int32))
            if terminated[0]:
                break
        assert (info["lives"][0], info["terminated"][0]) == (lives - 1, 0)
        _, info = envs.reset()
        assert (info["lives"][0], info["elapsed_step"][0]) == (lives, 0)

    def test_negative_seeds(self):
        observations = [make(seed=seed).reset()[0] for seed in (-1, [-1, 0, 1], [2**31 - 1, 0, 1])]
        assert np.array_equal(observations[0], observations[1])
        assert np.array_equal(observations[1][1:], observations[2][1:])


class TestOldGymnasium:
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
        assert re.search(
            "AtariVectorEnv needs Gymnasium 1.1 or later, and this is .*; install it with: pip install", done.stdout
        ), done.stderr
