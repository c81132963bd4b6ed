"""Memory, open files, threads and processors of a server."""

import os
import resource
import subprocess
import tempfile

import pytest
from harness import (
    BINARY,
    PATIENCE,
    Server,
    ask,
    connect_tcp,
    connect_unix,
    sanitized,
    serve,
    thread_sanitized,
)


class TestMemory:
    def test_the_log_says_how_much_memory_and_what_limits_it(self):
        with serve("--max-memory", "512M") as server:
            server.wait_for(f"memory: {512 << 20} bytes, limited by --max-memory$")
        with serve() as server:
            server.wait_for("memory: [0-9]+ bytes, limited by the (machine|control group)$")

    @pytest.mark.skipif(sanitized() or thread_sanitized(), reason="a sanitizer needs more memory")
    @pytest.mark.parametrize(
        "memory, caches",
        (
            ("64M", "28 resets, 699050 bytes"),
            ("512M", "128 resets, 4194304 bytes"),
            ("24M", "10 resets, 262144 bytes"),
        ),
    )
    def test_a_server_with_little_memory_has_small_caches(self, memory, caches):
        with serve("--max-memory", memory) as server:
            server.wait_for(f"caches: {caches} of code for an image, [0-9]+ for all$")
            wire = connect_tcp(server.port())
            assert ask(wire, b"load beamfall").startswith(b"ok ")
            wire.close()


