"""Sessions of WebAssembly are those of the program. `platforms/check wasm` builds racebeam.wasm, and runs this."""

import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from harness import BINARY, PATIENCE

pytestmark = [
    pytest.mark.needs_programs("node"),
    pytest.mark.skipif("RACEBEAM_WASM" not in os.environ, reason="not found: racebeam.wasm (RACEBEAM_WASM)"),
]


class TestWebAssembly:
    def test_its_tests_pass(self):
        # The program would have the games of RACEBEAM_ROMS, too.
        environment = {name: value for name, value in os.environ.items() if name != "RACEBEAM_ROMS"}
        done = subprocess.run(
            ["node", "--test", "wasm/"],
            cwd=SOURCE / "clients/js",
            timeout=PATIENCE * 10,
            capture_output=True,
            text=True,
            env=dict(environment, RACEBEAM_PROGRAM=BINARY),
        )
        assert done.returncode == 0, done.stdout
        assert "\n# skipped 0\n" in done.stdout
