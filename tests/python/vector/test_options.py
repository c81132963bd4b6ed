"""Options of a vector at their limits, and what the emulator receives of them."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from gymnasium.vector import AutoresetMode
from racebeam import VectorOptions
from racebeam.arguments import WrongType, WrongValue
from racebeam.vector_options import autoreset_of

MOST = 2**31 - 1
LIMITS = {
    "num_envs": (1, 10**7),
    "num_threads": (0, MOST),
    "thread_affinity_offset": (-1, MOST),
    "frameskip": (1, 1000),
    "max_num_frames_per_episode": (0, MOST),
    "noop_max": (0, 1000),
    "stack_num": (1, 16),
    "img_width": (0, 1000),
    "img_height": (0, 1000),
    "seed": (0, 2**32 - 1),
    "mode": (0, MOST),
    "difficulty": (0, MOST),
}


class TestLimits:
    @pytest.mark.parametrize("name", LIMITS)
    def test_whole_numbers_are_taken_up_to_their_limits(self, name):
        low, high = LIMITS[name]
        for value in (low, high):
            assert getattr(VectorOptions(**{name: value}), name) == value
        for value in (low - 1, high + 1):
            with pytest.raises(WrongValue, match=f"^{name} is {value}; it takes {low} to {high}"):
                VectorOptions(**{name: value})

    def test_a_batch_has_some_or_all_environments(self):
        assert [VectorOptions(3, batch_size=size).batch_size for size in (0, 1, 3)] == [3, 1, 3]
        assert [VectorOptions(3, batch_size=size).is_sync for size in (0, 2, 3)] == [True, False, True]
        for size in (-1, 4):
            with pytest.raises(WrongValue, match=f"batch_size is {size}; it takes 0 to 3"):
                VectorOptions(3, batch_size=size)
        assert VectorOptions(3).with_changes(5).batch_size == 5
        assert VectorOptions(3, batch_size=2).with_changes(5).batch_size == 2

    def test_flags_are_truth_values(self):
        for name in ("continuous", "reward_clipping", "maxpool", "use_fire_reset", "grayscale"):
            assert [getattr(VectorOptions(**{name: value}), name) for value in (1, 0)] == [True, False]
            assert type(getattr(VectorOptions(**{name: 1}), name)) is bool
            with pytest.raises(WrongType, match=f"^{name} is "):
                VectorOptions(**{name: np.ones(2)})

    def test_an_autoreset_has_a_name_and_a_value(self):
        for word in (AutoresetMode.SAME_STEP, "SAME_STEP", AutoresetMode.SAME_STEP.value):
            assert autoreset_of(word) is AutoresetMode.SAME_STEP
        for wrong, kind in (("same_step", WrongValue), (None, WrongType), (1, WrongType)):
            with pytest.raises(kind, match="^autoreset_mode is "):
                autoreset_of(wrong)


class TestLives:
    def life_loss(self, **arguments):
        return VectorOptions.of_preset("ale", **arguments).life_loss

    def test_flags_mean_words_and_the_stronger_one_counts(self):
        assert self.life_loss() == "ignored"
        assert self.life_loss(life_loss_info=True) == "reported"
        assert self.life_loss(episodic_life=True) == "restart"
        assert self.life_loss(life_loss_info=True, episodic_life=True) == "restart"
        assert self.life_loss(life_loss_info=False, life_loss="end") == "end"
        assert self.life_loss(life_loss_info=True, life_loss="reported") == "reported"
        for name, word in (("life_loss_info", "restart"), ("episodic_life", "reported")):
            with pytest.raises(WrongValue, match=f"{name} is True, which means life_loss="):
                self.life_loss(**{name: True}, life_loss=word)
        with pytest.raises(WrongType, match="life_loss_info is "):
            self.life_loss(life_loss_info=np.ones(2))

    def test_the_old_name_is_taken(self):
        for old, word in (("told", "reported"), ("end", "end")):
            with pytest.warns(DeprecationWarning, match="lives is the old name of life_loss"):
                assert self.life_loss(lives=old) == word


class TestCore:
    def core(self, **arguments):
        return VectorOptions(**{"num_envs": 3, "seed": 5, **arguments})._core_settings()

    def test_numbers_reach_the_emulator(self):
        core = self.core(frameskip=2, noop_max=7, max_num_frames_per_episode=99, thread_affinity_offset=4, rows=11)
        assert (core.seed, core.frame_skip, core.noop_max, core.max_episode_frames) == (5, 2, 7, 99)
        assert (core.first_processor, core.rows, core.batch_size) == (4, 11, 3)
        assert (core.mode, core.difficulty) == (None, None)

    def test_rewards_are_clipped_to_1_or_not_at_all(self):
        assert (self.core().reward_min, self.core().reward_max) == (-1, 1)
        core = self.core(reward_clipping=False)
        assert (core.reward_min, core.reward_max) == (-(2**31), 2**31 - 1)

    def test_screens_are_stacked_unless_the_ram_is_observed(self):
        for arguments, found in (
            ({}, (4, 84, 84, False)),
            ({"grayscale": False, "stack_num": 1, "img_width": 10, "img_height": 20}, (1, 10, 20, True)),
            ({"obs_type": "rgb"}, (4, 0, 0, True)),
            ({"obs_type": "grayscale", "grayscale": False}, (4, 0, 0, False)),
            ({"obs_type": "ram"}, (0, 0, 0, False)),
        ):
            core = self.core(**arguments)
            assert (core.stack, core.width, core.height, core.rgb) == found

    def test_threads_are_not_more_than_environments_nor_than_1024(self):
        for envs, threads, found in ((3, 2, 2), (3, 4, 3), (3, 0, 0), (5000, 1025, 1024), (5000, 1024, 1024)):
            assert self.core(num_envs=envs, num_threads=threads).threads == found

    def test_sound_and_screens_are_made_if_they_are_shown(self):
        for sound, found in ((False, (False, False)), (True, (True, False)), ("all", (True, True))):
            core = self.core(sound_obs=sound)
            assert (core.sound, core.all_audio) == found
        assert [self.core(render_mode=mode).screens for mode in (None, "human", "rgb_array")] == [False, True, True]
