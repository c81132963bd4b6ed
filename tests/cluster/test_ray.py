"""The scripts of cluster/ray on a Ray cluster of several nodes on this machine, one of which is killed.

scripts/cluster-test --ray runs it by a Python that has racebeam and Ray.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

import pytest
import slurm
from small_experiment import PLAN, files

FOLDER = slurm.TOP / "cluster/ray"
sys.path.insert(0, str(FOLDER))
try:
    import experiment
    import racebeam.program
    import ray
    import rollouts
    from ray.cluster_utils import Cluster

    MISSING = None
except ImportError as error:
    MISSING = f"racebeam and Ray are not both installed: {error}"

COUNT, STEPS = 24, 200
STORE = 200 << 20  # bytes of a node's object store


pytestmark = pytest.mark.skipif(MISSING is not None, reason=str(MISSING))


def patiently(start, tries=4):
    """What `start` returns. On a busy machine, a node takes longer to start than the 30 seconds for which Ray waits."""
    while True:
        try:
            return start()
        except Exception as error:
            tries -= 1
            if tries == 0 or "timed out during startup" not in str(error):
                raise


@pytest.mark.usefixtures("self_cleanup")
class Nodes:
    def nodes(self, count):
        """Starts a cluster. Its first node is this process's, and has no processor for actors and tasks. Returns the
        cluster and its other nodes, which play."""
        os.environ["PYTHONPATH"] = os.pathsep.join(
            [str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])]
        )  # of the workers
        head = {"num_cpus": 0, "object_store_memory": STORE, "include_dashboard": False}
        cluster = patiently(lambda: Cluster(initialize_head=True, head_node_args=head))
        self.cleanup(cluster.shutdown)
        nodes = [patiently(lambda: cluster.add_node(num_cpus=1, object_store_memory=STORE)) for _ in range(count)]
        cluster.wait_for_nodes()
        ray.init(address=cluster.address, log_to_driver=False)
        self.cleanup(ray.shutdown)
        return cluster, nodes

    def after(self, found, act):
        """Calls `act` once `found()` is true."""

        def wait():
            while not found():
                time.sleep(0.02)
            act()

        thread = threading.Thread(target=wait, daemon=True)
        thread.start()
        return thread


def mapping_of(array):
    """The name of the memory in which an array lies, as /proc/self/maps has it."""
    address = array.__array_interface__["data"][0]
    for line in pathlib.Path("/proc/self/maps").read_text().splitlines():
        words = line.split(maxsplit=5)
        first, last = (int(word, 16) for word in words[0].split("-"))
        if first <= address < last:
            return words[5] if len(words) > 5 else ""
    return ""


class TestRollouts(Nodes):
    def total(self, actors, after=lambda count: None):
        """The total of rewards. Calls `after` with the number of rollouts that are there."""
        total = steps = 0
        for one in rollouts.rollouts("beamfall", actors=actors, count=COUNT, num_envs=4, steps=STEPS, obs_type="ram"):
            assert one["observations"].shape == (STEPS + 1, 4, 128)
            total += int(one["rewards"].sum())
            steps += 1
            after(steps)
        assert steps == COUNT
        return total

    def test_the_total_is_the_same_on_three_nodes_one_of_which_is_killed(self):
        cluster, _ = self.nodes(1)
        expected = self.total(1)
        assert expected > 0
        ray.shutdown()
        cluster.shutdown()
        cluster, nodes = self.nodes(3)
        killed = []

        def kill(seen):
            if seen == 5:
                cluster.remove_node(nodes[0], allow_graceful=False)
                killed.append(seen)

        assert (self.total(3, kill), killed) == (expected, [5])

    def test_a_rollout_is_read_where_it_lies(self):
        self.nodes(1)
        for one in rollouts.rollouts("beamfall", actors=1, count=2, num_envs=4):
            assert one["observations"].shape == (129, 4, 4, 84, 84)
            assert not one["observations"].flags.writeable
            assert "plasma" in mapping_of(one["observations"])

    def test_a_policy_plays_and_errors_end_it(self):
        self.nodes(1)
        (one,) = rollouts.rollouts(
            "beamfall", actors=1, count=1, num_envs=2, steps=5, policy=lambda observations, _: [len(observations), 0]
        )
        assert one["actions"].tolist() == [[2, 0]] * 5
        with pytest.raises(ray.exceptions.RayActorError, match="unknown game 'pongg'"):
            list(rollouts.rollouts("pongg", actors=1, count=1))
        with pytest.raises(IndexError, match="99"):
            list(rollouts.rollouts("beamfall", actors=1, count=1, num_envs=1, policy=lambda seen, _: [99]))


class TestWords:
    """What is wrong gets one sentence and no traceback: status 2 for a usage error, else 1."""

    def check(self, status, says, script, *words):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, FOLDER / script, *words], cwd=folder, capture_output=True, text=True, timeout=300
            )
        assert done.returncode == status, done.stderr
        assert re.search(f"^{script}: {says}", done.stderr.splitlines()[-1])
        assert "Traceback" not in done.stderr

    @pytest.mark.parametrize(
        "script, words, option",
        (
            ("rollouts.py", ("beamfall",), "--actors"),
            ("rollouts.py", ("beamfall",), "--rollouts"),
            ("rollouts.py", ("beamfall",), "--envs"),
            ("rollouts.py", ("beamfall",), "--steps"),
            ("experiment.py", ("smoke", "results"), "--shards"),
        ),
    )
    @pytest.mark.parametrize("number", ("0", "-2", "many"))
    def test_a_number_that_cannot_be(self, script, words, option, number):
        self.check(
            2,
            f"error: argument {option}: it is '{number}'; it takes a whole number from 1 on",
            script,
            *words,
            f"{option}={number}",
        )

    def test_a_game_and_a_plan_that_are_not_there(self):
        self.check(1, ".*unknown game 'nosuch'", "rollouts.py", "nosuch", "--actors", "1", "--rollouts", "1")
        self.check(
            1, "shard 1/1: racebeam: unknown plan 'nosuch'", "experiment.py", "nosuch", "results", "--shards", "1"
        )


class TestRllib(Nodes):
    def test_an_algorithm_learns_with_and_without_vector_environments(self, subtests):
        try:
            import rllib_ppo
            import torch  # noqa: F401
        except ImportError as error:
            pytest.skip(f"RLlib and PyTorch are not both installed: {error}")
        TestWords.check(self, 1, ".*`Nosuch` doesn't exist", "rllib_ppo.py", "Nosuch")
        self.nodes(1)
        for vector, actors in (
            (True, "racebeam.vector_env.AtariVectorEnv"),
            (False, "gymnasium.vector.sync_vector_env.SyncVectorEnv"),
        ):
            with subtests.test(vector=vector):
                algorithm = rllib_ppo.config("Beamfall", runners=1, envs=4, vector=vector).build_algo()
                result = algorithm.train()
                assert result["env_runners"]["num_env_steps_sampled"] >= 1024
                envs = algorithm.env_runner_group.foreach_env_runner(
                    lambda runner: f"{type(runner.env.unwrapped).__module__}.{type(runner.env.unwrapped).__name__}",
                    local_env_runner=False,
                )
                assert envs == [actors]
                algorithm.stop()


class TestExperiment(Nodes):
    def test_the_results_are_the_same_when_a_node_is_killed(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            plan = folder / "plan.toml"
            plan.write_text(PLAN)
            subprocess.run(
                [racebeam.program.path(), "experiment", plan, "--into", folder / "whole"],
                capture_output=True,
                check=True,
            )
            cluster, nodes = self.nodes(3)
            killer = self.after(
                lambda: any((folder / "parts").rglob("*.csv")),
                lambda: cluster.remove_node(nodes[0], allow_graceful=False),
            )
            experiment.run(str(plan), str(folder / "parts"), 8, [])
            killer.join()
            assert files(folder / "parts") == files(folder / "whole")
            with pytest.raises(Exception, match="shard 1/1: .*nonexistent"):
                experiment.run("/nonexistent.toml", str(folder / "none"), 1, [])
