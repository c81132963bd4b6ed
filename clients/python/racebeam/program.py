"""Finds the program `racebeam`, which pip installs beside python."""

from __future__ import annotations

import importlib.metadata
import os
import pathlib
import shutil
import sys

NOT_FOUND = (
    "the program racebeam is neither beside this package nor on the PATH; install a wheel that has it (those for macOS "
    "and musl lack it), or the .deb or .tar.gz of racebeam, or set RACEBEAM_PROGRAM to the program; connect() needs no "
    "program here"
)
NOT_FOR_WINDOWS = (
    "the program racebeam is not on the PATH, and wheels for Windows lack it; put racebeam.exe on the PATH, or start a "
    "server in WSL 2 or on another machine, and use connect(); AtariEnv and AtariVectorEnv need no program"
)


def path() -> str:
    """Finds the program.

    Returns:
        The first that is set or found: RACEBEAM_PROGRAM, the path of the program that this package installed, or the
        path of the one on the PATH.

    Raises:
        FileNotFoundError: If the program is not found.
    """
    program = os.environ.get("RACEBEAM_PROGRAM")
    if program:
        return program
    installed = _find_installed()
    found = str(installed) if installed is not None else shutil.which("racebeam")
    if found is None:
        raise FileNotFoundError(NOT_FOR_WINDOWS if sys.platform == "win32" else NOT_FOUND)
    return found


def _find_installed() -> pathlib.Path | None:
    try:
        files = importlib.metadata.files("racebeam") or []
    except importlib.metadata.PackageNotFoundError:
        return None
    for file in files:
        if file.name == "racebeam" and file.parent.name in ("bin", "Scripts"):
            place = pathlib.Path(str(file.locate())).resolve()
            if os.access(place, os.X_OK):
                return place
    return None
