"""AtariEnv: seeds, states, copies, presets and rules."""

import copy
import pickle

import package
import pytest

package.require("gymnasium", "numpy")

import gymnasium as gym
import numpy as np
import racebeam


def play(env, actions):
    """What some steps show, as comparable values."""
    return [(step[0].tobytes(), *step[1:]) for step in (env.step(action) for action in actions)]


class TestPlaying:
    @pytest.fixture(autouse=True)
    def set_up(self):
        self.env = racebeam.AtariEnv("beamfall")
        self.env.reset(seed=11)
        self.actions = [int(action) for action in np.random.default_rng(5).integers(18, size=200)]

    def test_the_same_seed_is_the_same_game_and_another_is_not(self):
        first = play(self.env, self.actions)
        self.env.reset(seed=11)
        assert play(self.env, self.actions) == first
        self.env.reset(seed=12)
        assert play(self.env, self.actions) != first

    def test_actions_of_the_console(self):
        env = racebeam.AtariEnv("beamfall", full_action_space="console", repeat_action_probability=0, frameskip=1)
        names = env.get_action_meanings()
        assert names[18:] == ["RESET", "SELECT", "LEFT_A", "LEFT_B", "RIGHT_A", "RIGHT_B", "COLOR", "BW"]
        assert env.action_space == gym.spaces.Discrete(26)
        assert len(env.get_keys_to_action()) == 18
        env.reset(seed=1)
        at_rest = env.state_hash
        play(env, [names.index("BW"), 0])
        assert env.state_hash != at_rest
        env.reset(seed=1)
        assert env.state_hash == at_rest
        env.ale.act(racebeam.ConsoleAction.BW)
        with pytest.raises(racebeam.InvalidInput, match="0 to 17"):
            env.ale.act(25)
        with pytest.raises(ValueError, match="it takes True, False or 'console'"):
            racebeam.AtariEnv("beamfall", full_action_space="all")
        with pytest.raises(ValueError, match="an action moves a joystick, not a switch"):
            racebeam.AtariEnv("beamfall", full_action_space="console", continuous=True)

    def test_actions_of_other_controllers(self, subtests):
        settings = {"full_action_space": "console", "repeat_action_probability": 0, "frameskip": 1}
        for left, count, first, last in (
            ("keyboard", 38, "KEY1", "KEYHASH"),
            ("genesis", 44, "NOOP+C", "DOWNLEFTFIRE+C"),
            ("booster", 80, "NOOP+TRIGGER", "DOWNLEFTFIRE+TRIGGER+BOOSTER"),
        ):
            with subtests.test(left=left):
                env = racebeam.AtariEnv("beamfall", left=left, **settings)
                assert env.action_space == gym.spaces.Discrete(count)
                assert len(set(env.get_action_meanings())) == count
                assert env.get_action_meanings()[26] == first
                assert env.get_action_meanings()[-1] == last
                assert len(env.get_keys_to_action()) == 18
                assert env.ale.getControllers() == (left, "joystick")
                hashes = set()
                for action in range(26, count):
                    env.reset(seed=1)
                    play(env, [action])
                    hashes.add(env.state_hash)
                assert len(hashes) == count - 26
                assert env.ale.act(env._action_set[-1]) == 0
                with pytest.raises(racebeam.InvalidInput, match="those of the left controller"):
                    self.env.ale.act(env._action_set[-1])

    def test_the_switches_are_those_of_player_a(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        env = racebeam.AtariEnv("pong", full_action_space="console", two_player=True)
        env.reset(seed=1)
        assert env.action_space == gym.spaces.MultiDiscrete([26, 18])
        env.step((18, 17))
        with pytest.raises(IndexError, match="accepted: 0 to 17"):
            env.step((0, 18))
        env = racebeam.AtariEnv("pong", full_action_space="console", two_player=True, right="keyboard", left="genesis")
        assert env.action_space == gym.spaces.MultiDiscrete([44, 30])
        env.reset(seed=1)
        before = env.clone_state()
        env.step((43, 29))
        pressed = env.state_hash
        env.restore_state(before)
        env.step((43, 28))
        assert env.state_hash != pressed

    def test_all_the_sound_of_a_step(self):
        every = racebeam.AtariEnv("beamfall", frameskip=1, sound_obs=True)
        skipping = racebeam.AtariEnv("beamfall", frameskip=3, sound_obs="all")
        assert skipping.observation_space["sound"].shape == (3 * 512,)
        for env in (every, skipping):
            env.reset(seed=3)
        for action in self.actions[:50]:
            expected = np.concatenate([every.step(action)[0]["sound"] for _ in range(3)])
            assert skipping.step(action)[0]["sound"].tobytes() == expected.tobytes()
        ranged = racebeam.AtariEnv("beamfall", frameskip=(2, 5), sound_obs="all")
        assert (ranged.reset(seed=1)[0]["sound"] == 128).all()
        assert ranged.step(1)[0] in ranged.observation_space
        with pytest.raises(ValueError, match="it takes True, False or 'all'"):
            racebeam.AtariEnv("pong", sound_obs="last")

    def test_a_restored_state_shows_what_it_showed(self):
        play(self.env, self.actions[:20])
        seen, ram, info = self.env.ale.getScreenRGB(), self.env.ale.getRAM(), self.env._get_info()
        state = self.env.clone_state(include_rng=True)
        first = play(self.env, self.actions)
        self.env.restore_state(state)
        assert self.env.ale.getScreenRGB().tobytes() == seen.tobytes()
        assert self.env.ale.getRAM().tobytes() == ram.tobytes()
        assert self.env._get_info() == info
        assert play(self.env, self.actions) == first

    def test_a_state_as_bytes_goes_to_another_environment(self):
        play(self.env, self.actions[:20])
        state = racebeam.ALEState(self.env.clone_state(include_rng=True).serialize())
        first = play(self.env, self.actions)
        other = racebeam.AtariEnv("beamfall")
        other.reset(seed=99)
        other.restore_state(pickle.loads(pickle.dumps(state)))
        assert play(other, self.actions) == first

    def test_copies_go_on_where_the_game_is(self):
        play(self.env, self.actions[:30])
        self.env.action_space.seed(3)
        copies = [
            copy.deepcopy(self.env),
            pickle.loads(pickle.dumps(self.env)),
            pickle.loads(pickle.dumps(gym.make("racebeam/Updraft-v5", frameskip=(2, 5)))),
        ]
        first = play(self.env, self.actions), self.env.action_space.sample()
        for env in copies[:2]:
            assert (play(env, self.actions), env.action_space.sample()) == first
        assert play(copies[0].reset(seed=11) and copies[0], self.actions) == play(
            self.env.reset(seed=11) and self.env, self.actions
        )

    def test_a_copy_draws_the_same_frameskips(self):
        env = racebeam.AtariEnv("updraft", frameskip=(2, 9))
        env.reset(seed=1)
        actions = [action % env.action_space.n for action in self.actions]
        assert play(copy.deepcopy(env), actions) == play(env, actions)

    def test_observations_belong_to_the_caller(self):
        first = self.env.step(0)[0]
        before = first.copy()
        play(self.env, self.actions[:20])
        assert np.array_equal(first, before)
        first[:] = 7
        assert not np.array_equal(self.env.ale.getScreenRGB(), first)

    def test_two_players_are_both_rewarded(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        env = racebeam.AtariEnv("pong", two_player=True, frameskip=8)
        env.reset(seed=1)
        assert env.action_space.nvec.tolist() == [6, 6]
        assert env.ale.getMode() in env.ale.getTwoPlayerModes()
        rewards = []
        for _ in range(400):
            _, reward, _, _, info = env.step((1, 2))
            assert info["reward_a"] == reward
            rewards.append((info["reward_a"], info["reward_b"]))
        assert [b for _, b in rewards] == [-a for a, _ in rewards]
        assert any(a for a, _ in rewards)

    def test_player_b_moves(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        screens = []
        for b in (2, 3):
            env = racebeam.AtariEnv("pong", two_player=True, repeat_action_probability=0.0)
            env.reset(seed=1)
            for _ in range(30):
                observation = env.step((0, b))[0]
            screens.append(observation.tobytes())
        assert screens[0] != screens[1]

    def test_a_mode_for_two_needs_two_players(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        with pytest.raises(racebeam.InvalidInput, match="pong has mode 5 only for two.*for one it offers 0, 1$"):
            racebeam.AtariEnv("pong", mode=5)
        assert racebeam.AtariEnv("pong", mode=5, two_player=True).ale.getMode() == 5

    def test_presets_are_the_settings_of_the_literature(self):
        def settings(**arguments):
            env = racebeam.AtariEnv("updraft", **arguments)  # 6 of its 18 actions have an effect
            ale = env.ale
            return (
                env._frameskip,
                ale.getFloat("repeat_action_probability"),
                env.action_space.n,
                ale.getInt("max_num_frames_per_episode"),
                ale.getBool("truncate_on_loss_of_life"),
                env._noop_max,
                env._reward_range,
            )

        assert settings() == (4, 0.25, 6, 0, False, 0, None)
        assert settings(preset="paper2013") == (5, 0.0, 18, 18000, False, 0, None)
        assert settings(preset="dqn2015") == (4, 0.0, 6, 18000, True, 30, (-1, 1))
        assert settings(preset="gym-v5") == (4, 0.25, 6, 108000, False, 0, None)
        assert settings(preset="machado2018", frameskip=3) == (3, 0.25, 18, 18000, False, 0, None)

    @pytest.mark.needs_program
    def test_presets_are_those_of_the_line_protocol(self):
        with racebeam.launch() as session:
            for name in ("paper2013", "dqn2015", "machado2018", "gym-v5"):
                settings = session.load("beamfall", preset=name)
                env = racebeam.AtariEnv("beamfall", preset=name)
                low, high = env._reward_range or ("none", "none")
                assert (
                    settings["frame_skip"],
                    settings["sticky"],
                    settings["max_episode_frames"],
                    settings["life_loss"],
                    settings["noop_max"],
                    settings["reward_min"],
                    settings["reward_max"],
                ) == (
                    env._frameskip,
                    env.ale.getFloat("repeat_action_probability"),
                    env.ale.getInt("max_num_frames_per_episode"),
                    env._life_loss.word,
                    env._noop_max,
                    low,
                    high,
                ), name

    def test_a_lost_life_ends_the_episode_of_dqn_and_rewards_are_clipped(self):
        env = racebeam.AtariEnv("beamfall", preset="dqn2015")
        _, info = env.reset(seed=3)
        rewards, terminated = set(), False
        while not terminated:
            _, reward, terminated, truncated, after = env.step(1)
            rewards.add(reward)
            assert not truncated
        assert after["lives"] == info["lives"] - 1
        assert rewards == {0.0, 1.0}

    def test_a_lost_life_has_the_effect_that_was_chosen(self):
        def after_loss(**arguments):
            env = racebeam.AtariEnv("beamfall", frameskip=20, repeat_action_probability=0.0, **arguments)
            _, info = env.reset(seed=3)
            lives = now = info["lives"]
            while now == lives:
                *_, terminated, truncated, info = env.step(1)
                now = info["lives"]
            return terminated, truncated, env.reset()[1]["lives"] - lives

        assert after_loss() == (False, False, 0)
        assert after_loss(life_loss="reported") == (True, False, 0)
        assert after_loss(life_loss="end") == (True, False, -1)
        assert after_loss(life_loss="restart") == (True, False, 0)
        with pytest.warns(DeprecationWarning, match="life_loss_ends is the old name of life_loss"):
            assert after_loss(life_loss_ends=True) == (False, True, 0)

    def test_the_first_frames_of_dqn_differ(self):
        env = racebeam.AtariEnv("beamfall", preset="dqn2015")
        begins = {env.reset(seed=seed)[1]["episode_frame_number"] for seed in range(40)}
        assert len(begins) > 10
        assert (min(begins) >= 0, max(begins) <= 29) == (True, True)

    def test_fixed_rules_are_a_choice(self):
        assert racebeam.AtariEnv("beamfall", rules="fixed").ale.getString("rules") == "fixed"
        with pytest.raises(racebeam.InvalidInput, match="it takes ale-0.12 or fixed"):
            racebeam.AtariEnv("beamfall", rules="mended")

    def test_sound_is_heard(self):
        env = racebeam.AtariEnv("beamfall", sound_obs=True)
        env.reset(seed=1)
        sounds = {env.step(1)[0]["sound"].tobytes() for _ in range(40)}
        assert len(sounds) > 3

    def test_a_long_step_is_one_step(self):
        whole, parts = (racebeam.AtariEnv("beamfall", frameskip=frames) for frames in (5000, 1))
        whole.reset(seed=2)
        parts.reset(seed=2)
        result = whole.step(1)
        reward = sum(parts.step(1)[1] for _ in range(5000))
        assert (result[0].tobytes(), result[1], result[4]) == (
            parts.ale.getScreenRGB().tobytes(),
            reward,
            parts._get_info(),
        )
