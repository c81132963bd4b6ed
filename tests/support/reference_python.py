"""Runs a test where the reference and what comes with it are installed: by the Python of scripts/reference, or not at all."""

import importlib.util
import os
import pathlib
import sys

SKIPPED = 77  # the exit status that ctest reads as "skipped"
OF_SCRIPTS_REFERENCE = pathlib.Path(__file__).resolve().parents[2] / ".venv/bin/python"


def require(*modules):
    """Returns if they are all there; else the program begins again with the other Python, once, or ends as skipped."""
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    if not missing:
        return
    if OF_SCRIPTS_REFERENCE.exists() and "RACEBEAM_REFERENCE_PYTHON" not in os.environ:
        os.environ["RACEBEAM_REFERENCE_PYTHON"] = str(OF_SCRIPTS_REFERENCE)  # so that this is tried once
        os.execv(OF_SCRIPTS_REFERENCE, [str(OF_SCRIPTS_REFERENCE), "-B", *sys.argv])
    print(f"SKIPPED: there is nothing to compare with: {' and '.join(missing)} not installed (scripts/reference)")
    sys.exit(SKIPPED)
