"""AtariVectorEnv: what it shows, and who owns it."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from gymnasium.error import Error
from racebeam import AtariVectorEnv, InvalidInput
from vectors import play


class TestObservations:
    def test_results_belong_to_the_caller(self):
        envs = AtariVectorEnv("beamfall", 2)
        observations = [envs.reset(seed=1)[0], envs.step(np.zeros(2, int))[0]]
        before = [one.copy() for one in observations]
        play(envs, 20)
        assert all(map(np.array_equal, observations, before))

    def test_infos_belong_to_the_caller_too(self):
        envs = AtariVectorEnv("beamfall", 4, batch_size=2, seed=1)
        _, info = envs.reset()
        info["env_id"][:] = 3
        envs.step([0, 0])
        assert sorted([*envs._received_ids, *envs.recv()[4]["env_id"]]) == [0, 1, 2, 3]

    def test_results_are_written_into_the_array_of_the_caller(self):
        envs, others = (AtariVectorEnv("beamfall", 2) for _ in range(2))
        out = np.zeros(envs.observation_space.shape, np.uint8)
        assert envs.reset(seed=1, out=out)[0] is out
        assert np.array_equal(out, others.reset(seed=1)[0])
        assert envs.step(np.ones(2, int), out=out)[0] is out
        assert np.array_equal(out, others.step(np.ones(2, int))[0])
        half = np.zeros((4, *out.shape[1:]), np.uint8)
        frozen = out.copy()
        frozen.setflags(write=False)
        for wrong in (out[:1], out.astype(np.int32), half[::2], frozen, out.tolist()):
            with pytest.raises(InvalidInput, match="^out "):
                envs.step(np.ones(2, int), out=wrong)

    @pytest.mark.parametrize(
        "settings, shape",
        (
            ({"obs_type": "grayscale"}, (4, 210, 160)),
            ({"obs_type": "rgb", "stack_num": 1}, (1, 210, 160, 3)),
            ({"obs_type": "ram"}, (128,)),
            ({"img_height": 20, "img_width": 31}, (4, 20, 31)),
            ({"img_height": 224, "img_width": 224}, (4, 224, 224)),
            ({"img_height": 420, "img_width": 320}, (4, 420, 320)),
            ({"grayscale": False}, (4, 84, 84, 3)),
            ({"img_height": 0, "img_width": 0}, (4, 210, 160)),
        ),
    )
    def test_the_kinds_of_environments(self, settings, shape):
        envs = AtariVectorEnv("beamfall", 2, **settings)
        assert envs.reset(seed=1)[0].shape == (2, *shape)
        assert play(envs, 5)[-1][0] in envs.observation_space

    def test_full_ones_are_those_of_AtariEnv(self):
        for kind in ("rgb", "grayscale", "ram"):
            envs = AtariVectorEnv(
                "beamfall", 1, obs_type=kind, noop_max=0, use_fire_reset=False, maxpool=False, stack_num=1
            )
            env = racebeam.AtariEnv("beamfall", obs_type=kind, repeat_action_probability=0.0)
            envs.reset(seed=3)
            env.ale.setInt("random_seed", 3)
            env.load_game()
            env.ale.reset_game()
            for action in (1, 3, 4, 0, 1):
                observation = envs.step([action])[0].reshape(env.observation_space.shape)
                assert np.array_equal(observation, env.step(action)[0]), kind

    def test_the_sound_is_that_of_AtariEnv(self):
        settings = {"obs_type": "ram", "sound_obs": True}
        envs = AtariVectorEnv("beamfall", 2, noop_max=0, use_fire_reset=False, frameskip=1, **settings)
        assert list(envs.single_observation_space) == ["image", "sound"]
        env = racebeam.AtariEnv("beamfall", frameskip=1, repeat_action_probability=0.0, **settings)
        seen, _ = envs.reset(seed=3)
        env.ale.setInt("random_seed", 3)
        env.load_game()
        env.ale.reset_game()
        sounds = set()
        for step in range(60):
            assert seen in envs.observation_space
            assert {name: part.shape for name, part in seen.items()} == {"image": (2, 128), "sound": (2, 512)}
            seen, single = envs.step([1, 0])[0], env.step(1)[0]
            for name, part in single.items():
                assert np.array_equal(seen[name][0], part), (name, step)
            sounds.add(seen["sound"][0].tobytes())
        assert len(sounds) > 5
        assert np.array_equal(envs.show()[0]["sound"], seen["sound"])

    def test_all_the_sound_of_a_step_is_that_of_AtariEnv(self):
        settings = {"obs_type": "ram", "sound_obs": "all", "frameskip": 3}
        envs = AtariVectorEnv("beamfall", 2, noop_max=0, use_fire_reset=False, autoreset_mode="SameStep", **settings)
        env = racebeam.AtariEnv("beamfall", repeat_action_probability=0.0, **settings)
        envs.reset(seed=3)
        env.ale.setInt("random_seed", 3)
        env.load_game()
        env.ale.reset_game()
        for _ in range(40):
            seen, single = envs.step([1, 0])[0], env.step(1)[0]
            assert seen["sound"].shape == (2, 3 * 512)
            assert np.array_equal(seen["sound"][0], single["sound"])

    def test_the_sound_of_some_environments(self):
        envs, others = (
            AtariVectorEnv("beamfall", 3, sound_obs=True, **settings) for settings in ({"batch_size": 1}, {})
        )
        expected = others.reset(seed=1)[0]
        seen, info = envs.reset(seed=1)
        env = info["env_id"][0]
        assert np.array_equal(seen["sound"][0], expected["sound"][env])
        out = np.zeros((1, 4, 84, 84), np.uint8)
        assert envs.step([0], out=out)[0]["image"] is out

    def test_render_shows_each_environment(self):
        for kind in ("ram", None):
            envs = AtariVectorEnv("beamfall", 2, obs_type=kind, render_mode="rgb_array")
            full = AtariVectorEnv("beamfall", 2, obs_type="rgb", stack_num=1, maxpool=False)
            for one in (envs, full):
                one.reset(seed=1)
            observations = [play(one, 7)[-1][0] for one in (envs, full)]
            pictures = envs.render()
            assert len(pictures) == 2
            assert all(
                np.array_equal(picture, observation[0]) for picture, observation in zip(pictures, observations[1])
            )
        with pytest.raises(Error, match="render_mode"):
            full.render()

    def test_a_stack_may_begin_with_repeats(self):
        envs = AtariVectorEnv("beamfall", 1, stack_start="repeats")
        stack = envs.reset(seed=1)[0][0]
        assert all(np.array_equal(stack[0], screen) for screen in stack) and stack.any()
