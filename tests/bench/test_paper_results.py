"""scripts/measure/plan_figures.py and paper_results.py: docs/results.md follows from the folders of results."""

import hashlib
import json
import pathlib
import re
import sys
import tarfile

import paper_results
import plan_figures
import pytest
import tomllib
from paper.parts import PLANS, PUBLISHED
from paper.student import bounds, quantile, two_tailed, welch

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "docs"))
import layout  # noqa: E402


def write(path, lines):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(line + "\n" for line in lines))


def results(folder, agents, scores, seconds="2.0", frames="1000"):
    """Results of agents in Asterix: `scores` has a list of episodes for each trial of each agent."""
    write(
        folder / "plan.toml",
        ['games = ["asterix"]', f"agents = {json.dumps(agents)}"]
        + [
            line
            for agent in agents
            for line in (
                f"[agent.{agent}]",
                "frame_skip = 5",
                "trials = 1",
                "training_frames = 500",
                "evaluation_episodes = 2",
            )
        ],
    )
    rows, times = [], []
    for agent, trials in scores.items():
        for trial, episodes in enumerate(trials, 1):
            unit = f"asterix-{agent}-{trial}"
            for episode, score in enumerate(episodes, 1):
                rows.append(f"{unit},asterix,{agent},{trial},{episode},{score},1000,200,terminated")
                write(folder / "logs" / unit / f"{episode}.episode", ["log"])
            times.append(f"{unit},0.5,500,{seconds},{frames},30000")
    write(folder / "results.csv", ["unit,game,agent,trial,episode,score,frames,decisions,end", *rows])
    write(
        folder / "times.csv",
        ["unit,training_seconds,training_frames,evaluation_seconds,evaluation_frames,searched_frames", *times],
    )


class TestPicture:
    def test_the_learning_curves_are_those_of_the_results_that_are_kept(self, subtests):
        for plan, picture in (("hour", "learning-curves"), ("learners", "learning-curves-whole")):
            with subtests.test(plan=plan):
                drawn = (plan_figures.ROOT / f"docs/pictures/{picture}.svg").read_text()
                assert f"sha256:{self.digest_of_curves(plan)}" in drawn

    def digest_of_curves(self, name):
        """The SHA-256 of the curves.csv that the kept units of a plan make."""
        table = hashlib.sha256(b"unit,game,agent,trial,episode,score,frames,decisions\n")
        with tarfile.open(plan_figures.ROOT / f"docs/results/kept/{name}.tar.xz") as kept:
            plan = tomllib.loads(kept.extractfile(f"{name}/plan.toml").read().decode())
            for game in plan["games"]:
                for agent in plan["agents"]:
                    for trial in range(1, plan["agent"][agent]["trials"] + 1):
                        table.update(kept.extractfile(f"{name}/units/{game}-{agent}-{trial}.curves.csv").read())
        return table.hexdigest()


class TestCauses:
    def test_causes_of_const_have_the_scores_of_other_starts(self, subtests):
        distinct = json.loads((plan_figures.FIGURES / "const-again.json").read_text())["distinct"]
        scores = {game: each[game] for each in distinct.values() for game in each}
        rows = [row for name in ("causes", "not_comparable") for row in plan_figures.table(PUBLISHED / f"{name}.csv")]
        named = [row for row in rows if row["agent"] == "const" and "no-ops" in str(row)]
        assert len(named) > 15
        for row in named:
            with subtests.test(game=row["game"]):
                printed = re.search(r"no-ops gives? (-?\d+)(?: to (-?\d+))?", str(row)).groups()
                assert [float(each) for each in printed if each] == sorted(
                    {scores[row["game"]][0], scores[row["game"]][-1]}
                )


class TestKept:
    def test_all_units_that_are_kept_were_checked_as_they_are(self, subtests):
        kept = plan_figures.ROOT / "docs/results/kept"
        for archive in sorted(kept.glob("*.tar.xz")):
            name = archive.name.removesuffix(".tar.xz")
            with subtests.test(plan=name), tarfile.open(archive) as units:
                rows = {
                    pathlib.Path(member).name.removesuffix(".results.csv"): units.extractfile(member).read()
                    for member in units.getnames()
                    if member.endswith(".results.csv")
                }
                digests = {f"{unit} {hashlib.sha256(each).hexdigest()[:16]} verify" for unit, each in rows.items()}
                lines = (kept / f"{name}.checked").read_text().splitlines()
                assert {line.removesuffix(" ale") for line in lines} == digests


