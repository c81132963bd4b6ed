"""The scores that the paper prints give the figures that it prints."""

import csv
import os
import pathlib
import re

import package
import pytest

package.require()

from racebeam_evaluation import aggregate, paired
from racebeam_evaluation.bootstrap import Bootstrap
from racebeam_evaluation.games import DATA, PAPER, published
from racebeam_evaluation.normalise import all_ranges
from racebeam_evaluation.published.paper import paper_scores
from racebeam_evaluation.reports.paper2013 import columns

TEXT = pathlib.Path(os.environ.get("RACEBEAM_SHARED", package.SOURCE.parent / "shared")) / "paper/ale-paper.tex"
LEARNERS = ["basic", "bass", "disco", "lsh", "ram"]
ALL = "training + testing"


class TestMetrics:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls):
        cls.scores = paper_scores()
        cls.learning, cls.planning = cls.scores.groups
        cls.ranges = {each.name: each for each in all_ranges(cls.scores, cls.learning)}

    def aggregates(self, name):
        rows = aggregate.aggregate_rows(self.scores, self.ranges[name], self.learning, Bootstrap())
        return rows[rows["set"] == ALL].set_index("agent").loc[LEARNERS]

    def test_times_best(self):
        best, ties = paired.times_best(columns(self.scores, self.learning))
        assert best.to_list() == [6, 17, 1, 8, 8, 2, 9, 4]
        assert list(ties) == ["skiing"]
        best, ties = paired.times_best(columns(self.scores, self.planning))
        assert best.to_list() == [4, 45, 3, 3]
        assert list(ties) == ["boxing", "skiing"]

    def test_learners_above_baselines(self):
        above, equal, _ = paired.group_against(self.scores.columns(self.learning.agents), self.scores.views)
        assert (len(above), equal) == (39, ["skiing"])

    def test_planners_above_both(self):
        table = published("paper2013/planners")
        above, equal, _ = paired.group_against(table[["full_tree", "uct"]], table[["best_learner", "best_baseline"]])
        assert (len(above), equal) == (48, ["skiing"])

    def test_inter_algorithm_scores(self):
        rows = self.aggregates("inter-algorithm")
        assert rows["average"].round(3).to_list() == [0.534, 0.683, 0.197, 0.399, 0.570]
        assert rows["median"].round(3).to_list() == [0.483, 0.806, 0.000, 0.322, 0.539]
        assert set(rows["n/a"]) == {0}

    def test_baseline_scores_above_1(self):
        assert self.aggregates("baseline")["above 1"].to_list() == [31, 30, 22, 27, 29]

    def test_games_without_a_range(self):
        games = list(PAPER.index)
        assert self.ranges["random"].without(games) == ["freeway", "enduro", "skiing", "venture", "zaxxon"]
        assert self.ranges["baseline"].without(games) == ["skiing", "venture"]
        assert self.ranges["human"].without(games) == [
            "carnival",
            "elevator_action",
            "journey_escape",
            "pooyan",
            "skiing",
        ]

    def test_printed_paired_tests_have_room_in_the_counts_of_means(self):
        pairs = {(pair.first, pair.second): pair for pair in paired.pairs(self.scores, self.learning)}
        basic_bass, disco_ram = pairs["basic", "bass"], pairs["disco", "ram"]
        assert (len(basic_bass.higher), len(basic_bass.lower)) == (20, 35)
        assert (len(disco_ram.lower), len(disco_ram.higher)) == (45, 8)
        for row in published("paper2013/paired").reset_index().itertuples():
            pair = pairs[row.first, row.second]
            tied = len(pair.games) - len(pair.higher) - len(pair.lower)
            assert row.better <= len(pair.higher) + tied
            assert row.worse <= len(pair.lower) + tied

    def test_nothing_is_tested_without_trials(self):
        for pair in paired.pairs(self.scores, self.learning):
            assert (pair.better, pair.worse, pair.few) == ([], [], pair.games)

    def test_the_distribution_is_that_of_the_games(self):
        rows = aggregate.distribution_rows(self.scores, self.ranges["baseline"], self.learning)
        shares = rows[(rows["set"] == ALL) & (rows["score"] > 1)].groupby("agent")["share of games"].max()
        assert (shares[LEARNERS] * 53).round().astype(int).to_list() == [31, 30, 22, 27, 29]


