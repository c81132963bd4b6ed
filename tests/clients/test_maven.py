"""`mvn verify` builds the jars of the client in Java and passes its tests. The jars are reproducible.

Plugins and JUnit come from Maven Central, or from the user's repository. Where neither has them, the test is skipped.
"""

import hashlib
import os
import pathlib
import re
import subprocess
import tempfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from harness import BINARY

pytestmark = [pytest.mark.slow, pytest.mark.needs_programs("mvn", "javac")]

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


class TestMaven:
    def test_verify_builds_and_tests_and_twice_gives_the_same(self):
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            done = maven(first, "verify")
            if done.returncode != 0 and UNREACHABLE.search(done.stdout):
                pytest.skip("Maven cannot get its plugins here")
            assert done.returncode == 0, done.stdout[-5000:]
            assert re.search(r"Tests run: 1\d, Failures: 0, Errors: 0, Skipped: 0", done.stdout)
            archives = jars(first)
            assert sorted(archives) == [f"racebeam-{VERSION}{kind}.jar" for kind in ("-javadoc", "-sources", "")]
            assert maven(second, "-Dmaven.test.skip=true", "verify").returncode == 0
            assert jars(second) == archives
