"""Compares `racebeam classic` with ALE 0.6.0: sends the same lines to both, and compares their output.

The reference is a build of ALE's tag v0.6.0, made outside of this tree; give the path of its program `ale`.
The actions, settings, saves, loads and resets of a run are random_run from its seed. The run's name contains all
of that: --run repeats it. Status: 0 all identical, 1 a run differs, 2 usage error, 77 nothing to
compare with.
"""

import argparse
import os
import pathlib
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from images import SKIPPED, folder, image, images
from recorded import write as write_recorded
from run import Run, random_run
from session import BINARY, difference, play

IDENTICAL, UNKNOWN = "identical", "unknown to the reference"


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/check/classic-conformance",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("--reference", required=True, metavar="PATH", help="the program `ale` of ALE 0.6.0")
    add("--games", metavar="A,B", help="only these games (default: all with an image)")
    add("--seed", type=int, help="seed of the first series of runs (default: random, and printed)")
    add("--seeds", type=int, default=3, metavar="N", help="runs of each game (default 3)")
    add("--lines", type=int, default=1000, metavar="N", help="lines of a run (default 1000)")
    add("--run", action="append", metavar="NAME", help="only this run, by its name in a report; repeatable")
    add(
        "--jobs",
        type=int,
        default=os.cpu_count(),
        metavar="N",
        help="runs in parallel (default: one for each processor)",
    )
    add("--record", type=pathlib.Path, metavar="FILE", help="write digests of the reference's output")
    return parser.parse_args()


def chosen_runs(options):
    """Raises ValueError with a sentence."""
    if not os.access(options.reference, os.X_OK):
        raise ValueError(f"the reference '{options.reference}' is not a program that can be run")
    runs = [Run.parse(name) for name in options.run] if options.run else drawn_runs(options)
    for run in runs:
        image(run.game)
    return runs


def drawn_runs(options):
    first = random.SystemRandom().randrange(1, 10**6) if options.seed is None else options.seed
    print(f"seeds {first} to {first + options.seeds - 1}")
    games = options.games.split(",") if options.games else images()
    return [random_run(game, first + number, options.lines) for number in range(options.seeds) for game in games]


def compare(reference, run):
    """Returns the run, its verdict, and the reference's output."""
    path = image(run.game)
    try:
        expected = play([reference], run, path)
        if expected.status == 1 and not expected.output:
            return run, UNKNOWN, expected
        return run, difference(run, expected, play([BINARY, "classic"], run, path)) or IDENTICAL, expected
    except subprocess.TimeoutExpired as late:
        return run, f"{late.cmd[0]} did not end", None


def main():
    options = parse_arguments()
    if not images():
        print(f"skipped: no cartridge images are in {folder()}")
        return SKIPPED
    try:
        runs = chosen_runs(options)
    except ValueError as error:
        print(f"scripts/check/classic-conformance: {error}", file=sys.stderr)
        return 2
    results = compare_all(options, runs)
    if options.record:
        write_recorded(
            options.record, {run: expected for run, verdict, expected in results if expected and verdict != UNKNOWN}
        )
    return report({run: verdict for run, verdict, _ in results})


def compare_all(options, runs):
    """Returns the results of compare() for all runs. Prints differences as they are found."""
    results = []
    with ThreadPoolExecutor(options.jobs) as pool:
        for result in pool.map(lambda run: compare(options.reference, run), runs):
            run, verdict, _ = result
            results.append(result)
            if verdict not in (IDENTICAL, UNKNOWN):
                print(f"{run.name}: {verdict}", flush=True)
    return results


def report(verdicts):
    """Prints the counts. Returns the exit status."""
    unknown = sorted({run.game for run, verdict in verdicts.items() if verdict == UNKNOWN})
    results = {run: verdict for run, verdict in verdicts.items() if verdict != UNKNOWN}
    differing = sorted({run.game for run, verdict in results.items() if verdict != IDENTICAL})
    identical = sum(verdict == IDENTICAL for verdict in results.values())
    if unknown:
        print(f"{len(unknown)} games that the reference does not know: {', '.join(unknown)}")
    if differing:
        print(f"{len(differing)} games that differ: {', '.join(differing)}")
    print(f"{identical} of {len(results)} runs identical, of {len({run.game for run in results})} games")
    return 0 if identical == len(results) and results else 1


if __name__ == "__main__":
    sys.exit(main())
