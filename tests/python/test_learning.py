"""The examples that learn run, at a small scale, and draw their curves. Each is skipped where what it needs is not
installed."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import package
import pytest

package.require("gymnasium", "numpy")

import racebeam.program

CLIENT = package.SOURCE / "clients/python"


@pytest.mark.slow
class TestExamples:
    def refuse(self, example, *options):
        done = subprocess.run(
            [sys.executable, CLIENT / "examples" / example, "nogame", *options], capture_output=True, text=True
        )
        assert done.returncode == 1
        assert re.search(f"^{example}: unknown game 'nogame'", done.stderr.splitlines()[-1])
        assert "Traceback" not in done.stderr

    def run_example(self, example, *options):
        """Returns what the example prints. It draws a curve, if it has --curve."""
        with tempfile.TemporaryDirectory() as folder:
            curve = pathlib.Path(folder, "curve.png")
            options = [str(curve) if option == "CURVE" else str(option) for option in options]
            done = subprocess.run(
                [sys.executable, CLIENT / example, *options], capture_output=True, text=True, cwd=folder
            )
            assert done.returncode == 0, done.stderr
            assert "is the old name of" not in done.stderr
            if str(curve) in options:
                assert curve.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
            return done.stdout

    @pytest.mark.needs_modules("matplotlib")
    def test_sarsa(self):
        output = self.run_example(
            "sarsa.py", racebeam.program.path(), "--training", 3, "--frames", 3000, "--curve", "CURVE"
        )
        assert len(re.findall(r"training episode \d+: score \d+", output)) == 3

    def verify(self, log):
        return subprocess.run([racebeam.program.path(), "verify", log], capture_output=True, text=True)

    def test_steps_of_sarsa_end_the_training_and_the_log_of_the_last_episode_is_confirmed(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder, "last.episode")
            output = self.run_example(
                "sarsa.py", racebeam.program.path(), "--frames", 3000, "--steps", 700, "--evaluation", 1, "--log", log
            )
            steps = [int(count) for count in re.findall(r"training episode .* in (\d+) decisions", output)]
            assert sum(steps[:-1]) < 700 <= sum(steps), output
            score = re.search(r"evaluation episode \d+: score (\d+)", output)[1]
            assert re.search(rf"^last.episode \(beamfall, basic, score {score}\): confirmed; ", self.verify(log).stdout)

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
            assert len(set(again)) == 1
            assert re.search(r"^evaluation episode 1: score \d+ in \d+ decisions\n$", again[0])
            assert re.search(r"evaluation episode 3: score \d+", first)
            done = subprocess.run(
                [sys.executable, CLIENT / "sarsa.py", racebeam.program.path(), "--training", "1", "--film", "film"],
                capture_output=True,
                text=True,
                cwd=folder,
            )
            assert re.search(
                r"\nplan: 1 episode with learning and 0 episodes without, of up to 18,000 frames; "
                r"at most 3,600 steps in \d:\d\d:\d\d ",
                done.stderr,
            )
            assert pathlib.Path(folder, "film.gif").read_bytes()[:6] == b"GIF89a"
            pathlib.Path(folder, "wrong").write_bytes(b"x")
            done = subprocess.run(
                [sys.executable, CLIENT / "sarsa.py", racebeam.program.path(), "--play", pathlib.Path(folder, "wrong")],
                capture_output=True,
                text=True,
            )
            assert re.search(r"sarsa.py: --play is '.*wrong': .*; it takes a file of --keep\n$", done.stderr)

    @pytest.mark.needs_modules("jax", "optax", "tqdm", "matplotlib")
    def test_ppo_on_ram(self):
        output = self.run_example("examples/ppo.py", "updraft", "--steps", 8192, "--curve", "CURVE")
        assert re.search(
            r"^plan: 2 updates of 32 x 128 steps, 8,192 steps in about \d:\d\d:\d\d .*\n"
            r"update 1: .*\nupdate 2: [1-9]\d* games",
            output,
        )

    @pytest.mark.needs_modules("jax", "optax", "tqdm", "PIL")
    def test_a_policy_is_kept_and_played_and_filmed(self):
        from PIL import Image

        with tempfile.TemporaryDirectory() as folder:
            policy, film = pathlib.Path(folder, "policy"), pathlib.Path(folder, "film.gif")
            one = ("updraft", "--envs", 2, "--horizon", 8, "--steps", 16, "--games", 3)
            self.run_example("examples/ppo.py", *one, "--keep", policy)
            outputs = [self.run_example("examples/ppo.py", *one, "--play", policy, "--film", film) for _ in range(2)]
            assert re.search(r"^3 games: mean score \d+\.\d, from \d+ to \d+\n$", outputs[0])
            assert outputs[0] == outputs[1]
            with Image.open(film) as frames:
                assert frames.size == (320, 210)
                assert frames.n_frames > 10
            self.refuse("ppo.py", "--play", policy)

    @pytest.mark.needs_modules("jax", "optax", "tqdm")
    @pytest.mark.parametrize("observe", ("ram", "pixels"))
    def test_the_log_of_a_policy_is_confirmed(self, observe):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder, "game.episode")
            small = ("--observe", observe, "--envs", 2, "--horizon", 8, "--steps", 16)
            assert "racebeam verify confirms it" in self.run_example("examples/ppo.py", *small, "--log", log)
            done = self.verify(log)
            assert re.search(r"^game.episode \(updraft, ppo, score \d+\): confirmed; ", done.stdout), done.stderr
            log.write_bytes(log.read_bytes()[:-1])
            assert self.verify(log).returncode == 1

    @pytest.mark.needs_modules("matplotlib")
    def test_the_cells_of_the_notebook_run(self):
        notebook = json.loads((CLIENT / "examples/learning_curve.ipynb").read_text())
        cells = [("".join(cell["source"]), cell) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        assert all(not cell["outputs"] and cell["execution_count"] is None for _, cell in cells)
        code = "\n".join(source for source, _ in cells)
        code, count = re.subn(r"(?m)^GENERATIONS = \d+", "GENERATIONS = 2", code)
        assert count == 1
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "Agg"}
        )
        assert done.returncode == 0, done.stderr
        assert re.search(r"random play: \d+\.\d\n(generation \d+: .*\n){2}", done.stdout)

    @pytest.mark.needs_modules("jax", "optax", "tqdm")
    def test_ppo_on_pixels(self):
        output = self.run_example(
            "examples/ppo.py", "--observe", "pixels", "--steps", 32, "--horizon", 8, "--envs", 4, "--epochs", 1
        )
        assert re.search(r"\d+ steps a second", output)
        self.refuse("ppo.py")

    @pytest.mark.needs_modules("stable_baselines3")
    def test_stable_baselines(self):
        output = self.run_example("examples/stable_baselines.py", "--steps", 64, "--steps-of-update", 16, "--envs", 4)
        assert re.search(r"total_timesteps\s*\|\s*64", output)
        self.refuse("stable_baselines.py")

    @pytest.mark.needs_modules("stable_baselines3")
    def test_stable_baselines_leaves_a_submission(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder, small = pathlib.Path(scratch, "ppo"), ("--steps", 64, "--steps-of-update", 16, "--envs", 4)
            self.run_example("examples/stable_baselines.py", *small, "--log", folder)
            assert re.search("^3 rows confirmed, 0 wrong, 0 could not be checked", self.verify(folder).stdout)
            results = (folder / "results.csv").read_text()
            (folder / "results.csv").write_text(results.replace(",terminated,", ",truncated,", 1))
            assert self.verify(folder).returncode == 1
