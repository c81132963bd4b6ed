"""What those who run a server rely on: limits, the end, health, metrics, the ready file, systemd's sockets, the log."""

import json
import os
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request

from harness import BINARY, GAME, PATIENCE, Server, Wire, connect_tcp, connect_unix, main, run

LOAD = b"load beamfall seed=1 sticky=0 max_episode_frames=0\nsave root\nobserve frame\n"
LONG = b"branch root " + b"NOOP*400,FIRE*600 " * 100 + b"\n"  # 100,000 frames: seconds


def serve(*options):
    return Server("serve", "--listen", "tcp://127.0.0.1:0", *options)


def ask(wire, request):
    wire.send(request + b"\n")
    return wire.line()


class Limits(unittest.TestCase):
    def test_a_session_too_many_is_told_so(self):
        with serve("--max-sessions", "2") as server:
            wires = [connect_tcp(server.port()) for _ in range(2)]
            for wire in wires:
                self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            refused = connect_tcp(server.port())
            self.assertTrue(refused.rest().startswith(b"error busy there are 2 sessions"))
            wires.pop().close()
            server.wait_for("1 requests")
            wires.append(connect_tcp(server.port()))
            self.assertTrue(ask(wires[-1], b"hello").startswith(b"ok "))
            for wire in (refused, *wires):
                wire.close()

    def test_a_session_that_is_idle_is_told_so_and_closed(self):
        with serve("--idle", "1") as server:
            busy, idle, stuck = (connect_tcp(server.port()) for _ in range(3))
            stuck.send(LOAD + b"observe rgb:hex\n" + b"look\n" * 200)  # never read
            for _ in range(8):
                self.assertTrue(ask(busy, b"hello").startswith(b"ok "))
                time.sleep(0.25)
            self.assertTrue(idle.rest().startswith(b"error idle nothing came or went for 1 seconds"))
            server.wait_for("closed, it did not read")
            for wire in (busy, idle, stuck):
                wire.close()

    def test_each_limit_of_a_session_can_be_set_and_is_told(self):
        limits = {"--max-line": 300, "--max-machines": 2, "--max-states": 1, "--max-request-frames": 50}
        words = [word for name, value in limits.items() for word in (name, str(value))]
        requests = (b"hello\nload beamfall sticky=0\nopen 3\nsave a\nsave b\nact NOOP*51\nact NOOP*50\n" +
                    b"act " + b"x" * 300 + b"\n")
        lines = run("serve", "--stdio", *words, data=requests)[1].splitlines()
        self.assertIn(b"max_line=300 max_machines=2 max_states=1 max_request_frames=50", lines[0])
        codes = [line.split()[1] if line.startswith(b"error") else b"ok" for line in lines]
        self.assertEqual(codes, [b"ok", b"ok", b"bad-value", b"ok", b"limit", b"limit", b"ok", b"line-too-long"])

    def test_a_recording_ends_at_its_limit(self):
        with tempfile.TemporaryDirectory() as folder:
            requests = b"load beamfall sticky=0\nrecord y4m film\nact NOOP*60\nrecord stop\nact NOOP\n"
            lines = run("serve", "--stdio", "--record-dir", folder, "--record-limit", "1000000",
                        data=requests)[1].splitlines()
            self.assertIn(b"error recording the recording has reached its limit of 1000000 bytes", lines[3])
            self.assertTrue(lines[4].startswith(b"ok "))
            self.assertEqual(os.listdir(folder), [])

    def test_there_is_no_way_to_a_path(self):
        with tempfile.TemporaryDirectory() as folder:
            inside = os.path.join(folder, "inside")
            os.mkdir(inside)
            for name in ("../out", "/etc/passwd", "..", ".", "a/b", "", ".hidden"):
                requests = f"load beamfall\nrecord y4m {name}\nload {name or '/'}\nload ../{name}\n".encode()
                lines = run("serve", "--stdio", "--record-dir", inside, "--roms", inside, data=requests)[1].splitlines()
                self.assertTrue(all(line.startswith(b"error ") for line in lines[1:]), lines[1:])
            self.assertEqual((os.listdir(folder), os.listdir(inside)), (["inside"], []))


