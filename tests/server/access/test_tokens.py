"""Tokens: who may play, and how wrong tokens are slowed down."""

import contextlib
import os
import signal
import socket
import time

import pytest
from access_case import OTHER, TOKEN, Folder
from harness import LISTEN, PATIENCE, Server, Wire, ask, connect_tcp, connect_unix, run


@pytest.mark.usefixtures("self_cleanup")
class TestTokens(Folder):
    def serve(self, *options):
        tokens = self.write("tokens", f"# for the tests\n\n{TOKEN}\n")
        return Server("serve", *LISTEN, "--token-file", tokens, *options)

    def test_only_who_gives_a_token_may_play(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            for request in (b"load beamfall", b"games", b"stats", b"act NOOP", b"act", b"frob"):
                assert ask(wire, request).startswith(b"error unauthorized "), request
            assert b" admitted=0 " in ask(wire, b"hello")
            assert ask(wire, b"help load").startswith(b"ok load ")
            assert ask(wire, b"hello tocken=1").startswith(b"error bad-arguments ")
            assert b" admitted=1 " in ask(wire, b"hello token=" + TOKEN.encode())
            assert ask(wire, b"load beamfall").startswith(b"ok game=beamfall")
            wire.close()

    def test_a_long_line_needs_a_token_too(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            long = b"help " + b" " * 5000
            assert ask(wire, long).startswith(b"error line-too-long the line has more than 4096 bytes")
            wire.send(b"hello token=" + TOKEN.encode() + b"\n" + long + b"\n")
            assert wire.line().startswith(b"ok ")
            assert wire.line().startswith(b"ok commands: ")
            wire.close()

    def test_the_third_wrong_token_ends_the_session(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            for wrong in (TOKEN[:-1], TOKEN + "0", OTHER):
                assert ask(wire, b"hello token=" + wrong.encode()).startswith(b"error unauthorized ")
            assert wire.rest() == b""
            wire.close()

    def connect_from(self, server, address):
        connection = socket.create_connection(("127.0.0.1", server.port()), PATIENCE, (address, 0))
        self.cleanup(connection.close)
        return Wire(connection.fileno(), connection.fileno(), connection)

    def test_guessing_gets_slower_and_delays_nobody_else(self):
        right, wrong = b"hello token=" + TOKEN.encode(), b"hello token=" + OTHER.encode()
        with self.serve("--threads", "1", "--handshake", "4") as server:
            start = time.monotonic()
            delays = [0.1, 0.2, 0.4, 0.8, 1.6, 2, 2]  # the longest: half of --handshake
            for number in range(len(delays)):
                reply = ask(self.connect_from(server, "127.0.0.2"), wrong)
                assert reply.startswith(b"error unauthorized the token is not")
                assert time.monotonic() - start >= sum(delays[: number + 1])
            server.wait_for("client 7: a wrong token from 127.0.0.2, number 7 in a row")
            assert ask(self.connect_from(server, "127.0.0.2"), right).startswith(b"ok ")
            start = time.monotonic()
            ask(self.connect_from(server, "127.0.0.2"), wrong)
            assert time.monotonic() - start < 2  # the right token has ended the delays

    def test_forty_guessers_do_not_lock_out_the_right_token(self):
        right, wrong = b"hello token=" + TOKEN.encode(), b"hello token=" + OTHER.encode()
        with self.serve("--threads", "1") as server:
            guessers = [self.connect_from(server, "127.0.0.2") for _ in range(40)]
            for wire in guessers:
                wire.send(3 * (wrong + b"\n"))
            server.wait_for("number 40 in a row")
            waits = []
            for address in 3 * ("127.0.0.2", "127.0.0.3"):
                start = time.monotonic()
                wire = self.connect_from(server, address)
                assert ask(wire, right).startswith(b"ok ")
                assert ask(wire, b"load beamfall").startswith(b"ok ")
                waits.append(time.monotonic() - start)
            assert min(waits[::2]) < 0.1
            assert max(waits) < 5  # of which most are for slow machines: the delays are longer together

    def test_answers_to_wrong_tokens_that_are_sent_ahead_are_delayed_one_by_one(self):
        wrong = b"hello token=" + OTHER.encode() + b"\n"
        with self.serve() as server:
            wire, start = connect_tcp(server.port()), time.monotonic()
            wire.send(3 * wrong)
            for delay in (0.1, 0.1 + 0.2, 0.1 + 0.2 + 0.4):
                assert wire.line().startswith(b"error unauthorized the token is not")
                assert time.monotonic() - start >= delay
            assert wire.rest() == b""
            wire.close()

    @pytest.mark.needs_posix
    def test_who_has_no_token_makes_room_for_others(self):
        full = b"error busy there are 3 sessions, the limit of this server; "
        with self.serve("--max-sessions", "3") as server:
            first, silent, other = (connect_tcp(server.port()) for _ in range(3))
            for wire in (first, silent, other):
                assert b" admitted=0 " in ask(wire, b"hello")
            assert b" admitted=1 " in ask(first, b"hello token=" + TOKEN.encode())
            server.wait_for("listening on unix:s")
            local = connect_unix(server.path("s"))  # needs none
            assert ask(local, b"load beamfall").startswith(b"ok ")
            assert silent.rest() == full + b"those without a token go first\n"
            late = connect_tcp(server.port())
            assert b" admitted=1 " in ask(late, b"hello token=" + TOKEN.encode())
            assert other.rest() == full + b"those without a token go first\n"
            connection = connect_tcp(server.port())
            assert connection.rest() == full + b"try again later\n"
            for wire in (first, local, late):
                assert ask(wire, b"stats").startswith(b"ok ")
            for wire in (first, silent, other, local, late, connection):
                wire.close()

    def test_who_has_no_token_keeps_no_server_alive(self):
        with self.serve("--until-idle", "2") as server:
            holder = connect_tcp(server.port())
            ask(holder, b"hello token=" + TOKEN.encode())
            silent = connect_tcp(server.port())
            time.sleep(3)  # the subject: longer than the two seconds
            assert b" admitted=1 " in ask(holder, b"hello")  # a session with a token does
            holder.close()
            until = time.monotonic() + PATIENCE
            while server.process.poll() is None and time.monotonic() < until:
                with contextlib.suppress(OSError):  # it no longer listens
                    wire = connect_tcp(server.port())
                    wire.send(b"hello\n")
                    wire.close()
                time.sleep(0.2)
            assert server.process.poll() == 0
            server.wait_for("no session for 2 seconds: ")
            silent.close()

    def test_who_gives_no_token_in_time_is_closed(self):
        with self.serve("--handshake", "1") as server:
            silent, admitted = connect_tcp(server.port()), connect_tcp(server.port())
            ask(admitted, b"hello token=" + TOKEN.encode())
            assert silent.rest().startswith(b"error unauthorized no token came within 1 seconds")
            assert ask(admitted, b"stats").startswith(b"ok ")
            for wire in (silent, admitted):
                wire.close()

    @pytest.mark.needs_posix
    def test_a_unix_socket_needs_no_token(self):
        with self.serve() as server:
            server.wait_for("listening on unix:s")
            wire = connect_unix(server.path("s"))
            assert ask(wire, b"load beamfall").startswith(b"ok game=beamfall")
            wire.close()

    @pytest.mark.needs_posix
    def test_a_hangup_reads_the_file_again_and_a_bad_file_keeps_the_old_tokens(self):
        def admits(server, token):
            wire = connect_tcp(server.port())
            reply = ask(wire, b"hello token=" + token.encode())
            wire.close()
            return reply.startswith(b"ok ")

        with self.serve() as server:
            assert admits(server, TOKEN) and not admits(server, OTHER)
            self.write("tokens", OTHER + "\n")
            server.process.send_signal(signal.SIGHUP)
            server.wait_for("read the token file again")
            assert admits(server, OTHER) and not admits(server, TOKEN)
            self.write("tokens", "short\n")
            server.process.send_signal(signal.SIGHUP)
            server.wait_for("line 1: a token must have 16 .*; the old token file stays in use")
            assert admits(server, OTHER)

    def test_files_without_a_good_token_are_refused(self, subtests):
        for text, hint in (
            ("", " has no token"),
            ("# none\n", " has no token"),
            ("short\n", "line 1"),
            (f"{TOKEN}\ntwo words of a token\n", "line 2"),
        ):
            with subtests.test(text=text):
                status, _, errors = run(
                    "serve", "--listen", "tcp://127.0.0.1:0", "--token-file", self.write("bad", text)
                )
                assert (status, len(errors)) == (1, 1), errors
                assert hint in errors[0]
        status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", self.path("nothing"))
        assert (status, len(errors)) == (1, 1), errors

    @pytest.mark.needs_posix
    def test_a_file_that_everyone_can_read_is_warned_of(self):
        for mode, warned in ((0o600, False), (0o644, True)):
            path = self.write("tokens", TOKEN)
            os.chmod(path, mode)
            with Server("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", path) as server:
                server.wait_for("listening on")
                assert any("every user of this machine" in line for line in server.log()) == warned
