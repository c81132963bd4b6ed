"""The messages of conftest.py if the program is missing."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = """
import os
import subprocess

import pytest


@pytest.mark.needs_program
def test_that_needs_it():
    pass


def test_that_runs_it():
    subprocess.run([os.environ["RACEBEAM_BINARY"]], check=True)
"""


def run(case, tmp_path, program):
    """Runs a case of CASES with the tree's conftest.py, and returns the output of pytest."""
    file = tmp_path / "test_cases.py"
    file.write_text(CASES)
    command = [sys.executable, "-m", "pytest", "-c", ROOT / "pyproject.toml", "-p", "conftest", file, "-k", case]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "RACEBEAM_BINARY": str(program)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    return done.stdout


class TestMissingProgram:
    def test_a_failed_or_skipped_test_says_what_makes_it(self, tmp_path):
        hint = f"not found: the program {tmp_path}/racebeam, which scripts/build makes or RACEBEAM_BINARY names"
        assert hint in run("needs_it", tmp_path, tmp_path / "racebeam")
        failed = run("runs_it", tmp_path, tmp_path / "racebeam")
        assert "1 failed" in failed
        assert hint in failed

    def test_a_program_that_is_there_is_not_mentioned(self, tmp_path):
        program = tmp_path / "racebeam"
        program.write_text("#!/bin/sh\nexit 1\n")
        program.chmod(0o755)
        failed = run("runs_it", tmp_path, program)
        assert "1 failed" in failed
        assert "not found" not in failed
