"""An agent for the tests: plays a seeded episode, and prints its number and what it got. `--pause`: seconds in the
middle, after a line in the file that is named; only in the first run of a job that is requeued."""

import argparse
import hashlib
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "clients/python/single_file"))
import client

ACTIONS = ("NOOP", "FIRE", "LEFT", "RIGHT")


def play(game, number, middle=lambda: None):
    """The digest of a game that depends only on `number`."""
    digest = hashlib.sha256()
    game.load("beamfall", seed=number + 1, frame_skip=4)  # 0 would be a random one
    game.observe("reward", "terminated", "truncated", "ram", "screen:zlib")
    for step in range(60):
        if step == 30:
            middle()
        result = game.act(ACTIONS[(step * 7 + number) % len(ACTIONS)])
        digest.update(str(result["reward"]).encode() + result["ram"] + result["screen"])
    return digest.hexdigest()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--pause", type=float, default=0)
    parser.add_argument(
        "--reached", type=pathlib.Path, help="a folder, for a file that says that the middle is reached"
    )
    parser.add_argument("--into", type=pathlib.Path, help="a folder for the result")
    options = parser.parse_args()
    number = int(os.environ.get("SLURM_ARRAY_TASK_ID") or os.environ.get("SLURM_PROCID") or 0)

    def middle():
        if options.reached and "SLURM_RESTART_COUNT" not in os.environ:
            (options.reached / f"reached-{number}").write_text("")
            time.sleep(options.pause)

    with client.connect() as game:
        digest = play(game, number, middle)
    if options.into:
        (options.into / f"result-{number}").write_text(f"{digest}\n")
    print(number, digest)


if __name__ == "__main__":
    main()
