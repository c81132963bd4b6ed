"""Runs a test where the package of evaluation/ is installed: by the Python that `scripts/evaluation` makes, or not at
all."""

import importlib.util
import os
import pathlib
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # the exit status that ctest reads as "skipped"
VENV = pathlib.Path(os.environ.get("RACEBEAM_EVALUATION_VENV", SOURCE / "build/evaluation/venv"))


def require(*modules):
    """Returns if the package and the modules are there; else the program begins again where they are, or ends as
    skipped."""
    missing = [name for name in ("racebeam_evaluation", *modules) if importlib.util.find_spec(name) is None]
    python = VENV / "bin/python"
    if missing and python.exists() and sys.executable != str(python):
        os.execv(python, [str(python), "-B", *sys.argv])
    if missing:
        print(f"SKIPPED: not installed: {' and '.join(missing)} (scripts/evaluation)")
        sys.exit(SKIPPED)


def main():
    unittest.main(module="__main__", verbosity=2)
