"""AtariVectorEnv: states of its environments, saved and restored."""

import copy
import pickle

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from racebeam import AtariVectorEnv, InvalidInput
from vectors import play, same


class TestStates:
    def test_an_image_is_given_as_bytes_of_any_kind(self):
        image = (package.SOURCE / "games/homebrew/beamfall.bin").read_bytes()
        results = [
            AtariVectorEnv("beamfall", 1, rom=rom).reset(seed=1)[0]
            for rom in (image, bytearray(image), memoryview(image))
        ]
        assert np.array_equal(results[0], results[1]) and np.array_equal(results[0], results[2])
        with pytest.raises(TypeError, match="^rom .* int"):
            AtariVectorEnv("beamfall", 1, rom=3)

    def test_one_environment_returns_to_a_state(self):
        envs = AtariVectorEnv("beamfall", 2, repeat_action_probability=0.25, seed=1)
        before = play(envs, 10)[-1][0]
        state = envs.save(1)
        first = play(envs, 20)
        envs.restore(1, state)
        observations = envs.show()[0]
        assert np.array_equal(observations[1], before[1]) and np.array_equal(observations[0], first[-1][0][0])
        second = play(envs, 20)
        assert all(
            np.array_equal(one[0][1], other[0][1]) and one[1][1] == other[1][1] for one, other in zip(first, second)
        )
        assert not np.array_equal(first[-1][0][0], second[-1][0][0])

    def test_a_state_goes_to_another_environment_but_not_to_another_game(self):
        envs, others = AtariVectorEnv("beamfall", 2, seed=1), AtariVectorEnv("updraft", 1)
        play(envs, 10)
        envs.restore(0, envs.save(1))
        first = envs.show()[0]
        assert np.array_equal(first[0], first[1])
        with pytest.raises(InvalidInput):
            others.restore(0, envs.save(0))
        with pytest.raises(IndexError):
            envs.save(2)
        with pytest.raises(IndexError):
            envs.restore(-1, envs.save(0))
        with pytest.raises(TypeError):
            envs.restore(0, None)

    def test_later_episodes_are_the_same(self, subtests):
        for mode in ("NextStep", "SameStep", "Disabled"):
            for sticky in (0.0, 0.25):
                envs = AtariVectorEnv(
                    "beamfall",
                    2,
                    autoreset_mode=mode,
                    repeat_action_probability=sticky,
                    max_num_frames_per_episode=100,
                    seed=1,
                )
                play(envs, 33)
                states = [envs.save(env) for env in range(2)]

                def on():
                    results = []
                    for step in range(100):
                        results.append(envs.step([step % 4, 1]))
                        ends = results[-1][2] | results[-1][3]
                        if mode == "Disabled" and ends.any():
                            observations, info = envs.reset(options={"reset_mask": ends})
                            results.append((observations, info))
                    return results

                first = on()
                for env in range(2):
                    envs.restore(env, states[env])
                second = on()
                with subtests.test(mode=mode, sticky=sticky):
                    lengths = {int(one[-1]["frame_number"][0]) for one in first}
                    assert len(lengths) > 50
                    assert all(
                        np.array_equal(a[0], b[0]) and np.array_equal(a[-1]["frame_number"], b[-1]["frame_number"])
                        for a, b in zip(first, second)
                    )

    def test_a_state_of_other_screens_is_refused(self, subtests):
        envs = AtariVectorEnv("beamfall", 1, seed=1)
        before = play(envs, 5)[-1][0]
        for settings, sentence in (
            ({"stack_num": 2}, "stack of 2 .* stack of 4"),
            ({"img_height": 50}, "84 x 50"),
            ({"img_width": 42, "img_height": 168}, "42 x 168"),
            ({"grayscale": False}, "4 colour screens"),
            ({"obs_type": "ram"}, "no stack of screens"),
        ):
            with subtests.test(**settings), pytest.raises(InvalidInput, match=sentence):
                envs.restore(0, AtariVectorEnv("beamfall", 1, seed=9, **settings).save(0))
        assert np.array_equal(envs.show()[0], before)

    def test_a_state_is_pickled_and_copied(self, subtests):
        for settings in (
            {},
            {"obs_type": "ram"},
            {"life_loss": "end", "grayscale": False},
            {"noop_max": 7, "rules": "fixed"},
        ):
            envs = AtariVectorEnv("beamfall", 1, seed=1, max_num_frames_per_episode=90, **settings)
            play(envs, 10)
            state = envs.save(0)
            expected = play(envs, 60)
            others = AtariVectorEnv("beamfall", 1, seed=2, max_num_frames_per_episode=90, **settings)
            for copied in (
                pickle.loads(pickle.dumps(state)),
                copy.deepcopy(state),
                pickle.loads(pickle.dumps(copy.copy(state))),
            ):
                others.restore(0, copied)
                with subtests.test(**settings):
                    assert same(play(others, 60), expected)
            envs.close()
            del envs
            assert pickle.dumps(state) == pickle.dumps(copied)

    def test_pickled_bytes_that_were_altered_are_refused(self):
        envs, others = AtariVectorEnv("beamfall", 1, seed=1), AtariVectorEnv("updraft", 1)
        state = envs.save(0).__getstate__()
        kind = type(envs.save(0))

        def restored(data):
            copied = kind.__new__(kind)
            copied.__setstate__(data)
            envs.restore(0, copied)

        restored(state)
        for wrong in (
            b"",
            b"x" * 100,
            state[:-1],
            state + b"x",
            state[:500] + b"\0\1\2" + state[503:],
            state[:8] + b"\7" + state[9:],
        ):
            with pytest.raises(InvalidInput):
                restored(wrong)
        with pytest.raises(TypeError):
            restored(3)
        with pytest.raises(InvalidInput, match="^the state "):
            others.restore(0, pickle.loads(pickle.dumps(envs.save(0))))

    def test_environments_say_how_they_are_carried(self):
        envs = AtariVectorEnv("beamfall", 1)
        for carry in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(TypeError, match="^AtariVectorEnv "):
                carry(envs)
