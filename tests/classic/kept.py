"""What ALE 0.6.0 said, kept: for each run its exit status and the digest of its output, a line each."""

import hashlib
import pathlib

from run import Run

FILE = pathlib.Path(__file__).with_name("kept.txt")


def digest(answer):
    return f"{answer.status} {hashlib.md5(answer.output).hexdigest()}"


def write(path, answers):
    """`answers` maps runs to what was answered."""
    lines = (f"{run.name} {digest(answer)}\n" for run, answer in answers.items())
    path.write_text("".join(lines))


def read(path=FILE):
    """Pairs of a run and the digest of the answer."""
    words = (line.split(" ", 1) for line in path.read_text().splitlines())
    return [(Run.parse(name), wanted) for name, wanted in words]
