"""racebeam.testing, run on all environments of the package, and on environments that break its rules."""

import contextlib
import os
import tempfile
import unittest

import package

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
import racebeam.ale_py
import racebeam.program
from gymnasium.wrappers import ClipReward, FrameStackObservation
from racebeam import AtariEnv, AtariVectorEnv
from racebeam.testing import EnvironmentTests, VectorEnvironmentTests, equal

SHORT = {"max_num_frames_per_episode": 60, "noop_max": 4}


def case(kind, name, make, **attributes):
    """A test case of racebeam.testing, for environments that `make` makes."""
    maker = {EnvironmentTests: "make_env", VectorEnvironmentTests: "make_envs"}[kind]
    members = {maker: staticmethod(make), **attributes}
    globals()[name] = type(name, (kind, unittest.TestCase), members)


def on_server(kind):
    """Makes environments on a new server, which ends with the test."""

    def make(self, *count):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        address = f"unix:{os.path.join(folder.name, 'socket')}"
        ready = os.path.join(folder.name, "ready")
        server = racebeam.program.path(), "serve", "--log-level", "warning", "--listen", address, "--ready-file", ready
        self.addCleanup(stop, os.posix_spawn(server[0], server, os.environ))
        return kind("beamfall", *count, server=f"file:{ready}?wait=60")

    return make


def stop(process):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, 15)
    os.waitpid(process, 0)


for _name, _settings in {
    "Rgb": {},
    "Ram": {"obs_type": "ram"},
    "Grey": {"obs_type": "grayscale", **SHORT},
    "Sound": {"sound_obs": True},
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
}.items():
    case(
        VectorEnvironmentTests,
        f"Vector{_name}",
        lambda count, settings=_settings: AtariVectorEnv("beamfall", count, **settings),
    )

case(VectorEnvironmentTests, "VectorOfAlePy", lambda count: racebeam.ale_py.AtariVectorEnv("beamfall", count))
case(VectorEnvironmentTests, "VectorMade", lambda count: gymnasium.make_vec("racebeam/Updraft-v5", count))


class EnvOnServer(EnvironmentTests, unittest.TestCase):
    make_env = on_server(AtariEnv)


class VectorOnServer(VectorEnvironmentTests, unittest.TestCase):
    make_envs = on_server(AtariVectorEnv)


class Broken(unittest.TestCase):
    """Environments that break a rule fail the test of that rule."""

    def failures(self, kind, maker, make):
        tests = unittest.defaultTestLoader.loadTestsFromTestCase(
            type("Broken", (kind, unittest.TestCase), {maker: staticmethod(make)})
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

    def test_equal_compares_types_too(self):
        self.assertTrue(equal({"a": [np.zeros(2), 1]}, {"a": [np.zeros(2), 1]}))
        self.assertFalse(equal(np.zeros(2), np.zeros(2, int)))
        self.assertFalse(equal({"a": 1}, {"b": 1}))
        self.assertFalse(equal([1, 2], [1]))


if __name__ == "__main__":
    package.main()
