"""The examples that learn run, at a small scale, and draw their curves. Each is skipped where what it needs is not
installed."""

import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import package

package.require("gymnasium", "numpy")

import racebeam.program

CLIENT = package.SOURCE / "clients/python"


def needs(*modules):
    missing = [module for module in modules if importlib.util.find_spec(module) is None]
    return unittest.skipIf(missing, f"not installed: {' and '.join(missing)}")


class Examples(unittest.TestCase):
    def refuse(self, example, *options):
        done = subprocess.run(
            [sys.executable, CLIENT / "examples" / example, "nogame", *options], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.splitlines()[-1], f"^{example}: unknown game 'nogame'")
        self.assertNotIn("Traceback", done.stderr)

    def run_example(self, example, *options):
        """Returns what the example prints. It draws a curve, if it has --curve."""
        with tempfile.TemporaryDirectory() as folder:
            curve = pathlib.Path(folder, "curve.png")
            options = [str(curve) if option == "CURVE" else str(option) for option in options]
            done = subprocess.run(
                [sys.executable, CLIENT / example, *options], capture_output=True, text=True, cwd=folder
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("is the old name of", done.stderr)
            if str(curve) in options:
                self.assertEqual(curve.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            return done.stdout

    @needs("matplotlib")
    def test_sarsa(self):
        output = self.run_example(
            "sarsa.py", racebeam.program.path(), "--training", 3, "--frames", 3000, "--curve", "CURVE"
        )
        self.assertEqual(len(re.findall(r"training episode \d+: score \d+", output)), 3)

    def verify(self, log):
        return subprocess.run([racebeam.program.path(), "verify", log], capture_output=True, text=True)

    def test_steps_of_sarsa_end_the_training_and_the_log_of_the_last_episode_is_confirmed(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder, "last.episode")
            output = self.run_example(
                "sarsa.py", racebeam.program.path(), "--frames", 3000, "--steps", 700, "--evaluation", 1, "--log", log
            )
            steps = [int(count) for count in re.findall(r"training episode .* in (\d+) decisions", output)]
            self.assertTrue(sum(steps[:-1]) < 700 <= sum(steps), output)
            score = re.search(r"evaluation episode \d+: score (\d+)", output)[1]
            self.assertRegex(self.verify(log).stdout, rf"^last.episode \(beamfall, basic, score {score}\): confirmed; ")

    def test_what_sarsa_learned_is_kept_and_played_and_filmed(self):
        with tempfile.TemporaryDirectory() as folder:
            learned, play = pathlib.Path(folder, "learned"), ("--frames", 3000, "--evaluation", 1, "--training")
            first = self.run_example("sarsa.py", racebeam.program.path(), *play, 2, "--keep", learned)
            again = [
                self.run_example("sarsa.py", racebeam.program.path(), *play, 0, "--seed", 3, "--play", learned)
                for _ in range(2)
            ]
            again.append(
                self.run_example("sarsa.py", racebeam.program.path(), *play[:2], "--seed", 3, "--play", learned)
            )
            self.assertEqual(len(set(again)), 1)
            self.assertRegex(again[0], r"^evaluation episode 1: score \d+ in \d+ decisions\n$")
            self.assertRegex(first, r"evaluation episode 3: score \d+")
            done = subprocess.run(
                [sys.executable, CLIENT / "sarsa.py", racebeam.program.path(), "--training", "1", "--film", "film"],
                capture_output=True,
                text=True,
                cwd=folder,
            )
            self.assertRegex(
                done.stderr,
                r"\nplan: 1 episode with learning and 0 episodes without, of up to 18,000 frames; "
                r"at most 3,600 steps in \d:\d\d:\d\d ",
            )
            self.assertEqual(pathlib.Path(folder, "film.gif").read_bytes()[:6], b"GIF89a")
            pathlib.Path(folder, "wrong").write_bytes(b"x")
            done = subprocess.run(
                [sys.executable, CLIENT / "sarsa.py", racebeam.program.path(), "--play", pathlib.Path(folder, "wrong")],
                capture_output=True,
                text=True,
            )
            self.assertRegex(done.stderr, r"sarsa.py: --play is '.*wrong': .*; it takes a file of --keep\n$")

    @needs("jax", "optax", "tqdm", "matplotlib")
    def test_ppo_on_ram(self):
        output = self.run_example("examples/ppo.py", "updraft", "--steps", 8192, "--curve", "CURVE")
        self.assertRegex(
            output,
            r"^plan: 2 updates of 32 x 128 steps, 8,192 steps in about \d:\d\d:\d\d .*\n"
            r"update 1: .*\nupdate 2: [1-9]\d* games",
        )

    @needs("jax", "optax", "tqdm", "PIL")
    def test_a_policy_is_kept_and_played_and_filmed(self):
        from PIL import Image

        with tempfile.TemporaryDirectory() as folder:
            policy, film = pathlib.Path(folder, "policy"), pathlib.Path(folder, "film.gif")
            one = ("updraft", "--envs", 2, "--horizon", 8, "--steps", 16, "--games", 3)
            self.run_example("examples/ppo.py", *one, "--keep", policy)
            outputs = [self.run_example("examples/ppo.py", *one, "--play", policy, "--film", film) for _ in range(2)]
            self.assertRegex(outputs[0], r"^3 games: mean score \d+\.\d, from \d+ to \d+\n$")
            self.assertEqual(*outputs)
            with Image.open(film) as frames:
                self.assertEqual(frames.size, (320, 210))
                self.assertGreater(frames.n_frames, 10)
            self.refuse("ppo.py", "--play", policy)

    @needs("jax", "optax", "tqdm")
    def test_the_log_of_a_policy_is_confirmed(self):
        for observe in ("ram", "pixels"):
            with tempfile.TemporaryDirectory() as folder, self.subTest(observe=observe):
                log = pathlib.Path(folder, "game.episode")
                small = ("--observe", observe, "--envs", 2, "--horizon", 8, "--steps", 16)
                self.assertIn("racebeam verify confirms it", self.run_example("examples/ppo.py", *small, "--log", log))
                done = self.verify(log)
                self.assertRegex(done.stdout, r"^game.episode \(updraft, ppo, score \d+\): confirmed; ", done.stderr)
                log.write_bytes(log.read_bytes()[:-1])
                self.assertEqual(self.verify(log).returncode, 1)

    @needs("matplotlib")
    def test_the_cells_of_the_notebook_run(self):
        notebook = json.loads((CLIENT / "examples/learning_curve.ipynb").read_text())
        cells = [("".join(cell["source"]), cell) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertTrue(all(not cell["outputs"] and cell["execution_count"] is None for _, cell in cells))
        code = "\n".join(source for source, _ in cells)
        code, count = re.subn(r"(?m)^GENERATIONS = \d+", "GENERATIONS = 2", code)
        self.assertEqual(count, 1)
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "Agg"}
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"random play: \d+\.\d\n(generation \d+: .*\n){2}")

    @needs("jax", "optax", "tqdm")
    def test_ppo_on_pixels(self):
        output = self.run_example(
            "examples/ppo.py", "--observe", "pixels", "--steps", 32, "--horizon", 8, "--envs", 4, "--epochs", 1
        )
        self.assertRegex(output, r"\d+ steps a second")
        self.refuse("ppo.py")

    @needs("stable_baselines3")
    def test_stable_baselines(self):
        output = self.run_example("examples/stable_baselines.py", "--steps", 64, "--steps-of-update", 16, "--envs", 4)
        self.assertRegex(output, r"total_timesteps\s*\|\s*64")
        self.refuse("stable_baselines.py")

    @needs("stable_baselines3")
    def test_stable_baselines_leaves_a_submission(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder, small = pathlib.Path(scratch, "ppo"), ("--steps", 64, "--steps-of-update", 16, "--envs", 4)
            self.run_example("examples/stable_baselines.py", *small, "--log", folder)
            self.assertRegex(self.verify(folder).stdout, "^3 rows confirmed, 0 wrong, 0 could not be checked")
            results = (folder / "results.csv").read_text()
            (folder / "results.csv").write_text(results.replace(",terminated,", ",truncated,", 1))
            self.assertEqual(self.verify(folder).returncode, 1)
