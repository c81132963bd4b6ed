"""The tests of the client in Lua pass: test_busted.py LUA, where LUA is a program such as lua5.4 or luajit."""

import os
import pathlib
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY, PATIENCE, SKIPPED  # noqa: E402


def main():
    lua, busted = shutil.which(sys.argv[1]), shutil.which("busted")
    if (
        lua is None
        or busted is None
        or subprocess.run([lua, "-e", "require 'socket'"], capture_output=True).returncode != 0
    ):
        print(f"SKIPPED: {sys.argv[1]}, busted or LuaSocket is not installed")
        return SKIPPED
    done = subprocess.run(
        [busted, f"--lua={lua}", "--output=TAP"],
        cwd=SOURCE / "clients/lua",
        timeout=PATIENCE * 5,
        env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        stdout=subprocess.PIPE,
        text=True,
    )
    print(done.stdout)
    return 0 if done.returncode == 0 and done.stdout.count("\nok ") + done.stdout.startswith("ok ") > 20 else 1


if __name__ == "__main__":
    sys.exit(main())
