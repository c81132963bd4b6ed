"""Bad input gets one sentence and an exit status, and nothing is written."""

import pathlib
import tempfile

import package
import pytest

package.require()

from made_results import CURVES, RESULTS, curve, evaluate, result, results_of, write
from racebeam_evaluation import BadInput, load
from racebeam_evaluation.csv_file import Kind, content_of, digest, read
from racebeam_evaluation.main import _parser

GOOD = {("basic", "pong"): [[1], [2]], ("bass", "pong"): [[3], [5]]}


class TestBadInput:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path

    def check_refusal(self, sentence, *arguments, status=1):
        """Checks that the run says `sentence`, ends with `status`, and leaves nothing."""
        before = sorted(self.root.rglob("*"))
        done = evaluate(*arguments or [self.root / "a"], "--into", self.root / "out")
        assert (done.returncode, done.stdout) == (status, ""), done.stderr
        assert (len(done.stderr.splitlines()) if status == 1 else 1) == 1, done.stderr
        assert sentence in done.stderr
        assert sorted(self.root.rglob("*")) == before

    def lines(self, *lines, header=RESULTS, curves=()):
        return write(self.root / "a", lines, curves, header)

    def test_nothing_is_named(self):
        with pytest.raises(BadInput, match="no results are named"):
            load()

    def test_columns_are_missing(self):
        self.lines("1,pong,2", header="unit,game,score")
        self.check_refusal(
            "results.csv lacks the columns image_md5, agent, trial, episode, end; expected at least "
            "game,image_md5,agent,trial,episode,score,end"
        )

    def test_one_column_is_missing(self):
        header = "game,image_md5,agent,trial,episode,score"
        self.lines("pong,aa11,basic,0,0,1", header=header)
        self.check_refusal(f"results.csv lacks the column end; expected at least {header},end")

    def test_text_for_a_number(self):
        self.lines(result("pong", "basic", 0, 0, 1), result("pong", "basic", 0, 1, "high"))
        self.check_refusal("results.csv, line 3: score is 'high'; expected a decimal number")

    def test_a_score_that_is_not_finite(self):
        self.lines(result("pong", "basic", 0, 0, "inf"))
        self.check_refusal("results.csv, line 2: score is 'inf'; expected a decimal number")

    def test_a_score_whose_square_is_not_finite(self):
        for value in ("1e308", "-1e16"):
            self.lines(result("pong", "basic", 0, 0, value))
            self.check_refusal(
                f"results.csv, line 2: score is '{value}'; expected a decimal number from -1e15 to 1e15, or nothing"
            )

    def test_a_game_or_an_agent_without_a_name(self):
        self.lines(result("pong", "basic", 0, 0, 1), result("pong", "", 0, 0, 1))
        self.check_refusal("results.csv, line 3: agent is ''; expected a name")
        self.lines(result(" ", "basic", 0, 0, 1))
        self.check_refusal("results.csv, line 2: game is ' '; expected a name")

    def test_no_score_of_a_trial_that_did_not_diverge(self):
        self.lines(result("pong", "basic", 0, 0, ""))
        self.check_refusal("results.csv, line 2: score is ''; expected a decimal number, or the end diverged")
        self.lines(result("pong", "basic", 0, 0, 1), result("pong", "basic", 0, 1, ""))
        self.check_refusal("results.csv, line 3: score is ''; expected a decimal number, or the end diverged")

    def test_a_trial_that_is_not_a_whole_number(self):
        for value in ("1.5", "-1", "one", "1e300", "2147483648"):
            self.lines(result("pong", "basic", value, 0, 1))
            self.check_refusal(f"results.csv, line 2: trial is '{value}'; expected a whole number from 0 to 2147483647")

    def test_numbers_at_their_limits(self):
        path = self.lines("a,2147483647,1e15,", "b,0,-1e15,1e15", header="name,whole,decimal,optional") / "results.csv"
        kinds = {"name": Kind.NAME, "whole": Kind.WHOLE, "decimal": Kind.DECIMAL, "optional": Kind.OPTIONAL}
        frame, source = read(path, kinds)
        assert frame["whole"].to_list() == [2147483647, 0]
        assert frame["decimal"].to_list() == [1e15, -1e15]
        assert frame["optional"].isna().to_list() == [True, False]
        assert source == digest(path)

    def test_a_file_at_its_limit(self):
        path = self.root / "file"
        path.write_bytes(bytes(100))
        assert content_of(path, 100, "a file") == bytes(100)
        with pytest.raises(BadInput, match="file has 100 bytes; expected a file of at most 99"):
            content_of(path, 99, "a file")
        with pytest.raises(BadInput, match="/proc/self/status has more than 99 bytes; expected a file of at most 99"):
            content_of(pathlib.Path("/proc/self/status"), 99, "a file")
        with pytest.raises(BadInput, match="/dev/zero is a pipe, a socket or a device; expected a file"):
            content_of(pathlib.Path("/dev/zero"), 99, "a file")

    def test_a_line_of_another_length(self):
        self.lines(result("pong", "basic", 0, 0, 1), "1,2,3")
        self.check_refusal("results.csv, line 3, has 3 fields; expected 16, as the header has")
        self.lines(result("pong", "basic", 0, 0, 1) + ",7")
        self.check_refusal("results.csv, line 2, has 17 fields; expected 16")

    def test_no_rows_and_an_empty_file(self):
        self.lines()
        self.check_refusal("results.csv has no rows; expected at least one below the header")
        (self.root / "a/results.csv").write_text("")
        self.check_refusal("results.csv lacks the columns")

    def test_bytes_that_are_not_text(self):
        (self.lines() / "results.csv").write_bytes(RESULTS.encode() + b"\n\xff\n")
        self.check_refusal(f"results.csv: byte {len(RESULTS) + 1} is not UTF-8; expected a CSV file in UTF-8")

    def test_no_file(self):
        self.check_refusal("results.csv cannot be read: No such file or directory; expected a CSV file")

    def test_curves_are_as_strict(self):
        self.lines(*results_of(GOOD), curves=[curve("pong", "basic", 0, 0, 1, 100), "u,pong,basic,0,1,1,many,2"])
        self.check_refusal("curves.csv, line 3: frames is 'many'; expected a whole number from 0 to 2147483647")
        assert "frames" in CURVES

    def test_a_game_that_there_is_not(self):
        for name, sentence in (
            ("space_invader", "line 3: unknown game 'space_invader'; did you mean space_invaders?"),
            ("Pong", "line 3: unknown game 'Pong'; did you mean pong?"),
            (
                "xyz",
                "line 3: unknown game 'xyz'; expected a name that racebeam games lists, or that the "
                "folder's plan.toml has under [images]",
            ),
        ):
            self.lines(result("pong", "basic", 0, 0, 1), result(name, "basic", 0, 0, 1))
            self.check_refusal(f"results.csv, {sentence}")

    def test_a_role_that_there_is_not(self):
        folder = self.lines(*results_of(GOOD))
        (folder / "agents.csv").write_text("agent,role\nbasic,learner\nbass,teacher\n")
        self.check_refusal("agents.csv, line 3: role is 'teacher'; expected learner, planner or baseline")
        (folder / "agents.csv").write_text("agent,role\nbasic,learner\nbasic,planner\n")
        self.check_refusal(
            "agents.csv, line 3: basic is a planner, and a learner before; expected one role of each agent"
        )

    def test_a_plan_that_is_not_toml(self):
        (self.lines(*results_of(GOOD)) / "plan.toml").write_text("games = [")
        self.check_refusal("plan.toml is not TOML: ")

    def test_a_plan_that_nests_without_end(self):
        plan = self.lines(*results_of(GOOD)) / "plan.toml"
        plan.write_text("a = " + "[" * 5000 + "]" * 5000)
        self.check_refusal("plan.toml is not TOML: ")
        plan.write_text(".".join("a" * 51) + " = 1")
        self.check_refusal("plan.toml has tables within tables on 51 levels; expected at most 50")

    def test_a_table_of_a_gigabyte_is_not_read(self):
        with (self.lines(*results_of(GOOD)) / "results.csv").open("r+b") as file:
            file.truncate(2**30)
        self.check_refusal("results.csv has 1073741824 bytes; expected a CSV file of at most 536870912")

    def test_an_episode_twice(self):
        self.lines(*results_of(GOOD), result("pong", "bass", 1, 0, 5))
        self.check_refusal("evaluation episode 0 of trial 1 of bass on pong occurs twice; expected each episode once")

    def test_the_same_results_twice(self):
        folder = self.lines(*results_of(GOOD))
        self.check_refusal("of basic on pong occurs twice", folder, folder)

    def test_two_images_of_a_game(self):
        write(self.root / "a", [result("pong", "basic", 0, 0, 1, md5="aa")])
        write(self.root / "b", [result("pong", "bass", 0, 0, 1, md5="bb")])
        self.check_refusal(
            "pong has the images aa and bb; expected one image of each game", self.root / "a", self.root / "b"
        )

    def test_a_folder_that_is_full(self):
        self.lines(*results_of(GOOD))
        (self.root / "out").mkdir()
        (self.root / "out/mine").touch()
        self.check_refusal("out is not empty; expected a new or an empty folder")

    def test_a_folder_that_cannot_be(self):
        self.lines(*results_of(GOOD))
        done = evaluate(self.root / "a", "--into", self.root / "none/out")
        assert (done.returncode, done.stderr.splitlines()) == (
            1,
            [f"racebeam-evaluate: {self.root}/none is not a folder; expected the folder in which out is made"],
        )

    def test_reports_of_what_is_not_there(self):
        folder = self.lines(*results_of({("basic", "beamfall"): [[1], [2]]}))
        self.check_refusal("no curves.csv of RESULTS has one; expected learners", folder, "--report", "machado2018")
        self.check_refusal(
            "no game of RESULTS is one of Atari 100k; expected some of alien, amidar", folder, "--report", "atari100k"
        )

    def test_every_trial_diverged(self):
        self.lines(result("pong", "basic", 0, 0, "", end="diverged"))
        self.check_refusal("every trial diverged; expected a score")

    def test_usage(self):
        folder = self.lines(*results_of(GOOD))
        self.check_refusal("expected RESULTS, or --paper", "--seed", "1", status=2)
        self.check_refusal("expected RESULTS, or --paper", folder, "--paper", status=2)

    def test_options_that_would_have_no_effect(self):
        folder = self.lines(*results_of(GOOD))
        for words, sentence in (
            (("--paper", "--report", "paper2013"), "--report cannot be given with --paper"),
            (("--paper", "--mix"), "--mix cannot be given with --paper"),
            ((folder, "--board", "--report", "atari57"), "--report cannot be given with --board"),
            ((folder, "--board", "--mix"), "--mix cannot be given with --board"),
            ((folder, "--viewer", "https://example.org"), "--viewer can only be given with --board"),
        ):
            self.check_refusal(sentence, *words, status=2)
        self.check_refusal("'-1' is not accepted; expected 0 to 4294967295", folder, "--seed=-1", status=2)
        self.check_refusal("'0' is not accepted; expected 1 to 1000000", folder, "--repetitions", "0", status=2)
        options = _parser().parse_args(["--into", "a", "--seed", "4294967295", "--repetitions", "1000000"])
        assert (options.seed, options.repetitions) == (4294967295, 1000000)
        options = _parser().parse_args(["--into", "a", "--seed", "0", "--repetitions", "1"])
        assert (options.seed, options.repetitions) == (0, 1)
        for option, value in (("--seed", "4294967296"), ("--repetitions", "1000001")):
            self.check_refusal(f"'{value}' is not accepted", folder, option, value, status=2)


