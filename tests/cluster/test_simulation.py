"""cluster/simulate.py: simulations with a known end, and the lengths of units."""

import dataclasses
import os
import random
import re
import subprocess
import sys

import pytest
import slurm

sys.path.insert(0, str(slurm.TOP / "cluster"))
import simulate
from simulate import Cluster

BINARY = os.environ.get("RACEBEAM_BINARY", str(slurm.TOP / "build/release/racebeam"))
HOUR = 3600


def random_units(count, seed=1):
    chance = random.Random(seed)
    return [chance.uniform(60, 2 * HOUR) for _ in range(count)]


class TestSimulations:
    def test_one_core_works_through_the_sum(self):
        units = random_units(50)
        run = simulate.simulate(units, Cluster(1))
        assert run.elapsed == pytest.approx(sum(units), rel=0, abs=0.5e-7)
        assert run.busy == pytest.approx(sum(units), rel=0, abs=0.5e-7)
        assert (run.lost, run.failures) == (0, 0)

    def test_an_example_by_hand(self):
        # Two cores: 5 and 3 begin; 4 follows the 3 and ends at 7; 1 follows the 5 and ends at 6.
        assert simulate.simulate([5, 3, 4, 1], Cluster(2)).elapsed == 7
        # Shards take every second unit: 5 + 4 and 3 + 1.
        assert simulate.simulate([5, 3, 4, 1], Cluster(2), shards=2).elapsed == 9

    def test_the_bound_of_list_scheduling_holds(self):
        for seed in range(20):
            units = random_units(300, seed)
            for cluster in (Cluster(7), Cluster(3, cores=8)):
                cores = cluster.nodes * cluster.cores
                elapsed = simulate.simulate(units, cluster).elapsed
                assert elapsed >= max(sum(units) / cores, max(units))
                assert elapsed <= sum(units) / cores + max(units)

    def test_slow_nodes_take_longer(self):
        units = random_units(100)
        whole = simulate.simulate(units, Cluster(4)).elapsed
        assert simulate.simulate(units, Cluster(4, slow=1, slowness=3)).elapsed == pytest.approx(
            3 * whole, rel=0, abs=0.5e-7
        )
        some = [simulate.simulate(units, Cluster(4, slow=0.5, slowness=3), seed=seed).elapsed for seed in range(20)]
        assert all(whole <= elapsed <= 3 * whole for elapsed in some)
        assert len(set(some)) > 1

    def test_failures_lose_what_came_after_the_checkpoint_and_nothing_else(self):
        units = random_units(200)
        cluster = Cluster(8, cores=4, failures=365 * 24, repair=HOUR, requeue=120, checkpoint=60)  # one an hour
        for seed in range(10):
            run = simulate.simulate(units, cluster, seed=seed)
            assert run.failures > 5
            assert run.lost > 0
            assert run.lost < run.failures * cluster.cores * cluster.checkpoint
            assert run.busy - run.lost == pytest.approx(sum(units), rel=0, abs=0.5e-3)  # all units are done, once
            assert run.elapsed > simulate.simulate(units, dataclasses.replace(cluster, failures=0)).elapsed

    def test_slow_nodes_that_fail_do_all_units_once(self):
        units = random_units(60)
        cluster = Cluster(4, failures=365 * 24, slow=1, slowness=2)
        run = simulate.simulate(units, cluster, seed=3)
        assert run.failures > 0
        assert run.busy - run.lost == pytest.approx(2 * sum(units), rel=0, abs=0.5e-3)

    def test_the_fewest_nodes_are_enough_and_one_less_is_not(self):
        units = [random_units(400, seed) for seed in range(5)]
        within = 30 * HOUR
        nodes = simulate.fewest_nodes(units, Cluster(1, cores=2), 0, within)
        slowest = [simulate.summary(units, Cluster(count, cores=2), 0)[-1].elapsed for count in (nodes - 1, nodes)]
        assert slowest[0] > within
        assert slowest[1] <= within
        assert simulate.fewest_nodes(units, Cluster(1), 0, HOUR) is None  # a unit takes longer

    @pytest.mark.parametrize(
        "times, share, by_hand",
        [
            ([15, 20, 35, 40, 50], 0.3, 20),  # 1.5 runs: the second one
            ([15, 20, 35, 40, 50], 0.4, 20),
            ([15, 20, 35, 40, 50], 0.5, 35),
            ([15, 20, 35, 40, 50], 1, 50),
            (range(1, 21), 0.95, 19),
            (range(1, 22), 0.95, 20),
            (range(1, 101), 0.07, 7),
            ([8, 9], 0, 8),
        ],
    )
    def test_a_percentile_is_the_nearest_rank(self, times, share, by_hand):
        runs = [simulate.Run(elapsed=seconds, busy=0, lost=0, failures=0) for seconds in times]
        assert simulate.percentile(runs, share) == by_hand


PLAN = """games = ["beamfall", "updraft"]
agents = ["random", "ram"]
trials = 2
training_episodes = 2
evaluation_episodes = 2
environment = "max_episode_frames=1000"
[agent.random]
trials = 1
"""


