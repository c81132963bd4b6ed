"""Sessions of WebAssembly are those of the program. `platforms/check wasm` builds racebeam.wasm, and runs this."""

import os
import pathlib
import subprocess
import sys
import unittest

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY, PATIENCE  # noqa: E402

pytestmark = [
    pytest.mark.needs_programs("node"),
    pytest.mark.skipif("RACEBEAM_WASM" not in os.environ, reason="not found: racebeam.wasm (RACEBEAM_WASM)"),
]


class WebAssembly(unittest.TestCase):
    def test_its_tests_pass(self):
        done = subprocess.run(
            ["node", "--test", "wasm/"],
            cwd=SOURCE / "clients/js",
            timeout=PATIENCE * 10,
            capture_output=True,
            text=True,
            env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("\n# skipped 0\n", done.stdout)
