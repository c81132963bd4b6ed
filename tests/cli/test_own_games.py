"""--game-file with many images: the rules of the image that the file lists, wherever it lies."""

import hashlib
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

from harness import BINARY, PATIENCE, SOURCE, main, run

PADDING = 4000  # a place in Beamfall's image that the game does not read


class OwnGames(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)
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
            self.assertEqual(status, 0, errors)
            self.assertRegex(output.decode(), rf"(?s)^ok game=mine md5={self.md5} rule=1 .*\nok reward=[1-9]\d*\n")

    def test_a_built_in_image_is_of_the_game_whose_file_lists_it(self):
        image = pathlib.Path(SOURCE, "games/homebrew/beamfall.bin")
        md5 = hashlib.md5(image.read_bytes()).hexdigest()
        listed = self.game_file(md5, "listed")
        lines = f"load listed\nload {md5}\nload beamfall\n".encode()
        for options in ([], ["--rom", str(image)]):
            with self.subTest(options=options):
                status, output, errors = run("serve", "--stdio", "--game-file", listed, *options, data=lines)
                self.assertEqual(status, 0, errors)
                games = re.findall(r"^ok game=(\w+)", output.decode(), re.MULTILINE)
                self.assertEqual(games, ["listed", "listed", "beamfall"])

    def test_a_file_for_no_image_is_refused(self):
        other = self.game_file("0" * 32, "other")
        for options in (["--roms", str(self.roms)], []):
            for words in (["serve", "--stdio"], ["play"], ["experiment", "smoke", "--dry-run"]):
                with self.subTest(words=words, options=options):
                    status, output, errors = run(*words, *options, "--game-file", other)
                    self.assertEqual((status, output), (1, b""), errors)
                    self.assertIn(f"--game-file {other}: no image has an MD5 that it lists", errors[-1])
                    self.assertIn("the program's own games", errors[-1])

    def test_play_begins_with_the_game_of_the_file(self):
        variables = ("DISPLAY", "WAYLAND_DISPLAY")
        environment = {key: value for key, value in os.environ.items() if key not in variables}
        words = ["--roms", str(self.roms), "--game-file", self.file]
        with subprocess.Popen([BINARY, "play", *words], stdout=subprocess.PIPE, text=True, env=environment) as process:
            try:
                self.assertRegex(process.stdout.readline(), r"/\?game=mine#token=")
            finally:
                process.send_signal(signal.SIGINT)
                process.wait(PATIENCE)

    def test_an_experiment_runs_and_is_verified(self):
        plan = self.place / "plan.toml"
        plan.write_text('games = ["mine"]\nagents = ["random"]\nevaluation_episodes = 2\n')
        options = ["--roms", str(self.roms), "--game-file", self.file]
        results = str(self.place / "results")
        status, _, errors = run("experiment", str(plan), "--into", results, *options)
        self.assertEqual(status, 0, errors)
        status, output, errors = run("verify", results, *options)
        self.assertEqual(status, 0, (output, errors))
        self.assertTrue(re.search(r"\b2\b", output.decode()), output)
        film = str(self.place / "film.gif")
        log = f"{results}/logs/mine-random-1/1.episode"
        self.assertEqual(run("render", log, "--to", film, *options)[0], 0)
        status, _, errors = run("experiment", str(plan), "--into", f"{results}2")
        self.assertEqual(status, 1)
        self.assertIn("unknown game 'mine'", errors[-1])


if __name__ == "__main__":
    main()
