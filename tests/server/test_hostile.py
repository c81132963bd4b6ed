"""Clients that request as much as they can: the server still answers other clients, and stops when it is
told to.

The thresholds leave room for slow machines. The faults that they guard against take seconds to minutes.
"""

import base64
import os
import re
import signal
import socket
import statistics
import time
import urllib.request

import pytest
from harness import PATIENCE, WINDOWS, Server, Wire, ask, connect_tcp, connect_unix, open_pipes, serve

ENDLESS = (
    b"load beamfall as=tetris seed=1 system_seed=1 sticky=0 "
    b"max_episode_frames=0"
)  # beamfall with rules that end no episode
# which beamfall never reaches
MODE = b"load beamfall as=adventure mode=1 frame_skip=1000 max_episode_frames=0"
HOUR = b"act NOOP*900000000"
JUMP_TO_ITSELF = bytes([0x4C, 0x00, 0xF0])
MANY_FRAMES = ("--max-request-frames", "1000000000")


def load_inline(program):
    """An image of 4K that begins with `program`."""
    image = program.ljust(4090, b"\0") + bytes([0x00, 0xF0]) * 3
    return b"load inline max_episode_frames=0 image=" + base64.b64encode(image)


# A client's first requests, and then its repeated ones, each of which takes long.
SKIPPING = ENDLESS + b" frame_skip=1000"
NO_OPS = ENDLESS + b" noop_max=1000"
LONG_REQUESTS = {
    "a mode that does not come about": ([], MODE),
    "acts of frames that never end": ([load_inline(JUMP_TO_ITSELF) + b" frame_skip=1000"], b"act NOOP"),
    "machines that power on": ([NO_OPS], b"open 256"),
    "machines that act": ([SKIPPING, b"open 256"], b"step NOOP"),
    "machines that begin again": ([NO_OPS, b"open 256"], b"restart"),
    "machines whose episodes end": (
        [b"load beamfall max_episode_frames=1 noop_max=1000", b"open 256 autoreset=same-step"],
        b"step NOOP",
    ),
    "a search": ([ENDLESS, b"save root"], b"branch root" + b" NOOP*90000" * 20),
}


def begin(wire, first, request):
    """The client has received its replies to `first`; some of `request` are in flight, unread."""
    for line in first:
        reply = ask(wire, line)
        assert reply.startswith(b"ok"), reply
    wire.send((request + b"\n") * 20)


def least(measure, bound):
    """A measurement below the bound, or the least of many. A busy machine delays some of them; the faults, all."""
    found = []
    while len(found) < 20 and (not found or found[-1] >= bound):
        found.append(measure())
    return min(found)


def median_wait(wire, count=9):
    """The latency of a short act, in seconds."""
    waits = []
    for _ in range(count):
        start = time.monotonic()
        reply = ask(wire, b"act NOOP")
        assert reply.startswith(b"ok"), reply
        waits.append(time.monotonic() - start)
        time.sleep(0.005)  # the pace of a player
    return statistics.median(waits)


def health_wait(server):
    address = server.wait_for(r"health and metrics on (http://127\.0\.0\.1:\d+)").group(1)
    start = time.monotonic()
    with urllib.request.urlopen(address + "/healthz", timeout=PATIENCE) as response:
        assert response.read() == b"ok\n"
    return time.monotonic() - start


@pytest.mark.usefixtures("self_cleanup")
class Case:
    """A server, and connections to it, which are closed at the end of the test."""

    def start(self, server):
        self.server = server
        self.cleanup(server.__exit__)
        return server

    def connect(self):
        wire = connect_tcp(self.server.port())
        self.cleanup(wire.close)
        return wire


class TestOneThread(Case):
    """All clients on one thread of the server."""

    @pytest.fixture(autouse=True)
    def set_up(self, self_cleanup):
        self.start(serve("--threads", "1", "--http", "127.0.0.1:0", "--grace", "0"))
        self.bystander = self.connect()
        ask(self.bystander, b"load beamfall max_episode_frames=0")

    def check_that_others_are_answered(self):
        assert least(lambda: median_wait(self.bystander), 0.1) < 0.1
        assert least(lambda: health_wait(self.server), 0.5) < 0.5

    def test_others_are_answered_beside_64_that_search(self):
        searches = b"branch root" + b" UP*50,FIRE*20" * 18
        for _ in range(64):
            begin(self.connect(), [ENDLESS, b"save root"], b"\n".join([searches] * 10))
        self.check_that_others_are_answered()


def add_long_request(name, first, request):
    def test(self):
        begin(self.connect(), first, request)
        self.server.wait_until_it_works()
        self.check_that_others_are_answered()

    setattr(TestOneThread, "test_others_are_answered_beside_" + name.replace(" ", "_").replace("-", "_"), test)


for title, (before, asked_for) in LONG_REQUESTS.items():
    add_long_request(title, before, asked_for)


class TestLimits(Case):
    def test_a_mode_that_does_not_come_about_is_given_up(self):
        self.start(serve())
        wire = self.connect()
        start = time.monotonic()
        assert re.search(
            b"^error bad-value mode 1 of adventure could not be set up on this image: ",
            ask(wire, MODE.replace(b"=1000", b"=200")),
        )
        assert time.monotonic() - start < PATIENCE
        assert re.search(b"^error no-game ", ask(wire, b"look"))

    def test_steps_count_against_the_frames_of_a_request(self):
        self.start(serve("--max-request-frames", "1000"))
        wire = self.connect()
        ask(wire, ENDLESS + b" frame_skip=100")
        for machines, answer in (
            (10, b"^ok "),
            (11, b"^error limit the request asks for 1100 frames; it may ask for 1000"),
        ):
            assert re.search(b"^ok ", ask(wire, b"open %d" % machines))
            assert re.search(answer, ask(wire, b"step NOOP"))

    def test_resets_count_against_the_frames_of_a_request(self):
        self.start(serve("--max-request-frames", "1000"))
        wire = self.connect()
        ask(wire, ENDLESS)
        before = ask(wire, b"look ram reward lives")
        assert re.search(
            b"^error limit the request would run more than 2000 frames; ", ask(wire, MODE)
        )  # 1,000 are free
        assert ask(wire, b"look ram reward lives") == before