class TestPlans:
    """Results of different settings are evaluated together only with a sentence that says so."""

    PLAN = (
        'name = "{name}"\nenvironment = "sticky={sticky}"\ngames = ["pong"]\n\n[images]\npong = "aa"\n\n'
        "[agent.{agent}]\ntrials = {trials}\nalpha = {alpha}\nevaluation_episodes = {episodes}\n"
    )

    def report(self, *plans, mix=()):
        with tempfile.TemporaryDirectory() as root:
            folders = []
            for number, plan in enumerate(plans):
                agent = plan.setdefault("agent", "basic")
                folders.append(
                    write(
                        pathlib.Path(root) / f"r{number}",
                        [result("pong", agent, 10 * number + trial, 0, trial) for trial in (0, 1)],
                        [curve("pong", agent, 10 * number, 0, 1, 100)],
                    )
                )
                defaults = {"name": f"n{number}", "sticky": 0, "trials": 2 + number, "alpha": 0.5, "episodes": 3}
                (folders[-1] / "plan.toml").write_text(self.PLAN.format(**defaults | plan))
            texts = []
            for kind in ("paper2013", "machado2018", "atari100k"):
                out = pathlib.Path(root) / kind
                done = evaluate(*folders, "--into", out, "--report", kind, *mix)
                assert done.returncode in (0, 3), done.stderr
                texts.append((out / "report.md").read_text())
            return texts

    def test_the_same_settings(self):
        for text in self.report({}, {}):
            assert "The plans differ" not in text

    def test_other_settings_of_the_environment_and_of_an_agent(self):
        for text in self.report({}, {"sticky": 0.25, "alpha": 0.1}, mix=("--mix",)):
            assert (
                'The plans differ: environment is "sticky=0" in r0, and "sticky=0.25" in r1; scores are of both.'
                in text
            )
            assert "The plans differ: agent.basic.alpha is 0.5 in r0, and 0.1 in r1; scores are of both." in text

    def test_what_changes_no_score_may_differ(self):
        for text in self.report({}, {"episodes": 9}):
            assert (
                "The plans differ: agent.basic.evaluation_episodes is 3 in r0, and 9 in r1; scores are of both." in text
            )

    def test_settings_of_agents_that_only_one_has(self):
        for text in self.report({}, {"agent": "bass", "alpha": 0.1}):
            assert "The plans differ" not in text


