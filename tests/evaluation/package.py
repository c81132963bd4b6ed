"""Helpers for the tests of the evaluation package."""

import pathlib
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
VENV = pathlib.Path(sys.prefix)


def require(*modules):
    """Skips the calling file if the package or one of the modules is not installed."""
    for name in ("racebeam_evaluation", *modules):
        pytest.importorskip(
            name, reason=f"not installed: {name} (scripts/evaluation, build/evaluation/venv/bin/pytest)"
        )
