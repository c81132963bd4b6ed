"""The announce file: what it says, who may read it, when it is gone, and what is not replaced."""

import json
import os
import re
import resource
import signal
import socket
import stat
import subprocess
import tempfile
import time

import cartridges
import pytest
from harness import BINARY, PATIENCE, WINDOWS, Server, ask, connect_tcp, connect_unix, run, serve

FIRST_BYTES = '{"racebeam_announce": 1,'


def wait_for(path):
    deadline = time.monotonic() + PATIENCE
    while not os.path.exists(path):
        if time.monotonic() > deadline:
            raise AssertionError(f"{path} does not exist")
        time.sleep(0.005)
    with open(path) as file:
        return file.read()


def port_of(announced):
    return int(announced["addresses"][0].rsplit(":", 1)[1])


class TestAnnounced:
    def test_it_says_what_a_client_needs(self):
        second = "tcp://127.0.0.1:0" if WINDOWS else 'unix:a "quoted" name'
        with Server(
            "serve",
            "--listen",
            "tcp://127.0.0.1:0",
            "--listen",
            second,
            "--listen",
            "classic+tcp://127.0.0.1:0",
            "--rom",
            "builtin:beamfall",
            "--announce",
            "announce",
        ) as server:
            text = wait_for(server.path("announce"))
            announcement = json.loads(text)
            tcp, other = announcement["addresses"]
            assert re.search(r"^tcp://127\.0\.0\.1:\d+$", tcp)
            assert WINDOWS or other == second
            version = run("--version")[1].decode().split()[1]
            assert {**announcement, "addresses": [], "token": ""} == {
                "racebeam_announce": 1,
                "addresses": [],
                "host": socket.gethostname(),
                "process": announcement["process"] if WINDOWS else server.process.pid,
                "version": version,
                "games": list(cartridges.OURS),
                "token": "",
            }
            assert re.search("^[0-9a-f]{64}$", announcement["token"])
            # The layout that programs without a parser of JSON rely on
            lines = text.splitlines()
            assert lines[0] == FIRST_BYTES
            assert f'  "{tcp}",' in lines
            assert lines[-1] == f' "token": "{announcement["token"]}"}}'

    @pytest.mark.needs_posix
    def test_its_owner_alone_can_read_it(self):
        before = os.umask(0)
        try:
            with serve("--announce", "announce") as server:
                wait_for(server.path("announce"))
                assert stat.S_IMODE(os.stat(server.path("announce")).st_mode) == 0o600
        finally:
            os.umask(before)

    @pytest.mark.needs_posix
    def test_its_token_is_needed_over_TCP_and_not_on_a_Unix_socket(self):
        with serve("--listen", "unix:s", "--announce", "announce") as server:
            announcement = json.loads(wait_for(server.path("announce")))
            wire, local = connect_tcp(port_of(announcement)), connect_unix(server.path("s"))
            assert ask(wire, b"games").startswith(b"error unauthorized ")
            assert ask(wire, b"hello token=" + b"0" * 64).startswith(b"error unauthorized ")
            hello = b"hello token=" + announcement["token"].encode()
            assert b" admitted=1 " in ask(wire, hello)
            assert ask(wire, b"games").startswith(b"ok ")
            assert ask(local, b"games").startswith(b"ok ")
            assert ask(local, hello).startswith(b"ok ")
            wire.close()
            local.close()

    @pytest.mark.parametrize("reload", (False, pytest.param(True, marks=pytest.mark.needs_posix)))
    def test_tokens_of_a_file_are_admitted_as_well_and_survive_a_reload(self, reload):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "tokens")
            with open(path, "w") as tokens:
                tokens.write("0123456789abcdef\n")
            os.chmod(path, 0o600)
            with serve("--token-file", path, "--announce", "announce") as server:
                announcement = json.loads(wait_for(server.path("announce")))
                if reload:
                    server.process.send_signal(signal.SIGHUP)
                    server.wait_for("read the token file again")
                for token in ("0123456789abcdef", announcement["token"]):
                    wire = connect_tcp(port_of(announcement))
                    assert b" admitted=1 " in ask(wire, b"hello token=" + token.encode())
                    wire.close()

    def test_every_server_has_another_token(self):
        tokens = set()
        for _ in range(2):
            with serve("--announce", "announce") as server:
                tokens.add(json.loads(wait_for(server.path("announce")))["token"])
        assert len(tokens) == 2

    def test_all_addresses_of_a_machine_are_its_host_name(self):
        with Server("serve", "--listen", "tcp://0.0.0.0:0", "--announce", "announce") as server:
            announcement = json.loads(wait_for(server.path("announce")))
            assert announcement["addresses"] == [f"tcp://{socket.gethostname()}:{port_of(announcement)}"]


