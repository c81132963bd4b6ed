"""The job scripts of cluster/slurm on a real Slurm, and what they give compared with the same without Slurm.

Slice is what continuous integration has time for, and Whole the rest. Without root, or without Slurm, all are skipped.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import agent
import pytest
import slurm
import speed
from small_experiment import PLAN, files

sys.path.insert(0, str(slurm.TOP / "clients/python/single_file"))
import client

BINARY = os.environ.get("RACEBEAM_BINARY", str(slurm.TOP / "build/release/racebeam"))
SCRIPTS = slurm.TOP / "cluster/slurm"
SRUN = str(SCRIPTS / "racebeam-srun")
AGENT = str(pathlib.Path(agent.__file__).resolve())

PYTHON = os.environ.get(
    "RACEBEAM_PYTHON", str(slurm.TOP / "build/python/venv/bin/python")
)  # with racebeam and submitit
SHARDS = 24  # for 21 units: some have none
READY_WITHIN = 60  # seconds, for 200 servers


class Slurm:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, request):
        if (reason := slurm.missing()) is not None:
            pytest.skip(reason)
        cls.cluster = slurm.Cluster().__enter__()
        request.addfinalizer(cls.cluster.__exit__)
        cls.jobs = cls.cluster.folder / "jobs"
        cls.temporary = cls.cluster.folder / "tmp"
        cls.temporary.mkdir()
        cls.cluster.environment |= {
            "PATH": f"{pathlib.Path(BINARY).parent}:{os.environ['PATH']}",
            "TMPDIR": str(cls.temporary),
            "RACEBEAM_TEST": str(cls.cluster.folder),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        with client.Session.start(BINARY, "--log-level", "warning") as game:
            cls.expected = {number: agent.play(game, number) for number in range(16)}

    @pytest.fixture(autouse=True)
    def set_up(self, request):
        for path in self.jobs.iterdir():
            path.unlink() if path.is_file() else None
        self.results = self.jobs / re.sub(r"\W+", "-", request.node.name)
        self.results.mkdir()

    def job_processes(self):
        """The processes of jobs: all that have the tests' variable, which the daemons do not have."""
        return {
            number: words
            for number, words in slurm.processes(f"RACEBEAM_TEST={self.cluster.folder}").items()
            if words and not re.search("slurm|sbatch|munged", words)
        }

    def nothing_is_left(self):
        """Checks that no process, socket, announce file or folder of a job is left."""

        def leftovers():
            return [*self.job_processes().values(), *self.temporary.iterdir(), *self.jobs.glob("racebeam-*")]

        try:
            self.cluster.wait("the end of what jobs have left", lambda: not leftovers())
        except AssertionError as error:
            raise AssertionError(f"left: {leftovers()}\n{error}") from None

    def check_results(self, numbers):
        found = {path.name: path.read_text() for path in self.results.iterdir() if path.name.startswith("result-")}
        assert found == {f"result-{number}": f"{self.expected[number]}\n" for number in numbers}

    def agent(self, *words):
        return ("python3", AGENT, "--into", self.results, *words)

    def wait_for_files(self, pattern, count):
        self.cluster.wait(f"{count} of {pattern}", lambda: len(list(self.results.glob(pattern))) >= count)


class TestSlice(Slurm):
    def test_each_element_of_an_array_has_a_server(self):
        job = self.cluster.submit("--array=0-7", SCRIPTS / "array.sbatch", *self.agent())
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}
        self.check_results(range(8))
        self.nothing_is_left()

    def test_a_server_on_each_node_and_agents_in_another_step(self):
        job = self.cluster.submit("--nodes=4", "--ntasks-per-node=2", SCRIPTS / "nodes.sbatch", *self.agent())
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}, self.cluster.logs()
        self.check_results(range(8))
        self.nothing_is_left()

    def test_a_server_on_a_node_for_an_agent_here(self):
        done = subprocess.run(
            [SRUN, *self.agent()],
            cwd=self.jobs,
            capture_output=True,
            text=True,
            env=self.cluster.environment,
            timeout=slurm.PATIENCE,
        )
        assert done.returncode == 0, done.stderr
        self.check_results([0])
        self.nothing_is_left()

    def test_the_protocol_on_the_standard_streams_of_srun(self):
        os.environ |= {name: self.cluster.environment[name] for name in ("SLURM_CONF", "PATH", "RACEBEAM_TEST")}
        with client.Session.start(SRUN, "--log-level", "warning") as game:
            assert agent.play(game, 3) == self.expected[3]
        self.nothing_is_left()

    def test_servers_for_an_agent_in_python(self):
        imports = ("-c", "import racebeam.vector_env, submitit")
        if not pathlib.Path(PYTHON).exists() or subprocess.run([PYTHON, *imports], capture_output=True).returncode != 0:
            pytest.skip(f"{PYTHON} lacks racebeam or submitit (scripts/wheel --venv)")
        done = subprocess.run(
            [PYTHON, slurm.TOP / "tests/cluster/python_agent.py"],
            cwd=self.results,
            capture_output=True,
            text=True,
            env=self.cluster.environment | {"RACEBEAM_PROGRAM": BINARY},
            timeout=slurm.PATIENCE,
        )
        assert (done.returncode, done.stdout) == (0, "the same; 2 environments were lost, and played on\n"), done.stderr
        self.nothing_is_left()
        assert list(self.results.iterdir()) == []


