"""An agent for the tests: measures steps a second with RACEBEAM_ADDRESS, or with the program that --program names.

Prints an object of JSON: for each of SHOWN, the median of the rounds, and the characters of a reply.
"""

import argparse
import json
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "clients/python/single_file"))
import client

SHOWN = ("reward terminated truncated ram", "screen:zlib", "screen:rle", "screen:base64")
ROUNDS, STEPS = 3, 100


def rate_of(game):
    began = time.perf_counter()
    for _ in range(STEPS):
        game.ask("act", "FIRE")
    return STEPS / (time.perf_counter() - began)


def measure(game):
    game.load("beamfall", seed=1, frame_skip=4, max_episode_frames=0)
    found = {}
    for field in SHOWN:
        game.observe(*field.split())
        length = sum(len(name) + len(value) + 2 for name, value in game.ask("act", "FIRE")[0].items())
        found[field] = {"steps": statistics.median(rate_of(game) for _ in range(ROUNDS)), "length": length}
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program")
    options = parser.parse_args()
    with (
        client.Session.start(options.program, "--log-level", "warning") if options.program else client.connect()
    ) as game:
        print(json.dumps(measure(game)))


if __name__ == "__main__":
    main()
