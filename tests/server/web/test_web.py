"""Sessions over WebSocket, and the page."""

import contextlib
import gzip
import os
import re
import signal
import socket
import ssl
import struct
import sys
import time
import unittest
import urllib.error
import urllib.request

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import test_access
from harness import PATIENCE, SOURCE, Server, main, run, sanitized, thread_sanitized
from test_documents import conversations, pattern
from test_hostile import ENDLESS, JUMP_TO_ITSELF, load_inline
from web_socket import BINARY, CLOSE, PING, PONG, TEXT, Refused, WebSocket, frame, request


def port_of(server, scheme="ws"):
    return int(server.wait_for(scheme + r"://127\.0\.0\.1:(\d+)$").group(1))


class Case(unittest.TestCase):
    """A server, and connections to it, which are closed at the end of the test."""

    def start(self, *options, listen="ws://127.0.0.1:0"):
        self.server = Server("serve", "--listen", listen, "--grace", "0", *options)
        self.addCleanup(self.server.__exit__)
        return self.server

    def connect(self, scheme="ws", **fields):
        wire = WebSocket(port_of(self.server, scheme), **fields)
        self.addCleanup(wire.close)
        return wire

    def raw(self):
        connection = socket.create_connection(("127.0.0.1", port_of(self.server)), timeout=PATIENCE)
        self.addCleanup(connection.close)
        return connection

    def refusal(self, scheme="ws", **fields):
        with self.assertRaises(Refused) as found:
            self.connect(scheme, **fields)
        return found.exception

    def get(self, path, scheme="ws", **fields):
        asked = urllib.request.Request(f"http://127.0.0.1:{port_of(self.server, scheme)}{path}", headers=fields)
        try:
            with urllib.request.urlopen(asked, timeout=PATIENCE) as response:
                return response.status, response.headers, response.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, error.read()


