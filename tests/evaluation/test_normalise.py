"""Normalised scores."""

import package
import pytest

package.require()

import numpy as np
from made_scores import FEW, results_of
from racebeam_evaluation import aggregate
from racebeam_evaluation.normalise import all_ranges, human_and_random
from racebeam_evaluation.scores import Group, scores_of


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
