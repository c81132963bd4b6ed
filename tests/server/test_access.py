"""Access: tokens, TLS, and what is refused on addresses that other machines can reach."""

import contextlib
import os
import signal
import socket
import ssl
import subprocess
import tempfile
import time
import unittest

from harness import GAME, PATIENCE, Server, Wire, ask, connect_tcp, connect_unix, main, run, sanitized

TOKEN, OTHER = "0123456789abcdef", "fedcba9876543210"


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        os.chmod(self.path(name), 0o600)
        return self.path(name)


class Tokens(Folder):
    def serve(self, *options):
        tokens = self.write("tokens", f"# for the tests\n\n{TOKEN}\n")
        return Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s", "--token-file", tokens, *options)

    def test_only_who_gives_a_token_may_play(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            for request in (b"load beamfall", b"games", b"stats", b"act NOOP", b"act", b"frob"):
                self.assertTrue(ask(wire, request).startswith(b"error unauthorized "), request)
            self.assertIn(b" admitted=0 ", ask(wire, b"hello"))
            self.assertTrue(ask(wire, b"help load").startswith(b"ok load "))
            self.assertTrue(ask(wire, b"hello tocken=1").startswith(b"error bad-arguments "))
            self.assertIn(b" admitted=1 ", ask(wire, b"hello token=" + TOKEN.encode()))
            self.assertTrue(ask(wire, b"load beamfall").startswith(b"ok game=beamfall"))
            wire.close()

    def test_a_long_line_needs_a_token_too(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            long = b"help " + b" " * 5000
            self.assertTrue(ask(wire, long).startswith(b"error line-too-long the line has more than 4096 bytes"))
            wire.send(b"hello token=" + TOKEN.encode() + b"\n" + long + b"\n")
            self.assertTrue(wire.line().startswith(b"ok "))
            self.assertTrue(wire.line().startswith(b"ok commands: "))
            wire.close()

    def test_the_third_wrong_token_ends_the_session(self):
        with self.serve() as server:
            wire = connect_tcp(server.port())
            for wrong in (TOKEN[:-1], TOKEN + "0", OTHER):
                self.assertTrue(ask(wire, b"hello token=" + wrong.encode()).startswith(b"error unauthorized "))
            self.assertEqual(wire.rest(), b"")
            wire.close()

    def connect_from(self, server, address):
        connection = socket.create_connection(("127.0.0.1", server.port()), PATIENCE, (address, 0))
        self.addCleanup(connection.close)
        return Wire(connection.fileno(), connection.fileno(), connection)

    def test_guessing_gets_slower_and_delays_nobody_else(self):
        right, wrong = b"hello token=" + TOKEN.encode(), b"hello token=" + OTHER.encode()
        with self.serve("--threads", "1", "--handshake", "4") as server:
            start = time.monotonic()
            delays = [0.1, 0.2, 0.4, 0.8, 1.6, 2, 2]  # the longest: half of --handshake
            for number in range(len(delays)):
                reply = ask(self.connect_from(server, "127.0.0.2"), wrong)
                self.assertTrue(reply.startswith(b"error unauthorized that token is not"))
                self.assertGreaterEqual(time.monotonic() - start, sum(delays[: number + 1]))
            server.wait_for("client 7: a wrong token from 127.0.0.2, number 7 in a row")
            self.assertTrue(ask(self.connect_from(server, "127.0.0.2"), right).startswith(b"ok "))
            start = time.monotonic()
            ask(self.connect_from(server, "127.0.0.2"), wrong)
            self.assertLess(time.monotonic() - start, 2)  # the right token has ended the delays

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
                self.assertTrue(ask(wire, right).startswith(b"ok "))
                self.assertTrue(ask(wire, b"load beamfall").startswith(b"ok "))
                waits.append(time.monotonic() - start)
            self.assertLess(min(waits[::2]), 0.1)
            self.assertLess(max(waits), 5)  # of which most are for slow machines: the delays are longer together

    def test_answers_to_wrong_tokens_that_are_sent_ahead_are_delayed_one_by_one(self):
        wrong = b"hello token=" + OTHER.encode() + b"\n"
        with self.serve() as server:
            wire, start = connect_tcp(server.port()), time.monotonic()
            wire.send(3 * wrong)
            for delay in (0.1, 0.1 + 0.2, 0.1 + 0.2 + 0.4):
                self.assertTrue(wire.line().startswith(b"error unauthorized that token is not"))
                self.assertGreaterEqual(time.monotonic() - start, delay)
            self.assertEqual(wire.rest(), b"")
            wire.close()

    def test_who_has_no_token_makes_room_for_others(self):
        full = b"error busy there are 3 sessions, the limit of this server; "
        with self.serve("--max-sessions", "3") as server:
            first, silent, other = (connect_tcp(server.port()) for _ in range(3))
            for wire in (first, silent, other):
                self.assertIn(b" admitted=0 ", ask(wire, b"hello"))
            self.assertIn(b" admitted=1 ", ask(first, b"hello token=" + TOKEN.encode()))
            server.wait_for("listening on unix:s")
            local = connect_unix(server.path("s"))  # needs none
            self.assertTrue(ask(local, b"load beamfall").startswith(b"ok "))
            self.assertEqual(silent.rest(), full + b"those without a token go first\n")
            late = connect_tcp(server.port())
            self.assertIn(b" admitted=1 ", ask(late, b"hello token=" + TOKEN.encode()))
            self.assertEqual(other.rest(), full + b"those without a token go first\n")
            connection = connect_tcp(server.port())
            self.assertEqual(connection.rest(), full + b"try again later\n")
            for wire in (first, local, late):
                self.assertTrue(ask(wire, b"stats").startswith(b"ok "))
            for wire in (first, silent, other, local, late, connection):
                wire.close()

    def test_who_has_no_token_keeps_no_server_alive(self):
        with self.serve("--until-idle", "2") as server:
            holder = connect_tcp(server.port())
            ask(holder, b"hello token=" + TOKEN.encode())
            silent = connect_tcp(server.port())
            time.sleep(3)
            self.assertIn(b" admitted=1 ", ask(holder, b"hello"))  # a session with a token does
            holder.close()
            until = time.monotonic() + PATIENCE
            while server.process.poll() is None and time.monotonic() < until:
                with contextlib.suppress(OSError):  # it no longer listens
                    wire = connect_tcp(server.port())
                    wire.send(b"hello\n")
                    wire.close()
                time.sleep(0.2)
            self.assertEqual(server.process.poll(), 0)
            server.wait_for("no session for 2 seconds: ")
            silent.close()

    def test_who_gives_no_token_in_time_is_closed(self):
        with self.serve("--handshake", "1") as server:
            silent, admitted = connect_tcp(server.port()), connect_tcp(server.port())
            ask(admitted, b"hello token=" + TOKEN.encode())
            self.assertTrue(silent.rest().startswith(b"error unauthorized no token came within 1 seconds"))
            self.assertTrue(ask(admitted, b"stats").startswith(b"ok "))
            for wire in (silent, admitted):
                wire.close()

    def test_a_unix_socket_needs_no_token(self):
        with self.serve() as server:
            server.wait_for("listening on unix:s")
            wire = connect_unix(server.path("s"))
            self.assertTrue(ask(wire, b"load beamfall").startswith(b"ok game=beamfall"))
            wire.close()

    def test_a_hangup_reads_the_file_again_and_a_bad_file_keeps_the_old_tokens(self):
        def admits(server, token):
            wire = connect_tcp(server.port())
            reply = ask(wire, b"hello token=" + token.encode())
            wire.close()
            return reply.startswith(b"ok ")

        with self.serve() as server:
            self.assertTrue(admits(server, TOKEN) and not admits(server, OTHER))
            self.write("tokens", OTHER + "\n")
            server.process.send_signal(signal.SIGHUP)
            server.wait_for("read the token file again")
            self.assertTrue(admits(server, OTHER) and not admits(server, TOKEN))
            self.write("tokens", "short\n")
            server.process.send_signal(signal.SIGHUP)
            server.wait_for("line 1: a token must have 16 .*; the old token file stays in use")
            self.assertTrue(admits(server, OTHER))

    def test_files_without_a_good_token_are_refused(self):
        for text, hint in (
            ("", " has no token"),
            ("# none\n", " has no token"),
            ("short\n", "line 1"),
            (f"{TOKEN}\ntwo words of a token\n", "line 2"),
        ):
            with self.subTest(text=text):
                status, _, errors = run(
                    "serve", "--listen", "tcp://127.0.0.1:0", "--token-file", self.write("bad", text)
                )
                self.assertEqual((status, len(errors)), (1, 1), errors)
                self.assertIn(hint, errors[0])
        status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", self.path("nothing"))
        self.assertEqual((status, len(errors)), (1, 1), errors)

    def test_a_file_that_everyone_can_read_is_warned_of(self):
        for mode, warned in ((0o600, False), (0o644, True)):
            path = self.write("tokens", TOKEN)
            os.chmod(path, mode)
            with Server("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", path) as server:
                server.wait_for("listening on")
                self.assertEqual(any("every user of this machine" in line for line in server.log()), warned)


class BeyondThisMachine(Folder):
    def test_nothing_is_served_without_tokens(self):
        for address in ("tcp://0.0.0.0:0", "tcp://[::]:0"):
            with self.subTest(address=address):
                status, _, errors = run("serve", "--listen", address)
                self.assertEqual((status, len(errors)), (1, 1), errors)
                self.assertIn("--token-file", errors[0])

    def test_the_classic_protocol_is_not_served(self):
        tokens = self.write("tokens", TOKEN)
        status, _, errors = run("serve", "--listen", "classic+tcp://0.0.0.0:0", "--rom", GAME, "--token-file", tokens)
        self.assertEqual((status, len(errors)), (1, 1), errors)
        self.assertIn("classic protocol has no tokens", errors[0])

    def test_a_warning_names_the_risk_of_plain_TCP(self):
        with Server("serve", "--listen", "tcp://0.0.0.0:0", "--token-file", self.write("tokens", TOKEN)) as server:
            server.wait_for(
                "warning: tcp://0.0.0.0:[0-9]+ can be reached from other machines, without TLS: tokens can be read"
            )
            port = int(server.wait_for(r"listening on tcp://0\.0\.0\.0:(\d+)").group(1))
            wire = connect_tcp(port)
            self.assertTrue(ask(wire, b"games").startswith(b"error unauthorized "))
            wire.close()


class Tls(Folder):
    @classmethod
    def setUpClass(cls):
        cls.keys = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.keys.cleanup)
        cls.certificate, cls.key = (os.path.join(cls.keys.name, name) for name in ("cert.pem", "key.pem"))
        subprocess.run(
            [
                "openssl",
                "req",
                "-x509",
                "-newkey",
                "ec",
                "-pkeyopt",
                "ec_paramgen_curve:prime256v1",
                "-nodes",
                "-days",
                "2",
                "-subj",
                "/CN=localhost",
                "-addext",
                "subjectAltName=IP:127.0.0.1",
                "-keyout",
                cls.key,
                "-out",
                cls.certificate,
            ],
            check=True,
            capture_output=True,
        )

    def serve(self, *options):
        return Server(
            "serve",
            "--listen",
            "tls://127.0.0.1:0",
            "--tls-cert",
            self.certificate,
            "--tls-key",
            self.key,
            "--grace",
            "0",
            *options,
        )

    def port(self, server):
        return int(server.wait_for(r"listening on tls://127\.0\.0\.1:(\d+)$").group(1))

    def connect(self, server):
        context = ssl.create_default_context(cafile=self.certificate)
        plain = socket.create_connection(("127.0.0.1", self.port(server)), timeout=20)
        return context.wrap_socket(plain, server_hostname="127.0.0.1", suppress_ragged_eofs=False)

    def converse(self, server, requests):
        with self.connect(server) as connection:
            connection.sendall(requests)
            with connection.makefile("rb") as reader:
                return reader.read()

    def test_a_conversation_is_encrypted_and_the_same(self):
        requests = b"load beamfall seed=1 sticky=0\nobserve screen:hex ram\nact FIRE*50\nlook\nquit\n"
        with self.serve() as server:
            replies = self.converse(server, requests)
        self.assertEqual(replies, run("serve", "--stdio", data=requests)[1])
        self.assertEqual(len(replies.splitlines()), 5)

    def test_requests_are_answered_though_the_client_has_closed_its_end(self):
        requests = b"load beamfall seed=1\nlook screen:hex\nact FIRE*9\n"
        with self.serve() as server:
            for says_so in (True, False):  # TLS: close_notify; or only TCP
                with self.subTest(says_so=says_so), self.connect_by_hand(server) as (plain, inside, outside, tls):
                    tls.write(requests)
                    if says_so:
                        with self.assertRaises(ssl.SSLWantReadError):
                            tls.unwrap()
                    plain.sendall(outside.read())
                    plain.shutdown(socket.SHUT_WR)
                    replies = b""
                    while piece := plain.recv(65536):
                        inside.write(piece)
                        try:
                            while more := tls.read(65536):
                                replies += more
                        except (ssl.SSLWantReadError, ssl.SSLZeroReturnError):
                            pass
                    self.assertEqual(replies, run("serve", "--stdio", data=requests)[1])

    @contextlib.contextmanager
    def connect_by_hand(self, server):
        context = ssl.create_default_context(cafile=self.certificate)
        inside, outside = ssl.MemoryBIO(), ssl.MemoryBIO()
        tls = context.wrap_bio(inside, outside, server_hostname="127.0.0.1")
        with socket.create_connection(("127.0.0.1", self.port(server)), timeout=PATIENCE) as plain:
            while True:
                try:
                    tls.do_handshake()
                    break
                except ssl.SSLWantReadError:
                    plain.sendall(outside.read())
                    inside.write(plain.recv(65536))
            yield plain, inside, outside, tls

    def test_large_replies_come_whole(self):
        with self.serve() as server:
            replies = self.converse(server, b"load beamfall\nobserve rgb:hex\n" + b"look\n" * 20 + b"quit\n")
        self.assertEqual([len(line) for line in replies.splitlines()][2:-1], [len(b"ok rgb=") + 2 * 3 * 160 * 210] * 20)

    def test_tokens_go_with_it(self):
        with self.serve("--token-file", self.write("tokens", TOKEN)) as server:
            replies = self.converse(server, b"games\nhello token=" + TOKEN.encode() + b"\ngames\nquit\n").splitlines()
            self.assertEqual([line.split()[0] for line in replies], [b"error", b"ok", b"ok", b"ok"])

    def test_who_speaks_no_TLS_harms_nobody(self):
        with self.serve("--handshake", "1") as server:
            talker, silent = connect_tcp(self.port(server)), connect_tcp(self.port(server))
            talker.send(b"hello\n" * 10)
            self.assertNotIn(b"ok", talker.rest())
            self.assertEqual(silent.rest(), b"")
            for wire in (talker, silent):
                wire.close()
            self.assertTrue(self.converse(server, b"quit\n").startswith(b"ok"))

    def test_the_classic_protocol_can_be_encrypted_too(self):
        with (
            Server(
                "serve",
                "--listen",
                "classic+tls://127.0.0.1:0",
                "--rom",
                GAME,
                "--tls-cert",
                self.certificate,
                "--tls-key",
                self.key,
            ) as server,
            self.connect(server) as connection,
            connection.makefile("rb") as reader,
        ):
            self.assertEqual(reader.readline(), b"160-210\n")
            connection.sendall(b"0,0,0,1\n3,18\n")
            self.assertEqual(reader.readline(), b"0,0:\n")

    def test_a_certificate_and_a_key_are_needed(self):
        for options, status, hint in (
            ([], 1, "needs --tls-cert and --tls-key"),
            (["--tls-cert", self.certificate], 2, "must be given together"),
            (["--tls-cert", self.key, "--tls-key", self.key], 1, "cannot use the certificate"),
            (["--tls-cert", self.certificate, "--tls-key", "nothing"], 1, "cannot use the key"),
        ):
            with self.subTest(options=options):
                ended, _, errors = run("serve", "--listen", "tls://127.0.0.1:0", *options)
                self.assertEqual((ended, len(errors)), (status, 1), errors)
                self.assertIn(hint, errors[0])

    def test_a_key_of_another_kind_than_the_certificate_is_refused(self):
        other = os.path.join(self.keys.name, "rsa.pem")
        subprocess.run(["openssl", "genrsa", "-out", other, "2048"], check=True, capture_output=True)
        ended, _, errors = run(
            "serve", "--listen", "tls://127.0.0.1:0", "--tls-cert", self.certificate, "--tls-key", other
        )
        self.assertEqual((ended, len(errors)), (1, 1), errors)
        self.assertIn(f"the key {other} does not belong to the certificate {self.certificate}", errors[0])

    def test_nobody_is_asked_for_the_password_of_a_key(self):
        subprocess.run(
            ["openssl", "ec", "-aes256", "-in", self.key, "-passout", "pass:secret", "-out", self.path("locked.pem")],
            check=True,
            capture_output=True,
        )
        status, _, errors = run(
            "serve",
            "--listen",
            "tls://127.0.0.1:0",
            "--tls-cert",
            self.certificate,
            "--tls-key",
            self.path("locked.pem"),
        )
        self.assertEqual((status, len(errors)), (1, 1), errors)
        self.assertIn("cannot use the key", errors[0])

    def test_one_too_many_is_turned_away_without_a_word(self):
        with self.serve("--max-sessions", "1") as server, self.connect(server) as first:
            first.sendall(b"hello\n")
            first.recv(1)
            plain = connect_tcp(self.port(server))
            self.assertEqual(plain.rest(), b"")
            plain.close()

    def test_the_end_of_a_session_is_reported_over_TLS(self):
        for options, requests, last in ((["--idle", "1"], b"hello\n", b"error idle "), ([], b"quit\n", b"ok")):
            with self.subTest(last=last), self.serve(*options) as server, self.connect(server) as connection:
                connection.sendall(requests)
                replies = b""
                while piece := connection.recv(65536):  # an end that was not told is an SSLEOFError
                    replies += piece
                self.assertTrue(replies.splitlines()[-1].startswith(last), replies)

    @unittest.skipIf(sanitized(), "a sanitizer needs more memory")
    def test_handshakes_that_stall_count_as_memory(self):
        limit = 48  # MiB
        with self.serve("--max-memory", f"{limit}M", "--handshake", "60") as server, contextlib.ExitStack() as stack:
            port = self.port(server)
            for _ in range(800):
                stack.callback(connect_tcp(port).close)
            server.wait_for("refused, the server's sessions hold all the memory that they may")
            with open(f"/proc/{server.process.pid}/status") as status:
                resident = next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
            self.assertLess(resident / 1024, limit)

    def test_a_session_ends_in_time_when_its_client_does_not_close(self):
        with self.serve() as server:
            connection = self.connect(server)
            connection.sendall(b"hello\n")
            connection.recv(1)
            start = time.monotonic()
            self.assertEqual(server.stop(), 0)
            self.assertLess(time.monotonic() - start, 5)
            connection.close()


if __name__ == "__main__":
    main()
