"""All sentences of errors are in sentences.txt, so that other tests check the types of errors and what they name.

The file has an expression a line, and below it, indented, the error that it raises. This writes the errors anew:

    PYTHONPATH=tests/support build/python/venv/bin/python tests/python/test_sentences.py --write
"""

import ast
import pathlib
import subprocess
import sys
import tempfile
import time

import package

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from racebeam import ale_py, envpool, episode_log, presets, program
from racebeam.ale_py import AtariVectorEnv as AleVectorEnv
from racebeam.cluster import SlurmServers
from racebeam.env import AtariEnv
from racebeam.envpool import make_spec
from racebeam.vector_env import AtariVectorEnv
from racebeam.vector_options import VectorOptions

GOLDEN = pathlib.Path(__file__).with_name("sentences.txt")


class Places:
    """The names that expressions use. FOLDER stands for a folder of files, and SERVER for the address of a server."""

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        files = {
            "empty": "",
            "other": "x\n",
            "torn.json": "{",
            "new.json": '{"racebeam_announce": 99}',
            "no-address": "# nothing\n",
            "bad.bin": "x" * 6,
            "game.toml": "x",
        }
        for name, text in files.items():
            (self.folder / name).write_text(text)
        self.address = f"unix:{self.folder}/socket"
        self.server = subprocess.Popen(
            [program.path(), "serve", "--listen", self.address, "--ready-file", self.folder / "ready"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        while not (self.folder / "ready").exists() and self.server.poll() is None:
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()
        self.temporary.cleanup()

    def names(self):
        closed, closed_envs = AtariEnv("beamfall"), AtariVectorEnv("beamfall", 2)
        closed.close()
        closed_envs.close()
        return {
            "np": np,
            "racebeam": racebeam,
            "ale_py": ale_py,
            "envpool": envpool,
            "make_spec": make_spec,
            "episode_log": episode_log,
            "presets": presets,
            "AtariEnv": AtariEnv,
            "AtariVectorEnv": AtariVectorEnv,
            "AleVectorEnv": AleVectorEnv,
            "VectorOptions": VectorOptions,
            "SlurmServers": SlurmServers,
            "nan": float("nan"),
            "FOLDER": str(self.folder),
            "SERVER": self.address,
            "env": AtariEnv("beamfall"),
            "stick": AtariEnv("beamfall", continuous=True),
            "closed": closed,
            "ale": racebeam.ALEInterface(),
            "envs": AtariVectorEnv("beamfall", 2, seed=1),
            "sticks": AtariVectorEnv("beamfall", 2, continuous=True),
            "halves": AtariVectorEnv("beamfall", 2, batch_size=1),
            "closed_envs": closed_envs,
            "fresh": AleVectorEnv("beamfall", 2),
            "remote": AtariEnv("beamfall", server=self.address),
            "remotes": AtariVectorEnv("beamfall", 2, server=self.address),
            "session": racebeam.connect(self.address),
            "pool": envpool.make_gymnasium("Beamfall-v5", num_envs=2),
            "some": envpool.make_gymnasium("Beamfall-v5", num_envs=2, batch_size=1),
        }

    def error_of(self, expression, names):
        """The error that an expression raises, in one line."""
        try:
            eval(expression, dict(names))
        except Exception as error:
            sentence = " ".join(str(error).split())
            return f"{type(error).__name__}: {sentence}".replace(str(self.folder), "FOLDER")
        return "nothing is raised"


def expressions(text):
    return [line for line in text.splitlines() if line and line[0] not in "# "]


def with_current_sentences(text):
    """The file with the errors of its expressions. Comments and empty lines stay."""
    with Places() as places:
        names = places.names()
        lines = [line for line in text.splitlines() if not line.startswith(" ")]
        errors = [f"    {places.error_of(line, names)}\n" if line and line[0] != "#" else "" for line in lines]
        return "".join(f"{line}\n{error}" for line, error in zip(lines, errors))


class TestSentences:
    def test_each_error_says_what_the_file_says(self):
        self.maxDiff = None
        assert with_current_sentences(GOLDEN.read_text()) == GOLDEN.read_text()

    def test_each_expression_raises_an_error_and_occurs_once(self):
        text = GOLDEN.read_text()
        assert "nothing is raised" not in text
        assert len(expressions(text)) == len(set(expressions(text)))

    def test_most_sentences_of_the_package_are_in_the_file(self):
        """Some need another system: no pygame, no display, a server that goes away."""
        text = GOLDEN.read_text()
        missing = []
        for path in sorted(pathlib.Path(racebeam.__path__[0]).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if not isinstance(node, ast.Raise) or not isinstance(node.exc, ast.Call):
                    continue
                for sentence in node.exc.args[:1]:
                    words = longest_constant(sentence)
                    if words and words not in text:
                        missing.append(f"{path.name}: {words}")
        assert len(missing) <= 41, "\n".join(missing)


def longest_constant(sentence):
    """The longest part of a sentence that is the same in each error."""
    parts = sentence.values if isinstance(sentence, ast.JoinedStr) else [sentence]
    words = [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)]
    return max(words, key=len, default="").strip()


if __name__ == "__main__":
    if "--write" in sys.argv:
        GOLDEN.write_text(with_current_sentences(GOLDEN.read_text()))
        sys.exit()
