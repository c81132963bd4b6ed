"""Measures racebeam beside ALE: the same games and random legal actions, in alternating chunks, in one run.

Processor time of the acts alone is counted on both sides; ALE runs in this process, through ale-py, racebeam in one of
its own (racebeam bench). That both did the same is checked: the first chunk of every game line by line (screen,
RAM, reward, lives and end of every act), all others by frames, rewards and the last screen and RAM.
"""
import argparse
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time
import zlib

import_error = None
try:
    import ale_py
except ImportError as error:
    import_error = error

ROOT = pathlib.Path(__file__).resolve().parent.parent
RACEBEAM = ROOT / "build/release/racebeam"
GAMES = ["breakout", "pong", "qbert", "seaquest", "space_invaders"]
SEED = 123


def parse_arguments():
    parser = argparse.ArgumentParser(prog="scripts/bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", nargs="+", default=GAMES, metavar="GAME", help="default: " + " ".join(GAMES))
    parser.add_argument("--chunks", type=int, default=5, help="chunks on either side (default 5)")
    parser.add_argument("--frames", type=int, default=20000, help="frames in a chunk (default 20000)")
    parser.add_argument("--frame-skip", type=int, default=1, help="frames of an act (default 1)")
    parser.add_argument("--screen", choices=["every", "last", "none"], default="every",
                        help="the screens that racebeam produces (default every; ALE always produces each)")
    return parser.parse_args()


def image(game):
    return pathlib.Path(ale_py.__file__).parent / "roms" / f"{game}.bin"


def open_reference(game, frame_skip):
    ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
    ale = ale_py.ALEInterface()
    ale.setInt("frame_skip", frame_skip)
    ale.setInt("random_seed", SEED)
    ale.setFloat("repeat_action_probability", 0.0)
    ale.loadROM(image(game))
    return ale


def draw_actions(game, seed, count):
    """As in the recordings of the reference: an action is held for four acts on average."""
    legal = [action.value for action in open_reference(game, 1).getLegalActionSet()]
    generator, actions, action = random.Random(seed), [], 0
    for _ in range(count):
        if generator.random() < 0.25:
            action = generator.choice(legal)
        actions.append(action)
    return actions


def crc(array):
    return f"{zlib.crc32(array.tobytes()):08x}"


def play_reference(game, actions, options):
    """The processor seconds of the acts, and what shows that racebeam did the same."""
    ale = open_reference(game, options.frame_skip)
    seconds = frames = reward = resets = acts = 0
    while frames < options.frames:
        before, first = frames, ale.getFrameNumber()
        start = time.process_time()
        while frames < options.frames and not ale.game_over():
            reward += ale.act(actions[acts])
            acts += 1
            frames = before + ale.getFrameNumber() - first
        seconds += time.process_time() - start
        if ale.game_over():
            ale.reset_game()
            resets += 1
    return seconds, (frames, int(reward), resets, crc(ale.getScreen()), crc(ale.getRAM()))


def play_racebeam(game, actions_file, options):
    figures = json.loads(subprocess.run(
        [RACEBEAM, "bench", "--json", "--rom", image(game), "--actions", actions_file, "--frames", str(options.frames),
         "--frame-skip", str(options.frame_skip), "--screen", options.screen, "--seed", str(SEED), "--sticky", "0"],
        check=True, capture_output=True, text=True).stdout)
    proof = ("frames", "reward", "resets", "last_screen_crc", "last_ram_crc")
    return figures["cpu_seconds"], tuple(figures[key] for key in proof)


def trace_reference(game, actions, frame_skip):
    ale = open_reference(game, frame_skip)
    observe = lambda: f"{ale.lives()} {crc(ale.getRAM())} {crc(ale.getScreen())}"
    yield "R " + observe()
    for action in actions:
        reward = int(ale.act(action))
        yield f"A {action} {reward} {int(ale.game_over())} {observe()}"
        if ale.game_over():
            ale.reset_game()
            yield "R " + observe()


def check_every_frame(game, actions, actions_file, frame_skip):
    ours = subprocess.run([RACEBEAM, "trace", "--rom", image(game), "--actions", actions_file, "--seed", str(SEED),
                           "--frame-skip", str(frame_skip)], check=True, capture_output=True, text=True).stdout
    for number, (theirs, line) in enumerate(itertools.zip_longest(
            trace_reference(game, actions, frame_skip), ours.splitlines())):
        if theirs != line:
            sys.exit(f"bench: {game} differs from the reference in line {number}: {theirs} there, {line} here")


def measure(game, options, folder):
    """(seconds of the reference, seconds of racebeam) of every chunk."""
    pairs = []
    for chunk in range(options.chunks):
        actions = draw_actions(game, chunk + 1, options.frames)
        actions_file = pathlib.Path(folder) / "actions"
        actions_file.write_text(" ".join(map(str, actions)))
        if chunk == 0:
            check_every_frame(game, actions, actions_file, options.frame_skip)
        theirs, their_proof = play_reference(game, actions, options)
        ours, our_proof = play_racebeam(game, actions_file, options)
        if their_proof != our_proof:
            sys.exit(f"bench: {game} ended otherwise than the reference, {their_proof} there, {our_proof} here")
        pairs.append((theirs, ours))
    return pairs


def geomean(numbers):
    return math.exp(sum(map(math.log, numbers)) / len(numbers))


def print_row(game, pairs, frames):
    theirs, ours = (sum(column) for column in zip(*pairs))
    ratios = [a / b for a, b in pairs]
    print(f"| {game} | {frames / theirs:,.0f} | {frames / ours:,.0f} | {theirs / ours:.2f} | "
          f"{min(ratios):.2f} - {max(ratios):.2f} |", flush=True)
    return theirs / ours


def measure_frames(options):
    print("| game | ALE, frames/s | racebeam, frames/s | ratio | of single chunks |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        ratios = [print_row(game, measure(game, options, folder), options.chunks * options.frames)
                  for game in options.games]
    print(f"| **geomean** | | | **{geomean(ratios):.2f}** | |\n| **worst** | | | **{min(ratios):.2f}** | |")


def time_reference_snapshot(game):
    """Nanoseconds to save and restore, in the middle of a game."""
    ale = open_reference(game, 1)
    for _ in range(120):
        ale.act(0)
    count = 5000
    start = time.process_time()
    for _ in range(count):
        ale.restoreState(ale.cloneState())
    return (time.process_time() - start) / count * 1e9


def measure_snapshots(games):
    print("\n| game | ALE, save + restore | racebeam, with pictures | racebeam, the machine alone |\n|---|---|---|---|")
    for game in games:
        figures = json.loads(subprocess.run([RACEBEAM, "bench", "--json", "--save-restore", "--frames", "1", "--rom", image(game)],
                                            check=True, capture_output=True, text=True).stdout)
        print(f"| {game} | {time_reference_snapshot(game):,.0f} ns | {figures['client_save_restore_ns']:,.0f} ns | "
              f"{figures['machine_save_restore_ns']:,.0f} ns |", flush=True)


def main():
    options = parse_arguments()
    if import_error:
        sys.exit(f"bench: {import_error}; scripts/reference installs it")
    print(f"{options.chunks} x {options.frames} frames a game, frame skip {options.frame_skip}, screen: {options.screen}; "
          f"ALE {ale_py.__version__}\n")
    measure_frames(options)
    measure_snapshots(options.games)


if __name__ == "__main__":
    main()
