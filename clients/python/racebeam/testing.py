"""Tests that an environment keeps its contract: spaces, seeds, states, and vectors against single environments.

Programs run these tests on their own wrappers. A test case derives from one of the classes and from unittest.TestCase,
and says how to make the environment:

    import unittest

    import gymnasium
    import racebeam.testing


    class MyWrapper(racebeam.testing.EnvironmentTests, unittest.TestCase):
        def make_env(self):
            return gymnasium.wrappers.ClipReward(racebeam.AtariEnv("beamfall"), -1, 1)
"""

from __future__ import annotations

import copy
import unittest
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    Base = unittest.TestCase
else:
    Base = object

__all__ = ["EnvironmentTests", "VectorEnvironmentTests", "equal"]


def equal(one: Any, other: Any) -> bool:
    """Compares two observations, infos or steps, exactly.

    Args:
        one: Arrays, numbers, or mappings and sequences of them.
        other: The same kinds of values.

    Returns:
        Whether all numbers, shapes and dtypes are equal.

    Examples:
        >>> import numpy as np
        >>> from racebeam.testing import equal
        >>> equal({"lives": np.array([3, 4])}, {"lives": np.array([3, 4])})
        True
    """
    if isinstance(one, Mapping):
        return (
            isinstance(other, Mapping)
            and one.keys() == other.keys()
            and all(equal(one[key], other[key]) for key in one)
        )
    if isinstance(one, (tuple, list)):
        return len(one) == len(other) and all(map(equal, one, other))
    if isinstance(one, np.ndarray) and one.dtype == object:
        return one.shape == other.shape and all(map(equal, one.flat, other.flat))
    return np.asarray(one).dtype == np.asarray(other).dtype and np.array_equal(one, other)


def _row(values: Any, index: int) -> Any:
    """Returns the part of an environment: an element of each array."""
    return {key: _row(part, index) for key, part in values.items()} if isinstance(values, Mapping) else values[index]


class EnvironmentTests(Base):
    """Tests of a `gymnasium.Env`. A subclass defines `make_env`.

    Attributes:
        steps: Number of steps that each test plays.
        seed: First seed.
        has_states: Whether the state of `env.unwrapped.clone_state` is the whole state. It is not if a wrapper keeps
            more state, such as a stack of screens.

    Examples:
        >>> import unittest
        >>> import racebeam
        >>> from racebeam.testing import EnvironmentTests
        >>> class Ram(EnvironmentTests, unittest.TestCase):
        ...     def make_env(self):
        ...         return racebeam.AtariEnv("beamfall", obs_type="ram")
        >>> tests = unittest.defaultTestLoader.loadTestsFromTestCase(Ram)
        >>> tests.run(unittest.TestResult())
        <unittest.result.TestResult run=5 errors=0 failures=0>
    """

    steps = 50
    seed = 1
    has_states = True

    def make_env(self) -> Any:
        """Makes the environment under test. Each call makes a new one."""
        raise NotImplementedError

    def _play(self, env: Any, seed: int) -> list[Any]:
        """Plays random actions, and returns the steps. A reset follows each end."""
        env.action_space.seed(seed)
        steps = []
        for _ in range(self.steps):
            steps.append(env.step(env.action_space.sample()))
            if steps[-1][2] or steps[-1][3]:
                steps.append(env.reset())
        return steps

    def _open(self) -> Any:
        env = self.make_env()
        self.addCleanup(env.close)
        return env

    def test_results_have_the_types_of_the_spaces(self) -> None:
        """Observations lie in the space, rewards are floats, and ends are bools."""
        env = self._open()
        observation, info = env.reset(seed=self.seed)
        self.assertIn(observation, env.observation_space)
        self.assertIsInstance(info, dict)
        for _ in range(self.steps):
            observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
            self.assertIn(observation, env.observation_space)
            self.assertIsInstance(float(reward), float)
            self.assertIn(terminated, (False, True))
            self.assertIn(truncated, (False, True))
            self.assertIsInstance(info, dict)
            if terminated or truncated:
                env.reset()

    def test_a_seed_decides_all_results(self) -> None:
        """The same seed and actions give the same results: in the same environment, and in another one."""
        env, other = self._open(), self._open()
        first = [env.reset(seed=self.seed), *self._play(env, 2)]
        self.assertTrue(equal(first, [env.reset(seed=self.seed), *self._play(env, 2)]), "the second run differs")
        self.assertTrue(
            equal(first, [other.reset(seed=self.seed), *self._play(other, 2)]), "another environment differs"
        )

    def test_results_belong_to_the_caller(self) -> None:
        """Later steps do not change earlier observations."""
        env = self._open()
        observation, _ = env.reset(seed=self.seed)
        before = copy.deepcopy(observation)
        self._play(env, 3)
        self.assertTrue(equal(observation, before))

    def test_a_state_restores_the_game(self) -> None:
        """After restore_state, the same actions give the same results."""
        env = self._open()
        if not self.has_states or not hasattr(env.unwrapped, "clone_state"):
            self.skipTest("the environment has no states")
        env.reset(seed=self.seed)
        self._play(env, 4)
        state = env.unwrapped.clone_state(include_rng=True)
        random = env.unwrapped.np_random.bit_generator.state
        first = self._play(env, 5)
        env.unwrapped.restore_state(state)
        env.unwrapped.np_random.bit_generator.state = random
        self.assertTrue(equal(first, self._play(env, 5)))

    def test_a_second_close_does_nothing(self) -> None:
        """Closing twice is allowed."""
        env = self._open()
        env.close()
        env.close()