class Stopping(unittest.TestCase):
    def test_requests_under_way_are_finished(self):
        with serve("--grace", "60") as server:
            wire = connect_tcp(server.port())
            wire.send(LOAD + LONG)
            for _ in range(3):
                wire.line()
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop: 1 sessions have 60 seconds")
            with self.assertRaises(OSError):
                connect_tcp(server.port())
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(ask(wire, b"act NOOP"), b"ok frame=1\n")
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_sessions_that_stay_are_told_when_the_grace_is_over(self):
        with serve("--grace", "1") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            start = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            wire.close()
            self.assertEqual(server.wait(), 0)
            self.assertGreater(time.monotonic() - start, 0.9)

    def test_a_second_signal_ends_the_grace(self):
        with serve("--grace", "1000") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            server.process.send_signal(signal.SIGINT)
            server.wait_for("told to stop")
            self.assertEqual(server.stop(signal.SIGINT), 0)
            wire.close()

    def test_a_session_on_streams_finishes_its_request(self):
        with Server("serve", "--stdio", "--grace", "60", streams=True) as server:
            wire = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            wire.send(LOAD + LONG)
            for _ in range(3):
                wire.line()
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(server.wait(), 0)
            wire.close()

    def test_a_recording_is_kept(self):
        for transport in ("--stdio", "--listen=unix:s"):
            with self.subTest(transport=transport), Server("serve", transport, "--record-dir", ".", "--grace", "0",
                                                           streams=True) as server:
                wire = (Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
                        if transport == "--stdio" else server.wait_for("listening") and connect_unix(server.path("s")))
                wire.send(b"load beamfall\nrecord y4m film\nact NOOP*10\n")
                for _ in range(3):
                    wire.line()
                self.assertEqual(server.stop(), 0)
                self.assertGreater(os.path.getsize(server.path("film.y4m")), 320 * 210 * 10)
                wire.close()


class Together(unittest.TestCase):
    def test_both_protocols_on_streams_and_sockets(self):
        with Server("serve", "--stdio", "--listen", "unix:line", "--listen", "classic+unix:classic", "--rom", GAME,
                    "--pipes", "p", "--ready-file", "ready", streams=True) as server:
            server.wait_for("listening on unix:classic")
            deadline = time.monotonic() + PATIENCE
            while not os.path.exists(server.path("ready")) and time.monotonic() < deadline:
                time.sleep(0.01)
            with open(server.path("ready")) as ready:
                self.assertEqual(ready.read(), "unix:line\nclassic+unix:classic\nstdio\npipes:p\n")
            line, classic = connect_unix(server.path("line")), connect_unix(server.path("classic"))
            self.assertEqual(classic.line(), b"160-210\n")
            self.assertTrue(ask(line, b"hello").startswith(b"ok server="))
            streams = Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
            server.process.stdin.close()
            self.assertTrue(ask(streams, b"hello").startswith(b"ok server="))
            streams.stop_sending()
            server.process.stdout.close()
            self.assertTrue(ask(line, b"hello").startswith(b"ok server="))  # the server outlives its streams
            for wire in (line, classic):
                wire.close()
            self.assertEqual(server.stop(), 0)
            self.assertFalse(os.path.exists(server.path("ready")))
            streams.close()


