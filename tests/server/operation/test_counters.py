"""What the metrics and the log say of sessions that the server refuses or ends, and why."""

import json
import os
import sys
import urllib.request

import pytest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "access"))
from access_case import OTHER, TOKEN, Folder, make_certificate
from harness import GAME, PATIENCE, ask, connect_tcp, serve

WRONG, RIGHT = b"hello token=" + OTHER.encode(), b"hello token=" + TOKEN.encode()


def metrics(server):
    address = server.wait_for(r"health and metrics on (http://127\.0\.0\.1:\d+)$").group(1)
    with urllib.request.urlopen(address + "/metrics", timeout=PATIENCE) as response:
        lines = [line for line in response.read().decode().splitlines() if not line.startswith("#")]
    return {key.removeprefix("racebeam_"): float(value) for key, value in (line.rsplit(" ", 1) for line in lines)}


@pytest.mark.usefixtures("self_cleanup")
class TestCounters(Folder):
    def start(self, *options):
        self.server = serve("--http", "127.0.0.1:0", "--threads", "1", *options)
        self.cleanup(self.server.__exit__)

    def connect(self, port=None):
        wire = connect_tcp(port or self.server.port())
        self.cleanup(wire.close)
        return wire

    def counted(self):
        """The counters of sessions and tokens that are not 0."""
        found = metrics(self.server)
        return {key: value for key, value in found.items() if key.startswith(("sessions_", "wrong_")) and value}

    def test_each_session_counts_for_its_protocol(self):
        self.start("--listen", "classic+tcp://127.0.0.1:0", "--rom", GAME, "--ready-file", "ready")
        classic = int(self.server.addresses("ready")[1].removeprefix("classic+tcp://127.0.0.1:"))
        for _ in range(2):
            assert self.connect(classic).line() == b"160-210\n"
        ask(self.connect(), b"hello")
        assert self.counted() == {
            "sessions_open": 3,
            'sessions_total{protocol="line"}': 1,
            'sessions_total{protocol="classic"}': 2,
        }

    def test_a_session_that_was_idle(self):
        self.start("--idle", "1")
        assert self.connect().rest().startswith(b"error idle ")
        assert self.counted() == {'sessions_total{protocol="line"}': 1, 'sessions_ended_total{reason="idle"}': 1}

    def test_wrong_tokens_and_a_session_without_the_right_one(self):
        self.start("--token-file", self.write("tokens", TOKEN), "--handshake", "1")
        wire = self.connect()
        for _ in range(2):
            assert ask(wire, WRONG).startswith(b"error unauthorized the token is not")
        assert wire.rest() == b"error unauthorized no right token came within 1 seconds\n"
        assert self.counted() == {
            'sessions_total{protocol="line"}': 1,
            'sessions_ended_total{reason="handshake"}': 1,
            "wrong_tokens_total": 2,
        }

    def test_a_session_that_made_room_for_another_one(self):
        self.start("--token-file", self.write("tokens", TOKEN), "--max-sessions", "1")
        silent = self.connect()
        assert b" admitted=0 " in ask(silent, b"hello")
        assert ask(self.connect(), RIGHT).startswith(b"ok ")
        assert silent.rest().startswith(b"error busy ")
        assert self.counted() == {
            "sessions_open": 1,
            'sessions_total{protocol="line"}': 2,
            'sessions_ended_total{reason="busy"}': 1,
        }

    def test_a_client_that_speaks_no_TLS(self):
        certificate, key = make_certificate(self.folder)
        self.start("--listen", "tls://127.0.0.1:0", "--tls-cert", certificate, "--tls-key", key)
        wire = self.connect(int(self.server.wait_for(r"listening on tls://127\.0\.0\.1:(\d+)$").group(1)))
        wire.send(b"hello\n" * 10)
        wire.rest()
        self.server.wait_for("client 1: TLS handshake failed: ")
        counted = self.counted()
        assert counted['sessions_refused_total{reason="tls"}'] == 1
        assert 'sessions_refused_total{reason="busy"}' not in counted


class TestLog(Folder):
    def test_events_of_a_client_name_it_and_a_wrong_token_its_address(self):
        options = ("--token-file", self.write("tokens", TOKEN), "--log-format", "json", "--max-sessions", "9")
        with serve(*options) as server:
            port = int(server.wait_for(r"listening on tcp://127\.0\.0\.1:(\d+)").group(1))
            wire = connect_tcp(port)
            ask(wire, WRONG)
            ask(wire, b"quit")
            wire.close()
            server.wait_for("2 requests")
            events = [json.loads(line) for line in server.log()]
        client = f"tcp://127.0.0.1:{port} client 1"
        found = [(event["event"], event["level"], event.get("address")) for event in events if "client" in event]
        assert found == [
            ("came", "info", None),
            ("wrong-token", "warning", "127.0.0.1"),
            ("left", "info", None),
        ]
        assert {event["client"] for event in events if "client" in event} == {client}

    def test_a_stop_is_an_event(self):
        with serve("--log-format", "json") as server:
            server.wait_for("listening on")
            assert server.stop() == 0
            last = json.loads(server.log()[-1])
        assert (last["event"], last["level"]) == ("stopping", "info")
        assert last["message"] == "told to stop: 0 sessions have 5 seconds to end"

    @pytest.mark.needs_posix
    def test_a_line_has_the_first_1000_characters_of_a_sentence_and_all_are_printable(self):
        folder = os.path.join(self.folder, *(["\u00e9" * 120] * 4))
        os.makedirs(folder)
        path = os.path.join(folder, "tokens")
        with open(path, "w") as file:
            file.write(TOKEN)
        os.chmod(path, 0o644)
        with serve("--token-file", path) as server:
            server.wait_for("listening on")
            warning = next(line for line in server.log() if "every user of this machine" in line)
        start = "every user of this machine can read the tokens in "
        assert len(start + path) < 1000 < len((start + path).encode())
        assert warning == "racebeam: warning: " + (start + path.replace("\u00e9", "??"))[:1000]
