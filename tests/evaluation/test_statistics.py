"""Statistics of small samples, by hand or by rliable itself."""

import dataclasses

import package
import pytest

package.require()

import numpy as np
import pandas as pd
from racebeam_evaluation import against_random, aggregate, bootstrap, curves, efficiency, paired
from racebeam_evaluation.games import CATALOGUE
from racebeam_evaluation.normalise import Ranges, all_ranges, human_and_random
from racebeam_evaluation.reports import machado2018
from racebeam_evaluation.results import Results
from racebeam_evaluation.scores import Group, scores_of
from rliable import metrics

FEW = bootstrap.Bootstrap(seed=5, repetitions=200)


def results_of(scores, ends=None):
    """Results of {(agent, game): [scores of the episodes of each trial]}."""
    rows = [
        (game, "m", agent, trial, episode, score, "over")
        for (agent, game), trials in scores.items()
        for trial, episodes in enumerate(trials)
        for episode, score in enumerate(episodes)
    ]
    columns = ["game", "image_md5", "agent", "trial", "episode", "score", "end"]
    return Results(pd.DataFrame(rows + (ends or []), columns=columns), None, (), ())


def curves_of(episodes):
    """A frame of curves.csv of (game, agent, trial, episode, score, frames)."""
    return pd.DataFrame(episodes, columns=["game", "agent", "trial", "episode", "score", "frames"])


class TestScores:
    def test_a_score_is_the_mean_over_trials_of_their_means(self):
        scores = scores_of(results_of({("basic", "asterix"): [[1, 2, 3], [10]]}))
        assert scores.means.loc["asterix", "basic"] == 6
        assert scores.trial_scores("basic", "asterix").tolist() == [2, 10]

    def test_a_trial_that_diverged_is_in_no_mean_and_is_named(self):
        missing = [
            ("asterix", "m", "basic", 1, 0, float("nan"), "diverged"),
            ("boxing", "m", "ram", 0, 0, 7, "diverged"),
        ]
        scores = scores_of(results_of({("basic", "asterix"): [[4]], ("basic", "boxing"): [[5]]}, missing))
        assert scores.means["basic"].to_list() == [4, 5]
        assert "ram" not in scores.means
        assert scores.notes == (
            "Trial 1 of basic on asterix diverged, and is in no mean.",
            "Trial 0 of ram on boxing diverged, and is in no mean.",
        )

    def test_const_and_perturb_are_the_best_of_their_policies(self):
        results = {
            ("random", "boxing"): [[3]],
            ("const_0", "boxing"): [[4]],
            ("const_17", "boxing"): [[9]],
            ("perturb_2", "boxing"): [[5]],
            ("perturb_3", "boxing"): [[-5]],
            ("basic", "boxing"): [[0]],
        }
        scores = scores_of(results_of(results))
        assert scores.views.loc["boxing"].to_dict() == {"random": 3, "const": 9, "perturb": 5}
        assert list(scores.means) == ["basic"]

    def test_learners_and_planners_are_groups_and_baselines_alone_are_one(self):
        both = scores_of(
            results_of({(agent, "boxing"): [[1]] for agent in ("uct", "constant", "basic", "random", "const-3")})
        )
        assert [group.agents for group in both.groups] == [("basic", "constant"), ("uct",)]
        baselines = scores_of(results_of({(agent, "boxing"): [[1]] for agent in ("random", "const_upfire")}))
        assert [group.agents for group in baselines.groups] == [("random", "const")]

    def test_a_sample_is_of_the_policy_that_is_best_and_empty_without_scores(self):
        results = {("const_0", "boxing"): [[4, 5]], ("const_17", "boxing"): [[9], [11]], ("uct", "boxing"): [[1, 3]]}
        scores = scores_of(results_of(results | {("basic", "pong"): [[1, 3]]}))
        assert scores.sample("const", "boxing").tolist() == [9, 11]
        assert scores.sample("uct", "boxing").tolist() == [1, 3]  # the episodes
        assert scores.sample("basic", "pong").tolist() == [2]  # the mean of the trial
        assert len(scores.sample("basic", "boxing")) == len(scores.trial_scores("basic", "boxing")) == 0

    def test_agents_are_learners_then_planners_and_known_ones_are_first(self):
        names = ("iw1", "another", "ram", "uct", "basic", "mine")
        results = results_of({(agent, "boxing"): [[1]] for agent in names})
        roles = {"mine": "planner"}
        scores = scores_of(Results(results.episodes, None, (), (), roles=roles))
        assert list(scores.means) == ["basic", "ram", "another", "uct", "iw1", "mine"]

    def test_games_are_in_the_papers_order(self):
        scores = scores_of(results_of({("basic", game): [[1]] for game in ("beamfall", "alien", "freeway")}))
        assert list(scores.means.index) == ["freeway", "alien", "beamfall"]


