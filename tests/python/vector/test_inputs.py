"""Seeds, masks and actions at the limits of what a vector takes, and the rows of its results."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from racebeam import InvalidInput
from racebeam.vector.inputs import array_of, indices_of, joysticks_of, mask_of, seeds_of
from racebeam.vector.results import Results

MOST = 2**32 - 1


class TestSeeds:
    def test_one_seed_counts_up_and_others_are_one_each(self):
        for seed, seeds in (
            (0, [0, 1, 2]),
            (np.int64(7), [7, 8, 9]),
            (np.array(7), [7, 8, 9]),
            ([0, MOST, None], [0, MOST, -1]),
            ((-1, 5, np.int32(6)), [-1, 5, 6]),
            (np.array([3, -1, 4]), [3, -1, 4]),
            (np.array([3, None, 4], object), [3, -1, 4]),
            (np.array([3, 2, 4], np.uint32), [3, 2, 4]),
        ):
            found = seeds_of(seed, 3)
            assert (found.tolist(), found.dtype) == (seeds, np.int64)
        assert seeds_of(MOST, 1).tolist() == [MOST]

    def test_seeds_out_of_range_are_refused(self):
        for seed, sentence in (
            (-1, "the seed is -1; it takes 0 to 4294967295"),
            (MOST + 1, "the seed is 4294967296; it takes 0 to 4294967295"),
            ([0, -2, 0], "the seed is -2; it takes -1 to 4294967295"),
            ([0, MOST + 1, 0], "the seed is 4294967296; it takes -1 to"),
            ([0, 1], "there are 2 seeds for 3 environments"),
            ([0, 1, 2, 3], "there are 4 seeds for 3 environments"),
            (np.zeros((3, 1), np.int64), r"the seeds have the shape \(3, 1\); they must have \(3,\)"),
        ):
            with pytest.raises(InvalidInput, match=sentence):
                seeds_of(seed, 3)
        for seed in (1.5, "abc", [0, 1.0, 2], np.zeros(3), np.zeros(3, np.bool_)):
            with pytest.raises(TypeError):
                seeds_of(seed, 3)


class TestMasks:
    def test_a_mask_is_an_array_of_bools_of_the_environments(self):
        assert mask_of(None, 3) is None
        mask = np.array([True, False, False, False, True, True])[::2]
        found = mask_of(mask, 3)
        assert (found.tolist(), found.flags.c_contiguous) == ([True, False, True], True)
        for wrong, kind in (
            ([True, False, True], TypeError),
            (np.ones(3, np.int64), TypeError),
            (np.ones(2, np.bool_), InvalidInput),
            (np.ones((3, 1), np.bool_), InvalidInput),
        ):
            with pytest.raises(kind, match="^reset_mask "):
                mask_of(wrong, 3)


class TestActions:
    def test_indices_are_whole_numbers_of_any_type(self):
        for actions in ([1, 2], np.array([1, 2], np.uint8), np.array([1, 9, 2])[::2], (1, np.int64(2))):
            found = indices_of(actions, 2, 18)
            assert (found.tolist(), found.dtype, found.flags.c_contiguous) == ([1, 2], np.int64, True)
        assert indices_of(np.array([2**63 - 1], np.uint64), 1, 18).tolist() == [2**63 - 1]
        with pytest.raises(IndexError, match="action 9223372036854775808 is out of range; accepted: 0 to 17"):
            indices_of(np.array([1, 2**63], np.uint64), 2, 18)
        for actions in ([1.0, 2.0], [True, False], ["1", "2"]):
            with pytest.raises(TypeError, match="they must be integers"):
                indices_of(actions, 2, 18)
        for actions in ([1], [1, 2, 3], [[1, 2]], 1):
            with pytest.raises(InvalidInput, match=r"they must have \(2,\)"):
                indices_of(actions, 2, 18)

    def test_joysticks_are_finite_numbers(self):
        for actions in ([[1, 0, 1]], np.array([[1, 0, 1]], np.float64), np.array([[1, 0, 1]], np.uint8)):
            found = joysticks_of(actions, 1)
            assert (found.tolist(), found.dtype) == ([[1, 0, 1]], np.float32)
        most = float(np.finfo(np.float32).max)
        assert joysticks_of([[most, -most, 0]], 1).tolist() == [[most, -most, 0]]
        for value in (float("nan"), float("inf"), 1e39):
            with pytest.raises(InvalidInput, match="each must be a finite number"):
                joysticks_of([[0.0, 0.0, 0.0], [0.0, value, 0.0]], 2)
        with pytest.raises(TypeError, match="they must be numbers: radius, angle and fire"):
            joysticks_of([[True, False, True]], 1)
        for actions in ([[1.0, 0.0]], [1.0, 0.0, 1.0], [[1.0, 0.0, 1.0]] * 2):
            with pytest.raises(InvalidInput, match=r"they must have \(1, 3\)"):
                joysticks_of(actions, 1)

    def test_rows_of_different_lengths_are_refused(self):
        with pytest.raises(InvalidInput, match="its rows have different lengths"):
            array_of([[1, 2], [3]])


class TestResults:
    def results(self):
        made = Results.allocate(np.arange(8, dtype=np.uint8).reshape(4, 2), None, 4, np.zeros((4, 2), np.uint8))
        made.numbers[:] = np.arange(24).reshape(6, 4)
        made.flags[:] = np.eye(4, dtype=np.bool_)
        return made._replace(counts=np.arange(12, dtype=np.int32).reshape(3, 4), sound=np.zeros((4, 512), np.uint8))

    def test_each_name_is_a_row(self):
        made = self.results()
        names = ("rewards", "raw_rewards", "lives", "frames", "episode_frames", "env_id")
        assert [getattr(made, name)[0] for name in names] == [0, 4, 8, 12, 16, 20]
        names = ("terminated", "truncated", "finished", "game_over")
        assert [getattr(made, name).tolist().index(True) for name in names] == [0, 1, 2, 3]

    def test_arrays_are_of_all_environments(self):
        made = self.results()
        assert (made.numbers.shape, made.numbers.dtype) == ((6, 4), np.int32)
        assert (made.flags.shape, made.flags.dtype) == ((4, 4), np.bool_)
        assert (made.final_numbers.shape, made.final_numbers.dtype) == ((3, 4), np.int32)
        other = Results.allocate(None, None, 5, None)
        assert (other.numbers.shape, other.flags.shape, other.final_numbers) == ((6, 5), (4, 5), None)

    def test_a_selection_shares_the_memory(self):
        made = self.results()
        some = made.select(slice(1, 3))
        assert some.observations.tolist() == [[2, 3], [4, 5]]
        assert some.numbers.tolist() == made.numbers[:, 1:3].tolist()
        assert some.flags.tolist() == made.flags[:, 1:3].tolist()
        assert some.counts.tolist() == [[1, 2], [5, 6], [9, 10]]
        shapes = [array.shape for array in (some.final_observations, some.final_numbers, some.sound)]
        assert shapes == [(2, 2), (3, 2), (2, 512)]
        assert some.ram is None and some.final_sound is None
        some.rewards[:] = 99
        assert made.rewards.tolist() == [0, 99, 99, 3]
