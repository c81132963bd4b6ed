"""Logs that racebeam.episode_log writes are confirmed by `racebeam verify`."""

import re
import struct
import subprocess
import zlib

import package
import pytest

package.require("numpy")

import racebeam.program
from racebeam import InvalidInput
from racebeam.episode_log import Origin, Start, log_of, play, replay, write_log


def contents(log):
    """The lines of text in a log, and the bytes that follow them."""
    text, _, rest = zlib.decompress(log[24:]).partition(b"\n\n")
    return text.decode().splitlines(), rest


class TestLogs:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.path = tmp_path / "one.episode"

    def verify(self):
        return subprocess.run([racebeam.program.path(), "verify", self.path], capture_output=True, text=True)

    @pytest.mark.needs_program
    def test_a_log_is_confirmed(self, subtests):
        for settings, end in (
            ({"seed": 3, "frame_skip": 60}, True),
            ({"seed": 2**32 - 2, "frame_skip": 4, "sticky": 0.25, "max_episode_frames": 199}, False),
            ({"seed": 1, "frame_skip": 1, "max_episode_frames": 256}, False),
            ({"seed": 2**31 - 1, "frame_skip": 4, "max_episode_frames": 100}, False),
            ({"seed": 2**31, "frame_skip": 4, "max_episode_frames": 100}, False),
        ):
            actions = [step // 7 % 18 for step in range(2000)]
            with subtests.test(**settings):
                episode = write_log(self.path, "beamfall", actions, **settings, agent="test")
                assert (episode.is_over, episode.is_terminated) == (True, end)
                done = self.verify()
                assert re.search(
                    rf"^one.episode \(beamfall, test, score {episode.score}\): confirmed; ", done.stdout
                ), done.stderr

    @pytest.mark.needs_program
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

    def test_actions_are_numbers_or_members(self):
        members = [racebeam.Action.FIRE, racebeam.ConsoleAction.SELECT, racebeam.Action.LEFT]
        assert members[0].value == 1
        expected = replay("beamfall", [member.value for member in members], seed=1, frame_skip=4)
        assert replay("beamfall", members, seed=1, frame_skip=4) == expected
        assert replay("beamfall", iter(members), seed=1, frame_skip=4) == expected
        write_log(self.path, "beamfall", iter(members), seed=1, frame_skip=4, max_episode_frames=12)
        assert contents(self.path.read_bytes())[1][-3:] == bytes(member.value for member in members)
        for action in ("FIRE", 1.0, None):
            with pytest.raises(TypeError, match=rf"actions\[1\] is {action!r}; it takes a member of Action"):
                replay("beamfall", [0, action], seed=1, frame_skip=4)

    def test_an_agent_that_verify_would_refuse_is_refused(self):
        wrong = [{"agent": agent} for agent in ("a b", "", "é", 3, "-a", "a" * 65)]
        for words in (*wrong, {"agent_seed": -1}, {"agent_seed": 2**32}):
            with pytest.raises(InvalidInput, match=f"{next(iter(words))} is .*; it takes"):
                write_log(self.path, "beamfall", [1] * 20, seed=1, frame_skip=4, max_episode_frames=40, **words)
        assert not self.path.exists()

    def test_numbers_and_names_at_their_limits_are_accepted(self):
        for words in ({"agent": "a" * 64}, {"agent_seed": 2**32 - 1}, {"agent": "Z_.-9"}):
            write_log(self.path, "beamfall", [1] * 20, seed=0, frame_skip=4, max_episode_frames=40, **words)
            for key, word in words.items():
                assert f" {key}={word} " in contents(self.path.read_bytes())[0][2]

    def test_states_that_are_equal_have_one_hash(self):
        one, other = (replay("beamfall", actions, seed=1, frame_skip=1) for actions in ([1] * 256, [1] * 300))
        assert (len(one.hashes), len(other.hashes)) == (2, 2)
        assert one.hashes[0] == other.hashes[0]
        assert one.hashes[1] != other.hashes[1]

    def test_hashes_follow_every_256_decisions_and_the_end(self):
        for decisions, hashes in ((0, 1), (1, 1), (255, 1), (256, 2), (257, 2), (512, 3)):
            episode = replay("beamfall", [1] * decisions, seed=1, frame_skip=1)
            assert (episode.decisions, episode.frames, len(episode.hashes)) == (decisions, decisions, hashes)
            assert not episode.is_over and not episode.is_terminated

    def test_the_log_says_how_it_began_who_played_and_how_it_ended(self):
        start = Start("beamfall", 5, 4, 0.25, 40)
        episode = play(start, [1] * 20)
        assert (episode.decisions, episode.is_over, episode.is_terminated) == (10, True, False)
        log, row = log_of(start, [1] * 20, episode, Origin("mine", 3, 2, 7))
        lines, rest = contents(log)
        version = row["version"]
        assert lines[0] == (
            "load beamfall seed=5 frame_skip=4 sticky=0.25 max_episode_frames=40 action_set=full rules=ale-0.12 "
            "life_loss=ignored"
        )
        assert lines[2:] == [
            f"from unit=beamfall-mine-3 agent=mine trial=3 episode=2 agent_seed=7 version={version}",
            f"ended score={episode.score} frames=40 decisions=10 end=truncated lives={episode.lives}",
        ]
        assert rest == struct.pack("<Q", episode.hashes[0]) + bytes([1] * 10)
        assert (row["environment_seed"], row["state_hash"]) == ("5", f"{episode.hashes[-1]:016x}")

    @pytest.mark.needs_program
    def test_a_mode_and_a_difficulty_are_in_the_log_and_reset_the_game(self):
        for words in ({"mode": 0}, {"difficulty": 0}, {"mode": 0, "difficulty": 1}):
            start = Start("beamfall", 5, 1, max_episode_frames=60, **words)
            episode = play(start, [1] * 60)
            log, _ = log_of(start, [1] * 60, episode, Origin())
            assert contents(log)[0][0].split("life_loss=ignored ")[1] == " ".join(f"{k}={v}" for k, v in words.items())
            self.path.write_bytes(log)
            assert self.verify().returncode == 0

    def test_an_origin_is_the_first_episode_of_the_first_trial_unless_named(self):
        write_log(self.path, "beamfall", [1] * 20, seed=1, frame_skip=4, max_episode_frames=40)
        assert " agent=agent trial=1 episode=1 agent_seed=0 " in contents(self.path.read_bytes())[0][2]
        write_log(self.path, "beamfall", [1] * 20, seed=1, frame_skip=4, max_episode_frames=40, agent="a", agent_seed=2)
        assert " agent=a trial=1 episode=1 agent_seed=2 " in contents(self.path.read_bytes())[0][2]

    def test_strengths_are_logged_up_to_the_end_and_only_if_one_is_not_1(self):
        start = Start("beamfall", 5, 4, max_episode_frames=40)
        for strengths, logged in (([1.0] * 20, []), ([1.0] * 9 + [0.5] * 11, [1.0] * 9 + [0.5])):
            episode = play(start, [1] * 20, strengths)
            _, rest = contents(log_of(start, [1] * 20, episode, Origin(), strengths)[0])
            assert rest[8 + 10 :] == struct.pack(f"<{len(logged)}f", *logged)

    def test_a_lost_life_terminates_where_it_restarts_and_a_limit_truncates(self):
        lives = play(Start("beamfall", 3, 4), [0]).lives
        lost = play(Start("beamfall", 3, 4, life_loss="restart"), [0] * 5000)
        assert (lost.is_over, lost.is_terminated, lost.lives) == (True, True, lives - 1)
        for limit, is_terminated in ((lost.frames + 8, True), (lost.frames - 4, False)):
            episode = play(Start("beamfall", 3, 4, life_loss="restart", max_episode_frames=limit), [0] * 5000)
            assert (episode.is_over, episode.is_terminated) == (True, is_terminated)
            assert episode.frames == min(limit, lost.frames)
        episode = play(Start("beamfall", 3, 1, life_loss="restart", max_episode_frames=1), [0] * 9)
        assert (episode.frames, episode.is_over, episode.is_terminated) == (1, True, False)
