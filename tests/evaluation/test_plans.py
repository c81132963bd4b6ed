"""The settings that a plan names, and the differences between two plans."""

import package
import pytest

package.require()

import pandas as pd
from racebeam_evaluation import BadInput
from racebeam_evaluation.plan import Plan, Protocol, plan_of, preset_of
from racebeam_evaluation.results import Results, differences, together

WORDS = "frame_skip=5 sticky=0 action_set=full max_episode_frames=18000"
KNOWN = Protocol("paper2013", "5", "", "5,000 episodes", "30", "500")


def protocol_of(**settings):
    return Plan({"environment": WORDS, "agent": {"mine": settings}}).protocol("mine")


def results(plans, trials=(), roles=None, images=("",)):
    """Results of the agent "mine": trials of (game, trial)."""
    rows = [(game, image, "mine", trial, 0, 1.0, "over") for game, trial in trials for image in images]
    columns = ["game", "image_md5", "agent", "trial", "episode", "score", "end"]
    return Results(pd.DataFrame(rows, columns=columns), None, (), (), roles=roles or {}, plans=tuple(plans))


class TestProtocols:
    def test_a_budget_is_in_simulations_or_frames(self):
        for settings, words in (
            ({"simulations": 500, "depth_frames": 300}, "500 simulations of 300 frames"),
            ({"simulations": 1500}, "1,500 simulations"),
            ({"frames": 133000, "depth_frames": 300}, "133,000 frames"),
            ({"simulations": "many"}, ""),
            ({}, ""),
        ):
            assert protocol_of(**settings).budget == words

    def test_training_is_in_episodes_or_frames(self):
        for settings, words in (
            ({"training_episodes": 5000, "training_frames": 0}, "5,000 episodes"),
            ({"training_episodes": 0, "training_frames": 200_000_000}, "200,000,000 frames"),
            ({"training_episodes": 0, "training_frames": 0}, ""),
            ({}, ""),
        ):
            assert protocol_of(frame_skip=5, **settings).training == words

    def test_what_a_plan_leaves_out_is_unknown(self):
        assert protocol_of(trials=5) == Protocol("paper2013", "unknown", "", "", "5", "unknown")
        for tables in ({}, {"agent": {"yours": {"trials": 2}}}, {"agent": {"mine": 5}}, {"agent": 5}):
            assert Plan(tables).protocol("mine") == Protocol()
        assert Plan({"agent": {"mine": {"trials": 1}}}).protocol("mine").preset == "unknown"

    def test_settings_of_a_policy_are_those_of_its_kind(self):
        plan = Plan({"agent": {"const": {"trials": 1}, "const_up": {"trials": 2}}})
        assert [plan.protocol(name).trials for name in ("const_down", "const_up")] == ["1", "2"]

    def test_only_what_decides_scores_differs(self):
        other = Protocol("other", "4", "9 frames", "", "1", "1")
        assert KNOWN.differences(KNOWN) == []
        assert KNOWN.differences(other) == ["preset", "frame_skip", "budget", "training"]
        assert KNOWN.differences(Protocol("paper2013", "5", "", "5,000 episodes", "1", "1")) == []
        assert Protocol().differences(Protocol()) == ["preset", "frame_skip", "budget", "training"]
        assert KNOWN.differences(Protocol("paper2013", "unknown", "", "5,000 episodes")) == ["frame_skip"]

    def test_the_end_at_a_lost_life_makes_another_preset(self):
        assert preset_of(WORDS) == "paper2013"
        assert preset_of(f"pong {WORDS} life_loss=ignored life_loss_ends=0") == "paper2013"
        for word in ("life_loss=ends", "life_loss_ends=1", "noop_max=1"):
            assert preset_of(f"{WORDS} {word}") == "other"
        assert preset_of("pong") == "unknown"

    def test_the_games_of_a_plan_are_those_with_an_image(self):
        assert Plan({"images": {"mine": "00"}}).games == {"mine"}
        assert Plan({"images": 5}).games == Plan({}).games == set()

    def test_a_folder_without_a_plan_has_an_empty_one(self, tmp_path):
        assert plan_of(tmp_path) == Plan({})
        (tmp_path / "plan.toml").write_bytes(b"#" * 2**24)
        assert plan_of(tmp_path) == Plan({})
        (tmp_path / "plan.toml").write_bytes(b"#" * (2**24 + 1))
        with pytest.raises(BadInput, match="plan.toml has 16777217 bytes; expected a TOML file of at most 16777216"):
            plan_of(tmp_path)
        (tmp_path / "plan.toml").write_bytes(b'name = "\xff"')
        with pytest.raises(BadInput, match="plan.toml is not TOML: "):
            plan_of(tmp_path)


