"""The agents in clients/shell play, each over its own way to connect."""

import os
import re
import socketserver
import subprocess
import tempfile
import threading

import pytest

# isort: split
from test_clients import SOURCE  # which finds the harness

# isort: split
from harness import PATIENCE, Server

SHELL = os.path.join(SOURCE, "clients", "shell")
TCP = ("serve", "--listen", "tcp://127.0.0.1:0")


def run(*words, **streams):
    return subprocess.run(words, capture_output="stdout" not in streams, text=True, timeout=PATIENCE * 5, **streams)


class TestAgents:
    def test_bash_plays_over_tcp(self):
        with Server(*TCP) as server:
            done = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", str(server.port()))
        assert (done.returncode, done.stderr) == (0, "")
        assert re.search(r"^score [1-9]\d*\n$", done.stdout)

    def test_bash_says_that_no_server_is_there(self):
        done = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", "1")
        assert done.returncode != 0
        assert "Connection refused" in done.stderr

    def page(self, address):
        """Runs the script of the page."""
        with open(os.path.join(SHELL, "README.md")) as page:
            script = re.search(r"```shell\n(.*?)```", page.read(), re.DOTALL)[1]
        return run(
            "bash",
            "-c",
            script,
            env=os.environ | {"PATH": f"{SHELL}:{os.environ['PATH']}", "RACEBEAM_ADDRESS": address},
        )

    def test_the_script_of_the_page_ends_without_a_server(self):
        done = self.page("file:/nonexistent/announce")
        assert (done.returncode, done.stdout, done.stderr) == (1, "", "/nonexistent/announce cannot be read\n")

    def test_a_server_that_is_missing_is_a_sentence_and_a_status(self):
        for call, sentence in (
            ("racebeam_connect pipes:/nonexistent/game", "no server answers at pipes:/nonexistent/game"),
            ("racebeam_launch /nonexistent/racebeam", "there is no program /nonexistent/racebeam"),
        ):
            done = run("bash", "-c", f'source {SHELL}/racebeam.bash; {call}; echo "$? $racebeam_error"')
            assert (done.stdout, done.stderr) == (f"2 {sentence}\n", "")

    def test_the_script_of_the_page_ends_when_its_server_goes(self):
        class Leaving(socketserver.StreamRequestHandler):
            def handle(self):
                for reply in ("server=test protocol=1", "height=210", "fields=reward"):
                    self.rfile.readline()
                    self.wfile.write(f"ok {reply}\n".encode())
                self.rfile.readline()

        with socketserver.TCPServer(("127.0.0.1", 0), Leaving) as server:
            threading.Thread(target=server.handle_request).start()
            done = self.page(f"tcp://127.0.0.1:{server.server_address[1]}")
        assert (done.returncode, done.stdout) == (1, "")
        assert done.stderr == "the server has closed the connection, or sent an endless line\n"

    @pytest.mark.parametrize(
        "script",
        [
            "racebeam_ask load beamfall; racebeam_bytes 0 screen delta 000001AA01",
            "racebeam_ask watch room screen:delta; racebeam_bytes @room screen delta 000001AA01",
            "racebeam_ask look; echo $((1 + $(racebeam_number height)))",
        ],
    )
    def test_what_a_server_sends_is_not_executed(self, script, tmp_path):
        class Hostile(socketserver.StreamRequestHandler):
            def handle(self):
                for reply in ("protocol=1", "height=a[$(touch${IFS}executed)]"):
                    self.rfile.readline()
                    self.wfile.write(f"ok {reply}\n".encode())
                self.rfile.readline()

        with socketserver.TCPServer(("127.0.0.1", 0), Hostile) as server:
            threading.Thread(target=server.handle_request, daemon=True).start()
            connect = f"source {SHELL}/racebeam.bash; racebeam_connect tcp://127.0.0.1:{server.server_address[1]}"
            run("bash", "-c", f"{connect} && {script}", cwd=tmp_path)
        assert list(tmp_path.iterdir()) == []

    def test_the_name_of_a_watched_session_is_not_executed(self, tmp_path):
        script = """key='@a[$(touch executed)] screen'; racebeam_arrays[$key]=00; _racebeam_forget '@*'
        echo "${#racebeam_arrays[@]}" """
        done = run("bash", "-c", f"source {SHELL}/racebeam.bash; {script}", cwd=tmp_path)
        assert (done.stdout, done.stderr, list(tmp_path.iterdir())) == ("0\n", "", [])

    def test_a_number_is_not_another_text(self):
        script = """racebeam_reply=' reward=-12 name=x big=1234567890123456789 empty='
        for key in reward name big empty missing; do echo "$(racebeam_number $key)"; done"""
        done = run("bash", "-c", f"source {SHELL}/racebeam.bash; {script}")
        assert (done.stdout, done.stderr) == ("-12\n\n\n\n\n", "")

    def test_a_file_that_names_no_server_is_refused_in_a_sentence(self):
        tail = "; file:PATH takes the --ready-file or --announce file of a server"
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "file")
            for text, reason in (
                (b"", f"{file} is empty{tail}"),
                (b"dear diary\n", f"{file} has other contents{tail}"),
                (b"{\0\xff\x80\n", f"{file} is not a whole announce file"),
                (b"# addresses\ntcp://127.0.0.1:1\n", f"no server answers at tcp://127.0.0.1:1, which {file} names"),
            ):
                with open(file, "wb") as written:
                    written.write(text)
                assert self.page(f"file:{file}").stderr == reason + "\n"
            assert self.page(f"file:{folder}").stderr == f"{folder} is not a regular file{tail}\n"
            for time in ("", "x", "-1", "1e3", "99999999999999999999"):
                assert (
                    self.page(f"file:{file}?wait={time}").stderr
                    == f"the address is 'file:{file}?wait={time}'; ?wait= takes seconds, from 0 to 999999999\n"
                )

    @pytest.mark.needs_programs("mawk")
    def test_awk_plays_over_pipes_as_bash_does_over_tcp(self):
        with Server(*TCP) as server:
            expected = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", str(server.port())).stdout
        with Server("serve", "--pipes", "game") as server:
            server.wait_for("for a client that opens")
            with open(server.path("game_out")) as replies, open(server.path("game_in"), "w") as requests:
                done = run(os.path.join(SHELL, "agent.awk"), stdin=replies, stdout=requests, stderr=subprocess.PIPE)
        assert (done.returncode, done.stderr) == (0, expected)

    @pytest.mark.needs_programs("nc")
    def test_nc_asks(self):
        with Server(*TCP) as server:
            command = f"printf '%s\\n' 'load beamfall seed=1' 'act FIRE*60' | nc -N 127.0.0.1 {server.port()}"
            done = run("bash", "-c", command)
        assert re.search(r"^ok game=beamfall .*\nok reward=\d+ .*\n$", done.stdout)


