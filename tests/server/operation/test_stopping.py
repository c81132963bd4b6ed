"""The end of a server: what it finishes, and what it tells its clients."""

import os
import signal
import time

import pytest
from harness import (
    LISTEN,
    Server,
    Wire,
    ask,
    connect_nearby,
    connect_tcp,
    serve,
)
from long_request import LONG, load


class TestStopping:
    def test_requests_under_way_are_finished(self):
        with serve("--grace", "60") as server:
            wire = connect_tcp(server.port())
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop: 1 sessions have 60 seconds")
            with pytest.raises(OSError):
                connect_tcp(server.port())
            assert wire.line().count(b" |") == 100
            assert ask(wire, b"act NOOP") == b"ok frame=1\n"
            wire.close()
            assert server.wait() == 0

    def test_sessions_that_stay_get_an_error_when_the_grace_is_over(self):
        with serve("--grace", "2") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            start = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            assert ask(wire, b"hello").startswith(b"ok ")
            assert wire.rest() == b"error stopping the server stops\n"
            wire.close()
            assert server.wait() == 0
            assert time.monotonic() - start > 1.9

    def test_a_session_in_the_middle_of_a_request_gets_an_error_too(self):
        with serve("--grace", "0", "--max-request-frames", "10000000") as server:
            wire = connect_tcp(server.port())
            load(wire, b"branch root " + b"NOOP*1000 " * 5000 + b"\n")
            server.process.send_signal(signal.SIGTERM)
            assert wire.rest() == b"error stopping the server stops\n"
            wire.close()
            assert server.wait() == 0

    def test_a_session_on_streams_in_the_middle_of_a_request_gets_an_error_too(self):
        with Server("serve", "--stdio", "--grace", "0", "--max-request-frames", "1000000000", streams=True) as server:
            wire = Wire(server.process.stdout.fileno(), server.process.stdin.fileno())
            load(
                wire, b"branch root " + b"NOOP*20000 " * 300 + b"\n"
            )  # short enough to be read with what comes before it
            server.process.send_signal(signal.SIGTERM)
            assert wire.rest() == b"error stopping the server stops\n"
            assert server.wait() == 0

    def test_a_second_signal_ends_the_grace(self):
        with serve("--grace", "1000") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            server.process.send_signal(signal.SIGINT)
            server.wait_for("told to stop")
            assert server.stop(signal.SIGINT) == 0
            wire.close()

    def test_a_session_on_streams_finishes_its_request(self):
        with Server("serve", "--stdio", "--grace", "60", streams=True) as server:
            wire = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            assert wire.line().count(b" |") == 100
            assert server.wait() == 0
            wire.close()

    @pytest.mark.parametrize("where", (("--stdio",), LISTEN))
    def test_a_recording_is_kept(self, where):
        with Server("serve", *where, "--record-dir", ".", "--grace", "0", streams=True) as server:
            wire = (
                Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
                if where != LISTEN
                else connect_nearby(server)
            )
            wire.send(b"load beamfall\nrecord y4m film\nact NOOP*10\n")
            for _ in range(3):
                wire.line()
            assert server.stop() == 0
            assert os.path.getsize(server.path("film.y4m")) > 320 * 210 * 10
            wire.close()
