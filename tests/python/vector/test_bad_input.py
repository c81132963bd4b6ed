"""AtariVectorEnv refuses bad input."""

import subprocess
import sys

import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
from gymnasium.error import ClosedEnvironmentError, Error
from racebeam import AtariVectorEnv, InvalidInput, ale_py

PATIENCE = 60  # seconds until something counts as hanging
FLAGS = (
    "full_action_space",
    "continuous",
    "grayscale",
    "maxpool",
    "episodic_life",
    "life_loss_info",
    "reward_clipping",
    "use_fire_reset",
    "sound_obs",
)


class TestBadInput:
    def test_arguments(self, subtests):
        for name, values in {
            "num_envs": (0, -1, 2.5, "2", 10**9),
            "batch_size": (-1, 3),
            "num_threads": (-1, None),
            "frameskip": (0, 1001, 2.5, (2, 5)),
            "img_width": (-1, "84"),
            "stack_num": (0, 17),
            "noop_max": (-1, 1001),
            "repeat_action_probability": (-0.1, 1.1, float("nan"), "x"),
            "autoreset_mode": ("Never", None, 3),
            "life_loss": ("hurts",),
            "start": ("ale",),
            "stack_start": ("x",),
            "obs_type": ("sound",),
            "rules": ("x",),
            "render_mode": ("ansi",),
            "seed": (-1, 2**32, "x"),
            "mode": (-1, "x"),
            "thread_affinity_offset": (-2,),
            "max_num_frames_per_episode": (-1, 2**31),
            **{flag: (np.ones(2, bool), np.zeros((2, 3))) for flag in FLAGS},
        }.items():
            for value in values:
                with subtests.test(**{name: value}), pytest.raises(Error, match=name):
                    AtariVectorEnv("beamfall", **{"num_envs": 2, name: value})
        for arguments in (
            {"img_width": 321},
            {"img_height": 421},
            {"img_height": 5},
            {"mode": 99},
            {"difficulty": 9},
            {"rom": b"x" * 6},
            {"rom": "/nowhere.bin"},
        ):
            with subtests.test(**arguments), pytest.raises(InvalidInput):
                AtariVectorEnv("beamfall", 2, **arguments)
        with pytest.raises(racebeam.UnknownGame):
            AtariVectorEnv("beamfal", 2)

    def test_arguments_that_are_wrong_together(self, subtests):
        two = ["beamfall", "updraft"]
        for game, arguments, error, sentence in (
            (["beamfall"], {"num_envs": 3}, ValueError, "num_envs is 3"),
            ("beamfall", {"life_loss": "end", "episodic_life": True}, ValueError, "episodic_life is True"),
            (two, {"rom": b"", "full_action_space": True}, ValueError, "^there are 2 games"),
            (["beamfall", ["x"]], {}, TypeError, r"^game .*\['x'\]"),
            (b"beamfall", {}, TypeError, "^game .* 98 "),
            (3, {}, TypeError, "game is 3"),
            ("beamfall", {"sound_obs": True, "server": "unix:/nowhere"}, ValueError, "^sound_obs "),
        ):
            with subtests.test(sentence=sentence), pytest.raises(error, match=sentence) as raised:
                AtariVectorEnv(game, **arguments)
            assert isinstance(raised.value, Error)

    def test_more_environments_than_the_memory_has(self):
        for count in (10**6, 10**7):
            with pytest.raises(InvalidInput, match="this process may use"):
                AtariVectorEnv("beamfall", count)

    @pytest.mark.needs_posix
    def test_memory_that_runs_out(self):
        """The memory is enough for two machines, and not for thousands."""
        script = (
            "import pathlib, racebeam, resource\n"
            "few = racebeam.AtariVectorEnv('beamfall', 2, num_threads=2)\n"
            "used = int(pathlib.Path('/proc/self/statm').read_text().split()[0]) * resource.getpagesize()\n"
            "resource.setrlimit(resource.RLIMIT_AS, (used + (1000 << 20), -1))\n"
            "try: racebeam.AtariVectorEnv('beamfall', 4000, img_height=210, img_width=160, stack_num=16, "
            "grayscale=False)\n"
            "except MemoryError: print('refused')\n"
            "try: racebeam.AtariVectorEnv('beamfall', 50_000)\n"
            "except racebeam.InvalidInput as error: print('this process may use' in str(error))\n"
            "few.step([0, 0]); print('on')"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE)
        assert done.stdout.split() == ["refused", "True", "on"], done.stderr

    def test_more_threads_than_environments(self):
        settings = racebeam._core.VectorSettings()
        settings.threads = settings.first_processor = 2**31 - 1
        machines = racebeam._core.VectorMachines([("builtin:beamfall", "beamfall")], np.zeros(2, np.int32), settings)
        assert len(machines.numbers_of_actions()) == 2

    def test_actions(self, subtests):
        envs, sticks = AtariVectorEnv("beamfall", 2, seed=1), AtariVectorEnv("beamfall", 2, continuous=True)
        for one, cases in (
            (
                envs,
                (
                    ([0, 99], IndexError),
                    ([-1, 0], IndexError),
                    ([0, 2**40], IndexError),
                    (np.array([0, 2**64 - 1], np.uint64), IndexError),
                    ([0], InvalidInput),
                    ([[0, 0]], InvalidInput),
                    ([[0], [0, 1]], InvalidInput),
                    (0, InvalidInput),
                    ([0.5, 1], TypeError),
                    (None, TypeError),
                    (["a", "b"], TypeError),
                    ([True, False], TypeError),
                ),
            ),
            (
                sticks,
                (
                    ([[0, 0, 0]], InvalidInput),
                    ([[0, 0]] * 2, InvalidInput),
                    ([0, 0], InvalidInput),
                    ([[float("nan"), 0, 0]] * 2, InvalidInput),
                    ([[float("inf"), 0, 0]] * 2, InvalidInput),
                    (None, TypeError),
                    ([["a", "b", "c"]] * 2, TypeError),
                ),
            ),
        ):
            for actions, error in cases:
                with subtests.test(actions=actions), pytest.raises(error):
                    one.step(actions)
        assert envs.step([0, 0])[0].shape == (2, 4, 84, 84)
        for number in (2**63, 2**64 - 1):
            with pytest.raises(IndexError, match=f"action {number} "):
                envs.step(np.array([0, number], np.uint64))

    def test_actions_before_the_first_reset_of_a_batch(self):
        for arguments, action in (({}, [0]), ({"continuous": True}, [[0, 0, 0]])):
            envs = AtariVectorEnv("beamfall", 2, batch_size=1, seed=1, **arguments)
            for call in (envs.send, envs.step):
                with pytest.raises(InvalidInput, match="reset"):
                    call(action)
            envs.reset()
            envs.step(action)

    def test_a_lost_life_has_one_effect(self, subtests):
        for flag, others in (("episodic_life", ("end", "reported", "ignored")), ("life_loss_info", ("end", "restart"))):
            for lives in others:
                with (
                    subtests.test(flag=flag, lives=lives),
                    pytest.raises(Error, match=f"{flag} is True.* but life_loss is '{lives}'"),
                ):
                    AtariVectorEnv("beamfall", 2, life_loss=lives, **{flag: True})
        for lives in (3, np.zeros(2)):
            with pytest.raises(Error, match="life_loss is"):
                AtariVectorEnv("beamfall", 2, life_loss=lives, episodic_life=True)
        AtariVectorEnv("beamfall", 2, life_loss="restart", episodic_life=True)
        with pytest.warns(DeprecationWarning, match="lives is the old name of life_loss"):
            AtariVectorEnv("beamfall", 2, lives="end")
        with pytest.warns(DeprecationWarning):
            assert AtariVectorEnv("beamfall", 2, lives="told")._options.life_loss == "reported"
        with pytest.raises(Error, match="only one"):
            AtariVectorEnv("beamfall", 2, lives="end", life_loss="end")
        AtariVectorEnv("beamfall", 2, preset="dqn2015", episodic_life=True)

    def test_seeds_and_masks(self, subtests):
        envs = AtariVectorEnv("beamfall", 2, seed=1)
        for seed, error in (
            ("12", TypeError),
            (1.5, TypeError),
            (-3, InvalidInput),
            ([1], InvalidInput),
            ([1, -5], InvalidInput),
            (2**32, InvalidInput),
            ([1, "x"], TypeError),
            (np.zeros((2, 3)), TypeError),
        ):
            with subtests.test(seed=seed), pytest.raises(error, match="seed"):
                envs.reset(seed=seed)
        with pytest.raises(InvalidInput, match=r"seeds .*\(2, 1\)"):
            envs.reset(seed=np.zeros((2, 1), int))
        assert np.array_equal(envs.reset(seed=np.array(3))[0], envs.reset(seed=3)[0])
        for options in (3, "x", [("reset_mask", None)]):
            with pytest.raises(TypeError):
                envs.reset(options=options)
        for mask, error in (
            ([True, False], TypeError),
            (np.array([1, 0]), TypeError),
            (np.array([True]), InvalidInput),
        ):
            with subtests.test(mask=mask), pytest.raises(error):
                envs.reset(options={"reset_mask": mask})

    def test_a_block_closes_the_environments(self):
        with AtariVectorEnv("beamfall", 2) as envs:
            envs.reset(seed=1)
        with pytest.raises(ClosedEnvironmentError):
            envs.reset()

    def test_after_close(self):
        envs = AtariVectorEnv("beamfall", 2, render_mode="rgb_array")
        envs.close()
        envs.close()
        for call in (
            envs.reset,
            lambda: envs.step([0, 0]),
            lambda: envs.send([0, 0]),
            envs.recv,
            envs.show,
            envs.render,
            lambda: envs.save(0),
            lambda: envs.restore(0, None),
        ):
            with pytest.raises(ClosedEnvironmentError):
                call()


class TestFound:
    """Calls that fuzz.py found."""

    def test_calls_after_close_extras(self):
        envs = AtariVectorEnv("beamfall", 2)
        envs.close_extras()
        for call in (
            lambda: envs.step([0, 0]),
            envs.reset,
            envs.show,
            envs.recv,
            lambda: envs.send([0, 0]),
            lambda: envs.save(0),
        ):
            with pytest.raises(gymnasium.error.ClosedEnvironmentError):
                call()
        envs.close()

    def test_arguments_of_ALEVectorInterface(self):
        envs = ale_py.ALEVectorInterface("builtin:beamfall", 2)
        envs.reset([0, 1], [1, 2])
        for error, call in (
            (TypeError, lambda: envs.send([0, 1], "ab")),
            (ValueError, lambda: envs.send([0, 1], [[1], [2, 3]])),
            (TypeError, lambda: envs.reset([0, 1], ["x", None])),
            (TypeError, lambda: envs.reset(np.ones((2, 2)), [1, 2])),
        ):
            with pytest.raises(error):
                call()
