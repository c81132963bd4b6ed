"""scripts/demo with the program that was built: its status, and the files that it leaves."""

import os
import re
import shutil
import subprocess

import pytest
from harness import BINARY, PATIENCE, SOURCE

EPISODE = "docs/results/own-games/logs/updraft-uct-1/1.episode"


def run_program(*command):
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PATIENCE).returncode


class TestDemo:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root, self.scratch = os.path.join(tmp_path, "tree"), os.path.join(tmp_path, "scratch")
        os.mkdir(self.scratch)
        for name in ("scripts/demo", "clients/shell/play", EPISODE):
            os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
            shutil.copy(os.path.join(SOURCE, name), self.path(name))
        self.script("scripts/setup", "exit 0")  # nothing is missing, and
        self.script("scripts/build", "exit 0")  # it is built already

    def path(self, name):
        return os.path.join(self.root, name)

    def script(self, name, *lines):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w") as file:
            file.write("\n".join(["#!/usr/bin/env bash", *lines, ""]))
        os.chmod(self.path(name), 0o755)

    def run_demo(self, redirection):
        return subprocess.run(
            ["bash", "-c", f"exec bash '{self.path('scripts/demo')}' {redirection}"],
            capture_output=True,
            timeout=6 * PATIENCE,
            env={**os.environ, "TMPDIR": self.scratch},
        )

    def test_one_that_works_ends_with_status_0_and_leaves_only_its_results(self, subtests):
        os.makedirs(self.path("build/release"))
        os.symlink(BINARY, self.path("build/release/racebeam"))
        for redirection in ("</dev/null", "<&-"):
            with subtests.test(redirection=redirection):
                done = self.run_demo(redirection)
                assert done.returncode == 0, done
                self.check_text(done.stdout.decode())
                assert sorted(os.listdir(self.path("build/demo"))) == ["beamfall.png", "updraft.gif"]
                shutil.rmtree(self.path("build/demo"))
                assert os.listdir(self.scratch) == []

    def check_text(self, text):
        """It tells of a score, a film and a speed, and ends with three commands that the program has."""
        assert re.search(
            r"(?s)Score \d+ in \d+ frames.*updraft\.gif: \d+ frames\n.*"
            r"runs at \d+ frames a second on one processor, \d+ times as fast as a console\n\nTry next:\n",
            text,
        )
        commands = [line.split("#")[0].split() for line in text.partition("Try next:\n")[2].splitlines()]
        assert len(commands) == 3
        for program, command, *options in commands:
            assert run_program(program, command, *options, "--help") == 0

    def test_a_build_is_announced_before_it_begins(self):
        self.script("scripts/setup", "[[ $2 != --check ]] && exit 9 || exit 1")  # a package is missing
        done = self.run_demo("</dev/null")
        assert (done.returncode, done.stderr) == (9, b"")
        assert re.search(r"^demo: racebeam is built first, which takes about \w+ minutes on two", done.stdout.decode())

    def test_one_whose_server_fails_says_so_and_ends_the_player(self):
        self.script("build/release/racebeam", "exit 7")
        done = self.run_demo("</dev/null")  # which returns once the player has closed its standard output
        assert done.returncode == 7, done
        assert os.listdir(self.scratch) == []
