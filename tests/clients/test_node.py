"""The tests of the client in JavaScript pass, and its package has the files that it needs."""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CLIENT = SOURCE / "clients/js"
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY, PATIENCE  # noqa: E402

pytestmark = pytest.mark.needs_programs("node")


class Node(unittest.TestCase):
    def test_its_tests_pass(self):
        done = subprocess.run(
            ["node", "--test", "test/"],
            cwd=CLIENT,
            timeout=PATIENCE * 5,
            capture_output=True,
            text=True,
            env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        counts = dict(re.findall(r"^\S+ (pass|fail|skipped) (\d+)$", done.stdout, re.MULTILINE))
        self.assertGreater(int(counts["pass"]), 20)
        self.assertEqual((counts["fail"], counts["skipped"]), ("0", "0"))

    def test_the_package_needs_nothing(self):
        package = json.loads((CLIENT / "package.json").read_text())
        self.assertFalse({"dependencies", "devDependencies", "peerDependencies"} & set(package))
        for path in (
            package["types"],
            *package["files"],
            *package["exports"]["."].values(),
            *package["imports"]["#platform"].values(),
        ):
            self.assertTrue((CLIENT / path).exists(), path)