class TestData:
    def test_the_games_are_those_of_the_catalogue(self):
        for file in sorted(DATA.glob("**/*.csv")):
            for game in published(str(file.relative_to(DATA).with_suffix(""))).index:
                if file.name not in ("paired.csv", "protocols.csv"):
                    assert (package.SOURCE / f"games/catalogue/{game}.toml").exists(), f"{file.name}: {game}"

    def test_the_sets(self):
        assert list(PAPER.index[PAPER["set"] == "training"]) == [
            "asterix",
            "beam_rider",
            "freeway",
            "seaquest",
            "space_invaders",
        ]
        assert (PAPER["set"] == "testing").sum() == 50
        assert len(published("human")) == 57

    def test_successors(self):
        successors = published("successors")
        assert successors.loc["asterix"].to_list() == [153400, 3996.6]
        assert successors.count().to_list() == [54, 52]

    def test_machado2018(self):
        theirs = published("machado2018")
        assert theirs["agent"].value_counts().to_dict() == {"dqn": 60, "blob_prost": 60}
        assert set(published("atari57").index) - set(theirs.index) == {"surround"}
        assert len(theirs.select_dtypes("number").columns) == 8
        assert not theirs.isna().any(axis=None)

    def test_a_beginner(self):
        assert published("paper2013/human")["human"].to_dict() == {
            "asterix": 620,
            "seaquest": 156,
            "boxing": -2,
            "hero": 6087,
            "zaxxon": 820,
        }

    @pytest.mark.skipif(not TEXT.exists(), reason="the paper's source text is not here")
    def test_the_files_are_the_papers_tables(self):
        text = TEXT.read_text()
        titles = list(PAPER["title"])
        for name, table in (("learners", "allRLResults"), ("planners", "allSearchResults")):
            table_text = printed_table(text, table)
            with open(DATA / f"paper2013/{name}.csv", newline="") as file:
                ours = list(csv.reader(file))[1:]
            assert [title.replace("Ms. Pacman", "Ms. Pac-Man") for title, _ in table_text] == titles
            assert [row[0] for row in ours] == list(PAPER.index)
            assert [row[1:] for row in ours] == [cells for _, cells in table_text]
        beginner = {title: float(cells[-1]) for title, cells in printed_table(text, "selectedRLResults")}
        assert beginner == {
            PAPER["title"][game]: score for game, score in published("paper2013/human")["human"].items()
        }

    @pytest.mark.skipif(not TEXT.exists(), reason="the paper's source text is not here")
    def test_the_file_is_the_papers_table_of_paired_tests(self):
        text = TEXT.read_text().split("% Left = first")[1].split("% Top = first")[0]
        rows = {
            name.lower(): re.findall(r"(\d+)--(\d+)|---", cells) for name, cells in re.findall(r"(\w+) &(.*)\\\\", text)
        }
        assert list(rows) == LEARNERS
        for row in published("paper2013/paired").reset_index().itertuples():
            there, back = rows[row.first][LEARNERS.index(row.second)], rows[row.second][LEARNERS.index(row.first)]
            assert tuple(map(int, there)) == (row.better, row.worse)
            assert tuple(map(int, back)) == (row.worse, row.better)


def printed_table(text, name):
    """The rows of games of a table in the paper's source: title, and cells without the marks of bold type."""
    body = text.split(f"%% file: tables/{name}.tex")[1].split(r"\end{tabular}")[0]
    return [
        (title, [re.sub(r"\\textbf\s*\{|\}", "", cell).strip() for cell in cells.split("&")])
        for title, cells in re.findall(r"\\gamename\{(.*?)\} &(.*)\\\\", body)
    ]
