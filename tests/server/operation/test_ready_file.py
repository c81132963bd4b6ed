"""The file that says where a server listens."""

import os
import re
import signal
import tempfile

import pytest
from harness import (
    WINDOWS,
    Server,
    ask,
    connect_tcp,
    run,
    serve,
)

FIRST_LINE = "# racebeam ready file: the addresses of a server, one a line; lines that begin with # are comments\n"


class TestReadyFile:
    def test_a_file_that_is_not_a_ready_file_is_refused_and_stays(self, subtests):
        def file(path, text):
            with open(path, "w") as notes:
                notes.write(text)

        kinds = {
            "notes": lambda path: file(path, "tcp://127.0.0.1:1\n"),
            "empty": lambda path: file(path, ""),
            "near": lambda path: file(path, FIRST_LINE[:15]),
            "other": lambda path: file(path, "# racebeam ready file: x\n"),
            "long": lambda path: file(path, FIRST_LINE[:-1] + " of a kind\n"),
            "folder": os.mkdir,
        }
        if not WINDOWS:
            kinds["pipe"] = os.mkfifo
            kinds["device"] = lambda path: os.symlink("/dev/null", path)
            kinds["link"] = lambda path: os.symlink("ready", path)

        def marks(path):  # all but the time of the last access
            found = os.lstat(path)
            return found.st_ino, found.st_mode, found.st_size, found.st_mtime_ns

        for kind, make in kinds.items():
            for where in (["--stdio"], ["--listen", "tcp://127.0.0.1:0"]):
                with subtests.test(kind=kind, where=where[0]), tempfile.TemporaryDirectory() as folder:
                    file(os.path.join(folder, "ready"), FIRST_LINE)
                    path = os.path.join(folder, kind)
                    make(path)
                    before = marks(path)
                    status, output, errors = run("serve", *where, "--ready-file", path)
                    assert (status, output, len(errors)) == (1, b"", 1), errors
                    assert f"--ready-file {path} exists, and is not a ready file" in errors[0]
                    assert marks(path) == before

    @pytest.mark.parametrize(
        "words",
        (["--listen", "tcp://192.0.2.1:1"], ["--stdio", "--roms", "/nowhere"], ["--classic", "--stdio"]),
    )
    def test_a_stale_one_is_gone_before_anything_else_is_looked_at(self, words):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with open(path, "w") as stale:
                stale.write(FIRST_LINE + "tcp://127.0.0.1:1\n")
            status, _, errors = run("serve", *words, "--ready-file", path)
            assert status != 0, errors
            assert os.listdir(folder) == []

    def test_the_file_of_a_killed_server_is_stale(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ready")
            with serve("--ready-file", path) as server:
                server.addresses(path)
                server.process.kill()
                server.wait()
            assert os.path.exists(path)
            run("serve", "--stdio", "--roms", "/nowhere", "--ready-file", path)
            assert not os.path.exists(path)

    def test_it_is_gone_as_soon_as_the_server_is_told_to_stop(self):
        with serve("--ready-file", "ready", "--grace", "60") as server:
            server.addresses("ready")
            wire = connect_tcp(server.port())
            ask(wire, b"hello")
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop")
            assert not os.path.exists(server.path("ready"))
            assert ask(wire, b"hello").startswith(b"ok ")
            wire.close()
            assert server.wait() == 0

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
                assert lines[0] == f"tcp://127.0.0.1:{port}"
                with open(path) as ready:
                    assert ready.read().startswith(FIRST_LINE)
                assert re.search(r"^http://127\.0\.0\.1:\d+$", lines[1])
                assert server.stop() == 0
            assert os.listdir(folder) == []

    @pytest.mark.needs_posix
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
                    assert (status, os.path.exists(path)) == (3, True), errors
                    assert server.stop() == 0
                    assert os.path.exists(path)
                    assert heir.stop() == 0
                    assert not os.path.exists(path)

    def test_one_that_cannot_be_written_is_an_error(self):
        status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--ready-file", "nowhere/ready")
        assert (status, "cannot write the ready file nowhere/ready" in errors[-1]) == (1, True), errors
        with Server("serve", "--stdio", "--ready-file", "nowhere/ready", streams=True) as server:
            assert server.wait() == 1  # though its input is open
