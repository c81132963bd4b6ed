"""The reports have all that docs/evaluation.md lists, and the same input gives the same bytes."""

import hashlib
import pathlib
import re
import tempfile
import xml.etree.ElementTree

import package
import pytest

package.require()

import pandas as pd
from made_results import CURVES, curve, evaluate, results_of, tables, write
from racebeam_evaluation.output.figure import intervals

GAMES = ("asterix", "freeway", "boxing", "pong")
GROUPS = ("scores", "times-best", "normalised", "aggregates", "distribution", "profiles")
OF_TRIALS = ("tests", "means", "improvement")


def made_up():
    """Scores of two learners, a planner and all baselines, in four games."""
    policies = ["random", *(f"{kind}_{action}" for kind in ("const", "perturb") for action in range(18))]
    scores = {
        (policy, game): [[(7 * number + 3 * column) % 11, number]]
        for number, policy in enumerate(policies)
        for column, game in enumerate(GAMES)
    }
    for number, agent in enumerate(("basic", "bass", "full_tree", "uct")):
        for column, game in enumerate(GAMES):
            scores[agent, game] = [[10 * number + column + trial, 5 + trial] for trial in range(3)]
    return scores


def curves_of(agents, frames=10_000, episodes=1001):
    return [
        curve(game, agent, trial, episode, (episode + trial) % 7, frames)
        for game in GAMES[:2]
        for agent in agents
        for trial in range(2)
        for episode in range(episodes)
    ]


