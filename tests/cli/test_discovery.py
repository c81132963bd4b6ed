"""racebeam background: the files that it writes, and what it refuses."""

import hashlib
import os

import pytest
from harness import run


@pytest.mark.usefixtures("self_folder")
class TestBackground:
    def discover(self, into, *words):
        status, output, errors = run("background", "beamfall", "--into", into, *words, cwd=self.folder)
        assert (status, errors) == (0, [])
        assert output.endswith(f"{into}/beamfall.background and its pictures are written\n".encode())
        return output

    def contents(self, into, name="beamfall.csv"):
        with open(os.path.join(self.folder, into, name), "rb") as file:
            return file.read()

    def refuse(self, status, hint, game, *words):
        ended, output, errors = run("background", game, "--into", "x", *words, cwd=self.folder)
        assert (ended, output, len(errors)) == (status, b"", 1), errors
        assert hint in errors[0]
        assert not os.path.exists(os.path.join(self.folder, "x"))

    def test_all_files_are_written_and_the_seed_decides(self):
        self.discover("a/b", "--screens", "5", "--seed", "1")
        files = {f"beamfall{end}" for end in (".background", ".csv", "-background.png", "-secam.png", "-tiles.png")}
        assert set(os.listdir(os.path.join(self.folder, "a/b"))) == files
        lines = self.contents("a/b").decode().splitlines()
        assert [len(line.split(",")) for line in lines] == 210 * [160]
        assert {0 <= int(colour) <= 127 for line in lines for colour in line.split(",")} == {True}
        for into, words in (("same", ("--screens", "5", "--seed", "1")), ("other", ("--screens", "5", "--seed", "0"))):
            self.discover(into, *words)
            is_same = self.contents(into, "beamfall.background") == self.contents("a/b", "beamfall.background")
            assert is_same == (into == "same")

    def test_a_background_may_come_from_a_file(self):
        text = (",".join(str(x % 128) for x in range(160)) + "\n") * 210
        with open(os.path.join(self.folder, "mine.csv"), "w") as file:
            file.write(text)
        output = self.discover("a", "--csv", "mine.csv")
        assert self.contents("a").decode() == text
        assert f'beamfall = "{hashlib.sha256(text.encode()).hexdigest()}"\n'.encode() in output

    def test_a_discovered_background_is_drawn_and_can_be_read_again(self):
        self.discover("a", "--screens", "500")
        for name in ("background", "secam", "tiles"):
            assert self.contents("a", f"beamfall-{name}.png").startswith(b"\x89PNG")
        self.discover("again", "--csv", "a/beamfall.csv")
        assert self.contents("again") == self.contents("a")
        assert self.contents("again", "beamfall.background") != self.contents("a", "beamfall.background")

    def test_a_file_has_as_many_lines_as_the_screen(self):
        with open(os.path.join(self.folder, "long.csv"), "w") as file:
            file.write((",".join(160 * ["0"]) + "\n") * 210 + "1\n")
        self.refuse(1, "long.csv:211: there are more than 210 lines", "beamfall", "--csv", "long.csv")

    def test_a_file_has_at_most_a_mebibyte(self):
        path = os.path.join(self.folder, "large.csv")
        for size in (1 << 20, (1 << 20) + 1):
            with open(path, "wb") as file:
                file.truncate(size)
            self.refuse(1, "larger than 1048576 bytes" if size > 1 << 20 else "large.csv", "beamfall", "--csv", path)

    def test_one_screen_is_enough(self):
        self.discover("a", "--screens", "1")

    @pytest.mark.parametrize("screens", ("0", "10000001", "many"))
    def test_other_numbers_of_screens_are_refused(self, screens):
        hint = f"--screens: '{screens}' is not a whole number from 1 to 10000000"
        self.refuse(2, hint, "beamfall", "--screens", screens)

    def test_a_game_that_is_not_here_is_refused(self):
        self.refuse(1, "unknown game 'beamfal'; did you mean beamfall? racebeam games lists them", "beamfal")
        self.refuse(1, "no image was found for 'pong'; --roms names the folder that holds it", "pong")
        self.refuse(1, "background none.csv: no such file", "beamfall", "--csv", "none.csv")
