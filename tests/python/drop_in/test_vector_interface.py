"""Many environments of racebeam.ale_py, on our own game: indices, seeds, strengths and final observations."""

import hashlib

import package
import pytest

package.require("gymnasium", "numpy")

import numpy as np
from racebeam.ale_py import ALEVectorInterface, AtariVectorEnv, roms


def interface(count=3, **settings):
    return ALEVectorInterface("builtin:beamfall", count, **settings)


class TestReset:
    def test_each_environment_has_its_own_seed_in_any_order(self):
        one, other = interface(noop_max=30), interface(noop_max=30)
        for ids, seeds in (([0, 1, 2], [5, 6, 7]), ([2, 0], [8, 9]), ([np.int64(1)], np.array([3]))):
            pairs = sorted(zip(ids, seeds), reverse=True)
            seen, info = one.reset(ids, seeds)
            again, _ = other.reset([env for env, _ in pairs], [seed for _, seed in pairs])
            assert np.array_equal(seen, again)
            assert sorted(info) == ["env_id", "episode_frame_number", "frame_number", "lives"]

    def test_indices_are_those_of_the_environments_each_once(self):
        ale = interface()
        ale.reset([0, 1, 2], [1, 2, 3])
        for env in (-1, 3):
            with pytest.raises(IndexError, match=f"environment {env} is out of range; accepted: 0 to 2"):
                ale.reset([env], [1])
        with pytest.raises(ValueError, match=r"there is a duplicate env_id in \[1, 1\]"):
            ale.reset([1, 1], [1, 2])
        with pytest.raises(ValueError, match="there are 1 seeds for 2 environments"):
            ale.reset([0, 1], [1])
        with pytest.raises(TypeError):
            ale.reset([0.0], [1])

    def test_the_first_reset_is_of_all_environments(self):
        ale = interface()
        with pytest.raises(RuntimeError, match="reset_mask chooses 2 of 3; the first reset"):
            ale.reset([0, 2], [1, 2])
        with pytest.raises(RuntimeError, match="have not been reset yet"):
            ale.send([0, 0, 0], [1.0, 1.0, 1.0])
        ale.reset([2, 1, 0], [1, 2, 3])
        ale.reset([0, 2], [1, 2])

    def test_an_image_of_no_known_game_is_named_by_its_MD5(self, tmp_path):
        image = tmp_path / "unknown.bin"
        image.write_bytes(bytes(range(256)) * 16)
        digest = hashlib.md5(image.read_bytes()).hexdigest()
        with pytest.raises(ValueError, match=f"unknown.bin has the MD5 {digest}, which no known game has"):
            ALEVectorInterface(image, 2)


class TestSteps:
    def test_strengths_are_numbers_one_for_each_environment(self):
        ale = interface(2)
        ale.reset([0, 1], [1, 2])
        for strengths in (["1", "1"], [True, False], [None, None]):
            with pytest.raises(TypeError, match="they must be numbers"):
                ale.send([0, 0], strengths)
        for actions, strengths in (([0, 0], [1.0]), ([0], [1.0, 1.0]), ([0, 0], [[1.0], [1.0]])):
            with pytest.raises(ValueError, match=r"they must have \(2,\)"):
                ale.send(actions, strengths)
        ale.send([0, 0], [1, 0])
        assert [array.shape[0] for array in ale.recv()[:4]] == [2, 2, 2, 2]

    def test_the_place_of_a_joystick_has_an_action(self):
        places = AtariVectorEnv("beamfall", 1).map_action_idx
        assert (places.shape, places.dtype, places.flags.c_contiguous) == ((3, 3, 2), np.int32, True)
        left, middle, right = down, level, up = 0, 1, 2
        for column, row, fire, action in (
            (middle, level, 0, 0),
            (middle, level, 1, 1),
            (middle, up, 0, 2),
            (right, level, 0, 3),
            (left, level, 0, 4),
            (middle, down, 0, 5),
            (right, up, 0, 6),
            (left, down, 1, 17),
        ):
            assert places[column, row, fire] == action

    def test_where_no_episode_ended_the_final_observation_is_the_present_one(self):
        envs = AtariVectorEnv("beamfall", 2, autoreset_mode="SameStep", max_num_frames_per_episode=40, noop_max=0)
        envs.reset(seed=1)
        for _ in range(5):
            envs.step(np.array([1, 3]))
        envs.reset(seed=2, options={"reset_mask": np.array([False, True])})
        for _ in range(20):
            seen, _, terminated, truncated, info = envs.step(np.array([1, 3]))
            if (terminated | truncated).any():
                break
        assert (terminated | truncated).tolist() == [True, False]
        assert np.array_equal(info["final_obs"][1], seen[1])
        assert not np.array_equal(info["final_obs"][0], seen[0])


class TestRoms:
    def test_a_name_that_ale_py_does_not_have_is_a_warning(self):
        assert len(roms.get_all_rom_ids()) == len(set(roms.get_all_rom_ids())) > 100
        with pytest.warns(UserWarning, match="Rom beamfall not supported."):
            assert roms.get_rom_path("beamfall") is None
