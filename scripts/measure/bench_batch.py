"""Measures environment::Batch and AtariVectorEnv of ale-py with the same settings and actions, in alternating chunks
of one run.

Both sides make stacks of four grey screens of 84 x 84, pooled over the last two frames of a skip of four, for every
machine and step. Only the elapsed time of the steps is measured. Processor time is printed, too, because it varies less
on a busy machine. After every chunk, observations and RAM of both sides are compared.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import zlib

import_error = None
try:
    import ale_py
    import numpy as np
    from ale_py.vector_env import AtariVectorEnv
except ImportError as error:
    import_error = error

ROOT = pathlib.Path(__file__).resolve().parents[2]
RACEBEAM = ROOT / "build/release/racebeam"
GAMES = ["breakout", "pong", "qbert", "seaquest", "space_invaders"]
FRAME_SKIP = 4
SEED = 123


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench batch", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--games", nargs="+", default=GAMES, metavar="GAME", help="default: " + " ".join(GAMES))
    parser.add_argument("--machines", type=int, default=64, help="in a batch (default 64)")
    parser.add_argument(
        "--threads", type=int, default=os.cpu_count(), help="threads on both sides (default: all processors)"
    )
    parser.add_argument("--steps", type=int, default=200, help="steps of every machine in a chunk (default 200)")
    parser.add_argument("--chunks", type=int, default=3, help="chunks of each side (default 3); medians are printed")
    parser.add_argument("--json", metavar="FILE", help="also write the figures to FILE")
    options = parser.parse_args()
    if min(options.machines, options.threads, options.steps, options.chunks) < 1:
        parser.error("--machines, --threads, --steps and --chunks must be 1 or more")
    return options


def image(game):
    return pathlib.Path(ale_py.__file__).parent / "roms" / f"{game}.bin"


def play_reference(game, actions, options):
    """Returns elapsed and processor time in seconds, and a checksum of the last observations."""
    vector = AtariVectorEnv(game, num_envs=options.machines, num_threads=options.threads)
    vector.reset(seed=SEED)
    observations = None
    wall, cpu = time.perf_counter(), time.process_time()
    for row in actions:
        observations, *_ = vector.step(row)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    checksum = f"{zlib.crc32(np.ascontiguousarray(observations).tobytes()):08x}"
    vector.close()
    return wall, cpu, checksum


def play_racebeam(game, actions_file, threads, options):
    frames = options.machines * options.steps * FRAME_SKIP
    figures = json.loads(
        subprocess.run(
            [
                RACEBEAM,
                "bench",
                "--json",
                "--rom",
                image(game),
                "--batch",
                str(options.machines),
                "--threads",
                str(threads),
                "--frame-skip",
                str(FRAME_SKIP),
                "--frames",
                str(frames),
                "--actions",
                actions_file,
                "--seed",
                str(SEED),
            ],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
    )
    return figures["seconds"], figures["cpu_seconds"], figures["observation_crc"], figures["resident_bytes_per_machine"]


def choices(game):
    vector = AtariVectorEnv(game, num_envs=1)
    count = int(vector.single_action_space.n)
    vector.close()
    return count


def measure(game, options, folder):
    random = np.random.default_rng(SEED)
    count = choices(game)
    sides = {"reference": [], "one": [], "all": []}
    for _ in range(options.chunks):
        actions = random.integers(0, count, (options.steps, options.machines))
        actions_file = pathlib.Path(folder) / "actions"
        actions_file.write_text(" ".join(map(str, actions.ravel())))
        sides["reference"].append(play_reference(game, actions, options))
        sides["one"].append(play_racebeam(game, actions_file, 1, options))
        sides["all"].append(play_racebeam(game, actions_file, options.threads, options))
        digests = {side: chunks[-1][2] for side, chunks in sides.items()}
        if len(set(digests.values())) != 1:
            sys.exit(f"bench: {game}: observations differ: {digests}")

    def median(side, column):
        return statistics.median(chunk[column] for chunk in sides[side])

    frames = options.machines * options.steps * FRAME_SKIP
    return {
        "game": game,
        "frames": frames,
        "reference": frames / median("reference", 0),
        "racebeam": frames / median("all", 0),
        "ratio": median("reference", 0) / median("all", 0),
        "cpu_ratio": median("reference", 1) / median("all", 1),
        "over_one_thread": median("one", 0) / median("all", 0),
        "kib_a_machine": median("all", 3) / 1024,
    }


def main():
    options = parse_arguments()
    if import_error:
        sys.exit(f"bench: {import_error}; scripts/reference installs it")
    print(
        f"{options.machines} machines, {options.threads} threads, {options.chunks} x {options.steps} steps of "
        f"{FRAME_SKIP} frames, "
        f"4 x 84 x 84; ALE {ale_py.__version__}\n"
    )
    print(
        "| game | AtariVectorEnv, frames/s | racebeam, frames/s | ratio | of processor time | "
        f"{options.threads} threads over 1 | KiB a machine |\n|---|---|---|---|---|---|---|"
    )
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for game in options.games:
            row = measure(game, options, folder)
            rows.append(row)
            print(
                f"| {game} | {row['reference']:,.0f} | {row['racebeam']:,.0f} | {row['ratio']:.2f} | "
                f"{row['cpu_ratio']:.2f} | "
                f"{row['over_one_thread']:.2f} | {row['kib_a_machine']:.0f} |",
                flush=True,
            )
    means = {
        column: statistics.geometric_mean(row[column] for row in rows)
        for column in ("ratio", "cpu_ratio", "over_one_thread")
    }
    print(
        f"| **geomean** | | | **{means['ratio']:.2f}** | **{means['cpu_ratio']:.2f}** | "
        f"**{means['over_one_thread']:.2f}** | |"
    )
    if options.json:
        pathlib.Path(options.json).write_text(
            json.dumps(
                {"machines": options.machines, "threads": options.threads, "games": rows, "geomean": means}, indent=1
            )
            + "\n"
        )


if __name__ == "__main__":
    main()
