"""AtariVectorEnv: seeds, and how episodes begin and end."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from gymnasium.error import Error
from gymnasium.vector import AutoresetMode, VectorEnv
from racebeam import AtariVectorEnv, InvalidInput, ale_py
from vectors import SHORT, play, same


class TestSeeds:
    def test_a_seed_decides_everything(self):
        envs = AtariVectorEnv("beamfall", 3, repeat_action_probability=0.25)
        results = [
            (envs.reset(seed=seed), *play(envs, 30)) for seed in (3, np.int64(3), [3, 4, 5], np.array([3, 4, 6]))
        ]
        assert same(results[0], results[1]) and same(results[0], results[2])
        last, other = results[0][-1][0], results[3][-1][0]
        assert np.array_equal(last[:2], other[:2])
        assert not np.array_equal(last[2], other[2])

    def test_the_seed_of_the_constructor_is_that_of_a_reset(self):
        envs, others = AtariVectorEnv("beamfall", 2, seed=9), AtariVectorEnv("beamfall", 2)
        others.reset(seed=9)
        assert same(play(envs, 10), play(others, 10))

    def test_the_first_reset_has_the_seed_of_the_constructor(self):
        for settings in ({}, {"repeat_action_probability": 0.5, "noop_max": 30}):
            envs, others = AtariVectorEnv("beamfall", 2, seed=3, **settings), AtariVectorEnv("beamfall", 2, **settings)
            assert same([envs.reset()], [others.reset(seed=3)])
            assert not same([envs.reset(), envs.reset()], [others.reset(seed=3), others.reset(seed=3)])
        seen, info = AtariVectorEnv("beamfall", 2, batch_size=1, seed=3, **settings).reset()
        assert np.array_equal(seen, others.reset(seed=3)[0][info["env_id"]])

    def test_a_seed_of_the_constructor_ends_with_the_first_call_that_plays(self):
        for play_once in (
            lambda envs: envs.step([0, 0]),
            lambda envs: (envs.send([0, 0]), envs.recv()),
            lambda envs: envs.restore(0, envs.save(1)),
        ):
            envs = AtariVectorEnv("beamfall", 2, seed=3)
            begin = envs.show()[1]["frame_number"]
            play_once(envs)
            assert (envs.reset()[1]["frame_number"] > begin).all()

    def test_some_have_seeds_and_some_do_not(self):
        envs = AtariVectorEnv("beamfall", 3, repeat_action_probability=0.5)
        envs.reset(seed=[5, 5, 5])
        play(envs, 10)
        frames = envs.reset(seed=[5, None, -1])[1]["frame_number"]
        assert frames[0] < 40
        assert (frames[1:] >= 40).all()


class TestEpisodes:
    def test_the_modes_of_autoreset(self):
        for mode in ("NextStep", "SAME_STEP", AutoresetMode.DISABLED):
            envs = AtariVectorEnv("beamfall", 2, autoreset_mode=mode, **SHORT)
            envs.reset(seed=2)
            results = play(envs, 5)
            kind = envs.metadata["autoreset_mode"]
            assert isinstance(kind, AutoresetMode)
            assert [int(one[3][0]) for one in results] == [
                0,
                0,
                1,
                *{AutoresetMode.NEXT_STEP: (0, 0), AutoresetMode.SAME_STEP: (0, 0), AutoresetMode.DISABLED: (1, 1)}[
                    kind
                ],
            ]
            frames = [int(one[4]["episode_frame_number"][0]) for one in results]
            assert (frames[3] == frames[2]) == (kind is AutoresetMode.DISABLED)
            assert ("final_obs" in results[2][4]) == (kind is AutoresetMode.SAME_STEP)
            assert not any("final_obs" in results[step][4] for step in (0, 1, 3, 4))
        assert "autoreset_mode" not in VectorEnv.metadata

    def test_final_observations_are_those_of_the_episode_that_ended(self):
        for kind in (None, "ram"):
            envs, others = (
                AtariVectorEnv(
                    "beamfall", 3, autoreset_mode=mode, obs_type=kind, noop_max=20, max_num_frames_per_episode=40
                )
                for mode in ("SameStep", "Disabled")
            )
            envs.reset(seed=2)
            others.reset(seed=2)
            for (_, _, _, truncated, info), (seen, *_, expected) in zip(play(envs, 10), play(others, 10)):
                assert ("final_obs" in info) == truncated.any()
                if not truncated.any():
                    continue
                assert np.array_equal(info["_final_obs"], truncated) and np.array_equal(info["_final_info"], truncated)
                assert info["final_obs"].dtype == object
                for env in range(3):
                    if not truncated[env]:
                        assert info["final_obs"][env] is None
                        continue
                    assert np.array_equal(info["final_obs"][env], seen[env])
                    for key in ("lives", "frame_number", "episode_frame_number"):
                        assert info["final_info"][key][env] == expected[key][env]
                        assert info["final_info"][f"_{key}"][env]

    def test_final_observations_have_the_sound_of_the_episode_that_ended(self):
        for theirs in (AtariVectorEnv, ale_py.AtariVectorEnv):
            settings = {"sound_obs": True, "noop_max": 20, "max_num_frames_per_episode": 40}
            envs = theirs("beamfall", 3, autoreset_mode="SameStep", **settings)
            others = AtariVectorEnv("beamfall", 3, autoreset_mode="Disabled", **settings)
            envs.reset(seed=2)
            others.reset(seed=2)
            for (_, _, _, truncated, info), (seen, *_) in zip(play(envs, 10), play(others, 10)):
                for env in np.flatnonzero(truncated):
                    finals = info["final_obs"]
                    final = finals[env] if theirs is AtariVectorEnv else {key: finals[key][env] for key in finals}
                    assert all(np.array_equal(final[key], seen[key][env]) for key in seen)
            assert truncated.any()

    def test_a_reset_of_some(self):
        envs = AtariVectorEnv("beamfall", 3, autoreset_mode="Disabled", noop_max=0)
        envs.reset(seed=1)
        before = play(envs, 5)[-1][0]
        seen, info = envs.reset(options={"reset_mask": np.array([True, False, False])})
        assert [frames < 5 for frames in info["episode_frame_number"]] == [True, False, False]
        assert np.array_equal(seen[1:], before[1:])
        assert not np.array_equal(seen[0], before[0])

    def test_the_info_has_unclipped_rewards_and_true_ends(self):
        envs = AtariVectorEnv("beamfall", 2, frameskip=60, life_loss="end")
        envs.reset(seed=1)
        results = [envs.step([1, 1]) for _ in range(60)]
        raw = np.array([one[4]["raw_reward"] for one in results])
        assert np.array_equal(np.clip(raw, -1, 1), [one[1] for one in results])
        assert raw.max() > 1
        ends, games = (np.array(one) for one in zip(*((one[2], one[4]["game_over"]) for one in results)))
        assert games.sum() > 0
        assert ends.sum() > games.sum()

    def test_the_effects_of_a_lost_life(self):
        frames = {}
        for lives in ("ignored", "reported", "end", "restart"):
            envs = AtariVectorEnv("beamfall", 1, frameskip=60, life_loss=lives, noop_max=0)
            envs.reset(seed=1)
            results = [envs.step([1]) for _ in range(40)]
            first = next(step for step, one in enumerate(results) if one[2][0])
            frames[lives] = [int(one[4]["lives"][0]) for one in results[first : first + 2]]
        assert {lives: after for lives, (_, after) in frames.items()} == {
            "ignored": 4,
            "reported": 3,
            "end": 3,
            "restart": 4,
        }

    def test_presets(self):
        envs = AtariVectorEnv("updraft", 1, preset="paper2013")
        envs.reset(seed=1)
        assert (envs.single_action_space.n, AtariVectorEnv("updraft", 1).single_action_space.n) == (18, 6)
        assert int(envs.step([0])[4]["episode_frame_number"][0]) == 5
        with pytest.raises(InvalidInput, match="preset 'dqn'"):
            AtariVectorEnv("beamfall", 1, preset="dqn")

    def test_several_games(self):
        envs = AtariVectorEnv(["beamfall", "updraft", "beamfall"], full_action_space=True, seed=1)
        single = AtariVectorEnv("updraft", 3, full_action_space=True, seed=1)
        together, expected = play(envs, 10), play(single, 10)
        assert all(np.array_equal(one[0][1], other[0][1]) for one, other in zip(together, expected))
        assert not np.array_equal(together[-1][0][0], together[-1][0][1])
        for arguments in ((["beamfall", "updraft"], 3), ([],)):
            with pytest.raises(Error):
                AtariVectorEnv(*arguments)
        with pytest.raises(Error, match="^there are 2 games"):
            AtariVectorEnv(["beamfall", "updraft"], rom=b"", full_action_space=True)
