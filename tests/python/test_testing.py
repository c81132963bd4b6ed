"""racebeam.testing, run on all environments of the package, and on environments that break its rules."""

import contextlib
import itertools
import os
import tempfile
import unittest
import warnings

import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
import racebeam.ale_py
import racebeam.envpool
import racebeam.program
from gymnasium.vector.utils import batch_space
from gymnasium.wrappers import ClipReward, FrameStackObservation
from racebeam import AtariEnv, AtariVectorEnv
from racebeam.testing import EnvironmentTests, VectorEnvironmentTests, equal

LIVES = {"life_loss": "end", "frameskip": 60}  # each environment ends at another time
SHORT = {"max_num_frames_per_episode": 60, "noop_max": 4}


def case(kind, name, make, **attributes):
    """A test case of racebeam.testing, for environments that `make` makes."""
    maker = {EnvironmentTests: "make_env", VectorEnvironmentTests: "make_envs"}[kind]
    members = {maker: staticmethod(make), **attributes}
    globals()[name] = type(name, (kind, unittest.TestCase), members)


def scratch_folder(test):
    """Makes a folder, which ends with the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return folder.name


def start_server(test):
    """Starts a server, which ends with the test. Returns its address."""
    folder = scratch_folder(test)
    ready = os.path.join(folder, "ready")
    listen = "--listen", f"unix:{os.path.join(folder, 'socket')}", "--ready-file", ready
    server = racebeam.program.path(), "serve", "--log-level", "warning", *listen
    test.addCleanup(stop, os.posix_spawn(server[0], server, os.environ))
    return f"file:{ready}?wait=60"


def stop(process):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, 15)
    os.waitpid(process, 0)


for _name, _settings in {
    "Rgb": {},
    "Ram": {"obs_type": "ram"},
    "Grey": {"obs_type": "grayscale", **SHORT},
    "Sound": {"sound_obs": True},
    "AllSound": {"sound_obs": "all"},
    "Console": {"full_action_space": "console"},
    "Lives": {"life_loss": "end", "reward_range": (-1, 1), "frameskip": 20},
    "Restarts": {"life_loss": "restart", "frameskip": 20},
    "Skips": {"frameskip": (2, 5)},
    "Continuous": {"continuous": True},
    "Dqn": {"preset": "dqn2015"},
}.items():
    case(EnvironmentTests, f"Env{_name}", lambda settings=_settings: AtariEnv("beamfall", **settings))

case(EnvironmentTests, "EnvOfAlePy", lambda: racebeam.ale_py.AtariEnv("beamfall"))
case(EnvironmentTests, "EnvMade", lambda: gymnasium.make("racebeam/Updraft-v5"))
case(EnvironmentTests, "EnvOfEveryFrame", lambda: gymnasium.make("racebeam/BeamfallNoFrameskip-v4"))
case(EnvironmentTests, "EnvClipped", lambda: ClipReward(AtariEnv("beamfall"), -1, 1))
case(
    EnvironmentTests,
    "EnvStacked",
    lambda: FrameStackObservation(AtariEnv("beamfall", obs_type="ram"), 4),
    has_states=False,
)

for _name, _settings in {
    "Default": {},
    "Ram": {"obs_type": "ram"},
    "Colours": {"grayscale": False, "img_height": 40, "img_width": 30},
    "SameStep": {"autoreset_mode": "SameStep", **SHORT},
    "NextStep": {"autoreset_mode": "NextStep", **SHORT},
    "Disabled": {"autoreset_mode": "Disabled", **SHORT},
    "Continuous": {"continuous": True, "repeat_action_probability": 0.25},
    "Lives": {"life_loss": "end", "start": "baselines", "frameskip": 20},
    "Sound": {"sound_obs": True, **SHORT},
    "Console": {"full_action_space": "console"},
}.items():
    case(
        VectorEnvironmentTests,
        f"Vector{_name}",
        lambda count, settings=_settings: AtariVectorEnv("beamfall", count, **settings),
    )

case(VectorEnvironmentTests, "VectorOfAlePy", lambda count: racebeam.ale_py.AtariVectorEnv("beamfall", count))
case(VectorEnvironmentTests, "VectorMade", lambda count: gymnasium.make_vec("racebeam/Updraft-v5", count))


@pytest.mark.needs_program
class EnvOnServer(EnvironmentTests, unittest.TestCase):
    def make_env(self):
        return AtariEnv("beamfall", server=start_server(self))


@pytest.mark.needs_program
class VectorOnServer(VectorEnvironmentTests, unittest.TestCase):
    def make_envs(self, count):
        return AtariVectorEnv("beamfall", count, server=start_server(self))


@pytest.mark.needs_program
class VectorOnServers(VectorEnvironmentTests, unittest.TestCase):
    def make_envs(self, count):
        return AtariVectorEnv("beamfall", count, server=[start_server(self), start_server(self)])


class WithLogs(unittest.TestCase):
    """The tests leave episodes before their end, and restore states: such episodes have no log, and cause a warning."""

    def setUp(self):
        caught = warnings.catch_warnings(record=True)
        caught.__enter__()
        self.addCleanup(caught.__exit__, None, None, None)

    def new_folder(self):
        return os.path.join(scratch_folder(self), "logs")


class EnvWithLogs(EnvironmentTests, WithLogs):
    has_states = False  # the seeds of later episodes are not part of them

    def make_env(self):
        env = AtariEnv("beamfall", max_num_frames_per_episode=60)
        return racebeam.RecordLog(env, self.new_folder(), agent="random")


class VectorWithLogs(VectorEnvironmentTests, WithLogs):
    def make_envs(self, count):
        about = {"folder": self.new_folder(), "agent": "random"}
        return AtariVectorEnv("beamfall", count, noop_max=0, use_fire_reset=False, log=about)


class SeededPool:
    """Environments of racebeam.envpool, which take their seed when they are made, as a vector that `reset` seeds."""

    def __init__(self, count):
        self.num_envs, self.metadata, self.unwrapped = count, {}, self
        self._pool = self._make(1)
        self.single_observation_space, self.single_action_space = self._pool.observation_space, self._pool.action_space
        self.observation_space = batch_space(self.single_observation_space, count)

    def _make(self, seed):
        return racebeam.envpool.make_gymnasium("Beamfall-v5", num_envs=self.num_envs, seed=seed)

    def reset(self, *, seed):
        self._pool.close()
        self._pool = self._make(seed)
        return self._pool.reset()

    def step(self, actions):
        return self._pool.step(actions)

    def close(self):
        self._pool.close()


case(VectorEnvironmentTests, "VectorOfEnvPool", SeededPool)


class Broken(unittest.TestCase):
    """Environments that break a rule fail the test of that rule."""

    def failures(self, kind, maker, make, **attributes):
        tests = unittest.defaultTestLoader.loadTestsFromTestCase(
            type("Broken", (kind, unittest.TestCase), {maker: staticmethod(make), **attributes})
        )
        result = tests.run(unittest.TestResult())
        return {test.id().split(".")[-1] for test, _ in result.failures + result.errors}

    def test_an_environment_that_ignores_seeds(self):
        class Unseeded(gymnasium.Wrapper):
            def reset(self, *, seed=None, options=None):
                return self.env.reset(seed=int(np.random.default_rng().integers(2**31)))

        found = self.failures(EnvironmentTests, "make_env", lambda: Unseeded(AtariEnv("beamfall")))
        self.assertEqual(found, {"test_a_seed_decides_all_results"})

    def test_an_environment_that_reuses_its_memory(self):
        class Reused(gymnasium.ObservationWrapper):
            memory = None

            def observation(self, observation):
                self.memory = observation.copy() if self.memory is None else self.memory
                self.memory[:] = observation
                return self.memory

        found = self.failures(EnvironmentTests, "make_env", lambda: Reused(AtariEnv("beamfall", obs_type="ram")))
        self.assertIn("test_results_belong_to_the_caller", found)

    def test_a_vector_whose_environments_share_a_seed(self):
        class Shared(AtariVectorEnv):
            def reset(self, *, seed=None, **arguments):
                return super().reset(seed=None if seed is None else [seed] * self.num_envs, **arguments)

        found = self.failures(VectorEnvironmentTests, "make_envs", lambda count: Shared("beamfall", count))
        self.assertEqual(found, {"test_a_vector_plays_like_its_environments_one_by_one"})

    def check(self, kind, rules, **members):
        """Environments of this kind with these members break these rules, and no others."""
        tests = {AtariEnv: (EnvironmentTests, "make_env"), AtariVectorEnv: (VectorEnvironmentTests, "make_envs")}[kind]
        broken = type("Broken", (kind,), members)
        self.assertEqual(self.failures(*tests, lambda *count: broken("beamfall", *count, obs_type="ram")), rules)

    def test_results_of_other_shapes_and_types(self):
        wrong = {
            AtariEnv: (lambda ram: ram.astype(int), lambda _: None, lambda _: None, lambda _: None, list),
            AtariVectorEnv: (
                lambda ram: ram.astype(int),
                lambda rewards: rewards[:, None],
                lambda ends: ends.astype(np.uint8),
                lambda ends: ends.astype(np.uint8),
                list,
            ),
        }
        rules = {
            AtariEnv: {"test_results_have_the_types_of_the_spaces"},
            AtariVectorEnv: {"test_results_have_the_shapes_of_the_spaces"},
        }
        for kind, changes in wrong.items():
            for place, change in enumerate(changes):

                def step(self, action, kind=kind, place=place, change=change):
                    result = list(kind.step(self, action))
                    result[place] = change(result[place])
                    return tuple(result)

                with self.subTest(kind=kind, place=place):
                    self.check(kind, rules[kind], step=step)

    def test_a_first_observation_of_another_type(self):
        for kind, rule in ((AtariEnv, "types"), (AtariVectorEnv, "shapes")):

            def reset(self, kind=kind, **arguments):
                ram, info = kind.reset(self, **arguments)
                return ram.astype(int), info

            with self.subTest(kind=kind):
                self.check(kind, {f"test_results_have_the_{rule}_of_the_spaces"}, reset=reset)

    def test_a_seed_that_means_something_else_later_or_elsewhere(self):
        seeds = "test_a_seed_decides_all_results"
        alone = "test_a_vector_plays_like_its_environments_one_by_one"
        for kind in (AtariEnv, AtariVectorEnv):
            made = itertools.count(1)

            def later(self, *, seed=None, kind=kind, **arguments):
                self.resets = getattr(self, "resets", 0) + 1
                return kind.reset(self, seed=seed and 1000 * self.resets + seed, **arguments)

            def elsewhere(self, *, seed=None, kind=kind, made=made, **arguments):
                self.number = getattr(self, "number", None) or next(made)
                return kind.reset(self, seed=seed and 1000 * self.number + seed, **arguments)

            with self.subTest(kind=kind):
                self.check(kind, {seeds}, reset=later)
                self.check(kind, {seeds, alone} if kind is AtariVectorEnv else {seeds}, reset=elsewhere)

    def test_a_vector_that_reuses_its_memory(self):
        def step(self, actions):
            ram, *others = AtariVectorEnv.step(self, actions)
            self.memory[:] = ram
            return self.memory, *others

        def reset(self, **arguments):
            ram, info = AtariVectorEnv.reset(self, **arguments)
            self.memory = ram.copy()
            return self.memory, info

        tests = VectorEnvironmentTests, "make_envs"
        broken = type("Reused", (AtariVectorEnv,), {"step": step, "reset": reset})
        found = self.failures(*tests, lambda count: broken("beamfall", count, obs_type="ram"))
        self.assertIn("test_results_belong_to_the_caller", found)

    def test_a_state_that_is_not_restored(self):
        self.check(AtariEnv, {"test_a_state_restores_the_game"}, restore_state=lambda *_: None)
        self.check(AtariVectorEnv, {"test_a_state_restores_an_environment"}, restore=lambda *_: None)

    def test_a_second_close_that_fails(self):
        def close(self):
            if getattr(self, "is_closed", False):
                raise RuntimeError("closed")
            self.is_closed = True
            AtariEnv.close(self)

        self.check(AtariEnv, {"test_a_second_close_does_nothing"}, close=close)

    def test_an_environment_that_takes_no_step_after_an_end_keeps_the_rules(self):
        class Strict(gymnasium.Wrapper):
            ends = itertools.cycle(((True, False), (False, True)))
            steps = 0  # of the episode; None: it is over

            def reset(self, **arguments):
                self.steps = 0
                return self.env.reset(**arguments)

            def step(self, action):
                assert self.steps is not None
                self.steps += 1
                ram, reward, _, _, info = self.env.step(action)
                ends = (False, False)
                if self.steps == 3:
                    self.steps, ends = None, next(self.ends)
                return ram, reward, *ends, info

        tests = EnvironmentTests, "make_env"
        found = self.failures(*tests, lambda: Strict(AtariEnv("beamfall", obs_type="ram")), has_states=False, steps=48)
        self.assertEqual(found, set())

    def test_a_vector_that_takes_no_step_after_an_end_keeps_the_rules(self):
        class Strict(AtariVectorEnv):
            over = False

            def reset(self, *, options=None, **arguments):
                mask = True if options is None else options["reset_mask"]
                assert options is None or np.array_equal(mask, self.over)
                self.over = self.over & ~np.asarray(mask)
                return super().reset(options=options, **arguments)

            def step(self, actions):
                assert not np.any(self.over)
                result = super().step(actions)
                self.over = result[2] | result[3]
                return result

        def make(count):
            return Strict("beamfall", count, obs_type="ram", autoreset_mode="Disabled", **LIVES)

        self.assertEqual(self.failures(VectorEnvironmentTests, "make_envs", make, steps=30), set())

    def test_a_vector_that_resets_its_environments_itself_is_not_reset_at_their_ends(self):
        class Strict(AtariVectorEnv):
            def reset(self, *, options=None, **arguments):
                assert options is None
                return super().reset(**arguments)

        def make(count):
            return Strict("beamfall", count, obs_type="ram", **LIVES)

        self.assertEqual(self.failures(VectorEnvironmentTests, "make_envs", make, steps=30), set())

    def test_each_environment_is_closed(self):
        for kind, tests in (
            (AtariEnv, (EnvironmentTests, "make_env")),
            (AtariVectorEnv, (VectorEnvironmentTests, "make_envs")),
        ):
            made, closed = [], []

            def close(self, kind=kind, closed=closed):
                closed.append(self)
                kind.close(self)

            def make(*count, kind=kind, made=made, close=close):
                made.append(type("Counted", (kind,), {"close": close})("beamfall", *count, obs_type="ram"))
                return made[-1]

            with self.subTest(kind=kind):
                self.assertEqual(self.failures(*tests, make), set())
                self.assertEqual({*map(id, made)}, {*map(id, closed)})

    def test_equal_compares_types_too(self):
        self.assertTrue(equal({"a": [np.zeros(2), 1]}, {"a": [np.zeros(2), 1]}))
        self.assertFalse(equal(np.zeros(2), np.zeros(2, int)))
        self.assertFalse(equal({"a": 1}, {"b": 1}))
        self.assertFalse(equal({"a": 1}, {"a": 2}))
        self.assertFalse(equal({"a": 1}, 1))
        self.assertFalse(equal([1, 2], [1, 3]))
        self.assertFalse(equal(np.zeros(2), np.zeros((2, 1))))
        rows = np.array([np.zeros(2), None], dtype=object)
        self.assertTrue(equal(rows, rows.copy()))
        self.assertFalse(equal(rows, np.array([np.ones(2), None], dtype=object)))
        self.assertFalse(equal(rows, rows[:1]))
        self.assertFalse(equal([1, 2], [1]))
