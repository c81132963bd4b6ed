"""The tool finds differences, and reports nothing else. Its reference here is racebeam itself, with the same
or other settings."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from session import BINARY

TOOL = pathlib.Path(__file__).parent
IMAGE = TOOL.parents[1] / "games/homebrew/beamfall.bin"


class TestTool:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path
        shutil.copy(IMAGE, self.folder)

    def reference(self, command):
        path = self.folder / "reference"
        path.write_text(f"#!/bin/sh\n{command}\n")
        path.chmod(0o755)
        return path

    def compare(self, command, *options):
        """Status and output of the tool, with `command` as the reference."""
        done = subprocess.run(
            [sys.executable, "-B", TOOL, "--reference", self.reference(command), "--lines", "200", *options],
            env={**os.environ, "RACEBEAM_ROMS": str(self.folder), "RACEBEAM_BINARY": BINARY},
            capture_output=True,
            text=True,
        )
        return done.returncode, done.stdout + done.stderr

    def test_the_same_server_is_identical(self):
        status, output = self.compare(f"exec '{BINARY}' classic \"$@\"", "--seed", "1", "--seeds", "6")
        assert status == 0, output
        assert "6 of 6 runs identical, of 1 games" in output

    def test_a_difference_is_reported_with_the_line_and_its_run_can_be_played_again(self):
        (self.folder / "other").write_text("repeat_action_probability = 0.9\n")
        command = f"exec '{BINARY}' classic -config '{self.folder}/other' \"$@\""
        for options in (("--seed", "1", "--seeds", "2"), ("--run", "beamfall:sticky=0.0,seed=5,lines=200")):
            status, output = self.compare(command, *options)
            assert status == 1, output
            assert re.search(r"beamfall:\S+seed=\d+,lines=200: line \d+, after '\d+,\d+': RAM [89A-F]", output)

    def test_a_game_that_the_reference_does_not_know_is_not_a_difference(self):
        status, output = self.compare("exit 1", "--seed", "1")
        assert status == 1  # nothing was compared
        assert "1 games that the reference does not know: beamfall" in output
        assert "0 of 0 runs identical" in output

    def test_the_record_is_the_output_of_the_reference(self):
        from recorded import digest, read
        from session import play

        self.compare(
            f"exec '{BINARY}' classic \"$@\"", "--seed", "1", "--seeds", "2", "--record", str(self.folder / "recorded")
        )
        runs = read(self.folder / "recorded")
        assert len(runs) == 2
        for run, expected in runs:
            assert digest(play([BINARY, "classic"], run, str(IMAGE))) == expected

    def test_nonsense_is_named(self):
        for options, hint in (
            (("--run", "beamfall:depth=3"), "'depth'"),
            (("--run", "beamfall:skip=x"), "'x'"),
            (("--games", "unheard_of"), "'unheard_of'"),
        ):
            status, output = self.compare("exit 1", *options)
            assert status == 2, output
            assert hint in output.splitlines()[-1]
        status, output = self.compare("exit 1", "--reference", "/nowhere/ale")
        assert (status, "'/nowhere/ale' is not a program" in output) == (2, True), output
