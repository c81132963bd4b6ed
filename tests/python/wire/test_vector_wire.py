"""AtariVectorEnv(server=...) plays what AtariVectorEnv plays, and a server that goes away is an exception."""

import os
import pickle
import select
import threading
import unittest
import unittest.mock

import package
import pytest

package.require("gymnasium", "numpy")

import gymnasium
import numpy as np
from racebeam import AtariVectorEnv, InvalidInput
from racebeam.wire.last_reply import LastReply
from vector_servers import Compared, server

pytestmark = pytest.mark.needs_program

SETTINGS = (
    {},
    {
        "obs_type": "ram",
        "autoreset_mode": "SameStep",
        "max_num_frames_per_episode": 40,
        "repeat_action_probability": 0.25,
    },
    {
        "grayscale": False,
        "img_height": 40,
        "img_width": 51,
        "stack_num": 2,
        "autoreset_mode": "SameStep",
        "max_num_frames_per_episode": 41,
    },
    {
        "obs_type": "grayscale",
        "stack_num": 1,
        "life_loss": "end",
        "frameskip": 30,
        "reward_clipping": False,
        "full_action_space": True,
    },
    {
        "continuous": True,
        "continuous_action_threshold": 0.3,
        "difficulty": 1,
        "start": "baselines",
        "stack_start": "repeats",
    },
    {"preset": "dqn2015", "autoreset_mode": "Disabled", "maxpool": False, "frameskip": 60, "rules": "fixed"},
    {"full_action_space": "console", "repeat_action_probability": 0.25},
    {
        "left": "paddles",
        "right": "keyboard",
        "scheme": "2K",
        "format": "pal",
        "ystart": 40,
        "height": 220,
        "obs_type": "rgb",
    },
    {"use_fire_reset": False, "start": "fire-noops", "life_loss": "reported", "frameskip": 60, "seed": 0},
)


def both(address, game="beamfall", count=3, **settings):
    return [AtariVectorEnv(game, count, server=where, **settings) for where in (None, address)]


