"""scripts/demo with the program that was built: its status, and the files that it leaves."""

import os
import shutil
import subprocess
import tempfile
import unittest

from harness import BINARY, PATIENCE, SOURCE, main

EPISODE = "docs/results/own-games/logs/updraft-uct-1/1.episode"


class Demo(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.scratch = os.path.join(folder.name, "tree"), os.path.join(folder.name, "scratch")
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

    def test_one_that_works_ends_with_status_0_and_leaves_only_its_results(self):
        os.makedirs(self.path("build/release"))
        os.symlink(BINARY, self.path("build/release/racebeam"))
        for redirection in ("</dev/null", "<&-"):
            with self.subTest(redirection=redirection):
                done = self.run_demo(redirection)
                self.assertEqual(done.returncode, 0, done)
                self.assertEqual(sorted(os.listdir(self.path("build/demo"))), ["beamfall.png", "updraft.gif"])
                shutil.rmtree(self.path("build/demo"))
                self.assertEqual(os.listdir(self.scratch), [])

    def test_one_whose_server_fails_says_so_and_ends_the_player(self):
        self.script("build/release/racebeam", "exit 7")
        done = self.run_demo("</dev/null")  # which returns once the player has closed its standard output
        self.assertEqual(done.returncode, 7, done)
        self.assertEqual(os.listdir(self.scratch), [])


if __name__ == "__main__":
    main()
