"""The tests of the client in JavaScript pass, and its package has the files that it needs."""

import json
import os
import pathlib
import re
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CLIENT = SOURCE / "clients/js"

from harness import BINARY, PATIENCE

pytestmark = pytest.mark.needs_programs("node")


class TestNode:
    def test_its_tests_pass(self):
        done = subprocess.run(
            ["node", "--test", "test/"],
            cwd=CLIENT,
            timeout=PATIENCE * 5,
            capture_output=True,
            text=True,
            env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        )
        assert done.returncode == 0, done.stdout
        counts = dict(re.findall(r"^\S+ (pass|fail|skipped) (\d+)$", done.stdout, re.MULTILINE))
        assert int(counts["pass"]) > 20
        assert (counts["fail"], counts["skipped"]) == ("0", "0")

    def test_the_package_needs_nothing(self):
        package = json.loads((CLIENT / "package.json").read_text())
        assert not {"dependencies", "devDependencies", "peerDependencies"} & set(package)
        for path in (
            package["types"],
            *package["files"],
            *package["exports"]["."].values(),
            *package["imports"]["#platform"].values(),
        ):
            assert (CLIENT / path).exists(), path