class TestSame(Compared):
    def test_observations_and_infos(self, subtests):
        ends = 0
        with server() as (address, _):
            for settings in SETTINGS:
                with subtests.test(**settings):
                    here, there = both(address, **{"seed": 5, **settings})
                    assert (there.observation_space, there.action_space) == (here.observation_space, here.action_space)
                    ends += self.play(here, there, 10)
                    self.check(there.reset(seed=9), here.reset(seed=9))
                    ends += self.play(here, there, 40)
                    there.close()
        assert ends > 50

    def test_resets_of_some_and_seeds_of_each(self, subtests):
        with server() as (address, _):
            here, there = both(address, count=4, seed=1, repeat_action_probability=0.25)
            mask = np.array([True, False, False, True])
            for arguments in (
                {"seed": [7, 8, 3, 2**32 - 1]},
                {"options": {"reset_mask": mask}},
                {"options": {"reset_mask": mask & False}},
                {"seed": [1, None, -1, 9]},
                {"seed": 2**32 - 2, "options": {"reset_mask": mask}},
                {},
            ):
                with subtests.test(**arguments):
                    self.check(there.reset(**arguments), here.reset(**arguments))
                    self.play(here, there, 5)

    def test_a_reply_without_ends_is_read_as_a_whole(self, subtests):
        with (
            server() as (address, _),
            unittest.mock.patch.object(LastReply, "_fill_each", side_effect=AssertionError),
        ):
            for settings in (
                {},
                {"obs_type": "ram", "autoreset_mode": "SameStep"},
                {"grayscale": False, "stack_num": 2},
            ):
                with subtests.test(**settings):
                    here, there = both(address, seed=5, **settings)
                    self.play(here, there, 5)

    def test_pictures(self):
        with server() as (address, _):
            here, there = both(address, seed=1, render_mode="rgb_array")
            self.play(here, there, 5)
            assert all(map(np.array_equal, there.render(), here.render()))
            self.check(there.show(), here.show())

    def test_an_image_that_only_the_client_has_is_sent(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        with server() as (address, _):
            here, there = both(address, "pong", mode=1, difficulty=2, seed=3)
            self.play(here, there, 30)


class TestHalves(Compared):
    def halves(self, envs, actions):
        envs.send(actions)
        return envs.recv()

    def test_a_step_in_two_halves_is_a_step(self, subtests):
        with server() as (address, _):
            for settings in ({}, SETTINGS[1], SETTINGS[4]):
                with subtests.test(**settings):
                    here, there = both(address, **{"seed": 5, **settings})
                    here.action_space.seed(1)
                    for _ in range(30):
                        actions = here.action_space.sample()
                        expected = self.halves(here, actions)
                        self.check(self.halves(there, actions), expected)

    def test_the_server_plays_between_the_halves(self):
        with server() as (address, _):
            envs = AtariVectorEnv("beamfall", 3, seed=1, server=address)
            replies = envs._open_machines()._session._reader.connection
            assert select.select([replies], [], [], 0)[0] == []
            envs.send([1, 1, 1])
            assert select.select([replies], [], [], 60)[0] == [replies]
            envs.recv()

    def test_resets_in_two_halves(self):
        with server() as (address, _):
            here, there = both(address, seed=5)
            for seeds in ([3, 9, -1], None, [4, 5, 6]):
                for envs in (here, there):
                    envs._open_machines().send_resets(None if seeds is None else np.array(seeds))
                self.check(there.recv(), here.recv())
                self.play(here, there, 3)

    def test_nothing_else_is_possible_between_the_halves(self):
        with server() as (address, _):
            for envs in both(address, count=2, seed=1, render_mode="rgb_array"):
                envs.reset(seed=1)
                state = envs.save(0)
                envs.send([0, 0])
                for call in (
                    envs.show,
                    envs.render,
                    lambda: envs.save(0),
                    lambda: envs.restore(0, state),
                    lambda: envs.step([0, 0]),
                    lambda: envs.send([0, 0]),
                ):
                    with pytest.raises(InvalidInput, match="receive"):
                        call()
                assert envs.recv()[4]["frame_number"].shape == (2,)
                with pytest.raises(InvalidInput, match="0 environments play, and a receive takes 2; send some first"):
                    envs.recv()
                for actions in ([0, 99], [0]):
                    with pytest.raises((IndexError, InvalidInput)):
                        envs.send(actions)
                envs.step([0, 0])

    def test_a_reset_drops_what_was_not_received(self):
        with server() as (address, _):
            for where in (address, [address]):
                here, there = (AtariVectorEnv("beamfall", 3, server=place, seed=1) for place in (None, where))
                for seed in (1, None):
                    for envs in (here, there):
                        envs.send([1, 0, 1])
                    (seen, our_info), (expected, info) = there.reset(seed=seed), here.reset(seed=seed)
                    assert np.array_equal(seen, expected) and np.array_equal(
                        our_info["frame_number"], info["frame_number"]
                    )

    def test_a_server_that_dies_between_the_halves_is_a_ConnectionError(self):
        with server() as (address, process):
            envs = AtariVectorEnv("beamfall", 2, seed=1, server=address)
            envs.send([0, 0])
            process.kill()
            process.wait()
            for _ in range(2):
                with pytest.raises(ConnectionError):
                    while True:  # the first reply may have been there
                        self.halves(envs, [0, 0]) if envs._open_machines()._pending is None else envs.recv()


class TestStates(Compared):
    def test_a_state_moves_to_the_server_and_back(self, subtests):
        ends = 0
        with server() as (address, _):
            for settings in SETTINGS:
                with subtests.test(**settings):
                    here, there = both(
                        address, **{"seed": 5, "max_num_frames_per_episode": 90, **settings}, render_mode="rgb_array"
                    )
                    self.play(here, there, 10)
                    for one, other in ((here, there), (there, here)):
                        states = [one.save(env) for env in range(3)]
                        expected = [states[1], states[2], states[0]]
                        for env, state in enumerate(expected):
                            one.restore(env, state)
                            other.restore(env, pickle.loads(pickle.dumps(state)))
                        assert all(map(np.array_equal, there.render(), here.render()))
                        self.check(there.show(), here.show())
                        assert [there.save(env).__getstate__() for env in range(3)] == [
                            state.__getstate__() for state in expected
                        ]
                        ends += self.play(here, there, 30)
                    there.close()
        assert ends > 50

    def test_a_state_without_generators_keeps_those_that_are_there(self):
        with server() as (address, _):
            here, there = both(address, seed=1, repeat_action_probability=0.5)
            states = [envs.save(1, include_rng=False) for envs in (here, there)]
            assert states[0].__getstate__() == states[1].__getstate__()
            self.play(here, there, 20)
            for envs, state in zip((here, there), states):
                envs.restore(1, state)
            self.play(here, there, 20)

    def test_bad_states_are_refused_as_in_this_process(self, subtests):
        with server() as (address, _):
            here, there = both(address, count=2, seed=1)
            self.play(here, there, 5)
            other = AtariVectorEnv("beamfall", 1, stack_num=2).save(0)
            foreign = AtariVectorEnv("updraft", 1).save(0)
            for env, state, error, sentence in (
                (
                    0,
                    other,
                    InvalidInput,
                    "the state has a stack of 2 grey screens of 84 x 84; here, one has a stack of 4 grey screens",
                ),
                (0, foreign, InvalidInput, "the state is of the image"),
                (0, None, TypeError, ""),
                (2, here.save(0), IndexError, "environment 2 is out of range; accepted: 0 to 1"),
                (-1, here.save(0), IndexError, "environment -1 is out of range; accepted: 0 to 1"),
            ):
                for envs in (here, there):
                    with subtests.test(sentence=sentence, envs=envs), pytest.raises(error, match=sentence):
                        envs.restore(env, state)
            with pytest.raises(IndexError, match="environment 2 is out of range; accepted: 0 to 1"):
                there.save(2)
            assert there._open_machines()._session.states() == []
            self.play(here, there, 5)


class TestRefused:
    def test_bad_input_raises_the_same_errors_as_in_this_process(self, subtests):
        with server() as (address, _):
            for envs in both(address, count=2, seed=1):
                for actions, error in (
                    ([0, 99], IndexError),
                    ([-1, 0], IndexError),
                    ([0], InvalidInput),
                    ([0.5, 1], TypeError),
                ):
                    with subtests.test(actions=actions), pytest.raises(error):
                        envs.step(actions)
                assert envs.step([0, 0])[0].shape == (2, 4, 84, 84)
            for arguments in ({"mode": 7}, {"difficulty": 9}, {"img_width": 321}, {"rom": b"x" * 600000}):
                for where in (None, address):
                    with subtests.test(arguments=arguments, server=where), pytest.raises(InvalidInput):
                        AtariVectorEnv("beamfall", 2, server=where, **arguments)

    def test_a_server_refuses_what_it_does_not_do(self, subtests):
        with server("--max-machines", "4") as (address, _):
            _player = AtariVectorEnv("beamfall", 2, server=address)
            for arguments in ({"batch_size": 1}, {"num_envs": 5}, {"start": "baselines", "use_fire_reset": False}):
                with subtests.test(arguments=arguments), pytest.raises(InvalidInput):
                    AtariVectorEnv("beamfall", **{"num_envs": 2, "server": address, **arguments})
            AtariVectorEnv("beamfall", 2, server=address, use_fire_reset=False, start="fire-noops").close()
            with pytest.raises(gymnasium.error.Error):
                AtariVectorEnv(["beamfall", "updraft"], server=address, full_action_space=True)


class TestLost:
    def test_a_server_that_dies_is_a_ConnectionError(self):
        with server() as (address, process):
            envs = AtariVectorEnv("beamfall", 2, server=address, seed=1)
            envs.step([0, 0])
            process.kill()
            process.wait()
            for call in (lambda: envs.step([0, 0]), envs.reset, envs.show):
                with pytest.raises(ConnectionError):
                    call()
            envs.close()
            with pytest.raises(OSError):
                AtariVectorEnv("beamfall", 2, server=address)

    def test_a_server_that_dies_within_a_step_is_a_ConnectionError(self):
        with server() as (address, process):
            envs = AtariVectorEnv("beamfall", 64, server=address, frameskip=1000, seed=1)
            threading.Timer(0.3, process.kill).start()
            with pytest.raises(ConnectionError):
                for _ in range(10000):
                    envs.step([0] * 64)

    def test_a_child_after_a_fork_is_refused(self):
        with server() as (address, _):
            envs = AtariVectorEnv("beamfall", 2, server=address, seed=1)
            child = os.fork()
            if child == 0:
                try:
                    envs.step([0, 0])
                except RuntimeError as error:
                    os._exit(7 if "before the process forked" in str(error) else 8)
                os._exit(9)
            assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
            envs.step([0, 0])
