"""RecordLog leaves a submission that `racebeam verify` confirms, and that it refuses once somebody has changed it."""

import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import zlib

import harness
import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam.program
from racebeam import InvalidInput, RecordLog
from racebeam.episode_log import Episode, Origin, Start, log_of, play
from racebeam.single import played, submission
from racebeam.single.submission import COLUMNS

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl
    import resource


HEADER = pathlib.Path(__file__).parents[3] / "recording/episode_log.hpp"


def play_games(env, games, seed=None):
    """Plays at random until this many games are logged."""
    random, remaining = np.random.default_rng(3), games
    while remaining:
        env.reset(seed=seed)
        over = False
        while not over:
            if env.unwrapped.continuous:
                action = random.uniform([0, -np.pi, 0], [1, np.pi, 1]).astype(np.float32)
            else:
                action = int(random.integers(env.action_space.n))
            *_, terminated, truncated, _ = env.step(action)
            over = terminated or truncated
        remaining -= env.unwrapped.ale.game_over()
    return env


def take_lock(file):
    """Takes the lock of a file as another program does."""
    if sys.platform == "win32":
        file.seek(submission.LOCKED_BYTE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(file, fcntl.LOCK_EX)


pytestmark = pytest.mark.filterwarnings("always")


@pytest.fixture(autouse=True)
def plain_umask():
    before = os.umask(0o022)
    yield
    os.umask(before)


class TestSubmissions:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.scratch = tempfile.TemporaryDirectory()
        cleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name, "mine")

    def record(self, games=2, phrase=None, agent="random", **arguments):
        self.env = RecordLog(racebeam.AtariEnv("beamfall", **arguments), self.folder, agent=agent, phrase=phrase)
        return play_games(self.env, games)

    def verify(self):
        done = subprocess.run([racebeam.program.path(), "verify", self.folder], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def rows(self):
        with open(self.folder / "results.csv", newline="") as file:
            return list(csv.DictReader(file))

    def write_rows(self, rows):
        with open(self.folder / "results.csv", "w", newline="") as file:
            table = csv.DictWriter(file, rows[0], lineterminator="\n")
            table.writeheader()
            table.writerows(rows)

    @pytest.mark.needs_program
    def test_episodes_are_confirmed(self, subtests):
        for number, arguments in enumerate(
            (
                {"preset": "machado2018"},
                {"preset": "paper2013"},
                {"life_loss": "end"},
                {"continuous": True, "max_num_frames_per_episode": 901},
                {"life_loss": "restart", "difficulty": 0, "frameskip": 2},
                {"full_action_space": "console", "max_num_frames_per_episode": 1001},
                {"full_action_space": True, "repeat_action_probability": 0.1, "max_num_frames_per_episode": 301},
            )
        ):
            self.folder = pathlib.Path(self.scratch.name, str(number))
            with subtests.test(**arguments):
                env = self.record(**arguments)
                assert (env.logged, env.unlogged) == (2, 0)
                status, output = self.verify()
                assert (status, output.split(";")[0]) == (0, "2 rows confirmed, 0 wrong, 0 could not be checked")
                assert f'preset = "{arguments.get("preset", "other")}"' in (self.folder / "agent.toml").read_text()

    def test_the_seed_of_reset_and_the_hash_are_those_of_the_log(self):
        env = RecordLog(racebeam.AtariEnv("beamfall"), self.folder)
        _, info = env.reset(seed=5)
        env = play_games(env, 1, seed=5)
        (row,) = self.rows()
        assert row["environment_seed"] == str(info["seeds"][1])
        assert row["state_hash"] == f"{env.unwrapped.state_hash:016x}"

    @pytest.mark.needs_program
    def test_seeds_follow_from_a_phrase(self):
        self.record(phrase="a headline of tomorrow")
        assert self.verify()[0] == 0
        with pytest.raises(InvalidInput, match="with a phrase, reset\\(\\) takes no seed"):
            self.env.reset(seed=1)

    @pytest.mark.needs_program
    def test_what_was_changed_is_refused(self):
        self.record(phrase="a headline of tomorrow")
        rows = self.rows()
        self.write_rows([rows[0] | {"score": str(int(rows[0]["score"]) + 1)}, rows[1]])
        status, output = self.verify()
        assert status == 1
        assert re.search("score is '.*'; its log has", output)
        swapped = {"environment_seed": rows[1]["environment_seed"]}
        self.write_rows([rows[0] | swapped, rows[1]])
        status, output = self.verify()
        assert status == 1
        assert "environment_seed" in output

    @pytest.mark.needs_program
    def test_an_action_that_was_changed_is_refused(self):
        start = Start("beamfall", 7, 4, max_episode_frames=400)
        episode = play(start, [1] * 100)
        log, row = log_of(start, [1] * 49 + [4] + [1] * 50, episode, Origin("liar"))
        unit = self.folder / "logs" / row["unit"]
        unit.mkdir(parents=True)
        (unit / "1.episode").write_bytes(log)
        (self.folder / "agent.toml").write_text(
            'agent = "liar"\nversion = "1"\npreset = "other"\ntraining_frames = 0\n'
        )
        self.write_rows([{column: row[column] for column in COLUMNS.split(",")}])
        status, output = self.verify()
        assert status == 1, output
        assert "not confirmed" in output

    def test_episodes_that_cannot_be_repeated_have_no_log(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=200), self.folder)
        env.reset()
        env.step(1)
        with pytest.warns(UserWarning, match="no log: it was left before its end"):
            env.reset()
        state = env.unwrapped.clone_state()
        for _ in range(20):
            env.step(1)
        env.unwrapped.restore_state(state)
        with pytest.warns(UserWarning, match="no log: .* a state was restored in it"):
            for _ in range(60):
                env.step(2)
        assert (env.logged, env.unlogged, self.rows()) == (0, 2, [])

    def test_an_episode_with_too_many_actions_for_a_log_is_forgotten(self):
        with unittest.mock.patch.object(played, "MOST_ACTS", 10), unittest.mock.patch.object(played, "MOST_TURNS", 9):
            env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=44), self.folder)
            env.reset()
            for _ in range(10):
                env.step(1)
            with pytest.warns(UserWarning, match="no log: it has more than 10 acts$") as found:
                env.step(1)
            assert [warning.filename for warning in found] == [__file__]
            assert env.unwrapped.ale.game_over()
            assert (env.logged, env.unlogged, env._played.actions) == (0, 1, [])
            env.reset()
            env.step(1)
            assert env._played.actions == [1]
            turning = played.Played()
            answers = [turning.add(3, 0.5) for _ in range(11)]
            assert answers == [None] * 9 + ["it has more than 9 acts with strengths", None]
            assert (turning.actions, turning.strengths) == ([], [])

    def test_an_episode_without_a_limit_of_frames_does_not_fill_the_memory(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=0, life_loss="end"), self.folder)
        with unittest.mock.patch.object(played, "MOST_ACTS", 10):
            with pytest.warns(UserWarning, match="more than 10 acts") as found:
                play_games(env, 1)
        assert (len(found), env.logged, env.unlogged) == (1, 0, 1)  # lives of one game, which got one warning
        env.reset()
        env.close()
        assert env.unlogged == 1

    @pytest.mark.skipif(not HEADER.exists(), reason="the tree is not here")
    def test_the_program_has_the_same_limits(self):
        found = dict(re.findall("constexpr int (kMaxDecisions|kMaxTurns) = ([0-9']+);", HEADER.read_text()))
        numbers = {name: int(digits.replace("'", "")) for name, digits in found.items()}
        assert numbers == {"kMaxDecisions": played.MOST_ACTS, "kMaxTurns": played.MOST_TURNS}

    def test_a_reset_before_the_first_action_leaves_nothing_behind(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40), self.folder)
        env.reset()
        env.reset()
        env.close()
        assert (env.logged, env.unlogged) == (0, 0)

    def test_a_warning_names_the_line_of_the_caller(self):
        env = RecordLog(racebeam.AtariEnv("beamfall"), self.folder)
        for leave in (env.reset, env.close):
            env.reset()
            env.step(1)
            with pytest.warns(UserWarning, match="it was left before its end") as found:
                leave()
            assert [warning.filename for warning in found] == [__file__]
        assert env.unlogged == 2

    @pytest.mark.needs_program
    def test_any_seed_of_a_game_may_be_drawn(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40), self.folder)
        bounds = {"least": 1, "half": 2**31 - 1, "more": 2**31, "most": 2**32 - 2}
        for number, name in enumerate(bounds, 1):

            def drawn(low, high, endpoint=False, name=name):
                return {**bounds, "least": low, "most": high if endpoint else high - 1}[name]

            env._seeds = unittest.mock.Mock(integers=drawn)
            play_games(env, 1)
            assert env.logged == number
        assert [int(row["environment_seed"]) for row in self.rows()] == list(bounds.values())
        assert self.verify()[0] == 0

    @pytest.mark.needs_program
    def test_numbers_at_their_limits_are_logged(self):
        for trial, agent_seed in ((1, 0), (2**31 - 1, 2**32 - 1)):
            self.folder = pathlib.Path(self.scratch.name, str(trial))
            env = racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40)
            play_games(RecordLog(env, self.folder, trial=trial, agent_seed=agent_seed), 1)
            (row,) = self.rows()
            assert (row["trial"], row["agent_seed"], row["episode"]) == (str(trial), str(agent_seed), "1")
            assert self.verify()[0] == 0

    @pytest.mark.needs_posix
    def test_an_episode_of_more_bytes_than_a_log_has_is_refused(self):
        start, episode = Start("beamfall", 1, 1), Episode(0, 0, 0, True, True, 0, [7])
        room = 2**21 - len(zlib.decompress(log_of(start, [], episode._replace(decisions=10**6), Origin())[0][24:]))
        for decisions in (room, room + 1):
            longest = episode._replace(decisions=decisions)
            if decisions == room:
                assert len(zlib.decompress(log_of(start, [0] * decisions, longest, Origin())[0][24:])) == 2**21
            else:
                with pytest.raises(InvalidInput, match="the log has 2097153 bytes before .*; it takes at most 2097152"):
                    log_of(start, [0] * decisions, longest, Origin())

    @pytest.mark.needs_posix
    def test_a_full_disk_is_reported_and_the_game_goes_on(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40), self.folder)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
        try:
            with pytest.warns(UserWarning, match="no log: .*large"):
                play_games(env, 1)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        play_games(env, 1)
        assert (env.logged, env.unlogged, len(self.rows())) == (1, 1, 1)
        if os.path.exists(harness.BINARY):
            assert self.verify()[0] == 0

    def test_a_program_that_keeps_the_lock_of_the_table_costs_an_episode_its_log(self):
        env = RecordLog(racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40), self.folder)
        with open(self.folder / "results.csv", "rb") as table, unittest.mock.patch.object(submission, "PATIENCE", 0.1):
            take_lock(table)
            with pytest.warns(UserWarning, match="no log: another program has had the lock of .*results.csv"):
                play_games(env, 1)
        play_games(env, 1)
        assert (env.logged, env.unlogged, len(self.rows())) == (1, 1, 1)
        if os.path.exists(harness.BINARY):
            assert self.verify()[0] == 0

    @pytest.mark.needs_program
    def test_numbers_of_numpy_and_any_words_are_written(self):
        about = {"words": 'A "quoted"\x7f text\n', "role": "baseline", "link": "https://example.org/a"}
        env = RecordLog(racebeam.AtariEnv("beamfall"), self.folder, training_frames=np.int64(5), about=about)
        play_games(env, 1)
        assert "training_frames = 5\n" in (self.folder / "agent.toml").read_text()
        assert self.verify()[0] == 0

    def test_bad_arguments_are_refused_and_leave_nothing(self):
        for words in ({"trial": 0}, {"trial": "x"}, {"trial": 2**31}, {"agent_seed": -1}, {"agent_seed": 2**32}):
            with pytest.raises((ValueError, TypeError), match=f"{next(iter(words))} is .*; it takes"):
                RecordLog(racebeam.AtariEnv("beamfall"), self.folder, **words)
        for agent in ("", "../x", "a b", "a/b", "x" * 65):
            with pytest.raises(InvalidInput, match="agent is"):
                self.record(agent=agent)
        for words in (
            {"agent": 3},
            {"version": 3},
            {"version": None},
            {"training_frames": -1},
            {"training_frames": 1.5},
            {"training_frames": 10**15},
            {"phrase": ""},
            {"phrase": 3},
            {"phrase": "a\nb"},
            {"phrase": "é" * 501},
            {"about": [1]},
            {"about": {"colour": "red"}},
        ):
            with pytest.raises((InvalidInput, TypeError, ValueError), match=f"{next(iter(words))} is .*; it takes"):
                RecordLog(racebeam.AtariEnv("beamfall"), self.folder, **words)
        for key, word in (("words", 3), ("role", "boss"), ("link", "example.org")):
            with pytest.raises((InvalidInput, TypeError, ValueError), match=f"{key} is {word!r}; it takes"):
                RecordLog(racebeam.AtariEnv("beamfall"), self.folder, about={key: word})
        for version in ("", "x" * 65):
            with pytest.raises(InvalidInput, match=f"version has {len(version)} letters; it takes 1 to 64"):
                RecordLog(racebeam.AtariEnv("beamfall"), self.folder, version=version)
        with pytest.raises(InvalidInput, match="words has 4001 letters; it takes at most 4000"):
            RecordLog(racebeam.AtariEnv("beamfall"), self.folder, about={"words": "x" * 4001})
        with pytest.raises(TypeError, match="folder is 3; it takes a path"):
            RecordLog(racebeam.AtariEnv("beamfall"), 3)
        for arguments, sentence in (
            ({"frameskip": (2, 5)}, r"frameskip is \(2, 5\); a log takes a number"),
            ({"noop_max": 30}, "noop_max is 30; a log takes 0"),
            ({"noop_max": 1}, "noop_max is 1; a log takes 0"),
            ({"reward_range": (-1, 1)}, r"reward_range is \(-1, 1\); a log has whole rewards"),
        ):
            with pytest.raises(InvalidInput, match=sentence):
                self.record(**arguments)
        own = pathlib.Path(self.scratch.name, "own.toml")
        own.write_text('title = "Own"\n[rule]\nstep = "score = 0; terminal = 0"\n')
        with pytest.raises(InvalidInput, match="the game comes from a game file; a log takes a game of the catalogue"):
            RecordLog(racebeam.AtariEnv(game_file=own, rom="builtin:beamfall"), self.folder)
        with pytest.raises(InvalidInput, match="env is of class Plain; RecordLog takes an AtariEnv"):
            RecordLog(type("Plain", (gymnasium.Env,), {})(), self.folder)
        assert not self.folder.exists()

    def test_a_game_for_two_is_refused(self):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        with pytest.raises(InvalidInput, match="two_player is True; a log has the actions of player A"):
            RecordLog(racebeam.AtariEnv("pong", two_player=True), self.folder)
        assert not self.folder.exists()

    @pytest.mark.needs_program
    def test_texts_at_their_limits_are_written(self):
        about = {"words": "x" * 4000, "link": "http://a", "role": "learner"}
        env = RecordLog(
            racebeam.AtariEnv("beamfall", max_num_frames_per_episode=40),
            self.folder,
            agent="a" * 64,
            version="v" * 64,
            training_frames=10**15 - 1,
            phrase="é" * 500,
            trial=2,
            about=about,
        )
        play_games(env, 2)
        status, output = self.verify()
        assert (status, output.split(";")[0]) == (0, "2 rows confirmed, 0 wrong, 0 could not be checked"), output

    def test_two_programs_cannot_share_a_folder(self):
        self.record(1)
        with pytest.raises(FileExistsError, match="takes a new folder, and this one exists"):
            self.record(1)
        if os.path.exists(harness.BINARY):
            assert self.verify()[0] == 0
