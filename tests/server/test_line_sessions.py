"""The line protocol over the wire: slow, vanishing or demanding clients do not affect others."""

import os
import resource
import socket
import statistics
import subprocess
import threading
import time

import pytest
from harness import (
    GAME,
    LISTEN,
    LOAD,
    PATIENCE,
    STREAMS,
    WINDOWS,
    Server,
    Session,
    Wire,
    ask,
    connect_nearby,
    connect_tcp,
    run,
    sanitized,
)

LONG = b"branch root " + b"NOOP*400,FIRE*600 " * 800 + b"\n"  # about 800,000 frames: seconds


def serve(*options):
    return Server("serve", *LISTEN, *options)


def lines(wire, count):
    return [wire.line() for _ in range(count)]


class TestStrict:
    """--strict: the first error is the last reply, and the program ends with status 1."""

    @pytest.mark.parametrize(
        "requests, replies",
        (
            (b"load beamfall\nact 99\nact FIRE\nquit\n", [b"ok", b"error"]),
            (b"load beamfall\nact FIRE\nhello", [b"ok", b"ok", b"error"]),
            (b"x" * 5000 + b"\nhello\n", [b"error"]),
            (b"load beamfall\nsave a\nbranch a FIRE,99\nhello\n", [b"ok", b"ok", b"error"]),
        ),
    )
    @pytest.mark.parametrize("ahead", (True, False))
    @pytest.mark.parametrize("transport", STREAMS)
    def test_nothing_is_carried_out_after_the_first_error(self, requests, replies, ahead, transport):
        with Session(transport, "--strict", "--max-line", "4096", image=None) as session:
            if ahead:
                session.wire.send(requests)
                session.wire.stop_sending()
                answers = session.wire.rest().splitlines()
            else:  # the input stays open
                answers = []
                for request in requests.splitlines(True)[: len(replies)]:
                    session.wire.send(request)
                    if request.endswith(b"\n"):
                        answers.append(session.wire.line())
                if len(answers) < len(replies):
                    session.wire.stop_sending()
                answers += session.wire.rest().splitlines()
            assert [line.split()[0] for line in answers] == replies
            assert session.status() == 1

    def test_without_an_error_all_is_as_ever(self):
        requests = b"load beamfall seed=1\nact FIRE*9\nlook frame\nquit\n"
        plain, strict = (run("serve", "--stdio", *options, data=requests)[:2] for options in ((), ("--strict",)))
        assert plain == strict
        assert strict[0] == 0
        assert run("serve", "--stdio", data=b"nonsense\n")[0] == 0

    def test_it_is_refused_where_one_error_would_end_the_sessions_of_others(self):
        for words in (
            ("--listen", "tcp://127.0.0.1:0"),
            ("--stdio", "--listen", "tcp://127.0.0.1:0"),
            ("--classic", "--stdio", "--rom", GAME),
        ):
            status, output, errors = run("serve", "--strict", *words)
            assert (status, output, len(errors)) == (2, b"", 1), errors
            assert "--strict: requires --stdio or --pipes, and the line protocol" in errors[0]


@pytest.mark.needs_posix
class TestPieces:
    """A client that writes a request in pieces, and lets its system delay the second until the first is
    acknowledged. By default, the server's system acknowledges after 40 ms."""

    # Seconds: well below the 40 ms that each step would take. The median is that of most steps, though the machine is
    # busy.
    MOST = 0.03

    def median_step(self, connection, reader, request, count=100):
        """How long a step takes whose request is sent in these pieces, in seconds."""
        times = []
        for _ in range(count):
            start = time.monotonic()
            for piece in request:
                connection.sendall(piece)
            assert reader.readline().endswith(b"\n")
            times.append(time.monotonic() - start)
        return statistics.median(times)

    @pytest.mark.parametrize("pieces", ((b"act ", b"NOOP\n"), (b"a", b"c", b"t NOOP", b"\n")))
    def test_pieces_are_acknowledged_at_once(self, pieces):
        with (
            serve() as server,
            socket.create_connection(("127.0.0.1", server.port()), PATIENCE) as connection,
            connection.makefile("rb") as reader,
        ):
            connection.sendall(b"load beamfall\n")
            reader.readline()
            assert self.median_step(connection, reader, pieces) < self.MOST

    def test_so_they_are_in_the_classic_protocol(self):
        with Server("serve", "--classic", "--listen", "tcp://127.0.0.1:0", "--rom", GAME) as server:
            with socket.create_connection(("127.0.0.1", server.port()), PATIENCE) as connection:
                with connection.makefile("rb") as reader:
                    reader.readline()
                    connection.sendall(b"0,0,0,1\n")
                    reader.readline()
                    assert self.median_step(connection, reader, (b"3,", b"18", b"\n")) < self.MOST


class TestNetcat:
    """OpenBSD's netcat closes its sending end only with -N."""

    def converse(self, requests, *words):
        done = subprocess.run(["nc", *words], input=requests, capture_output=True, timeout=PATIENCE)
        assert done.returncode == 0, done
        return done.stdout

    def test_a_conversation_ends_with_its_input_or_with_quit(self, subtests):
        usage = subprocess.run("nc -h", shell=True, capture_output=True).stderr
        if b"OpenBSD" not in usage:
            pytest.skip("needs OpenBSD's netcat")
        requests = b"load beamfall seed=1\nact FIRE*9\nlook screen:hex\n"
        expected = run("serve", "--stdio", data=requests)[1]
        with serve() as server:
            tcp, unix = ("127.0.0.1", str(server.port())), ("-U", server.path("s"))
            connect_nearby(server).close()
            for where in (tcp,) if WINDOWS else (tcp, unix):
                with subtests.test(where=where[0]):
                    assert self.converse(requests, "-N", *where) == expected
                    assert self.converse(requests + b"quit\n", *where) == expected + b"ok\n"


