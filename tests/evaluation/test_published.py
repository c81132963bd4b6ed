"""Scores stand beside published ones only with the settings of both sides."""

import package
import pytest

package.require()

from made_results import evaluate, report, result, results_of, tables, write
from racebeam_evaluation.games import DATA
from racebeam_evaluation.plan import preset_of
from racebeam_evaluation.published import beside
from racebeam_evaluation.published.beside import interval
from racebeam_evaluation.published.paper import published_scores
from racebeam_evaluation.published.protocols import cause, not_comparable, published_protocols

WORDS = "frame_skip=5 sticky={sticky} noop_max=0 life_loss_ends=0 action_set=full max_episode_frames=18000"
PLAN = """name = "made"
environment = "{words}"

[agent.basic]
frame_skip = 5
trials = 2
training_episodes = {training}
training_frames = 0
evaluation_episodes = 3

[agent.uct]
frame_skip = 5
trials = 2
training_episodes = 0
training_frames = 0
evaluation_episodes = 1
simulations = {simulations}
depth_frames = 300

[agent.const]
frame_skip = 5
trials = 1
training_episodes = 0
training_frames = 0
evaluation_episodes = 2
"""
SCORES = {
    ("basic", "asterix"): [[860], [865]],
    ("basic", "seaquest"): [[100, 100, 101], [101]],
    ("uct", "asterix"): [[1], [3]],
    ("const_up", "asterix"): [[650, 650]],
    ("const_noop", "asterix"): [[0, 0]],
    ("const_up", "freeway"): [[23, 23]],
    ("mine", "asterix"): [[7]],
    ("const_noop", "skiing"): [[-9013, -9013]],
}


class TestPublished:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path

    def results(self, name="a", sticky=0, training=5000, simulations=500, plan=True):
        folder = write(self.root / name, results_of(SCORES))
        words = WORDS.format(sticky=sticky)
        text = PLAN.format(words=words, training=training, simulations=simulations)
        (folder / "plan.toml").write_text(text if plan else "")
        return folder

    @staticmethod
    def rows(text):
        """The rows of a table as CSV, by game and agent."""
        lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
        return {(line[0], line[1]): dict(zip(lines[0], line)) for line in lines[1:]}

    def test_settings_of_both_sides_are_shown(self):
        found = tables(self.results())["published-settings.csv"]
        assert '\nbasic,here,paper2013,5,,"5,000 episodes",2,3\n' in found
        assert '\nbasic,Bellemare et al. 2013,paper2013,5,,"5,000 episodes",30,500\n' in found
        assert "\nuct,here,paper2013,5,500 simulations of 300 frames,,2,1\n" in found
        assert "\nconst,Bellemare et al. 2013,paper2013,5,,,unknown,unknown\n" in found

    def test_trials_of_an_experiment_that_goes_on_are_those_that_are_finished(self):
        folder = self.results()
        lines = (folder / "results.csv").read_text().splitlines(keepends=True)
        trials = [line for line in lines if ",basic,1," not in line]
        assert len(trials) < len(lines)
        (folder / "results.csv").write_text("".join(trials))
        found = tables(folder)["published-settings.csv"]
        assert '\nbasic,here,paper2013,5,,"5,000 episodes",1 of 2,3\n' in found

    def test_agreement_is_reported_for_each_score(self):
        found = self.rows(tables(self.results())["beside-published.csv"])
        assert found["asterix", "basic"]["agrees"] == "yes"  # 862.3 lies within
        assert found["seaquest", "basic"]["agrees"] == "no: the cause is not known"
        assert found["asterix", "const"]["agrees"] == "yes"  # 650 without variance
        assert found["freeway", "const"]["agrees"].startswith("no: 30 starts after 0 to 29 no-ops give 19 to")
        assert found["skiing", "const"]["agrees"].startswith("not comparable: the reward was near 0 then")
        assert ("asterix", "mine") not in found

    def test_one_sample_agrees_only_with_the_same_score(self):
        for score, agrees in (("862.3", "yes"), ("862.4", "unknown: one sample has no interval")):
            folder = self.results()
            lines = [line for line in (folder / "results.csv").read_text().splitlines() if ",basic," not in line]
            write(folder, [*lines[1:], result("asterix", "basic", 0, 0, score)])
            assert self.rows(tables(folder)["beside-published.csv"])["asterix", "basic"]["agrees"] == agrees

    def test_the_bounds_of_an_interval_lie_in_it(self, monkeypatch):
        for bounds, agrees in (
            ((862.3, 900), "yes"),
            ((1, 862.3), "yes"),
            ((862.4, 900), "no: the cause is not known"),
            ((1, 862.2), "no: the cause is not known"),
        ):
            monkeypatch.setattr(beside, "interval", lambda _, bounds=bounds: bounds)
            row = self.rows(tables(self.results())["beside-published.csv"])["asterix", "basic"]
            assert row["agrees"] == agrees
            assert (float(row["low"]), float(row["high"])) == bounds

    def test_other_settings_are_left_out_unless_they_may_be_mixed(self):
        for edit, agent, names in (
            ({"simulations": 10}, "uct", "budget"),
            ({"training": 600}, "basic", "training"),
            ({"sticky": 0.25}, "const", "preset"),
        ):
            folder = self.results(**edit)
            found = tables(folder)
            assert ("asterix", agent) not in self.rows(found.get("beside-published.csv", "game,agent"))
            sentence = f"{agent} is not beside the published scores: {names} differ or are unknown"
            assert sentence in report(folder).document()
            assert ("asterix", agent) in self.rows(tables(folder, mix=True)["beside-published.csv"])
        mixed = self.rows(tables(self.results(simulations=10), mix=True)["beside-published.csv"])
        assert mixed["asterix", "uct"]["agrees"] == "no: budget differ or are unknown"

    def test_settings_that_nobody_says_are_not_equal(self):
        assert "beside-published.csv" not in tables(self.results(plan=False))

    def test_the_columns_of_the_paper_are_there_for_any_name(self):
        found = tables(self.results())["published.csv"].splitlines()
        assert found[1].startswith("game,basic,mine,uct,published basic,"), found[1]
        assert "published iw1" in found[1]
        assert found[2].startswith("asterix,862.5,7,2,862.3,"), found[2]

    def test_folders_of_other_settings_are_refused_unless_they_may_be_mixed(self):
        first, second = self.results("a"), self.results("b", sticky=0.25)
        (second / "results.csv").write_text((second / "results.csv").read_text().replace(",basic,", ",bass,"))
        done = evaluate(first, second, "--into", self.root / "out")
        assert done.returncode == 1
        assert "The plans differ: environment is" in done.stderr
        assert "; expected equal settings, or --mix" in done.stderr
        assert not (self.root / "out").exists()


