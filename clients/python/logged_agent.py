#!/usr/bin/env python3
"""Plays random episodes on a server, which writes their logs into a folder. `racebeam verify FOLDER` confirms them."""

import argparse
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "single_file"))
from client import Refused, connect  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("folder", help="a name below the server's --record-dir")
parser.add_argument("--address", help="address of the server, such as tcp://127.0.0.1:7800 (default: RACEBEAM_ADDRESS)")
parser.add_argument("--game", default="beamfall", help="(default: %(default)s)")
parser.add_argument("--episodes", type=int, default=3, help="(default: %(default)s)")
parser.add_argument("--seed", type=int, default=5, help="seed of the agent (default: %(default)s)")
options = parser.parse_args()


def play(session):
    """Plays the episodes, and prints their scores."""
    session.load(options.game, seed=1, preset="machado2018")
    session.observe("reward", "terminated", "truncated")
    actions = list(session.actions())
    session.log(options.folder, agent="python-random", agent_seed=options.seed, role="baseline")
    agent = random.Random(options.seed)
    for _ in range(options.episodes):
        reply, score = session.reset(), 0
        while not (reply["terminated"] or reply["truncated"]):
            reply = session.act(agent.choice(actions))
            score += reply["reward"]
        print(f"score {score}")
    logged = session.log("stop")["logged"]
    print(f"{logged} episodes are in the server's folder {options.folder}")


try:
    with connect(options.address) as session:
        play(session)
except (OSError, Refused) as error:
    sys.exit(f"logged_agent.py: {error}")