class Conversation(Case):
    def test_the_conversations_of_the_line_protocol_are_real(self):
        for command, said, heard in conversations("protocol/PROTOCOL.md"):
            options = [word for word in command[2:] if word != "--stdio"]
            if "--strict" in options:  # on streams only
                continue
            with (
                self.subTest(command=command, said=said),
                Server("serve", "--listen", "ws://127.0.0.1:0", *options) as server,
            ):
                wire = WebSocket(port_of(server))
                found = b""
                for line in said:
                    wire.send(line.rstrip("\n").encode())
                    if line.startswith("#"):
                        continue
                    text = wire.line()
                    found += text + b"\n"
                    if re.search(rb" raw=\d+\Z", text):
                        opcode, payload = wire.message()
                        self.assertEqual(opcode, BINARY)
                        found += payload
                wire.close()
                self.assertRegex(found.decode("latin-1"), f"\\A{pattern(heard)}\\Z")

    def test_a_message_is_one_line_or_several_in_any_number_of_frames(self):
        self.start()
        wire = self.connect()
        for text, replies in (
            (b"hello", 1),
            (b"hello\n", 1),
            (b"hello\r\n", 1),
            (b"hello\nhelp\n# no reply\nhelp load", 3),
        ):
            wire.send(text)
            for _ in range(replies):
                self.assertTrue(wire.line().startswith(b"ok "), text)
        wire.write(
            frame(TEXT, b"help", final=False)
            + frame(PING, b"between")
            + b"".join(frame(0, bytes([byte]), final=False) for byte in b" load")
            + frame(0, b"")
        )
        self.assertEqual(wire.message(), (PONG, b"between"))
        self.assertTrue(wire.line().startswith(b"ok load "))
        self.assertEqual(wire.ask(b""), b"error bad-line the line is empty; help lists the commands")

    def test_a_long_reply_and_a_long_request_arrive_whole(self):
        self.start()
        wire = self.connect()
        wire.ask(b"load beamfall seed=1")
        self.assertEqual(len(wire.ask(b"look rgb:hex")), len("ok rgb=") + 2 * 3 * 160 * 210)
        wire.send(b"look screen:raw ram:raw")
        self.assertEqual(wire.line(), b"ok screen=33600 ram=128 raw=33728")
        opcode, payload = wire.message()
        self.assertEqual((opcode, len(payload)), (BINARY, 33728))
        many = b"act" + b" NOOP" * 20000
        self.assertTrue(wire.ask(many).startswith(b"ok reward="))

    def test_requests_sent_ahead_are_answered_in_order(self):
        self.start()
        wire = self.connect()
        wire.write(
            b"".join(
                frame(TEXT, line) for line in [ENDLESS, b"observe acts"] + [b"act NOOP*%d" % n for n in range(1, 300)]
            )
        )
        wire.line(), wire.line()
        self.assertEqual([wire.line() for _ in range(1, 300)], [b"ok acts=%d" % n for n in range(1, 300)])

    def test_either_side_closes_in_good_order(self):
        self.start()
        wire = self.connect()
        wire.send(b"quit")
        self.assertEqual(wire.end(), (b"ok", 1000))
        wire = self.connect()
        wire.write(frame(CLOSE, struct.pack("!H", 1000)))
        self.assertEqual(wire.end(), (None, 1000))
        self.server.wait_for(r"client 2: 0 requests")
        wire = self.connect()
        wire.ask(b"load beamfall")
        self.server.process.send_signal(signal.SIGTERM)
        self.assertEqual(wire.end(), (b"error stopping the server stops", 1001))
        self.assertEqual(self.server.wait(), 0)

    def test_idle_sessions_are_told_and_closed(self):
        self.start("--idle", "1")
        self.assertEqual(self.connect().end(), (b"error idle nothing came or went for 1 seconds", 1008))

    def test_it_is_one_of_the_addresses(self):
        self.start("--ready-file", "ready", "--announce", "announce")
        self.assertEqual(self.server.addresses("ready"), [f"ws://127.0.0.1:{port_of(self.server)}"])

    def test_the_classic_protocol_is_refused(self):
        for options in (["--listen", "classic+ws://127.0.0.1:0"], ["--listen", "ws://127.0.0.1:0", "--classic"]):
            status, _, errors = run("serve", *options, "--rom", "builtin:beamfall")
            self.assertEqual((status, len(errors)), (2, 1), errors)


class BesideThePage(Case):
    """Sessions on the port of --http."""

    def start(self, *options, listen="tcp://127.0.0.1:0"):
        return super().start("--http", "127.0.0.1:0", *options, listen=listen)

    def test_a_session_runs_and_counts_as_one(self):
        self.start("--max-sessions", "1", "--threads", "2")
        wire = self.connect("http")
        self.assertTrue(wire.ask(b"load beamfall").startswith(b"ok game=beamfall"))
        self.assertIn(b'racebeam_sessions_total{protocol="line"} 1\n', self.get("/metrics", "http")[2])
        refused = self.refusal("http")
        self.assertEqual(refused.status, 503)
        self.assertIn("there are 1 sessions", refused.text)
        self.assertTrue(wire.ask(b"act NOOP").startswith(b"ok "))

    def test_a_server_without_the_line_protocol_has_none(self):
        self.start("--rom", "builtin:beamfall", listen="classic+tcp://127.0.0.1:0")
        self.assertEqual(self.refusal("http").status, 403)

    def test_beyond_this_machine_there_are_none_without_tokens(self):
        with Server("serve", "--listen", "unix:s", "--http", "0.0.0.0:0") as server:
            port = int(server.wait_for(r"health and metrics on http://0\.0\.0\.0:(\d+)").group(1))
            with self.assertRaises(Refused) as refused:
                WebSocket(port)
            self.assertEqual(refused.exception.status, 403)
            self.assertIn("--token-file", refused.exception.text)


