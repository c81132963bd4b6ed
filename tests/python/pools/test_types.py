"""racebeam.envpool with the interfaces of Gym and dm_env, and its bad input."""

import sys
import types
import unittest
import unittest.mock
import warnings

import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
from pools import make
from racebeam import InvalidInput, envpool


class TestOthers:
    def test_gym_has_its_old_interface(self):
        envs = make("gym", max_episode_steps=2)
        assert envs.reset().shape == (3, 4, 84, 84)
        for is_done in (False, True):
            seen, reward, done, info = envs.step(np.zeros(3, int))
            assert (done.tolist(), info["TimeLimit.truncated"].tolist()) == ([is_done] * 3, [is_done] * 3)
        assert len(make("gym", gym_reset_return_info=True).reset()) == 2
        assert len(envpool.make_gym("Beamfall-v5").reset()) == 2

    def test_spaces_are_those_of_gym_where_that_is_imported(self):
        assert isinstance(make("gym").action_space, gymnasium.spaces.Discrete)
        box = unittest.mock.Mock(side_effect=lambda low, high, shape, dtype: ("box", low, high, shape, np.dtype(dtype)))
        theirs = types.SimpleNamespace(
            spaces=types.SimpleNamespace(Box=box, Discrete=lambda count: ("discrete", int(count)))
        )
        with unittest.mock.patch.dict(sys.modules, gym=theirs):
            envs = make("gym")
            assert envs.observation_space == ("box", 0, 255, (4, 84, 84), np.uint8)
            assert (envs.action_space, envs.single_action_space) == (("discrete", 18),) * 2
            assert isinstance(make().action_space, gymnasium.spaces.Discrete)

    def test_time_steps_of_dm(self):
        envs = make("dm", max_episode_steps=2)
        results = [envs.reset(), *(envs.step(np.zeros(3, int)) for _ in range(3))]
        assert [one.step_type.tolist() for one in results] == [[0] * 3, [1] * 3, [2] * 3, [0] * 3]
        assert [one.discount.tolist() for one in results] == [[1] * 3, [1] * 3, [0] * 3, [1] * 3]
        assert results[0].observation.obs.shape == (3, 4, 84, 84)
        assert [[one.first().tolist(), one.mid().tolist(), one.last().tolist()] for one in results[:3]] == [
            [[part == kind] * 3 for part in range(3)] for kind in range(3)
        ]
        assert results[0].observation._fields == ("env_id", "players", "obs", "lives", "reward", "terminated", "ram")

    def test_actions_of_other_types(self):
        envs = make("dm")
        envs.reset()
        ids = np.arange(3, dtype=np.int32)
        envs.step(np.ones(3))
        envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int32)})
        with pytest.raises(RuntimeError, match="the part 'action' of the action has the type int64; it must be int32"):
            envs.step({"env_id": ids, "players.env_id": ids, "action": np.ones(3, np.int64)})
        envs.step({"action": np.ones(3, np.int32), "players": {"env_id": ids}, "env_id": ids, "more": np.ones(3)})
        for actions in (np.full(3, np.nan), [1e30] * 3, np.full(3, -1.5)):
            with pytest.raises(IndexError, match="is out of range; accepted: 0 to 17"):
                envs.step(actions)

    def test_a_fraction_of_an_action_is_cut_off(self):
        for cut, whole in (
            (np.full(3, 1.9), 1),
            ([True] * 3, 1),
            (np.full(3, -0.5), 0),
            (np.full(3, 3.0, np.float32), 3),
        ):
            results = [
                [envs.step(action)[4]["ram"] for _ in range(9)]
                for envs, action in ((make(), cut), (make(), np.full(3, whole)))
            ]
            assert np.array_equal(*results)

    def test_they_are_closed_at_the_end_of_a_block(self):
        for env_type in ("gymnasium", "gym", "dm"):
            with make(env_type) as envs:
                envs.reset()
            with pytest.raises(gymnasium.error.ClosedEnvironmentError):
                envs.reset()

    def test_the_methods_that_wrappers_call(self):
        for env_type in ("gymnasium", "gym"):
            envs = make(env_type, render_mode="rgb_array")
            assert envs.unwrapped is envs
            assert (envs.is_vector_env, envs.render_mode, envs.metadata["render_modes"]) == (
                True,
                "rgb_array",
                ["rgb_array"],
            )
        assert envs.reward_range == (-float("inf"), float("inf"))

    def test_the_spec_says_what_a_reset_returns(self):
        assert envpool.make_spec("Beamfall-v5").config.gym_reset_return_info is True
        for env_type, config, returns in (
            ("gymnasium", {}, True),
            ("dm", {}, True),
            ("gym", {}, False),
            ("gym", {"gym_reset_return_info": True}, True),
        ):
            assert make(env_type, **config).spec.config.gym_reset_return_info is returns

    def test_an_environment_is_one_of_gymnasium(self):
        for kind in (gymnasium.Env, gymnasium.vector.VectorEnv):
            assert isinstance(make("gymnasium"), kind)

    def test_tasks(self):
        tasks = envpool.list_all_envs()
        assert {"Pong-v5", "SpaceInvaders-v5", "TicTacToe3d-v5", "Beamfall-v5"} <= set(
            tasks
        ) and "Combat-v5" not in tasks

    def test_bad_input(self, subtests):
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
            with subtests.test(task=task, env_type=env_type, **config), pytest.raises(InvalidInput) as raised:
                envpool.make(task, env_type=env_type, **{"num_envs": 3, **config})
            for theirs in (AssertionError, TypeError, RuntimeError, ValueError):  # EnvPool raises one or the other
                assert isinstance(raised.value, theirs)
        with pytest.raises(RuntimeError):
            make(mode=99)
        envs = make()
        envs.reset()
        with pytest.raises(IndexError):
            envs.step(np.full(3, 99))
        with pytest.raises(InvalidInput, match=r"actions have the shape \(2,\); they must have \(1,\)"):
            envs.step(np.zeros(2, int), env_id=np.array([1]))
        with pytest.raises(InvalidInput, match="each index may occur once"):
            envs.step(np.zeros(2, int), env_id=np.array([1, 1]))
        envs.send(np.zeros(1, int), np.array([1]))
        with pytest.raises(InvalidInput, match="environment 1 plays already; receive it first"):
            envs.send(np.zeros(1, int), np.array([1]))
        with pytest.raises(InvalidInput, match="1 environments play; receive them first"):
            envs.step(np.zeros(3, int))
        assert envs.recv()[0].shape[0] == 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(UserWarning):
                envs.seed(3)
        envs.close()
        with pytest.raises(gymnasium.error.ClosedEnvironmentError):
            envs.step(np.zeros(3, int))


