"""Threads, forks, signals, memory: nothing hangs, nothing crashes, and other threads run meanwhile."""

import gc
import operator
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import package
import pytest

package.require("numpy")

import racebeam

PATIENCE = 60


def loaded(**settings):
    ale = racebeam.ALEInterface()
    ale.setInt("random_seed", 1)
    for key, value in settings.items():
        ale.setInt(key, value)
    ale.loadROM("builtin:beamfall")
    return ale


def await_work(process):
    """Waits until a process, which does nothing else, has worked for a fifth of a second."""
    until = time.monotonic() + PATIENCE

    def ticks():
        fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        return int(fields[11]) + int(fields[12])

    goal = ticks() + os.sysconf("SC_CLK_TCK") // 5
    while ticks() < goal and time.monotonic() < until:
        time.sleep(0.01)


class TestThreads:
    def test_two_threads_of_one_game_take_turns(self):
        ale, failures = loaded(), []
        everything = (
            lambda: ale.act(1),
            ale.getScreenRGB,
            ale.getRAM,
            lambda: ale.cloneState(True).serialize(),
            ale.reset_game,
            lambda: ale.restoreState(ale.cloneState()),
            lambda: ale.loadROM("builtin:beamfall"),
            ale.getMinimalActionSet,
        )

        def work(seed):
            try:
                for step in range(300):
                    everything[(step * 7 + seed) % len(everything)]()
            except Exception as error:
                failures.append(error)

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(PATIENCE)
        assert (failures, [thread for thread in threads if thread.is_alive()]) == ([], [])

    def test_one_thread_does_not_hold_up_another(self):
        ale, counted, done = loaded(frame_skip=50_000_000), [0], threading.Event()

        def play():
            ale.act(1)
            done.set()

        thread = threading.Thread(target=play)
        thread.start()
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)
        thread.join()
        assert counted[0] > 10

    @pytest.mark.needs_posix
    def test_Ctrl_C_ends_a_long_step(self):
        script = (
            "import racebeam, signal\n"
            "signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it\n"
            "env = racebeam.AtariEnv('beamfall', frameskip=10**9)\n"
            "env.reset(seed=1); env.ale.setInt('max_num_frames_per_episode', 0)\n"
            "print('begins', flush=True)\n"
            "try: env.step(1)\n"
            "except KeyboardInterrupt: print('ended', env.ale.getFrameNumber() > 0)"
        )
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        assert process.stdout.readline() == "begins\n"
        await_work(process)
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=PATIENCE)[0] == "ended True\n"

    def test_Python_ends_while_threads_play(self, subtests):
        head = "import racebeam, threading, time\n"
        makes = [
            "ale = racebeam.ALEInterface(); ale.loadROM('builtin:beamfall'); play = lambda: ale.act(1)",
            (
                "ale = racebeam.ALEInterface(); ale.loadROM('builtin:beamfall'); play = lambda: ale.step(1, 1.0, "
                "10**9, racebeam._core.View.NONE)"
            ),
            "ale = racebeam.ALEInterface(); play = lambda: ale.loadROM('builtin:beamfall')",
            "play = lambda: racebeam.ALEInterface.isSupportedROM('builtin:beamfall')",
        ]
        if package.has("gymnasium"):
            makes += [
                "envs = racebeam.AtariVectorEnv('beamfall', 8); play = lambda: envs.step([0] * 8)",
                (
                    "envs = racebeam.AtariVectorEnv('beamfall', 8, frameskip=1000); play = lambda: (envs.send([0] * "
                    "8), envs.recv())"
                ),
                "play = lambda: racebeam.AtariVectorEnv('beamfall', 3)",
            ]
        for make in makes:
            with subtests.test(make=make):
                script = (
                    f"{head}{make}\ndef forever():\n    while True:\n        try: play()\n        except "
                    f"Exception: pass\n"
                    "begin = time.process_time()\n"
                    "for _ in range(3): threading.Thread(target=forever, daemon=True).start()\n"
                    "while time.process_time() < begin + 0.2: time.sleep(0.001)"  # until they play
                )
                done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE)
                assert (done.returncode, done.stderr) == (0, "")

    @pytest.mark.needs_posix
    def test_a_child_of_fork_goes_on_with_the_game(self):
        ale = loaded()
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            os.write(writer, str(sum(ale.act(1) for _ in range(200))).encode())
            os._exit(0)
        os.waitpid(child, 0)
        assert int(os.read(reader, 100)) == sum(ale.act(1) for _ in range(200))
        os.close(reader)
        os.close(writer)

    @pytest.mark.needs_posix
    def test_a_game_that_another_thread_used_at_the_fork_is_refused(self):
        script = (
            "import os, racebeam, threading, time\n"
            "ale = racebeam.ALEInterface(); ale.setInt('frame_skip', 200_000_000); ale.loadROM('builtin:beamfall')\n"
            "thread = threading.Thread(target=ale.act, args=(1,)); thread.start()\n"
            "begin = time.process_time()\n"
            "while time.process_time() < begin + 0.05 and thread.is_alive(): time.sleep(0.001)\n"  # until it plays
            "child = os.fork()\n"
            "if child == 0:\n"
            "    try: ale.getRAM()\n"
            "    except RuntimeError as error: os._exit(7 if 'when the process forked' in str(error) else 8)\n"
            "    os._exit(9)\n"
            "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])); thread.join()"
        )
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=PATIENCE
        )
        assert done.stdout.strip() == "7", done.stderr

    @pytest.mark.needs_posix
    def test_a_pool_of_processes_takes_games_by_pickling(self, subtests):
        import multiprocessing

        for method in ("forkserver", "spawn"):
            with subtests.test(method=method), multiprocessing.get_context(method).Pool(1) as pool:
                ale = loaded()
                assert pool.apply(operator.methodcaller("act", 1), (ale,)) == ale.act(1)


@pytest.mark.needs_posix
class TestMemory:
    def test_the_memory_of_arrays_is_released(self):
        import resource

        ale = loaded()

        def use(times):
            for _ in range(times):
                ale.getScreenRGB(), ale.getRAM(), ale.cloneState(), ale.step(0, 1.0, 1, racebeam._core.View.RGB)
            gc.collect()
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

        use(500)
        assert use(5000) - use(0) < 20000  # 5,000 arrays have 500,000 KB
        before = use(0)
        assert use(5000) - before < 20000

    def test_impossible_calls_raise_exceptions(self, subtests):
        ale = loaded()
        for words in ((0, float("nan"), 1), (0, float("inf"), 1), (99, 1.0, 1), (0, 1.0, 0), (0, 1.0, -5)):
            with subtests.test(words=words), pytest.raises(ValueError):
                ale.step(*words, racebeam._core.View.RGB)
