"""Sockets: addresses that are in use, stale or invalid, several at once, signals, and independent clients."""

import contextlib
import fcntl
import os
import pathlib
import re
import resource
import signal
import socket
import tempfile
import threading
import time

import pytest
from harness import GAME, LISTEN, Server, connect_nearby, connect_tcp, connect_unix, open_pipes, run, sanitized

SERVE = ("serve", "--classic", "--rom", GAME, "--seed", "1", "--sticky", "0", "--grace", "0")
WHOLE = b"0,1,0,1\n" + b"1,18\n" * 20


def listening(*addresses):
    server = Server(*SERVE, *(word for address in addresses for word in ("--listen", address)))
    for address in addresses:
        server.wait_for(f"listening on {address}$" if not address.endswith(":0") else "listening on tcp")
    return server


def play(wire):
    wire.send(WHOLE)
    wire.stop_sending()
    answers = wire.rest()
    wire.close()
    return answers


@pytest.mark.usefixtures("self_cleanup")
class TestAddresses:
    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.cleanup(folder.cleanup)
        return folder.name

    def refuse(self, address, status, hint):
        ended, output, errors = run(*SERVE, "--listen", address)
        assert (ended, output, len(errors)) == (status, b"", 1), errors
        assert hint in errors[0]

    def test_port_0_picks_a_port_and_says_which(self):
        with listening("tcp://127.0.0.1:0") as server:
            assert server.port() > 0
            assert play(connect_tcp(server.port()))[:8] == b"160-210\n"

    def test_a_host_name_is_resolved_and_stays_in_the_address(self):
        with listening("tcp://LocalHost:0") as server:
            port = int(server.wait_for(r"listening on tcp://LocalHost:(\d+) \(127\.0\.0\.1\)$").group(1))
            assert play(connect_tcp(port))[:8] == b"160-210\n"

    def test_two_servers_cannot_have_one_port(self):
        with listening("tcp://127.0.0.1:0") as server:
            self.refuse(f"tcp://127.0.0.1:{server.port()}", 3, "in use")
            assert play(connect_tcp(server.port())).endswith(b"DIE\n")

    @pytest.mark.needs_posix
    def test_two_servers_cannot_have_one_path(self):
        with listening("unix:s") as server:
            self.refuse("unix:" + server.path("s"), 3, "in use")
            assert play(connect_unix(server.path("s"))).endswith(b"DIE\n")

    @pytest.mark.needs_posix
    def test_a_live_socket_whose_queue_is_full_is_not_waited_for(self):
        path = os.path.join(self.folder(), "s")
        with contextlib.ExitStack() as stack:
            listener = stack.enter_context(socket.socket(socket.AF_UNIX))
            listener.bind(path)
            listener.listen(0)
            with pytest.raises(BlockingIOError):
                while True:
                    client = stack.enter_context(socket.socket(socket.AF_UNIX))
                    client.setblocking(False)
                    client.connect(path)
            self.refuse("unix:" + path, 3, "in use")

    @pytest.mark.needs_posix
    def test_a_server_that_has_bound_its_socket_and_does_not_listen_yet_keeps_it(self, cleanup):
        folder = self.folder()
        path = os.path.join(folder, "s")
        lock = os.open(folder, os.O_RDONLY)
        cleanup(os.close, lock)
        fcntl.flock(lock, fcntl.LOCK_EX)
        with socket.socket(socket.AF_UNIX) as listener, Server(*SERVE, "--listen", "unix:" + path) as server:
            listener.bind(path)
            threading.Timer(0.5, lambda: (listener.listen(), fcntl.flock(lock, fcntl.LOCK_UN))).start()
            assert server.wait() == 3
            assert "in use" in server.log()[-1]
            assert os.path.exists(path)

    @pytest.mark.needs_posix
    def test_one_address_cannot_be_given_twice(self):
        ended, _, errors = run(*SERVE, "--listen", "unix:s", "--listen", "unix:s", cwd=self.folder())
        assert (ended, len(errors)) == (3, 1), errors

    @pytest.mark.needs_posix
    def test_the_socket_file_of_a_dead_server_is_replaced(self):
        with listening("unix:s") as server:
            server.stop(signal.SIGKILL)
            assert os.path.exists(server.path("s"))
            with Server(*SERVE, "--listen", "unix:" + server.path("s")) as heir:
                heir.wait_for("listening on")
                assert play(connect_unix(server.path("s"))).endswith(b"DIE\n")

    @pytest.mark.needs_posix
    def test_a_file_that_is_not_a_socket_is_left_alone(self):
        with listening("unix:s") as server:
            with open(server.path("notes"), "w") as notes:
                notes.write("dear diary")
            self.refuse("unix:" + server.path("notes"), 3, "is not a socket")
            assert os.path.getsize(server.path("notes")) == 10

    @pytest.mark.parametrize(
        "address",
        (
            "",
            "tcp",
            "tcp://",
            "tcp://127.0.0.1",
            "tcp://127.0.0.1:",
            "tcp://127.0.0.1:x",
            "unix:",
            "tcp://127.0.0.1:65536",
            "tcp://127.0.0.1:-1",
            "tcp://no body:1",
            "tcp://127.0.1:1",
            "udp://127.0.0.1:1",
        ),
    )
    def test_an_invalid_address_is_refused(self, address):
        self.refuse(address, 2, "is not an address")

    @pytest.mark.needs_posix
    def test_paths_that_cannot_be_had_are_refused(self):
        self.refuse("unix:nowhere/s", 3, "No such file")

    @pytest.mark.needs_posix
    def test_a_path_has_as_many_bytes_as_the_system_takes(self):
        longest = 107  # of sun_path, less the 0 at the end (unix(7))
        with listening("unix:" + "x" * longest) as server:
            assert server.stop() == 0
        self.refuse("unix:" + "x" * (longest + 1), 3, f"x is too long; a socket's path has at most {longest} bytes")

    def test_hosts_that_cannot_be_had_are_refused(self):
        self.refuse("tcp://192.0.2.1:1", 3, "cannot listen")
        self.refuse("tcp://" + "x" * 64 + ":1", 3, "the host of tcp://" + "x" * 64 + ":1 is unknown: ")

    @pytest.mark.needs_posix
    def test_nothing_is_left_behind_when_one_of_several_fails(self):
        with listening("tcp://127.0.0.1:0") as server:
            folder = self.folder()
            address = f"tcp://127.0.0.1:{server.port()}"
            ended, _, errors = run(*SERVE, "--listen", "unix:s", "--listen", address, cwd=folder)
            assert (ended, len(errors), os.listdir(folder)) == (3, 1, []), errors


