"""AtariVectorEnv: threads, forks and signals."""

import mmap
import pathlib
import signal
import subprocess
import sys
import threading
import time

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from racebeam import AtariVectorEnv
from vectors import SHORT, play, same


class TestThreads:
    PATIENCE = 60

    def test_two_threads_take_turns(self):
        envs, failures = AtariVectorEnv("beamfall", 4, num_threads=2, autoreset_mode="SameStep", **SHORT), []
        calls = (lambda: envs.step(np.zeros(4, int)), envs.reset, lambda: envs.restore(1, envs.save(2)), envs.show)

        def work(first):
            try:
                for step in range(100):
                    calls[(first + step) % len(calls)]()
            except Exception as error:
                failures.append(error)

        threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(self.PATIENCE)
        assert (failures, [thread for thread in threads if thread.is_alive()]) == ([], [])

    @pytest.mark.needs_posix
    def test_a_child_after_a_fork_is_refused_and_ends(self):
        script = (
            "import os, racebeam\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 4, num_threads=2, seed=1); envs.step([0] * 4)\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "    refused = 0\n"
            "    for call in (lambda: envs.step([0] * 4), envs.reset, lambda: envs.save(0)):\n"
            "        try: call()\n"
            "        except RuntimeError as error: refused += 'before the process forked' in str(error)\n"
            "    envs.close(); del envs\n"
            "    os._exit(refused)\n"
            "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])); envs.step([0] * 4); print('on')"
        )
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=self.PATIENCE
        )
        assert done.stdout.split() == ["3", "on"], done.stderr

    @pytest.mark.needs_posix
    def test_the_memory_of_results_is_released(self):
        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * mmap.PAGESIZE

        envs = AtariVectorEnv("beamfall", 8, seed=1)
        play(envs, 20)
        before = resident()
        for _ in range(50):
            play(envs, 10)  # 110 MB of observations in all
        assert resident() - before < 20 << 20


@pytest.mark.needs_posix
class TestInterrupts:
    """Ctrl-C ends what takes long, and leaves the environments so that they can go on."""

    LONG = {"num_envs": 500, "frameskip": 1000, "noop_max": 1000}

    def interrupt(self, call, raised=KeyboardInterrupt, handler=signal.default_int_handler):
        """`call` raises that, soon after a signal. Returns the seconds of processors it took."""
        before = signal.signal(signal.SIGALRM, handler)
        begin = time.process_time()
        try:
            with pytest.raises(raised):
                signal.setitimer(signal.ITIMER_REAL, 0.1)
                call()
                time.sleep(1)  # a signal that comes late
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        return time.process_time() - begin

    def test_a_step_and_a_reset(self):
        envs = AtariVectorEnv("beamfall", **self.LONG, seed=1)
        for call in (lambda: envs.step([1] * 500), lambda: envs.reset(seed=1)):
            before = envs.show()[1]["frame_number"]
            self.interrupt(call)
            assert (envs.show()[1]["frame_number"] == before).any()
        assert envs.reset(seed=1)[0].shape[0] == 500

    def test_making_them(self):
        begin = time.process_time()
        AtariVectorEnv("beamfall", **self.LONG)
        whole = time.process_time() - begin
        assert self.interrupt(lambda: AtariVectorEnv("beamfall", **self.LONG)) < whole

    def test_what_is_received_later_is_not_lost(self):
        envs, others = (AtariVectorEnv("beamfall", **self.LONG, seed=1) for _ in range(2))
        envs.send([1] * 500)
        self.interrupt(envs.recv)
        assert same([envs.recv()], [others.step([1] * 500)])
        envs.send([1] * 500)
        self.interrupt(envs.recv)
        assert same([envs.reset(seed=1)], [others.reset(seed=1)])

    def test_a_signal_handler_that_uses_the_environments(self):
        envs = AtariVectorEnv("beamfall", **self.LONG)
        self.interrupt(lambda: envs.step([1] * 500), RuntimeError, lambda *_: envs.save(0))
