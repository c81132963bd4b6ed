"""Replays recordings of the reference with `racebeam trace` and compares every line.

    replay.py [GAME...]      all recordings if no game is named

Needs cartridge images (RACEBEAM_ROMS, or ale-py in .venv) and the recordings themselves (RACEBEAM_SHARED, or the folder
`shared` beside the checkout; the README in its folder `traces` has the format). Status 0: all named are reproduced; 1:
one is not; 77: nothing failed, but none could be replayed.
"""

import gzip
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from harness import BINARY, SKIPPED, SOURCE, rom

TRACES = os.path.join(os.environ.get("RACEBEAM_SHARED", os.path.join(os.path.dirname(SOURCE), "shared")), "traces")
OPTIONS = {
    "skip": "--frame-skip",
    "sticky": "--sticky",
    "rseed": "--seed",
    "mode": "--mode",
    "diff": "--difficulty",
    "maxf": "--max-frames",
}
FLAGS = {"avg": "--color-averaging", "audio": "--audio", "ram": "--ram"}
NO_MEANING = {"rom", "width", "height", "frames", "action_seed", "every"}  # for a replay


def read_trace(path):
    """Returns the header as a dictionary, and the lines that racebeam must print."""
    with gzip.open(path, "rt") as file:
        header, *lines = file.read().splitlines()
    settings = dict(word.split("=", 1) for word in header.split() if "=" in word)
    return settings, [line for line in lines if line[0] in "RA"]


def options_of(settings):
    words = []
    for key, value in settings.items():
        if key in OPTIONS:
            words += [OPTIONS[key], value]
        elif key in FLAGS:
            words += [FLAGS[key]] if value == "1" else []
        elif key not in NO_MEANING:
            raise ValueError(f"unknown setting {key!r} of a trace")
    return words


def first_difference(expected, printed):
    for number, (theirs, ours) in enumerate(zip(expected, printed)):
        if theirs != ours:
            return f"line {number}:\n    reference {theirs}\n    racebeam  {ours}"
    return f"{len(expected)} lines in the recording, {len(printed)} printed"


def replay(game):
    """Returns (verdict, sentence). The verdict is reproduced, DIFFERENT or skipped."""
    path, image = os.path.join(TRACES, game + ".trace.gz"), rom(game)
    if not os.path.exists(path):
        return "skipped", "the recording is missing"
    if image is None:
        return "skipped", "the image is missing"
    settings, expected = read_trace(path)
    run = subprocess.run(
        [BINARY, "trace", "--rom", image, "--actions", path, *options_of(settings)],
        capture_output=True,
        text=True,
        timeout=250,
    )
    lines = run.stdout.splitlines()
    if run.returncode != 0:
        return "DIFFERENT", f"status {run.returncode} after {len(lines)} lines: {run.stderr.strip()}"
    if lines != expected:
        return "DIFFERENT", first_difference(expected, lines)
    return "reproduced", f"{len(lines)} lines"


def main():
    if not os.path.isdir(TRACES):
        print("skipped: the recordings of the reference are not here")
        return SKIPPED
    games = sys.argv[1:] or sorted(
        name.removesuffix(".trace.gz") for name in os.listdir(TRACES) if name.endswith(".gz")
    )
    counts = {"reproduced": 0, "DIFFERENT": 0, "skipped": 0}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for game, (verdict, sentence) in zip(games, pool.map(replay, games)):
            counts[verdict] += 1
            print(f"{game:20} {verdict}: {sentence}", flush=True)
    print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
    if counts["DIFFERENT"]:
        return 1
    return 0 if counts["reproduced"] else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