class TestClients:
    @pytest.mark.needs_posix
    def test_several_addresses_are_served_at_once(self):
        with listening("tcp://127.0.0.1:0", "unix:a", "unix:b") as server:
            wires = [connect_tcp(server.port()), connect_unix(server.path("a")), connect_unix(server.path("b"))]
            assert len({play(wire) for wire in wires}) == 1

    def test_several_ports_are_served_at_once(self):
        with listening("tcp://127.0.0.1:0", "tcp://127.0.0.1:0") as server:
            ports = set(re.findall(r"listening on tcp://127\.0\.0\.1:(\d+)", "\n".join(server.log())))
            assert len(ports) == 2
            assert len({play(connect_tcp(int(port))) for port in ports}) == 1

    def test_everyone_has_a_machine_of_their_own(self):
        with Server(*SERVE, *LISTEN) as server:
            wires = [connect_nearby(server) for _ in range(30)]
            for wire in wires:
                assert wire.line() == b"160-210\n"
                wire.send(b"0,1,0,1\n")
                wire.line()
            for _ in range(20):
                for wire in wires:
                    wire.send(b"1,18\n")
                assert len({wire.line() for wire in wires}) == 1
            for wire in wires:
                wire.close()

    def test_clients_that_make_no_sense_harm_nobody_else(self):
        with listening("tcp://127.0.0.1:0") as server:
            good = connect_tcp(server.port())
            assert good.line() == b"160-210\n"
            for nonsense in (b"\n", b"GET / HTTP/1.1\r\n\r\n", b"\0" * 5000, b"0,0,0,1\n99,18\n", b"1,1,1,1\n44,0\n"):
                bad = connect_tcp(server.port())
                bad.send(nonsense)
                assert bad.rest().startswith(b"160-210\n")
                bad.close()
            assert play(good).endswith(b"DIE\n")
            server.wait_for(r"(?s)(the client .*){5}")
            assert sum("the client " in line for line in server.log()) == 5

    def test_an_answer_is_not_lost_when_more_was_sent_than_is_read(self):
        with Server(*SERVE, "--listen", "tcp://127.0.0.1:0", "--max-frames", "5") as server:
            wire = connect_tcp(server.port())
            wire.send(b"0,0,0,1\n" + b"3,18\n" * 1000)
            assert wire.rest() == b"160-210\n" + b"0,0:\n" * 5 + b"DIE\n"
            assert not wire.was_reset  # else a slower client would have lost what it had not read
            wire.close()

    def test_a_client_that_resets_its_connection_harms_nobody_else(self):
        with listening("tcp://127.0.0.1:0") as server:
            wire = connect_tcp(server.port())
            wire.line()
            wire.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
            wire.close()
            assert play(connect_tcp(server.port())).endswith(b"DIE\n")

    @pytest.mark.skipif(not os.path.exists("/proc/net/tcp"), reason="it is for Linux")
    def test_a_machine_that_vanishes_is_noticed_by_keepalive(self):
        with listening("tcp://127.0.0.1:0") as server:
            wire = connect_tcp(server.port())
            wire.line()
            ends = tuple(f":{port:04X}" for port in (server.port(), wire.connection.getsockname()[1]))
            rows = [row.split() for row in pathlib.Path("/proc/net/tcp").read_text().splitlines()]
            [timer] = [row[5] for row in rows if (row[1][-5:], row[2][-5:]) == ends]
            assert timer.startswith("02:")
            wire.close()

    @pytest.mark.needs_posix
    def test_a_server_with_an_idle_session_rests(self):
        with listening("tcp://127.0.0.1:0") as server:
            wire = connect_tcp(server.port())
            wire.line()
            before = server.processor_seconds()
            time.sleep(1)  # the subject: nothing is to be done
            assert server.processor_seconds() - before < 0.05
            wire.close()

    @pytest.mark.needs_posix
    @pytest.mark.skipif(sanitized(), reason="the sanitizer's own checks fail without free descriptors")
    def test_a_server_that_has_too_many_clients_takes_others_later(self):
        with listening("unix:s") as server:
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (20, 20))
            for times in (1, 2):
                crowd = [connect_unix(server.path("s")) for _ in range(30)]
                server.wait_for(rf"(?s)(cannot take a client on unix:s: Too many open files.*){{{times}}}")
                if times == 1:
                    time.sleep(0.3)  # the subject: the server tries again, and says nothing
                    assert sum("cannot take a client" in line for line in server.log()) == 1
                for wire in crowd:
                    wire.close()
                assert play(connect_unix(server.path("s"))).endswith(b"DIE\n")


