"""The page that a server offers."""

import gzip
import os
import socket

from harness import PATIENCE, SOURCE
from web_case import Case, port_of

TYPES = {
    "html": "text/html; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "svg": "image/svg+xml",
}


class TestPage(Case):
    def test_it_is_served_with_fields_that_keep_it_to_itself(self):
        self.start()
        status, fields, text = self.get("/")
        with open(os.path.join(SOURCE, "viewer", "dist", "index.html"), "rb") as file:
            assert (status, text) == (200, file.read())
        assert fields["Content-Type"] == "text/html; charset=utf-8"
        assert fields["X-Content-Type-Options"] == "nosniff"
        policy = fields["Content-Security-Policy"].split("; ")
        assert policy[:2] == ["default-src 'none'", "script-src 'self'"]
        assert {"connect-src 'self'", "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'"} < {*policy}
        assert self.get("/index.html")[2] == text

    def test_every_file_is_there_compressed_and_cached(self, subtests):
        self.start()
        folder = os.path.join(SOURCE, "viewer", "dist")
        names = [
            os.path.relpath(os.path.join(path, name), folder) for path, _, files in os.walk(folder) for name in files
        ]
        assert "index.html" in names
        for name in names:
            with subtests.test(name), open(os.path.join(folder, name), "rb") as file:
                status, fields, text = self.get("/" + name, **{"Accept-Encoding": "br, gzip"})
                assert (status, fields["Content-Encoding"], gzip.decompress(text)) == (200, "gzip", file.read())
                assert fields["Content-Type"] == TYPES[name.rpartition(".")[2]]  # a browser guesses none (nosniff)
                assert (fields["Cache-Control"], fields["Vary"]) == ("no-cache", "Accept-Encoding")
                assert self.get("/" + name, **{"If-None-Match": fields["ETag"]})[::2] == (304, b"")
                assert self.get("/" + name, **{"If-None-Match": '"other"'})[0] == 200

    def answers(self, *pieces):
        """What the server says after each piece of a request, and then until it closes."""
        connection, replies = self.raw(), []
        for piece in pieces:
            connection.sendall(piece)
            replies.append(connection.recv(65536))
        while piece := connection.recv(65536):
            replies[-1] += piece
        return replies

    def test_who_waits_before_the_body_is_told_to_go_on(self):
        for method, status in ((b"GET", b"HTTP/1.1 200 OK\r\n"), (b"POST", b"HTTP/1.1 405 ")):
            self.start()
            first, second = self.answers(
                method + b" / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: 4\r\n"
                b"Expect: 100-continue\r\n\r\n",
                b"body",
            )
            assert first == b"HTTP/1.1 100 Continue\r\n\r\n"
            assert second.startswith(status), second
        assert self.answers(b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 4000\r\nExpect: 100-continue\r\n\r\n")[
            0
        ].startswith(b"HTTP/1.1 413 ")

    def test_a_header_may_have_8192_bytes_and_a_body_1024(self):
        self.start()
        start, end = b"HEAD / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nX: ", b"\r\n\r\n"
        for size, status in ((8192, b"HTTP/1.1 200 "), (9000, b"HTTP/1.1 431 ")):  # ends of lines are not counted
            assert self.answers(start.ljust(size - len(end), b"x") + end)[0].startswith(status), size
        for size, status in ((1024, b"HTTP/1.1 405 "), (1025, b"HTTP/1.1 413 ")):
            header = b"POST / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: %d\r\n\r\n" % size
            assert self.answers(header + b"x" * size)[0].startswith(status), size

    def test_a_request_that_cannot_be_read_gets_an_error(self):
        self.start("--http", "127.0.0.1:0")
        health = int(self.server.wait_for(r"health and metrics on http://127\.0\.0\.1:(\d+)").group(1))
        cases = (
            (b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"x" * 30000 + b"\r\n\r\n", b"HTTP/1.1 431 "),
            (b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9999\r\n\r\n" + b"x" * 9999, b"HTTP/1.1 413 "),
            (
                b"POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n4\r\nbody\r\n0\r\n\r\n",
                b"HTTP/1.1 411 ",
            ),
            (b"GET / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n0\r\nnone\r\n", b"HTTP/1.1 411 "),
            (b"GET / HTTP/1.1\r\nHost\r\n\r\n", b"HTTP/1.1 400 "),
            (b"load beamfall\n\r\n\r\n", b"HTTP/1.1 400 "),
        )
        for port in (port_of(self.server), health):
            for request_text, status in cases:
                with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as connection:
                    connection.sendall(request_text)
                    reply = b""
                    while piece := connection.recv(65536):
                        reply += piece
                    assert reply.startswith(status), (status, reply)

    def test_a_client_that_leaves_within_its_request_gets_nothing(self):
        self.start()
        with socket.create_connection(("127.0.0.1", port_of(self.server)), timeout=PATIENCE) as connection:
            connection.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n")
            connection.shutdown(socket.SHUT_WR)
            assert connection.recv(1) == b""

    def test_other_paths_are_not(self):
        self.start()
        for path, status in (
            ("/nothing", 404),
            ("/../CMakeLists.txt", 404),
            ("/healthz", 404),
            ("/metrics", 404),
            ("/session", 426),
        ):
            assert self.get(path)[0] == status, path
