"""racebeam play and racebeam watch: the page of a server, and its sessions in the terminal."""

import os
import pty
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import urllib.request

from harness import BINARY, PATIENCE, SOURCE, Server, main, run
from web.web_socket import WebSocket


def environment(**more):
    """An environment without a desktop and without settings."""
    left_out = ("DISPLAY", "WAYLAND_DISPLAY")
    return {
        key: value for key, value in os.environ.items() if key not in left_out and not key.startswith("RACEBEAM_")
    } | more


class Play(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def start(self, *words, **more):
        process = subprocess.Popen(
            [BINARY, "play", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment(TMPDIR=self.folder, **more),
        )
        self.addCleanup(process.kill)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        return process

    def end(self, process):
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, output, errors), (0, "", ""))
        self.assertEqual(os.listdir(self.folder), [])

    def test_it_serves_a_page_and_sessions_with_a_token_until_it_is_interrupted(self):
        process = self.start("beamfall")
        found = re.fullmatch(
            r"http://127\.0\.0\.1:(\d+)/\?game=beamfall#token=([0-9a-f]{64})\n", process.stdout.readline()
        )
        port, token = int(found[1]), found[2]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/?game=beamfall", timeout=PATIENCE) as page:
            self.assertIn(b"<html", page.read())
        session = WebSocket(port, Origin=f"http://127.0.0.1:{port}")
        self.assertTrue(session.ask(b"load beamfall").startswith(b"error unauthorized "))
        self.assertIn(b" admitted=1 ", session.ask(b"hello token=" + token.encode()))
        self.assertTrue(session.ask(b"load beamfall").startswith(b"ok game=beamfall "))
        session.close()
        self.end(process)

    def test_it_begins_with_the_image_of_the_command_line(self):
        image = os.path.join(self.folder, "image")
        os.mkdir(image)
        shutil.copy(os.path.join(SOURCE, "games/homebrew/updraft.bin"), os.path.join(image, "mine.bin"))
        process = self.start("--rom", os.path.join(image, "mine.bin"))
        self.assertRegex(process.stdout.readline(), r"/\?game=updraft#token=")
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
        self.assertRegex(page, r"^http://127\.0\.0\.1:\d+/#token=[0-9a-f]+\n$")
        self.assertEqual(process.stdout.readline(), "opened " + page)
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
            self.assertEqual((status, output, len(errors)), (2, b"", 1), errors)
            self.assertIn(hint, errors[0])
        status, _, errors = run("play", "--listen", "tcp://127.0.0.1:0")
        self.assertEqual(status, 1)
        self.assertIn("needs an address ws://HOST:PORT", errors[-1])


class Watch(unittest.TestCase):
    def setUp(self):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "ws://127.0.0.1:0", "--grace", "0")
        self.addCleanup(self.server.__exit__)
        self.address = f"tcp://127.0.0.1:{self.server.port()}"
        self.port = int(self.server.wait_for(r"listening on ws://127\.0\.0\.1:(\d+)$")[1])

    def share(self, name, game="beamfall"):
        session = WebSocket(self.port)
        self.addCleanup(session.close)
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
            self.assertEqual(
                (done.returncode, done.stdout, done.stderr), (0, f"http://127.0.0.1:{self.port}/#watch\n", "")
            )
        done = self.watch(self.address)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("other addresses with --terminal", done.stderr)

    def test_without_a_terminal_one_picture_is_written(self):
        self.share("a"), self.share("b", "updraft")
        for words, status in (([], "a  game beamfall"), (["--session", "b"], "b  game updraft")):
            done = self.watch("--terminal", self.address, *words)
            lines = done.stdout.splitlines()
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn(status, lines[-1])
            self.assertIn("score 0", lines[-1])
            self.assertEqual({line.count("\u2580") for line in lines[:-1]}, {80})

    def test_without_a_terminal_a_missing_picture_is_a_failure(self):
        for words, reason in (
            ([], "no session is shared"),
            (["--session", "nosuch"], "unknown shared session 'nosuch'"),
        ):
            done = self.watch("--terminal", self.address, *words)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (1, "", 1), done)
            self.assertTrue(done.stderr.startswith(f"racebeam: {reason}"), done.stderr)

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
        self.assertIn("\u2580", screen)
        os.write(terminal, b"n")
        self.wait_for_screen(terminal, "b  game updraft")
        os.write(terminal, b"p")
        self.wait_for_screen(terminal, "a  game beamfall")
        os.write(terminal, b"q")
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertTrue(score)

    def wait_for_screen(self, terminal, pattern):
        """What the terminal shows until `pattern` comes."""
        text, until = b"", time.monotonic() + PATIENCE
        while time.monotonic() < until and not re.search(pattern.encode(), text):
            if select.select([terminal], [], [], 0.1)[0]:
                text += os.read(terminal, 65536)
        self.assertRegex(text.decode(errors="replace"), pattern)
        return text.decode(errors="replace")


if __name__ == "__main__":
    main()
