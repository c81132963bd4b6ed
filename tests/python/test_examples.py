"""The examples of the documents run: all whose packages are installed, or those that import a module of --importing."""

import argparse
import importlib.util
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import package

package.require("numpy")

DOCUMENTS = (package.SOURCE / "README.md", *sorted((package.SOURCE / "docs/python").glob("*.md")))
OPTIONAL = ("gymnasium", "ale_py", "stable_baselines3", "jax", "torch", "torchrl", "tianshou")
EXAMPLE = re.compile(r"(?ms)^```python\n(.*?)^```")

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--importing", metavar="MODULE", help="only the examples that import it; it must be installed")
options, rest = parser.parse_known_args()


def imports(example, module):
    return re.search(rf"\b(import|from) {module}\b", example) is not None


def needs(example):
    """The packages that an example needs besides NumPy."""
    found = {module for module in OPTIONAL if imports(example, module)}
    found |= {"gymnasium"} if re.search(r"Atari\w*Env", example) else set()
    return found | ({"moviepy"} if "RecordVideo" in example else set())


def is_playable(example):
    if not all(map(importlib.util.find_spec, needs(example))):
        return False
    return "Pong" not in example or "pong" in package.roms()


def run(example):
    """Runs an example in a new folder, which has a game and its image if the example needs them."""
    with tempfile.TemporaryDirectory() as folder:
        if "my_game" in example:
            shutil.copy(package.SOURCE / "games/catalogue/beamfall.toml", f"{folder}/my_game.toml")
            shutil.copy(package.SOURCE / "games/homebrew/beamfall.bin", f"{folder}/my_game.bin")
        return subprocess.run([sys.executable, "-c", example], cwd=folder, capture_output=True, text=True)


class Examples(unittest.TestCase):
    def test_they_run(self):
        count = 0
        for document in DOCUMENTS:
            for number, example in enumerate(EXAMPLE.findall(document.read_text())):
                if options.importing and not imports(example, options.importing):
                    continue
                with self.subTest(document=document.name, example=number):
                    if options.importing or is_playable(example):
                        done = run(example)
                        self.assertEqual((done.returncode, done.stderr), (0, ""))
                        count += 1
        self.assertGreater(count, 0)
        print(f"{count} examples ran", end=" ")


if __name__ == "__main__":
    sys.argv[1:] = rest
    package.main()
