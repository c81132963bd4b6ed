"""What fuzz.py calls on servers: sessions, environments, and what may happen to them: Ctrl-C, a fork, other threads.

Each round has its own server. A reply that is given to another request, and a child process that is not refused,
are an AssertionError.
"""

import asyncio
import atexit
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

import numpy as np
import racebeam
import racebeam.program
from racebeam.wire import aio

LATE = 30  # seconds: a server that takes longer hangs
DOCUMENTED = (racebeam.Refused, ConnectionError, TimeoutError)
DELIBERATE = "a request is one line|requests were sent ahead"
WORDS = [
    "",
    "act",
    "0",
    "FIRE*3",
    "99",
    "RIGHT@0.5/LEFT",
    "1\n2",
    "#",
    "x" * 5000,
    "seed=7",
    "beamfall",
    3,
    None,
    "all",
    "ram",
    "screen:delta",
]
LONG = 60000  # acts after the end of a game: more replies than a connection buffers


class Servers:
    """chance: a random.Random. game, env_settings, vector_settings: functions that draw."""

    def __init__(self, chance, game, env_settings, vector_settings):
        self.chance, self._game, self._env_settings, self._vector_settings = chance, game, env_settings, vector_settings
        self._addresses = []

    def address(self):
        """Returns the address of one of two servers, which end with this process."""
        if not self._addresses:
            self._addresses = [self._started() for _ in range(2)]
        return self.chance.choice(self._addresses)

    @staticmethod
    def _started():
        folder = tempfile.mkdtemp()
        atexit.register(shutil.rmtree, folder)
        ready = pathlib.Path(folder, "ready")
        process = subprocess.Popen(
            [racebeam.program.path(), "serve", "--listen", f"unix:{folder}/s", "--ready-file", str(ready)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={name: value for name, value in os.environ.items() if name != "LD_PRELOAD"},
        )
        atexit.register(process.kill)
        while not ready.exists():
            time.sleep(0.01)
        return f"unix:{folder}/s"

    def makers(self):
        """What is made, by name."""
        return {
            "a session": lambda: racebeam.connect(self.address(), timeout=LATE, arrays=self.chance.random() < 0.5),
            "AtariEnv on a server": lambda: racebeam.AtariEnv(
                self._game(), server=self.address(), timeout=LATE, **self._env_settings()
            ),
            "AtariVectorEnv on a server": lambda: self._many(self.address()),
            "AtariVectorEnv on servers": lambda: self._many([self.address(), self.address()]),
        }

    def _many(self, server):
        return racebeam.AtariVectorEnv(self._game(), **{**self._vector_settings(), "server": server, "timeout": LATE})

    def checks(self):
        """What is tried as a whole."""
        return [self.after_an_interrupt, self.in_a_child, self.past_the_end, lambda: asyncio.run(self.at_once())]

    # Sessions

    def ask(self, session):
        """Some call. `receive` without a request would wait for ever."""
        word = self.chance.choice
        calls = [
            lambda: session.load("beamfall", seed=1),
            lambda: session.act(word(WORDS)),
            lambda: session.look(str(word(WORDS))),
            lambda: session.observe("reward", "screen:delta"),
            lambda: session.request(word(WORDS), word(WORDS)),
            lambda: session.send("act", word(WORDS)),
            session.flush,
            lambda: session.help(str(word(WORDS))),
            session.states,
            lambda: session.save("here"),
            lambda: session.restore("here"),
            lambda: session.open(2),
            lambda: session.step(1),
        ]
        if session._unanswered:
            calls = [*calls, *[session.receive, session.receive_values, session._await_plain] * 4]
        word([*calls, session.close_connection] if self.chance.random() < 0.05 else calls)()

    async def at_once(self):
        """Requests of asyncio, some of them cancelled, get their own replies."""
        async with await aio.connect(self.address(), timeout=LATE) as session:
            await session.request("load", "beamfall", seed=1)
            tasks = [asyncio.ensure_future(session.request("peek", index, 1)) for index in range(30)]
            await asyncio.sleep(0)
            for task in self.chance.sample(tasks, 10):
                task.cancel()
            for index, reply in enumerate(await asyncio.gather(*tasks, return_exceptions=True)):
                if not isinstance(reply, BaseException):
                    assert reply[0]["index"] == index, f"request {index} got the reply {reply}"

    # Environments

    def _pair(self):
        """The same environment on a server and here, and an action."""
        kind = self.chance.randrange(3)
        if kind == 0:
            return (*(racebeam.AtariEnv("beamfall", server=where) for where in (self.address(), None)), 1)
        server = self.address() if kind == 1 else [self.address(), self.address()]
        return (
            *(racebeam.AtariVectorEnv("beamfall", 2, server=where, obs_type="ram") for where in (server, None)),
            [1, 1],
        )

    def after_an_interrupt(self):
        """The next answer is right, or the sessions have ended."""
        there, here, action = self._pair()
        for env in (there, here):
            env.reset(seed=1)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        try:
            signal.setitimer(signal.ITIMER_REAL, self.chance.uniform(0.0002, 0.004))
            while True:
                there.step(action)
        except KeyboardInterrupt:
            pass
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        try:
            self._compare(there.reset(seed=5), here.reset(seed=5))
        except ConnectionError as error:
            assert "interrupted" in str(error), error

    def past_the_end(self):
        """A step that is much longer than its game."""
        there, here = (
            racebeam.AtariEnv("beamfall", server=where, frameskip=LONG, max_num_frames_per_episode=10)
            for where in (self.address(), None)
        )
        for env in (there, here):
            env.reset(seed=1)
        self._compare(there.step(1), here.step(1))

    def in_a_child(self):
        """It is refused there, and goes on here."""
        there, here, action = self._pair()
        for env in (there, here):
            env.reset(seed=1)
        child = os.fork()
        if child == 0:
            try:
                there.step(action)
            except RuntimeError as error:
                os._exit(7 if "forked" in str(error) else 8)
            os._exit(9)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        assert status == 7, f"a child process ends with {status}"
        self._compare(there.step(action), here.step(action))

    @staticmethod
    def _compare(shown, expected):
        assert np.array_equal(shown[0], expected[0]), "the observations differ"
        frames = [result[-1]["frame_number"] for result in (shown, expected)]
        assert np.array_equal(*frames), f"the frames differ: {frames}"
