"""The suite needs ale-py. Import this first: it sees to it that the program runs where that is installed."""

import importlib.util
import os
import pathlib
import sys

SKIPPED = 77  # the exit status that ctest reads as "skipped"
OF_SCRIPTS_REFERENCE = pathlib.Path(__file__).resolve().parents[2] / ".venv/bin/python"


def missing():
    return [name for name in ("ale_py", "numpy") if importlib.util.find_spec(name) is None]


if missing():
    if OF_SCRIPTS_REFERENCE.exists() and "RACEBEAM_REFERENCE_PYTHON" not in os.environ:
        os.environ["RACEBEAM_REFERENCE_PYTHON"] = str(OF_SCRIPTS_REFERENCE)  # so that this is tried once
        os.execv(OF_SCRIPTS_REFERENCE, [str(OF_SCRIPTS_REFERENCE), "-B", *sys.argv])
    print(f"skipped: there is nothing to compare with: {' and '.join(missing())} not installed (scripts/reference)")
    sys.exit(SKIPPED)
