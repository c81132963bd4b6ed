"""Clients over WebSocket that break the rules."""

import contextlib
import os
import socket
import time

import pytest
from harness import PATIENCE, Server, sanitized, thread_sanitized
from test_hostile import JUMP_TO_ITSELF, load_inline
from web_case import Case, port_of
from web_socket import BINARY, PING, TEXT, WebSocket, frame, request


class TestHostile(Case):
    """What one client does, another does not notice."""

    @pytest.fixture(autouse=True)
    def set_up(self, self_cleanup):
        self.start("--threads", "1")
        self.bystander = self.connect()
        self.bystander.ask(b"load beamfall max_episode_frames=0")

    def check_bystander(self):
        waits = []
        for _ in range(15):
            start = time.monotonic()
            assert self.bystander.ask(b"act NOOP*10").startswith(b"ok ")
            waits.append(time.monotonic() - start)
        assert sorted(waits)[len(waits) // 2] < 0.1

    def memory(self):
        with open(f"/proc/{self.server.process.pid}/statm") as sizes:
            return int(sizes.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def test_frames_that_break_the_rules_close_the_connection(self, subtests):
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
            with subtests.test(name):
                wire = self.connect()
                wire.write(data)
                assert wire.end()[1] == code
        self.check_bystander()
        assert self.memory() - before < 16 << 20

    def test_an_invalid_handshake_is_refused(self):
        port = port_of(self.server)
        for fields in ({"Upgrade": None}, {"Connection": None}, {"Connection": "close"}, {"Upgrade": "h2c"}):
            assert self.refusal(**fields).status == 426, fields
        for fields in ({"Sec-WebSocket-Key": None}, {"Sec-WebSocket-Key": "x" * 100}, {"Host": None}):
            assert self.refusal(**fields).status == 400, fields
        assert self.refusal(**{"Sec-WebSocket-Version": "8"}).status == 426
        assert self.refusal(path="/other").status == 404
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
                    assert b" 101 " not in connection.recv(4096)
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
        last, before = 0, self.memory()
        while before > last + (64 << 10):  # until the server has stopped to answer it
            self.check_bystander()
            last, before = before, self.memory()
        self.check_bystander()
        assert self.memory() - before < 4 << 20

    @pytest.mark.needs_posix
    def test_one_that_leaves_in_a_long_request_is_noticed(self):
        wire = self.connect()
        assert wire.ask(load_inline(JUMP_TO_ITSELF) + b" frame_skip=1000").startswith(b"ok ")
        wire.send(b"act NOOP*1999")
        self.server.wait_until_it_works()
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
            assert wire.ask(b"hello").startswith(b"ok ")

    @pytest.mark.skipif(sanitized() or thread_sanitized(), reason="a sanitizer needs more memory")
    def test_memory_is_limited(self):
        with (
            Server("serve", "--listen", "ws://127.0.0.1:0", "--max-memory", "80M") as server,
            contextlib.ExitStack() as stack,
        ):
            small = WebSocket(port_of(server))
            stack.callback(small.close)
            small.ask(b"load beamfall")
            wire, is_refused = WebSocket(port_of(server)), False
            stack.callback(wire.close)
            wire.ask(b"load beamfall")
            for number in range(256, 0, -64):
                is_refused |= wire.ask(b"open %d" % number).startswith(b"error limit ")
            assert is_refused
            assert small.ask(b"act NOOP").startswith(b"ok ")
