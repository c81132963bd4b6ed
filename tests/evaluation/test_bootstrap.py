"""Aggregates of small samples and their intervals, by hand or by rliable itself."""

import package
import pytest

package.require()

import numpy as np
import pandas as pd
from made_scores import FEW, results_of
from racebeam_evaluation import aggregate, bootstrap
from racebeam_evaluation.normalise import Ranges
from racebeam_evaluation.scores import Group, scores_of
from rliable import metrics


class TestBootstrap:
    @pytest.fixture(autouse=True)
    def set_up(self):
        generator = np.random.default_rng(3)
        self.first, self.second = generator.normal(1, 1, (6, 5)), generator.normal(0.5, 1, (4, 5))
        self.first[0] = self.second[0] = 2  # ties

    def test_improvement_is_that_of_rliable(self):
        for pair in ((self.first, self.second), (self.second, self.first), (self.first, self.first)):
            assert float(bootstrap.improvement(*pair)[0]) == pytest.approx(
                metrics.probability_of_improvement(*pair), rel=0, abs=0.5e-7
            )

    def test_a_profile_is_the_share_above_each_threshold(self):
        shares = bootstrap.profile(np.array([0.0, 1, 2]))(np.array([[0.0, 1], [2, 3]]))
        assert shares.tolist() == [0.75, 0.5, 0.25]

    def test_the_interquartile_mean_and_the_optimality_gap(self):
        scores = np.array([[0.0, 0.4], [0.6, 100]])
        # Means of games 0.3 and 50.2; the middle half 0.4 and 0.6; 1 - (0 + 0.4 + 0.6 + 1) / 4.
        assert bootstrap.aggregates(scores).round(9).tolist() == [25.25, 25.25, 0.5, 0.5]

    def test_each_aggregate_has_its_own_number(self):
        # Two games of four trials. The middle half of 0 0 1 1 2 3 8 9 is 1 1 2 3: 1.75. The gap is 1 - 6 / 8.
        scores = np.array([[0.0, 1], [0, 1], [2, 8], [3, 9]])
        average, median, iqm, gap = bootstrap.aggregates(scores)
        assert (average, median, iqm, gap) == (3, 3, 1.75, 0.25)
        assert bootstrap.AGGREGATES == ("average", "median", "IQM", "optimality gap")

    def test_the_mean_of_three_trials_is_not_their_median(self):
        scores = scores_of(results_of({("basic", "pong"): [[0], [1], [8]]}))
        assert scores.means.loc["pong", "basic"] == 3
        assert bootstrap.aggregates(np.array([[0.0], [1], [8]])).round(9).tolist()[:2] == [3, 3]

    def test_the_median_is_that_of_games_and_not_of_trials(self):
        assert bootstrap.aggregates(np.array([[0.0, 1, 5], [2, 1, 90]]))[1] == 1

    def test_the_seed_decides_and_the_global_generator_is_put_back(self):
        np.random.seed(1)
        before = np.random.get_state()[1].tolist()
        one, same, other = (
            bootstrap.Bootstrap(seed, 50).estimate(bootstrap.aggregates, self.first) for seed in (1, 1, 2)
        )
        assert (one.low.tolist(), one.high.tolist()) == (same.low.tolist(), same.high.tolist())
        assert one.low.tolist() != other.low.tolist()
        assert np.random.get_state()[1].tolist() == before

    def test_an_interval_contains_its_value_and_needs_two_trials(self):
        estimate = FEW.estimate(bootstrap.aggregates, self.first)
        assert (estimate.low < estimate.value).all() and (estimate.value < estimate.high).all()
        single = FEW.estimate(bootstrap.aggregates, self.first[:1])
        assert np.isnan(single.low).all() and np.isnan(single.high).all() and not np.isnan(single.value).any()

    def test_an_interval_of_two_agents_needs_two_trials_of_each(self):
        for pair in ((self.first, self.second[:1]), (self.first[:1], self.second)):
            estimate = FEW.estimate(bootstrap.improvement, *pair)
            assert estimate.value.tolist() == bootstrap.improvement(*pair).tolist()
            assert np.isnan(estimate.low).all() and np.isnan(estimate.high).all()

    def test_low_and_high_are_the_bounds_of_the_interval(self):
        # One game, whose trials are 0 or 1 alike: the mean of n draws is binomial. 95 % of 16 draws are 4 to 12.
        estimate = bootstrap.Bootstrap(seed=1, repetitions=4000).estimate(
            bootstrap.aggregates, np.array([[0.0], [1]] * 8)
        )
        assert (estimate.low[0], estimate.value[0], estimate.high[0]) == (4 / 16, 8 / 16, 12 / 16)
        scores = scores_of(results_of({("basic", "pong"): [[trial % 2] for trial in range(16)]}))
        ranges = Ranges("made", pd.Series({"pong": 0.0}), pd.Series({"pong": 1.0}))
        rows = aggregate.aggregate_rows(scores, ranges, Group("learning", ("basic",)), bootstrap.Bootstrap(1, 4000))
        assert rows.loc[0, ["average low", "average", "average high"]].to_list() == [4 / 16, 8 / 16, 12 / 16]
        assert rows.loc[0, ["median low", "median high"]].to_list() == [4 / 16, 12 / 16]
        assert rows.loc[0, ["optimality gap low", "optimality gap high"]].to_list() == [4 / 16, 12 / 16]

    def test_an_interval_has_95_percent_in_2000_repetitions_unless_told(self):
        assert bootstrap.Bootstrap() == bootstrap.Bootstrap(seed=1, repetitions=2000, confidence=0.95)

    def test_an_interval_without_confidence_is_the_middle(self):
        uneven = bootstrap.padded([self.first[:, 0], self.second[:, 1]])
        estimate = bootstrap.Bootstrap(repetitions=301, confidence=0).estimate(bootstrap.aggregates, uneven)
        assert estimate.low.tolist() == estimate.high.tolist()

    def test_the_bootstrap_is_stratified_by_game(self):
        constant_in_each_game = np.array([[1.0, 2, 4]] * 5)
        estimate = FEW.estimate(bootstrap.aggregates, constant_in_each_game)
        assert estimate.low.tolist() == estimate.value.tolist()

    def test_uneven_trials_are_all_used(self):
        scores = scores_of(results_of({("basic", "pong"): [[1], [2], [3]], ("basic", "boxing"): [[4], [5]]}))
        np.testing.assert_array_equal(
            aggregate.matrix(scores, "basic", ["pong", "boxing"]), [[1, 4], [2, 5], [3, np.nan]]
        )
        ranges = Ranges("made", pd.Series({"pong": 1.0, "boxing": 0}), pd.Series({"pong": 3.0, "boxing": 10}))
        np.testing.assert_array_equal(
            aggregate.normalised_matrix(scores, ranges, "basic", ["pong", "boxing"]),
            [[0, 0.4], [0.5, 0.5], [1, np.nan]],
        )

    def test_games_with_different_numbers_of_trials_count_the_same(self):
        games = self.first[:4, :3]  # three games of four trials; the second has each of two twice
        games[2:, 1] = games[:2, 1]
        uneven = bootstrap.padded([games[:, 0], games[:2, 1], games[:, 2]])
        for function in (
            bootstrap.aggregates,
            bootstrap.profile(np.array([0.0, 1, 2])),
            lambda scores: bootstrap.improvement(scores, self.second[:, :3]),
            lambda scores: bootstrap.improvement(self.second[:, :3], scores),
        ):
            np.testing.assert_allclose(function(uneven), function(games))

    def test_uneven_trials_have_intervals_which_the_seed_decides(self):
        uneven = bootstrap.padded([self.first[:, 0], self.second[:, 1], self.first[:2, 2]])
        one, same, other = (bootstrap.Bootstrap(seed, 200).estimate(bootstrap.aggregates, uneven) for seed in (1, 1, 2))
        assert (one.low < one.value).all() and (one.value < one.high).all()
        assert (one.low.tolist(), one.high.tolist()) == (same.low.tolist(), same.high.tolist())
        assert one.low.tolist() != other.low.tolist()
        constant = FEW.estimate(bootstrap.aggregates, bootstrap.padded([np.ones(5), np.full(3, 2.0)]))
        assert constant.low.tolist() == constant.high.tolist()
        single = FEW.estimate(bootstrap.aggregates, bootstrap.padded([np.ones(1), np.array([1.0, 2, 3])]))
        # The middle half of the weights 4/3, 1/3 and 1/3.
        assert single.value[2] == pytest.approx(5 / 6 * 1 + 1 / 6 * 2, rel=0, abs=0.5e-7)
        assert np.isnan(single.low).all()
