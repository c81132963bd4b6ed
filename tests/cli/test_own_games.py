"""--game-file with many images: the rules of the image that the file lists, wherever it lies."""

import hashlib
import os
import pathlib
import re
import signal
import subprocess

import pytest
from harness import BINARY, PATIENCE, SOURCE, run

PADDING = 4000  # a place in Beamfall's image that the game does not read


class TestOwnGames:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.place = tmp_path
        self.roms = self.place / "roms"
        self.roms.mkdir()
        image = bytearray(pathlib.Path(SOURCE, "games/homebrew/beamfall.bin").read_bytes())
        image[PADDING] = 1
        (self.roms / "another name.bin").write_bytes(image)
        self.md5 = hashlib.md5(image).hexdigest()
        self.file = self.game_file(self.md5)

    def game_file(self, md5, name="mine"):
        rules = pathlib.Path(SOURCE, "games/catalogue/beamfall.toml").read_text()
        path = self.place / f"{name}.toml"
        path.write_text(rules.replace("[rule]", f'[[image]]\nmd5 = "{md5}"\n\n[rule]'))
        return str(path)

    def serve(self, *options):
        lines = "load mine seed=1 sticky=0\nobserve reward\nact FIRE*600\n"
        return run("serve", "--stdio", *options, data=lines.encode())

    def test_a_server_knows_the_image_that_the_file_lists(self):
        folder = self.place / "files"
        folder.mkdir()
        os.link(self.file, folder / "mine.toml")
        for path in (self.file, str(folder)):
            status, output, errors = self.serve("--roms", str(self.roms), "--game-file", path)
            assert status == 0, errors
            assert re.search(rf"(?s)^ok game=mine md5={self.md5} rule=1 .*\nok reward=[1-9]\d*\n", output.decode())

    def test_a_built_in_image_is_of_the_game_whose_file_lists_it(self, subtests):
        image = pathlib.Path(SOURCE, "games/homebrew/beamfall.bin")
        md5 = hashlib.md5(image.read_bytes()).hexdigest()
        listed = self.game_file(md5, "listed")
        lines = f"load listed\nload {md5}\nload beamfall\n".encode()
        for options in ([], ["--rom", str(image)]):
            with subtests.test(options=options):
                status, output, errors = run("serve", "--stdio", "--game-file", listed, *options, data=lines)
                assert status == 0, errors
                games = re.findall(r"^ok game=(\w+)", output.decode(), re.MULTILINE)
                assert games == ["listed", "listed", "beamfall"]

    def test_a_folder_of_files_needs_an_image_for_one_of_them(self):
        folder = self.place / "files"
        folder.mkdir()
        os.link(self.file, folder / "mine.toml")
        os.link(self.game_file("0" * 32, "other"), folder / "other.toml")
        status, output, errors = self.serve("--roms", str(self.roms), "--game-file", str(folder))
        assert status == 0, errors
        assert output.startswith(b"ok game=mine ")

    def test_an_image_that_is_named_like_the_game_of_the_file_is_accepted(self):
        other = self.game_file("0" * 32, "other")
        (self.roms / "another name.bin").rename(self.roms / "other.bin")
        lines = b"load other\n"
        status, output, errors = run("serve", "--stdio", "--roms", str(self.roms), "--game-file", other, data=lines)
        assert status == 0, errors
        assert output.startswith(f"ok game=other md5={self.md5} rule=1 ".encode())

    def test_a_file_for_no_image_is_refused(self, subtests):
        other = self.game_file("0" * 32, "other")
        for options in (["--roms", str(self.roms)], []):
            for words in (["serve", "--stdio"], ["play"], ["experiment", "smoke", "--dry-run"]):
                with subtests.test(words=words, options=options):
                    status, output, errors = run(*words, *options, "--game-file", other)
                    assert (status, output) == (1, b""), errors
                    assert f"--game-file {other}: no image has an MD5 that it lists" in errors[-1]
                    places = "".join(f", --roms {path}" for path in options[1:])
                    assert f", in the program's own games{places}" in errors[-1]

    def test_play_begins_with_the_game_of_the_file(self):
        variables = ("DISPLAY", "WAYLAND_DISPLAY")
        environment = {key: value for key, value in os.environ.items() if key not in variables}
        words = ["--roms", str(self.roms), "--game-file", self.file]
        with subprocess.Popen([BINARY, "play", *words], stdout=subprocess.PIPE, text=True, env=environment) as process:
            try:
                assert re.search(r"/\?game=mine#token=", process.stdout.readline())
            finally:
                process.send_signal(signal.SIGINT)
                process.wait(PATIENCE)

    def test_an_experiment_runs_and_is_verified(self):
        plan = self.place / "plan.toml"
        plan.write_text('games = ["mine"]\nagents = ["random"]\nevaluation_episodes = 2\n')
        options = ["--roms", str(self.roms), "--game-file", self.file]
        results = str(self.place / "results")
        status, _, errors = run("experiment", str(plan), "--into", results, *options)
        assert status == 0, errors
        status, output, errors = run("verify", results, *options)
        assert status == 0, (output, errors)
        assert re.search(r"\b2\b", output.decode()), output
        film = str(self.place / "film.gif")
        log = f"{results}/logs/mine-random-1/1.episode"
        assert run("render", log, "--to", film, *options)[0] == 0
        status, output, errors = run("verify", log)
        assert (status, errors) == (2, [])
        assert re.search(r"^1\.episode \(mine, random, score \d+\): could not be checked: ", output.decode()), output
        status, _, errors = run("experiment", str(plan), "--into", f"{results}2")
        assert status == 1
        assert "unknown game 'mine'" in errors[-1]