class Page(Case):
    def test_it_is_served_with_fields_that_keep_it_to_itself(self):
        self.start()
        status, fields, text = self.get("/")
        with open(os.path.join(SOURCE, "viewer", "dist", "index.html"), "rb") as file:
            self.assertEqual((status, text), (200, file.read()))
        self.assertEqual(fields["Content-Type"], "text/html; charset=utf-8")
        self.assertEqual(fields["X-Content-Type-Options"], "nosniff")
        self.assertTrue(fields["Content-Security-Policy"].startswith("default-src 'none'; script-src 'self'; "))
        self.assertEqual(self.get("/index.html")[2], text)

    def test_every_file_is_there_compressed_and_cached(self):
        self.start()
        folder = os.path.join(SOURCE, "viewer", "dist")
        names = [
            os.path.relpath(os.path.join(path, name), folder) for path, _, files in os.walk(folder) for name in files
        ]
        self.assertIn("index.html", names)
        for name in names:
            with self.subTest(name), open(os.path.join(folder, name), "rb") as file:
                status, fields, text = self.get("/" + name, **{"Accept-Encoding": "br, gzip"})
                self.assertEqual(
                    (status, fields["Content-Encoding"], gzip.decompress(text)), (200, "gzip", file.read())
                )
                self.assertEqual(self.get("/" + name, **{"If-None-Match": fields["ETag"]})[::2], (304, b""))
                self.assertEqual(self.get("/" + name, **{"If-None-Match": '"other"'})[0], 200)

    def answers(self, *pieces):
        """What the server says after each piece of a request, and then until it closes."""
        connection, heard = self.raw(), []
        for piece in pieces:
            connection.sendall(piece)
            heard.append(connection.recv(65536))
        while piece := connection.recv(65536):
            heard[-1] += piece
        return heard

    def test_who_waits_before_the_body_is_told_to_go_on(self):
        for method, status in ((b"GET", b"HTTP/1.1 200 OK\r\n"), (b"POST", b"HTTP/1.1 405 ")):
            self.start()
            first, second = self.answers(
                method + b" / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: 4\r\n"
                b"Expect: 100-continue\r\n\r\n",
                b"body",
            )
            self.assertEqual(first, b"HTTP/1.1 100 Continue\r\n\r\n")
            self.assertTrue(second.startswith(status), second)
        self.assertTrue(
            self.answers(b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 4000\r\nExpect: 100-continue\r\n\r\n")[
                0
            ].startswith(b"HTTP/1.1 413 ")
        )

    def test_a_request_that_cannot_be_read_is_told_so(self):
        self.start("--http", "127.0.0.1:0")
        health = int(self.server.wait_for(r"health and metrics on http://127\.0\.0\.1:(\d+)").group(1))
        cases = (
            (b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"x" * 30000 + b"\r\n\r\n", b"HTTP/1.1 431 "),
            (b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9999\r\n\r\n" + b"x" * 9999, b"HTTP/1.1 413 "),
            (b"GET / HTTP/1.1\r\nHost\r\n\r\n", b"HTTP/1.1 400 "),
            (b"load beamfall\n\r\n\r\n", b"HTTP/1.1 400 "),
        )
        for port in (port_of(self.server), health):
            for request_text, status in cases:
                with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as connection:
                    connection.sendall(request_text)
                    heard = b""
                    while piece := connection.recv(65536):
                        heard += piece
                    self.assertTrue(heard.startswith(status), (status, heard))

    def test_other_paths_are_not(self):
        self.start()
        for path, status in (
            ("/nothing", 404),
            ("/../CMakeLists.txt", 404),
            ("/healthz", 404),
            ("/metrics", 404),
            ("/session", 426),
        ):
            self.assertEqual(self.get(path)[0], status, path)


class Origins(Case):
    def test_the_own_page_programs_and_allowed_pages_are_admitted(self):
        self.start("--allow-origin", "https://lab.example", "--allow-origin", "http://127.0.0.1:1")
        host = f"127.0.0.1:{port_of(self.server)}"
        for origin in (None, "http://" + host, "https://" + host, "https://lab.example", "http://127.0.0.1:1"):
            self.assertTrue(self.connect(Origin=origin).ask(b"hello").startswith(b"ok "), origin)
        self.assertTrue(
            self.connect(Host="LocalHost:80", Origin="http://localhost:80").ask(b"hello").startswith(b"ok ")
        )

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
            self.assertEqual(self.refusal(Origin=origin).status, 403, origin)
        for place in (
            "[::1].evil.example",
            "127.0.0.1:80@evil.example",
            "127.0.0.1:80.evil.example",
            "localhost@evil.example",
            "[::1]evil",
            "[127.0.0.1]",
            "127.0.0.1:99999",
        ):
            self.assertEqual(self.refusal(Origin="http://" + place, Host=place).status, 403, place)
        # The name of another site that stands for this machine.
        self.assertEqual(self.refusal(Origin="http://evil.example:80", Host="evil.example:80").status, 403)

    def test_a_name_is_admitted_where_tokens_are_required(self):
        folder = test_access.Folder()
        folder.setUp()
        self.addCleanup(folder.doCleanups)
        self.start("--token-file", folder.write("tokens", test_access.TOKEN))
        wire = self.connect(Origin="http://node7:80", Host="node7:80")
        self.assertIn(b" admitted=0 ", wire.ask(b"hello"))
        self.assertEqual(self.refusal(Origin="http://node8:80", Host="node7:80").status, 403)

    def test_an_invalid_origin_is_refused_at_the_start(self):
        for origin in ("*", "lab.example", "https://", "https://lab.example/page"):
            status, _, errors = run("serve", "--listen", "ws://127.0.0.1:0", "--allow-origin", origin)
            self.assertEqual((status, len(errors)), (2, 1), errors)


class Tokens(Case, test_access.Folder):
    def setUp(self):
        super().setUp()
        self.tokens = self.write("tokens", test_access.TOKEN)

    def test_a_token_is_required_and_the_third_wrong_one_closes(self):
        self.start("--token-file", self.tokens)
        wire = self.connect()
        self.assertTrue(wire.ask(b"load beamfall").startswith(b"error unauthorized "))
        self.assertIn(b" admitted=1 ", wire.ask(b"hello token=" + test_access.TOKEN.encode()))
        self.assertTrue(wire.ask(b"load beamfall").startswith(b"ok "))
        wire = self.connect()
        for _ in range(3):
            wire.send(b"hello token=0123456789abcdeX")
        for _ in range(2):
            self.assertTrue(wire.line().startswith(b"error unauthorized "))
        line, code = wire.end()
        self.assertTrue(line.startswith(b"error unauthorized "))
        self.assertEqual(code, 1008)

    def test_before_the_token_a_message_is_short(self):
        self.start("--token-file", self.tokens)
        self.assertEqual(self.too_long(self.connect(), 4099), 1009)
        wire = self.connect()
        wire.ask(b"hello token=" + test_access.TOKEN.encode())
        self.assertTrue(wire.ask(b"help" + b" " * 5000).startswith(b"ok "))
        self.assertEqual(self.too_long(wire, (1 << 20) + 3), 1009)

    def too_long(self, wire, size):
        wire.write(frame(TEXT, b"", length=size))
        return wire.end()[1]

    def test_connections_without_a_session_are_closed(self):
        self.start("--token-file", self.tokens, "--handshake", "1")
        begun = time.monotonic()
        silent, half, other = self.raw(), self.raw(), self.connect()
        half.sendall(b"GET /session HTTP/1.1\r\nHost: x\r\n")
        slow = self.raw()
        with contextlib.suppress(OSError):
            for byte in request("x" * 4000):  # one byte at a time
                slow.sendall(bytes([byte]))
                time.sleep(0.01)
        self.assertLess(time.monotonic() - begun, PATIENCE)
        self.assertEqual((silent.recv(1), half.recv(1)), (b"", b""))
        self.assertEqual(other.end(), (b"error unauthorized no token came within 1 seconds", 1008))
        self.server.wait_for("no handshake came within 1 seconds")

    def test_beyond_this_machine_tokens_are_demanded(self):
        status, _, errors = run("serve", "--listen", "ws://0.0.0.0:0")
        self.assertEqual((status, len(errors)), (1, 1), errors)
        self.assertIn("--token-file", errors[0])


class OverTls(unittest.TestCase):
    def test_a_session_and_the_page_run_over_TLS(self):
        tls = test_access.Tls
        tls.setUpClass()
        self.addCleanup(tls.doClassCleanups)
        keys = ("--tls-cert", tls.certificate, "--tls-key", tls.key)
        context = ssl.create_default_context(cafile=tls.certificate)
        with Server("serve", "--listen", "wss://127.0.0.1:0", *keys, "--grace", "0") as server:
            port = port_of(server, "wss")
            wire = WebSocket(port, tls=context)
            self.assertTrue(wire.ask(b"load beamfall seed=1").startswith(b"ok game=beamfall"))
            wire.send(b"look screen:raw")
            self.assertEqual(wire.line(), b"ok screen=33600 raw=33600")
            self.assertEqual(len(wire.message()[1]), 33600)
            with urllib.request.urlopen(f"https://127.0.0.1:{port}/", context=context, timeout=PATIENCE) as page:
                self.assertIn(b"<html", page.read())
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.end(), (b"error stopping the server stops", 1001))
            wire.close()
            self.assertEqual(server.wait(), 0)


