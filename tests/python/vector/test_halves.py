"""AtariVectorEnv: send and recv, the halves of a step."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from racebeam import AtariVectorEnv, InvalidInput
from vectors import SHORT, play


class TestHalves:
    def test_each_environment_shows_the_same_as_in_whole_steps(self):
        together, envs = AtariVectorEnv("beamfall", 4), AtariVectorEnv("beamfall", 4, batch_size=2, num_threads=2)
        expected = [[together.reset(seed=1)[0][env]] for env in range(4)]
        for step in range(20):
            observations_of_all = together.step(np.full(4, step % 3))[0]
            for env in range(4):
                expected[env].append(observations_of_all[env])
        steps = [0] * 4

        def check(observations, info):
            for env, observation in zip(info["env_id"], observations):
                if steps[env] <= 20:
                    assert np.array_equal(observation, expected[env][steps[env]])
                steps[env] += 1

        observations, info = envs.reset(seed=1)
        assert envs.action_space.shape == (2,)
        while min(steps) <= 20:
            check(observations, info)
            envs.send(np.array([(steps[env] - 1) % 3 for env in info["env_id"]]))
            observations, *_, info = envs.recv()

    def test_show_returns_all_environments(self):
        for settings in ({"batch_size": 1}, {"autoreset_mode": "SameStep", **SHORT}):
            envs = AtariVectorEnv("beamfall", 4, seed=1, **settings)
            if "batch_size" not in settings:
                assert "final_obs" in play(envs, 3)[-1][4]
            seen, info = envs.show()
            assert (seen.shape, info["env_id"].tolist()) == ((4, 4, 84, 84), [0, 1, 2, 3])
            assert "final_obs" not in info

    def test_environments_that_play_are_left_as_they_are(self):
        envs = AtariVectorEnv("beamfall", 4, batch_size=2)
        envs.reset(seed=1)
        for call in (envs.show, lambda: [envs.save(env) for env in range(4)]):
            with pytest.raises(InvalidInput, match="play"):
                call()
        envs.recv()
        with pytest.raises(InvalidInput, match="0 environments play"):
            envs.recv()
        with pytest.raises(InvalidInput, match="reset_mask"):
            envs.reset(options={"reset_mask": np.ones(4, bool)})

    def test_a_reset_drops_what_was_not_received(self, subtests):
        for settings in ({"batch_size": 2}, {}, {"autoreset_mode": "SameStep", **SHORT}):
            envs, others = (
                AtariVectorEnv("beamfall", 4, **settings),
                AtariVectorEnv("beamfall", 4, **{**settings, "batch_size": 0}),
            )
            for seed in (1, 2):
                (seen, info), (expected, _) = envs.reset(seed=seed), others.reset(seed=seed)
                with subtests.test(seed=seed, **settings):
                    assert np.array_equal(seen, expected[info["env_id"]])
                envs.send([0] * envs.batch_size)

    def test_a_reset_of_some_drops_too(self):
        envs = AtariVectorEnv("beamfall", 2, seed=1)
        before = envs.reset()[1]["frame_number"]
        envs.send([0, 0])
        after = envs.reset(options={"reset_mask": np.array([True, False])})[1]["frame_number"]
        assert after[1] == before[1] + 4  # it has made its step
