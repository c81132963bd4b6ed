"""racebeam, driven through its command line."""

import functools
import hashlib
import json
import os
import pathlib
import subprocess
from dataclasses import dataclass

from images import rule_of
from run import step_word

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BINARY = os.environ.get("RACEBEAM_BINARY", str(SOURCE / "build/release/racebeam"))
PATIENCE = 300  # seconds
# Variants of racebeam that must be equal to the default one: options, environment.
FORMS = {
    "interpreter": (["--cpu", "interpreter"], {}),
    "translator": (["--cpu", "translator"], {}),
    "plain": ([], {"RACEBEAM_SIMD": "plain"}),
}


def version():
    return subprocess.run([BINARY, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]


def digest():
    """A digest of the program. Results of one program are not valid for another."""
    return hashlib.sha256(pathlib.Path(BINARY).read_bytes()).hexdigest()[:16]


@functools.cache
def catalogue():
    output = subprocess.run([BINARY, "games", "--json"], check=True, capture_output=True, text=True).stdout
    return {game["name"]: game for game in json.loads(output)}


def trace_command(run, image_path, script, extra=()):
    words = [
        BINARY,
        "trace",
        "--rom",
        str(image_path),
        "--actions",
        script,
        "--audio",
        "--counters",
        "--colors",
        str(run.colors_every),
        "--seed",
        str(run.generator_seed),
        "--frame-skip",
        str(run.skip),
        "--sticky",
        str(run.sticky),
        "--max-frames",
        str(run.limit),
    ]
    if rule_of(run.game) != run.game:
        words += ["--game", rule_of(run.game)]
    for option, value in (("--mode", run.mode), ("--difficulty", run.difficulty)):
        words += [] if value is None else [option, str(value)]
    words += ["--color-averaging"] * run.averaging + ["--truncate-on-life-loss"] * run.lifeloss
    return words + list(extra)


@dataclass
class Printed:
    lines: list
    end: str  # why lines ceased


def play(run, image, steps, extra=(), variables=None):
    script = "\n".join(map(step_word, steps)) + "\n"
    done = subprocess.run(
        trace_command(run, image.path, "-", extra),
        input=script,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        env={**os.environ, **(variables or {})},
    )
    complaints = done.stderr.splitlines()
    end = "" if done.returncode == 0 else f"status {done.returncode}: {complaints[-1] if complaints else ''}"
    return Printed(done.stdout.splitlines(), end)


@dataclass
class Sight:
    """All output for one line of a run."""

    screen: bytes
    rgb: bytes
    ram: bytes


def look(run, image, steps, line, extra=()):
    """The output for that line, or None if the program does not reach it."""
    lines = play(run, image, steps, [*extra, "--ram", "--screen-of", str(line)]).lines
    for position, text in enumerate(lines):
        if text.startswith(f"S {line} "):
            _, _, screen, rgb = text.split()
            return Sight(bytes.fromhex(screen), bytes.fromhex(rgb), bytes.fromhex(lines[position - 1].split()[-1]))
    return None
