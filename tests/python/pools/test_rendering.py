"""racebeam.envpool: pictures, and results that depend on the interface."""

import os

import harness
import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
from gymnasium.error import Error
from pools import HAS_VECTORS, make
from racebeam import envpool


class TestRendering:
    def test_arguments_of_rendering_that_envpool_accepts(self, subtests):
        for arguments in (
            {"render_mode": "rgb_array"},
            {"render_mode": None},
            {"from_pixels": False},
            {"render_camera_id": -1},
        ):
            envs = make("gymnasium", **arguments)
            assert next(iter(arguments)) not in envs.config
            assert envs.render().shape == (1, 210, 160, 3)
        for arguments in (
            {"render_mode": "human"},
            {"from_pixels": True},
            {"render_width": 100},
            {"render_height": 3},
            {"render_camera_id": 4},
        ):
            with subtests.test(**arguments), pytest.raises(racebeam.InvalidInput, match="racebeam has"):
                make("gymnasium", **arguments)

    @pytest.mark.skipif(not HAS_VECTORS, reason="Gymnasium has no AddRenderObservation")
    def test_the_metadata_has_the_mode_and_wrappers_use_it(self):
        assert make().render_mode is None
        envs = gymnasium.wrappers.AddRenderObservation(make(render_mode="rgb_array"))
        assert (envs.reset()[0].shape, envs.observation_space.shape) == ((1, 210, 160, 3),) * 2
        assert envs.unwrapped.render(env_ids=2, camera_id=-1).shape == (1, 210, 160, 3)

    @pytest.mark.needs_roms("air_raid")
    def test_the_upper_210_rows_of_higher_screens_are_seen(self, monkeypatch):
        monkeypatch.setenv("RACEBEAM_ROMS", os.path.dirname(harness.rom("air_raid")))
        envs = envpool.make_gymnasium(
            "AirRaid-v5", gray_scale=False, stack_num=1, img_height=210, img_width=160, use_inter_area_resize=False
        )
        observations = envs.reset()[0]
        assert envs.render().shape == (1, 210, 160, 3)
        assert np.array_equal(observations[0].transpose(1, 2, 0), envs.render()[0])
        assert racebeam.AtariEnv("air_raid").reset()[0].shape == (250, 160, 3)

    def test_render_returns_the_chosen_environment(self, subtests):
        first, second = (make("gymnasium", num_envs=2, env_seed=[1, 9], render_env_id=env) for env in (0, 1))
        for envs in (first, second):
            envs.reset()
            for _ in range(20):
                envs.step(np.array([3, 4]))
        assert np.array_equal(second.render(), first.render(1))
        assert not np.array_equal(second.render(), first.render())
        for env in (2, -1, "x", None):
            with subtests.test(env=env), pytest.raises(Error, match="render_env_id"):
                make("gymnasium", num_envs=2, render_env_id=env)

    def test_only_gym_resets_without_infos(self):
        for env_type in ("gymnasium", "dm"):
            with pytest.raises(ValueError, match="gym_reset_return_info is False"):
                make(env_type, gym_reset_return_info=False)
        assert make("gym", gym_reset_return_info=False).reset().ndim == 4

    def test_rewards_and_discounts_of_dm(self):
        try:
            from dm_env import specs
        except ImportError:
            pytest.skip("dm_env is not installed")
        envs = make("dm")
        assert envs.reward_spec() == specs.Array((), float, "reward")
        assert envs.discount_spec() == specs.BoundedArray((), float, 0.0, 1.0, "discount")
