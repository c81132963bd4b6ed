"""Logs that racebeam.episode_log writes are confirmed by `racebeam verify`."""

import re
import subprocess

import package
import pytest

package.require("numpy")

import racebeam.program
from racebeam import InvalidInput
from racebeam.episode_log import replay, write_log


class TestLogs:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.path = tmp_path / "one.episode"

    def verify(self):
        return subprocess.run([racebeam.program.path(), "verify", self.path], capture_output=True, text=True)

    def test_a_log_is_confirmed(self, subtests):
        for settings, end in (
            ({"seed": 3, "frame_skip": 60}, True),
            ({"seed": 2**32 - 2, "frame_skip": 4, "sticky": 0.25, "max_episode_frames": 199}, False),
            ({"seed": 1, "frame_skip": 1, "max_episode_frames": 256}, False),
        ):
            actions = [step // 7 % 18 for step in range(2000)]
            with subtests.test(**settings):
                episode = write_log(self.path, "beamfall", actions, **settings, agent="test")
                assert (episode.is_over, episode.is_terminated) == (True, end)
                done = self.verify()
                assert re.search(
                    rf"^one.episode \(beamfall, test, score {episode.score}\): confirmed; ", done.stdout
                ), done.stderr

    def test_a_log_of_another_score_is_not(self):
        write_log(self.path, "beamfall", [1] * 2000, seed=3, frame_skip=60)
        first = self.path.read_bytes()
        write_log(self.path, "beamfall", [1] * 2000, seed=4, frame_skip=60)
        assert first != self.path.read_bytes()
        self.path.write_bytes(first[:-1] + bytes([first[-1] ^ 1]))
        assert self.verify().returncode == 1

    def test_what_cannot_be_a_log_is_refused(self):
        for path, actions, sentence in (
            (self.path, [0], "the episode is not over after 1 actions"),
            (self.path.with_suffix(".log"), [0], "must end in .episode"),
        ):
            with pytest.raises(InvalidInput, match=sentence):
                write_log(path, "beamfall", actions, seed=1, frame_skip=4)
        for seed in (-1, 2**32 - 1):
            with pytest.raises(InvalidInput, match=f"seed is {seed};"):
                write_log(self.path, "beamfall", [0], seed=seed, frame_skip=4)
        assert not self.path.exists()

    def test_states_that_are_equal_have_one_hash(self):
        one, other = (replay("beamfall", actions, seed=1, frame_skip=1) for actions in ([1] * 256, [1] * 300))
        assert (len(one.hashes), len(other.hashes)) == (2, 2)
        assert one.hashes[0] == other.hashes[0]
        assert one.hashes[1] != other.hashes[1]
