"""The server's outputs for its operator: health, metrics, the log."""

import contextlib
import fcntl
import json
import os
import re
import select
import signal
import tempfile
import urllib.error
import urllib.request

import pytest
from harness import LOAD, PATIENCE, ask, connect_tcp, run, serve

F_SETPIPE_SZ = 1031  # fcntl has the name from Python 3.10 on


def get(url):
    try:
        with urllib.request.urlopen(url, timeout=PATIENCE) as response:
            return response.status, response.read().decode()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read().decode()


class TestHttp:
    def address(self, server):
        return server.wait_for(r"health and metrics on (http://127\.0\.0\.1:\d+)").group(1)

    def metrics(self, server):
        status, text = get(self.address(server) + "/metrics")
        assert status == 200
        return {
            key: float(value)
            for key, value in (line.rsplit(" ", 1) for line in text.splitlines() if not line.startswith("#"))
        }

    def test_health_and_readiness(self):
        with serve("--http", "127.0.0.1:0", "--grace", "60") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            address = self.address(server)
            assert get(address + "/healthz") == (200, "ok\n")
            assert get(address + "/readyz") == (200, "ready\n")
            assert get(address + "/nothing")[0] == 404
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop")
            assert get(address + "/healthz") == (200, "ok\n")
            assert get(address + "/readyz") == (503, "stopping\n")
            wire.close()
            assert server.wait() == 0

    def test_metrics_count_what_was_done(self):
        with serve("--http", "127.0.0.1:0", "--max-sessions", "1") as server:
            wire = connect_tcp(server.port())
            replies = len(wire.send(LOAD) or b"") + sum(len(wire.line()) for _ in range(3))
            replies += len(ask(wire, b"act NOOP*7")) + len(ask(wire, b"act 99")) + len(ask(wire, b"nonsense"))
            connection = connect_tcp(server.port())
            connection.rest()
            connection.close()
            found = self.metrics(server)
            count = len(LOAD) + len(b"act NOOP*7\nact 99\nnonsense\n")
            expected = {
                "sessions_open": 1,
                'sessions_total{protocol="line"}': 1,
                'sessions_refused_total{reason="busy"}': 1,
                "frames_total": 7,
                'requests_total{command="act",outcome="ok"}': 1,
                'requests_total{command="act",outcome="error"}': 1,
                'requests_total{command="none",outcome="error"}': 1,
                "request_seconds_count": 6,
                'request_seconds_bucket{le="+Inf"}': 6,
                "received_bytes_total": count,
                "sent_bytes_total": replies,
            }
            assert {key: found["racebeam_" + key] for key in expected} == expected
            buckets = [value for key, value in found.items() if "_bucket" in key]
            assert buckets == sorted(buckets)
            wire.close()

    def test_silent_connections_make_room_the_oldest_first(self):
        with serve("--http", "127.0.0.1:0") as server, contextlib.ExitStack() as stack:
            address = self.address(server)

            def connect():
                wire = connect_tcp(int(address.rsplit(":", 1)[1]))
                stack.callback(wire.close)
                return wire

            def is_healthy(wire):
                wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
                while (line := wire.line()) != b"\r\n":
                    assert re.search(b"^HTTP/1.1 200 OK|: ", line)
                return wire.line() == b"ok\n"

            busy = connect()
            connections = [connect() for _ in range(63)]
            slow = connections[1]
            slow.send(b"GET /healthz HTTP/1.1\r\n")  # half a request does not keep a place either
            assert is_healthy(connections[-1])  # the server has accepted all
            assert is_healthy(busy)  # from now on it is the latest
            for _ in range(2):
                assert get(address + "/healthz") == (200, "ok\n")
            extra = [connect() for _ in range(10)]
            assert all(is_healthy(wire) for wire in extra)
            assert is_healthy(busy)
            assert connections[0].rest() == b""
            assert slow.rest() == b""
            assert is_healthy(connections[-1])
            crowd = [connect() for _ in range(500)]
            assert get(address + "/healthz") == (200, "ok\n")
            assert crowd[0].rest() == b""

    def test_a_request_that_is_not_HTTP_harms_nobody(self):
        with serve("--http", "127.0.0.1:0") as server:
            address = self.address(server)
            for nonsense in (
                b"\0" * 1000,
                b"hello\n\n",
                b"POST / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n",
                b"GET / HTTP/1.1\r\nX: " + b"x" * 100000,
            ):
                wire = connect_tcp(int(address.rsplit(":", 1)[1]))
                try:
                    wire.send(nonsense)
                    wire.stop_sending()
                    wire.rest()
                except OSError:
                    pass
                wire.close()
            assert get(address + "/healthz") == (200, "ok\n")


