"""`mvn verify` builds the jars of the client in Java and passes its tests. The jars are reproducible.

Plugins and JUnit come from Maven Central, or from the user's repository. Where neither has them, the test is skipped.
"""

import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY  # noqa: E402

pytestmark = pytest.mark.needs_programs("mvn", "javac")

VERSION = re.search(r"project\(racebeam VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
UNREACHABLE = re.compile("Could not transfer|Unknown host|Could not resolve|could not be resolved|offline mode")


def maven(folder, *words):
    return subprocess.run(
        [
            "mvn",
            "--batch-mode",
            "--no-transfer-progress",
            "-f",
            SOURCE / "clients/java/pom.xml",
            f"-Dracebeam.build={folder}",
            *words,
        ],
        env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        capture_output=True,
        text=True,
        timeout=600,
    )


def jars(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in pathlib.Path(folder).glob("*.jar")}


class Maven(unittest.TestCase):
    def test_verify_builds_and_tests_and_twice_gives_the_same(self):
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            done = maven(first, "verify")
            if done.returncode != 0 and UNREACHABLE.search(done.stdout):
                self.skipTest("Maven cannot get its plugins here")
            self.assertEqual(done.returncode, 0, done.stdout[-5000:])
            self.assertRegex(done.stdout, r"Tests run: 1\d, Failures: 0, Errors: 0, Skipped: 0")
            archives = jars(first)
            self.assertEqual(
                sorted(archives), [f"racebeam-{VERSION}{kind}.jar" for kind in ("-javadoc", "-sources", "")]
            )
            self.assertEqual(maven(second, "-Dmaven.test.skip=true", "verify").returncode, 0)
            self.assertEqual(jars(second), archives)
