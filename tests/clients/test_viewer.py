"""scripts/viewer succeeds with --check, --unit, --browser, --firefox and --static.

Skipped where the npm packages of viewer/ are missing, and in a browser where that is.
"""

import os
import pathlib
import re
import subprocess

import pytest
from harness import BINARY, PATIENCE, sanitized

SOURCE = pathlib.Path(__file__).resolve().parents[2]
EMULATOR = SOURCE / "build/wasm/clients/js/wasm/racebeam.wasm"
WITHOUT_SANITIZERS = pytest.mark.skipif(sanitized(), reason="the program has sanitizers")
BUILT = pytest.mark.skipif(not EMULATOR.exists(), reason="no racebeam.wasm, which platforms/check wasm builds")

pytestmark = [
    pytest.mark.needs_programs("node"),
    pytest.mark.skipif(
        not (SOURCE / "viewer/node_modules/esbuild").exists(),
        reason="the npm packages of viewer/ are missing; scripts/viewer --install installs them",
    ),
]


def in_browser(option, least, program, *marks):
    needed = pytest.mark.needs_programs(program)  # scripts/setup --viewer installs it
    return pytest.param(option, least, id=option, marks=(WITHOUT_SANITIZERS, needed, *marks))


@pytest.mark.parametrize(
    "option, least",
    (
        pytest.param("check", 0, id="check"),
        pytest.param("unit", 50, id="unit"),
        in_browser("browser", 30, "chromium"),
        in_browser("firefox", 4, "firefox-esr"),
        in_browser("static", 14, "chromium", pytest.mark.needs_programs("firefox-esr"), BUILT),
    ),
)
def test_it_passes(option, least):
    done = subprocess.run(
        [SOURCE / "scripts/viewer", f"--{option}"],
        timeout=PATIENCE * 15,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=dict(os.environ, RACEBEAM_BINARY=BINARY),
    )
    assert done.returncode == 0, done.stdout
    if least:
        counts = dict(re.findall(r"^\S+ (pass|fail|skipped) (\d+)$", done.stdout, re.MULTILINE))
        assert int(counts["pass"]) >= least
        assert (counts["fail"], counts["skipped"]) == ("0", "0")