class TestCompletion:
    """What Tab offers after racebeam_ask."""

    SCRIPT = """source "$1/completion.bash"; COMP_LINE=$2 COMP_POINT=${#2}; COMP_WORDBREAKS=$' \\t\\n"\\'@><=;|&(:'
    _racebeam_complete; printf '%s\\n' "${COMPREPLY[@]}" """

    def completions(self, typed):
        done = run("bash", "-c", self.SCRIPT, "bash", SHELL, f"racebeam_ask {typed}")
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout.split()

    def test_commands(self):
        assert self.completions("obs") == ["observe"]
        assert "load" in self.completions("")

    def test_keys_and_their_values(self):
        assert self.completions("load beamfall noop") == ["noop_max="]
        assert self.completions("load beamfall seed=3 life_loss=re") == ["reported", "restart"]
        assert self.completions("load beamfall preset=dq") == ["dqn2015"]
        assert self.completions("open 4 autoreset=s") == ["same-step"]

    def test_fields_and_their_encodings(self):
        assert self.completions("observe reward scr") == ["screen"]
        assert self.completions("watch room screen:de") == ["delta"]
        assert self.completions("observe no") == ["none"]

    def test_what_help_explains(self):
        assert self.completions("help life") == ["life_loss"]

    def test_nothing_after_an_unknown_command(self):
        assert self.completions("dance re") == []
