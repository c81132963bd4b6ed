#!/usr/bin/env python3
"""A planner in a page: tries each action for a while from the present state, and plays the one that paid best."""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "single_file"))
from client import Refused, Session  # noqa: E402

DEPTH = 20  # acts that a branch looks ahead
STEPS = 60  # acts that are played

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("racebeam", help="the program, such as build/release/racebeam")
parser.add_argument("game", nargs="?", default="beamfall", help="a game that it has an image of (default: beamfall)")
if len(sys.argv) == 1:
    parser.print_help(sys.stderr)
    sys.exit(2)
options = parser.parse_args()


def play(session):
    """Plays the game, and prints its score and the number of frames."""
    session.load(options.game, seed=1, sticky=0, frame_skip=4)
    session.observe("reward", "terminated", "truncated")
    actions = list(session.actions().values())
    score = 0
    for _ in range(STEPS):
        session.save("here")
        branches = session.branch("here", *[[action, f"FIRE*{DEPTH}"] for action in actions])
        best = max(range(len(actions)), key=lambda i: (branches[i]["reward"], branches[i]["lives"]))
        reply = session.act(actions[best])
        score += reply["reward"]
        if reply["terminated"] or reply["truncated"]:
            break
    print(
        f"score {score} after {session.look('episode_frame')['episode_frame']} frames, "
        f"{session.stats()['frames']} frames run"
    )


try:
    with Session.start(options.racebeam) as started:
        play(started)
except (OSError, Refused) as error:
    sys.exit(f"best_branch.py: {options.racebeam} {options.game}: {error}")
