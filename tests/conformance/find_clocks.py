#!/usr/bin/env python3
"""Finds games that end by a clock, of which the rule does not know.

A machine has ended if no action changes its memory any more: after the same number of frames, memory is the same,
whatever was pressed. The last second of each try presses nothing, since games remember the joystick. Four players
play each game: one does nothing, one only fires, one plays at random, and goes back before a lost life, and one keeps
its lives: it writes the byte of memory back that counts them.

    find_clocks.py [--frames N] [--rules ale-0.12] [--processes N] [--players noop,fire,random,held] [GAME...]

prints a line for each game and player: whether the rule said that the game was over, the machine has ended without it,
or the player came to its last frame or no further. The Python package must be installed (scripts/wheel --venv).
"""

import argparse
import multiprocessing
import random

import racebeam
from racebeam._core import View

PLAYERS = ("noop", "fire", "random", "held")
PRESSED = {"noop": 0, "fire": 1}
LOOK = 1800  # frames from one check to the next
TRY, REST = 840, 60  # frames of a try, and of the NOOP at its end
TRIES = 6
STEP, LONG_STEP = 40, 120  # frames of a random player, and of the others, between two states
ACTIONS = 18


class Machine:
    """A game without sticky actions and without a limit of frames."""

    def __init__(self, game, rules):
        self.ale = racebeam.ALEInterface()
        self.ale.setFloat("repeat_action_probability", 0)
        self.ale.setInt("max_num_frames_per_episode", 0)
        self.ale.setString("rules", rules)
        self.ale.loadROM(racebeam.find_image(game), game)
        self.reward, self.over, self.lives, self.frame = 0.0, False, self.ale.lives(), 0

    def act(self, action, frames):
        _, reward, _, self.over, _, self.lives, self.frame, _ = self.ale.step(action, 1.0, frames, View.NONE)
        self.reward += reward

    def play_randomly(self, random_numbers, frames):
        while frames > 0 and not self.over:
            held = min(random_numbers.randint(1, 20), frames)
            self.act(random_numbers.randrange(ACTIONS), held)
            frames -= held

    def save(self):
        return self.ale.cloneState(), self.reward, self.lives, self.frame

    def restore(self, saved):
        state, self.reward, self.lives, self.frame = saved
        self.ale.restoreState(state)
        self.over = False


def differing_bytes(machine, tries=TRIES):
    """How many bytes of memory the actions change; None if they change the reward, or end the game."""
    saved = machine.save()
    memories = []
    for number in range(tries):
        machine.restore(saved)
        if number == 0:
            machine.act(0, TRY)
        else:
            machine.play_randomly(random.Random(number), TRY)
        machine.act(0, REST)
        if machine.over or machine.reward != saved[1]:
            memories = None
            break
        memories.append(machine.ale.getRAM())
        differ = max(int((memory != memories[0]).sum()) for memory in memories)
        if differ > 1:
            break
    machine.restore(saved)
    return None if memories is None else differ


def play_on(machine, most, random_numbers):
    """Plays at random, and goes back before each lost life: the further, the longer it does not get ahead."""
    stack, failures, furthest = [machine.save()], 0, 0
    for _ in range(4 * most // STEP):
        if machine.frame >= most:
            return
        lives = machine.lives
        machine.play_randomly(random_numbers, STEP)
        if machine.over or machine.lives < lives:
            failures += 1
            steps = 1 + int(random_numbers.expovariate(4 / (4 + failures)))
            del stack[max(1, len(stack) - steps) :]
            machine.restore(stack[-1])
            continue
        stack = [*stack[-100:], machine.save()]
        if machine.frame > furthest:
            furthest, failures = machine.frame, 0
            yield


def life_byte(machine, before, after, memory, lives):
    """The byte that brings a lost life back, and its value before; None if no single byte does."""
    for place in range(len(memory)):
        machine.restore(after)
        if machine.ale.getRAM()[place] == memory[place]:
            continue
        machine.ale.setRAM(place, int(memory[place]))
        machine.act(0, 1)
        if not machine.over and machine.lives >= lives:
            machine.restore(before)
            return place, int(memory[place])
    machine.restore(before)
    return None


def keep_lives(machine, most, random_numbers):
    """Plays at random, and writes the byte of lives back where one is lost, until no byte helps."""
    held = None
    while machine.frame < most:
        before, lives, memory = machine.save(), machine.lives, machine.ale.getRAM()
        machine.act(random_numbers.randrange(ACTIONS), 1 if held is None else STEP // 2)
        if machine.lives < lives and held is None:
            held = life_byte(machine, before, machine.save(), memory, lives)
        if machine.over:
            machine.restore(before)
            machine.act(0, 1)
        if machine.over or (held is None and machine.lives < lives):
            return
        if machine.lives < lives:
            machine.ale.setRAM(*held)
        yield


def press(machine, action, most):
    """Presses and releases a button until the game is over."""
    while machine.frame < most and not machine.over:
        machine.act(action, LONG_STEP // 2)
        machine.act(0, LONG_STEP // 2)
        yield


def first_dead(machine, states, most_differing):
    """The frame of the earliest of these states from which the machine has ended."""
    frame = machine.frame
    here = machine.save()
    for state in reversed(states):
        machine.restore(state)
        differ = differing_bytes(machine)
        if differ is None or differ > most_differing:
            break
        frame = machine.frame
    machine.restore(here)
    return frame


def steps_of(machine, player, most):
    if player in PRESSED:
        return press(machine, PRESSED[player], most)
    return (play_on if player == "random" else keep_lives)(machine, most, random.Random(7))


def look_at(task):
    """Plays a game, and returns the line about it. A machine has ended if three checks in a row say so."""
    game, player, most, rules = task
    machine = Machine(game, rules)
    states, looked, in_a_row = [], machine.frame, 0
    for _ in steps_of(machine, player, most):
        if machine.over:
            break
        states = [*states[-200:], machine.save()]
        if machine.frame - looked < LOOK:
            continue
        looked = machine.frame
        differ = differing_bytes(machine)
        in_a_row = in_a_row + 1 if differ is not None and differ <= 1 else 0
        if in_a_row == 3:
            return line(task, machine, f"ended differ={differ}", first_dead(machine, states, differ))
    return line(task, machine, "over" if machine.over else "alive", machine.frame)


def line(task, machine, how, frame):
    return f"{task[0]} {task[1]} {how} frame={frame} lives={machine.lives} score={machine.reward:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=110000)
    parser.add_argument("--rules", default="fixed")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--players", default=",".join(PLAYERS))
    parser.add_argument("game", nargs="*")
    options = parser.parse_args()
    games = options.game or sorted(set(racebeam.find_images()))
    tasks = [(game, player, options.frames, options.rules) for game in games for player in options.players.split(",")]
    with multiprocessing.Pool(options.processes, maxtasksperchild=10) as pool:
        for one in pool.imap(look_at, tasks):
            print(one, flush=True)


if __name__ == "__main__":
    main()
