"""mypy finds nothing wrong with the types of the package."""

import subprocess
import sys

import package

package.require("mypy")


class TestTypes:
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
        assert done.returncode == 0, done.stdout + done.stderr
