"""Helpers for the tests of the Python package. Importing this fills new memory with zeros, as the reference
requires."""

import importlib.util
import pathlib

import reference_python

SOURCE = pathlib.Path(__file__).resolve().parents[2]

reference_python.zero_new_memory()


def require(*modules):
    """Skips the calling file if the package or one of the modules is not installed."""
    import pytest  # fuzz.py runs without it, too

    for name in ("racebeam._core", *modules):
        pytest.importorskip(name, reason=f"not installed: {name} (scripts/wheel --venv, build/python/venv/bin/pytest)")


def has(module):
    """Whether a module is installed."""
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:  # the package of the module
        return False


def roms():
    """The names of the games whose images are here, without our own games."""
    import racebeam

    return [game for game, image in racebeam.find_images().items() if not image.startswith("builtin:")]