@pytest.mark.skipif(sanitized(), reason="the sanitizer's own checks fail without free descriptors")
@pytest.mark.usefixtures("self_cleanup")
class TestFiles:
    """A server that may open few files, all of which its clients take."""

    FILES = 80

    @pytest.fixture(autouse=True)
    def set_up(self, cleanup, tmp_path):
        folder = str(tmp_path)
        self.server = Server(
            "serve",
            "--listen",
            "tcp://127.0.0.1:0",
            "--http",
            "127.0.0.1:0",
            "--grace",
            "0",
            "--record-dir",
            folder,
            before=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (self.FILES, self.FILES)),
        )
        cleanup(self.server.__exit__)
        self.port = self.server.port()
        self.http = int(self.server.wait_for(r"health and metrics on http://127\.0\.0\.1:(\d+)$").group(1))

    def connect(self, port):
        wire = connect_tcp(port)
        self.cleanup(wire.close)
        return wire

    def check_health(self):
        wire = self.connect(self.http)
        wire.send(b"GET /healthz HTTP/1.0\r\n\r\n")
        assert wire.rest().endswith(b"\r\n\r\nok\n")

    def test_files_limit_the_sessions_and_others_get_an_error(self):
        limit = int(self.server.wait_for(r"sessions: (\d+), limited by the open files \(ulimit -n\)$").group(1))
        assert limit == self.FILES // 2
        wires = [self.connect(self.port) for _ in range(limit)]
        for wire in wires:
            assert ask(wire, b"hello").startswith(b"ok ")
        assert self.connect(self.port).rest().startswith(b"error busy there are 40 sessions")
        self.check_health()
        assert ask(wires[0], b"load beamfall").startswith(b"ok ")

    def test_recordings_leave_files_for_sessions_and_for_health(self):
        recorders = [self.connect(self.port) for _ in range(20)]
        for wire in recorders:
            assert ask(wire, b"load beamfall").startswith(b"ok ")
        replies = [ask(wire, b"record gif,y4m,wav film-%d" % n) for n, wire in enumerate(recorders)]
        assert [reply.startswith(b"ok ") for reply in replies] == [True] * 3 + [False] * 17
        for reply in replies[3:]:
            assert reply.startswith(
                b"error recording the server would record into 12 files at the same time; the limit is 10;"
            )
        newcomers = [self.connect(self.port) for _ in range(20)]
        for wire in newcomers:
            assert ask(wire, b"hello").startswith(b"ok ")
        self.check_health()
        assert ask(recorders[0], b"record stop").startswith(b"ok recorded=film-0.gif,")
        assert ask(recorders[3], b"record gif,y4m,wav film-3").startswith(b"ok ")

    def test_health_is_reported_where_something_else_has_taken_all_files(self):
        wires = [self.connect(self.port) for _ in range(self.FILES // 2)]
        for wire in wires:
            assert ask(wire, b"hello").startswith(b"ok ")
        held = len(os.listdir(f"/proc/{self.server.process.pid}/fd"))
        resource.prlimit(self.server.process.pid, resource.RLIMIT_NOFILE, (held, held))
        for _ in range(3):
            self.check_health()

    def test_health_is_reported_where_no_file_is_left(self):
        for _ in range(2 * self.FILES):
            self.connect(self.port)
        for _ in range(3):
            self.check_health()
        connections = [self.connect(self.http) for _ in range(70)]
        for _ in range(3):
            self.check_health()
        assert sum("cannot take a client" in line for line in self.server.log()) < 20
        assert connections[0].rest() == b""


@pytest.mark.needs_posix
@pytest.mark.skipif(sanitized(), reason="the sanitizer's own checks fail without free descriptors")
class TestFewFiles:
    """A server that may open hardly more files than it needs."""

    def start(self, files):
        limit = (files, files)
        options = ("--listen", "unix:s", "--threads", "1")
        return Server("serve", *options, before=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, limit))

    def test_as_many_files_as_the_error_names_are_enough_for_a_client(self):
        with self.start(12) as server:
            assert server.wait() == 1
            sentence = r"the server may open 12 files \(ulimit -n\), but with these settings it needs at least (\d+)$"
            enough = int(server.wait_for(sentence)[1])
        with self.start(enough - 1) as server:
            assert server.wait() == 1
            server.wait_for(f"needs at least {enough}$")
        with self.start(enough) as server:
            server.wait_for("listening on unix:s")
            wire, other = (connect_unix(server.path("s")) for _ in range(2))
            assert ask(wire, b"load beamfall").startswith(b"ok ")
            assert other.rest() == b"error busy the server may open no more files; try again later\n"
            for each in (wire, other):
                each.close()

    def test_the_error_counts_files_that_a_parent_left_open_beyond_the_limit(self, tmp_path):
        def enough(redirection):
            done = subprocess.run(
                ["bash", "-c", f'exec {redirection} && ulimit -n 12 && exec "$@"', "bash", BINARY]
                + ["serve", "--listen", "unix:s", "--threads", "1"],
                cwd=tmp_path,
                capture_output=True,
                timeout=PATIENCE,
            )
            return int(done.stderr.decode().splitlines()[-1].split(" needs at least ")[1])

        assert enough("12</dev/null") == enough("12<&-") + 1


class TestThreads:
    def test_the_log_says_how_many_and_what_limits_them(self):
        with serve("--threads", "3") as server:
            server.wait_for("threads: 3, limited by --threads$")
        with serve() as server:
            server.wait_for("threads: [0-9]+, limited by the (machine|affinity|control group)$")


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="there is one processor")
@pytest.mark.usefixtures("self_cleanup")
class TestAllowance:
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
        assert done.returncode == 0, done.stderr
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
            self.cleanup(os.rmdir, group)
            if os.path.exists(os.path.join(group, name)):
                with open(os.path.join(group, name), "w") as file:
                    file.write(text)
                return os.path.join(group, "cgroup.procs")
        pytest.skip(f"this system does not let a control group for {controller} be made")

    def join(self, processes):
        with open(processes, "w") as file:
            file.write("0")

    def test_the_affinity_limits_the_threads(self):
        processor = min(os.sched_getaffinity(0))
        assert "threads: 1, limited by the affinity\n" in self.log_of(lambda: os.sched_setaffinity(0, {processor}))

    def test_a_control_group_limits_the_threads(self):
        processes = self.group("cpu", (("cpu.cfs_quota_us", "100000"), ("cpu.max", "100000 100000")))
        assert "threads: 1, limited by the control group\n" in self.log_of(lambda: self.join(processes))

    @pytest.mark.skipif(sanitized() or thread_sanitized(), reason="a sanitizer needs more memory")
    def test_a_control_group_limits_memory_and_caches(self):
        processes = self.group("memory", (("memory.limit_in_bytes", str(200 << 20)), ("memory.max", str(200 << 20))))
        log = self.log_of(lambda: self.join(processes))
        assert f"memory: {150 << 20} bytes, limited by the control group\n" in log
        assert "caches: 66 resets, 1638400 bytes of code for an image, 4964352 for all\n" in log
