"""TLS: encrypted sessions, certificates, and clients that speak something else."""

import contextlib
import os
import signal
import socket
import ssl
import subprocess
import tempfile
import time

import pytest
from access_case import TOKEN, Folder, make_certificate
from harness import GAME, PATIENCE, Server, connect_tcp, run, sanitized


class TestTls(Folder):
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, request):
        cls.keys = tempfile.TemporaryDirectory()
        request.addfinalizer(cls.keys.cleanup)
        cls.certificate, cls.key = make_certificate(cls.keys.name)

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
        assert replies == run("serve", "--stdio", data=requests)[1]
        assert len(replies.splitlines()) == 5

    def test_requests_are_answered_though_the_client_has_closed_its_end(self, subtests):
        requests = b"load beamfall seed=1\nlook screen:hex\nact FIRE*9\n"
        with self.serve() as server:
            for says_so in (True, False):  # TLS: close_notify; or only TCP
                with subtests.test(says_so=says_so), self.connect_by_hand(server) as (plain, inside, outside, tls):
                    tls.write(requests)
                    if says_so:
                        with pytest.raises(ssl.SSLWantReadError):
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
                    assert replies == run("serve", "--stdio", data=requests)[1]

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
        assert [len(line) for line in replies.splitlines()][2:-1] == [len(b"ok rgb=") + 2 * 3 * 160 * 210] * 20

    def test_tokens_go_with_it(self):
        with self.serve("--token-file", self.write("tokens", TOKEN)) as server:
            replies = self.converse(server, b"games\nhello token=" + TOKEN.encode() + b"\ngames\nquit\n").splitlines()
            assert [line.split()[0] for line in replies] == [b"error", b"ok", b"ok", b"ok"]

    def test_who_speaks_no_TLS_harms_nobody(self):
        with self.serve("--handshake", "1") as server:
            talker, silent = connect_tcp(self.port(server)), connect_tcp(self.port(server))
            talker.send(b"hello\n" * 10)
            assert b"ok" not in talker.rest()
            assert silent.rest() == b""
            for wire in (talker, silent):
                wire.close()
            assert self.converse(server, b"quit\n").startswith(b"ok")

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
            assert reader.readline() == b"160-210\n"
            connection.sendall(b"0,0,0,1\n3,18\n")
            assert reader.readline() == b"0,0:\n"

    @pytest.mark.needs_posix
    def test_a_hangup_reads_the_certificate_again_and_a_bad_file_keeps_the_old_one(self):
        def presented(server):
            return ssl.get_server_certificate(("127.0.0.1", self.port(server)))

        def install(folder):
            for name, path in zip(("cert", "key"), make_certificate(folder)):
                with open(path) as file:
                    self.write(name, file.read())
            with open(self.path("cert")) as file:
                return file.read()

        options = ("--tls-cert", self.path("cert"), "--tls-key", self.path("key"))
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            old = install(first)
            with Server("serve", "--listen", "tls://127.0.0.1:0", *options) as server:
                assert presented(server) == old
                new = install(second)
                assert presented(server) == old
                server.process.send_signal(signal.SIGHUP)
                server.wait_for("racebeam: read the certificate again$")
                assert presented(server) == new != old
                self.write("key", "no key")
                server.process.send_signal(signal.SIGHUP)
                server.wait_for("warning: cannot use the key .*; the old certificate stays in use$")
                assert presented(server) == new

    def test_a_certificate_and_a_key_are_needed(self, subtests):
        for options, status, hint in (
            ([], 1, "needs --tls-cert and --tls-key"),
            (["--tls-cert", self.certificate], 2, "must be given together"),
            (["--tls-cert", self.key, "--tls-key", self.key], 1, "cannot use the certificate"),
            (["--tls-cert", self.certificate, "--tls-key", "nothing"], 1, "cannot use the key"),
        ):
            with subtests.test(options=options):
                ended, _, errors = run("serve", "--listen", "tls://127.0.0.1:0", *options)
                assert (ended, len(errors)) == (status, 1), errors
                assert hint in errors[0]

    def test_a_key_of_another_kind_than_the_certificate_is_refused(self):
        other = os.path.join(self.keys.name, "rsa.pem")
        subprocess.run(["openssl", "genrsa", "-out", other, "2048"], check=True, capture_output=True)
        ended, _, errors = run(
            "serve", "--listen", "tls://127.0.0.1:0", "--tls-cert", self.certificate, "--tls-key", other
        )
        assert (ended, len(errors)) == (1, 1), errors
        assert f"the key {other} does not belong to the certificate {self.certificate}" in errors[0]

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
        assert (status, len(errors)) == (1, 1), errors
        assert "cannot use the key" in errors[0]

    def test_one_too_many_is_turned_away_without_a_word(self):
        with self.serve("--max-sessions", "1") as server, self.connect(server) as first:
            first.sendall(b"hello\n")
            first.recv(1)
            plain = connect_tcp(self.port(server))
            assert plain.rest() == b""
            plain.close()

    @pytest.mark.parametrize(
        "options, requests, last", ((["--idle", "1"], b"hello\n", b"error idle "), ([], b"quit\n", b"ok"))
    )
    def test_the_end_of_a_session_is_reported_over_TLS(self, options, requests, last):
        with self.serve(*options) as server, self.connect(server) as connection:
            connection.sendall(requests)
            replies = b""
            while piece := connection.recv(65536):  # an end that was not told is an SSLEOFError
                replies += piece
            assert replies.splitlines()[-1].startswith(last), replies

    @pytest.mark.skipif(sanitized(), reason="a sanitizer needs more memory")
    def test_handshakes_that_stall_count_as_memory(self):
        limit = 48  # MiB
        with self.serve("--max-memory", f"{limit}M", "--handshake", "60") as server, contextlib.ExitStack() as stack:
            port = self.port(server)
            for _ in range(800):
                stack.callback(connect_tcp(port).close)
            server.wait_for("refused, the server's sessions hold all the memory that they may")
            with open(f"/proc/{server.process.pid}/status") as status:
                resident = next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
            assert resident / 1024 < limit

    def test_a_session_ends_in_time_when_its_client_does_not_close(self):
        with self.serve() as server:
            connection = self.connect(server)
            connection.sendall(b"hello\n")
            connection.recv(1)
            start = time.monotonic()
            assert server.stop() == 0
            assert time.monotonic() - start < 5
            connection.close()