class TestTogether:
    @staticmethod
    def plan(trials):
        return Plan({"environment": WORDS, "agent": {"mine": {"trials": trials}}})

    def test_trials_are_those_that_every_game_has(self):
        played = [("pong", 0), ("pong", 1), ("pong", 2), ("boxing", 0), ("boxing", 1)]
        for planned, words in ((3, "2 of 3"), (2, "2"), (1, "1"), (1200, "2 of 1,200")):
            assert [each.trials for each in results([self.plan(planned)], played).protocols("mine")] == [words]
        assert [each.trials for each in results([self.plan(3)]).protocols("mine")] == ["3"]

    def test_each_way_is_named_once_and_an_unknown_one_only_without_another(self):
        found = results([self.plan(1), Plan({}), self.plan(1), self.plan(2)], [("pong", 0), ("pong", 1)])
        assert [each.trials for each in found.protocols("mine")] == ["1", "2"]
        assert results([Plan({})]).protocols("mine") == [Protocol()]

    def test_an_agent_has_one_role(self):
        parts = [results([], [("pong", 0)], {"mine": "learner"}), results([], [("pong", 1)], {"mine": "planner"})]
        with pytest.raises(BadInput, match="mine is a planner, and a learner elsewhere; expected one role"):
            together(parts)
        parts[1].roles["mine"] = "learner"
        assert together(parts).roles == {"mine": "learner"}

    def test_an_image_without_a_name_is_not_another_image(self):
        parts = [results([], [("pong", number)], images=(image,)) for number, image in enumerate(("aa", "", "aa"))]
        assert len(together(parts).episodes) == 3

    def test_notes_of_all_are_kept(self):
        parts = [results([], [("pong", number)]) for number in range(2)]
        parts[1] = Results(parts[1].episodes, None, (), (), ("of the second",))
        assert together(parts, ("of all",)).notes == ("of all", "of the second")


class TestDifferences:
    def folders(self, root, *texts):
        for number, text in enumerate(texts):
            (root / f"r{number}").mkdir()
            if text:
                (root / f"r{number}/plan.toml").write_text(text)
        return sorted(root.iterdir())

    def test_each_setting_that_differs_is_named_once(self, tmp_path):
        folders = self.folders(tmp_path, "", "alpha = 1\nbeta = 1\n", "alpha = 2\n", "alpha = 3\nbeta = 2\n")
        assert differences(folders, True) == (
            "The plans differ: alpha is 1 in r1, and 2 in r2; scores are of both.",
            "The plans differ: beta is 1 in r1, and 2 in r3; scores are of both.",
        )

    def test_only_what_changes_no_score_may_differ(self, tmp_path):
        own = (
            'name = "a"\nseed = {0}\n[images]\npong = "{0}"\n[backgrounds]\npong = "{0}"\n[agent.mine]\ntrials = {0}\n'
        )
        folders = self.folders(tmp_path, own.format(1), own.format(2), "version = 1\n", "version = 2\n")
        assert differences(folders[:2], False) == ()
        assert differences(folders, False) == (
            "The plans differ: version is 1 in r2, and 2 in r3; scores are of both.",
        )

    def test_what_changes_scores_is_refused(self, tmp_path):
        folders = self.folders(tmp_path, "[agent.mine]\nalpha = 1\n", "[agent.mine]\nalpha = 2\n")
        with pytest.raises(BadInput, match="alpha is 1 in r0, and 2 in r1; expected equal settings, or --mix"):
            differences(folders, False)
