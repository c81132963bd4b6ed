"""The examples of the documents run: all whose packages are installed.

RACEBEAM_IMPORTING names a module: then only those that import it run, and it must be installed."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile

import package
import pytest

package.require("numpy")

DOCUMENTS = (package.SOURCE / "README.md", *sorted((package.SOURCE / "docs/python").glob("*.md")))
OPTIONAL = ("gymnasium", "ale_py", "stable_baselines3", "jax", "torch", "torchrl", "tianshou")
EXAMPLE = re.compile(r"(?ms)^```python\n(.*?)^```")

IMPORTING = os.environ.get("RACEBEAM_IMPORTING")


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


EXAMPLES = [
    pytest.param(example, id=f"{document.stem}-{number}")
    for document in DOCUMENTS
    for number, example in enumerate(EXAMPLE.findall(document.read_text()))
    if not IMPORTING or imports(example, IMPORTING)
]


@pytest.mark.parametrize("example", EXAMPLES)
def test_it_runs(example):
    if not IMPORTING and not is_playable(example):
        pytest.skip("it needs a package or an image that is not here")
    done = run(example)
    assert (done.returncode, done.stderr) == (0, "")


def test_there_are_examples():
    assert EXAMPLES
    assert IMPORTING or any(is_playable(*example.values) for example in EXAMPLES)
