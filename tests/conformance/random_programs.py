"""Plays random programs on both sides until the time is over."""

import itertools
import random
import shlex
import time

import ours
import programs
from compare import IDENTICAL, Comparison, result_of
from pool import results as pool_results
from run import Run

FRAMES = 20  # per program, after the 128 steps of power-on
PATIENCE = 300  # seconds for one program
TOLD_EVERY = 30  # seconds


def run_of(kind, seed):
    """The seed also determines the settings, and whether bytes of RAM are written."""
    chance = random.Random(f"settings {seed}")
    return Run(
        kind,
        skip=chance.choice([1, 1, 4]),
        sticky=chance.choice([0, 0, 0.25]),
        averaging=chance.randrange(2),
        writes=chance.randrange(2),
        seed=seed,
        frames=FRAMES,
    )


def runs_until(end, first_seed):
    """All kinds in turn."""
    for seed, kind in zip(itertools.count(first_seed), itertools.cycle(programs.KINDS)):
        if time.monotonic() >= end:
            return
        yield run_of(kind, seed)


def compare_programs(options, first_seed):
    """Prints what differs, and the sum. Returns the exit status."""
    extra, forms = shlex.split(options.racebeam_options), ours.FORMS if options.forms else ()
    begin = reported = time.monotonic()
    done = different = frames = 0

    def compare(run):
        return Comparison(run, options.out, extra, forms).result()

    for run, returned in pool_results(
        compare, runs_until(begin + 60 * options.minutes, first_seed), options.jobs, PATIENCE
    ):
        result = result_of(run, returned)
        done, frames = done + 1, frames + result["frames"]
        if result["verdict"] != IDENTICAL:
            different += 1
            print(f"{result['run']}: {result['verdict']}: {result['report']}", flush=True)
        if time.monotonic() - reported > TOLD_EVERY:
            reported = time.monotonic()
            print(sentence(done, different, frames, first_seed, reported - begin), flush=True)
    print(sentence(done, different, frames, first_seed, time.monotonic() - begin), flush=True)
    return 1 if different else 0


def sentence(done, different, frames, first_seed, seconds):
    return (
        f"{done} random programs from seed {first_seed}, {frames:,} frames, {seconds / 60:.1f} minutes: "
        f"{different} differ"
    )