class TestNormalisation:
    @pytest.fixture(autouse=True)
    def set_up(self):
        scores = {("random", "boxing"): [[-2]], ("random", "pong"): [[0]], ("random", "freeway"): [[5]]}
        scores |= {(f"const_{action}", game): [[action]] for action in range(18) for game in ("boxing", "freeway")}
        scores |= {
            (f"perturb_{action}", game): [[2 * action]] for action in range(18) for game in ("boxing", "freeway")
        }
        scores |= {("basic", game): [[score]] for game, score in (("boxing", 16), ("pong", 3), ("freeway", 1))}
        scores |= {("bass", game): [[score]] for game, score in (("boxing", 7), ("pong", 3), ("freeway", 2))}
        self.scores = scores_of(results_of(scores))
        self.ranges = {each.name: each for each in all_ranges(self.scores, Group("learning", ("basic", "bass")))}

    def of_basic(self, name):
        return self.ranges[name].normalise(self.scores.means)["basic"]

    def test_random(self):
        assert self.of_basic("random")["boxing"] == 8  # 16 / |-2|
        assert np.isnan(self.of_basic("random")["pong"])  # 3 / 0
        assert self.ranges["random"].without(["boxing", "pong"]) == ["pong"]

    def test_baseline(self):
        assert self.of_basic("baseline")["boxing"] == 18 / 36  # from random's -2 to perturb_17's 34
        assert self.ranges["baseline"].without(["boxing", "pong"]) == ["pong"]  # one reference is not a range
        assert self.ranges["baseline"].notes == ("Baseline scores: 1 game has 1 of the 37 references.",)

    def test_every_game_with_some_references_but_not_all_is_counted_in_a_note(self):
        def notes(references):
            scores = {(f"const_{number}", game): [[number]] for game, count in references for number in range(count)}
            ranges = all_ranges(scores_of(results_of(scores | {("basic", "pong"): [[1]]})), Group("made", ("basic",)))
            return next((each.notes for each in ranges if each.name == "baseline"), None)

        assert notes([("boxing", 2), ("freeway", 36), ("alien", 36), ("asterix", 37)]) == (
            "Baseline scores: 1 game has 2 of the 37 references.",
            "Baseline scores: 2 games have 36 of the 37 references.",
        )
        assert notes([("boxing", 37)]) == ()

    def test_a_normalisation_without_any_range_is_left_out(self):
        scores = scores_of(results_of({("basic", "beamfall"): [[1]], ("bass", "beamfall"): [[2]]}))
        assert [each.name for each in all_ranges(scores, Group("made", ("basic", "bass")))] == ["inter-algorithm"]
        assert [each.name for each in human_and_random(scores)] == ["human"]
        with_random = scores_of(results_of({("basic", "pong"): [[1]], ("random", "pong"): [[-20]]}))
        assert [each.name for each in human_and_random(with_random)] == ["human", "random"]

    def test_only_the_scores_between_the_agents_are_bounded(self):
        assert [each.name for each in self.ranges.values() if each.bounded] == ["inter-algorithm"]

    def test_inter_algorithm(self):
        assert self.of_basic("inter-algorithm")[["freeway", "boxing"]].to_list() == [0, 1]
        assert self.ranges["inter-algorithm"].without(["pong"]) == ["pong"]

    def test_human(self):
        assert self.of_basic("human")["boxing"] == pytest.approx((16 - 0.1) / (12.1 - 0.1), rel=0, abs=0.5e-7)

    def test_aggregates_name_what_has_no_range_and_never_mix_sets_silently(self):
        rows = aggregate.aggregate_rows(
            self.scores, self.ranges["inter-algorithm"], Group("learning", ("basic", "bass")), FEW
        )
        found = {(row.set, row.agent): (row.games, row[5]) for row in rows.itertuples()}
        assert found["training", "basic"] == (1, 0)
        assert found["testing", "basic"] == (1, 1)
        assert found["training + testing", "bass"] == (2, 1)


