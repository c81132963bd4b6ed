"""Counts instructions under valgrind's callgrind. The counts are the same in every run, also on a busy machine.

Only the function `measured_act` of `racebeam bench --commands` is counted (cli/bench/bench_session.cpp): not
power-on, resets, or earlier acts. Translated code is counted like any other.
"""

import collections
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field

import bench_settings
import cartridges

COUNTED = "*measured_act*"
MADE_AT_RUN_TIME = "(made at run time)"
# Selects the variants of vectorised functions that every processor can run.
PLAIN = {"RACEBEAM_SIMD": "plain"}


@dataclass
class Counts:
    frames: int = 0
    total: int = 0
    files: collections.Counter = field(default_factory=collections.Counter)
    functions: collections.Counter = field(default_factory=collections.Counter)

    def a_frame(self):
        return self.total / self.frames


def available():
    return shutil.which("valgrind") is not None


def count(binary, game, setting, before, frames, cpu=None, environment=PLAIN):
    """Counts the instructions of `frames` frames after `before` frames of random play.

    Raises LookupError if the image of the game is missing, and RuntimeError, with its last lines, if the program fails.
    """
    actions = bench_settings.draw_actions(game, range(18), (before + frames) // setting.skip)
    first = before // setting.skip
    commands = "".join(
        f"{command} {' '.join(map(str, part))}\n"
        for command, part in (("check", actions[:first]), ("play", actions[first:]))
        if part
    )
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "callgrind.out"
        valgrind = ["valgrind", "--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={out}"]
        done = subprocess.run(
            [*valgrind, *setting.command(binary, game, cpu)],
            input=commands,
            capture_output=True,
            text=True,
            env=os.environ | environment,
        )
        if done.returncode:
            lines = [line for line in done.stderr.splitlines() if not line.startswith("==")]  # not valgrind's
            raise RuntimeError(
                f"{game}: racebeam under valgrind ended with status {done.returncode}: " + " ".join(lines[-1:])
            )
        counts = read(out)
    counts.frames = len(actions[first:]) * setting.skip
    return counts


def read(path):
    """Reads the counts in a file of callgrind, by source file and by function, without those of callees.

    Inlined code counts for its own file. If that is not in the tree (the standard library), it counts for the function
    that it is inlined into.
    """
    counts = Counts()
    names = {"ob": {}, "fl": {}, "fn": {}}
    home = str(cartridges.ROOT) + "/"
    file = function = own_file = thing = ""
    skip = False

    def name(table, words):
        number, _, rest = words.partition(" ")
        return table.setdefault(number, rest) if rest else table.get(number, "")

    for line in path.read_text(errors="replace").splitlines():
        key, equals, words = line.partition("=")
        if equals and re.fullmatch(r"c?(ob|fl|fi|fe|fn)", key):
            kind = "fl" if key[-2:] in ("fl", "fi", "fe") else key[-2:]
            found = name(names[kind], words)
            if key == "ob":
                thing = found
            elif key in ("fl", "fi", "fe"):
                file = found
            elif key == "fn":
                function, own_file = found, file
        elif key == "calls":
            skip = True
        elif line[:1] in "0123456789+-*" and line:
            if not skip:
                cost = int(line.split()[1])
                counts.total += cost
                counts.files[place(file, own_file, thing, home)] += cost
                counts.functions[function if thing not in ("", "???") else MADE_AT_RUN_TIME] += cost
            skip = False
    return counts


def place(file, own_file, thing, home):
    """The path in the tree, else the program or library, else MADE_AT_RUN_TIME."""
    for candidate in (file, own_file):
        if candidate.startswith(home):
            return os.path.normpath(candidate.removeprefix(home))
    return MADE_AT_RUN_TIME if thing in ("", "???") else f"{os.path.basename(thing)} (not in the tree)"
