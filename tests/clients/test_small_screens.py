"""grey84 and its stacks equal the output of OpenCV and of the reference's vector environment, byte for
byte."""

import os
import sys

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [
    os.path.join(SOURCE, folder) for folder in ("tests/server", "tests/support", "clients/python/single_file")
]

import pytest  # noqa: E402

pytest.importorskip("cv2")
pytest.importorskip("numpy")
pytest.importorskip("ale_py")
pytest.importorskip("gymnasium")


import client as racebeam  # noqa: E402
import cv2  # noqa: E402
import numpy as np  # noqa: E402
from ale_py import roms  # noqa: E402
from ale_py.vector_env import AtariVectorEnv  # noqa: E402
from harness import BINARY  # noqa: E402

ROMS = str(roms.get_rom_path("pong").parent)
STEPS = 300


def plane(data, *shape):
    return np.frombuffer(data, np.uint8).reshape(shape)


class TestOpenCv:
    @pytest.mark.parametrize("game, height", (("beamfall", 210), ("pong", 210), ("air_raid", 250), ("gravitar", 210)))
    def test_small_screens_are_those_of_INTER_AREA(self, game, height):
        with racebeam.Session.start(BINARY, "--roms", ROMS) as session:
            assert session.load(game, seed=5)["height"] == height
            session.observe("grey", "grey84")
            for step in range(STEPS):
                result = session.act(step // 7 % 18)
                expected = cv2.resize(plane(result["grey"], height, 160), (84, 84), interpolation=cv2.INTER_AREA)
                assert result["grey84"] == expected.tobytes(), f"step {step}"


class TestVectorEnvironment:
    """Until the end of an episode: at that point the reference shows a picture that mixes frames of two
    acts."""

    def compare(self, game, seed, **options):
        reference = AtariVectorEnv(game, num_envs=1, use_fire_reset=False, reward_clipping=False, **options)
        shown, info = reference.reset(seed=seed)
        with racebeam.Session.start(BINARY, "--roms", ROMS) as session:
            session.load(
                game,
                seed=seed,
                frame_skip=options["frameskip"],
                noop_max=options["noop_max"],
                action_set="minimal",
                sticky=options["repeat_action_probability"],
            )
            session.observe("reward", "ends", "lives", "episode_frame", "grey84x4")
            ours = session.look()
            actions = list(session.actions())
            rewards = 0
            for step in range(STEPS):
                assert plane(ours["grey84x4"], 4, 84, 84).tobytes() == shown[0].tobytes(), f"step {step}"
                assert (ours["lives"], ours["episode_frame"]) == (info["lives"][0], info["episode_frame_number"][0]), (
                    f"step {step}"
                )
                choice = (step * 7 + step // 11) % len(actions)
                shown, reward, terminated, truncated, info = reference.step(np.array([choice]))
                ours = session.act(actions[choice])
                assert ours["reward"] == reward[0]
                assert (ours["terminated"], ours["truncated"]) == (terminated[0], truncated[0])
                rewards += abs(ours["reward"])
                if terminated[0] or truncated[0]:
                    break
            return rewards

    def test_stacks_pooling_noops_and_stickiness_are_the_same(self, subtests):
        rewards = 0
        for game in ("pong", "ms_pacman", "breakout"):
            for seed, skip, sticky, noops in ((1, 4, 0.25, 30), (2, 4, 0.0, 30), (3, 1, 0.25, 5), (4, 3, 0.0, 0)):
                with subtests.test(game=game, seed=seed, frame_skip=skip):
                    rewards += self.compare(
                        game, seed, frameskip=skip, repeat_action_probability=sticky, noop_max=noops
                    )
        assert rewards > 0
