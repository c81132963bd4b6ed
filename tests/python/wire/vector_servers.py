"""Separate servers, and environments on them that are compared with those in this process."""

import contextlib
import pathlib
import signal
import subprocess
import tempfile
import time

import numpy as np
import racebeam.program


@contextlib.contextmanager
def server(*options):
    """The address of a server that serves a Unix socket, and its process."""
    with tempfile.TemporaryDirectory() as folder:
        ready = pathlib.Path(folder, "ready")
        process = subprocess.Popen(
            [racebeam.program.path(), "serve", "--listen", f"unix:{folder}/s", "--ready-file", str(ready), *options],
            stderr=subprocess.DEVNULL,
        )
        try:
            while not ready.exists():
                time.sleep(0.01)
            yield f"unix:{folder}/s", process
        finally:
            process.kill()
            process.wait()


def halt(process):
    """Stops all threads of a process: the signal returns before they have."""
    process.send_signal(signal.SIGSTOP)
    until = time.monotonic() + 60
    threads = [thread / "stat" for thread in pathlib.Path(f"/proc/{process.pid}/task").iterdir()]
    while any(stat.read_text().rpartition(")")[2].split()[0] != "T" for stat in threads) and time.monotonic() < until:
        time.sleep(0.001)


class Compared:
    def check(self, shown, expected):
        for one, other in zip(shown[:-1], expected[:-1]):
            assert (one.dtype, one.shape) == (other.dtype, other.shape)
            assert np.array_equal(one, other)
        self.check_info(shown[-1], expected[-1])

    def check_info(self, info, expected):
        assert list(info) == list(expected)
        for key, value in expected.items():
            if isinstance(value, dict):
                self.check_info(info[key], value)
            elif value.dtype == object:
                assert all(
                    one is other is None or np.array_equal(one, other) for one, other in zip(info[key], value)
                ), key
            else:
                assert info[key].dtype == value.dtype
                assert np.array_equal(info[key], value), key

    def play(self, here, there, steps):
        """How many episodes ended."""
        here.action_space.seed(1)
        ends = 0
        for _ in range(steps):
            actions = here.action_space.sample()
            expected = here.step(actions)
            self.check(there.step(actions), expected)
            ends += np.count_nonzero(expected[2] | expected[3])
        return ends