class TestDistribution:
    def test_aggregates_are_over_game_means_only_if_no_agent_has_trials(self):
        scores = scores_of(results_of({("basic", "pong"): [[1], [2]], ("random", "pong"): [[0], [1]]}))
        for agents, over in ((("basic", "random"), ""), (("random",), " over game means")):
            names = aggregate.statistics(scores, Group("made", agents))
            assert names == ["average", "median", f"IQM{over}", f"optimality gap{over}"]

    def test_a_share_counts_the_games_with_that_score_or_more(self):
        scores = scores_of(results_of({("basic", "pong"): [[2]], ("basic", "boxing"): [[8]]}))
        ranges = Ranges("made", pd.Series({"pong": 0.0, "boxing": 0}), pd.Series({"pong": 10.0, "boxing": 10}))
        rows = aggregate.distribution_rows(scores, ranges, Group("learning", ("basic",)))
        shares = [dict(zip(each["score"], each["share of games"])) for _, each in rows.groupby("set")]
        assert {0.2: 1, 0.8: 0.5} in shares

    def test_equal_scores_are_one_row_of_the_distribution(self):
        games = ("pong", "boxing", "freeway")
        scores = scores_of(results_of({("basic", game): [[score]] for game, score in zip(games, (5, 5, 10))}))
        ranges = Ranges("made", pd.Series(0.0, index=games), pd.Series(10.0, index=games))
        rows = aggregate.distribution_rows(scores, ranges, Group("learning", ("basic",)))
        of_all = rows[rows["set"] == "training + testing"]
        assert of_all[["score", "share of games"]].to_numpy().tolist() == [[0.5, 1], [1, 1 / 3]]
        assert rows.index.to_list() == list(range(len(rows)))

    def test_a_score_of_1_is_not_above_1(self):
        scores = {("basic", "pong"): [[10]], ("basic", "boxing"): [[10.5]], ("basic", "alien"): [[9]]}
        ranges = Ranges("made", pd.Series(0.0, index=GAMES), pd.Series(10.0, index=GAMES))
        rows = aggregate.aggregate_rows(scores_of(results_of(scores)), ranges, Group("learning", ("basic",)), FEW)
        assert rows["above 1"].to_list() == [1]
        assert rows[["games", "n/a"]].to_numpy().tolist() == [[3, 0]]

    def test_games_without_a_range_are_counted_and_a_set_without_one_has_no_row(self):
        scores = scores_of(results_of({("basic", game): [[1], [2]] for game in ("pong", "boxing", "freeway")}))
        ranges = Ranges("made", pd.Series({"pong": 0.0}), pd.Series({"pong": 2.0}))
        rows = aggregate.aggregate_rows(scores, ranges, Group("learning", ("basic",)), FEW)
        assert rows[["set", "games", "n/a"]].to_numpy().tolist() == [
            ["testing", 1, 1],
            ["training + testing", 1, 2],
        ]


GAMES = ("pong", "boxing", "alien")


class TestProfiles:
    SCORES = {("basic", game): [[score] for score in trials] for game, trials in zip(GAMES, ([1, 9], [2, 8], [3, 30]))}

    def rows(self, bounded=False):
        ranges = Ranges("made", pd.Series(0.0, index=GAMES), pd.Series(10.0, index=GAMES), bounded=bounded)
        scores = scores_of(results_of(self.SCORES | {("bass", game): [[0], [0]] for game in GAMES}))
        return aggregate.profile_rows(scores, ranges, Group("learning", ("basic", "bass")), FEW)

    def test_thresholds_go_to_2_and_to_1_where_no_score_is_higher(self):
        for bounded, last in ((False, 2), (True, 1)):
            rows = self.rows(bounded)
            np.testing.assert_allclose(rows["threshold"], [*np.arange(41) * last / 40] * 2)
            assert rows.index.to_list() == list(range(82))

    def test_the_share_of_trials_above_each_threshold_lies_in_its_interval(self):
        rows = self.rows()
        assert rows["agent"].to_list() == ["basic"] * 41 + ["bass"] * 41
        basic = rows[rows["agent"] == "basic"].set_index(rows["threshold"][:41].round(9))
        assert basic["share of trials"][[0, 0.5, 1, 2]].to_list() == [1, 0.5, 1 / 6, 1 / 6]
        assert basic.loc[0.25, ["low", "high"]].to_list() != [0.25, 0.25]
        assert (basic["low"] <= basic["share of trials"]).all() and (basic["share of trials"] <= basic["high"]).all()
        assert set(rows["set"]) == {"testing"} and set(rows["normalisation"]) == {"made"}