class ReadyFile(unittest.TestCase):
    def test_it_appears_whole_with_the_real_ports(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with open(path, "w") as stale:
                stale.write("tcp://127.0.0.1:1\n")
            with Server("serve", "--listen", "tcp://127.0.0.1:0", "--http", "127.0.0.1:0", "--ready-file", path) as server:
                port = server.port()
                server.wait_for("health and metrics")
                deadline = time.monotonic() + PATIENCE
                while not os.path.exists(path) and time.monotonic() < deadline:
                    time.sleep(0.01)
                with open(path) as ready:
                    lines = ready.read().splitlines()
                self.assertEqual(lines[0], f"tcp://127.0.0.1:{port}")
                self.assertRegex(lines[1], r"^http://127\.0\.0\.1:\d+$")
                self.assertEqual(server.stop(), 0)
            self.assertEqual(os.listdir(folder), [])

    def test_one_that_cannot_be_written_is_an_error(self):
        status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--ready-file", "nowhere/ready")
        self.assertEqual((status, "cannot write the ready file nowhere/ready" in errors[-1]), (1, True), errors)


class Systemd(unittest.TestCase):
    """By its convention, played by the test: sockets from descriptor 3 on, and variables that name this process."""

    def start(self, folder, options, names="line:classic"):
        sockets = [socket.socket(socket.AF_UNIX) for _ in range(2)]
        for number, listener in enumerate(sockets):
            listener.bind(os.path.join(folder, f"s{number}"))
            listener.listen()
        fds = [listener.fileno() for listener in sockets]
        script = "".join(f"os.dup2({fd}, {20 + place}); " for place, fd in enumerate(fds))
        script += "".join(f"os.dup2({20 + place}, {3 + place}); " for place in range(2))
        script = f"import os, sys; {script} os.environ['LISTEN_PID'] = str(os.getpid()); os.execv(sys.argv[1], sys.argv[1:])"
        notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        notify.bind(os.path.join(folder, "notify"))
        notify.settimeout(PATIENCE)
        environment = {**os.environ, "LISTEN_FDS": "2", "LISTEN_FDNAMES": names,
                       "NOTIFY_SOCKET": os.path.join(folder, "notify")}
        process = subprocess.Popen(["python3", "-c", script, BINARY, "serve", *options], env=environment, pass_fds=fds,
                                   stderr=subprocess.PIPE)
        for listener in sockets:
            listener.close()
        return process, notify

    def test_its_sockets_are_served_and_it_is_notified(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(folder, ["--listen", "systemd:line", "--listen", "classic+systemd:classic",
                                                  "--rom", GAME])
            self.assertEqual(notify.recv(100), b"READY=1")
            line, classic = (connect_unix(os.path.join(folder, name)) for name in ("s0", "s1"))
            self.assertTrue(ask(line, b"hello").startswith(b"ok "))
            self.assertEqual(classic.line(), b"160-210\n")
            for wire in (line, classic):
                wire.close()
            process.send_signal(signal.SIGTERM)
            self.assertEqual(notify.recv(100), b"STOPPING=1")
            self.assertEqual(process.wait(PATIENCE), 0)
            self.assertTrue(os.path.exists(os.path.join(folder, "s0")))  # systemd's, not ours to remove
            process.stderr.close()
            notify.close()

    def test_what_it_did_not_pass_on_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(folder, ["--listen", "systemd:other"])
            self.assertIn(b"no socket of the name 'other'", process.communicate(timeout=PATIENCE)[1])
            self.assertEqual(process.returncode, 1)
            notify.close()
        status, _, errors = run("serve", "--listen", "systemd")
        self.assertEqual((status, len(errors)), (1, 1), errors)
        self.assertIn("systemd has passed on no socket", errors[0])


class Http(unittest.TestCase):
    def address(self, server):
        return server.wait_for(r"health and metrics on (http://127\.0\.0\.1:\d+)").group(1)

    def get(self, url):
        try:
            with urllib.request.urlopen(url, timeout=PATIENCE) as response:
                return response.status, response.read().decode()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode()

    def metrics(self, server):
        status, text = self.get(self.address(server) + "/metrics")
        self.assertEqual(status, 200)
        return {key: float(value) for key, value in
                (line.rsplit(" ", 1) for line in text.splitlines() if not line.startswith("#"))}

    def test_health_and_readiness(self):
        with serve("--http", "127.0.0.1:0", "--grace", "60") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            address = self.address(server)
            self.assertEqual(self.get(address + "/healthz"), (200, "ok\n"))
            self.assertEqual(self.get(address + "/readyz"), (200, "ready\n"))
            self.assertEqual(self.get(address + "/nothing")[0], 404)
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop")
            self.assertEqual(self.get(address + "/healthz"), (200, "ok\n"))
            self.assertEqual(self.get(address + "/readyz"), (503, "stopping\n"))
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_metrics_count_what_was_done(self):
        with serve("--http", "127.0.0.1:0", "--max-sessions", "1") as server:
            wire = connect_tcp(server.port())
            replies = len(wire.send(LOAD) or b"") + sum(len(wire.line()) for _ in range(3))
            replies += len(ask(wire, b"act NOOP*7")) + len(ask(wire, b"act 99")) + len(ask(wire, b"nonsense"))
            refused = connect_tcp(server.port())
            refused.rest()
            refused.close()
            found = self.metrics(server)
            sent = len(LOAD) + len(b"act NOOP*7\nact 99\nnonsense\n")
            expected = {"sessions_open": 1, 'sessions_total{protocol="line"}': 1,
                        'sessions_refused_total{reason="busy"}': 1, "frames_total": 7,
                        'requests_total{command="act",outcome="ok"}': 1,
                        'requests_total{command="act",outcome="error"}': 1,
                        'requests_total{command="none",outcome="error"}': 1,
                        "request_seconds_count": 6, 'request_seconds_bucket{le="+Inf"}': 6,
                        "received_bytes_total": sent, "sent_bytes_total": replies}
            self.assertEqual({key: found["racebeam_" + key] for key in expected}, expected)
            buckets = [value for key, value in found.items() if "_bucket" in key]
            self.assertEqual(buckets, sorted(buckets))
            wire.close()

    def test_what_is_no_HTTP_harms_nobody(self):
        with serve("--http", "127.0.0.1:0") as server:
            address = self.address(server)
            for nonsense in (b"\0" * 1000, b"hello\n\n", b"POST / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n",
                             b"GET / HTTP/1.1\r\nX: " + b"x" * 100000):
                wire = connect_tcp(int(address.rsplit(":", 1)[1]))
                try:
                    wire.send(nonsense)
                    wire.stop_sending()
                    wire.rest()
                except OSError:
                    pass
                wire.close()
            self.assertEqual(self.get(address + "/healthz"), (200, "ok\n"))


class Log(unittest.TestCase):
    def test_json_is_an_object_a_line(self):
        with serve("--log-format", "json") as server:
            port = int(server.wait_for(r"listening on tcp://127\.0\.0\.1:(\d+)").group(1))
            wire = connect_tcp(port)
            ask(wire, b"quit")
            wire.close()
            server.wait_for("1 requests")
            events = [json.loads(line) for line in server.log()]
            self.assertEqual([event["event"] for event in events], ["listening", "came", "left"])
            for event in events:
                self.assertRegex(event["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")
                self.assertEqual(event["level"], "info")

    def test_the_level_hides_what_is_below(self):
        with tempfile.TemporaryDirectory() as folder:
            ready = os.path.join(folder, "ready")
            with serve("--log-level", "warning", "--ready-file", ready, "--max-sessions", "1") as server:
                deadline = time.monotonic() + PATIENCE
                while not os.path.exists(ready) and time.monotonic() < deadline:
                    time.sleep(0.01)
                with open(ready) as file:
                    port = int(file.read().rsplit(":", 1)[1])
                wires = [connect_tcp(port) for _ in range(2)]
                wires[1].rest()
                self.assertEqual(len(server.log()), 1)
                self.assertRegex(server.log()[0], "^racebeam: warning: tcp://.* client 2: refused")
                for wire in wires:
                    wire.close()


if __name__ == "__main__":
    main()
