"""The program for Windows, in Wine: what differs there from other systems. platforms/program runs this file, and tests
of the server. RACEBEAM_BINARY is platforms/windows-program, and RACEBEAM_NATIVE the program of this system."""

import os
import pathlib
import signal
import socket
import subprocess

import pytest
from harness import BINARY, GAME, Server, Wire, ask, connect_tcp, run

SOURCE = pathlib.Path(__file__).parents[2]
NATIVE = os.environ.get("RACEBEAM_NATIVE", str(SOURCE / "build/release/racebeam"))
LINES = [
    "load beamfall seed=7",
    "observe frame reward ram state_hash screen",
    *["act FIRE", "act RIGHT*9"] * 20,
    "nonsense",
]
RECORDING = (b"load beamfall seed=1", b"record gif film", b"act FIRE*30", b"record stop")

pytestmark = pytest.mark.skipif(
    pathlib.Path(BINARY).name != "windows-program", reason="platforms/program runs these tests"
)


def native(*words, data=b""):
    done = subprocess.run([NATIVE, *words], input=data, capture_output=True, timeout=60)
    return done.returncode, done.stdout


class TestStandardStreams:
    @pytest.mark.parametrize("end", ("\n", "\r\n"))
    def test_a_session_is_the_same_to_the_byte_as_on_this_system(self, end):
        status, replies, _ = run("serve", "--stdio", data="".join(line + end for line in LINES).encode())
        expected = native("serve", "--stdio", data="".join(line + "\n" for line in LINES).encode())
        assert (status, replies) == expected
        assert b"\r" not in replies
        assert replies.count(b"\nok ") == len(LINES) - 2

    def test_so_is_one_of_the_classic_protocol(self):
        words = ("serve", "--classic", "--stdio", "--rom", GAME, "--seed", "3")
        data = b"1,1,0,1\n" + b"1,18\n3,18\n" * 100
        assert run(*words, data=data)[:2] == native(*words, data=data)

    def test_a_strict_session_ends_with_its_first_error(self):
        status, replies, _ = run("serve", "--stdio", "--strict", data=b"load beamfall\nnonsense\nact FIRE\n")
        assert status == 1
        assert replies.splitlines()[-1].startswith(b"error ")


class TestRefusals:
    @pytest.mark.parametrize("address", ("unix:a.sock", "systemd", "pipes:a"))
    def test_an_address_that_windows_lacks_is_refused_with_those_that_it_has(self, address):
        status, output, errors = run("serve", "--listen", address)
        assert (status, output, len(errors)) == (2, b"", 1)
        assert f"'{address}'" in errors[0] and "--listen" in errors[0]
        assert "accepted: tcp://HOST:PORT, tls://HOST:PORT, ws://HOST:PORT, wss://HOST:PORT and stdio" in errors[0]

    @pytest.mark.parametrize(
        "words, accepted",
        (
            (("serve", "--pipes", "a"), "--stdio and --listen ADDRESS"),
            (("connect", "tcp://127.0.0.1:1"), "racebeam serve --stdio"),
            (("play",), "ws://127.0.0.1:PORT"),
            (("watch", "tcp://127.0.0.1:1"), "ws://127.0.0.1:PORT"),
            (("with", "--", "python3", "agent.py"), "RACEBEAM_ADDRESS"),
        ),
    )
    def test_a_command_or_an_option_that_windows_lacks_says_what_to_do_instead(self, words, accepted):
        status, output, errors = run(*words)
        assert (status, output, len(errors)) == (2, b"", 1)
        assert "Windows" in errors[0] and accepted in errors[0]

    def test_so_does_the_classic_command(self):
        status, _, errors = run("classic", "-game_controller", "fifo_named", "a.bin")
        assert (status, len(errors)) == (1, 1)
        assert "accepted: fifo and rlglue" in errors[0]

    def test_a_bad_image_is_refused_in_a_sentence(self, tmp_path):
        (tmp_path / "bad.bin").write_bytes(b"\0" * 5)
        for name, reason in (("bad.bin", "5 bytes"), ("missing.bin", "no such file"), (".", "this is a directory")):
            status, _, errors = run("trace", "--rom", str(tmp_path / name), "--actions", "-", data=b"0\n")
            assert (status, len(errors)) == (1, 1), errors
            assert reason in errors[0]


class TestFiles:
    def test_names_may_be_long_and_have_any_letters(self, tmp_path):
        folder = tmp_path / "Müller – 卓越"
        for number in range(12):
            folder /= f"a-folder-with-a-long-name-{number}"
        folder.mkdir(parents=True)
        assert len(str(folder)) > 300
        image = folder / "größe.bin"
        image.write_bytes(next((SOURCE / "games/homebrew").glob("beamfall*.bin")).read_bytes())
        words = ("trace", "--game", "beamfall", "--actions", "-", "--rom", str(image))
        assert run(*words, data=b"1\r\n0\r\n")[:2] == native(*words, data=b"1\n0\n")

    def test_a_word_that_begins_with_a_slash_is_a_path(self, tmp_path):
        assert run("verify", str(tmp_path / "no"))[2] == [
            f"racebeam: results {tmp_path}/no: no such folder; "
            "verify takes a folder, or a log whose name ends with .episode"
        ]

    def test_a_recording_is_written_whole_and_replaces_nothing(self, tmp_path):
        with Server("serve", "--stdio", "--record-dir", str(tmp_path), streams=True) as server:
            wire = Wire(server.process.stdout.fileno(), server.process.stdin.fileno())
            for _ in range(2):
                replies = [ask(wire, line) for line in RECORDING]
            assert b"exists; choose another name" in b"".join(replies)
            assert server.stop(signal.SIGINT) == 0
        assert [path.name for path in tmp_path.iterdir()] == ["film.gif"]
        assert (tmp_path / "film.gif").read_bytes().startswith(b"GIF89a")


class TestServer:
    def test_clients_over_tcp_have_machines_of_their_own_and_the_ready_file_goes_at_the_end(self, tmp_path):
        ready = tmp_path / "ready"
        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--ready-file", str(ready)) as server:
            port = int(server.addresses(ready)[0].rsplit(":", 1)[1])
            wires = [connect_tcp(port) for _ in range(3)]
            for wire in wires:
                assert ask(wire, b"load beamfall seed=1").startswith(b"ok ")
            replies = {ask(wire, b"act FIRE") for wire in wires}
            assert len(replies) == 1
            for wire in wires:
                wire.close()
            assert server.stop(signal.SIGINT) == 0
        assert not ready.exists()

    def test_ctrl_c_ends_it_in_order_also_in_the_middle_of_a_request(self):
        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--grace", "0") as server:
            wire = connect_tcp(server.port())
            ask(wire, b"load beamfall")
            wire.send(b"act NOOP*900000\n")
            assert server.stop(signal.SIGINT) == 0
            assert wire.rest().startswith(b"error stopping ")

    def test_ctrl_c_ends_a_session_on_standard_input(self):
        with Server("serve", "--stdio", streams=True) as server:
            server.wait_for("on standard input and output")
            assert server.stop(signal.SIGINT) == 0

    def test_an_address_in_use_is_refused(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            status, _, errors = run("serve", "--listen", f"tcp://127.0.0.1:{port}")
        assert status == 3
        assert errors[-1].endswith("is in use by another server")
