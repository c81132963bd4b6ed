"""The tests of the client in Lua pass, with each program of Lua."""

import os
import pathlib
import shutil
import subprocess

import pytest
from harness import BINARY, PATIENCE

SOURCE = pathlib.Path(__file__).resolve().parents[2]


@pytest.mark.needs_programs("busted")
@pytest.mark.parametrize("lua", ("lua5.1", "lua5.4", "luajit"))
def test_busted_passes(lua):
    program = shutil.which(lua)
    if not program or subprocess.run([program, "-e", "require 'socket'"], capture_output=True).returncode != 0:
        pytest.skip(f"{lua} or its LuaSocket is not installed")
    done = subprocess.run(
        ["busted", f"--lua={program}", "--output=TAP"],
        cwd=SOURCE / "clients/lua",
        timeout=PATIENCE * 5,
        env=dict(os.environ, RACEBEAM_PROGRAM=BINARY),
        stdout=subprocess.PIPE,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    assert done.stdout.count("\nok ") + done.stdout.startswith("ok ") > 20, done.stdout
