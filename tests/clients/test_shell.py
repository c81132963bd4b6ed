"""The agents in clients/shell play, each over its own way to connect."""

import os
import re
import shutil
import socketserver
import subprocess
import tempfile
import threading
import unittest

# isort: split
from test_clients import SOURCE  # which finds the harness

# isort: split
from harness import PATIENCE, Server, main

SHELL = os.path.join(SOURCE, "clients", "shell")
TCP = ("serve", "--listen", "tcp://127.0.0.1:0")


def run(*words, **streams):
    return subprocess.run(words, capture_output="stdout" not in streams, text=True, timeout=PATIENCE * 5, **streams)


class Agents(unittest.TestCase):
    def test_bash_plays_over_tcp(self):
        with Server(*TCP) as server:
            done = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", str(server.port()))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"^score [1-9]\d*\n$")

    def test_bash_says_that_no_server_is_there(self):
        done = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", "1")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("Connection refused", done.stderr)

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
        self.assertEqual((done.returncode, done.stdout, done.stderr), (1, "", "/nonexistent/announce cannot be read\n"))

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
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertEqual(done.stderr, "the server has closed the connection, or sent an endless line\n")

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
                self.assertEqual(self.page(f"file:{file}").stderr, reason + "\n")
            self.assertEqual(self.page(f"file:{folder}").stderr, f"{folder} is not a regular file{tail}\n")
            for time in ("", "x", "-1", "1e3", "99999999999999999999"):
                self.assertEqual(
                    self.page(f"file:{file}?wait={time}").stderr,
                    f"the address is 'file:{file}?wait={time}'; ?wait= takes seconds, from 0 to 999999999\n",
                )

    @unittest.skipUnless(shutil.which("mawk"), "mawk is not installed")
    def test_awk_plays_over_pipes_as_bash_does_over_tcp(self):
        with Server(*TCP) as server:
            expected = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", str(server.port())).stdout
        with Server("serve", "--pipes", "game") as server:
            server.wait_for("for a client that opens")
            with open(server.path("game_out")) as replies, open(server.path("game_in"), "w") as requests:
                done = run(os.path.join(SHELL, "agent.awk"), stdin=replies, stdout=requests, stderr=subprocess.PIPE)
        self.assertEqual((done.returncode, done.stderr), (0, expected))

    @unittest.skipUnless(shutil.which("nc"), "nc is not installed")
    def test_nc_asks(self):
        with Server(*TCP) as server:
            command = f"printf '%s\\n' 'load beamfall seed=1' 'act FIRE*60' | nc -N 127.0.0.1 {server.port()}"
            done = run("bash", "-c", command)
        self.assertRegex(done.stdout, r"^ok game=beamfall .*\nok reward=\d+ .*\n$")


class Completion(unittest.TestCase):
    """What Tab offers after racebeam_ask."""

    SCRIPT = """source "$1/completion.bash"; COMP_LINE=$2 COMP_POINT=${#2}; COMP_WORDBREAKS=$' \\t\\n"\\'@><=;|&(:'
    _racebeam_complete; printf '%s\\n' "${COMPREPLY[@]}" """

    def completions(self, typed):
        done = run("bash", "-c", self.SCRIPT, "bash", SHELL, f"racebeam_ask {typed}")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    def test_commands(self):
        self.assertEqual(self.completions("obs"), ["observe"])
        self.assertIn("load", self.completions(""))

    def test_keys_and_their_values(self):
        self.assertEqual(self.completions("load beamfall noop"), ["noop_max="])
        self.assertEqual(self.completions("load beamfall seed=3 life_loss=re"), ["reported", "restart"])
        self.assertEqual(self.completions("load beamfall preset=dq"), ["dqn2015"])
        self.assertEqual(self.completions("open 4 autoreset=s"), ["same-step"])

    def test_fields_and_their_encodings(self):
        self.assertEqual(self.completions("observe reward scr"), ["screen"])
        self.assertEqual(self.completions("watch room screen:de"), ["delta"])
        self.assertEqual(self.completions("observe no"), ["none"])

    def test_what_help_explains(self):
        self.assertEqual(self.completions("help life"), ["life_loss"])

    def test_nothing_after_an_unknown_command(self):
        self.assertEqual(self.completions("dance re"), [])


if __name__ == "__main__":
    main()
