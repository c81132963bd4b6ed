"""racebeam png: the picture shows the screen of the client's line."""

import base64
import os
import re
import resource
import stat
import struct
import subprocess
import zlib

import pytest
from harness import BINARY, GAME, run

WIDTH, HEIGHT = 160, 210
NTSC = {0x00: (0, 0, 0), 0x0E: (0xEC, 0xEC, 0xEC), 0x1A: (0xD2, 0xD2, 0x40), 0x44: (0xB8, 0x32, 0x32)}
PAL_44, SECAM_44 = (0xA0, 0x6B, 0x32), (0xF0, 0x3C, 0x79)


def run_lengths(pixels):
    text, start = "", 0
    for i in range(1, len(pixels) + 1):
        if i == len(pixels) or pixels[i] != pixels[start] or i - start == 255:
            text += f"{pixels[start]:02X}{i - start:02X}"
            start = i
    return text


def read_png(data):
    """Width, height and rows of an 8-bit RGB picture without interlacing."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            width, height, *kind_of_pixels = struct.unpack(">IIBBBBB", body)
            assert kind_of_pixels == [8, 2, 0, 0, 0]
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    return width, height, unfilter(zlib.decompress(packed), width * 3, height)


def unfilter(data, size, height):
    rows, above = [], bytes(size)
    for y in range(height):
        kind, line = data[y * (size + 1)], bytearray(data[y * (size + 1) + 1 : (y + 1) * (size + 1)])
        for i in range(size):
            left = line[i - 3] if i >= 3 else 0
            corner = above[i - 3] if i >= 3 else 0
            line[i] = (line[i] + [0, left, above[i], (left + above[i]) // 2, paeth(left, above[i], corner)][kind]) & 255
        rows.append(bytes(line))
        above = line
    return rows


def paeth(left, up, corner):
    distances = [abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)]
    return (left, up, corner)[distances.index(min(distances))]


class TestPng:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.path = os.path.join(tmp_path, "screen.png")
        self.pixels = [list(NTSC)[(x // 10 + y) % 4] for y in range(HEIGHT) for x in range(WIDTH)]

    def picture(self, line, *words):
        status, printed, errors = run("png", self.path, *words, data=line.encode())
        assert (status, printed, errors) == (0, b"", [])
        with open(self.path, "rb") as file:
            return read_png(file.read())

    def check(self, picture, palette):
        width, height, rows = picture
        assert (width, height) == (2 * WIDTH, HEIGHT)
        expected = [
            b"".join(bytes(palette[pixel] * 2) for pixel in self.pixels[y * WIDTH : (y + 1) * WIDTH])
            for y in range(HEIGHT)
        ]
        assert rows == expected

    def test_every_pixel_has_its_colour_twice(self):
        self.check(self.picture(run_lengths(self.pixels) + ":0,0:\n"), NTSC)

    def test_a_full_screen_gives_the_same(self):
        self.check(self.picture(bytes(self.pixels).hex().upper() + ":0,0:\n", "--full"), NTSC)

    def test_the_screen_is_found_in_every_kind_of_line(self, subtests):
        screen = run_lengths(self.pixels)
        for line in (
            screen,
            screen + ":",
            "00" * 128 + ":" + screen + ":\r\n",
            "00" * 128 + ":" + screen + ":1,-20:\n",
        ):
            with subtests.test(line=line[-20:]):
                self.check(self.picture(line, "--rle"), NTSC)

    def test_the_palette_is_the_one_asked_for(self):
        self.pixels = [0x44] * (WIDTH * HEIGHT)
        for name, color in (("ntsc", NTSC[0x44]), ("pal", PAL_44), ("secam", SECAM_44)):
            self.check(self.picture(run_lengths(self.pixels), "--palette", name), {0x44: color})

    def test_a_screen_of_the_server_is_one(self):
        status, lines, _ = run("serve", "--classic", "--stdio", "--rom", GAME, data=b"1,1,0,1\n1,18\n")
        assert status == 0
        width, height, rows = self.picture(lines.decode().splitlines()[2])
        assert (width, height) == (2 * WIDTH, HEIGHT)
        assert len(set(rows)) > 5

    def replies(self, *requests):
        """What a server answers, as bytes."""
        lines = "".join(f"{request}\n" for request in ("load beamfall seed=7 sticky=0 frame_skip=4", *requests))
        status, printed, _ = run("serve", "--stdio", data=lines.encode())
        assert status == 0
        return printed

    def picture_of(self, replies, *words):
        """The picture that replies give: width, height and rows."""
        status, printed, errors = run("png", self.path, *words, data=replies)
        assert (status, printed, errors) == (0, b"", [])
        with open(self.path, "rb") as file:
            return read_png(file.read())

    def test_a_reply_in_each_encoding_is_the_same_picture(self, subtests):
        first = self.picture_of(self.replies("act FIRE*30", "look screen"))
        assert first[:2] == (2 * WIDTH, HEIGHT)
        assert len(set(first[2])) > 5
        for field in ("screen", "rgb"):
            for encoding in ("hex", "rle", "base64", "zlib", "raw"):
                with subtests.test(field=field, encoding=encoding):
                    replies = self.replies("act FIRE*30", f"look lives ram:raw {field}:{encoding} palette", "stats")
                    assert self.picture_of(replies) == first
                    assert self.picture_of(replies, "--field", field) == first
                    if encoding != "raw":
                        assert self.picture_of(replies, "--encoding", encoding) == first
            replies = self.replies(f"observe reward {field}:delta", "act FIRE*20", "act FIRE*10")
            assert self.picture_of(replies, "--encoding", "delta") == first

    def test_a_single_reply_without_its_load_is_enough(self):
        replies = self.replies("act FIRE*30", "look screen:zlib")
        assert self.picture_of(replies.splitlines()[-1]) == self.picture_of(replies)

    @pytest.mark.parametrize(
        "field, size",
        (
            ("grey", (2 * WIDTH, HEIGHT)),
            ("grey84", (84, 84)),
            ("grey84x4", (84, 4 * 84)),
            ("grey40x30x2", (40, 60)),
            ("rgb40x30x1", (40, 30)),
        ),
    )
    @pytest.mark.parametrize("encoding", ("hex", "zlib", "delta", "raw"))
    def test_grey_and_resized_screens_keep_their_size(self, field, size, encoding):
        replies = self.replies(f"observe {field}:{encoding}", "act FIRE*9")
        words = ("--encoding", "delta") if encoding == "delta" else ()
        width, height, rows = self.picture_of(replies, *words)
        assert (width, height) == size
        assert len(set(rows)) > 5
        if "rgb" not in field:
            assert all(row[0::3] == row[1::3] == row[2::3] for row in rows)

    def test_a_shot_is_written_as_it_came(self):
        replies = self.replies("act FIRE*30", "shot")
        assert run("png", self.path, data=replies) == (0, b"", [])
        data = re.search(rb" data=(\S+)", replies)[1]
        with open(self.path, "rb") as file:
            assert file.read() == base64.b64decode(data)

    def test_machines_are_told_apart(self):
        replies = self.replies("observe screen", "open 2", "step FIRE UP", "step RIGHT*1 LEFT", "step RIGHT LEFT")
        pictures = [self.picture_of(replies, *words) for words in ((), ("--machine", "0"), ("--machine", "1"))]
        assert pictures[0] == pictures[1]
        assert pictures[1] != pictures[2]

    def test_a_picture_of_no_machine_is_not_that_of_machine_0(self):
        line = "ok grey1x1x1=77 | reward=0\n"
        self.check_refusal(1, "no reply on standard input has a picture", line, "--machine", "0")

    def test_three_numbers_are_columns_rows_and_screens(self):
        line = f"ok grey84x90x2={'55' * 84 * 90 * 2}\n"
        assert self.picture(line)[:2] == (84, 2 * 90)

    def test_the_palette_is_that_of_the_loaded_game(self):
        lines = b"load beamfall seed=7 format=pal\nlook screen\n"
        _, printed, _ = run("serve", "--stdio", data=lines)
        assert self.picture_of(printed) == self.picture_of(printed.splitlines()[-1], "--palette", "pal")
        assert self.picture_of(printed) != self.picture_of(printed, "--palette", "ntsc")

    def test_the_palette_of_a_reply_wins(self):
        lines = b"load beamfall seed=7 format=pal\nlook screen palette\n"
        _, printed, _ = run("serve", "--stdio", data=lines)
        reply = printed.splitlines()[-1]
        assert self.picture_of(reply) == self.picture_of(reply, "--palette", "pal")
        assert self.picture_of(reply) != self.picture_of(reply, "--palette", "ntsc")

    def test_differences_begin_anew_with_a_game_and_with_fields(self):
        expected = self.picture_of(self.replies("act FIRE*5", "look screen"))
        for again in (
            ("load beamfall seed=7 sticky=0 frame_skip=4", "observe screen:delta"),
            ("observe screen:delta",),
        ):
            replies = self.replies("observe screen:delta", *(["act RIGHT*9", *again] if len(again) > 1 else again))
            replies += self.replies("observe screen:delta", "act FIRE*5")
            assert self.picture_of(replies, "--encoding", "delta") == expected

    @pytest.mark.parametrize("rows, fits", ((199, False), (200, True), (256, True), (257, False), (210.5, False)))
    def test_a_single_reply_has_200_to_256_rows(self, rows, fits):
        pixels = bytes(range(0, 256, 2)) * int(rows * WIDTH // 128)
        line = f"ok screen={pixels.hex().upper()}\n"
        if fits:
            assert self.picture(line)[:2] == (2 * WIDTH, rows)
        else:
            self.check_refusal(1, "the value of screen is not a whole screen", line)

    @pytest.mark.parametrize(
        "size, fits", (("1000x1x1", True), ("1x1000x1", True), ("1001x1x1", False), ("0x1x1", False))
    )
    def test_a_resized_screen_has_1_to_1000_columns_and_rows(self, size, fits):
        columns, rows, _ = map(int, size.split("x"))
        line = f"ok grey{size}={'00' * columns * rows}\n"
        if fits:
            assert self.picture(line)[:2] == (columns, rows)
        else:
            self.check_refusal(1, "no reply on standard input has a picture", line)

    @pytest.mark.parametrize("rows, fits", ((1, True), (1024, True), (1025, False)))
    def test_a_classic_screen_has_at_most_1024_rows(self, rows, fits):
        line = "0EA0" * rows + ":\n"
        if fits:
            assert self.picture(line)[:2] == (2 * WIDTH, rows)
        else:
            self.check_refusal(1, f"the screen has {1025 * WIDTH} pixels, not whole rows of 160", line)

    def test_a_classic_screen_has_pixels(self):
        self.check_refusal(1, "the screen has 0 pixels, not whole rows of 160", "0E00:\n")

    def test_the_first_refusal_is_the_reason(self):
        errors = b"error no-game look needs a game\nok acts=1\nerror bad-value of another kind\n"
        status, _, lines = run("png", self.path, data=errors)
        assert (status, len(lines)) == (1, 1)
        assert lines[0].endswith("; the server refused a request: no-game look needs a game")
        assert "refused" not in run("png", self.path, data=self.replies("act FIRE"))[2][0]

    def test_replies_without_a_picture_are_refused(self, subtests):
        for complaint, replies, *words in (
            ("no reply on standard input has a picture", self.replies("act FIRE")),
            ("the server refused a request: no-game look needs a game", b"error no-game look needs a game; load\n"),
            ("no reply on standard input has the field grey", self.replies("look screen"), "--field", "grey"),
            ("ram is not a picture", self.replies("look ram"), "--field", "ram"),
            ("the value of screen is not a whole screen in hex, rle, base64 or zlib", self.replies("look screen")[:-9]),
            (
                "the value of screen has 868 bytes, which is not a whole screen",
                self.replies("look screen"),
                "--encoding",
                "hex",
            ),
            ("the input ends within the bytes", self.replies("look screen:raw")[:-9]),
            ("a reply says raw=", b"ok screen=33600 raw=999999999\n"),
        ):
            with subtests.test(complaint=complaint):
                ended, printed, errors = run("png", self.path, *words, data=replies)
                assert (ended, printed, len(errors)) == (1, b"", 1), errors
                assert complaint in errors[0]
                assert not os.path.exists(self.path)

    def check_refusal(self, status, complaint, line, *words):
        ended, printed, errors = run("png", self.path, *words, data=line.encode())
        assert (ended, printed, len(errors)) == (status, b"", 1), errors
        assert complaint in errors[0]
        assert not os.path.exists(self.path)

    @pytest.mark.parametrize("line", ("", "\n", "DIE\n", "0,0:\n", "00" * 128 + ":0,0:\n"))
    def test_lines_without_a_screen_are_refused(self, line):
        self.check_refusal(1, "truncated" if line == "DIE\n" else "no screen", line)

    def test_screens_that_make_no_sense_are_refused(self):
        screen = run_lengths(self.pixels)
        self.check_refusal(1, "odd number of digits", screen[:-1])
        self.check_refusal(1, "has no length", screen[:-2])
        self.check_refusal(1, "not whole rows", screen[:-4])
        self.check_refusal(1, "'XY' in the screen", "XY" + screen[2:])
        self.check_refusal(1, "without --full", bytes(self.pixels).hex()[:-2], "--full")
        self.check_refusal(1, "not whole rows", "00FF" * 100000)

    def test_words_that_make_no_sense_are_refused(self):
        screen = run_lengths(self.pixels)
        self.check_refusal(2, "blue", screen, "--palette", "blue")
        self.check_refusal(2, "--rle", screen, "--full", "--rle")

    def test_a_file_that_cannot_be_written_is_named(self):
        path = os.path.join(os.path.dirname(self.path), "missing", "x.png")
        status, _, errors = run("png", path, data=run_lengths(self.pixels).encode())
        assert (status, len(errors)) == (1, 1), errors
        assert path in errors[0]

    def test_a_file_that_may_not_grow_leaves_the_old_one(self):
        with open(self.path, "wb") as file:
            file.write(b"the old picture")
        limits = (resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        done = subprocess.run(
            [BINARY, "png", self.path],
            input=run_lengths(self.pixels).encode(),
            capture_output=True,
            preexec_fn=lambda: resource.setrlimit(*limits),
        )
        assert done.returncode == 1, done.stderr
        with open(self.path, "rb") as file:
            assert file.read() == b"the old picture"
        assert len(os.listdir(os.path.dirname(self.path))) == 1

    def test_a_pipe_is_written_to_and_stays(self):
        os.mkfifo(self.path)
        with subprocess.Popen([BINARY, "png", self.path], stdin=subprocess.PIPE) as writer:
            writer.stdin.write(run_lengths(self.pixels).encode())
            writer.stdin.close()
            with open(self.path, "rb") as pipe:
                assert pipe.read(4) == b"\x89PNG"
        assert writer.returncode == 0
        assert stat.S_ISFIFO(os.stat(self.path).st_mode)
