"""Shared by tests of the running server: starts it, talks to it over up to four transports, and waits for its end.

RACEBEAM_BINARY names the executable. RACEBEAM_ROMS has the commercial images, or else an ale-py in .venv or in the
environment that runs the tests. Tests that need one are skipped without it.
"""

import glob
import os
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BINARY = os.environ.get("RACEBEAM_BINARY", os.path.join(SOURCE, "build", "release", "racebeam"))
GAME = "builtin:beamfall"
LOAD = b"load beamfall seed=1 sticky=0 max_episode_frames=0\nsave root\nobserve frame\n"
WINDOWS = os.path.basename(BINARY) == "windows-program"  # in Wine (platforms/program)
STREAMS = ("stdio",) if WINDOWS else ("stdio", "pipes")
SOCKETS = ("tcp",) if WINDOWS else ("tcp", "unix")
TRANSPORTS = STREAMS + SOCKETS
# Where a server of many sessions listens: at a free port, and at a Unix socket in its folder.
LISTEN = ("--listen", "tcp://127.0.0.1:0") + (() if WINDOWS else ("--listen", "unix:s"))
# Seconds until something counts as hanging; more for slow builds.
PATIENCE = float(os.environ.get("RACEBEAM_PATIENCE", 60))
SKIPPED = 77  # exit status that ctest reads as "skipped"


def built(name):
    """The path of what the tests' CMakeLists.txt built beside the program, or None."""
    path = os.path.join(os.path.dirname(BINARY), "tests", name)
    return path if os.path.exists(path) else None


# A shell ignores SIGINT and SIGQUIT for what it runs in the background, and nohup SIGHUP. Programs inherit that;
# racebeam obeys.
for _number in signal.Signals:
    if _number.name in ("SIGINT", "SIGHUP", "SIGQUIT") and signal.getsignal(_number) == signal.SIG_IGN:
        signal.signal(_number, signal.default_int_handler if _number == signal.SIGINT else signal.SIG_DFL)


def rom(name):
    """The path of a commercial image, or None."""
    folders = [os.environ.get("RACEBEAM_ROMS", "")]
    for environment in (os.path.join(SOURCE, ".venv"), sys.prefix):
        folders += glob.glob(os.path.join(environment, "lib", "python*", "site-packages", "ale_py", "roms"))
    found = [os.path.join(folder, name + ".bin") for folder in folders if folder]
    return next((path for path in found if os.path.exists(path)), None)


def built_with(symbol):
    with open(BINARY, "rb") as binary:
        return symbol in binary.read()


def sanitized():
    return built_with(b"__ubsan")


def thread_sanitized():
    return built_with(b"__tsan")


def run(*words, data=b"", cwd=None):
    """Runs racebeam until it ends. Returns status, output, and the lines on standard error."""
    done = subprocess.run([BINARY, *words], input=data, capture_output=True, timeout=PATIENCE, cwd=cwd)
    return done.returncode, done.stdout, done.stderr.decode().splitlines()


