"""racebeam.cluster: servers as jobs, here by submitit's executor for this machine."""

import os
import pathlib
import sys
import threading
import time

import package
import pytest

package.require("gymnasium", "numpy", "submitit")

import racebeam
import submitit
from racebeam.cluster import SlurmServers


def processes(mark):
    """The process ids of servers whose command line has `mark`."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdecimal() and mark.encode() in (entry / "cmdline").read_bytes():
                found.append(int(entry.name))
        except OSError:
            continue
    return found


class TestServers:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path

    def servers(self, n, image=None, **options):
        return SlurmServers(
            n, image, folder=self.folder, executor=submitit.LocalExecutor(self.folder / "logs"), wait=60, **options
        )

    def nothing_is_left(self):
        until = time.monotonic() + 30
        while processes(str(self.folder)) and time.monotonic() < until:
            time.sleep(0.05)
        assert processes(str(self.folder)) == []
        assert [path.name for path in self.folder.iterdir()] == ["logs"]

    def test_environments_on_all_servers(self):
        with self.servers(3, timeout_min=5) as addresses:
            envs = racebeam.AtariVectorEnv("beamfall", 6, server=addresses, seed=1)
            here = racebeam.AtariVectorEnv("beamfall", 6, seed=1)
            for _ in range(5):
                assert (envs.step([1] * 6)[0] == here.step([1] * 6)[0]).all()
            envs.close()
            sessions = [racebeam.connect(address) for address in addresses]
            assert len({session.address for session in sessions}) == 3
        self.nothing_is_left()

    def test_images_and_options(self):
        image = self.folder / "roms" / "game.bin"
        image.parent.mkdir()
        image.write_bytes(os.urandom(4096))
        with self.servers(1, image, options=["--max-machines", "2"], listen="tcp://127.0.0.1:0") as (address,):
            with racebeam.connect(address) as session:
                assert session.hello()["max_machines"] == 2
        image.unlink()
        image.parent.rmdir()
        self.nothing_is_left()

    def test_an_exception_ends_the_servers(self):
        with pytest.raises(KeyError), self.servers(2) as addresses:
            racebeam.connect(addresses[0]).close_connection()
            raise KeyError
        self.nothing_is_left()

    def test_without_submitit_it_says_what_is_missing(self, monkeypatch):
        monkeypatch.setitem(sys.modules, "submitit", None)
        with pytest.raises(ImportError, match="racebeam.cluster needs submitit; "), SlurmServers(1, folder=self.folder):
            pass
        assert list(self.folder.iterdir()) == []

    @pytest.mark.parametrize("arguments", ({"n": 0}, {"n": "two"}, {"n": 1, "image": "/nonexistent"}))
    def test_bad_input(self, arguments):
        with pytest.raises(racebeam.InvalidInput):
            SlurmServers(**arguments)


class Job:
    def __init__(self):
        self.ends = []

    def cancel(self, check=True):
        self.ends.append(check)


class Executor:
    """Takes jobs as an executor of submitit does, and runs none."""

    def __init__(self, error=None):
        self.error = error

    def update_parameters(self, **parameters):
        self.parameters = parameters

    def map_array(self, _, options):
        if self.error:
            raise self.error
        self.options = options
        self.jobs = [Job() for _ in options]
        return self.jobs


class TestJobs:
    """The resources that the package requests from the scheduler."""

    @pytest.mark.parametrize("image, roms", (("roms/game.bin", "roms"), ("roms", "roms"), (None, None)))
    def test_each_server_has_the_options_and_an_announce_file(self, tmp_path, image, roms):
        (tmp_path / "roms").mkdir()
        (tmp_path / "roms" / "game.bin").touch()
        (tmp_path / "jobs").mkdir()
        executor, options = Executor(), ("--max-machines", "2")
        image = image and tmp_path / image
        servers = SlurmServers(
            2, image, options=options, folder=tmp_path / "jobs", wait=2.5, executor=executor, slurm_partition="cpu"
        )
        with servers as addresses:
            assert executor.parameters == {"name": "racebeam-servers", "slurm_partition": "cpu"}
            (folder,) = (tmp_path / "jobs").iterdir()
            files = [f"{folder}/server-{number}" for number in range(2)]
            assert addresses == [f"file:{file}?wait=2.5" for file in files]
            start = [*(["--roms", str(tmp_path / roms)] if roms else []), *options, "--listen", "tcp://0.0.0.0:0"]
            assert executor.options == [[*start, "--announce", file] for file in files]
            assert servers.jobs == executor.jobs
        assert [job.ends for job in executor.jobs] == [[False], [False]]
        assert servers.jobs == []
        assert list((tmp_path / "jobs").iterdir()) == []

    def test_without_an_executor_submitit_chooses_one_whose_logs_go_with_the_jobs(self, tmp_path, monkeypatch):
        executor, folders = Executor(), []
        monkeypatch.setattr(submitit, "AutoExecutor", lambda folder: folders.append(folder) or executor)
        with SlurmServers(1, folder=tmp_path) as (address,):
            (folder,) = tmp_path.iterdir()
            assert folders == [folder / "%j"]  # submitit replaces %j by the number of the job
            assert address == f"file:{folder}/server-0?wait=300"
        assert list(tmp_path.iterdir()) == []

    def test_jobs_may_have_another_name(self, tmp_path):
        executor = Executor()
        with SlurmServers(1, folder=tmp_path, executor=executor, name="mine"):
            assert executor.parameters == {"name": "mine"}

    def test_jobs_that_are_refused_leave_nothing(self, tmp_path):
        refusal = RuntimeError("no such partition")
        with pytest.raises(RuntimeError) as raised, SlurmServers(1, folder=tmp_path, executor=Executor(refusal)):
            pass
        assert raised.value is refusal
        assert list(tmp_path.iterdir()) == []

    def test_a_job_that_still_writes_leaves_nothing(self, tmp_path):
        def write(folder):
            until = time.monotonic() + 0.5
            while time.monotonic() < until:
                try:
                    (folder / f"{time.monotonic()}").touch()
                except FileNotFoundError:
                    break

        with SlurmServers(1, folder=tmp_path, executor=Executor()):
            (folder,) = tmp_path.iterdir()
            job = threading.Thread(target=write, args=(folder,))
            job.start()
        assert list(tmp_path.iterdir()) == []
        job.join()
