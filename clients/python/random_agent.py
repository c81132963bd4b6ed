#!/usr/bin/env python3
"""Plays one game at random over the classic protocol."""

import argparse
import random
import subprocess
import sys

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("racebeam", help="the program, such as build/release/racebeam")
parser.add_argument("rom", help="a cartridge image, or builtin:beamfall")
parser.add_argument("seed", nargs="?", type=int, default=1, help="seed of the actions (default: 1)")
if len(sys.argv) == 1:
    parser.print_help(sys.stderr)
    sys.exit(2)
options = parser.parse_args()

generator = random.Random(options.seed)
try:
    server = subprocess.Popen(
        [options.racebeam, "serve", "--classic", "--stdio", "--rom", options.rom, "--seed", "1"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
except OSError as error:
    sys.exit(
        f"random_agent.py: cannot start {options.racebeam}: {error.strerror}; it takes the path of the program racebeam"
    )


def ask(line):
    """Sends a line to the server, and returns its answer."""
    print(line, file=server.stdin, flush=True)
    return server.stdout.readline() or sys.exit("random_agent.py: the server has ended")


size = server.stdout.readline().strip()  # the server speaks first: 160-210
if not size:
    sys.exit(server.wait() or 1)  # the server has written the reason
answer = ask("0,1,0,1")  # asks for: no screen, RAM, (unused), end and reward
score = frames = 0
while answer != "DIE\n":
    ram, episode, _ = answer.split(":")  # RAM is bytes.fromhex(ram); an agent would look at it
    done, reward = map(int, episode.split(","))
    score += reward
    if done:
        break
    frames += 1
    answer = ask(f"{generator.randrange(18)},18")

server.stdin.close()
server.wait()
print(f"score {score} in {frames} frames")