class TestBounds:
    def test_they_are_those_of_students_t_for_as_many_scores(self):
        assert bounds([5]) is None
        assert bounds([4, 6]) == pytest.approx((5 - 12.7062, 5 + 12.7062))
        assert bounds(range(11)) == pytest.approx((5 - 2.22814, 5 + 2.22814))  # whose standard error is 1
        for count, reach in ((30, 2.04523), (40, 2.02269)):
            low, high = bounds([0, 2] * (count // 2))
            assert (high - low) / 2 == pytest.approx(reach / (count - 1) ** 0.5)


class TestStudent:
    def test_quantiles_are_those_of_tables(self):
        for freedom, confidence, value in ((1, 0.95, 12.7062), (4, 0.99, 4.60409), (29, 0.95, 2.04523)):
            assert quantile(freedom, confidence) == pytest.approx(value, rel=1e-5)
            assert two_tailed(value, freedom) == pytest.approx(1 - confidence, rel=1e-4)

    def test_the_distribution_of_two_degrees_of_freedom_has_a_closed_form(self):
        for t in (0, 0.1, 1, 5, 100):
            assert two_tailed(t, 2) == pytest.approx(1 - t / (2 + t * t) ** 0.5)

    def test_welchs_test_is_that_of_scipy(self):
        difference, (low, high), p = welch([1, 2, 4], [5, 9, 6])
        assert (difference, low, high) == pytest.approx((-4.3333333, -8.62334104, -0.0433256283))
        assert p == pytest.approx(0.0486458215)


class TestPaperResults:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path

    def text(self):
        """The document, by way of the files of figures."""
        figures = self.folder / "figures"
        figures.mkdir(exist_ok=True)
        for plan in self.folder.glob("*/plan.toml"):
            (figures / f"{plan.parent.name}.json").write_text(json.dumps(plan_figures.Results(plan.parent).figures()))
        return paper_results.Document(figures).text()

    def test_plans_without_whole_results_count_as_not_run(self):
        text = self.text()
        for plan in PLANS:
            assert f"| `{plan}` | not run yet |" in text
        assert "Not run yet: `racebeam experiment uct`." in text

    def test_unfinished_results_count_with_what_is_finished(self):
        results(self.folder / "uct", ["uct"], {"uct": [[5]]})
        (self.folder / "uct/work").mkdir()
        assert "| `uct` | 1, goes on | 1 |" in self.text()
        (self.folder / "uct/work").rmdir()
        assert "| `uct` | 1 | 1 |" in self.text()

    def test_a_folder_without_results_is_refused(self):
        with pytest.raises(SystemExit, match="has no results"):
            plan_figures.Results(self.folder / "uct")

    def test_baselines_stand_beside_the_paper(self):
        results(
            self.folder / "baselines",
            ["random", "const", "perturb"],
            {"random": [[100, 400]], "const_noop": [[10]], "const_up": [[70, 72]], "perturb_up": [[33]]},
        )
        text = self.text()
        assert "| asterix | 250.0 | 288.1 | 71.0 | up | 650.0 | 33.0 | up | 337.8 | const, perturb |" in text
        assert "1 for Random, 0 for Const, 0 for Perturb." in " ".join(text.split())
        assert "| `baselines` | random | largest | 4 | at most 12,288 |" in text

    def test_perturb_as_it_was_is_not_shown(self):
        agents = ["random", "const", "perturb"]
        results(self.folder / "baselines", agents, {"random": [[1]], "const_noop": [[1]], "perturb_up": [[33, 35]]})
        assert "as it was" not in self.text()
        results(self.folder / "perturb", ["perturb"], {"perturb_up": [[330]]})
        text = " ".join(self.text().split())
        assert "The plan `baselines` includes 2 episodes of Perturb as it was, with one action for 5 frames." in text
        assert "| 330.0 | up | 337.8 | random, const |" in text
        assert "1 for Perturb." in text

    def test_perturb_that_is_far_from_the_paper_has_a_cause(self, subtests):
        results(self.folder / "baselines", ["random", "const"], {"random": [[1]], "const_noop": [[1]]})
        for others, cause in (
            ([330, 340], "chance of 30 episodes: the others are within a fifth"),
            ([100, 300], "chance: the others are within two standard errors"),
            ([90, 90.2], "the emulator or the rules of 2012: the others differ, too"),
        ):
            with subtests.test(cause=cause):
                results(self.folder / "perturb", ["perturb"], {"perturb_up": [[90, 110]]})
                results(self.folder / "perturb-again", ["perturb"], {"perturb_up": [others]})
                mean, error = sum(others) / 2, abs(others[1] - others[0]) / 2
                row = f"| asterix | perturb up | 100.0 (10.0) | {mean:.1f} ({error:.1f}) | 337.8 | {cause} |"
                assert row in self.text()

    def test_const_that_differs_from_the_paper_has_a_cause(self, subtests):
        results(self.folder / "baselines", ["random", "const"], {"random": [[288.1]], "const_up": [[600]]})
        assert "| asterix | const up | 600.0 | - | 650.0 | not known |" in self.text()
        for others, cause in (
            ([700, 650, 600], "the frame in which play begins: after some no-ops, it is the paper's score"),
            ([600, 700, 600], "the frame in which play begins: no-ops give lower and higher scores"),
            ([600, 600], "the emulator or the rules of 2012: none of these starts gives the paper's score"),
            (
                [600, 500],
                "the frame in which play begins, or the emulator or the rules of 2012: none of these starts gives the "
                "paper's score",
            ),
        ):
            with subtests.test(cause=cause):
                results(self.folder / "const-again", ["const"], {"const_up": [others]})
                extent = " to ".join(f"{score:.1f}" for score in sorted({min(others), max(others)}))
                row = f"| asterix | const up | 600.0 | {extent} | 650.0 | {cause} |"
                assert row in self.text()

    def test_another_action_with_the_papers_score_is_named(self):
        scores = {"random": [[288.1]], "const_up": [[700]], "const_fire": [[650]], "const_down": [[650]]}
        results(self.folder / "baselines", ["random", "const"], scores)
        results(self.folder / "const-again", ["const"], {"const_up": [[700, 690]]})
        assert (
            "none of these starts gives the paper's score; the paper's score is that of fire, down here |"
            in self.text()
        )

    def test_learners_have_scores_and_speeds(self):
        results(self.folder / "hour", ["random", "basic"], {"random": [[10]], "basic": [[20, 40], [60]]})
        text = self.text()
        assert "| asterix | 10.0 (288.1) | 45.0 (862.3) |" in text
        assert "| basic | 1 | 120 | 120 | 120 | 8,000 |" in text  # 1,500 frames of 5 in 2.5 s

    def test_searches_have_times_and_their_part_of_the_bench(self):
        for name in ("uct", "uct10", "uct50", "uct150"):
            results(self.folder / name, ["uct"], {"uct": [[500]]})
        write(self.folder / "bench/asterix-search.json", ['{"frames_per_second": 20000}'])
        text = self.text()
        agrees = "unknown: one episode has no interval"
        assert (
            f"| uct | asterix | 500.0 | 290,700.0 | {agrees} | 100,000 | 200 | 0.01 | 15,000 | 0.75 | unknown |" in text
        )
        assert "| asterix | 500.0 (1) | 500.0 (1) | 500.0 (1) | 500.0 (1) |" in text

    def test_an_episode_of_two_plans_is_shown_once(self):
        for name in ("uct", "searches"):
            results(self.folder / name, ["uct"], {"uct": [[290000]]})
        assert self.text().count("| uct | asterix | 290,000.0 |") == 1

    def test_episodes_of_a_kind_show_how_far_one_can_be_trusted(self):
        results(self.folder / "uct10", ["uct"], {"uct": [[500], [200]]})
        assert "the higher score is 2.50 to 2.50 times the lower" in " ".join(self.text().split())

    def test_scores_that_do_not_agree_have_a_cause(self, subtests):
        for score, ratio, row in (("300", "0.35", "unknown"), ("860", "1.00", None)):
            with subtests.test(score=score):
                results(self.folder / "learners", ["basic"], {"basic": [[score]]})
                plan = self.folder / "learners/plan.toml"
                plan.write_text(plan.read_text().replace("training_frames = 500", "training_episodes = 5000"))
                curves = ["asterix-basic-1,asterix,basic,1,1,10,1000,200"]
                write(
                    self.folder / "learners/curves.csv",
                    ["unit,game,agent,trial,episode,score,frames,decisions", *curves],
                )
                found = f"| asterix | basic | {ratio} | unknown: one trial has no interval | {row} |"
                assert (found in self.text()) == (row is not None)

    def test_verification_is_quoted(self):
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500]]})
        write(
            self.folder / "iw1.verify",
            ["1 rows confirmed, 0 wrong, 0 could not be checked; 1000 frames in 9.0 s", "processor seconds: 0.05"],
        )
        write(self.folder / "iw1.ale", ["1 rows agree with ALE, 0 do not, 0 have no image"])
        assert "| `iw1` | 1 | 1 | 0 | 0 | 1 | 0 | 0 | 20,000 | - | 2.0% |" in self.text()
        write(self.folder / "bench/asterix-none-5.json", ['{"frames_per_second": 25000}'])
        assert "| `iw1` | 1 | 1 | 0 | 0 | 1 | 0 | 0 | 20,000 | 0.80 | 2.0% |" in self.text()

    def test_figures_of_agents_that_have_changed_are_named(self):
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500]]})
        text = self.text()
        assert "| `iw1` | iw1 | built its tree anew" in text
        assert "| `hour` | disco |" not in text
        plan = self.folder / "iw1/plan.toml"
        plan.write_text(plan.read_text().replace("[agent.iw1]", "[agent.iw1]\nreuse_tree = 1"))
        assert "Agents that have changed" not in self.text()

    def test_whole_training_stands_beside_the_paper(self):
        results(self.folder / "learners", ["disco"], {"disco": [[700, 800], [770]]})
        plan = self.folder / "learners/plan.toml"
        plan.write_text(plan.read_text().replace("training_frames = 500", "training_episodes = 5000"))
        curves = [f"asterix-disco-1,asterix,disco,1,{place},{10 * place},1000,200" for place in range(20)]
        write(self.folder / "learners/curves.csv", ["unit,game,agent,trial,episode,score,frames,decisions", *curves])
        text = self.text()
        # half the difference of 20, times 12.706
        assert "| asterix | disco | 2 | 3 | 760.0 | 632.9 to 887.1 | 754.6 | 1.01 | yes |" in text
        tenths = " | ".join(f"{mean}.0" if mean < 100 else str(mean) for mean in range(5, 200, 20))
        assert f"| asterix | disco | {tenths} |" in text
        assert "| disco | 1 | 1 | 1.01 | 1.01 | 1.01 |" in text
        assert "Not run yet: `racebeam experiment ram`." in text

    def test_curves_of_several_trials_have_intervals(self):
        results(self.folder / "learners", ["disco"], {"disco": [[700], [770]]})
        curves = [f"asterix-disco-{trial},asterix,disco,{trial},1,{40 * trial},1000,200" for trial in (1, 2)]
        write(self.folder / "learners/curves.csv", ["unit,game,agent,trial,episode,score,frames,decisions", *curves])
        assert "| asterix | disco | 60.0 ± 254.1 |" in self.text()  # 20 times 12.706

    def test_learners_are_tested_in_pairs(self):
        results(self.folder / "learners", ["basic", "bass"], {"basic": [[100], [300], [500]], "bass": [[10], [50]]})
        curves = [f"asterix-{agent}-1,asterix,{agent},1,1,10,1000,200" for agent in ("basic", "bass")]
        write(self.folder / "learners/curves.csv", ["unit,game,agent,trial,episode,score,frames,decisions", *curves])
        text = self.text()
        # by scipy.stats.ttest_ind
        assert "| asterix | basic, bass | 3 and 2 | 270.0 | -208.2 to 748.2 | 0.141 | no | 2.5 |" in text
        assert "0 of 1 differences have a p below 0.01" in text

    def test_another_length_of_training_is_not_comparable(self):
        results(self.folder / "blob_prost", ["blob_prost"], {"blob_prost": [[700]]})
        curves = ["asterix-blob_prost-1,asterix,blob_prost,1,1,10,1000,200"]
        write(self.folder / "blob_prost/curves.csv", ["unit,game,agent,trial,episode,score,frames,decisions", *curves])
        cause = "not comparable: the published agent was trained for 200,000,000 frames"
        assert f"| asterix | blob_prost | 1 | 1 | 700.0 | - | 3,996.6 | 0.18 | {cause} |" in self.text()
        assert "median of score / published" not in self.text()

    def test_games_of_searches_are_counted(self):
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500]]})
        assert "| UCT, full tree | 55 games, 10 episodes | 0 games and 0 games, 1 episode |" in self.text()
        assert "54 games | 1 game, 1 episode | the same | the same |" in self.text()

    def test_perturb_of_some_games_stands_beside_the_paper(self):
        results(
            self.folder / "baselines",
            ["random", "const", "perturb"],
            {"random": [[100]], "const_up": [[10]], "perturb_up": [[33]]},
        )
        results(self.folder / "perturb", ["perturb"], {"perturb_up": [[300]], "perturb_down": [[301]]})
        row = "| asterix | 100.0 | 288.1 | 10.0 | up | 650.0 | 301.0 | down | 337.8 | random, const |"
        assert row in self.text()

    def test_kept_units_have_no_logs_and_parts_of_a_verification_add_up(self):
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500], [500]]})
        (self.folder / "iw1/logs/asterix-iw1-1/1.episode").unlink()
        part = ["1 rows confirmed, 0 wrong, 0 could not be checked; 1000 frames in 9.0 s", "processor seconds: 0.05"]
        write(self.folder / "iw1.verify", [*part, *part])
        write(self.folder / "iw1.ale", ["1 rows agree with ALE, 0 do not, 0 have no image"] * 2)
        assert "| `iw1` | 2 | 2 | 0 | 0 | 2 | 0 | 0 | 20,000 | - | 2.0% |" in self.text()

    def test_rows_that_have_changed_since_they_were_checked_do_not_count(self):
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500], [600], [700]]})
        write(self.folder / "iw1.verify", ["4 rows confirmed, 0 wrong, 0 could not be checked; 1000 frames in 9.0 s"])
        write(self.folder / "iw1.verify", [(self.folder / "iw1.verify").read_text(), "processor seconds: 0.05"])
        write(self.folder / "iw1.ale", ["4 rows agree with ALE, 0 do not, 0 have no image"])
        lines = []
        for trial, checkers in ((1, "verify ale"), (2, "verify"), (3, "verify ale")):
            rows = self.folder / f"iw1/units/asterix-iw1-{trial}.results.csv"
            write(rows, ["rows"])
            lines.append(f"asterix-iw1-{trial} {hashlib.sha256(rows.read_bytes()).hexdigest()[:16]} {checkers}")
        write(self.folder / "iw1.checked", lines)
        write(self.folder / "iw1/units/asterix-iw1-3.results.csv", ["other rows"])
        text = self.text()
        assert "| `iw1` | 3 | 2 | 0 | 0 | 1 | 0 | 2 |" in text
        assert "units of `iw1`, whose logs were not kept: `asterix-iw1-2`, `asterix-iw1-3`." in " ".join(text.split())

    def test_a_sample_that_was_run_again_has_the_same_means(self):
        results(self.folder / "perturb", ["perturb"], {"perturb_up": [[300]], "perturb_down": [[301]]})
        results(self.folder / "perturb-sample", ["perturb"], {"perturb_up": [[300]], "perturb_down": [[302]]})
        results(self.folder / "iw1", ["iw1"], {"iw1": [[500]]})
        write(self.folder / "iw1.verify", ["1 rows confirmed, 0 wrong, 0 could not be checked; 9 frames in 9.0 s"])
        write(self.folder / "iw1.verify", [(self.folder / "iw1.verify").read_text(), "processor seconds: 0.05"])
        text = " ".join(self.text().split())
        assert "2 of the 2 units of `perturb` were run again, for ALE to play their logs." in text
        assert "The means of 1 of them are" in text

    def test_the_document_is_laid_out_as_all_are(self):
        results(self.folder / "uct", ["uct"], {"uct": [[5]]})
        write(self.folder / "machine.txt", ["processor: one", "version: 0.1.0"])
        text = self.text()
        assert [*layout.width_faults(text), *layout.table_faults(text)] == []
        assert "| `uct` | 1 | 1 | 0 | 0.00 | one | 0.1.0 |" in text
