"""A session that is interrupted, forked, closed or used by several threads never gives a reply to another request."""

import contextlib
import linecache
import os
import pathlib
import platform
import re
import socket
import sys
import threading
import time
import unittest
import unittest.mock

import package
import pytest

package.require("gymnasium", "numpy")

import numpy as np
import racebeam
from racebeam import AtariEnv, AtariVectorEnv
from vector_servers import halt, server

pytestmark = pytest.mark.needs_program

PATIENCE = 60  # seconds
WIRE = str(pathlib.Path(racebeam.__file__).parent / "wire")


class Interrupt:
    """Raises KeyboardInterrupt before the line of racebeam.wire that is the `after`-th to run, as Ctrl-C does
    anywhere."""

    def __init__(self, after):
        self.remaining, self.is_raised = after, False

    def __call__(self, frame, event, _):
        if not frame.f_code.co_filename.startswith(WIRE):
            return None
        if event == "line" and not self._is_of_a_block(frame):
            self.remaining -= 1
            if self.remaining < 0:
                self.is_raised = True
                raise KeyboardInterrupt
        return self

    @staticmethod
    def _is_of_a_block(frame):
        """At the beginning and the end of one, only tracing raises an exception, and would skip the end."""
        return linecache.getline(frame.f_code.co_filename, frame.f_lineno).lstrip().startswith(("with ", "try:"))

    def within(self, call):
        """Whether the call was interrupted."""
        sys.settrace(self)
        with contextlib.suppress(KeyboardInterrupt):
            call()
        sys.settrace(None)
        return self.is_raised


def contents_of(result):
    """What reset() or step() returned, as comparable values."""
    observation, *rest = result
    return observation.tobytes(), str(rest)


class TestInterrupted:
    def check(self, make, act):
        """At each line of a step in turn. Then the environment either ends with a sentence, or answers what was
        asked."""
        here = make(None)
        here.reset(seed=1)
        expected = contents_of(here.reset(seed=5))
        ends = answered = 0
        while True:
            there = make(self.address)
            there.reset(seed=1)
            there.step(act)
            if not Interrupt(ends + answered).within(lambda: there.step(act)):
                break
            try:
                assert contents_of(there.reset(seed=5)) == expected
                answered += 1
            except ConnectionError as error:
                assert re.search("was interrupted|were interrupted", str(error))
                ends += 1
            there.close()
        assert ends > 5
        assert answered > 5

    def test_a_step_that_is_cut_off_anywhere(self):
        with server() as (self.address, _):
            self.check(lambda where: AtariEnv("beamfall", server=where, obs_type="ram"), 1)
            self.check(
                lambda where: AtariEnv(
                    "beamfall", server=where, obs_type="ram", max_num_frames_per_episode=10, frameskip=9
                ),
                1,
            )
            self.check(lambda where: AtariVectorEnv("beamfall", 2, server=where, obs_type="ram"), [1, 1])

    def test_a_step_of_several_servers_that_is_cut_off_anywhere(self):
        with server() as (one, _), server() as (other, _):
            self.address = [one, other]
            settings = {"obs_type": "ram", "noop_max": 1}

            def make(where):
                envs = AtariVectorEnv("beamfall", 2, server=where or one, **settings)
                if where is not None:
                    return envs
                reset = envs.reset

                def with_lost(**arguments):
                    observations, info = reset(**arguments)
                    return observations, {**info, "lost": np.zeros(2, np.bool_)}

                envs.reset = with_lost
                return envs

            self.check(make, [1, 1])

    def test_a_session_that_is_cut_off_says_so(self):
        with racebeam.launch() as session:
            session.load("beamfall", seed=1)
            session._reader = unittest.mock.Mock(readline=unittest.mock.Mock(side_effect=KeyboardInterrupt))
            with pytest.raises(KeyboardInterrupt):
                session.act(1)
            for call in (
                session.flush,
                session.receive,
                lambda: session.send("act", 1),
                lambda: session.act(1),
                lambda: session.help(),
            ):
                with pytest.raises(
                    ConnectionError, match="it was interrupted between a request and the end of its reply"
                ):
                    call()

    def test_a_request_waits_for_the_replies_of_those_before_it(self):
        with racebeam.launch() as session:
            session.load("beamfall", seed=1)
            session.send("act", 1)
            for call in (lambda: session._begin("act", 1), lambda: session.act(1), session.help):
                with pytest.raises(ValueError, match="1 requests were sent ahead; receive their replies first"):
                    call()
            assert "reward" in session.receive()[0]
            assert "act" in session.help()


