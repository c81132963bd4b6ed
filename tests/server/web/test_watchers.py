"""Watchers that behave badly, or that are many: neither the session that they watch nor the others notice.

On a busy machine some acts take long, whoever watches. An act that waits for watchers would take long each time: the
tests compare the fastest tenth.
"""

import contextlib
import multiprocessing
import re
import resource
import selectors
import threading
import time

import pytest
from harness import PATIENCE, Server, ask, connect_tcp
from web_socket import TEXT, WebSocket, frame

REQUEST = b"watch room screen:raw"
LONGEST = 3  # seconds of an act on a busy machine


def number(reply, key):
    return int(re.search(rf" {key}=(\d+)".encode(), reply)[1])


class Agent:
    """Plays in a shared session, in a thread, until it is told to stop."""

    def __init__(self, port):
        self.wire = connect_tcp(port)
        ask(self.wire, b"load beamfall seed=1 sticky=0 autoreset=1")
        ask(self.wire, b"share room")
        self.acts, self.times, self.stops = 0, [], threading.Event()
        self.thread = threading.Thread(target=self.play)
        self.thread.start()

    def play(self):
        while not self.stops.is_set():
            begin = time.monotonic()
            ask(self.wire, b"act FIRE")
            self.times.append(time.monotonic() - begin)
            self.acts += 1
            time.sleep(0.002)  # the pace of a player

    def measure(self, seconds):
        """How long acts take from now on, in seconds: that which nine of ten exceed, and the slowest."""
        self.times = []
        time.sleep(seconds)  # play() measures meanwhile
        times = sorted(self.times)
        return times[len(times) // 10], times[-1]

    def go_on(self):
        """Waits for some acts."""
        goal, end = self.acts + 3, time.monotonic() + PATIENCE
        while self.acts < goal and time.monotonic() < end:
            time.sleep(0.001)

    def stop(self):
        self.stops.set()
        self.thread.join()
        self.wire.close()


def ask_ahead(port, count, ahead, seconds, is_ready, total):
    """Watchers that each have about `ahead` requests in flight. `is_ready`: an event; `total`: receives the sum of
    pictures."""
    watchers = [WebSocket(port) for _ in range(count)]
    received = dict.fromkeys((watcher.connection for watcher in watchers), 0)
    with selectors.DefaultSelector() as selector, contextlib.ExitStack() as closed:
        for watcher in watchers:
            closed.callback(watcher.close)
            watcher.connection.setblocking(False)
            watcher.write(frame(TEXT, REQUEST) * ahead)
            selector.register(watcher.connection, selectors.EVENT_READ)
        is_ready.set()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for key, _ in selector.select(0.1):
                connection = key.fileobj
                pictures, received[connection] = divmod(received[connection] + len(connection.recv(1 << 18)), 160 * 210)
                total.value += pictures
                with contextlib.suppress(BlockingIOError):
                    connection.send(frame(TEXT, REQUEST) * pictures)


@pytest.fixture(scope="module", autouse=True)
def many_files():
    """The server inherits how many files it may open."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (4096, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


@pytest.mark.usefixtures("self_cleanup")
class TestWatchers:
    def serve(self, *options):
        server = Server(
            "serve", "--listen", "tcp://127.0.0.1:0", "--listen", "ws://127.0.0.1:0", "--grace", "0", *options
        )
        self.cleanup(server.__exit__)
        self.process = server.process.pid
        self.port = int(server.wait_for(r"listening on ws://127\.0\.0\.1:(\d+)$")[1])
        agent = Agent(server.port())
        self.cleanup(agent.stop)
        return agent

    def check_not_held_up(self, agent, alone):
        """Plays for a second. `alone`: how long an act takes that nobody watches."""
        usual, slowest = agent.measure(1)
        assert usual < 2 * alone + 0.002
        assert slowest < LONGEST

    def watcher(self):
        wire = WebSocket(self.port)
        self.cleanup(wire.close)
        return wire

    def memory(self):
        with open(f"/proc/{self.process}/status") as status:
            return int(re.search(r"VmRSS:\s*(\d+)", status.read())[1]) << 10

    def watch(self, wire):
        """The frame of the newest picture."""
        reply = wire.ask(REQUEST)
        assert len(wire.message()[1]) == 160 * 210
        return number(reply, "frame")

    def test_a_tab_that_sleeps_holds_up_nothing_and_goes_on_when_it_wakes(self):
        agent, sleeper, other = self.serve(), self.watcher(), self.watcher()
        self.watch(other)
        alone, _ = agent.measure(1)
        sleeper.send(b"hello")
        sleeper.line()
        before = self.memory()
        for _ in range(1000):  # 33 MB of pictures
            sleeper.send(REQUEST)
        screens = [self.watch(other)]
        for _ in range(5):
            self.check_not_held_up(agent, alone)
            screens.append(self.watch(other))
        assert screens == sorted(set(screens))
        assert self.memory() - before < 8 << 20
        agent.go_on()
        frames = []
        for _ in range(1000):
            frames.append(number(sleeper.line(), "frame"))
            assert len(sleeper.message()[1]) == 160 * 210
        assert frames == sorted(frames)
        assert frames[-1] > screens[-1]  # the last is new, not from before the sleep

    def test_a_tab_that_sleeps_too_long_is_closed(self):
        agent = self.serve("--idle", "1")
        ask_again = self.watcher()
        assert ask_again.ask(b"hello").startswith(b"ok ")
        sleeper = self.watcher()
        for _ in range(1000):
            sleeper.send(REQUEST)
        end = time.monotonic() + PATIENCE
        _, slowest = agent.measure(2.5)
        assert slowest < LONGEST
        with contextlib.suppress(OSError, TypeError):
            while sleeper.message() is not None:
                assert time.monotonic() < end

    def test_a_thousand_watchers_of_one_session(self):
        agent = self.serve("--max-sessions", "1100")
        alone, _ = agent.measure(1)
        before = self.memory()
        crowd = [self.watcher() for _ in range(1000)]
        seen, rounds = set(), 0
        while rounds < 3 or len(seen) <= rounds:  # until the agent acts among the replies of a round
            assert rounds < 12, "no round has two pictures"
            rounds += 1
            agent.times = []
            for wire in crowd:
                wire.send(b"watch room screen:delta")
            for wire in crowd:
                reply = wire.line()
                assert reply.startswith(b"ok game=beamfall "), reply[:80]
                seen.add(number(reply, "frame"))
            assert max(agent.times, default=0) < LONGEST
        refusal = self.watcher().ask(b"watch room")
        assert refusal.startswith(b"error limit "), refusal
        grown = (self.memory() - before) / 1000
        assert grown < 150 << 10
        self.check_not_held_up(agent, alone)  # those that do not ask cost nothing

    def acts_for_each_picture(self, agent, watchers, seconds):
        """How many acts the agent gets in the time in which each of many watchers that ask ahead gets a picture."""
        is_ready, total = multiprocessing.Event(), multiprocessing.Value("q")
        crowd = multiprocessing.Process(
            target=ask_ahead, args=(self.port, watchers, 30, seconds, is_ready, total), daemon=True
        )
        crowd.start()
        assert is_ready.wait(PATIENCE)
        before = agent.acts
        crowd.join()
        assert crowd.exitcode == 0
        return (agent.acts - before) * watchers / total.value

    def test_watchers_that_always_have_a_request_in_flight(self):
        agent = self.serve("--threads", "1")
        shares = []
        while max(shares, default=0) < 0.2:  # usually about 1, and 0.05 where the agent waits for all that they sent
            assert len(shares) < 5, shares
            shares.append(self.acts_for_each_picture(agent, 200, 2))