class TestLog:
    def test_json_is_an_object_a_line(self):
        with serve("--log-format", "json") as server:
            port = int(server.wait_for(r"listening on tcp://127\.0\.0\.1:(\d+)").group(1))
            wire = connect_tcp(port)
            ask(wire, b"quit")
            wire.close()
            server.wait_for("1 requests")
            events = [json.loads(line) for line in server.log()]
            assert [event["event"] for event in events] == ["threads", "memory", "caches", "listening", "came", "left"]
            for event in events:
                assert re.search(r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$", event["time"])
                assert event["level"] == "info"

    def test_warnings_and_failures_of_the_start_are_objects_too(self):
        with tempfile.TemporaryDirectory() as folder:
            image = os.path.join(folder, "unknown.bin")
            with open(image, "wb") as file:
                file.write(bytes(range(256)) * 16)
            for words, status, level, hint in (
                (["--classic", "--stdio", "--rom", image], 0, "warning", "is not in the catalogue"),
                (["--classic", "--stdio", "--rom", image + "x"], 1, "error", "no such file"),
                (["--listen", "tcp://192.0.2.1:1"], 3, "error", "cannot listen on tcp://192.0.2.1:1"),
            ):
                ended, _, errors = run("serve", "--log-format", "json", *words)
                first = [json.loads(line) for line in errors][0]
                assert (ended, first["level"]) == (status, level)
                assert hint in first["message"]

    def test_a_standard_error_that_nobody_reads_holds_up_nobody(self):
        for log_format in ("text", "json"):
            reading, writing = os.pipe()
            fcntl.fcntl(writing, F_SETPIPE_SZ, 4096)
            with serve(
                "--http",
                "127.0.0.1:0",
                "--ready-file",
                "ready",
                "--log-format",
                log_format,
                "--grace",
                "0",
                errors=writing,
            ) as server:
                os.close(writing)
                addresses = server.addresses("ready")
                for _ in range(700):  # each comes and leaves: more than wait, and than fit into the pipe
                    wire = connect_tcp(int(addresses[0].rsplit(":", 1)[1]))
                    assert ask(wire, b"quit") == b"ok\n"
                    wire.rest()
                    wire.close()
                status, text = get(addresses[1] + "/metrics")
                losses = int(re.search(r"^racebeam_log_lines_lost_total (\d+)$", text, re.MULTILINE).group(1))
                assert losses > 200
                fcntl.fcntl(reading, F_SETPIPE_SZ, 1 << 20)
                lines = self.read(reading, b"client 700: 1 requests").splitlines()
                self.check_order(lines, losses)
                assert server.stop() == 0
            os.close(reading)

    def test_a_server_ends_though_nobody_reads_its_log(self):
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        with pytest.raises(BlockingIOError):
            while True:
                os.write(writing, b"x" * 4096)
        os.set_blocking(writing, True)
        with serve("--max-sessions", "100", "--ready-file", "ready", "--grace", "0", errors=writing) as server:
            wire = connect_tcp(int(server.addresses("ready")[0].rsplit(":", 1)[1]))
            assert ask(wire, b"quit") == b"ok\n"
            assert server.stop() == 0
            wire.close()
        os.close(writing)
        os.close(reading)

    def read(self, descriptor, last):
        text = b""
        while last not in text:
            assert select.select([descriptor], [], [], PATIENCE)[0], "the log does not go on"
            text += os.read(descriptor, 65536)
        return text

    def check_order(self, lines, lost):
        """The log has threads, memory, caches and two addresses, then clients that come and leave, in order. If lines
        are missing, it says how many."""
        notes = [match for match in (re.search(rb"(\d+) lines of the log are lost", line) for line in lines) if match]
        assert sum(int(note.group(1)) for note in notes) == lost
        assert len(lines) - len(notes) == 5 + 2 * 700 - lost
        events = [int(match.group(1)) for match in (re.search(rb"client (\d+): ", line) for line in lines) if match]
        assert events == sorted(events)

    def test_the_level_hides_what_is_below(self):
        with tempfile.TemporaryDirectory() as folder:
            ready = os.path.join(folder, "ready")
            with serve("--log-level", "warning", "--ready-file", ready, "--max-sessions", "1") as server:
                port = int(server.addresses(ready)[0].rsplit(":", 1)[1])
                wires = [connect_tcp(port) for _ in range(2)]
                wires[1].rest()
                server.wait_for("client 2: refused")
                assert len(server.log()) == 1
                assert re.search("^racebeam: warning: tcp://.* client 2: refused", server.log()[0])
                for wire in wires:
                    wire.close()
