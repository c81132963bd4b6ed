"""The agents in clients/shell play, each over its own way to connect."""

import os
import shutil
import subprocess
import unittest

from test_clients import SOURCE  # which finds the harness

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

    @unittest.skipUnless(shutil.which("mawk"), "there is no mawk")
    def test_awk_plays_over_pipes_as_bash_does_over_tcp(self):
        with Server(*TCP) as server:
            expected = run(os.path.join(SHELL, "agent.bash"), "127.0.0.1", str(server.port())).stdout
        with Server("serve", "--pipes", "game") as server:
            server.wait_for("for a client that opens")
            with open(server.path("game_out")) as replies, open(server.path("game_in"), "w") as requests:
                done = run(os.path.join(SHELL, "agent.awk"), stdin=replies, stdout=requests, stderr=subprocess.PIPE)
        self.assertEqual((done.returncode, done.stderr), (0, expected))

    @unittest.skipUnless(shutil.which("nc"), "there is no nc")
    def test_nc_asks(self):
        with Server(*TCP) as server:
            command = f"printf '%s\\n' 'load beamfall seed=1' 'act FIRE*60' | nc -N 127.0.0.1 {server.port()}"
            done = run("bash", "-c", command)
        self.assertRegex(done.stdout, r"^ok game=beamfall .*\nok reward=\d+ .*\n$")


if __name__ == "__main__":
    main()
