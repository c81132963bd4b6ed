#!/usr/bin/env python3
"""Plays one game at random: random_agent.py RACEBEAM ROM [SEED], for instance `build/release/racebeam builtin:beamfall`."""
import random
import subprocess
import sys

racebeam, rom, *seed = sys.argv[1:]
generator = random.Random(int(seed[0]) if seed else 1)
server = subprocess.Popen([racebeam, "serve", "--classic", "--stdio", "--rom", rom, "--seed", "1"],
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def ask(line):
    print(line, file=server.stdin, flush=True)
    return server.stdout.readline()


size = server.stdout.readline().strip()  # the server speaks first: 160-210
answer = ask("0,1,0,1")                  # we want: no screen, RAM, (nothing), end and reward
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