@pytest.mark.skipif(not os.path.exists(BINARY), reason=f"{BINARY} does not exist")
class TestUnits:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.place = tmp_path
        (self.place / "plan.toml").write_text(PLAN)

    def experiment(self, *words):
        return subprocess.run(
            [BINARY, "experiment", str(self.place / "plan.toml"), *words], capture_output=True, text=True, check=True
        ).stdout

    def test_they_are_as_many_and_as_long_as_the_program_says(self):
        agents = simulate.agents_of(self.experiment("--dry-run", "--unmeasured"))
        assert [(agent.name, agent.units) for agent in agents] == [("random", 2), ("ram", 4)]
        lengths = simulate.lengths_of(agents, {}, random.Random(1))
        assert len(lengths) == 6
        assert lengths[:3] == lengths[3:]  # a game after the other
        with pytest.raises(ValueError, match="has no line such as"):
            simulate.agents_of("racebeam: there is no plan\n")

    def test_a_pilot_tells_what_was_measured(self):
        results = self.place / "results"
        self.experiment("--into", str(results), "--threads", "1")
        measured = simulate.pilot_of(results)
        assert {agent: len(units) for agent, units in measured.items()} == {"random": 2, "ram": 4}
        for part, seconds in measured["ram"]:
            assert 0 < part <= 1 and 0 < seconds < 1, (part, seconds)
        # The plan of the pilot takes as long as the pilot took, but for the draws.
        agents = simulate.agents_of(self.experiment("--dry-run", "--unmeasured"))
        took = sum(
            float(row["training_seconds"]) + float(row["evaluation_seconds"])
            for row in simulate.rows_of(results / "times.csv")
        )
        means = {
            agent: [tuple(sum(values) / len(values) for values in zip(*units))] for agent, units in measured.items()
        }
        assert abs(sum(simulate.lengths_of(agents, means, random.Random(1))) / took - 1) <= 0.25

    def test_the_command_prints_a_row_for_each_number_of_nodes(self, tmp_path):
        command = [
            sys.executable,
            slurm.TOP / "cluster/simulate.py",
            "smoke",
            "--program",
            BINARY,
            "--cores",
            "2",
            "--runs",
            "3",
        ]
        done = subprocess.run(
            [*command, "--nodes", "1", "2", "--within", "1000"], capture_output=True, text=True, check=True
        )
        assert re.search(
            r"^\d+ units, [\d.]+ core-hours, longest unit [\d.]+ hours\n +nodes .*\n +1 +2 .*\n +2 +4 .*\n +1 +2 .*\n$",
            done.stdout,
        )
        done = subprocess.run([*command, "--within", "0.00001"], capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (1, "no number of nodes is enough for 1e-05 hours\n")
        done = subprocess.run([*command, "--nodes", "1", "--pilot", "/nowhere"], capture_output=True, text=True)
        sentence = "cannot read /nowhere/plan.toml: No such file or directory; --pilot takes a folder of results"
        assert (done.returncode, done.stderr) == (1, f"simulate.py: {sentence}\n")
        (tmp_path / "plan.toml").write_text('environment = "frame_skip=5"\n')
        done = subprocess.run([*command, "--nodes", "1", "--pilot", tmp_path], capture_output=True, text=True)
        sentence = f"{tmp_path}/plan.toml does not say max_episode_frames=N"
        assert (done.returncode, done.stderr) == (1, f"simulate.py: {sentence}\n")
        done = subprocess.run([*command[:2], "nothing", "--program", BINARY], capture_output=True, text=True)
        assert done.returncode == 1
        assert "unknown plan 'nothing'" in done.stderr

    def test_numbers_that_cannot_be_are_refused(self, subtests):
        command = [sys.executable, slurm.TOP / "cluster/simulate.py", "smoke", "--program", BINARY, "--within", "1000"]
        for option, value, takes in (
            ("--cores", "0", "a whole number from 1 on"),
            ("--cores", "-3", "a whole number from 1 on"),
            ("--nodes", "0", "a whole number from 1 on"),
            ("--runs", "0", "a whole number from 1 on"),
            ("--shards", "-1", "a whole number from 0 on"),
            ("--checkpoint", "0", "a number from 1 on"),
            ("--within", "nan", "a number from 0 on"),
            ("--failures", "inf", "a number from 0 on"),
            ("--slow", "1.5", "a number from 0 to 1"),
            ("--slowness", "many", "a number from 1 on"),
        ):
            with subtests.test(option=option, given=value):
                done = subprocess.run([*command, f"{option}={value}"], capture_output=True, text=True, timeout=60)
                assert done.returncode == 2
                assert done.stderr.endswith(f"error: argument {option}: it is '{value}'; it takes {takes}\n"), (
                    done.stderr
                )

    def test_a_program_that_is_not_there_is_named(self):
        command = [sys.executable, slurm.TOP / "cluster/simulate.py", "smoke", "--nodes", "1"]
        for words, complaint in (
            ((), "racebeam, looked for in the PATH"),
            (("--program", "/nowhere/racebeam"), "/nowhere/racebeam"),
        ):
            done = subprocess.run([*command, *words], capture_output=True, text=True, env={"PATH": "/nowhere"})
            assert (done.returncode, done.stderr) == (
                1,
                "simulate.py needs the program racebeam; it cannot start "
                f"{complaint}: No such file or directory; --program takes its path\n",
            )
