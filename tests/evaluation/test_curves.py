"""Learning curves, and the checkpoints of Machado et al. 2018."""

import package
import pytest

package.require()

import numpy as np
import pandas as pd
from made_scores import curves_of
from racebeam_evaluation import curves
from racebeam_evaluation.reports import machado2018


class TestCurves:
    def test_a_curve_is_the_mean_of_trials_in_stretches_of_frames(self):
        episodes = [
            ("pong", "basic", trial, episode, score, 50)
            for trial, scores in enumerate(([1, 3], [5, 7]))
            for episode, score in enumerate(scores)
        ]
        rows = curves.learning_curves(curves_of(episodes))
        assert rows["frames"].to_list() == [50, 100]
        assert rows["score"].to_list() == [3, 5]
        assert rows["standard error"].to_list() == [2, 2]

    def test_a_stretch_is_a_fiftieth_of_the_longest_training(self):
        episodes = [("pong", "basic", 0, number, number, 10) for number in range(1, 101)]
        episodes += [("pong", "bass", 0, 1, 7, 0), ("alien", "basic", 0, 1, 5, 80)]
        rows = curves.learning_curves(curves_of(episodes))
        assert rows["game"].to_list() == ["alien"] + ["pong"] * 51
        assert rows["agent"].to_list() == ["basic"] * 51 + ["bass"]
        assert rows["trials"].to_list() == [1] * 52
        basic = rows[(rows["game"] == "pong") & (rows["agent"] == "basic")]
        assert basic["frames"].to_list() == [20 * stretch for stretch in range(1, 51)]
        assert basic["score"].to_list() == [2 * stretch - 0.5 for stretch in range(1, 51)]
        # An episode without frames is in the first stretch. One trial has no error.
        assert rows.loc[51, ["frames", "score"]].to_list() == [20, 7]
        assert rows["standard error"].isna().all()

    def test_a_game_without_frames_has_one_stretch(self):
        rows = curves.learning_curves(curves_of([("pong", "dqn", 0, 0, 4, 0), ("pong", "dqn", 1, 0, 6, 0)]))
        assert rows[["frames", "trials", "score"]].values.tolist() == [[0, 2, 5]]

    def test_a_checkpoint_needs_100_episodes_unless_fewer_are_enough(self):
        def trial(count, **others):
            return pd.DataFrame({"trained": range(1, count + 1), "score": range(count)}).assign(**others)

        assert curves.checkpoint(trial(100), 100) == 49.5
        assert np.isnan(curves.checkpoint(trial(100), 99))
        assert curves.checkpoint(trial(5), 2, fewest=2) == 0.5
        assert np.isnan(curves.checkpoint(trial(5), 1, fewest=2))
        assert curves.checkpoint(trial(5, window=2), 4) == 2.5  # rows that are means of many episodes
        assert curves.checkpoint(trial(1, window=1), 1) == 0
        assert np.isnan(curves.checkpoint(trial(5, window=[2, None, 2, 2, 2]), 4))

    def test_checkpoints_take_the_last_100_episodes_that_ended_before(self):
        # Episodes of 10,000 frames: the 1,000th ends at 10 million frames. The score is the number of the episode.
        episodes = [
            ("pong", "basic", trial, number, number + trial, 10_000) for trial in (0, 2) for number in range(1, 1101)
        ]
        row = machado2018.checkpoints(curves_of(episodes)).iloc[0]
        assert row["10 M"] == (901 + 1000) / 2 + 1
        assert row["10 M deviation"] == pytest.approx(np.sqrt(2), rel=0, abs=0.5e-7)
        assert (row["10 M trials"], row["50 M trials"]) == (2, 0)
        assert np.isnan(row["50 M"])

    def test_a_checkpoint_is_reached_if_the_last_whole_episode_ends_just_before(self):
        for frames, count in ((9_990, 1), (9_980, 0)):  # of 1,000 episodes: 10,000 and 20,000 short of 10 million
            episodes = [("pong", "basic", 0, number, 1, frames) for number in range(1000)]
            assert machado2018.checkpoints(curves_of(episodes)).iloc[0]["10 M trials"] == count