class TestUntested:
    """Tests that cannot be made are named. The rest of the report is written, and the status is 3."""

    def evaluated(self, scores):
        with tempfile.TemporaryDirectory() as root:
            out = pathlib.Path(root) / "out"
            done = evaluate(write(pathlib.Path(root) / "a", results_of(scores)), "--into", out)
            return done.returncode, done.stderr.splitlines(), (out / "report.md").read_text()

    def test_fewer_than_two_trials(self):
        status, output, report = self.evaluated(GOOD | {("bass", "pong"): [[3, 5]]})
        assert status == 3
        assert output == [
            "racebeam-evaluate: Not tested: bass on pong has fewer than 2 trials; a test takes 2 or more."
        ]
        assert "Not tested: bass on pong has fewer than 2 trials" in report

    def test_no_variance(self):
        status, output, report = self.evaluated({("basic", "pong"): [[0], [0]], ("bass", "pong"): [[2], [2]]})
        assert status == 3
        assert output == [
            "racebeam-evaluate: Not tested: basic and bass on pong have no variance; a test takes trials that differ."
        ]
        assert "Not tested: basic and bass on pong have no variance" in report

    def test_a_game_that_one_lacks(self):
        status, output, report = self.evaluated(GOOD | {("bass", "boxing"): [[1], [2]]})
        assert (status, output) == (0, [])
        assert "basic and bass are compared in 1 game; only one of them has played boxing." in report
        assert "Not every agent has played boxing: not aggregated." in report
