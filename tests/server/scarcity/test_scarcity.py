"""A server that is short of memory, threads, files or stack: it goes on, or says why it does not start.

RACEBEAM_SCARCE_LIBRARY names the library that makes allocations and threads fail (scarce.cpp).
"""

import mmap
import os
import resource
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from harness import BINARY, PATIENCE, Server, ask, connect_tcp, main, sanitized
from test_hostile import health_wait

LIBRARY = os.environ.get("RACEBEAM_SCARCE_LIBRARY", "")
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


@unittest.skipIf(sanitized() or not LIBRARY, "the allocator is another one")
class Scarce(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scarcity = Scarcity(os.path.join(folder.name, "scarcity"))

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
        self.addCleanup(server.__exit__)
        lines = server.addresses("ready")
        self.ports = [int(line.rsplit(":", 1)[1]) for line in lines]
        return server


class Memory(Scarce):
    def converse(self, port, said):
        """Everything that the server answers. A connection may fail at any time."""
        reply = b""
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as connection:
                connection.sendall(said)
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
        self.assertTrue(server.alive(), server.log()[-3:])
        deadline = time.monotonic() + PATIENCE
        while self.scarcity.get("alive") > alive + 200 and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertLess(self.scarcity.get("alive"), alive + 200)
        seconds = server.processor_seconds()
        time.sleep(0.5)
        self.assertLess(server.processor_seconds() - seconds, 0.25)

    def check_every_allocation(self, port, said, failures, step=1):
        server = self.server
        for _ in range(3):
            expected = self.converse(port, said)
        alive, number = self.scarcity.get("alive"), 1
        while number < 20000:
            self.scarcity.fail(number, failures)
            with self.subTest(allocation=number):
                self.converse(port, said)
                self.assertTrue(server.alive(), server.log()[-3:])
            is_over = self.scarcity.get("failures") < failures
            self.scarcity.set("until_failure", 0)
            self.assertEqual(self.converse(port, said), expected, number)
            if not is_over:
                break
            number += step
        self.check_that_it_is_well(server, alive)
        self.assertGreater(number, 10)

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

    def test_any_allocation_of_the_end_may_fail(self):
        for number in range(1, 40, 3):
            with self.subTest(allocation=number):
                server = self.serve()
                wire = connect_tcp(self.ports[0])
                ask(wire, b"load beamfall")
                self.scarcity.fail(number, 3)
                self.assertEqual(server.stop(), 0)
                self.scarcity.set("until_failure", 0)
                wire.close()


class Threads(Scarce):
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
                        self.assertEqual(process.wait(PATIENCE), 0)
                        self.assertGreaterEqual(threads, 8)  # 3 of machines, 4 of loops, one of the session
                        continue
                    self.assertEqual(process.wait(PATIENCE), 5)
                    self.assertIn(b"allows no more threads", process.stderr.read())
                    self.assertEqual(process.stdout.read(), b"")
                    self.assertEqual(os.listdir(folder), [])


class Stack(unittest.TestCase):
    @unittest.skipIf(sanitized(), "a sanitizer needs more stack")
    def test_a_stack_of_256_KiB_is_enough(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_STACK, (256 << 10, 256 << 10))

        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--http", "127.0.0.1:0", before=limit) as server:
            wire = connect_tcp(server.port())
            self.assertTrue(ask(wire, b"load beamfall").startswith(b"ok "))
            self.assertTrue(ask(wire, b"look screen:zlib rgb:base64").startswith(b"ok "))
            self.assertTrue(ask(wire, b"open 4").startswith(b"ok "))
            health_wait(server)
            self.assertTrue(ask(wire, b"step NOOP").startswith(b"ok "))
            wire.close()
            self.assertEqual(server.stop(), 0)


class Files(unittest.TestCase):
    def test_with_few_files_it_serves_or_says_why_not(self):
        served = []
        for files in (8, 10, 12, 14, 15, 16, 18, 20, 24, 28, 32):
            with self.subTest(files=files), tempfile.TemporaryDirectory() as folder:
                self.check(files, folder, served)
        self.assertIn(32, served)

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
                self.assertEqual(server.wait(), 1, server.log())
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
            self.assertEqual(server.stop(), 0)

    def check_that_a_client_is_served(self, path):
        deadline, reply = time.monotonic() + PATIENCE, b""
        while not reply.startswith(b"ok ") and time.monotonic() < deadline:
            with socket.socket(socket.AF_UNIX) as client:
                client.settimeout(PATIENCE)
                client.connect(path)
                client.sendall(b"hello\n")
                reply = client.recv(4096)
        self.assertTrue(reply.startswith(b"ok "), reply)


if __name__ == "__main__":
    main()