class VectorEnvironmentTests(Base):
    """Tests of a `gymnasium.vector.VectorEnv`. A subclass defines `make_envs`.

    Attributes:
        steps: Number of steps that each test plays.
        seed: First seed.
        has_states: Whether the state of `envs.unwrapped.save` is the whole state of an environment. It is not if a
            wrapper keeps more state.

    Examples:
        >>> import unittest
        >>> import racebeam
        >>> from racebeam.testing import VectorEnvironmentTests
        >>> class Ram(VectorEnvironmentTests, unittest.TestCase):
        ...     def make_envs(self, count):
        ...         return racebeam.AtariVectorEnv("beamfall", count, obs_type="ram")
        >>> tests = unittest.defaultTestLoader.loadTestsFromTestCase(Ram)
        >>> tests.run(unittest.TestResult())
        <unittest.result.TestResult run=5 errors=0 failures=0>
    """

    steps = 50
    seed = 1
    has_states = True

    def make_envs(self, count: int) -> Any:
        """Makes the vector under test.

        Args:
            count: Number of environments.
        """
        raise NotImplementedError

    def _open(self, count: int) -> Any:
        envs = self.make_envs(count)
        self.addCleanup(envs.close)
        return envs

    def _actions(self, envs: Any, count: int, seed: int) -> list[Any]:
        """Returns random actions for each step: an array with a row for each environment."""
        envs.single_action_space.seed(seed)
        return [np.array([envs.single_action_space.sample() for _ in range(count)]) for _ in range(self.steps)]

    def _play(self, envs: Any, actions: list[Any]) -> list[Any]:
        """Plays actions, and returns the steps. With DISABLED, a reset follows each end."""
        steps = []
        is_disabled = getattr(envs.metadata.get("autoreset_mode"), "name", "") == "DISABLED"
        for row in actions:
            steps.append(envs.step(row))
            is_over = steps[-1][2] | steps[-1][3]
            if is_disabled and is_over.any():
                steps.append(envs.reset(options={"reset_mask": is_over}))
        return steps

    def test_results_have_the_shapes_of_the_spaces(self) -> None:
        """Observations lie in the space; rewards and ends have one element per environment."""
        envs = self._open(3)
        observations, info = envs.reset(seed=self.seed)
        self.assertEqual(envs.num_envs, 3)
        self.assertIn(observations, envs.observation_space)
        self.assertIn(_row(observations, 2), envs.single_observation_space)
        self.assertRaises(IndexError, _row, observations, 3)
        for actions in self._actions(envs, 3, 2):
            observations, rewards, terminated, truncated, info = envs.step(actions)
            self.assertIn(observations, envs.observation_space)
            self.assertEqual([array.shape for array in (rewards, terminated, truncated)], [(3,)] * 3)
            self.assertEqual((terminated.dtype, truncated.dtype), (np.bool_, np.bool_))
            self.assertIsInstance(info, dict)
            if (terminated | truncated).any():
                break

    def test_a_seed_decides_all_results(self) -> None:
        """The same seed and actions give the same results: in the same vector, and in another one."""
        envs, others = self._open(3), self._open(3)
        actions = self._actions(envs, 3, 3)
        first = [envs.reset(seed=self.seed), *self._play(envs, actions)]
        self.assertTrue(
            equal(first, [envs.reset(seed=self.seed), *self._play(envs, actions)]), "the second run differs"
        )
        self.assertTrue(
            equal(first, [others.reset(seed=self.seed), *self._play(others, actions)]), "another one differs"
        )

    def test_a_vector_plays_like_its_environments_one_by_one(self) -> None:
        """Row i of a vector with seed s has the results of a vector of one environment with seed s + i."""
        envs = self._open(3)
        actions = self._actions(envs, 3, 4)
        together = [envs.reset(seed=self.seed)[0], *(step[:4] for step in self._play(envs, actions) if len(step) == 5)]
        for index in range(3):
            one = self._open(1)
            single = [one.reset(seed=self.seed + index)[0]]
            single += [
                step[:4] for step in self._play(one, [row[index : index + 1] for row in actions]) if len(step) == 5
            ]
            rows = [_row(together[0], index), *(tuple(_row(part, index) for part in step) for step in together[1:])]
            singles = [_row(single[0], 0), *(tuple(_row(part, 0) for part in step) for step in single[1:])]
            self.assertTrue(equal(rows, singles), f"environment {index} differs")

    def test_results_belong_to_the_caller(self) -> None:
        """Later steps do not change earlier observations."""
        envs = self._open(2)
        observations, _ = envs.reset(seed=self.seed)
        before = copy.deepcopy(observations)
        self._play(envs, self._actions(envs, 2, 5))
        self.assertTrue(equal(observations, before))

    def test_a_state_restores_an_environment(self) -> None:
        """After restoring all states, the same actions give the same results."""
        envs = self._open(2)
        if not self.has_states or not hasattr(envs.unwrapped, "save"):
            self.skipTest("the environments have no states")
        envs.reset(seed=self.seed)
        self._play(envs, self._actions(envs, 2, 6))
        states = [envs.unwrapped.save(index) for index in range(2)]
        actions = self._actions(envs, 2, 7)
        first = self._play(envs, actions)
        for index, state in enumerate(states):
            envs.unwrapped.restore(index, state)
        self.assertTrue(equal(first, self._play(envs, actions)))
