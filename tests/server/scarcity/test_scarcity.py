"""A server that is short of memory, threads, files or stack: it goes on, or says why it does not start.

A library makes allocations and threads fail (scarce.cpp).
"""

import contextlib
import mmap
import os
import resource
import socket
import struct
import subprocess
import tempfile
import time

import pytest
from harness import BINARY, PATIENCE, Server, ask, built, connect_tcp, sanitized
from test_hostile import health_wait

LIBRARY = built("server/libscarce.so")
LIFE = b"""hello
load beamfall seed=1 sticky=0
observe screen:rle ram reward
act FIRE*3
save a random=1
act NOOP LEFT
restore a
branch a keep=b NOOP,FIRE LEFT*3
open 2
step NOOP
restart 10
export a
share hall
watch hall screen:zlib
look palette:base64
nonsense
quit
"""
WEB = b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"


class Scarcity:
    """What the server is short of. The library reads it from a shared page."""

    FIELDS = ("until_failure", "failures", "alive", "threads")

    def __init__(self, path):
        with open(path, "wb") as file:
            file.write(struct.pack("4q", 0, 0, 0, -1))
        with open(path, "r+b") as file:
            self.page = mmap.mmap(file.fileno(), 32)
        self.environment = {"LD_PRELOAD": LIBRARY, "RACEBEAM_SCARCE": path}

    def get(self, name):
        return struct.unpack_from("q", self.page, 8 * self.FIELDS.index(name))[0]

    def set(self, name, value):
        struct.pack_into("q", self.page, 8 * self.FIELDS.index(name), value)

    def fail(self, number, failures=1):
        """From now on, allocation `number` fails, and those after it up to `failures`."""
        self.set("failures", failures)
        self.set("until_failure", number)


@pytest.mark.skipif(sanitized() or LIBRARY is None, reason="the allocator is another one")
@pytest.mark.usefixtures("self_cleanup")
class Scarce:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.scarcity = Scarcity(os.path.join(tmp_path, "scarcity"))

    def serve(self, *options):
        server = Server(
            "serve",
            "--listen",
            "tcp://127.0.0.1:0",
            "--threads",
            "1",
            "--http",
            "127.0.0.1:0",
            "--log-level",
            "warning",
            "--ready-file",
            "ready",
            "--grace",
            "0",
            *options,
            **self.scarcity.environment,
        )
        self.cleanup(server.__exit__)
        lines = server.addresses("ready")
        self.ports = [int(line.rsplit(":", 1)[1]) for line in lines]
        return server


@pytest.mark.usefixtures("self_subtests")
class TestMemory(Scarce):
    def converse(self, port, requests):
        """Everything that the server answers. A connection may fail at any time."""
        reply = b""
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as connection:
                connection.sendall(requests)
                connection.shutdown(socket.SHUT_WR)
                while piece := connection.recv(65536):
                    reply += piece
        except TimeoutError:
            raise AssertionError("the server says nothing") from None
        except OSError:
            pass
        return reply

    def check_that_it_is_well(self, server, alive):
        """It neither spins nor leaks."""
        assert server.alive(), server.log()[-3:]
        deadline = time.monotonic() + PATIENCE
        while self.scarcity.get("alive") > alive + 200 and time.monotonic() < deadline:
            time.sleep(0.05)
        assert self.scarcity.get("alive") < alive + 200
        seconds = server.processor_seconds()
        time.sleep(0.5)  # the subject: it does nothing meanwhile
        assert server.processor_seconds() - seconds < 0.25

    def check_every_allocation(self, port, requests, failures, step=1):
        server = self.server
        for _ in range(3):
            expected = self.converse(port, requests)
        alive, number = self.scarcity.get("alive"), 1
        while number < 20000:
            self.scarcity.fail(number, failures)
            with self.subtests.test(allocation=number):
                self.converse(port, requests)
                assert server.alive(), server.log()[-3:]
            is_over = self.scarcity.get("failures") < failures
            self.scarcity.set("until_failure", 0)
            assert self.converse(port, requests) == expected, number
            if not is_over:
                break
            number += step
        self.check_that_it_is_well(server, alive)
        assert number > 10

    def test_any_allocation_of_a_session_may_fail(self):
        self.server = self.serve()
        self.check_every_allocation(self.ports[0], LIFE, 1)

    def test_many_allocations_in_a_row_may_fail(self):
        self.server = self.serve()
        self.check_every_allocation(self.ports[0], LIFE, 40, step=11)

    def test_any_allocation_of_a_request_over_http_may_fail(self):
        self.server = self.serve()
        for failures in (1, 20):
            self.check_every_allocation(self.ports[1], WEB, failures)

    @pytest.mark.parametrize("number", range(1, 40, 3))
    def test_any_allocation_of_the_end_may_fail(self, number):
        server = self.serve()
        wire = connect_tcp(self.ports[0])
        ask(wire, b"load beamfall")
        self.scarcity.fail(number, 3)
        assert server.stop() == 0
        self.scarcity.set("until_failure", 0)
        wire.close()


