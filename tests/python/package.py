"""Runs a test where the Python package is installed: by the Python that `scripts/wheel --venv` makes, or not at all."""

import importlib.util
import os
import pathlib
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # the exit status that ctest reads as "skipped"
ZEROS = "255"  # see tests/support/reference_python.py
VENV = SOURCE / "build/python/venv"


def _is_there(module):
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:  # of a module's package
        return False


def require(*modules):
    """Returns if the package and the modules are all there, and new memory is zero, which the reference relies on. Else
    the program begins again so that they are, once, or ends as skipped."""
    missing = [name for name in ("racebeam._core", *modules) if not _is_there(name)]
    python = VENV / "bin/python"
    wrong = missing or os.environ.get("MALLOC_PERTURB_") != ZEROS
    if wrong and "RACEBEAM_PACKAGE_PYTHON" not in os.environ and (not missing or python.exists()):
        os.environ.update(RACEBEAM_PACKAGE_PYTHON="1", MALLOC_PERTURB_=ZEROS)
        interpreter = str(python) if missing else sys.executable
        os.execv(interpreter, [interpreter, "-B", *sys.argv])
    if missing:
        print(f"SKIPPED: not installed: {' and '.join(missing)} (scripts/wheel --venv)")
        sys.exit(SKIPPED)


def roms():
    """The names of the games whose images are here, without our own games."""
    import racebeam

    return [game for game, image in racebeam.find_images().items() if not image.startswith("builtin:")]


def main():
    unittest.main(module="__main__", verbosity=2)
