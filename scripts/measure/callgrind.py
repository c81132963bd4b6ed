"""Counts the instructions of a play under valgrind's callgrind: the same in every run, on a busy machine too.

Counted is the function `measured_act` of `racebeam bench --commands` (cli/bench/bench_session.cpp): neither
power-on, nor resets, nor the acts that come before. Code that is made while the program runs is counted as
any other.
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
# What may be chosen by the processor is set to what there is on all of them.
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
    """Instructions of `frames` frames after `before` frames of random play.

    Raises LookupError without an image of the game, RuntimeError, with its last words, if the program fails."""
    actions = bench_settings.draw_actions(game, range(18), (before + frames) // setting.skip)
    first = before // setting.skip
    commands = "".join(f"{command} {' '.join(map(str, part))}\n"
                       for command, part in (("check", actions[:first]), ("play", actions[first:])) if part)
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "callgrind.out"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={out}",
             str(binary), "bench", "--commands", "--rom", cartridges.image(game), "--frame-skip", str(setting.skip),
             "--screen", "last" if setting.look else "none", *(["--cpu", cpu] if cpu else [])],
            input=commands, capture_output=True, text=True, env=os.environ | environment)
        if done.returncode:
            own = [line for line in done.stderr.splitlines() if not line.startswith("==")]  # not valgrind's
            raise RuntimeError(f"{game}: racebeam under valgrind ended with status {done.returncode}: "
                               + " ".join(own[-1:]))
        counts = read(out)
    counts.frames = len(actions[first:]) * setting.skip
    return counts


def read(path):
    """The counts in a file of callgrind's, by source file and by function, without what callees cost.

    What is inlined counts for its own file; from outside the tree (the standard library), for the function it
    is in.
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
    """The path in the tree, else the program or library it is in, else that it is code made at run time."""
    for candidate in (file, own_file):
        if candidate.startswith(home):
            return os.path.normpath(candidate.removeprefix(home))
    return MADE_AT_RUN_TIME if thing in ("", "???") else f"{os.path.basename(thing)} (not in the tree)"