def read(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


class TestReports:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("reports")
        cls.root = folder
        cls.results = write(cls.root / "results", results_of(made_up()), curves_of(("basic", "bass")))
        cls.digest = hashlib.sha256((cls.results / "results.csv").read_bytes()).hexdigest()
        cls.files = cls.evaluated("once")

    @classmethod
    def evaluated(cls, name, *arguments):
        done = evaluate(*arguments or [cls.results], "--into", cls.root / name)
        if done.returncode:
            raise AssertionError(done.stderr)
        return read(cls.root / name)

    def test_every_table_is_there_in_three_forms(self):
        names = [f"{group}-{table}" for group in ("learning", "planning") for table in GROUPS + OF_TRIALS]
        for name in [
            *names,
            "groups",
            "above-random",
            "published",
            "published-settings",
            "efficiency",
            "learning-curves",
        ]:
            for form in ("csv", "md", "tex"):
                assert f"tables/{name}.{form}" in self.files

    def test_every_figure_is_there_in_two_forms_and_is_one(self):
        names = [
            f"{group}-{figure}"
            for group in ("learning", "planning")
            for figure in ("normalised", "aggregates", "intervals", "distribution", "profiles", "improvement")
        ]
        for name in [*names, "efficiency", "learning-curves"]:
            assert self.files[f"figures/{name}.png"][:8] == b"\x89PNG\r\n\x1a\n"
            assert xml.etree.ElementTree.fromstring(self.files[f"figures/{name}.svg"]).tag.endswith("svg")

    def test_intervals_are_whole_in_their_panels(self):
        rows = {"normalisation": ["human"], "agent": ["one"], "IQM": [0.5], "IQM low": [0.3], "IQM high": [0.8]}
        [axes] = intervals(pd.DataFrame(rows), ["IQM"]).axes
        assert axes.get_xlim()[0] < 0.3
        assert axes.get_xlim()[1] > 0.8
        assert axes.get_title() == "IQM\nhuman"

    def test_tables_name_what_they_were_made_from(self):
        for name, content in self.files.items():
            if name.startswith("tables/") and "curves" not in name and "efficiency" not in name:
                assert f"made from results.csv sha256:{self.digest}" in content.decode(), name
        curves = hashlib.sha256((self.results / "curves.csv").read_bytes()).hexdigest()
        assert f"made from curves.csv sha256:{curves}".encode() in self.files["tables/learning-curves.csv"]

    def test_links_of_the_document_exist(self):
        links = re.findall(r"\]\((.*?)\)", self.files["report.md"].decode())
        assert len(links) > 8
        for link in links:
            assert link in self.files

    def test_the_document_says_which_sets_it_has(self):
        text = self.files["report.md"].decode()
        assert "Games: 2 of the training set, 2 of the testing set." in text
        assert "| inter-algorithm | training + testing | basic | 4 |" in text

    def test_the_three_forms_say_the_same(self):
        csv, markdown, latex = (self.files[f"tables/learning-scores.{form}"].decode() for form in ("csv", "md", "tex"))
        assert "\nset,game,basic,bass,random,const,perturb\ntraining,asterix,3.5,8.5,0,13,23\n" in csv
        assert "| training | asterix | 3.5 | 8.5 | 0.0 | 13.0 | **23.0** |" in markdown
        assert r"training & asterix & 3.5 & 8.5 & 0.0 & 13.0 & \textbf{23.0} \\" in latex

    def test_the_same_input_gives_the_same_bytes(self):
        again = self.evaluated("again")
        assert sorted(again) == sorted(self.files)
        assert [name for name in again if again[name] != self.files[name]] == []

    def test_the_order_of_the_rows_changes_digests_alone(self):
        folder = write(self.root / "reversed", reversed(results_of(made_up())), curves_of(("basic", "bass")))
        other = hashlib.sha256((folder / "results.csv").read_bytes()).hexdigest()
        found = tables(folder)
        assert len(found) == sum(name.startswith("tables/") for name in self.files)
        for name, text in found.items():
            assert text.replace(other, self.digest) == self.files[f"tables/{name}"].decode(), name

    def test_two_folders_are_evaluated_together(self):
        halves = [
            {key: value for key, value in made_up().items() if (key[0] == "bass") == is_bass}
            for is_bass in (True, False)
        ]
        scores = tables(*(write(self.root / f"half{number}", results_of(half)) for number, half in enumerate(halves)))[
            "learning-scores.csv"
        ]
        assert scores.count("made from results.csv sha256:") == 2
        assert scores.split("set,")[1] == self.files["tables/learning-scores.csv"].decode().split("set,")[1]

    def test_baselines_alone(self):
        lines = results_of(
            {key: value for key, value in made_up().items() if key[0].split("_")[0] in ("random", "const")}
        )
        found = tables(write(self.root / "alone", lines))
        assert "set,game,random,const\n" in found["baselines-scores.csv"]
        assert "baselines-tests.csv" not in found

    def test_experiments_without_learners(self):
        for kinds, groups, sentences in (
            (
                ("random", "const"),
                {"baselines"},
                (
                    "The results lack learners: the tables learning-... are left out.",
                    "The results lack planners: the tables planning-... are left out.",
                    "There are only baselines: the tables groups, -tests,",
                ),
            ),
            (("full", "uct"), {"planning"}, ("The results lack learners: the tables learning-... are left out.",)),
            (
                ("random", "full", "uct"),
                {"planning"},
                ("The results lack learners: the tables learning-... are left out.",),
            ),
        ):
            lines = results_of({key: value for key, value in made_up().items() if key[0].split("_")[0] in kinds})
            name = "-".join(kinds)
            folder = write(self.root / name, lines)
            (folder / "curves.csv").write_text(CURVES + "\n")  # as racebeam experiment leaves it
            files = self.evaluated(name + "-report", folder)
            tables = {file.split("/")[1] for file in files if file.startswith("tables/")}
            assert {
                group for group in ("learning", "planning", "baselines") if f"{group}-scores.csv" in tables
            } == groups
            assert "learning-curves.csv" not in tables
            report = files["report.md"].decode()
            for sentence in (*sentences, "The results lack training episodes: the learning curves are left out."):
                assert sentence in report
        assert "left out" not in self.files["report.md"].decode()

    def test_roles_come_with_the_results(self):
        scores = {
            ("mine", "pong"): [[1], [2]],
            ("uct", "pong"): [[3], [5]],
            ("scripted", "pong"): [[2], [4]],
            ("random", "pong"): [[0]],
            ("his", "pong"): [[5], [7]],
        }
        folder = write(self.root / "roles", results_of(scores))
        found = tables(folder)
        assert "set,game,his,mine,scripted,random\n" in found["learning-scores.csv"]
        (folder / "agents.csv").write_text("agent,role\nmine,planner\nscripted,baseline\nuct,planner\nnobody,learner\n")
        found = tables(folder)
        assert "set,game,his,random,scripted\n" in found["learning-scores.csv"]
        assert "set,game,uct,mine,best_learner,best_baseline\n" in found["planning-scores.csv"]

    def test_one_agent_in_a_game_of_ours(self):
        found = tables(write(self.root / "small", results_of({("basic", "beamfall"): [[1], [2]]})))
        assert "other,beamfall,1.5\n" in found["learning-scores.csv"]
        assert "learning-tests.csv" not in found

    def test_a_game_of_the_users_is_one_of_the_plan(self):
        folder = write(self.root / "own", results_of({("basic", "mine"): [[1], [2]]}))
        (folder / "plan.toml").write_text('games = ["mine"]\n\n[images]\nmine = "00"\n')
        assert "other,mine,1.5\n" in tables(folder)["learning-scores.csv"]

    def test_the_games_are_those_of_the_catalogue(self):
        from racebeam_evaluation.games import CATALOGUE

        files = (pathlib.Path(__file__).resolve().parents[2] / "games/catalogue").glob("*.toml")
        assert list(CATALOGUE) == sorted(file.stem for file in files)

    def test_groups_that_have_no_game_in_common(self):
        found = tables(
            write(self.root / "apart", results_of({("basic", "pong"): [[1], [2]], ("ram", "boxing"): [[3], [4]]}))
        )
        assert "\ntesting,boxing,n/a,3.5\ntesting,pong,1.5,n/a\n" in found["learning-scores.csv"]
        assert "learning-normalised.csv" not in found
        assert "basic,---,n/a\n" in found["learning-tests.csv"]

    def test_machado2018(self):
        files = self.evaluated("machado", self.results, "--report", "machado2018")
        table = files["tables/machado2018.csv"].decode().splitlines()
        assert table[1].startswith("game,agent,trials,10 M,")
        assert table[2].startswith("asterix,basic,2,3."), table[2]
        assert table[2].endswith(",2,n/a,n/a,0,n/a,n/a,0,n/a,n/a,0"), table[2]
        assert "figures/learning-curves.svg" in files
        theirs = files["tables/machado2018-published.csv"].decode().splitlines()
        assert (
            theirs[1]
            == "game,agent,10 M,10 M deviation,50 M,50 M deviation,100 M,100 M deviation,200 M,200 M deviation"
        )
        assert "asterix,dqn,1732.6,314.6,3122.6,96.4,3423.4,213.6,2866.8,1354.6" in theirs
        assert "asterix,blob_prost,2146.8,364.8,3417.8,445.3,3767.8,354.9,4358,431.6" in theirs

    def test_atari100k(self):
        files = self.evaluated("atari", self.results, "--report", "atari100k")
        assert "Of the 26 games, 22 are missing: alien, amidar," in files["report.md"].decode()
        assert b"\nasterix,210,8503.3,3.5,8.5\n" in files["tables/learning-scores.csv"]
        assert "figures/learning-profiles.svg" in files
        assert "figures/learning-intervals.svg" in files

    def test_atari57(self):
        files = self.evaluated("atari57", self.results, "--report", "atari57")
        assert "Of the 57 games, 53 are missing: alien, amidar," in files["report.md"].decode()


class TestPaper:
    def test_it_is_whole_and_says_what_cannot_be_rebuilt(self):
        with tempfile.TemporaryDirectory() as folder:
            done = evaluate("--paper", "--into", pathlib.Path(folder) / "paper")
            assert (done.returncode, done.stderr) == (0, "")
            files = read(pathlib.Path(folder) / "paper")
        text = files["report.md"].decode()
        for sentence in (
            "prints 3: random play, and the best Const and Perturb policy",
            "prints no single trials",
            "Games: 5 of the training set, 50 of the testing set.",
            "No baseline score (n/a) in skiing, venture: the range is unknown or empty.",
        ):
            assert sentence in text
        assert b"\nbasic,bass,18,32,20,35,0\n" in files["tables/paired.csv"]
        assert b"\nplanners above both or equal,49,49\n" in files["tables/claims.csv"]
        for group in ("learning", "planning"):
            for table in GROUPS:
                assert f"tables/{group}-{table}.csv" in files
            assert f"tables/{group}-improvement.csv" not in files
            header = files[f"tables/{group}-aggregates.csv"].decode().splitlines()[2]
            assert ",IQM over game means," in header
            assert ",IQM," not in header
