"""Runs a test with the Python that has the reference and its companions: this one, or that of
scripts/reference. Without one, it skips the test."""

import ctypes
import importlib.util
import os
import pathlib
import platform
import sys

SKIPPED = 77  # the exit status that ctest reads as "skipped"
M_PERTURB = -6  # malloc.h
ZEROS = "255"  # MALLOC_PERTURB_ (mallopt(3)): new memory holds the complement of this byte
OF_SCRIPTS_REFERENCE = pathlib.Path(__file__).resolve().parents[2] / ".venv/bin/python"


def require(*modules):
    """Returns if all modules are installed. Otherwise restarts the program once with the other Python, or ends it
    as skipped."""
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    if not missing:
        return
    if OF_SCRIPTS_REFERENCE.exists() and "RACEBEAM_REFERENCE_PYTHON" not in os.environ:
        os.environ["RACEBEAM_REFERENCE_PYTHON"] = str(OF_SCRIPTS_REFERENCE)  # so that this is tried once
        os.execv(OF_SCRIPTS_REFERENCE, [str(OF_SCRIPTS_REFERENCE), "-B", *sys.argv])
    print(f"SKIPPED: the reference is missing: {' and '.join(missing)} not installed (scripts/reference)")
    sys.exit(SKIPPED)


def zero_new_memory():
    """Has the GNU C library fill new memory with zeros, in this process and those that it starts.

    The reference reads memory that it never set: averaging looks up an unset entry of its table wherever an index is
    odd, as in PAL pictures that lost their colour (docs/spec/palette.md, "Colour averaging"). Fresh memory happens to
    be zero, reused memory is not.
    """
    if platform.libc_ver()[0] == "glibc" and os.environ.get("MALLOC_PERTURB_") != ZEROS:
        os.environ["MALLOC_PERTURB_"] = ZEROS
        ctypes.CDLL(None).mallopt(M_PERTURB, int(ZEROS))
