#!/usr/bin/env python3
"""A planner in a page: best_branch.py RACEBEAM [GAME]. Tries each action for a while from where the game is, plays what paid best."""
import sys

from racebeam import Session

DEPTH = 20    # acts that a branch looks ahead
STEPS = 60    # acts that are played

racebeam, game = sys.argv[1], (sys.argv[2:] or ["beamfall"])[0]
with Session.start(racebeam) as session:
    session.load(game, seed=1, sticky=0, frame_skip=4)
    session.observe("reward", "ends")
    actions = list(session.actions().values())
    score = 0
    for _ in range(STEPS):
        session.save("here")
        branches = session.branch("here", *[[action, f"FIRE*{DEPTH}"] for action in actions])
        best = max(range(len(actions)), key=lambda i: (branches[i]["reward"], branches[i]["lives"]))
        shown = session.act(actions[best])
        score += shown["reward"]
        if shown["terminated"] or shown["truncated"]:
            break
    print(f"score {score} after {session.look('episode_frame')['episode_frame']} frames, "
          f"{session.stats()['frames']} frames run")