class TestImprovement:
    def rows(self, agents):
        scores = {(agent, "pong"): [[score] for score in trials] for agent, trials in agents.items()}
        return aggregate.improvement_rows(scores_of(results_of(scores)), Group("learning", tuple(agents)), FEW)

    def test_each_ordered_pair_with_two_trials_of_both_has_a_row(self):
        rows = self.rows({"basic": [1, 3], "bass": [2, 4], "ram": [9]})
        assert rows[["first", "second"]].to_numpy().tolist() == [["basic", "bass"], ["bass", "basic"]]
        assert rows["probability"].to_list() == [0.25, 0.75]
        assert rows.loc[0, ["probability low", "probability high"]].to_list() == [0, 1]
        assert set(rows["games"]) == {1}

    def test_agents_without_a_common_game_are_left_out(self):
        scores = scores_of(results_of({("basic", "pong"): [[1], [2]], ("bass", "boxing"): [[1], [2]]}))
        assert aggregate.improvement_rows(scores, Group("learning", ("basic", "bass")), FEW).empty


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
        assert single.value[2] == pytest.approx(
            5 / 6 * 1 + 1 / 6 * 2, rel=0, abs=0.5e-7
        )  # of the weights 4/3, 1/3 and 1/3, the middle half
        assert np.isnan(single.low).all()


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
        row = self.row("uct", {("uct", "pong"): [[50, 60, 70]]})
        assert (row["significantly above"], row["not tested"]) == (1, 0)

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
        row = self.row("uct", {("uct", "boxing"): [[5], [5]], ("uct", "pong"): [[9]]})
        assert (row["games"], row["above"], row["low"], row["high"]) == (2, 1, 1, 1)
        assert row["not tested"] == 2  # one sample, and two that do not vary

    def test_the_interval_is_that_of_coins(self):
        # Each of 15 games is above random play in 3/4 of the repetitions: the better of two draws is above 0.
        games = list(CATALOGUE)[:15]
        scores = {(agent, game): [[score] for score in (-1, 1)] for agent in ("uct",) for game in games}
        found = scores_of(results_of(scores | {("random", game): [[-0.5]] for game in games}))
        for confidence, bounds in ((0.95, (8, 14)), (0, (11, 11))):
            row = against_random.rows(found, ("uct",), bootstrap.Bootstrap(1, 4000, confidence)).iloc[0]
            assert (row["above"], row["low"], row["high"]) == (15, *bounds)


class TestEfficiency:
    RANGES = Ranges("made", pd.Series({"pong": 0.0, "boxing": 0}), pd.Series({"pong": 10.0, "boxing": 10}))

    def rows(self, frames, count):
        """Two trials in each of two games; an episode scores its number, and one more in the second trial."""
        episodes = [
            (game, "basic", trial, number, number + trial, frames)
            for game in ("pong", "boxing")
            for trial in (0, 1)
            for number in range(count)
        ]
        trained = curves_of(episodes).assign(decisions=frames // 5)
        return efficiency.rows(trained, self.RANGES, FEW)

    def test_short_training_has_ten_points(self):
        rows = self.rows(1000, 10)
        frames = rows[rows["axis"] == "frames"]
        assert frames["trained for"].to_list() == [1000 * part for part in range(1, 11)]
        # The trials have the means of 0 to 9 and of 1 to 10: 4.5 and 5.5; of the four, the middle two, by 10.
        assert frames["IQM"].iloc[-1] == pytest.approx(0.5, rel=0, abs=0.5e-7)
        assert frames["IQM"].iloc[0] == pytest.approx(0.05, rel=0, abs=0.5e-7)
        assert rows[rows["axis"] == "decisions"]["trained for"].to_list()[-1] == 2000

    def test_long_training_has_the_points_of_the_literature(self):
        rows = self.rows(1_000_000, 120)
        frames = rows[rows["axis"] == "frames"]
        assert frames["trained for"].to_list() == [10_000_000, 50_000_000, 100_000_000]
        assert frames["IQM"].iloc[2] == pytest.approx((49.5 + 0.5) / 10, rel=0, abs=0.5e-7)

    def test_an_episode_that_ends_beyond_a_point_has_reached_it(self):
        # Four episodes of 10 million frames: the fifth would have ended at 50 million.
        rows = self.rows(10_000_000, 4)
        assert rows[rows["axis"] == "frames"]["trained for"].to_list() == [10_000_000, 50_000_000]
        assert rows[rows["axis"] == "decisions"]["trained for"].to_list() == [800_000 * part for part in range(3, 11)]
        assert self.rows(10_000_000, 20)["trained for"].to_list()[:4] == [
            10_000_000,
            50_000_000,
            100_000_000,
            200_000_000,
        ]

    def test_training_that_reaches_one_point_only_has_ten_parts(self):
        rows = self.rows(1_000_000, 20)
        assert rows["trained for"].to_list()[:10] == [2_000_000 * part for part in range(1, 11)]

    def test_points_of_the_shortest_training_are_whole_and_not_0(self):
        rows = self.rows(1, 15)
        assert rows[rows["axis"] == "frames"]["trained for"].to_list() == [1, 3, 4, 6, 7, 9, 10, 12, 13, 15]
        rows = self.rows(5, 1)
        assert rows[rows["axis"] == "frames"]["trained for"].to_list() == [5]  # before it no episode has ended

    def test_games_that_not_all_were_trained_in_do_not_count(self):
        trained = curves_of(
            [("pong", "basic", 0, 0, 5, 100), ("pong", "bass", 0, 0, 7, 100), ("boxing", "bass", 0, 0, 9, 100)]
        )
        rows = efficiency.rows(trained, self.RANGES, FEW)
        assert set(rows["games"]) == {1}
        assert rows[rows["trained for"] == 100].set_index("agent")["IQM"].to_dict() == {"basic": 0.5, "bass": 0.7}


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
