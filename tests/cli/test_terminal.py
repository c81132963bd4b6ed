"""Games in the terminal: racebeam play --terminal, racebeam watch --terminal, and :screen of racebeam connect."""

import os
import signal
import socket
import time

import pytest
from harness import BINARY, PATIENCE, Server, run
from terminal import Terminal

# An image that copies SWCHA, INPT4 and INPT5 to the first bytes of RAM in each frame. A bit is 0 for a pressed switch.
PORTS = bytes.fromhex("78D8A2FF9AA90285008502850285028500A9008500AD80028580A50C8581A50D8582A2FF8502CAD0FB4C05F0")
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

    def test_a_pause_is_drawn_anew_when_the_size_changes(self):
        terminal, wire, name = self.play("beamfall", graphics="kitty")
        expected = self.paused_picture(terminal, wire, name)
        terminal.wait_until(lambda: terminal.picture == expected, "the picture")
        terminal.drawn = None
        terminal.resize(40, 24)
        terminal.wait_until(lambda: terminal.picture == expected, "the picture")
        assert terminal.size == (40, 13)
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


class TestRoom(InTerminal):
    """A session that stands still, in terminals of many sizes."""

    @pytest.fixture(autouse=True)
    def set_up(self, self_cleanup, self_folder):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s", "--grace", "0")
        self.cleanup(self.server.__exit__)
        self.address = f"tcp://127.0.0.1:{self.server.port()}"
        self.wire = Wire(self.server.path("s"))
        self.cleanup(self.wire.close)
        for request in ("load beamfall seed=1 sticky=0", "act FIRE*9", "share a"):
            self.wire.ask(request)
        self.expected = self.wire.picture("a")

    def watch(self, columns, rows, **properties):
        terminal = self.open("watch", "--terminal", self.address, columns=columns, rows=rows, **properties)
        terminal.wait_until(lambda: terminal.pictures > 0, "a picture")
        return terminal

    def means(self, columns, rows):
        """The mean colours of the parts of the screen, rounded down."""
        found = []
        for row in range(rows):
            for column in range(columns):
                across = range(column * 160 // columns, max(column * 160 // columns + 1, (column + 1) * 160 // columns))
                down = range(row * 210 // rows, max(row * 210 // rows + 1, (row + 1) * 210 // rows))
                pixels = [self.expected[y * 160 + x] for y in down for x in across]
                found.append(tuple(sum(part) // len(pixels) for part in zip(*pixels)))
        return found

    def check_blocks(self, terminal, columns, rows):
        drawn = {at for at, cell in terminal.cells.items() if cell[0] == "\u2580"}
        assert drawn == {(row, column) for row in range(rows // 2) for column in range(columns)}
        assert terminal.block_picture(columns, rows) == self.means(columns, rows)

    @pytest.mark.parametrize(
        "size, blocks",
        (
            ((80, 24), (70, 44)),  # the rows limit it
            ((20, 24), (20, 12)),  # the columns limit it
            ((400, 120), (320, 210)),  # no pixel is wider than two blocks
            ((5, 2), (3, 2)),
            ((1, 2), (1, 2)),
        ),
    )
    def test_blocks_have_the_mean_colours_of_a_picture_that_fits(self, size, blocks):
        terminal = self.watch(*size)
        self.check_blocks(terminal, *blocks)
        assert terminal.line(-1) == "a  game beamfall  score 0  lives 4  episode 1  action FIRE"[: size[0]].rstrip()
        self.quit(terminal)

    def test_a_terminal_of_one_row_has_the_line_before_the_picture(self):
        terminal = self.watch(2, 1)
        assert {at: cell[0] for at, cell in terminal.cells.items()} == {(0, 0): "a", (0, 1): " "}
        self.quit(terminal)

    @pytest.mark.parametrize(
        "columns, rows, cell, size",
        (
            (80, 24, (8, 16), (70, 22)),  # the rows limit it
            (40, 60, (8, 16), (40, 13)),  # the columns limit it
            (80, 24, (10, 10), (35, 22)),
            (80, 24, (0, 0), (70, 22)),  # a terminal that does not know its cells
            (5, 2, (8, 16), (3, 1)),
            (1, 2, (8, 16), (1, 1)),
        ),
    )
    def test_kitty_graphics_fit_with_the_proportions_of_a_television(self, columns, rows, cell, size):
        terminal = self.watch(columns, rows, cell=cell, graphics="kitty")
        assert (terminal.picture, terminal.size) == (self.expected, size)
        self.quit(terminal)

    @pytest.mark.parametrize(
        "columns, rows, scale",
        ((80, 24, 1), (160, 60, 4), (80, 60, 2), (79, 60, 1), (160, 29, 2), (160, 27, 1), (20, 10, 1)),
    )
    def test_sixels_are_enlarged_by_a_whole_number(self, columns, rows, scale):
        terminal = self.watch(columns, rows, graphics="sixel")
        assert terminal.picture == [tuple((part * 100 + 127) // 255 for part in colour) for colour in self.expected]
        assert terminal.size == (320 * scale, 210 * scale)
        self.quit(terminal)

    def test_only_blocks_that_change_are_drawn_again(self):
        terminal = self.watch(80, 24)
        assert terminal.blocks == 70 * 22
        before, terminal.blocks = dict(terminal.cells), 0
        self.wire.ask("act RIGHT")
        terminal.wait_until(lambda: terminal.line(-1).endswith("action RIGHT"), "the next picture")
        self.expected = self.wire.picture("a")
        self.check_blocks(terminal, 70, 44)
        changed = [at for at, cell in terminal.cells.items() if cell[0] == "\u2580" and cell != before[at]]
        assert terminal.blocks == len(changed) > 0
        self.quit(terminal)

    @pytest.mark.parametrize("graphics", ("blocks", "kitty", "sixel"))
    def test_a_picture_is_drawn_anew_when_the_size_changes(self, graphics):
        terminal = self.watch(80, 24, graphics=graphics)
        for columns, blocks, cells in ((40, (40, 26), (40, 13)), (80, (70, 44), (70, 22))):
            terminal.drawn, terminal.size, terminal.blocks = None, None, 0
            terminal.resize(columns, 24)
            if graphics == "blocks":
                terminal.wait_until(lambda: terminal.blocks, "a picture")
                terminal.work(0.1)
                self.check_blocks(terminal, *blocks)
            else:
                terminal.wait_until(lambda: terminal.picture, "a picture")
                assert terminal.size == (cells if graphics == "kitty" else (320, 210))
        self.quit(terminal)


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