unnoticed = pytest.mark.skipif(WINDOWS, reason="it is not noticed there (server/README.md, On Windows)")


class TestDeparture(Case):
    """A request that would take an hour."""

    def check_that_it_is_given_up(self, wire, first, request):
        begin(wire, first, request)
        self.server.wait_until_it_works()
        wire.close()
        self.server.wait_for(r"client 1: .*(left|stopped)")
        seconds = self.server.processor_seconds()
        time.sleep(0.5)  # the subject: it does nothing meanwhile
        assert self.server.processor_seconds() - seconds < 0.2

    @unnoticed
    def test_a_request_of_a_client_that_left_over_tcp_is_given_up(self):
        self.start(serve("--grace", "0", *MANY_FRAMES))
        self.check_that_it_is_given_up(self.connect(), [ENDLESS], HOUR)

    @pytest.mark.needs_posix
    def test_a_request_of_a_client_that_left_over_a_unix_socket_is_given_up(self):
        server = self.start(Server("serve", "--listen", "unix:s", "--grace", "0", *MANY_FRAMES))
        server.wait_for("listening on unix:s")
        self.check_that_it_is_given_up(connect_unix(server.path("s")), [ENDLESS], HOUR)

    @unnoticed
    def test_machines_of_a_client_that_left_are_given_up(self):
        self.start(serve("--grace", "0", *MANY_FRAMES))
        self.check_that_it_is_given_up(self.connect(), [ENDLESS + b" frame_skip=1000 noop_max=1000"], b"open 256")

    def test_a_client_that_only_stops_sending_gets_its_reply(self):
        self.start(serve("--grace", "0"))
        replies = []
        for stop_sending in (False, True):
            wire = self.connect()
            wire.send(ENDLESS + b"\nact NOOP*60000\nquit\n")
            if stop_sending:
                wire.connection.shutdown(socket.SHUT_WR)
            replies.append(wire.rest())
        assert replies[0].count(b"\nok ") == 1, replies
        assert replies[1] == replies[0]


class TestHalfClosed(Case):
    """A client closes its sending end, and reads its replies late. Nothing else comes before them."""

    REQUESTS = ENDLESS + b"\nact NOOP*%d\nlook\nquit\n"

    def replies(self, connection, requests, shut):
        connection.sendall(requests)
        shut(connection)
        time.sleep(4)  # the subject: the client is late
        replies = b""
        while piece := connection.recv(65536):
            replies += piece
        return replies

    def frames(self):
        """So many that they take more than the four seconds on this machine."""
        wire = self.connect()
        ask(wire, ENDLESS)
        start = time.monotonic()
        ask(wire, b"act NOOP*20000")
        return int(20000 * 5 / (time.monotonic() - start))

    def test_replies_over_tcp_come_alone(self):
        self.start(serve("--grace", "0", "--max-request-frames", "100000000"))
        requests = self.REQUESTS % self.frames()
        found = []
        for shut in (lambda connection: None, lambda connection: connection.shutdown(socket.SHUT_WR)):
            with socket.create_connection(("127.0.0.1", self.server.port()), timeout=PATIENCE) as connection:
                found.append(self.replies(connection, requests, shut))
        assert found[0].endswith(b"\nok\n"), found[0]
        assert found[1] == found[0]


@pytest.mark.usefixtures("self_subtests")
class TestEnd:
    """SIGTERM in the middle of a request that would take an hour, or of a mode that takes long."""

    GRACE = 1
    REQUESTS = {
        "act": ([ENDLESS], HOUR),
        "mode": ([], MODE),
        "open": ([ENDLESS + b" frame_skip=1000 noop_max=1000"], b"open 256"),
    }

    def check_that_it_ends(self, *listen, connect, streams=False):
        for name, (first, request) in self.REQUESTS.items():
            with (
                self.subtests.test(name),
                Server("serve", *listen, "--grace", str(self.GRACE), *MANY_FRAMES, streams=streams) as server,
            ):
                wire = connect(server)
                begin(wire, first, request)
                server.wait_until_it_works()
                start = time.monotonic()
                server.process.send_signal(signal.SIGTERM)
                server.wait()
                assert time.monotonic() - start < self.GRACE + 5  # of which four are for slow machines
                wire.close()

    def test_over_tcp(self):
        self.check_that_it_ends("--listen", "tcp://127.0.0.1:0", connect=lambda server: connect_tcp(server.port()))

    @pytest.mark.needs_posix
    def test_over_a_unix_socket(self):
        def connect(server):
            server.wait_for("listening on unix:s")
            return connect_unix(server.path("s"))

        self.check_that_it_ends("--listen", "unix:s", connect=connect)

    @pytest.mark.needs_posix
    def test_over_pipes(self):
        def connect(server):
            server.wait_for("for a client that opens")
            return open_pipes(server, "p")

        self.check_that_it_ends("--pipes", "p", connect=connect)

    def test_over_standard_streams(self):
        def connect(server):
            return Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))

        self.check_that_it_ends("--stdio", connect=connect, streams=True)
