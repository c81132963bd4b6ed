"""Tests of two agents, game by game."""

import package
import pytest

package.require()

import numpy as np
import pandas as pd
from made_scores import results_of
from racebeam_evaluation import paired
from racebeam_evaluation.scores import Group, scores_of


class TestPaired:
    def verdicts(self, first, second):
        (pair,) = paired.pairs(
            scores_of(
                results_of(
                    {("basic", "pong"): [[score] for score in first], ("bass", "pong"): [[score] for score in second]}
                )
            ),
            Group("learning", ("basic", "bass")),
        )
        return [name for name in ("better", "worse", "few", "constant") if getattr(pair, name)]

    def test_welch_by_hand(self):
        # Means 2 and 5; variances of the means 1/3 and 4/3; t = -3 / sqrt(5/3); Welch's degrees of freedom 50/17.
        # The density of t, integrated numerically, gives 0.104479.
        assert paired.welch(np.array([1.0, 2, 3]), np.array([3.0, 5, 7])) == pytest.approx(0.104479, rel=0, abs=0.5e-6)

    def test_only_significant_differences_count(self):
        assert self.verdicts([1, 2, 3], [3, 5, 7]) == []
        assert self.verdicts([1, 2, 3, 2], [30, 31, 32, 33]) == ["worse"]
        assert self.verdicts([30, 31, 32, 33], [1, 2, 3, 2]) == ["better"]
        assert self.verdicts([30, 31, 32, 33], [1, 1]) == ["better"]

    def test_the_level_is_1_percent_and_not_5(self):
        first, second = [1, 2, 3, 4], [4, 5, 5.5, 7]
        assert 0.01 < paired.welch(np.array(first), np.array(second)) < 0.05
        assert self.verdicts(first, second) == []
        assert paired.SIGNIFICANCE == 0.01

    def test_a_value_at_the_level_is_not_significant(self, monkeypatch):
        first, second = [1, 2, 3, 4], [4, 5, 5.5, 7]
        p = paired.welch(np.array(first), np.array(second))
        for level, expected in ((p, []), (np.nextafter(p, 1), ["worse"])):
            monkeypatch.setattr(paired, "SIGNIFICANCE", level)
            assert self.verdicts(first, second) == expected

    def test_what_cannot_be_tested_is_noted(self):
        assert self.verdicts([1], [2, 3]) == ["few"]
        assert self.verdicts([1, 1], [2, 2, 2]) == ["constant"]

    def test_pairs_use_the_games_that_both_have(self):
        scores = {("basic", "pong"): [[1], [2]], ("bass", "pong"): [[1], [3]], ("bass", "boxing"): [[9], [8]]}
        (pair,) = paired.pairs(scores_of(results_of(scores)), Group("learning", ("basic", "bass")))
        assert (pair.games, pair.lacking) == (["pong"], ["boxing"])

    def test_a_game_that_neither_has_is_lacking_in_neither(self):
        scores = {("basic", "pong"): [[1], [2]], ("bass", "pong"): [[1], [2]], ("ram", "alien"): [[9], [8]]}
        (pair,) = paired.pairs(scores_of(results_of(scores)), Group("learning", ("basic", "bass")))
        assert (pair.games, pair.lacking, pair.higher, pair.lower) == (["pong"], [], [], [])

    def test_the_table_says_where_nothing_was_tested(self):
        scores = scores_of(
            results_of({("basic", "pong"): [[1], [2]], ("bass", "pong"): [[5]], ("ram", "boxing"): [[5], [6]]})
        )
        agents = ("basic", "bass", "ram")
        found = paired.pairs(scores, Group("learning", agents))
        assert paired.counts(found, agents, "better", "worse", "tested")["bass"].to_list() == ["n/a", "---", "n/a"]
        assert paired.counts(found, agents, "higher", "lower", "games")["bass"].to_list() == ["0--1", "---", "n/a"]

    def test_a_game_in_which_two_groups_tie_is_only_equal(self):
        first = pd.DataFrame({"a": [1.0, 2, 3], "b": [5.0, 0, 0]}, index=["x", "y", "z"])
        second = pd.DataFrame({"c": [4.0, 2, 9], "d": [0.0, 1, 0]}, index=["x", "y", "z"])
        assert paired.group_against(first, second) == (["x"], ["y"], ["z"])

    def test_the_first_of_a_tie_is_best(self):
        best, ties = paired.times_best(pd.DataFrame({"a": [1.0, 5], "b": [1.0, 6], "c": [0.0, 6]}, index=["x", "y"]))
        assert best.to_dict() == {"a": 1, "b": 1, "c": 0}
        assert ties == {"x": ["a", "b"], "y": ["b", "c"]}
