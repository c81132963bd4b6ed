"""Games in the terminal: racebeam play --terminal, racebeam watch --terminal, and :screen of racebeam connect."""

import os
import signal
import socket
import time

import pytest
from harness import BINARY, PATIENCE, Server, run
from terminal import Terminal

KITTY_RELEASE = b"\x1b[32;1:3u"  # of the space bar


def environment(**more):
    return {key: value for key, value in os.environ.items() if not key.startswith("RACEBEAM_")} | more


class Wire:
    """A session over a Unix socket."""

    def __init__(self, path):
        until = time.monotonic() + PATIENCE
        while not os.path.exists(path) and time.monotonic() < until:
            time.sleep(0.01)
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(PATIENCE)
        self.socket.connect(path)
        self.file = self.socket.makefile("rw", newline="\n")

    def ask(self, line):
        self.file.write(line + "\n")
        self.file.flush()
        words = self.file.readline().split()
        assert words[0] == "ok", words
        return dict(word.split("=", 1) for word in words if "=" in word)

    def close(self):
        self.file.close()
        self.socket.close()

    def watch(self, name):
        """What a shared session shows now."""
        request = f"watch {name} screen:hex palette"
        self.ask(request)  # the server makes a copy from now on
        time.sleep(0.2)  # several frames, each of which is copied
        return self.ask(request)

    def picture(self, name):
        """The pixels of a shared session, as red, green and blue."""
        screen = self.watch(name)
        palette = bytes.fromhex(screen["palette"])
        return [tuple(palette[3 * value : 3 * value + 3]) for value in bytes.fromhex(screen["screen"])]


@pytest.mark.usefixtures("self_cleanup", "self_folder")
class InTerminal:
    def open(self, *words, **properties):
        terminal = Terminal([BINARY, *words], environment=environment(TMPDIR=self.folder, TERM="xterm"), **properties)
        self.cleanup(terminal.close)
        return terminal

    def play(self, *words, **properties):
        """A game whose server others can watch."""
        path = os.path.join(self.folder, "watch")
        terminal = self.open(
            "play", "--terminal", "--watch", "all", "--grace", "0", "--listen", f"unix:{path}", *words, **properties
        )
        terminal.wait_until(lambda: "score" in terminal.line(-1), "a game")
        wire = Wire(path)
        self.cleanup(wire.close)
        return terminal, wire, wire.ask("shared")["name"]

    def quit(self, terminal):
        terminal.type(b"q")
        assert terminal.end() == 0
        assert terminal.is_restored(), terminal.modes

    def press(self, terminal, wire, name, keys, action):
        """Types keys, as a key that is held repeats itself, until they have become an action."""

        def acts():
            terminal.type(keys)
            return self.action(wire, name) == action

        terminal.wait_until(acts, action)

    def action(self, wire, name):
        return wire.ask(f"watch {name} ram")["action"]


