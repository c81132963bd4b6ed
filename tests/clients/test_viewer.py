"""scripts/viewer succeeds with --check, --unit, --browser, --firefox or --static. Usage: test_viewer.py OPTION.

Skipped where the npm packages of viewer/ are missing, and in a browser where that is.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY, PATIENCE, main, sanitized  # noqa: E402

LEAST_TESTS = {"--unit": 50, "--browser": 30, "--firefox": 4, "--static": 3}
BROWSERS = {"--browser": "chromium", "--firefox": "firefox-esr", "--static": "chromium"}
EMULATOR = SOURCE / "build/wasm/clients/js/wasm/racebeam.wasm"


class Viewer(unittest.TestCase):
    option = "--check"

    def test_it_passes(self):
        done = subprocess.run(
            [SOURCE / "scripts/viewer", self.option],
            timeout=PATIENCE * 15,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=dict(os.environ, RACEBEAM_BINARY=BINARY),
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        if least := LEAST_TESTS.get(self.option):
            counts = dict(re.findall(r"^\S+ (pass|fail|skipped) (\d+)$", done.stdout, re.MULTILINE))
            self.assertGreaterEqual(int(counts["pass"]), least)
            self.assertEqual((counts["fail"], counts["skipped"]), ("0", "0"))


if __name__ == "__main__":
    Viewer.option = sys.argv.pop()
    needs = [
        (
            "the npm packages of viewer/, which scripts/viewer --install installs",
            (SOURCE / "viewer/node_modules/esbuild").exists(),
        ),
        ("node", shutil.which("node")),
    ]
    if browser := BROWSERS.get(Viewer.option):
        needs += [
            (f"{browser}, which scripts/setup --viewer installs", shutil.which(browser)),
            ("a program without sanitizers", not sanitized()),
        ]
    if Viewer.option == "--static":
        needs += [("racebeam.wasm, which platforms/check wasm builds", EMULATOR.exists())]
    main(*needs)