class TestThreads(Scarce):
    def test_a_server_without_its_threads_says_so_and_is_never_ready(self):
        for threads in range(9):
            self.scarcity.set("threads", threads)
            with tempfile.TemporaryDirectory() as folder:
                ready = os.path.join(folder, "ready")
                process = subprocess.Popen(
                    [
                        BINARY,
                        "serve",
                        "--listen",
                        f"unix:{folder}/s",
                        "--stdio",
                        "--threads",
                        "4",
                        "--ready-file",
                        ready,
                    ],
                    env=os.environ | self.scarcity.environment,
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                )
                with process:
                    was_ready = False
                    deadline = time.monotonic() + PATIENCE
                    while process.poll() is None and not was_ready and time.monotonic() < deadline:
                        was_ready = os.path.exists(ready)
                        time.sleep(0.005)
                    if was_ready:
                        process.stdin.close()
                        process.terminate()
                        assert process.wait(PATIENCE) == 0
                        assert threads >= 8  # 3 of machines, 4 of loops, one of the session
                        continue
                    assert process.wait(PATIENCE) == 5
                    assert b"allows no more threads" in process.stderr.read()
                    assert process.stdout.read() == b""
                    assert os.listdir(folder) == []


class TestStack:
    @pytest.mark.skipif(sanitized(), reason="a sanitizer needs more stack")
    def test_a_stack_of_256_KiB_is_enough(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_STACK, (256 << 10, 256 << 10))

        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--http", "127.0.0.1:0", before=limit) as server:
            wire = connect_tcp(server.port())
            assert ask(wire, b"load beamfall").startswith(b"ok ")
            assert ask(wire, b"look screen:zlib rgb:base64").startswith(b"ok ")
            assert ask(wire, b"open 4").startswith(b"ok ")
            health_wait(server)
            assert ask(wire, b"step NOOP").startswith(b"ok ")
            wire.close()
            assert server.stop() == 0


class TestFiles:
    def test_with_few_files_it_serves_or_says_why_not(self, subtests):
        served = []
        for files in (8, 10, 12, 14, 15, 16, 18, 20, 24, 28, 32):
            with subtests.test(files=files), tempfile.TemporaryDirectory() as folder:
                self.check(files, folder, served)
        assert 32 in served

    def check(self, files, folder, served):
        def limit():
            resource.setrlimit(resource.RLIMIT_NOFILE, (files, files))

        with Server(
            "serve",
            "--listen",
            f"unix:{folder}/s",
            "--threads",
            "2",
            "--http",
            "127.0.0.1:0",
            "--grace",
            "0",
            before=limit,
        ) as server:
            deadline = time.monotonic() + PATIENCE
            while server.alive() and not any("health" in line for line in server.log()) and time.monotonic() < deadline:
                time.sleep(0.005)
            if not server.alive():
                assert server.wait() == 1, server.log()
                server.wait_for("racebeam: .*files")
                return
            served.append(files)
            clients = []
            for _ in range(40):
                client = socket.socket(socket.AF_UNIX)
                client.settimeout(PATIENCE)
                client.connect(f"{folder}/s")
                clients.append(client)
            for _ in range(3):
                health_wait(server)
            for client in clients:
                client.close()
            self.check_that_a_client_is_served(f"{folder}/s")
            assert server.stop() == 0

    def check_that_a_client_is_served(self, path):
        deadline, reply = time.monotonic() + PATIENCE, b""
        while not reply.startswith(b"ok ") and time.monotonic() < deadline:
            # A server that still lacks files may have closed the connection before the request.
            with socket.socket(socket.AF_UNIX) as client, contextlib.suppress(BrokenPipeError, ConnectionResetError):
                client.settimeout(PATIENCE)
                client.connect(path)
                client.sendall(b"hello\n")
                reply = client.recv(4096)
        assert reply.startswith(b"ok "), reply