def await_system_call(thread):
    """Waits until a thread has ended, or is in a system call that is not of a lock: it sends or receives."""
    futex = {"x86_64": "202", "aarch64": "98"}[platform.machine()]
    until = time.monotonic() + PATIENCE
    while thread.is_alive() and time.monotonic() < until:
        try:
            call = pathlib.Path(f"/proc/self/task/{thread.native_id}/syscall").read_text().split()[0]
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            return
        if call not in ("running", futex):
            return
        time.sleep(0.001)


@pytest.mark.usefixtures("self_cleanup")
class TestBlocked:
    def test_a_long_step_past_the_end_of_the_game(self):
        """Each act after the end is a request: more of them than a connection buffers."""
        settings = {"max_num_frames_per_episode": 10, "frameskip": 60000}
        here = AtariEnv("beamfall", **settings)
        with server() as (address, _):
            there = AtariEnv("beamfall", server=address, **settings)
            for env in (here, there):
                env.reset(seed=1)
            assert contents_of(there.step(1)) == contents_of(here.step(1))
            assert there.clone_state(include_rng=True) == here.clone_state(include_rng=True)

    def test_closing_does_not_wait_for_a_server_that_does_not_read(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
            opening = threading.Thread(target=self.answer_hello, args=(listener,))
            opening.start()
            session = racebeam.connect(address)
            opening.join()

            def send():
                with contextlib.suppress(ConnectionError):
                    while True:
                        session.send("act", "0" * 100000)

            threads = [threading.Thread(target=call, daemon=True) for call in (send, session.close_connection)]
            for thread in threads:
                thread.start()
                await_system_call(thread)
            for thread in threads:
                thread.join(10)
            assert not any(thread.is_alive() for thread in threads)

    def answer_hello(self, listener):
        self.connection, _ = listener.accept()
        self.cleanup(self.connection.close)
        self.connection.recv(100)
        self.connection.sendall(b"ok server=x protocol=1\n")

    def test_another_thread_can_close_an_environment_that_waits(self):
        with server() as (address, process):
            env, failures = AtariEnv("beamfall", server=address), []
            env.reset(seed=1)
            halt(process)

            def step():
                try:
                    env.step(1)
                except Exception as error:
                    failures.append(type(error))

            thread = threading.Thread(target=step, daemon=True)
            thread.start()
            await_system_call(thread)
            env.close()
            thread.join(PATIENCE)
            assert failures == [ConnectionError]

    def test_a_silent_server_is_a_TimeoutError_of_each_kind(self, subtests):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
            for make in (AtariEnv, AtariVectorEnv):
                with subtests.test(make=make), pytest.raises(TimeoutError, match="did not answer in time"):
                    make("beamfall", server=address, timeout=0.2)
        with server() as (address, process):
            env = AtariEnv("beamfall", server=address, timeout=0.3)
            env.reset(seed=1)
            halt(process)
            with pytest.raises(TimeoutError):
                env.step(1)
            with pytest.raises(ConnectionError):
                env.step(1)


class TestShared:
    def in_child(self, call):
        """The sentence of the RuntimeError that the call raises in a child process."""
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                call()
            except RuntimeError as error:
                os.write(writer, str(error).encode())
            os._exit(0)
        os.waitpid(child, 0)
        os.close(writer)
        with os.fdopen(reader) as said:
            return said.read()

    def test_a_child_process_is_refused_and_the_parent_goes_on(self):
        with server() as (address, _):
            env, envs, session = (
                AtariEnv("beamfall", server=address),
                AtariVectorEnv("beamfall", 2, server=address),
                racebeam.connect(address),
            )
            env.reset(seed=1)
            session.load("beamfall")
            for call in (
                lambda: env.step(0),
                env.reset,
                env.clone_state,
                env.ale.lives,
                lambda: envs.step([0, 0]),
                envs.reset,
                lambda: session.act(1),
                lambda: session.send("act", 1),
            ):
                assert "before the process forked" in self.in_child(call)
            for close in (env.close, envs.close, session.close_connection):
                assert self.in_child(close) == ""
            assert env.step(0)[4]["frame_number"] == 4
            envs.step([0, 0])
            assert "reward" in session.act(1)

    def test_threads_of_one_environment_take_turns(self):
        with server() as (address, _):
            env, failures = AtariEnv("beamfall", server=address), []
            env.reset(seed=1)
            calls = (
                lambda: env.step(1),
                env.ale.getScreenRGB,
                env.ale.getRAM,
                env.clone_state,
                env.ale.lives,
                env.ale.game_over,
            )

            def work(number):
                try:
                    for step in range(60):
                        calls[(step + number) % len(calls)]()
                except Exception as error:
                    failures.append(error)

            threads = [threading.Thread(target=work, args=(number,), daemon=True) for number in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join(PATIENCE)
            assert (failures, [thread for thread in threads if thread.is_alive()]) == ([], [])
            assert env.ale.getFrameNumber() == 4 * 40
