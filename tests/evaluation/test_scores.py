"""Scores of agents, from the rows of their results."""

import package

package.require()

from made_scores import results_of
from racebeam_evaluation.results import Results
from racebeam_evaluation.scores import scores_of


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
