"""racebeam with: a server for as long as a command runs."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import pytest
from harness import BINARY, PATIENCE, SOURCE

CLIENT = os.path.join(SOURCE, "clients", "python", "single_file")
PLAY = f"""import os, sys
sys.path.insert(0, {CLIENT!r})
import client
with client.connect() as game:
    game.load("beamfall", seed=1, sticky=0)
    game.observe("reward")
    print(sum(game.act("FIRE")["reward"] for _ in range(200)), os.environ["RACEBEAM_ADDRESS"])
"""


@pytest.mark.usefixtures("self_cleanup")
class TestWith:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.place = tmp_path
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("RACEBEAM_")}
        self.environment |= {"TMPDIR": str(self.place), "PYTHONDONTWRITEBYTECODE": "1"}

    def run_with(self, *words, **options):
        done = subprocess.run(
            [BINARY, "with", *words],
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            **options,
        )
        self.nothing_is_left()
        return done.returncode, done.stdout, done.stderr

    def start(self, *words):
        process = subprocess.Popen(
            [BINARY, "with", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment
        )
        self.cleanup(process.stdout.close)
        self.cleanup(process.stderr.close)
        self.cleanup(process.kill)
        return process

    def processes(self):
        """The processes that were started with the folder of this test."""
        mark = f"TMPDIR={self.place}".encode()
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdecimal() and mark in (entry / "environ").read_bytes().split(b"\0"):
                    found.append((entry / "cmdline").read_bytes())
            except OSError:
                continue
        return [command for command in found if command]

    def nothing_is_left(self):
        deadline = time.monotonic() + PATIENCE
        while (left := (self.processes(), os.listdir(self.place))) != ([], []):
            assert time.monotonic() < deadline, left
            time.sleep(0.01)

    def test_a_client_plays_and_nothing_is_left(self):
        status, output, errors = self.run_with("--", sys.executable, "-c", PLAY)
        assert (status, errors) == (0, "")
        assert re.search(rf"^\d+ file:{self.place}/racebeam-\w{{6}}/announce$", output)

    @pytest.mark.needs_programs("bash")
    def test_a_client_without_Unix_sockets_gets_the_port_and_the_token(self):
        script = (
            f"source {SOURCE}/clients/shell/racebeam.bash; racebeam_connect && racebeam_ask load beamfall "
            f"&& racebeam_value game"
        )
        assert self.run_with("--", "bash", "-c", script) == (0, "beamfall\n", "")

    def test_options_are_those_of_serve(self):
        status, output, errors = self.run_with(
            "--listen",
            "tcp://127.0.0.1:0",
            "--log-level",
            "info",
            "--threads",
            "1",
            "--",
            "sh",
            "-c",
            'cat "${RACEBEAM_ADDRESS#file:}"',
        )
        assert status == 0
        assert "racebeam: threads: 1, limited by --threads\n" in errors
        assert "unix:" not in output
        assert '"tcp://127.0.0.1:' in output

    def test_a_path_that_is_too_long_for_a_Unix_socket_leaves_the_port(self):
        longest = 107  # bytes, beside the NUL
        for length in (longest, longest + 1):
            with tempfile.TemporaryDirectory(dir="/tmp") as folder:
                name = "x" * (length - len(f"{folder}//racebeam-123456/socket"))
                self.place = pathlib.Path(folder, name)
                self.place.mkdir()
                self.environment["TMPDIR"] = str(self.place)
                status, output, errors = self.run_with("--", "sh", "-c", 'cat "${RACEBEAM_ADDRESS#file:}"')
            assert (status, errors) == (0, "")
            assert ('"unix:' in output) == (length == longest)
            assert '"tcp://127.0.0.1:' in output

    @pytest.mark.parametrize(
        "command, expected",
        (
            (["true"], 0),
            (["sh", "-c", "exit 7"], 7),
            (["sh", "-c", "kill -9 $$"], 137),
            (["sh", "-c", "kill -TERM $$"], 143),
        ),
    )
    def test_the_status_is_that_of_the_command(self, command, expected):
        assert self.run_with("--", *command) == (expected, "", "")

    def test_the_server_has_ended_when_the_status_is_there(self):
        for _ in range(3):
            # A server without a pipe of ours does not keep us waiting.
            done = subprocess.run(
                [BINARY, "with", "--", "true"],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=PATIENCE,
                env=self.environment,
            )
            assert (done.returncode, self.processes(), os.listdir(self.place)) == (0, [], [])

    def test_a_command_that_cannot_be_executed_has_the_status_of_shells(self):
        assert self.run_with("--", "no-such-program", "x") == (
            127,
            "",
            "racebeam: cannot execute no-such-program: No such file or directory\n",
        )
        assert self.run_with("--", "/etc/passwd") == (
            126,
            "",
            "racebeam: cannot execute /etc/passwd: Permission denied\n",
        )

    def test_standard_input_is_that_of_the_command(self):
        done = subprocess.run(
            [BINARY, "with", "--", "cat"], input=b"hello", capture_output=True, timeout=PATIENCE, env=self.environment
        )
        assert (done.returncode, done.stdout) == (0, b"hello")

    def test_a_server_that_dies_at_its_start_is_the_end(self):
        status, output, errors = self.run_with("--roms", "/nowhere", "--", "echo", "unreached")
        assert (status, output, errors) == (4, "", "racebeam: --roms /nowhere is not a folder\n")

    @pytest.mark.parametrize(
        "words, hint",
        (
            (["--stdio", "--", "true"], "--stdio: requires racebeam serve"),
            (["--pipes", "p", "--", "true"], "--pipes: requires racebeam serve"),
            (["--announce", "a", "--", "true"], "--announce: requires racebeam serve"),
            (["--ready-file", "a", "--", "true"], "--ready-file: requires racebeam serve"),
            (["--listen", "classic+unix:s", "--rom", "builtin:beamfall", "--", "true"], "--announce: requires"),
            ([], "COMMAND is required"),
            (["--speed", "--", "true"], "unknown argument: --speed"),
        ),
    )
    def test_what_does_not_fit_is_a_usage_error(self, words, hint):
        status, output, errors = self.run_with(*words, cwd=self.place)
        assert (status, output) == (2, ""), errors
        assert hint in errors

    @pytest.mark.parametrize("number", (signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGUSR1))
    def test_signals_are_passed_on(self, number):
        process = self.start(
            "--",
            sys.executable,
            "-c",
            "import signal, sys\n"
            f"signal.signal({int(number)}, lambda *_: sys.exit(9))\n"
            "print('ready', flush=True)\nwhile True: signal.pause()",
        )
        assert process.stdout.readline() == "ready\n"
        process.send_signal(number)
        assert process.wait(PATIENCE) == 9
        self.nothing_is_left()

    def test_a_signal_before_the_server_is_ready_stops_it(self):
        process = self.start("--", "sleep", "60")
        while not os.listdir(self.place):  # its folder is the first that it makes
            time.sleep(0.001)
        process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE) == 143
        self.nothing_is_left()

    def test_if_it_is_killed_nothing_is_left_either(self):
        process = self.start("--", "sh", "-c", "echo ready; exec sleep 60")
        assert process.stdout.readline() == "ready\n"
        process.kill()
        self.nothing_is_left()

    def test_a_server_that_dies_in_the_middle_is_reported(self):
        script = (
            'kill -9 $(sed -n \'s/^ "process": \\([0-9]*\\),$/\\1/p\' "${RACEBEAM_ADDRESS#file:}"); sleep 0.3; exit 3'
        )
        assert self.run_with("--", "sh", "-c", script) == (3, "", "racebeam: the server has ended with status 137\n")
