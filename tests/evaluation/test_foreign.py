"""Files of Dopamine, DQN Zoo and rliable are read, and results are frames for programs."""

import json

import package
import pytest

package.require()

from made_results import curve, evaluate, results_of, write
from racebeam_evaluation import BadInput, load

ZOO = (
    ",environment_name,seed,frame,eval_episode_return,eval_num_episodes\n"
    "0,battle_zone,1,0,100.0,3\n1,battle_zone,1,1000000,300.5,4\n2,battle_zone,2,0,90.0,3\n3,battle_zone,2,1000000,310,4\n"
)


class Folder:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path

    def file(self, name, content):
        path = self.root / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path


class TestFiles(Folder):
    def test_dopamine(self):
        entries = [
            {"Iteration": iteration, "Value": value, "Agent": agent}
            for agent, trials in (("DQN", [[1, 2], [3, 4.5]]), ("DQN (Adam)", [[7, 8]]))
            for trial in trials
            for iteration, value in enumerate(trial)
        ]
        found = load(self.file("battlezone.json", entries))
        assert found.trials.values.tolist() == [
            ["battle_zone", "dqn", 0, 2],
            ["battle_zone", "dqn", 1, 4.5],
            ["battle_zone", "dqn_adam", 0, 8],
        ]
        assert found.curves["frames"].to_list() == [1_000_000] * 6
        assert found.curves["decisions"].to_list() == [250_000] * 6

    def test_dqn_zoo(self):
        found = load(self.file("rainbow.csv", ZOO))
        assert found.trials.values.tolist() == [
            ["battle_zone", "rainbow", 1, 300.5],
            ["battle_zone", "rainbow", 2, 310],
        ]
        assert found.curves["frames"].to_list() == [0, 1_000_000, 0, 1_000_000]

    def test_rliable(self):
        found = load(self.file("DrQ.json", {"UpNDown": [1, 2.5], "MsPacman": [3]}))
        assert found.trials.values.tolist() == [
            ["ms_pacman", "drq", 0, 3],
            ["up_n_down", "drq", 0, 1],
            ["up_n_down", "drq", 1, 2.5],
        ]

    def test_they_are_evaluated_beside_results_of_ours(self):
        ours = write(self.root / "ours", results_of({("basic", "up_n_down"): [[4], [6]]}))
        done = evaluate(ours, self.file("DrQ.json", {"UpNDown": [1, 2]}), "--into", self.root / "report")
        assert (done.returncode, done.stderr) == (0, "")
        assert "testing,up_n_down,5,1.5\n" in (self.root / "report/tables/learning-scores.csv").read_text()

    def test_each_iteration_is_a_checkpoint_of_its_own(self):
        entries = [{"Iteration": i, "Value": i + 1, "Agent": "DQN"} for i in range(60)]
        done = evaluate(self.file("pong.json", entries), "--report", "machado2018", "--into", self.root / "report")
        assert done.returncode == 0, done.stderr
        row = (self.root / "report/tables/machado2018.csv").read_text().splitlines()[2]
        assert row == "pong,dqn,1,10,n/a,1,50,n/a,1,n/a,n/a,0,n/a,n/a,0"

    def test_an_iteration_that_comes_again_begins_a_trial(self):
        entries = [{"Iteration": i, "Value": i + 10, "Agent": agent} for i, agent in ((0, "A"), (0, "A"), (1, "B"))]
        found = load(self.file("pong.json", entries))
        assert found.trials.values.tolist() == [["pong", "a", 0, 10], ["pong", "a", 1, 10], ["pong", "b", 0, 11]]

    def test_results_of_others_have_one_episode_and_no_image(self):
        for name, content in (("DrQ.json", {"Pong": [1]}), ("a.csv", ZOO)):
            rows = load(self.file(name, content)).episodes
            assert set(rows["episode"]) == {0}
            assert set(rows["image_md5"]) == {""}

    def test_an_agent_is_named_without_signs(self):
        for name, agent in (("Rainbow (v2)", "rainbow_v2"), ("??", "agent")):
            assert load(self.file(f"{name}.json", {"Pong": [1]})).trials["agent"].to_list() == [agent]

    def test_frames_of_an_iteration_are_those_since_the_one_before(self):
        rows = ["0,pong,7,250,1,1", "1,pong,7,1000,2,1"]
        found = load(self.file("a.csv", "\n".join([ZOO.splitlines()[0], *reversed(rows), ""])))
        assert found.curves[["episode", "score", "frames", "decisions"]].values.tolist() == [
            [0, 1, 250, 62],
            [1, 2, 750, 187],
        ]
        assert found.trials["score"].to_list() == [2]

    def test_the_entry_that_is_wrong_is_numbered_and_cut(self):
        entries = [{"Iteration": 0, "Value": 1, "Agent": "a"}, {"Agent": "b" * 200}]
        for wrong in ({"Agent": "b" * 200}, {"Iteration": -1, "Value": 1, "Agent": "a"}):
            entries[1] = wrong
            with pytest.raises(BadInput) as raised:
                load(self.file("pong.json", entries))
            assert f"entry 2 is {json.dumps(wrong)[:100]}; expected a list" in str(raised.value)

    def test_mistakes_are_reported(self):
        for name, content, sentence in (
            ("pong.txt", "", "is neither a folder, nor a file .csv of DQN Zoo, nor .json of Dopamine or rliable"),
            ("pong.json", "{", "pong.json is not JSON: "),
            ("pong.json", "[" * 100_000, "pong.json is not JSON: "),
            ("pung.json", [{"Iteration": 0, "Value": 1, "Agent": "a"}], "unknown game 'pung'; did you mean pong?"),
            ("pong.json", [], "pong.json has no iterations; expected one or more"),
            (
                "pong.json",
                [{"Iteration": 0, "Agent": "a"}],
                'entry 1 is {"Iteration": 0, "Agent": "a"}; expected a list',
            ),
            ("pong.json", [{"Iteration": 0, "Value": "1", "Agent": "a"}], "entry 1 is "),
            ("pong.json", [{"Iteration": True, "Value": 1, "Agent": "a"}], "entry 1 is "),
            ("a.json", {"Pong": [1, "2"]}, 'Pong has [1, "2"]; expected a list of decimal numbers'),
            ("a.json", '{"Pong": [NaN]}', "Pong has [NaN]; expected a list of decimal numbers"),
            ("a.json", {"Pong": [10**400]}, "Pong has [1000"),
            ("a.json", {"Pong": [-1e16]}, "Pong has [-1e+16]; expected a list of decimal numbers from -1e15 to 1e15"),
            ("pong.json", [{"Iteration": 2**31, "Value": 1, "Agent": "a"}], "entry 1 is "),
            ("a.json", {"Pong": []}, "Pong has []; expected a list of decimal numbers"),
            ("a.json", {}, "a.json has {}; expected a list of objects"),
            ("a.json", "5", "a.json has 5; expected a list of objects"),
            ("a.csv", "frame,seed\n1,2\n", "a.csv lacks the columns environment_name, eval_episode_return"),
            ("a.csv", ZOO.replace("300.5", "much"), "eval_episode_return is 'much'; expected a decimal number"),
        ):
            with pytest.raises(BadInput) as raised:
                load(self.file(name, content))
            assert sentence in str(raised.value)

    def test_a_file_of_a_gigabyte_is_not_read(self):
        for name, limit in (("pong.json", 2**28), ("a.csv", 2**29)):
            with (self.root / name).open("wb") as file:
                file.truncate(2**30)
            with pytest.raises(BadInput, match=f"has 1073741824 bytes; expected a .* of at most {limit}"):
                load(self.root / name)


class TestFrames(Folder):
    def test_a_folder_is_frames(self):
        scores = {("basic", "pong"): [[1, 3], [4]], ("random", "pong"): [[-20, -21]]}
        folder = write(self.root / "a", results_of(scores), [curve("pong", "basic", 0, 0, 1, 100)])
        (folder / "agents.csv").write_text("agent,role\nbasic,learner\n")
        found = load(folder)
        assert len(found.episodes) == 5
        assert found.scores.loc["pong"].to_dict() == {"basic": 3, "random": -20.5}
        assert found.trials["score"].to_list() == [2, 4, -20.5]
        assert found.curves["decisions"].to_list() == [20]
        assert found.roles == {"basic": "learner"}
        rows = found.aggregates()
        human = rows[rows["normalisation"] == "human"].iloc[0]
        assert human["IQM"] == pytest.approx((3 + 20.7) / 35.3, rel=0, abs=0.5e-7)

    def test_a_folder_without_training_has_no_curves(self):
        found = load(str(write(self.root / "a", results_of({("uct", "pong"): [[1]]}))))
        assert (len(found.curves), list(found.curves)[:3]) == (0, ["game", "agent", "trial"])
