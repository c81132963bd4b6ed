"""What games in the terminal show: racebeam play --terminal, racebeam watch --terminal, and :screen of connect."""

import os

import pytest
from harness import Server
from in_terminal import InTerminal, Wire


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
        terminal.wait_until(lambda: terminal.size == (40, 13) and terminal.picture == expected, "the picture")
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
        """Waits until the blocks fill the picture's room, since a picture may come in parts."""
        room = {(row, column) for row in range(rows // 2) for column in range(columns)}

        def drawn():
            return {at for at, cell in terminal.cells.items() if cell[0] == "\u2580"}

        terminal.wait_until(lambda: drawn() == room, f"{columns} x {rows} blocks")
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
        # The cursor is placed once for each row of blocks, and in each picture once for the line below.
        terminal.wait_until(lambda: terminal.moves - terminal.pictures == 22, "a pause between two pictures")
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
            terminal.drawn, terminal.size = None, None
            terminal.resize(columns, 24)
            if graphics == "blocks":
                self.check_blocks(terminal, *blocks)
            else:
                size = cells if graphics == "kitty" else (320, 210)
                terminal.wait_until(lambda: terminal.size == size and terminal.picture, f"a picture of {size}")
        self.quit(terminal)