@pytest.mark.slow
class TestWhole(Slurm):
    def test_a_server_that_is_killed_ends_its_element_and_no_other(self):
        job = self.cluster.submit(
            "--array=0-3", SCRIPTS / "array.sbatch", *self.agent("--reached", self.results, "--pause", "8")
        )
        self.wait_for_files("reached-*", 4)
        with_one = [number for number, words in self.job_processes().items() if "racebeam with" in words]
        children = [number for number in with_one if slurm.parent(number) in with_one]
        os.kill(children[0], signal.SIGKILL)
        assert self.cluster.wait_for_end(job) == {"COMPLETED", "FAILED"}
        assert len(list(self.results.glob("result-*"))) == 3
        self.nothing_is_left()

    @pytest.mark.parametrize(
        "script, words",
        (
            ("array.sbatch", ("--array=0-3",)),
            ("nodes.sbatch", ("--nodes=2", "--ntasks-per-node=2")),
        ),
    )
    def test_scancel_leaves_nothing(self, script, words):
        job = self.cluster.submit(*words, SCRIPTS / script, *self.agent("--reached", self.results, "--pause", "60"))
        self.wait_for_files("reached-*", 4)
        self.cluster.run("scancel", job)
        assert self.cluster.wait_for_end(job) == {"CANCELLED"}
        self.nothing_is_left()
        for path in self.results.iterdir():
            path.unlink()

    def test_the_time_limit_leaves_nothing(self):
        job = self.cluster.submit(
            "--time=0:01",
            "--nodes=2",
            "--ntasks-per-node=1",
            SCRIPTS / "nodes.sbatch",
            *self.agent("--reached", self.results, "--pause", "300"),
        )
        assert self.cluster.wait_for_end(job, 240) == {"TIMEOUT"}
        self.nothing_is_left()

    def test_a_requeued_job_gives_the_same(self):
        job = self.cluster.submit(
            "--nodes=2",
            "--ntasks-per-node=2",
            SCRIPTS / "nodes.sbatch",
            *self.agent("--reached", self.results, "--pause", "60"),
        )
        self.wait_for_files("reached-*", 4)
        self.cluster.run("scontrol", "requeue", job)
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}
        self.check_results(range(4))
        self.nothing_is_left()

    def test_a_node_that_fails_is_replaced(self, cleanup):
        job = self.cluster.submit(
            "--array=5", SCRIPTS / "array.sbatch", *self.agent("--reached", self.results, "--pause", "60")
        )
        self.wait_for_files("reached-*", 1)
        node = self.cluster.run("squeue", "-h", "-j", job, "-o", "%N").strip()
        self.cluster.set_slurmd_timeout(15)
        cleanup(self.cluster.set_slurmd_timeout, slurm.SLURMD_TIMEOUT)
        cleanup(self.cluster.restart_node, node)
        self.cluster.kill_node(node)
        self.cluster.wait("the end of its processes", lambda: not self.job_processes())
        (socket_folder,) = self.temporary.iterdir()  # on the node's own disk
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}
        assert self.cluster.restarts(f"{job}_5") == 1
        assert self.cluster.field("NodeList", f"{job}_5") != node
        self.check_results([5])
        shutil.rmtree(socket_folder)
        self.nothing_is_left()

    def test_a_heterogeneous_job_has_servers_and_a_learner_apart(self):
        learner = (
            "bash",
            "-c",
            "for RACEBEAM_ADDRESS in $RACEBEAM_SERVERS; do export RACEBEAM_ADDRESS; "
            'SLURM_PROCID=$((number++)) python3 "$@"; done',
            "learner",
            AGENT,
            "--into",
            self.results,
        )
        job = self.cluster.submit(SCRIPTS / "learner.sbatch", *learner)
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}, self.cluster.logs()
        self.check_results(range(2))
        self.nothing_is_left()

    def test_an_experiment_in_shards_is_the_same_byte_for_byte(self, cleanup):
        plan = self.results / "plan.toml"
        plan.write_text(PLAN)
        alone, shared = self.results / "alone", self.results / "shared"
        subprocess.run([BINARY, "experiment", plan, "--into", alone, "--threads", "1"], check=True, capture_output=True)
        words = (plan, shared, "--threads", "1", "--checkpoint-seconds", "0")
        job = self.cluster.submit(f"--array=1-{SHARDS}", SCRIPTS / "experiment.sbatch", *words)
        self.cluster.wait("a first unit", lambda: list(shared.glob("units/*")))
        stopped = self.stop_elements(job, 3)
        for element in stopped:
            self.cluster.run("scontrol", "requeue", element)
        self.cluster.run("scontrol", "update", "nodename=n2", "state=down", "reason=test")
        cleanup(self.cluster.run, "scontrol", "update", "nodename=n2", "state=resume", check=False)
        gathered = self.cluster.submit(
            f"--dependency=afterany:{job}", "--output", self.results / "gathered", SCRIPTS / "gather.sbatch", *words
        )
        assert self.cluster.wait_for_end(gathered, 400) == {"COMPLETED"}, self.cluster.logs()
        assert all(self.cluster.restarts(element) > 0 for element in stopped)
        assert files(shared) == files(alone)
        assert re.search(
            r"\d+ rows confirmed, 0 wrong, 0 could not be checked", (self.results / "gathered").read_text()
        )
        self.nothing_is_left()

    def stop_elements(self, job, count):
        """Stops running elements of an experiment, which cannot end until they are requeued. Returns their numbers and
        nodes."""
        stopped = {}

        def stop():
            for number in slurm.processes(f"SLURM_ARRAY_JOB_ID={job}", f"RACEBEAM_TEST={self.cluster.folder}"):
                try:
                    variables = dict(
                        word.partition("=")[::2]
                        for word in pathlib.Path(f"/proc/{number}/environ").read_text().split("\0")
                    )
                    if slurm.name_of(number) == "racebeam" and len(stopped) < count:
                        os.kill(number, signal.SIGSTOP)
                        stopped[f"{job}_{variables['SLURM_ARRAY_TASK_ID']}"] = variables["SLURMD_NODENAME"]
                except OSError:
                    continue
            return len(stopped) == count

        self.cluster.wait(f"{count} elements that run", stop)
        return stopped

    def test_an_urgent_job_preempts_an_element_and_the_results_are_the_same(self):
        plan, alone, shared = (self.results / name for name in ("plan.toml", "alone", "shared"))
        plan.write_text(PLAN)
        subprocess.run([BINARY, "experiment", plan, "--into", alone, "--threads", "1"], check=True, capture_output=True)
        words = (plan, shared, "--threads", "1", "--checkpoint-seconds", "0")
        job = self.cluster.submit(f"--array=1-{SHARDS}", SCRIPTS / "experiment.sbatch", *words)
        gathered = self.cluster.submit(f"--dependency=afterany:{job}", SCRIPTS / "gather.sbatch", *words)
        ((element, node),) = self.stop_elements(job, 1).items()
        urgent = self.cluster.submit("--partition=urgent", "--exclusive", f"--nodelist={node}", "--wrap", "hostname")
        assert self.cluster.wait_for_end(urgent) == {"COMPLETED"}
        assert self.cluster.restarts(element) > 0
        assert re.search(
            f"preempted JobId={element}.* has been requeued", (self.cluster.folder / "slurmctld.log").read_text()
        )
        assert self.cluster.wait_for_end(gathered, 400) == {"COMPLETED"}, self.cluster.logs()
        assert files(shared) == files(alone)
        self.nothing_is_left()

    def test_a_full_shared_disk_ends_the_element_with_a_sentence_and_loses_nothing(self, cleanup):
        plan, alone, shared = (self.results / name for name in ("plan.toml", "alone", "shared"))
        plan.write_text(PLAN)
        subprocess.run([BINARY, "experiment", plan, "--into", alone, "--threads", "1"], check=True, capture_output=True)
        shared.mkdir()
        if (
            subprocess.run(
                ["mount", "-t", "tmpfs", "-o", "size=32k", "racebeam-test", shared], capture_output=True
            ).returncode
            != 0
        ):
            pytest.skip("a file system cannot be mounted here")
        cleanup(subprocess.run, ["umount", "--lazy", shared], check=True)
        job = self.cluster.submit(
            "--array=1-2", "--output", self.results / "said-%a", SCRIPTS / "experiment.sbatch", plan, shared
        )
        assert self.cluster.wait_for_end(job) == {"FAILED"}
        for number in (1, 2):
            assert re.search(
                r"(?m)^racebeam: cannot write .*: No space left on device$",
                (self.results / f"said-{number}").read_text(),
            )
        subprocess.run(["mount", "-o", "remount,size=64m", shared], check=True)
        job = self.cluster.submit(SCRIPTS / "gather.sbatch", plan, shared)
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}, self.cluster.logs()
        assert files(shared) == files(alone)

    def test_a_shard_number_beyond_the_plan_is_named(self):
        job = self.cluster.submit(
            "--array=0",
            "--output",
            self.results / "said",
            SCRIPTS / "experiment.sbatch",
            "smoke",
            self.results / "shared",
        )
        assert self.cluster.wait_for_end(job) == {"FAILED"}
        assert (
            "racebeam: --shard: '0/0' is not a shard; accepted is K/N, with K from 1 to N"
            in (self.results / "said").read_text()
        )
        assert not (self.results / "shared").exists()

    def test_two_hundred_servers_of_one_array(self):
        """All are ready within a minute, in the best of three attempts."""
        seconds = []
        while len(seconds) < 3 and min(seconds, default=READY_WITHIN) >= READY_WITHIN:
            seconds.append(self.two_hundred_servers())
        assert min(seconds) < READY_WITHIN

    def two_hundred_servers(self):
        """Seconds until the last of them has loaded a game for its agent."""
        for path in self.results.glob("found-*"):
            path.unlink()
        began = time.time()
        job = self.cluster.submit(
            "--array=0-199",
            "--oversubscribe",
            SCRIPTS / "array.sbatch",
            "bash",
            "-c",
            f"source {slurm.TOP}/clients/shell/racebeam.bash; racebeam_connect && racebeam_ask load beamfall "
            f"&& racebeam_value game >{self.results}/found-$SLURM_ARRAY_TASK_ID",
        )
        assert self.cluster.wait_for_end(job) == {"COMPLETED"}
        seconds = max(path.stat().st_mtime for path in self.results.glob("found-*")) - began
        assert {path.read_text() for path in self.results.glob("found-*")} == {"beamfall\n"}
        assert len(list(self.results.glob("found-*"))) == 200
        self.nothing_is_left()
        print(f"\n200 servers of one array job: {seconds:.1f} s, load {os.getloadavg()[0]:.1f}")
        return seconds

    def test_steps_a_second_over_streams_and_over_sockets(self):
        """Prints them: docs/scale.md."""
        script = str(pathlib.Path(speed.__file__).resolve())
        environment = self.cluster.environment

        def measured(*words):
            done = subprocess.run(
                words,
                cwd=self.jobs,
                capture_output=True,
                text=True,
                check=True,
                env=environment,
                timeout=slurm.PATIENCE,
            )
            return json.loads(done.stdout)

        def between_steps():
            job = self.cluster.submit(
                "--nodes=2",
                "--ntasks-per-node=1",
                SCRIPTS / "nodes.sbatch",
                "bash",
                "-c",
                f"((SLURM_PROCID)) || exec python3 {script} >{self.results}/found",
            )
            assert self.cluster.wait_for_end(job) == {"COMPLETED"}, self.cluster.logs()
            return json.loads((self.results / "found").read_text())

        found = {
            "pipes": measured(sys.executable, script, "--program", BINARY),
            "pipes, srun": measured(sys.executable, script, "--program", SRUN),
            "TCP, srun": measured(SRUN, sys.executable, script),
            "TCP, two steps": between_steps(),
        }
        lengths = [{field: one["length"] for field, one in way.items()} for way in found.values()]
        assert lengths == lengths[:1] * len(found)
        self.nothing_is_left()
        print(
            f"\nsteps/s, load {os.getloadavg()[0]:.1f}\n{'':32}"
            + "".join(f"{name:>16}" for name in found)
            + f"{'bytes':>8}"
        )
        for field, length in lengths[0].items():
            print(f"{field:32}" + "".join(f"{way[field]['steps']:16.0f}" for way in found.values()) + f"{length:8}")
