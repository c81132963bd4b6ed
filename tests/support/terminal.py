"""A terminal in which a test runs a program: it answers as real ones do, and knows what it shows."""

import base64
import codecs
import fcntl
import functools
import itertools
import os
import pty
import re
import select
import signal
import struct
import termios
import time
import zlib

from harness import PATIENCE

SEQUENCE = re.compile(rb"\x1b\[([0-9:;<=>?]*)([ -/]*[@-~])|\x1b([_P\]])(.*?)\x1b\\|\x1b\\|([^\x1b]+)", re.DOTALL)


class Terminal:
    """`graphics`: of blocks, sixel and kitty. `answers`: whether it answers at all. `keyboard`: whether it has the
    keyboard protocol of kitty. `confirms` may be set to False: it then keeps the questions whether a picture has
    arrived. `size`: of the last picture in pixels, or in cells with the graphics of kitty. `blocks`: the number of
    half blocks that were drawn. `moves`: how often the cursor was placed."""

    def __init__(
        self,
        words,
        columns=80,
        rows=24,
        cell=(8, 16),
        graphics="blocks",
        answers=True,
        keyboard=False,
        environment=None,
    ):
        self.graphics, self.answers, self.keyboard, self.confirms = graphics, answers, keyboard, True
        self.rest, self.modes, self.cells, self.drawn, self.pictures, self.chunks = b"", set(), {}, None, 0, []
        self.size, self.blocks, self.moves = None, 0, 0
        self.row = self.column = self.unanswered = 0
        self.colours = ["", ""]
        self.decoder = codecs.getincrementaldecoder("utf-8")()
        begin, ready = os.pipe()
        self.child, self.master = pty.fork()
        if self.child == 0:
            os.read(begin, 1)
            size = struct.pack("HHHH", rows, columns, columns * cell[0], rows * cell[1])
            fcntl.ioctl(0, termios.TIOCSWINSZ, size)
            os.execve(words[0], words, environment or dict(os.environ))
        self.before = termios.tcgetattr(self.master)
        os.write(ready, b"!")
        os.close(begin)
        os.close(ready)

    @property
    def picture(self):
        """The last picture's pixels; None without one. Only what a test looks at is decoded, which takes time."""
        return self.drawn and self.drawn()

    def close(self):
        try:
            os.kill(self.child, signal.SIGKILL)
            os.waitpid(self.child, 0)
        except (ProcessLookupError, ChildProcessError):
            pass
        os.close(self.master)

    def resize(self, columns, rows):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 8 * columns, 16 * rows))

    def type(self, data):
        os.write(self.master, data)

    def line(self, row):
        """The text of a row, counted from 0; of the last ones with a negative number."""
        rows = struct.unpack("HHHH", fcntl.ioctl(self.master, termios.TIOCGWINSZ, b"\0" * 8))[0]
        text = {column: cell[0] for (at, column), cell in self.cells.items() if at == row % rows}
        return "".join(text.get(column, " ") for column in range(max(text, default=-1) + 1)).rstrip()

    def wait_until(self, holds, what="what is awaited"):
        """Shows what comes until `holds()` does."""
        until = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < until, f"not {what}: {self.line(-1)!r}"
            self.work(0.05)

    def work(self, seconds):
        """Shows what comes within this time, until there is a pause. Returns False at the end."""
        while select.select([self.master], [], [], seconds)[0]:
            try:
                data = os.read(self.master, 65536)
            except OSError:  # the program has ended
                return False
            if not data:
                return False
            self.show(data)
            seconds = 0
        return True

    def end(self):
        """Shows the rest, and returns the exit status: negative for a signal."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            self.work(0.01)
            child, status = os.waitpid(self.child, os.WNOHANG)
            if child:
                self.work(0)
                return os.waitstatus_to_exitcode(status)
        raise AssertionError("the program does not end")

    def is_restored(self):
        return self.modes == {"?25"} and termios.tcgetattr(self.master) == self.before

    def show(self, data):
        data, at = self.rest + data, 0
        while found := SEQUENCE.match(data, at):
            parameters, final, kind, string, text = found.groups()
            at = found.end()
            if text:
                self.put(self.decoder.decode(text))
            elif kind:
                self.take_string(kind, string)
            elif final:
                self.control(parameters.decode(), final.decode())
        self.rest = data[at:]  # a sequence whose end has not come

    def put(self, text):
        for character in text:
            if character == "\n":
                self.row += 1
            elif character == "\r":
                self.column = 0
            else:
                self.cells[self.row, self.column] = (character, *self.colours)
                self.blocks += character == "\u2580"
                self.column += 1

    def control(self, parameters, final):
        numbers = [int(number or 0) for number in re.findall(r"\d+", parameters)]
        if final == "H":
            self.moves += 1
            self.row, self.column = (number - 1 for number in (numbers or [1, 1]))
        elif final == "J":
            self.cells = {}
        elif final == "K":
            self.cells = {at: cell for at, cell in self.cells.items() if at[0] != self.row or at[1] < self.column}
        elif final == "m":
            layer = {38: 0, 48: 1}.get(numbers[0])
            if layer is None:
                self.colours = ["", ""]
            else:
                self.colours[layer] = tuple(numbers[2:])
        elif final in "hl" and parameters.startswith("?"):
            (self.modes.add if final == "h" else self.modes.discard)(parameters)
            if (parameters, final) == ("?2026", "l"):
                self.pictures += 1
        elif final == "u" and parameters.startswith(">"):
            self.modes.add("keyboard")
        elif final == "u" and parameters.startswith("<"):
            self.modes.discard("keyboard")
        else:
            self.answer(parameters, final)

    def answer(self, parameters, final):
        if not self.answers:
            return
        if (parameters, final) == ("", "c"):
            self.type(b"\x1b[?62;4;22c" if self.graphics == "sixel" else b"\x1b[?62;22c")
        elif (parameters, final) == ("?", "u") and self.keyboard:
            self.type(b"\x1b[?0u")
        elif (parameters, final) == ("5", "n"):
            self.unanswered += 1
            if self.confirms:
                self.confirm()

    def confirm(self):
        self.type(b"\x1b[0n" * self.unanswered)
        self.unanswered = 0

    def take_string(self, kind, string):
        if kind == b"P":
            found = re.match(rb'[0-9;]*q"\d+;\d+;(\d+);(\d+)', string)
            self.size = int(found[1]), int(found[2])
            self.drawn = functools.partial(sixel_picture, string.decode())
        elif kind == b"_" and b"a=q" in string:
            if self.graphics == "kitty" and self.answers:
                self.type(b"\x1b_Gi=31;OK\x1b\\")
        elif kind == b"_" and b"a=d" not in string:
            keys, data = string[1:].split(b";")
            assert len(data) <= 4096
            self.chunks.append(data)
            if found := re.search(rb"c=(\d+),r=(\d+)", keys):
                self.size = int(found[1]), int(found[2])
            if b"m=0" in keys:
                self.drawn = functools.partial(kitty_picture, b"".join(self.chunks))
                self.chunks = []

    def block_picture(self, columns, rows):
        """The colours of half blocks in the upper left corner, row by row."""
        return [self.cells[row // 2, column][1 + row % 2] for row in range(rows) for column in range(columns)]


def kitty_picture(data):
    """The colours of a picture that is packed as RGB."""
    pixels = zlib.decompress(base64.b64decode(data))
    return [tuple(pixels[at : at + 3]) for at in range(0, len(pixels), 3)]


def sixel_picture(text):
    """The picture of a sixel string, as 160 columns of colours in percent. The enlargement is undone."""
    _, _, width, height = map(int, re.match(r'[0-9;]*q"(\d+);(\d+);(\d+);(\d+)', text).groups())
    colours, pixels, at, band, colour = {}, {}, 0, 0, None
    body = text[re.match(r'[0-9;]*q"[0-9;]*', text).end() :]
    for number, definition, times, character in re.findall(r"#(\d+)(;[0-9;]+)?|(?:!(\d+))?([?-~$-])", body):
        if definition:
            colours[number] = tuple(map(int, definition.split(";")[2:]))
        elif number:
            colour = number
        elif character in "$-":
            at, band = 0, band + 6 * (character == "-")
        else:
            end = at + int(times or 1)
            for column, bit in itertools.product(range(at, end), range(6)):
                if ord(character) - 63 >> bit & 1:
                    assert (band + bit, column) not in pixels
                    pixels[band + bit, column] = colours[colour]
            at = end
    scale = width // 320
    assert len(pixels) == width * height and width == 320 * scale
    return [pixels[row, column] for row in range(0, height, scale) for column in range(0, width, 2 * scale)]
