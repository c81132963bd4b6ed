"""A session that is interrupted, forked, closed or used by several threads never gives a reply to another request."""

import asyncio
import contextlib
import linecache
import os
import pathlib
import signal
import socket
import sys
import threading
import time
import unittest

import package

package.require("gymnasium", "numpy")

import numpy as np
from vector_servers import server

import racebeam
from racebeam import AtariEnv, AtariVectorEnv
from racebeam.wire import aio

PATIENCE = 60  # seconds
WIRE = str(pathlib.Path(racebeam.__file__).parent / "wire")


class Interrupt:
    """Raises KeyboardInterrupt before the line of racebeam.wire that is the `after`-th to run, as Ctrl-C does anywhere."""

    def __init__(self, after):
        self.left, self.is_raised = after, False

    def __call__(self, frame, event, _):
        if not frame.f_code.co_filename.startswith(WIRE):
            return None
        if event == "line" and not self._is_with(frame):
            self.left -= 1
            if self.left < 0:
                self.is_raised = True
                raise KeyboardInterrupt
        return self

    @staticmethod
    def _is_with(frame):
        """Also where the block ends: an exception there, which only tracing raises, would skip the end of the block."""
        return linecache.getline(frame.f_code.co_filename, frame.f_lineno).lstrip().startswith("with ")

    def within(self, call):
        """Whether the call was interrupted."""
        sys.settrace(self)
        with contextlib.suppress(KeyboardInterrupt):
            call()
        sys.settrace(None)
        return self.is_raised


def shown(result):
    """What reset() or step() returned, as comparable values."""
    observation, *rest = result
    return observation.tobytes(), str(rest)


class Interrupted(unittest.TestCase):
    def check(self, make, act):
        """At each line of a step in turn. Then the environment either ends with a sentence, or answers what was asked."""
        here = make(None)
        here.reset(seed=1)
        expected = shown(here.reset(seed=5))
        ended = answered = 0
        while True:
            there = make(self.address)
            there.reset(seed=1)
            there.step(act)
            if not Interrupt(ended + answered).within(lambda: there.step(act)):
                break
            try:
                self.assertEqual(shown(there.reset(seed=5)), expected)
                answered += 1
            except ConnectionError as error:
                self.assertRegex(str(error), "was interrupted|were interrupted")
                ended += 1
            there.close()
        self.assertGreater(ended, 5)
        self.assertGreater(answered, 5)

    def test_a_step_that_is_cut_off_anywhere(self):
        with server() as (self.address, _):
            self.check(lambda where: AtariEnv("beamfall", server=where, frameskip=3), 1)
            self.check(lambda where: AtariEnv("beamfall", server=where, max_num_frames_per_episode=10, frameskip=9), 1)
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
            self.assertTrue(Interrupt(12).within(lambda: session.act(1)))
            for call in (session.flush, session.receive, lambda: session.send("act", 1), lambda: session.act(1), lambda: session.help()):
                with self.assertRaisesRegex(ConnectionError, "it was interrupted between a request and the end of its reply"):
                    call()

    def test_a_request_waits_for_the_replies_of_those_before_it(self):
        with racebeam.launch() as session:
            session.load("beamfall", seed=1)
            session.send("act", 1)
            for call in (lambda: session.begin("act", 1), lambda: session.act(1), session.help):
                with self.assertRaisesRegex(ValueError, "1 requests were sent ahead; receive their replies first"):
                    call()
            self.assertIn("reward", session.receive()[0])
            self.assertIn("act", session.help())


if __name__ == "__main__":
    package.main()