class TestSrun:
    def test_a_server_in_a_step_of_a_job_warns_of_slow_streams(self, subtests):
        warning = "if srun forwards standard output"
        for environment, warns in (({"SLURM_STEP_ID": "0"}, True), ({}, False)):
            with subtests.test(environment), Server("serve", "--stdio", streams=True, **environment) as server:
                wire = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
                if warns:
                    server.wait_for(warning)
                ask(wire, b"quit")
                server.wait()
                assert (warning in "\n".join(server.log())) == warns
                wire.close()


class TestSessions:
    def test_each_client_has_its_own_session(self):
        with serve() as server:
            one, other = connect_tcp(server.port()), connect_nearby(server)
            one.send(LOAD + b"act NOOP*5\n")
            other.send(b"act NOOP\n" + LOAD + b"act NOOP\n")
            assert lines(one, 4)[3] == b"ok frame=5\n"
            replies = lines(other, 5)
            assert replies[0].startswith(b"error no-game ")
            assert replies[4] == b"ok frame=1\n"
            for wire in (one, other):
                wire.close()

    def test_a_long_request_leaves_room_for_other_sessions(self):
        with serve() as server:
            port = server.port()
            busy = [connect_tcp(port) for _ in range(os.cpu_count() * 2)]
            for wire in busy:
                wire.send(LOAD + LONG)
                lines(wire, 3)
            quick = connect_tcp(port)
            quick.send(LOAD)
            lines(quick, 3)
            worst = 0
            for _ in range(20):
                start = time.monotonic()
                quick.send(b"act NOOP\n")
                quick.line()
                worst = max(worst, time.monotonic() - start)
            assert worst < 2
            for wire in (quick, *busy):
                wire.close()

    @pytest.mark.needs_posix
    def test_a_request_ends_when_its_client_has_gone(self):
        with serve() as server:
            wire = connect_nearby(server)
            wire.send(LOAD + LONG)
            lines(wire, 3)
            wire.close()
            server.wait_for("left in the middle of a request")

    def test_a_client_that_only_stops_sending_still_gets_its_replies(self):
        with serve() as server:
            wire = connect_tcp(server.port())
            wire.send(LOAD + b"branch root NOOP*50000\nact NOOP\n")
            wire.stop_sending()
            replies = wire.rest().splitlines()
            assert len(replies) == 5
            assert replies[4] == b"ok frame=1"
            wire.close()

    def test_who_does_not_read_holds_up_nobody(self):
        with serve() as server:
            deaf, other = connect_tcp(server.port()), connect_tcp(server.port())
            deaf.send(LOAD + b"observe screen:hex\n" + b"look\n" * 2000)  # 134 MB of replies
            other.send(LOAD)
            lines(other, 3)
            for _ in range(50):
                other.send(b"act NOOP\n")
                other.line()
            with open(f"/proc/{server.process.pid}/status") as status:
                resident = next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
            if not sanitized() and not WINDOWS:  # most of it is the sanitizer's, or the process is Wine's
                assert resident < 100_000  # KiB
            count = 0
            while count < 2004:
                count += deaf.read(1 << 20).count(b"\n")
            for wire in (deaf, other):
                wire.close()

    def test_a_client_killed_in_mid_line_is_forgotten(self):
        with serve() as server:
            port = server.port()
            for _ in range(50):
                wire = connect_tcp(port)
                wire.send(b"load beamf")
                wire.close()
            wire = connect_tcp(port)
            wire.send(b"hello\n")
            assert wire.line().startswith(b"ok server=racebeam/")
            wire.close()

    def test_many_machines_of_many_sessions(self):
        with serve() as server:
            port, answers = server.port(), [None] * 4

            def play(number):
                wire = connect_tcp(port)
                wire.send(LOAD + b"open 8\n" + b"step FIRE\n" * 50)
                answers[number] = lines(wire, 54)[-1]
                wire.close()

            threads = [threading.Thread(target=play, args=(number,)) for number in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert answers == [b"ok machines=8" + b" | frame=50" * 8 + b"\n"] * 4

    def test_a_line_without_end_takes_no_memory(self):
        with Session("stdio", image=None) as session:
            for _ in range(64):
                session.wire.send(b"x" * (1 << 20))
            session.wire.send(b"\nhelp act\n")
            session.wire.stop_sending()
            replies = session.wire.rest().splitlines()
            assert [line.split()[:2] for line in replies] == [[b"error", b"line-too-long"], [b"ok", b"act"]]
            assert session.status() == 0
        assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss < 300_000

    def test_an_image_given_on_the_command_line_can_be_loaded(self):
        with Session("stdio", "--rom", GAME, image=None) as session:
            session.wire.send(b"games\n")
            assert session.wire.line() == b"ok count=2 games=beamfall,updraft\n"
