"""Who is admitted to WebSockets: origins, tokens, TLS."""

import contextlib
import os
import signal
import ssl
import sys
import time
import urllib.error
import urllib.request

import pytest

SERVER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [SERVER, os.path.join(SERVER, "access")]
from access_case import TOKEN, Folder, make_certificate
from harness import PATIENCE, Server, run
from web_case import Case, port_of
from web_socket import TEXT, WebSocket, frame, request


class TestOrigins(Case):
    def test_the_own_page_programs_and_allowed_pages_are_admitted(self):
        self.start("--allow-origin", "https://lab.example", "--allow-origin", "http://127.0.0.1:1")
        host = f"127.0.0.1:{port_of(self.server)}"
        for origin in (None, "http://" + host, "https://" + host, "https://lab.example", "http://127.0.0.1:1"):
            assert self.connect(Origin=origin).ask(b"hello").startswith(b"ok "), origin
        assert self.connect(Host="LocalHost:80", Origin="http://localhost:80").ask(b"hello").startswith(b"ok ")

    def test_other_pages_are_refused(self):
        self.start("--allow-origin", "https://lab.example")
        host = f"127.0.0.1:{port_of(self.server)}"
        for origin in (
            "http://evil.example",
            "http://" + host + "0",
            "http://127.0.0.1",
            "null",
            "",
            "file://",
            host,
            "https://lab.example.evil.example",
            "https://lab.example:444",
            "http://lab.example",
        ):
            assert self.refusal(Origin=origin).status == 403, origin
        for place in (
            "[::1].evil.example",
            "127.0.0.1:80@evil.example",
            "127.0.0.1:80.evil.example",
            "localhost@evil.example",
            "[::1]evil",
            "[127.0.0.1]",
            "127.0.0.1:99999",
        ):
            assert self.refusal(Origin="http://" + place, Host=place).status == 403, place
        # The name of another site that stands for this machine.
        assert self.refusal(Origin="http://evil.example:80", Host="evil.example:80").status == 403

    def test_a_name_is_admitted_where_tokens_are_required(self, tmp_path):
        folder = Folder()
        folder.folder = tmp_path
        self.start("--token-file", folder.write("tokens", TOKEN))
        wire = self.connect(Origin="http://node7:80", Host="node7:80")
        assert b" admitted=0 " in wire.ask(b"hello")
        assert self.refusal(Origin="http://node8:80", Host="node7:80").status == 403

    def test_an_invalid_origin_is_refused_at_the_start(self):
        for origin in ("*", "lab.example", "https://", "https://lab.example/page"):
            status, _, errors = run("serve", "--listen", "ws://127.0.0.1:0", "--allow-origin", origin)
            assert (status, len(errors)) == (2, 1), errors


class TestTokens(Case, Folder):
    @pytest.fixture(autouse=True)
    def token_file(self, own_folder):
        self.tokens = self.write("tokens", TOKEN)

    def test_a_token_is_required_and_the_third_wrong_one_closes(self):
        self.start("--token-file", self.tokens)
        wire = self.connect()
        assert wire.ask(b"load beamfall").startswith(b"error unauthorized ")
        assert b" admitted=1 " in wire.ask(b"hello token=" + TOKEN.encode())
        assert wire.ask(b"load beamfall").startswith(b"ok ")
        wire = self.connect()
        for _ in range(3):
            wire.send(b"hello token=0123456789abcdeX")
        for _ in range(2):
            assert wire.line().startswith(b"error unauthorized ")
        line, code = wire.end()
        assert line.startswith(b"error unauthorized ")
        assert code == 1008

    def test_before_the_token_a_message_is_short(self):
        self.start("--token-file", self.tokens)
        assert self.connect().ask(b"help".ljust(4096) + b"\n").startswith(b"ok ")
        assert self.too_long(self.connect(), 4099) == 1009
        wire = self.connect()
        wire.ask(b"hello token=" + TOKEN.encode())
        assert wire.ask(b"help" + b" " * 5000).startswith(b"ok ")
        assert self.too_long(wire, (1 << 20) + 3) == 1009

    def too_long(self, wire, size):
        wire.write(frame(TEXT, b"", length=size))
        return wire.end()[1]

    def test_connections_without_a_session_are_closed(self):
        self.start("--token-file", self.tokens, "--handshake", "1")
        start = time.monotonic()
        silent, half, other = self.raw(), self.raw(), self.connect()
        half.sendall(b"GET /session HTTP/1.1\r\nHost: x\r\n")
        slow = self.raw()
        with contextlib.suppress(OSError):
            for byte in request("x" * 4000):  # one byte at a time
                slow.sendall(bytes([byte]))
                time.sleep(0.01)
        assert time.monotonic() - start < PATIENCE
        assert (silent.recv(1), half.recv(1)) == (b"", b"")
        assert other.end() == (b"error unauthorized no token came within 1 seconds", 1008)
        self.server.wait_for("no handshake came within 1 seconds")

    def test_beyond_this_machine_tokens_are_demanded(self):
        status, _, errors = run("serve", "--listen", "ws://0.0.0.0:0")
        assert (status, len(errors)) == (1, 1), errors
        assert "--token-file" in errors[0]


class TestOverTls:
    def test_a_session_and_the_page_run_over_TLS(self, tmp_path):
        certificate, key = make_certificate(str(tmp_path))
        keys = ("--tls-cert", certificate, "--tls-key", key)
        context = ssl.create_default_context(cafile=certificate)
        with Server("serve", "--listen", "wss://127.0.0.1:0", *keys, "--grace", "0") as server:
            port = port_of(server, "wss")
            wire = WebSocket(port, tls=context)
            assert wire.ask(b"load beamfall seed=1").startswith(b"ok game=beamfall")
            wire.send(b"look screen:raw")
            assert wire.line() == b"ok screen=33600 raw=33600"
            assert len(wire.message()[1]) == 33600
            with urllib.request.urlopen(f"https://127.0.0.1:{port}/", context=context, timeout=PATIENCE) as page:
                assert b"<html" in page.read()
            server.process.send_signal(signal.SIGTERM)
            assert wire.end() == (b"error stopping the server stops", 1001)
            wire.close()
            assert server.wait() == 0
