"""racebeam.cluster: servers as jobs, here by submitit's executor for this machine."""

import os
import pathlib
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

    @pytest.mark.parametrize("arguments", ({"n": 0}, {"n": "two"}, {"n": 1, "image": "/nonexistent"}))
    def test_bad_input(self, arguments):
        with pytest.raises(racebeam.InvalidInput):
            SlurmServers(**arguments)
