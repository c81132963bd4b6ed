"""Agents in Lua and in Python leave submissions on a server. `racebeam verify` confirms them, and refuses forgeries."""

import csv
import hashlib
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import zlib

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from harness import BINARY, PATIENCE, Server

HEAD = 24  # bytes of a log before its contents (docs/episodes.md)
LUA = next(filter(None, map(shutil.which, ("lua5.4", "luajit", "lua5.1"))), None)


def resealed(log, alter):
    """A log with other contents and a checksum that fits."""
    contents = bytearray(zlib.decompress(log[HEAD:]))
    alter(contents)
    head, deflated = log[: HEAD - 4], zlib.compress(bytes(contents), 9)
    return head + struct.pack("<I", zlib.crc32(head + deflated)) + deflated


class TestSubmissions:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--record-dir", ".")
        cleanup(self.server.__exit__)
        self.address = f"tcp://127.0.0.1:{self.server.port()}"
        self.folder = pathlib.Path(self.server.path("mine"))

    def play(self, *command):
        lua = SOURCE / "clients/lua"
        done = subprocess.run(
            list(map(str, command)),
            env=dict(os.environ, RACEBEAM_ADDRESS=self.address, LUA_PATH=f"{lua}/?.lua;{lua}/?/init.lua;;"),
            capture_output=True,
            text=True,
            timeout=PATIENCE * 5,
        )
        assert (done.returncode, done.stderr) == (0, "")
        assert "3 episodes are in the server's folder mine\n" in done.stdout

    def play_in_python(self):
        self.play(sys.executable, "-B", SOURCE / "clients/python/logged_agent.py", "mine")

    def verify(self):
        done = subprocess.run([BINARY, "verify", self.folder], capture_output=True, text=True, timeout=PATIENCE)
        return done.returncode, done.stdout + done.stderr

    def rows(self):
        with open(self.folder / "results.csv", newline="") as file:
            return list(csv.DictReader(file))

    def write_rows(self, rows):
        with open(self.folder / "results.csv", "w", newline="") as file:
            table = csv.DictWriter(file, rows[0], lineterminator="\n")
            table.writeheader()
            table.writerows(rows)

    def check_confirmed(self):
        status, output = self.verify()
        assert (status, output.split(";")[0]) == (0, "3 rows confirmed, 0 wrong, 0 could not be checked")

    def check_refused(self, sentence):
        status, output = self.verify()
        assert status == 1, output
        assert sentence in output

    @pytest.mark.skipif(not LUA, reason="Lua is not installed")
    def test_an_agent_in_lua(self):
        self.play(LUA, SOURCE / "clients/lua/examples/submission.lua", "mine")
        self.check_confirmed()

    def test_an_agent_in_python(self):
        self.play_in_python()
        self.check_confirmed()
        assert (self.folder / "agent.toml").read_text().splitlines() == [
            'agent = "python-random"',
            'version = "1"',
            'preset = "machado2018"',
            "training_frames = 0",
            'role = "baseline"',
        ]

    def test_a_score_that_was_raised_is_refused(self):
        self.play_in_python()
        first, *others = self.rows()
        self.write_rows([first | {"score": str(int(first["score"]) + 1)}, *others])
        self.check_refused("not confirmed: score is '")

    def test_a_seed_that_was_swapped_is_refused(self):
        self.play_in_python()
        first, second, third = self.rows()
        self.write_rows([first | {"environment_seed": second["environment_seed"]}, second, third])
        self.check_refused("not confirmed: environment_seed is '")

    def test_an_action_that_was_changed_is_refused(self):
        self.play_in_python()
        first, *others = self.rows()
        path = self.folder / "logs" / first["unit"] / "1.episode"

        def alter(contents):
            contents[-1] = (contents[-1] + 1) % 18

        path.write_bytes(resealed(path.read_bytes(), alter))
        self.write_rows([first | {"log_digest": hashlib.sha256(path.read_bytes()).hexdigest()}, *others])
        self.check_refused("(beamfall-python-random-1, episode 1): not confirmed: ")
