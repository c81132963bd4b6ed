"""Operation of a server: limits, its end, the ready file, systemd's sockets."""

import os
import resource
import signal
import socket
import subprocess
import tempfile
import time
import unittest

from harness import (
    BINARY,
    GAME,
    LOAD,
    PATIENCE,
    Server,
    Wire,
    ask,
    connect_tcp,
    connect_unix,
    main,
    run,
    sanitized,
    serve,
    thread_sanitized,
)

FRAMES = 100 if thread_sanitized() else 1000
LONG = b"branch root " + b"NOOP*%d " % FRAMES * 100 + b"\n"  # 100,000 frames, or fewer where they take longer: a second


def load(wire, request=b""):
    """Loads a game, sends the request directly after it, and waits until only its reply is missing."""
    wire.send(LOAD + request)
    for _ in LOAD.splitlines():
        wire.line()


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

    def test_who_would_not_understand_it_is_turned_away_without_a_word(self):
        with Server("serve", "--listen", "classic+tcp://127.0.0.1:0", "--rom", GAME, "--max-sessions", "1") as server:
            wires = [connect_tcp(server.port()) for _ in range(2)]
            self.assertEqual(wires[0].line(), b"160-210\n")
            self.assertEqual(wires[1].rest(), b"")
            for wire in wires:
                wire.close()

    def test_a_long_request_is_not_idle(self):
        idle = 1
        with serve("--idle", str(idle), "--max-request-frames", "1000000000") as server:
            wire = connect_tcp(server.port())
            load(wire)
            sequences, took = 5, 0
            while took < 1.5 * idle:  # longer and longer requests, for any speed of the machine
                sequences *= 2
                start = time.monotonic()
                reply = ask(wire, b"branch root " + b"NOOP*%d " % FRAMES * sequences)
                took = time.monotonic() - start
                self.assertEqual(reply.count(b" |"), sequences)
            self.assertEqual(wire.rest(), b"error idle nothing came or went for 1 seconds\n")
            wire.close()

    def test_a_session_that_is_idle_is_told_so_and_closed(self):
        with serve("--idle", "2") as server:
            busy, idle, stuck = (connect_tcp(server.port()) for _ in range(3))
            stuck.send(LOAD + b"observe rgb:hex\n" + b"look\n" * 200)  # never read
            for _ in range(14):
                self.assertTrue(ask(busy, b"hello").startswith(b"ok "))
                time.sleep(0.25)  # far less than the two seconds, though the machine is busy
            self.assertTrue(idle.rest().startswith(b"error idle nothing came or went for 2 seconds"))
            server.wait_for("closed, it did not read")
            for wire in (busy, idle, stuck):
                wire.close()

    def test_each_limit_of_a_session_can_be_set_and_is_told(self):
        limits = {
            "--max-line": 300,
            "--max-machines": 2,
            "--max-states": 1,
            "--max-request-frames": 50,
            "--max-reply": 2000000,
        }
        words = [word for name, value in limits.items() for word in (name, str(value))]
        requests = (
            b"hello\nload beamfall sticky=0\nopen 3\nsave a\nsave b\nact NOOP*51\nact NOOP*50\n"
            + b"act "
            + b"x" * 300
            + b"\n"
        )
        lines = run("serve", "--stdio", *words, data=requests)[1].splitlines()
        self.assertIn(b"max_line=300 max_machines=2 max_states=1 max_request_frames=50 max_reply=2000000", lines[0])
        codes = [line.split()[1] if line.startswith(b"error") else b"ok" for line in lines]
        self.assertEqual(codes, [b"ok", b"ok", b"limit", b"ok", b"limit", b"limit", b"ok", b"line-too-long"])

    def test_nothing_that_is_there_is_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            os.symlink("/nowhere/file", os.path.join(folder, "link.gif"))
            lines = run("serve", "--stdio", "--record-dir", folder, data=b"load beamfall\nrecord gif link\n")[
                1
            ].splitlines()
            self.assertIn(b"error recording link.gif exists", lines[1])

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
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop: 1 sessions have 60 seconds")
            with self.assertRaises(OSError):
                connect_tcp(server.port())
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(ask(wire, b"act NOOP"), b"ok frame=1\n")
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_sessions_that_stay_are_told_when_the_grace_is_over(self):
        with serve("--grace", "2") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            start = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            wire.close()
            self.assertEqual(server.wait(), 0)
            self.assertGreater(time.monotonic() - start, 1.9)

    def test_who_is_in_the_middle_of_a_request_is_told_too(self):
        with serve("--grace", "0", "--max-request-frames", "10000000") as server:
            wire = connect_tcp(server.port())
            load(wire, b"branch root " + b"NOOP*1000 " * 5000 + b"\n")
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_who_is_in_the_middle_of_a_request_on_streams_is_told_too(self):
        with Server("serve", "--stdio", "--grace", "0", "--max-request-frames", "1000000000", streams=True) as server:
            wire = Wire(server.process.stdout.fileno(), server.process.stdin.fileno())
            load(
                wire, b"branch root " + b"NOOP*20000 " * 300 + b"\n"
            )  # short enough to be read with what comes before it
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.rest(), b"error stopping the server stops\n")
            self.assertEqual(server.wait(), 0)

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
            load(wire, LONG)
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(wire.line().count(b" |"), 100)
            self.assertEqual(server.wait(), 0)
            wire.close()

    def test_a_recording_is_kept(self):
        for transport in ("--stdio", "--listen=unix:s"):
            with (
                self.subTest(transport=transport),
                Server("serve", transport, "--record-dir", ".", "--grace", "0", streams=True) as server,
            ):
                wire = (
                    Wire(os.dup(server.process.stdout.fileno()), os.dup(server.process.stdin.fileno()))
                    if transport == "--stdio"
                    else server.wait_for("listening") and connect_unix(server.path("s"))
                )
                wire.send(b"load beamfall\nrecord y4m film\nact NOOP*10\n")
                for _ in range(3):
                    wire.line()
                self.assertEqual(server.stop(), 0)
                self.assertGreater(os.path.getsize(server.path("film.y4m")), 320 * 210 * 10)
                wire.close()


