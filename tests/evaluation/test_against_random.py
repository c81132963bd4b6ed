"""Tests of an agent against random play."""

import dataclasses

import package

package.require()

from made_scores import FEW, results_of
from racebeam_evaluation import against_random, bootstrap
from racebeam_evaluation.games import CATALOGUE
from racebeam_evaluation.scores import scores_of


class TestAgainstRandom:
    def row(self, agent, scores):
        found = scores_of(results_of(scores | {("random", "pong"): [[0, 1, 2, 3]], ("random", "boxing"): [[5, 5, 5]]}))
        return against_random.rows(found, (agent,), FEW).iloc[0]

    def test_a_higher_mean_is_not_a_difference(self):
        row = self.row("basic", {("basic", "pong"): [[1], [3]], ("basic", "boxing"): [[90], [91], [92]]})
        assert (row["games"], row["above"]) == (2, 2)
        assert (row["significantly above"], row["significantly below"], row["not tested"]) == (1, 0, 0)
        assert (row["low"], row["high"]) == (1, 2)

    def test_a_single_trial_of_a_learner_is_not_tested_but_episodes_of_a_planner_are(self):
        row = self.row("basic", {("basic", "pong"): [[50, 60, 70]]})
        assert (row["significantly above"], row["not tested"]) == (0, 1)
        assert row[["low", "high"]].isna().all()
        row = self.row("uct", {("uct", "pong"): [[50, 60, 70]]})
        assert (row["significantly above"], row["not tested"]) == (1, 0)
        assert (row["low"], row["high"]) == (1, 1)

    def test_worse_than_random(self):
        row = self.row("uct", {("uct", "boxing"): [[1], [2], [1]]})
        assert (row["above"], row["significantly below"], row["low"], row["high"]) == (0, 1, 0, 0)

    def test_without_trials_or_random_play_there_is_nothing_to_compare(self):
        scores = scores_of(results_of({("basic", "pong"): [[1], [2]], ("random", "pong"): [[0]]}))
        assert len(against_random.rows(scores, ("basic",), FEW)) == 1
        assert against_random.rows(dataclasses.replace(scores, trials=None), ("basic",), FEW).empty
        without = scores_of(results_of({("basic", "pong"): [[1], [2]]}))
        assert against_random.rows(without, ("basic",), FEW).empty

    def test_the_mean_of_random_play_is_not_above_it(self):
        row = self.row("uct", {("uct", "boxing"): [[5], [5]], ("uct", "pong"): [[9, 9]]})
        assert (row["games"], row["above"], row["low"], row["high"]) == (2, 1, 1, 1)
        assert row["not tested"] == 1  # two samples that do not vary

    def test_a_single_episode_has_no_interval_and_no_test(self):
        row = self.row("uct", {("uct", "boxing"): [[5], [5]], ("uct", "pong"): [[9]]})
        assert (row["games"], row["above"], row["not tested"]) == (2, 1, 2)
        assert row[["low", "high"]].isna().all()

    def test_the_interval_is_that_of_coins(self):
        # Each of 15 games is above random play in 3/4 of the repetitions: the better of two draws is above 0.
        games = list(CATALOGUE)[:15]
        scores = {(agent, game): [[score] for score in (-1, 1)] for agent in ("uct",) for game in games}
        found = scores_of(results_of(scores | {("random", game): [[-0.5, -0.5]] for game in games}))
        for confidence, bounds in ((0.95, (8, 14)), (0, (11, 11))):
            row = against_random.rows(found, ("uct",), bootstrap.Bootstrap(1, 4000, confidence)).iloc[0]
            assert (row["above"], row["low"], row["high"]) == (15, *bounds)
