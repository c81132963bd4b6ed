"""racebeam play and racebeam watch: the page of a server, and its sessions in the terminal."""

import os
import pty
import re
import select
import shutil
import signal
import subprocess
import time
import urllib.request

import pytest
from harness import BINARY, PATIENCE, SOURCE, Server, run
from web.web_socket import WebSocket


def environment(**more):
    """An environment without a desktop and without settings."""
    left_out = ("DISPLAY", "WAYLAND_DISPLAY")
    return {
        key: value for key, value in os.environ.items() if key not in left_out and not key.startswith("RACEBEAM_")
    } | more


@pytest.mark.usefixtures("self_cleanup", "self_folder")
class TestPlay:
    def start(self, *words, **more):
        process = subprocess.Popen(
            [BINARY, "play", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment(TMPDIR=self.folder, **more),
        )
        self.cleanup(process.kill)
        self.cleanup(process.stdout.close)
        self.cleanup(process.stderr.close)
        return process

    def end(self, process):
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=PATIENCE)
        assert (process.returncode, output, errors) == (0, "", "")
        assert os.listdir(self.folder) == []

    def test_it_serves_a_page_and_sessions_with_a_token_until_it_is_interrupted(self):
        process = self.start("beamfall")
        found = re.fullmatch(
            r"http://127\.0\.0\.1:(\d+)/\?game=beamfall#token=([0-9a-f]{64})\n", process.stdout.readline()
        )
        port, token = int(found[1]), found[2]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/?game=beamfall", timeout=PATIENCE) as page:
            assert b"<html" in page.read()
        session = WebSocket(port, Origin=f"http://127.0.0.1:{port}")
        assert session.ask(b"load beamfall").startswith(b"error unauthorized ")
        assert b" admitted=1 " in session.ask(b"hello token=" + token.encode())
        assert session.ask(b"load beamfall").startswith(b"ok game=beamfall ")
        session.close()
        self.end(process)

    def test_it_begins_with_the_image_of_the_command_line(self):
        image = os.path.join(self.folder, "image")
        os.mkdir(image)
        shutil.copy(os.path.join(SOURCE, "games/homebrew/updraft.bin"), os.path.join(image, "mine.bin"))
        process = self.start("--rom", os.path.join(image, "mine.bin"))
        assert re.search(r"/\?game=updraft#token=", process.stdout.readline())
        shutil.rmtree(image)
        self.end(process)

    def test_a_desktop_opens_the_page(self):
        opener = os.path.join(self.folder, "bin")
        os.mkdir(opener)
        with open(os.path.join(opener, "xdg-open"), "w") as script:
            script.write('#!/bin/sh\necho "opened $1"\n')
        os.chmod(script.name, 0o755)
        process = self.start(DISPLAY=":0", PATH=f"{opener}:{os.environ['PATH']}")
        page = process.stdout.readline()
        assert re.search(r"^http://127\.0\.0\.1:\d+/#token=[0-9a-f]+\n$", page)
        assert process.stdout.readline() == "opened " + page
        shutil.rmtree(opener)
        self.end(process)

    def test_what_it_cannot_do_is_refused(self):
        for words, hint in (
            (["beamfal"], "did you mean beamfall?"),
            (
                ["pong", "--roms", self.folder],
                f"no image of pong was found in these places: the program's own games, --roms {self.folder}",
            ),
            (["--stdio"], "requires racebeam serve"),
            (["--announce", "x"], "requires racebeam serve"),
        ):
            status, output, errors = run("play", *words)
            assert (status, output, len(errors)) == (2, b"", 1), errors
            assert hint in errors[0]
        status, _, errors = run("play", "--listen", "tcp://127.0.0.1:0")
        assert status == 1
        assert "needs an address ws://HOST:PORT" in errors[-1]


@pytest.mark.usefixtures("self_cleanup")
class TestWatch:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "ws://127.0.0.1:0", "--grace", "0")
        cleanup(self.server.__exit__)
        self.address = f"tcp://127.0.0.1:{self.server.port()}"
        self.port = int(self.server.wait_for(r"listening on ws://127\.0\.0\.1:(\d+)$")[1])

    def share(self, name, game="beamfall"):
        session = WebSocket(self.port)
        self.cleanup(session.close)
        session.ask(f"load {game} seed=1".encode())
        session.ask(f"share {name}".encode())
        return session

    def watch(self, *words):
        return subprocess.run(
            [BINARY, "watch", *words],
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            env=environment(),
            stdin=subprocess.DEVNULL,
        )

    def test_the_page_of_a_server_is_named(self):
        for address in (
            f"ws://127.0.0.1:{self.port}",
            f"http://127.0.0.1:{self.port}",
            f"http://127.0.0.1:{self.port}/",
        ):
            done = self.watch(address)
            assert (done.returncode, done.stdout, done.stderr) == (0, f"http://127.0.0.1:{self.port}/#watch\n", "")
        done = self.watch(self.address)
        assert (done.returncode, done.stdout) == (2, "")
        assert "other addresses with --terminal" in done.stderr

    def test_without_a_terminal_one_picture_is_written(self):
        self.share("a"), self.share("b", "updraft")
        for words, status in (([], "a  game beamfall"), (["--session", "b"], "b  game updraft")):
            done = self.watch("--terminal", self.address, *words)
            lines = done.stdout.splitlines()
            assert (done.returncode, done.stderr) == (0, "")
            assert status in lines[-1]
            assert "score 0" in lines[-1]
            assert {line.count("\u2580") for line in lines[:-1]} == {80}

    def test_without_a_terminal_a_missing_picture_is_a_failure(self):
        for words, reason in (
            ([], "no session is shared"),
            (["--session", "nosuch"], "unknown shared session 'nosuch'"),
        ):
            done = self.watch("--terminal", self.address, *words)
            assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1), done
            assert done.stderr.startswith(f"racebeam: {reason}"), done.stderr

    def test_a_terminal_shows_what_is_played_and_takes_keys(self):
        session = self.share("a")
        self.share("b", "updraft")
        child, terminal = pty.fork()
        if child == 0:
            os.execve(BINARY, [BINARY, "watch", "--terminal", self.address], environment(TERM="xterm"))
        screen = self.wait_for_screen(terminal, "a  game beamfall  score 0")
        session.ask(b"act FIRE*200")
        score = re.search(rb"score=(\d+)", session.ask(b"watch a"))
        session.ask(b"act NOOP")
        screen = self.wait_for_screen(terminal, r"a  game beamfall  score [1-9]")
        assert "\u2580" in screen
        os.write(terminal, b"n")
        self.wait_for_screen(terminal, "b  game updraft")
        os.write(terminal, b"p")
        self.wait_for_screen(terminal, "a  game beamfall")
        os.write(terminal, b"q")
        assert os.waitpid(child, 0)[1] == 0
        assert score

    def wait_for_screen(self, terminal, pattern):
        """What the terminal shows until `pattern` comes."""
        text, until = b"", time.monotonic() + PATIENCE
        while time.monotonic() < until and not re.search(pattern.encode(), text):
            if select.select([terminal], [], [], 0.1)[0]:
                text += os.read(terminal, 65536)
        assert re.search(pattern, text.decode(errors="replace"))
        return text.decode(errors="replace")
