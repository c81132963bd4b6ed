"""The examples that learn run, at a small scale, and draw their curves. Each is skipped where what it needs is not
installed."""

import importlib.util
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
        self.assertRegex(done.stderr.splitlines()[-1], f"^{example}: there is no game 'nogame'")
        self.assertNotIn("Traceback", done.stderr)

    def run_example(self, example, *options):
        """What it prints. It draws a curve, if it has --curve."""
        with tempfile.TemporaryDirectory() as folder:
            curve = pathlib.Path(folder, "curve.png")
            options = [str(curve) if option == "CURVE" else str(option) for option in options]
            done = subprocess.run(
                [sys.executable, CLIENT / example, *options], capture_output=True, text=True, cwd=folder
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            if str(curve) in options:
                self.assertEqual(curve.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            return done.stdout

    @needs("matplotlib")
    def test_sarsa(self):
        said = self.run_example(
            "sarsa.py", racebeam.program.path(), "--training", 3, "--frames", 3000, "--curve", "CURVE"
        )
        self.assertEqual(len(re.findall(r"training episode \d+: score \d+", said)), 3)

    @needs("jax", "optax", "matplotlib")
    def test_ppo_on_ram(self):
        said = self.run_example("examples/ppo.py", "updraft", "--updates", 2, "--curve", "CURVE")
        self.assertRegex(said, r"update 2: [1-9]\d* games")

    @needs("jax", "optax")
    def test_ppo_on_pixels(self):
        said = self.run_example(
            "examples/ppo.py", "--observe", "pixels", "--updates", 1, "--steps", 8, "--envs", 4, "--epochs", 1
        )
        self.assertRegex(said, r"\d+ steps a second")
        self.refuse("ppo.py")

    @needs("stable_baselines3")
    def test_stable_baselines(self):
        said = self.run_example("examples/stable_baselines.py", "--steps", 64, "--steps-of-update", 16, "--envs", 4)
        self.assertRegex(said, r"total_timesteps\s*\|\s*64")
        self.refuse("stable_baselines.py")


if __name__ == "__main__":
    package.main()