class TestData:
    def test_presets_are_told_by_their_settings(self):
        words = WORDS.format(sticky=0)
        assert preset_of(words) == "paper2013"
        assert preset_of(WORDS.format(sticky=0.25)) == "machado2018"
        assert preset_of(words.replace("18000", "3000")) == "other"
        assert preset_of(words.replace("noop_max=0", "noop_max=30")) == "other"
        minimal = words.replace("frame_skip=5", "frame_skip=4").replace("full", "minimal").replace("max=0", "max=30")
        assert preset_of(minimal) == "dqn2015"
        assert preset_of(minimal.replace("18000", "108000")) == "atari100k"
        assert preset_of(minimal.replace("life_loss_ends=0", "life_loss_ends=1")) == "other"
        assert preset_of(minimal.replace("max=30", "max=0")) == "other"
        assert preset_of("") == "unknown"

    def test_every_published_agent_has_settings(self):
        assert sorted(published_protocols()) == sorted(published_scores())

    def test_causes_name_agents_and_games_that_are_published(self):
        scores = published_scores()
        for name in ("not_comparable", "causes"):
            for line in (DATA / f"{name}.csv").read_text().splitlines()[1:]:
                game, agent, reason = line.split(",", 2)
                assert agent in [*scores, "*"]
                assert game in scores.index
                assert reason
        assert cause("basic", "asterix") is None
        assert not_comparable("basic", "asterix") is None
        assert not_comparable("uct", "skiing") == not_comparable("const", "skiing")

    def test_the_interval_of_a_mean(self):
        import numpy as np

        # Mean 2, deviation 1, t with 2 degrees of freedom at 97.5 %: 4.302653.
        low, high = interval(np.array([1.0, 2, 3]))
        assert low == pytest.approx(2 - 4.302653 / 3**0.5, rel=0, abs=0.5e-5)
        assert high == pytest.approx(2 + 4.302653 / 3**0.5, rel=0, abs=0.5e-5)
        assert np.isnan(interval(np.array([1.0]))).all()
