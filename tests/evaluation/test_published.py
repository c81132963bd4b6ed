"""Scores stand beside published ones only with the settings of both sides."""

import pathlib
import tempfile
import unittest

import package

package.require()

from made_results import evaluate, report, results_of, tables, write  # noqa: E402
from racebeam_evaluation.games import DATA  # noqa: E402
from racebeam_evaluation.plan import preset_of  # noqa: E402
from racebeam_evaluation.published.beside import interval  # noqa: E402
from racebeam_evaluation.published.paper import published_scores  # noqa: E402
from racebeam_evaluation.published.protocols import cause, not_comparable, published_protocols  # noqa: E402

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


class Published(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

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
        self.assertIn('\nbasic,here,paper2013,5,,"5,000 episodes",2,3\n', found)
        self.assertIn('\nbasic,Bellemare et al. 2013,paper2013,5,,"5,000 episodes",30,500\n', found)
        self.assertIn("\nuct,here,paper2013,5,500 simulations of 300 frames,,2,1\n", found)
        self.assertIn("\nconst,Bellemare et al. 2013,paper2013,5,,,unknown,unknown\n", found)

    def test_trials_of_an_experiment_that_goes_on_are_those_that_are_finished(self):
        folder = self.results()
        lines = (folder / "results.csv").read_text().splitlines(keepends=True)
        trials = [line for line in lines if ",basic,1," not in line]
        self.assertLess(len(trials), len(lines))
        (folder / "results.csv").write_text("".join(trials))
        found = tables(folder)["published-settings.csv"]
        self.assertIn('\nbasic,here,paper2013,5,,"5,000 episodes",1 of 2,3\n', found)

    def test_agreement_is_reported_for_each_score(self):
        found = self.rows(tables(self.results())["beside-published.csv"])
        self.assertEqual(found["asterix", "basic"]["agrees"], "yes")  # 862.3 lies within
        self.assertEqual(found["seaquest", "basic"]["agrees"], "no: the cause is not known")
        self.assertEqual(found["asterix", "const"]["agrees"], "yes")  # 650 without variance
        self.assertTrue(found["freeway", "const"]["agrees"].startswith("no: 30 starts after 0 to 29 no-ops give 19 to"))
        self.assertTrue(found["skiing", "const"]["agrees"].startswith("not comparable: the reward was near 0 then"))
        self.assertNotIn(("asterix", "mine"), found)

    def test_other_settings_are_left_out_unless_they_may_be_mixed(self):
        for edit, agent, names in (
            ({"simulations": 10}, "uct", "budget"),
            ({"training": 600}, "basic", "training"),
            ({"sticky": 0.25}, "const", "preset"),
        ):
            folder = self.results(**edit)
            found = tables(folder)
            self.assertNotIn(("asterix", agent), self.rows(found.get("beside-published.csv", "game,agent")))
            sentence = f"{agent} is not beside the published scores: {names} differ or are unknown"
            self.assertIn(sentence, report(folder).document())
            self.assertIn(("asterix", agent), self.rows(tables(folder, mix=True)["beside-published.csv"]))
        mixed = self.rows(tables(self.results(simulations=10), mix=True)["beside-published.csv"])
        self.assertEqual(mixed["asterix", "uct"]["agrees"], "no: budget differ or are unknown")

    def test_settings_that_nobody_says_are_not_equal(self):
        self.assertNotIn("beside-published.csv", tables(self.results(plan=False)))

    def test_the_columns_of_the_paper_are_there_for_any_name(self):
        found = tables(self.results())["published.csv"].splitlines()
        self.assertTrue(found[1].startswith("game,basic,mine,uct,published basic,"), found[1])
        self.assertIn("published iw1", found[1])
        self.assertTrue(found[2].startswith("asterix,862.5,7,2,862.3,"), found[2])

    def test_folders_of_other_settings_are_refused_unless_they_may_be_mixed(self):
        first, second = self.results("a"), self.results("b", sticky=0.25)
        (second / "results.csv").write_text((second / "results.csv").read_text().replace(",basic,", ",bass,"))
        done = evaluate(first, second, "--into", self.root / "out")
        self.assertEqual(done.returncode, 1)
        self.assertIn("The plans differ: environment is", done.stderr)
        self.assertIn("; expected equal settings, or --mix", done.stderr)
        self.assertFalse((self.root / "out").exists())


class Data(unittest.TestCase):
    def test_presets_are_told_by_their_settings(self):
        words = WORDS.format(sticky=0)
        self.assertEqual(preset_of(words), "paper2013")
        self.assertEqual(preset_of(WORDS.format(sticky=0.25)), "machado2018")
        self.assertEqual(preset_of(words.replace("18000", "3000")), "other")
        self.assertEqual(preset_of(words.replace("noop_max=0", "noop_max=30")), "other")
        minimal = words.replace("frame_skip=5", "frame_skip=4").replace("full", "minimal").replace("max=0", "max=30")
        self.assertEqual(preset_of(minimal), "dqn2015")
        self.assertEqual(preset_of(minimal.replace("18000", "108000")), "atari100k")
        self.assertEqual(preset_of(minimal.replace("life_loss_ends=0", "life_loss_ends=1")), "other")
        self.assertEqual(preset_of(minimal.replace("max=30", "max=0")), "other")
        self.assertEqual(preset_of(""), "unknown")

    def test_every_published_agent_has_settings(self):
        self.assertEqual(sorted(published_protocols()), sorted(published_scores()))

    def test_causes_name_agents_and_games_that_are_published(self):
        scores = published_scores()
        for name in ("not_comparable", "causes"):
            for line in (DATA / f"{name}.csv").read_text().splitlines()[1:]:
                game, agent, reason = line.split(",", 2)
                self.assertIn(agent, [*scores, "*"])
                self.assertIn(game, scores.index)
                self.assertTrue(reason)
        self.assertIsNone(cause("basic", "asterix"))
        self.assertIsNone(not_comparable("basic", "asterix"))
        self.assertEqual(not_comparable("uct", "skiing"), not_comparable("const", "skiing"))

    def test_the_interval_of_a_mean(self):
        import numpy as np

        # Mean 2, deviation 1, t with 2 degrees of freedom at 97.5 %: 4.302653.
        low, high = interval(np.array([1.0, 2, 3]))
        self.assertAlmostEqual(low, 2 - 4.302653 / 3**0.5, places=5)
        self.assertAlmostEqual(high, 2 + 4.302653 / 3**0.5, places=5)
        self.assertTrue(np.isnan(interval(np.array([1.0]))).all())