class TestSignals:
    @pytest.mark.parametrize("number", (signal.SIGTERM, signal.SIGINT))
    def test_a_server_that_is_told_to_stop_ends_sessions_and_removes_its_socket(self, number):
        with Server(*SERVE, *LISTEN) as server:
            wires = [connect_nearby(server), connect_tcp(server.port())]
            for wire in wires:
                wire.line()
            assert server.stop(number) == 0
            assert not os.path.exists(server.path("s"))
            for wire in wires:
                assert wire.rest() == b""
                wire.close()

    @pytest.mark.needs_posix
    @pytest.mark.parametrize("is_private, end", ((True, "signal"), (True, "client"), (False, "signal")))
    def test_pipes_that_the_server_has_made_are_removed_at_its_end(self, is_private, end):
        with Server(*SERVE, "--pipes", "p", before=None if is_private else self.make_pipes) as server:
            server.wait_for("for a client that opens p_out for reading, then p_in for writing$")
            made = [line for line in server.log() if "made the pipe" in line]
            assert made == (["racebeam: made the pipe p_out", "racebeam: made the pipe p_in"] if is_private else [])
            if end == "client":
                wire = open_pipes(server, "p")
                play(wire)
                assert server.wait() == 0
            else:
                assert server.stop() == 0
            assert os.path.exists(server.path("p_out")) == (not is_private)
            assert os.path.exists(server.path("p_in")) == (not is_private)

    def make_pipes(self):
        for name in ("p_out", "p_in"):
            os.mkfifo(name)

    @pytest.mark.needs_posix
    def test_a_hangup_early_in_the_start_does_no_harm(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in range(300):  # the server reads them all before it handles signals
                with open(os.path.join(folder, f"{number}.bin"), "wb") as image:
                    image.write(number.to_bytes(4, "big") * (1 << 16))
            with Server("serve", "--listen", "unix:s", "--roms", folder) as server:
                files, early = f"/proc/{server.process.pid}/fd", False
                while not early and server.alive():
                    with contextlib.suppress(OSError):
                        early = any(
                            os.readlink(os.path.join(files, file)).startswith(folder) for file in os.listdir(files)
                        )
                for _ in range(3):
                    server.process.send_signal(signal.SIGHUP)
                server.wait_for("listening on unix:s")
                assert server.stop() == 0

    @pytest.mark.needs_posix
    def test_the_socket_of_a_successor_is_left_alone(self):
        with listening("unix:s") as server:
            os.unlink(server.path("s"))
            with Server(*SERVE, "--listen", "unix:" + server.path("s")) as heir:
                heir.wait_for("listening on")
                assert server.stop() == 0
                assert play(connect_unix(server.path("s"))).endswith(b"DIE\n")

    @pytest.mark.parametrize(
        "transport, ready",
        (
            (["--stdio"], "on standard input"),
            pytest.param(["--pipes", "p"], "for a client that opens", marks=pytest.mark.needs_posix),
        ),
    )
    @pytest.mark.parametrize("number", (signal.SIGTERM, signal.SIGINT))
    def test_sessions_on_streams_stop_when_told_to(self, transport, ready, number):
        with Server(*SERVE, *transport, streams=True) as server:
            server.wait_for(ready)
            assert server.stop(number) == 0