class Together(unittest.TestCase):
    def test_both_protocols_on_streams_and_sockets(self):
        with Server(
            "serve",
            "--stdio",
            "--listen",
            "unix:line",
            "--listen",
            "classic+unix:classic",
            "--rom",
            GAME,
            "--pipes",
            "p",
            "--ready-file",
            "ready",
            streams=True,
        ) as server:
            server.wait_for("listening on unix:classic")
            self.assertEqual(server.addresses("ready"), ["unix:line", "classic+unix:classic", "stdio", "pipes:p"])
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


FIRST_LINE = "# racebeam ready file: the addresses of a server, one a line; lines that begin with # are comments\n"


class ReadyFile(unittest.TestCase):
    def test_a_file_that_is_not_a_ready_file_is_refused_and_stays(self):
        def file(path, text):
            with open(path, "w") as notes:
                notes.write(text)

        kinds = {
            "notes": lambda path: file(path, "tcp://127.0.0.1:1\n"),
            "empty": lambda path: file(path, ""),
            "near": lambda path: file(path, FIRST_LINE[:15]),
            "other": lambda path: file(path, "# racebeam ready file: x\n"),
            "long": lambda path: file(path, FIRST_LINE[:-1] + " of a kind\n"),
            "pipe": os.mkfifo,
            "folder": os.mkdir,
            "device": lambda path: os.symlink("/dev/null", path),
            "link": lambda path: os.symlink("ready", path),
        }

        def marks(path):  # all but the time of the last access
            found = os.lstat(path)
            return found.st_ino, found.st_mode, found.st_size, found.st_mtime_ns

        for kind, make in kinds.items():
            for where in (["--stdio"], ["--listen", "tcp://127.0.0.1:0"]):
                with self.subTest(kind=kind, where=where[0]), tempfile.TemporaryDirectory() as folder:
                    file(os.path.join(folder, "ready"), FIRST_LINE)
                    path = os.path.join(folder, kind)
                    make(path)
                    before = marks(path)
                    status, output, errors = run("serve", *where, "--ready-file", path)
                    self.assertEqual((status, output, len(errors)), (1, b"", 1), errors)
                    self.assertIn(f"--ready-file {path} exists, and is not a ready file", errors[0])
                    self.assertEqual(marks(path), before)

    def test_a_stale_one_is_gone_before_anything_else_is_looked_at(self):
        for words in (["--listen", "unix:/nowhere/s"], ["--stdio", "--roms", "/nowhere"], ["--classic", "--stdio"]):
            with self.subTest(words=words), tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "ready")
                with open(path, "w") as stale:
                    stale.write(FIRST_LINE + "tcp://127.0.0.1:1\n")
                status, _, errors = run("serve", *words, "--ready-file", path)
                self.assertNotEqual(status, 0, errors)
                self.assertEqual(os.listdir(folder), [])

    def test_the_file_of_a_killed_server_is_stale(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with serve("--ready-file", path) as server:
                server.addresses(path)
                server.process.kill()
                server.wait()
            self.assertTrue(os.path.exists(path))
            run("serve", "--stdio", "--roms", "/nowhere", "--ready-file", path)
            self.assertFalse(os.path.exists(path))

    def test_it_is_gone_as_soon_as_the_server_is_told_to_stop(self):
        with serve("--ready-file", "ready", "--grace", "60") as server:
            server.addresses("ready")
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop")
            self.assertFalse(os.path.exists(server.path("ready")))
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            wire.close()
            self.assertEqual(server.wait(), 0)

    def test_it_appears_whole_with_the_real_ports(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with open(path, "w") as stale:
                stale.write(FIRST_LINE + "tcp://127.0.0.1:1\n")
            with Server(
                "serve", "--listen", "tcp://127.0.0.1:0", "--http", "127.0.0.1:0", "--ready-file", path
            ) as server:
                port = server.port()
                server.wait_for("health and metrics")
                lines = server.addresses(path)
                self.assertEqual(lines[0], f"tcp://127.0.0.1:{port}")
                with open(path) as ready:
                    self.assertTrue(ready.read().startswith(FIRST_LINE))
                self.assertRegex(lines[1], r"^http://127\.0\.0\.1:\d+$")
                self.assertEqual(server.stop(), 0)
            self.assertEqual(os.listdir(folder), [])

    def test_the_file_of_a_successor_stays(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with serve("--ready-file", path) as server:
                server.addresses(path)
                with serve("--ready-file", path) as heir:
                    heir.wait_for(f"warning: the ready file {path} of another server, which runs, is replaced")
                    mine = heir.port()
                    while True:
                        try:
                            with open(path) as ready:
                                if f":{mine}" in ready.read():
                                    break
                        except FileNotFoundError:
                            pass
                    status, _, errors = run(
                        "serve", "--listen", "tcp://127.0.0.1:0", "--http", f"127.0.0.1:{mine}", "--ready-file", path
                    )
                    self.assertEqual((status, os.path.exists(path)), (3, True), errors)
                    self.assertEqual(server.stop(), 0)
                    self.assertTrue(os.path.exists(path))
                    self.assertEqual(heir.stop(), 0)
                    self.assertFalse(os.path.exists(path))

    def test_one_that_cannot_be_written_is_an_error(self):
        status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--ready-file", "nowhere/ready")
        self.assertEqual((status, "cannot write the ready file nowhere/ready" in errors[-1]), (1, True), errors)
        with Server("serve", "--stdio", "--ready-file", "nowhere/ready", streams=True) as server:
            self.assertEqual(server.wait(), 1)  # though its input is open


class UntilIdle(unittest.TestCase):
    def test_a_server_without_sessions_ends(self):
        with serve("--until-idle", "1", "--ready-file", "ready") as server:
            self.assertEqual(server.wait(), 0)
            server.wait_for("no session for 1 seconds: 0 sessions have 5 seconds to end")
            self.assertFalse(os.path.exists(server.path("ready")))

    def test_a_session_keeps_it_alive_and_a_short_one_begins_the_time_anew(self):
        with serve("--until-idle", "2") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            time.sleep(3)
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
            wire.close()
            for _ in range(3):  # each is over before the server looks
                time.sleep(1)
                wire = connect_tcp(server.port())
                ask(wire, b"quit")
                wire.close()
            ended = time.monotonic()
            self.assertEqual(server.wait(), 0)
            self.assertGreater(time.monotonic() - ended, 1.5)


class Memory(unittest.TestCase):
    def test_the_log_says_how_much_memory_and_what_limits_it(self):
        with serve("--max-memory", "512M") as server:
            server.wait_for(f"memory: {512 << 20} bytes, limited by --max-memory$")
        with serve() as server:
            server.wait_for("memory: [0-9]+ bytes, limited by the (machine|control group)$")

    @unittest.skipIf(sanitized() or thread_sanitized(), "a sanitizer needs more memory")
    def test_a_server_with_little_memory_has_small_caches(self):
        for memory, caches in (
            ("64M", "28 resets, 699050 bytes"),
            ("512M", "128 resets, 4194304 bytes"),
            ("24M", "10 resets, 262144 bytes"),
        ):
            with self.subTest(memory=memory), serve("--max-memory", memory) as server:
                server.wait_for(f"caches: {caches} of code for an image, [0-9]+ for all$")
                wire = connect_tcp(server.port())
                self.assertTrue(ask(wire, b"load beamfall").startswith(b"ok "))
                wire.close()


@unittest.skipIf(sanitized(), "the sanitizer's own checks fail when there are no descriptors left")
class Files(unittest.TestCase):
    """A server that may open few files, all of which its clients take."""

    FILES = 80

    def setUp(self):
        self.server = Server(
            "serve",
            "--listen",
            "tcp://127.0.0.1:0",
            "--http",
            "127.0.0.1:0",
            "--grace",
            "0",
            before=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (self.FILES, self.FILES)),
        )
        self.addCleanup(self.server.__exit__)
        self.port = self.server.port()
        self.http = int(self.server.wait_for(r"health and metrics on http://127\.0\.0\.1:(\d+)$").group(1))

    def connect(self, port):
        wire = connect_tcp(port)
        self.addCleanup(wire.close)
        return wire

    def check_health(self):
        wire = self.connect(self.http)
        wire.send(b"GET /healthz HTTP/1.0\r\n\r\n")
        self.assertTrue(wire.rest().endswith(b"\r\n\r\nok\n"))

    def test_there_are_no_more_sessions_than_files_and_others_are_told(self):
        most = int(self.server.wait_for(r"sessions: (\d+), limited by the open files \(ulimit -n\)$").group(1))
        self.assertEqual(most, self.FILES // 2)
        wires = [self.connect(self.port) for _ in range(most)]
        for wire in wires:
            self.assertTrue(ask(wire, b"hello").startswith(b"ok "))
        self.assertTrue(self.connect(self.port).rest().startswith(b"error busy there are 40 sessions"))
        self.check_health()
        self.assertTrue(ask(wires[0], b"load beamfall").startswith(b"ok "))

    def test_health_is_told_where_no_file_is_left(self):
        for _ in range(2 * self.FILES):
            self.connect(self.port)
        for _ in range(3):
            self.check_health()
        silent = [self.connect(self.http) for _ in range(70)]
        for _ in range(3):
            self.check_health()
        self.assertLess(sum("cannot take a client" in line for line in self.server.log()), 20)
        self.assertEqual(silent[0].rest(), b"")


class Threads(unittest.TestCase):
    def test_the_log_says_how_many_and_what_limits_them(self):
        with serve("--threads", "3") as server:
            server.wait_for("threads: 3, limited by --threads$")
        with serve() as server:
            server.wait_for("threads: [0-9]+, limited by the (machine|affinity|control group)$")


@unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "there is one processor")
class Allowance(unittest.TestCase):
    """What the system allows to a process."""

    def log_of(self, join):
        """The log of a server whose process calls `join` first."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [BINARY, "serve", "--listen", "unix:s", "--until-idle", "1"],
                cwd=folder,
                capture_output=True,
                text=True,
                timeout=PATIENCE,
                preexec_fn=join,
            )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def group(self, controller, limits):
        """A new control group with a limit, of the version that this machine has. limits: a file's name and text for
        either."""
        for folder, (name, text) in zip((f"/sys/fs/cgroup/{controller}", "/sys/fs/cgroup"), limits):
            group = os.path.join(folder, f"racebeam-test-{os.getpid()}")
            try:
                os.mkdir(group)
            except OSError:
                continue
            self.addCleanup(os.rmdir, group)
            if os.path.exists(os.path.join(group, name)):
                with open(os.path.join(group, name), "w") as file:
                    file.write(text)
                return os.path.join(group, "cgroup.procs")
        self.skipTest(f"there can be no control group for {controller} here")

    def join(self, processes):
        with open(processes, "w") as file:
            file.write("0")

    def test_the_affinity_limits_the_threads(self):
        processor = min(os.sched_getaffinity(0))
        self.assertIn(
            "threads: 1, limited by the affinity\n", self.log_of(lambda: os.sched_setaffinity(0, {processor}))
        )

    def test_a_control_group_limits_the_threads(self):
        processes = self.group("cpu", (("cpu.cfs_quota_us", "100000"), ("cpu.max", "100000 100000")))
        self.assertIn("threads: 1, limited by the control group\n", self.log_of(lambda: self.join(processes)))

    @unittest.skipIf(sanitized() or thread_sanitized(), "a sanitizer needs more memory")
    def test_a_control_group_limits_memory_and_caches(self):
        processes = self.group("memory", (("memory.limit_in_bytes", str(200 << 20)), ("memory.max", str(200 << 20))))
        log = self.log_of(lambda: self.join(processes))
        self.assertIn(f"memory: {150 << 20} bytes, limited by the control group\n", log)
        self.assertIn("caches: 66 resets, 1638400 bytes of code for an image, 4964352 for all\n", log)


class Systemd(unittest.TestCase):
    """The convention of systemd, played by the test: sockets from descriptor 3 on, and variables that name
    this process."""

    def start(self, folder, options, names="line:classic"):
        sockets = [socket.socket(socket.AF_UNIX) for _ in range(2)]
        for number, listener in enumerate(sockets):
            listener.bind(os.path.join(folder, f"s{number}"))
            listener.listen()
        fds = [listener.fileno() for listener in sockets]
        script = "".join(f"os.dup2({fd}, {20 + place}); " for place, fd in enumerate(fds))
        script += "".join(f"os.dup2({20 + place}, {3 + place}); " for place in range(2))
        script = (
            f"import os, sys; {script} os.environ['LISTEN_PID'] = str(os.getpid()); os.execv(sys.argv[1], sys.argv[1:])"
        )
        notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        notify.bind(os.path.join(folder, "notify"))
        notify.settimeout(PATIENCE)
        environment = {
            **os.environ,
            "LISTEN_FDS": "2",
            "LISTEN_FDNAMES": names,
            "NOTIFY_SOCKET": os.path.join(folder, "notify"),
        }
        process = subprocess.Popen(
            ["python3", "-c", script, BINARY, "serve", *options], env=environment, pass_fds=fds, stderr=subprocess.PIPE
        )
        for listener in sockets:
            listener.close()
        return process, notify

    def test_its_sockets_are_served_and_it_is_notified(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(
                folder, ["--listen", "systemd:line", "--listen", "classic+systemd:classic", "--rom", GAME]
            )
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


if __name__ == "__main__":
    main()
