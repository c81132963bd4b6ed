"""Rows of aggregates, distributions, profiles and probabilities of improvement."""

import dataclasses

import package

package.require()

import numpy as np
import pandas as pd
from made_scores import FEW, results_of
from racebeam_evaluation import aggregate
from racebeam_evaluation.normalise import Ranges
from racebeam_evaluation.scores import Group, scores_of

GAMES = ("pong", "boxing", "alien")


class TestMatrix:
    def test_an_agent_has_a_row_for_each_trial_and_a_view_or_means_only_one(self):
        scores = scores_of(results_of({("basic", "pong"): [[1], [3]], ("random", "pong"): [[2], [6]]}))
        means = dataclasses.replace(scores, trials=None)
        for source, agent, rows in ((scores, "basic", [[1], [3]]), (scores, "random", [[4]]), (means, "basic", [[2]])):
            assert aggregate.matrix(source, agent, ["pong"]).tolist() == rows


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
