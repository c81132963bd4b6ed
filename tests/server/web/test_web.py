"""Sessions over WebSocket, alone and beside the page."""

import re
import signal
import struct
import time

import pytest
from harness import Server, run
from test_documents import conversations, pattern
from test_hostile import ENDLESS
from web_case import Case, port_of
from web_socket import BINARY, CLOSE, PING, PONG, TEXT, Refused, WebSocket, frame


class TestConversation(Case):
    def test_the_conversations_of_the_line_protocol_are_real(self, subtests):
        for command, requests, replies in conversations("protocol/PROTOCOL.md"):
            options = [word for word in command[2:] if word != "--stdio"]
            if "--strict" in options:  # on streams only
                continue
            with (
                subtests.test(command=command, said=requests),
                Server("serve", "--listen", "ws://127.0.0.1:0", *options) as server,
            ):
                wire = WebSocket(port_of(server))
                found = b""
                for line in requests:
                    wire.send(line.rstrip("\n").encode())
                    if line.startswith("#"):
                        continue
                    text = wire.line()
                    found += text + b"\n"
                    if re.search(rb" raw=\d+\Z", text):
                        opcode, payload = wire.message()
                        assert opcode == BINARY
                        found += payload
                wire.close()
                assert re.search(f"\\A{pattern(replies)}\\Z", found.decode("latin-1"))

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
                assert wire.line().startswith(b"ok "), text
        wire.write(
            frame(TEXT, b"help", final=False)
            + frame(PING, b"between")
            + b"".join(frame(0, bytes([byte]), final=False) for byte in b" load")
            + frame(0, b"")
        )
        assert wire.message() == (PONG, b"between")
        assert wire.line().startswith(b"ok load ")
        assert wire.ask(b"") == b"error bad-line the line is empty; help lists the commands"

    def test_a_long_reply_and_a_long_request_arrive_whole(self):
        self.start()
        wire = self.connect()
        wire.ask(b"load beamfall seed=1")
        assert len(wire.ask(b"look rgb:hex")) == len("ok rgb=") + 2 * 3 * 160 * 210
        wire.send(b"look screen:raw ram:raw")
        assert wire.line() == b"ok screen=33600 ram=128 raw=33728"
        opcode, payload = wire.message()
        assert (opcode, len(payload)) == (BINARY, 33728)
        many = b"act" + b" NOOP" * 20000
        assert wire.ask(many).startswith(b"ok reward=")

    def test_requests_sent_ahead_are_answered_in_order(self):
        self.start()
        wire = self.connect()
        wire.write(
            b"".join(
                frame(TEXT, line) for line in [ENDLESS, b"observe acts"] + [b"act NOOP*%d" % n for n in range(1, 300)]
            )
        )
        wire.line(), wire.line()
        assert [wire.line() for _ in range(1, 300)] == [b"ok acts=%d" % n for n in range(1, 300)]

    def test_either_side_closes_in_good_order(self):
        self.start()
        wire = self.connect()
        wire.send(b"quit")
        assert wire.end() == (b"ok", 1000)
        wire = self.connect()
        wire.write(frame(CLOSE, struct.pack("!H", 1000)))
        assert wire.end() == (None, 1000)
        self.server.wait_for(r"client 2: 0 requests")
        wire = self.connect()
        wire.ask(b"load beamfall")
        self.server.process.send_signal(signal.SIGTERM)
        assert wire.end() == (b"error stopping the server stops", 1001)
        assert self.server.wait() == 0

    def test_idle_sessions_get_an_error_and_are_closed(self):
        self.start("--idle", "1")
        assert self.connect().end() == (b"error idle nothing came or went for 1 seconds", 1008)

    def test_a_session_whose_client_only_pings_is_not_idle(self):
        self.start("--idle", "2")
        wire, idle = self.connect(), self.connect()
        until = time.monotonic() + 4  # the subject: longer than the two seconds
        while time.monotonic() < until:
            wire.write(frame(PING, b"here"))
            assert wire.message() == (PONG, b"here")
            time.sleep(0.25)
        assert wire.ask(b"hello").startswith(b"ok ")
        assert idle.end()[1] == 1008

    def test_it_is_one_of_the_addresses(self):
        self.start("--ready-file", "ready", "--announce", "announce")
        assert self.server.addresses("ready") == [f"ws://127.0.0.1:{port_of(self.server)}"]

    def test_the_classic_protocol_is_refused(self):
        for options in (["--listen", "classic+ws://127.0.0.1:0"], ["--listen", "ws://127.0.0.1:0", "--classic"]):
            status, _, errors = run("serve", *options, "--rom", "builtin:beamfall")
            assert (status, len(errors)) == (2, 1), errors


class TestBesideThePage(Case):
    """Sessions on the port of --http."""

    def start(self, *options, listen="tcp://127.0.0.1:0"):
        return super().start("--http", "127.0.0.1:0", *options, listen=listen)

    def test_a_session_runs_and_counts_as_one(self):
        self.start("--max-sessions", "1", "--threads", "2")
        wire = self.connect("http")
        assert wire.ask(b"load beamfall").startswith(b"ok game=beamfall")
        assert b'racebeam_sessions_total{protocol="line"} 1\n' in self.get("/metrics", "http")[2]
        reply = self.refusal("http")
        assert reply.status == 503
        assert "there are 1 sessions" in reply.text
        assert wire.ask(b"act NOOP").startswith(b"ok ")

    def test_either_side_ends_a_session_in_good_order(self):
        self.start("--threads", "2")
        ends = (
            (lambda wire: wire.send(b"quit"), (b"ok", 1000)),
            (lambda wire: wire.write(frame(CLOSE, struct.pack("!H", 1000))), (None, 1000)),
            (lambda wire: self.server.process.send_signal(signal.SIGTERM), (b"error stopping the server stops", 1001)),
        )
        for number, (end, last) in enumerate(ends, 1):
            wire = self.connect("http")
            assert wire.ask(b"load beamfall").startswith(b"ok game=beamfall")
            end(wire)
            assert wire.end() == last
            wire.close()
            self.server.wait_for(rf"client {number}: (\d requests|closed)")
        assert self.server.wait() == 0

    def test_the_place_of_a_client_that_vanishes_is_free(self):
        self.start("--max-sessions", "1")
        wire = self.connect("http")
        assert wire.ask(b"load beamfall").startswith(b"ok ")
        wire.close()
        self.server.wait_for("client 1: 1 requests")
        assert self.connect("http").ask(b"load beamfall").startswith(b"ok ")

    def test_a_server_without_the_line_protocol_offers_no_session(self):
        self.start("--rom", "builtin:beamfall", listen="classic+tcp://127.0.0.1:0")
        assert self.refusal("http").status == 403

    def test_beyond_this_machine_sessions_need_tokens(self):
        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--http", "0.0.0.0:0") as server:
            port = int(server.wait_for(r"health and metrics on http://0\.0\.0\.0:(\d+)").group(1))
            with pytest.raises(Refused) as refused:
                WebSocket(port)
            assert refused.value.status == 403
            assert "--token-file" in refused.value.text
