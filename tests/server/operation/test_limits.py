"""Limits of a server and of its sessions."""

import os
import tempfile
import time

import pytest
from harness import (
    GAME,
    LOAD,
    Server,
    Wire,
    ask,
    connect_tcp,
    connect_unix,
    run,
    serve,
)
from long_request import FRAMES, load


class TestLimits:
    def test_a_session_too_many_gets_an_error(self):
        with serve("--max-sessions", "2") as server:
            wires = [connect_tcp(server.port()) for _ in range(2)]
            for wire in wires:
                assert ask(wire, b"hello").startswith(b"ok ")
            connection = connect_tcp(server.port())
            assert connection.rest().startswith(b"error busy there are 2 sessions")
            wires.pop().close()
            server.wait_for("1 requests")
            wires.append(connect_tcp(server.port()))
            assert ask(wires[-1], b"hello").startswith(b"ok ")
            for wire in (connection, *wires):
                wire.close()

    def test_who_would_not_understand_it_is_turned_away_without_a_word(self):
        with Server("serve", "--listen", "classic+tcp://127.0.0.1:0", "--rom", GAME, "--max-sessions", "1") as server:
            wires = [connect_tcp(server.port()) for _ in range(2)]
            assert wires[0].line() == b"160-210\n"
            assert wires[1].rest() == b""
            for wire in wires:
                wire.close()

    def test_a_long_request_is_not_idle(self):
        idle = 1
        with serve("--idle", str(idle), "--max-request-frames", "1000000000") as server:
            wire = connect_tcp(server.port())
            load(wire)
            sequences, took = 5, 0
            while took < 1.5 * idle:  # longer and longer requests, for any speed of the machine
                sequences *= 2
                start = time.monotonic()
                reply = ask(wire, b"branch root " + b"NOOP*%d " % FRAMES * sequences)
                took = time.monotonic() - start
                assert reply.count(b" |") == sequences
            assert wire.rest() == b"error idle nothing came or went for 1 seconds\n"
            wire.close()

    def test_an_idle_session_gets_an_error_and_is_closed(self):
        with serve("--idle", "2") as server:
            busy, idle, stuck = (connect_tcp(server.port()) for _ in range(3))
            stuck.send(LOAD + b"observe rgb:hex\n" + b"look\n" * 200)  # never read
            for _ in range(14):
                assert ask(busy, b"hello").startswith(b"ok ")
                time.sleep(0.25)  # far less than the two seconds, though the machine is busy
            assert idle.rest().startswith(b"error idle nothing came or went for 2 seconds")
            server.wait_for("closed, it did not read")
            for wire in (busy, idle, stuck):
                wire.close()

    def test_each_limit_of_a_session_can_be_set_and_is_reported(self):
        limits = {
            "--max-line": 300,
            "--max-machines": 2,
            "--max-states": 1,
            "--max-request-frames": 50,
            "--max-reply": 2000000,
        }
        words = [word for name, value in limits.items() for word in (name, str(value))]
        requests = (
            b"hello\nload beamfall sticky=0\nopen 3\nsave a\nsave b\nact NOOP*51\nact NOOP*50\n"
            + b"act "
            + b"x" * 300
            + b"\n"
        )
        lines = run("serve", "--stdio", *words, data=requests)[1].splitlines()
        assert b"max_line=300 max_machines=2 max_states=1 max_request_frames=50 max_reply=2000000" in lines[0]
        codes = [line.split()[1] if line.startswith(b"error") else b"ok" for line in lines]
        assert codes == [b"ok", b"ok", b"limit", b"ok", b"limit", b"limit", b"ok", b"line-too-long"]

    @pytest.mark.needs_posix
    def test_nothing_that_is_there_is_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            os.symlink("/nowhere/file", os.path.join(folder, "link.gif"))
            lines = run("serve", "--stdio", "--record-dir", folder, data=b"load beamfall\nrecord gif link\n")[
                1
            ].splitlines()
            assert b"error recording link.gif exists" in lines[1]

    def test_names_do_not_lead_out_of_the_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            inside = os.path.join(folder, "inside")
            os.mkdir(inside)
            for name in ("../out", "/etc/passwd", "..", ".", "a/b", "", ".hidden"):
                requests = f"load beamfall\nrecord y4m {name}\nload {name or '/'}\nload ../{name}\n".encode()
                lines = run("serve", "--stdio", "--record-dir", inside, "--roms", inside, data=requests)[1].splitlines()
                assert all(line.startswith(b"error ") for line in lines[1:]), lines[1:]
            assert (os.listdir(folder), os.listdir(inside)) == (["inside"], [])


class TestTogether:
    @pytest.mark.needs_posix
    def test_both_protocols_on_streams_and_sockets(self):
        with Server(
            "serve",
            "--stdio",
            "--listen",
            "unix:line",
            "--listen",
            "classic+unix:classic",
            "--rom",
            GAME,
            "--pipes",
            "p",
            "--ready-file",
            "ready",
            streams=True,
        ) as server:
            server.wait_for("listening on unix:classic")
            assert server.addresses("ready") == ["unix:line", "classic+unix:classic", "stdio", "pipes:p"]
            line, classic = connect_unix(server.path("line")), connect_unix(server.path("classic"))
            assert classic.line() == b"160-210\n"
            assert ask(line, b"hello").startswith(b"ok server=")
            streams = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            server.process.stdin.close()
            assert ask(streams, b"hello").startswith(b"ok server=")
            streams.stop_sending()
            server.process.stdout.close()
            assert ask(line, b"hello").startswith(b"ok server=")  # the server outlives its streams
            for wire in (line, classic):
                wire.close()
            assert server.stop() == 0
            assert not os.path.exists(server.path("ready"))
            streams.close()


class TestUntilIdle:
    def test_a_server_without_sessions_ends(self):
        with serve("--until-idle", "1", "--ready-file", "ready") as server:
            assert server.wait() == 0
            server.wait_for("no session for 1 seconds: 0 sessions have 5 seconds to end")
            assert not os.path.exists(server.path("ready"))

    @pytest.mark.needs_posix
    def test_a_session_on_streams_keeps_it_alive(self):
        with Server("serve", "--stdio", "--listen", "unix:s", "--until-idle", "1", streams=True) as server:
            wire = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            server.process.stdin.close()
            assert ask(wire, b"hello").startswith(b"ok ")
            time.sleep(2)  # the subject: longer than the second
            assert ask(wire, b"hello").startswith(b"ok ")
            wire.close()
            assert server.wait() == 0
            server.wait_for("no session for 1 seconds: ")

    def test_a_session_keeps_it_alive_and_a_short_one_begins_the_time_anew(self):
        with serve("--until-idle", "2") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            time.sleep(3)  # the subject: longer than the two seconds
            assert ask(wire, b"hello").startswith(b"ok ")
            wire.close()
            for _ in range(3):  # each is over before the server looks
                time.sleep(1)  # the subject: half of the two seconds
                wire = connect_tcp(server.port())
                ask(wire, b"quit")
                wire.close()
            start = time.monotonic()
            assert server.wait() == 0
            assert time.monotonic() - start > 1.5
