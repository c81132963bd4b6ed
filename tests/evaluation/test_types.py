"""mypy finds nothing wrong with the types of the package."""

import subprocess
import sys
import unittest

import package

package.require("mypy")


class Types(unittest.TestCase):
    def test_mypy_reports_no_error(self):
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "mypy",
                "--config-file",
                "pyproject.toml",
                "--cache-dir",
                "/dev/null",
                "racebeam_evaluation",
            ],
            cwd=package.SOURCE / "evaluation",
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