class Hostile(Case):
    """What one client does, another does not notice."""

    def setUp(self):
        self.start("--threads", "1")
        self.bystander = self.connect()
        self.bystander.ask(b"load beamfall max_episode_frames=0")

    def check_bystander(self):
        waits = []
        for _ in range(15):
            begun = time.monotonic()
            self.assertTrue(self.bystander.ask(b"act NOOP*10").startswith(b"ok "))
            waits.append(time.monotonic() - begun)
        self.assertLess(sorted(waits)[len(waits) // 2], 0.1)

    def memory(self):
        with open(f"/proc/{self.server.process.pid}/statm") as sizes:
            return int(sizes.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def test_frames_that_break_the_rules_close_the_connection(self):
        cases = {
            "a binary message": (frame(BINARY, b"act NOOP"), 1003),
            "an empty binary message": (frame(BINARY, b""), 1003),
            "a gibibyte": (frame(TEXT, b"act", length=1 << 30), 1009),
            "more than there is": (frame(TEXT, b"act", length=(1 << 63) - 1), 1009),
            "a gibibyte in fragments": (frame(TEXT, b"a" * 999, final=False) + frame(0, b"", length=1 << 30), 1009),
            "bytes that are not UTF-8": (frame(TEXT, b"\xff\xfe"), 1007),
            "half a character": (frame(TEXT, b"help \xc3"), 1007),
            "no mask": (frame(TEXT, b"hello", mask=b""), 1002),
            "an unknown opcode": (frame(3, b"hello"), 1002),
            "a continuation of nothing": (frame(0, b"hello"), 1002),
            "a message in a message": (frame(TEXT, b"he", final=False) + frame(TEXT, b"llo"), 1002),
            "a long ping": (frame(PING, b"x" * 126), 1002),
            "a fragmented ping": (frame(PING, b"x", final=False), 1002),
            "binary garbage": (b"\xf3" * 4096, 1002),
        }
        before = self.memory()
        for name, (data, code) in cases.items():
            with self.subTest(name):
                wire = self.connect()
                wire.write(data)
                self.assertEqual(wire.end()[1], code)
        self.check_bystander()
        self.assertLess(self.memory() - before, 16 << 20)

    def test_an_invalid_handshake_is_refused(self):
        port = port_of(self.server)
        for fields in ({"Upgrade": None}, {"Connection": None}, {"Connection": "close"}, {"Upgrade": "h2c"}):
            self.assertEqual(self.refusal(**fields).status, 426, fields)
        for fields in ({"Sec-WebSocket-Key": None}, {"Sec-WebSocket-Key": "x" * 100}, {"Host": None}):
            self.assertEqual(self.refusal(**fields).status, 400, fields)
        self.assertEqual(self.refusal(**{"Sec-WebSocket-Version": "8"}).status, 426)
        self.assertEqual(self.refusal(path="/other").status, 404)
        for nonsense in (
            os.urandom(4096),
            b"\0" * 100,
            b"load beamfall\n",
            request("x") + frame(TEXT, b"too early"),
            b"GET /session HTTP/1.1\r\nX: " + b"x" * 100000,
        ):
            with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as connection:
                with contextlib.suppress(OSError):
                    connection.sendall(nonsense)
                    connection.shutdown(socket.SHUT_WR)
                    self.assertNotIn(b" 101 ", connection.recv(4096))
        self.check_bystander()

    def test_pings_without_end_delay_no_one(self):
        wire = self.connect()
        wire.connection.setblocking(False)  # the pongs are not read
        flood, until = frame(PING, b"x" * 125) * 500, time.monotonic() + 0.5
        while time.monotonic() < until:
            with contextlib.suppress(BlockingIOError):
                wire.connection.send(flood)
        self.check_bystander()

    def test_empty_fragments_without_end_delay_no_one(self):
        wire = self.connect()
        wire.write(frame(TEXT, b"help", final=False))
        wire.connection.setblocking(False)
        until = time.monotonic() + 0.5
        while time.monotonic() < until:
            with contextlib.suppress(BlockingIOError):
                wire.connection.send(frame(0, b"", final=False) * 1000)
        self.check_bystander()

    def test_a_client_that_does_not_read_only_stops_itself(self):
        wire = self.connect()
        wire.ask(b"load beamfall")
        wire.write(frame(TEXT, b"look rgb:hex") * 200)  # 20 MB of replies
        time.sleep(0.2)
        before = self.memory()
        self.check_bystander()
        self.assertLess(self.memory() - before, 4 << 20)

    def test_one_that_leaves_in_a_long_request_is_noticed(self):
        wire = self.connect()
        self.assertTrue(wire.ask(load_inline(JUMP_TO_ITSELF) + b" frame_skip=1000").startswith(b"ok "))
        wire.send(b"act NOOP*1999")
        time.sleep(0.05)
        wire.close()
        self.server.wait_for(r"client 2: the client left in the middle of a request")
        self.check_bystander()

    def test_a_thousand_connections(self):
        crowd = [self.connect() for _ in range(300)]
        half = [self.raw() for _ in range(700)]
        for connection in half[::2]:
            connection.sendall(b"GET /session HTTP/1.1\r\n")
        self.check_bystander()
        for wire in crowd[::50]:
            self.assertTrue(wire.ask(b"hello").startswith(b"ok "))

    @unittest.skipIf(sanitized() or thread_sanitized(), "a sanitizer needs more memory")
    def test_memory_is_limited(self):
        with (
            Server("serve", "--listen", "ws://127.0.0.1:0", "--max-memory", "80M") as server,
            contextlib.ExitStack() as stack,
        ):
            small = WebSocket(port_of(server))
            stack.callback(small.close)
            small.ask(b"load beamfall")
            wire, refused = WebSocket(port_of(server)), False
            stack.callback(wire.close)
            wire.ask(b"load beamfall")
            for number in range(256, 0, -64):
                refused |= wire.ask(b"open %d" % number).startswith(b"error limit ")
            self.assertTrue(refused)
            self.assertTrue(small.ask(b"act NOOP").startswith(b"ok "))


if __name__ == "__main__":
    main()
