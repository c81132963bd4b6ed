"""The units of an experiment as tasks of a Ray cluster.

    python3 cluster/ray/experiment.py paper results --shards 100 --roms /shared/atari

Words that are not listed by --help are options of `racebeam experiment`. All nodes need the folder of the results. A
shard whose node is lost goes on elsewhere from its checkpoints, and a finished unit is never run again. So the results
are the same, byte for byte, for any number of nodes and losses. At the end, `racebeam verify` checks the scores.
"""

from __future__ import annotations

import argparse
import ctypes
import signal
import subprocess
import sys

import racebeam.program
import ray
from options import positive
from ray.exceptions import RayTaskError

PR_SET_PDEATHSIG = 1  # linux/prctl.h


def end_with_parent() -> None:
    """Lets a child process be killed when the worker of Ray is."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


@ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=False)
def play(plan: str, results: str, shard: str, words: list[str]) -> str:
    """Runs a shard, such as 3/100. Returns what it printed. Raises RuntimeError with its error."""
    done = subprocess.run(
        [racebeam.program.path(), "experiment", plan, "--into", results, "--shard", shard, "--threads", "1", *words],
        capture_output=True,
        text=True,
        preexec_fn=end_with_parent,
    )
    if done.returncode != 0:
        raise RuntimeError(f"shard {shard}: {done.stderr.strip() or f'status {done.returncode}'}")
    return done.stdout


def run(plan: str, results: str, shards: int, words: list[str]) -> None:
    """Plays all shards. Prints what each of them printed."""
    waiting = [play.remote(plan, results, f"{number}/{shards}", words) for number in range(1, shards + 1)]
    while waiting:
        (done,), waiting = ray.wait(waiting)
        print(ray.get(done), end="", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("plan")
    parser.add_argument("results")
    parser.add_argument("--shards", type=positive, default=10)
    parser.add_argument("--address", help="address of a cluster, or auto; without it, Ray starts on this machine")
    options, words = parser.parse_known_args()
    ray.init(options.address)
    try:
        run(options.plan, options.results, options.shards, words)
    except RayTaskError as error:
        sys.exit(f"experiment.py: {error.cause}")
    sys.exit(subprocess.run([racebeam.program.path(), "verify", options.results]).returncode)


if __name__ == "__main__":
    main()