class Server:
    """A racebeam process. It works in a temporary folder, or in the given one. Its standard error is the
    log, or the given descriptor. `before`: called in the new process. `environment`: variables besides those of
    the test."""

    def __init__(self, *words, streams=False, folder=None, errors=None, before=None, **environment):
        self.own_folder = tempfile.TemporaryDirectory()
        self.folder = folder or self.own_folder.name
        self.errors = open(os.path.join(self.own_folder.name, "stderr"), "w+b")
        pipe = subprocess.PIPE if streams else subprocess.DEVNULL
        self.process = subprocess.Popen(
            [BINARY, *words],
            stdin=pipe,
            stdout=pipe,
            stderr=errors or self.errors,
            cwd=self.folder,
            bufsize=0,
            preexec_fn=before,
            env={name: value for name, value in os.environ.items() if name != "RACEBEAM_ROMS"} | environment,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout, self.errors):
            if stream:
                stream.close()
        self.own_folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def log(self):
        with open(self.errors.name, "rb") as errors:
            return errors.read().decode().splitlines()

    def wait_for(self, pattern):
        """Waits for `pattern` in the log. Returns the match."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            match = re.search(pattern, "\n".join(self.log()), re.MULTILINE)
            if match:
                return match
            if self.process.poll() is not None:
                break
            time.sleep(0.005)
        raise AssertionError(f"'{pattern}' is not in the log: {self.log()}")

    def addresses(self, ready_file):
        """Waits for --ready-file. Returns its addresses."""
        deadline = time.monotonic() + PATIENCE
        while not os.path.exists(self.path(ready_file)) and time.monotonic() < deadline:
            time.sleep(0.005)
        with open(self.path(ready_file)) as file:
            return [line for line in file.read().splitlines() if not line.startswith("#")]

    def port(self):
        return int(self.wait_for(r"listening on tcp://127\.0\.0\.1:(\d+)$").group(1))

    def stop(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        return self.wait()

    def wait(self):
        return self.process.wait(timeout=PATIENCE)

    def alive(self):
        return self.process.poll() is None

    def program(self):
        """The number of the process that runs the program. In Wine, it is a child of what the test has started."""
        if not WINDOWS:
            return self.process.pid
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            with open(f"/proc/{self.process.pid}/task/{self.process.pid}/children") as children:
                if found := children.read().split():
                    return int(found[0])
            time.sleep(0.01)
        raise AssertionError("Wine has not started the program")

    def processor_seconds(self):
        """What the program has used of a processor."""
        with open(f"/proc/{self.program()}/stat") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def wait_until_it_works(self):
        """Waits until the server is in the middle of a long request: it has used some processor time from now on."""
        until, deadline = self.processor_seconds() + 0.05, time.monotonic() + PATIENCE
        while self.processor_seconds() < until:
            if time.monotonic() > deadline:
                raise AssertionError("the server does not work")
            time.sleep(0.005)


class Wire:
    """Both directions of a client's connection."""

    def __init__(self, input_fd, output_fd, connection=None):
        self.input_fd, self.output_fd, self.connection = input_fd, output_fd, connection
        self.was_reset = False

    def fileno(self):
        return self.input_fd

    def send(self, data):
        while data:
            data = data[os.write(self.output_fd, data) :]

    def read(self, count):
        """Receives up to `count` bytes; none at the end."""
        if not select.select([self.input_fd], [], [], PATIENCE)[0]:
            raise AssertionError("the server says nothing")
        try:
            return os.read(self.input_fd, count)
        except ConnectionResetError:
            self.was_reset = True
            return b""

    def receive(self, count):
        data = b""
        while len(data) < count:
            piece = self.read(count - len(data))
            if not piece:
                raise AssertionError(f"the server closed its end after {data[-100:]!r}")
            data += piece
        return data

    def line(self):
        data = b""
        while not data.endswith(b"\n"):
            data += self.receive(1)
        return data

    def rest(self):
        pieces = []
        while True:
            pieces.append(self.read(65536))
            if not pieces[-1]:
                return b"".join(pieces)

    def stop_sending(self):
        if self.connection:
            self.connection.shutdown(socket.SHUT_WR)
        elif self.output_fd is not None:
            os.close(self.output_fd)
            self.output_fd = None

    def stop_reading(self):
        """The peer of a socket only sees the end when everything is closed."""
        if self.connection:
            self.close()
        elif self.input_fd is not None:
            os.close(self.input_fd)
            self.input_fd = None

    def close(self):
        if self.connection:
            self.connection.close()
            self.connection = self.input_fd = self.output_fd = None
        self.stop_sending()
        self.stop_reading()


def serve(*options, errors=None):
    """A server of the line protocol on a free port."""
    return Server("serve", "--listen", "tcp://127.0.0.1:0", *options, errors=errors)


def ask(wire, request):
    wire.send(request + b"\n")
    return wire.line()


def connect_tcp(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    connection.setblocking(True)
    return Wire(connection.fileno(), connection.fileno(), connection)


def connect_unix(path):
    connection = socket.socket(socket.AF_UNIX)
    connection.connect(path)
    return Wire(connection.fileno(), connection.fileno(), connection)


def connect_nearby(server):
    """Connects to a server that listens at LISTEN: over the Unix socket, if there is one."""
    if WINDOWS:
        return connect_tcp(server.port())
    server.wait_for("listening on unix:s")
    return connect_unix(server.path("s"))


def open_pipes(server, prefix):
    # O_NONBLOCK: opening for reading does not wait for a writer. The server's open for writing then returns.
    input_fd = os.open(server.path(prefix + "_out"), os.O_RDONLY | os.O_NONBLOCK)
    os.set_blocking(input_fd, True)
    return Wire(input_fd, os.open(server.path(prefix + "_in"), os.O_WRONLY))


class Session:
    """One server and one client, over any of TRANSPORTS. Without an image: the line protocol."""

    def __init__(self, transport, *options, image=GAME):
        protocol = ["--classic", "--rom", image] if image else []
        command = ["serve", *protocol, *options]
        where = {
            "stdio": ["--stdio"],
            "pipes": ["--pipes", "p"],
            "tcp": ["--listen", "tcp://127.0.0.1:0", "--grace", "0"],
            "unix": ["--listen", "unix:s", "--grace", "0"],
        }[transport]
        self.transport = transport
        self.server = Server(*command, *where, streams=transport == "stdio")
        try:
            self.wire = self.connect()
        except BaseException:
            self.server.__exit__()
            raise

    def connect(self):
        if self.transport == "stdio":
            process = self.server.process
            return Wire(os.dup(process.stdout.fileno()), os.dup(process.stdin.fileno()))
        if self.transport == "pipes":
            self.server.wait_for("for a client that opens")
            return open_pipes(self.server, "p")
        if self.transport == "tcp":
            return connect_tcp(self.server.port())
        self.server.wait_for("listening on unix:s")
        return connect_unix(self.server.path("s"))

    def __enter__(self):
        if self.transport == "stdio":  # the remaining descriptors are duplicates
            self.server.process.stdin.close()
            self.server.process.stdout.close()
        return self

    def __exit__(self, *_):
        self.wire.close()
        self.server.__exit__()

    def status(self):
        """The exit status of the process. A server of many sessions is told to stop first."""
        return self.server.stop() if self.transport in ("tcp", "unix") else self.server.wait()
