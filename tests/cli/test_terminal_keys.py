"""Keys of games in the terminal, lines that are slow or do not carry pictures, and how such games end."""

import os
import signal
import time

import pytest
from harness import Server, run
from in_terminal import InTerminal, Wire

# An image that copies SWCHA, INPT4 and INPT5 to the first bytes of RAM in each frame. A bit is 0 for a pressed switch.
PORTS = bytes.fromhex("78D8A2FF9AA90285008502850285028500A9008500AD80028580A50C8581A50D8582A2FF8502CAD0FB4C05F0")
KITTY_RELEASE = b"\x1b[32;1:3u"  # of the space bar


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

    def test_two_players_have_keys(self):
        path = os.path.join(self.folder, "ports.bin")
        with open(path, "wb") as image:
            image.write(PORTS.ljust(0xFFC, b"\xea") + b"\0\xf0\0\xf0")
        terminal, wire, name = self.play("--rom", path)
        for keys, pressed in (
            (b"\x1b[A", ("A up",)),
            (b"\x1b[C\x1b[D\x1b[B ", ("A down", "A left", "A fire")),
            (b"w", ("B up",)),
            (b"wsadg", ("B down", "B right", "B fire")),
            (b"A", ("B left",)),  # with Caps Lock
            (b" \x1b[Cg", ("A right", "A fire", "B fire")),
            (b"x\x1b[E\x1b[5~ ", ("A fire",)),  # other keys have no effect
        ):
            for keys_now, expected in ((keys, pressed), (b"", ())):
                terminal.wait_until(lambda: self.pressed(terminal, wire, name, keys_now) == expected, expected)
        os.remove(path)
        self.quit(terminal)

    def pressed(self, terminal, wire, name, keys):
        """The switches that the machine has as pressed."""
        terminal.type(keys)
        directions, fire_a, fire_b = bytes.fromhex(wire.ask(f"watch {name} ram")["ram"])[:3]
        words = [f"{player} {word}" for player in "BA" for word in ("up", "down", "left", "right")]
        found = [word for bit, word in enumerate(words) if not directions >> bit & 1]
        found += [word for word, byte in (("A fire", fire_a), ("B fire", fire_b)) if byte < 128]
        return tuple(sorted(found, key=lambda word: (word[0], word.endswith("fire"))))

    def test_a_key_may_come_in_pieces(self):
        terminal, wire, name = self.play()

        def acts():
            for key in b"\x1b[1;1C":
                terminal.type(bytes([key]))
                time.sleep(0.01)  # it is read alone
            return self.action(wire, name) == "RIGHT"

        terminal.wait_until(acts, "RIGHT")
        self.quit(terminal)

    def test_bytes_that_are_not_a_key_have_no_effect(self):
        terminal, wire, name = self.play()
        for text in (
            b"\x1b]0;qnp\x1b\\",  # the title of a window
            b"\x1bP1$rqnp\x1b\\",
            b"\x1b_Gi=32;qnp\x1b\\",
            b"\x1b[200~\x1b[?1;2y\x1b[3;4R",
            b"\x1b]" + 600 * b"x",  # its end is lost
            b"\x1b[" + 600 * b"1",
            b"\x1b[99;2u\x1b[99u\x1b[100;5u\x1b[99;3u",  # C without Ctrl, and Ctrl-D
            b"\x1bOP\x1b",
        ):
            terminal.type(text)
            self.press(terminal, wire, name, b" ", "FIRE")
            terminal.wait_until(lambda: self.action(wire, name) == "NOOP", "released")
        assert "paused" not in terminal.line(-1)
        self.quit(terminal)

    @pytest.mark.parametrize("key", (b"\x1b[99;5u", b"\x1b[99;6u", b"\x1b[99;69u"))
    def test_ctrl_c_ends_with_other_modifiers_too(self, key):
        terminal, _, _ = self.play(keyboard=True)
        terminal.type(key)
        assert terminal.end() == 130
        assert terminal.is_restored(), terminal.modes

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
