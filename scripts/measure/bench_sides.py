"""The two processes of a comparison. Each reads commands, and answers each with a line of JSON."""

import json
import os
import pathlib
import subprocess
import sys

import cartridges

HERE = pathlib.Path(__file__).resolve().parent
RACEBEAM = os.environ.get("RACEBEAM_BINARY", str(cartridges.ROOT / "build/release/racebeam"))
SEED = 123  # as bench_reference.py; both sides play without sticky actions


def one_processor():
    """Pins both sides to one processor, so that other work on it disturbs both."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


class Side:
    def __init__(self, name, command, environment=None):
        self.name = name
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            preexec_fn=one_processor,
            env=os.environ | (environment or {}),
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()

    def ask(self, command):
        self.send(command)
        return self.answer()

    def send(self, command):
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"bench: {self.name} ended in the middle of the measurement, status {self.process.wait()}")
        return json.loads(line)


class Reference(Side):
    def __init__(self):
        super().__init__("the reference", [sys.executable, HERE / "bench_reference.py"])

    def open(self, game, setting):
        return self.ask(f"open {setting.skip} {setting.look:d} {cartridges.image(game)}")


class Racebeam(Side):
    def __init__(self, game, setting, cpu=None, environment=None):
        command = setting.command(RACEBEAM, game, cpu)
        super().__init__("racebeam", [*command, "--seed", str(SEED), "--sticky", "0"], environment)