class TestPictures(InTerminal):
    def paused_picture(self, terminal, wire, name):
        terminal.type(b"p")
        terminal.wait_until(lambda: "paused" in terminal.line(-1), "a pause")
        return wire.picture(name)

    def test_kitty_graphics_show_each_pixel(self):
        terminal, wire, name = self.play("beamfall", graphics="kitty")
        expected = self.paused_picture(terminal, wire, name)
        assert len(set(expected)) > 3
        terminal.wait_until(lambda: terminal.picture == expected, "the picture")
        self.quit(terminal)

    def test_sixels_show_each_pixel(self):
        terminal, wire, name = self.play("beamfall", graphics="sixel", columns=160, rows=60)
        expected = self.paused_picture(terminal, wire, name)
        assert terminal.picture == [tuple((part * 100 + 127) // 255 for part in colour) for colour in expected]
        self.quit(terminal)

    def test_blocks_show_each_pixel_where_there_is_room(self):
        terminal, wire, name = self.play("beamfall", columns=320, rows=110)
        expected = self.paused_picture(terminal, wire, name)
        wide = [colour for colour in expected for _ in range(2)]  # a pixel is as wide as two blocks
        assert terminal.block_picture(320, 210) == wide
        self.quit(terminal)

    def test_the_caller_chooses_the_graphics(self):
        terminal, _, _ = self.play("--graphics", "blocks", graphics="kitty")
        assert terminal.picture is None
        assert terminal.cells[0, 0][0] == "\u2580"
        self.quit(terminal)

    def test_connect_shows_a_screen_among_text(self):
        path = os.path.join(self.folder, "s")
        with Server("serve", "--listen", f"unix:{path}") as server:
            server.wait_for("listening")
            terminal = self.open("connect", f"unix:{path}", graphics="kitty")
            terminal.type(b"load beamfall\n:screen\n")
            terminal.wait_until(lambda: terminal.picture, "a picture")
            assert len(terminal.picture) == 210 * 160
            terminal.type(b":quit\n")
            assert terminal.end() == 0


class TestKeys(InTerminal):
    def test_a_key_counts_as_pressed_for_a_short_time(self):
        terminal, wire, name = self.play(rows=60)
        self.action(wire, name)
        for keys, action in (
            (b" ", "FIRE"),
            (b"\x1b[A", "UP"),
            (b"\x1bOC", "RIGHT"),
            (b"\x1b[B\x1b[D ", "DOWNLEFTFIRE"),
        ):
            self.press(terminal, wire, name, keys, action)
            terminal.wait_until(lambda: self.action(wire, name) == "NOOP", "released")
        self.press(terminal, wire, name, b"\x1b[A\x1b[B", "DOWN")  # a direction ends the opposite one
        self.quit(terminal)

    def test_releases_are_reported_where_the_keyboard_protocol_is(self):
        terminal, wire, name = self.play(keyboard=True)
        assert "keyboard" in terminal.modes
        terminal.type(b"\x1b[32u")
        terminal.wait_until(lambda: self.action(wire, name) == "FIRE", "fire")
        begin = time.monotonic()
        terminal.wait_until(lambda: time.monotonic() > begin + 0.5, "a while")
        assert self.action(wire, name) == "FIRE"
        terminal.type(b"\x1b[1;1:1C")
        terminal.wait_until(lambda: self.action(wire, name) == "RIGHTFIRE", "right and fire")
        terminal.type(KITTY_RELEASE + b"\x1b[1;1:3C")
        terminal.wait_until(lambda: self.action(wire, name) == "NOOP", "released")
        terminal.type(b"\x1b[113u")  # q
        assert terminal.end() == 0
        assert terminal.is_restored(), terminal.modes

    def test_a_game_is_played_to_a_score_paused_and_begun_anew(self):
        terminal, wire, name = self.play("beamfall", keyboard=True)
        terminal.type(b"\x1b[32u")
        terminal.wait_until(lambda: "score 0 " not in terminal.line(-1), "a score")
        terminal.type(b"p")
        terminal.wait_until(lambda: "paused" in terminal.line(-1), "a pause")
        frame = wire.watch(name)["frame"]
        time.sleep(0.3)  # the subject: nothing is played meanwhile
        assert wire.watch(name)["frame"] == frame
        terminal.type(b"n")
        terminal.wait_until(lambda: "score 0 " in terminal.line(-1), "a new game")
        terminal.type(b"\x1b[113u")
        assert terminal.end() == 0


class TestLines(InTerminal):
    def test_pictures_are_left_out_for_a_line_that_does_not_carry_them(self):
        terminal, wire, name = self.play()
        terminal.confirms = False
        frame = int(wire.watch(name)["frame"])
        terminal.wait_until(lambda: terminal.unanswered == 2, "two pictures")
        begin, pictures = time.monotonic(), terminal.pictures
        terminal.wait_until(lambda: time.monotonic() > begin + 0.5, "a while")
        assert (terminal.unanswered, terminal.pictures) == (2, pictures)
        assert int(wire.watch(name)["frame"]) > frame + 15  # the game goes on
        terminal.confirms = True
        terminal.confirm()
        terminal.wait_until(lambda: terminal.pictures > pictures + 5, "pictures")
        self.quit(terminal)

    def test_a_terminal_that_answers_nothing_gets_blocks(self):
        terminal, wire, name = self.play(answers=False)
        assert terminal.cells[0, 0][0] == "\u2580"
        terminal.wait_until(lambda: terminal.pictures > 5, "pictures")
        self.quit(terminal)


class TestEnds(InTerminal):
    def watching(self, server, **properties):
        terminal = self.open("watch", "--terminal", f"tcp://127.0.0.1:{server.port()}", **properties)
        terminal.wait_until(lambda: "session-1" in terminal.line(-1), "a session")
        return terminal

    def test_signals_restore_the_terminal(self, cleanup, subtests):
        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s", "--watch", "all") as server:
            server.port()
            wire = Wire(server.path("s"))
            cleanup(wire.close)
            wire.ask("load beamfall")
            for number in (
                signal.SIGINT,
                signal.SIGTERM,
                signal.SIGHUP,
                signal.SIGQUIT,
                signal.SIGABRT,
                signal.SIGSEGV,
            ):
                for graphics in ("blocks", "kitty"):
                    with subtests.test(number, graphics=graphics):
                        terminal = self.watching(server, graphics=graphics, keyboard=True)
                        assert {"?1049", "keyboard"} <= terminal.modes
                        os.kill(terminal.child, number)
                        assert terminal.end() == -number
                        assert terminal.is_restored(), terminal.modes
            terminal = self.watching(server, keyboard=True)
            terminal.type(b"\x1b[99;5u")  # Ctrl-C in the keyboard protocol
            assert terminal.end() == -signal.SIGINT
            assert terminal.is_restored(), terminal.modes
            terminal = self.watching(server)
            server.stop(signal.SIGKILL)
            terminal.wait_until(lambda: "?25" in terminal.modes or not terminal.work(0), "the end")
            assert terminal.end() == 1
            assert terminal.is_restored(), terminal.modes

    def test_ctrl_c_and_a_signal_end_a_game_and_its_server(self):
        for end, status in (
            (lambda terminal: terminal.type(b"\x03"), 130),
            (lambda terminal: os.kill(terminal.child, signal.SIGTERM), 143),
        ):
            terminal, wire, _ = self.play()
            end(terminal)
            assert terminal.end() == status
            assert terminal.is_restored(), terminal.modes
            assert wire.file.readline().split()[:2] == ["error", "stopping"]
            assert os.listdir(self.folder) == []

    def test_what_cannot_be_drawn_is_refused(self):
        status, output, errors = run("play", "--terminal")
        assert (status, output) == (2, b"")
        assert errors == [
            "racebeam: --terminal: standard input and output must be a terminal (see racebeam play --help)"
        ]
        assert "accepted: auto, blocks, kitty" in run("play", "--terminal", "--graphics", "ascii")[2][0]
        terminal = self.open("play", "--terminal", "updraft", "--max-sessions", "0")
        assert terminal.end() == 2
