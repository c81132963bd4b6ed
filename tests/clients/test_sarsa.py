"""clients/python/sarsa.py learns as the paper says, and chooses act by act what `racebeam experiment` chooses."""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import zlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / folder) for folder in ("tests/server", "tests/support", "clients/python")]

import pytest  # noqa: E402

pytest.importorskip("numpy")

import numpy as np  # noqa: E402
import sarsa  # noqa: E402
from harness import BINARY, PATIENCE, Server  # noqa: E402

PLAN = """
name = "same"
games = ["beamfall"]
agents = ["basic"]
trials = 1
training_episodes = 20
evaluation_episodes = 20
background_screens = 500
environment = "max_episode_frames=3000"
"""
PIXELS = 160 * 210
LONG = 10 * PATIENCE  # seconds


def learn(server, *options):
    """What the client prints, line by line."""
    done = subprocess.run(
        [sys.executable, "-B", SOURCE / "clients/python/sarsa.py", server, *map(str, options)],
        capture_output=True,
        text=True,
        timeout=LONG,
    )
    if done.returncode:
        raise AssertionError(done.stderr)
    return done.stdout.splitlines()


def has_experiments():
    return b"Usage: racebeam experiment" in subprocess.run([BINARY, "experiment", "--help"], capture_output=True).stdout


class TestParts:
    def test_the_generator_gives_published_numbers(self):
        generator = sarsa.Random(0)
        assert [generator.next() for _ in range(3)] == [0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F]

    def test_features_of_a_screen(self):
        background = np.zeros(PIXELS, np.uint8)
        background[1] = 9
        basic = sarsa.Basic(background)
        screen = np.zeros(PIXELS, np.uint8)
        screen[0] = 2 * 5  # colour 5 in the first tile
        screen[1] = 2 * 9 + 1  # the background: the lowest bit means nothing
        screen[14 * 160 + 9] = 2 * 127  # the last pixel of the first tile
        screen[14 * 160 + 10] = 2  # the next tile
        screen[15 * 160] = 4  # the next row of tiles
        screen[PIXELS - 1] = 6  # the last tile
        assert basic.SIZE == 28672
        assert basic.active(screen.tobytes()).tolist() == [5, 127, 128 + 1, 16 * 128 + 2, 223 * 128 + 3]
        assert basic.active(bytes(PIXELS)).tolist() == [0]  # black, where the background is not

    def test_screens_of_another_height(self):
        basic = sarsa.Basic(np.full(PIXELS, 3, np.uint8))
        assert len(basic.active(bytes([6]) * (160 * 195))) == 16  # black below
        assert len(basic.active(bytes([6]) * (160 * 250))) == 0

    def test_weights_of_an_episode_by_hand(self):
        agent = sarsa.Sarsa(3, 1)
        agent.random = types.SimpleNamespace(uniform=lambda: 1.0, below=lambda count: 0)  # greedy; the first of equals
        states = [np.array([state]) for state in range(3)]
        assert [agent.begin(states[0]), agent.next(0, states[1]), agent.next(-2, states[2])] == [0, 0, 0]
        agent.end(4)
        # The scaled rewards are 0, -1 and 2. The errors are 0, -1 and 2, the steps half of them.
        decay = 0.999 * 0.9
        expected = [-0.5 * decay + decay**2, -0.5 + decay, 1]
        np.testing.assert_allclose(agent.weights[:, 0], expected, rtol=1e-6)
        assert np.count_nonzero(agent.weights) == 3

    def test_the_step_is_divided_by_the_most_active_features(self):
        agent = sarsa.Sarsa(4, 1)
        agent.random = types.SimpleNamespace(uniform=lambda: 1.0, below=lambda count: 3)
        agent.begin(np.array([0, 1, 2, 3]))
        agent.end(7)
        assert agent.weights[:, 3].tolist() == [0.125] * 4
        agent.begin(np.array([1]))
        agent.end(7)  # error 1 - 0.125, step 0.5 / 4
        assert agent.weights[:, 3].tolist() == [0.125, 0.125 + 0.125 * 0.875, 0.125, 0.125]

    def test_evaluation_does_not_learn(self):
        agent = sarsa.Sarsa(1, 1)
        agent.learning = False
        agent.begin(np.array([0]))
        agent.end(5)
        assert not agent.weights.any()


class TestPlay:
    def test_every_transport_and_repetition_plays_the_same(self):
        options = ("beamfall", "--training", 2, "--evaluation", 1, "--frames", 500, "--actions")
        with Server("serve", "--listen", "tcp://127.0.0.1:0") as server:
            over_tcp = learn(f"tcp://127.0.0.1:{server.port()}", *options)
        assert learn(BINARY, *options) == over_tcp
        assert re.search(r"^evaluation episode 3: score \d+ in 100 decisions( \d+){100}$", over_tcp[2])
        assert learn(BINARY, *options, "--agent-seed", 2) != over_tcp

    def test_it_says_how_it_is_used(self):
        done = subprocess.run(
            [sys.executable, "-B", SOURCE / "clients/python/sarsa.py"], capture_output=True, text=True
        )
        assert (done.returncode, done.stderr[:15]) == (2, "usage: sarsa.py")

    @pytest.mark.skipif(not has_experiments(), reason="this racebeam has no experiments")
    def test_it_chooses_what_the_agent_basic_chooses(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "plan.toml").write_text(PLAN)
            subprocess.run(
                [BINARY, "experiment", root / "plan.toml", "--into", root / "results"],
                check=True,
                capture_output=True,
                timeout=LONG,
            )
            content = zlib.decompress((root / "results/games/beamfall.background").read_bytes()[24:])
            np.savetxt(root / "background.csv", np.frombuffer(content[-PIXELS:], np.uint8).reshape(210, 160), "%d", ",")
            trained, evaluated = (rows(root / f"results/{name}.csv") for name in ("curves", "results"))
            # Without sticky actions the seed of the environment makes no difference.
            lines = learn(
                BINARY,
                "beamfall",
                "--training",
                20,
                "--evaluation",
                20,
                "--frames",
                3000,
                "--actions",
                "--agent-seed",
                evaluated[0]["agent_seed"],
                "--background",
                root / "background.csv",
            )
            replay = [
                re.fullmatch(r"\w+ episode \d+: score (-?\d+) in (\d+) decisions ([\d ]+)", line).groups()
                for line in lines
            ]
            assert [(score, count) for score, count, _ in replay] == [
                (row["score"], row["decisions"]) for row in trained + evaluated
            ]
            for row, (_, count, actions) in zip(evaluated, replay[20:]):
                log = zlib.decompress((root / f"results/logs/{row['unit']}/{row['episode']}.episode").read_bytes()[24:])
                assert list(log[-int(count) :]) == [int(action) for action in actions.split()]
            assert len({score for score, _, _ in replay}) > 5


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))