class TestFound:
    """Calls that fuzz.py found."""

    def test_invalid_counts(self, subtests):
        for config in (
            {"num_envs": np.ones(210, np.uint8)},
            {"num_envs": 0},
            {"max_episode_steps": "2"},
            {"frame_skip": [4]},
        ):
            with subtests.test(**config), pytest.raises(gymnasium.error.Error):
                make(**config)

    def test_arrays_for_single_values(self, subtests):
        many = np.ones(3)
        for config in (
            {"episodic_life": many},
            {"mode": many},
            {"max_num_players": many},
            {"use_inter_area_resize": many},
        ):
            with subtests.test(**config), pytest.raises(envpool.InvalidSetting):
                make(**config)
        envs = make()
        envs.async_reset()
        with pytest.raises(gymnasium.error.Error, match="reset is .* takes True or False"):
            envs.recv(many)

    def test_rendering_without_environments_is_refused(self):
        envs = make()
        envs.reset()
        with pytest.raises(InvalidInput):
            envs.render(np.zeros(0, np.int32))
        with pytest.raises(IndexError):
            envs.render([99])

    def test_invalid_numbers_of_environments(self, subtests):
        envs = make()
        envs.reset()
        for env_id in ([[0], [0, 1, 2]], [99], [-1], [0.5], np.zeros((1, 3), int), "0"):
            with subtests.test(env_id=env_id):
                with pytest.raises(InvalidInput, match="env_id is .* takes whole numbers from 0 to 2"):
                    envs.reset(env_id)
                with pytest.raises(InvalidInput, match="env_id is .* takes whole numbers from 0 to 2"):
                    envs.step(np.zeros(3, int), env_id)
        with pytest.raises(InvalidInput, match="options is .* takes a dictionary"):
            envs.reset(options=np.ones(3))
        envs.step(np.zeros(3, int), env_id=np.array([2, 0, 1]))

    def test_an_action_without_its_part(self):
        envs = make()
        envs.reset()
        with pytest.raises(InvalidInput, match="it needs the part 'action'"):
            envs.step({"env_id": np.arange(3, dtype=np.int32)})
