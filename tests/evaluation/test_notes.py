"""Sentences below tables say what is not in them."""

import dataclasses

import package

package.require()

import pandas as pd
from made_scores import curves_of, results_of
from racebeam_evaluation import notes, paired
from racebeam_evaluation.normalise import Ranges
from racebeam_evaluation.scores import Group, scores_of

BOTH = Group("learning", ("basic", "bass"))


def scores(trials):
    return scores_of(results_of({key: [[score] for score in values] for key, values in trials.items()}))


class TestNotes:
    def test_numbers_of_trials(self):
        for counts, sentences in (
            ((2, 2), ()),
            ((1, 3), ("basic has a game with 1 trial: no interval (n/a).",)),
            ((2, 3), ("basic has 2 to 3 trials: each game counts the same.",)),
        ):
            made = scores({("basic", game): range(count) for game, count in zip(("pong", "boxing"), counts)})
            assert notes.of_trials(made, Group("learning", ("basic",))) == sentences

    def test_games_that_are_not_aggregated(self):
        made = scores(
            {("basic", "pong"): (1, 2), ("bass", "pong"): (3, 4), ("bass", "alien"): (1, 2), ("ram", "boxing"): (1, 2)}
        )
        ranges = [
            Ranges("whole", pd.Series({"pong": 0.0}), pd.Series({"pong": 1.0})),
            Ranges("empty", pd.Series({"pong": 0.0}), pd.Series({"pong": 0.0}), ("A note of the range.",)),
        ]
        assert notes.of_aggregates(made, BOTH, ranges) == (
            "Not every agent has played alien: not aggregated.",
            "No empty score (n/a) in pong: the range is unknown or empty.",
            "A note of the range.",
        )

    def test_tables_that_are_left_out(self):
        learners = "The results lack learners: the tables learning-... are left out."
        planners = "The results lack planners: the tables planning-... are left out."
        baselines = "There are only baselines: the tables groups, -tests, -means and -improvement are left out."
        curves = "The results lack training episodes: the learning curves are left out."
        for agents, has_curves, sentences in (
            (("basic", "uct"), True, []),
            (("basic", "uct"), False, [curves]),
            (("basic", "random"), True, [planners]),
            (("uct",), True, [learners]),
            (("random",), False, [learners, planners, baselines, curves]),
        ):
            results = results_of({(agent, "pong"): [[1]] for agent in agents})
            results = dataclasses.replace(results, curves=curves_of([]) if has_curves else None)
            assert notes.of_left_out(scores_of(results), results) == sentences

    def test_games_that_one_of_a_pair_lacks(self):
        trials = {(agent, game): (1, 2) for agent in BOTH.agents for game in ("pong", "alien")}
        assert notes.of_lacking(paired.pairs(scores(trials), BOTH)) == ()
        trials |= {("bass", "boxing"): (1, 2), ("basic", "freeway"): (1, 2)}
        assert notes.of_lacking(paired.pairs(scores(trials), BOTH)) == (
            "basic and bass are compared in 2 games; only one of them has played freeway, boxing.",
        )

    def test_each_agent_with_too_few_trials_is_named_once(self):
        group = Group("learning", ("basic", "bass", "ram"))
        trials = {"pong": {"basic": 1, "bass": 1, "ram": 2}, "alien": {"basic": 2, "bass": 1, "ram": 2}}
        made = scores({(agent, game): range(trials[game][agent]) for game in trials for agent in group.agents})
        assert notes.of_untested(made, group, paired.pairs(made, group)) == [
            "Not tested: basic on pong has fewer than 2 trials; a test takes 2 or more.",
            "Not tested: bass on alien, pong has fewer than 2 trials; a test takes 2 or more.",
        ]

    def test_a_pair_without_variance_is_named(self):
        made = scores({("basic", "pong"): (1, 1), ("bass", "pong"): (2, 2)})
        assert notes.of_untested(made, BOTH, paired.pairs(made, BOTH)) == [
            "Not tested: basic and bass on pong have no variance; a test takes trials that differ."
        ]