class TestLife:
    def test_it_is_gone_as_soon_as_the_server_is_told_to_stop(self):
        with serve("--announce", "announce", "--grace", "60") as server:
            announcement = json.loads(wait_for(server.path("announce")))
            wire = connect_tcp(port_of(announcement))
            ask(wire, b"hello token=" + announcement["token"].encode())
            server.process.send_signal(signal.SIGTERM)
            server.wait_for("told to stop")
            assert not os.path.exists(server.path("announce"))
            wire.close()
            assert server.wait() == 0

    def test_a_stale_one_is_gone_when_the_next_start_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "announce")
            with serve("--announce", path) as server:
                wait_for(path)
                server.process.kill()
                server.wait()
            assert os.path.exists(path)
            status, _, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--roms", "/nowhere", "--announce", path)
            assert (status, os.listdir(folder)) == (4, []), errors

    def test_the_file_of_a_running_server_is_replaced_with_a_warning(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "announce")
            with serve("--announce", path):
                wait_for(path)
                with serve("--announce", path) as heir:
                    heir.wait_for(f"warning: the announce file {path} of another server, which runs, is replaced")
            with serve("--announce", path) as alone:
                alone.wait_for("listening on")
                wait_for(path)
                assert "is replaced" not in "\n".join(alone.log())

    def test_a_file_that_is_not_an_announce_file_is_refused_and_stays(self, subtests):
        texts = {"notes": "dear diary", "empty": "", "json": '{"a": 1}', "ready": "# racebeam ready file: x\n"}
        for name, text in texts.items():
            with subtests.test(name=name), tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, name)
                with open(path, "w") as file:
                    file.write(text)
                status, output, errors = run("serve", "--listen", "tcp://127.0.0.1:0", "--announce", path)
                assert (status, output, len(errors)) == (1, b"", 1), errors
                assert f"--announce {path} exists, and is not an announce file" in errors[0]
                with open(path) as file:
                    assert file.read() == text

    @pytest.mark.needs_posix
    def test_a_full_disk_leaves_nothing_half_written(self, subtests):
        def limit():  # a write beyond it fails, as on a full disk
            resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))

        for option, name in (("--announce", "announce file"), ("--ready-file", "ready file")):
            with subtests.test(option=option), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(
                    [BINARY, "serve", "--listen", "tcp://127.0.0.1:0", "--log-level", "error", option, "file"],
                    capture_output=True,
                    cwd=folder,
                    timeout=PATIENCE,
                    preexec_fn=limit,
                )
                assert (done.returncode, os.listdir(folder)) == (1, []), done.stderr
                assert done.stderr.decode() == f"racebeam: cannot write the {name} file: File too large\n"

    def test_it_needs_a_socket_with_the_line_protocol(self):
        for words in (["--stdio"], ["--listen", "classic+tcp://127.0.0.1:0", "--rom", "builtin:beamfall"]):
            with tempfile.TemporaryDirectory() as folder:
                status, _, errors = run("serve", *words, "--announce", "announce", cwd=folder)
                assert (status, os.listdir(folder)) == (2, []), errors
                assert re.search("--announce: requires the line protocol on a socket", errors[0]), errors
