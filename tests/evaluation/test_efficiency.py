"""Sample efficiency."""

import package
import pytest

package.require()

import pandas as pd
from made_scores import FEW, curves_of
from racebeam_evaluation import efficiency
from racebeam_evaluation.normalise import Ranges


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

    def test_a_point_has_a_row_only_if_an_episode_of_each_game_has_ended(self):
        short, long = [("pong", "basic", 0, number, 5, 10) for number in range(10)], [("boxing", "basic", 0, 0, 5, 100)]
        rows = efficiency.rows(curves_of(short + long), self.RANGES, FEW)
        assert rows["trained for"].to_list() == [100]

    def test_games_that_not_all_were_trained_in_do_not_count(self):
        trained = curves_of(
            [("pong", "basic", 0, 0, 5, 100), ("pong", "bass", 0, 0, 7, 100), ("boxing", "bass", 0, 0, 9, 100)]
        )
        rows = efficiency.rows(trained, self.RANGES, FEW)
        assert set(rows["games"]) == {1}
        assert rows[rows["trained for"] == 100].set_index("agent")["IQM"].to_dict() == {"basic": 0.5, "bass": 0.7}
