"""Recordings on a disk that hangs: the server still plays, and ends."""

import re
import select
import time

import pytest
from harness import Server, ask, built, connect_unix, sanitized, thread_sanitized

SLACK = 2  # seconds, for a busy machine


@pytest.mark.skipif(sanitized() or thread_sanitized(), reason="a sanitizer wants to be loaded first")
class TestHangingDisk:
    """fsync never returns."""

    def serve(self, *options):
        hanging_disk = built("server/libhanging_disk.so")
        assert hanging_disk  # else the loader ignores it
        return Server(
            "serve",
            "--threads",
            "1",
            "--listen",
            "unix:s",
            "--record-dir",
            ".",
            "--grace",
            "1",
            *options,
            LD_PRELOAD=hanging_disk,
        )

    def begin(self, server, kind):
        wire = connect_unix(server.path("s"))
        for line in (b"load beamfall sticky=0 max_episode_frames=0", b"record %s film" % kind, b"act FIRE*40"):
            assert ask(wire, line).startswith(b"ok ")
        return wire

    def check_others_play(self, server):
        other = connect_unix(server.path("s"))
        for line in [b"load beamfall"] + [b"act NOOP"] * 20:
            assert ask(other, line).startswith(b"ok ")
        other.close()

    def check_it_ends(self, server):
        start = time.monotonic()
        assert server.stop() == 0
        assert time.monotonic() - start < 1 + 1 + SLACK

    def test_a_client_leaves(self):
        with self.serve() as server:
            server.wait_for("listening")
            for kind in (b"gif", b"png"):  # as many as there are threads that write
                self.begin(server, kind).close()
            waiting = connect_unix(server.path("s"))
            waiting.send(b"load beamfall\nrecord wav one-more\n")
            assert waiting.line().startswith(b"ok ")
            self.check_others_play(server)
            self.check_it_ends(server)
            waiting.close()

    def test_a_session_stops_its_recording(self):
        with self.serve() as server:
            server.wait_for("listening")
            wire = self.begin(server, b"gif")
            wire.send(b"record stop\n")
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()

    def test_a_recording_reaches_its_limit(self):
        with self.serve("--record-limit", "1000000") as server:
            server.wait_for("listening")
            wire = self.begin(server, b"y4m")
            for _ in range(10):
                assert ask(wire, b"act FIRE*40").startswith(b"ok ")
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()

    def test_what_is_not_written_yet_counts_when_its_client_has_left(self):
        with self.serve("--max-memory", "64M") as server:
            server.wait_for("listening")
            stays = connect_unix(server.path("s"))
            ask(stays, b"load beamfall")
            for number in range(60):
                wire = connect_unix(server.path("s"))
                reply = ask(wire, b"load beamfall")
                wire.send(b"record y4m,wav film%d\n" % number)
                if reply.startswith(b"ok ") and select.select([wire], [], [], 0.2)[0]:  # not once both threads hang
                    reply = wire.line()
                if reply.startswith(b"error "):
                    break
                wire.close()
            assert number in range(4, 59)
            assert re.search(b"^error limit a recording would take about ", ask(stays, b"record y4m,wav mine"))
            for wire_to_close in (stays, wire):
                wire_to_close.close()
            self.check_it_ends(server)

    def test_a_session_stays(self):
        with self.serve() as server:
            server.wait_for("listening")
            wire = self.begin(server, b"gif")
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()
