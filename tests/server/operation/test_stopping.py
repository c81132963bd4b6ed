"""The end of a server: what it finishes, and what it tells its clients."""

import os
import signal
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from harness import (
    Server,
    Wire,
    ask,
    connect_tcp,
    connect_unix,
    main,
    serve,
)
from long_request import LONG, load


class Stopping(unittest.TestCase):
    def test_requests_under_way_are_finished(self):
        with serve("--grace", "60") as server:
            wire = connect_tcp(server.port())
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop: 1 sessions have 60 seconds")
            with self.assertRaises(OSError):
                connect_tcp(server.port())
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(ask(wire, b"act NOOP"), b"ok frame=1\n")
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_sessions_that_stay_get_an_error_when_the_grace_is_over(self):
        with serve("--grace", "2") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            start = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            wire.close()
            self.assertEqual(server.wait(), 0)
            self.assertGreater(time.monotonic() - start, 1.9)

    def test_a_session_in_the_middle_of_a_request_gets_an_error_too(self):
        with serve("--grace", "0", "--max-request-frames", "10000000") as server:
            wire = connect_tcp(server.port())
            load(wire, b"branch root " + b"NOOP*1000 " * 5000 + b"\n")
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_a_session_on_streams_in_the_middle_of_a_request_gets_an_error_too(self):
        with Server("serve", "--stdio", "--grace", "0", "--max-request-frames", "1000000000", streams=True) as server:
            wire = Wire(server.process.stdout.fileno(), server.process.stdin.fileno())
            load(
                wire, b"branch root " + b"NOOP*20000 " * 300 + b"\n"
            )  # short enough to be read with what comes before it
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            self.assertEqual(server.wait(), 0)

    def test_a_second_signal_ends_the_grace(self):
        with serve("--grace", "1000") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            server.process.send_signal(signal.SIGINT)
            server.wait_for("told to stop")
            self.assertEqual(server.stop(signal.SIGINT), 0)
            wire.close()

    def test_a_session_on_streams_finishes_its_request(self):
        with Server("serve", "--stdio", "--grace", "60", streams=True) as server:
            wire = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(server.wait(), 0)
            wire.close()

    def test_a_recording_is_kept(self):
        for transport in ("--stdio", "--listen=unix:s"):
            with (
                self.subTest(transport=transport),
                Server("serve", transport, "--record-dir", ".", "--grace", "0", streams=True) as server,
            ):
                wire = (
                    Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
                    if transport == "--stdio"
                    else server.wait_for("listening") and connect_unix(server.path("s"))
                )
                wire.send(b"load beamfall\nrecord y4m film\nact NOOP*10\n")
                for _ in range(3):
                    wire.line()
                self.assertEqual(server.stop(), 0)
                self.assertGreater(os.path.getsize(server.path("film.y4m")), 320 * 210 * 10)
                wire.close()


if __name__ == "__main__":
    main()
