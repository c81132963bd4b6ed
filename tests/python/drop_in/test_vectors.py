"""Many environments of racebeam.ale_py show what those of ale_py show."""

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
import racebeam.ale_py as drop_in
from both import PONG, interfaces


@pytest.mark.needs_roms("pong")
class TestVectors:
    def check(self, one, other):
        if isinstance(other, dict):
            assert set(one) == set(other)
            one, other = [one[key] for key in other], list(other.values())
        if isinstance(other, (tuple, list)):
            assert len(one) == len(other)
            for pair in zip(one, other):
                self.check(*pair)
            return
        assert (one.dtype, one.shape) == (other.dtype, other.shape)
        assert np.array_equal(one, other)

    def check_step(self, one, other):
        """Compares a step. ale_py's final_obs is not defined where no episode ended."""
        done = other[2] | other[3]
        for *_, info in (one, other):
            if "final_obs" in info:
                info["final_obs"] = info["final_obs"][done]
        self.check(one, other)

    @pytest.mark.parametrize(
        "settings",
        (
            {},
            {"autoreset_mode": "SameStep", "max_episode_steps": 20},
            {"grayscale": False, "stack_num": 2},
            {"full_action_space": True},
        ),
    )
    def test_all_calls_have_the_same_outcome(self, settings):
        ours, theirs = both = interfaces(3, **settings)
        assert [action.name for action in ours.get_action_set()] == [action.name for action in theirs.get_action_set()]
        assert (ours.get_num_envs(), ours.get_observation_shape()) == (3, theirs.get_observation_shape())
        assert (ours.handle().dtype, ours.handle().shape) == (theirs.handle().dtype, theirs.handle().shape)
        for ids, seeds in (
            ([0, 1, 2], [5, 6, 7]),
            ([1], [9]),
            ([2, 0], [-1, -1]) if not settings else ([0], [3]),
        ):
            self.check(*(each.reset(ids, seeds) for each in both))
            for step in range(8):
                for each in both:
                    each.send([step % 3, 1, 2], [1.0, 0.5, 0.0])
                self.check_step(*(each.recv() for each in both))

    def test_bad_input_is_refused_as_ale_py_does(self):
        ours, theirs = both = interfaces(3)
        for each in both:
            each.reset([0, 1, 2], [1, 2, 3])
        for call, error in (
            (lambda each: each.reset([0, 1], [3]), ValueError),
            (lambda each: each.send([0], [1.0]), ValueError),
            (lambda each: each.reset([7], [3]), IndexError),
            (lambda each: each.send([0, 1, 2], [1.0]), ValueError),
            (lambda each: type(each)(PONG, 2, autoreset_mode="x"), Exception),
        ):
            for each in both:
                with pytest.raises(error):
                    call(each)

    def test_the_environments_of_AtariVectorEnv(self):
        ours, theirs = both = [module.AtariVectorEnv("pong", 2) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
            envs.ale.reset([1], [5])
        self.check(*(envs.step(np.array([1, 2])) for envs in both))
        self.check(*(envs.map_action_idx for envs in both))

    def test_seeds_are_those_of_the_environments_that_are_reset(self):
        both = [module.AtariVectorEnv("pong", 3) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
        for mask in ([False, False, True], [True, False, True], [True, True, True]):
            selection = np.array(mask)
            for seed in (50, np.arange(60, 60 + sum(mask))):
                self.check(*(envs.reset(seed=seed, options={"reset_mask": selection}) for envs in both))
                self.check(*(envs.step(np.array([1, 2, 3])) for envs in both))
            for envs in both:
                with pytest.raises(ValueError):
                    envs.reset(seed=np.arange(4), options={"reset_mask": selection})
        for envs in both:
            with pytest.raises(ValueError):
                envs.reset(seed=np.arange(3), options={"reset_mask": np.array([True, False, False])})

    def test_a_reset_drops_what_was_not_received(self):
        # ale_py is not run beside it: a reset while its threads play ends the process now and then.
        for batch_size in (2, 4):
            envs = drop_in.AtariVectorEnv("pong", 4, batch_size=batch_size)
            for seed in (1, 2):
                _, info = envs.reset(seed=seed)
                assert info["env_id"].shape == (batch_size,)
                envs.send(np.zeros(batch_size, np.int64))
