"""The argument `log` of AtariVectorEnv leaves a submission that `racebeam verify` confirms."""

import csv
import os
import pathlib
import subprocess
import tempfile
import unittest.mock

import harness
import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam.program
from racebeam import AtariVectorEnv, InvalidInput
from racebeam.single import played

PLAIN = {"noop_max": 0, "use_fire_reset": False, "max_num_frames_per_episode": 600}


pytestmark = pytest.mark.filterwarnings("always")


class TestLogs:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.scratch = tempfile.TemporaryDirectory()
        cleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name, "mine")

    def make(self, *words, **arguments):
        log = {"folder": self.folder, "agent": "random", "training_frames": 9, "trial": 3, **arguments.pop("about", {})}
        return AtariVectorEnv(*(words or ("beamfall", 3)), log=log, **{"seed": 7, **PLAIN, **arguments})

    def play(self, envs, steps):
        random = np.random.default_rng(3)
        envs.reset()
        for _ in range(steps):
            if envs.continuous:
                actions = random.uniform([0, -np.pi, 0], [1, np.pi, 1], (envs.num_envs, 3)).astype(np.float32)
            else:
                actions = random.integers(envs.single_action_space.n, size=envs.num_envs)
            _, _, terminated, truncated, _ = envs.step(actions)
            if envs.autoreset_mode.name == "DISABLED" and (terminated | truncated).any():
                envs.reset(options={"reset_mask": terminated | truncated})
        return envs._logs

    def verify(self):
        done = subprocess.run([racebeam.program.path(), "verify", self.folder], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def rows(self):
        with open(self.folder / "results.csv", newline="") as file:
            return list(csv.DictReader(file))

    @pytest.mark.parametrize(
        "number, arguments",
        list(
            enumerate(
                (
                    {},
                    {"repeat_action_probability": 0.25, "frameskip": 5, "full_action_space": True},
                    {"full_action_space": "console"},
                    {"continuous": True, "continuous_action_threshold": 0.3, "repeat_action_probability": 0.25},
                    {"life_loss": "restart"},
                    {"life_loss": "reported"},
                    {"autoreset_mode": "Disabled", "difficulty": 1, "rules": "fixed"},
                    {"seed": 0, "repeat_action_probability": 0.25},
                )
            )
        ),
    )
    def test_games_are_confirmed(self, number, arguments):
        self.folder = pathlib.Path(self.scratch.name, str(number))
        logs = self.play(self.make(**arguments), 800)
        assert logs.logged >= 3
        assert logs.unlogged == 0
        if os.path.exists(harness.BINARY):
            status, output = self.verify()
            assert (status, output.split(",")[0]) == (0, f"{logs.logged} rows confirmed"), output

    def test_a_preset_of_the_literature_is_named(self):
        for preset in ("paper2013", "machado2018"):
            self.folder = pathlib.Path(self.scratch.name, preset)
            AtariVectorEnv("beamfall", 1, preset=preset, log={"folder": self.folder}).close()
            assert f'preset = "{preset}"' in (self.folder / "agent.toml").read_text()

    def test_each_environment_plays_a_trial_and_seeds_count_up(self):
        self.play(self.make(["beamfall", "updraft"], full_action_space=True), 400)
        rows = self.rows()
        assert {row["unit"] for row in rows} == {"beamfall-random-3", "updraft-random-4"}
        seeds = [int(row["environment_seed"]) for row in rows if row["game"] == "beamfall"]
        assert seeds == [7 + 2 * game for game in range(len(seeds))]
        assert len(seeds) > 1
        if os.path.exists(harness.BINARY):
            assert self.verify()[0] == 0

    @pytest.mark.needs_program
    def test_games_that_begin_without_a_reset_have_the_seed_of_the_constructor(self):
        envs = self.make(repeat_action_probability=0.25)
        random = np.random.default_rng(3)
        for _ in range(400):
            envs.step(random.integers(envs.single_action_space.n, size=3))
        assert (envs._logs.logged, envs._logs.unlogged) == (6, 0)
        assert [row["environment_seed"] for row in self.rows()] == ["7", "8", "9", "10", "11", "12"]
        assert self.verify()[0] == 0

    @pytest.mark.needs_program
    def test_1_follows_the_largest_seed(self):
        self.play(self.make("beamfall", 1, seed=2**32 - 2, max_num_frames_per_episode=40), 25)
        assert [row["environment_seed"] for row in self.rows()] == [str(2**32 - 2), "1"]
        assert self.verify()[0] == 0

    @pytest.mark.needs_program
    def test_a_reset_with_a_mask_leaves_the_other_games(self):
        envs = self.make(autoreset_mode="Disabled", max_num_frames_per_episode=40)
        envs.reset(seed=[11, 12, 13])
        for _ in range(3):
            envs.step([1, 1, 1])
        mask = np.array([False, True, False])
        with pytest.warns(UserWarning, match="a game of environment 1, beamfall, has no log") as found:
            envs.reset(options={"reset_mask": mask})
        assert [warning.filename for warning in found] == [__file__]
        for _ in range(12):  # those that are over stay so
            envs.step([1, 1, 1])
        assert (envs._logs.logged, envs._logs.unlogged) == (3, 1)
        rows = {row["trial"]: row for row in self.rows()}
        assert [rows[trial]["environment_seed"] for trial in "345"] == ["11", "15", "13"]
        assert {row["episode"] for row in self.rows()} == {"1"}
        assert self.verify()[0] == 0

    def test_a_game_with_too_many_actions_for_a_log_is_forgotten(self):
        envs = self.make("beamfall", 2, max_num_frames_per_episode=48)
        envs.reset()
        with unittest.mock.patch.object(played, "MOST_ACTS", 10):
            for _ in range(10):
                envs.step([1, 1])
            with pytest.warns(UserWarning, match="a game of environment [01], .* it has more than 10 acts$") as found:
                envs.step([1, 1])
            assert [warning.filename for warning in found] == [__file__] * 2
            envs.step([1, 1])  # both games end
        envs.step([1, 1])  # begins the next ones
        for _ in range(12):
            envs.step([1, 1])
        assert (envs._logs.logged, envs._logs.unlogged) == (2, 2)
        assert {row["episode"] for row in self.rows()} == {"1"}

    def test_an_agent_is_the_first_trial_with_seed_0_unless_named(self):
        for number, (about, words) in enumerate(
            (
                ({}, ("agent", "1", "0")),
                ({"agent": "a", "trial": 2**31 - 1, "agent_seed": 2**32 - 1}, ("a", "2147483647", "4294967295")),
            )
        ):
            self.folder = pathlib.Path(self.scratch.name, str(number))
            log = {"folder": self.folder, **about}
            self.play(AtariVectorEnv("beamfall", 1, log=log, **PLAIN | {"max_num_frames_per_episode": 40}), 12)
            row = self.rows()[0]
            assert (row["agent"], row["trial"], row["agent_seed"]) == words
        for about in ({"trial": 0}, {"trial": 2**31}, {"agent_seed": -1}, {"agent_seed": 2**32}):
            with pytest.raises(ValueError, match=f"{next(iter(about))} is "):
                self.make(about=about)

    def test_one_no_op_at_most_is_a_power_on(self):
        self.play(self.make("beamfall", 1, noop_max=1, max_num_frames_per_episode=40), 12)
        assert len(self.rows()) == 1
        with pytest.raises(InvalidInput, match="noop_max is 2; a log takes 0"):
            self.make("beamfall", 1, noop_max=2)

    @pytest.mark.needs_program
    def test_what_was_changed_is_refused(self):
        self.play(self.make(), 400)
        first, *others = self.rows()
        for change in ({"score": str(int(first["score"]) + 1)}, {"environment_seed": others[0]["environment_seed"]}):
            with open(self.folder / "results.csv", "w", newline="") as file:
                table = csv.DictWriter(file, first, lineterminator="\n")
                table.writeheader()
                table.writerows([first | change, *others])
            status, output = self.verify()
            assert status == 1
            assert f"not confirmed: {next(iter(change))} is" in output

    def test_a_game_in_which_a_state_was_restored_has_no_log(self):
        envs = self.make("beamfall", 1, repeat_action_probability=0.25)
        envs.reset()
        envs.step([1])
        state = envs.save(0)
        for _ in range(20):
            envs.step([1])
        envs.restore(0, state)
        with pytest.warns(UserWarning, match="has no log: the same actions lead to another end") as found:
            for _ in range(160):
                envs.step([2])
        assert {warning.filename for warning in found} == {__file__}

    def test_a_game_that_was_left_has_no_log(self):
        envs = self.make()
        envs.reset()
        envs.step([1, 1, 1])
        with pytest.warns(UserWarning, match="environment 0, beamfall, has no log: it was left before its end"):
            envs.reset()
        assert (envs.logged, envs.unlogged) == (0, 3)

    def test_games_with_a_log_are_counted(self):
        envs = self.make(max_num_frames_per_episode=8)
        assert (envs.logged, envs.unlogged) == (0, 0)
        self.play(envs, 6)
        assert (envs.logged, envs.unlogged) == (len(self.rows()), 0) == (6, 0)
        without = AtariVectorEnv("beamfall", 1)
        assert (without.logged, without.unlogged) == (0, 0)

    def test_what_a_log_cannot_repeat_is_refused_and_leaves_nothing(self, subtests):
        for arguments in (
            {"noop_max": 30},
            {"use_fire_reset": True},
            {"autoreset_mode": "SameStep"},
            {"start": "baselines"},
            {"life_loss": "end"},
            {"batch_size": 2},
            {"height": 220},
            {"about": {"phrase": "a phrase"}},
            {"about": {"nonsense": 1}},
            {"about": {"trial": "x"}},
            {"about": {"training_frames": b"x"}},
            {"about": {"agent": "../x"}},
        ):
            with subtests.test(**arguments), pytest.raises((InvalidInput, ValueError, TypeError)):
                self.make(**arguments)
            assert not self.folder.exists()
        for log in ({}, "mine", 5):
            with subtests.test(log=log), pytest.raises(TypeError, match="^log is .*; it takes a dict with folder"):
                AtariVectorEnv("beamfall", log=log, **PLAIN)

    def test_calls_that_would_leave_out_games_are_refused(self):
        envs = self.make()
        envs.reset()
        for call in (lambda: envs.send([0, 0, 0]), envs.xla):
            with pytest.raises(InvalidInput, match="does not write logs; with log, step"):
                call()

    def test_two_vectors_cannot_share_a_folder(self):
        self.make()
        with pytest.raises(FileExistsError):
            self.make()
